//! What entities have.

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
use fuwafuwa::{BodyId, BuildError, MotionType, Layers, Material, RigidId, Shape, VoxelGrid};
use std::marker::PhantomData;

/// A soft body: the voxels that it is made from. It enters the world at the beginning of the next tick, where its
/// `Transform` says, and gets [`SoftBodyId`] and a mesh. Inserted again it is made anew; removed or despawned it leaves.
#[derive(Component, Clone, Debug)]
#[component(on_insert = soft_body_arrives::<D>, on_discard = soft_body_leaves::<D>)]
#[require(Transform, SoftMaterials)]
pub struct SoftBody<D: Dimension> {
    pub(crate) source: Source<D>,
}

/// Where the voxels of a body come from.
#[derive(Clone, Debug)]
pub(crate) enum Source<D: Dimension> {
    Grid(Result<VoxelGrid<D>, BuildError>),
    Asset(Handle<Voxels<D>>),
}

/// What a soft body is made of: material number 1 first; the last one serves all above. Counts when the body enters.
#[derive(Component, Clone, Debug, PartialEq)]
pub struct SoftMaterials(pub Vec<Material>);

/// How fast a soft body moves as a whole, or something rigid. It has this velocity when it enters; after each tick this is
/// what it has. What you change is added to a soft body in the next one, and what is free of the rigid things has it then;
/// others it only tells.
#[derive(Component, Copy, Clone, Debug, Default, PartialEq)]
pub struct Velocity {
    /// Of its centre of mass [m/s].
    pub linear: Vec3,
    /// About its centre of mass [rad/s]; in the plane z alone counts.
    pub angular: Vec3,
}

/// An impulse for a soft body, or for something rigid that is free, given in the next tick; the component is removed then.
#[derive(Component, Copy, Clone, Debug, PartialEq)]
pub struct ExternalImpulse {
    /// [N s]
    pub impulse: Vec3,
    /// Where in the world [m].
    pub at: Vec3,
    /// All nodes of a soft body within this distance share it [m]; where there is none, the nearest one has it alone, which
    /// tears most bodies.
    pub radius: f32,
}

/// How strongly gravity pulls on a soft body, in shares of the usual, −100 to 100.
#[derive(Component, Copy, Clone, Debug, PartialEq)]
pub struct GravityScale(pub f32);

/// A soft body without a mesh: for a server, or for who draws it another way. Counts when the body enters.
#[derive(Component, Copy, Clone, Debug, Default)]
pub struct WithoutMesh;

/// Which body of the engine an entity is. See also [`crate::SoftWorld::entity_of_body`].
#[derive(Component, Copy, Clone, Debug, PartialEq, Eq)]
pub struct SoftBodyId(pub BodyId);

/// Something rigid: an obstacle that stands, a hand that moves, or what is free to fall. The shape is as it would be at the
/// origin, best with its middle there; its `Transform` moves, turns and scales it when it enters. From then on its size
/// stays, as does all that is said here: insert it again for another one.
///
/// What moves it is [`MotionType`]:
/// - Nothing moves what is [`MotionType::Fixed`].
/// - [`MotionType::Kinematic`] is where its `Transform` says at the end of the next tick, and moves and turns there evenly.
/// - [`MotionType::Coupled`] is pulled to its [`Goal`] without turning; its `Transform` says how far it got.
/// - [`MotionType::Dynamic`] falls, turns, and is pushed by what it touches; its `Transform` follows. See [`RigidBody::free`].
///
/// All but what is kinematic are put at once where you write that they are, with the velocity that they have.
#[derive(Component, Clone, Debug, PartialEq)]
#[component(on_insert = rigid_body_arrives::<D>, on_discard = rigid_body_leaves::<D>)]
#[require(Transform)]
pub struct RigidBody<D: Dimension> {
    /// As it would be at the origin.
    pub shape: Shape,
    /// Coulomb friction with what it touches; about 0.2.
    pub friction: f32,
    /// Share of its speed with which it bounces off what is rigid, 0 to 1, where one of both is free; the larger one
    /// counts.
    pub restitution: f32,
    /// Whether it touches nobody, and tells who comes and goes: [`Entered`](crate::message::Entered).
    pub is_sensor: bool,
    /// Who touches it.
    pub layers: Layers,
    /// What moves it.
    pub drive: MotionType,
    dim: PhantomData<D>,
}

/// Where a hand that is [`MotionType::Coupled`] is pulled [m].
#[derive(Component, Copy, Clone, Debug, PartialEq)]
pub struct Goal(pub Vec3);

/// Which rigid thing of the engine an entity is. See also [`crate::SoftWorld::entity_of_rigid`].
#[derive(Component, Copy, Clone, Debug, PartialEq, Eq)]
pub struct RigidBodyId(pub RigidId);

impl<D: Dimension> SoftBody<D> {
    /// A disc or ball, `across` voxels wide and `diameter` metres large.
    pub fn ball(across: usize, diameter: f32) -> Self {
        VoxelGrid::ball(across, diameter).into()
    }

    /// A square or cube, `across` voxels and `width` metres wide.
    pub fn cube(across: usize, width: f32) -> Self {
        VoxelGrid::cube(across, width).into()
    }

    /// Of a file, once it is loaded: see [`crate::asset`].
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

/// What could not be built is told when it enters, like all else that is wrong with it.
impl<D: Dimension> From<Result<VoxelGrid<D>, BuildError>> for SoftBody<D> {
    fn from(grid: Result<VoxelGrid<D>, BuildError>) -> Self {
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
    /// An obstacle of a shape, of friction 0.2.
    pub fn fixed(shape: Shape) -> Self {
        Self {
            shape,
            friction: 0.2,
            restitution: 0.0,
            is_sensor: false,
            layers: Layers::default(),
            drive: MotionType::Fixed,
            dim: PhantomData,
        }
    }

    /// All below y = 0, of friction 0.5.
    pub fn floor() -> Self {
        let floor = Shape::half_space([0.0, 1.0, 0.0], [0.0; 3]);
        Self::fixed(floor).with_friction(0.5)
    }

    /// A disc or ball of a radius [m] that is where its `Transform` says.
    pub fn hand(radius: f32) -> Self {
        let centre = [0.0; 3];
        Self::fixed(Shape::Ball { centre, radius }).with_drive(MotionType::Kinematic)
    }

    /// What falls and turns, of a mass [kg] that is spread evenly over a ball, box or bar, and of friction 0.5. It turns
    /// about the middle of its shape, wherever that is.
    pub fn free(shape: Shape, mass: f32) -> Self {
        let drive = MotionType::Dynamic { mass };
        Self::fixed(shape).with_friction(0.5).with_drive(drive)
    }

    /// The same with another drive.
    pub fn with_drive(self, drive: MotionType) -> Self {
        Self { drive, ..self }
    }

    /// The same with another friction.
    pub fn with_friction(self, friction: f32) -> Self {
        Self { friction, ..self }
    }

    /// The same as a sensor.
    pub fn as_sensor(self) -> Self {
        Self {
            is_sensor: true,
            ..self
        }
    }

    /// The same in other layers.
    pub fn with_layers(self, layers: Layers) -> Self {
        Self { layers, ..self }
    }

    /// The same with another restitution.
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
