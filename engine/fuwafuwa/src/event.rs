//! Events of a tick and the report of a step.

use crate::foundation::arena::{
    GripHandle, JointHandle, KnifeHandle, RigidBodyHandle, SoftBodyHandle,
};
use crate::foundation::dim::Dim;
use crate::foundation::hash::hash_state;
use crate::foundation::ids::PieceId;
use crate::object_ref::{ObjectRef, ObjectSelector};

/// Event of the last tick, from which a program can trigger sounds, scores and visual effects.
#[derive(Copy, Clone, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound = ""))]
pub enum Event<D: Dim> {
    /// A node was split in two, because a crack advanced through it or [`World::cut`](crate::World::cut)
    /// separated the voxels around it.
    NodeSplit {
        /// Body to which the split node belongs.
        body: SoftBodyHandle,
        /// Position of the split node [m].
        point: D::Vector,
        /// Elastic energy that the advancing crack released at the node [J]. At a crack tip, it is the energy
        /// release rate times the opened area; at a smooth surface, it is estimated from the tension. 0 for
        /// [`World::cut`](crate::World::cut).
        energy: f32,
    },
    /// A piece was detached from its body.
    PieceDetached {
        /// Body from which the piece was detached.
        body: SoftBodyHandle,
        /// Number of the new piece within the body.
        piece: PieceId,
    },
    /// Two objects pressed on each other during the tick. Sent once per pair and tick, as long as contact
    /// impulses act; a sleeping pair sends none. If a piece folds onto itself, both objects of the pair are
    /// that piece.
    ContactForce(Contact<D>),
    /// Two objects began to touch. The tick also has an [`Event::ContactForce`] with the same contact. Not
    /// sent for a piece that folds onto itself.
    ContactStarted(Contact<D>),
    /// Two objects stopped touching, or one of them was removed. Objects at rest in contact keep touching,
    /// even while they sleep.
    ContactEnded {
        /// The objects, in the order of [`Contact::pair`].
        pair: [ObjectRef; 2],
    },
    /// An object entered a sensor.
    SensorEntered {
        /// The sensor.
        sensor: RigidBodyHandle,
        /// The piece or rigid body that entered.
        object: ObjectRef,
    },
    /// An object exited a sensor, or the object or the sensor was removed.
    SensorExited {
        /// The sensor.
        sensor: RigidBodyHandle,
        /// The piece or rigid body that exited.
        object: ObjectRef,
    },
    /// A knife cut a body: its cutting edge passed between neighbouring voxels and separated them.
    Cut {
        /// The knife.
        knife: KnifeHandle,
        /// Body that was cut.
        body: SoftBodyHandle,
        /// World-space midpoint of the part of the cutting edge that is inside the body [m].
        point: D::Vector,
        /// Area that this knife has cut since its previous [`Event::Cut`], summed over all bodies and
        /// measured on the undeformed bodies [m²].
        area: f32,
        /// Work that this knife has done by cutting since its previous [`Event::Cut`], summed over all bodies
        /// [J].
        work: f32,
    },
    /// A joint broke and was removed, because its force exceeded the breaking force or an attached body was
    /// removed.
    JointBroke {
        /// Handle of the broken joint.
        joint: JointHandle,
    },
    /// A grip was removed, because its body or its carrier was removed.
    GripEnded {
        /// Handle of the removed grip.
        grip: GripHandle,
    },
    /// A piece fell asleep.
    FellAsleep {
        /// Body of the piece.
        body: SoftBodyHandle,
        /// Number of the piece that fell asleep.
        piece: PieceId,
    },
    /// A sleeping piece was woken.
    WokeUp {
        /// Body of the piece.
        body: SoftBodyHandle,
        /// Number of the piece that woke.
        piece: PieceId,
    },
    /// A piece was [removed](crate::World::remove_piece) from the world.
    PieceRemoved {
        /// Body of the removed piece. The handle is stale if this was the last piece.
        body: SoftBodyHandle,
        /// Number of the removed piece.
        piece: PieceId,
    },
    /// The last piece of a body was removed, and the body with it.
    SoftBodyRemoved {
        /// Handle of the removed body.
        body: SoftBodyHandle,
    },
    /// A rigid body was removed because it [left a region](crate::World::remove_outside).
    RigidBodyRemoved {
        /// Handle of the removed rigid body.
        body: RigidBodyHandle,
    },
    /// Two objects were placed inside each other, by more than a voxel. They are moved apart at 0.5 m/s,
    /// without contacts between them, and stay awake until then. If neither can be moved, they stay as they
    /// are. Sent once, in the first tick after one of the objects was placed.
    Overlapped {
        /// The objects, in ascending order; the first one is a piece.
        pair: [ObjectRef; 2],
        /// Depth of the overlap [m].
        depth: f32,
    },
    /// An object moved out of the range in which single precision is enough. A piece is simulated further, but
    /// its shape gets coarser; see [`SoftBody::range`](crate::SoftBody::range). A rigid body stops at its
    /// position at the start of the tick, within 10⁶ m of the origin. The same happens if its
    /// velocity becomes non-finite. Sent once each time an object leaves.
    LeftRange {
        /// The piece or rigid body.
        object: ObjectRef,
    },
    /// A piece became non-finite or too fast. The engine froze the piece permanently, so that it cannot
    /// affect the rest of the world.
    Quarantined {
        /// Body of the quarantined piece.
        body: SoftBodyHandle,
        /// Number of the quarantined piece.
        piece: PieceId,
    },
    /// A piece approached an object by more than a voxel per substep, or by more than half the thickness of
    /// a thinner rigid body. Until the impact ends, the piece moves by a share of its velocity (relative to a
    /// rigid body that it hits), and its forces act for the same share of the substep, so that it does not pass
    /// through. Contacts keep momentum exactly. The piece falls behind a little, and bounces off slower than a real one.
    ///
    /// Two limits remain: soft bodies may pass partly through each other, and a kinematic body that moves by more
    /// than half its thickness per substep may pass through a piece. Sent once per piece and tick.
    ImpactSlowed {
        /// Body of the piece.
        body: SoftBodyHandle,
        /// Number of the piece.
        piece: PieceId,
        /// Smallest ratio of displacement to velocity × substep in this tick, 0 to 1.
        share: f32,
    },
    /// The scale of a soft body that requires more substeps than the world allows began to act, changed or
    /// ended; see [`WorldConfig::stiff_bodies`](crate::WorldConfig::stiff_bodies). Sent in the first tick
    /// after the body was added or the configuration changed. Both scales are 1 if the body is exact again.
    StiffBodyScaled {
        /// The body.
        body: SoftBodyHandle,
        /// Factor on the inertia of deformation, see [`SoftBody::mass_scale`](crate::SoftBody::mass_scale).
        mass_scale: f32,
        /// Factor on Young's modulus, see [`SoftBody::stiffness_scale`](crate::SoftBody::stiffness_scale).
        stiffness_scale: f32,
    },
}

