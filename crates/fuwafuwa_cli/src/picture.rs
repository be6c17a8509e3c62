//! A list of simple shapes that becomes an SVG or a PNG, the same in both.
//!
//! Letters are strokes like any other line, so that neither file needs a font.

use anyhow::{Context, Result};
use std::fmt::Write;
use tiny_skia::{
    Color, FillRule, LineCap, LineJoin, Paint, Path, PathBuilder, Pixmap, Stroke, Transform,
};

/// Red, green, blue.
pub type Colour = [u8; 3];
/// A place on the paper [px], y downwards.
pub type Spot = [f32; 2];

/// Paper on which nothing is drawn.
pub const WHITE: Colour = [255; 3];

/// One thing on the paper.
#[derive(Clone, Debug)]
enum Shape {
    /// A filled outline.
    Polygon { outline: Vec<Spot>, fill: Colour },
    /// A line through spots, joined at the end when it is closed.
    Line {
        spots: Vec<Spot>,
        closed: bool,
        width: f32,
        colour: Colour,
    },
    /// A filled disc.
    Dot { at: Spot, radius: f32, fill: Colour },
}

/// Shapes on white paper, the last one on top.
#[derive(Clone, Debug)]
pub struct Picture {
    width: u32,
    height: u32,
    shapes: Vec<Shape>,
}

impl Picture {
    /// Empty paper of a size [px].
    pub fn new(width: u32, height: u32) -> Self {
        Self {
            width,
            height,
            shapes: Vec::new(),
        }
    }

    /// Adds a filled outline with an edge.
    pub fn polygon(&mut self, outline: Vec<Spot>, fill: Colour, edge: Colour, width: f32) {
        self.shapes.push(Shape::Polygon {
            outline: outline.clone(),
            fill,
        });
        self.shapes.push(Shape::Line {
            spots: outline,
            closed: true,
            width,
            colour: edge,
        });
    }

    /// Adds a filled rectangle with an edge.
    pub fn rectangle(&mut self, low: Spot, size: Spot, fill: Colour, edge: Colour, width: f32) {
        let [x, y] = low;
        let (right, bottom) = (x + size[0], y + size[1]);
        let outline = vec![[x, y], [right, y], [right, bottom], [x, bottom]];
        self.polygon(outline, fill, edge, width);
    }

    /// Adds an open line.
    pub fn line(&mut self, spots: Vec<Spot>, width: f32, colour: Colour) {
        self.shapes.push(Shape::Line {
            spots,
            closed: false,
            width,
            colour,
        });
    }

    /// Adds a disc with a ring around it.
    pub fn dot(&mut self, at: Spot, radius: f32, fill: Colour, ring: Option<Colour>) {
        if let Some(ring) = ring {
            let radius = radius * 1.45;
            self.shapes.push(Shape::Dot {
                at,
                radius,
                fill: ring,
            });
        }
        self.shapes.push(Shape::Dot { at, radius, fill });
    }

    /// Adds a line of small letters and digits; `at` is its top left, `height` that of a digit.
    pub fn text(&mut self, at: Spot, height: f32, colour: Colour, text: &str) {
        let unit = height / 6.0;
        let mut x = at[0];
        for letter in text.chars() {
            let (shift, advance) = match letter {
                'i' | 'l' => (1.0, 3.7),
                ' ' => (0.0, 3.6),
                _ => (0.0, 5.8),
            };
            for stroke in strokes(letter).split('|').filter(|s| !s.is_empty()) {
                let spot = |pair: &str| {
                    let digit = |k: usize| f32::from(pair.as_bytes()[k] - b'0');
                    [x + (digit(0) - shift) * unit, at[1] + digit(1) * unit]
                };
                self.shapes.push(Shape::Line {
                    spots: stroke.split(' ').map(spot).collect(),
                    closed: false,
                    width: 0.85 * unit,
                    colour,
                });
            }
            x += advance * unit;
        }
    }

