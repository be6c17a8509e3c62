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

/// Watch over the duration of frames.
#[derive(Clone, Debug)]
pub struct DrawingWatch {
    /// Durations of the last frames [s].
    frames: Vec<f32>,
    /// Quality that was reached by lowering it automatically.
    reached: Quality,
    /// Whether the player was told that drawing is slow.
    is_told: bool,
}

impl Default for DrawingWatch {
    fn default() -> Self {
        Self {
            frames: Vec::new(),
            reached: Quality::High,
            is_told: false,
        }
    }
}

impl DrawingWatch {
    /// Forgets the measured frames.
    fn forget(&mut self) {
        self.frames.clear();
    }

    /// Adds the duration of a frame [s]. Returns whether drawing is slow, as soon as this is known.
    fn note(&mut self, seconds: f32) -> bool {
        if seconds >= INTERRUPTED {
            return false;
        }
        self.frames.push(seconds);
        if self.frames.len() < FRAMES {
            return false;
        }
        self.frames.sort_by(f32::total_cmp);
        let median = self.frames[FRAMES / 2];
        self.forget();
        median > SLOW
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

    /// Notes the time from one frame to the next [s]: everything from input to picture. If frames of a round
    /// usually take too long, lowers the picture quality by a step unless the player has chosen it, and tells
    /// the player once.
    pub fn note_frame(&mut self, seconds: f32) {
        let is_simulation_slow = self.bout.session.bearable() < SIMULATED;
        if self.screen() != Screen::Play || self.is_away || is_simulation_slow {
            return self.drawing.forget();
        }
        if !self.drawing.note(seconds) {
            return;
        }
        let text = match self.settings.quality {
            Quality::Automatic => {
                self.drawing.reached = self.drawing.reached.lower();
                self.words().quality_lowered
            }
            _ => self.words().drawing_slow,
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

    #[test]
    fn slow_drawing_lowers_quality_by_steps_and_is_told_once() {
        let mut game = game();
        assert_eq!(draw(&mut game, 400, 1.0 / 60.0), (Quality::High, 0));
        assert_eq!(draw(&mut game, FRAMES, 0.04), (Quality::Medium, 1));
        assert_eq!(draw(&mut game, FRAMES, 0.04), (Quality::Low, 1));
        assert_eq!(draw(&mut game, 400, 0.04), (Quality::Low, 1));
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
