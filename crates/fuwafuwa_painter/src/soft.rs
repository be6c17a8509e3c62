//! The look of the game: soft things with round rims, under a light from the upper left.
//!
//! Each thing is painted pixel by pixel and lies on the paper as an image. To see elements exactly,
//! use [`crate::stage`].

use crate::face::Face;
use crate::paper::ellipse;
use crate::puff::{LINE, Layer, Puff, THIN_LINE, layered, line_tone};
use crate::smoothing::{self, Curve};
use crate::stage;
use crate::{Frame, Painter, Role, Spot};
use fuwafuwa::shape::{Shape, Vector};
use fuwafuwa::{Body, Dim2, PieceId, Rigid, World};
use std::collections::BTreeMap;

/// How far the roundness of a body reaches in from its rim [m].
const BODY_RIM: f32 = 0.045;
/// The same of rigid things [m].
const RIGID_RIM: f32 = 0.02;
/// How wide the fresh inside shows along a torn rim [voxels].
const FRESH_BAND: f32 = 1.7;
/// Its width at most, as a share of the width of a piece.
const FRESH_SHARE: f32 = 0.2;
/// Width of the line around a crumb at most [voxels], so that a heap is not all lines.
const CRUMB_LINE: f32 = 0.2;

/// What a game adds to a world.
#[derive(Clone, Debug, Default)]
pub struct Extras {
    /// The region that the body has to get into.
    pub basket: Option<Shape>,
    /// Faces of bodies.
    pub faces: Vec<Face>,
}

/// Paints a moment: basket, bodies, faces, obstacles, hands, the first hand being player 1's.
pub fn world(painter: &mut Painter, frame: Frame, world: &World<Dim2>, extras: &Extras) {
    if let Some(region) = extras.basket {
        basket(painter, frame, region);
    }
    for each in world.bodies() {
        body(painter, frame, each);
    }
    for face in &extras.faces {
        face.paint(painter, frame);
    }
    // A smooth outline may reach a little into what the body touches: on top, that stays whole.
    for obstacle in world.obstacles() {
        bar(painter, frame, *obstacle.shape());
    }
    for (number, (_, each)) in world.hands().enumerate() {
        hand(painter, frame, each, number);
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
pub fn hand(painter: &mut Painter, frame: Frame, hand: &Rigid, number: usize) {
    let role = [Role::Hand, Role::OtherHand][number % 2];
    let (at, radius) = (hand.position(), hand.shape().inradius());
    let rings = vec![spots(frame, &stage::rim(*hand.shape(), 0.0))];
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
    let mut pieces: BTreeMap<PieceId, Piece> = BTreeMap::new();
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
            paint_piece(layer, piece, voxel);
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

/// Paints a piece of a body with voxels of a width [m].
fn paint_piece(layer: &mut Layer, piece: &Piece, voxel: f32) {
    let unit = layer.frame.unit;
    let rings = piece.rings(layer.frame);
    let is_crumb = piece.element_count == 1;
    let role = if is_crumb { Role::Crumb } else { Role::Skin };
    let Some(mut puff) = Puff::new(&rings, BODY_RIM * unit, role, layer.paper) else {
        return;
    };
    let region = puff.mask.region;
    let fresh = piece.runs(layer.frame, true);
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
    layer.add(&puff);
    if is_crumb {
        let width = THIN_LINE.min(CRUMB_LINE * voxel);
        layer.lines(&rings, width, line_tone(Role::Crumb));
    } else {
        layer.strokes(&fresh, THIN_LINE, line_tone(Role::Crumb));
        layer.strokes(&piece.runs(layer.frame, false), LINE, line_tone(Role::Skin));
    }
}

fn spots(frame: Frame, places: &[Vector]) -> Vec<Spot> {
    places.iter().map(|&at| frame.spot(at)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Pixmap;
    use crate::puff::{Tone, tone};
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
        assert!(world.cut(world.nth_body(0).unwrap(), &blade).unwrap() > 0);
        world.remove_body(world.nth_body(0).unwrap()).unwrap()
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
            hand(
                &mut painter,
                FRAME,
                &Rigid::hand([0.5, 0.5, 0.0], 0.3),
                number,
            );
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
        hand(&mut painter, FRAME, &Rigid::hand([50.0, 0.0, 0.0], 0.1), 0);
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
        hand(&mut painter, FRAME, &Rigid::hand([0.5, 0.5, 0.0], 0.1), 0);
        let before = at(&painter.pixels().unwrap(), [0.5, 0.5]);
        basket(&mut painter, FRAME, region);
        let pixels = painter.pixels().unwrap();
        assert!(apart(at(&pixels, [0.5, 0.5]), before) > 20.0);
        assert!(apart(at(&pixels, [0.5, 0.5]), at(&pixels, [0.3, 0.7])) > 20.0);
    }
}
