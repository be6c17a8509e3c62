//! Synthetic organ (phantom), used without a scan: a kidney. It is asymmetric, so that mirrored views can be
//! noticed:
//!
//! ```text
//!   from above         A                       from behind     S
//!             ╭─────────────────╮                ╭──────────────────────╮
//!         ╭───╯   ‖    ◌ growth ╰──╮           L │  ○ vessel  ◌ growth  │ R
//!       L │    vessel    core      │ R           ╰──────────────────────╯
//!         ╰──────╮    ‖    ╭───────╯                       I
//!                ╰────╫────╯ hilum              128 × 80 × 60 mm without the ureter
//!                     ‖ ureter
//!                     P
//! ```
//!
//! The shape is an ellipsoid with half axes of 64, 34 and 30 mm, bent along a parabola: each slice across the
//! long axis is moved to the back, by [`BEND`] at the poles relative to the middle. The bend keeps the volume, so
//! that the organ has 4/3 π · 6.4 · 3.4 · 3.0 = 273.4 ml, and a stub of the ureter adds 1.4 ml. The phantom is
//! larger than the kidney of an adult (some 110 × 60 × 40 mm), so that tools have room.
//!
//! Materials:
//!
//! 1. flesh (cortex)
//! 2. a firmer core (medulla)
//! 3. a hard growth in the patient's *right* half, in front
//! 4. tough vessels: one runs from front to back through the *left* half, and the ureter leaves the hilum at the
//!    back

use crate::case::{Case, CaseError, tissues};
use fuwafuwa::VoxelGrid;

/// Name of the case.
pub const NAME: &str = "kidney phantom";
/// Names of the materials, starting at number 1.
pub const MATERIALS: [&str; 4] = ["flesh", "core", "growth", "vessels"];
/// Half axes of the ellipsoid before it is bent [mm]: left–right, front–back, up–down.
pub const HALF: [f64; 3] = [64.0, 34.0, 30.0];
/// Distance by which the poles are moved to the back, relative to the middle [mm].
pub const BEND: f64 = 38.0;
/// Share of [`BEND`] by which the middle is moved to the front, so that the organ stays near its origin.
const MIDDLE: f64 = 0.35;
/// Ball of hard growth in the phantom: centre (RAS+) and radius [mm].
pub const GROWTH: ([f64; 3], f64) = ([30.0, 18.0, 10.0], 10.0);
/// Vessel through the phantom, a cylinder from front to back: its axis (distance to the right and up from the
/// centre) and its radius [mm].
const VESSEL: ([f64; 2], f64) = ([-26.0, 6.0], 5.0);
/// Radius of the ureter, which runs from the middle of the phantom to the back [mm].
const URETER: f64 = 5.0;
/// Position of the ureter's end [mm behind the origin].
const URETER_END: f64 = 39.0;
/// Half of the front–back extent of the grid [mm].
const DEPTH: f64 = 48.0;
/// Size of the phantom's firmer core, bent like the whole phantom, relative to the whole phantom.
const CORE: f64 = 0.45;

/// Returns the material at a point in the patient, RAS+ [mm]; 0 outside.
pub fn material(patient: [f64; 3]) -> u8 {
    let [right, front, up] = patient;
    let [long, wide, high] = HALF;
    // Position along the front–back axis before the bend.
    let straight = front + BEND * ((right / long).powi(2) - MIDDLE);
    let squares = (right / long).powi(2) + (straight / wide).powi(2) + (up / high).powi(2);
    let squared = |a: f64, b: f64| (a - b) * (a - b);
    let is_in_ureter = right * right + up * up < URETER * URETER && -URETER_END < front;
    if squares >= 1.0 {
        let is_behind = straight < 0.0;
        return if is_in_ureter && is_behind { 4 } else { 0 };
    }
    let (middle, radius) = GROWTH;
    let away: f64 = (0..3)
        .map(|axis| squared(patient[axis], middle[axis]))
        .sum();
    let ([x, z], radius_of_vessel) = VESSEL;
    let is_across = squared(right, x) + squared(up, z) < radius_of_vessel * radius_of_vessel;
    match () {
        () if away < radius * radius => 3,
        () if is_across && straight.abs() < 0.8 * wide => 4,
        () if squares < CORE * CORE => 2,
        () if is_in_ureter && straight < 0.0 => 4,
        () => 1,
    }
}

