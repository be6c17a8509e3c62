//! Mass damping and drag: changes of the velocities of pieces.
//!
//! The mass term of [`Damping`](crate::Damping) relaxes the velocities of each piece towards its rigid
//! motion, at the rate α. The stiffness term acts through the elastic forces, which are evaluated at
//! positions extrapolated by β; see `SoftBody::evaluate_forces`. Neither term changes the linear or angular
//! momentum of a free piece.

use crate::foundation::dim::Dim;
use crate::foundation::ids::{IndexVec, NodeId, PieceId};
use crate::foundation::threads::{self, Run};
use crate::math::lanes::on_widest_lanes;
use crate::math::row::Row;
use crate::soft_body::SoftBody;
use crate::soft_body::momentum::{RigidMotion, inverse};
use glam::DVec3;

/// Factor on the mass of fixed nodes in the rigid motion of a piece. A piece with fixed nodes thereby moves
/// as these nodes do, and turns only if they allow it. A thousandth of this factor would leave large pieces a
/// motion of their own; a thousand times this factor would exceed the precision of the sums.
const FIXED_WEIGHT: f64 = 1e9;

/// Motion of one piece, with the moments of its mass; all 0 for a sleeping piece. In `weight`, `centre`,
/// `velocity`, `angular` and `spread`, the mass of fixed nodes is multiplied by [`FIXED_WEIGHT`].
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct PieceMotion {
    /// Mass [kg].
    mass: f64,
    /// Mass with that of fixed nodes multiplied [kg].
    weight: f64,
    /// Centre of mass [m].
    pub mass_centre: DVec3,
    /// Centre of the masses of which those of fixed nodes are multiplied [m].
    pub centre: DVec3,
    /// Velocity of the centre of mass [m/s].
    velocity: DVec3,
    /// Mean of the squared speed over the mass of the piece [m²/s²].
    pub speed_squared: f64,
    /// Number of nodes; 0 for a sleeping piece.
    pub nodes: u32,
    /// Whether a fixed node of the piece moves; such a piece never sleeps.
    pub is_driven: bool,
    /// Angular momentum about the centre of mass [kg m²/s].
    angular: DVec3,
    /// Second moment of mass Σ m x xᵀ [kg m²]; x is the offset of a node from the centre of mass.
    spread: [DVec3; 3],
}

impl PieceMotion {
    /// Adds a node to the sums. `x` is the offset [m] of the node from the reference point of the piece.
    /// `weight` is its mass, multiplied if the node is fixed. [`PieceMotion::finish`] then converts the sums
    /// to moments about the centre of mass.
    #[inline(always)]
    fn add<D: Dim>(&mut self, x: DVec3, velocity: DVec3, mass: f64, weight: f64) {
        let (moment, impulse) = (x * weight, velocity * weight);
        self.mass += mass;
        self.weight += weight;
        self.nodes += 1;
        self.speed_squared += mass * velocity.dot(velocity);
        match D::N {
            // In 2D, angular momentum has only a third component.
            2 => self.angular[2] += x[0] * impulse[1] - x[1] * impulse[0],
            _ => self.angular += x.cross(impulse),
        }
        for i in 0..D::N {
            self.mass_centre[i] += x[i] * mass;
            self.centre[i] += moment[i];
            self.velocity[i] += impulse[i];
            for j in i..D::N {
                self.spread[i][j] += moment[i] * x[j];
            }
        }
    }

    /// Converts sums about the reference point `origin` [m] to means, and to moments about the centre of
    /// mass.
    fn finish(&mut self, origin: DVec3) {
        let share = 1.0 / self.weight;
        let (from, impulse) = (self.centre * share, self.velocity);
        self.velocity = impulse * share;
        self.speed_squared /= self.mass;
        self.angular -= from.cross(impulse);
        for i in 0..3 {
            for j in i..3 {
                self.spread[i][j] -= self.weight * from[i] * from[j];
                self.spread[j][i] = self.spread[i][j];
            }
        }
        self.centre = origin + from;
        self.mass_centre = origin + self.mass_centre / self.mass;
    }

    /// Returns the rigid motion that has the linear and angular momentum of the piece; zero for a sleeping
    /// piece.
    pub fn rigid(&self) -> RigidMotion {
        self.rigid_with(self.velocity * self.weight, self.angular)
    }

    /// Mass [kg]; 0 for a sleeping piece.
    pub fn mass(&self) -> f64 {
        self.mass
    }

    /// Returns whether some nodes of the piece are fixed.
    pub fn has_fixed_nodes(&self) -> bool {
        self.weight > self.mass
    }

