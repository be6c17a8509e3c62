//! Joint anchors: a point of the world, a point of a rigid body, or the mean position of some nodes of a soft
//! body.

use super::joint_end::{JointEnd, Woken};
use crate::error::Error;
use crate::foundation::arena::{RigidBodyHandle, SoftBodyHandle};
use crate::foundation::dim::{Dim, Point, voxel_around};
use crate::foundation::hash::hash_state;
use crate::foundation::ids::NodeId;
use crate::math::row::Row;
use crate::object_ref::ObjectRef;
#[cfg(feature = "serde")]
use crate::rigid_body::FARTHEST;
use crate::rigid_body::RigidBodies;
use crate::rigid_body::solid::flat;
use crate::soft_body::{SoftBodies, SoftBody};
use glam::Vec3;

/// Anchor of a joint, attached to a body or fixed in the world.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum AttachedAnchor {
    /// Point of the world [m].
    Position(Vec3),
    /// Point of a rigid body in local coordinates [m].
    RigidBody(RigidBodyHandle, Vec3),
    /// Voxel corners of a soft body, each given by a voxel and the lattice point of the corner. The anchor is
    /// at the mean position of the nodes at these corners. If the body tears at a corner, the anchor stays
    /// with the given voxel.
    Soft(SoftBodyHandle, Vec<(Point, Point)>),
}

hash_state! { enum AttachedAnchor { Position(at), RigidBody(rigid, at), Soft(body, corners) } }

/// State and compliance of an anchor.
#[derive(Copy, Clone, Debug)]
pub struct AnchorState {
    /// Position [m].
    pub at: Vec3,
    /// Velocity [m/s].
    pub velocity: Vec3,
    /// Inverse effective mass matrix, by rows [1/kg]: velocity change of the anchor per impulse.
    pub inverse_mass: [Vec3; 3],
    pub is_asleep: bool,
}

impl AttachedAnchor {
    /// Returns the anchor for the attachment point `end`, with the bodies at their present positions.
    pub fn of<D: Dim>(
        end: &JointEnd,
        bodies: &SoftBodies<D>,
        rigids: &RigidBodies,
    ) -> Result<Self, Error> {
        Ok(match *end {
            JointEnd::Position(at) => Self::Position(flat::<D>(at)),
            JointEnd::RigidBody { rigid: id, at } => {
                let rigid = rigids.get(id)?;
                let apart = flat::<D>(at) - rigid.position();
                Self::RigidBody(id, rigid.rotation().inverse().apply(apart))
            }
            JointEnd::Soft {
                body: id,
                at,
                radius,
            } => {
                let body = bodies.get(id)?;
                Self::Soft(id, corners_near(body, flat::<D>(at), radius))
            }
        })
    }

    /// Returns whether the anchor is on nodes of a soft body.
    pub fn is_soft(&self) -> bool {
        matches!(self, Self::Soft(..))
    }

    /// Returns the object that the anchor is attached to; `None` for a point of the world. For nodes of several
    /// pieces, the piece of the first node.
    pub fn object<D: Dim>(&self, bodies: &SoftBodies<D>) -> Option<ObjectRef> {
        match self {
            Self::Position(_) => None,
            Self::RigidBody(id, _) => Some(ObjectRef::RigidBody(*id)),
            Self::Soft(id, corners) => {
                let body = bodies.get(*id).ok()?;
                let node = nodes(body, corners).next()?;
                let piece = body.pieces().of_node(node);
                Some(ObjectRef::Piece { body: *id, piece })
            }
        }
    }

    /// Moves an anchor on a rigid body or in the world to a world-space point [m]. Does nothing to an anchor
    /// on a soft body.
    pub fn move_to(&mut self, at: Vec3, rigids: &RigidBodies) {
        match self {
            Self::Position(place) => *place = at,
            Self::RigidBody(id, own) => {
                if let Ok(rigid) = rigids.get(*id) {
                    *own = rigid.rotation().inverse().apply(at - rigid.position());
                }
            }
            Self::Soft(..) => {}
        }
    }

    /// Returns the present state of the anchor; `None` if its body or all of the attached voxels are gone.
    pub fn state<D: Dim>(
        &self,
        bodies: &SoftBodies<D>,
        rigids: &RigidBodies,
    ) -> Option<AnchorState> {
        match self {
            Self::Position(at) => Some(AnchorState {
                at: *at,
                velocity: Vec3::ZERO,
                inverse_mass: [Vec3::ZERO; 3],
                is_asleep: false,
            }),
            Self::RigidBody(id, own) => {
                let rigid = rigids.get(*id).ok()?;
                let lever = rigid.rotation().apply(*own);
                Some(AnchorState {
                    at: rigid.position() + lever,
                    velocity: rigid.velocity_at(lever),
                    inverse_mass: Vec3::AXES.map(|way| rigid.velocity_per_impulse(lever, way)),
                    is_asleep: rigid.is_asleep(),
                })
            }
            Self::Soft(id, corners) => {
                let body = bodies.get(*id).ok()?;
                let nodes: Vec<NodeId> = nodes(body, corners).collect();
                if nodes.is_empty() {
                    return None;
                }
                let share = 1.0 / nodes.len() as f32;
                let (mut at, mut velocity, mut mean_inverse_mass) = (Vec3::ZERO, Vec3::ZERO, 0.0);
                let mut is_asleep = true;
                for &node in &nodes {
                    at += body.positions()[node].xyz() * share;
                    velocity += body.velocities()[node].xyz() * share;
                    mean_inverse_mass += body.inverse_masses()[node] * share * share;
                    is_asleep &= body.pieces().sleeps(node);
                }
                let mut inverse_mass = [Vec3::ZERO; 3];
                (0..D::N).for_each(|axis| inverse_mass[axis][axis] = mean_inverse_mass);
                if !body.responses().is_empty() {
                    let weights: Vec<_> = nodes.iter().map(|&node| (node, share)).collect();
                    velocity += body.response_velocity(&weights);
                    let whole = body.response_matrix(&weights);
                    (0..3).for_each(|row| inverse_mass[row] += whole[row]);
                }
                Some(AnchorState {
                    at,
                    velocity,
                    inverse_mass,
                    is_asleep,
                })
            }
        }
    }

