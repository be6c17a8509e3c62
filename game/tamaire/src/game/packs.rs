//! Packs: adding their levels to those of the player, and saving all levels of the player as one.

use super::sharing::foreign_id;
use super::{Game, Screen};
use crate::platform::MOST_LEVELS;
use std::sync::Arc;
use tamaire_play::daily::is_daily;
use tamaire_play::level::LevelError;
use tamaire_play::{Level, Pack, pack, shortened};

/// Maximum number of refused files that a message names.
const MOST_NAMED: usize = 4;
/// Maximum length of the reason why a file was refused [characters].
const LETTERS: usize = 120;

impl Game {
    /// Adds the levels of a pack to those of the player, shows them, and tells what was added and what was not. A
    /// level that the game has is not added again.
    pub(super) fn open_pack(&mut self, pack: Result<Pack, LevelError>) {
        let Pack { levels, refused } = match pack {
            Ok(pack) => pack,
            Err(error) => return self.notify((self.words().level_error)(&error)),
        };
        // A stored level that is still being read is one that the game has, too.
        for news in self.files.await_levels() {
            self.tell(news);
        }
        let (said, words) = (self.words(), self.making());
        let told = |(name, error): &(String, LevelError)| refusal(name, &(said.level_error)(error));
        let mut refused: Vec<String> = refused.iter().map(told).collect();
        let (first, mut known) = (self.levels.len(), 0);
        let mut room = MOST_LEVELS.saturating_sub(self.own_levels().count());
        for level in levels {
            if self.has_scene_of(&level) {
                known += 1;
            } else if room == 0 {
                refused.push(refusal(&level.id, &(words.own_full)(MOST_LEVELS)));
            } else {
                room -= 1;
                self.add_own(level);
            }
        }
        let added = self.levels.len() - first;
        if added + known > 0 {
            self.chosen = if added > 0 { first } else { self.chosen };
            self.go(Screen::Levels);
            self.notify(match added {
                0 => words.pack_known.to_string(),
                _ => (words.pack_added)(added),
            });
        }
        if !refused.is_empty() {
            let named = refused.iter().take(MOST_NAMED).cloned();
            let more = (refused.len() > MOST_NAMED).then(|| "…".to_string());
            let files: Vec<String> = named.chain(more).collect();
            self.notify((words.pack_refused)(&files.join(" / ")));
        }
    }

    /// Saves all levels of the player as a pack, and tells where.
    pub fn save_pack(&mut self) {
        let levels: Vec<Arc<Level>> = self.own_levels().cloned().collect();
        if !levels.is_empty() {
            self.files.save_pack(levels);
        }
    }

    /// Whether the player has made or added a level.
    pub fn has_own_levels(&self) -> bool {
        self.own_levels().next().is_some()
    }

    fn own_levels(&self) -> impl Iterator<Item = &Arc<Level>> {
        let own = (0..self.levels.len()).filter(|&index| self.is_own(index));
        own.map(|index| &self.levels[index])
    }

    /// Whether the player has as many levels as are read at the start.
    pub(super) fn has_all_own_levels(&self) -> bool {
        self.own_levels().count() >= MOST_LEVELS
    }

    /// Whether the game has the level, perhaps under another id.
    fn has_scene_of(&self, level: &Level) -> bool {
        let mut scenes = self.levels.iter().map(|known| known.scene());
        scenes.any(|scene| scene == level.scene())
    }

    /// Stores a level under an id that is free.
    pub(super) fn add_own(&mut self, mut level: Level) {
        if is_daily(&level) {
            level.id = format!("sent-{}", level.id);
        }
        level.id = pack::free_id(&foreign_id(&level.id), |id| self.is_taken(id));
        let level = Arc::new(level);
        self.levels.push(level.clone());
        self.files.keep_level(level);
    }

    /// Whether a level has this id. Some file systems do not distinguish upper and lower case.
    pub(super) fn is_taken(&self, id: &str) -> bool {
        let removed = self.removed.iter().map(|(level, _)| level);
        let known = self.levels.iter().chain(removed);
        let mut ids = known.map(|level| level.id.to_lowercase());
        ids.any(|known| known == id.to_lowercase()) || self.files.level_text(id).is_some()
    }
}

/// Returns the name of a refused file and the reason, which may begin with the name.
fn refusal(name: &str, reason: &str) -> String {
    let reason = shortened(reason, LETTERS);
    match reason.starts_with(name) {
        true => reason,
        false => format!("{}: {reason}", shortened(name, LETTERS)),
    }
}
