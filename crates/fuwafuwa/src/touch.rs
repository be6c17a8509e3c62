//! Finding what may touch: lists of close pairs that stay good for a while.
//!
//! Against rigid shapes every node counts, so that an element squashed flat lets none through.
//! Against each other, bodies touch with their *skin*: every surface element is of level 0, so a
//! ball of one voxel's width around the middle of each is enough. Lists are made with some slack
//! and hold until something may have moved by that much [Verlet 1967].

mod bins;
mod captives;
mod skins;

use crate::body::Body;
use crate::dim::Dim;
use crate::shape::Shape;
use crate::solve::Row;
use crate::vector::{dot, length, minus, plus, scaled, three};
use bins::Bins;
pub use captives::Captive;
pub use skins::{MARGIN, Skin, Skins, mean};
use std::ops::Range;

/// Something rigid that nodes can touch.
#[derive(Copy, Clone, Debug)]
pub struct Collider {
    /// Where it is now.
    pub shape: Shape,
    /// [m/s]
    pub velocity: Row,
    /// One over its mass [1/kg]; 0 when nothing can push it.
    pub lightness: f32,
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
}

/// Slack of the list of nodes, in voxels, and in seconds at the speed of what is fastest: larger
/// means longer lists, smaller more lists.
const SLACK: f32 = 0.5;
const SLACK_TIME: f32 = 1.0 / 120.0;

/// Nodes in a square of so many voxels are tested against a rigid shape together, before each is on
/// its own.
const SQUARE: f32 = 4.0;

impl Nearby {
    /// The lists are out of date: the meshes have changed.
    pub fn expire(&mut self) {
        self.skins.expire();
    }

    /// The bodies are in somebody else's hands.
    pub fn doubt(&mut self) {
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
        self.nodes_are_good &= self.skins.follow(bodies, size);
        self.travel += hand_speed * duration;
        // What gets faster may be looked for further out: half of the slack is kept for it.
        self.nodes_are_good &= self.travel < 0.5 * self.slack;
        if !self.nodes_are_good {
            let speed = fastest(bodies).max(hand_speed);
            self.slack = SLACK * size + speed * SLACK_TIME;
            self.find_node_pairs(bodies, colliders, self.slack + MARGIN * size);
            self.travel = 0.0;
            self.nodes_are_good = true;
        }
    }

    fn find_node_pairs<D: Dim>(&mut self, bodies: &[Body<D>], colliders: &[Collider], reach: f32) {
        let old = std::mem::take(&mut self.node_pairs);
        let mut old = old.into_iter().peekable();
        let places: Vec<Places> = bodies.iter().map(Places::of).collect();
        let mut near: Vec<u32> = Vec::new();
        for (index, collider) in colliders.iter().enumerate() {
            for (body, places) in places.iter().enumerate() {
                near.clear();
                places.within(reach, &collider.shape, &mut near);
                // What is near comes square by square.
                near.sort_unstable();
                for &node in &near {
                    let key = (index as u32, body as u32, node);
                    let key_of = |pair: &NodePair| (pair.collider, pair.body, pair.node);
                    while old.next_if(|pair| key_of(pair) < key).is_some() {}
                    let known = old.next_if(|pair| key_of(pair) == key);
                    self.node_pairs.push(NodePair {
                        collider: key.0,
                        body: key.1,
                        node,
                        impulse: known.map_or(Impulse::default(), |pair| pair.impulse),
                        clear: 0.0,
                    });
                }
            }
        }
    }
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
            let points = self.bins.points(&square.points).iter();
            let points = points.filter(|(at, _)| is_near(*at, reach));
            near.extend(points.map(|&(_, place)| self.nodes[place as usize]));
        }
    }
}

impl Square {
    fn around(bins: &Bins, points: Range<usize>) -> Self {
        let (mut low, mut high) = ([f32::MAX; 4], [f32::MIN; 4]);
        for (at, _) in bins.points(&points) {
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
