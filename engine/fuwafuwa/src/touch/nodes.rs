//! Which nodes may touch rigid shapes. Every node counts, so that an element squashed flat lets none
//! through.

use super::bins::Bins;
use super::impulse::Impulse;
use super::pair::MARGIN;
use crate::body::{Bodies, Body};
use crate::dim::Dim;
use crate::handle::{BodySlot, RigidSlot};
use crate::ids::{NodeId, PieceId, Table};
use crate::rigid::{Rigid, Rigids};
use crate::shape::Shape;
use crate::solve::Row;
use crate::vector::{dot, length, minus, plus, scaled, three};
use std::ops::Range;

/// How far a node and how far a hand may come beyond what their speed says, in voxels, before they are
/// looked for again: larger means longer lists, smaller more looks. What pulls a hand is stronger. Neither is critical: with
/// a quarter and twice of the first, and half and twice of the second, `diced` and `tear-3d` take the same.
const SLACK: f32 = 0.4;
const HAND_SLACK: f32 = 1.0;

/// Nodes in a square of so many voxels are tested against a rigid shape together, before each is on
/// its own. From 2 to 8 `diced` and `tear-3d` take the same.
const SQUARE: f32 = 4.0;

/// A node that may touch a rigid shape.
#[derive(Copy, Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct NodePair {
    /// The slot of what is rigid.
    pub rigid: RigidSlot,
    /// The slot of the body.
    pub body: BodySlot,
    /// Node id.
    pub node: NodeId,
    /// What passed between them.
    pub impulse: Impulse,
    /// How far any node must have come, since all were looked for, before this one may be where it
    /// touches a shape that stands still [m].
    #[cfg_attr(feature = "serde", serde(skip))]
    pub clear: f32,
}

/// The nodes that may touch rigid shapes in this tick.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct NodePairs {
    /// By rigid thing, body and node, asleep or not.
    pub list: Vec<NodePair>,
    /// How far the fastest nodes have come since all were looked for [m].
    #[cfg_attr(feature = "serde", serde(skip))]
    pub travel: f32,
    /// Where each node was when it was last looked for, and as the fourth number how far it may come
    /// from there, by body and node [m].
    #[cfg_attr(feature = "serde", serde(skip))]
    anchors: Table<BodySlot, Table<NodeId, Row>>,
    /// How far nodes may still come before one may have come too far [m].
    #[cfg_attr(feature = "serde", serde(skip))]
    spare: f32,
    /// How far each rigid thing may come from where it was, and how far it has come [m]; nothing while all
    /// must be looked for.
    #[cfg_attr(feature = "serde", serde(skip))]
    leeways: Vec<Leeway>,
    /// Nodes that are gone, new or awake since: body and node.
    #[cfg_attr(feature = "serde", serde(skip))]
    changed: Vec<(BodySlot, NodeId)>,
}

/// How far something rigid may come, and how far it has come [m].
#[derive(Copy, Clone, Debug)]
struct Leeway {
    most: f32,
    come: f32,
}

impl NodePairs {
    /// What passed in the last tick is settled. All will be looked for.
    pub fn start_tick(&mut self) {
        for pair in &mut self.list {
            (pair.impulse.total, pair.impulse.speed) = (0.0, 0.0);
        }
        self.leeways.clear();
        self.changed.clear();
    }

    /// Something rigid moves that stood: all will be looked for.
    pub fn look_again(&mut self) {
        self.leeways.clear();
    }

    /// Forgets what is of no body, node or rigid thing that is there; leaves each pair once, in their order.
    #[cfg(feature = "serde")]
    pub fn keep_known<D: Dim>(&mut self, bodies: &Bodies<D>, rigids: &Rigids) {
        let is_known =
            |pair: &NodePair| rigids.find(pair.rigid).is_some() && pair.piece(bodies).is_some();
        self.list.retain(is_known);
        self.list.sort_by_key(NodePair::key);
        self.list.dedup_by_key(|pair| pair.key());
    }

