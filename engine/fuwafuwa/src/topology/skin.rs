//! Smooth surface of a voxel grid: the smooth shape that the voxels approximate.
//!
//! Voxels decide where material is. Rigid shapes, queries and the renderer see the skin; two soft bodies touch at
//! their contact spheres. Each surface point, a lattice point between solid and empty voxels, has an offset to the
//! skin. Offsets are exact if the grid knows its surface (see [`VoxelGrid::from_distance`]); otherwise they smooth
//! the staircase by at most half a voxel on each axis.
//!
//! ```text
//!        ▁▂▃▄▄▃▂▁          skin
//!     ▂▄█████████▄▂
//!   ▗████████████████▖     voxels
//! ```

use crate::foundation::dim::{
    Dim, Point, add, beyond, corner, face_corners, points_in, voxel_around,
};
use crate::topology::grid::VoxelGrid;
use glam::Vec3;

/// Maximum length of an offset that follows from distances [voxels]: the distance of a corner of a voxel from
/// its centre is 0.87, and the surface passes between the centres of solid and empty voxels.
const MAX_OFFSET: f32 = 1.0;
/// Unit in which grids store offsets [1/voxels].
const STEPS: f32 = 64.0;
/// Distance within which voxels decide the direction of an offset [voxels]. With 1, the direction on a ball is
/// wrong by up to 30°.
const AROUND: i32 = 2;
/// Maximum offset by smoothing along each axis [voxels]: the uncertainty of a surface known only by its voxels.
const BAND: f32 = 0.5;
/// Number of faces in a row that make an edge sharp. Balls of up to 64 voxels have no such edge.
const SHARP: i32 = 3;
/// Rounds of smoothing.
const ROUNDS: usize = 60;
/// Step of the descent in smoothing: the largest eigenvalue of the bending energy is 4.
const DESCENT: f32 = 0.22;

/// Smooth surface of a voxel grid.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Skin {
    /// Surface points, as [`surface_points`] returns them.
    points: Vec<Point>,
    /// Offset of each surface point [voxels].
    offsets: Vec<Vec3>,
}

impl Skin {
    /// Returns the skin of a grid.
    #[inline(never)]
    pub fn of<D: Dim>(grid: &VoxelGrid<D>) -> Self {
        let points = surface_points(grid);
        let offsets: Vec<Vec3> = match grid.surface_offsets() {
            Some(known) if known.len() == points.len() => {
                let both = points.iter().zip(known);
                both.map(|(&at, &steps)| outward(grid, at) * (f32::from(steps) / STEPS))
                    .collect()
            }
            _ => smoothed(grid, &points),
        };
        Self { points, offsets }
    }

    /// Returns the offset of a lattice point [voxels]; 0 if the point is not on the original surface.
    pub fn offset(&self, at: Point) -> Vec3 {
        index_of(&self.points, at).map_or(Vec3::ZERO, |index| self.offsets[index])
    }
}

/// Returns the surface points of a grid in memory order of the lattice: the first axis fastest.
pub fn surface_points<D: Dim>(grid: &VoxelGrid<D>) -> Vec<Point> {
    let mut high = grid.size();
    high[D::N..].fill(0);
    let is_surface = |&at: &Point| {
        let voxels = (0..D::CORNERS).map(|octant| voxel_around::<D>(at, octant));
        let solid = voxels.filter(|&voxel| grid.is_solid(voxel)).count();
        (1..D::CORNERS).contains(&solid)
    };
    points_in([0; 3], high).filter(is_surface).collect()
}

/// Returns the index of a lattice point among surface points.
fn index_of(points: &[Point], at: Point) -> Option<usize> {
    let key = |&[x, y, z]: &Point| [z, y, x];
    points.binary_search_by_key(&key(&at), key).ok()
}

/// Returns the offset of each surface point along its outward direction [1/64 voxel]. `distance` is the signed
/// distance [voxels] of a position from the surface [voxels], negative inside.
pub fn measured<D: Dim>(grid: &VoxelGrid<D>, distance: impl Fn(Vec3) -> f32) -> Vec<i8> {
    let along = |at: Point| {
        let (from, out) = (place(at), outward(grid, at));
        let mut offset = 0.0;
        // The distance along `out` differs from the nearest one, so a few steps are required.
        for _ in 0..3 {
            let change = distance(from + out * offset);
            offset = (offset - change).clamp(-MAX_OFFSET, MAX_OFFSET);
        }
        if offset.is_finite() { offset } else { 0.0 }
    };
    let points = surface_points(grid).into_iter();
    points.map(|at| (along(at) * STEPS).round() as i8).collect()
}

/// Returns whether no offset of a grid is longer than [`MAX_OFFSET`].
pub fn are_offsets(steps: &[i8]) -> bool {
    let limit = (MAX_OFFSET * STEPS) as u8;
    steps.iter().all(|steps| steps.unsigned_abs() <= limit)
}

fn place(at: Point) -> Vec3 {
    at.map(|k| k as f32).into()
}