    /// Applies an impulse [N s] to the body at the anchor.
    pub fn apply_impulse<D: Dim>(
        &self,
        bodies: &mut SoftBodies<D>,
        rigids: &mut RigidBodies,
        impulse: Vec3,
    ) {
        match self {
            Self::Position(_) => {}
            Self::RigidBody(id, own) => {
                if let Ok(rigid) = rigids.get_mut(*id) {
                    let lever = rigid.rotation().apply(*own);
                    rigid.apply_impulse(impulse, lever);
                }
            }
            Self::Soft(id, corners) => {
                let Ok(body) = bodies.get_mut(*id) else {
                    return;
                };
                let nodes: Vec<NodeId> = nodes(body, corners).collect();
                let share = Row::from(impulse * (1.0 / nodes.len() as f32));
                for &node in &nodes {
                    let change = share * body.inverse_masses()[node];
                    body.velocities_mut()[node] += change;
                    body.push_responses(&[(node, 1.0)], share.xyz());
                }
            }
        }
    }

    /// Adds to `woken` the rigid body, or the pieces of the soft body, that the anchor is attached to.
    pub fn wake<D: Dim>(&self, bodies: &SoftBodies<D>, woken: &mut Woken) {
        match self {
            Self::Position(_) => {}
            Self::RigidBody(id, _) => woken.rigids.push(id.slot()),
            Self::Soft(id, corners) => {
                let Ok(body) = bodies.get(*id) else {
                    return;
                };
                let pieces = nodes(body, corners).map(|node| body.pieces().of_node(node));
                woken.pieces.extend(pieces.map(|piece| (id.slot(), piece)));
            }
        }
    }

    /// Returns whether an anchor that was read from a file is valid and belongs to the attachment point
    /// `end`.
    #[cfg(feature = "serde")]
    pub fn is_sound<D: Dim>(&self, end: &JointEnd) -> bool {
        let is_of_it = match (self, end) {
            (Self::Position(_), JointEnd::Position(_)) => true,
            (Self::RigidBody(own, _), JointEnd::RigidBody { rigid, .. }) => own == rigid,
            (Self::Soft(own, _), JointEnd::Soft { body, .. }) => own == body,
            _ => false,
        };
        let is_valid = match self {
            Self::Position(at) | Self::RigidBody(_, at) => {
                let is_near = at.to_array().iter().all(|k| k.abs() <= 4.0 * FARTHEST);
                is_near && at.to_array()[D::N..].iter().all(|k| *k == 0.0)
            }
            Self::Soft(_, corners) => !corners.is_empty(),
        };
        is_of_it && is_valid
    }
}

/// Returns a node for each corner: of all nodes of the voxel's element, the node nearest to the lattice point
/// of the corner. Skips removed voxels.
fn nodes<'a, D: Dim>(
    body: &'a SoftBody<D>,
    corners: &'a [(Point, Point)],
) -> impl Iterator<Item = NodeId> + 'a {
    corners.iter().filter_map(|&corner| node_at(body, corner))
}

/// Returns the node at the corner of a voxel, given by the voxel and the lattice point of the corner: of all
/// nodes of the voxel's element, the node nearest to the lattice point. `None` if the voxel was removed.
pub(crate) fn node_at<D: Dim>(
    body: &SoftBody<D>,
    (voxel, point): (Point, Point),
) -> Option<NodeId> {
    let mesh = body.mesh();
    let element = mesh.element_at(voxel)?;
    let apart = |node: NodeId| {
        let at = mesh.node(node).at;
        // Subtracts in 64 bits to avoid overflow, because a file may contain any lattice point.
        let along = |axis: usize| i64::from(at[axis]) - i64::from(point[axis]);
        (0..D::N).map(|axis| along(axis).abs()).sum::<i64>()
    };
    let nodes = element.nodes.iter().copied();
    nodes.min_by_key(|&node| (apart(node), node))
}

/// Returns the corner of a voxel at which a node is.
pub(crate) fn corner_of<D: Dim>(body: &SoftBody<D>, node: NodeId) -> (Point, Point) {
    let own = body.mesh().node(node);
    let octant = own.group.trailing_zeros() as usize;
    (voxel_around::<D>(own.at, octant), own.at)
}

/// Returns the voxel corners of a body with a node within `radius` [m] of a point, or the corner with the
/// nearest node if there is none.
fn corners_near<D: Dim>(body: &SoftBody<D>, at: Vec3, radius: f32) -> Vec<(Point, Point)> {
    let distance = |node: NodeId| {
        let apart = body.positions()[node].xyz() - at;
        apart.dot(apart)
    };
    let mesh = body.mesh();
    let nodes = || mesh.nodes().map(|(node, _)| node);
    let is_near = |&node: &NodeId| distance(node) <= radius * radius;
    let mut near: Vec<NodeId> = nodes().filter(is_near).collect();
    if near.is_empty() {
        near.extend(nodes().min_by(|&a, &b| distance(a).total_cmp(&distance(b)).then(a.cmp(&b))));
    }
    near.into_iter().map(|node| corner_of(body, node)).collect()
}
