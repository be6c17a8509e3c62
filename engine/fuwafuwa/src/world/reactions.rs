//! Reactions: forces and torques that contacts, joints, knives and grips exert on objects, and that hold fixed
//! nodes.

use super::World;
use crate::error::Error;
use crate::foundation::arena::SoftBodyHandle;
use crate::foundation::dim::{Dim, DimAngular, DimVector};
use crate::foundation::hash::hash_state;
use crate::foundation::ids::NodeId;
use crate::object_ref::{ObjectRef, ObjectSelector};
use crate::rigid_body::shape::Shape;
use crate::soft_body::SoftBody;
use glam::{DVec3, Vec3};

/// Force, and torque about a point.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound = ""))]
pub struct ReactionForce<D: Dim> {
    /// Point that the torque refers to [m].
    pub point: D::Vector,
    /// Force [N].
    pub force: D::Vector,
    /// Torque about `point` [N m]; in 2D positive is counterclockwise.
    pub torque: D::Angular,
}

hash_state! { [D: Dim] struct ReactionForce<D> { point, force, torque } }

impl<D: Dim> ReactionForce<D> {
    /// Returns the mean of `count` reactions, given the mean `self` of all but the last one, and the last one.
    /// The torque is about the point of the last one.
    pub(super) fn mean_with(self, last: Self, count: u32) -> Self {
        let mut sum = ForceSum::default();
        let share = 1.0 / count as f32;
        sum.add_reaction(&self, 1.0 - share);
        sum.add_reaction(&last, share);
        sum.about(last.point)
    }

    /// Returns the same reaction with the torque about another point [m].
    #[must_use]
    pub fn about(self, point: D::Vector) -> Self {
        let mut sum = ForceSum::default();
        sum.add_reaction(&self, 1.0);
        sum.about(point)
    }
}

/// Sum of forces, with their moment about the origin. In double precision, because the moment about a distant
/// origin is much larger than the torque.
#[derive(Copy, Clone, Debug, Default)]
pub(super) struct ForceSum {
    force: DVec3,
    moment: DVec3,
}

impl ForceSum {
    /// Adds a force [N] at a position [m].
    pub(super) fn add(&mut self, force: Vec3, at: Vec3) {
        let force = force.as_dvec3();
        self.force += force;
        self.moment += at.as_dvec3().cross(force);
    }

    fn add_reaction<D: Dim>(&mut self, reaction: &ReactionForce<D>, sign: f32) {
        self.add((reaction.force * sign).to_vec3(), reaction.point.to_vec3());
        self.moment += (reaction.torque * sign).to_vec3().as_dvec3();
    }

    pub(super) fn about<D: Dim>(&self, point: D::Vector) -> ReactionForce<D> {
        let at = point.to_vec3().as_dvec3();
        let torque = self.moment - at.cross(self.force);
        ReactionForce {
            point,
            force: D::Vector::from_vec3(self.force.as_vec3()),
            torque: D::Angular::from_vec3(torque.as_vec3()),
        }
    }
}

impl<D: Dim> World<D> {
    /// Returns the force and torque that contacts, joints, knives and grips exert on a rigid body of any motion
    /// type, on a piece, or on a whole soft body. The torque is about the position of the rigid body, or about the
    /// centre of mass of the soft body.
    ///
    /// Contact forces are means over the last tick. Forces between the pieces of a selected soft body cancel.
    /// While both objects of a contact sleep or stand still, its force is the mean over the time in which they
    /// settled: a floor carries the weight of a sleeping body within 1.6 %. A joint keeps its last force.
    ///
    /// Not included are:
    ///
    /// - what holds [fixed nodes](World::fixed_node_reaction);
    /// - contacts of kinematic and coupled bodies with each other and with fixed bodies: see
    ///   [`RigidBodyRef::reactions`](crate::RigidBodyRef::reactions) of the kinematic or coupled body;
    /// - the force of a knife on the body that it cuts, and the forces of grips on a single piece.
    ///
    /// ```
    /// use fuwafuwa::{Dim3, RigidBody, Shape, Vec3, World, WorldConfig};
    ///
    /// let mut world = World::<Dim3>::new(WorldConfig::default())?;
    /// let floor = world.add_rigid_body(RigidBody::fixed(Shape::half_space(Vec3::Y, Vec3::ZERO)))?;
    /// let cube = RigidBody::dynamic(Shape::cuboid(Vec3::splat(0.1)), 2.0).at(0.1 * Vec3::Y);
    /// world.add_rigid_body(cube)?;
    /// for _ in 0..120 {
    ///     world.step();
    /// }
    /// let reaction = world.reaction(floor)?;
    /// assert!((reaction.force.y + 2.0 * 9.81).abs() < 0.1);
    /// # Ok::<(), fuwafuwa::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::InvalidHandle`] if the object does not exist, [`Error::InvalidParameter`] if the body has no such
    /// piece.
    #[inline(never)]
    pub fn reaction(&self, object: impl Into<ObjectSelector>) -> Result<ReactionForce<D>, Error> {
        let object = object.into();
        let mut sum = ForceSum::default();
        for contact in self.contacts_of(object)? {
            let part = ReactionForce::<D> {
                point: contact.point,
                force: contact.force,
                torque: contact.torque,
            };
            match contact.pair.map(|one| object.contains(one)) {
                [true, false] => sum.add_reaction(&part, 1.0),
                [false, true] => sum.add_reaction(&part, -1.0),
                _ => {}
            }
        }
        for joint in self.joints.iter() {
            let [first, second] = joint.attached_objects(&self.bodies);
            let Some([at, other]) = joint.anchor_positions(&self.bodies, &self.rigids) else {
                continue;
            };
            if first.is_some_and(|first| object.contains(first)) {
                sum.add(joint.reaction(), at);
            }
            if second.is_some_and(|second| object.contains(second)) {
                sum.add(-joint.reaction(), other);
            }
        }
        for knife in self.knives.iter() {
            if let Ok(holder) = self.rigids.get(knife.holder)
                && object.contains(ObjectRef::RigidBody(knife.holder))
            {
                let part = ReactionForce::<D> {
                    point: D::Vector::from_vec3(holder.position()),
                    force: D::Vector::from_vec3(knife.force()),
                    torque: D::Angular::from_vec3(knife.torque()),
                };
                sum.add_reaction(&part, 1.0);
            }
        }
        for grip in self.grips.iter() {
            let on_body = object == ObjectSelector::SoftBody(grip.body);
            if on_body {
                sum.add_reaction::<D>(&grip.reaction(), 1.0);
            }
            let carrier = grip.carrier().map(ObjectRef::RigidBody);
            if carrier.is_some_and(|carrier| object.contains(carrier)) {
                sum.add_reaction::<D>(&grip.reaction(), -1.0);
            }
        }
        Ok(sum.about(self.reference_point(object)?))
    }