/// Returns the unit direction from the solid to the empty voxels around a lattice point; 0 if there is none.
fn outward<D: Dim>(grid: &VoxelGrid<D>, at: Point) -> Vec3 {
    let (mut low, mut high) = (at, at);
    for axis in 0..D::N {
        low[axis] -= AROUND;
        high[axis] += AROUND - 1;
    }
    let mut sum = Vec3::ZERO;
    for voxel in points_in(low, high).filter(|&voxel| grid.is_solid(voxel)) {
        for axis in 0..D::N {
            sum[axis] -= (voxel[axis] - at[axis]) as f32 + 0.5;
        }
    }
    let length = sum.length();
    if length > 0.0 {
        sum / length
    } else {
        Vec3::ZERO
    }
}

/// Returns offsets that smooth the staircase of a grid: they minimise the bending of the surface, within
/// [`BAND`], by accelerated gradient descent [Beck 2009]. Sharp edges stay.
fn smoothed<D: Dim>(grid: &VoxelGrid<D>, points: &[Point]) -> Vec<Vec3> {
    let neighbours = neighbours(grid, points);
    let is_sharp = points.iter().map(|&at| is_sharp(grid, at));
    let is_sharp: Vec<bool> = is_sharp.collect();
    let rest: Vec<Vec3> = points.iter().map(|&at| place(at)).collect();
    let mean = |values: &[Vec3], k: usize| {
        let sum: Vec3 = neighbours[k]
            .iter()
            .map(|&other| values[other as usize])
            .sum();
        sum / neighbours[k].len() as f32
    };
    let (mut now, mut before) = (rest.clone(), rest.clone());
    let (mut ahead, mut bending) = (rest.clone(), vec![Vec3::ZERO; rest.len()]);
    let mut inertia = 1.0f32;
    for _ in 0..ROUNDS {
        let next = 0.5 * (1.0 + (1.0 + 4.0 * inertia * inertia).sqrt());
        let share = (inertia - 1.0) / next;
        inertia = next;
        for k in 0..rest.len() {
            ahead[k] = now[k] + (now[k] - before[k]) * share;
        }
        for k in (0..rest.len()).filter(|&k| !is_sharp[k]) {
            bending[k] = ahead[k] - mean(&ahead, k);
        }
        before.clone_from(&now);
        for k in (0..rest.len()).filter(|&k| !is_sharp[k]) {
            let mut slope = bending[k];
            for &other in &neighbours[k] {
                let other = other as usize;
                slope -= bending[other] / neighbours[other].len() as f32;
            }
            let offset = ahead[k] - slope * DESCENT - rest[k];
            now[k] = rest[k] + offset.clamp(Vec3::splat(-BAND), Vec3::splat(BAND));
        }
    }
    now.iter()
        .zip(&rest)
        .map(|(now, rest)| now - rest)
        .collect()
}

/// Returns the neighbours of each surface point along the edges of bare faces, ascending.
fn neighbours<D: Dim>(grid: &VoxelGrid<D>, points: &[Point]) -> Vec<Vec<u32>> {
    let mut neighbours: Vec<Vec<u32>> = vec![Vec::new(); points.len()];
    let corners = D::CORNERS / 2;
    for voxel in grid.voxels().filter(|&voxel| grid.is_solid(voxel)) {
        for face in (0..2 * D::N).filter(|&face| !grid.is_solid(beyond(voxel, face))) {
            let ring = face_corners::<D>(face).map(|k| index_of(points, add(voxel, corner(k))));
            for k in 0..corners {
                let (Some(a), Some(b)) = (ring[k], ring[(k + 1) % corners]) else {
                    continue;
                };
                neighbours[a].push(b as u32);
                neighbours[b].push(a as u32);
            }
        }
    }
    for list in &mut neighbours {
        list.sort_unstable();
        list.dedup();
    }
    neighbours
}

/// Returns whether a surface point is on a sharp edge: two faces meet in the edge, and both go on from the
/// edge for [`SHARP`] voxels, or up to another edge of the same kind (thin limbs and small boxes).
fn is_sharp<D: Dim>(grid: &VoxelGrid<D>, at: Point) -> bool {
    let faces = 2 * D::N;
    (0..faces).any(|a| {
        (0..faces).filter(|b| b / 2 != a / 2).any(|b| {
            // At a convex edge, face `a` goes on from the edge against the direction of face `b`; at a hollow
            // edge, along it.
            let convex = goes_on(grid, at, a, b ^ 1) && goes_on(grid, at, b, a ^ 1);
            let hollow = goes_on(grid, at, a, b) && goes_on(grid, at, b, a);
            convex && !touches(grid, at, a, b) || hollow && !touches(grid, at, a, b ^ 1)
        })
    })
}

