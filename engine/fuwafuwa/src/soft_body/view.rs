//! Views of a body: pieces, surface, elements, and the mass in a region.

use crate::foundation::dim::{
    Dim, Dim2, DimVector, Point, add, beyond, corner, face_corners, scale,
};
use crate::foundation::ids::{ElementId, IndexVec, NodeId, PieceId};
use crate::math::row::Row;
use crate::rigid_body::shape::Shape;
use crate::soft_body::SoftBody;
use crate::topology::element_class::{slot_at, slot_index};
use crate::topology::mesh::Element;
use glam::{DVec3, Vec3};

/// Summary of a piece.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct PieceView {
    /// Number of the piece.
    pub number: PieceId,
    /// Mass [kg].
    pub mass: f32,
    /// Centre of mass [m].
    pub centre: Vec3,
    /// Velocity of the centre of mass [m/s].
    pub velocity: Vec3,
    /// Lowest coordinate of the smooth surface along each axis [m].
    pub low: Vec3,
    /// Highest coordinate of the smooth surface along each axis [m].
    pub high: Vec3,
    /// Number of elements.
    pub element_count: u32,
    /// Whether the piece sleeps.
    pub asleep: bool,
    /// Whether the piece was quarantined: stopped for good because a node became non-finite or too fast.
    pub quarantined: bool,
    /// Whether the piece was removed. The mass, positions and velocity of a removed piece are 0.
    pub removed: bool,
}

/// Exposed face of a voxel: a segment in 2D, a quad in 3D.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Facet {
    /// Nodes of the face: two in 2D, four in 3D. In 3D they run counterclockwise as seen from outside. In 2D
    /// the body lies to the left of the segment from the first node to the second. Unused entries are
    /// `u32::MAX`.
    pub nodes: [NodeId; 4],
    /// Corners [m]: the positions of `nodes`, or the points of the smooth surface at them; 0 for unused entries.
    pub corners: [Vec3; 4],
    /// Outward unit normal.
    pub normal: Vec3,
    /// Element to which the face belongs.
    pub element: ElementId,
    /// Piece of the element.
    pub piece: PieceId,
    /// Whether a crack exposed the face; false at the original surface.
    pub is_torn: bool,
}

/// Closed line around a piece of a 2D body, or around a hole in it.
#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    /// Piece to which the line belongs.
    pub piece: PieceId,
    /// Ids of the nodes along the line; the body lies to the left of the line.
    pub nodes: Vec<NodeId>,
    /// Positions of `nodes` [m].
    pub points: Vec<Vec3>,
    /// Outward unit normal at each entry of `points`.
    pub normals: Vec<Vec3>,
    /// For each entry of `points`, whether a crack exposed the segment from this point to the next.
    pub is_torn: Vec<bool>,
}

/// View of an element, for drawing.
#[derive(Clone, Debug, PartialEq)]
pub struct ElementView {
    /// Id of the element.
    pub id: ElementId,
    /// Level of the element's cell: the cell is 2^level voxels wide.
    pub level: u8,
    /// Piece of the element.
    pub piece: PieceId,
    /// Number of the material.
    pub material: u8,
    /// Mask of the children of the cell that the element fills; all bits are set at level 0.
    pub children: u8,
    /// Elastic strain ‖F − R‖: distance of the deformation gradient from its rotation; 0 at rest.
    pub strain: f32,
    /// Positions [m] of the slots of the element, a 3 × 3 (× 3) lattice. A slot outside the region that the
    /// element fills has the position of the element's centroid.
    pub slots: [Vec3; 27],
}

/// Boundary face of the region that an element fills.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub struct ElementFace {
    /// Slots at the corners of the face: two in 2D, four in 3D, in the order of [`face_corners`].
    pub slots: [usize; 4],
    /// In 3D, for each side of the face, whether the surface of the region bends at the side. False if a
    /// further face of the region continues in the same plane beyond the side. Side k leads from corner k to
    /// the next corner.
    pub is_edge: [bool; 4],
}

