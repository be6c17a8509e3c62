//! What flies about and what it does to the camera and the face.

use super::{Camera, Mood};
use fuwafuwa::Dim2;
use fuwafuwa::{Event, Vector, With};
use tamaire_play::Round;

/// Most particles at once.
const MOST: usize = 400;
/// Particles for each released node.
const DUST: usize = 3;
/// How long the face is shocked after a tear [s].
const SHOCK: f32 = 0.6;
/// A hand that presses harder than this hurts [N].
const HURTS: f32 = 350.0;

/// A speck of dust.
#[derive(Copy, Clone, Debug)]
pub struct Speck {
    /// Where [m].
    pub at: Vector,
    /// [m/s]
    velocity: Vector,
    /// Of how many seconds it has how many left.
    life: f32,
    left: f32,
    /// [m]
    pub radius: f32,
    /// Of which material it is made.
    pub material: u8,
}

impl Speck {
    /// From 1 when it is new to 0 when it goes.
    pub fn strength(&self) -> f32 {
        (self.left / self.life).clamp(0.0, 1.0)
    }
}

/// What flies about, and what was felt lately.
#[derive(Clone, Debug)]
pub struct Effects {
    /// Dust.
    pub specks: Vec<Speck>,
    /// For how long the body is still shocked [s].
    pub shock: f32,
    /// How hard hands press on it [N], smoothed.
    pub pressure: f32,
    random: fastrand::Rng,
}

impl Default for Effects {
    fn default() -> Self {
        Self {
            specks: Vec::new(),
            shock: 0.0,
            pressure: 0.0,
            random: fastrand::Rng::with_seed(1),
        }
    }
}

impl Effects {
    /// How the body feels about all this.
    pub fn mood(&self, round: &Round<Dim2>) -> Mood {
        let progress = round.progress();
        if progress.outcome.is_some() || progress.held > 0.3 {
            Mood::Beam
        } else if self.shock > 0.0 {
            Mood::Shock
        } else if self.pressure > HURTS {
            Mood::Wince
        } else {
            Mood::Calm
        }
    }

    /// Looks at what happened in a tick.
    pub fn see(&mut self, round: &Round<Dim2>, camera: &mut Camera, still: bool) {
        let mut pressed = 0.0;
        for event in round.world().events() {
            match *event {
                Event::Released { at, energy, .. } => {
                    self.shock = SHOCK;
                    camera.shake(0.002 + 0.002 * energy.clamp(0.0, 2.0));
                    let count = if still { 1 } else { DUST };
                    (0..count).for_each(|_| self.puff(at));
                }
                Event::Touched {
                    with: With::Manipulator(_),
                    impulse,
                    ..
                } => {
                    pressed += impulse / fuwafuwa::world::TICK;
                }
                _ => {}
            }
        }
        self.pressure += 0.2 * (pressed - self.pressure);
    }

    /// Lets `seconds` pass.
    pub fn pass(&mut self, seconds: f32) {
        self.shock = (self.shock - seconds).max(0.0);
        for speck in &mut self.specks {
            speck.left -= seconds;
            let slower = (1.0 - 3.0 * seconds).max(0.0);
            for axis in 0..2 {
                speck.velocity[axis] *= slower;
                speck.at[axis] += speck.velocity[axis] * seconds;
            }
        }
        self.specks.retain(|speck| speck.left > 0.0);
    }

    fn puff(&mut self, at: Vector) {
        if self.specks.len() >= MOST {
            return;
        }
        let mut any = |low: f32, high: f32| low + (high - low) * self.random.f32();
        let life = any(0.3, 0.9);
        self.specks.push(Speck {
            at,
            velocity: [any(-0.8, 0.8), any(-0.8, 0.8), 0.0],
            life,
            left: life,
            radius: any(0.004, 0.012),
            material: 1,
        });
    }
}
