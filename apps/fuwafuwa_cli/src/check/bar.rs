//! Slender bodies in plane strain, shared by the checks of bars and rings.

use anyhow::{Context, Result};
use fuwafuwa::inspect::Elasticity;
use fuwafuwa::{Damping, Dim, Dim2, Material, SoftBody, StiffBodies, Vec2, VoxelGrid, WorldConfig};
use std::f64::consts::TAU;

/// Lowest frequency of a bar or ring [Hz]. It sets Young's modulus.
pub const FREQUENCY: f64 = 1.0;
/// Poisson's ratio.
pub const POISSON: f64 = 0.3;

/// Straight bar in plane strain, 1 m long, along the x axis with its left end at x = 0.
pub struct Bar {
    size: [usize; 2],
    material: Material,
}

impl Bar {
    /// Returns a bar with a size [voxels]. Its lowest frequency, while clamped at one end, is [`FREQUENCY`].
    pub fn new(size: [usize; 2], damping: Damping) -> Self {
        let usual = Material::default();
        // ω = k² √(E' I / ρ A), with the root k of cos k cosh k = −1 and L = 1 m.
        let thickness = size[1] as f64 / size[0] as f64;
        let wave_speed = TAU * FREQUENCY * 12f64.sqrt() / (1.875_104 * 1.875_104 * thickness);
        let modulus = f64::from(usual.density) * wave_speed * wave_speed;
        let material = unbreakable(modulus, damping);
        Self { size, material }
    }

    /// Modulus E' = E / (1 − ν²) of bending in plane strain [Pa].
    pub fn modulus(&self) -> f64 {
        plane_strain(self.material.elasticity)
    }

    /// Thickness [m].
    pub fn thickness(&self) -> f64 {
        self.size[1] as f64 / self.size[0] as f64
    }

    /// Returns the bar, clamped at its left end.
    pub fn body(&self) -> Result<SoftBody<Dim2>> {
        let [length, thickness] = self.size;
        let grid = VoxelGrid::from_fn([length, thickness, 1], 1.0 / length as f32, |_| 1)?;
        let mut body = SoftBody::new(grid, &[self.material])?;
        fix_where(&mut body, |at| at[0] == 0);
        Ok(body)
    }

    /// Returns the gravity [m/s²] at which the weight per length q of the bar is `weight` · E' I / L³.
    pub fn gravity(&self, weight: f64) -> f64 {
        let thickness = self.thickness();
        let stiffness = self.modulus() * thickness * thickness / 12.0;
        weight * stiffness / f64::from(self.material.density)
    }
}

/// Returns a material that does not tear, with the default density, a Poisson's ratio of [`POISSON`], and a modulus of
/// bending in plane strain [Pa].
pub fn unbreakable(modulus: f64, damping: Damping) -> Material {
    Material {
        elasticity: Elasticity {
            young: modulus * (1.0 - POISSON * POISSON),
            poisson: POISSON,
        },
        damping,
        strength: f32::INFINITY,
        ..Material::default()
    }
}

/// Returns the modulus of bending in plane strain, E / (1 − ν²) [Pa].
pub fn plane_strain(elasticity: Elasticity) -> f64 {
    elasticity.young / (1.0 - elasticity.poisson * elasticity.poisson)
}

/// Returns a configuration with a gravity [m/s²], without sleep, in which no body is scaled.
pub fn still<D: Dim>(gravity: D::Vector) -> WorldConfig<D> {
    WorldConfig {
        gravity,
        sleep: false,
        stiff_bodies: StiffBodies::Exact,
        ..WorldConfig::default()
    }
}

/// Fixes the nodes at the lattice points that `is_fixed` returns true for.
pub fn fix_where(body: &mut SoftBody<Dim2>, is_fixed: impl Fn([i32; 2]) -> bool) {
    let nodes: Vec<_> = body.mesh().nodes().collect();
    for (id, _) in nodes
        .into_iter()
        .filter(|(_, node)| is_fixed([node.at[0], node.at[1]]))
    {
        body.fix_node(id);
    }
}

/// Returns the position [m] of the node at a lattice point.
///
/// # Errors
/// If the body has no node there.
pub fn place(body: &SoftBody<Dim2>, at: [usize; 2]) -> Result<Vec2> {
    let point = at.map(|coordinate| coordinate as i32);
    let mut nodes = body.mesh().nodes();
    let node = nodes.find(|(_, node)| node.at[..2] == point);
    let (id, _) = node.with_context(|| format!("the body has no node at {at:?}"))?;
    Ok(body.node_state(id).0)
}
