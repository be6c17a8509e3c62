//! Position, orientation, velocity and user-defined properties of a whole body.

use super::SoftBody;
use super::body_state::State;
use crate::error::Error;
use crate::foundation::dim::{Dim, DimVector, turning};
use crate::foundation::ids::{NodeId, PieceId};
use crate::math::rotation::Rotation;
use crate::math::twist::Twist;
use crate::math::velocity::Velocity;
use crate::rigid_body::layers::Layers;
use crate::rigid_body::solid::flat;
use crate::rigid_body::{range_of, require_in_range};
use crate::soft_body::element_forces::Row;
use crate::soft_body::momentum::{Momentum, RigidMotion, centre_of};
use glam::{DVec3, Vec3};
use std::collections::BTreeSet;

/// Motion of a piece as a whole.
#[derive(Copy, Clone, Debug, Default)]
pub(crate) struct WholePiece {
    /// Mass [kg].
    pub mass: f64,
    /// Centre of mass [m].
    pub centre: DVec3,
    /// Velocity of the centre of mass [m/s].
    pub velocity: DVec3,
    /// Whether the piece has fixed nodes or is quarantined.
    pub is_held: bool,
}

impl<D: Dim> SoftBody<D> {
    /// Collision layers of the body: see [`World::set_layers`](crate::World::set_layers).
    pub fn layers(&self) -> Layers {
        self.state.layers
    }

    /// User data of the body: see [`World::set_user_data`](crate::World::set_user_data).
    pub fn user_data(&self) -> u64 {
        self.state.user_data
    }

    /// Factor by which gravity is multiplied for this body, default 1: see
    /// [`World::set_gravity_scale`](crate::World::set_gravity_scale).
    pub fn gravity_scale(&self) -> f32 {
        self.state.gravity_scale
    }

    /// Largest absolute coordinate [m] at which the body may be [added](crate::World::add_soft_body) to a world
    /// or moved by hand: 8192 voxels, 128 m for voxels of 1/64 m. Up to there, rounding in single precision
    /// changes the shape of the body at rest by less than 1 % of a voxel. A piece that moves beyond it by
    /// itself is reported, see [`Event::LeftRange`](crate::Event::LeftRange).
    pub fn range(&self) -> f32 {
        range_of(self.topology.grid.voxel_size())
    }

    /// Returns an error if a node is out of [range](SoftBody::range) after `moved` maps its position [m].
    pub(crate) fn check_range(&self, moved: impl Fn(Vec3) -> Vec3) -> Result<(), Error> {
        let size = self.topology.grid.voxel_size();
        let mut nodes = self.topology.mesh.nodes();
        nodes.try_for_each(|(id, _)| {
            let at = flat::<D>(moved(self.state.position[id].xyz()));
            require_in_range(at, size, "the voxels")
        })
    }

    /// Returns the pieces that left the [range](SoftBody::range) since the start of the tick.
    pub(crate) fn pieces_out_of_range(&self) -> Vec<PieceId> {
        let range = self.range();
        let is_out = |at: Row| at.xyz().abs().max_element() > range;
        let out = self.cache.awake.iter();
        let out = out.filter(|&&id| is_out(self.state.position[id]));
        let mut pieces: Vec<PieceId> = out.map(|&id| self.topology.pieces.of_node(id)).collect();
        pieces.sort_unstable();
        pieces.dedup();
        if pieces.is_empty() {
            return pieces;
        }
        let nodes = self.topology.mesh.nodes();
        let were_out = nodes.filter(|&(id, node)| is_out(self.position_before(id, node.at)));
        let were_out: BTreeSet<PieceId> = were_out
            .map(|(id, _)| self.topology.pieces.of_node(id))
            .collect();
        pieces.retain(|piece| !were_out.contains(piece));
        pieces
    }

    /// Returns the body translated by `by` [m].
    #[inline(never)]
    pub fn translated(mut self, by: D::Vector) -> Self {
        self.shift(by.to_vec3());
        self
    }

