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
        colour: own_colour(round, basket, theme),
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

/// Maximum lightness of a basket's own colour, 0 to 1: a paler one would not be seen on the floor.
const LIGHTEST: f32 = 0.62;

/// Returns the colour of a basket for which only some bodies count, if these are of one material: that of the material.
fn own_colour<D: Dim>(
    round: &Round<D>,
    basket: &tamaire_play::Basket<D>,
    theme: &Theme,
) -> Option<Colour> {
    let level = round.level();
    let material = |body: &usize| level.scene().body[body - 1].material.unwrap_or(1);
    let first = material(basket.bodies.first()?);
    if basket.bodies.iter().any(|body| material(body) != first) {
        return None;
    }
    let colour = theme.world.tinted_material(first, level.colours());
    let [red, green, blue] = colour;
    let lightness = 0.3 * red + 0.59 * green + 0.11 * blue;
    let scale = (LIGHTEST / lightness).min(1.0);
    Some(colour.map(|part| scale * part))
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