    /// Inverse inertia tensor about the centre of mass, by rows [1/kg m²].
    pub fn inverse_inertia(&self) -> [DVec3; 3] {
        inverse(self.inertia())
    }

    /// Inverse of the second moment of mass, by rows [1/kg m²]; in 2D, the row of the third axis is 0.
    pub fn inverse_spread<D: Dim>(&self) -> [DVec3; 3] {
        let mut spread = self.spread;
        if D::N == 2 {
            spread[2][2] = spread[0][0] + spread[1][1];
        }
        let mut inverse = inverse(spread);
        inverse[D::N..].fill(DVec3::ZERO);
        inverse
    }

    /// Inertia tensor about the centre of mass [kg m²].
    fn inertia(&self) -> [DVec3; 3] {
        let squared = self.spread[0][0] + self.spread[1][1] + self.spread[2][2];
        let mut inertia = self.spread.map(|row| -row);
        (0..3).for_each(|k| inertia[k][k] += squared);
        inertia
    }

    /// Returns the rigid motion that has a given linear momentum [kg m/s], and a given angular momentum about
    /// the centre of mass [kg m²/s]; zero for a sleeping piece.
    fn rigid_with(&self, linear: DVec3, angular: DVec3) -> RigidMotion {
        if self.nodes == 0 {
            return RigidMotion::default();
        }
        let velocity = linear / self.weight;
        RigidMotion::of_spin(velocity, self.centre, &angular, &self.inertia())
    }
}

