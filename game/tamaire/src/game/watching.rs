//! Watching replays: position and speed.

use super::Game;
use crate::look::Effects;
use fuwafuwa::DEFAULT_TICK;

/// Time by which a key or a stick winds a replay [s].
const LEAP: f32 = 5.0;

/// Speeds at which a replay can be watched, relative to real time, with their names.
pub const SPEEDS: [(f32, &str); 4] = [(0.5, "½×"), (1.0, "1×"), (2.0, "2×"), (4.0, "4×")];

impl Game {
    /// Winds the replay on the screen to `tick`. Does nothing in a round that is played.
    pub fn wind_to(&mut self, tick: usize) {
        let bout = &mut self.bout;
        if bout
            .session
            .position()
            .is_some_and(|[here, _]| here != tick)
        {
            bout.session.wind_to(tick);
            // The effects belong to the moment before.
            bout.effects = { bout.session.start() }.map_or_else(Effects::default, Effects::resumed);
            bout.cheered = 0.0;
        }
    }

    /// Winds the replay on the screen by [`LEAP`], forwards or backwards. It does not reach the end, where the
    /// replay would close.
    pub(super) fn leap(&mut self, forwards: bool) {
        let Some([here, length]) = self.bout.session.position() else {
            return;
        };
        let leap = (LEAP / DEFAULT_TICK).round() as usize;
        self.wind_to(match forwards {
            true => (here + leap).min(length.saturating_sub(1)).max(here),
            false => here.saturating_sub(leap),
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::game::Screen;
    use crate::input::{Action, InputSource};
    use crate::platform::{Files, Sound};
    use app_shell::{Clock, Pads};
    use std::sync::Arc;
    use tamaire_play::{AnyRound, Bot, BotKind, Level};

    /// Returns a game that shows a replay of `ticks` ticks.
    fn watched(ticks: usize) -> Game {
        let mut game = Game::new(Files::nowhere(), Sound::none(), Pads::none());
        game.clock = Clock::of(|| 0.0);
        let mut round = AnyRound::new(Arc::new(Level::open("classic").unwrap()));
        round.play(&mut Bot::new(BotKind::Idle, 1), ticks);
        game.watch(Arc::new(round.replay())).unwrap();
        game
    }

    fn tick(game: &Game) -> u64 {
        game.bout.round().ticks()
    }

    #[test]
    fn speed_multiplies_ticks_of_a_replay_only() {
        for (speed, _) in SPEEDS {
            let mut game = watched(400);
            game.bout.watch_speed = speed;
            (0..60).for_each(|_| game.update(DEFAULT_TICK));
            let expected = 60.0 * speed;
            let found = tick(&game) as f32;
            assert!((found - expected).abs() <= 2.0, "{speed}: {found}");
        }
        let mut game = watched(10);
        game.bout.watch_speed = 4.0;
        game.start(0);
        (0..60).for_each(|_| game.update(DEFAULT_TICK));
        assert!(tick(&game) <= 60, "{}", tick(&game));
    }

    #[test]
    fn replay_can_be_wound_in_single_steps() {
        let mut game = watched(400);
        game.bout.stepping = true;
        game.wind_to(300);
        game.update(DEFAULT_TICK);
        assert_eq!(tick(&game), 300);
        // The faces of the bodies are there before the next step.
        assert_eq!(game.bout.effects.feelings.len(), 1);
        game.update(DEFAULT_TICK);
        assert_eq!(tick(&game), 300, "single steps go on");
    }

    #[test]
    fn keys_wind_replay_and_stop_before_its_end() {
        let mut game = watched(700);
        let mut press = |action, expected| {
            game.act(action, InputSource::Keys);
            game.update(0.0);
            assert_eq!(tick(&game), expected);
            assert_eq!(game.screen(), Screen::Play);
        };
        for (action, expected) in [
            (Action::Right, 300),
            (Action::Right, 600),
            (Action::Right, 699),
            (Action::Left, 399),
            (Action::Left, 99),
            (Action::Left, 0),
        ] {
            press(action, expected);
        }
    }
}
