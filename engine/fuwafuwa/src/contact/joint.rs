//! Joints: pins, springs and ropes between soft bodies, rigid bodies and points of the world.
//!
//! Each joint connects two *anchors*. In every substep a joint applies an impulse, solved for all axes
//! together. As with contacts, the correction of position errors adds no velocity [Catto 2023]. Springs are
//! integrated implicitly and are stable at any stiffness.

mod attached_anchor;
mod joint_end;
mod joint_ref;
mod joint_solver;
mod joint_state;

use crate::foundation::arena::{RigidBodyHandle, SoftBodyHandle};
use crate::foundation::dim::Dim;
use crate::foundation::hash::hash_state;
use crate::world::BodyHandle;
pub(crate) use attached_anchor::{corner_of, node_at};
pub(crate) use joint_end::JointEnd;
pub use joint_ref::JointRef;
pub(crate) use joint_state::{JointState, Joints, relax, solve};

/// Joint between two anchors, to add with [`World::add_joint`](crate::World::add_joint).
///
/// ```
/// use fuwafuwa::{Dim2, Joint, JointAnchor, Material, SoftBody, Vec2, VoxelGrid, World, WorldConfig};
///
/// let mut world = World::<Dim2>::new(WorldConfig::default())?;
/// // The ball weighs 770 N and hangs from 0.4 m of its surface: 1.9 kPa, above the default strength of 1 kPa.
/// let material = Material {
///     strength: 4000.0,
///     ..Material::default()
/// };
/// let ball = SoftBody::new(VoxelGrid::ball(12, 1.0)?, &[material])?;
/// let ball = world.add_soft_body(ball)?;
/// let top = Vec2::new(0.5, 1.0);
/// let anchor = JointAnchor::on(ball, top).within(0.2);
/// let nail = world.add_joint(Joint::pin(anchor, JointAnchor::Point(top)))?;
/// for _ in 0..60 {
///     world.step();
/// }
/// assert!(world[ball].centre_of_mass().y > 0.2);
/// world.remove(nail)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Copy, Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound = ""))]
pub struct Joint<D: Dim> {
    /// Attachment points. Not two points of the world, and not twice the same rigid body; both may be on one soft body.
    pub anchors: [JointAnchor<D>; 2],
    /// Behaviour: pin, spring or rope.
    pub kind: JointKind,
    /// Force above which the joint breaks [N], in tension or compression; infinite (default) = never.
    pub breaking_force: f32,
}

impl<D: Dim> Joint<D> {
    /// Returns a joint of any kind that never breaks.
    pub fn new(anchors: [JointAnchor<D>; 2], kind: JointKind) -> Self {
        let breaking_force = f32::INFINITY;
        Self {
            anchors,
            kind,
            breaking_force,
        }
    }

    /// Returns a pin, which keeps its anchors together.
    pub fn pin(first: JointAnchor<D>, second: JointAnchor<D>) -> Self {
        Self::new([first, second], JointKind::Pin)
    }

    /// Returns a rope of a maximum length [m].
    pub fn rope(first: JointAnchor<D>, second: JointAnchor<D>, length: f32) -> Self {
        Self::new([first, second], JointKind::Rope { length })
    }

    /// Returns a spring with a stiffness [N/m], a damping [N s/m] and a rest length [m].
    pub fn spring(
        [first, second]: [JointAnchor<D>; 2],
        stiffness: f32,
        damping: f32,
        length: f32,
    ) -> Self {
        let kind = JointKind::Spring {
            stiffness,
            damping,
            length,
        };
        Self::new([first, second], kind)
    }

    /// Returns the joint with a breaking force [N].
    #[must_use]
    pub fn with_breaking_force(self, breaking_force: f32) -> Self {
        Self {
            breaking_force,
            ..self
        }
    }
}

/// Attachment point of a joint, on a body or in the world.
#[derive(Copy, Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound = ""))]
pub enum JointAnchor<D: Dim> {
    /// Point of the world [m].
    Point(D::Vector),
    /// Point of a rigid body. It need not be on the surface or inside of the body.
    RigidBody {
        /// Handle of the rigid body.
        body: RigidBodyHandle,
        /// World-space position at the time when the joint is added [m].
        point: D::Vector,
    },
    /// Mean position of the nodes near a point of a soft body.
    SoftBody {
        /// Handle of the soft body.
        body: SoftBodyHandle,
        /// World-space position at the time when the joint is added [m].
        point: D::Vector,
        /// Radius around `point` within which nodes are attached [m], default 0. If there is no node within
        /// the radius, the nearest node is attached. More nodes share the load, so that the body tears less
        /// easily.
        radius: f32,
    },
}

impl<D: Dim> JointAnchor<D> {
    /// Returns an anchor at a point [m] of a rigid body, or at the nearest node of a soft body.
    pub fn on(body: impl Into<BodyHandle>, point: D::Vector) -> Self {
        match body.into() {
            BodyHandle::Rigid(body) => Self::RigidBody { body, point },
            BodyHandle::Soft(body) => Self::SoftBody {
                body,
                point,
                radius: 0.0,
            },
        }
    }

    /// Returns the anchor with all nodes of its soft body within a radius [m]. Returns anchors that are not
    /// on a soft body unchanged.
    #[must_use]
    pub fn within(self, radius: f32) -> Self {
        match self {
            Self::SoftBody { body, point, .. } => Self::SoftBody {
                body,
                point,
                radius,
            },
            other => other,
        }
    }
}

/// Kind of a joint.
#[derive(Copy, Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum JointKind {
    /// Pin: keeps the anchors together and lets the bodies rotate. If only one anchor is on a soft body, the
    /// other anchor moves to it when the joint is added, so that nothing jumps. In all other cases, anchors
    /// that are apart are drawn together.
    Pin,
    /// Spring with a rest length.
    Spring {
        /// Stiffness [N/m], 1e-6 to 1e12.
        stiffness: f32,
        /// Damping [N s/m], 0 to 1e12.
        damping: f32,
        /// Rest length [m], 0 to 1e6.
        length: f32,
    },
    /// Rope: limits the distance between the anchors.
    Rope {
        /// Maximum distance [m], positive, at most 1e6.
        length: f32,
    },
}

hash_state! { enum JointKind { Pin, Spring { stiffness, damping, length }, Rope { length } } }
