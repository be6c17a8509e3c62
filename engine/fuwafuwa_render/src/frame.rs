//! The description of a picture as plain data: camera, colours, look and extras.

use crate::palette::{Colour, Palette};
use crate::space;
use fuwafuwa::{Dim, Dim2, Dim3, PieceId, Shape, SoftBody, VoxelGrid, World};
use glam::{Vec2, Vec3};
use std::borrow::Cow;

/// Everything besides the world that determines a picture. For a 3D picture, `C` is [`space::Camera`].
#[derive(Clone, Debug)]
pub struct Frame<'a, C: DimCamera = Camera> {
    /// Camera.
    pub camera: C,
    /// Colours.
    pub palette: &'a Palette,
    /// Colours that the scene gives to its materials.
    pub tints: Tints<'a, C::Dim>,
    /// View of the bodies: their skin or their elements.
    pub look: Look<'a>,
    /// Target regions of the game.
    pub baskets: Vec<Basket<C::Dim>>,
    /// Particles such as crumbs, dust and sparks.
    pub particles: &'a [Particle],
    /// Stickers: coloured patches on the skins of 3D bodies, for example eyes and a mouth. In 2D, the caller
    /// paints them after [`crate::Renderer::paint_bodies`].
    pub stickers: &'a [Sticker],
    /// Second world whose bodies and hands are drawn transparently, such as a replay to race against (3D
    /// only).
    pub ghost: Option<&'a World<Dim3>>,
    /// Objects that are not in the world but look like hands, such as the handle of a tool in a hand (3D
    /// only).
    pub props: &'a [Prop],
    /// Clock for slow decorative animation, such as marching dashes [s].
    pub seconds: f64,
}

/// Period of the animation clock [s]. All clock-driven animations repeat after this period, so that the time
/// stays accurate in the single precision of shaders.
const CYCLE: f64 = 16.0;

impl<'a, C: DimCamera> Frame<'a, C> {
    /// Returns the clock modulo its period [s], for the shaders.
    pub(crate) fn phase(&self) -> f32 {
        self.seconds.rem_euclid(CYCLE) as f32
    }

    /// Returns the voxels of a body by the material numbers that decide its colours; `place` is its index in
    /// the world.
    pub(crate) fn numbers<'b>(
        &self,
        place: usize,
        body: &'b SoftBody<C::Dim>,
    ) -> &'b VoxelGrid<C::Dim>
    where
        'a: 'b,
    {
        let grid = self.tints.grids.get(place).and_then(Option::as_ref);
        let own = body.grid();
        grid.filter(|grid| grid.size() == own.size()).unwrap_or(own)
    }

    /// Returns the colour of a material number.
    pub(crate) fn colour(&self, number: u8) -> Colour {
        self.palette.tinted_material(number, self.tints.colours)
    }

    /// Returns the colours of all material numbers, number 1 first.
    pub(crate) fn colours(&self) -> Cow<'a, [Colour]> {
        let own = self.tints.colours;
        let all = &self.palette.materials;
        match own.iter().any(Option::is_some) {
            false => Cow::Borrowed(all),
            true => {
                let count = own.len().max(all.len()).min(u8::MAX.into()) as u8;
                Cow::Owned((1..=count).map(|number| self.colour(number)).collect())
            }
        }
    }

    /// Creates a frame that shows the skin of a world and nothing else.
    pub fn new(camera: C, palette: &'a Palette) -> Self {
        Self {
            camera,
            palette,
            tints: Tints::default(),
            look: Look::Skin,
            baskets: Vec::new(),
            particles: &[],
            stickers: &[],
            ghost: None,
            props: &[],
            seconds: 0.0,
        }
    }
}

/// Colours that a scene gives to its materials, in place of those of the palette. Empty by default.
#[derive(Copy, Clone, Debug)]
pub struct Tints<'a, D: Dim> {
    /// Colour of each material, number 1 first: red, green and blue, 0 to 255 (sRGB). `None` takes the colour
    /// of the palette.
    pub colours: &'a [Option<[u8; 3]>],
    /// Grids whose material numbers select the colours of the voxels, in the order of
    /// [`World::soft_bodies`]; remove the entry of a removed body. `None`, or a grid of another size than the
    /// body's, takes the numbers of the body.
    pub grids: &'a [Option<VoxelGrid<D>>],
}

impl<D: Dim> Default for Tints<'_, D> {
    fn default() -> Self {
        Self {
            colours: &[],
            grids: &[],
        }
    }
}

/// Camera of a dimension: [`Camera`] or [`space::Camera`].
pub trait DimCamera {
    /// Dimension of the worlds that the camera shows.
    type Dim: Dim;
}

impl DimCamera for Camera {
    type Dim = Dim2;
}

impl DimCamera for space::Camera {
    type Dim = Dim3;
}

/// A bounded shape with a colour.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Prop {
    /// Shape and position.
    pub shape: Shape<Dim3>,
    /// Colour.
    pub colour: Colour,
}

/// 2D camera. The picture fills a target of any size.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Camera {
    /// Point in the middle of the picture [m].
    pub centre: Vec2,
    /// Height of the visible region [m].
    pub height: f32,
    /// Counterclockwise roll of the camera [rad].
    pub tilt: f32,
    /// Shake offset of the centre [m].
    pub shake: Vec2,
}

