//! How the stairs of a voxel shape in space are smoothed, once, before it moves.
//!
//! As in the plane: every point of the surface gets an offset, in voxels and in the frame of the
//! body at rest, and a deformed body carries the offsets along.

use crate::stairs::smoothed;
use fuwafuwa::dim::{add, corner, face_corners, points_in, voxel_around};
use fuwafuwa::sharing::{Connectivity, Groups};
use fuwafuwa::{Dim, Dim3, Point, VoxelGrid};
use glam::Vec3;

/// The variance of the smoothing [voxels²] as a share of the root of the number of faces of the
/// surface. The widest terraces of a ball, where it is flat, grow like that.
const REACH: f32 = 0.45;
/// What a round adds to the variance of a flat surface [voxels²]: half of the way to the mean of four
/// neighbours, of which two are a voxel away along each axis.
const VARIANCE: f32 = 0.25;
/// Rounds at most, so that the largest bodies are ready in a moment.
const MOST_ROUNDS: usize = 200;
/// A point is not moved by more [voxels] where the body is thin and where it is thick around it: so a
/// nose of a few voxels stays a nose.
const FARTHEST: [f32; 2] = [0.3, 0.8];
/// What is thin and what is thick: the share of voxels that are solid around a point, out to `AROUND`.
/// A flat surface has 0.5, an edge and a limb three voxels wide have 0.25.
const SOLID: [f32; 2] = [0.22, 0.32];
const AROUND: i32 = 3;
/// Rounds in which the materials of neighbours are mixed: stairs between two of them go as far as that reaches.
const TINT_ROUNDS: usize = 12;
/// A point in the midst of a material keeps so much of it, and one apart from it gets no more than what is left of 1: so a
/// dot of few voxels stays one.
const KEPT: f32 = 0.52;
/// A point with less of a second material is not beside a border.
const BESIDE: f32 = 0.1;
/// How much the voxels around a point inside count, along each axis.
const AROUND_INSIDE: [f32; 4] = [1.0, 3.0, 3.0, 1.0];
/// How far points inside the body are moved off the lattice at most, along each axis [voxels]: more
/// looks rougher, and lets faces turn over.
const ROUGHNESS: f32 = 0.45;

/// The offsets of a voxel shape.
#[derive(Clone, Debug, Default)]
pub struct Rest {
    /// By lattice point: the first of its entries in `points`, or none.
    first: Vec<u32>,
    /// Lattice point by lattice point.
    points: Vec<RestPoint>,
    /// The grid they belong to.
    grid: Option<VoxelGrid<Dim3>>,
    /// The greatest number of a material in it.
    materials: u8,
}

/// What the voxels of a group around a lattice point share on the surface.
#[derive(Copy, Clone, Debug)]
struct RestPoint {
    at: Point,
    /// The voxels, as a mask of octants.
    group: u8,
    /// [voxels]
    offset: Vec3,
    tint: Tint,
}

/// The materials around a point, smoothed too, so that the border of two is a line without stairs.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct Tint {
    /// The numbers of the two that there is most of, the lower one first; away from a border the same twice.
    pub materials: [u8; 2],
    /// On which side of their border it is: towards 0 on that of the first one, 0.5 on the border.
    pub side: f32,
}

/// The two materials that there is most of, and how much there is.
#[derive(Copy, Clone, Debug, Default)]
struct Most([(u8, f32); 2]);

impl Most {
    fn add(&mut self, material: u8, share: f32) {
        let [first, second] = &mut self.0;
        if share > first.1 {
            (*second, *first) = (*first, (material, share));
        } else if share > second.1 {
            *second = (material, share);
        }
    }

    fn tint(self) -> Tint {
        let [(first, more), (second, less)] = self.0;
        let share = less / (more + less).max(1e-6);
        let materials = match share < BESIDE {
            true => [first; 2],
            false => [first.min(second), first.max(second)],
        };
        let side = if first < second { share } else { 1.0 - share };
        Tint { materials, side }
    }
}

const NONE: u32 = u32::MAX;