    /// Nodes of a body are gone or new.
    pub fn tear(&mut self, body: BodySlot, nodes: &[NodeId]) {
        self.changed.extend(nodes.iter().map(|&node| (body, node)));
    }

    /// Pieces woke, given by body and number in ascending order: they meet walls again.
    pub fn wake<D: Dim>(&mut self, pieces: &[(BodySlot, PieceId)], bodies: &Bodies<D>) {
        for (slot, body) in bodies.by_slot() {
            if pieces.iter().all(|&(body, _)| body != slot) {
                continue;
            }
            let woke = |node| {
                let piece = body.truth.pieces.of_node(node);
                pieces.binary_search(&(slot, piece)).is_ok()
            };
            let woken = body.cache.awake.iter().filter(|&&node| woke(node));
            self.changed.extend(woken.map(|&node| (slot, node)));
        }
    }

    /// The bodies have moved, no node of them further than by `distance` [m].
    pub fn pass(&mut self, distance: f32) {
        self.travel += distance;
        self.spare -= distance;
    }

    /// Brings the list up to date; a substep takes `duration` [s], and `left` [s] of the tick are to
    /// come.
    pub fn follow<D: Dim>(
        &mut self,
        bodies: &Bodies<D>,
        rigids: &Rigids,
        duration: f32,
        left: f32,
    ) {
        if rigids.is_empty() {
            self.list.clear();
            return;
        }
        for (leeway, rigid) in self.leeways.iter_mut().zip(rigids.iter()) {
            leeway.come += rigid.top_speed() * duration;
        }
        let outrun = self.leeways.iter().any(|leeway| leeway.come > leeway.most);
        if outrun || self.leeways.is_empty() {
            self.find_all(bodies, rigids, left);
            return;
        }
        if self.spare <= 0.0 {
            self.find_strayed(bodies);
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
                let reach = self.reach(slot, node, body.truth.grid.voxel_size());
                let at = three(body.state.position[node]);
                rigid.meets(body.state.layers)
                    && body.truth.mesh.is_alive(node)
                    && rigid.shape().distance(at).0 <= reach + leeway.most
            };
            let near = changed.iter().filter(is_near);
            found.extend(near.map(|&(body, node)| (own, body, node)));
        }
        self.merge(&found, |pair| {
            let is_changed = changed.binary_search(&(pair.body, pair.node)).is_ok();
            !is_changed || pair.has_touched(bodies)
        });
    }

    /// Looks for all nodes that may come to something rigid in what is `left` of the tick [s]. Those that
    /// sleep meet hands only.
    fn find_all<D: Dim>(&mut self, bodies: &Bodies<D>, rigids: &Rigids, left: f32) {
        self.changed.clear();
        self.travel = 0.0;
        self.spare = f32::INFINITY;
        let sizes = bodies.iter().map(|body| body.truth.grid.voxel_size());
        let size = sizes.fold(0.0, f32::max);
        let leeway = |rigid: &Rigid| {
            let slack = if rigid.moves() {
                HAND_SLACK * size
            } else {
                0.0
            };
            let most = slack + rigid.top_speed() * left;
            Leeway { most, come: 0.0 }
        };
        self.leeways.clear();
        self.leeways.extend(rigids.iter().map(leeway));
        self.anchors.resize(bodies.slot_count(), Table::default());
        let mut squares = Vec::new();
        for (slot, body) in bodies.by_slot() {
            for &node in &body.cache.awake {
                self.anchor(slot, node, bodies, left);
            }
            let reach = |node| self.reach(slot, node, body.truth.grid.voxel_size());
            squares.push((slot, body, Squares::of(body, reach)));
        }
        let mut found = Vec::new();
        let mut near: Vec<NodeId> = Vec::new();
        for ((own, rigid), leeway) in rigids.by_slot().zip(&self.leeways) {
            let met = squares.iter();
            let met = met.filter(|(_, body, _)| rigid.meets(body.state.layers));
            for (slot, body, squares) in met {
                near.clear();
                squares.within(leeway.most, rigid.shape(), &mut near);
                if rigid.moves() && body.cache.awake.len() < body.truth.mesh.node_count() {
                    let reach = leeway.most + MARGIN * body.truth.grid.voxel_size();
                    let is_near = |&node: &NodeId| {
                        let at = three(body.state.position[node]);
                        body.truth.pieces.sleeps(node) && rigid.shape().distance(at).0 <= reach
                    };
                    near.extend(
                        body.truth
                            .mesh
                            .nodes()
                            .map(|(node, _)| node)
                            .filter(is_near),
                    );
                }
                // What is near comes square by square.
                near.sort_unstable();
                found.extend(near.iter().map(|&node| (own, *slot, node)));
            }
        }
        self.merge(&found, |pair| pair.has_touched(bodies));
    }

    /// Adds the nodes that came further than they might to the changed ones; notes what the others have
    /// to spare.
    fn find_strayed<D: Dim>(&mut self, bodies: &Bodies<D>) {
        let mut spare = f32::INFINITY;
        for (slot, body) in bodies.by_slot() {
            let Some(anchors) = self.anchors.get(slot.index()) else {
                continue;
            };
            for &node in &body.cache.awake {
                let Some(&[x, y, z, most]) = anchors.get(node.index()) else {
                    continue;
                };
                let come = minus(body.state.position[node], [x, y, z, 0.0]);
                let come = dot(come, come);
                if come > most * most {
                    self.changed.push((slot, node));
                } else {
                    let left = most - come.sqrt();
                    spare = if left < spare { left } else { spare };
                }
            }
        }
        self.spare = spare;
    }

    /// Notes where a node is, and how far it may come until the end of the tick.
    fn anchor<D: Dim>(&mut self, slot: BodySlot, node: NodeId, bodies: &Bodies<D>, left: f32) {
        let body = bodies.at(slot);
        let anchors = &mut self.anchors[slot];
        anchors.resize(body.state.position.len(), [0.0; 4]);
        let [x, y, z, _] = body.state.position[node];
        let speed = length(body.state.velocity[node]);
        let most = SLACK * body.truth.grid.voxel_size() + speed * left;
        anchors[node] = [x, y, z, most];
        self.spare = if most < self.spare { most } else { self.spare };
    }

    /// How close to a wall a node is listed [m]; `size` [m] is that of its voxels.
    fn reach(&self, body: BodySlot, node: NodeId, size: f32) -> f32 {
        self.anchors[body][node][3] + MARGIN * size
    }

    /// Makes the new list of those just found and those of the old ones that stay. Pairs that were
    /// known keep their impulses.
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