/// Returns the voxels around a lattice point that lie on the side `way` and have a bare face `face` at the point.
fn voxels_at<D: Dim>(
    grid: &VoxelGrid<D>,
    at: Point,
    face: usize,
    way: usize,
) -> impl Iterator<Item = Point> {
    let is_side = |octant: usize, face: usize| octant >> (face / 2) & 1 == face & 1;
    // The voxel is behind its face, and on the given side.
    let octants =
        (0..D::CORNERS).filter(move |&octant| !is_side(octant, face) && is_side(octant, way));
    let voxels = octants.map(move |octant| voxel_around::<D>(at, octant));
    voxels.filter(move |&voxel| is_bare(grid, voxel, face))
}

fn is_bare<D: Dim>(grid: &VoxelGrid<D>, voxel: Point, face: usize) -> bool {
    grid.is_solid(voxel) && !grid.is_solid(beyond(voxel, face))
}

/// Returns whether a bare face `face` touches a lattice point on the side `way`.
fn touches<D: Dim>(grid: &VoxelGrid<D>, at: Point, face: usize, way: usize) -> bool {
    voxels_at(grid, at, face, way).next().is_some()
}

/// Returns whether the bare faces `face` that begin at a lattice point go on in the direction `way` for
/// [`SHARP`] voxels, or end earlier at a convex edge that faces another convex edge.
fn goes_on<D: Dim>(grid: &VoxelGrid<D>, at: Point, face: usize, way: usize) -> bool {
    let mut voxels = voxels_at(grid, at, face, way);
    voxels.any(|first| {
        let starts_convex = !grid.is_solid(beyond(first, way ^ 1));
        let mut voxel = first;
        for _ in 1..SHARP {
            let next = beyond(voxel, way);
            if !is_bare(grid, next, face) {
                return starts_convex && !grid.is_solid(next);
            }
            voxel = next;
        }
        true
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::foundation::dim::{Dim2, Dim3};

    fn lengths<D: Dim>(grid: &VoxelGrid<D>) -> Vec<(Point, Vec3)> {
        let skin = Skin::of(grid);
        let points = skin.points.iter().copied();
        points.zip(skin.offsets.iter().copied()).collect()
    }

    fn check_ball<D: Dim>(n: usize) {
        let grid = VoxelGrid::<D>::ball(n, 1.0).unwrap();
        let mut centre = Vec3::splat(0.5 * n as f32);
        centre.as_mut()[D::N..].fill(0.0);
        for (at, offset) in lengths(&grid) {
            let radius = (place(at) + offset - centre).length();
            let theory = 0.5 * n as f32 - 0.5;
            assert!((radius - theory).abs() < 0.02, "{n}: {radius} at {at:?}");
        }
    }

    #[test]
    fn skin_of_a_ball_is_round() {
        for n in [8, 16, 31] {
            check_ball::<Dim2>(n);
            check_ball::<Dim3>(n);
        }
    }

    #[test]
    fn smoothed_ball_is_rounder_than_its_voxels() {
        for n in [16, 32] {
            let ball = VoxelGrid::<Dim3>::ball(n, 1.0).unwrap();
            let grid = VoxelGrid::<Dim3>::from_fn([n; 3], 1.0, |at| ball.material(at)).unwrap();
            let half = 0.5 * n as f32;
            let spread = |with: f32| {
                let radii = lengths(&grid).into_iter();
                let radii = radii.map(|(at, by)| (place(at) + by * with - half).length());
                let (low, high) = radii.fold((f32::MAX, 0.0f32), |(low, high), radius| {
                    (low.min(radius), high.max(radius))
                });
                high - low
            };
            assert!(
                spread(1.0) < 0.5 * spread(0.0),
                "{} {}",
                spread(1.0),
                spread(0.0)
            );
        }
    }

    #[test]
    fn boxes_and_limbs_stay_sharp() {
        for size in [[1, 1, 1], [2, 2, 2], [7, 3, 4], [9, 1, 1]] {
            let grid = VoxelGrid::<Dim3>::from_fn(size, 1.0, |_| 1).unwrap();
            assert!(
                lengths(&grid).iter().all(|(_, by)| *by == Vec3::ZERO),
                "{size:?}"
            );
        }
        let limb = |[x, y, _]: Point| u8::from(y < 4 || (4..6).contains(&x));
        let grid = VoxelGrid::<Dim2>::from_fn([10, 9, 1], 1.0, limb).unwrap();
        assert!(lengths(&grid).iter().all(|(_, by)| *by == Vec3::ZERO));
    }

    #[test]
    fn staircases_become_slopes() {
        for tread in [1, 2, 3] {
            let stair = |[x, y, _]: Point| u8::from(tread * y < x + 6);
            let grid = VoxelGrid::<Dim2>::from_fn([48, 60, 1], 1.0, stair).unwrap();
            let inner = lengths(&grid)
                .into_iter()
                .filter(|(at, _)| at[0] > 12 && at[0] < 36 && at[1] > 1 && at[1] < 55);
            let heights = inner.map(|(at, by)| {
                let at = place(at) + by;
                at.y - at.x / tread as f32
            });
            let (low, high) = heights.fold((f32::MAX, f32::MIN), |(low, high), height| {
                (low.min(height), high.max(height))
            });
            assert!(high - low < 0.15, "{tread}: {low} to {high}");
        }
    }
}
