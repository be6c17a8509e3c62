//! Knives: edges that cut where they pass, at the energy that a material's toughness asks for.
//!
//! Along an edge stand *samples*. Each knows where in the body at rest it is, and a row of the solver holds the material
//! there, as dry friction does: below a force the material goes along with the edge and is pressed; at that force the edge
//! goes on, and the faces between voxels are opened that the samples, joined to a swath, went across.
//!
//! ```text
//!     force per metre of edge = G + 2 r σ      G = toughness² / Y   [Irwin 1957]
//! ```
//!
//! G is the energy that a square metre of crack takes, and r the radius of the edge: in front of a dull one a strip of its
//! width has to fail, too, at the strength σ [Atkins 2009, ch. 9]. Sideways it is the flat of the blade that presses, with
//! the strength over its height. Where it was cut before nothing holds the edge.

mod edge;
mod inside;
mod row;
mod sample;
mod swath;

use crate::dim::Dim;
use crate::handle::{Arena, KnifeId, RigidId};
use crate::rigid::{FARTHEST, Rigid, Rigids};
use crate::shape::{Vector, flat};
use crate::vector::{cross, dot, is_finite, length, minus, scaled};
#[cfg(feature = "serde")]
use sample::MOST_SAMPLES;
use sample::{Near, Sample};

/// The knives of a world.
pub type Knives = Arena<KnifeId, Knife>;

/// An edge that cuts, held by something rigid that follows a goal.
///
/// ```
/// use fuwafuwa::{Body, Dim2, Event, Knife, Material, Rigid, Settings, Shape, VoxelGrid, World};
///
/// let mut world = World::<Dim2>::new(Settings::default())?;
/// world.add_rigid(Rigid::fixed(Shape::half_space([0.0, 1.0, 0.0], [0.0; 3]), 0.5))?;
/// world.add_body(Body::new(VoxelGrid::cube(16, 1.0)?, &[Material::default()])?);
/// let mut hand = Rigid::hand([0.53, 1.2, 0.0], 0.05);
/// hand.is_sensor = true; // the edge alone touches
/// let hand = world.add_rigid(hand)?;
/// let knife = world.add_knife(Knife::new(hand, [[0.0; 3]; 2], [0.0, -1.0, 0.0]))?;
/// let mut area = 0.0;
/// for tick in 0..120 {
///     world.set_goal(hand, [0.53, 1.2 - 0.01 * tick as f32, 0.0])?;
///     world.step();
///     area += world.events().iter().map(|event| match event {
///         Event::Cut { area, .. } => *area,
///         _ => 0.0,
///     }).sum::<f32>();
/// }
/// assert!(area > 0.8);
/// world.remove_knife(knife)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Knife {
    /// What holds it: something that follows a goal. A [sensor](Rigid::is_sensor) touches with its edge alone.
    pub holder: RigidId,
    /// The ends of the edge, as they are on the [form](Rigid::form) of the holder [m]; in the plane the middle between
    /// them counts, for a sheet 1 m deep.
    pub edge: [Vector; 2],
    /// Which way it cuts, as on the form of the holder: across the edge.
    pub toward: Vector,
    /// Radius of the edge [m]: 0 is sharp, a tenth of a millimetre is dull.
    pub radius: f32,
    /// From the edge to the back [m]: the flat that holds it from going sideways.
    pub height: f32,
    samples: Vec<Sample>,
    /// What each of them may come into, and whether that holds still.
    #[cfg_attr(feature = "serde", serde(skip))]
    near: Vec<Vec<Near>>,
    #[cfg_attr(feature = "serde", serde(skip))]
    knows_near: bool,
    /// Of the last substep [N] and [N m], on the knife; the torque about the place of its holder.
    force: Vector,
    torque: Vector,
    /// What it cut [m²] and the work that it did [J], since it told of that.
    area: f64,
    work: f64,
}

/// What of a knife is out of range: which field, and what was expected.
pub type BadKnife = (&'static str, &'static str);

impl Knife {
    /// A sharp one of usual height, 0.02 m.
    pub fn new(holder: RigidId, edge: [Vector; 2], toward: Vector) -> Self {
        Self {
            holder,
            edge,
            toward,
            radius: 0.0,
            height: 0.02,
            samples: Vec::new(),
            near: Vec::new(),
            knows_near: false,
            force: [0.0; 3],
            torque: [0.0; 3],
            area: 0.0,
            work: 0.0,
        }
    }

