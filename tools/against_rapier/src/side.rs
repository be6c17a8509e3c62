//! What is measured of each engine while worlds run in turns.

use serde::Serialize;

use crate::world::Falling;

/// How far the peak squash of one engine may be from the other's: 2 percentage points.
pub const TOLERANCE: f64 = 0.02;

/// How a scene went in one of the engines.
#[derive(Clone, Debug, Serialize)]
pub struct Side {
    /// Its name and version, and what its bodies are made of.
    pub engine: String,
    /// Substeps of the solver in each frame. Rapier adds up to 4 while a body hits fast.
    pub substeps: usize,
    /// Factor by which the engine itself lowered Young's modulus.
    pub stiffness_scale: f64,
    /// Pieces at the start.
    pub pieces: usize,
    /// Share of the pieces that sleeps in the end.
    pub asleep: f64,
    /// 1 − least height / height at the start of all that is soft, over all frames.
    pub peak_squash: f64,
    /// Whether every node stayed at a finite place.
    pub finite: bool,
    /// Time that the processor worked on each frame [ms].
    #[serde(skip)]
    pub milliseconds: Vec<f64>,
}

impl Side {
    /// Whether the peak squash of both is the same, within 2 percentage points.
    pub fn equals(&self, other: &Self) -> bool {
        (self.peak_squash - other.peak_squash).abs() <= TOLERANCE
    }

    /// Median time of a frame [ms].
    pub fn median(&self) -> f64 {
        let mut sorted = self.milliseconds.clone();
        sorted.sort_by(f64::total_cmp);
        sorted.get(sorted.len() / 2).copied().unwrap_or(f64::NAN)
    }

    /// Time of the slowest frame [ms].
    pub fn worst(&self) -> f64 {
        self.milliseconds.iter().copied().fold(f64::NAN, f64::max)
    }
}

/// Runs worlds frame by frame in turns, until one of them sleeps as a whole.
pub fn fall<const K: usize>(worlds: [Box<dyn Falling>; K], frames: usize) -> [Side; K] {
    let mut watched = worlds.map(Watched::new);
    for _ in 0..frames {
        watched.iter_mut().for_each(Watched::step);
        if watched.iter().any(|watched| watched.side.asleep >= 1.0) {
            break;
        }
    }
    watched.map(|watched| watched.side)
}

/// A world, and what was seen of it so far.
pub struct Watched {
    world: Box<dyn Falling>,
    height: f32,
    /// What was seen.
    pub side: Side,
}

impl Watched {
    /// A world as it is now.
    pub fn new(world: Box<dyn Falling>) -> Self {
        Self {
            height: world.span().height(),
            side: Side {
                engine: world.engine(),
                substeps: world.substeps(),
                stiffness_scale: world.stiffness_scale(),
                pieces: world.pieces(),
                asleep: world.asleep(),
                peak_squash: 0.0,
                finite: true,
                milliseconds: Vec::new(),
            },
            world,
        }
    }

    /// Runs it for a frame.
    pub fn step(&mut self) {
        self.side.milliseconds.push(self.world.timed_step());
        let span = self.world.span();
        let squash = 1.0 - f64::from(span.height() / self.height);
        self.side.peak_squash = self.side.peak_squash.max(squash);
        self.side.finite &= span.finite;
        self.side.asleep = self.world.asleep();
    }
}