/// What a pair is known by, and sorted by: rigid thing, body and node.
type Key = (RigidSlot, BodySlot, NodeId);

impl NodePair {
    fn key(&self) -> Key {
        (self.rigid, self.body, self.node)
    }

    /// Whether they touched in this tick, which is to be told when they are far apart too.
    fn has_touched<D: Dim>(&self, bodies: &Bodies<D>) -> bool {
        self.impulse.total > 0.0 && bodies.at(self.body).truth.mesh.is_alive(self.node)
    }

    /// The number of the piece; nothing when another body stands here since.
    pub fn piece<D: Dim>(&self, bodies: &Bodies<D>) -> Option<PieceId> {
        let body = bodies.find(self.body)?;
        let is_known = self.node.index() < body.truth.mesh.node_capacity();
        is_known.then(|| body.truth.pieces.of_node(self.node))
    }
}

/// The nodes of a body that are awake, those in a square of space together: most squares are out of
/// reach as a whole, however the body is torn.
struct Squares {
    /// By their numbers in the bins; each with how close to a wall it is listed [m].
    nodes: Vec<(NodeId, f32)>,
    bins: Bins,
    list: Vec<Square>,
}

/// The places of nodes in the bins, a ball around them, and how close the first of them are listed [m].
struct Square {
    points: Range<usize>,
    centre: Row,
    radius: f32,
    reach: f32,
}

