//! Finding what may touch: lists of close pairs that stay good for a while.
//!
//! Against rigid shapes every node counts, so that an element squashed flat lets none through.
//! Against each other, bodies touch with their *skin*: every surface element is of level 0, so a
//! ball of one voxel's width around the middle of each is enough. Lists are made with some slack
//! and hold until something may have moved by that much [Verlet 1967].

use crate::body::Body;
use crate::dim::{Dim, Point};
use crate::shape::Shape;
use crate::solve::Row;
use crate::vector::{dot, length, minus, plus, scaled};

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
}

/// The ball around a surface element that stands for its skin.
#[derive(Copy, Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Skin {
    /// Place among the bodies.
    pub body: u32,
    /// Element id.
    pub element: u32,
    /// Piece number.
    pub piece: u32,
    /// Half a voxel [m].
    pub radius: f32,
    /// Its voxel.
    cell: Point,
    /// Its corner nodes; the first four in 2D.
    pub nodes: [u32; 8],
}

/// Two skins that may touch.
#[derive(Copy, Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SkinPair {
    /// Places among the skins, ascending.
    pub skins: [u32; 2],
    /// Body and element of both, in one number each: what the pair is known by.
    key: [u64; 2],
    /// What passed between them.
    pub impulse: Impulse,
}

/// What may touch what.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Nearby {
    /// Nodes close to rigid shapes, by collider, body and node.
    pub node_pairs: Vec<NodePair>,
    /// All skins, by body and element.
    pub skins: Vec<Skin>,
    /// Skins close to each other, ascending.
    pub skin_pairs: Vec<SkinPair>,
    /// Where the middles of the skins are now [m].
    pub centres: Vec<Row>,
    /// Where they were when the lists were made, and how far each may move before they must be
    /// made anew [m]; on the whole, and as seen from what moves along.
    made_at: Vec<Row>,
    slack: Vec<f32>,
    node_slack: f32,
    /// How far a hand has come since the list of nodes was made [m].
    hand_travel: f32,
    nodes_are_good: bool,
    skins_are_good: bool,
}

/// Slack of a skin, in voxels, and in seconds at the speed it has: larger means longer lists,
/// smaller more lists.
const SKIN_SLACK: f32 = 0.3;
const SLACK_TIME: f32 = 1.0 / 120.0;
/// The most slack that a fast skin gets, in voxels.
const MOST_SLACK: f32 = 8.0;
/// Slack of the list of nodes, in voxels.
const NODE_SLACK: f32 = 1.0;
/// Contacts are looked for out to this many voxels, so that none comes as a surprise.
pub const MARGIN: f32 = 0.3;

impl Nearby {
    /// The lists are out of date: the meshes or who is asleep have changed.
    pub fn expire(&mut self) {
        self.nodes_are_good = false;
        self.skins_are_good = false;
    }

    /// Forgets which node touched which collider: the colliders have other places now.
    pub fn forget_node_pairs(&mut self) {
        self.node_pairs.clear();
        self.expire();
    }

    /// A new tick: what passed in the last one is settled.
    pub fn start_tick(&mut self) {
        let nodes = self.node_pairs.iter_mut().map(|pair| &mut pair.impulse);
        let skins = self.skin_pairs.iter_mut().map(|pair| &mut pair.impulse);
        nodes.chain(skins).for_each(|impulse| impulse.total = 0.0);
    }

    /// Finds the middles of the skins, and makes new lists where something may have moved further
    /// than the old ones bear; a substep takes `duration` [s].
    pub fn refresh<D: Dim>(&mut self, bodies: &[Body<D>], colliders: &[Collider], duration: f32) {
        let sizes = bodies.iter().map(|body| body.grid.voxel_size());
        let size = sizes.fold(0.0, f32::max);
        if self.skins_are_good {
            self.find_centres(bodies);
            self.check_slack();
        }
        let hands = colliders.iter().map(|collider| length(collider.velocity));
        let hand_speed = hands.fold(0.0, f32::max);
        self.hand_travel += hand_speed * duration;
        self.nodes_are_good &= self.hand_travel < 0.5 * self.node_slack;
        if !self.skins_are_good {
            self.find_skins(bodies);
            self.find_centres(bodies);
            self.find_slack(bodies, size);
            self.find_skin_pairs(bodies, (1.0 + MARGIN) * size, SKIN_SLACK * size);
            self.skins_are_good = true;
            self.nodes_are_good = false;
        }
        if !self.nodes_are_good {
            let speed = fastest(bodies).max(hand_speed);
            self.node_slack = NODE_SLACK * size + 4.0 * speed * SLACK_TIME;
            self.find_node_pairs(bodies, colliders, self.node_slack + MARGIN * size);
            self.made_at.clone_from(&self.centres);
            self.hand_travel = 0.0;
            self.nodes_are_good = true;
        }
    }

