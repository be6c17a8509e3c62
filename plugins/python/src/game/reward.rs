//! Rewards of a step.

use tamaire_play::{AnyRound, Progress, Route};

/// Share of the mass up to which torn-off mass is rewarded on the way to a shaved win: about what a disc loses if both
/// sides are cut to the opening of the level `classic`, which has 0.85 of its width.
const SHAVED: f32 = 0.07;
/// Cost of tearing the whole mass off: in [`Reward::Squeeze`], and beyond [`SHAVED`] in [`Reward::Shave`].
const TEARING: f32 = 2.0;

/// Reward of a win on top of a potential, whose change over a won round is about 2.
const WIN: f32 = 5.0;

/// Names of the rewards.
pub const REWARDS: [(&str, Reward); 4] = [
    ("sparse", Reward::Sparse),
    ("shaped", Reward::Shaped),
    ("squeeze", Reward::Squeeze),
    ("shave", Reward::Shave),
];

/// Reward of a step. `python/fuwafuwa/envs` documents the formulas for users.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Reward {
    /// 1 for the win.
    Sparse,
    /// [`WIN`] for the win, and the change of the potential.
    Shaped,
    /// As `Shaped`, but only a squeezed win counts, and torn-off mass costs.
    Squeeze,
    /// As `Shaped`, but only a shaved win counts. Torn-off mass is part of the potential: up to [`SHAVED`] it is
    /// rewarded, beyond it costs.
    Shave,
}

/// State of a round that rewards depend on.
#[derive(Copy, Clone, Debug)]
pub struct Standing {
    /// Mean distance of the mass from the basket [m].
    pub distance: f32,
    potential: f32,
    kept: f32,
}

impl Reward {
    /// Returns the state of a round. `distance` is the mean distance of its mass from the basket [m].
    pub fn standing(self, round: &AnyRound, distance: f32) -> Standing {
        let (progress, share) = (round.progress(), round.level().game().share);
        let filled = (progress.within / share).min(1.0);
        let shaved = match self {
            Self::Shave => {
                let torn = 1.0 - progress.kept;
                (torn / SHAVED).min(1.0) - TEARING * (torn - SHAVED).max(0.0)
            }
            _ => 0.0,
        };
        Standing {
            distance,
            potential: filled - distance + shaved,
            kept: progress.kept,
        }
    }

    /// Returns the reward of a step that led from one state to another.
    pub fn of(self, before: Standing, now: Standing, progress: &Progress) -> f32 {
        let route = progress.outcome.map(|outcome| outcome.route);
        let win = match self {
            Self::Sparse | Self::Shaped => route.is_some(),
            Self::Squeeze => route == Some(Route::Squeeze),
            Self::Shave => route == Some(Route::Shave),
        };
        let win = f32::from(u8::from(win));
        let gain = now.potential - before.potential;
        match self {
            Self::Sparse => win,
            Self::Shaped | Self::Shave => WIN * win + gain,
            Self::Squeeze => WIN * win + gain - TEARING * (before.kept - now.kept).max(0.0),
        }
    }
}
