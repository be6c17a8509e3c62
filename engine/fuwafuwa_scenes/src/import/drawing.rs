//! Drawings: closed outlines become solid, and thin strokes become thick enough to hold.

use super::mask::{Component, Extent, Mask, longer};
use super::note::NoteKind;
use super::paper::Drawing;
use super::tints::{INK_WEIGHT, Sample, Samples};

/// Maximum number of pixels per voxel at which shapes are worked on.
const DETAIL: usize = 8;
/// Maximum area of a speck of noise [voxels²].
const SPECK: f64 = 0.25;
/// Radius by which outlines are closed before they are filled [voxels]. Gaps of twice this width close.
const CLOSED: f64 = 0.6;
/// Rounds in which strokes are thickened: radius of the disc that does not fit into a stroke which is too thin,
/// and radius by which the stroke then grows [voxels]. A stroke 1.5 voxels wide holds at any angle: the voxels
/// of which it covers at least half share edges.
const THICKENED: [(f64, f64); 2] = [(0.375, 0.8), (0.75, 0.4)];
/// Share of the edge of a picture along which something lies that is not part of the drawing, such as a table
/// below the paper.
const SURROUNDING: f64 = 0.2;
/// Minimum thickness of such surroundings, in widths of the pen of the drawing. What is thinner is an outline to
/// which the picture was cropped.
const THICK: f64 = 2.0;
/// Maximum ratio of width to length of a wedge: a strip of the table at an edge, visible because the paper is turned.
const WEDGE: f64 = 0.25;
/// Minimum share of the length of a wedge that lies at the edge of the picture.
const WEDGE_AT_EDGE: f64 = 0.8;
/// Maximum share of the box around a wedge that the wedge covers. A straight line along the edge covers more.
const WEDGE_AREA: f64 = 0.75;
/// Maximum width of a pen, as a share of the longer side of a picture. Wider strokes are filled shapes.
const WIDEST_PEN: f64 = 0.02;
/// Minimum size of a drawing on such paper, as a share of the picture's area.
const LEAST_DRAWING: f64 = 0.02;

/// Solid part of a drawing.
pub(super) struct Solid {
    /// Solid pixels, trimmed. The mask has no pixel if the drawing has none.
    pub mask: Mask,
    /// Ink and enclosed paper, before thickening; same size as `mask`.
    filled: Mask,
    /// Number of pixels of the picture along a pixel of `mask`.
    factor: usize,
    /// Pixel of the picture at the upper left corner of `mask`, which may lie outside the picture.
    corner: [isize; 2],
    /// Notes on what was left out.
    pub notes: Vec<NoteKind>,
}

impl Solid {
    /// Returns the colours of the solid pixels. A pixel with ink has the mean colour of its ink. Pixels
    /// added by thickening have no colour.
    pub fn samples(&self, drawing: &Drawing) -> Samples {
        let [width, _] = self.mask.size;
        let pixels = self.filled.on.iter().enumerate().map(|(at, &is_filled)| {
            let sample = || self.sample(drawing, [at % width, at / width]);
            is_filled.then(sample).flatten()
        });
        Samples {
            size: self.mask.size,
            pixels: pixels.collect(),
        }
    }

    fn sample(&self, drawing: &Drawing, pixel: [usize; 2]) -> Option<Sample> {
        let size = drawing.ink.size;
        let [columns, rows] = [0, 1].map(|axis| {
            let start = self.corner[axis] + (pixel[axis] * self.factor) as isize;
            let within = |at: isize| at.clamp(0, size[axis] as isize) as usize;
            within(start)..within(start + self.factor as isize)
        });
        let block = || {
            let row = |row: usize| columns.clone().map(move |column| row * size[0] + column);
            rows.clone().flat_map(row)
        };
        let mean = |pixels: &mut dyn Iterator<Item = usize>| {
            let (mut sums, mut count) = ([0u32; 3], 0u32);
            for at in pixels {
                (0..3).for_each(|k| sums[k] += u32::from(drawing.colours[at][k]));
                count += 1;
            }
            (count > 0).then(|| sums.map(|sum| (sum / count) as u8))
        };
        let of = |colour, weight| Sample { colour, weight };
        let ink = mean(&mut block().filter(|&at| drawing.ink.on[at]));
        let ink = ink.map(|colour| of(colour, INK_WEIGHT));
        ink.or_else(|| mean(&mut block()).map(|colour| of(colour, 1)))
    }
}

/// Returns the solid part of a drawing with at most `across` voxels on its longer side. Closed outlines are
/// filled if `fill` is set.
pub(super) fn solid(ink: &Mask, across: usize, fill: bool) -> Solid {
    let (ink, surroundings) = without_surroundings(ink);
    let (kept, specks) = without_specks(&ink, across);
    let extent = kept.extent();
    let ink = kept.part(&extent);
    let factor = (ink.longer() / (DETAIL * across)).max(1);
    let ink = ink.reduced(factor);
    let surroundings = (surroundings > 0).then_some(NoteKind::Surroundings {
        left_out: surroundings,
    });
    let specks = (specks > 0).then_some(NoteKind::Specks { left_out: specks });
    let held = held(ink, across, fill);
    let trimmed = held.solid.extent();
    let corner = [0, 1].map(|axis| {
        let pixels = trimmed[axis].start as isize - held.margin as isize;
        extent[axis].start as isize + pixels * factor as isize
    });
    Solid {
        mask: held.solid.part(&trimmed),
        filled: held.filled.part(&trimmed),
        factor,
        corner,
        notes: surroundings.into_iter().chain(specks).collect(),
    }
}