hash_state! {
    [D: Dim] enum Event<D> {
        NodeSplit { body, point, energy },
        PieceDetached { body, piece },
        ContactForce(contact),
        ContactStarted(contact),
        ContactEnded { pair },
        SensorEntered { sensor, object },
        SensorExited { sensor, object },
        Cut { knife, body, point, area, work },
        JointBroke { joint },
        GripEnded { grip },
        FellAsleep { body, piece },
        WokeUp { body, piece },
        PieceRemoved { body, piece },
        SoftBodyRemoved { body },
        RigidBodyRemoved { body },
        Overlapped { pair, depth },
        LeftRange { object },
        Quarantined { body, piece },
        ImpactSlowed { body, piece, share },
        StiffBodyScaled { body, mass_scale, stiffness_scale },
    }
}

impl<D: Dim> Event<D> {
    /// Returns one [`Event::PieceDetached`] for each piece in `pieces`.
    pub(crate) fn pieces_detached(
        body: SoftBodyHandle,
        pieces: &[PieceId],
    ) -> impl Iterator<Item = Self> {
        pieces
            .iter()
            .map(move |&piece| Self::PieceDetached { body, piece })
    }
}

/// Contact between two objects, summed over all their contact points and over the substeps of a tick.
#[derive(Copy, Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound = ""))]
pub struct Contact<D: Dim> {
    /// The objects, in ascending order of [`ObjectRef`]: pieces precede rigid bodies, and two objects of one
    /// kind are ordered by handle and piece number. The order of a pair therefore never changes.
    pub pair: [ObjectRef; 2],
    /// Position of the contact point with the largest normal impulse in a substep [m].
    pub point: D::Vector,
    /// Unit normal at `point`, from the second object towards the first. The contact pushes the first object
    /// along the normal, and the second object in the opposite direction.
    pub normal: D::Vector,
    /// Highest approach speed along the normal at any contact point, in any substep of the tick [m/s].
    pub speed: f32,
    /// Sum of the magnitudes of the normal impulses over all contact points and substeps [N s]. Divided by
    /// the tick length [s], this sum is the mean normal force [N]. Friction is not included.
    pub impulse: f32,
    /// Mean contact force on the first object during the tick, with friction [N]. The force on the second
    /// object is opposite. If both objects sleep or stand still, the mean over the time in which they settled.
    pub force: D::Vector,
    /// Torque of the contact forces on the first object about `point` [N m]; in 2D positive is
    /// counterclockwise.
    pub torque: D::Angular,
}

