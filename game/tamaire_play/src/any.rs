//! Rounds whose dimension is that of their level: for those who do not look into bodies.

use crate::{InputFrame, Level, Progress, Round};
use fuwafuwa::{Dim2, Dim3, Event, RigidBody, Shape, StepReport, Vector};
use std::sync::Arc;

/// A round in the plane or in space.
#[derive(Clone, Debug)]
pub enum AnyRound {
    /// dim = 2
    Plane(Round<Dim2>),
    /// dim = 3
    Space(Round<Dim3>),
}

/// The same for both.
macro_rules! both {
    ($any:expr, $one:ident => $act:expr) => {
        match $any {
            Self::Plane($one) => $act,
            Self::Space($one) => $act,
        }
    };
}

impl AnyRound {
    /// The start of a round.
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

    /// See [`Round::level`].
    pub fn level(&self) -> &Arc<Level> {
        both!(self, round => round.level())
    }

    /// See [`Round::basket`].
    pub fn basket(&self) -> Option<&Shape> {
        both!(self, round => round.basket())
    }

    /// See [`Round::start`].
    ///
    /// # Panics
    /// When the level has no such hand.
    pub fn start(&self, player: usize) -> Vector {
        both!(self, round => round.start(player))
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

    /// See [`Round::hands`].
    pub fn hands(&self) -> Vec<&RigidBody> {
        both!(self, round => round.hands().collect())
    }

    /// What happened in the last tick.
    pub fn events(&self) -> &[Event] {
        both!(self, round => round.world().events())
    }

    /// How many ticks have passed, those after a win too.
    pub fn ticks(&self) -> u64 {
        both!(self, round => round.world().ticks())
    }

    /// The world's hash as it is now.
    pub fn hash(&self) -> u64 {
        both!(self, round => round.world().hash())
    }

    /// See [`Round::hashes`].
    pub fn hashes(&self) -> &[u64] {
        both!(self, round => round.hashes())
    }
}
