//! View of a round at rest, used on the screen and for level thumbnails.

use super::Face;
use super::feelings::Feeling;
use app_shell::{Theme, View};
use fuwafuwa::Dim;
use fuwafuwa::inspect::vector::{plus, scaled};
use fuwafuwa_render::{Basket, Camera, Frame};
use tamaire_play::Round;

/// Returns the render frame of a round without effects, stickers or ghost.
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

/// Converts `view` to a camera of the 2D renderer.
pub(super) fn camera(view: &View) -> Camera {
    Camera {
        centre: [view.centre[0], view.centre[1], 0.0],
        height: view.height(),
        tilt: 0.0,
        shake: [0.0; 3],
    }
}

/// Returns the face of a body looking straight ahead, scaled by `size` (1 = normal).
pub(super) fn face_at_rest(body: usize, feeling: &Feeling, size: f32) -> Face {
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
