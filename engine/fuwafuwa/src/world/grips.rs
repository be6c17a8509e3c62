//! Grips: all nodes of a soft body inside a region, held still, carried by a rigid body, or pulled by a force.
//!
//! Finite-element programs call a held region a support or a prescribed displacement, and a pulled one a
//! distributed load. In each substep, a held node gets the velocity with which it reaches its place at the end
//! of the substep. No force changes this velocity. The opposite of all other forces is the reaction.

use super::World;
use super::reactions::{ForceSum, ReactionForce, load_on};
use crate::contact::joint::{corner_of, node_at};
use crate::contact::solver::Hit;
use crate::error::{Error, require};
use crate::event::Event;
use crate::foundation::arena::{Arena, GripHandle, RigidBodyHandle, SoftBodyHandle};
use crate::foundation::dim::{Dim, DimAngular, DimVector, Point};
use crate::foundation::hash::hash_state;
use crate::foundation::ids::NodeId;
use crate::math::row::Row;
use crate::rigid_body::shape::Shape;
use crate::rigid_body::solid::Solid;
use crate::rigid_body::{MotionType, RigidState, is_within_reach};
use crate::soft_body::SoftBody;
use glam::Vec3;
use std::collections::BTreeSet;
use std::marker::PhantomData;

/// Distance of a sleeping held node from its place above which its piece wakes [voxels]. Smaller motions are not
/// visible.
const WAKE_DISTANCE: f32 = 1e-3;

/// Grip on a region of a soft body, to add with [`World::add_grip`].
///
/// Elements grow from the surface inwards. If a held region ends inside large elements, which have no nodes
/// there, the stress beside it is 1.3 to 1.5 times the mean, and a bar breaks there at about 0.84 of strength ×
/// area (`fuwafuwa check grid`). To avoid this, grip the end faces only, or let the grip end at a multiple of 8
/// voxels. Elements with all nodes held do not count in the tension that starts a crack.
///
/// ```
/// use fuwafuwa::{
///     Dim3, Grip, Material, RigidBody, Shape, SoftBody, Vec3, VoxelGrid, World, WorldConfig,
/// };
///
/// // A bar is pulled by its ends, and the force is read.
/// let weightless = WorldConfig { gravity: Vec3::ZERO, ..WorldConfig::default() };
/// let mut world = World::<Dim3>::new(weightless)?;
/// let rubber = Material { strength: f32::INFINITY, ..Material::default() };
/// let bar = VoxelGrid::from_fn([16, 4, 4], 0.05, |_| 1)?;
/// let bar = world.add_soft_body(SoftBody::new(bar, &[rubber])?)?;
/// let left = Shape::half_space(Vec3::X, 0.01 * Vec3::X);
/// let right = Shape::half_space(Vec3::NEG_X, 0.79 * Vec3::X);
/// // A sensor has no contacts of its own.
/// let clamp = RigidBody::kinematic(Shape::ball(0.01)).at(0.8 * Vec3::X).with_sensor(true);
/// let clamp = world.add_rigid_body(clamp)?;
/// let fixed = world.add_grip(Grip::still(bar, left))?;
/// let pulled = world.add_grip(Grip::carried(bar, right, clamp))?;
/// for tick in 1..=240 {
///     let stretch = 0.04 * (tick.min(120) as f32 / 120.0);
///     world.set_target_position(clamp, (0.8 + stretch) * Vec3::X)?;
///     world.step();
/// }
/// // The reactions are opposite: nothing else acts.
/// let [near, far] = [fixed, pulled].map(|grip| world.grip(grip).map(|grip| grip.reaction().force.x));
/// let (near, far) = (near?, far?);
/// assert!(far > 0.0 && (near + far).abs() < 0.01 * far);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Grip<D: Dim> {
    /// Soft body.
    pub body: SoftBodyHandle,
    /// Region, in world coordinates at the time when the grip is added. The nodes inside the region or on its
    /// surface at that time are gripped; they stay gripped wherever they move.
    pub region: Shape<D>,
    /// How the gripped nodes are held or pulled.
    pub drive: GripDrive<D>,
}

