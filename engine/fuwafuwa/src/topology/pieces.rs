//! Pieces of a body: connected sets of elements.
//!
//! Elements that share a node belong to one piece. A release can divide a piece only at the released points.
//! At each such point, one search through the mesh starts on each side of the new crack. All searches advance
//! at the same pace. Two searches that meet continue as one. A search that has no more elements to visit,
//! while others still run, has found a new piece. The last running search stops: its elements keep their
//! piece. The cost is therefore proportional to the smaller side. If many points were released at once, a
//! search that meets an earlier one continues with its results.

use crate::foundation::dim::Dim;
use crate::foundation::disjoint_sets::DisjointSets;
use crate::foundation::hash::hash_state;
use crate::foundation::ids::{ElementId, IndexVec, NodeId, PieceId};
use crate::topology::mesh::Mesh;
use glam::Vec3;
use std::collections::{BTreeMap, VecDeque};
use std::ops::Range;

/// Placeholder for the piece of an element that is not assigned to a piece yet.
const NONE: PieceId = PieceId(u32::MAX);

/// Connected part of a body.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Piece {
    /// Whether the piece sleeps: it is not simulated until something touches or wakes it.
    pub asleep: bool,
    /// Whether the piece was quarantined: a node became non-finite or too fast, and the piece was stopped for
    /// good.
    pub quarantined: bool,
    /// Whether the piece was [removed](crate::World::remove_piece): only its number remains.
    pub removed: bool,
    /// Time for which the piece has been at rest [s].
    pub sleep_timer: f32,
    /// Centre of mass of the piece, low-pass filtered over half a second [m]; see `world::sleep`.
    pub settled_at: Vec3,
}

hash_state! { struct Piece { asleep, quarantined, removed, sleep_timer, settled_at } }

/// Pieces of one body, and the piece of each element and node.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Pieces {
    /// Pieces by number. Numbers are never reused.
    pub list: IndexVec<PieceId, Piece>,
    of_element: IndexVec<ElementId, PieceId>,
    of_node: IndexVec<NodeId, PieceId>,
    /// For each element, the mark of the last search that visited it; each search has marks of its own.
    /// Scratch memory of [`Pieces::detach`].
    #[cfg_attr(feature = "serde", serde(skip))]
    seen: IndexVec<ElementId, u32>,
    /// For each node, the mark of the last search that visited it; each search has marks of its own. Scratch
    /// memory of [`Pieces::detach`].
    #[cfg_attr(feature = "serde", serde(skip))]
    node_seen: IndexVec<NodeId, u32>,
    /// Highest mark that a search has used so far.
    #[cfg_attr(feature = "serde", serde(skip))]
    marked: u32,
}

hash_state! { struct Pieces { list, of_element, of_node } skip { seen, node_seen, marked } }

/// Search through the mesh that started on one side of a crack at a released point.
struct Search {
    /// Index of the side at which the search started, among the sides of all released points.
    place: usize,
    found: Vec<ElementId>,
    next: VecDeque<ElementId>,
}

/// Searches from all sides of all points that were released at once.
struct Sides {
    /// Mark in [`Pieces::seen`] of the elements that the search from side 0 has found. The search from side k
    /// uses this mark plus k.
    first: u32,
    /// Sets of sides that are known to belong to one piece.
    joined: DisjointSets,
    /// Searches that are still running.
    running: VecDeque<Search>,
    /// Searches that stopped because no other search of their piece was still running.
    resting: Vec<Search>,
    /// Numbers of the pieces detached by this release.
    born: Vec<PieceId>,
}

impl Pieces {
    /// Computes the pieces of a mesh, numbered in the order of their lowest element ids.
    pub fn new<D: Dim>(mesh: &Mesh<D>) -> Self {
        let mut pieces = Self::default();
        pieces.make_room(mesh);
        pieces.of_element.fill(NONE);
        for (first, _) in mesh.elements() {
            if pieces.of_element[first] != NONE {
                continue;
            }
            let number = pieces.list.next_id();
            pieces.list.push(Piece::default());
            let mut next = vec![first];
            pieces.of_element[first] = number;
            while let Some(id) = next.pop() {
                for near in neighbours(mesh, id) {
                    if pieces.of_element[near] == NONE {
                        pieces.of_element[near] = number;
                        next.push(near);
                    }
                }
            }
        }
        for (id, element) in mesh.elements() {
            for &node in &element.nodes {
                pieces.of_node[node] = pieces.of_element[id];
            }
        }
        pieces
    }

    /// Returns the number of pieces that were not removed.
    pub fn count(&self) -> usize {
        self.list.iter().filter(|piece| !piece.removed).count()
    }

    /// Returns the piece of an element.
    ///
    /// # Panics
    /// If the id was never used.
    #[inline]
    pub fn of_element(&self, id: ElementId) -> PieceId {
        self.of_element[id]
    }

