//! Triangulated surface of a 2D body: one vertex per node, with the elements between them.
//!
//! ```text
//!   o───o─o─o      A whole element is a triangle fan of the nodes around it, hanging nodes included. In a remodelled
//!   │   ├─o─o      element each remaining child is a square; a corner without a node lies at the mean of its
//!   o───o─o─o      neighbours.
//! ```
//!
//! The outline is smoothed in two steps. First, the points of the outline move onto the smooth surface of the body,
//! see `SoftBody::skin_offset`. These offsets deform together with the voxels. Then
//! several rounds smooth the stair steps that contacts press into the deformed outline. The rounds
//! alternately shrink and expand the outline, so that it keeps its area [Taubin 1995].

use super::pool::Pool;
use super::{Surface, Vertex, light_of};
use crate::colours::SoftColours;
use bevy_math::{Vec2, Vec3};
use fuwafuwa::IndexVec;
use fuwafuwa::inspect::Element;
use fuwafuwa::inspect::{add, beyond, corner, face_corners};
use fuwafuwa::inspect::{slot_at, slot_index};
use fuwafuwa::{Bookmark, Changes, Dim, Dim2, ElementId, NodeId, SoftBody};

/// Factor of each smoothing round: fraction of the way from a point of the outline to the midpoint of its
/// neighbours. Negative factors move the point away and expand the outline.
const ROUNDS: [f32; 6] = [0.5, -0.5, 0.5, -0.5, 0.5, -0.5];
/// Index of a missing vertex.
const NONE: u32 = u32::MAX;
/// Bit mask of the bare faces of a voxel without neighbours.
const ALL_SIDES: u8 = 0b1111;
/// Slots of the nodes on the border of an element, counterclockwise, beginning with the middle of an edge.
const AROUND: [usize; 8] = [1, 2, 5, 8, 7, 6, 3, 0];

/// Triangles of a 2D body.
#[derive(Default)]
pub struct PlaneSurface {
    vertices: Pool<VertexSource>,
    triangles: Pool<[u32; 3]>,
    /// Triangles, vertices and outline sides of each element.
    forms: IndexVec<ElementId, Form>,
    /// Vertex of each node, or `NONE`.
    of_node: IndexVec<NodeId, u32>,
    /// Side of the outline that begins at each node; `last` has the side that ends there.
    next: IndexVec<NodeId, OutlineEdge>,
    last: IndexVec<NodeId, OutlineEdge>,
    places: Vec<Vec2>,
    smoothed: Vec<Vec2>,
    followed: Bookmark,
}

/// Definition of a vertex: the mean of eight nodes, or one node eight times.
#[derive(Copy, Clone, Debug)]
struct VertexSource {
    nodes: [NodeId; 8],
    material: u8,
}

/// Triangles, vertices and outline sides of an element.
#[derive(Clone, Debug, Default)]
struct Form {
    triangles: Vec<u32>,
    /// Vertices that lie at the mean of several nodes instead of at a node.
    means: Vec<u32>,
    sides: Vec<[NodeId; 2]>,
}

/// Side of the outline, as stored at the node at one of its ends.
#[derive(Copy, Clone, Debug)]
struct OutlineEdge {
    /// Vertex at the other end of the side, or `NONE`.
    to: u32,
    is_fresh: bool,
    /// Smoothing offset at the node that stores this value [voxels], in the frame of the voxel.
    offset: Vec2,
    /// Corner nodes of the voxel to which the side belongs.
    corners: [NodeId; 4],
}

const NO_SIDE: OutlineEdge = OutlineEdge {
    to: NONE,
    is_fresh: false,
    offset: Vec2::ZERO,
    corners: [NodeId(u32::MAX); 4],
};

impl Surface<Dim2> for PlaneSurface {
    fn follow(&mut self, body: &SoftBody<Dim2>, _: &SoftColours) -> bool {
        let changes = body.changes_since(&mut self.followed);
        let changes = changes.unwrap_or_else(|| {
            // Rebuilds everything in the first call, or if the body had more changes than it stores.
            *self = Self {
                followed: self.followed,
                ..Self::default()
            };
            let mesh = body.mesh();
            Changes {
                nodes: mesh.nodes().map(|(id, _)| id).collect(),
                elements: mesh.elements().map(|(id, _)| id).collect(),
                ..Changes::default()
            }
        });
        self.change(body, &changes);
        self.place(body);
        ROUNDS.iter().for_each(|&share| self.smooth(share));
        !changes.elements.is_empty() || !changes.nodes.is_empty()
    }

