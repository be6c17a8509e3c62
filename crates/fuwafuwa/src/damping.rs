//! How pieces lose their swing: their motion relaxes towards that of a rigid body.
//!
//! Two dampers share the work. The elastic force is taken at positions a moment ahead
//! (Kelvin–Voigt), which calms fast ripples but, within what the substep bears, hardly the body's
//! own slow swing. For that the velocities of each piece are drawn towards its rigid motion, at
//! the rate 2 ζ ω of a damped oscillator; momentum and spin are left alone.

use crate::body::Body;
use crate::dim::Dim;
use crate::momentum::{Momentum, RigidMotion};
use crate::vector::{dot, minus, plus, scaled};

/// The motion of one piece.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct PieceMotion {
    /// Mass of its nodes that move [kg].
    pub mass: f64,
    /// Their centre [m].
    pub centre: [f64; 3],
    /// Velocity of the centre [m/s].
    pub velocity: [f64; 3],
    /// Mean square speed [m²/s²].
    pub speed_squared: f64,
    /// Number of its nodes that move.
    pub nodes: u32,
    /// Whether some of its nodes are held and on the move: it cannot rest.
    pub is_driven: bool,
}

/// The motions of all pieces, by number; those asleep have no mass here.
pub fn motions<D: Dim>(body: &Body<D>) -> Vec<PieceMotion> {
    let mut motions = vec![PieceMotion::default(); body.pieces.list.len()];
    for (&id, (position, velocity, mass)) in body.awake.iter().zip(body.states(&body.awake)) {
        let motion = &mut motions[body.pieces.of_node(id) as usize];
        let (x, v, mass) = (wide(position), wide(velocity), f64::from(mass));
        motion.mass += mass;
        motion.centre = plus(motion.centre, scaled(x, mass));
        motion.velocity = plus(motion.velocity, scaled(v, mass));
        motion.speed_squared += mass * dot(v, v);
        motion.nodes += 1;
        motion.is_driven |= body.lightness[id as usize] == 0.0 && velocity != [0.0; 4];
    }
    for motion in motions.iter_mut().filter(|motion| motion.mass > 0.0) {
        let share = 1.0 / motion.mass;
        motion.centre = scaled(motion.centre, share);
        motion.velocity = scaled(motion.velocity, share);
        motion.speed_squared *= share;
    }
    motions
}

/// What slows a piece down: rates [1/s], or the shares that are lost in one round.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct Slowing {
    /// Of the motion within the piece.
    pub swing: f32,
    /// Of its spin.
    pub spin: f32,
    /// Of all motion: drag of the air, and of what it touches.
    pub drag: f32,
}

impl Slowing {
    /// The shares that these rates take in a round of `duration` [s].
    pub fn over(self, duration: f32) -> Self {
        let share = |rate: f32| (rate * duration).min(1.0);
        Self {
            swing: share(self.swing),
            spin: share(self.spin),
            drag: share(self.drag),
        }
    }
}

/// Slows the pieces of a body down, each by its own `slowing`, and notes their rigid motions.
pub fn slow_down<D: Dim>(body: &mut Body<D>, motions: &[PieceMotion], slowing: &[Slowing]) {
    let mut spins = vec![([0.0; 3], [[0.0; 3]; 3]); motions.len()];
    for (&id, (position, velocity, mass)) in body.awake.iter().zip(body.states(&body.awake)) {
        let piece = body.pieces.of_node(id) as usize;
        let x = minus(wide(position), motions[piece].centre);
        let v = minus(wide(velocity), motions[piece].velocity);
        let (angular, inertia) = &mut spins[piece];
        Momentum::add_spin(angular, inertia, x, v, f64::from(mass));
    }
    let rigid: Vec<RigidMotion> = motions
        .iter()
        .zip(&spins)
        .map(|(motion, (angular, inertia))| {
            RigidMotion::of_spin(motion.velocity, motion.centre, angular, inertia)
        })
        .collect();
    body.rigid.clear();
    body.rigid.extend(rigid.iter().map(RigidMotion::rounded));
    if slowing.iter().all(|slowing| *slowing == Slowing::default()) {
        return;
    }
    for &id in &body.awake {
        let node = id as usize;
        if body.lightness[node] == 0.0 {
            continue;
        }
        let piece = body.pieces.of_node(id) as usize;
        let Slowing { swing, spin, drag } = slowing[piece];
        let own = motions[piece].velocity.map(|k| k as f32);
        let whole = rigid[piece].at(body.position[node]).map(|k| k as f32);
        for axis in 0..D::N {
            let turning = (whole[axis] - own[axis]) * (1.0 - spin);
            let within = (body.velocity[node][axis] - whole[axis]) * (1.0 - swing);
            body.velocity[node][axis] = (own[axis] + turning + within) * (1.0 - drag);
        }
    }
}

fn wide(row: [f32; 4]) -> [f64; 3] {
    [row[0], row[1], row[2]].map(f64::from)
}
