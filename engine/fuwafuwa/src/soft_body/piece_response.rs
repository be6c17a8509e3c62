//! Selective mass scaling: motion of pieces as a whole, in bodies with a mass scale.
//!
//! Let M be the mass matrix of a piece, s the mass scale, and P and A the M-orthogonal projections onto the rigid
//! and the affine motions of the piece. Impulses J change the velocities by W J, with
//!
//! ```text
//! W = M⁻¹/s + (1/a − 1/s) A M⁻¹ + (1 − 1/a) P M⁻¹,    1 ≤ a ≤ s
//! ```
//!
//! Rigid motion therefore has the true mass, affine motion is a times and everything else s times as heavy; a is
//! the smallest value at which the affine motion is stable. Elastic forces have no resultant and gravity is
//! rigid, so P acts on impulses of contacts, joints, knives, fields and the program only. The inverse masses of
//! the nodes contain the first term. A [`PieceResponse`] collects the other two, so that solvers see them at
//! once; [`SoftBody::apply_responses`] then gives them to all nodes of the piece.

use super::SoftBody;
use crate::foundation::dim::Dim;
use crate::foundation::ids::{IndexVec, NodeId, PieceId};
use crate::math::row::Row;
use crate::soft_body::damping::{PieceMotion, motions};
use glam::{DVec3, Vec3};

/// Response of a piece as a whole to impulses, and the velocity that impulses have caused so far.
#[derive(Copy, Clone, Debug, Default)]
pub(crate) struct PieceResponse {
    /// Centre of mass [m].
    centre: Row,
    /// Inverse mass times the share of the response [1/kg]; 0 for a piece that sleeps or has fixed nodes.
    inverse_mass: f32,
    /// Inverse inertia times the share of the rigid response [1/kg m²].
    inverse_inertia: [Vec3; 3],
    /// Inverse second moment of mass times the share of the affine response [1/kg m²].
    inverse_spread: [Vec3; 3],
    /// Whether the piece is awake and has fixed nodes. All its motion has the scaled mass, gravity included.
    has_fixed_nodes: bool,
    /// Whether impulses wait for [`SoftBody::apply_responses`].
    is_pending: bool,
    /// Velocity of the centre [m/s] that the impulses have caused.
    velocity: Row,
    /// Columns of the velocity gradient [1/s] that the impulses have caused.
    gradient: [Row; 3],
}

impl PieceResponse {
    /// Returns the response of a piece with a mass scale, in substeps of `duration` [s]. No affine vibration is
    /// faster than one whose wave has the speed `wave` [m/s].
    fn of<D: Dim>(motion: &PieceMotion, mass_scale: f64, wave: f64, duration: f32) -> Self {
        let has_fixed_nodes = motion.has_fixed_nodes();
        if motion.nodes == 0 || has_fixed_nodes {
            return Self {
                has_fixed_nodes,
                ..Self::default()
            };
        }
        let inverse_spread = motion.inverse_spread::<D>();
        // The elastic energy of a strain ε is at most ½ M c² ε², and the kinetic energy of its rate at least
        // ½ ε'² / |G⁻¹|, with the mass M, the wave speed c and the second moment of mass G.
        let squares = inverse_spread[..D::N].iter();
        let norm = squares.map(|row| row.dot(*row)).sum::<f64>().sqrt();
        let travel = wave * f64::from(duration);
        let affine_scale = (travel * travel * motion.mass() * norm).clamp(1.0, mass_scale);
        let (rigid, affine) = (
            1.0 - 1.0 / affine_scale,
            1.0 / affine_scale - 1.0 / mass_scale,
        );
        Self {
            centre: Row::from(motion.centre.as_vec3()),
            inverse_mass: ((rigid + affine) / motion.mass()) as f32,
            inverse_inertia: motion.inverse_inertia().map(|row| (row * rigid).as_vec3()),
            inverse_spread: inverse_spread.map(|row| (row * affine).as_vec3()),
            ..Self::default()
        }
    }

    /// Returns whether the response is more than that of the nodes alone.
    pub fn acts(&self) -> bool {
        self.inverse_mass > 0.0
    }

    /// Returns the offset of a position from the centre of the piece [m].
    #[inline(always)]
    pub fn offset(&self, at: Row) -> Row {
        at - self.centre
    }

