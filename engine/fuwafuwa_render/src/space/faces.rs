//! Bare (exposed) faces of a body, the surface points at their corners and the vertices drawn there.
//!
//! Faces belong to elements, points to nodes. [`Faces::update`] updates only what the body reports as changed
//! since the last call. For a body that was loaded or replaced, it updates everything. A point at the mouth
//! of a crack, where the original surface meets the torn surface, has two vertices at the same position. Each
//! of the two vertices has the normal and the colour of one of these surfaces.

use super::pool::Pool;
use super::rest::Rest;
use crate::palette::{Colour, among, bytes};
use fuwafuwa::IndexVec;
use fuwafuwa::inspect::{corner, face_corners};
use fuwafuwa::{Bookmark, Dim3, ElementId, NodeId, Point, SoftBody};
use glam::Vec3;

/// Null index.
pub const NONE: u32 = u32::MAX;
/// Null node.
pub const NO_NODE: NodeId = NodeId(u32::MAX);
/// Face mask of a voxel without neighbours in its piece.
const ALL_FACES: u8 = 0b11_1111;

/// Bare faces of a body with their points, vertices and triangles.
#[derive(Clone, Debug, Default)]
pub struct Faces {
    /// Properties of each element at the last update that determine its faces.
    forms: IndexVec<ElementId, Form>,
    /// Index of the point of each node, or `NONE`.
    of_node: IndexVec<NodeId, u32>,
    /// Faces. Removed faces have no points.
    pub faces: Pool<Face>,
    /// Points. Removed points have no node.
    pub points: Pool<SkinPoint>,
    /// Vertices drawn at the points.
    pub vertices: Pool<VertexSource>,
    /// Vertex indices: two triangles per face. The triangles of removed faces have no area.
    pub indices: Vec<u32>,
    /// Elements that are crumbs (pieces of a single voxel). They have no points and faces.
    pub crumbs: Vec<ElementId>,
    /// Indices of points to be updated.
    dirty: Vec<u32>,
    followed: Bookmark,
    palette: Vec<Colour>,
}

/// Bare face of a voxel.
#[derive(Copy, Clone, Debug)]
pub struct Face {
    /// Indices of the face's points, counterclockwise seen from outside.
    pub points: [u32; 4],
    /// Indices of the face's vertices.
    pub vertices: [u32; 4],
    /// For each corner of the face: the next entry in the list of all face corners at that point, as 4 · face
    /// + corner, or `NONE` at the end.
    next: [u32; 4],
    element: ElementId,
    /// Number of the face within the element: 2 · axis + side.
    side: u8,
    is_fresh: bool,
}

/// Node on the surface.
#[derive(Copy, Clone, Debug)]
pub struct SkinPoint {
    /// Node at which the point lies, or [`NO_NODE`].
    pub node: NodeId,
    /// Nodes of the adjacent voxel with whose deformation the smoothing offset moves.
    pub voxel: [NodeId; 8],
    /// Smoothing offset in the frame of the voxel [voxels].
    pub offset: Vec3,
    /// Neighbour points that smoothing averages.
    pub near: [u32; 6],
    /// Number of neighbour points.
    pub near_count: u8,
    /// Kind of surface at the point.
    pub ground: SurfaceKind,
    /// First entry in the list of all face corners at the point, as 4 · face + corner.
    first: u32,
    /// Vertex on the original surface, then vertex on the torn surface.
    vertices: [u32; 2],
    is_dirty: bool,
}

/// Kind of surface at a point.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum SurfaceKind {
    /// Original surface.
    Original,
    /// Mouth of a crack, where original and torn surface meet.
    CrackMouth,
    /// Surface created by tearing.
    Torn,
}

/// Motion-independent data of a vertex.
#[derive(Copy, Clone, Debug)]
pub struct VertexSource {
    /// Index of the point at which the vertex lies, or `NONE`.
    pub point: u32,
    /// Rest position [voxels].
    pub rest: Vec3,
    /// Red, green, blue of the material; the last component is 255 on torn surfaces.
    pub colour: [u8; 4],
    /// Red, green, blue of the material beyond the nearest border between materials. The last component is
    /// the position across the border: 128 on the border, higher in the material beyond it.
    pub other: [u8; 4],
}

/// Properties of an element that determine its faces.
#[derive(Copy, Clone, Debug, PartialEq)]
struct Form {
    bare: u8,
    at: Point,
    nodes: [NodeId; 8],
    /// Indices of the element's faces, or `NONE`.
    faces: [u32; 6],
}

const NO_FORM: Form = Form {
    bare: 0,
    at: [0; 3],
    nodes: [NO_NODE; 8],
    faces: [NONE; 6],
};
const NO_FACE: Face = Face {
    points: [NONE; 4],
    vertices: [0; 4],
    next: [NONE; 4],
    element: ElementId(u32::MAX),
    side: 0,
    is_fresh: false,
};
const NO_POINT: SkinPoint = SkinPoint {
    node: NO_NODE,
    voxel: [NO_NODE; 8],
    offset: Vec3::ZERO,
    near: [NONE; 6],
    near_count: 0,
    ground: SurfaceKind::Original,
    first: NONE,
    vertices: [NONE; 2],
    is_dirty: false,
};
const NO_CORNER: VertexSource = VertexSource {
    point: NONE,
    rest: Vec3::ZERO,
    colour: [0; 4],
    other: [0; 4],
};

