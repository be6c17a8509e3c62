//! Grids with the shape of something that has a name.
//!
//! Each is one formula for the plane and for space.

use super::{BuildError, VoxelGrid};
use crate::dim::{Dim, Point};
use crate::shape::Vector;

impl<D: Dim> VoxelGrid<D> {
    /// The disc (2D) or ball (3D) that fills a grid of `n` voxels across `diameter` metres.
    ///
    /// A voxel is solid when its centre lies within the radius less half a voxel, so that the
    /// outermost layer stays inside the box. One or two voxels across it fills the box.
    ///
    /// # Errors
    /// As [`VoxelGrid::from_fn`].
    #[inline(never)]
    pub fn ball(n: usize, diameter: f32) -> Result<Self, BuildError> {
        let centre = n as f32 * 0.5;
        // Wide enough for the corners of 2 × 2 × 2 voxels, and less than the 1 of three voxels.
        let radius = (centre - 0.5).max(0.9);
        Self::from_fn(Self::cube_size(n), diameter / n as f32, |at| {
            let squared: f32 = at[..D::N]
                .iter()
                .map(|&k| (k as f32 + 0.5 - centre) * (k as f32 + 0.5 - centre))
                .sum();
            u8::from(squared < radius * radius)
        })
    }

    /// The square (2D) or cube (3D) of `n` voxels across `width` metres.
    ///
    /// # Errors
    /// As [`VoxelGrid::from_fn`].
    #[inline(never)]
    pub fn cube(n: usize, width: f32) -> Result<Self, BuildError> {
        Self::from_fn(Self::cube_size(n), width / n as f32, |_| 1)
    }

    /// The ring (2D) or torus in the plane of the first two axes (3D) of `n` voxels across `diameter`
    /// metres, its hole half as wide.
    ///
    /// # Errors
    /// As [`VoxelGrid::from_fn`]; a small `n` leaves nothing solid.
    #[inline(never)]
    pub fn ring(n: usize, diameter: f32) -> Result<Self, BuildError> {
        let size = [n, n, D::depth(n.div_ceil(4))];
        // In halves of a voxel; like a ball it leaves one free on each side.
        let outer = n as f32 - 1.0;
        let tube = 0.25 * outer;
        Self::from_fn(size, diameter / n as f32, |voxel| {
            let [x, y, z] = Self::from_middle(voxel, size);
            let from_circle = (x * x + y * y).sqrt() - (outer - tube);
            u8::from(from_circle * from_circle + z * z < tube * tube)
        })
    }

    /// A heart of `n` voxels across `width` metres, its point down.
    ///
    /// In space it is the sextic (x² + 9/4 z² + y² − 1)³ ≤ x²y³ + 9/80 z²y³ [Taubin 1994] with y up,
    /// in the plane the section of that through z = 0.
    ///
    /// # Errors
    /// As [`VoxelGrid::from_fn`].
    #[inline(never)]
    pub fn heart(n: usize, width: f32) -> Result<Self, BuildError> {
        // The curve reaches from −1.14 to 1.14 in x and from −1 to 1.24 in y.
        const HALF_WIDTH: f32 = 1.2;
        const MIDDLE: f32 = 0.12;
        let size = Self::cube_size(n);
        let unit = HALF_WIDTH / n as f32;
        Self::from_fn(size, width / n as f32, |voxel| {
            let [x, y, z] = Self::from_middle(voxel, size).map(|k| k * unit);
            let y = y + MIDDLE;
            let ball = x * x + 2.25 * z * z + y * y - 1.0;
            u8::from(ball * ball * ball <= (x * x + 0.1125 * z * z) * y * y * y)
        })
    }

    /// A flower of five petals, one of them up, `n` voxels across `width` metres; in space a cushion.
    ///
    /// Its radius is 0.7 + 0.3 cos 5φ of the half width, φ from the y axis. As r⁵ cos 5φ is the real
    /// part of (y + ix)⁵, no angle has to be found.
    ///
    /// # Errors
    /// As [`VoxelGrid::from_fn`].
    #[inline(never)]
    pub fn flower(n: usize, width: f32) -> Result<Self, BuildError> {
        let size = Self::cube_size(n);
        Self::from_fn(size, width / n as f32, |voxel| {
            let [x, y, z] = Self::from_middle(voxel, size).map(|k| k / n as f32);
            let (xx, yy) = (x * x, y * y);
            let squared = xx + yy + z * z;
            let fifth = squared * squared * squared.sqrt();
            let petals = y * (yy * yy - 10.0 * yy * xx + 5.0 * xx * xx);
            u8::from(squared * squared * squared <= 0.7 * fifth + 0.3 * petals)
        })
    }

