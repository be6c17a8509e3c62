//! What the player is told in passing.

use tamaire_play::shortened;

/// How long a notice stays at least [s].
const LEAST: f32 = 6.0;
/// How fast it can be read, at leisure [letters/s].
const READING: f32 = 15.0;
/// Most letters of a notice: what it quotes may be as long as a file.
const LETTERS: usize = 600;

/// What is told, and for how long still.
#[derive(Clone, Debug)]
pub struct Notice {
    /// What.
    pub text: String,
    /// How long it stays [s].
    pub seconds: f32,
}

/// All that is told now, the newest last.
#[derive(Clone, Debug, Default)]
pub struct Notices(Vec<Notice>);

impl Notices {
    /// Tells something; what is still to be read is not said twice.
    pub(super) fn tell(&mut self, text: &str) {
        let text = shortened(text, LETTERS);
        self.take_back(&text);
        let reading = text.chars().count() as f32 / READING;
        let seconds = reading.max(LEAST);
        self.0.push(Notice { text, seconds });
    }

    /// What was told holds no more.
    pub(super) fn take_back(&mut self, text: &str) {
        self.0.retain(|notice| notice.text != text);
    }

    /// Lets time pass [s].
    pub(super) fn pass(&mut self, seconds: f32) {
        self.0
            .iter_mut()
            .for_each(|notice| notice.seconds -= seconds);
        self.0.retain(|notice| notice.seconds > 0.0);
    }

    /// What is told now.
    pub fn iter(&self) -> impl Iterator<Item = &Notice> {
        self.0.iter()
    }

    /// Forgets all.
    pub fn clear(&mut self) {
        self.0.clear();
    }
}