impl Faces {
    /// Updates everything that changed since the last call. `palette` has the colours of the materials,
    /// starting at number 1. Returns whether anything changed.
    pub fn update(&mut self, body: &SoftBody<Dim3>, rest: &Rest, palette: &[Colour]) -> bool {
        let mesh = body.mesh();
        let (elements, nodes) = (mesh.element_capacity(), mesh.node_capacity());
        // A body never reuses ids, so smaller capacities mean that this is another body.
        if elements < self.forms.len() || nodes < self.of_node.len() {
            *self = Self::default();
        }
        self.forms.resize(elements, NO_FORM);
        self.of_node.resize(nodes, NONE);
        self.repaint(palette);
        let stale = self.compare(body);
        let any = !stale.is_empty() || !self.dirty.is_empty();
        for &(id, _) in &stale {
            for face in std::mem::replace(&mut self.forms[id], NO_FORM).faces {
                if face != NONE {
                    self.remove_face(face);
                }
            }
        }
        let mut new = Vec::new();
        for &(id, form) in &stale {
            self.forms[id] = form;
            if form.bare == ALL_FACES {
                continue;
            }
            for side in (0..6u8).filter(|side| form.bare >> side & 1 == 1) {
                let face = self.add_face(body, id, side);
                self.forms[id].faces[usize::from(side)] = face;
                new.push(face);
            }
        }
        for point in std::mem::take(&mut self.dirty) {
            self.refresh(body, rest, point);
        }
        self.indices.resize(6 * self.faces.all.len(), 0);
        new.iter().for_each(|&face| self.triangulate(face));
        any
    }

    /// Returns the changed elements with their new forms.
    fn compare(&mut self, body: &SoftBody<Dim3>) -> Vec<(ElementId, Form)> {
        let (mut stale, mut has_lost) = (Vec::new(), false);
        let changes = body.changes_since(&mut self.followed);
        let is_other = changes.is_none();
        if is_other {
            self.crumbs.clear();
        }
        let all = || self.forms.ids().collect();
        for id in changes.map_or_else(all, |changes| changes.elements) {
            let known = &self.forms[id];
            let bare = body.bare_faces(id);
            if bare | known.bare == 0 {
                continue;
            }
            let now = match body.mesh().element(id) {
                Some(element) if bare != 0 => Form {
                    bare,
                    at: element.cell.at,
                    nodes: std::array::from_fn(|vertex| element.nodes[vertex]),
                    ..NO_FORM
                },
                _ => NO_FORM,
            };
            let (is_crumb, was_crumb) = (now.bare == ALL_FACES, known.bare == ALL_FACES);
            if is_crumb && (is_other || !was_crumb) {
                self.crumbs.push(id);
            }
            has_lost |= was_crumb && !is_crumb;
            if (now.bare, now.at, now.nodes) != (known.bare, known.at, known.nodes) {
                stale.push((id, now));
            }
        }
        if has_lost {
            self.crumbs.retain(|&id| body.bare_faces(id) == ALL_FACES);
        }
        stale
    }

    /// Marks all points for an update if the colours have changed.
    fn repaint(&mut self, palette: &[Colour]) {
        if self.palette != palette {
            self.palette = palette.to_vec();
            for place in 0..self.points.all.len() as u32 {
                if self.points[place].node != NO_NODE {
                    self.mark_dirty(place);
                }
            }
        }
    }

    fn mark_dirty(&mut self, point: u32) {
        let is_dirty = &mut self.points[point].is_dirty;
        if !std::mem::replace(is_dirty, true) {
            self.dirty.push(point);
        }
    }

    fn add_face(&mut self, body: &SoftBody<Dim3>, element: ElementId, side: u8) -> u32 {
        let form = self.forms[element];
        let mut beyond = form.at;
        beyond[usize::from(side / 2)] += 2 * i32::from(side % 2) - 1;
        let place = self.faces.insert(Face {
            element,
            side,
            is_fresh: body.grid().is_solid(beyond),
            ..NO_FACE
        });
        for (k, vertex) in face_corners::<Dim3>(side.into()).into_iter().enumerate() {
            let node = form.nodes[vertex];
            let mut point = self.of_node[node];
            if point == NONE {
                point = self.points.insert(SkinPoint { node, ..NO_POINT });
                self.of_node[node] = point;
            }
            let face = &mut self.faces[place];
            face.points[k] = point;
            face.next[k] = self.points[point].first;
            self.points[point].first = 4 * place + k as u32;
            self.mark_dirty(point);
        }
        place
    }

