//! How the stairs of a voxel shape are smoothed, once, before it moves.
//!
//! Every point of the surface gets an offset, in voxels and in the frame of the body at rest. A
//! deformed body carries the offsets along by the deformation of its voxels: so the skin is as
//! smooth after any motion as before, and no squash is smoothed away.

use crate::stairs::smoothed;
use fuwafuwa::{Dim2, VoxelGrid};
use glam::Vec2;

/// Steps to the four sides, anticlockwise from the right.
const STEPS: [[i32; 2]; 4] = [[1, 0], [0, 1], [-1, 0], [0, -1]];
/// How far the smoothing reaches, as a standard deviation: this many times the root of the number
/// of sides of the ring, in sides. The longest stairs of a disc, where it is flat, grow like that.
const REACH: f32 = 0.5;
/// Rings of fewer sides have no stairs, only corners.
pub const SMALL: usize = 12;
/// A point is not moved by more [voxels], so that a nose of a few voxels stays a nose.
const FARTHEST: f32 = 0.9;

/// The offsets of a voxel shape.
#[derive(Clone, Debug, Default)]
pub struct Rest {
    /// By voxel and direction: the place of a side in `offsets`, or none.
    sides: Vec<u32>,
    /// At the start and at the end of a side [voxels].
    offsets: Vec<[Vec2; 2]>,
    /// The grid they belong to.
    grid: Option<VoxelGrid<Dim2>>,
    first_material: u8,
}

impl Rest {
    /// Finds the offsets of a grid.
    pub fn new(grid: &VoxelGrid<Dim2>) -> Self {
        let mut sides = vec![u32::MAX; 4 * grid.voxels().count()];
        let mut offsets = Vec::new();
        for start in grid.voxels() {
            for direction in 0..4 {
                if !is_bare(grid, start, direction)
                    || sides[4 * grid.index(start) + direction] != u32::MAX
                {
                    continue;
                }
                let mut ring = Vec::new();
                let (mut voxel, mut facing) = (start, direction);
                loop {
                    let side = &mut sides[4 * grid.index(voxel) + facing];
                    if *side != u32::MAX {
                        break;
                    }
                    *side = (offsets.len() + ring.len()) as u32;
                    ring.push(start_of(voxel, facing));
                    (voxel, facing) = next_side(grid, voxel, facing);
                }
                let moved = without_stairs(&ring);
                let moved: Vec<Vec2> = moved
                    .iter()
                    .zip(&ring)
                    .map(|(a, b)| (a - b).clamp_length_max(FARTHEST))
                    .collect();
                let next = moved.iter().cycle().skip(1);
                offsets.extend(moved.iter().zip(next).map(|(a, b)| [*a, *b]));
            }
        }
        let materials = grid.voxels().map(|voxel| grid.material(voxel));
        Self {
            sides,
            offsets,
            grid: Some(grid.clone()),
            first_material: materials.filter(|&number| number > 0).min().unwrap_or(1),
        }
    }

    /// Whether these are the offsets of a grid.
    pub fn fits(&self, grid: &VoxelGrid<Dim2>) -> bool {
        self.grid.as_ref() == Some(grid)
    }

    /// The lowest number of a material in the grid.
    pub fn first_material(&self) -> u8 {
        self.first_material
    }

    /// The offsets [voxels] at the start and at the end of a side of the original surface, which
    /// runs along `step` with the voxel to its left.
    pub fn offsets(&self, grid: &VoxelGrid<Dim2>, voxel: [i32; 3], step: [i32; 2]) -> [Vec2; 2] {
        let direction = STEPS.iter().position(|&known| known == step);
        let side =
            direction.and_then(|direction| self.sides.get(4 * grid.index(voxel) + direction));
        let found = side.and_then(|&side| self.offsets.get(side as usize));
        found.copied().unwrap_or_default()
    }
}

/// Whether the side of a solid voxel that runs in a direction, the voxel to its left, is bare.
fn is_bare(grid: &VoxelGrid<Dim2>, voxel: [i32; 3], direction: usize) -> bool {
    grid.is_solid(voxel) && !grid.is_solid(beside(voxel, (direction + 3) % 4))
}

