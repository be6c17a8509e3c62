//! Surface of a 3D body at rest: the offset and the colours of each point, computed once.
//!
//! Offsets are in voxels and in the frame of the body at rest; a deformed body carries them along.

use fuwafuwa::inspect::{Connectivity, Groups};
use fuwafuwa::inspect::{add, beyond, corner, face_corners, points_in, voxel_around};
use fuwafuwa::{Dim, Dim3, Point, SoftBody, VoxelGrid};
use glam::Vec3;

/// Rounds of mixing material shares between neighbours. More rounds smooth longer stair steps of material
/// borders.
const TINT_ROUNDS: usize = 12;
/// Minimum share of a material at a point where all adjacent voxels have this material. At a point without
/// such voxels, the maximum share is 1 − `MIN_OWN_SHARE`. Both limits keep dots of a few voxels visible.
const MIN_OWN_SHARE: f32 = 0.52;
/// Minimum share of the second most frequent material at a point. With a smaller share, the point is treated
/// as away from any material border.
const MIN_SECOND_SHARE: f32 = 0.1;
/// Weights of the voxels around an inner point, along each axis.
const AROUND_INSIDE: [f32; 4] = [1.0, 3.0, 3.0, 1.0];
/// Maximum offset of inner points from the lattice, along each axis [voxels]. Larger values look rougher, but
/// faces may turn over.
const ROUGHNESS: f32 = 0.45;

/// Offsets and colours of the surface points of a body.
#[derive(Clone, Debug, Default)]
pub struct Rest {
    /// Index of the first entry in `points` by lattice point, or `NONE`.
    first: Vec<u32>,
    /// Surface points, ordered by lattice point.
    points: Vec<RestPoint>,
    /// Grid that the offsets belong to.
    grid: Option<VoxelGrid<Dim3>>,
    /// Voxels by the material numbers that decide the colours, if these are not those of the grid.
    numbers: Option<VoxelGrid<Dim3>>,
    /// Highest material number that decides a colour.
    materials: u8,
}

/// Surface point shared by a group of connected voxels around a lattice point.
#[derive(Copy, Clone, Debug)]
struct RestPoint {
    at: Point,
    /// Voxels of the group, as a mask of octants.
    group: u8,
    /// Offset of the smooth surface [voxels].
    offset: Vec3,
    tint: Tint,
}

/// Smoothed materials around a point, so that material borders have no staircase.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct Tint {
    /// Numbers of the two most frequent materials, the lower one first; equal away from a border.
    pub materials: [u8; 2],
    /// Position across the border: 0.5 on the border, towards 0 on the side of the first material.
    pub side: f32,
}

/// The two most frequent materials with their shares.
#[derive(Copy, Clone, Debug, Default)]
struct TopMaterials([(u8, f32); 2]);

impl TopMaterials {
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
        let materials = match share < MIN_SECOND_SHARE {
            true => [first; 2],
            false => [first.min(second), first.max(second)],
        };
        let side = if first < second { share } else { 1.0 - share };
        Tint { materials, side }
    }
}

const NONE: u32 = u32::MAX;

