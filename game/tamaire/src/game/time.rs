//! Progress of time: ticks, wins, and the end of replays.

use super::{Controls, CurrentRound, Game, Screen, heard};
use crate::haptics;
use crate::input::{Action, Bindings, Devices, Hands, InputMapping, Players, ScanAction};
use crate::settings::Quality;
use fuwafuwa::{DEFAULT_TICK, Vec3};
use tamaire_play::{AnyRound, InputFrame, PLAYERS};
use tamaire_sound::Cue;

/// Speed of slow motion, relative to normal speed.
const SLOW: f32 = 0.2;

impl Game {
    /// Advances the game by `seconds` [s].
    pub fn update(&mut self, seconds: f32) {
        self.time += f64::from(seconds);
        self.notices.pass(seconds);
        if self.screen() != Screen::Levels {
            self.forget_removed_cards();
        }
        let was_winding = self.bout.session.is_winding();
        let stands = matches!(self.screen(), Screen::Paused | Screen::Editor);
        let is_paused = stands || (self.bout.stepping && !was_winding);
        let runs = self.is_seen() && !is_paused;
        let is_watched = self.screen() == Screen::Play && !self.bout.session.is_played();
        let watch_speed = if is_watched {
            self.bout.watch_speed
        } else {
            1.0
        };
        let slowed = if self.bout.slow { SLOW } else { 1.0 };
        let pace = slowed * watch_speed * self.settings.speed;
        self.press_tool();
        if let Some(back) = self.homeward(seconds) {
            self.run_back(back);
            self.bout.effects.advance(seconds);
        } else if self.wants_rewind() {
            self.run_back(seconds);
            self.bout.effects.advance(seconds);
        } else if runs && self.screen() != Screen::Editor {
            // In the editor, the room does not run.
            if self.bout.session.is_rewinding() {
                self.end_rewind();
            }
            self.pass_ticks(seconds * pace);
            self.bout.effects.advance(seconds * pace);
        }
        if was_winding && !self.bout.session.is_winding() {
            self.show_wound();
        }
        if let Some(complaint) = self.bout.session.take_complaint() {
            self.notify((self.words().replay_error)(&complaint));
            if !self.bout.session.is_played() {
                self.attract();
                if self.screen() == Screen::Play {
                    self.leave_round();
                }
            }
        }
        let trouble = self.sound.trouble();
        if trouble != self.trouble {
            self.trouble = trouble;
            if let Some(trouble) = &self.trouble {
                self.notify(format!("{} ({trouble})", self.words().no_sound));
            }
        }
        for news in self.files.pass(seconds) {
            self.tell(news);
        }
        self.open_picked();
        if self.screen() == Screen::Replays {
            self.shelf.load_next_details(&self.files, &self.levels);
        }
        self.tell_if_slow();
        self.celebrate(seconds);
        self.count_up(seconds);
        self.learn(seconds);
        self.drive_forces(seconds);
        if self.screen() == Screen::Title && self.bout.session.is_over() {
            self.bout.cheered += seconds;
            if self.bout.cheered > 4.0 {
                self.bout.cheered = 0.0;
                self.attract();
            }
        }
        let arena = self.bout.round().level().arena();
        let hand = self.bout.round().hands()[0].position;
        self.bout
            .camera
            .follow(hand, arena, seconds, self.settings.reduced_motion);
        self.sound
            .update(&heard::soundscape(self), &self.settings.volumes());
    }

    /// Whether a player lets time run back.
    fn wants_rewind(&self) -> bool {
        let devices = &self.controls.devices;
        let is_held = devices.is_held(&self.settings.bindings, Action::Rewind)
            || devices.taken == Some(ScanAction::Rewind)
            || self.bout.is_rewind_pressed;
        let session = &self.bout.session;
        let can = session.is_rewinding() || session.seconds_to_rewind() > 0.0;
        is_held && can && self.screen() == Screen::Play && session.is_played()
    }

    /// Lets time run back by `seconds` [s].
    fn run_back(&mut self, seconds: f32) {
        let still = self.is_still();
        let bout = &mut self.bout;
        let (session, effects, camera) = (&mut bout.session, &mut bout.effects, &mut bout.camera);
        if session.run_back(seconds, &self.clock) {
            effects.process_tick(session.round(), camera, still);
        }
    }

