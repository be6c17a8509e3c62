//! Packs: adding their levels to those of the player, and saving all levels of the player as one.

use super::sharing::{foreign_id, is_made_here};
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
            if self.place_of_scene(&level).is_some() {
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

    pub(super) fn own_levels(&self) -> impl Iterator<Item = &Arc<Level>> {
        let own = (0..self.levels.len()).filter(|&index| self.is_own(index));
        own.map(|index| &self.levels[index])
    }

    /// Whether the player has as many levels as are read at the start.
    pub(super) fn has_all_own_levels(&self) -> bool {
        self.own_levels().count() >= MOST_LEVELS
    }

    /// Returns the index in [`Game::levels`] of a level with the same scene, perhaps under another id.
    pub(super) fn place_of_scene(&self, level: &Level) -> Option<usize> {
        let mut scenes = self.levels.iter().map(|known| known.scene());
        scenes.position(|scene| scene == level.scene())
    }

    /// Returns the index in [`Game::levels`] of an earlier version of a level from a file. Levels of several makers have
    /// the ids of levels that were made here, so these do not tell that a level is an earlier version. Nor is a level of another
    /// maker one.
    pub(super) fn place_of_earlier(&self, level: &Level) -> Option<usize> {
        if is_made_here(&level.id) {
            return None;
        }
        let (id, game) = (stored_id(level), level.game());
        let is_by_maker = |known: &Level| known.game().made_by == game.made_by;
        let own = (0..self.levels.len()).filter(|&index| self.is_own(index));
        let own = own.filter(|&index| is_by_maker(&self.levels[index]));
        let after_id = |index: usize| {
            // Earlier versions of the game kept the ending of the file in the id.
            let known = &self.levels[index].id;
            known
                .strip_suffix(".toml")
                .unwrap_or(known)
                .strip_prefix(&id)
        };
        // If a level of another maker has the id, the earlier version has a number after it. A level of the same maker may have
        // such an id, too, but then another name.
        let is_numbered = |index: usize| {
            let number = after_id(index).and_then(|after| after.strip_prefix('-'));
            let is_number = number.is_some_and(|number| number.parse::<usize>().is_ok());
            is_number && game.made_by.is_some() && self.levels[index].game().name == game.name
        };
        let mut exact = own.clone().filter(|&index| after_id(index) == Some(""));
        let mut numbered = own.filter(|&index| is_numbered(index));
        exact.next().or_else(|| numbered.next())
    }

    /// Stores a level in place of another own one, under its id.
    pub(super) fn replace_own(&mut self, index: usize, mut level: Level) {
        level.id.clone_from(&self.levels[index].id);
        let level = Arc::new(level);
        self.levels[index] = level.clone();
        self.files.keep_level(level);
    }

    /// Stores a level under an id that is free. Returns its index in [`Game::levels`].
    pub(super) fn add_own(&mut self, mut level: Level) -> usize {
        level.id = pack::free_id(&stored_id(&level), |id| self.is_taken(id));
        let level = Arc::new(level);
        self.levels.push(level.clone());
        self.files.keep_level(level);
        self.levels.len() - 1
    }

    /// Whether a level has this id. Some file systems do not distinguish upper and lower case.
    pub(super) fn is_taken(&self, id: &str) -> bool {
        let removed = self.removed.iter().map(|removed| &removed.level);
        let known = self.levels.iter().chain(removed);
        let mut ids = known.map(|level| level.id.to_lowercase());
        ids.any(|known| known == id.to_lowercase()) || self.files.level_text(id).is_some()
    }
}

/// Returns the id under which a level from elsewhere is stored, if it is free: without the ending of level files, which its
/// file gets again. A level of the day that was sent does not take the place of today's.
fn stored_id(level: &Level) -> String {
    let id = level.id.strip_suffix(".toml");
    let id = id.filter(|id| !id.is_empty()).unwrap_or(&level.id);
    match is_daily(level) {
        true => format!("sent-{id}"),
        false => foreign_id(id),
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