/// Returns the squares or cubes that an element fills, each as its low corner and its width, in steps of the
/// slot lattice: one for each filled child, or a single one for an element of level 0.
pub fn blocks<D: Dim>(level: u8, children: u8) -> impl Iterator<Item = (Point, i32)> {
    let whole = (level == 0).then_some(([0; 3], 2));
    let filled = (0..D::CORNERS).filter(move |child| level > 0 && children >> child & 1 == 1);
    let filled = filled.map(|child| (corner(child), 1));
    whole.into_iter().chain(filled)
}

/// Returns the boundary faces of the region that an element fills, in the order of its children.
///
/// ```text
///     o──o──o        2D: the element fills three of its children. Where two of them meet there is no face.
///     │     │        `outline_slots` goes around the region counterclockwise.
///     o  o──o
///     │  │
///     o──o
/// ```
pub fn faces<D: Dim>(level: u8, children: u8) -> Vec<ElementFace> {
    let is_filled = |block: Point| blocks::<D>(level, children).any(|(low, _)| low == block);
    let mut faces = Vec::new();
    for (low, width) in blocks::<D>(level, children) {
        for face in 0..2 * D::N {
            if is_filled(beyond(low, face)) {
                continue;
            }
            let ring = face_corners::<D>(face);
            let is_edge = [0, 1, 2, 3].map(|k| {
                // Axis within the plane of the face that is perpendicular to side k of the face.
                let (a, b) = (ring[k], ring[(k + 1) % 4]);
                let mut axes = (0..D::N).filter(|&axis| axis != face / 2);
                let across = axes.find(|axis| (a ^ b) >> axis & 1 == 0);
                across.is_none_or(|axis| {
                    let beside = beyond(low, 2 * axis + (a >> axis & 1));
                    !is_filled(beside) || is_filled(beyond(beside, face))
                })
            });
            let slot = |vertex| slot_index(add(low, scale(corner(vertex), width)));
            let slots = ring.map(slot);
            faces.push(ElementFace { slots, is_edge });
        }
    }
    faces
}

/// Returns the slots around the region that a 2D element fills, in one counterclockwise round. A slot occurs
/// twice if two filled children touch only at that slot.
pub fn outline_slots(level: u8, children: u8) -> Vec<usize> {
    let mut faces = faces::<Dim2>(level, children);
    let mut at = faces.first().map(|face| face.slots[0]);
    let mut ring = Vec::new();
    // Two faces begin at a slot where two children touch only at the slot. The last face belongs to the child
    // that was not visited yet, so that one round visits both children.
    while let Some(next) = faces.iter().rposition(|face| Some(face.slots[0]) == at) {
        let [from, to, ..] = faces.remove(next).slots;
        ring.push(from);
        at = Some(to);
    }
    ring
}

impl<D: Dim> SoftBody<D> {
    /// Returns a summary of each piece, by piece number.
    #[inline(never)]
    pub fn piece_views(&self) -> Vec<PieceView> {
        let none = |(number, piece): (PieceId, &crate::topology::pieces::Piece)| PieceView {
            number,
            mass: 0.0,
            centre: Vec3::ZERO,
            velocity: Vec3::ZERO,
            low: Vec3::splat(f32::MAX),
            high: Vec3::splat(f32::MIN),
            element_count: 0,
            asleep: piece.asleep,
            quarantined: piece.quarantined,
            removed: piece.removed,
        };
        let pieces = &self.topology.pieces;
        let mut views: Vec<PieceView> = pieces.list.entries().map(none).collect();
        // Far from the origin, the rounding of sums in single precision would be noticeable.
        let mut sums = vec![(0.0f64, DVec3::ZERO, DVec3::ZERO); views.len()];
        for (id, _) in self.topology.mesh.elements() {
            views[pieces.of_element(id).index()].element_count += 1;
        }
        for (id, _) in self.topology.mesh.nodes() {
            let piece = pieces.of_node(id).index();
            let of_node = |rows: &IndexVec<NodeId, Row>| rows[id].xyz().as_dvec3();
            let node_mass = f64::from(self.state.mass[id]);
            let (mass, centre, velocity) = &mut sums[piece];
            *mass += node_mass;
            *centre += of_node(&self.state.position) * node_mass;
            *velocity += of_node(&self.state.velocity) * node_mass;
            let view = &mut views[piece];
            let surface = self.skin_position(id);
            for axis in 0..3 {
                view.low[axis] = view.low[axis].min(surface[axis]);
                view.high[axis] = view.high[axis].max(surface[axis]);
            }
        }
        for (view, (mass, centre, velocity)) in views.iter_mut().zip(sums) {
            if view.removed {
                (view.low, view.high) = (Vec3::ZERO, Vec3::ZERO);
                continue;
            }
            view.mass = mass as f32;
            view.centre = (centre / mass).as_vec3();
            view.velocity = (velocity / mass).as_vec3();
        }
        views
    }

