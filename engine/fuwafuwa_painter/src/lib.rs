//! Pictures and films of worlds, painted without a GPU. Shapes have a role, and the role determines the
//! colour: see [`role`].
//!
//! A [`Painter`] is a list of shapes. It becomes a drawing ([`Painter::svg`]), an image ([`Painter::pixels`])
//! or a frame of a [`film`], with the same look. The module [`solid`] renders 3D bodies to an image, which is
//! a shape like any other.
//!
//! The module [`worlds`] paints whole worlds and shows their elements and voxels exactly. For the look of the
//! game, use the crate `fuwafuwa_render`.
#![forbid(unsafe_code)]
#![warn(missing_docs)]
#![allow(rustdoc::broken_intra_doc_links)] // brackets hold units, such as [m]

mod canvas;
mod error;
pub mod film;
mod letters;
mod paper;
mod raster;
pub mod role;
mod shadow;
pub mod solid;
mod svg;
pub mod worlds;

pub use error::PaintError;
use fuwafuwa::DimVector;
pub use paper::{PaperPoint, PaperTransform};
pub use raster::png_of;
pub use role::Role;
use std::rc::Rc;
pub use tiny_skia::Pixmap;

/// A shape on the paper.
#[derive(Clone, Debug)]
enum Shape {
    /// A filled polygon.
    Area {
        outline: Vec<PaperPoint>,
        role: Role,
    },
    /// Polyline through points. If `closed`, another segment joins the last point to the first.
    Line {
        spots: Vec<PaperPoint>,
        closed: bool,
        width: f32,
        role: Role,
    },
    /// A filled disc.
    Dot {
        at: PaperPoint,
        radius: f32,
        role: Role,
    },
    /// Image with its top left corner at `at`.
    Image { at: PaperPoint, pixels: Rc<Pixmap> },
}

/// List of shapes on paper; later shapes cover earlier ones.
#[derive(Clone, Debug)]
pub struct Painter {
    width: u32,
    height: u32,
    shapes: Vec<Shape>,
}

impl Painter {
    /// Returns width and height [px].
    pub fn size(&self) -> [u32; 2] {
        [self.width, self.height]
    }

    /// Extends the paper at the bottom by `by` [px].
    pub fn extend(&mut self, by: u32) {
        self.height += by;
    }

    /// Creates empty paper of `width` × `height` pixels.
    pub fn new(width: u32, height: u32) -> Self {
        Self {
            width,
            height,
            shapes: Vec::new(),
        }
    }

    /// Creates empty paper for the view between a low and a high corner [m], and the map from the world to
    /// the paper. The paper is `width` pixels wide. Its height follows from the view, limited to 50 to 2000
    /// px. Third coordinates are ignored.
    pub fn for_view([low, high]: [impl DimVector; 2], width: u32) -> (Self, PaperTransform) {
        let unit = width as f32 / (high[0] - low[0]);
        let height = (unit * (high[1] - low[1])).round().clamp(50.0, 2000.0);
        let origin = [-low[0] * unit, height + low[1] * unit];
        (
            Self::new(width, height as u32),
            PaperTransform { origin, unit },
        )
    }

    /// Adds a filled polygon without an outline.
    pub fn area(&mut self, outline: Vec<PaperPoint>, role: Role) {
        self.shapes.push(Shape::Area { outline, role });
    }

    /// Adds a filled polygon with an outline of a width [px].
    pub fn polygon(&mut self, outline: Vec<PaperPoint>, role: Role, edge: Role, width: f32) {
        self.area(outline.clone(), role);
        self.ring(outline, width, edge);
    }

    /// Adds a filled rectangle with an outline of a width [px].
    pub fn rectangle(
        &mut self,
        low: PaperPoint,
        size: PaperPoint,
        role: Role,
        edge: Role,
        width: f32,
    ) {
        self.polygon(rectangle(low, size), role, edge, width);
    }

    /// Adds an open line of a width [px].
    pub fn line(&mut self, spots: Vec<PaperPoint>, width: f32, role: Role) {
        self.shapes.push(Shape::Line {
            spots,
            closed: false,
            width,
            role,
        });
    }

    /// Adds a closed line of a width [px].
    pub fn ring(&mut self, spots: Vec<PaperPoint>, width: f32, role: Role) {
        self.shapes.push(Shape::Line {
            spots,
            closed: true,
            width,
            role,
        });
    }

    /// Adds a centred line of text below the picture, for which the paper is extended.
    pub fn caption(&mut self, text: &str) {
        const HEIGHT: f32 = 13.0;
        let [width, height] = self.size().map(|k| k as f32);
        self.extend((2.6 * HEIGHT) as u32);
        let x = 0.5 * (width - letters::width(HEIGHT, text));
        self.text([x, height + 0.7 * HEIGHT], HEIGHT, Role::Ink, text);
    }

    /// Adds a disc of a radius [px].
    pub fn dot(&mut self, at: PaperPoint, radius: f32, role: Role) {
        self.shapes.push(Shape::Dot { at, radius, role });
    }

