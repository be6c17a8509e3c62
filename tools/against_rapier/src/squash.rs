//! Comparing at equal quality: both engines get the fewest substeps with which the body is as stiff as its material.

use std::ops::Range;

use fuwafuwa::world::FEWEST_SUBSTEPS;

use crate::side::{Side, TOLERANCE, Watched, fall};
use crate::world::Falling;
use crate::{Drop, Effort, FRAME, Result, WIDTH, ours, theirs};

/// How often Rapier may go over its constraints in a substep; its default first, which is seldom far off.
const SWEEPS: [usize; 4] = [4, 8, 2, 1];
/// Where raising the substeps ends.
const MOST_SUBSTEPS: usize = 128;

/// A body falls in both engines, a frame of fuwafuwa's and a frame of Rapier's in turns; returns fuwafuwa's side and
/// Rapier's. Each gets so few substeps that its peak squash is just within 2 percentage points of the exact one, which is
/// ours where nothing is softened, or below that; Rapier with the number of sweeps that is fastest then. `trying`
/// hears of all that Rapier tries before. They run until the deepest squash is over, even if that takes more frames than the
/// scene has.
///
/// # Errors
/// [`Error`](crate::Error) when the scene makes no sense.
pub fn compare_drop(scene: &Drop, mut trying: impl FnMut(Effort)) -> Result<[Side; 2]> {
    let frames = frames_to_peak(scene);
    let [exact] = fall([ours(scene, None)?], frames);
    let limit = exact.peak_squash + TOLERANCE;
    let range = FEWEST_SUBSTEPS as usize..exact.substeps;
    let softened = enough(range, f64::INFINITY, |substeps| {
        Ok(stiff(ours(scene, Some(substeps))?, frames, limit))
    })?;
    let mut fastest = f64::INFINITY;
    let mut effort = Effort {
        substeps: MOST_SUBSTEPS,
        sweeps: SWEEPS[0],
    };
    for sweeps in SWEEPS {
        let found = enough(1..MOST_SUBSTEPS + 1, fastest, |substeps| {
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

/// Whether a body is never squashed deeper than `limit`, and the median time of a frame [ms] up to where it is.
fn stiff(world: Box<dyn Falling>, frames: usize, limit: f64) -> (bool, f64) {
    let mut watched = Watched::new(world);
    let is_stiff = (0..frames).all(|_| {
        watched.step();
        watched.side.peak_squash <= limit && watched.side.finite
    });
    (is_stiff, watched.side.median())
}

/// The fewest substeps of these with which a body is stiff, as it is with more of them, and the median time of a frame with so
/// many [ms]: raised by a quarter at a time until they are enough, then halved between those and the last that were not.
/// Nothing if that is not faster than `fastest` [ms], or none of them are enough.
fn enough(
    range: Range<usize>,
    fastest: f64,
    mut stiff: impl FnMut(usize) -> Result<(bool, f64)>,
) -> Result<Option<(usize, f64)>> {
    // The most that were too few, and the fewest that were enough.
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
            let [exact] = fall([ours(&scene, None).expect("the scene makes sense")], 1);
            assert_eq!(exact.stiffness_scale, 1.0);
            let [ours, theirs] = compare_drop(&scene, |_| ()).expect("the scene makes sense");
            for side in [&ours, &theirs] {
                assert!(side.milliseconds.len() >= 40);
                assert!(side.finite);
                assert!((0.01..0.15).contains(&side.peak_squash), "{side:?}");
            }
            assert!(ours.equals(&theirs), "{ours:?} {theirs:?}");
        }
    }

    #[test]
    fn substeps_are_as_few_as_are_enough() {
        let median = |substeps| substeps as f64;
        for (range, least) in [(1..129, 1), (1..129, 51), (8..31, 25), (8..31, 30)] {
            let mut tried = Vec::new();
            let stiff = |substeps| {
                tried.push(substeps);
                Ok((substeps >= least, median(substeps)))
            };
            let found = enough(range.clone(), f64::INFINITY, stiff);
            assert_eq!(found, Ok(Some((least, median(least)))), "{tried:?}");
            assert!(tried.iter().all(|substeps| range.contains(substeps)));
            let slow = enough(range, median(least), |substeps| {
                Ok((substeps >= least, median(substeps)))
            });
            assert_eq!(slow, Ok(None));
        }
        // The first that are enough are too slow, and yet the fewest are not.
        let stiff = |substeps| Ok((substeps >= 25, median(substeps)));
        assert_eq!(enough(8..31, 26.0, stiff), Ok(Some((25, 25.0))));
        let never = |substeps| Ok((false, median(substeps)));
        assert_eq!(enough(8..31, f64::INFINITY, never), Ok(None));
        // Nothing is left to try.
        assert_eq!(enough(8..8, f64::INFINITY, never), Ok(None));
    }

    #[test]
    fn fewer_substeps_make_a_body_softer_in_either_engine() {
        let scene = small(2, 16);
        let squash = |world: Result<Box<dyn Falling>>| {
            let [side] = fall([world.expect("the scene makes sense")], 40);
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