    /// What was cut or pressed did this to it in the last substep [N].
    pub fn force(&self) -> Vector {
        self.force
    }

    /// The same about the position of its holder [N m].
    pub fn torque(&self) -> Vector {
        self.torque
    }

    /// What it cut [m²] and the work that it did [J], since it told of that.
    pub(crate) fn take_sums(&mut self) -> [f32; 2] {
        [&mut self.area, &mut self.work].map(|sum| std::mem::take(sum) as f32)
    }

    /// As new: it is in nobody.
    pub(crate) fn forget(&mut self) {
        *self = Self {
            radius: self.radius,
            height: self.height,
            ..Self::new(self.holder, self.edge, self.toward)
        };
    }

    /// Whether its numbers are in range, in a world of `D`.
    pub(crate) fn check<D: Dim>(&self, rigids: &Rigids) -> Result<(), BadKnife> {
        let holder = rigids.get(self.holder);
        let is_held = holder.is_ok_and(Rigid::is_driven);
        require(is_held, "holder", "something rigid that follows a goal")?;
        self.check_numbers::<D>()
    }

    fn check_numbers<D: Dim>(&self) -> Result<(), BadKnife> {
        let [from, to] = self.edge;
        let is_near = |at: &Vector| at.iter().all(|k| k.abs() <= FARTHEST);
        let are_near = self.edge.iter().all(is_near);
        require(are_near, "edge", "within 1e6 m of its holder")?;
        let along = minus(to, from);
        // In the plane an edge is a point, and leads nowhere.
        let has_length = D::N == 2 || length(along) > 0.0;
        require(has_length, "edge", "of a length that is not 0")?;
        let toward = flat::<D>(self.toward);
        let has_direction = is_finite(self.toward) && (0.01..=100.0).contains(&length(toward));
        require(has_direction, "toward", "a direction of length 1")?;
        let leans = D::N == 3 && dot(along, toward).abs() > 0.5 * length(along) * length(toward);
        require(!leans, "toward", "across the edge, within 30°")?;
        require((0.0..=1.0).contains(&self.radius), "radius", "0 to 1 m")?;
        require((0.0..=10.0).contains(&self.height), "height", "0 to 10 m")
    }

    /// Whether what was read from a file may be one.
    #[cfg(feature = "serde")]
    pub(crate) fn is_sound<D: Dim>(&self) -> bool {
        let numbers = [self.force, self.torque];
        // Its holder may be gone since; that shows when it is asked for.
        self.check_numbers::<D>().is_ok()
            && numbers.into_iter().all(is_finite)
            && self.work.is_finite()
            && self.area.is_finite()
            && self.samples.len() <= MOST_SAMPLES + 1
            && self.samples.iter().all(Sample::is_sound)
    }

    /// The edge, the way it cuts and the way across both, as they are in the world: the ends [m] and two directions.
    fn stance<D: Dim>(&self, holder: &Rigid) -> Stance {
        let turn = |vector: Vector| holder.rotation().apply(vector);
        let levers = self.edge.map(|end| flat::<D>(turn(end)));
        // In the plane it is a point, and stands for an edge across the body.
        let along = match D::N {
            2 => [0.0, 0.0, 1.0],
            _ => direction(minus(levers[1], levers[0])),
        };
        let toward = flat::<D>(turn(self.toward));
        let lean = scaled(along, dot(along, toward));
        let toward = direction(minus(toward, lean));
        Stance {
            position: holder.position(),
            levers,
            along,
            toward,
            across: cross(along, toward),
        }
    }
}

/// How a knife is held.
struct Stance {
    /// Where its holder is [m].
    position: Vector,
    /// Its ends, seen from the position of the holder [m].
    levers: [Vector; 2],
    along: Vector,
    toward: Vector,
    across: Vector,
}

impl Stance {
    /// How long the edge is [m].
    fn long(&self) -> f32 {
        length(minus(self.levers[1], self.levers[0]))
    }
}

fn direction(vector: Vector) -> Vector {
    scaled(vector, 1.0 / length(vector).max(f32::MIN_POSITIVE))
}

fn require(is_good: bool, field: &'static str, expected: &'static str) -> Result<(), BadKnife> {
    is_good.then_some(()).ok_or((field, expected))
}
