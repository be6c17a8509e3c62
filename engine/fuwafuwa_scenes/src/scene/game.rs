//! Rules of the game in a scene file.

use super::error::{FieldError, expected_number, require};
use super::shapes::{BoxText, ShapeChoice, check_path};
use fuwafuwa::{Dim, Shape};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

/// The `[game]` table of a level. The engine ignores it; the crate `tamaire_play` applies it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GameText {
    /// Name of the level.
    pub name: LocalizedText,
    /// Name of its maker, as the maker wants to be called.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub made_by: Option<String>,
    /// Name of the level from which it was made.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub changed_from: Option<String>,
    /// Region that must be filled, enclosed by the wooden bars.
    pub basket: Option<BoxText>,
    /// Several regions that must all be filled at the same time, in place of `basket`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub baskets: Vec<BasketText>,
    /// Share of the bodies' mass that must rest in the basket, above 0 and up to 1; default 0.6.
    #[serde(default = "usual_share")]
    pub share: f32,
    /// Time for which `share` of the mass must rest in the basket [s], 0 to 60; default 1.
    #[serde(default = "usual_hold")]
    pub hold: f32,
    /// Whether the basket counts only while no hand touches a piece in it; default false.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub alone: bool,
    /// Numbers of the bodies that have to rest in the basket, counted from 1. If empty, all bodies. The others are
    /// tools or furniture: their mass and pieces do not count, and a hand may touch them. Goals about joints count all
    /// joints.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub bodies: Vec<usize>,
    /// Conditions without which the level is not won. They are those of a goal.
    pub require: Option<WishText>,
    /// Routes by which the level can be won. If empty, all routes that its materials allow.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub routes: Vec<RouteText>,
    /// Aids that were active, so that results with aids can be told apart. The game writes them into a
    /// recorded round; in a level file they have no effect.
    #[serde(default, skip_serializing_if = "BTreeSet::is_empty")]
    pub assists: BTreeSet<AssistText>,
    /// Aids that the level ignores, because it could not be won with them.
    #[serde(default, skip_serializing_if = "BTreeSet::is_empty")]
    pub ignored_assists: BTreeSet<AssistText>,
    /// Optional goals of the level.
    #[serde(default)]
    pub wish: Vec<WishText>,
    /// First move, which the game shows to a player who is stuck: points of the path of the first hand, as in
    /// [`HandText::path`](super::HandText::path). At most 15 s.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub hint: Vec<[f32; 4]>,
}

/// One of several regions that must be filled.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BasketText {
    /// Centre [m].
    pub centre: [f32; 3],
    /// Half widths on each axis [m]; the third is ignored in 2D.
    pub half: [f32; 3],
    /// Share of the mass of its bodies that must rest in it, above 0 and up to 1; default that of the level.
    pub share: Option<f32>,
    /// Numbers of the bodies that have to rest in it, counted from 1; default those of the level.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub bodies: Vec<usize>,
    /// Numbers of the bodies that must not be in it. It does not count while it holds more than a crumb of them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub refuses: Vec<usize>,
}

/// Aid that makes a level easier.
#[derive(Copy, Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum AssistText {
    /// The bars of the basket stand farther apart.
    WiderBasket,
    /// Nothing tears.
    Unbreakable,
}

/// A text in each language of the game.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LocalizedText {
    /// English.
    pub en: String,
    /// Japanese; English is used if missing.
    pub ja: Option<String>,
}

/// An optional goal of a level. All its conditions must hold in the same round.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WishText {
    /// Maximum time to win [s].
    pub seconds: Option<f32>,
    /// Minimum mass of the bodies' largest pieces when the level is won, as a share of that mass at the
    /// start, 0 to 1.
    pub kept: Option<f32>,
    /// Minimum number of pieces when the level is won.
    pub pieces: Option<usize>,
    /// Maximum number of pieces when the level is won.
    pub max_pieces: Option<usize>,
    /// State of the joints when the level is won.
    pub joints: Option<JointsText>,
    /// Numbers of bodies that must be whole when the level is won, counted from 1. Bodies that do not count for the
    /// basket may be among them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub whole: Vec<usize>,
    /// Minimum share of the mass of all bodies that count in the baskets when the level is won, 0 to 1.
    pub inside: Option<f32>,
    /// Route by which the level must be won.
    pub route: Option<RouteText>,
}

/// State of the joints of a level when it is won.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum JointsText {
    /// No joint broke.
    Whole,
    /// At least one joint broke.
    Broken,
}

/// Route by which a round was won.
#[derive(Copy, Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RouteText {
    /// The body is squeezed into the basket whole (押し込み).
    Squeeze,
    /// The body is shaved until it fits (削り).
    Shave,
    /// A mix of squeezing and shaving.
    Mix,
}

/// Maximum number of optional goals in a level: the result screen lists them all.
const MAX_WISHES: usize = 8;

/// Maximum duration of the first move that a level shows [s].
const MAX_HINT: f32 = 15.0;

/// Maximum number of baskets in a level.
const MAX_BASKETS: usize = 8;

impl GameText {
    /// Returns all baskets of the level, with their shares and bodies.
    pub fn all_baskets(&self) -> Vec<BasketText> {
        let only = self.basket.iter().map(|basket| BasketText {
            centre: basket.centre,
            half: basket.half,
            ..BasketText::default()
        });
        let all = only.chain(self.baskets.iter().cloned());
        let filled = all.map(|mut basket| {
            basket.share = basket.share.or(Some(self.share));
            if basket.bodies.is_empty() {
                basket.bodies = self.bodies.clone();
            }
            basket
        });
        filled.collect()
    }

