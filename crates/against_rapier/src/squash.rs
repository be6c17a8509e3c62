//! Comparing at equal quality: Rapier's substeps are raised until its body is as stiff as ours.

use crate::side::{Side, TOLERANCE, Watched, fall};
use crate::{Drop, FRAME, Result, WIDTH, ours, theirs};

/// Where raising the substeps ends.
const MOST_SUBSTEPS: usize = 128;

/// A body falls in both engines, a frame of fuwafuwa's and a frame of Rapier's in turns; returns fuwafuwa's side and
/// Rapier's. Rapier gets so few substeps that its peak squash is just within 2 percentage points of ours, or below that;
/// `trying` hears of every number that is tried before. They run until the deepest squash is over, even if that takes
/// more frames than the scene has.
///
/// # Errors
/// [`Error`](crate::Error) when the scene makes no sense.
pub fn compare_drop(scene: &Drop, trying: impl FnMut(usize)) -> Result<[Side; 2]> {
    let frames = frames_to_peak(scene);
    let [alone] = fall([ours(scene)?], frames);
    let substeps = enough_substeps(scene, frames, alone.peak_squash + TOLERANCE, trying)?;
    let frames = scene.frames.max(frames);
    Ok(fall([ours(scene)?, theirs(scene, substeps)?], frames))
}

/// With how many substeps Rapier's body is not squashed deeper than `limit`; raised by a quarter at a time.
fn enough_substeps(
    scene: &Drop,
    frames: usize,
    limit: f64,
    mut trying: impl FnMut(usize),
) -> Result<usize> {
    let mut substeps = 1;
    loop {
        trying(substeps);
        let mut watched = Watched::new(theirs(scene, substeps)?);
        let too_soft = (0..frames).any(|_| {
            watched.step();
            watched.side.peak_squash > limit
        });
        let raised = substeps + (substeps / 4).max(1);
        if !too_soft || raised > MOST_SUBSTEPS {
            return Ok(substeps);
        }
        substeps = raised;
    }
}

/// Frames until the first impact is over, and with it the deepest squash: the fall, the time in which sound crosses the
/// body six times (one under a free end swings back after four), and some more for a solver softer than the material.
fn frames_to_peak(scene: &Drop) -> usize {
    const SOFTER: f32 = 0.25;
    let fall = (2.0 * scene.height / scene.gravity).sqrt();
    let crossing = WIDTH / (scene.young / scene.density).sqrt();
    ((fall + 6.0 * crossing + SOFTER) / FRAME).ceil() as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    fn small(dim: u8, n: usize) -> Drop {
        Drop {
            height: 0.3,
            frames: 40,
            ..Drop::stiff(dim, n)
        }
    }

    #[test]
    fn both_engines_squash_a_body_alike() {
        for scene in [small(2, 12), small(3, 8)] {
            let [ours, theirs] = compare_drop(&scene, |_| ()).expect("the scene makes sense");
            for side in [&ours, &theirs] {
                assert!(side.milliseconds.len() >= 40);
                assert!(side.finite && side.softening == 1.0);
                assert!((0.01..0.15).contains(&side.peak_squash), "{side:?}");
            }
            assert!(ours.equals(&theirs), "{ours:?} {theirs:?}");
        }
    }

    #[test]
    fn substeps_rise_until_the_body_is_stiff_enough() {
        let scene = small(2, 16);
        let [soft] = fall([theirs(&scene, 1).expect("the scene makes sense")], 40);
        let mut tried = Vec::new();
        let limit = soft.peak_squash - 0.01;
        let enough = enough_substeps(&scene, 40, limit, |substeps| tried.push(substeps));
        let enough = enough.expect("the scene makes sense");
        assert!(enough > 1 && tried.last() == Some(&enough), "{tried:?}");
        let [stiffer] = fall([theirs(&scene, enough).expect("the scene makes sense")], 40);
        assert!(stiffer.peak_squash <= limit);
    }
}
