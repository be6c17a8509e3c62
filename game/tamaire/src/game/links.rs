//! Links to rounds and levels, which are the fragment of a web address.

use super::{Game, Screen};
use crate::platform::address_of_page;
use std::sync::Arc;
use tamaire_play::link::{Link, LinkError, address};
use tamaire_play::{Replay, ReplayError};

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

    fn copy(&mut self, link: Result<String, LinkError>) {
        match link {
            Ok(link) => self.copied = Some(address(&address_of_page(), &link)),
            Err(error) => self.notify((self.words().link_error)(&error)),
        }
    }

    /// Tells the player whether copying to the clipboard worked.
    pub fn tell_of_copy(&mut self, took: bool) {
        self.notify(match took {
            true => self.words().link_copied.to_string(),
            false => self.words().link_refused.to_string(),
        });
    }

    /// Opens a link: a level is started, a round is offered to watch or race.
    pub fn open_link(&mut self, link: &str) {
        match Link::read(link) {
            Ok(Link::Level(level)) => self.offer(*level),
            Ok(Link::Round(replay)) => match replay.level() {
                Ok(level) => {
                    self.offered = Some((Arc::from(replay), Arc::new(level)));
                    self.attract();
                    self.go(Screen::Offered);
                }
                Err(error) => self.notify((self.words().replay_error)(&error)),
            },
            Err(error) => self.notify((self.words().link_error)(&error)),
        }
    }
}
