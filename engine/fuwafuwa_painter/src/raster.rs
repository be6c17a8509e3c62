//! Rasterisation of the painter's shapes.

use crate::role::colour;
use crate::{PaintError, Painter, PaperPoint, Role, Shape};
use tiny_skia::{
    Color, FillRule, LineCap, LineJoin, Paint, Path, PathBuilder, Pixmap, PixmapPaint, Stroke,
    Transform,
};

impl Painter {
    /// Renders the shapes to pixels.
    ///
    /// # Errors
    /// [`PaintError::NoSize`] if the paper or a shape has no area.
    pub fn pixels(&self) -> Result<Pixmap, PaintError> {
        let mut pixels =
            Pixmap::new(self.width, self.height).ok_or(PaintError::NoSize { what: "the paper" })?;
        let [red, green, blue] = colour(Role::Paper);
        pixels.fill(Color::from_rgba8(red, green, blue, 255));
        for shape in &self.shapes {
            paint(&mut pixels, shape)?;
        }
        Ok(pixels)
    }

    /// Renders the shapes to a PNG file.
    ///
    /// # Errors
    /// Same errors as [`Painter::pixels`].
    pub fn png(&self) -> Result<Vec<u8>, PaintError> {
        png_of(&self.pixels()?)
    }
}

/// Encodes pixels as a PNG file.
///
/// # Errors
/// [`PaintError::Packing`] if the encoder fails.
pub fn png_of(pixels: &Pixmap) -> Result<Vec<u8>, PaintError> {
    let straight = pixels.pixels().iter().flat_map(|pixel| {
        let pixel = pixel.demultiply();
        [pixel.red(), pixel.green(), pixel.blue(), pixel.alpha()]
    });
    let straight: Vec<u8> = straight.collect();
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, pixels.width(), pixels.height());
    encoder.set_color(png::ColorType::Rgba);
    let packed = encoder.write_header().and_then(|mut writer| {
        writer.write_image_data(&straight)?;
        writer.finish()
    });
    packed.map_err(PaintError::packing("PNG"))?;
    Ok(bytes)
}

fn paint(pixels: &mut Pixmap, shape: &Shape) -> Result<(), PaintError> {
    let place = Transform::identity();
    match shape {
        Shape::Area { outline, role } => {
            let path = path_of(outline, true)?;
            pixels.fill_path(&path, &brush(*role), FillRule::EvenOdd, place, None);
        }
        Shape::Line { spots, .. } if spots.windows(2).all(|pair| pair[0] == pair[1]) => {
            let Shape::Line { width, role, .. } = shape else {
                return Ok(());
            };
            dot(pixels, spots[0], 0.5 * width, *role)?;
        }
        Shape::Line {
            spots,
            closed,
            width,
            role,
        } => {
            let stroke = Stroke {
                width: *width,
                line_cap: LineCap::Round,
                line_join: LineJoin::Round,
                ..Stroke::default()
            };
            let path = path_of(spots, *closed)?;
            pixels.stroke_path(&path, &brush(*role), &stroke, place, None);
        }
        Shape::Dot { at, radius, role } => dot(pixels, *at, *radius, *role)?,
        Shape::Image { at, pixels: image } => {
            let [x, y] = at.map(|k| k.round() as i32);
            pixels.draw_pixmap(
                x,
                y,
                image.as_ref().as_ref(),
                &PixmapPaint::default(),
                place,
                None,
            );
        }
    }
    Ok(())
}

fn dot(pixels: &mut Pixmap, [x, y]: PaperPoint, radius: f32, role: Role) -> Result<(), PaintError> {
    let circle =
        PathBuilder::from_circle(x, y, radius).ok_or(PaintError::NoSize { what: "a dot" })?;
    let place = Transform::identity();
    pixels.fill_path(&circle, &brush(role), FillRule::Winding, place, None);
    Ok(())
}

fn path_of(spots: &[PaperPoint], closed: bool) -> Result<Path, PaintError> {
    let mut builder = PathBuilder::new();
    for (index, [x, y]) in spots.iter().enumerate() {
        if index == 0 {
            builder.move_to(*x, *y);
        } else {
            builder.line_to(*x, *y);
        }
    }
    if closed {
        builder.close();
    }
    builder
        .finish()
        .ok_or(PaintError::NoSize { what: "a shape" })
}

fn brush(role: Role) -> Paint<'static> {
    let [red, green, blue] = colour(role);
    let mut paint = Paint::default();
    paint.set_color_rgba8(red, green, blue, 255);
    paint.anti_alias = true;
    paint
}
