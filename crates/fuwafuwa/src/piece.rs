//! Which elements hang together: the pieces of a body.
//!
//! Elements that share a node are of one piece. A release can part a piece only at the points it
//! changed, so both sides are followed from there at the same pace until they meet, or until one
//! of them is used up: that one is the new piece. What it costs goes with the smaller side.

use crate::dim::Dim;
use crate::mesh::Mesh;
use std::collections::{BTreeMap, VecDeque};

/// A connected part of a body.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Piece {
    /// Whether it rests and is left alone until something touches it.
    pub asleep: bool,
    /// Whether it went out of hand (not finite) and was stopped for good.
    pub quarantined: bool,
    /// How long it has been slow [s].
    pub still: f32,
}

/// The pieces of one body, and which one each element and node belongs to.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Pieces {
    /// By piece number. Numbers are never given back.
    pub list: Vec<Piece>,
    /// By element id.
    of_element: Vec<u32>,
    /// By node id.
    of_node: Vec<u32>,
    /// Scratch of [`Pieces::part`]: which search has seen each element and node.
    seen: Vec<u32>,
    node_seen: Vec<u32>,
    marked: u32,
}

/// One side of a release that is being followed.
struct Search {
    /// Its place among the sides at the start.
    place: usize,
    found: Vec<u32>,
    next: VecDeque<u32>,
}

/// Which of some things, given by their places, have turned out to be the same.
pub(crate) struct Same {
    /// Each points to a lower one of its kind, the lowest to itself.
    lower: Vec<usize>,
}

impl Same {
    /// Nothing is the same yet.
    pub(crate) fn new(count: usize) -> Self {
        let lower = (0..count).collect();
        Self { lower }
    }

    /// The lowest of the kind of one.
    pub(crate) fn lowest(&mut self, mut place: usize) -> usize {
        while self.lower[place] != place {
            self.lower[place] = self.lower[self.lower[place]];
            place = self.lower[place];
        }
        place
    }

    /// Makes two the same.
    pub(crate) fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.lowest(a), self.lowest(b));
        self.lower[a.max(b)] = a.min(b);
    }
}

impl Pieces {
    /// The pieces of a mesh from scratch, numbered by their lowest element.
    pub fn new<D: Dim>(mesh: &Mesh<D>) -> Self {
        let mut pieces = Self::default();
        pieces.make_room(mesh);
        pieces.of_element.fill(u32::MAX);
        for (first, _) in mesh.elements() {
            if pieces.of_element[first as usize] != u32::MAX {
                continue;
            }
            let number = pieces.list.len() as u32;
            pieces.list.push(Piece::default());
            let mut next = vec![first];
            pieces.of_element[first as usize] = number;
            while let Some(id) = next.pop() {
                for near in neighbours(mesh, id) {
                    if pieces.of_element[near as usize] == u32::MAX {
                        pieces.of_element[near as usize] = number;
                        next.push(near);
                    }
                }
            }
        }
        for (id, element) in mesh.elements() {
            for &node in &element.nodes {
                pieces.of_node[node as usize] = pieces.of_element[id as usize];
            }
        }
        pieces
    }

    /// The piece of an element.
    ///
    /// # Panics
    /// When the id was never used.
    #[inline]
    pub fn of_element(&self, id: u32) -> u32 {
        self.of_element[id as usize]
    }

    /// The piece of a node.
    ///
    /// # Panics
    /// When the id was never used.
    #[inline]
    pub fn of_node(&self, id: u32) -> u32 {
        self.of_node[id as usize]
    }

    /// Whether the piece of a node is asleep.
    #[inline]
    pub fn sleeps(&self, node: u32) -> bool {
        self.list[self.of_node[node as usize] as usize].asleep
    }

    /// Makes room for elements and nodes that a remodelling added.
    pub fn make_room<D: Dim>(&mut self, mesh: &Mesh<D>) {
        self.of_element.resize(mesh.element_capacity(), 0);
        self.seen.resize(mesh.element_capacity(), 0);
        self.of_node.resize(mesh.node_capacity(), 0);
        self.node_seen.resize(mesh.node_capacity(), 0);
    }

    /// A new node belongs where the node it took its state from belongs.
    pub fn inherit(&mut self, node: u32, from: u32) {
        self.of_node[node as usize] = self.of_node[from as usize];
    }

    /// An element that was seated belongs where its nodes belong.
    pub fn adopt(&mut self, element: u32, nodes: &[u32]) {
        self.of_element[element as usize] = self.of_node[nodes[0] as usize];
    }

    /// Finds out whether the elements `around` a release still hang together. Every part that does
    /// not reach the rest of its piece becomes a piece of its own; returns their numbers.
    pub fn part<D: Dim>(&mut self, mesh: &Mesh<D>, around: &[u32]) -> Vec<u32> {
        let mut sides: BTreeMap<u32, Vec<Vec<u32>>> = BTreeMap::new();
        for side in self.sides(mesh, around) {
            sides
                .entry(self.of_element(side[0]))
                .or_default()
                .push(side);
        }
        let mut born = Vec::new();
        // What hangs together right here needs no search.
        for starts in sides.into_values().filter(|starts| starts.len() > 1) {
            self.part_one(mesh, starts, &mut born);
        }
        born
    }