    /// Lets time run forward again. The hands wait until the players reach for them, as at the start of a round.
    pub(super) fn end_rewind(&mut self) {
        self.bout.session.run_forward();
        self.bout.hopeless = None;
        let bout = &mut self.bout;
        bout.toys.follow(bout.session.round());
        // The switches are as they were, without a click.
        drop(heard::switched(
            bout.session.round(),
            &mut bout.switches,
            None,
        ));
        let is_space = self.bout.turn().is_some();
        self.controls.begin(is_space);
    }

    pub(super) fn pass_ticks(&mut self, seconds: f32) {
        let manner = InputMapping {
            sensitivity: self.settings.sensitivity,
            stick_sets_position: self.settings.stick_places,
            arena: self.bout.round().level().arena(),
            turn: self.bout.turn(),
        };
        let still = self.is_still();
        // Keys and sticks move the hand only during a round; in menus they move the focus. After a win, input
        // is ignored so that the body is not torn any more.
        let is_won = self.bout.round().progress().outcome.is_some();
        let in_round = self.screen() == Screen::Play && !is_won;
        let view = self.bout.view;
        let mut is_heard = false;
        let mut tears = [0.0f32; PLAYERS];
        let Self {
            bout:
                CurrentRound {
                    session,
                    effects,
                    camera,
                    switches,
                    ..
                },
            controls: Controls {
                players, devices, ..
            },
            settings,
            sound,
            clock,
            ..
        } = self;
        session.advance(
            seconds,
            clock,
            |round| {
                is_heard = true;
                if !in_round {
                    return InputFrame::default();
                }
                let frame = input_for(round, players, devices, &settings.bindings, &manner);
                // Clears the height by which the player has scrolled. Scrolling then counts once, however
                // many ticks are played in this frame.
                devices.lift = 0.0;
                frame
            },
            |round| {
                effects.process_tick(round, camera, still);
                for (player, size) in haptics::tears(round).into_iter().enumerate() {
                    tears[player] = size.max(tears[player]);
                }
                let switched = heard::switched(round, switches, view);
                for cue in heard::cues(round, view).into_iter().chain(switched) {
                    sound.play(cue);
                }
            },
        );
        if is_heard {
            devices.pointer = None;
        }
        if in_round {
            self.feel_tears(tears);
        }
    }

    /// Lets the stick or pad of each player feel the tears of the last ticks. `tears` are their sizes.
    fn feel_tears(&mut self, tears: [f32; PLAYERS]) {
        let tears = tears.into_iter().enumerate();
        for (player, size) in tears.filter(|(_, size)| *size > 0.0) {
            if let Some(device) = self.controls.players.device_of(player) {
                self.forces.tear(device, size);
            }
        }
    }

    /// Shows the bodies as they are after a replay was wound, before the next tick.
    fn show_wound(&mut self) {
        let still = self.is_still();
        let bout = &mut self.bout;
        bout.effects
            .process_tick(bout.session.round(), &mut bout.camera, still);
    }

    /// Whether effects are reduced, by choice or because drawing is slow.
    fn is_still(&self) -> bool {
        self.settings.reduced_motion || self.quality() == Quality::Low
    }

    /// Tells the player once if the machine is too slow for the round. The speed is known after two seconds.
    fn tell_if_slow(&mut self) {
        const LEAST_TICKS: u64 = 120;
        const LEAST: f64 = 0.8;
        let share = self.bout.session.bearable();
        let is_known = self.bout.round().ticks() >= LEAST_TICKS;
        if share < LEAST && is_known && self.screen() == Screen::Play && !self.bout.is_known_slow {
            self.bout.is_known_slow = true;
            self.notify((self.words().slow)(share));
        }
    }

