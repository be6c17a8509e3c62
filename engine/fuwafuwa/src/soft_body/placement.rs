//! Position, orientation, velocity and user-defined properties of a whole body.

use super::SoftBody;
use super::body_state::State;
use crate::foundation::dim::{Dim, DimVector, turning};
use crate::foundation::ids::NodeId;
use crate::math::rotation::Rotation;
use crate::math::twist::Twist;
use crate::math::velocity::Velocity;
use crate::rigid_body::layers::Layers;
use crate::rigid_body::solid::flat;
use crate::soft_body::element_forces::Row;
use crate::soft_body::momentum::{Momentum, RigidMotion, centre_of};
use glam::Vec3;

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

    /// Returns the body translated by `by` [m]. Pieces whose positions become non-finite are quarantined in
    /// their first tick.
    #[inline(never)]
    pub fn translated(mut self, by: D::Vector) -> Self {
        self.shift(by.to_vec3());
        self
    }

    /// Returns the body rotated about `point` [m] as a rigid body, without strain. In 2D, only the part of
    /// the rotation about the third axis is applied. Pieces whose positions become non-finite are quarantined
    /// in their first tick.
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
    /// The response of the pieces as a whole is that of substeps of `duration` [s].
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
