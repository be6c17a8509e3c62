//! SVG output of the painter's shapes.

use crate::raster::png_of;
use crate::role::colour;
use crate::{PaintError, Painter, PaperPoint, Role, Shape};
use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use std::fmt::Write;

impl Painter {
    /// Writes the shapes as an SVG document.
    ///
    /// # Errors
    /// [`PaintError::Packing`] if an image cannot be encoded.
    pub fn svg(&self) -> Result<String, PaintError> {
        let (width, height, paper) = (self.width, self.height, name(Role::Paper));
        let mut text = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" height=\"{height}\" stroke-linecap=\"round\" stroke-linejoin=\"round\">\n<rect width=\"{width}\" height=\"{height}\" fill=\"{paper}\"/>\n"
        );
        for shape in &self.shapes {
            write_shape(&mut text, shape)?;
        }
        Ok(text + "</svg>\n")
    }
}

fn write_shape(text: &mut String, shape: &Shape) -> Result<(), PaintError> {
    let written = match shape {
        Shape::Area { outline, role } => writeln!(
            text,
            "<polygon points=\"{}\" fill=\"{}\"/>",
            spots_of(outline),
            name(*role)
        ),
        Shape::Line {
            spots,
            closed,
            width,
            role,
        } => writeln!(
            text,
            "<{} points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{width:.2}\"/>",
            if *closed { "polygon" } else { "polyline" },
            spots_of(spots),
            name(*role)
        ),
        Shape::Dot { at, radius, role } => writeln!(
            text,
            "<circle cx=\"{:.2}\" cy=\"{:.2}\" r=\"{radius:.2}\" fill=\"{}\"/>",
            at[0],
            at[1],
            name(*role)
        ),
        Shape::Image { at, pixels } => writeln!(
            text,
            "<image x=\"{:.2}\" y=\"{:.2}\" width=\"{}\" height=\"{}\" href=\"data:image/png;base64,{}\"/>",
            at[0],
            at[1],
            pixels.width(),
            pixels.height(),
            BASE64_STANDARD.encode(png_of(pixels)?)
        ),
    };
    written.expect("writing to a string cannot fail");
    Ok(())
}

fn spots_of(spots: &[PaperPoint]) -> String {
    let pairs: Vec<String> = spots
        .iter()
        .map(|[x, y]| format!("{x:.2},{y:.2}"))
        .collect();
    pairs.join(" ")
}

fn name(role: Role) -> String {
    let [red, green, blue] = colour(role);
    format!("#{red:02x}{green:02x}{blue:02x}")
}
