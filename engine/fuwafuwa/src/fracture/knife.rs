//! Knives: cutting edges that open the faces they pass through, with the force that follows from the
//! material's toughness.
//!
//! *Samples* are spaced along an edge. Each sample tracks its rest position in the body, and a solver row
//! holds the material at the sample like dry friction. Below a limit force, the material moves with the edge
//! and is compressed. At the limit, the edge advances. The samples then sweep an area, and the faces between
//! voxels that this area crosses are opened.
//!
//! ```text
//!     force per metre of edge = G + 2 r σ      G = toughness² (1 − ν²) / Y   [Irwin 1957]
//! ```
//!
//! G is the [fracture energy](crate::Material::fracture_energy) per square metre of crack, Y Young's modulus, ν
//! Poisson's ratio, r the radius of the edge, and σ the strength. The term 2 r σ stands for a strip in front of a dull edge, as wide as the edge, which fails as
//! well [Atkins 2009, ch. 9]. Against sideways motion, the flat of the blade resists with at most σ times its
//! height, per metre of edge. Material that was cut before does not resist the edge.

mod cutting_edge;
mod edge_row;
mod edge_sample;
mod knife_ref;
mod knife_state;
mod material_point;
mod swept_area;

use crate::foundation::arena::RigidBodyHandle;
use crate::foundation::dim::Dim;
pub use knife_ref::KnifeRef;
pub(crate) use knife_state::{KnifeState, Knives};

/// Cutting edge on a kinematic or coupled rigid body, to add with [`World::add_knife`](crate::World::add_knife).
///
/// ```
/// use fuwafuwa::{
///     Dim2, Event, Knife, Material, RigidBody, Shape, SoftBody, Vec2, VoxelGrid, World, WorldConfig,
/// };
///
/// let mut world = World::<Dim2>::new(WorldConfig::default())?;
/// world.add_rigid_body(RigidBody::fixed(Shape::half_space(Vec2::Y, Vec2::ZERO)))?;
/// world.add_soft_body(SoftBody::new(VoxelGrid::cube(16, 1.0)?, &[Material::default()])?)?;
/// let start = Vec2::new(0.53, 1.2);
/// let hand = RigidBody::coupled(Shape::ball(0.05)).at(start);
/// // As a sensor, the hand passes through the body, and only the edge touches it.
/// let hand = world.add_rigid_body(hand.with_sensor(true))?;
/// let knife = world.add_knife(Knife::new(hand, [Vec2::ZERO; 2], Vec2::NEG_Y))?;
/// let mut area = 0.0;
/// for tick in 0..120 {
///     world.set_target_position(hand, start - 0.01 * tick as f32 * Vec2::Y)?;
///     world.step();
///     area += world.events().iter().map(|event| match event {
///         Event::Cut { area, .. } => *area,
///         _ => 0.0,
///     }).sum::<f32>();
/// }
/// assert!(area > 0.8);
/// world.remove(knife)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Copy, Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound = ""))]
pub struct Knife<D: Dim> {
    /// Rigid body that holds the knife, kinematic or coupled. If it is a
    /// [sensor](crate::RigidBody::is_sensor), the rigid body has no contacts, and only the edge touches soft
    /// bodies.
    pub holder: RigidBodyHandle,
    /// Ends of the edge in local coordinates of the holder [m]. In 2D only the midpoint of the edge is used,
    /// and soft bodies are sheets 1 m thick.
    pub edge: [D::Vector; 2],
    /// Cutting direction in local coordinates of the holder, within 30° of a right angle to the edge. The
    /// length of this vector has no effect, but must be 0.01 to 100.
    pub toward: D::Vector,
    /// Radius of the edge [m], 0 to 1, default 0 (sharp). A larger radius requires more force; 1e-4 is a dull
    /// edge.
    pub radius: f32,
    /// Height of the blade from the edge to the back [m], 0 to 10, default 0.02. The flat of the blade
    /// resists sideways motion.
    pub height: f32,
}

impl<D: Dim> Knife<D> {
    /// Returns a sharp knife with the default height, 0.02 m.
    pub fn new(holder: RigidBodyHandle, edge: [D::Vector; 2], toward: D::Vector) -> Self {
        Self {
            holder,
            edge,
            toward,
            radius: 0.0,
            height: 0.02,
        }
    }
}
