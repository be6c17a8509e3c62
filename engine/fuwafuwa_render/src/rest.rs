//! Smoothing of the voxel staircase of a 2D shape, computed once for the body at rest.
//!
//! Every point of the surface gets an offset, in voxels and in the frame of the body at rest. A deformed body
//! carries the offsets along by the deformation of its voxels. So the skin stays equally smooth after any
//! motion, and no deformation is smoothed away.

use crate::stairs::smoothed;
use fuwafuwa::{Dim2, VoxelGrid};
use glam::Vec2;

/// Steps along the four sides of a voxel, counterclockwise starting with the one to the right.
const STEPS: [[i32; 2]; 4] = [[1, 0], [0, 1], [-1, 0], [0, -1]];
/// Standard deviation of the blur [voxel sides], as a multiple of the square root of the number of sides of a
/// ring (closed line of exposed voxel sides). The longest stair steps of a voxelised disc grow with the same
/// square root.
const REACH: f32 = 0.5;
/// Minimum number of sides of a ring (closed line of exposed voxel sides) that is smoothed. Smaller rings
/// have no staircase, only corners.
pub const SMALL: usize = 12;
/// Maximum offset of a point [voxels], so that a protrusion of a few voxels survives.
const FARTHEST: f32 = 0.9;

/// Smoothing offsets of a voxel shape.
#[derive(Clone, Debug, Default)]
pub struct Rest {
    /// Index of a side in `offsets` by voxel and direction. `u32::MAX` for sides that are not on the surface.
    sides: Vec<u32>,
    /// Offsets at the start and at the end of each side [voxels].
    offsets: Vec<[Vec2; 2]>,
    /// Grid that the offsets belong to.
    grid: Option<VoxelGrid<Dim2>>,
    first_material: u8,
}

impl Rest {
    /// Computes the offsets of a grid.
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

    /// Returns whether these offsets belong to a grid.
    pub fn matches_grid(&self, grid: &VoxelGrid<Dim2>) -> bool {
        self.grid.as_ref() == Some(grid)
    }

    /// Returns the lowest material number in the grid.
    pub fn first_material(&self) -> u8 {
        self.first_material
    }

    /// Returns the offsets [voxels] at the start and at the end of a side of the original surface. The side
    /// runs along `step` with the voxel to its left. Other sides have zero offsets.
    pub fn offsets(&self, grid: &VoxelGrid<Dim2>, voxel: [i32; 3], step: [i32; 2]) -> [Vec2; 2] {
        let direction = STEPS.iter().position(|&known| known == step);
        let side =
            direction.and_then(|direction| self.sides.get(4 * grid.index(voxel) + direction));
        let found = side.and_then(|&side| self.offsets.get(side as usize));
        found.copied().unwrap_or_default()
    }
}

/// Returns whether a side of a solid voxel is on the surface. The side runs in `direction` with the voxel to
/// its left.
fn is_bare(grid: &VoxelGrid<Dim2>, voxel: [i32; 3], direction: usize) -> bool {
    grid.is_solid(voxel) && !grid.is_solid(beside(voxel, (direction + 3) % 4))
}

fn beside([x, y, z]: [i32; 3], direction: usize) -> [i32; 3] {
    let [dx, dy] = STEPS[direction];
    [x + dx, y + dy, z]
}

/// Returns the start point of a side of a voxel.
fn start_of([x, y, _]: [i32; 3], direction: usize) -> Vec2 {
    let [dx, dy] = [[0, 0], [1, 0], [1, 1], [0, 1]][direction];
    Vec2::new((x + dx) as f32, (y + dy) as f32)
}

/// Returns the next exposed side along the surface. Voxels that touch only in a corner are not connected.
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

/// Returns a closed line with its staircase smoothed.
fn without_stairs(ring: &[Vec2]) -> Vec<Vec2> {
    if ring.len() < SMALL {
        return ring.to_vec();
    }
    let reach = REACH * (ring.len() as f32).sqrt();
    smoothed(ring, |ring| blurred(ring, reach))
}

/// Returns a closed line blurred by a Gaussian of standard deviation `sigma` [points].
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

    /// Returns the smoothed surface of a grid as the start points of its sides [voxels].
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
    fn offsets_make_a_disc_round() {
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
    fn rings_separate_voxels_that_touch_in_a_corner() {
        let grid =
            VoxelGrid::<Dim2>::from_fn([2, 2, 1], 1.0, |[x, y, _]| u8::from(x == y)).unwrap();
        let (_, facing) = next_side(&grid, [0, 0, 0], 1);
        assert_eq!(facing, 2, "the ring stays on its voxel");
        assert_eq!(surface(&grid).len(), 8);
    }

    #[test]
    fn matches_grid_rejects_other_grids() {
        let [disc, larger] = [24, 25].map(|n| VoxelGrid::<Dim2>::ball(n, 1.0).unwrap());
        assert!(Rest::new(&disc).matches_grid(&disc));
        assert!(!Rest::new(&disc).matches_grid(&larger));
        let other = VoxelGrid::from_fn([24, 24, 1], disc.voxel_size(), |voxel| {
            3 * disc.material(voxel)
        });
        let other = other.unwrap();
        assert!(!Rest::new(&disc).matches_grid(&other));
        assert_eq!(Rest::new(&other).first_material(), 3);
    }
}
