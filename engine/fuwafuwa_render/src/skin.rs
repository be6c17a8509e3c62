//! Triangles that fill the outlines of pieces, and bands along them.

use crate::elements::fills;
use crate::rings::{Outlines, sides, strain};
use bytemuck::{Pod, Zeroable};
use fuwafuwa::inspect::slot_index;
use fuwafuwa::inspect::{add, blocks, corner, scale};
use fuwafuwa::{Dim, Dim2, ElementView, SoftBody, VoxelGrid};
use glam::Vec2;

/// Maximum area of a piece that counts as a crumb [areas of a voxel].
const CRUMB: f32 = 14.0;

/// Vertex of the skin.
#[repr(C)]
#[derive(Copy, Clone, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct SkinVertex {
    /// Position [m].
    pub at: Vec2,
    /// Colour and opacity.
    pub colour: [u8; 4],
    /// Thickness (0 on the outline), freshness (255 on torn surfaces), strain, and the blending weight of
    /// these three; each 0 to 255.
    pub relief: [u8; 4],
}

/// Triangles of the skin, with separate index lists for fans and bands.
#[derive(Clone, Debug, Default)]
pub struct SkinMesh {
    /// Vertices.
    pub vertices: Vec<SkinVertex>,
    /// Triangle fans of the outlines. Pixels with a non-zero winding number are inside. The fans of each body
    /// are followed by the quads that colour it.
    pub fans: Vec<u32>,
    /// Bands along the inner side of the outlines.
    pub bands: Vec<u32>,
}

impl SkinMesh {
    /// Removes all triangles.
    pub fn clear(&mut self) {
        self.vertices.clear();
        self.fans.clear();
        self.bands.clear();
    }

    /// Adds the triangle fans and bands of a body's outlines. `voxel` is the voxel size of the body [m].
    pub fn add(&mut self, rings: &Outlines, voxel: f32) {
        for span in &rings.spans {
            let points = &rings.points[span.start..span.end];
            let pivot = self.vertices.len() as u32;
            let sum: Vec2 = points.iter().map(|point| point.at).sum();
            let middle = sum / points.len() as f32;
            self.vertices.push(SkinVertex {
                at: middle,
                ..SkinVertex::default()
            });
            // The bands of a crumb meet in its centre, so that all of the crumb looks torn.
            let is_crumb = (0.0..CRUMB * voxel * voxel).contains(&span.area);
            let count = points.len() as u32;
            for (k, point) in points.iter().enumerate() {
                let torn = voxel * (0.9 + 0.9 * point.grain);
                let depth = 0.8 * voxel + (torn - 0.8 * voxel) * point.fresh;
                let (inner, share) = match is_crumb {
                    true => (middle, 110),
                    false => (point.at - depth * point.normal, 0),
                };
                let relief = [0, byte(point.fresh), byte(2.0 * point.strain), 255];
                self.vertices.push(SkinVertex {
                    at: point.at,
                    relief,
                    ..SkinVertex::default()
                });
                self.vertices.push(SkinVertex {
                    at: inner,
                    relief: [255, relief[1], relief[2], share],
                    ..SkinVertex::default()
                });
                let outer = |k: u32| pivot + 1 + 2 * (k % count);
                let (here, next) = (outer(k as u32), outer(k as u32 + 1));
                self.fans.extend([pivot, here, next]);
                self.bands
                    .extend([here, here + 1, next, next, here + 1, next + 1]);
            }
        }
    }

    /// Adds a rectangle of one colour.
    pub fn add_rectangle(&mut self, [low, high]: [Vec2; 2], colour: [u8; 4]) {
        let round = [
            low,
            Vec2::new(high.x, low.y),
            high,
            Vec2::new(low.x, high.y),
        ];
        self.add_quad(round, colour, 0.0);
    }

    /// Adds the area that an element covers.
    pub fn add_element(&mut self, view: &ElementView, colour: [u8; 4]) {
        for round in fills(view) {
            self.add_quad(round, colour, 0.0);
        }
    }

    /// Adds the colours of the voxels that an element covers, except where they have the number `first`.
    /// `numbers` has the number of each voxel. Towards empty voxels, colours extend by a voxel, because the
    /// outline is smoothed. Stair steps between two colours are cut at 45°.
    pub fn add_tints(
        &mut self,
        view: &ElementView,
        body: &SoftBody<Dim2>,
        numbers: &VoxelGrid<Dim2>,
        first: u8,
        colour: impl Fn(u8) -> [u8; 4],
    ) {
        let Some(element) = body.mesh().element(view.id) else {
            return;
        };
        let cell = element.cell;
        for ((low, width), corners) in blocks::<Dim2>(view.level, view.children).zip(fills(view)) {
            // Corners of blocks are given in half widths of the cell.
            let side = width * cell.width() / 2;
            let start = add(scale(cell.at, 2), low).map(|k| k * cell.width() / 2);
            let place = |[x, y]: [f32; 2]| {
                let [u, v] = [x, y].map(|k| k / side as f32);
                let [a, b, c, d] = corners;
                a.lerp(b, u).lerp(d.lerp(c, u), v)
            };
            for y in 0..side {
                for x in 0..side {
                    let voxel = [start[0] + x, start[1] + y, 0];
                    let corner = [x as f32, y as f32];
                    self.add_tint(numbers, voxel, first, &colour, |[u, v]| {
                        place([corner[0] + u, corner[1] + v])
                    });
                }
            }
        }
    }