/// How a grip holds or pulls its nodes.
#[derive(Copy, Clone, Debug, PartialEq)]
pub enum GripDrive<D: Dim> {
    /// The nodes stay where they are.
    Still,
    /// The nodes move with a fixed or kinematic rigid body, as if they were glued to it.
    Carried(RigidBodyHandle),
    /// A force [N], spread over the nodes in proportion to their mass, at most 1e9 N on each axis. The nodes
    /// can move.
    Force(D::Vector),
}

impl<D: Dim> Grip<D> {
    /// Returns a grip that holds the region where it is.
    pub fn still(body: SoftBodyHandle, region: Shape<D>) -> Self {
        let drive = GripDrive::Still;
        Self {
            body,
            region,
            drive,
        }
    }

    /// Returns a grip that moves the region with a fixed or kinematic rigid body.
    pub fn carried(body: SoftBodyHandle, region: Shape<D>, carrier: RigidBodyHandle) -> Self {
        let drive = GripDrive::Carried(carrier);
        Self {
            body,
            region,
            drive,
        }
    }

    /// Returns a grip that pulls the region with a force [N].
    pub fn force(body: SoftBodyHandle, region: Shape<D>, force: D::Vector) -> Self {
        let drive = GripDrive::Force(force);
        Self {
            body,
            region,
            drive,
        }
    }
}

/// Grips of a world.
pub(crate) type Grips = Arena<GripHandle, GripState>;

/// State of a grip in the simulation.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct GripState {
    pub(super) body: SoftBodyHandle,
    region: Solid,
    drive: Drive,
    /// Gripped nodes.
    nodes: Vec<GrippedNode>,
    /// Corners of the nodes that were fixed before, by the program and not by a grip.
    fixed_before: Vec<(Point, Point)>,
    /// Force on the body in the last substep in which it was awake, or mean while it settled [N].
    force: Vec3,
    /// Torque of this force about `point` [N m].
    torque: Vec3,
    /// Mean position of the gripped nodes in that substep [m].
    point: Vec3,
    /// Number of substeps in the mean: those in which all gripped pieces were slow.
    settled: u32,
}

hash_state! {
    struct GripState { body, region, drive, nodes, fixed_before, force, torque, point, settled }
}

/// Internal counterpart of [`GripDrive`].
#[derive(Copy, Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
enum Drive {
    Still,
    Carried(RigidBodyHandle),
    Force(Vec3),
}

hash_state! { enum Drive { Still, Carried(carrier), Force(force) } }

/// Gripped node: a voxel with the lattice point of one of its corners. If the body tears there, the node of
/// this voxel stays gripped.
#[derive(Copy, Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct GrippedNode {
    corner: (Point, Point),
    /// Place of a held node, in local coordinates of the carrier or, without a carrier, of the world [m].
    place: Vec3,
}

hash_state! { struct GrippedNode { corner, place } }

impl GripState {
    pub(super) fn carrier(&self) -> Option<RigidBodyHandle> {
        match self.drive {
            Drive::Carried(carrier) => Some(carrier),
            Drive::Still | Drive::Force(_) => None,
        }
    }

    fn holds(&self) -> bool {
        !matches!(self.drive, Drive::Force(_))
    }

    /// Returns the force on the body in the last substep in which it was awake.
    pub(super) fn reaction<D: Dim>(&self) -> ReactionForce<D> {
        ReactionForce {
            point: D::Vector::from_vec3(self.point),
            force: D::Vector::from_vec3(self.force),
            torque: D::Angular::from_vec3(self.torque),
        }
    }

