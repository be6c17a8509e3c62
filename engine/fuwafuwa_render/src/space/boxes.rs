//! Elements of 3D bodies as deformed boxes.

use super::camera::Cut;
use super::cut::planes;
use crate::elements::colour_of;
use crate::frame::ElementColour;
use crate::palette::{Palette, bytes};
use bytemuck::{Pod, Zeroable};
use fuwafuwa::inspect::Element;
use fuwafuwa::inspect::slot_index;
use fuwafuwa::inspect::{ElementFace, faces};
use fuwafuwa::inspect::{corner, scale};
use fuwafuwa::{Dim3, ElementId, ElementView, SoftBody};
use glam::Vec3;

/// Distance between a box and the faces of its element [voxels], so that neighbours can be told apart.
const GAP: f32 = 0.03;
/// Minimum depth of an element's centre behind the cut [element widths] at which none of its neighbours is
/// cut away. Faces covered by neighbours are then left out. A neighbour towards the cut is at most twice as
/// wide, so its centre is at most 1.5 widths closer to the cut.
const DEEP: f32 = 1.51;

/// Vertex of the element view.
#[repr(C)]
#[derive(Copy, Clone, Debug, PartialEq, Pod, Zeroable)]
pub struct BoxVertex {
    /// Position [m].
    pub at: Vec3,
    /// Distance of the vertex from each side of the quad: 0 on that side, 255 on the opposite side. Always
    /// 255 for a side that is no edge of the element, so that no line is drawn there.
    pub sides: [u8; 4],
    /// Red, green, blue; the last component is unused.
    pub colour: [u8; 4],
}

/// Boxes of elements.
#[derive(Clone, Debug, Default)]
pub struct Boxes {
    /// Vertices.
    pub vertices: Vec<BoxVertex>,
    /// Vertex indices, three per triangle.
    pub indices: Vec<u32>,
    /// Axis and side of the last cut, by body and piece.
    sides: Vec<Vec<(usize, f32)>>,
}

impl Boxes {
    /// Removes all boxes.
    pub fn clear(&mut self) {
        self.vertices.clear();
        self.indices.clear();
    }

    /// Adds the visible elements of the body at index `place` of the world. Elements with a centre in front
    /// of the cut are left out.
    pub fn add(
        &mut self,
        place: usize,
        body: &SoftBody<Dim3>,
        palette: &Palette,
        colour: ElementColour,
        ages: &[f32],
        cut: Option<Cut>,
    ) {
        if self.sides.len() <= place {
            self.sides.resize(place + 1, Vec::new());
        }
        let sides = &mut self.sides[place];
        let planes = cut.map_or(Vec::new(), |cut| planes(body, cut, sides));
        *sides = planes
            .iter()
            .map(|plane| (plane.axis, plane.side))
            .collect();
        let mut forms: Vec<(u8, u8, Vec<ElementFace>)> = Vec::new();
        for (id, element) in body.mesh().elements() {
            let bare = body.bare_faces(id);
            let width = element.cell.width() as f32;
            let piece = body.pieces().of_node(element.nodes[0]).index();
            let middle = Vec3::from(element.cell.at.map(|k| k as f32 + 0.5)) * width;
            let depth = planes
                .get(piece)
                .map_or(f32::MAX, |plane| plane.depth(middle));
            let is_at_cut = depth < DEEP * width;
            if depth < 0.0 || bare == 0 && !is_at_cut {
                continue;
            }
            let view = match element.cell.level {
                0 => small_view(body, id, element, colour),
                _ => body.element_view(id).expect("the element is in the mesh"),
            };
            let form = (element.cell.level.min(1), element.children);
            let known = forms.iter().position(|known| (known.0, known.1) == form);
            let place = known.unwrap_or_else(|| {
                forms.push((form.0, form.1, faces::<Dim3>(form.0, form.1)));
                forms.len() - 1
            });
            let shown = bytes(colour_of(&view, palette, colour, ages), 1.0);
            let (centre, share) = (view.slots[13], GAP / width);
            let shrunk = view.slots.map(|at| at.lerp(centre, share));
            for (number, face) in forms[place].2.iter().enumerate() {
                // Only elements of level 0 have bare faces. Such an element is one voxel, so bit `number` of
                // `bare` belongs to its face `number`.
                if is_at_cut || bare >> number & 1 == 1 {
                    self.add_quad(&shrunk, face, shown);
                }
            }
        }
    }

    fn add_quad(&mut self, places: &[Vec3; 27], face: &ElementFace, colour: [u8; 4]) {
        let first = self.vertices.len() as u32;
        for (k, &slot) in face.slots.iter().enumerate() {
            let at = places[slot];
            // Side k runs from corner k to the next corner.
            let is_on = |side: usize| side == k || (side + 1) % 4 == k;
            let is_line = |side: usize| face.is_edge[side] && is_on(side);
            let sides = [0, 1, 2, 3].map(|side| if is_line(side) { 0 } else { 255 });
            self.vertices.push(BoxVertex { at, sides, colour });
        }
        self.indices.extend([0, 1, 2, 0, 2, 3].map(|k| first + k));
    }
}