    /// Returns the piece of a node.
    ///
    /// # Panics
    /// If the id was never used.
    #[inline]
    pub fn of_node(&self, id: NodeId) -> PieceId {
        self.of_node[id]
    }

    /// Returns the pieces of nodes with consecutive ids.
    #[inline]
    pub fn of_nodes(&self, ids: Range<usize>) -> &[PieceId] {
        &self.of_node.as_slice()[ids]
    }

    /// Returns whether the piece of a node sleeps.
    #[inline]
    pub fn sleeps(&self, node: NodeId) -> bool {
        self.list[self.of_node[node]].asleep
    }

    /// Extends the lists to the present number of element ids and node ids.
    pub fn make_room<D: Dim>(&mut self, mesh: &Mesh<D>) {
        self.of_element.resize(mesh.element_capacity(), PieceId(0));
        self.seen.resize(mesh.element_capacity(), 0);
        self.of_node.resize(mesh.node_capacity(), PieceId(0));
        self.node_seen.resize(mesh.node_capacity(), 0);
    }

    /// Returns whether a list read from a file has a valid piece for every element id and node id of the
    /// mesh, used or not.
    #[cfg(feature = "serde")]
    pub(crate) fn has_room<D: Dim>(&self, mesh: &Mesh<D>) -> bool {
        let is_there = |piece: &PieceId| piece.index() < self.list.len();
        self.of_element.len() == mesh.element_capacity()
            && self.of_node.len() == mesh.node_capacity()
            && self
                .of_element
                .iter()
                .chain(self.of_node.iter())
                .all(is_there)
    }

    /// Assigns a new node to the piece of the old node `from`, from which its state is interpolated.
    pub fn inherit(&mut self, node: NodeId, from: NodeId) {
        self.of_node[node] = self.of_node[from];
    }

    /// Assigns a new or changed element to the piece of its nodes.
    pub fn adopt(&mut self, element: ElementId, nodes: &[NodeId]) {
        self.of_element[element] = self.of_node[nodes[0]];
    }

    /// Finds the pieces that a release has detached. `places` contains one list of elements for each cluster
    /// of released points: the elements around these points. If the elements of a list are not connected any
    /// more, each part except one becomes a new piece. Returns the numbers of the new pieces.
    pub fn detach<D: Dim>(&mut self, mesh: &Mesh<D>, places: &[Vec<ElementId>]) -> Vec<PieceId> {
        if self.marked > u32::MAX / 2 {
            self.marked = 0;
            self.seen.fill(0);
            self.node_seen.fill(0);
        }
        let mut sides = Sides {
            first: self.marked + 1,
            joined: DisjointSets::new(0),
            running: VecDeque::new(),
            resting: Vec::new(),
            born: Vec::new(),
        };
        let first_born = self.list.next_id();
        for around in places {
            self.part_at(mesh, around, &mut sides);
        }
        // A detached piece may have been the only connection between two sides at different points, and then
        // has elements at both points. All points with elements of detached pieces are therefore searched
        // again, as if they were one point.
        let is_off = |&id: &ElementId| self.of_element(id) >= first_born;
        let beside_off = places.iter().filter(|around| around.iter().any(is_off));
        let around: Vec<ElementId> = beside_off.flatten().copied().collect();
        self.part_at(mesh, &around, &mut sides);
        self.marked += sides.joined.count() as u32;
        sides.born
    }

    /// Implements [`Pieces::detach`] for the elements `around` one cluster of released points.
    fn part_at<D: Dim>(&mut self, mesh: &Mesh<D>, around: &[ElementId], sides: &mut Sides) {
        let mut by_piece: BTreeMap<PieceId, Vec<Vec<ElementId>>> = BTreeMap::new();
        for side in sides_of(mesh, around) {
            let of_piece = by_piece.entry(self.of_element(side[0]));
            of_piece.or_default().push(side);
        }
        // Elements on one side are connected at this point. Only pieces with several sides at this point need
        // a search.
        for starts in by_piece.into_values().filter(|starts| starts.len() > 1) {
            self.follow(mesh, starts, sides);
        }
    }

