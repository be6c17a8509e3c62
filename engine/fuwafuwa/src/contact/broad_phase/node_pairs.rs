//! Nodes that may touch rigid shapes. Inner nodes are tested too, so that no rigid body passes through a
//! flattened element.

use super::bins::Bins;
use super::known_impulse::Impulse;
use super::slack::{SlackTest, smaller};
use super::sphere_pair::MARGIN;
use crate::foundation::arena::{BodySlot, RigidSlot};
use crate::foundation::dim::Dim;
use crate::foundation::hash::{Hash, HashState, hash_all, hash_state};
use crate::foundation::ids::{IndexVec, NodeId, PieceId};
use crate::foundation::threads::{self, CHUNK_SIZE, RowChunk};
use crate::rigid_body::solid::Solid;
use crate::rigid_body::{RigidBodies, RigidState};
use crate::soft_body::element_forces::Row;
use crate::soft_body::{SoftBodies, SoftBody};
use std::ops::Range;

/// Distance by which a node may exceed the motion predicted from its velocity before its pairs are searched
/// again [voxels]. A larger value makes the list of pairs longer; a smaller one makes searches more frequent.
const SLACK: f32 = 0.4;
/// Distance by which a moving rigid body may exceed the motion predicted from its velocity before all pairs
/// are searched again [voxels]. It is larger than [`SLACK`], because the coupling force accelerates hands
/// strongly.
const RIGID_SLACK: f32 = 1.0;

/// Factor by which the distance between a node and its point of the smooth surface may grow until the next search.
const STRETCHED: f32 = 1.25;

/// Width of a bin of nodes [voxels]. A rigid shape is first tested against whole bins, and only in nearby
/// bins against each node.
const BIN_WIDTH: f32 = 4.0;

/// Pair of a node and a rigid body that may touch.
#[derive(Copy, Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct NodePair {
    /// Slot of the rigid body.
    pub rigid: RigidSlot,
    /// Slot of the soft body.
    pub body: BodySlot,
    /// Node of the soft body.
    pub node: NodeId,
    /// Impulses of the contact.
    pub impulse: Impulse,
    /// Limit for [`NodePairs::travel`] [m]: up to this value, the node cannot touch the rigid body while the
    /// rigid body rests.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub clear: f32,
}

hash_state! { struct NodePair { rigid, body, node, impulse } skip { clear } }

/// Pairs of nodes and rigid shapes that may touch in this tick.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct NodePairs {
    /// Pairs, ascending by rigid body, soft body and node; sleeping nodes included. Only pairs with an
    /// impulse are part of the hashed state: which pairs without an impulse are listed depends on the time of
    /// the last search.
    #[cfg_attr(feature = "serde", serde(serialize_with = "serialize_known"))]
    pub list: Vec<NodePair>,
    /// Upper bound of the distance that any node has moved since the last full search [m].
    #[cfg_attr(feature = "serde", serde(skip))]
    pub travel: f32,
    /// For each body and node, the position at which the pairs of the node were last searched [m]. The fourth
    /// component is the distance that the node may move from there [m].
    #[cfg_attr(feature = "serde", serde(skip))]
    anchors: IndexVec<BodySlot, IndexVec<NodeId, Row>>,
    /// Distance that every node can still move without exceeding its allowed distance in `anchors` [m].
    #[cfg_attr(feature = "serde", serde(skip))]
    spare: f32,
    /// Allowed and actual movement of each rigid body since the last full search [m]; empty if a full search
    /// is due.
    #[cfg_attr(feature = "serde", serde(skip))]
    leeways: Vec<Leeway>,
    /// Nodes removed, added or woken since the last update.
    #[cfg_attr(feature = "serde", serde(skip))]
    changed: Vec<(BodySlot, NodeId)>,
}

impl HashState for NodePairs {
    fn hash_state(&self, hash: &mut Hash) {
        let Self {
            list,
            travel: _,
            anchors: _,
            spare: _,
            leeways: _,
            changed: _,
        } = self;
        hash_all(list.iter().filter(|pair| pair.impulse.is_known()), hash);
    }
}