/// Returns the drawn part of [`SoftBody::element_view`] for an element of level 0: corners, centre and colour
/// data. Leaving out the other slots is faster, and most elements have level 0.
fn small_view(
    body: &SoftBody<Dim3>,
    id: ElementId,
    element: &Element,
    colour: ElementColour,
) -> ElementView {
    let mut slots = [Vec3::ZERO; 27];
    let corners: [Vec3; 8] = std::array::from_fn(|k| body.positions()[element.nodes[k]].xyz());
    for (k, &at) in corners.iter().enumerate() {
        slots[slot_index(scale(corner(k), 2))] = at;
    }
    slots[13] = corners.iter().sum::<Vec3>() / 8.0;
    ElementView {
        id,
        level: 0,
        piece: body.pieces().of_element(id),
        material: 0,
        children: element.children,
        strain: match colour {
            ElementColour::Level => 0.0,
            ElementColour::Strain => body.strain(id).unwrap_or(0.0),
        },
        slots,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fuwafuwa::{Material, RigidBody, Shape, VoxelGrid, World, WorldConfig};

    #[test]
    fn small_view_matches_element_view() {
        let mut world = World::<Dim3>::new(WorldConfig::default()).unwrap();
        let grid = VoxelGrid::<Dim3>::ball(12, 1.0).unwrap();
        let soft = world
            .add_soft_body(SoftBody::new(grid, &[Material::default()]).unwrap())
            .unwrap();
        let hand = RigidBody::coupled(Shape::ball(0.3)).at(Vec3::new(0.5, 1.3, 0.5));
        let hand = world.add_rigid_body(hand).unwrap();
        let floor = Shape::half_space(Vec3::Y, Vec3::ZERO);
        world.add_rigid_body(RigidBody::fixed(floor)).unwrap();
        for _ in 0..40 {
            let target = Vec3::new(0.5, 0.8, 0.4);
            world.set_target_position(hand, target).unwrap();
            world.step();
        }
        let body = &world[soft];
        let mut most = 0.0f32;
        for (id, element) in body.mesh().elements().filter(|(_, of)| of.cell.level == 0) {
            let exact = body.element_view(id).unwrap();
            let small = small_view(body, id, element, ElementColour::Strain);
            for slot in (0..8).map(|k| slot_index(scale(corner(k), 2))).chain([13]) {
                assert!(small.slots[slot].distance(exact.slots[slot]) < 1e-5);
            }
            assert_eq!(small.strain, exact.strain);
            most = most.max(exact.strain);
        }
        assert!(most > 0.15, "{most}");
    }

    #[test]
    fn boxes_fill_the_uncut_part_in_any_orientation() {
        let grid = VoxelGrid::<Dim3>::cube(8, 1.0).unwrap();
        let mut world = World::<Dim3>::new(WorldConfig::default()).unwrap();
        let soft = world
            .add_soft_body(SoftBody::new(grid, &[Material::default()]).unwrap())
            .unwrap();
        let volume = |world: &World<Dim3>, share: f32| {
            let direction = Vec3::new(0.6, 0.0, 0.8);
            let (palette, cut) = (Palette::candy(), Some(Cut { direction, share }));
            let mut boxes = Boxes::default();
            boxes.add(0, &world[soft], &palette, ElementColour::Level, &[], cut);
            let at = |k: &u32| boxes.vertices[*k as usize].at;
            let triangles = boxes.indices.chunks(3);
            let triangles = triangles.map(|t| (at(&t[0]), at(&t[1]), at(&t[2])));
            let volume = triangles
                .map(|(a, b, c): (Vec3, Vec3, Vec3)| a.dot(b.cross(c)))
                .sum::<f32>()
                / 6.0;
            let vertices = boxes.vertices.iter();
            let front = vertices.map(|vertex| vertex.at.dot(direction));
            (volume, front.fold(f32::MIN, f32::max))
        };
        // The gaps between boxes make the drawn volume smaller than half of the body.
        let (half, front) = volume(&world, 0.5);
        assert!(
            (0.44..0.5).contains(&half) && front < 1.01,
            "{half} {front}"
        );
        assert!((0.84..0.97).contains(&volume(&world, 1.0).0));
        assert_eq!(volume(&world, 0.0).0, 0.0);
        // Rotates the body onto its side and moves it away.
        let body = world.soft_body_mut(soft).unwrap();
        let ids: Vec<_> = body.mesh().nodes().map(|(id, _)| id).collect();
        for id in ids {
            let [x, y, z] = body.node_state(id).0.to_array();
            let place = Vec3::new(1.0 - y + 5.0, z, 1.0 - x);
            body.set_node_state(id, place, Vec3::ZERO).unwrap();
        }
        let (half, front) = volume(&world, 0.5);
        assert!(
            (0.44..0.5).contains(&half) && front < 3.0 + 1.01,
            "{half} {front}"
        );
    }
}
