//! The ending: as at the end of a sports day, all that was won is counted aloud.

use super::{Game, Screen};
use crate::journey::chapter_of;
use crate::records::Record;
use tamaire_sound::{Cue, Menu, Route};

/// Time before the first count [s].
const FIRST: f32 = 1.5;
/// Time from one count to the next [s].
const EACH: f32 = 0.45;
/// Time from the last count to the thanks [s].
const LAST: f32 = 1.2;

/// Progress of the ending.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct Ending {
    /// Time since it began [s].
    seconds: f32,
    /// Whether it waits to be shown, because the last level of the path has just been won.
    pub(super) is_due: bool,
}

impl Ending {
    /// Time since the ending began, in counts: 1 at the first count, 2 at the second one.
    pub fn counts(self) -> f32 {
        ((self.seconds - FIRST) / EACH + 1.0).max(0.0)
    }

    /// Returns whether `all` levels have been counted and the thanks are shown.
    pub fn is_counted(self, all: usize) -> bool {
        self.seconds >= end(all)
    }
}

/// Time at which all levels have been counted [s].
fn end(all: usize) -> f32 {
    FIRST + EACH * all as f32 + LAST
}

impl Game {
    /// Returns the indices in [`Self::levels`] of the levels of the path, in order.
    pub fn path(&self) -> Vec<usize> {
        let all = 0..self.levels.len();
        all.filter(|&index| !self.is_own(index) && chapter_of(&self.levels[index]).is_some())
            .collect()
    }

    /// Whether the player has won every level of the path.
    pub fn has_won_path(&self) -> bool {
        let is_won = |&index: &usize| {
            let record = self.records.of_level(&self.levels[index]);
            record.is_some_and(Record::is_won)
        };
        let path = self.path();
        !path.is_empty() && path.iter().all(is_won)
    }

    /// Shows the ending.
    pub fn show_ending(&mut self) {
        self.ending = Ending::default();
        self.go(Screen::Ending);
    }

    /// Counts everything at once.
    pub fn skip_ending(&mut self) {
        self.ending.seconds = end(self.path().len());
    }

    /// Advances the ending, if it is shown.
    pub(super) fn count_up(&mut self, seconds: f32) {
        if self.screen() != Screen::Ending {
            return;
        }
        let all = self.path().len();
        let before = self.ending;
        self.ending.seconds += seconds;
        let counted = |ending: Ending| (ending.counts() as usize).min(all);
        if counted(self.ending) > counted(before) {
            self.sound.play(Cue::Menu(Menu::Move));
        }
        if self.ending.is_counted(all) && !before.is_counted(all) {
            self.sound.play(Cue::Won(Route::Mix));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::platform::{Files, Sound};
    use app_shell::Pads;
    use tamaire_play::Outcome;
    use tamaire_play::level::PATH;

    #[test]
    fn ending_follows_the_last_missing_win() {
        let mut game = Game::new(Files::nowhere(), Sound::none(), Pads::none());
        let last = PATH
            .iter()
            .find(|level| level.id == "walk-the-dog")
            .unwrap();
        let won = Outcome {
            ticks: 600,
            route: tamaire_play::Route::Squeeze,
            kept: 1.0,
            inside: 1.0,
            pieces: 1,
            lost: 0,
            broken: 0,
            torn: 0,
        };
        for index in game.path() {
            let level = game.levels[index].clone();
            if level.id != last.id {
                game.records.note(&level, &won, 0);
            }
        }
        assert!(!game.has_won_path());
        let place = game.levels.iter().position(|level| level.id == last.id);
        game.start(place.unwrap());
        let way = &last.ways().way[0];
        for _ in 0..1200 {
            let session = &mut game.bout.session;
            session.advance(0.02, &game.clock, |round| way.frame(round.ticks()), |_| {});
            if session.is_over() {
                break;
            }
        }
        game.update(0.02);
        assert!(game.has_won_path() && game.ending.is_due);
        game.start_next();
        assert_eq!(game.screen(), Screen::Ending);
        let all = game.path().len();
        let mut counted = Vec::new();
        while !game.ending.is_counted(all) {
            game.update(0.1);
            counted.push(game.ending.counts() as usize);
        }
        counted.dedup();
        assert!(
            (1..=all).all(|number| counted.contains(&number)),
            "{counted:?}"
        );
        // The next level follows as usual the next time.
        game.start_next();
        assert_ne!(game.screen(), Screen::Ending);
    }
}