    /// Some elements, sorted by which of them hang together through nodes of their own.
    fn sides<D: Dim>(&mut self, mesh: &Mesh<D>, around: &[u32]) -> Vec<Vec<u32>> {
        let first = self.marks(around.len());
        let mut same = Same::new(around.len());
        for (place, &id) in around.iter().enumerate() {
            let element = mesh
                .element(id)
                .expect("elements around a release are alive");
            for &node in &element.nodes {
                let seen = &mut self.node_seen[node as usize];
                if *seen < first {
                    *seen = first + place as u32;
                    continue;
                }
                same.join(place, (*seen - first) as usize);
            }
        }
        let mut sides: BTreeMap<usize, Vec<u32>> = BTreeMap::new();
        for (place, &id) in around.iter().enumerate() {
            let side = sides.entry(same.lowest(place)).or_default();
            side.push(id);
        }
        sides.into_values().collect()
    }

    /// The first of some marks that nothing bears yet.
    fn marks(&mut self, count: usize) -> u32 {
        if self.marked > u32::MAX - count as u32 {
            self.marked = 0;
            self.seen.fill(0);
            self.node_seen.fill(0);
        }
        self.marked += count as u32;
        self.marked - count as u32 + 1
    }

    /// As [`Pieces::part`], for the sides of one piece.
    fn part_one<D: Dim>(&mut self, mesh: &Mesh<D>, starts: Vec<Vec<u32>>, born: &mut Vec<u32>) {
        let first = self.marks(starts.len());
        let mut same = Same::new(starts.len());
        let mut searches: Vec<Search> = Vec::new();
        for (place, found) in starts.into_iter().enumerate() {
            for &id in &found {
                self.seen[id as usize] = first + place as u32;
            }
            let next = found.iter().copied().collect();
            searches.push(Search { place, found, next });
        }
        let mut turn = 0;
        while searches.len() > 1 {
            turn %= searches.len();
            let Some(id) = searches[turn].next.pop_front() else {
                let alone = searches.remove(turn);
                born.push(self.split_off(mesh, &alone.found));
                continue;
            };
            let element = mesh.element(id).expect("searches find live elements");
            for &node in &element.nodes {
                let place = searches[turn].place;
                let mark = first + place as u32;
                let seen = std::mem::replace(&mut self.node_seen[node as usize], mark);
                if seen >= first {
                    turn = meet(&mut searches, turn, &mut same, (seen - first) as usize);
                    continue;
                }
                for near in mesh.carrier_ids(node) {
                    let seen = &mut self.seen[near as usize];
                    if *seen >= first {
                        let other = (*seen - first) as usize;
                        turn = meet(&mut searches, turn, &mut same, other);
                        continue;
                    }
                    *seen = mark;
                    searches[turn].found.push(near);
                    searches[turn].next.push_back(near);
                }
            }
            turn += 1;
        }
    }

    /// Makes a piece of the given elements: asleep or stopped, like the one they were of.
    fn split_off<D: Dim>(&mut self, mesh: &Mesh<D>, elements: &[u32]) -> u32 {
        let number = self.list.len() as u32;
        let whole = &self.list[self.of_element[elements[0] as usize] as usize];
        self.list.push(Piece {
            still: 0.0,
            ..whole.clone()
        });
        for &id in elements {
            self.of_element[id as usize] = number;
            let element = mesh.element(id).expect("searches find live elements");
            for &node in &element.nodes {
                self.of_node[node as usize] = number;
            }
        }
        number
    }
}

/// Adds the search that saw what the one at `turn` sees now, if it is another one, to it; returns
/// where that one stands now.
fn meet(searches: &mut Vec<Search>, turn: usize, same: &mut Same, seen_by: usize) -> usize {
    let own = same.lowest(searches[turn].place);
    let other = same.lowest(seen_by);
    if own == other {
        return turn;
    }
    let place = searches
        .iter()
        .position(|search| same.lowest(search.place) == other)
        .expect("a search that has ended is met by nobody");
    let met = searches.remove(place);
    same.join(own, other);
    let turn = if place < turn { turn - 1 } else { turn };
    searches[turn].found.extend(met.found);
    searches[turn].next.extend(met.next);
    turn
}

/// The elements that share a node with one, itself included, some of them more than once.
fn neighbours<D: Dim>(mesh: &Mesh<D>, id: u32) -> impl Iterator<Item = u32> + '_ {
    let element = mesh.element(id).expect("neighbours of a live element");
    element
        .nodes
        .iter()
        .flat_map(move |&node| mesh.carrier_ids(node))
}
