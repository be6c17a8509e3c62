//! Components of soft and rigid bodies.

use crate::asset::Voxels;
pub use crate::colours::SoftColours;
use crate::dimension::Dimension;
use crate::queue::{Queue, Request};
use bevy_asset::Handle;
use bevy_ecs::component::Component;
use bevy_ecs::lifecycle::HookContext;
use bevy_ecs::world::DeferredWorld;
use bevy_math::Vec3;
use bevy_transform::components::Transform;
use fuwafuwa::{
    DimVector, Error, Layers, Material, MotionType, RigidBodyHandle, Shape, SoftBodyHandle,
    VoxelGrid,
};

/// Soft body, made from voxels. It enters the world at the beginning of the next tick, at the pose of its
/// `Transform`, and gets [`SoftBodyId`] and a mesh. Inserting the component again replaces the body. Removing
/// the component or despawning the entity removes the body.
#[derive(Component, Clone, Debug)]
#[component(on_insert = soft_body_arrives::<D>, on_discard = soft_body_leaves::<D>)]
#[require(Transform, SoftMaterials)]
pub struct SoftBody<D: Dimension> {
    pub(crate) source: Source<D>,
}

/// Source of the voxels of a body.
#[derive(Clone, Debug)]
pub(crate) enum Source<D: Dimension> {
    Grid(Result<VoxelGrid<D>, Error>),
    Asset(Handle<Voxels<D>>),
}

/// Materials of a soft body, number 1 first. The last material of the list is used for all higher numbers.
/// The component is read when the body enters the world.
#[derive(Component, Clone, Debug, PartialEq)]
pub struct SoftMaterials(pub Vec<Material>);

/// Velocity of a soft body as a whole, or of a rigid body. The component gives the initial velocity when the
/// body enters the world, and is updated after each tick. If you change it, the next tick adds the difference
/// to a soft body, and sets the velocity of a dynamic rigid body. For other rigid bodies it is read-only.
#[derive(Component, Copy, Clone, Debug, Default, PartialEq)]
pub struct Velocity {
    /// Velocity of the centre of mass [m/s].
    pub linear: Vec3,
    /// Angular velocity about the centre of mass [rad/s]. In 2D only z is used.
    pub angular: Vec3,
}

/// Impulse on a soft body or a dynamic rigid body. It is applied in the next tick, and the component is
/// removed.
#[derive(Component, Copy, Clone, Debug, PartialEq)]
pub struct ExternalImpulse {
    /// Impulse [N s].
    pub impulse: Vec3,
    /// Point of application, world space [m].
    pub point: Vec3,
    /// Radius within which the nodes of a soft body share the impulse [m]. If no node is within this radius,
    /// the nearest node gets the whole impulse, which tears most bodies.
    pub radius: f32,
}

/// Gravity multiplier of a soft body, −100 to 100; 1 without this component.
#[derive(Component, Copy, Clone, Debug, PartialEq)]
pub struct GravityScale(pub f32);

/// Marks a soft body without a mesh, for servers or custom rendering. Read when the body enters the world.
#[derive(Component, Copy, Clone, Debug, Default)]
pub struct WithoutMesh;

/// Handle in the engine of the soft body of an entity. See also [`crate::SoftWorld::entity_of_soft_body`].
#[derive(Component, Copy, Clone, Debug, PartialEq, Eq)]
pub struct SoftBodyId(pub SoftBodyHandle);

/// Rigid body: fixed, kinematic, coupled or dynamic. The shape is given in the frame of the entity and should
/// be centred on the origin. The `Transform` scales, rotates and translates it when it enters the world.
/// After that the size and all fields stay fixed: insert the component again to change them.
///
/// [`MotionType`] selects the type of motion:
/// - [`MotionType::Fixed`] bodies do not move.
/// - [`MotionType::Kinematic`] bodies reach the pose of their `Transform` at the end of the next tick, at constant
///   velocity.
/// - [`MotionType::Coupled`] bodies are pulled to their [`TargetPosition`] without rotating; their
///   `Transform` shows the position reached.
/// - [`MotionType::Dynamic`] bodies fall, rotate and are pushed by contacts; their `Transform` follows them.
///   See [`RigidBody::dynamic`].
///
/// Writing the `Transform` of a body that is not kinematic teleports it and keeps its velocity.
#[derive(Component, Clone, Debug, PartialEq)]
#[component(on_insert = rigid_body_arrives::<D>, on_discard = rigid_body_leaves::<D>)]
#[require(Transform)]
pub struct RigidBody<D: Dimension> {
    /// Shape in the frame of the entity.
    pub shape: Shape<D>,
    /// Coefficient of Coulomb friction, usually 0.2 to 0.8.
    pub friction: f32,
    /// Coefficient of restitution, 0 to 1, in contacts between two rigid bodies of which at least one is
    /// dynamic. A contact uses the larger value of the two bodies.
    pub restitution: f32,
    /// Whether the body is a sensor: it has no contact response and sends
    /// [`SensorEntered`](crate::message::SensorEntered) and [`SensorExited`](crate::message::SensorExited).
    pub is_sensor: bool,
    /// Collision layers.
    pub layers: Layers,
    /// Type of motion.
    pub motion_type: MotionType,
}