impl Rest {
    /// Computes the surface of a body at rest. `numbers` has the material numbers that decide the colours.
    pub fn new(body: &SoftBody<Dim3>, numbers: &VoxelGrid<Dim3>) -> Self {
        let grid = body.grid();
        let sharing = Connectivity::new(grid);
        let materials = numbers.voxels().map(|voxel| numbers.material(voxel));
        let mut rest = Self {
            first: vec![NONE; sharing.point_count()],
            points: Vec::new(),
            grid: Some(grid.clone()),
            numbers: (numbers != grid).then(|| numbers.clone()),
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
                offset: body.skin_offset(at),
                tint: Tint::default(),
            }));
        }
        let neighbours = rest.neighbours(grid);
        rest.find_tints(numbers, &neighbours);
        rest
    }

    /// Returns whether these offsets were computed for this grid and these numbers.
    pub fn fits(&self, grid: &VoxelGrid<Dim3>, numbers: &VoxelGrid<Dim3>) -> bool {
        self.grid.as_ref() == Some(grid) && self.numbers() == Some(numbers)
    }

    fn numbers(&self) -> Option<&VoxelGrid<Dim3>> {
        self.numbers.as_ref().or(self.grid.as_ref())
    }

    /// Returns the offset of a point [voxels] as seen from the voxel in one of its octants: that of the smooth
    /// surface on the original surface, a pseudo-random roughness inside. Both faces of a crack get the same
    /// offset.
    pub fn offset(&self, at: Point, octant: usize) -> Vec3 {
        match self.find(at, octant) {
            Some(found) => self.points[found as usize].offset,
            None => {
                let grain = Vec3::from([0, 1, 2].map(|axis| grain(at, axis)));
                ROUGHNESS * (2.0 * grain - 1.0)
            }
        }
    }

    /// Returns the materials of a point as seen from the voxel in one of its octants.
    pub fn tint(&self, at: Point, octant: usize) -> Tint {
        match self.find(at, octant) {
            Some(found) => self.points[found as usize].tint,
            None => self.tint_inside(at),
        }
    }

    fn tint_inside(&self, at: Point) -> Tint {
        let mut most = TopMaterials::default();
        let mut shares = [0.0; 256];
        if let Some(grid) = self.numbers().filter(|_| self.materials > 1) {
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
        let mut most = vec![TopMaterials::default(); self.points.len()];
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

    /// Returns the neighbours of each point along the edges of bare faces.
    fn neighbours(&self, grid: &VoxelGrid<Dim3>) -> Vec<Vec<u32>> {
        let mut neighbours: Vec<Vec<u32>> = vec![Vec::new(); self.points.len()];
        for voxel in grid.voxels().filter(|&voxel| grid.is_solid(voxel)) {
            for face in 0..6 {
                if grid.is_solid(beyond(voxel, face)) {
                    continue;
                }
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
        neighbours
    }
}

/// Returns the shares of a material after mixing them between neighbours.
fn mingled(own: &[f32], neighbours: &[Vec<u32>]) -> Vec<f32> {
    let mut shares = own.to_vec();
    for _ in 0..TINT_ROUNDS {
        let mixed = |(k, near): (usize, &Vec<u32>)| {
            let sum: f32 = near.iter().map(|&k| shares[k as usize]).sum();
            let share = 0.5 * (shares[k] + sum / near.len().max(1) as f32);
            match own[k] {
                0.0 => share.min(1.0 - MIN_OWN_SHARE),
                1.0 => share.max(MIN_OWN_SHARE),
                _ => share,
            }
        };
        shares = neighbours.iter().enumerate().map(mixed).collect();
    }
    shares
}

/// Returns a constant pseudo-random value of a lattice point for an axis, 0 to 1.
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
    use fuwafuwa::Material;

    fn rest_of(grid: &VoxelGrid<Dim3>) -> Rest {
        let materials = [Material::default(); 2];
        let body = SoftBody::new(grid.clone(), &materials).unwrap();
        Rest::new(&body, grid)
    }

    /// Returns all surface points with their position across the border of two materials: 0 = first, 1 =
    /// second.
    fn sides(grid: &VoxelGrid<Dim3>) -> Vec<(Point, f32)> {
        let rest = rest_of(grid);
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
    fn material_border_has_no_staircase() {
        // Border between two materials that rises by one voxel every four voxels.
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
    fn tint_keeps_dots_of_four_voxels() {
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
        let rest = rest_of(&grid);
        assert_eq!(rest.tint([5, 5, 5], 0).materials, [1, 1]);
        assert_eq!(
            rest.tint([5, 5, 9], 0).materials,
            [1, 2],
            "inside, below the dot"
        );
    }

    #[test]
    fn points_separate_voxels_that_touch_along_an_edge() {
        let grid =
            VoxelGrid::<Dim3>::from_fn([2, 2, 1], 1.0, |[x, y, _]| u8::from(x == y)).unwrap();
        let rest = rest_of(&grid);
        assert_eq!(rest.points.len(), 16);
        assert_ne!(rest.find([1, 1, 1], 0), rest.find([1, 1, 1], 3));
        assert_eq!(rest.find([1, 1, 1], 1), None);
    }
}
