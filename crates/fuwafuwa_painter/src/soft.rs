//! The look of the game: soft things with round rims, under a light from the upper left.
//!
//! A shape is blurred, and the blur is taken for its height: where it falls off is the rim, and
//! which way it falls tells how the light meets it. Everything is painted on one layer of pixels,
//! which lies on the paper as an image. To see elements exactly, use [`crate::stage`].

use crate::cover::{Cover, Region};
use crate::face::Face;
use crate::smoothing::{self, Curve};
use crate::stage;
use crate::theme::{Role, colour};
use crate::{Frame, Painter, Spot};
use fuwafuwa::shape::{Shape, Vector};
use fuwafuwa::{Body, Dim2, World};
use std::collections::BTreeMap;
use tiny_skia::{Pixmap, PremultipliedColorU8};

/// How far the roundness of a body reaches in from its rim [m].
const BODY_RIM: f32 = 0.045;
/// The same of rigid things [m].
const RIGID_RIM: f32 = 0.02;
/// How wide the fresh inside shows along a torn rim [voxels].
const FRESH_BAND: f32 = 1.7;
/// Its width at most, as a share of the width of a piece.
const FRESH_SHARE: f32 = 0.2;
/// Width of outlines [m], and of those around what was inside.
const LINE: f32 = 0.011;
const THIN_LINE: f32 = 0.007;
/// Towards the light on the paper, y downwards; of length 1.
const LIGHT: Spot = [-0.5, -0.866];
/// How far shadows fall [m], how soft they are [m] and how dark.
const SHADOW_FALL: f32 = 0.02;
const SHADOW_WIDTH: f32 = 0.02;
const SHADOW: f32 = 0.16;

/// What a game adds to a world.
#[derive(Clone, Debug, Default)]
pub struct Extras {
    /// The region that the body has to get into.
    pub basket: Option<Shape>,
    /// Faces of bodies.
    pub faces: Vec<Face>,
}

/// Paints a moment: basket, obstacles, bodies, faces, and hands, the first hand being player 1's.
pub fn world(painter: &mut Painter, frame: Frame, world: &World<Dim2>, extras: &Extras) {
    if let Some(region) = extras.basket {
        basket(painter, frame, region);
    }
    for obstacle in world.obstacles() {
        bar(painter, frame, obstacle.shape);
    }
    for each in world.bodies() {
        body(painter, frame, each);
    }
    for face in &extras.faces {
        face.paint(painter, frame);
    }
    for (number, each) in world.manipulators().iter().enumerate() {
        hand(painter, frame, each.position(), each.radius, number);
    }
}

/// Paints a translucent region with a dashed border.
pub fn basket(painter: &mut Painter, frame: Frame, region: Shape) {
    let spots = spots(frame, &stage::rim(region, 0.03));
    painter.area(spots.clone(), Role::Basket);
    let dash = 0.05 * frame.unit;
    let width = (0.012 * frame.unit).max(1.5);
    painter.dashed(&spots, [dash, 0.8 * dash], width, Role::BasketRim);
}

/// Paints something rigid that never moves.
pub fn bar(painter: &mut Painter, frame: Frame, shape: Shape) {
    let rings = vec![spots(frame, &stage::rim(shape, 0.015))];
    toy(painter, frame, &rings, RIGID_RIM, Role::Bar);
}

/// Paints a hand; the look of player 1 has `number` 0, that of player 2 has 1, and so in turns.
///
/// Besides its colour, a paw tells the first from the second, which has a star.
pub fn hand(painter: &mut Painter, frame: Frame, at: Vector, radius: f32, number: usize) {
    let role = [Role::Hand, Role::OtherHand][number % 2];
    let disc = Shape::Ball { centre: at, radius };
    let rings = vec![spots(frame, &stage::rim(disc, 0.0))];
    toy(painter, frame, &rings, 0.4 * radius, role);
    let place = |[u, v]: Spot| frame.spot([at[0] + u * radius, at[1] + v * radius, 0.0]);
    let pad = |painter: &mut Painter, middle: Spot, size: Spot| {
        let points = ellipse(middle, size).map(place);
        painter.area(points.collect(), Role::HandMark);
    };
    if number.is_multiple_of(2) {
        pad(painter, [0.0, -0.22], [0.36, 0.28]);
        for middle in [[-0.46, 0.08], [-0.17, 0.36], [0.17, 0.36], [0.46, 0.08]] {
            pad(painter, middle, [0.15, 0.19]);
        }
    } else {
        let star = (0..10).map(|k| {
            let far = [0.56, 0.27][k % 2];
            let turn = k as f32 * std::f32::consts::PI / 5.0;
            place([far * turn.sin(), far * turn.cos()])
        });
        painter.area(star.collect(), Role::HandMark);
    }
}

