//! Elements of 2D bodies as coloured quads with outlines.

use crate::frame::ElementColour;
use crate::palette::{Colour, Palette, bytes, mix};
use bytemuck::{Pod, Zeroable};
use fuwafuwa::inspect::slot_index;
use fuwafuwa::inspect::{ElementFace, blocks, faces};
use fuwafuwa::inspect::{add, corner, scale};
use fuwafuwa::{Dim2, ElementView, SoftBody};
use glam::Vec2;

/// Duration of an element's flash after it was remodelled [s].
const FLASH: f32 = 0.4;

/// Vertex of the element view.
#[repr(C)]
#[derive(Copy, Clone, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct ElementVertex {
    /// Position [m], before the shader adds `across`.
    pub at: Vec2,
    /// Offset that gives a line its thickness [px].
    pub across: Vec2,
    /// Distance of the vertex from the line's centre, then half the line width [px].
    pub line: [f32; 2],
    /// Colour and opacity.
    pub colour: [u8; 4],
}

/// Triangles of the element view.
#[derive(Clone, Debug)]
pub struct ElementMesh {
    /// Vertices.
    pub vertices: Vec<ElementVertex>,
    /// Vertex indices, three per triangle.
    pub indices: Vec<u32>,
    /// Faces of an element of level 1 or higher, indexed by the mask of the children that it fills.
    faces: [Vec<ElementFace>; 16],
    /// Faces of an element of level 0, which is a single voxel.
    whole: Vec<ElementFace>,
}

impl Default for ElementMesh {
    fn default() -> Self {
        Self {
            vertices: Vec::new(),
            indices: Vec::new(),
            faces: std::array::from_fn(|mask| faces::<Dim2>(1, mask as u8)),
            whole: faces::<Dim2>(0, 15),
        }
    }
}

impl ElementMesh {
    /// Removes all triangles.
    pub fn clear(&mut self) {
        self.vertices.clear();
        self.indices.clear();
    }

    /// Adds the elements of a body, then their edges, then (if `nodes`) their nodes.
    pub fn add(
        &mut self,
        body: &SoftBody<Dim2>,
        palette: &Palette,
        colour: ElementColour,
        ages: &[f32],
        nodes: bool,
    ) {
        let views: Vec<ElementView> = body.element_views().collect();
        for view in &views {
            self.add_fill(view, bytes(colour_of(view, palette, colour, ages), 1.0));
        }
        for view in &views {
            // Larger elements have bolder lines, so that levels can be told apart without colours.
            let level = f32::from(view.level.min(4));
            self.add_edges(
                view,
                0.4 + 0.25 * level,
                bytes(palette.ink, 0.45 + 0.12 * level),
            );
        }
        if nodes {
            let ink = bytes(palette.ink, 1.0);
            for (id, _) in body.mesh().nodes() {
                let at = body.node_state(id).0;
                self.add_line(at, at, 1.8, ink);
            }
        }
    }

    /// Adds the filled area of an element, without its edges.
    pub fn add_fill(&mut self, view: &ElementView, colour: [u8; 4]) {
        for round in fills(view) {
            let first = self.vertices.len() as u32;
            self.vertices.extend(round.map(|at| ElementVertex {
                at,
                across: Vec2::ZERO,
                line: [0.0, 1e6],
                colour,
            }));
            self.indices.extend([0, 1, 2, 0, 2, 3].map(|k| first + k));
        }
    }

    fn add_edges(&mut self, view: &ElementView, half: f32, colour: [u8; 4]) {
        let count = self.faces_of(view).len();
        for k in 0..count {
            let [from, to, ..] = self.faces_of(view)[k].slots;
            let [from, to] = [from, to].map(|slot| view.slots[slot].truncate());
            self.add_line(from, to, half, colour);
        }
    }

    fn faces_of(&self, view: &ElementView) -> &[ElementFace] {
        match view.level {
            0 => &self.whole,
            _ => &self.faces[usize::from(view.children & 15)],
        }
    }

    /// Adds a line with square ends; adds a square if `from` equals `to`.
    fn add_line(&mut self, from: Vec2, to: Vec2, half: f32, colour: [u8; 4]) {
        let along = (to - from).try_normalize().unwrap_or(Vec2::X);
        let first = self.vertices.len() as u32;
        let reach = half + 0.7;
        for (at, end, side) in [
            (from, -1.0, -1.0),
            (to, 1.0, -1.0),
            (to, 1.0, 1.0),
            (from, -1.0, 1.0),
        ] {
            self.vertices.push(ElementVertex {
                at,
                across: side * reach * along.perp() + end * half * along,
                line: [side * reach, half],
                colour,
            });
        }
        self.indices.extend([0, 1, 2, 0, 2, 3].map(|k| first + k));
    }
}

/// Returns the colour of an element. It flashes white for [`FLASH`] seconds after it was remodelled.
pub fn colour_of(
    view: &ElementView,
    palette: &Palette,
    colour: ElementColour,
    ages: &[f32],
) -> Colour {
    let plain = match colour {
        ElementColour::Level => palette.level(view.level),
        ElementColour::Strain => palette.strain(view.strain),
    };
    let age = ages.get(view.id.index()).copied().unwrap_or(FLASH);
    let flash = 0.65 * (1.0 - age / FLASH).clamp(0.0, 1.0);
    mix(plain, [1.0; 3], flash)
}

/// Returns the quads that an element covers [m], counterclockwise.
pub fn fills(view: &ElementView) -> impl Iterator<Item = [Vec2; 4]> + '_ {
    blocks::<Dim2>(view.level, view.children).map(|(low, width)| {
        [0, 1, 3, 2].map(|vertex| {
            let at = add(low, scale(corner(vertex), width));
            view.slots[slot_index(at)].truncate()
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use fuwafuwa::{Material, VoxelGrid};

    #[test]
    fn fills_of_a_disc_have_the_disc_area() {
        let grid = VoxelGrid::<Dim2>::ball(32, 1.0).unwrap();
        let voxels = grid.solid_count() as f32;
        let body = SoftBody::new(grid, &[Material::default()]).unwrap();
        let mut mesh = ElementMesh::default();
        for view in body.element_views() {
            mesh.add_fill(&view, [0; 4]);
        }
        let at = |index: u32| mesh.vertices[index as usize].at;
        let areas = mesh
            .indices
            .chunks(3)
            .map(|t| 0.5 * (at(t[1]) - at(t[0])).perp_dot(at(t[2]) - at(t[0])));
        assert!((areas.sum::<f32>() - voxels / 1024.0).abs() < 1e-4);
    }

    #[test]
    fn element_flashes_only_while_young() {
        let grid = VoxelGrid::<Dim2>::from_fn([1, 1, 1], 1.0, |_| 1).unwrap();
        let body = SoftBody::new(grid, &[Material::default()]).unwrap();
        let palette = Palette::candy();
        let colour = |age: f32| {
            let mut mesh = ElementMesh::default();
            mesh.add(&body, &palette, ElementColour::Level, &[age], false);
            mesh.vertices[0].colour
        };
        assert_eq!(colour(9.0), bytes(palette.level(0), 1.0));
        assert!(colour(0.0)[2] > colour(9.0)[2]);
    }
}