fn beside([x, y, z]: [i32; 3], direction: usize) -> [i32; 3] {
    let [dx, dy] = STEPS[direction];
    [x + dx, y + dy, z]
}

/// Where a side of a voxel begins.
fn start_of([x, y, _]: [i32; 3], direction: usize) -> Vec2 {
    let [dx, dy] = [[0, 0], [1, 0], [1, 1], [0, 1]][direction];
    Vec2::new((x + dx) as f32, (y + dy) as f32)
}

/// The side that goes on where one ends. Voxels that only meet in a corner do not hang together.
fn next_side(grid: &VoxelGrid<Dim2>, voxel: [i32; 3], direction: usize) -> ([i32; 3], usize) {
    let ahead = beside(voxel, direction);
    let right = beside(ahead, (direction + 3) % 4);
    if !grid.is_solid(ahead) {
        (voxel, (direction + 1) % 4)
    } else if !grid.is_solid(right) {
        (ahead, direction)
    } else {
        (right, (direction + 3) % 4)
    }
}

/// A closed line without its stairs.
fn without_stairs(ring: &[Vec2]) -> Vec<Vec2> {
    if ring.len() < SMALL {
        return ring.to_vec();
    }
    let reach = REACH * (ring.len() as f32).sqrt();
    smoothed(ring, |ring| blurred(ring, reach))
}

/// A closed line, each point of it moved to the mean of those around it, by a bell curve of a
/// standard deviation [points].
fn blurred(ring: &[Vec2], sigma: f32) -> Vec<Vec2> {
    let count = ring.len() as i32;
    let reach = (3.0 * sigma).ceil() as i32;
    let weight = |k: i32| (-0.5 * (k * k) as f32 / (sigma * sigma)).exp();
    let total: f32 = (-reach..=reach).map(weight).sum();
    let mean = |at: i32| {
        let around = (-reach..=reach).map(|k| {
            let place = (at + k).rem_euclid(count) as usize;
            weight(k) / total * ring[place]
        });
        around.sum()
    };
    (0..count).map(mean).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The smoothed surface of a disc [voxels], as the starts of its sides.
    fn surface(grid: &VoxelGrid<Dim2>) -> Vec<Vec2> {
        let rest = Rest::new(grid);
        let mut points = Vec::new();
        for voxel in grid.voxels() {
            for direction in (0..4).filter(|&direction| is_bare(grid, voxel, direction)) {
                let [offset, _] = rest.offsets(grid, voxel, STEPS[direction]);
                points.push(start_of(voxel, direction) + offset);
            }
        }
        points
    }

    #[test]
    fn a_disc_is_round_before_its_curve_smooths_it_further() {
        for n in [24, 64, 128] {
            let grid = VoxelGrid::<Dim2>::ball(n, 1.0).unwrap();
            let half = 0.5 * n as f32;
            let radii: Vec<f32> = surface(&grid)
                .iter()
                .map(|place| place.distance(Vec2::splat(half)))
                .collect();
            let round = (grid.solid_count() as f32 / std::f32::consts::PI).sqrt();
            for radius in radii {
                assert!(
                    (radius - round).abs() < 0.3,
                    "n = {n}: {radius}, not {round}"
                );
            }
        }
    }

    #[test]
    fn voxels_that_meet_in_a_corner_stay_apart() {
        let grid =
            VoxelGrid::<Dim2>::from_fn([2, 2, 1], 1.0, |[x, y, _]| u8::from(x == y)).unwrap();
        let (_, facing) = next_side(&grid, [0, 0, 0], 1);
        assert_eq!(facing, 2, "around its own voxel");
        assert_eq!(surface(&grid).len(), 8);
    }

    #[test]
    fn another_shape_does_not_fit() {
        let [disc, larger] = [24, 25].map(|n| VoxelGrid::<Dim2>::ball(n, 1.0).unwrap());
        assert!(Rest::new(&disc).fits(&disc));
        assert!(!Rest::new(&disc).fits(&larger));
        let other = VoxelGrid::from_fn([24, 24, 1], disc.voxel_size(), |voxel| {
            3 * disc.material(voxel)
        });
        let other = other.unwrap();
        assert!(!Rest::new(&disc).fits(&other));
        assert_eq!(Rest::new(&other).first_material(), 3);
    }
}
