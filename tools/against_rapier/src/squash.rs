//! Comparison at equal quality: each engine gets the fewest substeps for which the body is as stiff as its
//! material.

use std::ops::Range;

use fuwafuwa::MIN_SUBSTEPS;

use crate::side::{EngineResult, MeasuredWorld, TOLERANCE, fall};
use crate::world::Falling;
use crate::{Drop, Effort, FRAME, Result, WIDTH, ours, theirs};

/// Numbers of Rapier's solver iterations per substep to try. Rapier's default comes first, since it is seldom
/// far from the best.
const SWEEPS: [usize; 4] = [4, 8, 2, 1];
/// Maximum number of substeps per frame that is tried.
const MAX_SUBSTEPS: usize = 128;

/// Lets a body fall in both engines, alternating frame by frame. Returns the results of fuwafuwa and of
/// Rapier.
///
/// The exact peak squash is that of fuwafuwa with an unsoftened body. Each engine gets the fewest substeps
/// for which its peak squash exceeds the exact one by at most 2 percentage points. Rapier gets the number of
/// iterations for which it is then fastest. `trying` is called before each trial of Rapier. The run lasts at
/// least until the deepest squash is over, even if that exceeds the frames of the scene.
///
/// # Errors
/// [`Error`](crate::Error) if the scene is invalid.
pub fn compare_drop(scene: &Drop, mut trying: impl FnMut(Effort)) -> Result<[EngineResult; 2]> {
    let frames = frames_to_peak(scene);
    let [exact] = fall([ours(scene, None)?], frames);
    let limit = exact.peak_squash + TOLERANCE;
    let range = MIN_SUBSTEPS as usize..exact.substeps;
    let softened = fewest_stiff_substeps(range, f64::INFINITY, |substeps| {
        Ok(stiff(ours(scene, Some(substeps))?, frames, limit))
    })?;
    let mut fastest = f64::INFINITY;
    let mut effort = Effort {
        substeps: MAX_SUBSTEPS,
        sweeps: SWEEPS[0],
    };
    for sweeps in SWEEPS {
        let found = fewest_stiff_substeps(1..MAX_SUBSTEPS + 1, fastest, |substeps| {
            let effort = Effort { substeps, sweeps };
            trying(effort);
            Ok(stiff(theirs(scene, effort)?, frames, limit))
        })?;
        if let Some((substeps, median)) = found {
            (effort, fastest) = (Effort { substeps, sweeps }, median);
        }
    }
    let frames = scene.frames.max(frames);
    let ours = ours(scene, softened.map(|(substeps, _)| substeps))?;
    Ok(fall([ours, theirs(scene, effort)?], frames))
}

/// Runs a world for `frames` frames, or until its peak squash exceeds `limit`. Returns whether the squash
/// stayed within the limit, and the median frame time [ms].
fn stiff(world: Box<dyn Falling>, frames: usize, limit: f64) -> (bool, f64) {
    let mut watched = MeasuredWorld::new(world);
    let is_stiff = (0..frames).all(|_| {
        watched.step();
        watched.side.peak_squash <= limit && watched.side.finite
    });
    (is_stiff, watched.side.median())
}

/// Returns the fewest substeps in `range` for which a body is stiff enough, and the median frame time with
/// them [ms]. Raises the number of substeps by a quarter until it suffices, then bisects. Returns `None` if
/// no number suffices, or if the frame time is not shorter than `fastest` [ms].
fn fewest_stiff_substeps(
    range: Range<usize>,
    fastest: f64,
    mut stiff: impl FnMut(usize) -> Result<(bool, f64)>,
) -> Result<Option<(usize, f64)>> {
    // Largest number of substeps known to be too small, and smallest number known to suffice.
    let (mut few, mut found) = (range.start - 1, None);
    let mut substeps = range.start;
    while few + 1 < found.map_or(range.end, |(enough, _)| enough) {
        let (is_stiff, median) = stiff(substeps)?;
        if is_stiff {
            found = Some((substeps, median));
        } else if median >= fastest {
            return Ok(None);
        } else {
            few = substeps;
        }
        substeps = match found {
            Some((enough, _)) => usize::midpoint(few, enough),
            None => (few + (few / 4).max(1)).min(range.end - 1),
        };
    }
    Ok(found.filter(|&(_, median)| median < fastest))
}

/// Returns the number of frames until the first impact and its deepest squash are over. It covers the fall,
/// and six times the time in which sound crosses the body; a bar with a free end rebounds after four. A
/// quarter of a second is added, because a solver softer than the material takes longer.
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
    fn both_engines_have_equal_peak_squash() {
        for scene in [small(2, 12), small(3, 8)] {
            let [exact] = fall([ours(&scene, None).expect("the scene is valid")], 1);
            assert_eq!(exact.stiffness_scale, 1.0);
            let [ours, theirs] = compare_drop(&scene, |_| ()).expect("the scene is valid");
            for side in [&ours, &theirs] {
                assert!(side.milliseconds.len() >= 40);
                assert!(side.finite);
                assert!((0.01..0.15).contains(&side.peak_squash), "{side:?}");
            }
            assert!(ours.equals(&theirs), "{ours:?} {theirs:?}");
        }
    }

    #[test]
    fn search_returns_the_fewest_stiff_substeps() {
        let median = |substeps| substeps as f64;
        for (range, least) in [(1..129, 1), (1..129, 51), (8..31, 25), (8..31, 30)] {
            let mut tried = Vec::new();
            let stiff = |substeps| {
                tried.push(substeps);
                Ok((substeps >= least, median(substeps)))
            };
            let found = fewest_stiff_substeps(range.clone(), f64::INFINITY, stiff);
            assert_eq!(found, Ok(Some((least, median(least)))), "{tried:?}");
            assert!(tried.iter().all(|substeps| range.contains(substeps)));
            let slow = fewest_stiff_substeps(range, median(least), |substeps| {
                Ok((substeps >= least, median(substeps)))
            });
            assert_eq!(slow, Ok(None));
        }
        // 25 substeps are fast enough. The search must find them, although the first sufficient number that it
        // tries is larger and too slow.
        let stiff = |substeps| Ok((substeps >= 25, median(substeps)));
        assert_eq!(
            fewest_stiff_substeps(8..31, 26.0, stiff),
            Ok(Some((25, 25.0)))
        );
        let never = |substeps| Ok((false, median(substeps)));
        assert_eq!(fewest_stiff_substeps(8..31, f64::INFINITY, never), Ok(None));
        // An empty range must give `None`.
        assert_eq!(fewest_stiff_substeps(8..8, f64::INFINITY, never), Ok(None));
    }

    #[test]
    fn fewer_substeps_soften_a_body_in_both_engines() {
        let scene = small(2, 16);
        let squash = |world: Result<Box<dyn Falling>>| {
            let [side] = fall([world.expect("the scene is valid")], 40);
            side.peak_squash
        };
        let theirs = |substeps| {
            let effort = Effort {
                substeps,
                sweeps: 4,
            };
            squash(theirs(&scene, effort))
        };
        assert!(theirs(1) > theirs(8) + 0.01);
        assert!(squash(ours(&scene, Some(8))) > squash(ours(&scene, None)) + 0.01);
    }
}