/// Target position of a [`MotionType::Coupled`] rigid body, world space [m].
#[derive(Component, Copy, Clone, Debug, PartialEq)]
pub struct TargetPosition(pub Vec3);

/// Handle in the engine of the rigid body of an entity. See also [`crate::SoftWorld::entity_of_rigid_body`].
#[derive(Component, Copy, Clone, Debug, PartialEq, Eq)]
pub struct RigidBodyId(pub RigidBodyHandle);

impl<D: Dimension> SoftBody<D> {
    /// Disc (2D) or ball (3D), `across` voxels wide, with a diameter [m].
    pub fn ball(across: usize, diameter: f32) -> Self {
        VoxelGrid::ball(across, diameter).into()
    }

    /// Square (2D) or cube (3D), `across` voxels wide, with a width [m].
    pub fn cube(across: usize, width: f32) -> Self {
        VoxelGrid::cube(across, width).into()
    }

    /// Soft body from a file; it enters the world once the file is loaded. See [`crate::asset`].
    pub fn asset(voxels: Handle<Voxels<D>>) -> Self {
        Self {
            source: Source::Asset(voxels),
        }
    }
}

impl<D: Dimension> From<VoxelGrid<D>> for SoftBody<D> {
    fn from(grid: VoxelGrid<D>) -> Self {
        Ok(grid).into()
    }
}

/// Accepts the result of building a grid. An error in the result is reported when the body would enter the
/// world.
impl<D: Dimension> From<Result<VoxelGrid<D>, Error>> for SoftBody<D> {
    fn from(grid: Result<VoxelGrid<D>, Error>) -> Self {
        Self {
            source: Source::Grid(grid),
        }
    }
}

impl Default for SoftMaterials {
    fn default() -> Self {
        Material::default().into()
    }
}

impl From<Material> for SoftMaterials {
    fn from(material: Material) -> Self {
        Self(vec![material])
    }
}

impl<D: Dimension> RigidBody<D> {
    /// Fixed rigid body with friction 0.2.
    pub fn fixed(shape: Shape<D>) -> Self {
        Self {
            shape,
            friction: 0.2,
            restitution: 0.0,
            is_sensor: false,
            layers: Layers::default(),
            motion_type: MotionType::Fixed,
        }
    }

    /// Fixed half-space below y = 0 with friction 0.5.
    pub fn floor() -> Self {
        let floor = Shape::half_space(D::Vector::Y, D::Vector::ZERO);
        Self::fixed(floor).with_friction(0.5)
    }

    /// Kinematic disc (2D) or ball (3D) of a radius [m], moved by its `Transform`.
    pub fn kinematic_ball(radius: f32) -> Self {
        Self::fixed(Shape::ball(radius)).with_motion_type(MotionType::Kinematic)
    }

    /// Dynamic rigid body with friction 0.5. The shape must be a ball, box or capsule; the mass [kg] is
    /// spread evenly over it. The body rotates about the middle of its shape, even if the origin of the
    /// entity is elsewhere.
    pub fn dynamic(shape: Shape<D>, mass: f32) -> Self {
        let motion_type = MotionType::Dynamic { mass };
        Self::fixed(shape)
            .with_friction(0.5)
            .with_motion_type(motion_type)
    }

    /// Sets the type of motion.
    pub fn with_motion_type(self, motion_type: MotionType) -> Self {
        Self {
            motion_type,
            ..self
        }
    }

    /// Sets the coefficient of friction.
    pub fn with_friction(self, friction: f32) -> Self {
        Self { friction, ..self }
    }

    /// Sets whether the body is a sensor.
    pub fn with_sensor(self, is_sensor: bool) -> Self {
        Self { is_sensor, ..self }
    }

    /// Sets the collision layers.
    pub fn with_layers(self, layers: Layers) -> Self {
        Self { layers, ..self }
    }

    /// Sets the coefficient of restitution, 0 to 1.
    pub fn with_restitution(self, restitution: f32) -> Self {
        Self {
            restitution,
            ..self
        }
    }
}

fn soft_body_arrives<D: Dimension>(mut world: DeferredWorld, context: HookContext) {
    Queue::<D>::of(&mut world, |queue| {
        queue.add(context.entity, Request::AddBody)
    });
}

fn soft_body_leaves<D: Dimension>(mut world: DeferredWorld, context: HookContext) {
    Queue::<D>::of(&mut world, |queue| {
        queue.add(context.entity, Request::RemoveBody)
    });
}

fn rigid_body_arrives<D: Dimension>(mut world: DeferredWorld, context: HookContext) {
    Queue::<D>::of(&mut world, |queue| {
        queue.add(context.entity, Request::AddRigid)
    });
}

fn rigid_body_leaves<D: Dimension>(mut world: DeferredWorld, context: HookContext) {
    Queue::<D>::of(&mut world, |queue| {
        queue.add(context.entity, Request::RemoveRigid)
    });
}
