//! Assists, which make a level easier. They are stored in the level itself, so that the level of a round or a
//! replay shows which assists were used.

use crate::level::LevelError;
use crate::{Assist, Level, Route};
use fuwafuwa_scenes::Scene;
use fuwafuwa_scenes::scene::{BoxText, GameText, ObstacleText};
use std::collections::BTreeSet;

/// Growth of a wider basket on each side, as a share of the basket's half width.
const WIDER: f32 = 0.25;
/// Minimum space between a side of the basket and the arena's end, as a multiple of the side's movement. With
/// less space, the side stays, because a bar must fit between both.
const ROOM: f32 = 2.5;

impl Level {
    /// Returns the level with `assists` added to the assists that the level already has. Assists that the level
    /// ignores are left out; see [`GameText::ignored_assists`].
    ///
    /// # Errors
    /// [`LevelError`] if the resulting level cannot be played.
    pub fn assisted(&self, assists: &BTreeSet<Assist>) -> Result<Self, LevelError> {
        Self::from_scene(&self.id, assisted(self.scene(), assists))
    }

    /// Returns whether this level and `plain` are the same apart from assists.
    pub fn is_version_of(&self, plain: &Level) -> bool {
        self.id == plain.id && *self.scene() == assisted(plain.scene(), &self.game().assists)
    }
}

/// Returns the scene with `assists` applied; see [`Level::assisted`].
pub(crate) fn assisted(scene: &Scene, assists: &BTreeSet<Assist>) -> Scene {
    let mut scene = scene.clone();
    for &assist in assists {
        let game = scene.game.as_mut();
        let applies = |game: &mut GameText| !game.ignores(assist) && game.assists.insert(assist);
        if !game.is_some_and(applies) {
            continue;
        }
        match assist {
            Assist::WiderBasket => widen(&mut scene),
            Assist::Unbreakable => make_unbreakable(&mut scene),
        }
    }
    scene
}

/// Makes all materials unbreakable, which rules out shaving.
fn make_unbreakable(scene: &mut Scene) {
    for material in &mut scene.material {
        (material.strength, material.toughness) = (None, None);
        material.unbreakable = true;
    }
    if let Some(game) = &mut scene.game {
        game.routes.retain(|&route| route == Route::Squeeze);
    }
}

/// Widens the basket on every axis without gravity: moves the sides apart, together with the obstacles around
/// them.
fn widen(scene: &mut Scene) {
    let Some(basket) = scene.game.as_mut().and_then(|game| game.basket.as_mut()) else {
        return;
    };
    for axis in 0..usize::from(scene.dim) {
        if scene.gravity[axis] != 0.0 {
            continue;
        }
        let stretch = Stretch::of(basket, scene.view, axis);
        stretch.widen(basket, axis);
        for obstacle in &mut scene.obstacle {
            stretch.carry(obstacle, axis);
        }
    }
}

/// Piecewise linear map of coordinates on an axis for a wider basket. The basket is stretched, the space on
/// both sides is compressed, and the ends of the arena stay in place.
struct Stretch {
    /// Coordinates before the change [m]: low end of the arena, low side of the basket, high side of the
    /// basket, high end of the arena.
    from: [f32; 4],
    to: [f32; 4],
}

impl Stretch {
    fn of(basket: &BoxText, [low, high]: [[f32; 3]; 2], axis: usize) -> Self {
        let (middle, half) = (basket.centre[axis], basket.half[axis]);
        let from = [low[axis], middle - half, middle + half, high[axis]];
        let wanted = WIDER * half;
        let step = |room: f32| if room > ROOM * wanted { wanted } else { 0.0 };
        let mut to = from;
        to[1] -= step(from[1] - from[0]);
        to[2] += step(from[3] - from[2]);
        Self { from, to }
    }

    fn point(&self, x: f32) -> f32 {
        let is_within = |k: &usize| (self.from[*k]..self.from[k + 1]).contains(&x);
        let Some(k) = (0..3).find(is_within) else {
            return x;
        };
        let share = (x - self.from[k]) / (self.from[k + 1] - self.from[k]);
        self.to[k] + share * (self.to[k + 1] - self.to[k])
    }

    /// Returns the new centre of a ball or bar with centre `x` and radius `reach`. The map moves the side
    /// that faces the basket, and the centre follows at the same radius.
    fn middle(&self, x: f32, reach: f32) -> f32 {
        let out = x - 0.5 * (self.from[1] + self.from[2]);
        let side = out.clamp(-reach, reach);
        self.point(x - side) + side
    }

    fn widen(&self, shape: &mut BoxText, axis: usize) {
        let (middle, half) = (shape.centre[axis], shape.half[axis]);
        let [low, high] = [middle - half, middle + half].map(|x| self.point(x));
        shape.centre[axis] = 0.5 * (low + high);
        shape.half[axis] = 0.5 * (high - low);
    }

