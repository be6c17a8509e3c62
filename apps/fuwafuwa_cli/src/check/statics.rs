//! Static equilibrium under small loads, with the law linearised at rest.
//!
//! Each element class has a stiffness matrix, computed by central differences of [`forces`]. The global
//! matrix is never assembled.

use crate::report::Progress;
use anyhow::{Result, ensure};
use fuwafuwa::inspect::{Elasticity, ElementClass, Mesh, Node, forces};
use fuwafuwa::{Dim, Law};
use std::collections::BTreeMap;

/// Relative residual at which the solver stops.
const CONVERGED: f64 = 1e-8;
/// Maximum number of iterations of conjugate gradients.
const MOST_ROUNDS: usize = 20_000;
/// Step of a node to each side in the central differences, in half widths of an element.
const STEP: f64 = 1e-6;

/// Body linearised at rest, with some fixed nodes. Lengths are in voxels.
pub struct Statics {
    /// Row-major stiffness matrix of each element class, for an element of width 2.
    classes: BTreeMap<u32, Vec<f64>>,
    elements: Vec<OperatorElement>,
    held: Vec<bool>,
    diagonal: Vec<f64>,
}

/// One element of the global stiffness operator.
struct OperatorElement {
    class: u32,
    /// Factor between the stiffness of the element and that of its class.
    scale: f64,
    /// Indices of the coordinates of the element's nodes in the global vectors.
    places: Vec<u32>,
}

impl Statics {
    /// Creates the stiffness operator of a mesh. `is_held` returns whether a node is fixed along an axis.
    pub fn new<D: Dim>(
        mesh: &Mesh<D>,
        elasticity: Elasticity,
        is_held: impl Fn(Node, usize) -> bool,
    ) -> Self {
        let mut held = vec![true; mesh.node_capacity() * D::N];
        for (id, node) in mesh.nodes() {
            for axis in 0..D::N {
                held[id.index() * D::N + axis] = is_held(node, axis);
            }
        }
        let mut classes = BTreeMap::new();
        let mut elements = Vec::new();
        let mut diagonal = vec![0.0; held.len()];
        for (_, element) in mesh.elements() {
            let class = element.element_class;
            let matrix = classes
                .entry(class)
                .or_insert_with(|| stiffness(mesh.element_class(element), elasticity));
            let places: Vec<u32> = element
                .nodes
                .iter()
                .flat_map(|&node| (0..D::N as u32).map(move |axis| node.0 * D::N as u32 + axis))
                .collect();
            let half = 0.5 * f64::from(element.cell.width());
            let scale = (2..D::N).fold(1.0, |scale, _| scale * half);
            for (k, &place) in places.iter().enumerate() {
                diagonal[place as usize] += scale * matrix[k * places.len() + k];
            }
            elements.push(OperatorElement {
                class,
                scale,
                places,
            });
        }
        // Groups elements of the same class, so that the matrix of the class stays in the cache.
        elements.sort_by_key(|part| part.class);
        Self {
            classes,
            elements,
            held,
            diagonal,
        }
    }

    /// Returns the displacement of every coordinate under a load, by conjugate gradients with diagonal
    /// preconditioning.
    ///
    /// # Errors
    /// If the iteration does not converge.
    pub fn solve(&self, load: &[f64], guess: Vec<f64>, progress: &Progress) -> Result<Vec<f64>> {
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
            progress.show_if_slow();
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
            "conjugate gradients did not converge in {MOST_ROUNDS} iterations"
        );
        Ok(moved)
    }

    /// Returns the displacement of every coordinate if the fixed coordinates are displaced as in `given` and no load
    /// acts on the others. Other coordinates of `given` are ignored.
    ///
    /// # Errors
    /// If the iteration does not converge.
    pub fn solve_displaced(&self, given: &[f64], progress: &Progress) -> Result<Vec<f64>> {
        let pairs = given.iter().zip(&self.held);
        let given: Vec<f64> = pairs
            .map(|(&u, &held)| if held { u } else { 0.0 })
            .collect();
        let mut load = vec![0.0; given.len()];
        self.multiply(&given, &mut load);
        for (load, &held) in load.iter_mut().zip(&self.held) {
            *load = if held { 0.0 } else { -*load };
        }
        let moved = self.solve(&load, vec![0.0; given.len()], progress)?;
        Ok(moved
            .iter()
            .zip(&given)
            .map(|(u, given)| u + given)
            .collect())
    }

    /// Returns the elastic energy of a displacement, with lengths in voxels.
    pub fn energy(&self, moved: &[f64]) -> f64 {
        let mut forces = vec![0.0; moved.len()];
        self.multiply(moved, &mut forces);
        0.5 * dot(moved, &forces)
    }

    /// Computes image = K · moved. Fixed coordinates of the image stay 0.
    fn apply(&self, moved: &[f64], image: &mut [f64]) {
        self.multiply(moved, image);
        for (image, &held) in image.iter_mut().zip(&self.held) {
            if held {
                *image = 0.0;
            }
        }
    }

    /// Computes image = K · moved for all coordinates.
    fn multiply(&self, moved: &[f64], image: &mut [f64]) {
        image.fill(0.0);
        let mut local = Vec::new();
        for part in &self.elements {
            let matrix = &self.classes[&part.class];
            local.clear();
            local.resize(part.places.len(), 0.0);
            // Reads each matrix row as a column, which is valid because the matrix is symmetric. The sums of
            // the inner loop are then independent of each other and can be vectorised.
            for (column, &place) in matrix.chunks_exact(local.len()).zip(&part.places) {
                let along = part.scale * moved[place as usize];
                for (sum, entry) in local.iter_mut().zip(column) {
                    *sum += along * entry;
                }
            }
            for (sum, &place) in local.iter().zip(&part.places) {
                image[place as usize] += sum;
            }
        }
    }
}

/// Returns −∂f/∂x at rest for an element of width 2, by central differences, symmetrised.
fn stiffness<D: Dim>(stencil: &ElementClass<D>, elasticity: Elasticity) -> Vec<f64> {
    let count = stencil.slots.len() * D::N;
    let mut matrix = vec![0.0; count * count];
    let pull = |column: usize, step: f64| {
        let mut positions = stencil.offsets.clone();
        positions[column / D::N][column % D::N] += step;
        forces(
            Law::CorotationalVem,
            elasticity.into(),
            stencil,
            2.0,
            &positions,
        )
    };
    for column in 0..count {
        let (ahead, behind) = (pull(column, STEP), pull(column, -STEP));
        for row in 0..count {
            let (node, axis) = (row / D::N, row % D::N);
            let slope = (behind[node][axis] - ahead[node][axis]) / (2.0 * STEP);
            // Averages with the transposed entry: conjugate gradients need exact symmetry, and the
            // differences contain rounding errors.
            matrix[row * count + column] += 0.5 * slope;
            matrix[column * count + row] += 0.5 * slope;
        }
    }
    matrix
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