    /// Records a win once, lets the body celebrate for a moment, and then shows the result.
    fn celebrate(&mut self, seconds: f32) {
        let Some(outcome) = self.bout.round().progress().outcome else {
            return;
        };
        if self.screen() != Screen::Play {
            return;
        }
        self.bout.cheered += seconds;
        if self.bout.session.is_played() && self.bout.won.is_none() {
            let level = self.bout.round().level().clone();
            // A round from a link may have a different level under a known name. A win in such a level is not
            // recorded.
            let is_known = self.listed(&level).is_some();
            let rewinds = self.bout.round().rewinds();
            let was_won = self.has_won_path();
            // A win without a hand that moved is no feat: it sets no record, and nobody can race it.
            let is_known = is_known && !outcome.is_by_itself();
            let is_best = is_known && self.records.note(&level, &outcome, rewinds);
            self.ending.is_due |= !was_won && self.has_won_path();
            self.bout.won = Some((outcome, is_best));
            if !outcome.is_by_itself() {
                self.note_test_win();
            }
            self.note_end();
            self.sound.play(Cue::Won(match outcome.route {
                tamaire_play::Route::Squeeze => tamaire_sound::Route::Squeeze,
                tamaire_play::Route::Shave => tamaire_sound::Route::Shave,
                tamaire_play::Route::Mix => tamaire_sound::Route::Mix,
            }));
            self.files.keep_records(&self.records, &self.levels);
            if is_known && rewinds == 0 {
                self.files.keep_best(&level, self.bout.round().replay());
            }
        }
        if self.bout.has_cheered() && self.bout.won.is_some() {
            self.go(Screen::Result);
        }
    }
}

/// Returns the input of the players for the next tick of a round.
fn input_for(
    round: &AnyRound,
    players: &mut Players,
    devices: &Devices,
    bindings: &Bindings,
    manner: &InputMapping,
) -> InputFrame {
    // A player who joins now begins at the start position of the level.
    let hands = round.level().scene().hand.iter();
    let starts = hands.map(|hand| Vec3::from(hand.target(0.0)));
    let mut targets: Vec<Vec3> = starts.collect();
    for (target, hand) in targets.iter_mut().zip(round.hands()) {
        *target = hand.target;
    }
    let hands = Hands {
        targets: &targets,
        radius: round.hands()[0].radius,
        distance_to_bodies: &|position| round.distance_to_bodies(position),
    };
    players.frame(devices, bindings, manner, &hands, DEFAULT_TICK)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::platform::{Files, Sound};
    use app_shell::{Clock, Pads};
    use std::cell::Cell;

    /// Creates a game in its first level, with a clock that advances by `tick` [s] at each call.
    fn game(tick: f64) -> Game {
        let mut game = Game::new(Files::nowhere(), Sound::none(), Pads::none());
        let now = Cell::new(0.0);
        game.clock = Clock::of(move || {
            now.set(now.get() + tick);
            now.get()
        });
        game.start(0);
        game
    }

    fn ticks_in(game: &mut Game, seconds: f32) -> u64 {
        let before = game.bout.round().ticks();
        game.update(seconds);
        game.bout.round().ticks() - before
    }

    #[test]
    fn slow_machine_plays_one_tick_per_frame() {
        let mut quick = game(0.001);
        assert_eq!(ticks_in(&mut quick, 0.051), 3);
        let mut slow = game(0.04);
        for _ in 0..5 {
            assert_eq!(ticks_in(&mut slow, 0.05), 1);
        }
    }

    #[test]
    fn player_is_told_once_about_slow_machine() {
        for (tick, expect) in [(0.001, 0), (0.015, 0), (0.03, 1)] {
            let mut game = game(tick);
            (0..400).for_each(|_| game.update(0.02));
            let said = (game.words().slow)(game.bout.session.bearable());
            let count = game.notices.iter().filter(|notice| notice.text == said);
            assert_eq!(count.count(), expect, "{tick} s a tick");
        }
    }

    #[test]
    fn hidden_or_paused_round_stands_still() {
        for screen in [
            Screen::Levels,
            Screen::Replays,
            Screen::Settings,
            Screen::Forces,
            Screen::Licences,
            Screen::Paused,
            Screen::Toolbox,
        ] {
            let mut game = game(0.001);
            game.go(Screen::Title);
            assert_eq!(ticks_in(&mut game, 0.02), 1, "the title shows a round");
            game.go(screen);
            assert_eq!(ticks_in(&mut game, 0.05), 0, "{screen:?}");
        }
    }

    #[test]
    fn time_stays_precise_after_weeks() {
        let mut game = game(0.001);
        game.time = 60.0 * 86_400.0;
        let before = game.time;
        (0..144).for_each(|_| game.update(1.0 / 144.0));
        assert!((game.time - before - 1.0).abs() < 1e-4);
    }
}
