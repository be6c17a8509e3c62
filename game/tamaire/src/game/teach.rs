//! Hints for players who do not know the controls yet, or who are stuck.

use super::lesson::Seen;
use super::{Game, Screen};
use crate::input::{Action, InputMethod};
use crate::journey::chapter_of;
use crate::records::{Record, WishName};
use crate::session::Session;
use fuwafuwa::Vec3;
use tamaire_play::Way;
use tamaire_play::level::PATH;

impl Game {
    /// Returns the hints about moving the hand, raising it and turning the camera, each with whether to show
    /// it. A hint disappears when its action was done, and returns when the player is stuck. The texts suit
    /// the input method used last. There are no hints in 2D and outside of a round. With scanning on, the only
    /// hint explains the switch.
    pub fn lesson(&self) -> Vec<(String, bool)> {
        if self.settings.scanning.is_on() {
            let is_played = self.screen() == Screen::Play && self.bout.session.is_played();
            let told = self.words().how_by_switch.to_string();
            return Vec::from_iter(is_played.then_some((told, !self.controls.scan.is_known())));
        }
        // In the element view the mouse wheel cuts bodies open instead of raising the hand, so the hints
        // would be wrong.
        if !self.is_played_in_space() || self.bout.elements.is_some() {
            return Vec::new();
        }
        let on_stick = self.controls.means == InputMethod::Stick;
        let names = [
            &[Action::Up, Action::Left, Action::Down, Action::Right][..],
            &[Action::Raise, Action::Lower],
            &[Action::TurnLeft, Action::TurnRight],
        ];
        let bindings = &self.settings.bindings;
        let names = names.map(|actions| bindings.first_names(actions, on_stick));
        let lines = (self.words().how_in_space)(self.controls.means, &names);
        lines.into_iter().zip(self.bout.lesson.missing()).collect()
    }

    /// Updates the tutorial with the movements of this frame.
    pub(super) fn learn(&mut self, seconds: f32) {
        if self.screen() != Screen::Play || !self.bout.session.is_played() {
            return;
        }
        let round = self.bout.round();
        let gone = match self.controls.players.wanted(0) {
            Some(wanted) => wanted - round.start(0),
            None => Vec3::ZERO,
        };
        let progress = round.progress();
        let is_open = round.has_basket() && progress.outcome.is_none();
        let [right, up] = self.bout.camera.orbit_angles();
        let is_stuck = self.bout.lesson.see(Seen {
            gone,
            turned: right.abs().max(up.abs()),
            within: is_open.then_some(progress.within),
            has_begun: round.clock_ticks() > 0,
            seconds,
        });
        if is_stuck {
            self.bout.effects.remind();
        }
        let is_won = |record: &Record| record.is_won();
        let is_known = self
            .records
            .of_level(self.bout.round().level())
            .is_some_and(is_won);
        let is_due = is_open && !is_known && self.bout.lesson.wants_first_move();
        if is_due && self.bout.session.show_first_move() {
            self.notify(self.words().first_move.to_string());
        }
    }

    /// Returns whether a way to win the level of the round may be shown: the level is on the path, and the player has
    /// won it or has given it up four times. Not in calm mode, because things may tear.
    pub fn may_show_way(&self) -> bool {
        let level = self.bout.round().level();
        let is_built_in = chapter_of(level).is_some() && self.listed(level).is_some();
        let record = self.records.of_level(level);
        let is_due = record.is_some_and(Record::is_won) || self.bout.lesson.may_see_way();
        is_built_in && is_due && !self.settings.calm
    }

    /// Returns the way to show: one that reaches a goal that the player has not reached, if there is one.
    fn way_to_show(&self) -> Option<Way> {
        let level = self.bout.round().level();
        let known = PATH.iter().find(|known| known.id == level.id)?;
        let record = self.records.of_level(level);
        let wishes = &level.game().wish;
        let is_open = |number: &usize| {
            let wish = number.checked_sub(1).and_then(|index| wishes.get(index));
            wish.is_some_and(|wish| {
                record.is_none_or(|record| !record.wishes.contains(&WishName::of(wish)))
            })
        };
        let ways = known.ways().way;
        let other = ways.iter().find(|way| way.wishes.iter().any(is_open));
        other.or(ways.first()).cloned()
    }