impl Rest {
    /// Finds the offsets of a grid.
    pub fn new(grid: &VoxelGrid<Dim3>) -> Self {
        let sharing = Connectivity::new(grid);
        let materials = grid.voxels().map(|voxel| grid.material(voxel));
        let mut rest = Self {
            first: vec![NONE; sharing.point_count()],
            points: Vec::new(),
            grid: Some(grid.clone()),
            materials: materials.max().unwrap_or(0),
        };
        for at in sharing.points() {
            let groups = sharing.groups(at);
            if groups == Groups::NONE || groups == Groups::joined(Dim3::ALL_CORNERS) {
                continue;
            }
            rest.first[sharing.index(at)] = rest.points.len() as u32;
            rest.points.extend(groups.iter().map(|group| RestPoint {
                at,
                group,
                offset: Vec3::ZERO,
                tint: Tint::default(),
            }));
        }
        let (neighbours, face_count) = rest.neighbours(grid);
        let places: Vec<Vec3> = rest.points.iter().map(|point| place(point.at)).collect();
        let variance = REACH * (face_count as f32).sqrt();
        let rounds = ((variance / VARIANCE) as usize).min(MOST_ROUNDS);
        let smooth = smoothed(&places, |places| blurred(places, &neighbours, rounds));
        for (point, (&to, &from)) in rest.points.iter_mut().zip(smooth.iter().zip(&places)) {
            point.offset = (to - from).clamp_length_max(farthest(grid, point.at));
        }
        rest.find_tints(grid, &neighbours);
        rest
    }

    /// Whether these are the offsets of a grid.
    pub fn fits(&self, grid: &VoxelGrid<Dim3>) -> bool {
        self.grid.as_ref() == Some(grid)
    }

    /// How far a point is moved [voxels], as the voxel in an octant of it sees it: on the original
    /// surface so that stairs go, inside so that it is rough. It is the same on both lips of a crack.
    pub fn offset(&self, at: Point, octant: usize) -> Vec3 {
        match self.find(at, octant) {
            Some(found) => self.points[found as usize].offset,
            None => {
                let grain = Vec3::from([0, 1, 2].map(|axis| grain(at, axis)));
                ROUGHNESS * (2.0 * grain - 1.0)
            }
        }
    }

    /// The materials of a point, as the voxel in an octant of it sees it.
    pub fn tint(&self, at: Point, octant: usize) -> Tint {
        match self.find(at, octant) {
            Some(found) => self.points[found as usize].tint,
            None => self.tint_inside(at),
        }
    }

    fn tint_inside(&self, at: Point) -> Tint {
        let mut most = Most::default();
        let mut shares = [0.0; 256];
        if let Some(grid) = self.grid.as_ref().filter(|_| self.materials > 1) {
            for voxel in points_in(at.map(|k| k - 2), at.map(|k| k + 1)) {
                let weights = [0, 1, 2].map(|k| AROUND_INSIDE[(voxel[k] - at[k] + 2) as usize]);
                shares[usize::from(grid.material(voxel))] += weights.iter().product::<f32>();
            }
        }
        for material in 1..=self.materials {
            most.add(material, shares[usize::from(material)]);
        }
        most.tint()
    }

    fn find(&self, at: Point, octant: usize) -> Option<u32> {
        let size = self.grid.as_ref()?.size().map(|side| side + 1);
        let index = (at[2] * size[1] + at[1]) * size[0] + at[0];
        let first = *self.first.get(index as usize)?;
        let rest = self.points.get(first as usize..)?;
        let own = rest.iter().take(8).take_while(|point| point.at == at);
        let place = own
            .map(|point| point.group)
            .position(|group| group >> octant & 1 == 1);
        Some(first + place? as u32)
    }

    fn find_tints(&mut self, grid: &VoxelGrid<Dim3>, neighbours: &[Vec<u32>]) {
        let mut most = vec![Most::default(); self.points.len()];
        for material in 1..=self.materials {
            let own = |point: &RestPoint| {
                let octants = (0..8).filter(|octant| point.group >> octant & 1 == 1);
                let voxels = octants.map(|octant| voxel_around::<Dim3>(point.at, octant));
                let count = voxels.filter(|&voxel| grid.material(voxel) == material);
                count.count() as f32 / point.group.count_ones() as f32
            };
            let own: Vec<f32> = self.points.iter().map(own).collect();
            if own.iter().all(|&share| share == 0.0) {
                continue;
            }
            for (most, share) in most.iter_mut().zip(mingled(&own, neighbours)) {
                most.add(material, share);
            }
        }
        for (point, most) in self.points.iter_mut().zip(most) {
            point.tint = most.tint();
        }
    }