#[cfg(feature = "serde")]
fn serialize_known<S: serde::Serializer>(list: &[NodePair], to: S) -> Result<S::Ok, S::Error> {
    let known = list.iter().filter(|pair| pair.impulse.is_known());
    serde::Serialize::serialize(&known.collect::<Vec<_>>(), to)
}

/// Allowed and actual movement of a rigid body since the last full search.
#[derive(Copy, Clone, Debug)]
struct Leeway {
    /// Distance that the rigid body may move before a full search is due [m].
    allowed: f32,
    /// Upper bound of the distance that the rigid body has moved since the last full search [m].
    moved: f32,
}

impl NodePairs {
    /// Starts a tick: clears the impulse sums of the last tick and requests a full search.
    pub fn start_tick(&mut self) {
        for pair in &mut self.list {
            pair.impulse.start_tick();
        }
        self.leeways.clear();
        self.changed.clear();
    }

    /// Requests a full search, because a rigid body changed.
    pub fn request_full_search(&mut self) {
        self.leeways.clear();
    }

    /// Discards pairs without an existing rigid body, soft body or node. Sorts the remaining pairs and
    /// removes duplicates.
    #[cfg(feature = "serde")]
    pub fn keep_known<D: Dim>(&mut self, bodies: &SoftBodies<D>, rigids: &RigidBodies) {
        let is_known =
            |pair: &NodePair| rigids.find(pair.rigid).is_some() && pair.piece(bodies).is_some();
        self.list.retain(is_known);
        self.list.sort_by_key(NodePair::key);
        self.list.dedup_by_key(|pair| pair.key());
    }

    /// Marks nodes that a tear of a body removed or added, so that their pairs are searched again.
    pub fn tear(&mut self, body: BodySlot, nodes: &[NodeId]) {
        self.changed.extend(nodes.iter().map(|&node| (body, node)));
    }

    /// Marks the nodes of woken pieces, so that their pairs are searched again: only awake nodes are paired
    /// with fixed bodies. `pieces` holds body slots and piece numbers in ascending order.
    pub fn wake<D: Dim>(&mut self, pieces: &[(BodySlot, PieceId)], bodies: &SoftBodies<D>) {
        for (slot, body) in bodies.by_slot() {
            if pieces.iter().all(|&(body, _)| body != slot) {
                continue;
            }
            let woke = |node| {
                let piece = body.pieces().of_node(node);
                pieces.binary_search(&(slot, piece)).is_ok()
            };
            let woken = body.awake_nodes().iter().filter(|&&node| woke(node));
            self.changed.extend(woken.map(|&node| (slot, node)));
        }
    }

    /// Subtracts the motion of a substep from the search margins. No node moved farther than `distance` [m]
    /// in the substep.
    pub fn pass(&mut self, distance: f32) {
        self.travel += distance;
        self.spare -= distance;
    }

    /// Updates the list of pairs. A substep takes `duration` [s], and `left` [s] of the tick remain.
    pub fn follow<D: Dim>(
        &mut self,
        bodies: &SoftBodies<D>,
        rigids: &RigidBodies,
        duration: f32,
        left: f32,
    ) {
        if rigids.is_empty() {
            self.list.clear();
            return;
        }
        for (leeway, rigid) in self.leeways.iter_mut().zip(rigids.iter()) {
            leeway.moved += rigid.top_speed() * duration;
        }
        let outrun = self
            .leeways
            .iter()
            .any(|leeway| leeway.moved > leeway.allowed);
        if outrun || self.leeways.is_empty() {
            self.find_all(bodies, rigids, left);
            return;
        }
        if self.spare <= 0.0 {
            self.find_beyond_slack(bodies);
        }
        if self.changed.is_empty() {
            return;
        }
        let mut changed = std::mem::take(&mut self.changed);
        changed.sort_unstable();
        changed.dedup();
        let mut found = Vec::new();
        for &(slot, node) in &changed {
            self.anchor(slot, node, bodies, left);
        }
        for ((own, rigid), leeway) in rigids.by_slot().zip(&self.leeways) {
            let is_near = |&&(slot, node): &&(BodySlot, NodeId)| {
                let body = bodies.at(slot);
                let reach = reach(self.anchors[slot][node], body, node);
                let at = body.positions()[node].xyz();
                rigid.meets(body.layers())
                    && body.mesh().is_alive(node)
                    && rigid.shape().distance(at).0 <= reach + leeway.allowed
            };
            let near = changed.iter().filter(is_near);
            found.extend(near.map(|&(body, node)| (own, body, node)));
        }
        self.merge(&found, |pair| {
            let is_changed = changed.binary_search(&(pair.body, pair.node)).is_ok();
            !is_changed || pair.has_touched(bodies)
        });
    }

