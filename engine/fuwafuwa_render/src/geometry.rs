//! A 2D world as vertices: all CPU work before the GPU draws.

use crate::elements::ElementMesh;
use crate::frame::{Frame, Look};
use crate::palette::bytes;
use crate::rigid::RigidShapes;
use crate::rings::Outlines;
use crate::skin::SkinMesh;
use fuwafuwa::{Dim2, SoftBody, VoxelGrid, World};
use glam::Vec2;
use std::ops::Range;

/// Vertices of a 2D world. Keep the value between frames to reuse its buffers.
#[derive(Clone, Debug, Default)]
pub struct Geometry {
    pub(crate) skin: SkinMesh,
    pub(crate) bodies: Vec<BodyParts>,
    pub(crate) elements: ElementMesh,
    pub(crate) rigid: RigidShapes,
    /// Radius of a disc with the area of the largest body at rest [m].
    pub(crate) radius: f32,
    /// Bounding box of all bodies as low and high corner [m]. Without bodies low is above high.
    pub(crate) bounds: [Vec2; 2],
    rings: Outlines,
}

/// Index ranges of a body in the triangles of the skin.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyParts {
    /// Triangle fans of the outlines. The fans wind a non-zero number of times around each point inside the
    /// body.
    pub fan: Range<u32>,
    /// Quads that colour the inside: first the whole body, then the regions of other materials.
    pub cover: Range<u32>,
}

impl Geometry {
    /// Computes the vertices of a world.
    pub fn gather(&mut self, world: &World<Dim2>, frame: &Frame<'_>) {
        self.skin.clear();
        self.bodies.clear();
        self.elements.clear();
        self.rigid
            .gather(world, frame.palette, &frame.baskets, frame.particles);
        let radii = world.soft_bodies().map(|(_, body)| radius(body));
        self.radius = radii.fold(0.0, f32::max);
        self.bounds = NOWHERE;
        for (place, (_, body)) in world.soft_bodies().enumerate() {
            match frame.look {
                Look::Skin => self.add_skin(place, body, frame),
                Look::Elements {
                    colour,
                    ages,
                    nodes,
                } => {
                    let ages = ages.get(place).map_or(&[][..], Vec::as_slice);
                    self.elements.add(body, frame.palette, colour, ages, nodes);
                    let corners = self.elements.vertices.iter().map(|vertex| vertex.at);
                    self.bounds = corners.fold(self.bounds, around);
                }
            }
        }
    }

    /// Returns the number of vertices of bodies.
    pub fn vertex_count(&self) -> usize {
        self.skin.vertices.len() + self.elements.vertices.len()
    }

    fn add_skin(&mut self, place: usize, body: &SoftBody<Dim2>, frame: &Frame<'_>) {
        let numbers = frame.numbers(place, body);
        self.rings.trace(body);
        let start = self.skin.fans.len() as u32;
        self.skin.add(&self.rings, body.grid().voxel_size());
        let middle = self.skin.fans.len() as u32;
        let points = self.rings.points.iter().map(|point| point.at);
        let bounds = points.fold(NOWHERE, around);
        self.bounds = bounds.into_iter().fold(self.bounds, around);
        let colour = |number| bytes(frame.colour(number), 1.0);
        let is_tinted = !std::ptr::eq(numbers, body.grid());
        let first = match is_tinted || body.materials().len() > 1 {
            true => most_frequent(numbers),
            false => 1,
        };
        self.skin.add_rectangle(bounds, colour(first));
        if is_tinted {
            for view in body.element_views() {
                self.skin.add_tints(&view, body, numbers, first, colour);
            }
        } else if body.materials().len() > 1 {
            for view in body.element_views().filter(|view| view.material != first) {
                let colour = colour(view.material);
                self.skin.add_element(&view, colour);
            }
        }
        self.skin.add_strains(body);
        self.bodies.push(BodyParts {
            fan: start..middle,
            cover: middle..self.skin.fans.len() as u32,
        });
    }
}