    /// Shows a way to win the level of the round; see [`Self::may_show_way`].
    pub fn show_way(&mut self) {
        let Some(way) = self.way_to_show().filter(|_| self.may_show_way()) else {
            return;
        };
        // The way is made for the level without assists, which is the one in the list.
        if let Some(index) = self.listed(self.bout.round().level()) {
            self.begin(Session::of_way(self.levels[index].clone(), &way));
        }
    }

    fn is_played_in_space(&self) -> bool {
        self.screen() == Screen::Play && self.bout.is_played_in_space()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::journey::Lock;
    use crate::platform::{Files, Sound};
    use app_shell::Pads;
    use fuwafuwa::DEFAULT_TICK;
    use tamaire_play::{AnyRound, InputFrame};

    fn game() -> Game {
        Game::new(Files::nowhere(), Sound::none(), Pads::none())
    }

    fn place(game: &Game, id: &str) -> usize {
        let place = game.levels.iter().position(|level| level.id == id);
        place.expect("the level is built in")
    }

    /// Gives the current round up after a push.
    fn give_up(game: &mut Game) {
        let push = |round: &AnyRound| InputFrame::towards(round.start(0) + Vec3::splat(0.2));
        let session = &mut game.bout.session;
        session.advance(0.02, &game.clock, push, |_| {});
        game.retry();
    }

    #[test]
    fn ghost_shows_the_first_move_after_two_failures() {
        let mut game = game();
        let hop = place(&game, "hop");
        game.start(hop);
        let is_shown = |game: &mut Game| {
            game.update(0.02);
            game.bout.session.ghost().is_some()
        };
        assert!(!is_shown(&mut game));
        give_up(&mut game);
        assert!(!is_shown(&mut game));
        give_up(&mut game);
        assert!(is_shown(&mut game));
        let said = game.words().first_move;
        assert!(game.notices.iter().any(|notice| notice.text == said));
        // A level without a hint has no ghost.
        let classic = place(&game, "classic");
        game.start(classic);
        give_up(&mut game);
        give_up(&mut game);
        assert!(!is_shown(&mut game));
    }

    #[test]
    fn a_way_is_shown_after_four_failures_or_a_win_and_prefers_a_missing_goal() {
        let mut game = game();
        let hop = place(&game, "hop");
        game.start(hop);
        for _ in 0..4 {
            assert!(!game.may_show_way());
            give_up(&mut game);
        }
        let ways = PATH
            .iter()
            .find(|level| level.id == "hop")
            .unwrap()
            .ways()
            .way;
        assert!(game.may_show_way());
        assert_eq!(game.way_to_show().as_ref(), Some(&ways[0]));
        game.show_way();
        assert!(game.bout.session.shows_way());
        // A way ends with its win, which counts for nothing.
        for _ in 0..60 * 40 {
            game.update(DEFAULT_TICK);
        }
        assert!(game.bout.session.is_over());
        assert!(game.records.of("hop").is_none());
        // Then it is the player's turn, who may see it again.
        game.leave_round();
        assert!(game.bout.session.is_played() && game.screen() == Screen::Play);
        assert!(game.may_show_way());
        game.settings.calm = true;
        assert!(!game.may_show_way());
        game.settings.calm = false;

        let level = game.levels[hop].clone();
        let mut round = AnyRound::new(level.clone());
        let outcome = ways[0].play(&mut round, None).unwrap();
        game.records.note(&level, &outcome, 0);
        game.start(hop);
        let shown = game.way_to_show().unwrap();
        assert!(
            shown
                .wishes
                .iter()
                .any(|wish| !ways[0].wishes.contains(wish))
        );
        let classic = place(&game, "classic");
        game.start(classic);
        assert!(!game.may_show_way(), "not on the path");
    }

    #[test]
    fn calm_mode_closes_levels_in_which_things_must_tear() {
        let mut game = game();
        let [hop, halves] = ["hop", "halves"].map(|id| place(&game, id));
        let is_starred = |lock| matches!(lock, Some(Lock::Stars { .. }));
        assert!(is_starred(game.lock_of_level(halves)));
        game.settings.calm = true;
        assert_eq!(game.lock_of_level(halves), Some(Lock::Calm));
        let nest = place(&game, "make-a-nest");
        assert_eq!(game.lock_of_level(nest), None, "all chapters are open");
        game.start(hop);
        let materials = game.bout.round().level().scene().materials();
        assert!({ materials.iter() }.all(|material| material.strength.is_infinite()));
    }
}
