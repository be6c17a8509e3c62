//! Knives: cutting edges that open the faces they pass through, with the force that follows from the
//! material's toughness.
//!
//! *Samples* are spaced along an edge. Each sample tracks its rest position in the body, and a solver row
//! holds the material there like dry friction. Below a limit force the material moves with the edge and is
//! compressed. At the limit the edge advances, and the faces between voxels that the area swept by the
//! samples crosses are opened.
//!
//! ```text
//!     force per metre of edge = G + 2 r σ      G = toughness² / Y   [Irwin 1957]
//! ```
//!
//! G is the fracture energy per square metre of crack, and r the radius of the edge. In front of a dull edge
//! a strip of its width fails at the strength σ, too [Atkins 2009, ch. 9]. Sideways the flat of the blade is
//! limited by the strength over its height. Material that was cut before does not resist the edge.

mod cutting_edge;
mod edge_row;
mod edge_sample;
mod material_point;
mod swept_area;

use crate::error::{Error, require};
use crate::foundation::arena::{Arena, KnifeHandle, RigidBodyHandle};
use crate::foundation::dim::Dim;
use crate::foundation::hash::hash_state;
use crate::rigid_body::shape::{Vector, flat};
use crate::rigid_body::{FARTHEST, RigidBodies, RigidBody};
#[cfg(feature = "serde")]
use edge_sample::MOST_SAMPLES;
use edge_sample::{Near, Sample};

/// Knives of a world.
pub type Knives = Arena<KnifeHandle, Knife>;

/// Cutting edge on a kinematic or coupled rigid body.
///
/// ```
/// use fuwafuwa::{SoftBody, Dim2, Event, Knife, Material, RigidBody, WorldConfig, Shape, VoxelGrid, World};
///
/// let mut world = World::<Dim2>::new(WorldConfig::default())?;
/// world.add_rigid_body(RigidBody::fixed(Shape::half_space([0.0, 1.0, 0.0], [0.0; 3]), 0.5))?;
/// world.add_soft_body(SoftBody::new(VoxelGrid::cube(16, 1.0)?, &[Material::default()])?);
/// let mut hand = RigidBody::coupled_ball([0.53, 1.2, 0.0], 0.05);
/// hand.is_sensor = true; // the edge alone touches
/// let hand = world.add_rigid_body(hand)?;
/// let knife = world.add_knife(Knife::new(hand, [[0.0; 3]; 2], [0.0, -1.0, 0.0]))?;
/// let mut area = 0.0;
/// for tick in 0..120 {
///     world.set_target_position(hand, [0.53, 1.2 - 0.01 * tick as f32, 0.0])?;
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
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Knife {
    /// Rigid body that holds the knife, kinematic or coupled. If it is a [sensor](RigidBody::is_sensor), only its
    /// edge touches.
    pub holder: RigidBodyHandle,
    /// Ends of the edge in local coordinates of the holder, see [`RigidBody::form`] [m]. In 2D only their
    /// midpoint counts, and the body is a sheet 1 m deep.
    pub edge: [Vector; 2],
    /// Cutting direction in local coordinates of the holder, across the edge.
    pub toward: Vector,
    /// Radius of the edge [m], 0 to 1, default 0 (sharp); 1e-4 is dull.
    pub radius: f32,
    /// Height of the blade from the edge to the back [m], 0 to 10, default 0.02. The flat of the blade
    /// resists sideways motion.
    pub height: f32,
    samples: Vec<Sample>,
    /// Elements near each sample, and whether these lists are up to date.
    #[cfg_attr(feature = "serde", serde(skip))]
    near: Vec<Vec<Near>>,
    #[cfg_attr(feature = "serde", serde(skip))]
    knows_near: bool,
    /// Force [N] and torque [N m] on the knife in the last substep; the torque is about the position of the
    /// holder.
    force: Vector,
    torque: Vector,
    /// Area cut [m²] and work done [J] since the last event.
    area: f64,
    work: f64,
}

hash_state! {
    struct Knife { holder, edge, toward, radius, height, samples, force, torque, area, work } skip {
        near, knows_near,
    }
}

impl Knife {
    /// Returns a sharp knife with the default height, 0.02 m.
    pub fn new(holder: RigidBodyHandle, edge: [Vector; 2], toward: Vector) -> Self {
        Self {
            holder,
            edge,
            toward,
            radius: 0.0,
            height: 0.02,
            samples: Vec::new(),
            near: Vec::new(),
            knows_near: false,
            force: Vector::ZERO,
            torque: Vector::ZERO,
            area: 0.0,
            work: 0.0,
        }
    }

