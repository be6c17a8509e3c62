//! Bodies at rest under small loads: the law linearised, and solved.
//!
//! Each class of element has a stiffness matrix, by central differences of [`forces`]; the sum
//! over all elements is never formed.

use crate::report::Progress;
use anyhow::{Result, ensure};
use fuwafuwa::law::{Elasticity, Law, forces};
use fuwafuwa::mesh::Node;
use fuwafuwa::stencil::ElementClass;
use fuwafuwa::{Dim, Mesh};
use std::collections::BTreeMap;

/// Residual at which the gradients stop, relative to the load.
const CONVERGED: f64 = 1e-8;
/// Conjugate gradients give up after so many rounds.
const MOST_ROUNDS: usize = 20_000;
/// Half the step of the central differences, in half widths of an element.
const STEP: f64 = 1e-6;

/// A body linearised at rest, some of its nodes held. Lengths are in voxels.
pub struct Statics {
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

impl Statics {
    /// The body of a mesh; `is_held` tells whether a node is held along an axis.
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
            let class = element.stencil;
            let matrix = classes
                .entry(class)
                .or_insert_with(|| stiffness(mesh.stencil(element), elasticity));
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

    /// How far every coordinate moves under a load, by conjugate gradients scaled by the diagonal.
    ///
    /// # Errors
    /// When the gradients do not converge.
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
            "the body did not settle in {MOST_ROUNDS} rounds"
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
            local.resize(part.places.len(), 0.0);
            // Column by column, the matrix being symmetric: sums that need not wait for each other.
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
        for (image, &held) in image.iter_mut().zip(&self.held) {
            if held {
                *image = 0.0;
            }
        }
    }
}

/// −∂f/∂x at rest for an element of width 2, by central differences, made symmetric.
fn stiffness<D: Dim>(stencil: &ElementClass<D>, elasticity: Elasticity) -> Vec<f64> {
    let count = stencil.slots.len() * D::N;
    let mut matrix = vec![0.0; count * count];
    let pull = |column: usize, step: f64| {
        let mut positions = stencil.offsets.clone();
        positions[column / D::N][column % D::N] += step;
        forces(Law::CorotationalVem, elasticity, stencil, 2.0, &positions)
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
