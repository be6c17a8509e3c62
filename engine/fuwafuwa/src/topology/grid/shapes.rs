//! Grids in the shape of a ball, cube, ring, heart or flower.
//!
//! The same formulas serve 2D and 3D: in 2D the third coordinate is 0.

use super::VoxelGrid;
use crate::error::Error;
use crate::foundation::dim::{Dim, Point};
use glam::Vec3;

impl<D: Dim> VoxelGrid<D> {
    /// Creates the disc (2D) or ball (3D) that fills a grid of `n` voxels across `diameter` metres.
    ///
    /// A voxel is solid if its centre lies within half the diameter minus half a voxel, so that the outermost
    /// layer stays inside the box of the grid. A ball of one or two voxels across fills the box.
    ///
    /// # Errors
    /// See [`VoxelGrid::from_fn`].
    #[inline(never)]
    pub fn ball(n: usize, diameter: f32) -> Result<Self, Error> {
        let centre = n as f32 * 0.5;
        // Radius in voxels; at least 0.9 for balls of one or two voxels across. The voxel centres of a 2 × 2
        // × 2 grid are 0.87 from its centre, so all eight voxels are solid. Larger balls have a radius of at
        // least 1.
        let radius = (centre - 0.5).max(0.9);
        let grid = Self::from_fn(Self::cube_size(n), diameter / n as f32, |at| {
            let squared: f32 = at[..D::N]
                .iter()
                .map(|&k| (k as f32 + 0.5 - centre) * (k as f32 + 0.5 - centre))
                .sum();
            u8::from(squared < radius * radius)
        })?;
        Ok(grid.with_distance(|at| (at - Self::middle_of([n; 3])).length() - radius))
    }

    /// Creates the square (2D) or cube (3D) of `n` voxels across `width` metres.
    ///
    /// # Errors
    /// See [`VoxelGrid::from_fn`].
    #[inline(never)]
    pub fn cube(n: usize, width: f32) -> Result<Self, Error> {
        Self::from_fn(Self::cube_size(n), width / n as f32, |_| 1)
    }

    /// Creates the ring (2D) or torus (3D, in the plane of the first two axes) of `n` voxels across
    /// `diameter` metres. The diameter of the hole is half that of the ring.
    ///
    /// # Errors
    /// See [`VoxelGrid::from_fn`]; with a small `n` no voxel is solid.
    #[inline(never)]
    pub fn ring(n: usize, diameter: f32) -> Result<Self, Error> {
        let size = [n, n, D::depth(n.div_ceil(4))];
        // Outer radius in half voxels. It leaves half a voxel empty on each side of the box, like the radius
        // of a ball.
        let outer = n as f32 - 1.0;
        let tube = 0.25 * outer;
        let grid = Self::from_fn(size, diameter / n as f32, |voxel| {
            let [x, y, z] = Self::from_middle(voxel, size).to_array();
            let from_circle = (x * x + y * y).sqrt() - (outer - tube);
            u8::from(from_circle * from_circle + z * z < tube * tube)
        })?;
        Ok(grid.with_distance(|at| {
            let [x, y, z] = (at - Self::middle_of(size)).to_array();
            let from_circle = (x * x + y * y).sqrt() - 0.5 * (outer - tube);
            (from_circle * from_circle + z * z).sqrt() - 0.5 * tube
        }))
    }