    /// Iterates over the nodes inside `region` or on its surface.
    pub fn nodes_in(&self, region: &Shape<D>) -> impl Iterator<Item = NodeId> + '_ {
        let region = region.solid();
        let nodes = self.topology.mesh.nodes().map(|(id, _)| id);
        nodes.filter(move |&id| region.distance(self.state.position[id].xyz()).0 <= 0.0)
    }

    /// Mass [kg] of all nodes inside `region`, without those on its surface.
    #[inline(never)]
    pub fn mass_inside(&self, region: &Shape<D>) -> f32 {
        let region = region.solid();
        self.mass_where(|at| region.distance(at.to_vec3()).0 < 0.0)
    }

    /// Mass [kg] of all nodes whose position [m] satisfies a condition.
    pub fn mass_where(&self, is_inside: impl Fn(D::Vector) -> bool) -> f32 {
        let states = self
            .topology
            .mesh
            .nodes()
            .map(|(id, _)| self.node_state(id));
        states
            .filter(|&(at, _, _)| is_inside(at))
            .fold(0.0, |sum, (_, _, mass)| sum + mass)
    }

    /// Returns all exposed faces, in the order of the elements.
    pub fn facets(&self) -> impl Iterator<Item = Facet> + '_ {
        self.topology
            .mesh
            .elements()
            .flat_map(move |(id, element)| {
                let exposed_faces = self.bare_faces(id);
                (0..2 * D::N)
                    .filter(move |face| exposed_faces >> face & 1 == 1)
                    .map(move |face| self.facet(id, element, face))
            })
    }

    /// Returns the parts of the smooth surface over all exposed faces, in the order of [`SoftBody::facets`]: their
    /// `corners` are the points of the smooth surface at `nodes`, see [`SoftBody::skin_position`]. Rigid shapes and
    /// queries use this surface.
    pub fn skin_facets(&self) -> impl Iterator<Item = Facet> + '_ {
        self.facets().map(|facet| {
            let mut corners = facet.corners;
            for (corner, node) in corners.iter_mut().zip(facet.nodes).take(D::CORNERS / 2) {
                *corner = self.skin_position(node);
            }
            Facet {
                corners,
                normal: normal_of::<D>(&corners),
                ..facet
            }
        })
    }

    /// Mask of the exposed faces of an element, with bit 2 · axis + side (0 = low, 1 = high). Always 0 for
    /// elements above level 0. Use [`SoftBody::changes_since`] to learn which elements cracks have changed.
    ///
    /// # Panics
    /// If the id was never used.
    pub fn bare_faces(&self, element: ElementId) -> u8 {
        match self.cache.exposed_faces[element] {
            0 => 0,
            exposed_faces => match self.topology.mesh.element(element) {
                Some(alive) if alive.cell.level == 0 => exposed_faces,
                _ => 0,
            },
        }
    }

    /// Position [m] of each node, by id, as (x, y, z, 0). Entries of ids without a node are unspecified.
    pub fn positions(&self) -> &IndexVec<NodeId, Row> {
        &self.state.position
    }

    /// Returns the closed lines around all pieces of a 2D body and around their holes; empty in 3D.
    #[inline(never)]
    pub fn outlines(&self) -> Vec<Outline> {
        // Surface nodes form closed lines only in 2D.
        if D::N != 2 {
            return Vec::new();
        }
        // For each node, the surface segment that starts at the node. At every surface node, one segment
        // starts and one ends.
        let mut leaving: IndexVec<NodeId, Option<Facet>> =
            vec![None; self.topology.mesh.node_capacity()].into();
        for facet in self.facets() {
            leaving[facet.nodes[0]] = Some(facet);
        }
        let mut outlines = Vec::new();
        for start in leaving.ids() {
            let mut ring: Vec<Facet> = Vec::new();
            let mut at = start;
            while let Some(facet) = leaving[at].take() {
                at = facet.nodes[1];
                ring.push(facet);
            }
            if let Some(last) = ring.last() {
                let before = std::iter::once(last).chain(&ring);
                let normals = ring.iter().zip(before);
                let normals = normals.map(|(next, last)| unit(last.normal + next.normal));
                outlines.push(Outline {
                    piece: ring[0].piece,
                    nodes: ring.iter().map(|facet| facet.nodes[0]).collect(),
                    points: ring.iter().map(|facet| facet.corners[0]).collect(),
                    normals: normals.collect(),
                    is_torn: ring.iter().map(|facet| facet.is_torn).collect(),
                });
            }
        }
        outlines
    }

    /// Returns views of all elements.
    pub fn element_views(&self) -> impl Iterator<Item = ElementView> + '_ {
        self.topology
            .mesh
            .elements()
            .map(|(id, element)| self.view_of(id, element))
    }

    /// Returns the view of an element, if the element is alive.
    #[inline(never)]
    pub fn element_view(&self, id: ElementId) -> Option<ElementView> {
        Some(self.view_of(id, self.topology.mesh.element(id)?))
    }

    #[inline(never)]
    fn view_of(&self, id: ElementId, element: &Element) -> ElementView {
        ElementView {
            id,
            level: element.cell.level,
            piece: self.topology.pieces.of_element(id),
            material: self
                .topology
                .grid
                .material(self.topology.mesh.first_voxel(element)),
            children: element.children,
            strain: self.strain_of(id, element),
            slots: self.slot_positions(element),
        }
    }

    /// Elastic strain ‖F − R‖ of an element, or `None` if the element was removed; 0.1 is a stretch by a
    /// tenth. [Plastic strain](SoftBody::plastic_strain) is not included.
    #[inline(never)]
    pub fn strain(&self, id: ElementId) -> Option<f32> {
        Some(self.strain_of(id, self.topology.mesh.element(id)?))
    }

    fn strain_of(&self, id: ElementId, element: &Element) -> f32 {
        let deformation = self.elastic_part(id, element);
        let rotation = self.state.batches.rotation(id);
        let mut sum = 0.0;
        for i in 0..D::N {
            for j in 0..D::N {
                let difference = deformation[i][j] - rotation[i][j];
                sum += difference * difference;
            }
        }
        sum.sqrt()
    }

    /// Positions of the slots of an element [m]. A slot without a node gets the mean position of its
    /// neighbours: an edge middle from two corners, a face centre from four edge middles, the cell centre
    /// from the face centres. If one of these has no position, the slot gets the centroid of the element.
    fn slot_positions(&self, element: &Element) -> [Vec3; 27] {
        let centre = self.deformation(element).0;
        let mut positions: [Option<Vec3>; 27] = [None; 27];
        let slots = &self.topology.mesh.element_class(element).slots;
        for (&slot, &node) in slots.iter().zip(&element.nodes) {
            positions[slot as usize] = Some(self.state.position[node].xyz());
        }
        // Edge middles come first, then face centres, then the cell centre, because each is the mean of slots
        // of the previous kind.
        for order in 1..=D::N {
            for slot in 0..D::SLOTS {
                let at = slot_at(slot);
                let middles = at.iter().filter(|&&k| k == 1).count();
                if positions[slot].is_some() || middles != order {
                    continue;
                }
                let mut sum = Vec3::ZERO;
                let mut count = 0.0;
                for axis in (0..D::N).filter(|&axis| at[axis] == 1) {
                    for end in [0, 2] {
                        let mut near = at;
                        near[axis] = end;
                        if let Some(position) = positions[slot_index(near)] {
                            sum += position;
                            count += 1.0;
                        }
                    }
                }
                if count == 2.0 * order as f32 {
                    positions[slot] = Some(sum * (1.0 / count));
                }
            }
        }
        positions.map(|position| position.unwrap_or(centre))
    }

    #[inline(never)]
    fn facet(&self, id: ElementId, element: &Element, face: usize) -> Facet {
        let ring = face_corners::<D>(face);
        let mut nodes = [NodeId(u32::MAX); 4];
        let mut corners = [Vec3::ZERO; 4];
        for place in 0..D::CORNERS / 2 {
            nodes[place] = element.nodes[ring[place]];
            corners[place] = self.state.position[nodes[place]].xyz();
        }
        Facet {
            nodes,
            corners,
            normal: normal_of::<D>(&corners),
            element: id,
            piece: self.topology.pieces.of_element(id),
            is_torn: self.topology.grid.is_solid(beyond(element.cell.at, face)),
        }
    }
}

