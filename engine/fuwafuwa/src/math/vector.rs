//! Vectors in single precision.

/// Vector or position in space; the third coordinate is 0 in 2D.
pub type Vector = glam::Vec3;

/// Returns two unit vectors that are perpendicular to the unit vector `way` and to each other.
pub fn across(way: Vector) -> [Vector; 2] {
    let least = (0..3).fold(0, |least, k| match way[k].abs() < way[least].abs() {
        true => k,
        false => least,
    });
    let first = way.cross(Vector::AXES[least]);
    let first = first * (1.0 / first.length());
    [first, way.cross(first)]
}