    /// The picture as an SVG document.
    pub fn svg(&self) -> String {
        let (width, height) = (self.width, self.height);
        let mut text = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" height=\"{height}\" stroke-linecap=\"round\" stroke-linejoin=\"round\">\n<rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n"
        );
        for shape in &self.shapes {
            // Writing into a String cannot fail.
            let _ = match shape {
                Shape::Polygon { outline, fill } => writeln!(
                    text,
                    "<polygon points=\"{}\" fill=\"{}\"/>",
                    svg_spots(outline),
                    svg_colour(*fill)
                ),
                Shape::Line {
                    spots,
                    closed,
                    width,
                    colour,
                } => writeln!(
                    text,
                    "<{} points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{width:.2}\"/>",
                    if *closed { "polygon" } else { "polyline" },
                    svg_spots(spots),
                    svg_colour(*colour)
                ),
                Shape::Dot { at, radius, fill } => writeln!(
                    text,
                    "<circle cx=\"{:.2}\" cy=\"{:.2}\" r=\"{radius:.2}\" fill=\"{}\"/>",
                    at[0],
                    at[1],
                    svg_colour(*fill)
                ),
            };
        }
        text + "</svg>\n"
    }

    /// The picture as the bytes of a PNG file.
    pub fn png(&self) -> Result<Vec<u8>> {
        let mut pixels = Pixmap::new(self.width, self.height).context("the picture has no area")?;
        pixels.fill(Color::WHITE);
        for shape in &self.shapes {
            match shape {
                Shape::Polygon { outline, fill } => {
                    fill_path(&mut pixels, path_of(outline, true)?, *fill);
                }
                Shape::Line {
                    spots,
                    closed,
                    width,
                    colour,
                } => {
                    let stroke = Stroke {
                        width: *width,
                        line_cap: LineCap::Round,
                        line_join: LineJoin::Round,
                        ..Stroke::default()
                    };
                    let path = path_of(spots, *closed)?;
                    let place = Transform::identity();
                    pixels.stroke_path(&path, &paint(*colour), &stroke, place, None);
                }
                Shape::Dot { at, radius, fill } => {
                    let circle = PathBuilder::from_circle(at[0], at[1], *radius);
                    fill_path(&mut pixels, circle.context("a dot has no size")?, *fill);
                }
            }
        }
        Ok(pixels.encode_png()?)
    }
}

/// The strokes of a letter on a grid of 4 × 8: pairs of digits x, y; `|` lifts the pen.
fn strokes(letter: char) -> &'static str {
    match letter {
        '0' => "10 30 41 45 36 16 05 01 10",
        '1' => "11 20 26|16 36",
        '2' => "01 10 30 41 42 06 46",
        '3' => "01 10 30 41 42 33 13|33 44 45 36 16 05",
        '4' => "36 30 04 44",
        '5' => "40 00 03 33 44 45 36 06",
        '6' => "30 10 01 05 16 36 45 44 33 03",
        '7' => "00 40 16",
        '8' => "13 02 01 10 30 41 42 33 13 04 05 16 36 45 44 33",
        '9' => "16 36 45 41 30 10 01 02 13 43",
        'a' => "12 32 43 46|44 14 05 16 36 45",
        'b' => "00 06|03 12 32 43 45 36 16 05",
        'c' => "43 32 12 03 05 16 36 45",
        'd' => "40 46|43 32 12 03 05 16 36 45",
        'e' => "04 44 43 32 12 03 05 16 36 45",
        'g' => "42 47 38 18|43 32 12 03 05 16 36 45",
        'h' => "00 06|03 12 32 43 46",
        'i' => "22 26|20 20",
        'l' => "20 26",
        'm' => "02 06|03 12 23 26|23 32 43 46",
        'n' => "02 06|03 12 32 43 46",
        'o' => "12 32 43 45 36 16 05 03 12",
        'p' => "02 08|03 12 32 43 45 36 16 05",
        'r' => "02 06|04 22 32",
        's' => "43 32 12 03 14 34 45 36 16 05",
        't' => "10 15 26 36|02 32",
        'u' => "02 05 16 36 45|42 46",
        'v' => "02 26 42",
        'w' => "02 16 24 36 42",
        'x' => "02 46|42 06",
        'y' => "02 05 16 36 45|42 47 38 18",
        _ => "",
    }
}

fn svg_spots(spots: &[Spot]) -> String {
    let pairs: Vec<String> = spots
        .iter()
        .map(|[x, y]| format!("{x:.2},{y:.2}"))
        .collect();
    pairs.join(" ")
}

fn svg_colour([red, green, blue]: Colour) -> String {
    format!("#{red:02x}{green:02x}{blue:02x}")
}

fn path_of(spots: &[Spot], closed: bool) -> Result<Path> {
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
    builder.finish().context("a shape has no area")
}

fn fill_path(pixels: &mut Pixmap, path: Path, fill: Colour) {
    let place = Transform::identity();
    pixels.fill_path(&path, &paint(fill), FillRule::Winding, place, None);
}

fn paint([red, green, blue]: Colour) -> Paint<'static> {
    let mut paint = Paint::default();
    paint.set_color_rgba8(red, green, blue, 255);
    paint.anti_alias = true;
    paint
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_files_hold_the_same_shapes() {
        let mut picture = Picture::new(40, 30);
        picture.rectangle([5.0, 5.0], [20.0, 20.0], [200, 0, 0], [0; 3], 1.0);
        picture.dot([30.0, 15.0], 3.0, [0, 0, 200], Some(WHITE));
        picture.text([2.0, 2.0], 6.0, [0; 3], "level 0");
        assert!(picture.svg().contains("fill=\"#c80000\""));
        let pixels = Pixmap::decode_png(&picture.png().unwrap()).unwrap();
        let inside = pixels.pixel(15, 18).unwrap();
        assert_eq!((inside.red(), inside.green(), inside.blue()), (200, 0, 0));
    }
}