hash_state! {
    [D: Dim] struct Contact<D> { pair, point, normal, speed, impulse, force, torque }
}

impl<D: Dim> Contact<D> {
    /// Returns the partner of a selected object in this contact. Returns `None` if neither object of the pair
    /// is selected, and the second object if both are.
    pub fn other(&self, object: impl Into<ObjectSelector>) -> Option<ObjectRef> {
        let selector = object.into();
        let [first, second] = self.pair;
        match () {
            () if selector.contains(first) => Some(second),
            () if selector.contains(second) => Some(first),
            () => None,
        }
    }
}

/// Summary of one tick.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct StepReport {
    /// Number of substeps in the tick.
    pub substeps: u32,
    /// Number of nodes that were split during the tick.
    pub nodes_split: u32,
    /// Number of pieces that were detached during the tick.
    pub pieces_detached: u32,
    /// Number of elements that are turned inside out at the end of the tick. Their elastic forces turn them
    /// back.
    pub inverted: u32,
    /// Number of pieces in impacts that were too fast for the substeps, see [`Event::ImpactSlowed`].
    pub slowed_impacts: u32,
    /// Number of nodes, summed over the substeps, whose speed relative to the rigid motion of their piece was
    /// limited to a voxel per substep. The piece keeps its momentum but loses energy.
    pub speed_limited: u32,
    /// Number of pieces that were frozen permanently during the tick, see [`Event::Quarantined`].
    pub quarantined: u32,
    /// Number of soft bodies with less stiffness damping than their materials specify, because the substep
    /// limits it, see [`World::acting_damping`](crate::World::acting_damping).
    pub damping_limited: u32,
    /// Number of soft bodies that require more substeps than the world allows, and whose mass or stiffness is
    /// therefore scaled, see [`WorldConfig::stiff_bodies`](crate::WorldConfig::stiff_bodies).
    pub scaled_bodies: u32,
    /// Largest scale of a soft body: its mass scale, or the inverse of its stiffness scale. It is the squared
    /// ratio of the required and the allowed number of substeps; 1 if no body is scaled.
    pub largest_scale: f32,
}