/// Removes what lies along the edge of a picture, if a drawing remains. Returns the number of components that
/// were removed.
fn without_surroundings(ink: &Mask) -> (Mask, usize) {
    let components = ink.components();
    let [width, height] = ink.size;
    let is_much = |at_edge: usize| at_edge as f64 > SURROUNDING * 2.0 * (width + height) as f64;
    let wedges = components
        .list
        .iter()
        .filter(|component| is_wedge(component));
    let (wedges, at_edge) = wedges.fold((0, 0), |(count, sum), wedge| {
        (count + 1, sum + wedge.at_edge)
    });
    // A single wedge may be the ground in the drawing.
    let has_wedges = wedges > 1 && is_much(at_edge);
    let is_along_edge =
        |component: &Component| is_much(component.at_edge) || has_wedges && is_wedge(component);
    if !components.list.iter().any(is_along_edge) {
        return (ink.clone(), 0);
    }
    let is_drawing = |component: &Component| {
        let [columns, rows] = &component.extent;
        let share = (columns.len() * rows.len()) as f64 / (width * height) as f64;
        !is_along_edge(component) && share >= LEAST_DRAWING
    };
    let pen = components.kept(ink.size, is_drawing).stroke_width();
    let thick = THICK * pen.min(WIDEST_PEN * ink.longer() as f64);
    let is_around = |component: &Component| {
        let is_thick = component.area as f64 > thick * component.at_edge as f64;
        is_along_edge(component) && (is_thick || has_wedges && is_wedge(component))
    };
    let around = components
        .list
        .iter()
        .filter(|component| is_around(component))
        .count();
    if around == 0 || !components.list.iter().any(is_drawing) {
        return (ink.clone(), 0);
    }
    let drawing = components.kept(ink.size, |component| !is_around(component));
    (drawing, around)
}

/// Returns whether a component is long and thin, and lies along the edge of the picture.
fn is_wedge(component: &Component) -> bool {
    let [columns, rows] = &component.extent;
    let long = longer(&component.extent) as f64;
    let short = columns.len().min(rows.len()) as f64;
    let is_tapered = component.area as f64 <= WEDGE_AREA * short * long;
    is_tapered && short < WEDGE * long && component.at_edge as f64 >= WEDGE_AT_EDGE * long
}

/// Removes specks. Returns the number of specks.
fn without_specks(ink: &Mask, across: usize) -> (Mask, usize) {
    let components = ink.components();
    let largest = components.list.iter().map(|component| component.area).max();
    let limit = |extent: &Extent| SPECK * (longer(extent) as f64 / across as f64).powi(2);
    // Specks far away make the extent of all ink, and so its voxels, too large. Within the extent of what is
    // large even then, smaller things count.
    let coarse = limit(&ink.extent());
    let is_large =
        |component: &Component| component.area as f64 >= coarse || Some(component.area) == largest;
    let drawing = components.kept(ink.size, is_large).extent();
    let fine = limit(&drawing);
    let is_kept = |component: &Component| {
        let is_inside = (0..2).all(|axis| {
            let (own, all) = (&component.extent[axis], &drawing[axis]);
            own.start < all.end && all.start < own.end
        });
        is_large(component) || is_inside && component.area as f64 >= fine
    };
    let specks = components
        .list
        .iter()
        .filter(|component| !is_kept(component))
        .count();
    (components.kept(ink.size, is_kept), specks)
}

/// Ink that was filled, and then thickened.
struct Held {
    solid: Mask,
    filled: Mask,
    /// Margin around the ink [pixels].
    margin: usize,
}

/// Returns ink with closed outlines filled and thin strokes thickened, so that voxels of which at least half is
/// solid hold together.
fn held(ink: Mask, across: usize, fill: bool) -> Held {
    let voxel = ink.longer() as f64 / across as f64;
    let margin = (2.0 * voxel) as usize + 1;
    let ink = ink.padded(margin);
    // Each pixel becomes a voxel, so no stroke is too thin, but voxels hold together only along edges.
    let keeps_pixels = voxel <= 1.0;
    let filled = match fill {
        true => filled(&ink, if keeps_pixels { 0.0 } else { CLOSED * voxel }),
        false => ink,
    };
    let thicker =
        |solid: Mask, (thin, by): (f64, f64)| thickened(solid, voxel, thin * voxel, by * voxel);
    let solid = match keeps_pixels {
        true => filled.clone().joined(),
        false => THICKENED.into_iter().fold(filled.clone(), thicker),
    };
    Held {
        solid,
        filled,
        margin,
    }
}

/// Returns a mask with its strokes grown by a radius `by`, if a disc of radius `thin` does not fit into them
/// [pixels].
fn thickened(solid: Mask, voxel: f64, thin: f64, by: f64) -> Mask {
    // The discs are larger by a pixel and a half, because discs of pixels do not fit exactly along edges.
    let thick = solid.clone().eroded(thin).dilated(thin + 1.5);
    let strokes = solid.clone().and(&thick.inverted()).components();
    // Corners of thick parts are thin, too, but short.
    let strokes = strokes.kept(solid.size, |component| {
        longer(&component.extent) as f64 > voxel
    });
    solid.or(&strokes.dilated(by))
}

/// Returns ink with everything that the paper around it cannot reach, if gaps of twice `radius` [pixels] are
/// closed.
fn filled(ink: &Mask, radius: f64) -> Mask {
    ink.dilated(radius).outside().inverted().eroded(radius)
}
