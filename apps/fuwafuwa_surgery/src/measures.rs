//! What is noted of a procedure, tick by tick, and what it comes to.

use crate::tools::Tool;
use fuwafuwa::{Dim3, SoftBody, Vector};

/// What was measured in a tick.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct Sample {
    /// What was held.
    pub tool: Tool,
    /// Where it was [m].
    pub at: Vector,
    /// Mean force of the tissue on it [N].
    pub force: Vector,
    /// The strongest force within the tick [N].
    pub peak: f32,
    /// Mean torque on it about where it works [N m].
    pub torque: Vector,
    /// All that was cut so far [m²].
    pub area: f64,
    /// What the knife did on the tissue for that so far [J].
    pub work: f64,
    /// How far the knife went within tissue, so far [m].
    pub path: f64,
    /// Nodes that came apart so far, by the knife or by pulling.
    pub released: u32,
    /// Pieces that there are.
    pub pieces: u32,
    /// Whether tissue is gripped.
    pub grips: bool,
}

/// A piece of the organ.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Its volume at rest [ml].
    pub millilitres: f64,
    /// The same by material, number 1 first.
    pub by_material: Vec<f64>,
}

/// The pieces of an organ by volume, the largest first; `voxel` is the volume of a voxel [ml].
pub fn parts(body: &SoftBody<Dim3>, voxel: f64) -> Vec<Part> {
    let materials = body.materials().len();
    let none = Part {
        millilitres: 0.0,
        by_material: vec![0.0; materials],
    };
    let mut parts = vec![none; body.pieces().list.len()];
    let mesh = body.mesh();
    for (id, element) in mesh.elements() {
        // Of each child that it fills; at level 0 there is one voxel and no child.
        let voxels = match element.cell.level {
            0 => 1,
            level => element.children.count_ones() << (3 * (u32::from(level) - 1)),
        };
        let volume = f64::from(voxels) * voxel;
        let part = &mut parts[body.pieces().of_element(id).index()];
        part.millilitres += volume;
        let material = body.grid().material(mesh.first_voxel(element));
        part.by_material[usize::from(material) - 1] += volume;
    }
    parts.retain(|part| part.millilitres > 0.0);
    parts.sort_by(|a, b| b.millilitres.total_cmp(&a.millilitres));
    parts
}

/// How many pieces an organ has: those that are not empty.
pub fn pieces(body: &SoftBody<Dim3>) -> u32 {
    let list = &body.pieces().list;
    list.len() as u32
}

/// How large a force or a torque is.
pub fn size(vector: Vector) -> f32 {
    fuwafuwa::vector::length(vector)
}
