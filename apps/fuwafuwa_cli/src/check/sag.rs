//! Sag: under its weight, the top of a graded disc, ball or box must sink as far as that of a uniform body.
//!
//! The lowest layer of nodes is fixed. Graded discs and balls are compared with uniform ones of the same
//! voxels, because their shape and the area that they stand on depend on the resolution. Boxes stand on the
//! same area at any resolution. All graded boxes are therefore compared with one nearly converged uniform
//! box. The weight is small, so the law is linearised at rest. The reported sag is for a game's material and
//! a gravity of 1 m/s².
//!
//! A uniform body has by far the most elements. Symmetry reduces them: only half of the disc or a quarter of
//! the ball is simulated, and nodes in a symmetry plane are fixed perpendicular to the plane.

use super::motion::material;
use super::parallel;
use super::statics::Statics;
use crate::report::{Findings, Outcome, Progress};
use anyhow::Result;
use fuwafuwa::inspect::{CellHierarchy, Connectivity, Mesh};
use fuwafuwa::{Dim, Dim2, Dim3, Grading, VoxelGrid};

/// Voxels across the discs.
const DISCS: [usize; 5] = [16, 32, 64, 128, 256];
/// Voxels across the balls.
const BALLS: [usize; 4] = [8, 16, 32, 64];
/// Maximum relative difference between the sag of a graded disc or ball and the sag of the uniform one.
const TOLERANCE: f64 = 0.02;
/// Graded boxes: number of dimensions, voxels across, and maximum relative difference from the sag of the
/// reference box.
const BOXES: [(usize, usize, f64); 7] = [
    (2, 16, 0.05),
    (2, 32, TOLERANCE),
    (2, 64, TOLERANCE),
    (2, 128, TOLERANCE),
    (3, 16, 0.05),
    (3, 32, TOLERANCE),
    (3, 64, TOLERANCE),
];
/// Uniform reference boxes: number of dimensions and voxels across.
const REFERENCES: [(usize, usize); 2] = [(2, 256), (3, 64)];
/// Maximum relative difference between the sag of a reference box and that of a box with half its resolution.
const CONVERGED: f64 = 0.01;

/// Compares the sag of graded bodies with that of uniform ones.
pub fn check(progress: &Progress) -> Result<Findings> {
    let mut outcomes = check_round(progress)?;
    outcomes.extend(check_boxes(progress)?);
    Ok(outcomes.into())
}

fn check_boxes(progress: &Progress) -> Result<Vec<Outcome>> {
    let halves = REFERENCES.map(|(dim, n)| (dim, n / 2));
    let uniform = REFERENCES.iter().chain(&halves);
    let uniform = uniform.map(|&(dim, n)| (dim, n, Grading::Uniform));
    let graded = BOXES.map(|(dim, n, _)| (dim, n, Grading::Graded));
    let cases: Vec<_> = uniform.chain(graded).collect();
    let found = parallel::each(&cases, progress, |&(dim, n, grading)| match dim {
        2 => sag(&VoxelGrid::<Dim2>::cube(n, 1.0)?, grading, progress),
        _ => sag(&VoxelGrid::<Dim3>::cube(n, 1.0)?, grading, progress),
    })?;
    let mut outcomes = Vec::new();
    for (place, (dim, n)) in REFERENCES.into_iter().enumerate() {
        let (reference, half) = (found[place], found[REFERENCES.len() + place]);
        let case = format!(
            "sag of a box {dim}D, uniform, n = {} / {n} ({:.2} mm)",
            n / 2,
            1e3 * reference
        );
        outcomes.push(Outcome::near(case, half / reference, 1.0, CONVERGED));
        let graded = BOXES.iter().zip(&found[2 * REFERENCES.len()..]);
        for (&(_, n, tolerance), sag) in graded.filter(|((of, ..), _)| *of == dim) {
            let case = format!("sag of a box {dim}D, n = {n}, graded / uniform reference");
            outcomes.push(Outcome::near(case, sag / reference, 1.0, tolerance));
        }
    }
    Ok(outcomes)
}

fn check_round(progress: &Progress) -> Result<Vec<Outcome>> {
    let discs = DISCS.map(|n| (2, n));
    let bodies: Vec<(usize, usize)> = discs.into_iter().chain(BALLS.map(|n| (3, n))).collect();
    let gradings = [Grading::Graded, Grading::Uniform];
    let mut cases: Vec<_> = bodies
        .iter()
        .flat_map(|&body| gradings.map(|grading| (body, grading)))
        .collect();
    // Sorts the slowest cases to the end, because [`parallel::each`] starts with the last case.
    cases.sort_by_key(|&((dim, n), _)| n.pow(dim as u32) * n);
    let found = parallel::each(&cases, progress, |&((dim, n), grading)| match dim {
        2 => sag(&VoxelGrid::<Dim2>::ball(n, 1.0)?, grading, progress),
        _ => sag(&VoxelGrid::<Dim3>::ball(n, 1.0)?, grading, progress),
    })?;
    let sags: Vec<_> = cases.into_iter().zip(found).collect();
    let sag_of = |body, grading| {
        let case = sags.iter().find(|(case, _)| *case == (body, grading));
        case.expect("every body was solved in both gradings").1
    };
    let outcome = |&(dim, n): &(usize, usize)| {
        let [graded, uniform] = gradings.map(|grading| sag_of((dim, n), grading));
        Outcome::near(
            format!(
                "sag {dim}D, n = {n}, graded / uniform ({:.2} mm)",
                1e3 * uniform
            ),
            graded / uniform,
            1.0,
            TOLERANCE,
        )
    };
    Ok(bodies.iter().map(outcome).collect())
}