/// Returns the outward unit normal of a face: perpendicular to a segment in 2D, and in 3D to both diagonals of a quad,
/// which need not be flat.
fn normal_of<D: Dim>(corners: &[Vec3; 4]) -> Vec3 {
    let [a, b, c, d] = *corners;
    unit(match D::N {
        2 => Vec3::new(b.y - a.y, a.x - b.x, 0.0),
        _ => (c - a).cross(d - b),
    })
}

impl ElementView {
    /// Corners [m] of a child that the element fills, in the order of [`corner`]. At level 0, where cells
    /// have no children, the corners of the whole cell.
    pub fn child_corners<D: Dim>(&self, child: usize) -> Vec<Vec3> {
        let at = |vertex: usize| match self.level {
            0 => scale(corner(vertex), 2),
            _ => add(corner(child), corner(vertex)),
        };
        let position = |vertex: usize| self.slots[slot_index(at(vertex))];
        (0..D::CORNERS).map(position).collect()
    }
}

fn unit(v: Vec3) -> Vec3 {
    v * (1.0 / v.length().max(1e-12))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::foundation::dim::Dim3;

    #[test]
    fn faces_enclose_filled_children() {
        let count = |faces: &[ElementFace]| {
            let edges = faces.iter().flat_map(|face| face.is_edge);
            (faces.len(), edges.filter(|&is| is).count())
        };
        let check = |level, children, expect| {
            let faces = faces::<Dim3>(level, children);
            assert_eq!(count(&faces), expect, "{children:#b} of level {level}");
        };
        check(0, 255, (6, 24));
        check(1, 255, (24, 48));
        check(1, 0b0001, (6, 24));
        check(1, 0b0011, (10, 32));
        check(1, 0b1001, (12, 48));
    }

    #[test]
    fn outline_slots_enclose_filled_children_once() {
        let check = |level, children, expect: &[[i32; 2]]| {
            let ring = outline_slots(level, children);
            let low = ring
                .iter()
                .position(|&slot| slot == 0)
                .expect("the element fills the low corner");
            let around = ring.iter().cycle().skip(low).take(ring.len());
            let around: Vec<[i32; 2]> = around
                .map(|&slot| [slot_at(slot)[0], slot_at(slot)[1]])
                .collect();
            assert_eq!(around, expect, "{children:#b} of level {level}");
        };
        check(0, 15, &[[0, 0], [2, 0], [2, 2], [0, 2]]);
        check(1, 0b0001, &[[0, 0], [1, 0], [1, 1], [0, 1]]);
        check(
            1,
            0b0111,
            &[
                [0, 0],
                [1, 0],
                [2, 0],
                [2, 1],
                [1, 1],
                [1, 2],
                [0, 2],
                [0, 1],
            ],
        );
        check(
            1,
            0b1001,
            &[
                [0, 0],
                [1, 0],
                [1, 1],
                [2, 1],
                [2, 2],
                [1, 2],
                [1, 1],
                [0, 1],
            ],
        );
    }
}
