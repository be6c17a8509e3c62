//! Blades in both dimensions, for tests that run in 2D and in 3D.

use fuwafuwa::{Blade, Dim, Dim2, Dim3, Vec3};

/// Dimension in which tests can build a blade, the area along which a body is cut.
pub trait Blades: Dim {
    /// Returns the parallelogram with the given corner [m] and the two edges [m] that begin at this corner.
    /// In 2D, the blade is the segment along the first edge.
    fn blade(corner: Vec3, first: Vec3, second: Vec3) -> Blade<Self>;
}

impl Blades for Dim2 {
    fn blade(corner: Vec3, first: Vec3, _: Vec3) -> Blade<Self> {
        Blade::segment(corner.truncate(), (corner + first).truncate())
    }
}

impl Blades for Dim3 {
    fn blade(corner: Vec3, first: Vec3, second: Vec3) -> Blade<Self> {
        Blade::parallelogram(corner, first, second)
    }
}
