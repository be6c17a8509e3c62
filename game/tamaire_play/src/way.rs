//! Ways to win a level: paths of the hand. Each level of the path has at least two, and tests play them.

use crate::{AnyRound, InputFrame, Outcome, Route};
use fuwafuwa::{DEFAULT_TICK, Vec3};
use fuwafuwa_scenes::scene::point_at;
use serde::{Deserialize, Serialize};

/// Time for which a round goes on after the end of a way [s].
const AFTER: f32 = 8.0;

/// A way to win a level.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Way {
    /// Route by which the round is won.
    pub route: Route,
    /// Goals of the level that the round reaches, counted from 1.
    #[serde(default)]
    pub wishes: Vec<usize>,
    /// Path of the first player's target: time [s], then position [m]; interpolated linearly.
    pub path: Vec<[f32; 4]>,
    /// Path of the second player's target, if two play.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub second: Vec<[f32; 4]>,
}

/// File with the ways of a level.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Ways {
    /// The ways.
    pub way: Vec<Way>,
}

impl Ways {
    /// Reads the ways of a level from a text.
    ///
    /// # Errors
    /// The message of the TOML parser, with the line.
    pub fn read(text: &str) -> Result<Self, toml::de::Error> {
        toml::from_str(text)
    }
}

impl Way {
    /// Returns the input of a tick.
    pub fn frame(&self, tick: u64) -> InputFrame {
        let seconds = (tick + 1) as f32 * DEFAULT_TICK;
        let paths = [&self.path, &self.second].into_iter().enumerate();
        let frame = InputFrame::default();
        paths.fold(frame, |frame, (player, path)| match path.is_empty() {
            true => frame,
            false => frame.with(player, Vec3::from(point_at(path, seconds))),
        })
    }

    /// Returns the duration of the way [s].
    pub fn seconds(&self) -> f32 {
        let ends = [&self.path, &self.second].map(|path| path.last().map_or(0.0, |end| end[0]));
        ends[0].max(ends[1])
    }

    /// Returns the input of the way and of the time after it, in which the bodies come to rest.
    pub fn frames(&self) -> Vec<InputFrame> {
        let ticks = ((self.seconds() + AFTER) / DEFAULT_TICK) as u64;
        (0..ticks).map(|tick| self.frame(tick)).collect()
    }

    /// Plays the way in a round from its start. Returns the outcome if it wins within 8 s after the end of the way.
    /// With `shake`, a seed, all targets tremble by up to 3 mm.
    pub fn play(&self, round: &mut AnyRound, shake: Option<u64>) -> Option<Outcome> {
        let mut shake = shake.map(Shake::new);
        for frame in self.frames() {
            round.step(match &mut shake {
                Some(shake) => shake.of(frame),
                None => frame,
            });
            if round.progress().outcome.is_some() {
                break;
            }
        }
        round.progress().outcome
    }
}

/// Trembling of a hand: an offset of up to 3 mm on each axis that changes from tick to tick.
#[derive(Clone, Debug)]
pub struct Shake {
    random: fastrand::Rng,
    offset: Vec3,
}

impl Shake {
    /// Maximum offset on each axis [m].
    pub const OFFSET: f32 = 0.003;

    /// Creates a trembling from a seed.
    pub fn new(seed: u64) -> Self {
        Self {
            random: fastrand::Rng::with_seed(seed),
            offset: Vec3::ZERO,
        }
    }

    /// Returns the input of the next tick with all targets moved by the offset.
    pub fn of(&mut self, frame: InputFrame) -> InputFrame {
        let step = Vec3::from([0; 3].map(|_: i32| 2.0 * self.random.f32() - 1.0));
        let offset = self.offset + 0.5 * Self::OFFSET * step;
        self.offset = offset.clamp(Vec3::splat(-Self::OFFSET), Vec3::splat(Self::OFFSET));
        let players = 0..frame.goals.len();
        players.fold(frame, |moved, player| match frame.goal(player) {
            Some(goal) => moved.with(player, goal + self.offset),
            None => moved,
        })
    }
}
