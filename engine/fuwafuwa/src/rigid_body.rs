//! Rigid bodies: fixed, kinematic, coupled and dynamic.
//!
//! A coupled rigid body follows its target through a spring and a damper, the *virtual coupling* [Colgate
//! 1995]. Because the body has inertia, the coupling force is smooth, whereas the raw contact force jumps. A
//! force-feedback device should therefore play the coupling force. Contacts rotate only dynamic rigid bodies.
//! Kinematic and coupled bodies rotate to their target rotation.

mod dynamics;
mod inertia;
pub mod layers;
mod reach;
mod rigid_body_ref;
mod rigid_state;
mod rigid_state_check;
pub mod shape;
pub mod solid;

use crate::foundation::dim::{Dim, DimAngular, DimVector};
use crate::foundation::hash::hash_state;
use crate::math::rotation::Rotation;
use crate::math::velocity::Velocity;
use crate::rigid_body::layers::Layers;
use crate::rigid_body::shape::Shape;
use crate::rigid_body::solid::Solid;
use inertia::Inertia;
pub use reach::FARTHEST;
pub(crate) use reach::{is_within_reach, range_of, require_in_range};
pub use rigid_body_ref::RigidBodyRef;
pub(crate) use rigid_state::{ReactionSum, RigidBodies, RigidState};
pub(crate) use rigid_state_check::{check_friction, check_restitution};

/// Motion type of a rigid body.
#[derive(Copy, Clone, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum MotionType {
    /// Fixed: never moves. Bodies resting on it may sleep.
    Fixed,
    /// Kinematic: reaches its target pose at the end of each tick, through any obstacle.
    Kinematic,
    /// Coupled: pulled towards its target position by a spring and a damper, and stopped by contacts.
    /// Contacts do not rotate the body; it rotates to its target rotation.
    Coupled {
        /// Mass [kg], 1e-6 to 1e6, default 2. A lighter body follows faster and feels rougher.
        mass: f32,
        /// Spring stiffness [N/m], default 3000. To keep the spring stable, the stiffness is limited to mass
        /// / (4 h²), where h is the length of a substep [s].
        stiffness: f32,
        /// Damping ratio, above 0 and up to 10, default 0.9. Below 0.5 the body oscillates around its target.
        damping: f32,
        /// Maximum force of the coupling [N], default 1000; infinite = no limit.
        max_force: f32,
    },
    /// Dynamic: moved and rotated by gravity and contacts. The shape must be bounded and centred on its
    /// origin, see [`RigidBody::dynamic`].
    Dynamic {
        /// Mass [kg], 1e-6 to 1e6, with uniform density. A body ten times as heavy as the soft or rigid body
        /// under it sinks into that body.
        mass: f32,
    },
}

hash_state! {
    enum MotionType {
        Fixed,
        Kinematic,
        Coupled { mass, stiffness, damping, max_force },
        Dynamic { mass },
    }
}

impl MotionType {
    /// Returns whether the body follows a target: it is kinematic or coupled.
    pub fn follows_target(self) -> bool {
        matches!(self, Self::Kinematic | Self::Coupled { .. })
    }

    /// Returns the moments of inertia of a body with this motion type and shape in a world of dimension `D`;
    /// `None` unless the type is dynamic.
    fn inertia<D: Dim>(self, shape: &Solid) -> Option<Inertia> {
        match self {
            Self::Dynamic { mass } => Some(Inertia::of::<D>(shape, mass)),
            _ => None,
        }
    }
}

impl Default for MotionType {
    fn default() -> Self {
        Self::Coupled {
            mass: 2.0,
            stiffness: 3000.0,
            damping: 0.9,
            max_force: 1000.0,
        }
    }
}

