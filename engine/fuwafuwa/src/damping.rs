//! How pieces lose their swing: their motion relaxes towards that of a rigid body.
//!
//! Two dampers share the work. The elastic force is taken at positions a moment ahead
//! (Kelvin–Voigt), which calms fast ripples but, within what the substep bears, hardly the body's
//! own slow swing. For that the velocities of each piece are drawn towards its rigid motion, at
//! the rate 2 ζ ω of a damped oscillator; momentum and spin are left alone.

use crate::body::Body;
use crate::dim::Dim;
use crate::ids::{PieceId, Table};
use crate::momentum::RigidMotion;
use crate::threads;
use crate::vector::{cross, dot, minus, plus, scaled, three};

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
    /// Angular momentum about the centre [kg m²/s].
    angular: [f64; 3],
    /// Σ m x xᵀ about the centre [kg m²].
    spread: [[f64; 3]; 3],
}

impl PieceMotion {
    /// Adds a node at x from `origin`, still without regard to the centre.
    #[inline(always)]
    fn add<D: Dim>(&mut self, x: [f64; 3], velocity: [f64; 3], mass: f64) {
        let (moment, impulse) = (scaled(x, mass), scaled(velocity, mass));
        self.mass += mass;
        self.nodes += 1;
        self.speed_squared += dot(impulse, velocity);
        match D::N {
            // In the plane the other two are 0.
            2 => self.angular[2] += x[0] * impulse[1] - x[1] * impulse[0],
            _ => self.angular = plus(self.angular, cross(x, impulse)),
        }
        for i in 0..D::N {
            self.centre[i] += moment[i];
            self.velocity[i] += impulse[i];
            for j in i..D::N {
                self.spread[i][j] += moment[i] * x[j];
            }
        }
    }

    /// From sums about `origin` to what the fields say.
    fn finish(&mut self, origin: [f64; 3]) {
        let share = 1.0 / self.mass;
        let (from, impulse) = (scaled(self.centre, share), self.velocity);
        self.velocity = scaled(impulse, share);
        self.speed_squared *= share;
        self.angular = minus(self.angular, cross(from, impulse));
        for i in 0..3 {
            for j in i..3 {
                self.spread[i][j] -= self.mass * from[i] * from[j];
                self.spread[j][i] = self.spread[i][j];
            }
        }
        self.centre = plus(origin, from);
    }

    /// The rigid motion with the same momentum; of a piece that sleeps none.
    fn rigid(&self) -> RigidMotion {
        if self.nodes == 0 {
            return RigidMotion::default();
        }
        let squared = self.spread[0][0] + self.spread[1][1] + self.spread[2][2];
        let mut inertia = self.spread.map(|row| scaled(row, -1.0));
        (0..3).for_each(|k| inertia[k][k] += squared);
        RigidMotion::of_spin(self.velocity, self.centre, &self.angular, &inertia)
    }
}

/// The motions of all pieces, by number; those asleep have no mass here.
pub fn motions<D: Dim>(body: &Body<D>) -> Table<PieceId, PieceMotion> {
    let count = body.truth.pieces.list.len();
    let mut motions: Table<PieceId, _> = vec![PieceMotion::default(); count].into();
    // A node of the piece itself: far from the world's origin the sums would lose digits.
    let mut origins: Table<PieceId, _> = vec![[0.0; 3]; count].into();
    let of_node = |id| body.truth.pieces.of_node(id);
    // Nodes that follow one another are mostly of one piece: its sums stay at hand for as long.
    for nodes in body.cache.awake.chunk_by(|&a, &b| of_node(a) == of_node(b)) {
        let piece = of_node(nodes[0]);
        let (mut motion, origin) = (motions[piece], &mut origins[piece]);
        if motion.nodes == 0 {
            *origin = wide(body.state.position[nodes[0]]);
        }
        for (&id, (position, velocity, mass)) in nodes.iter().zip(body.states(nodes)) {
            let x = minus(wide(position), *origin);
            motion.add::<D>(x, wide(velocity), f64::from(mass));
            motion.is_driven |= body.state.inverse_mass[id] == 0.0 && velocity != [0.0; 4];
        }
        motions[piece] = motion;
    }
    for (motion, origin) in motions.iter_mut().zip(origins.iter()) {
        if motion.nodes > 0 {
            motion.finish(*origin);
        }
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
    let rigid: Vec<RigidMotion> = motions.iter().map(PieceMotion::rigid).collect();
    body.cache.rigid.clear();
    body.cache
        .rigid
        .extend(rigid.iter().map(RigidMotion::roughly));
    if slowing.iter().all(|slowing| *slowing == Slowing::default()) {
        return;
    }
    // Of the motion of the centre 1 − drag is kept, of the spin about it and of the motion within
    // the piece what spin and swing leave of that: v ← kept v + pace(x).
    let paces: Vec<_> = rigid
        .iter()
        .zip(slowing)
        .map(|(rigid, &Slowing { swing, spin, drag })| {
            let kept = 1.0 - drag;
            let pace = rigid.times(f64::from(kept * swing), f64::from(kept * (swing - spin)));
            (kept * (1.0 - swing), pace.roughly())
        })
        .collect();
    let (inverse_mass, position, pieces) = (
        &body.state.inverse_mass,
        &body.state.position,
        &body.truth.pieces,
    );
    let rows = threads::rows(&body.cache.awake, [&mut body.state.velocity]);
    threads::map(rows, |rows| {
        let [velocities] = rows.lists;
        for &id in rows.nodes {
            if inverse_mass[id] != 0.0 {
                let (kept, pace) = &paces[pieces.of_node(id).index()];
                let velocity = &mut velocities[id.index() - rows.first];
                *velocity = plus(scaled(*velocity, *kept), pace.at::<D>(position[id]));
            }
        }
    });
}

#[inline(always)]
fn wide(row: [f32; 4]) -> [f64; 3] {
    three(row).map(f64::from)
}
