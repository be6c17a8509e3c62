//! Finding what may touch: lists of close pairs that stay good for a while.
//!
//! Against rigid shapes every node counts, so that an element squashed flat lets none through.
//! Against each other, bodies touch with their *skin*: every surface element is of level 0, so a
//! ball of one voxel's width around the middle of each is enough. Lists are made with some slack
//! and hold until something may have moved by that much [Verlet 1967].

mod bins;
mod captives;
mod skin;
mod skins;

use crate::body::Body;
use crate::dim::Dim;
use crate::release::Torn;
use crate::shape::Shape;
use crate::solve::Row;
use crate::vector::{dot, length, minus, plus, scaled, three};
use bins::Bins;
pub use captives::Captive;
pub use skin::{Skin, mean};
pub use skins::{MARGIN, Skins};
use std::ops::Range;

/// Something rigid that nodes can touch.
#[derive(Copy, Clone, Debug)]
pub struct Collider {
    /// Where it is now.
    pub shape: Shape,
    /// [m/s]
    pub velocity: Row,
    /// One over its mass [1/kg]; 0 when nothing can push it.
    pub inverse_mass: f32,
    /// Coulomb friction with nodes.
    pub friction: f32,
    /// Whether it wakes what it touches.
    pub is_hand: bool,
}

/// The impulses of a contact [N s]: from one substep to the next, and over a tick.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Impulse {
    /// Along the normal.
    pub pressed: f32,
    /// Across it.
    pub dragged: Row,
    /// Along the normal, since the start of the tick.
    pub total: f32,
}

/// A node that may touch a rigid shape.
#[derive(Copy, Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct NodePair {
    /// Place among the colliders.
    pub collider: u32,
    /// Place among the bodies.
    pub body: u32,
    /// Node id.
    pub node: u32,
    /// What passed between them.
    pub impulse: Impulse,
    /// How far anything must have come, since the list was made, before the node may be where it
    /// touches a shape that stands still [m].
    #[cfg_attr(feature = "serde", serde(skip))]
    pub clear: f32,
}

/// What may touch what.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Nearby {
    /// Nodes close to rigid shapes, asleep or not, by collider, body and node.
    pub node_pairs: Vec<NodePair>,
    /// The skins, and those of them that are close to each other.
    pub skins: Skins,
    /// How far nodes and hands may move before the list of nodes must be made anew [m], and how
    /// far the fastest have come since it was made.
    slack: f32,
    pub travel: f32,
    nodes_are_good: bool,
    /// Nodes that are gone or new since: body and node.
    #[cfg_attr(feature = "serde", serde(skip))]
    torn: Vec<(u32, u32)>,
}

/// Slack of the list of nodes, in voxels, and in seconds at the speed of what is fastest: larger
/// means longer lists, smaller more lists.
const SLACK: f32 = 0.5;
const SLACK_TIME: f32 = 1.0 / 120.0;

/// Nodes in a square of so many voxels are tested against a rigid shape together, before each is on
/// its own.
const SQUARE: f32 = 4.0;

impl Nearby {
    /// A body was torn.
    pub fn tear(&mut self, body: u32, torn: &Torn) {
        self.skins.tear(body, &torn.elements);
        self.torn
            .extend(torn.nodes.iter().map(|&node| (body, node)));
    }

    /// The lists are out of date: the meshes have changed, nobody knows where.
    pub fn expire(&mut self) {
        self.nodes_are_good = false;
        self.skins.expire();
    }

    /// The bodies are in somebody else's hands.
    pub fn doubt(&mut self) {
        self.nodes_are_good = false;
        self.skins.doubt();
    }

    /// Who is asleep has changed.
    pub fn expire_rest(&mut self) {
        self.skins.expire_rest();
    }

    /// Forgets which node touched which collider: the colliders have other places now.
    pub fn forget_node_pairs(&mut self) {
        self.node_pairs.clear();
        self.expire();
    }

    /// A new tick: what passed in the last one is settled.
    pub fn start_tick(&mut self) {
        let nodes = self.node_pairs.iter_mut().map(|pair| &mut pair.impulse);
        let skins = self.skins.pairs.iter_mut().map(|pair| &mut pair.impulse);
        nodes.chain(skins).for_each(|impulse| impulse.total = 0.0);
        self.skins.start_tick();
    }

    /// The bodies have moved, no node of them further than by `distance` [m].
    pub fn pass(&mut self, distance: f32) {
        self.travel += distance;
        self.skins.pass(distance);
    }