    /// Searches all pairs of a node and a rigid body that may touch in the remaining time `left` of the tick
    /// [s]. Sleeping nodes are paired only with moving rigid bodies.
    fn find_all<D: Dim>(&mut self, bodies: &SoftBodies<D>, rigids: &RigidBodies, left: f32) {
        self.changed.clear();
        self.travel = 0.0;
        let sizes = bodies.iter().map(|body| body.grid().voxel_size());
        let size = sizes.fold(0.0, f32::max);
        let leeway = |rigid: &RigidState| {
            let slack = if rigid.moves() {
                RIGID_SLACK * size
            } else {
                0.0
            };
            let allowed = slack + rigid.top_speed() * left;
            Leeway {
                allowed,
                moved: 0.0,
            }
        };
        self.leeways.clear();
        self.leeways.extend(rigids.iter().map(leeway));
        self.anchors
            .resize(bodies.slot_count(), IndexVec::default());
        let anchors = self.anchors.entries_mut().zip(bodies.slots());
        let anchors = anchors.filter_map(|((slot, anchors), body)| Some((slot, body?, anchors)));
        let node_bins = threads::map_items(
            anchors,
            |(_, body, _)| body.awake_nodes().len(),
            |(slot, body, anchors)| {
                let spare = anchor_all(body, anchors, left);
                let reach = |node| reach(anchors[node], body, node);
                (slot, body, NodeBins::of(body, reach), spare)
            },
        );
        let spares = node_bins.iter().map(|(.., spare)| *spare);
        self.spare = spares.fold(f32::INFINITY, smaller);
        let mut found = Vec::new();
        let mut near: Vec<NodeId> = Vec::new();
        for ((own, rigid), leeway) in rigids.by_slot().zip(&self.leeways) {
            let met = node_bins.iter();
            let met = met.filter(|(_, body, ..)| rigid.meets(body.layers()));
            for (slot, body, node_bins, _) in met {
                near.clear();
                node_bins.within(leeway.allowed, rigid.shape(), &mut near);
                if rigid.moves() && body.awake_nodes().len() < body.mesh().node_count() {
                    let is_near = |&node: &NodeId| {
                        let reach = leeway.allowed + margin(body, node);
                        let at = body.positions()[node].xyz();
                        body.pieces().sleeps(node) && rigid.shape().distance(at).0 <= reach
                    };
                    near.extend(body.mesh().nodes().map(|(node, _)| node).filter(is_near));
                }
                // Sorts the nodes, because they were found bin by bin and `merge` requires ascending pairs.
                near.sort_unstable();
                found.extend(near.iter().map(|&node| (own, *slot, node)));
            }
        }
        self.merge(&found, |pair| pair.has_touched(bodies));
    }