    /// The neighbours of each point along the edges of bare faces, and how many faces there are.
    fn neighbours(&self, grid: &VoxelGrid<Dim3>) -> (Vec<Vec<u32>>, usize) {
        let mut neighbours: Vec<Vec<u32>> = vec![Vec::new(); self.points.len()];
        let mut face_count = 0;
        for voxel in grid.voxels().filter(|&voxel| grid.is_solid(voxel)) {
            for face in 0..6 {
                let mut beyond = voxel;
                beyond[face / 2] += 2 * (face % 2) as i32 - 1;
                if grid.is_solid(beyond) {
                    continue;
                }
                face_count += 1;
                let ring = face_corners::<Dim3>(face)
                    .map(|vertex| self.find(add(voxel, corner(vertex)), 7 - vertex));
                for k in 0..4 {
                    let (Some(a), Some(b)) = (ring[k], ring[(k + 1) % 4]) else {
                        continue;
                    };
                    for (one, other) in [(a, b), (b, a)] {
                        let near = &mut neighbours[one as usize];
                        if !near.contains(&other) {
                            near.push(other);
                        }
                    }
                }
            }
        }
        (neighbours, face_count)
    }
}

fn place(at: Point) -> Vec3 {
    at.map(|k| k as f32).into()
}

/// A surface after some rounds, in each of which every point goes half of the way to the mean of its neighbours.
fn blurred(places: &[Vec3], neighbours: &[Vec<u32>], rounds: usize) -> Vec<Vec3> {
    let mut now = places.to_vec();
    let mut next = now.clone();
    for _ in 0..rounds {
        for (to, (from, near)) in next.iter_mut().zip(now.iter().zip(neighbours)) {
            let sum: Vec3 = near.iter().map(|&k| now[k as usize]).sum();
            *to = from.midpoint(sum / near.len().max(1) as f32);
        }
        std::mem::swap(&mut now, &mut next);
    }
    now
}

/// The shares of a material after the rounds in which neighbours mix theirs.
fn mingled(own: &[f32], neighbours: &[Vec<u32>]) -> Vec<f32> {
    let mut shares = own.to_vec();
    for _ in 0..TINT_ROUNDS {
        let mixed = |(k, near): (usize, &Vec<u32>)| {
            let sum: f32 = near.iter().map(|&k| shares[k as usize]).sum();
            let share = 0.5 * (shares[k] + sum / near.len().max(1) as f32);
            match own[k] {
                0.0 => share.min(1.0 - KEPT),
                1.0 => share.max(KEPT),
                _ => share,
            }
        };
        shares = neighbours.iter().enumerate().map(mixed).collect();
    }
    shares
}

/// How far a point may be moved [voxels].
fn farthest(grid: &VoxelGrid<Dim3>, at: Point) -> f32 {
    let low = at.map(|k| k - AROUND);
    let high = at.map(|k| k + AROUND - 1);
    let solid = points_in(low, high)
        .filter(|&voxel| grid.is_solid(voxel))
        .count();
    let share = solid as f32 / (8 * AROUND * AROUND * AROUND) as f32;
    let thick = ((share - SOLID[0]) / (SOLID[1] - SOLID[0])).clamp(0.0, 1.0);
    FARTHEST[0] + (FARTHEST[1] - FARTHEST[0]) * thick
}