    fn definition<D: Dim>(&self) -> Grip<D> {
        Grip {
            body: self.body,
            region: Shape::of(&self.region),
            drive: match self.drive {
                Drive::Still => GripDrive::Still,
                Drive::Carried(carrier) => GripDrive::Carried(carrier),
                Drive::Force(force) => GripDrive::Force(D::Vector::from_vec3(force)),
            },
        }
    }

    /// Returns the gripped nodes that still exist, with their places.
    fn live_nodes<D: Dim>(&self, body: &SoftBody<D>) -> Vec<(NodeId, Vec3)> {
        let nodes = self.nodes.iter();
        let nodes = nodes.filter_map(|node| Some((node_at(body, node.corner)?, node.place)));
        let mut nodes: Vec<(NodeId, Vec3)> = nodes.collect();
        nodes.sort_by_key(|&(node, _)| node);
        nodes.dedup_by_key(|&mut (node, _)| node);
        nodes
    }

    /// Returns the nodes that were fixed before the grip was added and still exist.
    fn live_fixed_before<D: Dim>(&self, body: &SoftBody<D>) -> Vec<NodeId> {
        let corners = self.fixed_before.iter();
        corners
            .filter_map(|&corner| node_at(body, corner))
            .collect()
    }

    /// Grips a node at its present position.
    fn add<D: Dim>(&mut self, body: &SoftBody<D>, node: NodeId, carrier: Option<&RigidState>) {
        let at = body.positions()[node].xyz();
        let place = match carrier {
            Some(carrier) => carrier.rotation().inverse().apply(at - carrier.position()),
            None => at,
        };
        self.nodes.push(GrippedNode {
            corner: corner_of(body, node),
            place,
        });
    }

    /// Grips the nodes that a tear has added between gripped ones: fixed nodes within the lattice box of the
    /// gripped ones, without `others`, which other grips hold, and without those that were fixed before.
    fn adopt<D: Dim>(
        &mut self,
        body: &SoftBody<D>,
        carrier: Option<&RigidState>,
        others: impl Iterator<Item = NodeId>,
    ) {
        let own = self.live_nodes(body).into_iter().map(|(id, _)| id);
        let known: BTreeSet<NodeId> = own
            .chain(self.live_fixed_before(body))
            .chain(others)
            .collect();
        let points = self.nodes.iter().map(|node| node.corner.1);
        let (mut low, mut high) = ([i32::MAX; 3], [i32::MIN; 3]);
        for point in points {
            for axis in 0..3 {
                low[axis] = low[axis].min(point[axis]);
                high[axis] = high[axis].max(point[axis]);
            }
        }
        let is_inside = |at: Point| (0..3).all(|axis| (low[axis]..=high[axis]).contains(&at[axis]));
        let nodes = body.mesh().nodes();
        let new = nodes.filter(|&(id, node)| body.is_fixed(id) && is_inside(node.at));
        let new: Vec<NodeId> = new
            .map(|(id, _)| id)
            .filter(|id| !known.contains(id))
            .collect();
        new.into_iter().for_each(|id| self.add(body, id, carrier));
    }

    /// Returns whether a grip that was read from a file has valid values.
    #[cfg(feature = "serde")]
    pub(super) fn is_sound<D: Dim>(&self) -> bool {
        let force = match self.drive {
            Drive::Force(force) => force,
            Drive::Still | Drive::Carried(_) => Vec3::ZERO,
        };
        let vectors = [self.force, self.point, force];
        let places = self.nodes.iter().map(|node| node.place);
        self.region.check().is_ok()
            && self.torque.is_finite()
            && vectors.into_iter().chain(places).all(|vector| {
                vector.is_finite() && crate::rigid_body::solid::flat::<D>(vector) == vector
            })
    }
}

/// Grip of a world, for reading; see [`World::grip`].
#[derive(Copy, Clone, Debug)]
pub struct GripRef<'a, D: Dim> {
    state: &'a GripState,
    dim: PhantomData<D>,
}

