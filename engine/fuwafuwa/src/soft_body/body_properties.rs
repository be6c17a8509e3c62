//! Properties of a whole body, combined from the materials of its voxels.

use crate::foundation::dim::Dim;
use crate::material::Material;
use crate::soft_body::element_law::Elasticity;
use crate::soft_body::plasticity::Plasticity;
use crate::topology::grid::VoxelGrid;

/// Properties of a whole body, combined from the materials of its voxels.
#[derive(Copy, Clone, Debug, Default)]
pub struct BodyProperties {
    /// Damping ratio of the slowest mode, 0 to 1; mean over the voxels.
    pub damping: f64,
    /// Angular frequency of the slowest mode [1/s]: π √(Y/ρ) / w. Young's modulus Y and density ρ are means
    /// over the voxels; w is the width of a square or cube with the volume of the body.
    pub slowest_frequency: f64,
    /// Friction coefficient; mean over the voxels.
    pub friction: f32,
    /// Rolling resistance of crumbs [1/s]; mean over the voxels.
    pub rolling_resistance: f32,
    /// Lowest strength of the materials in use [Pa].
    pub least_strength: f32,
    /// Speed of the pressure wave in the material in which it is fastest [m/s].
    pub fastest_wave: f64,
    /// Angular frequency of the fastest mode [1/s], the breathing mode of a single voxel of the material in
    /// which it is fastest.
    pub fastest_frequency: f64,
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
        let young = mean(&|material| material.elasticity.young);
        let density = mean(&|material| f64::from(material.density));
        let width = f64::from(grid.voxel_size()) * root(total, D::N);
        let strengths = used().map(|(_, material)| material.strength);
        let waves = used().map(|(_, material)| material.wave_speed());
        let breathing_speeds = used().map(|(_, material)| material.breathing_speed(D::N));
        Self {
            damping: mean(&|material| f64::from(material.damping)),
            slowest_frequency: std::f64::consts::PI * (young / density).sqrt() / width,
            friction: mean(&|material| f64::from(material.friction)) as f32,
            rolling_resistance: mean(&|material| f64::from(material.rolling_resistance)) as f32,
            least_strength: strengths.fold(f32::INFINITY, f32::min),
            fastest_wave: waves.fold(0.0, f64::max),
            fastest_frequency: breathing_speeds.fold(0.0, f64::max) / f64::from(grid.voxel_size()),
        }
    }
}

pub fn plasticities(materials: &[Material]) -> Vec<Option<Plasticity>> {
    materials.iter().map(Material::plasticity).collect()
}

pub fn elasticities(materials: &[Material], stiffness_scale: f64) -> Vec<Elasticity> {
    let soft = |material: &Material| Elasticity {
        young: material.elasticity.young * stiffness_scale,
        ..material.elasticity
    };
    materials.iter().map(soft).collect()
}

/// Returns the square root (`order` 2) or cube root (`order` 3) by Newton's iteration. Platform functions may
/// round differently.
fn root(of: f64, order: usize) -> f64 {
    let mut root = of.max(1.0);
    for _ in 0..60 {
        let power = (1..order).fold(1.0, |power, _| power * root);
        root -= (power * root - of) / (order as f64 * power);
    }
    root
}
