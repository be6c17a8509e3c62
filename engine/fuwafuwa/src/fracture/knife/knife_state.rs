//! State of a knife in the simulation.

use super::Knife;
#[cfg(feature = "serde")]
use super::edge_sample::MAX_SAMPLES;
use super::edge_sample::{Near, Sample};
use crate::error::{Error, require};
use crate::foundation::arena::{Arena, KnifeHandle, RigidBodyHandle};
use crate::foundation::dim::{Dim, DimVector};
use crate::foundation::hash::hash_state;
use crate::rigid_body::solid::flat;
use crate::rigid_body::{FARTHEST, RigidBodies, RigidState};
use glam::Vec3;

/// Knives of a world.
pub type Knives = Arena<KnifeHandle, KnifeState>;

/// State of a knife in the simulation. The first fields are those of [`Knife`].
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct KnifeState {
    pub holder: RigidBodyHandle,
    pub edge: [Vec3; 2],
    pub toward: Vec3,
    pub radius: f32,
    pub height: f32,
    pub(super) samples: Vec<Sample>,
    /// For each sample, the elements that it may enter soon.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub(super) near: Vec<Vec<Near>>,
    /// Whether the lists in `near` are up to date.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub(super) knows_near: bool,
    /// Force of the tissue on the knife in the last substep [N].
    pub(super) force: Vec3,
    /// Torque of the tissue on the knife in the last substep [N m], about the position of the holder.
    pub(super) torque: Vec3,
    /// Area cut since the last cut event of the knife [m²].
    pub(super) area: f64,
    /// Work of the edge on the tissue since the last cut event of the knife [J].
    pub(super) work: f64,
}

hash_state! {
    struct KnifeState { holder, edge, toward, radius, height, samples, force, torque, area, work } skip {
        near, knows_near,
    }
}

impl<D: Dim> From<&Knife<D>> for KnifeState {
    fn from(knife: &Knife<D>) -> Self {
        let [from, to] = knife.edge.map(D::Vector::to_vec3);
        // In 2D the edge is a single point, the midpoint of the given ends.
        let edge = match D::N {
            2 => [(from + to) * 0.5; 2],
            _ => [from, to],
        };
        Self {
            radius: knife.radius,
            height: knife.height,
            ..Self::new(knife.holder, edge, knife.toward.to_vec3())
        }
    }
}

impl KnifeState {
    /// Returns the definition of the knife.
    pub fn definition<D: Dim>(&self) -> Knife<D> {
        Knife {
            holder: self.holder,
            edge: self.edge.map(D::Vector::from_vec3),
            toward: D::Vector::from_vec3(self.toward),
            radius: self.radius,
            height: self.height,
        }
    }

    fn new(holder: RigidBodyHandle, edge: [Vec3; 2], toward: Vec3) -> Self {
        Self {
            holder,
            edge,
            toward,
            radius: 0.0,
            height: 0.02,
            samples: Vec::new(),
            near: Vec::new(),
            knows_near: false,
            force: Vec3::ZERO,
            torque: Vec3::ZERO,
            area: 0.0,
            work: 0.0,
        }
    }

    /// Returns the force of the tissue on the knife in the last substep [N].
    pub fn force(&self) -> Vec3 {
        self.force
    }

    /// Returns the torque of the tissue on the knife about the position of its holder in the last substep [N
    /// m].
    pub fn torque(&self) -> Vec3 {
        self.torque
    }

    /// Returns and resets the area cut [m²] and the work done [J] since the last cut event.
    pub(crate) fn take_sums(&mut self) -> [f32; 2] {
        [&mut self.area, &mut self.work].map(|sum| std::mem::take(sum) as f32)
    }

    /// Resets everything except the definition: the knife is then in no body.
    pub(crate) fn forget(&mut self) {
        *self = Self {
            radius: self.radius,
            height: self.height,
            ..Self::new(self.holder, self.edge, self.toward)
        };
    }

    /// Checks that all parameters are in range for a world of dimension `D`.
    pub(crate) fn check<D: Dim>(&self, rigids: &RigidBodies) -> Result<(), Error> {
        let holder = rigids.get(self.holder)?;
        let expected = "a kinematic or coupled rigid body";
        let is_held = holder.follows_target();
        require(is_held, "holder", expected, holder.motion_type)?;
        self.check_numbers::<D>()
    }

    fn check_numbers<D: Dim>(&self) -> Result<(), Error> {
        let [from, to] = self.edge;
        let is_near = |at: &Vec3| at.to_array().iter().all(|k| k.abs() <= FARTHEST);
        let are_near = self.edge.iter().all(is_near);
        require(are_near, "edge", "within 1e6 m of its holder", self.edge)?;
        let along = to - from;
        // In 2D the edge is a point, which has no length.
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
        // Does not check the holder: it may have been removed, which the simulation handles.
        self.check_numbers::<D>().is_ok()
            && numbers.into_iter().all(Vec3::is_finite)
            && self.work.is_finite()
            && self.area.is_finite()
            && self.samples.len() <= MAX_SAMPLES + 1
            && self.samples.iter().all(Sample::is_sound)
    }

    /// Returns the pose of the edge in world space, given the rigid body that holds the knife.
    pub(super) fn edge_pose<D: Dim>(&self, holder: &RigidState) -> EdgePose {
        let turn = |vector: Vec3| holder.rotation().apply(vector);
        let levers = self.edge.map(|end| flat::<D>(turn(end)));
        // In 2D the edge is a point. It stands for an edge along the third axis.
        let along = match D::N {
            2 => Vec3::Z,
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
pub(super) struct EdgePose {
    /// Position of the holder [m].
    pub(super) position: Vec3,
    /// Ends of the edge relative to the position of the holder [m].
    pub(super) levers: [Vec3; 2],
    /// Unit vector along the edge, from its first end to its second.
    pub(super) along: Vec3,
    /// Unit vector of the cutting direction, at a right angle to the edge.
    pub(super) toward: Vec3,
    /// Unit normal of the flat of the blade: `along` × `toward`.
    pub(super) across: Vec3,
}

impl EdgePose {
    /// Returns the length of the edge [m].
    pub(super) fn length(&self) -> f32 {
        (self.levers[1] - self.levers[0]).length()
    }
}

pub(super) fn direction(vector: Vec3) -> Vec3 {
    vector * (1.0 / vector.length().max(f32::MIN_POSITIVE))
}
