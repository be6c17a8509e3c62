//! Synthetic organ (phantom), used without a scan. It is asymmetric, so that mirrored views can be noticed:
//!
//! ```text
//!   from behind        S             from the left     S
//!             ╭────────────────╮               ╭──────────────────╮
//!             │  ○ vessel      │               │  growth ◌        │
//!           L │    ◌ growth  R │ core        A │      core        │ P     96 × 72 × 128 mm
//!             ╰────────────────╯               ╰──────────────────╯
//! ```
//!
//! Materials:
//!
//! 1. flesh
//! 2. a firmer core
//! 3. a hard growth in the patient's *right* half, in front
//! 4. a tough vessel that runs from front to back through the *left* half

use crate::case::{Case, CaseError, tissues};
use fuwafuwa::VoxelGrid;

/// Half axes of the phantom's ellipsoid [mm]: left–right, front–back, up–down.
pub const HALF: [f64; 3] = [48.0, 64.0, 36.0];
/// Ball of hard growth in the phantom: centre (RAS+) and radius [mm].
pub const GROWTH: ([f64; 3], f64) = ([22.0, 18.0, 12.0], 11.0);
/// Vessel through the phantom, a cylinder from front to back: its axis (distance to the right and up from the
/// centre) and its radius [mm].
const VESSEL: ([f64; 2], f64) = ([-20.0, 8.0], 5.0);
/// Size of the phantom's firmer core, an ellipsoid, relative to the whole phantom.
const CORE: f64 = 0.45;

/// Returns the material at a point in the patient, RAS+ [mm]; 0 outside.
pub fn material(patient: [f64; 3]) -> u8 {
    let [right, front, up] = patient;
    let share = |axis: usize, of: f64| {
        let part = patient[axis] / (of * HALF[axis]);
        part * part
    };
    let is_inside = |of: f64| (0..3).map(|axis| share(axis, of)).sum::<f64>() < 1.0;
    // Depth of a furrow at the top of the phantom, which separates the left and right halves as in a brain.
    let depth = up - 0.45 * HALF[2];
    if !is_inside(1.0) || right.abs() < (0.22 * depth).min(4.0) {
        return 0;
    }
    let squared = |a: f64, b: f64| (a - b) * (a - b);
    let (middle, radius) = GROWTH;
    let away: f64 = (0..3)
        .map(|axis| squared(patient[axis], middle[axis]))
        .sum();
    let ([x, z], wide) = VESSEL;
    let is_in_vessel = squared(right, x) + squared(up, z) < wide * wide;
    match (away < radius * radius, is_in_vessel) {
        (true, _) => 3,
        (_, true) if front.abs() < 0.8 * HALF[1] => 4,
        _ if is_inside(CORE) => 2,
        _ => 1,
    }
}

/// Returns the phantom as a case with `resolution` voxels along its longest side.
///
/// # Errors
/// [`CaseError`] if the engine rejects the grid.
pub fn case(resolution: usize) -> Result<Case, CaseError> {
    let resolution = resolution.max(8);
    let voxel = 2.0 * HALF[1] / (resolution as f64 - 2.0);
    let [right, front, up] = HALF;
    let count = |half: f64| (2.0 * half / voxel).ceil() as usize + 2;
    let size = [count(right), count(up), count(front)];
    let half = size.map(|extent| 0.5 * extent as f64 * voxel);
    let corner = [-half[0], half[2], -half[1]];
    let grid = VoxelGrid::from_fn(size, (voxel / 1000.0) as f32, |at| {
        let [x, y, z] = at.map(|k| (f64::from(k) + 0.5) * voxel);
        material([corner[0] + x, corner[1] - z, corner[2] + y])
    });
    Ok(Case {
        name: "phantom".into(),
        grid: grid?,
        tissues: tissues(4),
        corner,
    })
}
