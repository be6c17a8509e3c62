//! Rounds and levels that travel as the end of an address.

use super::{Game, Screen};
use crate::platform::address_of_page;
use std::sync::Arc;
use tamaire_play::link::{Link, LinkError, address};
use tamaire_play::{Replay, ReplayError};

impl Game {
    /// Puts a link to the round as it was played so far on the clipboard.
    pub fn copy_link(&mut self) {
        let link = self.bout.round().replay().link();
        self.copy(link);
    }

    /// The same of a round that was kept: fit for [`Game::open_kept`].
    pub fn copy_link_of(&mut self, replay: Arc<Replay>) -> Result<(), ReplayError> {
        self.copy(replay.link());
        Ok(())
    }

    /// Puts a link to the level that is played on the clipboard.
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

    /// Tells whether the clipboard took what was put on it.
    pub fn tell_of_copy(&mut self, took: bool) {
        self.notify(match took {
            true => self.words().link_copied.to_string(),
            false => self.words().link_refused.to_string(),
        });
    }

    /// Opens what a link brings: a level is played, a round is offered to be watched or raced.
    pub fn open_link(&mut self, link: &str) {
        match Link::read(link) {
            Ok(Link::Level(level)) => self.offer(level),
            Ok(Link::Round(replay)) => match replay.level() {
                Ok(level) => {
                    self.offered = Some((Arc::new(replay), Arc::new(level)));
                    self.attract();
                    self.go(Screen::Offered);
                }
                Err(error) => self.notify((self.words().replay_error)(&error)),
            },
            Err(error) => self.notify((self.words().link_error)(&error)),
        }
    }
}
