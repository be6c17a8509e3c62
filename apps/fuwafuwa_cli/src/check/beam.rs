//! Bending: tip deflection of a graded cantilever against Timoshenko's theory.
//!
//! ```text
//!   ▓┌──────────────────────┐
//!   ▓│                      │ ↓ P     w = P L³ / 3 E' I + P L / κ G A,  κ = 5/6
//!   ▓└──────────────────────┘
//! ```
//!
//! `w` is the tip deflection under the load `P`. The load is small, so the law is linearised at rest; see
//! [`Statics`].

use super::bar::plane_strain;
use super::parallel;
use super::statics::Statics;
use crate::plot::{Plot, Points};
use crate::report::{Findings, Outcome, Progress};
use anyhow::Result;
use fuwafuwa::inspect::{CellHierarchy, Connectivity, Elasticity, Mesh};
use fuwafuwa::{Dim, Dim2, Dim3, Grading, VoxelGrid};

/// Thickness of a beam [voxels].
const THICKNESS: usize = 16;
/// Lengths of the beams, as multiples of their thickness.
const LENGTHS: [usize; 3] = [4, 6, 8];
/// Maximum relative deviation of a graded beam's tip deflection from theory.
const TOLERANCE: f64 = 0.02;

/// Cantilever: a beam fixed at one end.
#[derive(Copy, Clone, Debug)]
struct Beam {
    dim: usize,
    length: usize,
    thickness: usize,
    poisson: f64,
}

/// Compares tip deflections of 2D and 3D beams with Timoshenko's theory.
pub fn check(progress: &Progress) -> Result<Findings> {
    let mut beams = Vec::new();
    for dim in [2, 3] {
        for poisson in [0.0, 0.3] {
            beams.extend(LENGTHS.map(|length| Beam {
                dim,
                length: length * THICKNESS,
                thickness: THICKNESS,
                poisson,
            }));
        }
    }
    let ratios = parallel::each(&beams, progress, |beam| beam.ratio(progress))?;
    let outcome = |(beam, value): (&Beam, f64)| {
        let case = format!(
            "beam {}D, length {}t, poisson {}, tip / theory",
            beam.dim,
            beam.length / beam.thickness,
            beam.poisson
        );
        Outcome::near(case, value, 1.0, TOLERANCE)
    };
    let outcomes = beams.iter().zip(ratios.iter().copied()).map(outcome);
    let outcomes = outcomes.collect();
    let slenderness = |beam: &Beam| (beam.length / beam.thickness) as f64;
    let rows = beams
        .chunks(LENGTHS.len())
        .zip(ratios.chunks(LENGTHS.len()));
    let points = rows.map(|(beams, ratios)| {
        let name = format!("{}D, Poisson's ratio {}", beams[0].dim, beams[0].poisson);
        Points::new(
            name,
            beams.iter().map(slenderness).zip(ratios.iter().copied()),
        )
    });
    let plot = Plot {
        x: "length / thickness".into(),
        y: "tip deflection / theory".into(),
        points: points.collect(),
        band: Some(1.0 - TOLERANCE..=1.0 + TOLERANCE),
        ..Plot::default()
    };
    Ok(Findings {
        outcomes,
        plots: vec![plot],
    })
}

impl Beam {
    fn ratio(self, progress: &Progress) -> Result<f64> {
        match self.dim {
            2 => self.ratio_in::<Dim2>(progress),
            _ => self.ratio_in::<Dim3>(progress),
        }
    }

    /// Returns the tip deflection of the graded mesh relative to Timoshenko's theory.
    fn ratio_in<D: Dim>(self, progress: &Progress) -> Result<f64> {
        let elasticity = Elasticity::new(1000.0, self.poisson)?;
        let size = [self.length, self.thickness, D::depth(self.thickness)];
        let grid = VoxelGrid::<D>::from_fn(size, 1.0, |_| 1)?;
        let sharing = Connectivity::new(&grid);
        let mesh = Mesh::grade(
            &grid,
            &sharing,
            &CellHierarchy::new(&grid, &sharing, Grading::Graded),
        )?;
        let statics = Statics::new(&mesh, elasticity, |node, _| node.at[0] == 0);
        let load = self.load(&mesh);
        let guess = self.guess(&mesh, elasticity);
        let moved = statics.solve(&load, guess, progress)?;
        // Tip deflection as the work of the load, because the nodal forces sum to 1.
        let deflection: f64 = moved.iter().zip(&load).map(|(u, f)| u * f).sum();
        Ok(deflection / self.timoshenko(D::N, self.length as f64, elasticity))
    }

    /// Returns the theoretical deflection at `x` under a unit load at the tip.
    fn timoshenko(self, dim: usize, x: f64, elasticity: Elasticity) -> f64 {
        let (t, length) = (self.thickness as f64, self.length as f64);
        let depth = if dim == 3 { t } else { 1.0 };
        let (area, inertia) = (depth * t, depth * t * t * t / 12.0);
        let modulus = bending_modulus(dim, elasticity);
        let shear = 5.0 / 6.0 * elasticity.shear_modulus() * area;
        x * x * (3.0 * length - x) / (6.0 * modulus * inertia) + x / shear
    }

    /// Returns the nodal forces of a unit load on the end face of the beam, in proportion to each node's
    /// area.
    fn load<D: Dim>(self, mesh: &Mesh<D>) -> Vec<f64> {
        let mut load = vec![0.0; mesh.node_capacity() * D::N];
        for (_, element) in mesh.elements() {
            let half = 0.5 * f64::from(element.cell.width());
            let face = (1..D::N).fold(1.0, |area, _| area * half);
            let stencil = mesh.element_class(element);
            for (&node, gradient) in element.nodes.iter().zip(&stencil.gradients) {
                if mesh.node(node).at[0] == self.length as i32 {
                    load[node.index() * D::N + 1] += gradient[0] * face;
                }
            }
        }
        let total: f64 = load.iter().sum();
        load.iter().map(|share| share / total).collect()
    }

    /// Returns the nodal displacements of beam theory. As an initial guess they save most iterations of the
    /// solver.
    fn guess<D: Dim>(self, mesh: &Mesh<D>, elasticity: Elasticity) -> Vec<f64> {
        let mut moved = vec![0.0; mesh.node_capacity() * D::N];
        for (id, node) in mesh.nodes() {
            let x = f64::from(node.at[0]);
            let slope = (self.timoshenko(D::N, x + 0.5, elasticity)
                - self.timoshenko(D::N, x - 0.5, elasticity))
                * f64::from(u8::from(x > 0.0));
            let up = f64::from(node.at[1]) - 0.5 * self.thickness as f64;
            moved[id.index() * D::N] = -slope * up;
            moved[id.index() * D::N + 1] = self.timoshenko(D::N, x, elasticity);
        }
        moved
    }
}

/// Returns the effective modulus in bending. A plane-strain beam cannot contract sideways.
fn bending_modulus(dim: usize, elasticity: Elasticity) -> f64 {
    if dim == 2 {
        plane_strain(elasticity)
    } else {
        elasticity.young
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_plane_beam_matches_timoshenko() {
        let beam = Beam {
            dim: 2,
            length: 48,
            thickness: 8,
            poisson: 0.0,
        };
        let ratio = beam.ratio(&Progress::new()).unwrap();
        assert!((ratio - 1.0).abs() < TOLERANCE, "{ratio}");
    }
}
