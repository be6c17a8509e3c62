//! Bending: the tip of a graded cantilever against Timoshenko's theory.
//!
//! ```text
//!   ▓┌──────────────────────┐
//!   ▓│                      │ ↓ P     w = P L³ / 3 E' I + P L / κ G A,  κ = 5/6
//!   ▓└──────────────────────┘
//! ```
//!
//! The load is small, so the law is linearised at rest: a stiffness matrix for each class of
//! element, by central differences of [`forces`], and conjugate gradients over all elements.

use super::parallel;
use crate::report::{Outcome, Progress};
use anyhow::{Result, ensure};
use fuwafuwa::law::{Elasticity, Law, forces};
use fuwafuwa::pyramid::{Grading, Pyramid};
use fuwafuwa::sharing::Sharing;
use fuwafuwa::stencil::Stencil;
use fuwafuwa::{Dim, Dim2, Dim3, Mesh, VoxelGrid};
use std::collections::BTreeMap;

/// Thickness of a beam in voxels.
const THICKNESS: usize = 16;
/// Lengths of the beams in thicknesses.
const LENGTHS: [usize; 3] = [4, 6, 8];
/// Largest deviation of the ratio from 1.
const TOLERANCE: f64 = 0.02;
/// Residual at which the gradients stop, relative to the load.
const CONVERGED: f64 = 1e-8;
/// Conjugate gradients give up after so many rounds.
const MOST_ROUNDS: usize = 20_000;
/// Half the step of the central differences, in half widths of an element.
const STEP: f64 = 1e-6;

/// A cantilever to be bent.
#[derive(Copy, Clone, Debug)]
struct Beam {
    dim: usize,
    length: usize,
    thickness: usize,
    poisson: f64,
}

/// Tip deflection of beams in the plane and in space, by theory.
pub fn check(progress: &Progress) -> Result<Vec<Outcome>> {
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
    Ok(beams.iter().zip(ratios).map(outcome).collect())
}

impl Beam {
    fn ratio(self, progress: &Progress) -> Result<f64> {
        match self.dim {
            2 => self.ratio_in::<Dim2>(progress),
            _ => self.ratio_in::<Dim3>(progress),
        }
    }

    /// Tip deflection of the graded mesh by Timoshenko's.
    fn ratio_in<D: Dim>(self, progress: &Progress) -> Result<f64> {
        let elasticity = Elasticity::new(1000.0, self.poisson)?;
        let depth = if D::N == 3 { self.thickness } else { 1 };
        let size = [self.length, self.thickness, depth];
        let grid = VoxelGrid::<D>::from_fn(size, 1.0, |_| 1)?;
        let sharing = Sharing::new(&grid);
        let mesh = Mesh::grade(
            &grid,
            &sharing,
            &Pyramid::new(&grid, &sharing, Grading::Graded),
        )?;
        let operator = Operator::new(&mesh, elasticity);
        let load = self.load(&mesh);
        let guess = self.guess(&mesh, elasticity);
        let moved = operator.solve(&load, guess, progress)?;
        // The load adds up to 1, so its work is the deflection.
        let deflection: f64 = moved.iter().zip(&load).map(|(u, f)| u * f).sum();
        Ok(deflection / self.timoshenko(D::N, self.length as f64, elasticity))
    }

    /// Deflection at `x` under a unit load at the tip.
    fn timoshenko(self, dim: usize, x: f64, elasticity: Elasticity) -> f64 {
        let (t, length) = (self.thickness as f64, self.length as f64);
        let depth = if dim == 3 { t } else { 1.0 };
        let (area, inertia) = (depth * t, depth * t * t * t / 12.0);
        let modulus = bending_modulus(dim, elasticity);
        let shear = 5.0 / 6.0 * elasticity.shear_modulus() * area;
        x * x * (3.0 * length - x) / (6.0 * modulus * inertia) + x / shear
    }

    /// A unit load across the end face, each node by its share of the face.
    fn load<D: Dim>(self, mesh: &Mesh<D>) -> Vec<f64> {
        let mut load = vec![0.0; mesh.node_capacity() * D::N];
        for (_, element) in mesh.elements() {
            let half = 0.5 * f64::from(element.cell.width());
            let face = (1..D::N).fold(1.0, |area, _| area * half);
            let stencil = mesh.stencil(element);
            for (&node, gradient) in element.nodes.iter().zip(&stencil.gradients) {
                if mesh.node(node).at[0] == self.length as i32 {
                    load[node as usize * D::N + 1] += gradient[0] * face;
                }
            }
        }
        let total: f64 = load.iter().sum();
        load.iter().map(|share| share / total).collect()
    }

    /// The motion that the theory expects: it saves most of the rounds.
    fn guess<D: Dim>(self, mesh: &Mesh<D>, elasticity: Elasticity) -> Vec<f64> {
        let mut moved = vec![0.0; mesh.node_capacity() * D::N];
        for (id, node) in mesh.nodes() {
            let x = f64::from(node.at[0]);
            let slope = (self.timoshenko(D::N, x + 0.5, elasticity)
                - self.timoshenko(D::N, x - 0.5, elasticity))
                * f64::from(u8::from(x > 0.0));
            let up = f64::from(node.at[1]) - 0.5 * self.thickness as f64;
            moved[id as usize * D::N] = -slope * up;
            moved[id as usize * D::N + 1] = self.timoshenko(D::N, x, elasticity);
        }
        moved
    }
}