    /// Adds a disc with a pale ring for contrast.
    pub fn bright_dot(&mut self, at: PaperPoint, radius: f32, role: Role) {
        self.dot(at, radius * 1.45, Role::Paper);
        self.dot(at, radius, role);
    }

    /// Adds a cross of half extent `reach` [px], with a pale rim for contrast.
    pub fn cross(&mut self, at: PaperPoint, reach: f32, role: Role) {
        for (width, role) in [(1.1 * reach, Role::Paper), (0.55 * reach, role)] {
            for side in [-reach, reach] {
                let ends = [[at[0] - reach, at[1] - side], [at[0] + reach, at[1] + side]];
                self.line(ends.to_vec(), width, role);
            }
        }
    }

    /// Adds a line of text. `at` is the top left corner of the text, `height` the height of a capital letter
    /// [px].
    pub fn text(&mut self, at: PaperPoint, height: f32, role: Role, text: &str) {
        for spots in letters::lines(at, height, text) {
            self.line(spots, 0.15 * height, role);
        }
    }

    /// Adds an image; `at` is its top left corner.
    pub fn image(&mut self, at: PaperPoint, pixels: Pixmap) {
        let pixels = Rc::new(pixels);
        self.shapes.push(Shape::Image { at, pixels });
    }

    /// Adds a legend: a centred row of samples, each with its name. `y` is the upper edge of the row [px].
    pub fn legend(&mut self, y: f32, entries: &[(Sample, &str)]) {
        let wide: f32 = entries.iter().map(|(_, name)| entry_width(name)).sum();
        let x = 0.5 * (self.width as f32 - wide + BETWEEN_ENTRIES);
        self.entries([x, y], entries);
    }

    /// Adds a row of samples, each with its name, that begins at `at`.
    pub fn entries(&mut self, at: PaperPoint, entries: &[(Sample, &str)]) {
        let mut x = at[0];
        for &(sample, name) in entries {
            let middle = [x + 0.5 * SIZE, at[1] + 0.5 * SIZE];
            match sample {
                Sample::Area(role, edge) => {
                    self.rectangle([x, at[1]], [SIZE; 2], role, edge, 1.6);
                }
                Sample::Dot(role) => self.bright_dot(middle, 4.6, role),
                Sample::Cross(role) => self.cross(middle, 5.0, role),
                Sample::Line(role) => {
                    let ends = [[x, middle[1]], [x + SIZE, middle[1]]];
                    self.line(ends.to_vec(), 4.0, role);
                }
            }
            self.text([x + SIZE + 10.0, at[1] + 3.5], 15.0, Role::Ink, name);
            x += entry_width(name);
        }
    }
}

/// Size of a sample in a legend [px].
const SIZE: f32 = 22.0;
const BETWEEN_ENTRIES: f32 = 26.0;

fn entry_width(name: &str) -> f32 {
    SIZE + 10.0 + letters::width(15.0, name) + BETWEEN_ENTRIES
}

/// Sample next to a name in a legend.
#[derive(Copy, Clone, Debug)]
pub enum Sample {
    /// Filled square, with the role of its fill and the role of its outline.
    Area(Role, Role),
    /// A dot.
    Dot(Role),
    /// A cross.
    Cross(Role),
    /// A line.
    Line(Role),
}

/// Returns the corners of a rectangle with the top left corner `[x, y]`.
pub fn rectangle([x, y]: PaperPoint, size: PaperPoint) -> Vec<PaperPoint> {
    let (right, bottom) = (x + size[0], y + size[1]);
    vec![[x, y], [right, y], [right, bottom], [x, bottom]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use role::colour;

    #[test]
    fn caption_extends_paper() {
        let mut painter = Painter::new(120, 40);
        painter.caption("2.5 s: it is in!");
        let pixels = painter.pixels().unwrap();
        let is_ink = |y: u32| (0..120).any(|x| pixels.pixel(x, y).is_some_and(|at| at.red() < 100));
        assert!(pixels.height() > 60 && !(0..42).any(is_ink) && (42..pixels.height()).any(is_ink));
    }

    #[test]
    fn svg_and_png_show_same_colours() {
        let mut painter = Painter::new(40, 30);
        painter.rectangle([5.0, 5.0], [20.0, 20.0], Role::Hand, Role::Ink, 1.0);
        painter.bright_dot([30.0, 15.0], 3.0, Role::Added);
        painter.text([2.0, 2.0], 6.0, Role::Ink, "level 0");
        let [red, green, blue] = colour(Role::Hand);
        let named = format!("fill=\"#{red:02x}{green:02x}{blue:02x}\"");
        assert!(painter.svg().unwrap().contains(&named));
        let file = std::io::Cursor::new(painter.png().unwrap());
        let mut picture = png::Decoder::new(file).read_info().unwrap();
        let mut pixels = vec![0; picture.output_buffer_size().unwrap()];
        picture.next_frame(&mut pixels).unwrap();
        let inside = 4 * (18 * 40 + 15);
        assert_eq!(pixels[inside..inside + 4], [red, green, blue, 255]);
    }
}