    fn find_centres<D: Dim>(&mut self, bodies: &[Body<D>]) {
        self.centres.clear();
        let centres = self.skins.iter().map(|skin| skin.centre(bodies));
        self.centres.extend(centres);
    }

    /// Whether something has moved further than the lists bear. What moves along with everything
    /// else comes no closer to it.
    fn check_slack(&mut self) {
        let mut shift = [0.0; 4];
        for (now, then) in self.centres.iter().zip(&self.made_at) {
            shift = plus(shift, minus(*now, *then));
        }
        let shift = scaled(shift, 1.0 / self.centres.len().max(1) as f32);
        let mut furthest = 0.0f32;
        for ((now, then), slack) in self.centres.iter().zip(&self.made_at).zip(&self.slack) {
            let moved = minus(*now, *then);
            furthest = furthest.max(dot(moved, moved));
            let apart = minus(moved, shift);
            self.skins_are_good &= dot(apart, apart) < slack * slack;
        }
        let bearable = 0.5 * self.node_slack;
        self.nodes_are_good &= furthest < bearable * bearable;
    }

    /// How far each skin may move as seen from the rest: fast ones further.
    fn find_slack<D: Dim>(&mut self, bodies: &[Body<D>], size: f32) {
        let velocity = |skin: &Skin| skin.mean::<D>(&bodies[skin.body as usize].velocity);
        let velocities: Vec<Row> = self.skins.iter().map(velocity).collect();
        let sum = velocities
            .iter()
            .fold([0.0; 4], |sum, &velocity| plus(sum, velocity));
        let mean = scaled(sum, 1.0 / velocities.len().max(1) as f32);
        self.slack.clear();
        self.slack.extend(velocities.iter().map(|&velocity| {
            let own = length(minus(velocity, mean)) * SLACK_TIME;
            own.clamp(SKIN_SLACK * size, MOST_SLACK * size)
        }));
    }

    fn find_node_pairs<D: Dim>(&mut self, bodies: &[Body<D>], colliders: &[Collider], reach: f32) {
        let old = std::mem::take(&mut self.node_pairs);
        let mut old = old.into_iter().peekable();
        let boxes: Vec<(Row, f32)> = bodies.iter().map(bounding_ball).collect();
        for (index, collider) in colliders.iter().enumerate() {
            for (place, body) in bodies.iter().enumerate() {
                let (centre, radius) = boxes[place];
                if collider.shape.distance(three(centre)).0 > radius + reach {
                    continue;
                }
                for (node, _) in body.mesh.nodes() {
                    // What sleeps is touched by hands alone.
                    if body.pieces.sleeps(node) && !collider.is_hand {
                        continue;
                    }
                    let at = three(body.position[node as usize]);
                    if collider.shape.distance(at).0 > reach {
                        continue;
                    }
                    let key = (index as u32, place as u32, node);
                    let key_of = |pair: &NodePair| (pair.collider, pair.body, pair.node);
                    while old.next_if(|pair| key_of(pair) < key).is_some() {}
                    let known = old.next_if(|pair| key_of(pair) == key);
                    self.node_pairs.push(NodePair {
                        collider: key.0,
                        body: key.1,
                        node,
                        impulse: known.map_or(Impulse::default(), |pair| pair.impulse),
                    });
                }
            }
        }
    }

    fn find_skins<D: Dim>(&mut self, bodies: &[Body<D>]) {
        self.skins.clear();
        for (place, body) in bodies.iter().enumerate() {
            for (id, element) in body.mesh.elements() {
                if element.cell.level > 0 || body.bare[id as usize] == 0 {
                    continue;
                }
                let mut nodes = [0; 8];
                nodes[..D::CORNERS].copy_from_slice(&element.nodes);
                self.skins.push(Skin {
                    body: place as u32,
                    element: id,
                    piece: body.pieces.of_element(id),
                    radius: 0.5 * body.grid.voxel_size(),
                    cell: element.cell.at,
                    nodes,
                });
            }
        }
    }

