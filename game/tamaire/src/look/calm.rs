//! How a round is seen while nothing happens: on the screen, and in a little picture of its level.

use super::feelings::Feeling;
use super::{Face, Theme, View};
use fuwafuwa::Dim;
use fuwafuwa::vector::{plus, scaled};
use fuwafuwa_render::{Basket, Camera, Frame};
use tamaire_play::Round;

/// How a round is seen from somewhere while nothing happens.
pub(super) fn frame<'a, D: Dim, C>(camera: C, round: &Round<D>, theme: &'a Theme) -> Frame<'a, C> {
    let fill = (round.progress().inside / round.level().game().share).clamp(0.0, 1.0);
    Frame {
        camera,
        palette: &theme.world,
        look: fuwafuwa_render::Look::Skin,
        basket: round.basket().map(|&region| Basket { region, fill }),
        particles: &[],
        stickers: &[],
        ghost: None,
        props: &[],
        seconds: 0.0,
    }
}

/// The view as the renderer takes it.
pub(super) fn camera(view: &View) -> Camera {
    Camera {
        centre: [view.centre[0], view.centre[1], 0.0],
        height: view.height(),
        tilt: 0.0,
        shake: [0.0; 3],
    }
}

/// The face of a body that looks straight ahead, so many times as large as usual.
pub(super) fn face_of(body: usize, feeling: &Feeling, size: f32) -> Face {
    Face {
        body,
        piece: feeling.piece,
        at: feeling.at,
        axes: feeling.axes.map(|axis| scaled(axis, size * feeling.size)),
        mood: feeling.mood,
        blink: 0.0,
        look_at: plus(feeling.at, feeling.axes[2]),
    }
}
