//! What ties things together: pins, springs and ropes between soft bodies, rigid things and places of the world.
//!
//! Each joint holds two *anchors*. Every substep gives them the impulse that a pin, a spring or a rope asks for, worked out
//! at once for all axes; what draws a pin together again gains no speed by it, as with contacts [Catto 2023]. Springs are
//! implicit: however stiff, they do not blow up.

mod anchor;
mod end;
mod tie;

use crate::body::Bodies;
use crate::dim::Dim;
use crate::handle::{Arena, Gone, JointId};
use crate::rigid::{FARTHEST, Rigids};
use crate::shape::{Vector, flat};
use crate::vector::length;
use anchor::Anchor;
pub(crate) use end::Woken;
pub use end::{End, Tie};

/// How often all joints are solved in a substep: what hangs in a chain hangs on the others.
/// With 1, 2, 4 and 8 a chain of pins with a heavy end hangs still to 10, 5, 2 and 2 cm/s.
const ROUNDS: usize = 4;

/// The joints of a world.
pub type Joints = Arena<JointId, Joint>;

/// Two ends that are tied.
///
/// ```
/// use fuwafuwa::joint::{End, Joint};
/// use fuwafuwa::{Body, Dim2, Material, Settings, VoxelGrid, World};
///
/// let mut world = World::<Dim2>::new(Settings::default())?;
/// let ball = Body::new(VoxelGrid::ball(12, 1.0)?, &[Material::default()])?;
/// let ball = world.add_body(ball);
/// let top = [0.5, 1.0, 0.0];
/// let end = End::Soft { body: ball, at: top, radius: 0.2 };
/// let nail = world.add_joint(Joint::pin(end, End::Position(top)))?;
/// for _ in 0..60 {
///     world.step();
/// }
/// assert!(world.bodies()[ball].centre_of_mass()[1] > 0.2);
/// world.remove_joint(nail)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Joint {
    /// What is tied.
    pub ends: [End; 2],
    /// How.
    pub tie: Tie,
    /// It breaks when it pulls or pushes by more than this [N]; infinite = never.
    pub breaking_force: f32,
    anchors: [Anchor; 2],
    /// What passed in the last substep, on the first end [N s].
    impulse: Vector,
    /// How strongly it pulled in the last substep [N].
    force: f32,
}

/// What of a joint is out of range: which field, and what was expected.
pub type BadJoint = (&'static str, &'static str);

impl Joint {
    /// Ends that are tied in some way and never break.
    pub fn new(ends: [End; 2], tie: Tie) -> Self {
        Self {
            ends,
            tie,
            breaking_force: f32::INFINITY,
            anchors: [Anchor::Position([0.0; 3]), Anchor::Position([0.0; 3])],
            impulse: [0.0; 3],
            force: 0.0,
        }
    }

    /// Ends that stay together.
    pub fn pin(first: End, second: End) -> Self {
        Self::new([first, second], Tie::Pin)
    }

    /// The same, but it breaks at a force [N].
    #[must_use]
    pub fn breaking_at(self, force: f32) -> Self {
        Self {
            breaking_force: force,
            ..self
        }
    }

    /// How strongly it pulled or pushed in the last substep [N].
    pub fn force(&self) -> f32 {
        self.force
    }

    /// Takes hold of its ends, as they are said.
    pub(crate) fn hold<D: Dim>(&mut self, bodies: &Bodies<D>, rigids: &Rigids) -> Result<(), Gone> {
        for (anchor, end) in self.anchors.iter_mut().zip(&self.ends) {
            *anchor = Anchor::of(end, bodies, rigids)?;
        }
        if self.tie == Tie::Pin {
            self.meet_soft_ends(bodies, rigids);
        }
        (self.impulse, self.force) = ([0.0; 3], 0.0);
        Ok(())
    }

    /// A pin between something soft and something that is not is where the soft end is: nothing jumps.
    fn meet_soft_ends<D: Dim>(&mut self, bodies: &Bodies<D>, rigids: &Rigids) {
        let is_soft = self.anchors.each_ref().map(Anchor::is_soft);
        for (own, other) in [(0, 1), (1, 0)] {
            if is_soft[own] && !is_soft[other] {
                let at = self.anchors[own].grip(bodies, rigids).map(|grip| grip.at);
                at.into_iter()
                    .for_each(|at| self.anchors[other].stand_at(at, rigids));
            }
        }
    }