    /// Finds the skins whose middles are no further apart than `touching` and the slack of both;
    /// `slow` is the least slack.
    fn find_skin_pairs<D: Dim>(&mut self, bodies: &[Body<D>], touching: f32, slow: f32) {
        let sleeps = |skin: &Skin| {
            let body = &bodies[skin.body as usize];
            body.pieces.list[skin.piece as usize].asleep
        };
        let asleep: Vec<bool> = self.skins.iter().map(sleeps).collect();
        let mut found: Vec<[u32; 2]> = Vec::new();
        for_each_close_pair::<D>(&self.centres, &self.slack, touching, slow, |a, b| {
            let (low, high) = (a.min(b), a.max(b));
            let pair = [&self.skins[low as usize], &self.skins[high as usize]];
            let both_sleep = asleep[a as usize] && asleep[b as usize];
            if !both_sleep && !pair[0].shares_node::<D>(pair[1]) {
                found.push([low, high]);
            }
        });
        found.sort_unstable();
        let old = std::mem::take(&mut self.skin_pairs);
        let mut old = old.into_iter().peekable();
        for skins in found {
            let key = skins.map(|skin| self.skins[skin as usize].key());
            while old.next_if(|pair| pair.key < key).is_some() {}
            let known = old.next_if(|pair| pair.key == key);
            let impulse = known.map_or(Impulse::default(), |pair| pair.impulse);
            self.skin_pairs.push(SkinPair {
                skins,
                key,
                impulse,
            });
        }
    }
}

impl Skin {
    /// The middle of its corners [m].
    #[inline]
    pub fn centre<D: Dim>(&self, bodies: &[Body<D>]) -> Row {
        self.mean::<D>(&bodies[self.body as usize].position)
    }

    /// The mean of something at its corners.
    #[inline]
    pub fn mean<D: Dim>(&self, rows: &[Row]) -> Row {
        let mut sum = rows[self.nodes[0] as usize];
        for &node in &self.nodes[1..D::CORNERS] {
            sum = plus(sum, rows[node as usize]);
        }
        scaled(sum, 1.0 / D::CORNERS as f32)
    }

    /// Body and element in one number.
    fn key(&self) -> u64 {
        u64::from(self.body) << 32 | u64::from(self.element)
    }

