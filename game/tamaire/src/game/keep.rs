//! What is kept, and what is told of it.

use super::{Game, Screen};
use crate::platform::{Damage, Entry, Kind, News};
use std::sync::Arc;
use tamaire_play::{Replay, ReplayError};

impl Game {
    /// Keeps the settings, once they rest; what cannot be written is said and lost only at the end of the game.
    pub fn keep_settings(&mut self) {
        self.files.keep_settings(&self.settings);
    }

    /// Keeps the round as it was played so far.
    pub fn keep_replay(&mut self) {
        self.files.save_replay(self.bout.round().replay());
    }

    /// Nothing is drawn any more: a round that is played is kept, to be watched later, and all else is written.
    pub fn rescue(&mut self) {
        if self.is_in_round() {
            self.keep_replay();
            self.go(Screen::Title);
            self.files.close();
        }
    }

    /// Takes a photo of how the round ended.
    pub fn keep_photo(&mut self) {
        let replay = self.bout.round().replay();
        self.files.save_picture(Kind::Photo, Arc::new(replay));
    }

    /// Keeps the last seconds of the round as an animation.
    pub fn keep_clip(&mut self) {
        let replay = self.bout.round().replay();
        self.files.save_picture(Kind::Clip, Arc::new(replay));
    }

    /// The same of a round that was kept: fit for [`Game::open_kept`].
    pub fn keep_clip_of(&mut self, replay: Arc<Replay>) -> Result<(), ReplayError> {
        self.files.save_picture(Kind::Clip, replay);
        Ok(())
    }

    /// Takes a level that does not come along out of the list. What was reached in it stays.
    pub fn take_out(&mut self, index: usize) {
        let level = self.levels.remove(index);
        self.files.remove_level(&level.id);
        if self.chosen >= index {
            self.chosen = self.chosen.saturating_sub(1);
        }
    }

    /// Hands a round that was kept to the player as a file.
    pub fn hand_out(&mut self, saved: &Entry) {
        if let Err(error) = self.files.hand_out(&saved.name) {
            self.tell(News::Failed(error.to_string()));
        }
    }

    /// Deletes a round that was kept.
    pub fn delete(&mut self, saved: &Entry) {
        if let Err(error) = self.files.delete(&saved.name) {
            self.tell(News::Failed(error.to_string()));
        }
        self.shelf.look(&self.files);
    }

    /// Writes what is still to be written, and waits until it is.
    pub fn finish_writing(&mut self) {
        for news in self.files.finish() {
            self.tell(news);
        }
    }

    /// Tells what became of what was to be written.
    pub(super) fn tell(&mut self, news: News) {
        match news {
            // One that was opened in the meantime is newer.
            News::Level(level) if self.levels.iter().any(|known| known.id == level.id) => {}
            News::Level(level) => self.levels.push(level),
            News::Damaged(damage) => self.tell_of(damage),
            News::Saved(location) => {
                self.shelf.look(&self.files);
                self.notify(format!("{} {location}", self.words().saved));
            }
            News::Failed(reason) => {
                self.notify(format!("{} {reason}", self.words().not_written));
            }
            News::Full => self.notify(self.words().full.to_string()),
        }
    }

    /// Names what of what was kept could not be used.
    pub(super) fn tell_of(&mut self, damage: Damage) {
        const MOST: usize = 4;
        let refused = damage.refused.iter().take(MOST);
        let refused: Vec<&str> = refused.map(String::as_str).collect();
        let more = if damage.refused.len() > MOST {
            ", …"
        } else {
            ""
        };
        let refused = format!("{}{more}", refused.join(", "));
        self.notify((self.words().damaged)(&refused, damage.aside.as_deref()));
    }
}