/// Returns the most frequent material number of a grid, the lowest of equally frequent ones.
fn most_frequent(grid: &VoxelGrid<Dim2>) -> u8 {
    let mut counts = [0usize; 256];
    let numbers = grid.voxels().map(|voxel| grid.material(voxel));
    numbers.for_each(|number| counts[usize::from(number)] += 1);
    let most = (1..=u8::MAX).min_by_key(|&number| std::cmp::Reverse(counts[usize::from(number)]));
    most.unwrap_or(1)
}

fn radius(body: &SoftBody<Dim2>) -> f32 {
    let grid = body.grid();
    grid.voxel_size() * (grid.solid_count() as f32 / std::f32::consts::PI).sqrt()
}

const NOWHERE: [Vec2; 2] = [Vec2::MAX, Vec2::MIN];

/// Returns the smallest box that contains a given box and a point.
fn around([low, high]: [Vec2; 2], at: Vec2) -> [Vec2; 2] {
    [low.min(at), high.max(at)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::{Camera, Tints};
    use crate::palette::Palette;
    use fuwafuwa::{Material, WorldConfig};

    /// Returns the colour that is painted last at a point [m].
    fn colour_at(geometry: &Geometry, at: Vec2) -> [u8; 4] {
        let cover = &geometry.bodies[0].cover;
        let indices = &geometry.skin.fans[cover.start as usize..cover.end as usize];
        let mut colour = [0; 4];
        for triangle in indices.chunks(3) {
            let [a, b, c] = [0, 1, 2].map(|k| geometry.skin.vertices[triangle[k] as usize]);
            let is_left = |from: Vec2, to: Vec2| (to - from).perp_dot(at - from) >= 0.0;
            let is_inside = is_left(a.at, b.at) && is_left(b.at, c.at) && is_left(c.at, a.at);
            let has_area = (b.at - a.at).perp_dot(c.at - a.at) > 0.0;
            if is_inside && has_area && a.colour[3] > 0 {
                colour = a.colour;
            }
        }
        colour
    }

    #[test]
    fn tints_colour_voxels_within_large_elements() {
        const N: i32 = 16;
        let voxel = 1.0 / N as f32;
        // Colours by number: 2 is own, 3 of the palette. A stripe of 2 across the middle, 3 above, 1 below.
        let number = |[_, y, _]: [i32; 3]| match y {
            0..7 => 1,
            7 => 2,
            _ => 3,
        };
        let size = [N as usize, N as usize, 1];
        let whole = VoxelGrid::<Dim2>::from_fn(size, voxel, |_| 1).unwrap();
        let numbers = VoxelGrid::<Dim2>::from_fn(size, voxel, number).unwrap();
        let body = SoftBody::new(whole, &[Material::default()]).unwrap();
        assert!(body.element_views().any(|view| view.level > 0));
        let mut world = World::new(WorldConfig::default()).unwrap();
        world.add_soft_body(body).unwrap();
        let palette = Palette::candy();
        let camera = Camera::fit(Vec2::ZERO, Vec2::ONE, [64, 64]);
        let (colours, grids) = ([None, Some([10, 20, 30])], [Some(numbers.clone())]);
        let frame = Frame {
            tints: Tints {
                colours: &colours,
                grids: &grids,
            },
            ..Frame::new(camera, &palette)
        };
        let mut geometry = Geometry::default();
        geometry.gather(&world, &frame);
        for at in numbers.voxels() {
            let expected = match number(at) {
                2 => [10, 20, 30, 255],
                other => bytes(palette.material(other), 1.0),
            };
            let [x, y, _] = at.map(|k| (k as f32 + 0.45) * voxel);
            assert_eq!(colour_at(&geometry, Vec2::new(x, y)), expected, "{at:?}");
        }
        // Beyond the lower side, which the skin may smooth, the colour goes on.
        let beyond = colour_at(&geometry, Vec2::new(0.5, -0.4 * voxel));
        assert_eq!(beyond, bytes(palette.material(1), 1.0));
        // A grid of another size belongs to another body.
        let other = [Some(VoxelGrid::<Dim2>::ball(8, 1.0).unwrap())];
        let frame = Frame {
            tints: Tints {
                colours: &colours,
                grids: &other,
            },
            ..Frame::new(camera, &palette)
        };
        geometry.gather(&world, &frame);
        let found = colour_at(&geometry, Vec2::splat(0.52));
        assert_eq!(found, bytes(palette.material(1), 1.0));
    }
}