/// Paints a body of the plane, smooth, its inside showing where it tore.
pub fn body(painter: &mut Painter, frame: Frame, body: &Body<Dim2>) {
    let mut pieces: BTreeMap<u32, Piece> = BTreeMap::new();
    for view in body.element_views() {
        let piece = pieces.entry(view.piece).or_default();
        piece.element_count += 1;
        if view.material > 1 {
            let inner = piece.inner.entry(view.material).or_default();
            inner.push(stage::outline(frame, &view));
        }
    }
    for line in body.outlines() {
        let curve = smoothing::rounded(&line.points, &line.is_fresh);
        pieces.entry(line.piece).or_default().curves.push(curve);
    }
    let mut pieces: Vec<Piece> = pieces.into_values().collect();
    // Crumbs that were pressed into a piece would look like dirt on it.
    pieces.sort_by_key(|piece| piece.element_count);
    let all: Vec<Vec<Spot>> = pieces.iter().flat_map(|piece| piece.rings(frame)).collect();
    let voxel = body.grid().voxel_size();
    layered(painter, frame, &all, |layer| {
        for piece in &pieces {
            layer.piece(piece, voxel);
        }
    });
}

/// Paints a thing of one colour with a round rim of a width [m].
fn toy(painter: &mut Painter, frame: Frame, rings: &[Vec<Spot>], rim: f32, role: Role) {
    layered(painter, frame, rings, |layer| {
        if let Some(puff) = Puff::new(rings, rim * frame.unit, role, layer.paper) {
            layer.add(&puff);
        }
        layer.lines(rings, LINE, line_tone(role));
    });
}