    /// Returns the velocity [m/s] that the impulses so far have caused at an offset from the centre [m].
    #[inline(always)]
    pub fn velocity_at<D: Dim>(&self, offset: Row) -> Row {
        let mut velocity = self.velocity;
        for axis in 0..D::N {
            velocity += self.gradient[axis] * offset[axis];
        }
        velocity
    }

    /// Adds an impulse [N s] at an offset from the centre [m].
    pub fn push<D: Dim>(&mut self, offset: Row, impulse: Row) {
        self.is_pending = true;
        let (offset, impulse) = (offset.xyz(), impulse.xyz());
        self.velocity += Row::from(impulse * self.inverse_mass);
        let angular = times(&self.inverse_inertia, offset.cross(impulse));
        let stretch = times(&self.inverse_spread, offset);
        for axis in 0..D::N {
            let turned = angular.cross(Vec3::AXES[axis]);
            self.gradient[axis] += Row::from(turned + impulse * stretch[axis]);
        }
    }

    /// Adds elastic impulses, given by their sum Σ J ⊗ x over the nodes [N s m] as columns, with the offsets x.
    fn push_moments<D: Dim>(&mut self, moments: &[DVec3; 3]) {
        self.is_pending = true;
        for axis in 0..D::N {
            let of = |k: usize| moments[k] * f64::from(self.inverse_spread[axis][k]);
            self.gradient[axis] += Row::from((of(0) + of(1) + of(2)).as_vec3());
        }
    }

    /// Returns the velocity [m/s] per impulse [N s] along `way`, both at an offset from the centre [m].
    pub fn velocity_per_impulse<D: Dim>(&self, offset: Row, way: Vec3) -> Vec3 {
        let mut fresh = Self {
            velocity: Row::ZERO,
            gradient: [Row::ZERO; 3],
            ..*self
        };
        fresh.push::<D>(offset, Row::from(way));
        fresh.velocity_at::<D>(offset).xyz()
    }

    /// Returns the inverse effective mass [1/kg] along a unit vector, and an upper bound over all directions,
    /// at an offset from the centre [m].
    pub fn inverse_masses_at(&self, offset: Row, way: Row) -> (f32, f32) {
        let (along, most) = self.inverse_masses_between(offset, way);
        (along + self.inverse_mass, most + self.inverse_mass)
    }

    /// Like [`PieceResponse::inverse_masses_at`], but for opposite impulses at two positions of the piece that
    /// are `apart` [m].
    pub fn inverse_masses_between(&self, apart: Row, way: Row) -> (f32, f32) {
        let (apart, way) = (apart.xyz(), way.xyz());
        let by = |matrix: &[Vec3; 3], vector: Vec3| vector.dot(times(matrix, vector));
        let [x, y, z] = self.inverse_inertia;
        let trace = x[0] + y[1] + z[2];
        let affine = by(&self.inverse_spread, apart);
        (
            by(&self.inverse_inertia, apart.cross(way)) + affine,
            trace * apart.length_squared() + affine,
        )
    }

    fn clear(&mut self) {
        (self.velocity, self.gradient) = (Row::ZERO, [Row::ZERO; 3]);
        self.is_pending = false;
    }
}

impl<D: Dim> SoftBody<D> {
    /// Measures the response of each piece for substeps of `duration` [s], if the body has a mass scale.
    pub(crate) fn measure_responses(&mut self, duration: f32) {
        self.cache.responses.clear();
        let mass_scale = self.topology.mass_scale;
        if mass_scale == 1.0 {
            return;
        }
        let wave = 0.5 * self.cache.properties.fastest_breathing;
        let motions = motions(self);
        let responses = motions
            .iter()
            .map(|motion| PieceResponse::of::<D>(motion, mass_scale, wave, duration));
        self.cache.responses = responses.collect();
    }

    /// Returns the responses of the pieces; empty in a body without a mass scale.
    #[inline(always)]
    pub(crate) fn responses(&self) -> &IndexVec<PieceId, PieceResponse> {
        &self.cache.responses
    }

    /// Returns the responses of the pieces; empty in a body without a mass scale.
    pub(crate) fn responses_mut(&mut self) -> &mut IndexVec<PieceId, PieceResponse> {
        &mut self.cache.responses
    }

    /// Returns the response of a piece, if it is more than that of the nodes alone.
    #[inline(always)]
    pub(crate) fn response(&self, piece: PieceId) -> Option<&PieceResponse> {
        let response = self.cache.responses.get(piece.index());
        response.filter(|response| response.acts())
    }