    /// Follows the bodies, and brings the lists up to date where something may have moved further
    /// than they bear; a substep takes `duration` [s].
    pub fn refresh<D: Dim>(&mut self, bodies: &[Body<D>], colliders: &[Collider], duration: f32) {
        let sizes = bodies.iter().map(|body| body.grid.voxel_size());
        let size = sizes.fold(0.0, f32::max);
        let hands = colliders.iter().map(|collider| length(collider.velocity));
        let hand_speed = hands.fold(0.0, f32::max);
        self.skins.follow(bodies, size);
        self.travel += hand_speed * duration;
        // What gets faster may be looked for further out: half of the slack is kept for it.
        self.nodes_are_good &= self.travel < 0.5 * self.slack;
        let mut torn = std::mem::take(&mut self.torn);
        if !self.nodes_are_good {
            let speed = fastest(bodies).max(hand_speed);
            self.slack = SLACK * size + speed * SLACK_TIME;
            let found = near_nodes(bodies, colliders, self.slack + MARGIN * size);
            self.merge(&found, |_| false);
            self.travel = 0.0;
            self.nodes_are_good = true;
        } else if !torn.is_empty() {
            torn.sort_unstable();
            torn.dedup();
            let found = near_torn(&torn, bodies, colliders, self.slack + MARGIN * size);
            self.merge(&found, |pair| {
                torn.binary_search(&(pair.body, pair.node)).is_err()
            });
        }
    }

    /// Makes the new list of those just found and those of the old ones that stay. Pairs that were
    /// known keep their impulses.
    fn merge(&mut self, found: &[Key], stays: impl Fn(&NodePair) -> bool) {
        let old = std::mem::take(&mut self.node_pairs);
        let mut old = old.into_iter().peekable();
        for &key in found {
            while let Some(pair) = old.next_if(|pair| pair.key() < key) {
                if stays(&pair) {
                    self.node_pairs.push(pair);
                }
            }
            let known = old.next_if(|pair| pair.key() == key);
            let (collider, body, node) = key;
            self.node_pairs.push(NodePair {
                collider,
                body,
                node,
                impulse: known.map_or(Impulse::default(), |pair| pair.impulse),
                clear: 0.0,
            });
        }
        self.node_pairs.extend(old.filter(stays));
    }
}

/// What a pair is known by, and sorted by: collider, body and node.
type Key = (u32, u32, u32);

impl NodePair {
    fn key(&self) -> Key {
        (self.collider, self.body, self.node)
    }
}

/// The nodes that are no further from a collider than `reach` [m].
fn near_nodes<D: Dim>(bodies: &[Body<D>], colliders: &[Collider], reach: f32) -> Vec<Key> {
    let places: Vec<Places> = bodies.iter().map(Places::of).collect();
    let mut found = Vec::new();
    let mut near: Vec<u32> = Vec::new();
    for (collider, index) in colliders.iter().zip(0..) {
        for (places, body) in places.iter().zip(0..) {
            near.clear();
            places.within(reach, &collider.shape, &mut near);
            // What is near comes square by square.
            near.sort_unstable();
            found.extend(near.iter().map(|&node| (index, body, node)));
        }
    }
    found
}

/// As [`near_nodes`], of those that were `torn` and are not gone.
fn near_torn<D: Dim>(
    torn: &[(u32, u32)],
    bodies: &[Body<D>],
    colliders: &[Collider],
    reach: f32,
) -> Vec<Key> {
    let mut found = Vec::new();
    for (collider, index) in colliders.iter().zip(0..) {
        let is_near = |&&(body, node): &&(u32, u32)| {
            let body = &bodies[body as usize];
            let at = three(body.position[node as usize]);
            body.mesh.is_alive(node) && collider.shape.distance(at).0 <= reach
        };
        let near = torn.iter().filter(is_near);
        found.extend(near.map(|&(body, node)| (index, body, node)));
    }
    found
}

/// The greatest speed of anything awake [m/s].
fn fastest<D: Dim>(bodies: &[Body<D>]) -> f32 {
    let mut fastest = 0.0f32;
    for body in bodies {
        for &node in &body.awake {
            let velocity = body.velocity[node as usize];
            fastest = fastest.max(dot(velocity, velocity));
        }
    }
    fastest.sqrt()
}

/// The nodes of a body, those in a square of space together: most squares are out of reach as a
/// whole, however the body is torn.
struct Places {
    nodes: Vec<u32>,
    bins: Bins,
    /// The places of `nodes` in each square that has any, and a ball around them.
    squares: Vec<Square>,
}