    /// Returns whether an aid has no effect: the level ignores it, or has several baskets, which stay as wide as they are.
    pub fn ignores(&self, assist: AssistText) -> bool {
        let is_fixed = assist == AssistText::WiderBasket && !self.baskets.is_empty();
        is_fixed || self.ignored_assists.contains(&assist)
    }

    /// Checks every field, and returns the regions of the baskets. The scene has `bodies` bodies and `joints` joints
    /// that can break.
    pub(super) fn check<D: Dim>(
        &self,
        bodies: usize,
        joints: usize,
    ) -> Result<Vec<Shape<D>>, FieldError> {
        check_numbers("bodies", &self.bodies, bodies)?;
        let regions = self.regions::<D>(bodies)?;
        let expected = "expected a name of 1 to 60 letters";
        for (field, name) in [
            ("name.en", Some(&self.name.en)),
            ("name.ja", self.name.ja.as_ref()),
        ] {
            let letters = name.map_or(1, |name| name.chars().count());
            require((1..=60).contains(&letters), field, expected)?;
        }
        let expected = |range: &str, found: f32| format!("expected {range}, found {found}");
        let good = self.share > 0.0 && self.share <= 1.0;
        require(good, "share", expected("above 0, up to 1", self.share))?;
        let good = (0.0..=60.0).contains(&self.hold);
        require(good, "hold", expected("0 to 60 s", self.hold))?;
        let good = !self.alone || self.hold > 0.0;
        require(good, "hold", "expected more than 0 s with alone = true")?;
        let count = self.wish.len();
        let most = format!("expected {MAX_WISHES} at most, found {count}");
        require(count <= MAX_WISHES, "wish", most)?;
        for (index, wish) in self.wish.iter().enumerate() {
            let checked = wish.check(bodies, joints);
            checked.map_err(|wrong| wrong.inside("wish", index))?;
        }
        if let Some(required) = &self.require {
            let checked = required.check(bodies, joints);
            checked.map_err(|wrong| wrong.under("require"))?;
        }
        check_path::<D>("hint", &self.hint)?;
        let end = self.hint.last().map_or(0.0, |end| end[0]);
        require(end <= MAX_HINT, "hint", expected("15 s at most", end))?;
        Ok(regions)
    }

    /// Checks the baskets, and returns their regions.
    fn regions<D: Dim>(&self, bodies: usize) -> Result<Vec<Shape<D>>, FieldError> {
        let region = |text: &BoxText| {
            let shapes = ShapeChoice {
                half_space: None,
                boxed: Some(text),
                capsule: None,
                ball: None,
            };
            shapes.only::<D>()
        };
        let good = self.basket.is_none() || self.baskets.is_empty();
        require(good, "baskets", "expected either basket or baskets")?;
        let count = self.baskets.len();
        let expected = format!("expected {MAX_BASKETS} at most, found {count}");
        require(count <= MAX_BASKETS, "baskets", expected)?;
        let only = self.basket.as_ref().map(region).transpose()?;
        let mut regions = Vec::from_iter(only);
        for (index, basket) in self.baskets.iter().enumerate() {
            let inside = |wrong: FieldError| wrong.inside("baskets", index);
            check_numbers("bodies", &basket.bodies, bodies).map_err(inside)?;
            check_numbers("refuses", &basket.refuses, bodies).map_err(inside)?;
            let share = basket.share.unwrap_or(1.0);
            let good = share > 0.0 && share <= 1.0;
            let expected = format!("expected above 0, up to 1, found {share}");
            require(good, "share", expected).map_err(inside)?;
            let (centre, half) = (basket.centre, basket.half);
            regions.push(region(&BoxText { centre, half }).map_err(inside)?);
        }
        Ok(regions)
    }
}

/// Checks a list of numbers of bodies.
pub(super) fn check_numbers(
    field: &str,
    numbers: &[usize],
    bodies: usize,
) -> Result<(), FieldError> {
    for (index, &number) in numbers.iter().enumerate() {
        let field = format!("{field}.{}", index + 1);
        let expected = expected_number(bodies, number);
        require((1..=bodies).contains(&number), &field, expected)?;
        let expected = format!("expected each body once, found {number} again");
        require(!numbers[..index].contains(&number), &field, expected)?;
    }
    Ok(())
}

impl WishText {
    /// Checks every field; see [`GameText::check`].
    fn check(&self, bodies: usize, joints: usize) -> Result<(), FieldError> {
        let expected = |range: &str, found: f32| format!("expected {range}, found {found}");
        let seconds = self.seconds.unwrap_or(1.0);
        let good = seconds > 0.0 && seconds.is_finite();
        require(good, "seconds", expected("more than 0 s", seconds))?;
        for (field, share) in [("kept", self.kept), ("inside", self.inside)] {
            let share = share.unwrap_or(1.0);
            let good = (0.0..=1.0).contains(&share);
            require(good, field, expected("0 to 1", share))?;
        }
        let [least, most] = [self.pieces, self.max_pieces];
        let least = least.unwrap_or(1).max(1);
        let good = most.is_none_or(|most| most >= least);
        let found = most.unwrap_or_default();
        let expected = format!("expected at least {least}, found {found}");
        require(good, "max_pieces", expected)?;
        let good = joints > 0 || self.joints.is_none();
        let expected = "expected a joint with a breaking_force or a switch in the level";
        require(good, "joints", expected)?;
        check_numbers("whole", &self.whole, bodies.min(MAX_TOLD_BODIES))?;
        let given = self != &Self::default();
        let expected = "expected at least one of seconds, kept, inside, pieces, max_pieces, joints, whole and route";
        require(given, "seconds", expected)
    }
}

/// Bodies up to this number can be named in [`WishText::whole`].
pub const MAX_TOLD_BODIES: usize = 32;

fn usual_share() -> f32 {
    0.6
}

fn usual_hold() -> f32 {
    1.0
}
