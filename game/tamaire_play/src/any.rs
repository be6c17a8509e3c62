//! Rounds with the dimension chosen at run time. They suit callers that do not access the bodies.

use crate::playground::{Change, ChangeError, TimedChange, Tool};
use crate::round::Hand;
use crate::{InputFrame, Level, Progress, Round};
use fuwafuwa::{DEFAULT_TICK, Dim2, Dim3, DimVector, Event, StepReport, Vec3};
use std::sync::Arc;

/// A round in 2D or in 3D.
#[derive(Clone, Debug)]
pub enum AnyRound {
    /// 2D round.
    Plane(Round<Dim2>),
    /// 3D round.
    Space(Round<Dim3>),
}

/// Evaluates an expression for the round of either variant.
macro_rules! both {
    ($any:expr, $one:ident => $act:expr) => {
        match $any {
            Self::Plane($one) => $act,
            Self::Space($one) => $act,
        }
    };
}

impl AnyRound {
    /// Starts a round of a level.
    pub fn new(level: Arc<Level>) -> Self {
        match level.scene().dim {
            2 => Self::Plane(Round::new(level)),
            _ => Self::Space(Round::new(level)),
        }
    }

    /// See [`Round::step`].
    pub fn step(&mut self, frame: InputFrame) -> StepReport {
        both!(self, round => round.step(frame))
    }

    /// See [`Round::change`].
    ///
    /// # Errors
    /// As [`Round::change`].
    pub fn change(&mut self, change: Change) -> Result<(), ChangeError> {
        both!(self, round => round.change(change))
    }

    /// See [`Round::nodes`].
    pub fn nodes(&self) -> usize {
        both!(self, round => round.nodes())
    }

    /// See [`Round::tool`].
    pub fn tool(&self) -> (Tool, bool) {
        both!(self, round => round.tool())
    }

    /// Returns the downward gravity [m/s²] and the drag of the air [1/s].
    pub fn gravity_and_air(&self) -> [f32; 2] {
        both!(self, round => {
            let config = round.world().config();
            [-config.gravity.to_vec3().y, config.drag]
        })
    }

    /// See [`Round::changes`].
    pub fn changes(&self) -> &[TimedChange] {
        both!(self, round => round.changes())
    }

    /// Makes those of `changes` again that were made before the next tick.
    pub(crate) fn change_again(&mut self, changes: &[TimedChange]) {
        both!(self, round => round.change_again(changes))
    }

    /// See [`Round::level`].
    pub fn level(&self) -> &Arc<Level> {
        both!(self, round => round.level())
    }

    /// Returns whether the level has a basket; see [`Round::baskets`].
    pub fn has_basket(&self) -> bool {
        both!(self, round => !round.baskets().is_empty())
    }

    /// See [`Round::is_weightless`].
    pub fn is_weightless(&self) -> bool {
        both!(self, round => round.is_weightless())
    }

    /// See [`Round::distance_to_bodies`].
    pub fn distance_to_bodies(&self, position: Vec3) -> f32 {
        both!(self, round => round.distance_to_bodies(DimVector::from_vec3(position)))
    }

    /// See [`Round::start`].
    ///
    /// # Panics
    /// If the level has no such hand.
    pub fn start(&self, player: usize) -> Vec3 {
        both!(self, round => round.start(player).to_vec3())
    }

    /// See [`Round::progress`].
    pub fn progress(&self) -> &Progress {
        both!(self, round => round.progress())
    }

    /// See [`Round::share_held`].
    pub fn share_held(&self) -> f32 {
        both!(self, round => round.share_held())
    }

    /// See [`Round::frames`].
    pub fn frames(&self) -> &[InputFrame] {
        both!(self, round => round.frames())
    }

    /// Returns the hands of the players that have joined, in the order of the players. The forces on a hand are those
    /// on all its parts together; on an axis on which a part moves opposite to the hand, its forces count opposite.
    pub fn hands(&self) -> Vec<Hand> {
        both!(self, round => round.felt_hands())
    }

    /// Returns the positions of the nodes that were split in the last tick [m].
    pub fn split_points(&self) -> Vec<Vec3> {
        both!(self, round => {
            let events = round.world().events().iter();
            let splits = events.filter_map(|event| match event {
                Event::NodeSplit { point, .. } => Some(point.to_vec3()),
                _ => None,
            });
            splits.collect()
        })
    }

    /// Returns the number of ticks so far, including those after a win.
    pub fn ticks(&self) -> u64 {
        both!(self, round => round.world().ticks())
    }

    /// See [`Round::clock_ticks`].
    pub fn clock_ticks(&self) -> u64 {
        both!(self, round => round.clock_ticks())
    }

    /// Returns the time on the clock [s]: the time since the first input that moved a hand, until the win.
    pub fn seconds(&self) -> f32 {
        match self.progress().outcome {
            Some(outcome) => outcome.seconds(),
            None => self.clock_ticks() as f32 * DEFAULT_TICK,
        }
    }

    /// Returns the hash of the world's current state.
    pub fn hash(&self) -> u64 {
        both!(self, round => round.world().hash())
    }

    /// See [`Round::count_rewind`].
    pub fn count_rewind(&mut self) {
        both!(self, round => round.count_rewind())
    }

    /// See [`Round::rewinds`].
    pub fn rewinds(&self) -> u32 {
        both!(self, round => round.rewinds())
    }

    /// See [`Round::hashes`].
    pub fn hashes(&self) -> &[u64] {
        both!(self, round => round.hashes())
    }
}