/// Returns how far the top of a body sinks [m]. A uniform body must have an even number of voxels across,
/// because only one half of it is simulated.
fn sag<D: Dim>(whole: &VoxelGrid<D>, grading: Grading, progress: &Progress) -> Result<f64> {
    match grading {
        Grading::Uniform => sag_between(whole, grading, whole.size()[0] / 2, progress),
        _ => sag_between(whole, grading, 0, progress),
    }
}

/// Returns how far the top sinks [m] if only voxels with horizontal coordinates of at least `mirror` are
/// simulated. Nodes at the coordinate `mirror` stay in that symmetry plane. With 0, the whole body is
/// simulated.
fn sag_between<D: Dim>(
    whole: &VoxelGrid<D>,
    grading: Grading,
    mirror: i32,
    progress: &Progress,
) -> Result<f64> {
    let material = material();
    let level_axes = (0..D::N).filter(|&axis| axis != 1);
    let size = whole.size().map(|extent| extent as usize);
    let grid = VoxelGrid::<D>::from_fn(size, whole.voxel_size(), |at| {
        let is_beyond = level_axes.clone().all(|axis| at[axis] >= mirror);
        u8::from(is_beyond) * whole.material(at)
    })?;
    let sharing = Connectivity::new(&grid);
    let mesh = Mesh::grade(
        &grid,
        &sharing,
        &CellHierarchy::new(&grid, &sharing, grading),
    )?;
    let heights: Vec<i32> = mesh.nodes().map(|(_, node)| node.at[1]).collect();
    let lowest = heights.iter().copied().min().unwrap_or(0);
    let highest = heights.iter().copied().max().unwrap_or(0);
    let statics = Statics::new(&mesh, material.elasticity, |node, axis| {
        node.at[1] == lowest || axis != 1 && mirror > 0 && node.at[axis] == mirror
    });
    let mut load = vec![0.0; mesh.node_capacity() * D::N];
    for (_, element) in mesh.elements() {
        let half = 0.5 * f64::from(element.cell.width());
        let child = (0..D::N).fold(f64::from(material.density), |mass, _| mass * half);
        let shares = &mesh.element_class(element).volumes;
        for (&node, share) in element.nodes.iter().zip(shares) {
            load[node.index() * D::N + 1] -= child * share;
        }
    }
    let still = vec![0.0; load.len()];
    let moved = statics.solve(&load, still, progress)?;
    let (mut sunk, mut count) = (0.0, 0.0);
    for (id, node) in mesh.nodes().filter(|(_, node)| node.at[1] == highest) {
        // Weight of a top node in the mean: its number of adjacent voxels. A node in a symmetry plane has
        // half as many.
        let weight = f64::from(node.group.count_ones());
        sunk -= weight * moved[id.index() * D::N + 1];
        count += weight;
    }
    // Scales the solution, which is for voxels 1 m wide. In D dimensions the load grows with width^D and the
    // stiffness with width^(D−2), so the sag grows with width².
    let voxel = f64::from(grid.voxel_size());
    Ok(sunk / count * voxel * voxel)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_graded_disc_sags_like_a_uniform_one() {
        let progress = Progress::new();
        let disc = VoxelGrid::<Dim2>::ball(16, 1.0).unwrap();
        let [graded, uniform] =
            [Grading::Graded, Grading::Uniform].map(|grading| sag(&disc, grading, &progress));
        let (graded, uniform) = (graded.unwrap(), uniform.unwrap());
        assert!(uniform > 1e-3 && (graded / uniform - 1.0).abs() < TOLERANCE);
    }

    #[test]
    fn part_between_symmetry_planes_sags_like_the_whole() {
        fn check<D: Dim>(body: VoxelGrid<D>) {
            let between = |mirror| {
                let sag = sag_between(&body, Grading::Uniform, mirror, &Progress::new());
                sag.unwrap()
            };
            let (whole, part) = (between(0), between(body.size()[0] / 2));
            assert!((part / whole - 1.0).abs() < 1e-6, "{part} of {whole}");
        }
        check(VoxelGrid::<Dim2>::ball(16, 1.0).unwrap());
        check(VoxelGrid::<Dim3>::ball(8, 1.0).unwrap());
        check(VoxelGrid::<Dim2>::cube(16, 1.0).unwrap());
        check(VoxelGrid::<Dim3>::cube(8, 1.0).unwrap());
    }
}