impl<'a, D: Dim> GripRef<'a, D> {
    /// Returns the grip as it was added, with its present force.
    pub fn definition(&self) -> Grip<D> {
        self.state.definition()
    }

    /// Returns the force of the grip on the body, and its torque about the mean position of the gripped nodes,
    /// in the last substep in which the body was awake. After the body has settled, this is the mean over the time
    /// in which it settled. A body that falls asleep while it still vibrates leaves an error of up to 1.6 % of its
    /// weight. With sleep turned off there is no mean. [`ReactionForce::about`] returns the torque about another
    /// point. Contacts of the gripped nodes themselves and external fields are not included.
    pub fn reaction(&self) -> ReactionForce<D> {
        self.state.reaction()
    }

    /// Returns the number of gripped nodes.
    pub fn node_count(&self) -> usize {
        self.state.nodes.len()
    }
}

impl<D: Dim> World<D> {
    /// Adds a grip. Its body wakes. A held node counts as [fixed](SoftBody::fix_node), and is free after the grip
    /// is removed, unless it was fixed before or another grip holds it.
    ///
    /// # Errors
    /// [`Error`] if a handle is stale, the carrier is neither fixed nor kinematic, the region is not
    /// [valid](Shape::check) or contains no node, or the force is out of range.
    #[inline(never)]
    pub fn add_grip(&mut self, grip: Grip<D>) -> Result<GripHandle, Error> {
        let body = self.bodies.get(grip.body)?;
        grip.region.check().map_err(|error| error.of("region"))?;
        let (drive, carrier) = match grip.drive {
            GripDrive::Still => (Drive::Still, None),
            GripDrive::Carried(id) => {
                let carrier = self.rigids.get(id)?;
                let motion_type = carrier.motion_type;
                let is_carrier = matches!(motion_type, MotionType::Fixed | MotionType::Kinematic);
                require(is_carrier, "carrier", "fixed or kinematic", motion_type)?;
                (Drive::Carried(id), Some(carrier))
            }
            GripDrive::Force(force) => (Drive::Force(checked_force::<D>(force)?), None),
        };
        let mut state = GripState {
            body: grip.body,
            region: grip.region.solid(),
            drive,
            nodes: Vec::new(),
            fixed_before: Vec::new(),
            force: Vec3::ZERO,
            torque: Vec3::ZERO,
            point: Vec3::ZERO,
            settled: 0,
        };
        let nodes: Vec<NodeId> = body.nodes_in(&grip.region).collect();
        nodes
            .iter()
            .for_each(|&node| state.add(body, node, carrier));
        if nodes.is_empty() {
            let expected = "a region with nodes of the body";
            return Err(Error::parameter("region", expected, grip.region));
        }
        if state.holds() {
            let held = self.held_nodes(grip.body, None);
            let fixed = body.mesh().nodes().map(|(id, _)| id);
            let fixed = fixed.filter(|&id| body.is_fixed(id) && !held.contains(&id));
            state.fixed_before = fixed.map(|id| corner_of(body, id)).collect();
        }
        self.wake_up(grip.body)?;
        if state.holds() {
            let body = self.bodies.get_mut(grip.body)?;
            nodes.iter().for_each(|&node| body.fix_node(node));
        }
        Ok(self.grips.insert(state))
    }

    /// Removes a grip, see [`World::remove`].
    #[inline(never)]
    pub(crate) fn remove_grip(&mut self, grip: GripHandle) -> Result<Grip<D>, Error> {
        let grip = self.grips.remove(grip)?;
        let held = self.held_nodes(grip.body, None);
        if let Ok(body) = self.bodies.get_mut(grip.body) {
            if grip.holds() {
                let kept = grip.live_fixed_before(body).into_iter();
                let kept: BTreeSet<NodeId> = kept.chain(held).collect();
                let nodes = grip.live_nodes(body).into_iter().map(|(node, _)| node);
                let freed = nodes.filter(|node| !kept.contains(node));
                freed.for_each(|node| body.free_node(node));
            }
            self.wake_up(grip.body)?;
        }
        Ok(grip.definition())
    }

