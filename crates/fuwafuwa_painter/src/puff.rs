//! Soft light on flat shapes.
//!
//! A shape is blurred, and the blur is taken for its height: where it falls off is the rim, and
//! which way it falls tells how the light meets it.

use crate::cover::{Cover, Region};
use crate::theme::colour;
use crate::{Frame, Painter, Role, Spot};
use tiny_skia::{Pixmap, PremultipliedColorU8};

/// Width of outlines [m], and of those around what was inside.
pub const LINE: f32 = 0.011;
pub const THIN_LINE: f32 = 0.007;
/// Towards the light on the paper, y downwards; of length 1.
const LIGHT: Spot = [-0.5, -0.866];
/// How far shadows fall [m], how soft they are [m] and how dark.
const SHADOW_FALL: f32 = 0.02;
const SHADOW_WIDTH: f32 = 0.02;
const SHADOW: f32 = 0.16;

/// Paints on pixels of their own what lies in and around rings, their shadow first.
pub fn layered(
    painter: &mut Painter,
    frame: Frame,
    rings: &[Vec<Spot>],
    paint: impl Fn(&mut Layer),
) {
    let paper = painter.size();
    let margin = (SHADOW_FALL + 3.0 * SHADOW_WIDTH + LINE) * frame.unit + 2.0;
    let Some(region) = Region::around(rings, margin, paper).and_then(|all| all.on(paper)) else {
        return;
    };
    let [width, height] = region.size.map(|k| k as u32);
    let Some(pixels) = Pixmap::new(width, height) else {
        return;
    };
    let mut layer = Layer {
        frame,
        paper,
        region,
        pixels,
    };
    layer.shadow(rings);
    paint(&mut layer);
    painter.image(region.low.map(|k| k as f32), layer.pixels);
}

/// Red, green and blue, from 0 to 255.
pub type Tone = [f32; 3];

/// A shape with its colours and its height.
pub struct Puff {
    /// Which pixels it covers.
    pub mask: Cover,
    height: Cover,
    /// Width of its rim [px].
    rim: f32,
    tones: Vec<Tone>,
}

impl Puff {
    /// What rings cover, with a rim of at most some width [px]; nothing when that is off the paper.
    pub fn new(rings: &[Vec<Spot>], rim: f32, role: Role, paper: [u32; 2]) -> Option<Self> {
        let region = Region::around(rings, 3.0 * rim + 1.0, paper)?;
        let mask = region.filled(rings);
        let covered: f32 = mask.share.iter().sum();
        let rim = rim.min(0.22 * covered.sqrt());
        Some(Self {
            height: mask.blurred(rim),
            rim: rim.round().max(0.5),
            tones: vec![tone(role); mask.share.len()],
            mask,
        })
    }

    /// Gives it another colour where a cover of the same region is.
    pub fn tint(&mut self, cover: &Cover, role: Role) {
        let new = tone(role);
        for (tone, &share) in self.tones.iter_mut().zip(&cover.share) {
            *tone = mixed(*tone, new, share);
        }
    }

    /// The colour of a pixel under the light.
    fn lit(&self, x: usize, y: usize) -> Tone {
        let [columns, rows] = self.mask.region.size;
        let pixel = y * columns + x;
        let base = self.tones[pixel];
        let deep = shaded(base);
        // At a straight rim the blur is a half; one width further in it is nearly whole.
        let inside = (2.0 * self.height.share[pixel] - 1.0).clamp(0.0, 1.0);
        let slope = self.height.slope(x, y).map(|k| -2.2 * self.rim * k);
        let facing = slope[0] * LIGHT[0] + slope[1] * LIGHT[1];
        // Over the whole of a thing the light grows weaker downwards.
        let below = y as f32 / rows as f32 - 0.5;
        let tone = mixed(deep, base, 0.45 + 0.55 * inside);
        let tone = mixed(
            tone,
            [255.0, 250.0, 240.0],
            (0.42 * facing - 0.12 * below).clamp(0.0, 0.6),
        );
        mixed(tone, deep, (-0.75 * facing + 0.25 * below).clamp(0.0, 0.8))
    }
}