    /// Returns the force of the tissue on the knife in the last substep [N].
    pub fn force(&self) -> Vector {
        self.force
    }

    /// Returns the torque of the tissue on the knife about the position of its holder in the last substep [N
    /// m].
    pub fn torque(&self) -> Vector {
        self.torque
    }

    /// Returns and resets the area cut [m²] and the work done [J] since the last event.
    pub(crate) fn take_sums(&mut self) -> [f32; 2] {
        [&mut self.area, &mut self.work].map(|sum| std::mem::take(sum) as f32)
    }

    /// Clears the runtime state: the knife is in no body.
    pub(crate) fn forget(&mut self) {
        *self = Self {
            radius: self.radius,
            height: self.height,
            ..Self::new(self.holder, self.edge, self.toward)
        };
    }

    /// Checks that all parameters are in range for a world of `D`.
    pub(crate) fn check<D: Dim>(&self, rigids: &RigidBodies) -> Result<(), Error> {
        let holder = rigids.get(self.holder)?;
        let expected = "a kinematic or coupled rigid body";
        let is_held = holder.follows_target();
        require(is_held, "holder", expected, holder.motion_type)?;
        self.check_numbers::<D>()
    }

    fn check_numbers<D: Dim>(&self) -> Result<(), Error> {
        let [from, to] = self.edge;
        let is_near = |at: &Vector| at.to_array().iter().all(|k| k.abs() <= FARTHEST);
        let are_near = self.edge.iter().all(is_near);
        require(are_near, "edge", "within 1e6 m of its holder", self.edge)?;
        let along = to - from;
        // In 2D the edge is a point.
        let has_length = D::N == 2 || along.length() > 0.0;
        require(has_length, "edge", "longer than 0", self.edge)?;
        let toward = flat::<D>(self.toward);
        let has_direction = self.toward.is_finite() && (0.01..=100.0).contains(&toward.length());
        let expected = "a direction, of a length of 0.01 to 100";
        require(has_direction, "toward", expected, self.toward)?;
        let leans = D::N == 3 && along.dot(toward).abs() > 0.5 * along.length() * toward.length();
        let expected = "across the edge, within 30°";
        require(!leans, "toward", expected, self.toward)?;
        let (radius, height) = (self.radius, self.height);
        require((0.0..=1.0).contains(&radius), "radius", "0 to 1 m", radius)?;
        require(
            (0.0..=10.0).contains(&height),
            "height",
            "0 to 10 m",
            height,
        )
    }

    /// Returns whether a knife that was read from a file is valid.
    #[cfg(feature = "serde")]
    pub(crate) fn is_sound<D: Dim>(&self) -> bool {
        let numbers = [self.force, self.torque];
        // The holder may have been removed; the simulation handles that.
        self.check_numbers::<D>().is_ok()
            && numbers.into_iter().all(Vector::is_finite)
            && self.work.is_finite()
            && self.area.is_finite()
            && self.samples.len() <= MOST_SAMPLES + 1
            && self.samples.iter().all(Sample::is_sound)
    }

    /// Returns the edge and its directions in world coordinates.
    fn stance<D: Dim>(&self, holder: &RigidBody) -> EdgePose {
        let turn = |vector: Vector| holder.rotation().apply(vector);
        let levers = self.edge.map(|end| flat::<D>(turn(end)));
        // In 2D the edge is a point that stands for an edge along the third axis.
        let along = match D::N {
            2 => Vector::Z,
            _ => direction(levers[1] - levers[0]),
        };
        let toward = flat::<D>(turn(self.toward));
        let lean = along * along.dot(toward);
        let toward = direction(toward - lean);
        EdgePose {
            position: holder.position(),
            levers,
            along,
            toward,
            across: along.cross(toward),
        }
    }
}

/// World-space pose of a cutting edge.
struct EdgePose {
    /// Position of the holder [m].
    position: Vector,
    /// Ends of the edge relative to the position of the holder [m].
    levers: [Vector; 2],
    along: Vector,
    toward: Vector,
    across: Vector,
}

impl EdgePose {
    /// Returns the length of the edge [m].
    fn long(&self) -> f32 {
        (self.levers[1] - self.levers[0]).length()
    }
}

fn direction(vector: Vector) -> Vector {
    vector * (1.0 / vector.length().max(f32::MIN_POSITIVE))
}