/// View of the bodies.
#[derive(Copy, Clone, Debug, PartialEq)]
pub enum Look<'a> {
    /// Smooth skin.
    Skin,
    /// Elements.
    Elements {
        /// Quantity shown by the colour.
        colour: ElementColour,
        /// Time since each element was remodelled [s], by body and element id, as [`crate::Ages`] computes
        /// it. Recently remodelled elements flash. Elements without an entry do not flash.
        ages: &'a [Vec<f32>],
        /// Whether nodes are drawn as dots (2D only).
        nodes: bool,
    },
}

/// Quantity shown by the colour of an element.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum ElementColour {
    /// Level of the element.
    Level,
    /// Strain of the element.
    Strain,
}

/// Target region of the game.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Basket<D: Dim> {
    /// Shape of the region: a box, a capsule or a ball.
    pub region: Shape<D>,
    /// Fill level, 0 to 1. A fuller basket glows more.
    pub fill: f32,
    /// Colour; `None` is that of the palette.
    pub colour: Option<Colour>,
}

/// Round soft dot.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Particle {
    /// Centre [m]; in 2D the third coordinate is ignored.
    pub at: Vec3,
    /// Radius [m].
    pub radius: f32,
    /// Red, green, blue (sRGB), opacity; 0 to 1.
    pub colour: [f32; 4],
}

/// Coloured patch of a [`Sticker`], for example one eye.
#[derive(Clone, Debug, PartialEq)]
pub struct Mark {
    /// Corners (right, up), counterclockwise, in mark units: lengths of the sticker's axes. The patch
    /// consists of the triangles between each edge and the mean of the corners.
    pub outline: Vec<[f32; 2]>,
    /// Red, green, blue (sRGB), opacity; 0 to 1.
    pub colour: [f32; 4],
    /// Height of the patch's centre above its edge [mark units].
    pub bulge: f32,
    /// Height of the patch's edge above the skin [mark units].
    pub lift: f32,
}

/// Coloured patches (marks) on the skin of a piece, for example eyes and a mouth. Each mark is painted over
/// the previous ones.
#[derive(Clone, Debug, PartialEq)]
pub struct Sticker {
    /// Index of the body in the world.
    pub body: usize,
    /// Piece of the body.
    pub piece: PieceId,
    /// Point inside the piece [m]. The sticker lies on the skin in front of this point, in the direction of
    /// the third axis.
    pub origin: Vec3,
    /// Axes to the right, up and out of the skin. The length of each axis [m] is one mark unit in its
    /// direction.
    pub axes: [Vec3; 3],
    /// Coloured patches of the sticker, bottom first.
    pub marks: Vec<Mark>,
}

impl Camera {
    /// Returns the camera that shows the region between two corners [m] in a target of `size` pixels.
    pub fn fit(low: Vec2, high: Vec2, size: [u32; 2]) -> Self {
        let aspect = size[0].max(1) as f32 / size[1].max(1) as f32;
        let span = high - low;
        Self {
            centre: low.midpoint(high),
            height: span.y.max(span.x / aspect),
            tilt: 0.0,
            shake: Vec2::ZERO,
        }
    }

    /// Returns the pixel of a point [m] in a target of `size` pixels, measured from its upper left corner.
    pub fn to_pixel(&self, at: Vec2, size: [u32; 2]) -> [f32; 2] {
        let [right, up] = self.axes();
        let by = at - self.middle();
        let scale = size[1] as f32 / self.height;
        [
            0.5 * size[0] as f32 + by.dot(right) * scale,
            0.5 * size[1] as f32 - by.dot(up) * scale,
        ]
    }

    /// Returns the point [m] at a pixel of a target of `size` pixels.
    pub fn to_world(&self, pixel: [f32; 2], size: [u32; 2]) -> Vec2 {
        let [right, up] = self.axes();
        let scale = self.height / size[1].max(1) as f32;
        let along = right * (pixel[0] - 0.5 * size[0] as f32);
        let across = up * (0.5 * size[1] as f32 - pixel[1]);
        self.middle() + scale * (along + across)
    }

    /// Returns the point in the middle of the picture, shake included [m].
    pub(crate) fn middle(&self) -> Vec2 {
        self.centre + self.shake
    }

    /// Returns the directions to the right and up.
    pub(crate) fn axes(&self) -> [Vec2; 2] {
        let right = Vec2::from_angle(self.tilt);
        [right, right.perp()]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn to_world_inverts_to_pixel() {
        let size = [640, 480];
        let mut camera = Camera::fit(Vec2::new(-1.0, 0.0), Vec2::new(3.0, 1.0), size);
        assert_eq!(camera.height, 3.0);
        assert_eq!(camera.to_pixel(Vec2::new(-1.0, 0.5), size), [0.0, 240.0]);
        camera.tilt = 0.3;
        camera.shake = Vec2::new(0.1, -0.2);
        let place = Vec2::new(0.7, 0.9);
        let back = camera.to_world(camera.to_pixel(place, size), size);
        assert!((back - place).abs().max_element() < 1e-5, "{back:?}");
    }
}