/// Pixels for a part of the paper, clear at first.
pub struct Layer {
    /// Where places fall.
    pub frame: Frame,
    /// Size of the paper [px].
    pub paper: [u32; 2],
    region: Region,
    pixels: Pixmap,
}

impl Layer {
    fn shadow(&mut self, rings: &[Vec<Spot>]) {
        let unit = self.frame.unit;
        let fall = SHADOW_FALL * unit;
        let moved = |[x, y]: &Spot| [x + 0.5 * fall, y + fall];
        let fallen: Vec<Vec<Spot>> = rings
            .iter()
            .map(|ring| ring.iter().map(moved).collect())
            .collect();
        let cover = self.region.filled(&fallen);
        self.cover(&cover.blurred(0.6 * SHADOW_WIDTH * unit), SHADOW, |_, _| {
            tone(Role::Ink)
        });
    }

    /// Adds a shape.
    pub fn add(&mut self, puff: &Puff) {
        self.cover(&puff.mask, 1.0, |x, y| puff.lit(x, y));
    }

    /// Adds closed lines of a width [m].
    pub fn lines(&mut self, rings: &[Vec<Spot>], width: f32, tone: Tone) {
        let close = |ring: &Vec<Spot>| ring.iter().chain(ring.first()).copied().collect();
        let closed: Vec<Vec<Spot>> = rings.iter().map(close).collect();
        self.strokes(&closed, width, tone);
    }

    /// Adds open lines of a width [m]; what is thinner than a pixel is pale instead.
    pub fn strokes(&mut self, lines: &[Vec<Spot>], width: f32, tone: Tone) {
        let thin = width * self.frame.unit;
        let width = thin.max(1.0);
        if let Some(region) = Region::around(lines, width, self.paper) {
            self.cover(&region.stroked(lines, width), thin.min(1.0), |_, _| tone);
        }
    }

    /// Paints the pixels of a cover that are on the layer, each with its tone.
    fn cover(&mut self, cover: &Cover, opacity: f32, tone: impl Fn(usize, usize) -> Tone) {
        let [width, height] = self.region.size;
        let Region { low, size } = cover.region;
        let pixels = self.pixels.pixels_mut();
        for (k, &share) in cover
            .share
            .iter()
            .enumerate()
            .filter(|&(_, &share)| share > 0.0)
        {
            let at = [k % size[0], k / size[0]];
            let place =
                |axis: usize| (low[axis] + at[axis] as i32 - self.region.low[axis]) as usize;
            // What is left of the layer or above it becomes huge.
            let (column, row) = (place(0), place(1));
            if column < width && row < height {
                blend(
                    &mut pixels[row * width + column],
                    tone(at[0], at[1]),
                    opacity * share,
                );
            }
        }
    }
}

/// Puts a share of a colour over a pixel.
fn blend(pixel: &mut PremultipliedColorU8, tone: Tone, share: f32) {
    let share = share.clamp(0.0, 1.0);
    let old = [pixel.red(), pixel.green(), pixel.blue(), pixel.alpha()].map(f32::from);
    let new = [tone[0], tone[1], tone[2], 255.0];
    let mut sum = [0u8; 4];
    for k in 0..4 {
        sum[k] = (old[k] + (new[k].clamp(0.0, 255.0) - old[k]) * share).round() as u8;
    }
    let [red, green, blue, alpha] = sum;
    let whole =
        PremultipliedColorU8::from_rgba(red.min(alpha), green.min(alpha), blue.min(alpha), alpha);
    *pixel = whole.expect("no part is above the whole");
}

/// The colour of a role.
pub fn tone(role: Role) -> Tone {
    colour(role).map(f32::from)
}

/// A colour in the shade: darker and stronger, as of something that light shines into.
fn shaded(tone: Tone) -> Tone {
    tone.map(|k| 0.94 * k * (k / 255.0).sqrt())
}

/// The colour of the line around something.
pub fn line_tone(role: Role) -> Tone {
    mixed(shaded(tone(role)), tone(Role::Ink), 0.4)
}

fn mixed(a: Tone, b: Tone, share: f32) -> Tone {
    [0, 1, 2].map(|k: usize| a[k] + (b[k] - a[k]) * share)
}
