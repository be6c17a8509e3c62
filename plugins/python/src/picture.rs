//! Pictures and films of worlds, painted without a GPU.

use crate::convert::{Any, coordinates, vector_pair};
use crate::error::{OrInvalid, invalid, invalid_parameter};
use fuwafuwa::{Dim, Dim2, Dim3, DimVector, RigidBodyRef, Vec2, Vec3, World};
use fuwafuwa_painter::film::Gif;
use fuwafuwa_painter::solid::{Camera, Scene3d};
use fuwafuwa_painter::{PaintError, Painter, Pixmap, worlds};
use numpy::PyReadonlyArray3;
use numpy::ndarray::{Array3, ArrayView3};
use pyo3::prelude::*;
use pyo3::types::PyBytes;

/// Visible region of a world: low and high corner [m].
pub type View<D> = [<D as Dim>::Vector; 2];

/// Dimension whose worlds can be painted.
pub trait Paint: Dim {
    /// Paints the visible region of a world, `width` pixels wide.
    fn paint(
        world: &World<Self>,
        view: View<Self>,
        width: u32,
        shows_elements: bool,
    ) -> Result<Pixmap, PaintError>;
}

impl Paint for Dim2 {
    fn paint(
        world: &World<Self>,
        [low, high]: View<Self>,
        width: u32,
        shows_elements: bool,
    ) -> Result<Pixmap, PaintError> {
        // A flat view would make the paper higher or lower than the painter allows.
        let size = high - low;
        let missing = (size.max_element() * 0.25 - size).max(Vec2::ZERO) * 0.5;
        let (mut painter, frame) = Painter::for_view([low - missing, high + missing], width);
        let draw = match shows_elements {
            true => worlds::plane_elements,
            false => worlds::plane_skin,
        };
        worlds::plane(&mut painter, frame, world, draw);
        painter.pixels()
    }
}

impl Paint for Dim3 {
    /// Shows the world from the front, somewhat from the right and from above. The picture is a square.
    fn paint(
        world: &World<Self>,
        [low, high]: View<Self>,
        width: u32,
        shows_elements: bool,
    ) -> Result<Pixmap, PaintError> {
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
        scene.pixels(width, width)
    }
}

/// Options of a picture.
pub struct PictureOptions<D: Dim> {
    /// Visible region; `None` = that of all bodies.
    pub view: Option<View<D>>,
    /// Width [pixels], 16 to 4096.
    pub width: u32,
    /// Whether elements are shown instead of the surface.
    pub shows_elements: bool,
}

impl<D: Paint> PictureOptions<D> {
    /// Returns the options of keyword arguments.
    pub fn new(view: Option<&Any<'_>>, width: u32, shows_elements: bool) -> PyResult<Self> {
        if !(16..=4096).contains(&width) {
            let expected = "16 to 4096 pixels";
            return Err(invalid_parameter("width", expected, width.to_string()));
        }
        Ok(Self {
            view: view.map(self::view::<D>).transpose()?,
            width,
            shows_elements,
        })
    }

    /// Paints a world.
    pub fn paint(&self, world: &World<D>) -> Result<Pixmap, PaintError> {
        let view = self.view.unwrap_or_else(|| view_of(world));
        D::paint(world, view, self.width, self.shows_elements)
    }
}

fn view<D: Dim>(value: &Any<'_>) -> PyResult<View<D>> {
    let expected = "a low and a high corner";
    let [low, high] = vector_pair::<D>("view", expected, value)?;
    if (0..D::N).any(|axis| low[axis] >= high[axis]) {
        let given = format!("{:?} and {:?}", coordinates(low), coordinates(high));
        return Err(invalid_parameter("view", expected, given));
    }
    Ok([low, high])
}

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

/// Returns the colours of an image without transparency: red, green and blue, by row and column.
pub fn rgb(image: &Pixmap) -> Array3<u8> {
    let shape = (image.height() as usize, image.width() as usize, 3);
    let pixels = image.pixels().iter();
    let values = pixels.flat_map(|pixel| [pixel.red(), pixel.green(), pixel.blue()]);
    Array3::from_shape_vec(shape, values.collect()).expect("each pixel has three values")
}

/// Returns the image with the given colours.
fn image(rgb: ArrayView3<'_, u8>) -> PyResult<Pixmap> {
    let &[height, width, 3] = rgb.shape() else {
        let text = format!(
            "a frame must have the shape (height, width, 3), given {:?}",
            rgb.shape()
        );
        return Err(invalid(text));
    };
    let sides = [width, height].map(|side| u32::try_from(side).unwrap_or(0));
    let image = Pixmap::new(sides[0], sides[1]);
    let mut image =
        image.ok_or_else(|| invalid(format!("a frame has {width} × {height} pixels")))?;
    let pixels = image.data_mut().chunks_exact_mut(4);
    for (pixel, colour) in pixels.zip(rgb.rows()) {
        pixel.copy_from_slice(&[colour[0], colour[1], colour[2], 255]);
    }
    Ok(image)
}

/// Encodes frames as a GIF that repeats forever: an iterable of pairs of a uint8 array (height, width, 3) and its
/// duration [1/100 s].
#[pyfunction(name = "_gif")]
pub fn gif<'py>(py: Python<'py>, frames: &Any<'py>) -> PyResult<Bound<'py, PyBytes>> {
    let mut film = Gif::default();
    for frame in frames.try_iter()? {
        let (rgb, hundredths): (PyReadonlyArray3<'_, u8>, u16) = frame?.extract()?;
        let image = image(rgb.as_array())?;
        py.detach(|| film.add(&image, hundredths)).or_invalid()?;
    }
    Ok(PyBytes::new(py, &film.finish().or_invalid()?))
}
