//! View of a round at rest, used on the screen and for level thumbnails.

use super::Face;
use super::feelings::Feeling;
use app_shell::{Theme, View};
use fuwafuwa::{Dim, Vec2};
use fuwafuwa_render::palette::Colour;
use fuwafuwa_render::{Basket, Camera, DimCamera, Frame, Tints};
use tamaire_play::{Level, Round};

/// Returns the render frame of a round without effects, drawn faces or ghost.
pub(super) fn frame<'a, C: DimCamera>(
    camera: C,
    round: &'a Round<C::Dim>,
    theme: &'a Theme,
) -> Frame<'a, C> {
    let baskets = round.baskets().iter().zip(&round.progress().fills);
    let baskets = baskets.map(|(basket, &fill)| Basket {
        region: basket.region,
        fill,
        colour: own_colour(round, basket),
    });
    Frame {
        camera,
        palette: &theme.world,
        tints: tints(round.level()),
        look: fuwafuwa_render::Look::Skin,
        baskets: baskets.collect(),
        particles: &[],
        stickers: &[],
        ghost: None,
        props: &[],
        seconds: 0.0,
    }
}

/// Returns the colour of a basket for a single body, in a level with several baskets: that of the body.
fn own_colour<D: Dim>(round: &Round<D>, basket: &tamaire_play::Basket<D>) -> Option<Colour> {
    let level = round.level();
    let [body] = basket.bodies[..] else {
        return None;
    };
    if round.baskets().len() < 2 {
        return None;
    }
    let material = level.scene().body[body - 1].material.unwrap_or(1);
    let colour = level.colours().get(usize::from(material) - 1).copied()??;
    Some(colour.map(|part| f32::from(part) / 255.0))
}

/// Returns the colours that a level gives to its materials.
fn tints<D: Dim>(level: &Level) -> Tints<'_, D> {
    Tints {
        colours: level.colours(),
        grids: level.tint_grids(),
    }
}

/// Converts `view` to a camera of the 2D renderer.
pub(super) fn camera(view: &View) -> Camera {
    Camera {
        centre: Vec2::from(view.centre),
        height: view.height(),
        tilt: 0.0,
        shake: Vec2::ZERO,
    }
}

/// Returns the drawn face of a body looking straight ahead, scaled by `size` (1 = normal).
pub(super) fn face_at_rest(body: usize, feeling: &Feeling, size: f32) -> Face {
    Face {
        body,
        piece: feeling.piece,
        at: feeling.at,
        axes: feeling.axes.map(|axis| axis * (size * feeling.size)),
        mood: feeling.mood,
        blink: 0.0,
        look_at: feeling.at + feeling.axes[2],
    }
}
