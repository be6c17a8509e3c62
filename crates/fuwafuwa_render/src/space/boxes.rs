//! Elements as boxes that have gone out of shape with them.

use super::camera::Cut;
use crate::elements::colour_of;
use crate::frame::ElementColour;
use crate::theme::{Theme, bytes};
use bytemuck::{Pod, Zeroable};
use fuwafuwa::dim::{add, corner, scale};
use fuwafuwa::stencil::slot_index;
use fuwafuwa::vector::{dot, length, minus, plus, scaled, three};
use fuwafuwa::view::face_corners;
use fuwafuwa::{Body, Dim3, ElementView, Vector};

/// How far a box stays inside its element [voxels]: so neighbours are told apart.
const GAP: f32 = 0.03;
/// An element whose middle is so far behind the cut, in its own widths, has all its neighbours.
const DEEP: f32 = 2.2;
/// What is thinner has no inside to be looked into [voxels].
const THIN: f32 = 6.0;

/// A corner of a triangle of the element view.
#[repr(C)]
#[derive(Copy, Clone, Debug, PartialEq, Pod, Zeroable)]
pub struct BoxVertex {
    /// Where [m].
    pub at: Vector,
    /// How far it is from the four sides of its quad, 255 being the width of the quad; 255 also from
    /// a side behind which the element goes on.
    pub sides: [u8; 4],
    /// Red, green, blue; the last one says nothing.
    pub colour: [u8; 4],
}

/// Boxes of elements.
#[derive(Clone, Debug, Default)]
pub struct Boxes {
    /// Corners.
    pub vertices: Vec<BoxVertex>,
    /// Three to a triangle.
    pub indices: Vec<u32>,
}

/// The faces of a block of an element: corners of its slots, and which sides are edges.
type Quads = Vec<([usize; 4], [bool; 4])>;

impl Boxes {
    /// Forgets all boxes.
    pub fn clear(&mut self) {
        self.vertices.clear();
        self.indices.clear();
    }

    /// Adds the elements of a body whose middle is not cut off, as far as something of them can be seen.
    pub fn add(
        &mut self,
        body: &Body<Dim3>,
        theme: &Theme,
        colour: ElementColour,
        ages: &[f32],
        cut: Option<Cut>,
    ) {
        let planes = cut.map_or(Vec::new(), |cut| planes(body, cut));
        let mut quads: Vec<(u8, u8, Quads)> = Vec::new();
        for (id, element) in body.mesh().elements() {
            let bare = body.bare_faces(id);
            let width = element.cell.width() as f32;
            let piece = body.pieces().of_node(element.nodes[0]) as usize;
            let middle = element.cell.at.map(|k| (k as f32 + 0.5) * width);
            let depth = planes
                .get(piece)
                .map_or(f32::MAX, |plane| plane.depth(middle));
            let is_at_cut = depth < DEEP * width;
            if depth < 0.0 || bare == 0 && !is_at_cut {
                continue;
            }
            let Some(view) = body.element_view(id) else {
                continue;
            };
            let form = (element.cell.level.min(1), element.children);
            let known = quads.iter().position(|known| (known.0, known.1) == form);
            let place = known.unwrap_or_else(|| {
                quads.push((form.0, form.1, quads_of(form.0, form.1)));
                quads.len() - 1
            });
            let shown = bytes(colour_of(&view, theme, colour, ages), 1.0);
            let shrunk = 1.0 - GAP / element.cell.width() as f32;
            for (face, quad) in quads[place].2.iter().enumerate() {
                // At level 0 quads go by faces.
                if is_at_cut || bare >> face & 1 == 1 {
                    self.add_quad(&view, quad, shrunk, shown);
                }
            }
        }
    }

    fn add_quad(
        &mut self,
        view: &ElementView,
        (slots, edges): &([usize; 4], [bool; 4]),
        shrunk: f32,
        colour: [u8; 4],
    ) {
        let first = self.vertices.len() as u32;
        let centre = view.slots[13];
        for (k, &slot) in slots.iter().enumerate() {
            let at = plus(centre, scaled(minus(view.slots[slot], centre), shrunk));
            // Side k leads from corner k to the next one.
            let is_on = |side: usize| side == k || (side + 1) % 4 == k;
            let sides = [0, 1, 2, 3].map(|side| if edges[side] && is_on(side) { 0 } else { 255 });
            self.vertices.push(BoxVertex { at, sides, colour });
        }
        self.indices.extend([0, 1, 2, 0, 2, 3].map(|k| first + k));
    }
}

/// Where a piece is cut, in its body at rest [voxels].
#[derive(Copy, Clone, Debug)]
struct Plane {
    axis: usize,
    /// 1 or −1: on which side it is cut off.
    side: f32,
    /// Where, along the axis towards that side.
    at: f32,
}

impl Plane {
    /// How far a place at rest is behind it [voxels].
    fn depth(&self, rest: Vector) -> f32 {
        self.at - self.side * rest[self.axis]
    }
}

