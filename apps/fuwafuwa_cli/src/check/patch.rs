//! Patch test: under uniform strain no force acts on inner nodes, for any shape and any cuts.

use super::random::Random;
use crate::report::{Findings, Outcome, Progress};
use anyhow::Result;
use fuwafuwa::glam::DVec3;
use fuwafuwa::inspect::{
    CellHierarchy, Connectivity, Elasticity, Mesh, forces, neighbourhood, points_in,
};
use fuwafuwa::{Dim, Dim2, Dim3, Grading, Law, NodeId, Point, VoxelGrid};

/// Maximum residual force of the default law on an inner node, relative to stress × face area of a voxel.
const LIMIT: f64 = 1e-5;

/// Number of random shapes in 2D and in 3D.
#[derive(Copy, Clone, Debug)]
struct Shapes {
    plane: u64,
    space: u64,
}

/// Number of shapes in `fuwafuwa check`. The unit test uses fewer.
const FULL: Shapes = Shapes {
    plane: 1000,
    space: 400,
};

/// Checks that the residual force of the default law stays below [`LIMIT`] on random shapes with cuts. Shows
/// the residual force of the paper's law for comparison.
pub fn check(progress: &Progress) -> Result<Findings> {
    Ok(check_shapes(FULL, progress)?.into())
}

fn check_shapes(shapes: Shapes, progress: &Progress) -> Result<Vec<Outcome>> {
    progress.expect(shapes.plane + shapes.space);
    let mut outcomes = check_dim::<Dim2>(shapes.plane, 6..20, progress)?;
    outcomes.extend(check_dim::<Dim3>(shapes.space, 6..11, progress)?);
    Ok(outcomes)
}

fn check_dim<D: Dim>(
    shapes: u64,
    sizes: std::ops::Range<i32>,
    progress: &Progress,
) -> Result<Vec<Outcome>> {
    let laws = [Law::CorotationalVem, Law::Endo2004];
    let mut worst = [0.0f64; 2];
    for seed in 0..shapes {
        let n = sizes.start + seed as i32 % (sizes.end - sizes.start);
        let mut random = Random::new(seed + 1);
        if let Some(grid) = random_shape::<D>(&mut random, n) {
            let mut sharing = Connectivity::new(&grid);
            for _ in 0..1 + random.below(5) {
                random_cut(&mut sharing, &mut random, n);
            }
            let mesh = Mesh::grade(
                &grid,
                &sharing,
                &CellHierarchy::new(&grid, &sharing, Grading::Graded),
            )?;
            for (worst, law) in worst.iter_mut().zip(laws) {
                *worst = worst.max(residual(&mesh, &sharing, law)?);
            }
        }
        progress.step();
    }
    let case = |law: &str| format!("patch {}D, {shapes} shapes, {law}", D::N);
    Ok(vec![
        Outcome::at_most(case("default law"), worst[0], LIMIT),
        Outcome::shown(case("the paper's law"), worst[1]),
    ])
}

/// Returns the maximum force on an inner node under uniform strain, relative to stress × face area of a
/// voxel.
fn residual<D: Dim>(mesh: &Mesh<D>, sharing: &Connectivity<D>, law: Law) -> Result<f64> {
    let elasticity = Elasticity::new(1000.0, 0.3)?;
    let strain = [[1.12, 0.07, 0.0], [-0.21, 0.91, 0.05], [0.0, 0.11, 1.04]];
    let deformed = |at: Point| {
        let mut x = DVec3::ZERO;
        for i in 0..D::N {
            x[i] = (0..D::N).map(|j| strain[i][j] * f64::from(at[j])).sum();
        }
        x
    };
    let mut sums = vec![DVec3::ZERO; mesh.node_capacity()];
    for (_, element) in mesh.elements() {
        let at = |&node: &NodeId| deformed(mesh.node(node).at);
        let positions: Vec<_> = element.nodes.iter().map(at).collect();
        let size = f64::from(element.cell.width());
        let all = forces(
            law,
            elasticity.into(),
            mesh.element_class(element),
            size,
            &positions,
        );
        for (&node, force) in element.nodes.iter().zip(all) {
            sums[node.index()] += force;
        }
    }
    let stress = 0.2 * elasticity.young;
    let mut worst = 0.0f64;
    for (id, node) in mesh.nodes() {
        if node.group == D::ALL_CORNERS && !sharing.is_open(node.at) {
            for force in sums[id.index()].to_array() {
                // Replaces NaN by infinity, because f64::max would ignore it.
                let force = if force.is_nan() { f64::INFINITY } else { force };
                worst = worst.max(force.abs() / stress);
            }
        }
    }
    Ok(worst)
}

/// Returns a union of balls and boxes minus one ball, of one or two materials; `None` if it is empty.
fn random_shape<D: Dim>(random: &mut Random, n: i32) -> Option<VoxelGrid<D>> {
    let parts: Vec<(Point, i32, bool)> = (0..4)
        .map(|_| {
            let at = [random.below(n), random.below(n), random.below(n)];
            (at, n / 6 + random.below(n / 3), random.below(2) == 0)
        })
        .collect();
    let inside = |part: &(Point, i32, bool), at: Point| {
        let away = (0..D::N).map(|axis| (at[axis] - part.0[axis]).abs());
        if part.2 {
            away.max().is_some_and(|distance| distance < part.1)
        } else {
            away.map(|k| k * k).sum::<i32>() < part.1 * part.1
        }
    };
    let two_materials = random.below(3) == 0;
    let extent = n as usize;
    let size = [extent, extent, D::depth(extent)];
    VoxelGrid::from_fn(size, 1.0, |at| {
        let solid = parts[..3].iter().any(|part| inside(part, at)) && !inside(&parts[3], at);
        u8::from(solid) * (1 + u8::from(two_materials && at[0] > n / 2))
    })
    .ok()
}

/// Splits nodes of a random plane: either a single point, as a growing crack does, or a rectangle, as a knife
/// does.
fn random_cut<D: Dim>(sharing: &mut Connectivity<D>, random: &mut Random, n: i32) {
    let axis = random.below(D::N as i32) as usize;
    let side = (0..D::CORNERS).fold(0u8, |mask, octant| {
        mask | ((octant >> axis & 1) as u8) << octant
    });
    let (mut low, mut high) = ([0; 3], [0; 3]);
    let reach = if random.below(2) == 0 { 1 } else { n };
    for k in 0..D::N {
        low[k] = random.below(n + 1);
        high[k] = (low[k] + random.below(reach)).min(n);
    }
    high[axis] = low[axis];
    let mut around = Vec::new();
    for at in points_in(low, high) {
        if sharing.release(at, side) {
            around.extend(neighbourhood::<D>(at, 1));
        }
    }
    sharing.normalise(around);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn default_law_passes_and_paper_law_fails() {
        let shapes = Shapes {
            plane: 40,
            space: 20,
        };
        let outcomes = check_shapes(shapes, &Progress::new()).unwrap();
        assert_eq!(outcomes.len(), 4);
        assert!(outcomes.iter().all(|outcome| outcome.pass != Some(false)));
        assert!(outcomes[1].value > LIMIT && outcomes[3].value > LIMIT);
    }
}