struct Square {
    points: Range<usize>,
    centre: Row,
    radius: f32,
}

impl Places {
    fn of<D: Dim>(body: &Body<D>) -> Self {
        let nodes: Vec<u32> = body.mesh.nodes().map(|(node, _)| node).collect();
        let points = nodes.iter().map(|&node| body.position[node as usize]);
        let points: Vec<Row> = points.collect();
        let bins = Bins::new::<D>(&points, SQUARE * body.grid.voxel_size());
        let squares = bins.filled().map(|range| Square::around(&bins, range));
        Self {
            squares: squares.collect(),
            nodes,
            bins,
        }
    }

    /// Adds the nodes that are no further from a shape than `reach` [m].
    fn within(&self, reach: f32, shape: &Shape, near: &mut Vec<u32>) {
        let is_near = |at: Row, reach: f32| shape.distance(three(at)).0 <= reach;
        for square in &self.squares {
            if !is_near(square.centre, square.radius + reach) {
                continue;
            }
            let points = square.points.clone().map(|place| self.bins.point(place));
            let points = points.filter(|&(_, at)| is_near(at, reach));
            near.extend(points.map(|(number, _)| self.nodes[number as usize]));
        }
    }
}

impl Square {
    fn around(bins: &Bins, points: Range<usize>) -> Self {
        let (mut low, mut high) = ([f32::MAX; 4], [f32::MIN; 4]);
        for (_, at) in points.clone().map(|place| bins.point(place)) {
            for axis in 0..4 {
                low[axis] = low[axis].min(at[axis]);
                high[axis] = high[axis].max(at[axis]);
            }
        }
        let centre = scaled(plus(low, high), 0.5);
        Self {
            points,
            centre,
            radius: length(minus(high, centre)),
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

    /// A body is torn at random between two walls; the list against all nodes there are.
    fn check<D: Dim>(n: usize) {
        let grid = VoxelGrid::<D>::ball(n, 1.0).expect("a ball is not empty");
        let mut body = Body::new(grid, &[Material::default()]).expect("the material is good");
        let size = body.grid.voxel_size();
        let wall = |normal, offset| Collider {
            shape: Shape::HalfSpace { normal, offset },
            velocity: [0.0; 4],
            inverse_mass: 0.0,
            friction: 0.0,
            is_hand: false,
        };
        let walls = [wall([0.0, 1.0, 0.0], 0.3), wall([-1.0, 0.0, 0.0], -0.8)];
        let mut seed = 5u32;
        let mut random = |below: usize| {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (seed >> 8) as usize % below
        };
        let mut nearby = Nearby::default();
        let (mut gone, mut new) = (0, 0);
        for _ in 0..60 {
            nearby.refresh(std::slice::from_ref(&body), &walls, 0.001);
            let listed: BTreeSet<Key> = nearby.node_pairs.iter().map(NodePair::key).collect();
            assert_eq!(listed.len(), nearby.node_pairs.len());
            assert!(nearby.node_pairs.is_sorted_by_key(NodePair::key));
            assert!(listed.iter().all(|&(.., node)| body.mesh.is_alive(node)));
            for (node, _) in body.mesh.nodes() {
                let at = three(body.position[node as usize]);
                for (wall, index) in walls.iter().zip(0..) {
                    let is_close = wall.shape.distance(at).0 <= MARGIN * size;
                    assert!(!is_close || listed.contains(&(index, 0, node)));
                }
            }
            let sides = (0..4).map(|_| {
                let mut at = [0; 3];
                (0..D::N).for_each(|axis| at[axis] = random(n + 1) as i32);
                (at, 1 + random((1 << D::CORNERS) - 2) as u8)
            });
            let before = body.mesh.node_count();
            let torn = body.tear(&sides.collect::<Vec<_>>());
            let torn = torn.expect("a release leaves the mesh whole");
            let alive = |&&node: &&u32| body.mesh.is_alive(node);
            new += torn.nodes.iter().filter(alive).count();
            gone += torn.nodes.len() - torn.nodes.iter().filter(alive).count();
            assert!(body.mesh.node_count() == before || !torn.nodes.is_empty());
            nearby.tear(0, &torn);
        }
        assert!(
            new > 50 && (gone > 0 || D::N == 2),
            "{new} new, {gone} gone"
        );
    }

    #[test]
    fn nodes_near_a_wall_are_known_after_every_tear() {
        check::<Dim2>(16);
        check::<Dim3>(10);
    }
}