/// Returns the phantom as a case with `resolution` voxels along its longest side.
///
/// # Errors
/// [`CaseError`] if the engine rejects the grid.
pub fn case(resolution: usize) -> Result<Case, CaseError> {
    let resolution = resolution.max(8);
    let [right, _, up] = HALF;
    let voxel = 2.0 * right / (resolution as f64 - 2.0);
    let count = |half: f64| (2.0 * half / voxel).ceil() as usize + 2;
    let size = [count(right), count(up), count(DEPTH)];
    let half = size.map(|extent| 0.5 * extent as f64 * voxel);
    let corner = [-half[0], half[2], -half[1]];
    let grid = VoxelGrid::from_fn(size, (voxel / 1000.0) as f32, |at| {
        let [x, y, z] = at.map(|k| (f64::from(k) + 0.5) * voxel);
        material([corner[0] + x, corner[1] - z, corner[2] + y])
    });
    Ok(Case {
        name: NAME.into(),
        grid: grid?,
        tissues: tissues(MATERIALS.len()),
        names: MATERIALS.map(String::from).into(),
        corner,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn kidney_has_the_documented_volume_and_extent() {
        let case = case(128).unwrap();
        let volume = case.grid.solid_count() as f64 * case.millilitres();
        let [long, wide, high] = HALF;
        let bean = 4.0 / 3.0 * PI * long * wide * high / 1000.0;
        // Back of the kidney at the hilum.
        let hilum = wide - BEND * MIDDLE;
        let stub = PI * URETER * URETER * (URETER_END - hilum) / 1000.0;
        assert!(
            (bean - 273.4).abs() < 0.05 && (stub - 1.4).abs() < 0.15,
            "{bean} {stub}"
        );
        assert!((volume / (bean + stub) - 1.0).abs() < 0.01, "{volume} ml");
        // Front–back extent without the ureter, from the formula in steps of 0.1 mm.
        let steps = (-640..=640).map(|step| f64::from(step) / 10.0);
        let edges = steps.flat_map(|right| {
            let share = (right / long).powi(2);
            let bent = BEND * (share - MIDDLE);
            let half = wide * (1.0 - share).sqrt();
            [-bent - half, -bent + half]
        });
        let [low, high] = edges.fold([f64::MAX, f64::MIN], |[low, high], at| {
            [low.min(at), high.max(at)]
        });
        assert!((high - low - 79.6).abs() < 0.5, "{low} {high}");
        assert!(high < DEPTH && -low < DEPTH);
    }

    #[test]
    fn hilum_is_a_notch_at_the_back_with_the_ureter() {
        // Between the poles the back is concave.
        assert_eq!(material([0.0, -25.0, 12.0]), 0);
        assert_eq!(material([50.0, -25.0, 0.0]), 1);
        assert_eq!(material([-50.0, -25.0, 0.0]), 1);
        assert_eq!(material([0.0, 45.0, 0.0]), 1, "the front is convex");
        assert_eq!(material([0.0, -30.0, 0.0]), 4, "ureter");
        assert_eq!(material([0.0, -40.0, 0.0]), 0, "end of the ureter");
        assert_eq!(material([0.0, 15.4, 0.0]), 2);
        let (growth, _) = GROWTH;
        assert_eq!(material(growth), 3);
        let [right, front, up] = growth;
        assert_ne!(material([-right, front, up]), 3);
        assert_eq!(material([-26.0, 0.0, 6.0]), 4);
        assert_ne!(material([26.0, 0.0, 6.0]), 4);
    }

    #[test]
    fn kidney_is_one_piece_at_any_resolution() {
        for resolution in [8, 10, 13, 16, 20, 33, 64] {
            let case = case(resolution).unwrap();
            let body = fuwafuwa::SoftBody::new(case.grid.clone(), &case.tissues).unwrap();
            assert_eq!(body.pieces().list.len(), 1, "{resolution}");
        }
    }
}