impl Squares {
    fn of<D: Dim>(body: &Body<D>, reach: impl Fn(NodeId) -> f32) -> Self {
        let nodes = body.cache.awake.iter().map(|&node| (node, reach(node)));
        let nodes: Vec<(NodeId, f32)> = nodes.collect();
        let points = nodes.iter().map(|&(node, _)| body.state.position[node]);
        let points: Vec<Row> = points.collect();
        let bins = Bins::new::<D>(&points, SQUARE * body.truth.grid.voxel_size());
        let squares = { bins.filled() }.map(|range| Square::around(&bins, range, &nodes));
        Self {
            list: squares.collect(),
            nodes,
            bins,
        }
    }

    /// Adds the nodes that are no further from a shape than their reach and `range` [m].
    fn within(&self, range: f32, shape: &Shape, near: &mut Vec<NodeId>) {
        let is_near = |at: Row, reach: f32| shape.distance(three(at)).0 <= reach;
        for square in &self.list {
            if !is_near(square.centre, square.radius + square.reach + range) {
                continue;
            }
            for place in square.points.clone() {
                let (node, reach) = self.nodes[self.bins.numbers()[place] as usize];
                if is_near(self.bins.point(place), reach + range) {
                    near.push(node);
                }
            }
        }
    }
}

impl Square {
    fn around(bins: &Bins, points: Range<usize>, nodes: &[(NodeId, f32)]) -> Self {
        let (mut low, mut high, mut furthest) = ([f32::MAX; 4], [f32::MIN; 4], 0.0f32);
        for place in points.clone() {
            let at = bins.point(place);
            for axis in 0..4 {
                low[axis] = low[axis].min(at[axis]);
                high[axis] = high[axis].max(at[axis]);
            }
            furthest = furthest.max(nodes[bins.numbers()[place] as usize].1);
        }
        let centre = scaled(plus(low, high), 0.5);
        Self {
            points,
            centre,
            radius: length(minus(high, centre)),
            reach: furthest,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dim::{Dim2, Dim3};
    use crate::grid::VoxelGrid;
    use crate::material::Material;
    use std::collections::BTreeSet;

    /// A body is torn, and its nodes move, at random between two walls; the list against all nodes there are.
    fn check<D: Dim>(n: usize) {
        let grid = VoxelGrid::<D>::ball(n, 1.0).expect("a ball is not empty");
        let body = Body::new(grid, &[Material::default()]).expect("the material is good");
        let size = body.truth.grid.voxel_size();
        let mut bodies = Bodies::default();
        let ball = bodies.insert(body).slot();
        let wall = |normal, offset| Rigid::fixed(Shape::HalfSpace { normal, offset }, 0.0);
        let mut walls = Rigids::default();
        walls.insert(wall([0.0, 1.0, 0.0], 0.3));
        walls.insert(wall([-1.0, 0.0, 0.0], -0.8));
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
            assert!(
                listed
                    .iter()
                    .all(|&(.., node)| body.truth.mesh.is_alive(node))
            );
            for (node, _) in body.truth.mesh.nodes() {
                let at = three(body.state.position[node]);
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
            let before = body.truth.mesh.node_count();
            let changes = body.tear(&sides.collect::<Vec<_>>());
            let changes = changes.expect("a release leaves the mesh whole");
            let alive = |&&node: &&NodeId| body.truth.mesh.is_alive(node);
            new += changes.nodes.iter().filter(alive).count();
            gone += changes.nodes.len() - changes.nodes.iter().filter(alive).count();
            assert!(body.truth.mesh.node_count() == before || !changes.nodes.is_empty());
            body.refresh_awake();
            pairs.tear(ball, &changes.nodes);
            let step = 0.1 * size;
            for &node in &body.cache.awake {
                for along in &mut body.state.position[node][..D::N] {
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
    fn nodes_near_a_wall_are_known_however_they_move_and_tear() {
        check::<Dim2>(16);
        check::<Dim3>(10);
    }
}
