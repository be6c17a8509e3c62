//! How to look at a world, as plain data.

use crate::palette::{Colour, Palette};
use crate::plane::flat;
use fuwafuwa::{Dim3, PieceId, Shape, Vector, World};
use glam::Vec2;

/// Everything that a picture needs beside the world; for one in space, a camera in space.
#[derive(Clone, Debug)]
pub struct Frame<'a, C = Camera> {
    /// From where.
    pub camera: C,
    /// In which colours.
    pub palette: &'a Palette,
    /// The skin, or what is inside.
    pub look: Look<'a>,
    /// The region to get into.
    pub basket: Option<Basket>,
    /// Crumbs, dust, sparks.
    pub particles: &'a [Particle],
    /// What lies on skins in space. In the plane it is painted between the two halves of [`crate::Renderer::paint`].
    pub stickers: &'a [Sticker],
    /// A world whose bodies and hands are seen through, in space.
    pub ghost: Option<&'a World<Dim3>>,
    /// What is seen beside a world in space and is not in it, such as the handle of what a hand holds; as hands are.
    pub props: &'a [Prop],
    /// A clock for slow motion that means nothing, like the march of dashes [s].
    pub seconds: f64,
}

/// After so long all that moves by the clock is where it was [s]: the shaders count in single precision.
const CYCLE: f64 = 16.0;

impl<'a, C> Frame<'a, C> {
    /// The clock as the shaders have it [s].
    pub(crate) fn phase(&self) -> f32 {
        self.seconds.rem_euclid(CYCLE) as f32
    }

    /// The skin of a world as it stands, and nothing beside it.
    pub fn new(camera: C, palette: &'a Palette) -> Self {
        Self {
            camera,
            palette,
            look: Look::Skin,
            basket: None,
            particles: &[],
            stickers: &[],
            ghost: None,
            props: &[],
            seconds: 0.0,
        }
    }
}

/// A shape that ends somewhere, in its own colour.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Prop {
    /// Where it is.
    pub shape: Shape,
    /// Its colour.
    pub colour: Colour,
}

/// Where the camera is. What it looks at fills the target, whatever that measures.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Camera {
    /// What is in the middle [m]; in the plane the third coordinate does not count.
    pub centre: Vector,
    /// How much of the world is to be seen from bottom to top [m].
    pub height: f32,
    /// By how much it leans to its left [rad].
    pub tilt: f32,
    /// By how much it is shaken out of place [m].
    pub shake: Vector,
}

/// What to show of a body.
#[derive(Copy, Clone, Debug, PartialEq)]
pub enum Look<'a> {
    /// Its skin.
    Skin,
    /// Its elements.
    Elements {
        /// What their colour tells.
        colour: ElementColour,
        /// How long ago each element was remodelled [s], by body and element id: the young ones
        /// flash. [`crate::Ages`] keeps count. What is not listed is old.
        ages: &'a [Vec<f32>],
        /// Whether nodes are dots; in space they never are.
        nodes: bool,
    },
}

/// What the colour of an element tells.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum ElementColour {
    /// Its level.
    Level,
    /// How far it is strained.
    Strain,
}

/// The region to get into.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Basket {
    /// Where it is; a box, a capsule or a ball.
    pub region: Shape,
    /// How far it is filled, 0 to 1: it glows the more.
    pub fill: f32,
}

/// A round, soft dot.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Particle {
    /// Its middle [m].
    pub at: Vector,
    /// [m]
    pub radius: f32,
    /// Red, green, blue (sRGB), opacity; 0 to 1.
    pub colour: [f32; 4],
}

/// A patch of the plane.
#[derive(Clone, Debug, PartialEq)]
pub struct Mark {
    /// Its corners, counterclockwise, to the right and up; all between them and their mean belongs to it.
    pub outline: Vec<[f32; 2]>,
    /// Red, green, blue (sRGB), opacity; 0 to 1.
    pub colour: [f32; 4],
    /// How far its middle stands out of where it lies, where there is room to: its edge does not.
    pub bulge: f32,
    /// How far its edge does.
    pub lift: f32,
}

/// Marks on the skin of a piece, each on top of the one before: a face.
#[derive(Clone, Debug, PartialEq)]
pub struct Sticker {
    /// The body, by its place in the world.
    pub body: usize,
    /// Its piece.
    pub piece: PieceId,
    /// A place inside [m]. The sticker lies on the skin that is seen from there.
    pub from: Vector,
    /// To the right, up, and out of the skin; as long as a mark's coordinate 1 is to be [m].
    pub axes: [Vector; 3],
    /// What is on it.
    pub marks: Vec<Mark>,
}

impl Camera {
    /// The camera that sees all between two corners [m] in a target of `size` pixels.
    pub fn fit(low: Vector, high: Vector, size: [u32; 2]) -> Self {
        let aspect = size[0].max(1) as f32 / size[1].max(1) as f32;
        let span = flat(high) - flat(low);
        Self {
            centre: [0, 1, 2].map(|axis| 0.5 * (low[axis] + high[axis])),
            height: span.y.max(span.x / aspect),
            tilt: 0.0,
            shake: [0.0; 3],
        }
    }

    /// Where a place [m] of the plane is in a target of `size` pixels, from its upper left corner.
    pub fn to_pixel(&self, at: Vector, size: [u32; 2]) -> [f32; 2] {
        let [right, up] = self.axes();
        let by = flat(at) - self.middle();
        let scale = size[1] as f32 / self.height;
        [
            0.5 * size[0] as f32 + by.dot(right) * scale,
            0.5 * size[1] as f32 - by.dot(up) * scale,
        ]
    }

    /// The place [m] in the plane at a pixel of a target of `size` pixels.
    pub fn to_world(&self, pixel: [f32; 2], size: [u32; 2]) -> Vector {
        let [right, up] = self.axes();
        let scale = self.height / size[1].max(1) as f32;
        let along = right * (pixel[0] - 0.5 * size[0] as f32);
        let across = up * (0.5 * size[1] as f32 - pixel[1]);
        (self.middle() + scale * (along + across))
            .extend(0.0)
            .into()
    }

    /// What is in the middle of the picture [m].
    pub(crate) fn middle(&self) -> Vec2 {
        flat(self.centre) + flat(self.shake)
    }

    /// What is to the right and what is up.
    pub(crate) fn axes(&self) -> [Vec2; 2] {
        let right = Vec2::from_angle(self.tilt);
        [right, right.perp()]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_and_places_agree() {
        let size = [640, 480];
        let mut camera = Camera::fit([-1.0, 0.0, 0.0], [3.0, 1.0, 0.0], size);
        assert_eq!(camera.height, 3.0);
        assert_eq!(camera.to_pixel([-1.0, 0.5, 0.0], size), [0.0, 240.0]);
        camera.tilt = 0.3;
        camera.shake = [0.1, -0.2, 0.0];
        let place = [0.7, 0.9, 0.0];
        let back = camera.to_world(camera.to_pixel(place, size), size);
        assert!(
            (0..3).all(|k| (back[k] - place[k]).abs() < 1e-5),
            "{back:?}"
        );
    }
}
