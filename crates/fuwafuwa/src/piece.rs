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
    /// Scratch of [`Pieces::part`]: which search has seen each element.
    seen: Vec<u32>,
    searches: u32,
}

/// One side of a release that is being followed.
struct Search {
    mark: u32,
    found: Vec<u32>,
    next: VecDeque<u32>,
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
        let mut sides: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        for &id in around {
            sides.entry(self.of_element(id)).or_default().push(id);
        }
        let mut born = Vec::new();
        for starts in sides.values() {
            self.part_one(mesh, starts, &mut born);
        }
        born
    }

    /// As [`Pieces::part`], for elements of one piece.
    fn part_one<D: Dim>(&mut self, mesh: &Mesh<D>, starts: &[u32], born: &mut Vec<u32>) {
        let first = self.searches + 1;
        let mut searches: Vec<Search> = Vec::new();
        for &id in starts {
            if self.seen[id as usize] < first {
                let mark = first + searches.len() as u32;
                self.seen[id as usize] = mark;
                let next = VecDeque::from([id]);
                let found = vec![id];
                searches.push(Search { mark, found, next });
            }
        }
        self.searches += searches.len() as u32;
        let mut turn = 0;
        while searches.len() > 1 {
            turn %= searches.len();
            let Some(id) = searches[turn].next.pop_front() else {
                let alone = searches.remove(turn);
                born.push(self.split_off(mesh, &alone.found));
                continue;
            };
            for near in neighbours(mesh, id) {
                let mark = searches[turn].mark;
                match self.seen[near as usize] {
                    seen if seen == mark => {}
                    seen if seen < first => {
                        self.seen[near as usize] = mark;
                        searches[turn].found.push(near);
                        searches[turn].next.push_back(near);
                    }
                    other => turn = self.join(&mut searches, turn, other),
                }
            }
            turn += 1;
        }
    }

    /// Adds the search marked `other` to the one at `turn`; returns where that one stands now.
    fn join(&mut self, searches: &mut Vec<Search>, turn: usize, other: u32) -> usize {
        let place = searches.iter().position(|search| search.mark == other);
        let Some(place) = place else { return turn };
        let met = searches.remove(place);
        let turn = if place < turn { turn - 1 } else { turn };
        let mark = searches[turn].mark;
        for &id in &met.found {
            self.seen[id as usize] = mark;
        }
        searches[turn].found.extend(met.found);
        searches[turn].next.extend(met.next);
        turn
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

/// The elements that share a node with one, itself included, some of them more than once.
fn neighbours<D: Dim>(mesh: &Mesh<D>, id: u32) -> impl Iterator<Item = u32> + '_ {
    let element = mesh.element(id).expect("neighbours of a live element");
    element
        .nodes
        .iter()
        .flat_map(move |&node| mesh.carrier_ids(node))
}
