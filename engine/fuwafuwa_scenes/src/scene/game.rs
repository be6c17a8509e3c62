//! What makes a game of a scene, as it is written down.

use super::error::{Wrong, require};
use super::rigid::{BoxText, Shapes};
use fuwafuwa::{Dim, Shape};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

/// The table `[game]` of a level. The engine knows nothing of it; the crate `tamaire_play` plays by it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GameText {
    /// What the level is called.
    pub name: Words,
    /// The region that the bars enclose.
    pub basket: Option<BoxText>,
    /// Share of the bodies' mass that must rest in the basket, above 0 and up to 1.
    #[serde(default = "usual_share")]
    pub share: f32,
    /// For how long it must rest there [s].
    #[serde(default = "usual_hold")]
    pub hold: f32,
    /// The routes by which it can be won, where they are not those that its materials allow.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub routes: Vec<RouteText>,
    /// What was made easier in it, so that what is won in it can be told from what is won without help.
    /// The game writes it down with a round; in the file of a level it counts for nothing.
    #[serde(default, skip_serializing_if = "BTreeSet::is_empty")]
    pub assists: BTreeSet<AssistText>,
    /// What else one may try.
    #[serde(default)]
    pub wish: Vec<WishText>,
}

/// What can be made easier in a level.
#[derive(Copy, Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum AssistText {
    /// The bars stand further apart.
    WiderBasket,
    /// Nothing tears.
    Unbreakable,
}

/// The same in each language of the game.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Words {
    /// English.
    pub en: String,
    /// Japanese; English where it is left out.
    pub ja: Option<String>,
}

/// A wish that a level has beyond being won: all that it names must come true.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WishText {
    /// Won within so many seconds.
    pub seconds: Option<f32>,
    /// Won with at least this share of the mass still in one piece.
    pub kept: Option<f32>,
    /// Won with at least so many pieces.
    pub pieces: Option<usize>,
    /// Won by this route.
    pub route: Option<RouteText>,
}

/// How a round was won.
#[derive(Copy, Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RouteText {
    /// Whole, by squeezing (押し込み).
    Squeeze,
    /// By shaving until it fitted (削り).
    Shave,
    /// By some of both.
    Mix,
}

/// Most wishes of a level: all of them are listed with its result.
const MAX_WISHES: usize = 8;

impl GameText {
    /// Its basket, checked, where it has one.
    pub(super) fn basket<D: Dim>(&self) -> Result<Option<Shape>, Wrong> {
        let shape = |text| {
            let shapes = Shapes {
                half_space: None,
                boxed: Some(text),
                capsule: None,
                ball: None,
            };
            shapes.only::<D>()
        };
        self.basket.as_ref().map(shape).transpose()
    }

    /// Checks every field.
    pub(super) fn check<D: Dim>(&self) -> Result<(), Wrong> {
        self.basket::<D>()?;
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
        let count = self.wish.len();
        let most = format!("expected {MAX_WISHES} at most, found {count}");
        require(count <= MAX_WISHES, "wish", most)?;
        for (index, wish) in self.wish.iter().enumerate() {
            let inside = |wrong: Wrong| wrong.inside("wish", index);
            let seconds = wish.seconds.unwrap_or(1.0);
            let good = seconds > 0.0 && seconds.is_finite();
            require(good, "seconds", expected("more than 0 s", seconds)).map_err(inside)?;
            let kept = wish.kept.unwrap_or(1.0);
            let good = (0.0..=1.0).contains(&kept);
            require(good, "kept", expected("0 to 1", kept)).map_err(inside)?;
            let given = wish != &WishText::default();
            let expected = "expected one of seconds, kept, pieces and route at least";
            require(given, "seconds", expected).map_err(inside)?;
        }
        Ok(())
    }
}

fn usual_share() -> f32 {
    0.6
}

fn usual_hold() -> f32 {
    1.0
}
