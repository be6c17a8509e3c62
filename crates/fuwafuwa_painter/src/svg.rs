//! The painter's shapes as an SVG document.

use crate::raster::png_of;
use crate::theme::{colour, opacity};
use crate::{PaintError, Painter, Role, Shape, Spot};
use std::fmt::Write;

impl Painter {
    /// The shapes as an SVG document.
    ///
    /// # Errors
    /// When an image in it cannot be packed.
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
            "<polygon points=\"{}\" {}/>",
            spots_of(outline),
            fill(*role)
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
            "<circle cx=\"{:.2}\" cy=\"{:.2}\" r=\"{radius:.2}\" {}/>",
            at[0],
            at[1],
            fill(*role)
        ),
        Shape::Image { at, pixels } => writeln!(
            text,
            "<image x=\"{:.2}\" y=\"{:.2}\" width=\"{}\" height=\"{}\" href=\"data:image/png;base64,{}\"/>",
            at[0],
            at[1],
            pixels.width(),
            pixels.height(),
            base64(&png_of(pixels)?)
        ),
    };
    written.expect("a string has room");
    Ok(())
}

fn spots_of(spots: &[Spot]) -> String {
    let pairs: Vec<String> = spots
        .iter()
        .map(|[x, y]| format!("{x:.2},{y:.2}"))
        .collect();
    pairs.join(" ")
}

fn fill(role: Role) -> String {
    let fill = format!("fill=\"{}\"", name(role));
    match opacity(role) {
        1.0 => fill,
        share => format!("{fill} fill-opacity=\"{share}\""),
    }
}

fn name(role: Role) -> String {
    let [red, green, blue] = colour(role);
    format!("#{red:02x}{green:02x}{blue:02x}")
}

/// Six bits a letter, three bytes in four letters [RFC 4648].
fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for chunk in bytes.chunks(3) {
        let byte = |k: usize| u32::from(chunk.get(k).copied().unwrap_or(0));
        let bits = byte(0) << 16 | byte(1) << 8 | byte(2);
        for k in 0..4 {
            let letter = LETTERS[(bits >> (18 - 6 * k) & 63) as usize];
            text.push(if k <= chunk.len() {
                char::from(letter)
            } else {
                '='
            });
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_is_that_of_the_standard() {
        let pairs = [
            ("", ""),
            ("f", "Zg=="),
            ("fo", "Zm8="),
            ("foobar", "Zm9vYmFy"),
        ];
        for (plain, packed) in pairs {
            assert_eq!(base64(plain.as_bytes()), packed);
        }
    }
}