/// A number that a lattice point keeps for each axis, 0 to 1.
fn grain(at: Point, axis: u32) -> f32 {
    let [x, y, z] = at.map(|k| k as u32);
    let mixed =
        x.wrapping_mul(0x9e37_79b1) ^ y.wrapping_mul(0x85eb_ca77) ^ z.wrapping_mul(0xc2b2_ae3d);
    let mixed = (mixed ^ mixed >> 15)
        .wrapping_add(axis.wrapping_mul(0x27d4_eb2f))
        .wrapping_mul(0x2c1b_3c6d);
    let mixed = (mixed ^ mixed >> 13).wrapping_mul(0x297a_2d39);
    (mixed >> 16) as f32 / 65535.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ball_is_round() {
        for n in [12, 32] {
            let grid = VoxelGrid::<Dim3>::ball(n, 1.0).unwrap();
            let rest = Rest::new(&grid);
            let half = 0.5 * n as f32;
            let round = (grid.solid_count() as f32 * 0.75 / std::f32::consts::PI).cbrt();
            for point in &rest.points {
                let at = place(point.at) + point.offset;
                let radius = at.distance(Vec3::splat(half));
                assert!(
                    (radius - round).abs() < 0.35,
                    "n = {n}: {radius}, not {round}"
                );
            }
        }
    }

    /// How far into the second material of a grid points of its surface are, by what their tints say.
    fn sides(grid: &VoxelGrid<Dim3>) -> Vec<(Point, f32)> {
        let rest = Rest::new(grid);
        let side = |point: &RestPoint| match point.tint.materials {
            [1, 1] => 0.0,
            [2, 2] => 1.0,
            _ => point.tint.side,
        };
        rest.points
            .iter()
            .map(|point| (point.at, side(point)))
            .collect()
    }

    #[test]
    fn the_border_of_two_materials_has_no_stairs() {
        // It rises by one voxel in four.
        let half = |[x, y, _]: Point| 1 + u8::from(4 * y > x + 20);
        let grid = VoxelGrid::<Dim3>::from_fn([40, 30, 4], 1.0, half).unwrap();
        let sides = sides(&grid);
        let mut crossings = Vec::new();
        for x in 8..32 {
            let column = sides.iter().filter(|(at, _)| at[0] == x && at[2] == 4);
            let mut column: Vec<(f32, f32)> =
                column.map(|(at, side)| (at[1] as f32, *side)).collect();
            column.sort_by(|a, b| a.0.total_cmp(&b.0));
            let pair = column
                .windows(2)
                .find(|pair| pair[0].1 < 0.5 && pair[1].1 >= 0.5);
            let pair = pair.expect("the border crosses every column");
            let share = (0.5 - pair[0].1) / (pair[1].1 - pair[0].1);
            crossings.push(pair[0].0 + share - 0.25 * x as f32);
        }
        let low = crossings.iter().copied().fold(f32::MAX, f32::min);
        let high = crossings.iter().copied().fold(f32::MIN, f32::max);
        assert!(high - low < 0.25, "{crossings:?}");
    }

    #[test]
    fn a_dot_of_four_voxels_stays_and_so_does_a_painted_surface() {
        let dot =
            |[x, y, z]: Point| 1 + u8::from(z == 9 && (4..6).contains(&x) && (4..6).contains(&y));
        let grid = VoxelGrid::<Dim3>::from_fn([10, 10, 10], 1.0, dot).unwrap();
        let sides = sides(&grid);
        let side = |at: Point| {
            sides
                .iter()
                .find(|(own, _)| *own == at)
                .map(|found| found.1)
        };
        assert!(side([5, 5, 10]) > Some(0.5) && side([3, 5, 10]) < Some(0.5));
        let rest = Rest::new(&grid);
        assert_eq!(rest.tint([5, 5, 5], 0).materials, [1, 1]);
        assert_eq!(
            rest.tint([5, 5, 9], 0).materials,
            [1, 2],
            "inside, below the dot"
        );
    }

    #[test]
    fn voxels_that_meet_along_an_edge_stay_apart() {
        let grid =
            VoxelGrid::<Dim3>::from_fn([2, 2, 1], 1.0, |[x, y, _]| u8::from(x == y)).unwrap();
        let rest = Rest::new(&grid);
        assert_eq!(rest.points.len(), 16);
        assert_ne!(rest.find([1, 1, 1], 0), rest.find([1, 1, 1], 3));
        assert_eq!(rest.find([1, 1, 1], 1), None);
    }
}