    fn reference_point(&self, object: ObjectSelector) -> Result<D::Vector, Error> {
        Ok(match object {
            ObjectSelector::SoftBody(body) => self.bodies.get(body)?.centre_of_mass(),
            ObjectSelector::Object(ObjectRef::RigidBody(rigid)) => {
                D::Vector::from_vec3(self.rigids.get(rigid)?.position())
            }
            ObjectSelector::Object(ObjectRef::Piece { body, piece }) => {
                let motion = self.bodies.get(body)?.motion_of_piece(piece);
                D::Vector::from_vec3(motion.centre.as_vec3())
            }
        })
    }

    /// Returns the force and torque that hold the [fixed](SoftBody::fix_node) nodes of a body inside `region` or
    /// on its surface: the opposite of their elastic forces in the last substep and of their weight. A body that
    /// sleeps keeps the elastic forces with which it fell asleep, so its slow vibration may change the reaction
    /// by up to 3 %; the reaction of a [grip](crate::Grip) is a mean. The torque is about the centre of mass of
    /// these nodes. An external [field](crate::Hooks::field), and contacts of the fixed nodes themselves, are not
    /// included.
    ///
    /// ```
    /// use fuwafuwa::{Material, NodeId, Shape, SoftBody, Vec2, VoxelGrid, World2, WorldConfig};
    ///
    /// let mut world = World2::new(WorldConfig::default())?;
    /// let mut block = SoftBody::new(VoxelGrid::cube(8, 1.0)?, &[Material::default()])?;
    /// let base = Shape::half_space(Vec2::Y, 0.01 * Vec2::Y);
    /// let nodes: Vec<NodeId> = block.nodes_in(&base).collect();
    /// nodes.iter().for_each(|&node| block.fix_node(node));
    /// let weight = 9.81 * block.total_mass() as f32;
    /// let block = world.add_soft_body(block)?;
    /// for _ in 0..300 {
    ///     world.step();
    /// }
    /// let reaction = world.fixed_node_reaction(block, &base)?;
    /// assert!((reaction.force.y / weight - 1.0).abs() < 0.03);
    /// # Ok::<(), fuwafuwa::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error`] if the handle is stale, the region is not [valid](Shape::check), or it contains no fixed node.
    #[inline(never)]
    pub fn fixed_node_reaction(
        &self,
        body: SoftBodyHandle,
        region: &Shape<D>,
    ) -> Result<ReactionForce<D>, Error> {
        let body = self.bodies.get(body)?;
        region.check().map_err(|error| error.of("region"))?;
        let nodes = body.nodes_in(region).filter(|&node| body.is_fixed(node));
        let nodes: Vec<NodeId> = nodes.collect();
        if nodes.is_empty() {
            let expected = "a region with fixed nodes";
            return Err(Error::parameter("region", expected, region));
        }
        let mut sum = ForceSum::default();
        let (mut moment, mut mass) = (DVec3::ZERO, 0.0);
        for &node in &nodes {
            let at = body.positions()[node].xyz();
            sum.add(-self.load_on(body, node), at);
            let own = f64::from(body.masses()[node]);
            moment += at.as_dvec3() * own;
            mass += own;
        }
        Ok(sum.about(D::Vector::from_vec3((moment / mass).as_vec3())))
    }

    /// Returns the elastic force in the last substep and the weight of a node [N].
    pub(super) fn load_on(&self, body: &SoftBody<D>, node: NodeId) -> Vec3 {
        load_on(body, node, self.config.gravity.to_vec3())
    }
}

/// Returns the elastic force in the last substep and the weight of a node [N], in the `gravity` of the world
/// [m/s²].
pub(super) fn load_on<D: Dim>(body: &SoftBody<D>, node: NodeId, gravity: Vec3) -> Vec3 {
    let weight = gravity * (body.gravity_scale() * body.masses()[node]);
    body.force_on(node).to_vec3() + weight
}
