//! Read access to the rigid bodies of a world.

use crate::foundation::dim::{Dim, DimVector};
use crate::math::rotation::Rotation;
use crate::math::velocity::Velocity;
use crate::rigid_body::layers::Layers;
use crate::rigid_body::rigid_state::RigidState;
use crate::rigid_body::shape::Shape;
use crate::rigid_body::{MotionType, Reaction, RigidBody};
use std::marker::PhantomData;

/// Read access to a rigid body of a world; see [`World::rigid_body`](crate::World::rigid_body).
#[derive(Copy, Clone, Debug)]
pub struct RigidBodyRef<'a, D: Dim> {
    state: &'a RigidState,
    dim: PhantomData<D>,
}

impl<'a, D: Dim> RigidBodyRef<'a, D> {
    pub(crate) fn new(state: &'a RigidState) -> Self {
        let dim = PhantomData;
        Self { state, dim }
    }

    /// Returns a definition of the body with its present pose, velocity and target, for example to add a
    /// copy. The definition contains no sleep state and no reactions.
    pub fn definition(&self) -> RigidBody<D> {
        self.state.definition()
    }

    /// Returns the motion type.
    pub fn motion_type(&self) -> MotionType {
        self.state.motion_type
    }

    /// Returns whether the body is dynamic.
    pub fn is_dynamic(&self) -> bool {
        self.state.is_dynamic()
    }

    /// Returns whether the body is kinematic or coupled.
    pub fn follows_target(&self) -> bool {
        self.state.follows_target()
    }

    /// Returns whether the body is dynamic and sleeps.
    pub fn is_asleep(&self) -> bool {
        self.state.is_asleep()
    }

    /// Returns the position of the local origin [m].
    pub fn position(&self) -> D::Vector {
        D::Vector::from_vec3(self.state.position())
    }

    /// Returns the rotation from local to world axes.
    pub fn rotation(&self) -> Rotation {
        self.state.rotation()
    }

    /// Returns the linear and angular velocity.
    pub fn velocity(&self) -> Velocity<D> {
        Velocity::from(self.state.twist())
    }

    /// Returns the target position of a kinematic or coupled body [m]; meaningless for other motion types.
    pub fn target_position(&self) -> D::Vector {
        D::Vector::from_vec3(self.state.target_position())
    }

    /// Returns the target rotation of a kinematic or coupled body; meaningless for other motion types.
    pub fn target_rotation(&self) -> Rotation {
        self.state.target_rotation()
    }

    /// Returns the shape in world coordinates.
    pub fn shape(&self) -> Shape<D> {
        Shape::of(self.state.shape())
    }

    /// Returns the shape in local coordinates.
    pub fn local_shape(&self) -> Shape<D> {
        Shape::of(self.state.local_shape())
    }

    /// Returns the [friction](RigidBody::friction) coefficient.
    pub fn friction(&self) -> f32 {
        self.state.friction
    }

    /// Returns the [restitution](RigidBody::restitution) coefficient.
    pub fn restitution(&self) -> f32 {
        self.state.restitution
    }

    /// Returns the collision layers.
    pub fn layers(&self) -> Layers {
        self.state.layers
    }

    /// Returns whether the body is a [sensor](RigidBody::is_sensor).
    pub fn is_sensor(&self) -> bool {
        self.state.is_sensor
    }

    /// Returns the user data, a number that the engine ignores.
    pub fn user_data(&self) -> u64 {
        self.state.user_data
    }

    /// Returns the forces and torques on the body, one [`Reaction`] for each substep of the last tick; none
    /// for a fixed body.
    pub fn reactions(
        &self,
    ) -> impl ExactSizeIterator<Item = Reaction<D>> + DoubleEndedIterator + use<'a, D> {
        self.state.reactions().iter().map(Reaction::from)
    }
}
