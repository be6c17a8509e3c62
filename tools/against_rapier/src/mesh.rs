//! Splits voxels into the triangles and tetrahedra of Rapier's soft bodies.

use fuwafuwa::inspect::{add, corner};
use fuwafuwa::{Dim, Dim2, Dim3, Point, VoxelGrid};

/// Simplices with `K` corners that fill the solid voxels of a grid without gaps or overlaps.
pub struct Simplices<const K: usize> {
    /// Edge length of a voxel [m].
    pub voxel_size: f32,
    /// Node positions [m]. The middle of the grid is at the origin, except that the lowest node has height 0.
    pub positions: Vec<[f32; 3]>,
    /// Volume (2D: area) that belongs to each node, from the voxels around it [m³ or m²].
    pub volumes: Vec<f32>,
    /// Corner nodes of each simplex.
    pub cells: Vec<[u32; K]>,
}

/// Triangles of a voxel. Diagonals alternate from voxel to voxel, so that the mesh has no preferred
/// direction.
///
/// ```text
///   ┌────┬────┐
///   │  ╱ │ ╲  │
///   │ ╱  │  ╲ │
///   └────┴────┘
///    even odd
/// ```
const TRIANGLES: [&[[usize; 3]]; 2] = [&[[0, 1, 3], [0, 3, 2]], &[[0, 1, 2], [1, 3, 2]]];

/// Five tetrahedra of a voxel, mirrored from voxel to voxel, so that neighbours agree on the diagonals of
/// shared faces. Same as in Rapier's `SoftBodyBuilder::cuboid`.
const TETRAHEDRA: [&[[usize; 4]]; 2] = [
    &[
        [0, 3, 5, 6],
        [1, 0, 3, 5],
        [2, 0, 3, 6],
        [4, 0, 5, 6],
        [7, 3, 5, 6],
    ],
    &[
        [1, 2, 4, 7],
        [0, 1, 2, 4],
        [3, 1, 2, 7],
        [5, 1, 4, 7],
        [6, 2, 4, 7],
    ],
];

impl Simplices<3> {
    /// Returns two triangles per voxel.
    pub fn triangles(grid: &VoxelGrid<Dim2>) -> Self {
        Self::fill(grid, TRIANGLES)
    }
}

impl Simplices<4> {
    /// Returns five tetrahedra per voxel.
    pub fn tetrahedra(grid: &VoxelGrid<Dim3>) -> Self {
        Self::fill(grid, TETRAHEDRA)
    }
}

impl<const K: usize> Simplices<K> {
    /// Fills the solid voxels of a grid with simplices. `splits` are the simplices of a voxel whose
    /// coordinates have an even sum, and of one with an odd sum.
    fn fill<D: Dim>(grid: &VoxelGrid<D>, splits: [&[[usize; K]]; 2]) -> Self {
        let voxel_size = grid.voxel_size();
        let share = voxel_size.powi(D::N as i32) / D::CORNERS as f32;
        let mut nodes = Nodes::new(grid.size());
        let (mut volumes, mut cells) = (Vec::new(), Vec::new());
        for voxel in grid.voxels().filter(|&voxel| grid.is_solid(voxel)) {
            let corners: Vec<u32> = (0..D::CORNERS)
                .map(|index| nodes.at(add(voxel, corner(index))))
                .collect();
            volumes.resize(nodes.points.len(), 0.0);
            corners
                .iter()
                .for_each(|&node| volumes[node as usize] += share);
            let odd = voxel.iter().sum::<i32>() & 1;
            cells.extend(
                splits[odd as usize]
                    .iter()
                    .map(|cell| cell.map(|k| corners[k])),
            );
        }
        let lowest = nodes.points.iter().map(|point| point[1]).min().unwrap_or(0);
        let middle = grid.size().map(|extent| extent as f32 * 0.5);
        let place = |point: &Point| {
            let [x, y, z] = *point;
            [
                x as f32 - middle[0],
                (y - lowest) as f32,
                z as f32 - middle[2],
            ]
            .map(|k| k * voxel_size)
        };
        Self {
            voxel_size,
            positions: nodes.points.iter().map(place).collect(),
            volumes,
            cells,
        }
    }
}