    fn carry(&self, obstacle: &mut ObstacleText, axis: usize) {
        let plane = obstacle.half_space.as_mut();
        if let Some(plane) = plane.filter(|plane| plane.normal[axis] != 0.0) {
            plane.point[axis] = self.point(plane.point[axis]);
        }
        if let Some(shape) = &mut obstacle.boxed {
            self.widen(shape, axis);
        }
        if let Some(bar) = &mut obstacle.capsule {
            for end in [&mut bar.from, &mut bar.to] {
                end[axis] = self.middle(end[axis], bar.radius);
            }
        }
        if let Some(ball) = &mut obstacle.ball {
            ball.centre[axis] = self.middle(ball.centre[axis], ball.radius);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::level::built_in;
    use crate::{AnyRound, InputFrame};
    use std::sync::Arc;

    fn with(id: &str, assists: &[Assist]) -> Level {
        let level = Level::open(id).unwrap();
        level.assisted(&assists.iter().copied().collect()).unwrap()
    }

    #[test]
    fn wider_basket_moves_the_bars_but_not_the_arena() {
        let [plain, wide] = [
            with("classic", &[]),
            with("classic", &[Assist::WiderBasket]),
        ];
        let basket = |level: &Level| level.game().basket.clone().unwrap();
        let [before, after] = [basket(&plain), basket(&wide)];
        assert!((after.half[1] - 1.25 * before.half[1]).abs() < 1e-5);
        // The far side of the basket must stay, because the bar there has no space behind it.
        let end = |basket: &BoxText| basket.centre[0] + basket.half[0];
        assert!((end(&after) - end(&before)).abs() < 1e-5);
        assert_eq!(plain.arena(), wide.arena());
        let upper = |level: &Level| level.scene().obstacle[0].capsule.clone().unwrap();
        let inside = upper(&wide).from[1] - upper(&wide).radius;
        let top = after.centre[1] + after.half[1];
        assert!(
            (inside - top).abs() < 1e-4,
            "the bar is at {inside} m, the basket's side at {top} m"
        );
        assert_eq!(upper(&wide).from[1], upper(&wide).to[1]);
        assert_eq!(
            plain.scene().obstacle[3..],
            wide.scene().obstacle[3..],
            "walls must not move"
        );
    }

    #[test]
    fn wider_basket_is_free_of_bars() {
        for (id, _) in built_in() {
            let [plain, wide] = [with(id, &[]), with(id, &[Assist::WiderBasket])];
            let (Some(before), Some(after)) = (&plain.game().basket, &wide.game().basket) else {
                assert_eq!(plain.scene().obstacle, wide.scene().obstacle, "{id}");
                continue;
            };
            if plain.game().ignored_assists.contains(&Assist::WiderBasket) {
                assert_eq!(before, after, "{id}");
                continue;
            }
            let size = |basket: &BoxText| {
                basket.half[..plain.scene().dim.into()]
                    .iter()
                    .product::<f32>()
            };
            assert!(
                size(after) > 1.2 * size(before),
                "{id}: {before:?}, {after:?}"
            );
            // Checks that no bar reaches further into the wider basket than into the plain one.
            let into = |level: &Level| -> Vec<f32> {
                let basket = level.game().basket.as_ref().unwrap();
                let bars = level
                    .scene()
                    .obstacle
                    .iter()
                    .filter_map(|obstacle| obstacle.capsule.as_ref());
                let depth = |bar: &fuwafuwa_scenes::scene::CapsuleText| {
                    let axes = 0..usize::from(level.scene().dim);
                    let depths = axes.map(|axis| {
                        let away =
                            [bar.from, bar.to].map(|end| (end[axis] - basket.centre[axis]).abs());
                        basket.half[axis] - (away[0].min(away[1]) - bar.radius)
                    });
                    depths.fold(f32::INFINITY, f32::min).max(0.0)
                };
                bars.map(depth).collect()
            };
            for (before, after) in into(&plain).into_iter().zip(into(&wide)) {
                assert!(
                    after <= 1.25 * before + 1e-4,
                    "{id}: {before} m, now {after} m"
                );
            }
        }
    }

    #[test]
    fn unbreakable_level_offers_squeezing_only() {
        for id in ["classic", "biscuit", "core", "pudding"] {
            let level = with(id, &[Assist::Unbreakable]);
            assert_eq!(level.routes(), [Route::Squeeze], "{id}");
            assert!(level.is_version_of(&Level::open(id).unwrap()), "{id}");
            assert!(!level.is_version_of(&Level::open("gravity").unwrap()));
        }
    }

    #[test]
    fn replay_with_assists_is_not_of_the_plain_level() {
        let plain = Arc::new(Level::open("classic").unwrap());
        let all = BTreeSet::from([Assist::WiderBasket, Assist::Unbreakable]);
        let easy = Arc::new(plain.assisted(&all).unwrap());
        let mut round = AnyRound::new(easy.clone());
        round.step(InputFrame::default());
        let replay = round.replay();
        assert!(replay.is_of(&easy) && !replay.is_of(&plain));
        assert_eq!(replay.level().unwrap().game().assists, all);
        assert_eq!(
            easy.assisted(&all).unwrap(),
            *easy,
            "repeated assists must have no effect"
        );
        assert_eq!(plain.assisted(&BTreeSet::new()).unwrap(), *plain);
    }
}