/// Where each piece of a body is cut.
fn planes(body: &Body<Dim3>, cut: Cut) -> Vec<Plane> {
    let nodes = || {
        body.mesh().nodes().map(|(id, node)| {
            let at = three(body.positions()[id as usize]);
            (
                body.pieces().of_node(id) as usize,
                at,
                node.at.map(|k| k as f32),
            )
        })
    };
    let none = ([f32::MAX; 3], [f32::MIN; 3], [0.0; 3], 0.0f32);
    let mut spans = vec![none; body.pieces().list.len()];
    for (piece, at, rest) in nodes() {
        let (low, high, sum, count) = &mut spans[piece];
        (0..3).for_each(|k| (low[k], high[k]) = (low[k].min(rest[k]), high[k].max(rest[k])));
        (*sum, *count) = (plus(*sum, at), *count + 1.0);
    }
    // By piece and axis: in which direction, more or less, the axis leads now.
    let mut axes = vec![[[0.0; 3]; 3]; spans.len()];
    for (piece, at, rest) in nodes() {
        let (low, high, sum, count) = spans[piece];
        let by = minus(at, scaled(sum, 1.0 / count));
        for k in 0..3 {
            let along = rest[k] - 0.5 * (low[k] + high[k]);
            axes[piece][k] = plus(axes[piece][k], scaled(by, along));
        }
    }
    let plane = |((low, high, ..), axes): ((Vector, Vector, _, _), [Vector; 3])| {
        let facing = axes.map(|axis| dot(axis, cut.towards) / length(axis).max(1e-12));
        let more = |a: &usize, b: &usize| facing[*a].abs().total_cmp(&facing[*b].abs());
        let axis = (0..3).max_by(more).unwrap_or(0);
        let side = 1.0f32.copysign(facing[axis]);
        let wide = high[axis] - low[axis];
        let first = (side * low[axis]).min(side * high[axis]);
        let share = if wide < THIN { 2.0 } else { cut.share };
        Plane {
            axis,
            side,
            at: first + share * wide,
        }
    };
    spans.into_iter().zip(axes).map(plane).collect()
}

/// The quads around what an element fills, those of a block in the order of its faces.
fn quads_of(level: u8, children: u8) -> Quads {
    let mut quads = Vec::new();
    let fills = |block: usize| level == 0 || children >> block & 1 == 1;
    for block in (0..8).filter(|&block| fills(block) && (level > 0 || block == 0)) {
        let (low, width) = match level {
            0 => ([0; 3], 2),
            _ => (corner(block), 1),
        };
        let slot = |vertex: usize| slot_index(add(low, scale(corner(vertex), width)));
        // The block beyond a face, if the element fills it; at level 0 there is none.
        let beyond = |block: usize, face: usize| {
            let is_inner = level > 0 && (block >> (face / 2) & 1) != face % 2;
            let other = block ^ 1 << (face / 2);
            (is_inner && fills(other)).then_some(other)
        };
        for face in 0..6 {
            if beyond(block, face).is_some() {
                continue;
            }
            let ring = face_corners::<Dim3>(face);
            let edges = [0, 1, 2, 3].map(|k| {
                // Both corners of a side are on the same end of the axis that leads across it.
                let (a, b) = (ring[k], ring[(k + 1) % 4]);
                let common = !(a ^ b) & 7 & !(1 << (face / 2));
                let axis = common.trailing_zeros() as usize;
                let across = beyond(block, 2 * axis + (a >> axis & 1));
                across.is_none_or(|other| beyond(other, face).is_some())
            });
            quads.push((ring.map(slot), edges));
        }
    }
    quads
}

#[cfg(test)]
mod tests {
    use super::*;
    use fuwafuwa::vector::cross;
    use fuwafuwa::{Material, Settings, VoxelGrid, World};

    #[test]
    fn quads_close_around_what_is_filled() {
        let edges = |quads: &Quads| {
            quads
                .iter()
                .flat_map(|quad| quad.1)
                .filter(|&is| is)
                .count()
        };
        let whole = quads_of(0, 255);
        assert_eq!((whole.len(), edges(&whole)), (6, 24));
        let large = quads_of(1, 255);
        assert_eq!((large.len(), edges(&large)), (24, 48));
        let corner = quads_of(1, 1);
        assert_eq!((corner.len(), edges(&corner)), (6, 24));
        let bar = quads_of(1, 3);
        assert_eq!((bar.len(), edges(&bar)), (10, 32));
    }

    #[test]
    fn boxes_fill_what_is_left_of_a_body_however_it_lies() {
        let grid = VoxelGrid::<Dim3>::cube(8, 1.0).unwrap();
        let mut world = World::<Dim3>::new(Settings::default()).unwrap();
        world.add_body(Body::new(grid, &[Material::default()]).unwrap());
        let volume = |world: &World<Dim3>, share: f32| {
            let towards = [0.6, 0.0, 0.8];
            let (theme, cut) = (Theme::candy(), Some(Cut { towards, share }));
            let mut boxes = Boxes::default();
            boxes.add(&world.bodies()[0], &theme, ElementColour::Level, &[], cut);
            let at = |k: &u32| boxes.vertices[*k as usize].at;
            let triangles = boxes.indices.chunks(3);
            let triangles = triangles.map(|t| (at(&t[0]), at(&t[1]), at(&t[2])));
            let volume = triangles.map(|(a, b, c)| dot(a, cross(b, c))).sum::<f32>() / 6.0;
            let front = boxes.vertices.iter().map(|vertex| dot(vertex.at, towards));
            (volume, front.fold(f32::MIN, f32::max))
        };
        // Gaps make boxes smaller.
        let (half, front) = volume(&world, 0.5);
        assert!(
            (0.44..0.5).contains(&half) && front < 1.01,
            "{half} {front}"
        );
        assert!((0.84..0.97).contains(&volume(&world, 1.0).0));
        assert_eq!(volume(&world, 0.0).0, 0.0);
        // It lies on its side, away from where it was.
        let body = world.body_mut(0);
        let ids: Vec<u32> = body.mesh().nodes().map(|(id, _)| id).collect();
        for id in ids {
            let [x, y, z] = body.node_state(id).0;
            body.set_node_state(id, [1.0 - y + 5.0, z, 1.0 - x], [0.0; 3]);
        }
        let (half, front) = volume(&world, 0.5);
        assert!(
            (0.44..0.5).contains(&half) && front < 3.0 + 1.01,
            "{half} {front}"
        );
    }
}
