//! Saving and loading, and the messages about them.

use super::{Game, RemovedLevel, Screen};
use crate::platform::{Damage, Entry, Kind, Location, StorageEvent};
use std::sync::Arc;
use tamaire_play::{Level, Replay, ReplayError};

/// Entry of the list of levels.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum ListEntry {
    /// Level, by its index in [`Game::levels`].
    Level(usize),
    /// Removed level, by its index in the order of the removals.
    Removed(usize),
}

impl Game {
    /// Schedules the settings to be saved once they no longer change. If writing fails, a message is shown,
    /// and the settings stay in effect until the game ends.
    pub fn keep_settings(&mut self) {
        self.files.keep_settings(&self.settings);
    }

    /// Saves a replay of the round up to now.
    pub fn keep_replay(&mut self) {
        self.files.save_replay(self.bout.round().replay());
    }

    /// Keeps the level in the editor, saves a replay of a round that is being played and returns to the title, and writes
    /// all pending data. Called when the GPU is lost.
    pub fn rescue(&mut self) {
        self.keep_silently();
        if self.is_in_round() {
            self.keep_replay();
            self.go(Screen::Title);
        }
        self.files.close();
    }

    /// Keeps the level in the editor, and writes all pending data at the end of the program.
    pub fn close(&mut self) {
        self.keep_silently();
        self.files.close();
    }

    /// Saves a photo of the end of the round.
    pub fn keep_photo(&mut self) {
        let replay = self.bout.round().replay();
        self.files.save_picture(Kind::Photo, Arc::new(replay));
    }

    /// Saves the last seconds of the round as an animation.
    pub fn keep_clip(&mut self) {
        let replay = self.bout.round().replay();
        self.files.save_picture(Kind::Clip, Arc::new(replay));
    }

    /// Saves the last seconds of a saved round as an animation. For use with [`Game::open_kept`].
    pub fn keep_clip_of(&mut self, replay: Arc<Replay>) -> Result<(), ReplayError> {
        self.files.save_picture(Kind::Clip, replay);
        Ok(())
    }

    /// Returns the level that was removed last, unless a card in the list stands for it.
    pub fn removed_level(&self) -> Option<&Level> {
        let last = self.removed.last().filter(|removed| !removed.is_shown);
        last.map(|removed| removed.level.as_ref())
    }

    /// Returns the name of a removed level, given by its index in the order of the removals.
    pub fn removed_name(&self, removed: usize) -> &str {
        let level = &self.removed[removed].level;
        self.settings.language.of(&level.game().name)
    }

    /// Returns the levels in the order of the list, with the removed ones in their places.
    fn with_removed(&self) -> Vec<ListEntry> {
        let mut entries: Vec<ListEntry> = (0..self.levels.len()).map(ListEntry::Level).collect();
        for (index, removed) in self.removed.iter().enumerate().rev() {
            let place = removed.place.min(entries.len());
            entries.insert(place, ListEntry::Removed(index));
        }
        entries
    }

    /// Returns the player's own levels in the order of the list, and those removed ones for which it shows a card.
    pub fn own_entries(&self) -> Vec<ListEntry> {
        let mut entries = self.with_removed();
        entries.retain(|entry| match *entry {
            ListEntry::Level(index) => self.is_own(index),
            ListEntry::Removed(index) => self.removed[index].is_shown,
        });
        entries
    }

    /// Forgets the cards of removed levels, after the list was left.
    pub(super) fn forget_removed_cards(&mut self) {
        for removed in &mut self.removed {
            removed.is_shown = false;
        }
    }

    /// Brings back the level that was removed last, to its place in the list.
    pub fn bring_back(&mut self) {
        if let Some(last) = self.removed.len().checked_sub(1) {
            self.bring_back_removed(last);
        }
    }

    /// Brings back a removed level, given by its index in the order of the removals, to its place in the list.
    pub fn bring_back_removed(&mut self, removed: usize) {
        let mut order = self.with_removed();
        let Some(at) = order
            .iter()
            .position(|entry| *entry == ListEntry::Removed(removed))
        else {
            return;
        };
        let before = order[..at].iter();
        let place = before
            .filter(|entry| matches!(entry, ListEntry::Level(_)))
            .count();
        let RemovedLevel { level, text, .. } = self.removed.remove(removed);
        self.files.keep_level_text(&level.id, text);
        // The places of the others count the level again.
        order[at] = ListEntry::Level(place);
        for index in 0..self.removed.len() {
            let number = index + usize::from(index >= removed);
            let mut left = order.iter();
            let found = left.position(|entry| *entry == ListEntry::Removed(number));
            if let Some(found) = found {
                self.removed[index].place = found;
                order.remove(found);
            }
        }
        let double = self.levels.iter().position(|known| known.id == level.id);
        let place = match double {
            Some(double) => {
                self.levels.remove(double);
                place - usize::from(double < place)
            }
            None => place,
        };
        let place = place.min(self.levels.len());
        self.levels.insert(place, level);
        if self.chosen >= place {
            self.chosen += 1;
        }
    }

