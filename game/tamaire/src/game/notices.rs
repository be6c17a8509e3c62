//! Short messages to the player.

use crate::platform::Location;
use tamaire_play::shortened;

/// Minimum display time of a message [s].
const LEAST: f32 = 6.0;
/// Minimum display time of a message with a button [s].
const LEAST_WITH_BUTTON: f32 = 12.0;
/// Reading speed that determines longer display times [characters/s].
const READING: f32 = 15.0;
/// Maximum length of a message [characters]. Messages may quote files of any length.
const LETTERS: usize = 600;

/// A visible message.
#[derive(Clone, Debug)]
pub struct Notice {
    /// Text of the message.
    pub text: String,
    /// Location of a saved file, whose folder a button opens.
    pub saved: Option<Location>,
    /// Remaining display time [s].
    pub seconds: f32,
}

/// All visible messages, the newest last.
#[derive(Clone, Debug, Default)]
pub struct Notices(Vec<Notice>);

impl Notices {
    /// Adds a message. A visible message with the same text is replaced.
    pub(super) fn tell(&mut self, text: &str) {
        let text = shortened(text, LETTERS);
        self.take_back(&text);
        let reading = text.chars().count() as f32 / READING;
        let seconds = reading.max(LEAST);
        let saved = None;
        self.0.push(Notice {
            text,
            saved,
            seconds,
        });
    }

    /// Adds a message with a button that opens the folder of the file saved at `location`.
    pub(super) fn tell_of_saved(&mut self, text: &str, location: Location) {
        self.tell(text);
        if let Some(notice) = self.0.last_mut() {
            notice.saved = Some(location);
            notice.seconds = notice.seconds.max(LEAST_WITH_BUTTON);
        }
    }

    /// Removes the message with this text.
    pub(super) fn take_back(&mut self, text: &str) {
        self.0.retain(|notice| notice.text != text);
    }

    /// Advances the time by `seconds` [s].
    pub(super) fn pass(&mut self, seconds: f32) {
        self.0
            .iter_mut()
            .for_each(|notice| notice.seconds -= seconds);
        self.0.retain(|notice| notice.seconds > 0.0);
    }

    /// Returns the visible messages.
    pub fn iter(&self) -> impl Iterator<Item = &Notice> {
        self.0.iter()
    }

    /// Removes all messages.
    pub fn clear(&mut self) {
        self.0.clear();
    }
}