    fn shares_node<D: Dim>(&self, other: &Self) -> bool {
        if self.piece != other.piece || self.body != other.body {
            return false;
        }
        let near = (0..D::N).all(|axis| (self.cell[axis] - other.cell[axis]).abs() <= 1);
        let has = |node: &u32| other.nodes[..D::CORNERS].contains(node);
        near && self.nodes[..D::CORNERS].iter().any(has)
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

/// A ball around all nodes of a body.
fn bounding_ball<D: Dim>(body: &Body<D>) -> (Row, f32) {
    let (mut low, mut high) = ([f32::MAX; 4], [f32::MIN; 4]);
    for (node, _) in body.mesh.nodes() {
        let at = body.position[node as usize];
        for axis in 0..4 {
            low[axis] = low[axis].min(at[axis]);
            high[axis] = high[axis].max(at[axis]);
        }
    }
    let centre = scaled(plus(low, high), 0.5);
    (centre, length(minus(high, centre)))
}

/// Calls `visit` once for each pair of points no further apart than `touching` and the slack of
/// both. Points of the least slack, `slow`, are looked for in narrow cells, the others, few as they
/// are, in wide ones.
fn for_each_close_pair<D: Dim>(
    points: &[Row],
    slack: &[f32],
    touching: f32,
    slow: f32,
    mut visit: impl FnMut(u32, u32),
) {
    let is_close = |a: usize, b: usize| {
        let apart = minus(points[a], points[b]);
        let reach = touching + slack[a] + slack[b];
        dot(apart, apart) <= reach * reach
    };
    let is_fast = |index: usize| slack[index] > slow;
    let narrow = Cells::new(points, touching + 2.0 * slow);
    let ahead = cells_ahead::<D>();
    for index in (0..points.len()).filter(|&index| !is_fast(index)) {
        for step in &ahead {
            for other in narrow.near(index, *step) {
                let seen = *step == [0; 3] && other <= index;
                if !seen && !is_fast(other) && is_close(index, other) {
                    visit(index as u32, other as u32);
                }
            }
        }
    }
    let most = slack.iter().fold(slow, |most, &slack| most.max(slack));
    if most == slow {
        return;
    }
    let wide = Cells::new(points, touching + 2.0 * most);
    let around: Vec<Point> = crate::dim::neighbourhood::<D>([0; 3], 1).collect();
    for index in (0..points.len()).filter(|&index| is_fast(index)) {
        for step in &around {
            for other in wide.near(index, *step) {
                let seen = is_fast(other) && other <= index;
                if !seen && is_close(index, other) {
                    visit(index as u32, other as u32);
                }
            }
        }
    }
}

/// Points sorted into the cells of a grid without bounds.
struct Cells {
    /// The cell of each point.
    cells: Vec<Point>,
    /// `sorted[start[b]..start[b + 1]]` are the points of bucket b.
    start: Vec<u32>,
    sorted: Vec<u32>,
}

impl Cells {
    fn new(points: &[Row], width: f32) -> Self {
        let inverse = 1.0 / width;
        // Rounding towards zero alone would make the cells around the middle twice as wide.
        let cell_of = |at: &Row| {
            [0, 1, 2].map(|axis: usize| {
                let place = at[axis] * inverse;
                place as i32 - i32::from(place < 0.0)
            })
        };
        let cells: Vec<Point> = points.iter().map(cell_of).collect();
        let buckets = points.len().next_power_of_two();
        let mut start = vec![0u32; buckets + 1];
        for &cell in &cells {
            start[bucket(cell, buckets) + 1] += 1;
        }
        for bucket in 0..buckets {
            start[bucket + 1] += start[bucket];
        }
        let mut sorted = vec![0u32; points.len()];
        let mut next = start.clone();
        for (index, &cell) in cells.iter().enumerate() {
            let place = &mut next[bucket(cell, buckets)];
            sorted[*place as usize] = index as u32;
            *place += 1;
        }
        Self {
            cells,
            start,
            sorted,
        }
    }

    /// The points in the cell some steps from that of a point.
    fn near(&self, index: usize, step: Point) -> impl Iterator<Item = usize> + '_ {
        let own = self.cells[index];
        let cell = [0, 1, 2].map(|axis: usize| own[axis].wrapping_add(step[axis]));
        let bucket = bucket(cell, self.start.len() - 1);
        let places = self.start[bucket] as usize..self.start[bucket + 1] as usize;
        let here = self.sorted[places].iter().map(|&other| other as usize);
        here.filter(move |&other| self.cells[other] == cell)
    }
}

/// The bucket of a cell; the number of buckets is a power of two.
fn bucket(cell: Point, buckets: usize) -> usize {
    let mixed = (cell[0] as u32).wrapping_mul(0x8da6_b343)
        ^ (cell[1] as u32).wrapping_mul(0xd816_3841)
        ^ (cell[2] as u32).wrapping_mul(0xcb1a_b31f);
    (mixed ^ mixed >> 15) as usize & (buckets - 1)
}

/// A cell itself and one of each two opposite neighbours.
fn cells_ahead<D: Dim>() -> Vec<Point> {
    let near = crate::dim::neighbourhood::<D>([0; 3], 1);
    near.filter(|&[x, y, z]| (z, y, x) >= (0, 0, 0)).collect()
}

fn three(row: Row) -> [f32; 3] {
    [row[0], row[1], row[2]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dim::{Dim2, Dim3};

    fn check_pairs<D: Dim>() {
        let mut seed = 7u32;
        let mut random = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (seed >> 8) as f32 / (1 << 24) as f32 * 4.0 - 2.0
        };
        let point = |_| {
            let z = if D::N == 3 { random() } else { 0.0 };
            [random(), random(), z, 0.0]
        };
        let points: Vec<Row> = (0..400).map(point).collect();
        let slack: Vec<f32> = (0..400)
            .map(|k| if k % 9 == 0 { 0.4 } else { 0.05 })
            .collect();
        let mut found = Vec::new();
        for_each_close_pair::<D>(&points, &slack, 0.2, 0.05, |a, b| {
            found.push((a.min(b), a.max(b)));
        });
        found.sort_unstable();
        let mut expected = Vec::new();
        for b in 0..points.len() {
            for a in 0..b {
                let reach = 0.2 + slack[a] + slack[b];
                let apart = minus(points[a], points[b]);
                if dot(apart, apart) <= reach * reach {
                    expected.push((a as u32, b as u32));
                }
            }
        }
        expected.sort_unstable();
        assert!(expected.len() > 20);
        assert_eq!(found, expected);
    }

    #[test]
    fn close_pairs_are_found_once_each() {
        check_pairs::<Dim2>();
        check_pairs::<Dim3>();
    }
}
