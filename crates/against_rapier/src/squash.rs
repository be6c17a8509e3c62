//! Comparing at equal quality: Rapier's substeps are raised until its body is as stiff as ours.

use crate::side::{Side, TOLERANCE, Watched, fall};
use crate::{Drop, Effort, FRAME, Result, WIDTH, ours, theirs};

/// How often Rapier may go over its constraints in a substep; its default first, which is seldom far off.
const SWEEPS: [usize; 4] = [4, 8, 2, 1];
/// Where raising the substeps ends.
const MOST_SUBSTEPS: usize = 128;

/// A body falls in both engines, a frame of fuwafuwa's and a frame of Rapier's in turns; returns fuwafuwa's side and
/// Rapier's. Rapier gets so few substeps that its peak squash is just within 2 percentage points of ours, or below that,
/// with the number of sweeps that is fastest then; `trying` hears of all that is tried before. They run until the deepest
/// squash is over, even if that takes more frames than the scene has.
///
/// # Errors
/// [`Error`](crate::Error) when the scene makes no sense.
pub fn compare_drop(scene: &Drop, mut trying: impl FnMut(Effort)) -> Result<[Side; 2]> {
    let frames = frames_to_peak(scene);
    let [alone] = fall([ours(scene)?], frames);
    let limit = alone.peak_squash + TOLERANCE;
    let mut fastest = f64::INFINITY;
    let mut effort = Effort {
        substeps: MOST_SUBSTEPS,
        sweeps: SWEEPS[0],
    };
    for sweeps in SWEEPS {
        let start = Effort {
            substeps: 1,
            sweeps,
        };
        if let Some(found) = enough(scene, start, frames, limit, fastest, &mut trying)? {
            (effort, fastest) = found;
        }
    }
    let frames = scene.frames.max(frames);
    Ok(fall([ours(scene)?, theirs(scene, effort)?], frames))
}

/// With how many substeps Rapier's body is not squashed deeper than `limit`, raised by a quarter at a time, and the
/// median time of a frame with so many [ms]; nothing if that is not faster than `fastest` [ms], or out of reach.
fn enough(
    scene: &Drop,
    mut effort: Effort,
    frames: usize,
    limit: f64,
    fastest: f64,
    mut trying: impl FnMut(Effort),
) -> Result<Option<(Effort, f64)>> {
    loop {
        trying(effort);
        let mut watched = Watched::new(theirs(scene, effort)?);
        let too_soft = (0..frames).any(|_| {
            watched.step();
            watched.side.peak_squash > limit || !watched.side.finite
        });
        let median = watched.side.median();
        if median >= fastest {
            return Ok(None);
        }
        if !too_soft {
            return Ok(Some((effort, median)));
        }
        effort.substeps += (effort.substeps / 4).max(1);
        if effort.substeps > MOST_SUBSTEPS {
            return Ok(None);
        }
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
                assert!(side.finite && side.stiffness_scale == 1.0);
                assert!((0.01..0.15).contains(&side.peak_squash), "{side:?}");
            }
            assert!(ours.equals(&theirs), "{ours:?} {theirs:?}");
        }
    }

    #[test]
    fn substeps_rise_until_the_body_is_stiff_enough() {
        let scene = small(2, 16);
        let whole = |effort| fall([theirs(&scene, effort).expect("the scene makes sense")], 40);
        let least = Effort {
            substeps: 1,
            sweeps: 4,
        };
        let [soft] = whole(least);
        let limit = soft.peak_squash - 0.01;
        let mut tried = Vec::new();
        let found = enough(&scene, least, 40, limit, f64::INFINITY, |effort| {
            tried.push(effort);
        });
        let (effort, _) = found
            .expect("the scene makes sense")
            .expect("anything is faster than never");
        assert!(
            effort.substeps > 1 && tried.last() == Some(&effort),
            "{tried:?}"
        );
        let [stiffer] = whole(effort);
        assert!(stiffer.peak_squash <= limit);
        let faster = enough(&scene, least, 40, limit, 0.0, |_| ());
        assert_eq!(faster, Ok(None));
    }
}
