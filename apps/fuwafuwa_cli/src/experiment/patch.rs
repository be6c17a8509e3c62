//! Block under uniform strain: a material point of the engine.
//!
//! All nodes of a cube of 4³ voxels are placed as a uniform stretch places them, and the stress is the mean of the
//! elastic forces on the nodes of each face. Stretches along free axes are found by bisection, so that the block is in
//! equilibrium without any motion.

use crate::material::fit::{Fit, Mode};
use anyhow::{Context, Result};
use fuwafuwa::{Damping, Dim3, Elasticity, Material, NodeId, SoftBody, StressLaw, Vec3, VoxelGrid};

/// Voxels across the block.
pub const ACROSS: usize = 4;
/// Poisson's ratio, the largest that the engine allows.
pub const POISSON: f64 = 0.49;
/// Number of halvings of the interval of a free stretch.
const HALVINGS: u32 = 40;

/// Block 1 m across with its centre at the origin.
pub struct Block {
    body: SoftBody<Dim3>,
    /// Nodes with their places at rest [m].
    nodes: Vec<(NodeId, Vec3)>,
}

/// Returns a material without damping that does not break.
pub fn elastic(fit: &Fit) -> Material {
    Material {
        damping: Damping::NONE,
        strength: f32::INFINITY,
        toughness: f32::INFINITY,
        ..fit.material(POISSON)
    }
}

/// Returns a neo-Hookean material with the usual Young's modulus that does not break.
pub fn rubber(poisson: f64, damping: Damping) -> Result<Material> {
    let usual = Material::default();
    Ok(Material {
        elasticity: Elasticity::new(usual.elasticity.young, poisson)?,
        stress_law: StressLaw::NeoHookean,
        damping,
        strength: f32::INFINITY,
        toughness: f32::INFINITY,
        ..usual
    })
}

impl Block {
    /// Returns a block with a fitted law.
    pub fn new(fit: &Fit) -> Result<Self> {
        let grid = VoxelGrid::<Dim3>::cube(ACROSS, 1.0)?;
        let body = SoftBody::new(grid, &[elastic(fit)])?;
        let nodes = body.mesh().nodes();
        let nodes = nodes.map(|(id, node)| {
            let at = node.at.map(|k| k as f32 / ACROSS as f32 - 0.5);
            (id, Vec3::from(at))
        });
        let nodes = nodes.collect();
        Ok(Self { body, nodes })
    }

    /// Returns the engineering stresses [Pa] along the axes under stretches along the axes.
    fn stresses(&mut self, stretches: [f64; 3]) -> Result<[f64; 3]> {
        let stretches = Vec3::from(stretches.map(|stretch| stretch as f32));
        for &(id, at) in &self.nodes {
            self.body.set_node_state(id, at * stretches, Vec3::ZERO)?;
        }
        self.body.advance(0.0, Vec3::ZERO);
        Ok([0, 1, 2].map(|axis: usize| {
            let on_face = self.nodes.iter().filter(|(_, at)| at[axis] > 0.499);
            let forces = on_face.map(|&(id, _)| f64::from(self.body.force_on(id)[axis]));
            -forces.sum::<f64>()
        }))
    }

    /// Returns the engineering stress [Pa] of a test along its first axis. Axes across are free, except those that
    /// the test holds.
    ///
    /// # Errors
    /// If the stress across is 0 nowhere near the stretch of an incompressible material.
    pub fn stress(&mut self, mode: Mode, stretch: f64) -> Result<f64> {
        let exact = mode.stretches(stretch);
        let with_free = |factor: f64| match mode {
            Mode::Uniaxial => [stretch, exact[1] * factor, exact[2] * factor],
            Mode::Equibiaxial | Mode::PureShear => [stretch, exact[1], exact[2] * factor],
        };
        let (mut low, mut high) = (0.8, 1.6);
        let across = |block: &mut Self, factor| anyhow::Ok(block.stresses(with_free(factor))?[2]);
        let is_between = across(self, low)? < 0.0 && across(self, high)? > 0.0;
        is_between
            .then_some(())
            .with_context(|| format!("{mode:?}, stretch {stretch}: no equilibrium across"))?;
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            match across(self, middle)? < 0.0 {
                true => low = middle,
                false => high = middle,
            }
        }
        Ok(self.stresses(with_free(0.5 * (low + high)))?[0])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::fit::Law;

    #[test]
    fn block_has_the_stress_of_the_neo_hookean_law() {
        let fit = Fit {
            law: Law::NeoHookean,
            shear_modulus: 1.0,
            second: 0.0,
            third: 0.0,
        };
        let mut block = Block::new(&fit).unwrap();
        // Engineering stress of an incompressible neo-Hookean material, divided by the shear modulus.
        for (mode, stretch, exact) in [
            (Mode::Uniaxial, 0.7, -1.3408),
            (Mode::Uniaxial, 2.0, 1.75),
            (Mode::Uniaxial, 3.0, 2.8889),
            (Mode::PureShear, 2.0, 1.875),
            (Mode::PureShear, 3.0, 2.963),
            (Mode::Equibiaxial, 1.5, 1.3683),
            (Mode::Equibiaxial, 2.0, 1.9688),
        ] {
            let found = block.stress(mode, stretch).unwrap();
            assert!(
                (found / exact - 1.0).abs() < 0.02,
                "{mode:?} {stretch} {found}"
            );
        }
    }
}
