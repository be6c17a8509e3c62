//! Watch over the speed of drawing, which lowers the picture quality on slow devices.

use super::{Game, Screen};
use crate::settings::Quality;

/// Number of frames from which the usual duration of a frame is computed.
const FRAMES: usize = 90;
/// Median duration of a frame from which drawing counts as slow [s]: fewer than 33 frames per second.
const SLOW: f32 = 0.030;
/// Duration from which a frame is ignored [s]: the window was hidden, or the machine was busy with another
/// program.
const INTERRUPTED: f32 = 0.5;
/// Speed of the simulation below which the simulation counts as the slow part, as a share of real time.
const SIMULATED: f64 = 0.8;

/// Duration of a frame from which slow drawing is told if the quality is chosen [s]. A display with 30 frames per
/// second does not reach it.
const TOLD: f32 = 0.036;
/// Duration of a frame after a lower quality, relative to the one before, up to which the lower quality has helped.
const HELPS: f32 = 0.95;

/// Watch over the duration of frames.
#[derive(Clone, Debug)]
pub struct DrawingWatch {
    /// Durations of the last frames, without the time in ticks [s].
    frames: Vec<f32>,
    /// Quality that was reached by lowering it automatically.
    reached: Quality,
    /// Quality before the last step and the usual duration of a frame with it [s], until it is known whether the
    /// step has helped.
    trial: Option<(Quality, f32)>,
    /// Whether a step did not help. The frames are then slow for another reason, for example because the display
    /// shows 30 frames per second.
    is_useless: bool,
    /// Whether the player was told that drawing is slow.
    is_told: bool,
}

impl Default for DrawingWatch {
    fn default() -> Self {
        Self {
            frames: Vec::new(),
            reached: Quality::High,
            trial: None,
            is_useless: false,
            is_told: false,
        }
    }
}

impl DrawingWatch {
    /// Forgets the measured frames.
    fn forget(&mut self) {
        self.frames.clear();
    }

    /// Adds the duration of a frame [s]. Returns the median of the last [`FRAMES`] frames [s] as soon as there are
    /// enough of them.
    fn note(&mut self, seconds: f32) -> Option<f32> {
        if seconds >= INTERRUPTED {
            return None;
        }
        self.frames.push(seconds);
        if self.frames.len() < FRAMES {
            return None;
        }
        self.frames.sort_by(f32::total_cmp);
        let median = self.frames[FRAMES / 2];
        self.forget();
        Some(median)
    }

    /// Lowers the quality by a step if frames take `median` [s], and takes back a step that did not help. Returns
    /// whether a lower quality has helped.
    fn adapt(&mut self, median: f32) -> bool {
        let trial = self.trial.take();
        if let Some((quality, before)) = trial
            && median > HELPS * before
        {
            self.reached = quality;
            self.is_useless = true;
            return false;
        }
        if median > SLOW && !self.is_useless && self.reached != Quality::Low {
            self.trial = Some((self.reached, median));
            self.reached = self.reached.lower();
        }
        trial.is_some()
    }
}

impl Game {
    /// Picture quality with which worlds are drawn: high, medium or low.
    pub fn quality(&self) -> Quality {
        match self.settings.quality {
            Quality::Automatic => self.drawing.reached,
            chosen => chosen,
        }
    }

    /// Returns to the highest automatic quality, for a new visitor of a stand.
    pub fn forget_slow_drawing(&mut self) {
        self.drawing = DrawingWatch::default();
    }

