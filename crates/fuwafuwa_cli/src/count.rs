//! How many elements, nodes and vertices a graded body has, beside the formulas of the paper.

use crate::report;
use anyhow::{Context, Result};
use clap::ValueEnum;
use fuwafuwa::pyramid::{Grading, Pyramid};
use fuwafuwa::sharing::Sharing;
use fuwafuwa::{Dim, Dim2, Dim3, Mesh, VoxelGrid};
use serde::Serialize;

/// What fills the grid.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Serialize, ValueEnum)]
#[serde(rename_all = "lowercase")]
pub enum Form {
    /// Every voxel: a square in 2D.
    Cube,
    /// The largest ball that fits: a disc in 2D.
    Ball,
}

/// The counts of one body.
#[derive(Clone, Debug, Serialize)]
pub struct Count {
    /// Space dimensions.
    pub dim: u8,
    /// What fills the grid.
    pub shape: Form,
    /// Voxels across.
    pub n: u16,
    /// Solid voxels.
    pub voxels: usize,
    /// Elements of all levels.
    pub elements: usize,
    /// Elements on each level, finest first.
    pub elements_per_level: Vec<usize>,
    /// Nodes that elements share.
    pub nodes: usize,
    /// Vertices when each element counts its own, as the paper does in §3.1.
    pub independent_vertices: usize,
    /// The paper's count without levels: 2^d n^d.
    pub paper_uniform: usize,
    /// The paper's count with levels, given for space only: 26 n².
    pub paper_graded: Option<usize>,
}

/// Counts bodies of `n` voxels across.
pub fn count(dim: u8, shape: Form, all: &[u16]) -> Result<Vec<Count>> {
    let one = |&n: &u16| match dim {
        2 => count_one::<Dim2>(shape, n),
        _ => count_one::<Dim3>(shape, n),
    };
    all.iter().map(one).collect()
}

/// The counts as a table, one row a body.
pub fn table(counts: &[Count]) -> String {
    let levels = counts.iter().map(|count| count.elements_per_level.len());
    let levels = levels.max().unwrap_or(0);
    let graded = counts.iter().any(|count| count.paper_graded.is_some());
    let mut head: Vec<String> = ["n", "voxels", "elements"].map(String::from).to_vec();
    head.extend((0..levels).map(|level| format!("level {level}")));
    head.extend(["nodes", "independent vertices"].map(String::from));
    let dim = counts.first().map_or(3, |count| count.dim);
    head.push(format!("paper {}n^{dim}", 1 << dim));
    if graded {
        head.push("paper 26n^2".into());
    }
    let mut rows = vec![head];
    for count in counts {
        let mut row = vec![
            count.n.to_string(),
            count.voxels.to_string(),
            count.elements.to_string(),
        ];
        let on = |level| count.elements_per_level.get(level);
        row.extend((0..levels).map(|level| on(level).map_or("-".into(), ToString::to_string)));
        row.push(count.nodes.to_string());
        row.push(count.independent_vertices.to_string());
        row.push(count.paper_uniform.to_string());
        row.extend(count.paper_graded.map(|vertices| vertices.to_string()));
        rows.push(row);
    }
    let right = vec![true; rows[0].len()];
    report::table(&rows, &right)
}

fn count_one<D: Dim>(shape: Form, n: u16) -> Result<Count> {
    let across = usize::from(n);
    let grid = match shape {
        Form::Cube => VoxelGrid::<D>::cube(across, 1.0),
        Form::Ball => VoxelGrid::<D>::ball(across, 1.0),
    };
    let grid = grid.with_context(|| format!("cannot count n = {n} in {}D", D::N))?;
    let sharing = Sharing::new(&grid);
    let mesh = Mesh::grade(
        &grid,
        &sharing,
        &Pyramid::new(&grid, &sharing, Grading::Graded),
    )?;
    Ok(Count {
        dim: D::N as u8,
        shape,
        n,
        voxels: grid.solid_count(),
        elements: mesh.element_count(),
        elements_per_level: mesh.elements_per_level(),
        nodes: mesh.node_count(),
        independent_vertices: mesh.independent_vertex_count(),
        paper_uniform: (2 * across).pow(D::N as u32),
        paper_graded: (D::N == 3).then_some(26 * across * across),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ball_of_32_voxels_has_the_known_number_of_elements() {
        let counts = count(3, Form::Ball, &[32]).unwrap();
        assert_eq!((counts[0].voxels, counts[0].elements), (15_408, 5_048));
        assert!(table(&counts).contains("5048"));
    }

    #[test]
    fn the_plane_has_no_26_n_squared() {
        let counts = count(2, Form::Cube, &[8]).unwrap();
        assert_eq!(counts[0].paper_uniform, 256);
        assert_eq!(counts[0].paper_graded, None);
    }
}