    /// Adds to `changed` the nodes that have exceeded their allowed distance in `anchors`, and updates
    /// `spare` for the other nodes.
    fn find_beyond_slack<D: Dim>(&mut self, bodies: &SoftBodies<D>) {
        let anchors = &self.anchors;
        let shares = bodies.by_slot().flat_map(|(slot, body)| {
            let anchors = anchors.get(slot.index());
            let nodes = body.awake_nodes().chunks(CHUNK_SIZE);
            nodes.filter_map(move |nodes| Some((slot, body, anchors?, nodes)))
        });
        let rows = |(.., nodes): &(_, _, _, &[NodeId])| nodes.len();
        let tests = threads::map_items(shares, rows, |(slot, body, anchors, nodes)| {
            let test = SlackTest::of_points(nodes, |node: NodeId| {
                let [x, y, z, allowed] = anchors.get(node.index())?.to_array();
                let anchor = Row::from_array([x, y, z, 0.0]);
                Some((body.positions()[node] - anchor, allowed))
            });
            (slot, test)
        });
        self.spare = f32::INFINITY;
        for (slot, test) in tests {
            let exceeded = test.exceeded.into_iter();
            self.changed.extend(exceeded.map(|node| (slot, node)));
            self.spare = smaller(self.spare, test.spare);
        }
    }

    /// Sets the anchor of a node of a body, for the remaining time `left` of the tick [s].
    fn anchor<D: Dim>(&mut self, slot: BodySlot, node: NodeId, bodies: &SoftBodies<D>, left: f32) {
        let body = bodies.at(slot);
        let anchors = &mut self.anchors[slot];
        anchors.resize(body.positions().len(), Row::ZERO);
        anchors[node] = anchor(body, node, left);
        self.spare = smaller(self.spare, anchors[node][3]);
    }

    /// Replaces the list by the `found` pairs and those old pairs for which `stays` is true. Pairs that were
    /// listed before keep their impulses.
    fn merge(&mut self, found: &[Key], stays: impl Fn(&NodePair) -> bool) {
        let old = std::mem::take(&mut self.list);
        let mut old = old.into_iter().peekable();
        for &key in found {
            while let Some(pair) = old.next_if(|pair| pair.key() < key) {
                if stays(&pair) {
                    self.list.push(pair);
                }
            }
            let known = old.next_if(|pair| pair.key() == key);
            let (rigid, body, node) = key;
            self.list.push(NodePair {
                rigid,
                body,
                node,
                impulse: known.map_or(Impulse::default(), |pair| pair.impulse),
                clear: 0.0,
            });
        }
        self.list.extend(old.filter(stays));
    }
}

/// Sets the anchors of all awake nodes of a body, for the remaining time `left` of the tick [s]. Returns the least
/// distance that one of them may move [m].
fn anchor_all<D: Dim>(body: &SoftBody<D>, anchors: &mut IndexVec<NodeId, Row>, left: f32) -> f32 {
    anchors.resize(body.positions().len(), Row::ZERO);
    let rows = threads::rows(body.awake_nodes(), [anchors.as_mut_slice()]);
    let allowed = threads::map(rows, |RowChunk { ids, first, lists }| {
        let [anchors] = lists;
        let mut least = f32::INFINITY;
        for &node in ids {
            let anchor = anchor(body, node, left);
            anchors[node.index() - first] = anchor;
            least = smaller(least, anchor[3]);
        }
        least
    });
    allowed.into_iter().fold(f32::INFINITY, smaller)
}

/// Returns the position of a node [m], and as the fourth component the distance that the node may move in the
/// remaining time `left` of the tick [s].
fn anchor<D: Dim>(body: &SoftBody<D>, node: NodeId, left: f32) -> Row {
    let [x, y, z, _] = body.positions()[node].to_array();
    let speed = body.velocities()[node].length();
    let allowed = SLACK * body.grid().voxel_size() + speed * left;
    Row::from_array([x, y, z, allowed])
}

/// Returns the distance from a resting rigid shape within which a node is paired with that shape [m].
fn reach<D: Dim>(anchor: Row, body: &SoftBody<D>, node: NodeId) -> f32 {
    anchor[3] + margin(body, node)
}