    fn remove_face(&mut self, place: u32) {
        let face = self.faces[place];
        for (k, &point) in face.points.iter().enumerate() {
            let own = 4 * place + k as u32;
            let mut at = self.points[point].first;
            if at == own {
                self.points[point].first = face.next[k];
            } else {
                while self.next(at) != own {
                    at = self.next(at);
                }
                self.faces[at / 4].next[at as usize % 4] = face.next[k];
            }
            self.mark_dirty(point);
        }
        self.faces.remove(place, NO_FACE);
        self.indices[6 * place as usize..][..6].fill(0);
    }

    fn next(&self, corner: u32) -> u32 {
        self.faces[corner / 4].next[corner as usize % 4]
    }

    /// Returns the face corners at a point.
    fn corners(&self, point: u32) -> impl Iterator<Item = (Face, usize)> {
        let mut at = self.points[point].first;
        std::iter::from_fn(move || {
            let found = (at != NONE).then(|| (self.faces[at / 4], at as usize % 4))?;
            at = found.0.next[found.1];
            Some(found)
        })
    }

    /// Recomputes everything at a point that depends on its faces.
    fn refresh(&mut self, body: &SoftBody<Dim3>, rest: &Rest, place: u32) {
        let mut point = self.points[place];
        point.is_dirty = false;
        if point.first == NONE {
            for vertex in point.vertices.into_iter().filter(|&vertex| vertex != NONE) {
                self.vertices.remove(vertex, NO_CORNER);
            }
            self.of_node[point.node] = NONE;
            self.points.remove(place, NO_POINT);
            return;
        }
        let at = body.mesh().node(point.node).at;
        let mut octant = 0;
        let mut counts = [0; 2];
        let mut near = [NeighbourSet::default(); 2];
        let mut best = f32::MIN;
        for (face, k) in self.corners(place) {
            let ground = usize::from(face.is_fresh);
            counts[ground] += 1;
            let form = &self.forms[face.element];
            let vertex = face_corners::<Dim3>(face.side.into())[k];
            octant = 7 - vertex;
            near[ground].add(face.points[(k + 1) % 4]);
            near[ground].add(face.points[(k + 3) % 4]);
            // Selects the voxel with whose deformation the smoothing offset moves: a voxel that the offset
            // points into, otherwise the voxel that the offset leaves least.
            let offset = rest.offset(at, octant);
            let inwards = Vec3::from(corner(vertex).map(|end| 1.0 - 2.0 * end as f32));
            let towards = (inwards * offset).min(Vec3::ZERO).element_sum();
            if towards > best {
                (best, point.voxel, point.offset) = (towards, form.nodes, offset);
            }
        }
        point.ground = match counts {
            [_, 0] => SurfaceKind::Original,
            [0, _] => SurfaceKind::Torn,
            _ => SurfaceKind::CrackMouth,
        };
        let joined = match point.ground {
            SurfaceKind::Original => near[0],
            SurfaceKind::Torn => near[1],
            SurfaceKind::CrackMouth => near[0].common(near[1]),
        };
        (point.near, point.near_count) = (joined.points, joined.count);
        let tint = rest.tint(at, octant);
        let [own, other] = tint.materials.map(|number| self.colour(number));
        for (ground, &count) in counts.iter().enumerate() {
            let vertex = &mut point.vertices[ground];
            let corner = VertexSource {
                point: place,
                rest: Vec3::from(at.map(|k| k as f32)) + point.offset,
                colour: bytes(own, ground as f32),
                other: bytes(other, tint.side),
            };
            match (*vertex, count) {
                (NONE, 0) => {}
                (NONE, _) => *vertex = self.vertices.insert(corner),
                (known, 0) => {
                    self.vertices.remove(known, NO_CORNER);
                    *vertex = NONE;
                }
                (known, _) => self.vertices[known] = corner,
            }
        }
        self.points[place] = point;
    }

    fn colour(&self, material: u8) -> Colour {
        among(&self.palette, usize::from(material.max(1)) - 1)
    }

    fn triangulate(&mut self, place: u32) {
        let face = &mut self.faces[place];
        for k in 0..4 {
            let vertices = self.points[face.points[k]].vertices;
            face.vertices[k] = vertices[usize::from(face.is_fresh)];
        }
        let corners = [0, 1, 2, 0, 2, 3].map(|k| face.vertices[k]);
        self.indices[6 * place as usize..][..6].copy_from_slice(&corners);
    }
}

/// Distinct neighbours of a point, at most six. More than six occur only where thin sheets meet and are
/// ignored.
#[derive(Copy, Clone, Debug)]
struct NeighbourSet {
    points: [u32; 6],
    count: u8,
}

impl Default for NeighbourSet {
    fn default() -> Self {
        Self {
            points: [NONE; 6],
            count: 0,
        }
    }
}

impl NeighbourSet {
    fn add(&mut self, point: u32) {
        let count = usize::from(self.count);
        if count < 6 && !self.points[..count].contains(&point) {
            self.points[count] = point;
            self.count += 1;
        }
    }

    fn common(self, other: Self) -> Self {
        let mut both = Self::default();
        let own = self.points[..self.count.into()].iter();
        own.filter(|point| other.points.contains(point))
            .for_each(|&point| both.add(point));
        both
    }
}