    /// Where its ends are now [m]; nothing when one is gone.
    pub(crate) fn places<D: Dim>(
        &self,
        bodies: &Bodies<D>,
        rigids: &Rigids,
    ) -> Option<[Vector; 2]> {
        let [first, second] = &self.anchors;
        let at = |anchor: &Anchor| Some(anchor.grip(bodies, rigids)?.at);
        Some([at(first)?, at(second)?])
    }

    /// Whether its numbers are in range.
    pub(crate) fn check(&self) -> Result<(), BadJoint> {
        for end in &self.ends {
            let (at, radius) = match *end {
                End::Position(at) | End::Rigid { at, .. } => (at, 0.0),
                End::Soft { at, radius, .. } => (at, radius),
            };
            let is_near = at.iter().all(|k| k.abs() <= FARTHEST);
            require(is_near, "place of an end", "within 1e6 m of the origin")?;
            require(
                (0.0..=FARTHEST).contains(&radius),
                "radius of an end",
                "0 to 1e6 m",
            )?;
        }
        let is_of_two = match self.ends {
            [End::Position(_), End::Position(_)] => false,
            [End::Rigid { rigid, .. }, End::Rigid { rigid: other, .. }] => rigid != other,
            _ => true,
        };
        let expected = "of two things, of which one can be moved";
        require(is_of_two, "ends of a joint", expected)?;
        require(self.breaking_force > 0.0, "breaking force", "positive")?;
        let is_within = |k: f32, least: f32| (least..=f32::MAX).contains(&k);
        match self.tie {
            Tie::Pin => Ok(()),
            Tie::Rope { length } => require(
                is_within(length, f32::MIN_POSITIVE),
                "length",
                "positive and finite",
            ),
            Tie::Spring {
                stiffness,
                damping,
                length,
            } => {
                let is_stiff = is_within(stiffness, f32::MIN_POSITIVE);
                require(is_stiff, "stiffness", "positive and finite")?;
                require(is_within(damping, 0.0), "damping", "0 or more, and finite")?;
                require(is_within(length, 0.0), "length", "0 or more, and finite")
            }
        }
    }

    /// Whether what was read from a file may be one.
    #[cfg(feature = "serde")]
    pub(crate) fn is_sound<D: Dim>(&self) -> bool {
        let is_finite = crate::vector::is_finite(self.impulse) && self.force >= 0.0;
        let is_flat = self.impulse[D::N..].iter().all(|k| *k == 0.0);
        let mut both = self.anchors.iter().zip(&self.ends);
        self.check().is_ok()
            && is_finite
            && is_flat
            && both.all(|(own, end)| own.is_sound::<D>(end))
    }
}

/// Gives all ends of joints the impulses of a substep of `duration` [s]. Returns those that broke or lost an end.
pub(crate) fn solve<D: Dim>(
    joints: &mut Joints,
    bodies: &mut Bodies<D>,
    rigids: &mut Rigids,
    duration: f32,
) -> (Vec<JointId>, Woken) {
    let (mut broken, mut woken) = (Vec::new(), Woken::default());
    for (id, joint) in joints.entries_mut() {
        match joint.start(bodies, rigids, &mut woken) {
            true => {}
            false => broken.push(id),
        }
    }
    for _ in 0..ROUNDS {
        for joint in joints.iter_mut() {
            joint.solve(bodies, rigids, duration, true);
        }
    }
    (broken, woken)
}

/// After the move: takes back the speed with which pins were drawn together. Returns those that broke.
pub(crate) fn relax<D: Dim>(
    joints: &mut Joints,
    bodies: &mut Bodies<D>,
    rigids: &mut Rigids,
    duration: f32,
) -> Vec<JointId> {
    let mut broken = Vec::new();
    for _ in 0..ROUNDS {
        for joint in joints.iter_mut() {
            joint.solve(bodies, rigids, duration, false);
        }
    }
    for (id, joint) in joints.entries_mut() {
        if !joint.yields(bodies, rigids) {
            // Both ends rest: it goes on pulling as it did.
            continue;
        }
        joint.force = length(flat::<D>(joint.impulse)) / duration;
        if joint.force > joint.breaking_force {
            broken.push(id);
        }
    }
    broken
}

fn require(is_good: bool, field: &'static str, expected: &'static str) -> Result<(), BadJoint> {
    is_good.then_some(()).ok_or((field, expected))
}