    /// Returns the body rotated about `point` [m] as a rigid body, without strain. In 2D, only the part of
    /// the rotation about the third axis is applied.
    ///
    /// ```
    /// use fuwafuwa::{SoftBody, Dim2, Material, Rotation, VoxelGrid};
    ///
    /// let grid = VoxelGrid::<Dim2>::from_fn([8, 4, 1], 0.25, |_| 1)?;
    /// let body = SoftBody::new(grid, &[Material::default()])?;
    /// let centre = body.centre_of_mass();
    /// let upright = body.rotated_about(Rotation::in_plane(1.5708), centre);
    /// assert!(upright.centre_of_mass().distance(centre) < 1e-5);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[inline(never)]
    #[must_use]
    pub fn rotated_about(mut self, rotation: Rotation, point: D::Vector) -> Self {
        self.turn(rotation, point.to_vec3());
        self
    }

    /// Returns the body rotated about its centre of mass; otherwise like [`SoftBody::rotated_about`].
    #[must_use]
    pub fn rotated(self, rotation: Rotation) -> Self {
        let centre = self.centre_of_mass();
        self.rotated_about(rotation, centre)
    }

    /// Returns the body with every node moving as in a rigid motion. `velocity` is the linear velocity [m/s],
    /// or the linear velocity and the angular velocity [rad/s] about the centre of mass.
    #[must_use]
    pub fn with_velocity(self, velocity: impl Into<Velocity<D>>) -> Self {
        self.moving_at(velocity.into().twist())
    }

    #[inline(never)]
    pub(crate) fn moving_at(mut self, velocity: Twist) -> Self {
        let linear = velocity.linear;
        for row in self.state.velocity.iter_mut() {
            *row = Row::from(linear);
        }
        let angular = turning::<D>(velocity.angular);
        if angular != Vec3::ZERO {
            let centre = self.centre();
            for (id, _) in self.topology.mesh.nodes() {
                let lever = self.state.position[id].xyz() - centre;
                add::<D>(&mut self.state.velocity[id], angular.cross(lever));
            }
        }
        self
    }

    /// Returns the body with other collision layers.
    #[must_use]
    pub fn with_layers(mut self, layers: Layers) -> Self {
        self.state.layers = layers;
        self
    }

    /// Returns the body with other user data.
    #[must_use]
    pub fn with_user_data(mut self, user_data: u64) -> Self {
        self.state.user_data = user_data;
        self
    }

    /// Centre of mass [m].
    pub fn centre_of_mass(&self) -> D::Vector {
        D::Vector::from_vec3(self.centre())
    }

    #[inline(never)]
    fn centre(&self) -> Vec3 {
        let nodes: Vec<NodeId> = self.topology.mesh.nodes().map(|(id, _)| id).collect();
        let states = self.states(&nodes).map(|(at, _, mass)| (at, mass));
        centre_of(states).as_vec3()
    }

    pub(crate) fn shift(&mut self, by: Vec3) {
        let State {
            position, ahead, ..
        } = &mut self.state;
        for row in position.iter_mut().chain(ahead.iter_mut()) {
            for axis in 0..D::N {
                row[axis] += by[axis];
            }
        }
    }

    pub(crate) fn turn(&mut self, rotation: Rotation, about: Vec3) {
        let rotation = rotation.seen_in::<D>();
        let about = flat::<D>(about);
        let State {
            position,
            velocity,
            ahead,
            batches,
            ..
        } = &mut self.state;
        for row in position.iter_mut().chain(ahead.iter_mut()) {
            *row = Row::from(rotation.apply_about(row.xyz(), about));
        }
        for row in velocity.iter_mut() {
            *row = Row::from(rotation.apply(row.xyz()));
        }
        batches.rotate(rotation);
    }

    /// Translates a piece by `by` [m], and adds a velocity [m/s].
    pub(crate) fn shift_piece(&mut self, piece: PieceId, by: Vec3, velocity: Vec3) {
        for (id, _) in self.topology.mesh.nodes() {
            if self.topology.pieces.of_node(id) == piece {
                add::<D>(&mut self.state.position[id], by);
                add::<D>(&mut self.state.ahead[id], by);
                add::<D>(&mut self.state.velocity[id], velocity);
            }
        }
    }

