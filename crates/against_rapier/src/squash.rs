//! Comparing at equal quality: substeps are raised until the body is as stiff as its material.

use std::ops::RangeInclusive;

use crate::{Drop, FRAME, Outcome, Result, WIDTH};

/// How far the peak squash may be from the one wanted: 2 percentage points.
const TOLERANCE: f64 = 0.02;

/// A fall with as many substeps as the wanted squash takes.
#[derive(Clone, Debug)]
pub struct AtSquash {
    /// Substeps in each frame.
    pub substeps: usize,
    /// The fall with that many.
    pub outcome: Outcome,
    /// Whether its peak squash is within 2 percentage points of the one wanted. If not, either the range was too
    /// short, or the body is stiffer than wanted with any number of substeps.
    pub reached: bool,
}

/// Raises the substeps, a quarter at a time, until the peak squash is within 2 percentage points of `wanted` or below
/// that, and runs the scene with those. `fall` is [`drop_disc`](crate::drop_disc) or [`drop_ball`](crate::drop_ball);
/// the scene's own substeps count for nothing.
///
/// # Errors
/// [`Error`](crate::Error) when the scene makes no sense.
pub fn drop_at_squash(
    fall: fn(&Drop) -> Result<Outcome>,
    scene: &Drop,
    wanted: f64,
    substeps: RangeInclusive<usize>,
) -> Result<AtSquash> {
    let mut tried = Drop {
        substeps: *substeps.start(),
        frames: scene.frames.min(frames_to_peak(scene)),
        ..*scene
    };
    while fall(&tried)?.peak_squash > wanted + TOLERANCE {
        let raised = tried.substeps + (tried.substeps / 4).max(1);
        if raised > *substeps.end() {
            break;
        }
        tried.substeps = raised;
    }
    let outcome = fall(&Drop {
        frames: scene.frames,
        ..tried
    })?;
    Ok(AtSquash {
        substeps: tried.substeps,
        reached: (outcome.peak_squash - wanted).abs() <= TOLERANCE,
        outcome,
    })
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
    use crate::drop_disc;

    #[test]
    fn substeps_rise_until_the_disc_is_stiff_enough() {
        let scene = Drop {
            n: 12,
            height: 0.3,
            frames: 40,
            ..Drop::default()
        };
        let soft = drop_disc(&Drop {
            substeps: 1,
            ..scene
        })
        .expect("the scene makes sense");
        let wanted = soft.peak_squash - 0.03;
        let found =
            drop_at_squash(drop_disc, &scene, wanted, 1..=32).expect("the scene makes sense");
        assert!(found.reached && found.substeps > 1, "{found:?}");
        let all_too_soft =
            drop_at_squash(drop_disc, &scene, wanted, 1..=1).expect("the scene makes sense");
        assert!(
            !all_too_soft.reached && all_too_soft.substeps == 1,
            "{all_too_soft:?}"
        );
    }
}