/// Returns the distance from a rigid shape within which a node can touch the shape [m]: the node's point of the
/// smooth surface may be closer than the node.
fn margin<D: Dim>(body: &SoftBody<D>, node: NodeId) -> f32 {
    let point = body.skin_point(node);
    if point.is_node() {
        return MARGIN * body.grid().voxel_size();
    }
    let now = (body.skin_position(node) - body.positions()[node].xyz()).length();
    let offset = now.max(point.reach() * body.grid().voxel_size());
    MARGIN * body.grid().voxel_size() + STRETCHED * offset
}

/// Sort key of a pair: rigid body, soft body and node.
type Key = (RigidSlot, BodySlot, NodeId);

impl NodePair {
    fn key(&self) -> Key {
        (self.rigid, self.body, self.node)
    }

    /// Returns whether the node touched the rigid body in this tick. The events of the tick report such a
    /// pair, so it stays listed even if it is far apart now.
    fn has_touched<D: Dim>(&self, bodies: &SoftBodies<D>) -> bool {
        self.impulse.total > 0.0 && bodies.at(self.body).mesh().is_alive(self.node)
    }

    /// Returns the piece of the node; `None` if the body or the node does not exist.
    pub fn piece<D: Dim>(&self, bodies: &SoftBodies<D>) -> Option<PieceId> {
        let body = bodies.find(self.body)?;
        let is_known = self.node.index() < body.mesh().node_capacity();
        is_known.then(|| body.pieces().of_node(self.node))
    }
}

/// Awake nodes of a body, grouped in bins. A rigid shape is first tested against each bin as a whole: most
/// bins are too far away, even in a body torn into many pieces.
struct NodeBins {
    /// Awake nodes, indexed by the point numbers of `bins`. The second entry is the distance from a resting
    /// shape within which the node is paired with the shape [m].
    nodes: Vec<(NodeId, f32)>,
    bins: Bins,
    list: Vec<NodeBin>,
}

/// Nodes of one bin: their index range in the bin order, a ball around them, and the largest distance at
/// which one of them is paired with a resting shape [m].
struct NodeBin {
    points: Range<usize>,
    centre: Row,
    radius: f32,
    reach: f32,
}

impl NodeBins {
    fn of<D: Dim>(body: &SoftBody<D>, reach: impl Fn(NodeId) -> f32) -> Self {
        let nodes = body.awake_nodes().iter().map(|&node| (node, reach(node)));
        let nodes: Vec<(NodeId, f32)> = nodes.collect();
        let points = nodes.iter().map(|&(node, _)| body.positions()[node]);
        let points: Vec<Row> = points.collect();
        let bins = Bins::new::<D>(&points, BIN_WIDTH * body.grid().voxel_size());
        let node_bins = { bins.filled() }.map(|range| NodeBin::around(&bins, range, &nodes));
        Self {
            list: node_bins.collect(),
            nodes,
            bins,
        }
    }

    /// Adds to `near` the nodes that are within `range` [m] of a shape, plus the distance stored for each of
    /// them in `nodes`.
    fn within(&self, range: f32, shape: &Solid, near: &mut Vec<NodeId>) {
        let is_near = |at: Row, reach: f32| shape.distance(at.xyz()).0 <= reach;
        for bin in &self.list {
            if !is_near(bin.centre, bin.radius + bin.reach + range) {
                continue;
            }
            for place in bin.points.clone() {
                let (node, reach) = self.nodes[self.bins.numbers()[place] as usize];
                if is_near(self.bins.point(place), reach + range) {
                    near.push(node);
                }
            }
        }
    }
}