    /// Returns the nodes of a body that grips hold, without those of the grip `except`.
    fn held_nodes(&self, body: SoftBodyHandle, except: Option<GripHandle>) -> BTreeSet<NodeId> {
        let grips = self.grips.entries();
        let grips =
            grips.filter(|&(id, grip)| grip.body == body && grip.holds() && Some(id) != except);
        let Ok(body) = self.bodies.get(body) else {
            return BTreeSet::new();
        };
        let nodes = grips.flat_map(|(_, grip)| grip.live_nodes(body));
        nodes.map(|(node, _)| node).collect()
    }

    /// Returns a grip.
    ///
    /// # Errors
    /// [`Error::InvalidHandle`] if the handle is stale.
    pub fn grip(&self, grip: GripHandle) -> Result<GripRef<'_, D>, Error> {
        let dim = PhantomData;
        self.grips.get(grip).map(|state| GripRef { state, dim })
    }

    /// Iterates over the handles and grips, in the order of their arena slots.
    pub fn grips(&self) -> impl Iterator<Item = (GripHandle, GripRef<'_, D>)> + Clone {
        let dim = PhantomData;
        let grips = self.grips.entries();
        grips.map(move |(id, state)| (id, GripRef { state, dim }))
    }

    /// Sets the force [N] of a grip that pulls. The body wakes.
    ///
    /// # Errors
    /// [`Error`] if the handle is stale, the grip holds its nodes instead, or the force is not finite or beyond
    /// ±1e9 N.
    pub fn set_grip_force(&mut self, grip: GripHandle, force: D::Vector) -> Result<(), Error> {
        let force = checked_force::<D>(force)?;
        let state = self.grips.get_mut(grip)?;
        let pulls = !state.holds();
        require(pulls, "drive", "a force", state.drive)?;
        state.drive = Drive::Force(force);
        let body = state.body;
        self.wake_up(body)
    }

    /// Removes grips whose body or carrier was removed, and adds new nodes of torn bodies to the others.
    pub(super) fn update_grips(&mut self) {
        if self.grips.is_empty() {
            return;
        }
        let is_gone = |grip: &GripState| {
            let carrier = grip.carrier();
            self.bodies.get(grip.body).is_err()
                || carrier.is_some_and(|carrier| self.rigids.get(carrier).is_err())
        };
        let gone = self.grips.entries().filter(|(_, grip)| is_gone(grip));
        let gone: Vec<GripHandle> = gone.map(|(id, _)| id).collect();
        for grip in gone {
            if self.remove_grip(grip).is_ok() {
                self.events.push(Event::GripEnded { grip });
            }
        }
        let holding = self.grips.entries().filter(|(_, grip)| grip.holds());
        let others = holding.map(|(id, grip)| (id, self.held_nodes(grip.body, Some(id))));
        let others: Vec<(GripHandle, BTreeSet<NodeId>)> = others.collect();
        for (id, others) in others {
            let grip = self.grips.get_mut(id).expect("the grip was just listed");
            let carrier = grip
                .carrier()
                .and_then(|carrier| self.rigids.get(carrier).ok());
            if let Ok(body) = self.bodies.get(grip.body) {
                grip.adopt(body, carrier, others.into_iter());
            }
        }
    }

    /// Sets the velocities of held nodes, and adds the forces of grips that pull, in a substep of `duration` [s].
    /// Returns the sleeping pieces that a carrier moves.
    pub(super) fn apply_grips(&mut self, duration: f32) -> Vec<Hit> {
        let mut woken = Vec::new();
        let gravity = self.config.gravity.to_vec3();
        for grip in self.grips.iter_mut() {
            let Ok(body) = self.bodies.get_mut(grip.body) else {
                continue;
            };
            let nodes = grip.live_nodes(body);
            let pose = grip
                .carrier()
                .and_then(|carrier| self.rigids.get(carrier).ok());
            let pose = pose.map(|carrier| carrier.pose_after(duration));
            let mut sum = ForceSum::default();
            let mut centre = Vec3::ZERO;
            let awake = nodes
                .iter()
                .filter(|&&(node, _)| !body.pieces().sleeps(node));
            let awake: Vec<(NodeId, Vec3)> = awake.copied().collect();
            for &(node, _) in &awake {
                centre += body.positions()[node].xyz() * (1.0 / awake.len() as f32);
            }
            match grip.drive {
                Drive::Force(force) => {
                    let free = awake
                        .iter()
                        .filter(|&&(node, _)| body.inverse_masses()[node] > 0.0);
                    let free: Vec<NodeId> = free.map(|&(node, _)| node).collect();
                    // Nodes that sleep carry their share of the force, too.
                    let all = nodes.iter().map(|&(node, _)| node);
                    let all = all.filter(|&node| body.inverse_masses()[node] > 0.0);
                    let mass: f32 = all.map(|node| body.masses()[node]).sum();
                    for node in free {
                        let share = force * (body.masses()[node] / mass);
                        sum.add(share, body.positions()[node].xyz());
                        let pace = body.pace_share(body.pieces().of_node(node));
                        let (impulse, inverse_mass) =
                            (share * (duration * pace), body.inverse_masses()[node]);
                        body.velocities_mut()[node] += Row::from(impulse * inverse_mass);
                        body.push_responses(&[(node, 1.0)], impulse);
                    }
                    body.apply_responses();
                }
                Drive::Still | Drive::Carried(_) => {
                    let least = WAKE_DISTANCE * body.grid().voxel_size();
                    for (node, place) in nodes {
                        let at = body.positions()[node].xyz();
                        let goal = match pose {
                            Some((position, rotation)) => position + rotation.apply(place),
                            None => place,
                        };
                        if body.pieces().sleeps(node) {
                            if (goal - at).length() > least {
                                woken.push((grip.body.slot(), body.pieces().of_node(node)));
                            }
                            continue;
                        }
                        let velocity = (goal - at) * (1.0 / duration);
                        let change = velocity - body.velocities()[node].xyz();
                        let inertia = change * (body.masses()[node] / duration);
                        sum.add(inertia - load_on(body, node, gravity), at);
                        body.velocities_mut()[node] = Row::from(velocity);
                    }
                }
            }
            // While the piece sleeps, the last reaction is kept.
            if !awake.is_empty() {
                let settles = |&(node, _): &(NodeId, Vec3)| {
                    let piece = body.pieces().of_node(node);
                    body.pieces().list[piece].sleep_timer > 0.0
                };
                grip.settled = match awake.iter().all(settles) {
                    true => grip.settled.saturating_add(1),
                    false => 1,
                };
                let now: ReactionForce<D> = sum.about(D::Vector::from_vec3(centre));
                let reaction = grip.reaction().mean_with(now, grip.settled);
                let (force, torque) = (reaction.force.to_vec3(), reaction.torque.to_vec3());
                let is_finite = force.is_finite() && torque.is_finite() && centre.is_finite();
                // A body that became non-finite is quarantined; its grip has no reaction then.
                (grip.force, grip.torque, grip.point, grip.settled) = match is_finite {
                    true => (force, torque, centre, grip.settled),
                    false => (Vec3::ZERO, Vec3::ZERO, Vec3::ZERO, 0),
                };
            }
        }
        woken.sort_unstable();
        woken.dedup();
        woken
    }
}

fn checked_force<D: Dim>(force: D::Vector) -> Result<Vec3, Error> {
    let is_valid = is_within_reach(force.to_vec3() * 1e-3);
    require(is_valid, "force", "at most 1e9 N on each axis", force)?;
    Ok(force.to_vec3())
}
