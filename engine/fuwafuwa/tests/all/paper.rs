//! Measurements against figures and formulas of the paper.
#![allow(clippy::needless_range_loop)] // an axis indexes several vectors at once

use fuwafuwa::Grading;
use fuwafuwa::Law;
use fuwafuwa::inspect::CellHierarchy;
use fuwafuwa::inspect::Connectivity;
use fuwafuwa::inspect::Mesh;
use fuwafuwa::inspect::{Elasticity, forces};
use fuwafuwa::inspect::{ElementClass, cell_corners};
use fuwafuwa::{Dim, Dim2, Dim3, VoxelGrid};
use glam::DVec3;

fn graded<D: Dim>(grid: &VoxelGrid<D>) -> Mesh<D> {
    mesh_of(grid, Grading::Graded)
}

fn mesh_of<D: Dim>(grid: &VoxelGrid<D>, grading: Grading) -> Mesh<D> {
    let sharing = Connectivity::new(grid);
    let pyramid = CellHierarchy::new(grid, &sharing, grading);
    let mesh = Mesh::grade(grid, &sharing, &pyramid).unwrap();
    mesh.validate(grid, &sharing).unwrap();
    mesh
}

/// Paper, §3.1: elements grow from the surface to the centre, so their number is proportional to the surface.
#[test]
fn element_count_grows_with_surface() {
    let count = |n| graded(&VoxelGrid::<Dim3>::ball(n, 1.0).unwrap()).element_count();
    // For comparison, an independent prototype has 5,048 and 12,368 elements. The prototype does not limit
    // elements to an eighth of the body's width.
    assert_eq!((count(32), count(48)), (5_048, 12_520));
    let disc = |n| graded(&VoxelGrid::<Dim2>::ball(n, 1.0).unwrap()).element_count() as f64;
    let growth = disc(128) / disc(64);
    assert!(
        (1.9..2.2).contains(&growth),
        "doubling n must double the elements: {growth}"
    );
}

/// Elements are at most an eighth of the body wide: wider ones would concentrate too much mass in single nodes.
#[test]
fn element_width_is_at_most_an_eighth_of_body() {
    for n in [32, 64, 100, 256] {
        let mesh = graded(&VoxelGrid::<Dim2>::ball(n, 1.0).unwrap());
        let widths = mesh.elements().map(|(_, element)| element.cell.width());
        let widest = widths.max().unwrap() as usize;
        assert!(widest * 8 <= n && widest * 16 > n, "n = {n}: {widest}");
    }
}

/// Paper, §3.1: if vertices are not shared between elements, n³ voxels have 8n³ vertices. With elements two
/// voxels wide at the surface and wider ones inside, about 26n² vertices remain.
#[test]
fn vertex_count_falls_from_8n3_to_26n2_when_graded() {
    let count = |n, grading| {
        let cube = VoxelGrid::<Dim3>::cube(n, 1.0).unwrap();
        mesh_of(&cube, grading).independent_vertex_count() as f64
    };
    assert_eq!(count(8, Grading::Uniform), 8.0 * 8.0f64 * 8.0 * 8.0);
    for n in [32, 64] {
        let ratio = count(n, Grading::Coarse) / (26.0 * (n * n) as f64);
        assert!((0.8..1.2).contains(&ratio), "n = {n}: {ratio} of 26n²");
    }
}

/// Paper, Fig. 1: a small disc, with the level of each voxel's element as a digit.
#[test]
fn disc_is_fine_at_rim_and_coarse_inside() {
    let grid = VoxelGrid::<Dim2>::ball(12, 1.0).unwrap();
    let mesh = graded(&grid);
    let mut rows = vec![vec!['.'; 12]; 12];
    for (_, element) in mesh.elements() {
        for at in mesh.voxels(element) {
            rows[at[1] as usize][at[0] as usize] = (b'0' + element.cell.level) as char;
        }
    }
    let picture: Vec<String> = rows.iter().map(|row| row.iter().collect()).collect();
    assert_eq!(
        picture,
        [
            "............",
            "...000000...",
            "..00111100..",
            ".0011111100.",
            ".0112222110.",
            ".0112222110.",
            ".0112222110.",
            ".0112222110.",
            ".0011111100.",
            "..00111100..",
            "...000000...",
            "............",
        ]
    );
}

/// Paper, §3.1: for a regular polyhedron, the paper's force equals that of a linear element with the given
/// Young's modulus Y and Poisson's ratio 0. A stretched cube pulls with the force Y × strain × area.
#[test]
fn laws_reproduce_youngs_modulus_on_cube() {
    fn check<D: Dim>() {
        let element_class = ElementClass::<D>::new(D::ALL_CORNERS, cell_corners::<D>()).unwrap();
        let elasticity = Elasticity::new(2000.0, 0.0).unwrap();
        let (size, strain) = (0.5, 0.01);
        let positions: Vec<_> = element_class
            .offsets
            .iter()
            .map(|r| *r * 0.25 * DVec3::new(1.0 + strain, 1.0, 1.0))
            .collect();
        let ideal = 2000.0 * strain * (1..D::N).fold(1.0, |area, _| area * size);
        for law in [Law::Endo2004, Law::CorotationalVem] {
            let all = forces(law, elasticity.into(), &element_class, size, &positions);
            let pull: f64 = all
                .iter()
                .zip(&element_class.offsets)
                .filter(|(_, r)| r[0] > 0.0)
                .map(|(force, _)| -force[0])
                .sum();
            assert!(
                (pull / ideal - 1.0).abs() < 1e-9,
                "{law:?}: {pull} of {ideal}"
            );
        }
    }
    check::<Dim2>();
    check::<Dim3>();
}

/// Paper, §3.1: two vertices that have swapped positions are pulled back, because the force takes the
/// element's rotation into account.
#[test]
fn paper_law_pulls_swapped_nodes_back() {
    let element_class = ElementClass::<Dim2>::new(15, cell_corners::<Dim2>()).unwrap();
    let elasticity = Elasticity::new(1000.0, 0.0).unwrap();
    let mut positions = element_class.offsets.clone();
    positions.swap(0, 1);
    let all = forces(
        Law::Endo2004,
        elasticity.into(),
        &element_class,
        2.0,
        &positions,
    );
    let home = |k: usize| element_class.offsets[k][0] - positions[k][0];
    assert!(
        all[0][0] * home(0) > 0.0 && all[1][0] * home(1) > 0.0,
        "{all:?}"
    );
}