/// Lattice points in use, numbered in the order of first use.
struct Nodes {
    size: Point,
    /// Number of each lattice point, or [`u32::MAX`] while it is unused.
    numbers: Vec<u32>,
    points: Vec<Point>,
}

impl Nodes {
    fn new(voxels: Point) -> Self {
        let size = voxels.map(|extent| extent + 1);
        Self {
            size,
            numbers: vec![u32::MAX; size.iter().map(|&extent| extent as usize).product()],
            points: Vec::new(),
        }
    }

    fn at(&mut self, point: Point) -> u32 {
        let place = (point[2] * self.size[1] + point[1]) * self.size[0] + point[0];
        let number = &mut self.numbers[place as usize];
        if *number == u32::MAX {
            *number = self.points.len() as u32;
            self.points.push(point);
        }
        *number
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn simplices_fill_the_solid_voxels() {
        let disc = VoxelGrid::<Dim2>::ball(16, 1.0).expect("a disc of 16 voxels");
        let triangles = Simplices::triangles(&disc);
        assert_eq!(triangles.cells.len(), 2 * disc.solid_count());
        let area: f32 = triangles
            .cells
            .iter()
            .map(|cell| area(&triangles.positions, cell))
            .sum();
        let shares: f32 = triangles.volumes.iter().sum();
        let expected = disc.solid_count() as f32 / 256.0;
        assert!((area - expected).abs() < 1e-4, "{area} is not {expected}");
        assert!(
            (shares - expected).abs() < 1e-4,
            "{shares} is not {expected}"
        );

        let ball = VoxelGrid::<Dim3>::ball(8, 1.0).expect("a ball of 8 voxels");
        let tetrahedra = Simplices::tetrahedra(&ball);
        let volume: f32 = tetrahedra
            .cells
            .iter()
            .map(|cell| volume(&tetrahedra.positions, cell))
            .sum();
        let expected = ball.solid_count() as f32 / 512.0;
        assert!(
            (volume - expected).abs() < 1e-4,
            "{volume} is not {expected}"
        );
    }

    /// Both voxels must divide their shared face into the same two triangles.
    #[test]
    fn neighbouring_tetrahedra_share_their_faces() {
        let pair = VoxelGrid::<Dim3>::from_fn([2, 1, 1], 1.0, |_| 1).expect("two voxels");
        let mesh = Simplices::tetrahedra(&pair);
        let on_the_border = |cell: &[u32; 4]| {
            let mut side: Vec<u32> = cell
                .iter()
                .copied()
                .filter(|&k| mesh.positions[k as usize][0] == 0.0)
                .collect();
            side.sort_unstable();
            (side.len() == 3).then_some(side)
        };
        let mut sides: Vec<Vec<u32>> = mesh.cells.iter().filter_map(on_the_border).collect();
        sides.sort();
        assert_eq!(sides.len(), 4);
        assert_eq!((&sides[0], &sides[2]), (&sides[1], &sides[3]));
    }

    fn difference(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
        [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
    }

    fn area(positions: &[[f32; 3]], cell: &[u32; 3]) -> f32 {
        let [a, b, c] = cell.map(|k| positions[k as usize]);
        let (u, v) = (difference(b, a), difference(c, a));
        (u[0] * v[1] - u[1] * v[0]).abs() / 2.0
    }

    fn volume(positions: &[[f32; 3]], cell: &[u32; 4]) -> f32 {
        let [a, b, c, d] = cell.map(|k| positions[k as usize]);
        let (u, v, w) = (difference(b, a), difference(c, a), difference(d, a));
        let cross = [
            u[1] * v[2] - u[2] * v[1],
            u[2] * v[0] - u[0] * v[2],
            u[0] * v[1] - u[1] * v[0],
        ];
        (cross[0] * w[0] + cross[1] * w[1] + cross[2] * w[2]).abs() / 6.0
    }
}