/// Rigid body to add with [`World::add_rigid_body`](crate::World::add_rigid_body). Of a soft body, only the nodes
/// collide with rigid bodies. A rigid body thinner than three voxels may slip between the nodes.
///
/// ```
/// use fuwafuwa::{Dim3, RigidBody, Rotation, Shape, Vec3, World, WorldConfig};
///
/// let mut world = World::<Dim3>::new(WorldConfig::default())?;
/// let floor = Shape::half_space(Vec3::Y, Vec3::ZERO);
/// world.add_rigid_body(RigidBody::fixed(floor).with_friction(0.5))?;
/// let cube = RigidBody::dynamic(Shape::cuboid(Vec3::splat(0.5)), 10.0)
///     .at(Vec3::new(0.0, 2.0, 0.0))
///     .rotated(Rotation::about(Vec3::new(1.0, 1.0, 0.0), 0.4));
/// let cube = world.add_rigid_body(cube)?;
/// for _ in 0..180 {
///     world.step();
/// }
/// let cube = world.rigid_body(cube)?;
/// assert!((cube.position().y - 0.5).abs() < 0.01 && cube.is_asleep());
/// # Ok::<(), fuwafuwa::Error>(())
/// ```
#[derive(Copy, Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound = ""))]
pub struct RigidBody<D: Dim> {
    /// Motion type.
    pub motion_type: MotionType,
    /// Shape in local coordinates. The shape of a dynamic body must be bounded and centred on the local
    /// origin.
    pub shape: Shape<D>,
    /// Position of the local origin [m], default 0.
    pub position: D::Vector,
    /// Rotation from local to world axes, default none. In 2D only the part about the third axis is used.
    pub rotation: Rotation,
    /// Initial velocity, default 0. A fixed body ignores it, and a coupled body uses only the linear part. A
    /// kinematic body gets the velocity towards its target in the first tick instead.
    pub velocity: Velocity<D>,
    /// Target position of a kinematic or coupled body [m]; `None` (default) = its position.
    pub target_position: Option<D::Vector>,
    /// Target rotation of a kinematic or coupled body; `None` (default) = its rotation.
    pub target_rotation: Option<Rotation>,
    /// Coulomb friction coefficient, default 0.2; 0.5 from [`RigidBody::dynamic`]. Contacts with soft bodies use this
    /// value alone and ignore the friction of the material. Contacts between two rigid bodies use:
    /// - the mean of both values, if neither is fixed
    /// - the value of the fixed body, if the other is dynamic
    /// - the value of the other body, if it is kinematic or coupled and touches a fixed body
    pub friction: f32,
    /// Restitution coefficient, 0 to 1, default 0. Used in contacts between two rigid bodies of which at
    /// least one is dynamic; the larger of the two values applies. In contacts with soft bodies, elasticity
    /// alone determines the rebound.
    pub restitution: f32,
    /// Collision layers. By default, the body is in the first layer and collides with all layers.
    pub layers: Layers,
    /// Whether the body is a sensor, default false. A sensor has no contacts, but reports
    /// [`Event::SensorEntered`](crate::Event::SensorEntered) and
    /// [`Event::SensorExited`](crate::Event::SensorExited).
    pub is_sensor: bool,
    /// Number for use by the program; the engine ignores it.
    pub user_data: u64,
}

/// Force and torque on a rigid body in one substep.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound = ""))]
pub struct Reaction<D: Dim> {
    /// Contact force on the body [N]. Discontinuous when a soft body tears.
    pub contact: D::Vector,
    /// Torque of contacts and knives on the body about its [position](RigidBodyRef::position) [N m]; in 2D
    /// positive is counterclockwise.
    pub torque: D::Angular,
    /// Force of the virtual coupling on the target, opposite to its force on the body [N]. A force-feedback
    /// device should play this force.
    pub coupling: D::Vector,
}

impl<D: Dim> From<&ReactionSum> for Reaction<D> {
    fn from(sum: &ReactionSum) -> Self {
        Self {
            contact: D::Vector::from_vec3(sum.contact),
            torque: D::Angular::from_vec3(sum.torque),
            coupling: D::Vector::from_vec3(sum.coupling),
        }
    }
}

impl<D: Dim> RigidBody<D> {
    /// Returns a rigid body of any motion type, at rest at the origin.
    pub fn new(shape: Shape<D>, motion_type: MotionType) -> Self {
        Self {
            motion_type,
            shape,
            position: D::Vector::ZERO,
            rotation: Rotation::NONE,
            velocity: Velocity::default(),
            target_position: None,
            target_rotation: None,
            friction: 0.2,
            restitution: 0.0,
            layers: Layers::default(),
            is_sensor: false,
            user_data: 0,
        }
    }

    /// Returns a fixed rigid body.
    pub fn fixed(shape: Shape<D>) -> Self {
        Self::new(shape, MotionType::Fixed)
    }