    /// Completes the velocity changes of a substep of `duration` [s] in a body with a mass scale: adds the
    /// affine response to the elastic forces, and reduces `gravity` [m/s²] to 1/s in pieces with fixed nodes.
    pub(super) fn complete_forces(&mut self, duration: f32, gravity: Row) {
        self.measure_responses(duration);
        if self.cache.responses.is_empty() {
            return;
        }
        let excess = gravity * (duration * (1.0 - 1.0 / self.topology.mass_scale) as f32);
        let mut moments = vec![[DVec3::ZERO; 3]; self.cache.responses.len()];
        for &id in &self.cache.awake {
            let piece = self.topology.pieces.of_node(id);
            let response = &self.cache.responses[piece];
            if response.has_fixed_nodes {
                if self.state.inverse_mass[id] > 0.0 {
                    self.state.velocity[id] -= excess;
                }
                continue;
            }
            let force = self.state.batches.force_on(id);
            let impulse = (force * duration).xyz().as_dvec3();
            let offset = response.offset(self.state.position[id]);
            for axis in 0..D::N {
                moments[piece.index()][axis] += impulse * f64::from(offset[axis]);
            }
        }
        for (response, moments) in self.cache.responses.iter_mut().zip(&moments) {
            if response.acts() {
                response.push_moments::<D>(moments);
            }
        }
        self.apply_responses();
    }

    /// Gives the nodes the velocities that impulses have caused in their piece as a whole.
    pub(crate) fn apply_responses(&mut self) {
        let responses = &mut self.cache.responses;
        if !responses.iter().any(|response| response.is_pending) {
            return;
        }
        for &id in &self.cache.awake {
            let response = &responses[self.topology.pieces.of_node(id)];
            if response.is_pending {
                let offset = response.offset(self.state.position[id]);
                self.state.velocity[id] += response.velocity_at::<D>(offset);
            }
        }
        responses.iter_mut().for_each(PieceResponse::clear);
    }

    /// Adds an impulse [N s], which the nodes share by their weights, to the responses of their pieces.
    pub(crate) fn push_responses(&mut self, weights: &[(NodeId, f32)], impulse: Vec3) {
        for &(node, weight) in weights {
            let piece = self.topology.pieces.of_node(node);
            if self.response(piece).is_some() {
                let response = &mut self.cache.responses[piece];
                let offset = response.offset(self.state.position[node]);
                response.push::<D>(offset, Row::from(impulse * weight));
            }
        }
    }

    /// Returns the weighted mean of the velocities [m/s] that [`SoftBody::apply_responses`] will add to nodes.
    pub(crate) fn response_velocity(&self, weights: &[(NodeId, f32)]) -> Vec3 {
        let mut velocity = Vec3::ZERO;
        for &(node, weight) in weights {
            if let Some(response) = self.response(self.topology.pieces.of_node(node)) {
                let offset = response.offset(self.state.position[node]);
                velocity += response.velocity_at::<D>(offset).xyz() * weight;
            }
        }
        velocity
    }

    /// Returns the matrix of the responses to impulses that nodes share by their weights, by rows [1/kg].
    pub(crate) fn response_matrix(&self, weights: &[(NodeId, f32)]) -> [Vec3; 3] {
        let mut matrix = [Vec3::ZERO; 3];
        if self.cache.responses.is_empty() {
            return matrix;
        }
        let mut pieces: Vec<(PieceId, f32, Row)> = Vec::new();
        for &(node, weight) in weights {
            let piece = self.topology.pieces.of_node(node);
            let part = self.state.position[node] * weight;
            match pieces.iter_mut().find(|(other, ..)| *other == piece) {
                Some((_, sum, at)) => (*sum, *at) = (*sum + weight, *at + part),
                None => pieces.push((piece, weight, part)),
            }
        }
        for (piece, weight, at) in pieces {
            let Some(response) = self.response(piece).filter(|_| weight > 0.0) else {
                continue;
            };
            let offset = response.offset(at * (1.0 / weight));
            for axis in 0..D::N {
                let velocity = response.velocity_per_impulse::<D>(offset, Vec3::AXES[axis]);
                // The matrix is symmetric.
                matrix[axis] += velocity * (weight * weight);
            }
        }
        matrix
    }
}

/// Returns the product of a matrix, given by rows, with a vector.
#[inline(always)]
fn times(rows: &[Vec3; 3], vector: Vec3) -> Vec3 {
    Vec3::from(rows.map(|row| row.dot(vector)))
}