    /// Removes a level from the list and deletes its file. The level must not be built in. Its records stay, and
    /// [`Game::bring_back`] undoes it.
    pub fn take_out(&mut self, index: usize) {
        let level = self.levels.remove(index);
        // A text that is still being written may be older than the level.
        let is_current = |text: &String| {
            Level::read_kept(&level.id, text.as_bytes())
                .is_ok_and(|read| read.scene() == level.scene())
        };
        let text = self.text_of(&level).filter(is_current);
        let text = text.or_else(|| level.text_to_keep().ok());
        self.files.remove_level(&level.id);
        self.removed.extend(text.map(|text| RemovedLevel {
            level,
            text,
            place: index,
            is_shown: self.screen() == Screen::Levels,
        }));
        if self.chosen >= index {
            self.chosen = self.chosen.saturating_sub(1);
        }
    }

    /// Gives a saved round to the player as a file, as a download in a browser. Not supported on a desktop.
    pub fn hand_out(&mut self, saved: &Entry) {
        if let Err(error) = self.files.hand_out(&saved.name) {
            self.tell(StorageEvent::Failed(error.to_string()));
        }
    }

    /// Deletes a saved round.
    pub fn delete(&mut self, saved: &Entry) {
        if let Err(error) = self.files.delete(&saved.name) {
            self.tell(StorageEvent::Failed(error.to_string()));
        }
        self.shelf.refresh(&self.files);
    }

    /// Opens the folder of the file saved at `location` in the system's file manager.
    pub fn open_folder_of(&mut self, location: &Location) {
        if let Err(error) = self.files.open_folder_of(location) {
            self.notify(format!("{} {error}", self.words().folder_not_opened));
        }
    }

    /// Keeps the level in the editor and writes all pending data, for a page that may be closed without notice.
    pub fn flush(&mut self) {
        self.keep_silently();
        self.finish_writing();
    }

    /// Writes all pending data and waits until it is written.
    pub fn finish_writing(&mut self) {
        for news in self.files.finish() {
            self.tell(news);
        }
    }

    /// Shows the result of a file operation to the player.
    pub(super) fn tell(&mut self, news: StorageEvent) {
        match news {
            // The stored level is ignored: the player has opened a newer one with this id in the meantime.
            StorageEvent::Level(level) if self.levels.iter().any(|known| known.id == level.id) => {}
            StorageEvent::Level(level) => self.levels.push(level),
            StorageEvent::Damaged(damage) => self.tell_of(damage),
            StorageEvent::Saved(location) => {
                self.shelf.refresh(&self.files);
                let (file, folder) = file_and_folder(&location);
                let text = (self.words().saved)(&file, folder.as_deref());
                // The system's file manager cannot be operated with a single switch.
                match self.files.has_folders() && !self.settings.scanning.is_on() {
                    true => self.notices.tell_of_saved(&text, location),
                    false => self.notify(text),
                }
            }
            StorageEvent::Failed(reason) => {
                self.notify(format!("{} {reason}", self.words().not_written));
            }
            StorageEvent::Full => self.notify(self.words().full.to_string()),
        }
    }

    /// Tells the player which stored data could not be used.
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

/// Returns the name of a saved file and its folder, if it has one, as texts for the player. The middle of a long folder is
/// left out.
fn file_and_folder(location: &Location) -> (String, Option<String>) {
    /// Maximum number of characters at each end of a folder.
    const ENDS: usize = 22;
    let text = |part: &std::ffi::OsStr| part.to_string_lossy().into_owned();
    let file = location.file_name().unwrap_or(location.as_os_str());
    let folder = location
        .parent()
        .filter(|folder| !folder.as_os_str().is_empty());
    let folder = folder.map(|folder| {
        let whole = text(folder.as_os_str());
        let letters: Vec<char> = whole.chars().collect();
        match letters.len() > 2 * ENDS {
            true => {
                let (first, last) = (&letters[..ENDS], &letters[letters.len() - ENDS..]);
                first.iter().chain(&['…']).chain(last).collect()
            }
            false => whole,
        }
    });
    (text(file), folder)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn saved_file_is_named_with_its_folder_shortened_in_the_middle() {
        for (path, file, folder) in [
            ("classic-1", "classic-1", None),
            (
                "/home/mika/levels/cat.toml",
                "cat.toml",
                Some("/home/mika/levels"),
            ),
            (
                "/home/mika/.local/share/applications/tamaire/games/levels/cat.toml",
                "cat.toml",
                Some("/home/mika/.local/shar…s/tamaire/games/levels"),
            ),
        ] {
            let expected = (file.to_string(), folder.map(String::from));
            assert_eq!(file_and_folder(&Location::from(path)), expected);
        }
    }
}