    /// Returns the motion of a piece as a whole.
    pub(crate) fn motion_of_piece(&self, piece: PieceId) -> WholePiece {
        let mut motion = WholePiece {
            is_held: self.topology.pieces.list[piece].quarantined,
            ..WholePiece::default()
        };
        for (id, _) in self.topology.mesh.nodes() {
            if self.topology.pieces.of_node(id) == piece {
                let mass = f64::from(self.state.mass[id]);
                motion.mass += mass;
                motion.centre += self.state.position[id].xyz().as_dvec3() * mass;
                motion.velocity += self.state.velocity[id].xyz().as_dvec3() * mass;
                motion.is_held |= self.state.fixed[id];
            }
        }
        motion.centre /= motion.mass;
        motion.velocity /= motion.mass;
        motion
    }

    /// Returns the velocity of the centre of mass [m/s], and the angular velocity [rad/s] that a rigid body
    /// with the same mass distribution and angular momentum would have.
    pub(crate) fn rigid_velocity(&self) -> Twist {
        let nodes: Vec<NodeId> = self.topology.mesh.nodes().map(|(id, _)| id).collect();
        let masses = || self.states(&nodes).map(|(at, _, mass)| (at, mass));
        let centre = centre_of(masses());
        let momentum = Momentum::of(self.states(&nodes), centre);
        RigidMotion::with_momentum(masses(), centre, momentum).velocity()
    }

    /// Gives all nodes that are neither fixed nor asleep the velocity of a rigid motion: linear [m/s], and
    /// angular [rad/s] about the centre of mass.
    pub(crate) fn set_velocity(&mut self, velocity: Twist) {
        for (id, _) in self.topology.mesh.nodes() {
            if self.state.inverse_mass[id] > 0.0 {
                self.state.velocity[id] = Row::ZERO;
            }
        }
        self.add_velocity(velocity.linear, velocity.angular);
    }

    /// Adds the velocity of a rigid motion to all nodes that are neither fixed nor asleep. The rigid motion
    /// is `linear` [m/s], and `angular` [rad/s] about the centre of mass.
    pub(crate) fn add_velocity(&mut self, linear: Vec3, angular: Vec3) {
        let centre = self.centre();
        let angular = turning::<D>(angular);
        for (id, _) in self.topology.mesh.nodes() {
            if self.state.inverse_mass[id] > 0.0 {
                let lever = self.state.position[id].xyz() - centre;
                let added = linear + angular.cross(lever);
                add::<D>(&mut self.state.velocity[id], added);
            }
        }
    }

    /// Distributes an impulse [N s] over the nodes within `radius` [m] of the point `at`, in proportion to
    /// their mass, so that these nodes all gain the same velocity. If the radius contains no node, the
    /// nearest node receives the whole impulse. Fixed and sleeping nodes are skipped.
    /// `duration` is the substep [s] for which a body with a mass scale responds.
    pub(crate) fn add_impulse(&mut self, at: Vec3, radius: f32, impulse: Vec3, duration: f32) {
        let nodes = self.topology.mesh.nodes().map(|(id, _)| id);
        let free = nodes.filter(|&id| self.state.inverse_mass[id] > 0.0);
        let at = flat::<D>(at);
        let squared = |id: NodeId| {
            let apart = self.state.position[id].xyz() - at;
            apart.length_squared()
        };
        let free: Vec<(NodeId, f32)> = free.map(|id| (id, squared(id))).collect();
        let is_within = |(_, squared): &&(NodeId, f32)| *squared <= radius * radius;
        let mut reached: Vec<NodeId> = free.iter().filter(is_within).map(|&(id, _)| id).collect();
        if reached.is_empty() {
            let nearest = free.iter().min_by(|a, b| a.1.total_cmp(&b.1));
            reached.extend(nearest.map(|&(id, _)| id));
        }
        let mass: f32 = reached.iter().map(|&id| self.state.mass[id]).sum();
        let own = impulse / self.topology.mass_scale as f32;
        for &id in &reached {
            add::<D>(&mut self.state.velocity[id], own / mass);
        }
        if self.topology.mass_scale > 1.0 {
            let weight = |&id: &NodeId| (id, self.state.mass[id] / mass);
            let weights: Vec<(NodeId, f32)> = reached.iter().map(weight).collect();
            self.refresh_awake();
            self.measure_responses(duration);
            self.push_responses(&weights, flat::<D>(impulse));
            self.apply_responses();
        }
    }
}

fn add<D: Dim>(row: &mut Row, vector: Vec3) {
    for axis in 0..D::N {
        row[axis] += vector[axis];
    }
}
