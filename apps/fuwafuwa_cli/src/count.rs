//! Numbers of elements, nodes and vertices of a graded body, compared with the formulas of the paper.

use crate::report::{self, Progress};
use anyhow::{Context, Result};
use clap::ValueEnum;
use fuwafuwa::inspect::{CellHierarchy, Connectivity, Mesh};
use fuwafuwa::{Dim, Dim2, Dim3, Grading, VoxelGrid};
use serde::Serialize;
use std::process::ExitCode;

/// Count voxels, elements, nodes and vertices and compare with the formulas of the paper.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Number of space dimensions, 2 or 3.
    #[arg(long, default_value_t = 3, value_parser = clap::value_parser!(u8).range(2..=3))]
    dim: u8,
    /// Shape to count; in 2D a square or a disc.
    #[arg(long, value_enum, default_value_t = Form::Ball)]
    shape: Form,
    /// Voxels across, 3 to 1024; accepts several values.
    #[arg(long, num_args = 1.., default_values_t = [16, 32, 64],
          value_parser = clap::value_parser!(u16).range(3..=1024))]
    n: Vec<u16>,
    /// Print JSON instead of a table.
    #[arg(long)]
    json: bool,
}

/// Counts and prints the results.
pub fn run(arguments: &Arguments) -> Result<ExitCode> {
    let counts = count(arguments.dim, arguments.shape, &arguments.n)?;
    if arguments.json {
        report::print_json(&counts)?;
    } else {
        output::print(&table(&counts))?;
    }
    Ok(ExitCode::SUCCESS)
}

/// Shape to count.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Serialize, ValueEnum)]
#[serde(rename_all = "lowercase")]
enum Form {
    /// All voxels; a square in 2D.
    Cube,
    /// Largest ball that fits; a disc in 2D.
    Ball,
}

/// Ways to place the elements. `graded`, for bodies that can be cut, has single-voxel elements at the
/// surface. `coarse`, as counted in the paper, has elements two voxels wide at the surface, and a vertex at
/// every lattice point of the surface.
const PLACINGS: [(&str, Grading); 2] = [("graded", Grading::Graded), ("coarse", Grading::Coarse)];

/// Counts of one body.
#[derive(Clone, Debug, Serialize)]
struct Count {
    /// Number of space dimensions.
    dim: u8,
    /// Shape in the grid.
    shape: Form,
    /// Voxels across.
    n: u16,
    /// Way to place the elements: `graded` or `coarse`.
    placing: &'static str,
    /// Number of solid voxels.
    voxels: usize,
    /// Number of elements on all levels.
    elements: usize,
    /// Number of elements on each level, finest first.
    elements_per_level: Vec<usize>,
    /// Number of nodes, each counted once.
    nodes: usize,
    /// Number of vertices if each element had its own, as in the paper's §3.1.
    independent_vertices: usize,
    /// The paper's number of vertices of a full box with single-voxel elements only: 2^d n^d.
    paper_uniform: usize,
    /// The paper's number of vertices of a full 3D box with elements of several levels: 26 n².
    paper_graded: Option<usize>,
}

/// Counts bodies of all given sizes, each with both placings.
fn count(dim: u8, shape: Form, all: &[u16]) -> Result<Vec<Count>> {
    let progress = Progress::new();
    progress.expect(2 * all.len() as u64);
    let mut counts = Vec::new();
    for &n in all {
        for placing in PLACINGS {
            counts.push(match dim {
                2 => count_one::<Dim2>(shape, n, placing)?,
                _ => count_one::<Dim3>(shape, n, placing)?,
            });
            progress.step();
        }
    }
    Ok(counts)
}

/// Formats the counts as a table, one row per body.
fn table(counts: &[Count]) -> String {
    let levels = counts.iter().map(|count| count.elements_per_level.len());
    let levels = levels.max().unwrap_or(0);
    let in_space = counts.iter().any(|count| count.paper_graded.is_some());
    let dim = counts.first().map_or(3, |count| count.dim);
    let mut head: Vec<String> = ["n", "placing", "voxels", "elements"]
        .map(String::from)
        .to_vec();
    head.extend((0..levels).map(|level| format!("level {level}")));
    head.extend(["nodes", "independent vertices"].map(String::from));
    head.extend([format!("{}n^{dim}", 1 << dim), "share".into()]);
    if in_space {
        head.extend(["26n^2", "ratio"].map(String::from));
    }
    let mut rows = vec![head];
    rows.extend(counts.iter().map(|count| row(count, levels)));
    let mut right = vec![true; rows[0].len()];
    right[1] = false;
    report::table(&rows, &right)
}

fn row(count: &Count, levels: usize) -> Vec<String> {
    let mut row = vec![
        count.n.to_string(),
        count.placing.into(),
        count.voxels.to_string(),
        count.elements.to_string(),
    ];
    let on = |level| count.elements_per_level.get(level);
    row.extend((0..levels).map(|level| on(level).map_or("-".into(), ToString::to_string)));
    let vertices = count.independent_vertices as f64;
    row.push(count.nodes.to_string());
    row.push(count.independent_vertices.to_string());
    row.push(count.paper_uniform.to_string());
    row.push(format!(
        "{:.1} %",
        100.0 * vertices / count.paper_uniform as f64
    ));
    if let Some(paper) = count.paper_graded {
        row.push(paper.to_string());
        row.push(format!("{:.2}", vertices / paper as f64));
    }
    row
}

fn count_one<D: Dim>(
    shape: Form,
    n: u16,
    (placing, grading): (&'static str, Grading),
) -> Result<Count> {
    let across = usize::from(n);
    let grid = match shape {
        Form::Cube => VoxelGrid::<D>::cube(across, 1.0),
        Form::Ball => VoxelGrid::<D>::ball(across, 1.0),
    };
    let grid = grid.with_context(|| format!("cannot count n = {n} in {}D", D::N))?;
    let sharing = Connectivity::new(&grid);
    let pyramid = CellHierarchy::new(&grid, &sharing, grading);
    let mesh = Mesh::grade(&grid, &sharing, &pyramid)?;
    Ok(Count {
        dim: D::N as u8,
        shape,
        n,
        placing,
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
    fn ball_of_32_voxels_has_the_known_element_count() {
        let counts = count(3, Form::Ball, &[32]).unwrap();
        assert_eq!((counts[0].voxels, counts[0].elements), (15_408, 5_048));
        assert!(table(&counts).contains("5048"));
        let coarse = &counts[1];
        assert_eq!(coarse.elements_per_level[0], 0, "no single voxels");
    }

    #[test]
    fn paper_graded_count_is_absent_in_2d() {
        let counts = count(2, Form::Cube, &[8]).unwrap();
        assert_eq!(counts[0].paper_uniform, 256);
        assert_eq!(counts[0].paper_graded, None);
    }
}