    fn cube_size(n: usize) -> [usize; 3] {
        [n, n, D::depth(n)]
    }

    /// The centre of a voxel from the middle of a grid of `size`, in halves of a voxel: whole numbers.
    fn from_middle(voxel: Point, size: [usize; 3]) -> Vector {
        [0, 1, 2].map(|axis| (2 * voxel[axis] + 1 - size[axis] as i32) as f32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dim::{Dim2, Dim3};

    /// The picture of a flat grid, or of the middle layer of a solid one; the highest row first.
    fn picture<D: Dim>(grid: Result<VoxelGrid<D>, BuildError>) -> Vec<String> {
        let grid = grid.unwrap();
        let [width, height, depth] = grid.size();
        let sign = |at| ['.', '#'][usize::from(grid.material(at))];
        let row = |y| (0..width).map(|x| sign([x, y, depth / 2])).collect();
        (0..height).rev().map(row).collect()
    }

    #[test]
    fn shapes_look_like_their_names() {
        let ring = [
            ".........",
            "..#####..",
            ".###.###.",
            ".##...##.",
            ".#.....#.",
            ".##...##.",
            ".###.###.",
            "..#####..",
            ".........",
        ];
        assert_eq!(picture(VoxelGrid::<Dim2>::ring(9, 1.0)), ring);
        assert_eq!(picture(VoxelGrid::<Dim3>::ring(9, 1.0)), ring);
        let torus = VoxelGrid::<Dim3>::ring(33, 1.0).unwrap();
        assert_eq!(torus.size(), [33, 33, 9]);
        // Round in section too, and the same on both sides.
        let tube = (0..9).map(|z| torus.is_solid([1, 16, z]));
        assert_eq!(tube.filter(|&solid| solid).count(), 5);
        let heart = [
            "..##...##..",
            ".#########.",
            "###########",
            "###########",
            "###########",
            ".#########.",
            ".#########.",
            "..#######..",
            "...#####...",
            "....###....",
            ".....#.....",
        ];
        assert_eq!(picture(VoxelGrid::<Dim2>::heart(11, 1.0)), heart);
        assert_eq!(picture(VoxelGrid::<Dim3>::heart(11, 1.0)), heart);
        let flower = [
            ".......#.......",
            "......###......",
            "......###......",
            "......###......",
            ".###..###..###.",
            "###############",
            ".#############.",
            "..###########..",
            ".....#####.....",
            "....#######....",
            "...####.####...",
            "...####.####...",
            "...###...###...",
            "...##.....##...",
            "...............",
        ];
        assert_eq!(picture(VoxelGrid::<Dim2>::flower(15, 1.0)), flower);
        assert_eq!(picture(VoxelGrid::<Dim3>::flower(15, 1.0)), flower);
    }

    #[test]
    fn shapes_too_small_to_be_seen_are_refused() {
        assert_eq!(VoxelGrid::<Dim2>::heart(0, 1.0), Err(BuildError::Empty));
        assert_eq!(VoxelGrid::<Dim3>::flower(0, 1.0), Err(BuildError::Empty));
        assert_eq!(VoxelGrid::<Dim3>::ring(0, 1.0), Err(BuildError::Empty));
        assert_eq!(VoxelGrid::<Dim2>::ring(4, 1.0), Err(BuildError::Empty));
        assert!(VoxelGrid::<Dim2>::ring(5, 1.0).is_ok());
        assert!(VoxelGrid::<Dim3>::ring(6, 1.0).is_ok());
    }

    #[test]
    fn a_ball_keeps_the_count_of_its_voxels() {
        // Counts of the prototypes: 15,408 voxels at n = 32 in 3D.
        assert_eq!(
            VoxelGrid::<Dim3>::ball(32, 1.0).unwrap().solid_count(),
            15_408
        );
    }
}
