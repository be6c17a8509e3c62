//! Pictures and films of worlds, painted without a GPU, from shapes that have a role and no colour:
//! see [`role`].
//!
//! A [`Painter`] is a list of shapes; it becomes a drawing ([`Painter::svg`]), an image
//! ([`Painter::pixels`]) or a frame of a [`film`], the same in all of them. Bodies in space are
//! painted by [`solid`] into an image that lies on the paper like any other shape.
//!
//! Whole worlds are put on a painter by [`worlds`], which shows elements and voxels as they are. The look of the game is
//! that of the crate `fuwafuwa_render` alone.
#![forbid(unsafe_code)]
#![warn(missing_docs)]
#![allow(rustdoc::broken_intra_doc_links)] // units stand in brackets: [m]

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
pub use paper::{Frame, Spot};
pub use raster::png_of;
pub use role::Role;
use std::rc::Rc;
pub use tiny_skia::Pixmap;

/// One thing on the paper.
#[derive(Clone, Debug)]
enum Shape {
    /// A filled outline.
    Area { outline: Vec<Spot>, role: Role },
    /// A line through spots, joined at the end when it is closed.
    Line {
        spots: Vec<Spot>,
        closed: bool,
        width: f32,
        role: Role,
    },
    /// A filled disc.
    Dot { at: Spot, radius: f32, role: Role },
    /// An image with its top left at a spot.
    Image { at: Spot, pixels: Rc<Pixmap> },
}

/// Shapes on paper, the last one on top.
#[derive(Clone, Debug)]
pub struct Painter {
    width: u32,
    height: u32,
    shapes: Vec<Shape>,
}

impl Painter {
    /// Its width and height [px].
    pub fn size(&self) -> [u32; 2] {
        [self.width, self.height]
    }

    /// More paper at the bottom.
    pub fn extend(&mut self, by: u32) {
        self.height += by;
    }

    /// Empty paper of a size [px].
    pub fn new(width: u32, height: u32) -> Self {
        Self {
            width,
            height,
            shapes: Vec::new(),
        }
    }

    /// Empty paper of a width [px] for a view from one corner to the other [m], and where its places
    /// fall; 50 to 2000 px high.
    pub fn for_view([low, high]: [[f32; 3]; 2], width: u32) -> (Self, Frame) {
        let unit = width as f32 / (high[0] - low[0]);
        let height = (unit * (high[1] - low[1])).round().clamp(50.0, 2000.0);
        let origin = [-low[0] * unit, height + low[1] * unit];
        (Self::new(width, height as u32), Frame { origin, unit })
    }

    /// Adds a filled outline without an edge.
    pub fn area(&mut self, outline: Vec<Spot>, role: Role) {
        self.shapes.push(Shape::Area { outline, role });
    }

    /// Adds a filled outline with an edge of a width [px].
    pub fn polygon(&mut self, outline: Vec<Spot>, role: Role, edge: Role, width: f32) {
        self.area(outline.clone(), role);
        self.ring(outline, width, edge);
    }

    /// Adds a filled rectangle with an edge.
    pub fn rectangle(&mut self, low: Spot, size: Spot, role: Role, edge: Role, width: f32) {
        self.polygon(rectangle(low, size), role, edge, width);
    }

    /// Adds an open line.
    pub fn line(&mut self, spots: Vec<Spot>, width: f32, role: Role) {
        self.shapes.push(Shape::Line {
            spots,
            closed: false,
            width,
            role,
        });
    }

    /// Adds a closed line.
    pub fn ring(&mut self, spots: Vec<Spot>, width: f32, role: Role) {
        self.shapes.push(Shape::Line {
            spots,
            closed: true,
            width,
            role,
        });
    }

    /// Adds a line of text in the middle below everything, on paper of its own.
    pub fn caption(&mut self, text: &str) {
        const HEIGHT: f32 = 13.0;
        let [width, height] = self.size().map(|k| k as f32);
        self.extend((2.6 * HEIGHT) as u32);
        let x = 0.5 * (width - letters::width(HEIGHT, text));
        self.text([x, height + 0.7 * HEIGHT], HEIGHT, Role::Ink, text);
    }

    /// Adds a disc.
    pub fn dot(&mut self, at: Spot, radius: f32, role: Role) {
        self.shapes.push(Shape::Dot { at, radius, role });
    }

    /// Adds a disc with a pale ring that sets it off.
    pub fn bright_dot(&mut self, at: Spot, radius: f32, role: Role) {
        self.dot(at, radius * 1.45, Role::Paper);
        self.dot(at, radius, role);
    }

    /// Adds a cross with a pale rim that sets it off.
    pub fn cross(&mut self, at: Spot, reach: f32, role: Role) {
        for (width, role) in [(1.1 * reach, Role::Paper), (0.55 * reach, role)] {
            for side in [-reach, reach] {
                let ends = [[at[0] - reach, at[1] - side], [at[0] + reach, at[1] + side]];
                self.line(ends.to_vec(), width, role);
            }
        }
    }

    /// Adds a line of text; `at` is the top left of its first capital, `height` that of a capital.
    pub fn text(&mut self, at: Spot, height: f32, role: Role, text: &str) {
        for spots in letters::lines(at, height, text) {
            self.line(spots, 0.15 * height, role);
        }
    }

    /// Adds an image with its top left at a spot.
    pub fn image(&mut self, at: Spot, pixels: Pixmap) {
        let pixels = Rc::new(pixels);
        self.shapes.push(Shape::Image { at, pixels });
    }

    /// Adds a row of samples with their names in the middle of the paper, as a legend.
    pub fn legend(&mut self, y: f32, entries: &[(Sample, &str)]) {
        let wide: f32 = entries.iter().map(|(_, name)| entry_width(name)).sum();
        let x = 0.5 * (self.width as f32 - wide + BETWEEN_ENTRIES);
        self.entries([x, y], entries);
    }

    /// Adds a row of samples with their names from `at` on.
    pub fn entries(&mut self, at: Spot, entries: &[(Sample, &str)]) {
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

/// Width of a sample in a legend [px].
const SIZE: f32 = 22.0;
const BETWEEN_ENTRIES: f32 = 26.0;

fn entry_width(name: &str) -> f32 {
    SIZE + 10.0 + letters::width(15.0, name) + BETWEEN_ENTRIES
}

/// What stands before a name in a legend.
#[derive(Copy, Clone, Debug)]
pub enum Sample {
    /// A filled square with an edge.
    Area(Role, Role),
    /// A dot.
    Dot(Role),
    /// A cross.
    Cross(Role),
    /// A line.
    Line(Role),
}

/// The corners of a rectangle.
pub fn rectangle([x, y]: Spot, size: Spot) -> Vec<Spot> {
    let (right, bottom) = (x + size[0], y + size[1]);
    vec![[x, y], [right, y], [right, bottom], [x, bottom]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use role::colour;

    #[test]
    fn a_caption_stands_on_paper_of_its_own() {
        let mut painter = Painter::new(120, 40);
        painter.caption("2.5 s: it is in!");
        let pixels = painter.pixels().unwrap();
        let is_ink = |y: u32| (0..120).any(|x| pixels.pixel(x, y).is_some_and(|at| at.red() < 100));
        assert!(pixels.height() > 60 && !(0..42).any(is_ink) && (42..pixels.height()).any(is_ink));
    }

    #[test]
    fn drawing_and_image_hold_the_same_shapes() {
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