    fn vertices(&self) -> impl Iterator<Item = Option<Vertex>> {
        let places = self.vertices.all.iter().zip(&self.places);
        places.map(|(place, at)| {
            place.map(|_| Vertex {
                position: at.extend(0.0),
                normal: Vec3::Z,
            })
        })
    }

    fn colours(&self, colours: &SoftColours) -> impl Iterator<Item = [f32; 4]> {
        self.vertices.all.iter().map(|place| {
            place.map_or([0.0; 4], |place| {
                let node = place.nodes[0];
                let is_fresh = self.next[node].is_fresh || self.last[node].is_fresh;
                light_of(colours, place.material, is_fresh)
            })
        })
    }

    fn indices(&self) -> impl Iterator<Item = u32> {
        let triangles = self.triangles.all.iter();
        triangles.flat_map(|triangle| triangle.unwrap_or([0; 3]))
    }
}

impl PlaneSurface {
    /// Removes the triangles and vertices of changed elements and nodes, and adds the new ones.
    fn change(&mut self, body: &SoftBody<Dim2>, changes: &Changes) {
        let mesh = body.mesh();
        self.forms.resize(mesh.element_capacity(), Form::default());
        self.of_node.resize(mesh.node_capacity(), NONE);
        self.next.resize(mesh.node_capacity(), NO_SIDE);
        self.last.resize(mesh.node_capacity(), NO_SIDE);
        for &id in &changes.elements {
            let form = std::mem::take(&mut self.forms[id]);
            let triangles = form.triangles.into_iter();
            triangles.for_each(|place| self.triangles.free(place));
            let means = form.means.into_iter();
            means.for_each(|place| self.vertices.free(place));
            for [from, to] in form.sides {
                (self.next[from], self.last[to]) = (NO_SIDE, NO_SIDE);
            }
        }
        for &id in &changes.nodes {
            let known = std::mem::replace(&mut self.of_node[id], NONE);
            if known != NONE {
                self.vertices.free(known);
            }
        }
        for &id in changes.nodes.iter().filter(|&&id| mesh.is_alive(id)) {
            self.of_node[id] = self.vertices.take(VertexSource {
                nodes: [id; 8],
                material: 0,
            });
        }
        for &id in &changes.elements {
            if let Some(element) = mesh.element(id) {
                self.put_up(body, id, element);
            }
        }
    }

    fn put_up(&mut self, body: &SoftBody<Dim2>, id: ElementId, element: &Element) {
        let material = body.grid().material(body.mesh().first_voxel(element));
        let mut form = Form::default();
        let slots = &body.mesh().element_class(element).slots;
        let mut nodes = [None; 9];
        for (&slot, &node) in slots.iter().zip(&element.nodes) {
            nodes[usize::from(slot)] = Some(node);
            if let Some(place) = &mut self.vertices.all[self.of_node[node] as usize] {
                place.material = material;
            }
        }
        let mut vertices = nodes.map(|node| node.map_or(NONE, |node| self.of_node[node]));
        let is_whole = element.children == Dim2::ALL_CORNERS;
        let polygons: Vec<Vec<usize>> = match is_whole {
            true => vec![AROUND.to_vec()],
            false => squares(element.children),
        };
        for slot in polygons.iter().flatten().copied() {
            if vertices[slot] == NONE && !is_whole {
                let nodes = mean_of(slot, &nodes);
                let mean = nodes.map(|nodes| self.vertices.take(VertexSource { nodes, material }));
                form.means.extend(mean);
                vertices[slot] = mean.unwrap_or(NONE);
            }
        }
        for polygon in polygons {
            let ring = polygon.into_iter().map(|slot| vertices[slot]);
            let ring: Vec<u32> = ring.filter(|&vertex| vertex != NONE).collect();
            let Some((&first, rest)) = ring.split_first() else {
                continue;
            };
            let fan = rest.windows(2).map(|pair| [first, pair[0], pair[1]]);
            form.triangles
                .extend(fan.map(|triangle| self.triangles.take(triangle)));
        }
        self.add_sides(body, id, element, &mut form);
        self.forms[id] = form;
    }