    /// Notes the time from one frame to the next [s]: everything from input to picture. If frames of a round
    /// usually take too long, even without the ticks, lowers the picture quality by a step unless the player has
    /// chosen it. Tells the player once, as soon as a step has helped.
    pub fn note_frame(&mut self, seconds: f32) {
        let bout = &self.bout;
        let is_simulation_slow = bout.session.bearable() < SIMULATED;
        let is_fast = !bout.session.is_played() && bout.watch_speed > 1.0;
        let is_unusual = bout.session.is_winding() || bout.stepping || is_fast;
        if self.screen() != Screen::Play || self.is_away || is_simulation_slow || is_unusual {
            return self.drawing.forget();
        }
        let drawing = seconds - bout.session.time_in_ticks() as f32;
        let Some(median) = self.drawing.note(drawing) else {
            return;
        };
        let is_automatic = self.settings.quality == Quality::Automatic;
        let text = match is_automatic {
            true if self.drawing.adapt(median) => self.words().quality_lowered,
            false if median > TOLD => self.words().drawing_slow,
            _ => return,
        };
        // Visitors of a stand cannot change the settings.
        if !self.drawing.is_told && self.public.is_none() {
            self.notify(text.to_string());
        }
        self.drawing.is_told = true;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::platform::{Files, Sound};
    use app_shell::{Clock, Pads};

    fn game() -> Game {
        let mut game = Game::new(Files::nowhere(), Sound::none(), Pads::none());
        game.clock = Clock::of(|| 0.0);
        game.start(0);
        game
    }

    /// Draws `count` frames of `seconds` each, and returns the quality and the number of messages.
    fn draw(game: &mut Game, count: usize, seconds: f32) -> (Quality, usize) {
        (0..count).for_each(|_| game.note_frame(seconds));
        (game.quality(), game.notices.iter().count())
    }

    /// Draws `count` frames whose duration depends on the quality: a full picture takes `full` seconds more than
    /// an empty one, which takes 10 ms.
    fn draw_by_quality(game: &mut Game, count: usize, full: f32) -> (Quality, usize) {
        for _ in 0..count {
            let share = game.quality().resolution();
            game.note_frame(0.01 + full * share * share);
        }
        (game.quality(), game.notices.iter().count())
    }

    #[test]
    fn slow_drawing_lowers_quality_by_steps_and_is_told_once() {
        let mut game = game();
        assert_eq!(draw(&mut game, 400, 1.0 / 60.0), (Quality::High, 0));
        // The last 40 of these frames count towards the next median.
        game.drawing.forget();
        let mut draw = |count| draw_by_quality(&mut game, count, 0.08);
        assert_eq!(draw(FRAMES), (Quality::Medium, 0), "a trial");
        assert_eq!(draw(FRAMES), (Quality::Low, 1));
        assert_eq!(draw(400), (Quality::Low, 1));
        let told = game.notices.iter().next().unwrap().text.clone();
        assert_eq!(told, game.words().quality_lowered);
        game.forget_slow_drawing();
        assert_eq!(game.quality(), Quality::High, "a new visit");
    }

    #[test]
    fn step_that_does_not_help_is_taken_back() {
        // A display with 30 frames per second, and a slow one.
        for seconds in [1.0 / 30.0, 0.04] {
            let mut game = game();
            assert_eq!(draw(&mut game, FRAMES, seconds), (Quality::Medium, 0));
            assert_eq!(draw(&mut game, FRAMES, seconds), (Quality::High, 0));
            assert_eq!(draw(&mut game, 900, seconds), (Quality::High, 0));
        }
    }

    #[test]
    fn frames_of_fast_replays_are_not_measured() {
        let mut game = game();
        (0..5).for_each(|_| game.update(0.02));
        let replay = game.bout.round().replay();
        game.watch(replay.into()).unwrap();
        game.bout.watch_speed = 4.0;
        assert_eq!(draw(&mut game, 400, 0.04), (Quality::High, 0));
    }

    #[test]
    fn few_long_frames_are_not_slow_drawing() {
        let mut game = game();
        for _ in 0..20 {
            draw(&mut game, 30, 1.0 / 60.0);
            draw(&mut game, 10, 0.1);
        }
        assert_eq!(draw(&mut game, 200, 2.0), (Quality::High, 0), "hidden");
    }

    #[test]
    fn chosen_quality_is_kept_and_slow_drawing_is_told() {
        let mut game = game();
        game.settings.quality = Quality::High;
        assert_eq!(draw(&mut game, 400, 0.04), (Quality::High, 1));
        let told = game.notices.iter().next().unwrap().text.clone();
        assert_eq!(told, game.words().drawing_slow);
    }

    #[test]
    fn only_rounds_are_measured() {
        let mut game = game();
        game.go(Screen::Paused);
        assert_eq!(draw(&mut game, 400, 0.04), (Quality::High, 0));
    }
}
