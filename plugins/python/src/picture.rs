//! Pictures of worlds, painted without a GPU.

use fuwafuwa::{Dim, Dim2, Dim3, DimVector, RigidBodyRef, Vec2, Vec3, World};
use fuwafuwa_painter::solid::{Camera, Scene3d};
use fuwafuwa_painter::{PaintError, Painter, worlds};

/// Visible region of a world: low and high corner [m].
pub type View<D> = [<D as Dim>::Vector; 2];

/// Returns the bounding box of what a world shows, with a margin: soft bodies, and bounded rigid bodies.
pub fn view_of<D: Dim>(world: &World<D>) -> View<D> {
    let (mut low, mut high) = (Vec3::MAX, Vec3::MIN);
    let mut include = |[from, to]: [Vec3; 2]| {
        if from.is_finite() && to.is_finite() {
            low = low.min(from);
            high = high.max(to);
        }
    };
    for (_, body) in world.soft_bodies() {
        let pieces = body
            .piece_views()
            .into_iter()
            .filter(|piece| !piece.removed);
        pieces.for_each(|piece| include([piece.low, piece.high]));
    }
    let shown = world.rigid_bodies().filter(|(_, body)| !body.is_sensor());
    let bounds = |body: RigidBodyRef<'_, D>| body.shape().bounds().map(DimVector::to_vec3);
    shown.for_each(|(_, body)| include(bounds(body)));
    if low.x > high.x {
        (low, high) = (Vec3::splat(-1.0), Vec3::splat(1.0));
    }
    let margin = 0.1 * (high - low).max_element().max(1e-3);
    [low - Vec3::splat(margin), high + Vec3::splat(margin)].map(D::Vector::from_vec3)
}

/// Returns a picture of a 2D world as a PNG file.
pub fn plane(
    world: &World<Dim2>,
    [low, high]: View<Dim2>,
    width: u32,
    shows_elements: bool,
) -> Result<Vec<u8>, PaintError> {
    // A flat view would make the paper higher or lower than the painter allows.
    let size = high - low;
    let missing = (size.max_element() * 0.25 - size).max(Vec2::ZERO) * 0.5;
    let (mut painter, frame) = Painter::for_view([low - missing, high + missing], width);
    let draw = match shows_elements {
        true => worlds::plane_elements,
        false => worlds::plane_skin,
    };
    worlds::plane(&mut painter, frame, world, draw);
    painter.png()
}

/// Returns a picture of a 3D world as a PNG file, seen from the front, somewhat from the right and from above.
pub fn space(
    world: &World<Dim3>,
    [low, high]: View<Dim3>,
    width: u32,
    shows_elements: bool,
) -> Result<Vec<u8>, PaintError> {
    let (target, across) = (0.5 * (low + high), (high - low).length());
    let eye = target + across * Vec3::new(0.7, 0.6, 1.8);
    let mut scene = Scene3d::new(Camera {
        eye,
        target,
        across,
    });
    match shows_elements {
        true => worlds::space(&mut scene, world, |scene, body| {
            worlds::space_elements(scene, body, |_| true);
        }),
        false => worlds::space(&mut scene, world, worlds::space_skin),
    }
    fuwafuwa_painter::png_of(&scene.pixels(width, width)?)
}