/// Paints on pixels of their own what lies in and around rings, their shadow first.
fn layered(painter: &mut Painter, frame: Frame, rings: &[Vec<Spot>], paint: impl Fn(&mut Layer)) {
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

/// A piece of a body, to be painted.
#[derive(Default)]
struct Piece {
    element_count: usize,
    curves: Vec<Curve>,
    /// Outlines of elements of other materials than the first, by material.
    inner: BTreeMap<u8, Vec<Vec<Spot>>>,
}

impl Piece {
    fn rings(&self, frame: Frame) -> Vec<Vec<Spot>> {
        let curves = self.curves.iter();
        curves.map(|curve| spots(frame, &curve.points)).collect()
    }

    /// The stretches of its outlines that are torn, or those that are not.
    fn runs(&self, frame: Frame, is_fresh: bool) -> Vec<Vec<Spot>> {
        let mut runs: Vec<Vec<Spot>> = Vec::new();
        for curve in &self.curves {
            let count = curve.points.len();
            let mut is_open = false;
            for k in 0..count {
                if curve.is_fresh[k] != is_fresh {
                    is_open = false;
                    continue;
                }
                if !is_open {
                    runs.push(vec![frame.spot(curve.points[k])]);
                    is_open = true;
                }
                if let Some(run) = runs.last_mut() {
                    run.push(frame.spot(curve.points[(k + 1) % count]));
                }
            }
        }
        runs
    }
}

/// Red, green and blue, from 0 to 255.
type Tone = [f32; 3];

/// A shape with its colours and its height.
struct Puff {
    mask: Cover,
    height: Cover,
    /// Width of its rim [px].
    rim: f32,
    tones: Vec<Tone>,
}

impl Puff {
    /// What rings cover, with a rim of at most some width [px]; nothing when that is off the paper.
    fn new(rings: &[Vec<Spot>], rim: f32, role: Role, paper: [u32; 2]) -> Option<Self> {
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
    fn tint(&mut self, cover: &Cover, role: Role) {
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
struct Layer {
    frame: Frame,
    paper: [u32; 2],
    region: Region,
    pixels: Pixmap,
}

impl Layer {
    fn shadow(&mut self, rings: &[Vec<Spot>]) {
        let unit = self.frame.unit;
        let fall = SHADOW_FALL * unit;
        let fallen = |ring: &Vec<Spot>| {
            ring.iter()
                .map(|[x, y]| [x + 0.5 * fall, y + fall])
                .collect()
        };
        let fallen: Vec<Vec<Spot>> = rings.iter().map(fallen).collect();
        let cover = self
            .region
            .filled(&fallen)
            .blurred(0.6 * SHADOW_WIDTH * unit);
        let ink = tone(Role::Ink);
        for (pixel, share) in self.pixels.pixels_mut().iter_mut().zip(cover.share) {
            blend(pixel, ink, SHADOW * share);
        }
    }

    fn add(&mut self, puff: &Puff) {
        let Region {
            low,
            size: [columns, rows],
        } = puff.mask.region;
        let [width, height] = self.region.size;
        for y in 0..rows {
            for x in 0..columns {
                let share = puff.mask.share[y * columns + x];
                let column = low[0] + x as i32 - self.region.low[0];
                let row = low[1] + y as i32 - self.region.low[1];
                let is_here =
                    (0..width as i32).contains(&column) && (0..height as i32).contains(&row);
                if share > 0.0 && is_here {
                    let pixel = row as usize * width + column as usize;
                    blend(&mut self.pixels.pixels_mut()[pixel], puff.lit(x, y), share);
                }
            }
        }
    }

    /// Adds closed lines of a width [m].
    fn lines(&mut self, rings: &[Vec<Spot>], width: f32, tone: Tone) {
        let close = |ring: &Vec<Spot>| ring.iter().chain(ring.first()).copied().collect();
        let closed: Vec<Vec<Spot>> = rings.iter().map(close).collect();
        self.strokes(&closed, width, tone);
    }

    /// Adds open lines of a width [m].
    fn strokes(&mut self, lines: &[Vec<Spot>], width: f32, tone: Tone) {
        let width = (width * self.frame.unit).max(1.0);
        let cover = self.region.stroked(lines, width);
        for (pixel, share) in self.pixels.pixels_mut().iter_mut().zip(cover.share) {
            blend(pixel, tone, share);
        }
    }

    fn piece(&mut self, piece: &Piece, voxel: f32) {
        let unit = self.frame.unit;
        let rings = piece.rings(self.frame);
        let is_crumb = piece.element_count == 1;
        let role = if is_crumb { Role::Crumb } else { Role::Skin };
        let Some(mut puff) = Puff::new(&rings, BODY_RIM * unit, role, self.paper) else {
            return;
        };
        let region = puff.mask.region;
        let fresh = piece.runs(self.frame, true);
        if !is_crumb {
            // On a small piece a narrower one, so that something of its colour is left.
            let most = FRESH_SHARE * puff.mask.share.iter().sum::<f32>().sqrt();
            let band = region.stroked(&fresh, 2.0 * most.min(FRESH_BAND * voxel * unit));
            puff.tint(&band.blurred(0.4 * voxel * unit), Role::Fresh);
        }
        for (&material, outlines) in &piece.inner {
            let cells = region.filled(outlines).blurred(1.2 * voxel * unit);
            puff.tint(&cells.steeper(), Role::Material(material));
        }
        self.add(&puff);
        if is_crumb {
            self.lines(&rings, THIN_LINE, line_tone(Role::Crumb));
        } else {
            self.strokes(&fresh, THIN_LINE, line_tone(Role::Crumb));
            self.strokes(&piece.runs(self.frame, false), LINE, line_tone(Role::Skin));
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

fn tone(role: Role) -> Tone {
    colour(role).map(f32::from)
}

/// A colour in the shade: darker and stronger, as of something that light shines into.
fn shaded(tone: Tone) -> Tone {
    tone.map(|k| 0.94 * k * (k / 255.0).sqrt())
}

/// The colour of the line around something.
fn line_tone(role: Role) -> Tone {
    mixed(shaded(tone(role)), tone(Role::Ink), 0.4)
}

fn mixed(a: Tone, b: Tone, share: f32) -> Tone {
    [0, 1, 2].map(|k: usize| a[k] + (b[k] - a[k]) * share)
}

fn spots(frame: Frame, places: &[Vector]) -> Vec<Spot> {
    places.iter().map(|&at| frame.spot(at)).collect()
}

/// The corners of an ellipse, for an upright pair of axes.
pub(crate) fn ellipse(middle: Spot, size: Spot) -> impl Iterator<Item = Spot> {
    const ROUND: usize = 32;
    (0..ROUND).map(move |k| {
        let turn = k as f32 / ROUND as f32 * std::f32::consts::TAU;
        [
            middle[0] + size[0] * turn.cos(),
            middle[1] + size[1] * turn.sin(),
        ]
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use fuwafuwa::{Blade, Material, Settings, VoxelGrid};

    const FRAME: Frame = Frame {
        origin: [20.0, 120.0],
        unit: 100.0,
    };

    fn paper() -> Painter {
        Painter::new(140, 140)
    }

    fn at(pixels: &Pixmap, place: [f32; 2]) -> Tone {
        let [x, y] = FRAME.spot([place[0], place[1], 0.0]).map(|k| k as u32);
        let pixel = pixels.pixel(x, y).unwrap();
        [pixel.red(), pixel.green(), pixel.blue()].map(f32::from)
    }

    /// How far two colours are apart.
    fn apart(a: Tone, b: Tone) -> f32 {
        (0..3).map(|k| (a[k] - b[k]).abs()).sum()
    }

    /// A disc that is cut from its left side to its middle.
    fn cut_disc() -> Body<Dim2> {
        let mut world = World::<Dim2>::new(Settings::default()).unwrap();
        let body = Body::new(VoxelGrid::ball(32, 1.0).unwrap(), &[Material::default()]);
        world.add_body(body.unwrap());
        let blade = Blade {
            from: [-0.1, 0.5, 0.0],
            across: [0.6, 0.0, 0.0],
            along: [0.0, 0.0, 1.0],
        };
        assert!(world.cut(0, &blade) > 0);
        world.remove_body(0)
    }

    #[test]
    fn a_body_is_pink_outside_and_pale_where_it_is_cut() {
        let mut painter = paper();
        body(&mut painter, FRAME, &cut_disc());
        let pixels = painter.pixels().unwrap();
        let near = |place, role| apart(at(&pixels, place), tone(role)) < 60.0;
        assert!(near([0.5, 0.75], Role::Skin) && near([0.5, 0.3], Role::Skin));
        assert!(near([0.3, 0.53], Role::Fresh) && near([0.3, 0.47], Role::Fresh));
        assert!(near([0.02, 0.98], Role::Paper), "beside the disc");
        let [lit, dark] = [[0.28, 0.89], [0.72, 0.11]].map(|place| at(&pixels, place));
        assert!(
            lit[1] > dark[1] + 30.0,
            "the light comes from the upper left"
        );
    }

    #[test]
    fn two_hands_differ_in_more_than_colour() {
        let marks = [0, 1].map(|number| {
            let mut painter = paper();
            hand(&mut painter, FRAME, [0.5, 0.5, 0.0], 0.3, number);
            let pixels = painter.pixels().unwrap();
            let mark = tone(Role::HandMark);
            let cells =
                (0..400).map(|k| [0.3 + 0.02 * (k % 20) as f32, 0.3 + 0.02 * (k / 20) as f32]);
            cells
                .map(|cell| apart(at(&pixels, cell), mark) < 120.0)
                .collect::<Vec<bool>>()
        });
        let differences = marks[0]
            .iter()
            .zip(&marks[1])
            .filter(|(a, b)| a != b)
            .count();
        assert!(differences > 40, "{differences} of 400 places");
    }

    #[test]
    fn what_is_off_the_paper_or_nowhere_leaves_it_empty() {
        let mut painter = paper();
        hand(&mut painter, FRAME, [50.0, 0.0, 0.0], 0.1, 0);
        let far = cut_disc().moved([0.0, -30.0, 0.0]);
        body(&mut painter, FRAME, &far);
        bar(
            &mut painter,
            FRAME,
            Shape::half_space([0.0, 1.0, 0.0], [0.0, -9.0, 0.0]),
        );
        let pixels = painter.pixels().unwrap();
        let empty = paper().pixels().unwrap();
        assert!(pixels.data() == empty.data());
    }

    #[test]
    fn a_basket_lets_through_what_is_behind_it() {
        let region = Shape::Box {
            centre: [0.5, 0.5, 0.0],
            half: [0.3, 0.3, 1.0],
        };
        let mut painter = paper();
        hand(&mut painter, FRAME, [0.5, 0.5, 0.0], 0.1, 0);
        let before = at(&painter.pixels().unwrap(), [0.5, 0.5]);
        basket(&mut painter, FRAME, region);
        let pixels = painter.pixels().unwrap();
        assert!(apart(at(&pixels, [0.5, 0.5]), before) > 20.0);
        assert!(apart(at(&pixels, [0.5, 0.5]), at(&pixels, [0.3, 0.7])) > 20.0);
    }
}