    /// Adds the bare sides of an element to the outline. Skips an isolated voxel, which is too small to need
    /// smoothing.
    fn add_sides(
        &mut self,
        body: &SoftBody<Dim2>,
        id: ElementId,
        element: &Element,
        form: &mut Form,
    ) {
        let bare = body.bare_faces(id);
        if bare == ALL_SIDES {
            return;
        }
        for face in (0..4).filter(|face| bare >> face & 1 == 1) {
            let [from, to, ..] = face_corners::<Dim2>(face).map(|corner| element.nodes[corner]);
            let is_fresh = body.grid().is_solid(beyond(element.cell.at, face));
            let offsets = [from, to].map(|node| match is_fresh {
                true => Vec3::ZERO,
                false => Vec3::from_array(body.skin_offset(body.mesh().node(node).at).to_array()),
            });
            let side = |to: NodeId, end: usize| OutlineEdge {
                to: self.of_node[to],
                is_fresh,
                offset: offsets[end].truncate(),
                corners: std::array::from_fn(|corner| element.nodes[corner]),
            };
            (self.next[from], self.last[to]) = (side(to, 0), side(from, 1));
            form.sides.push([from, to]);
        }
    }

    fn place(&mut self, body: &SoftBody<Dim2>) {
        let positions = body.positions();
        let at = |node: NodeId| Vec2::new(positions[node][0], positions[node][1]);
        let places = self.vertices.all.iter().map(|place| match place {
            Some(VertexSource { nodes, .. }) if nodes.iter().all(|node| *node == nodes[0]) => {
                at(nodes[0])
            }
            Some(VertexSource { nodes, .. }) => {
                nodes.iter().map(|&node| at(node)).sum::<Vec2>() / 8.0
            }
            None => Vec2::ZERO,
        });
        self.places.clear();
        self.places.extend(places);
        let moved = |side: &OutlineEdge| {
            let [a, b, c, d] = side.corners.map(at);
            let (right, up) = (0.5 * (b - a + d - c), 0.5 * (c - a + d - b));
            side.offset.x * right + side.offset.y * up
        };
        for (node, next) in self.next.entries() {
            let (own, last) = (self.of_node[node], &self.last[node]);
            if own == NONE || next.to == NONE || last.to == NONE {
                continue;
            }
            self.places[own as usize] += match (last.is_fresh, next.is_fresh) {
                (false, false) => moved(last).midpoint(moved(next)),
                (false, true) => moved(last),
                _ => moved(next),
            };
        }
    }

    fn smooth(&mut self, share: f32) {
        self.smoothed.clone_from(&self.places);
        for (node, next) in self.next.entries() {
            let (own, last) = (self.of_node[node], self.last[node]);
            if own == NONE || next.to == NONE || last.to == NONE {
                continue;
            }
            let place = |vertex: u32| self.places[vertex as usize];
            let middle = place(next.to).midpoint(place(last.to));
            self.smoothed[own as usize] = place(own).lerp(middle, share);
        }
        std::mem::swap(&mut self.places, &mut self.smoothed);
    }
}

/// Returns the corner slots of each remaining child, counterclockwise.
fn squares(children: u8) -> Vec<Vec<usize>> {
    let left = (0..Dim2::CORNERS).filter(|child| children >> child & 1 == 1);
    let square = |child| {
        let corners = [0, 1, 3, 2].map(|vertex| slot_index(add(corner(child), corner(vertex))));
        corners.to_vec()
    };
    left.map(square).collect()
}

/// Returns the nodes whose mean is the position of a slot without a node. These are the ends of its edge or,
/// for the centre of the element, the midpoints of the edges around it.
fn mean_of(slot: usize, nodes: &[Option<NodeId>; 9]) -> Option<[NodeId; 8]> {
    let halves = |slot: usize, axis: usize| {
        [0, 2].map(|end| {
            let mut at = slot_at(slot);
            at[axis] = end;
            slot_index(at)
        })
    };
    let edge = |slot: usize, axis: usize| match nodes[slot] {
        Some(node) => Some([node; 2]),
        None => {
            let [from, to] = halves(slot, axis);
            Some([nodes[from]?, nodes[to]?])
        }
    };
    match slot_at(slot) {
        [1, 1, _] => {
            let [left, right] = halves(slot, 0);
            let [low, high] = halves(slot, 1);
            let around = [
                edge(left, 1)?,
                edge(right, 1)?,
                edge(low, 0)?,
                edge(high, 0)?,
            ];
            let [[a, b], [c, d], [e, f], [g, h]] = around;
            Some([a, b, c, d, e, f, g, h])
        }
        [1, ..] => edge(slot, 0).map(|[a, b]| [a, a, a, a, b, b, b, b]),
        _ => edge(slot, 1).map(|[a, b]| [a, a, a, a, b, b, b, b]),
    }
}
