//! A 2D world as vertices: all CPU work before the GPU draws.

use crate::elements::ElementMesh;
use crate::frame::{Frame, Look};
use crate::palette::bytes;
use crate::rest::Rest;
use crate::rigid::RigidShapes;
use crate::rings::Outlines;
use crate::skin::SkinMesh;
use fuwafuwa::{Dim2, SoftBody, World};
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
    rests: Vec<Rest>,
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
        let basket = frame.basket.as_ref();
        self.rigid
            .gather(world, frame.palette, basket, frame.particles);
        let radii = world.soft_bodies().map(|(_, body)| radius(body));
        self.radius = radii.fold(0.0, f32::max);
        self.bounds = NOWHERE;
        self.rests
            .resize_with(world.soft_bodies().count(), Rest::default);
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
        let rest = &mut self.rests[place];
        if !rest.matches_grid(body.grid()) {
            *rest = Rest::new(body.grid());
        }
        self.rings.trace(body, rest);
        let start = self.skin.fans.len() as u32;
        self.skin.add(&self.rings, body.grid().voxel_size());
        let middle = self.skin.fans.len() as u32;
        let points = self.rings.points.iter().map(|point| point.at);
        let bounds = points.fold(NOWHERE, around);
        self.bounds = bounds.into_iter().fold(self.bounds, around);
        let first = rest.first_material();
        let colour = |number| bytes(frame.palette.material(number), 1.0);
        self.skin.add_rectangle(bounds, colour(first));
        if body.materials().len() > 1 {
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

fn radius(body: &SoftBody<Dim2>) -> f32 {
    let grid = body.grid();
    grid.voxel_size() * (grid.solid_count() as f32 / std::f32::consts::PI).sqrt()
}

const NOWHERE: [Vec2; 2] = [Vec2::MAX, Vec2::MIN];

/// Returns the smallest box that contains a given box and a point.
fn around([low, high]: [Vec2; 2], at: Vec2) -> [Vec2; 2] {
    [low.min(at), high.max(at)]
}
