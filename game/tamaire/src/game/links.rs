//! Links to rounds and levels, which are the fragment of a web address.

use super::{Game, Screen};
use crate::platform::{MOST_LEVELS, address_of_page};
use std::sync::Arc;
use tamaire_play::link::{Link, LinkError, address};
use tamaire_play::{Level, Replay, ReplayError};

impl Game {
    /// Copies a link to the round up to now to the clipboard.
    pub fn copy_link(&mut self) {
        let link = self.bout.round().replay().link();
        self.copy(link);
    }

    /// Copies a link to a saved round to the clipboard. For use with [`Game::open_kept`].
    pub fn copy_link_of(&mut self, replay: Arc<Replay>) -> Result<(), ReplayError> {
        self.copy(replay.link());
        Ok(())
    }

    /// Copies a link to the current level to the clipboard.
    pub fn copy_link_to_level(&mut self) {
        let link = self.bout.round().level().link();
        self.copy(link);
    }

    pub(super) fn copy(&mut self, link: Result<String, LinkError>) {
        match link {
            Ok(link) => self.copied = Some(address(&address_of_page(), &link)),
            Err(error) => self.notify((self.words().link_error)(&error)),
        }
    }

    fn show_offer(&mut self, replay: Option<Arc<Replay>>, level: Level) {
        self.offered = Some((replay, Arc::new(level)));
        self.attract();
        self.go(Screen::Offered);
    }

    /// Returns the index in [`Game::levels`] of a level that the game has, perhaps under another id or without its assists.
    fn place_of_known(&self, level: &Level) -> Option<usize> {
        self.listed(level).or_else(|| self.place_of_scene(level))
    }

    /// Plays the level that is offered, and keeps it.
    pub fn play_offered(&mut self) {
        let Some((_, level)) = self.offered.clone() else {
            return;
        };
        let known = self.place_of_known(&level);
        if known.is_none() && self.has_all_own_levels() {
            return self.notify((self.making().own_full)(MOST_LEVELS));
        }
        self.offered = None;
        let index = known.unwrap_or_else(|| self.add_own(Level::clone(&level)));
        self.start(index);
    }

    /// Tells the player whether copying to the clipboard worked.
    pub fn tell_of_copy(&mut self, took: bool) {
        self.notify(match took {
            true => self.words().link_copied.to_string(),
            false => self.words().link_refused.to_string(),
        });
    }

    /// Opens a link: a level that the game has is started; another one, and a round, is offered.
    pub fn open_link(&mut self, link: &str) {
        // The link may be one to the level in the editor.
        if self.screens.has(Screen::Editor) {
            self.keep_replaced_level();
        }
        match Link::read(link) {
            Ok(Link::Level(level)) => match self.place_of_known(&level) {
                Some(index) => self.start(index),
                None => self.show_offer(None, *level),
            },
            Ok(Link::Round(replay)) => match replay.level() {
                Ok(level) => self.show_offer(Some(Arc::from(replay)), level),
                Err(error) => self.notify((self.words().replay_error)(&error)),
            },
            Err(error) => self.notify((self.words().link_error)(&error)),
        }
    }
}