    /// Runs one search from each side `starts` of a piece, until only one is still running. The others have
    /// merged into a search that they met, or have found new pieces.
    fn follow<D: Dim>(&mut self, mesh: &Mesh<D>, starts: Vec<Vec<ElementId>>, sides: &mut Sides) {
        let first = sides.first;
        let mut known = Vec::new();
        for mut found in starts {
            let place = sides.joined.add();
            found.retain(|&id| {
                let seen = &mut self.seen[id];
                let is_new = *seen < first;
                if is_new {
                    *seen = first + place as u32;
                } else {
                    known.push((place, *seen));
                }
                is_new
            });
            let next = found.iter().copied().collect();
            sides.running.push_back(Search { place, found, next });
        }
        for (place, seen) in known {
            let own = sides
                .running
                .iter()
                .position(|search| sides.joined.lowest(search.place) == sides.joined.lowest(place));
            sides.meet(
                own.expect("sides that met are merged into one running search"),
                seen,
            );
        }
        let mut turn = 0;
        while sides.running.len() > 1 {
            turn %= sides.running.len();
            let Some(id) = sides.running[turn].next.pop_front() else {
                // Removing a search from the queue is cheap here: small pieces are searched completely while
                // their searches are near the front.
                let alone = sides
                    .running
                    .remove(turn)
                    .expect("turn is a valid index of a running search");
                sides.born.push(self.split_off(mesh, &alone.found));
                continue;
            };
            let element = mesh.element(id).expect("searches find live elements");
            for &node in &element.nodes {
                let mark = first + sides.running[turn].place as u32;
                let seen = std::mem::replace(&mut self.node_seen[node], mark);
                if seen >= first {
                    turn = sides.meet(turn, seen);
                    continue;
                }
                for near in mesh.carrier_ids(node) {
                    let seen = &mut self.seen[near];
                    if *seen >= first {
                        turn = sides.meet(turn, *seen);
                        continue;
                    }
                    *seen = mark;
                    sides.running[turn].found.push(near);
                    let next = &mut sides.running[turn].next;
                    // Visits coarser elements first, because searches meet soonest through the coarse
                    // interior.
                    let level = |id| mesh.element(id).map(|element| element.cell.level);
                    if level(near) > level(id) {
                        next.push_front(near);
                    } else {
                        next.push_back(near);
                    }
                }
            }
            turn += 1;
        }
        sides.resting.extend(sides.running.drain(..));
    }

    /// Moves elements to a new piece. The new piece is asleep or quarantined if the old piece was. Returns
    /// its number.
    fn split_off<D: Dim>(&mut self, mesh: &Mesh<D>, elements: &[ElementId]) -> PieceId {
        let number = self.list.next_id();
        let whole = &self.list[self.of_element[elements[0]]];
        let part = Piece {
            sleep_timer: 0.0,
            ..whole.clone()
        };
        self.list.push(part);
        for &id in elements {
            self.of_element[id] = number;
            let element = mesh.element(id).expect("searches find live elements");
            for &node in &element.nodes {
                self.of_node[node] = number;
            }
        }
        number
    }
}

impl Sides {
    /// Handles the case that the running search with index `turn` has reached an element or node with the
    /// mark `mark`. If the mark belongs to another search, merges that search into the search `turn`. Returns
    /// the index of the merged search, which may have changed.
    fn meet(&mut self, turn: usize, mark: u32) -> usize {
        let own = self.joined.lowest(self.running[turn].place);
        let other = self.joined.lowest((mark - self.first) as usize);
        if own == other {
            return turn;
        }
        let joined = &mut self.joined;
        let mut is_met = |search: &Search| joined.lowest(search.place) == other;
        let running = self.running.iter().position(&mut is_met);
        let resting = self.resting.iter().position(&mut is_met);
        self.joined.join(own, other);
        let met = match (running, resting) {
            (Some(place), _) => self.running.remove(place),
            (_, Some(place)) => Some(self.resting.swap_remove(place)),
            _ => None,
        };
        // A side without a running or resting search has become a detached piece. The side of this search
        // belongs to that piece.
        let Some(met) = met else {
            return turn;
        };
        let turn = turn - usize::from(running.is_some_and(|place| place < turn));
        self.running[turn].found.extend(met.found);
        self.running[turn].next.extend(met.next);
        turn
    }
}

/// Sorts elements into sides. Two elements are on one side if they share a node, directly or through other
/// elements of `around`.
fn sides_of<D: Dim>(mesh: &Mesh<D>, around: &[ElementId]) -> Vec<Vec<ElementId>> {
    let mut nodes: Vec<(NodeId, usize)> = Vec::new();
    for (place, &id) in around.iter().enumerate() {
        let element = mesh.element(id);
        let element = element.expect("elements around a release are alive");
        nodes.extend(element.nodes.iter().map(|&node| (node, place)));
    }
    nodes.sort_unstable();
    let mut joined = DisjointSets::new(around.len());
    for two in nodes.windows(2).filter(|two| two[0].0 == two[1].0) {
        joined.join(two[0].1, two[1].1);
    }
    joined.sort(around)
}

/// Returns the ids of the elements that share a node with an element. The element itself is included; some
/// ids occur several times.
fn neighbours<D: Dim>(mesh: &Mesh<D>, id: ElementId) -> impl Iterator<Item = ElementId> + '_ {
    let element = mesh.element(id).expect("neighbours of a live element");
    element
        .nodes
        .iter()
        .flat_map(move |&node| mesh.carrier_ids(node))
}