impl NodeBin {
    fn around(bins: &Bins, points: Range<usize>, nodes: &[(NodeId, f32)]) -> Self {
        let (mut low, mut high) = ([f32::MAX; 4], [f32::MIN; 4]);
        let mut furthest = 0.0f32;
        for place in points.clone() {
            let at = bins.point(place);
            for axis in 0..4 {
                low[axis] = low[axis].min(at[axis]);
                high[axis] = high[axis].max(at[axis]);
            }
            furthest = furthest.max(nodes[bins.numbers()[place] as usize].1);
        }
        let (low, high) = (Row::from_array(low), Row::from_array(high));
        let centre = (low + high) * 0.5;
        Self {
            points,
            centre,
            radius: (high - centre).length(),
            reach: furthest,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::foundation::dim::DimVector;
    use crate::foundation::dim::{Dim2, Dim3};
    use crate::material::Material;
    use crate::rigid_body::RigidBody;
    use crate::rigid_body::shape::Shape;
    use crate::topology::grid::VoxelGrid;
    use glam::Vec3;
    use std::collections::BTreeSet;

    /// Tears a body, moves its nodes at random between two walls, and checks the list of pairs against a test
    /// of all nodes.
    fn check<D: Dim>(n: usize) {
        let grid = VoxelGrid::<D>::ball(n, 1.0).expect("the ball has voxels");
        let body =
            SoftBody::new(grid, &[Material::default()]).expect("the default material is valid");
        let size = body.grid().voxel_size();
        let mut bodies = SoftBodies::default();
        let ball = bodies.insert(body).slot();
        let wall = |normal: Vec3, offset| {
            let wall = Shape::half_space(
                D::Vector::from_vec3(normal),
                D::Vector::from_vec3(normal * offset),
            );
            RigidState::from(&RigidBody::<D>::fixed(wall))
        };
        let mut walls = RigidBodies::default();
        walls.insert(wall(Vec3::Y, 0.3));
        walls.insert(wall(Vec3::NEG_X, -0.8));
        let mut seed = 5u32;
        let mut random = |below: usize| {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (seed >> 8) as usize % below
        };
        let mut pairs = NodePairs::default();
        bodies.at_mut(ball).refresh_awake();
        let (mut gone, mut new) = (0, 0);
        for _ in 0..60 {
            pairs.follow(&bodies, &walls, 0.001, 0.016);
            let body = bodies.at_mut(ball);
            let listed: BTreeSet<Key> = pairs.list.iter().map(NodePair::key).collect();
            assert_eq!(listed.len(), pairs.list.len());
            assert!(pairs.list.is_sorted_by_key(NodePair::key));
            assert!(listed.iter().all(|&(.., node)| body.mesh().is_alive(node)));
            for (node, _) in body.mesh().nodes() {
                let at = body.positions()[node].xyz();
                for (own, wall) in walls.by_slot() {
                    let is_close = wall.shape().distance(at).0 <= MARGIN * size;
                    assert!(!is_close || listed.contains(&(own, ball, node)));
                }
            }
            let sides = (0..4).map(|_| {
                let mut at = [0; 3];
                (0..D::N).for_each(|axis| at[axis] = random(n + 1) as i32);
                (at, 1 + random((1 << D::CORNERS) - 2) as u8)
            });
            let before = body.mesh().node_count();
            let changes = body.tear(&sides.collect::<Vec<_>>());
            let alive = |&&node: &&NodeId| body.mesh().is_alive(node);
            new += changes.nodes.iter().filter(alive).count();
            gone += changes.nodes.len() - changes.nodes.iter().filter(alive).count();
            assert!(body.mesh().node_count() == before || !changes.nodes.is_empty());
            body.refresh_awake();
            pairs.tear(ball, &changes.nodes);
            let step = 0.1 * size;
            for node in body.awake_nodes().to_vec() {
                for along in &mut body.positions_mut()[node][..D::N] {
                    *along += step * (random(3) as f32 - 1.0);
                }
            }
            pairs.pass(1.001 * step * (D::N as f32).sqrt());
        }
        assert!(
            new > 50 && (gone > 0 || D::N == 2),
            "{new} new, {gone} gone"
        );
    }

    #[test]
    fn list_contains_all_nodes_near_walls_while_they_move_and_tear() {
        check::<Dim2>(16);
        check::<Dim3>(10);
    }
}
