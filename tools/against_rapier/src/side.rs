//! Results of each engine, and the measurement of worlds that run alternately.

use serde::Serialize;

use crate::world::Falling;

/// Allowed difference between the peak squash of the engines, as a fraction of the height.
pub const TOLERANCE: f64 = 0.02;

/// Result of a scene in one engine.
#[derive(Clone, Debug, Serialize)]
pub struct EngineResult {
    /// Name and version of the engine, and the elements of its bodies.
    pub engine: String,
    /// Substeps per frame. Rapier adds up to 4 during fast impacts.
    pub substeps: usize,
    /// Factor by which the engine lowered Young's modulus; 1 if it did not.
    pub stiffness_scale: f64,
    /// Number of pieces of all bodies at the start.
    pub pieces: usize,
    /// Fraction of the pieces that sleep at the end.
    pub asleep: f64,
    /// Largest squash of all frames: 1 − height / initial height, of all soft bodies together.
    pub peak_squash: f64,
    /// True if all node positions stayed finite.
    pub finite: bool,
    /// Processor time of each frame [ms].
    #[serde(skip)]
    pub milliseconds: Vec<f64>,
}

impl EngineResult {
    /// Returns whether the peak squash of both results agrees within 2 percentage points.
    pub fn equals(&self, other: &Self) -> bool {
        (self.peak_squash - other.peak_squash).abs() <= TOLERANCE
    }

    /// Returns the median frame time [ms].
    pub fn median(&self) -> f64 {
        let mut sorted = self.milliseconds.clone();
        sorted.sort_by(f64::total_cmp);
        sorted.get(sorted.len() / 2).copied().unwrap_or(f64::NAN)
    }

    /// Returns the slowest frame time [ms].
    pub fn worst(&self) -> f64 {
        self.milliseconds.iter().copied().fold(f64::NAN, f64::max)
    }
}

/// Runs worlds alternately, frame by frame, until one of them sleeps completely.
pub fn fall<const K: usize>(worlds: [Box<dyn Falling>; K], frames: usize) -> [EngineResult; K] {
    let mut watched = worlds.map(MeasuredWorld::new);
    for _ in 0..frames {
        watched.iter_mut().for_each(MeasuredWorld::step);
        if watched.iter().any(|watched| watched.side.asleep >= 1.0) {
            break;
        }
    }
    watched.map(|watched| watched.side)
}

/// World and its measurements.
pub struct MeasuredWorld {
    world: Box<dyn Falling>,
    height: f32,
    /// Measurements of this world so far.
    pub side: EngineResult,
}

impl MeasuredWorld {
    /// Starts the measurements of a world.
    pub fn new(world: Box<dyn Falling>) -> Self {
        Self {
            height: world.span().height(),
            side: EngineResult {
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

    /// Runs a frame and measures it.
    pub fn step(&mut self) {
        self.side.milliseconds.push(self.world.timed_step());
        let span = self.world.span();
        let squash = 1.0 - f64::from(span.height() / self.height);
        self.side.peak_squash = self.side.peak_squash.max(squash);
        self.side.finite &= span.finite;
        self.side.asleep = self.world.asleep();
    }
}