    /// Returns a kinematic rigid body.
    pub fn kinematic(shape: Shape<D>) -> Self {
        Self::new(shape, MotionType::Kinematic)
    }

    /// Returns a coupled rigid body with the default coupling.
    pub fn coupled(shape: Shape<D>) -> Self {
        Self::new(shape, MotionType::default())
    }

    /// Returns a dynamic rigid body of a mass [kg]. The centre of the bounding box of `shape` becomes the position of
    /// the body.
    pub fn dynamic(shape: Shape<D>, mass: f32) -> Self {
        let [low, high] = shape.bounds();
        let middle = (low + high) * 0.5;
        let middle = match middle.is_finite() {
            true => middle,
            false => D::Vector::ZERO,
        };
        Self {
            friction: 0.5,
            position: middle,
            ..Self::new(shape.translated(-middle), MotionType::Dynamic { mass })
        }
    }

    /// Returns the body with its local origin at a position [m]. The centre of the shape is there only if the
    /// shape is centred on the local origin, as [`RigidBody::dynamic`] makes it.
    #[must_use]
    pub fn at(self, position: D::Vector) -> Self {
        Self { position, ..self }
    }

    /// Returns the body translated by the vector `by` [m]. Its target position is translated, too.
    #[must_use]
    pub fn translated(self, by: D::Vector) -> Self {
        Self {
            position: self.position + by,
            target_position: self.target_position.map(|target| target + by),
            ..self
        }
    }

    /// Returns the body rotated about its own [`position`](RigidBody::position). Its target rotation is
    /// rotated, too. In 2D only the part of the rotation about the third axis is applied.
    #[must_use]
    pub fn rotated(self, by: Rotation) -> Self {
        let by = by.seen_in::<D>();
        Self {
            rotation: self.rotation.then(by),
            target_rotation: self.target_rotation.map(|target| target.then(by)),
            ..self
        }
    }

    /// Returns the body rotated about a point [m]. Its velocity and its target are rotated, too. In 2D only
    /// the part of the rotation about the third axis is applied.
    #[must_use]
    pub fn rotated_about(self, rotation: Rotation, point: D::Vector) -> Self {
        let rotation = rotation.seen_in::<D>();
        let about = |position: D::Vector| {
            let turned = rotation.apply_about(position.to_vec3(), point.to_vec3());
            D::Vector::from_vec3(turned)
        };
        let Velocity { linear, angular } = self.velocity;
        let angular = rotation.apply(angular.to_vec3());
        Self {
            position: about(self.position),
            rotation: self.rotation.then(rotation),
            velocity: Velocity {
                linear: rotation.apply(linear),
                angular: D::Angular::from_vec3(angular),
            },
            target_position: self.target_position.map(about),
            target_rotation: self.target_rotation.map(|target| target.then(rotation)),
            ..self
        }
    }

    /// Returns the body with a velocity: linear, or linear and angular.
    #[must_use]
    pub fn with_velocity(self, velocity: impl Into<Velocity<D>>) -> Self {
        Self {
            velocity: velocity.into(),
            ..self
        }
    }

    /// Returns the body with another motion type.
    #[must_use]
    pub fn with_motion_type(self, motion_type: MotionType) -> Self {
        Self {
            motion_type,
            ..self
        }
    }

    /// Returns the body with another [friction](RigidBody::friction) coefficient.
    #[must_use]
    pub fn with_friction(self, friction: f32) -> Self {
        Self { friction, ..self }
    }

    /// Returns the body with another [restitution](RigidBody::restitution) coefficient.
    #[must_use]
    pub fn with_restitution(self, restitution: f32) -> Self {
        Self {
            restitution,
            ..self
        }
    }

    /// Returns the body with other collision layers.
    #[must_use]
    pub fn with_layers(self, layers: Layers) -> Self {
        Self { layers, ..self }
    }

    /// Returns the body as a [sensor](RigidBody::is_sensor) if `is_sensor` is true, otherwise as a body with
    /// contacts.
    #[must_use]
    pub fn with_sensor(self, is_sensor: bool) -> Self {
        Self { is_sensor, ..self }
    }

    /// Returns the body with other [user data](RigidBody::user_data).
    #[must_use]
    pub fn with_user_data(self, user_data: u64) -> Self {
        Self { user_data, ..self }
    }
}
