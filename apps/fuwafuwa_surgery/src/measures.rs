//! Measurements of each tick of a procedure, and volumes of the pieces.

use crate::tools::Tool;
use fuwafuwa::{Dim3, SoftBody, Vec3};

/// Measurements of a tick.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct Sample {
    /// Tool in the hand.
    pub tool: Tool,
    /// Position of the tool [m].
    pub at: Vec3,
    /// Mean force of the tissue on the tool [N].
    pub force: Vec3,
    /// Peak force within the tick [N].
    pub peak: f32,
    /// Mean torque on the tool about its working point [N m].
    pub torque: Vec3,
    /// Total cut area since the start [m²].
    pub area: f64,
    /// Total work of the knife for all cuts since the start [J].
    pub work: f64,
    /// Total path of the knife within tissue since the start [m].
    pub path: f64,
    /// Total number of nodes split since the start, by the knife or by pulling.
    pub released: u32,
    /// Number of pieces.
    pub pieces: u32,
    /// Whether the forceps hold tissue.
    pub grips: bool,
}

/// Returns the largest force on the tool that two of three successive ticks reach [N].
/// A force that acts for a single tick does not count, because such a spike is an artefact of contacts that begin
/// and end with whole voxels. 0 for fewer than three samples.
pub fn strongest_force(samples: &[Sample]) -> f32 {
    let median = |some: &[Sample]| {
        let mut forces = [0, 1, 2].map(|k: usize| some[k].force.length());
        forces.sort_by(f32::total_cmp);
        forces[1]
    };
    samples.windows(3).map(median).fold(0.0, f32::max)
}

/// Volume of a piece of the organ.
#[derive(Clone, Debug, PartialEq)]
pub struct PieceVolume {
    /// Rest volume [ml].
    pub millilitres: f64,
    /// Rest volume by material, starting at number 1 [ml].
    pub by_material: Vec<f64>,
}

/// Returns the pieces of an organ, largest first. `voxel` is the volume of a voxel [ml].
pub fn parts(body: &SoftBody<Dim3>, voxel: f64) -> Vec<PieceVolume> {
    let materials = body.materials().len();
    let none = PieceVolume {
        millilitres: 0.0,
        by_material: vec![0.0; materials],
    };
    let mut parts = vec![none; body.pieces().list.len()];
    let mesh = body.mesh();
    for (id, element) in mesh.elements() {
        // Number of voxels in the element. Each child of a cell has 8^(level − 1) voxels; an element of level
        // 0 is one voxel without children.
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

/// Returns the number of pieces of an organ.
pub fn pieces(body: &SoftBody<Dim3>) -> u32 {
    let list = &body.pieces().list;
    list.len() as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    fn samples(forces: &[f32]) -> Vec<Sample> {
        let sample = |&force: &f32| Sample {
            force: Vec3::new(0.0, force, 0.0),
            ..Sample::default()
        };
        forces.iter().map(sample).collect()
    }

    #[test]
    fn strongest_force_ignores_a_spike_of_one_tick() {
        for (forces, expected) in [
            (&[1.0, 1.0, 9.0, 1.0, 2.0][..], 2.0),
            (&[0.0, 5.0, 0.0, 0.0], 0.0),
            (&[0.0, 5.0, 4.0, 0.0], 4.0),
            (&[1.0, 3.0, 3.0, 3.0, 2.0], 3.0),
            (&[7.0, 7.0], 0.0),
            (&[], 0.0),
        ] {
            assert_eq!(strongest_force(&samples(forces)), expected, "{forces:?}");
        }
    }
}