    /// Adds the colour of a voxel. `place` returns the position [m] of a point of the voxel, 0 to 1 on both
    /// axes.
    fn add_tint(
        &mut self,
        numbers: &VoxelGrid<Dim2>,
        voxel: [i32; 3],
        first: u8,
        colour: &impl Fn(u8) -> [u8; 4],
        place: impl Fn([f32; 2]) -> Vec2,
    ) {
        let near = |[dx, dy]: [i32; 2]| numbers.material([voxel[0] + dx, voxel[1] + dy, 0]);
        let own = near([0, 0]);
        let beside = [[1, 0], [0, 1], [-1, 0], [0, -1]].map(near);
        if own != first {
            let beyond = beside.map(|number| if number == 0 { 1.0 } else { 0.0 });
            let [right, up, left, down] = beyond;
            let round = [
                [-left, -down],
                [1.0 + right, -down],
                [1.0 + right, 1.0 + up],
                [-left, 1.0 + up],
            ];
            self.add_quad(round.map(&place), colour(own), 0.0);
        }
        for k in 0..4 {
            let [here, next, after, last] = [0, 1, 2, 3].map(|by| beside[(k + by) % 4]);
            let is_step = here == next && here != own && here != 0 && after != here && last != here;
            if is_step {
                // Corner between the sides `k` and `k + 1`, and the middles of these sides.
                let turn = |[u, v]: [f32; 2]| (0..k).fold([u, v], |[u, v], _| [1.0 - v, u]);
                let [from, corner, to] = [[1.0, 0.5], [1.0, 1.0], [0.5, 1.0]].map(turn).map(&place);
                self.add_quad([from, corner, to, to], colour(here), 0.0);
            }
        }
    }

    /// Adds the strain of the large elements of a body, without changing their colour.
    pub fn add_strains(&mut self, body: &SoftBody<Dim2>) {
        let (mesh, voxel) = (body.mesh(), body.grid().voxel_size());
        for (_, element) in mesh.elements() {
            if element.cell.level == 0 || element.children != Dim2::ALL_CORNERS {
                continue;
            }
            let slots = &mesh.element_class(element).slots;
            let corners = [0, 1, 2, 3].map(|index| {
                let slot = slot_index(scale(corner(index), 2)) as u8;
                let place = slots.iter().position(|&known| known == slot)?;
                Some(body.node_state(element.nodes[place]).0)
            });
            let [Some(a), Some(b), Some(c), Some(d)] = corners else {
                continue;
            };
            let (right, up) = sides([a, b, c, d]);
            let strain = strain(right, up, voxel * element.cell.width() as f32);
            self.add_quad([a, b, d, c], [0; 4], strain);
        }
    }

    fn add_quad(&mut self, round: [Vec2; 4], colour: [u8; 4], strain: f32) {
        let first = self.vertices.len() as u32;
        let relief = [255, 0, byte(2.0 * strain), 255];
        self.vertices
            .extend(round.map(|at| SkinVertex { at, colour, relief }));
        self.fans.extend([0, 1, 2, 0, 2, 3].map(|k| first + k));
    }
}

fn byte(share: f32) -> u8 {
    (share.clamp(0.0, 1.0) * 255.0) as u8
}

#[cfg(test)]
mod tests {
    use super::*;
    use fuwafuwa::{Material, VoxelGrid};

    #[test]
    fn fans_enclose_the_area_of_the_curves() {
        let grid = VoxelGrid::ball(16, 1.0).unwrap();
        let body = SoftBody::new(grid, &[Material::default()]).unwrap();
        let mut rings = Outlines::default();
        rings.trace(&body);
        let enclosed: f32 = rings.spans.iter().map(|span| span.area).sum();
        let mut mesh = SkinMesh::default();
        mesh.add(&rings, 1.0 / 16.0);
        let at = |index: u32| mesh.vertices[index as usize].at;
        let areas = mesh.fans.chunks(3).map(|t| {
            let [a, b, c] = [at(t[0]), at(t[1]), at(t[2])];
            0.5 * (b - a).perp_dot(c - a)
        });
        assert!((areas.sum::<f32>() - enclosed).abs() < 1e-4);
    }
}
