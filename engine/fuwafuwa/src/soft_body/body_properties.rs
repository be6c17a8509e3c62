//! Properties of a whole body, combined from the materials of its voxels.

use crate::foundation::dim::Dim;
use crate::material::Material;
use crate::topology::grid::VoxelGrid;

/// Properties of a whole body, combined from the materials of its voxels.
#[derive(Clone, Debug, Default)]
pub struct BodyProperties {
    /// Whether voxels have the material, by material number − 1.
    pub used: Vec<bool>,
    /// Mass damping [1/s]; `None` if it differs between the materials in use.
    pub mass_damping: Option<f32>,
    /// Friction coefficient; mean over the voxels.
    pub friction: f32,
    /// Rolling resistance of crumbs [1/s]; mean over the voxels.
    pub rolling_resistance: f32,
    /// Lowest strength of the materials in use [Pa].
    pub least_strength: f32,
    /// Speed of the pressure wave in the material in which it is fastest [m/s].
    pub fastest_wave: f64,
    /// Largest product of the angular frequency of the breathing mode of a voxel and the width of the voxel
    /// [m/s].
    pub fastest_breathing: f64,
    /// Whether the fracture energy of a material in use grows with the speed of a crack.
    pub has_rate_toughening: bool,
    /// Whether a material in use is hyperelastic.
    pub is_hyperelastic: bool,
}

impl BodyProperties {
    pub fn of<D: Dim>(grid: &VoxelGrid<D>, materials: &[Material]) -> Self {
        let mut counts = vec![0.0; materials.len()];
        for number in grid.voxels().map(|voxel| grid.material(voxel)) {
            if number > 0 {
                counts[number as usize - 1] += 1.0;
            }
        }
        let total: f64 = counts.iter().sum();
        let used = || {
            counts
                .iter()
                .zip(materials)
                .filter(|(count, _)| **count > 0.0)
        };
        let mean = |of: &dyn Fn(&Material) -> f64| {
            used()
                .map(|(count, material)| count * of(material))
                .sum::<f64>()
                / total
        };
        let strengths = used().map(|(_, material)| material.strength);
        let waves = used().map(|(_, material)| material.wave_speed());
        let breathing = used().map(|(_, material)| material.breathing_speed(D::N));
        let mut mass_damping = used().map(|(_, material)| material.damping.mass);
        let first = mass_damping.next();
        Self {
            used: counts.iter().map(|&count| count > 0.0).collect(),
            mass_damping: first.filter(|first| mass_damping.all(|other| other == *first)),
            friction: mean(&|material| f64::from(material.friction)) as f32,
            rolling_resistance: mean(&|material| f64::from(material.rolling_resistance)) as f32,
            least_strength: strengths.fold(f32::INFINITY, f32::min),
            fastest_wave: waves.fold(0.0, f64::max),
            fastest_breathing: breathing.fold(0.0, f64::max),
            has_rate_toughening: used()
                .any(|(_, material)| material.rate_toughening.exponent > 0.0),
            is_hyperelastic: used().any(|(_, material)| material.stress_law.factors().is_some()),
        }
    }
}