/// Returns the motion of every piece, by piece number; zero for sleeping pieces.
pub fn motions<D: Dim>(body: &SoftBody<D>) -> IndexVec<PieceId, PieceMotion> {
    let count = body.topology.pieces.list.len();
    let mut motions: IndexVec<PieceId, _> = vec![PieceMotion::default(); count].into();
    // Reference point of each piece: its first awake node. Sums about the world origin, which may be far
    // away, would lose precision.
    let mut origins: IndexVec<PieceId, _> = vec![DVec3::ZERO; count].into();
    let of_node = |id| body.topology.pieces.of_node(id);
    // Processes each run of nodes of one piece together, so that the sums of the piece stay in registers.
    for nodes in body.cache.awake.chunk_by(|&a, &b| of_node(a) == of_node(b)) {
        let piece = of_node(nodes[0]);
        let (mut motion, origin) = (motions[piece], &mut origins[piece]);
        if motion.nodes == 0 {
            *origin = wide(body.state.position[nodes[0]]);
        }
        for (&id, (position, velocity, mass)) in nodes.iter().zip(body.states(nodes)) {
            let is_fixed = body.state.inverse_mass[id] == 0.0;
            let mass = f64::from(mass);
            let weight = if is_fixed { mass * FIXED_WEIGHT } else { mass };
            motion.add::<D>(wide(position) - *origin, wide(velocity), mass, weight);
            motion.is_driven |= is_fixed && velocity != Row::ZERO;
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

/// Damping of a piece, as rates [1/s]. [`PieceDamping::over`] converts them to the fractions of velocity that
/// are lost in one damping round.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct PieceDamping {
    /// Damping of the vibration: of all motion relative to the rigid motion of the piece. 0 in a body with
    /// materials of different mass damping, which [`apply_damping`] adds itself.
    pub vibration: f32,
    /// Damping of the angular velocity of the piece.
    pub spin: f32,
    /// Damping of all motion of the piece by the air and by contacts.
    pub drag: f32,
}

impl PieceDamping {
    /// Converts rates to the fractions lost in a damping round of `duration` [s].
    pub fn over(self, duration: f32) -> Self {
        let share = |rate: f32| (rate * duration).min(1.0);
        Self {
            vibration: lost(self.vibration, duration),
            spin: share(self.spin),
            drag: share(self.drag),
        }
    }
}

/// Returns the fraction of a velocity that is lost in `duration` [s] at a damping rate [1/s]: 1 −
/// exp(−x), with x = `rate` · `duration`. The error of the exponent is below x³/1500.
fn lost(rate: f32, duration: f32) -> f32 {
    // exp(−x) = (exp(x/16))⁻¹⁶, with the Taylor series of second order for exp(x/16).
    let x = rate * duration / 16.0;
    let kept = (0..4).fold(1.0 / (1.0 + x + 0.5 * x * x), |kept, _| kept * kept);
    1.0 - kept
}

/// Damps the velocities of a body over `duration` [s], and stores the rigid motion of each piece in the
/// cache. `damping` holds for each piece the fractions of velocity that the piece loses.
pub fn apply_damping<D: Dim>(
    body: &mut SoftBody<D>,
    motions: &[PieceMotion],
    damping: &[PieceDamping],
    duration: f32,
) {
    let rigid: Vec<RigidMotion> = motions.iter().map(PieceMotion::rigid).collect();
    body.cache.rigid.clear();
    body.cache
        .rigid
        .extend(rigid.iter().map(RigidMotion::roughly));
    if body.mass_damping().is_none() {
        damp_by_node(body, motions, &rigid, duration);
    }
    if damping
        .iter()
        .all(|damping| *damping == PieceDamping::default())
    {
        return;
    }
    // New velocity of a node at x: a fraction of its velocity plus the velocity at x of a rigid motion. As a
    // result, the velocity of the centre of mass is multiplied by 1 − drag, the angular velocity by (1 −
    // drag)(1 − spin), and the vibration by (1 − drag)(1 − vibration).
    let new_velocities: Vec<_> = rigid
        .iter()
        .zip(damping)
        .map(
            |(
                rigid,
                &PieceDamping {
                    vibration,
                    spin,
                    drag,
                },
            )| {
                let kept = 1.0 - drag;
                let rigid_velocity = rigid.times(
                    f64::from(kept * vibration),
                    f64::from(kept * (vibration - spin)),
                );
                (kept * (1.0 - vibration), rigid_velocity.roughly())
            },
        )
        .collect();
    let (inverse_mass, position, pieces) = (
        &body.state.inverse_mass,
        &body.state.position,
        &body.topology.pieces,
    );
    let rows = threads::rows(&body.cache.awake, [body.state.velocity.as_mut_slice()]);
    threads::map(rows, |chunk| {
        on_widest_lanes!(_simd => {
            let [velocities] = chunk.lists;
            for Run { ids, rows } in threads::runs(chunk.ids, chunk.first) {
                let masses = &inverse_mass.as_slice()[ids.clone()];
                let places = position.as_slice()[ids.clone()].iter().zip(pieces.of_nodes(ids));
                let nodes = masses.iter().zip(places);
                for (velocity, (&inverse_mass, (&position, piece))) in velocities[rows].iter_mut().zip(nodes) {
                    if inverse_mass != 0.0 {
                        let (kept, rigid_velocity) = &new_velocities[piece.index()];
                        *velocity = *velocity * *kept + rigid_velocity.at::<D>(position);
                    }
                }
            }
        });
    });
}

/// Applies the mass damping of the nodes of a body over `duration` [s], relative to the rigid motion of each
/// piece.
///
/// Nodes of different damping lose a momentum that is not zero in sum. The piece gets it back as a rigid
/// motion. With the rigid motions projected out of it, the damping matrix is symmetric and has no negative
/// eigenvalue: the damping never adds energy.
fn damp_by_node<D: Dim>(
    body: &mut SoftBody<D>,
    motions: &[PieceMotion],
    rigid: &[RigidMotion],
    duration: f32,
) {
    let slowdown = body.slowdown() as f32;
    let state = &mut body.state;
    let pieces = &body.topology.pieces;
    let mut taken = vec![(DVec3::ZERO, DVec3::ZERO); motions.len()];
    let free = |id: &&NodeId| state.inverse_mass[**id] != 0.0;
    let free: Vec<NodeId> = body.cache.awake.iter().filter(free).copied().collect();
    for &id in &free {
        let piece = pieces.of_node(id).index();
        let (position, velocity) = (state.position[id], &mut state.velocity[id]);
        let vibration = wide(*velocity) - rigid[piece].at(position);
        let rate = body.cache.mass_damping[id] / slowdown;
        let change = vibration * -f64::from(lost(rate, duration));
        let impulse = change * f64::from(state.mass[id]);
        taken[piece].0 -= impulse;
        taken[piece].1 -= (wide(position) - motions[piece].centre).cross(impulse);
        *velocity += Row::from(change.as_vec3());
    }
    let returned = motions.iter().zip(taken);
    let returned = returned.map(|(motion, (linear, angular))| motion.rigid_with(linear, angular));
    let returned: Vec<RigidMotion> = returned.collect();
    for &id in &free {
        let change = returned[pieces.of_node(id).index()].at(state.position[id]);
        state.velocity[id] += Row::from(change.as_vec3());
    }
}

#[inline(always)]
fn wide(row: Row) -> DVec3 {
    row.xyz().as_dvec3()
}