    /// Creates a heart of `n` voxels across `width` metres, with the tip towards −y.
    ///
    /// In 3D the heart is the sextic (x² + 9/4 z² + y² − 1)³ ≤ x²y³ + 9/80 z²y³ [Taubin 1994]; in 2D it is
    /// the section of this sextic at z = 0.
    ///
    /// # Errors
    /// See [`VoxelGrid::from_fn`].
    #[inline(never)]
    pub fn heart(n: usize, width: f32) -> Result<Self, Error> {
        // Half the width of the grid, and the height of its middle, in the coordinates of the sextic. At z =
        // 0, the heart spans −1.14 to 1.14 in x and −1 to 1.24 in y.
        const HALF_WIDTH: f32 = 1.2;
        const MIDDLE: f32 = 0.12;
        let size = Self::cube_size(n);
        let unit = HALF_WIDTH / n as f32;
        Self::from_fn(size, width / n as f32, |voxel| {
            let [x, y, z] = (Self::from_middle(voxel, size) * unit).to_array();
            let y = y + MIDDLE;
            let ball = x * x + 2.25 * z * z + y * y - 1.0;
            u8::from(ball * ball * ball <= (x * x + 0.1125 * z * z) * y * y * y)
        })
    }

    /// Creates a flower of `n` voxels across `width` metres, with five petals, one of them towards +y. In 3D
    /// the flower is a cushion with this outline.
    ///
    /// At the angle φ from the y axis, the radius r is 0.7 + 0.3 cos 5φ times half the width. Because r⁵ cos
    /// 5φ is the real part of (y + ix)⁵, no angle is computed.
    ///
    /// # Errors
    /// See [`VoxelGrid::from_fn`].
    #[inline(never)]
    pub fn flower(n: usize, width: f32) -> Result<Self, Error> {
        let size = Self::cube_size(n);
        Self::from_fn(size, width / n as f32, |voxel| {
            let [x, y, z] = (Self::from_middle(voxel, size) / n as f32).to_array();
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

    /// Returns the middle of a grid of `size` [voxels]; the third coordinate is 0 in 2D.
    fn middle_of(size: [usize; 3]) -> Vec3 {
        let mut middle = Vec3::from(size.map(|extent| 0.5 * extent as f32));
        middle.as_mut()[D::N..].fill(0.0);
        middle
    }

    /// Returns the offset of a voxel's centre from the middle of a grid of `size`, in half voxels, so that
    /// the coordinates are whole numbers.
    fn from_middle(voxel: Point, size: [usize; 3]) -> Vec3 {
        [0, 1, 2]
            .map(|axis| (2 * voxel[axis] + 1 - size[axis] as i32) as f32)
            .into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::foundation::dim::{Dim2, Dim3};

    /// Returns a picture of a 2D grid or of the middle layer of a 3D grid, one string for each row, the row
    /// with the highest y first.
    fn picture<D: Dim>(grid: Result<VoxelGrid<D>, Error>) -> Vec<String> {
        let grid = grid.unwrap();
        let [width, height, depth] = grid.size();
        let sign = |at| ['.', '#'][usize::from(grid.material(at))];
        let row = |y| (0..width).map(|x| sign([x, y, depth / 2])).collect();
        (0..height).rev().map(row).collect()
    }

    #[test]
    fn named_shapes_match_pictures() {
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
        // The tube of the torus is 5 voxels high in a grid of 9 layers.
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
    fn named_shapes_fail_below_smallest_size() {
        assert_eq!(VoxelGrid::<Dim2>::heart(0, 1.0), Err(Error::EmptyGrid));
        assert_eq!(VoxelGrid::<Dim3>::flower(0, 1.0), Err(Error::EmptyGrid));
        assert_eq!(VoxelGrid::<Dim3>::ring(0, 1.0), Err(Error::EmptyGrid));
        assert_eq!(VoxelGrid::<Dim2>::ring(4, 1.0), Err(Error::EmptyGrid));
        assert!(VoxelGrid::<Dim2>::ring(5, 1.0).is_ok());
        assert!(VoxelGrid::<Dim3>::ring(6, 1.0).is_ok());
    }

    #[test]
    fn ball_has_known_voxel_count() {
        // Number of solid voxels in a 3D ball 32 voxels across.
        assert_eq!(
            VoxelGrid::<Dim3>::ball(32, 1.0).unwrap().solid_count(),
            15_408
        );
    }
}