/// Young's modulus that a beam bends with: a plane-strain beam cannot contract sideways.
fn bending_modulus(dim: usize, elasticity: Elasticity) -> f64 {
    if dim == 2 {
        elasticity.young / (1.0 - elasticity.poisson * elasticity.poisson)
    } else {
        elasticity.young
    }
}

/// The linearised body, with all nodes at x = 0 held.
struct Operator {
    /// Row-major stiffness of each class, for an element of width 2.
    classes: BTreeMap<u32, Vec<f64>>,
    elements: Vec<Part>,
    held: Vec<bool>,
    diagonal: Vec<f64>,
}

/// One element of the operator.
struct Part {
    class: u32,
    /// How its stiffness compares with that of its class.
    scale: f64,
    /// The places of its coordinates.
    places: Vec<u32>,
}

impl Operator {
    fn new<D: Dim>(mesh: &Mesh<D>, elasticity: Elasticity) -> Self {
        let mut held = vec![true; mesh.node_capacity() * D::N];
        for (id, node) in mesh.nodes() {
            let free = id as usize * D::N;
            held[free..free + D::N].fill(node.at[0] == 0);
        }
        let mut classes = BTreeMap::new();
        let mut elements = Vec::new();
        let mut diagonal = vec![0.0; held.len()];
        for (_, element) in mesh.elements() {
            let class = element.stencil;
            let matrix = classes
                .entry(class)
                .or_insert_with(|| stiffness(mesh.stencil(element), elasticity));
            let places: Vec<u32> = element
                .nodes
                .iter()
                .flat_map(|&node| (0..D::N as u32).map(move |axis| node * D::N as u32 + axis))
                .collect();
            let half = 0.5 * f64::from(element.cell.width());
            let scale = (2..D::N).fold(1.0, |scale, _| scale * half);
            for (k, &place) in places.iter().enumerate() {
                diagonal[place as usize] += scale * matrix[k * places.len() + k];
            }
            elements.push(Part {
                class,
                scale,
                places,
            });
        }
        // Elements of a class together keep its matrix in the cache.
        elements.sort_by_key(|part| part.class);
        Self {
            classes,
            elements,
            held,
            diagonal,
        }
    }

    /// Conjugate gradients, scaled by the diagonal.
    fn solve(&self, load: &[f64], guess: Vec<f64>, progress: &Progress) -> Result<Vec<f64>> {
        let free = |value: f64, held: bool| if held { 0.0 } else { value };
        let mut moved: Vec<f64> = guess
            .iter()
            .zip(&self.held)
            .map(|(&u, &held)| free(u, held))
            .collect();
        let mut image = vec![0.0; moved.len()];
        self.apply(&moved, &mut image);
        let mut residual: Vec<f64> = (0..moved.len())
            .map(|k| free(load[k] - image[k], self.held[k]))
            .collect();
        let scaled = |residual: &[f64]| -> Vec<f64> {
            (0..residual.len())
                .map(|k| free(residual[k] / self.diagonal[k], self.held[k]))
                .collect()
        };
        let goal = CONVERGED * dot(load, load).sqrt();
        let mut step = scaled(&residual);
        let mut power = dot(&residual, &step);
        for _ in 0..MOST_ROUNDS {
            if dot(&residual, &residual).sqrt() <= goal {
                return Ok(moved);
            }
            progress.look();
            self.apply(&step, &mut image);
            let reach = power / dot(&step, &image);
            for k in 0..moved.len() {
                moved[k] += reach * step[k];
                residual[k] -= reach * image[k];
            }
            let next = scaled(&residual);
            let next_power = dot(&residual, &next);
            for (step, next) in step.iter_mut().zip(&next) {
                *step = next + next_power / power * *step;
            }
            power = next_power;
        }
        ensure!(
            dot(&residual, &residual).sqrt() <= goal,
            "the beam did not settle in {MOST_ROUNDS} rounds"
        );
        Ok(moved)
    }

    /// image = K moved; held places stay 0.
    fn apply(&self, moved: &[f64], image: &mut [f64]) {
        image.fill(0.0);
        let mut local = Vec::new();
        for part in &self.elements {
            let matrix = &self.classes[&part.class];
            local.clear();
            local.extend(part.places.iter().map(|&place| moved[place as usize]));
            for (row, &place) in matrix.chunks_exact(local.len()).zip(&part.places) {
                image[place as usize] += part.scale * dot(row, &local);
            }
        }
        for (image, &held) in image.iter_mut().zip(&self.held) {
            if held {
                *image = 0.0;
            }
        }
    }
}

/// −∂f/∂x at rest for an element of width 2, by central differences, made symmetric.
fn stiffness<D: Dim>(stencil: &Stencil<D>, elasticity: Elasticity) -> Vec<f64> {
    let count = stencil.slots.len() * D::N;
    let mut matrix = vec![0.0; count * count];
    let pull = |column: usize, step: f64| {
        let mut positions = stencil.offsets.clone();
        positions[column / D::N][column % D::N] += step;
        forces(Law::PatchExact, elasticity, stencil, 2.0, &positions)
    };
    for column in 0..count {
        let (ahead, behind) = (pull(column, STEP), pull(column, -STEP));
        for row in 0..count {
            let (node, axis) = (row / D::N, row % D::N);
            let slope = (behind[node][axis] - ahead[node][axis]) / (2.0 * STEP);
            // Conjugate gradients need K = Kᵀ to the last bit; differences leave some rounding.
            matrix[row * count + column] += 0.5 * slope;
            matrix[column * count + row] += 0.5 * slope;
        }
    }
    matrix
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_small_plane_beam_bends_as_it_should() {
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
