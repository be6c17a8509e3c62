//! Outlines of voxels as soft curves: the stairs go, what was torn keeps its edge.
//!
//! ```text
//!     ┌──┐              ╭─╮
//!  ┌──┘  └──┐   →    ╭──╯ ╰──╮      old skin: many rounds, a smooth curve
//!  │        │        │       │
//!  └─┐ ┌─┐ ┌┘        └╮ ╭╮ ╭─┘      torn: a round or two, and corners where it meets old skin
//!    └─┘ └─┘          ╰─╯╰─╯
//! ```
//!
//! First [`smoothed`] moves each point of an outline a little, then [`rounded`] lays a curve through
//! them. A round of the former is a step towards the mean of two neighbours and a slightly larger
//! one away from it, which flattens what is short and leaves alone what is long [Taubin 1995]. The
//! neighbours are the next ones at first and then ever farther ones, because the flat runs in the
//! outline of a disc grow with the root of its size, and one reach would need thousands of rounds.
//!
//! Both use + − × ÷ √ in a fixed order only: the same outline has the same curve everywhere.

use fuwafuwa::shape::Vector;
use fuwafuwa::vector::{length, minus, plus, scaled};

/// Rounds for old skin at each reach, and for torn skin at the first: a child shall see what tore.
const ROUNDS: usize = 5;
const TORN_ROUNDS: usize = 2;
/// Rounds at the end, over the kinks that [`FARTHEST`] leaves.
const LAST_ROUNDS: usize = 2;
/// The step towards the mean of the neighbours. At a half, stairs of one voxel go in one step.
const INWARDS: f32 = 0.5;
/// The step back.
const OUTWARDS: f32 = -0.51;
/// The farthest neighbours are as many points away as the root of their number, divided by this.
const REACH: f32 = 3.0;
/// How far a point may go, in lengths of a segment: about voxels, whether they are squashed just
/// there or not. With less the flat runs of a disc leave kinks, with more small parts lose their
/// shape.
const FARTHEST: f32 = 0.8;
/// An outline with no more points than this is a crumb, round all over.
const CRUMB: usize = 12;
/// Points of the curve around each point of the outline.
const STEPS: usize = 4;

/// A closed line with the body to its left.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Curve {
    /// [m]
    pub points: Vec<Vector>,
    /// Whether the segment from each point to the next was inside before the body tore.
    pub is_fresh: Vec<bool>,
}

/// The points [m] of a closed outline, each moved by about a voxel at most so that stairs go.
///
/// `is_fresh` tells of the segment from each point to the next whether it is torn. A point between
/// a torn segment and one that is not stays where it is, unless the outline is a crumb's.
///
/// # Panics
/// When there is not one flag for each point.
pub fn smoothed(points: &[Vector], is_fresh: &[bool]) -> Vec<Vector> {
    let count = points.len();
    assert_eq!(count, is_fresh.len(), "a flag for each point");
    let skins = skins(is_fresh);
    let mut places = points.to_vec();
    // On eight points or less a round would leave hardly anything.
    let farthest = ((count as f32).sqrt() / REACH)
        .round()
        .min((count / 8) as f32) as usize;
    for reach in 1..=farthest {
        for round in 0..ROUNDS {
            let torn = usize::from(reach == 1 && round < TORN_ROUNDS);
            smooth_once(&mut places, &skins, reach, torn);
        }
    }
    let sides = (0..count).map(|k| length(minus(points[after(k, count)], points[k])));
    let most = FARTHEST * sides.sum::<f32>() / count as f32;
    for k in 0..count {
        let way = minus(places[k], points[k]);
        let far = length(way);
        if far > most {
            places[k] = plus(points[k], scaled(way, most / far));
        }
    }
    if farthest > 0 {
        for _ in 0..LAST_ROUNDS {
            smooth_once(&mut places, &skins, 1, 0);
        }
    }
    places
}

/// One round: old skin at a reach, but never across a corner, and torn skin at its own, 0 = not.
fn smooth_once(places: &mut [Vector], skins: &[Skin], reach: usize, torn: usize) {
    let count = places.len();
    for step in [INWARDS, OUTWARDS] {
        let old = places.to_vec();
        for k in 0..count {
            let reach = match skins[k] {
                Skin::Corner => 0,
                Skin::Torn => torn,
                Skin::Old { from_corner } => reach.min(from_corner),
            };
            let mean = middle(old[(k + count - reach) % count], old[(k + reach) % count]);
            places[k] = plus(old[k], scaled(minus(mean, old[k]), step));
        }
    }
}

/// The soft curve of a closed outline [m], of the same area.
///
/// Around each smoothed point runs a parabola, from the middle of one segment to that of the next;
/// corners stay.
///
/// # Panics
/// When there is not one flag for each point.
pub fn rounded(points: &[Vector], is_fresh: &[bool]) -> Curve {
    let places = smoothed(points, is_fresh);
    let count = places.len();
    let mut curve = Curve::default();
    for k in 0..count {
        let (last, next) = (before(k, count), after(k, count));
        let [from, to] = [last, next].map(|other| middle(places[k], places[other]));
        for step in 0..STEPS {
            let is_late = 2 * step >= STEPS;
            let t = step as f32 / STEPS as f32;
            curve.points.push(if is_corner(is_fresh, k) {
                let (start, end, t) = if is_late {
                    (places[k], to, 2.0 * t - 1.0)
                } else {
                    (from, places[k], 2.0 * t)
                };
                plus(scaled(start, 1.0 - t), scaled(end, t))
            } else {
                let (a, b) = (between(from, places[k], t), between(places[k], to, t));
                between(a, b, t)
            });
            curve
                .is_fresh
                .push(is_fresh[if is_late { k } else { last }]);
        }
    }
    give_back(&mut curve.points, area(points));
    curve
}

/// The area that a closed line runs around [m²]: negative when it runs clockwise.
pub fn area(points: &[Vector]) -> f32 {
    let count = points.len();
    // From the first point, so that places far from the origin cost no digits.
    let reach = |k: usize| minus(points[k], points[0]);
    let double: f32 = (0..count)
        .map(|k| (reach(k), reach(after(k, count))))
        .map(|(a, b)| a[0] * b[1] - a[1] * b[0])
        .sum();
    0.5 * double
}

/// Moves a line sideways, everywhere as far, until its area is as wanted, or nearly.
fn give_back(points: &mut [Vector], wanted: f32) {
    let count = points.len();
    let along = |k: usize, points: &[Vector]| minus(points[after(k, count)], points[k]);
    let whole: f32 = (0..count).map(|k| length(along(k, points))).sum();
    if whole <= 0.0 {
        return;
    }
    let mean = whole / count as f32 * STEPS as f32;
    let lost = ((wanted - area(points)) / whole).clamp(-0.5 * mean, 0.5 * mean);
    let old = points.to_vec();
    for k in 0..count {
        let way = minus(old[after(k, count)], old[before(k, count)]);
        let outwards = [way[1], -way[0], 0.0];
        let far = length(outwards);
        if far > 0.0 {
            points[k] = plus(old[k], scaled(outwards, lost / far));
        }
    }
}

/// What a point of an outline lies on.
#[derive(Copy, Clone)]
enum Skin {
    /// Where torn skin meets old skin.
    Corner,
    /// Between torn segments.
    Torn,
    /// Between old ones, so many points away from the next corner.
    Old { from_corner: usize },
}

fn skins(is_fresh: &[bool]) -> Vec<Skin> {
    let count = is_fresh.len();
    // How far it is to the last corner, going round twice so that it is known from the first on.
    let run = |order: &mut dyn Iterator<Item = usize>| {
        let (mut far, mut distances) = (count, vec![count; count]);
        for k in order {
            far = if is_corner(is_fresh, k) { 0 } else { far + 1 };
            distances[k] = far;
        }
        distances
    };
    let onwards = run(&mut (0..2 * count).map(|k| k % count));
    let backwards = run(&mut (0..2 * count).rev().map(|k| k % count));
    let skin = |k: usize| match onwards[k].min(backwards[k]) {
        0 => Skin::Corner,
        _ if count > CRUMB && is_fresh[k] => Skin::Torn,
        from_corner => Skin::Old { from_corner },
    };
    (0..count).map(skin).collect()
}

/// Whether torn skin meets old skin at a point.
fn is_corner(is_fresh: &[bool], k: usize) -> bool {
    let count = is_fresh.len();
    count > CRUMB && is_fresh[k] != is_fresh[before(k, count)]
}

fn before(k: usize, count: usize) -> usize {
    (k + count - 1) % count
}

fn after(k: usize, count: usize) -> usize {
    (k + 1) % count
}

fn middle(a: Vector, b: Vector) -> Vector {
    between(a, b, 0.5)
}

fn between(a: Vector, b: Vector, t: f32) -> Vector {
    plus(scaled(a, 1.0 - t), scaled(b, t))
}

#[cfg(test)]
mod tests {
    use super::*;
    use fuwafuwa::vector::cross;
    use fuwafuwa::{Body, Dim2, Material, Outline, VoxelGrid};

    fn outline(grid: VoxelGrid<Dim2>) -> Outline {
        let body = Body::new(grid, &[Material::default()]).unwrap();
        let mut outlines = body.outlines();
        assert_eq!(outlines.len(), 1);
        outlines.remove(0)
    }

    fn curve(line: &Outline) -> Curve {
        rounded(&line.points, &line.is_fresh)
    }

    /// How many pairs of segments of a closed line cross.
    fn crossings(points: &[Vector]) -> usize {
        let count = points.len();
        let side = |a: Vector, b: Vector, c: Vector| cross(minus(b, a), minus(c, a))[2];
        let ends = |k: usize| [points[k], points[after(k, count)]];
        let crosses = |i: usize, j: usize| {
            let ([a, b], [c, d]) = (ends(i), ends(j));
            side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0
        };
        (0..count)
            .map(|i| (i + 2..count).filter(|&j| crosses(i, j)).count())
            .sum()
    }

    fn check_disc(n: usize) {
        let line = outline(VoxelGrid::ball(n, 1.0).unwrap());
        let sum = line.points.iter().fold([0.0; 3], |sum, &at| plus(sum, at));
        let centre = scaled(sum, 1.0 / line.points.len() as f32);
        let radius = (area(&line.points) / std::f32::consts::PI).sqrt();
        let curve = curve(&line);
        let off = |at: &Vector| (length(minus(*at, centre)) - radius).abs() * n as f32;
        let most = curve.points.iter().map(off).fold(0.0, f32::max);
        assert!(most < 0.25, "n = {n}: {most} voxels off the circle");
    }

    #[test]
    fn a_disc_becomes_a_circle() {
        [24, 32, 48, 64, 80, 100].into_iter().for_each(check_disc);
    }

    #[test]
    fn area_is_kept_and_no_crossing_made() {
        let shapes = [VoxelGrid::ball, VoxelGrid::heart, VoxelGrid::flower];
        for (which, shape) in shapes.into_iter().enumerate() {
            for n in [12, 24, 64] {
                let line = outline(shape(n, 1.0).unwrap());
                let curve = curve(&line);
                let kept = area(&curve.points) / area(&line.points);
                assert!((kept - 1.0).abs() < 0.02, "{which}, n = {n}: {kept}");
                assert_eq!(crossings(&curve.points), 0, "{which}, n = {n}");
            }
        }
    }

    #[test]
    fn a_part_as_thin_as_a_voxel_does_not_cross_itself() {
        // A block with a whisker that goes round two corners.
        let grid = VoxelGrid::from_fn([20, 20, 1], 1.0, |[x, y, _]| {
            let is_block = x < 6 && y < 6;
            let is_whisker = (y == 3 && x < 16) || (x == 15 && (3..18).contains(&y));
            let is_stair = (y == x || y == x + 1) && x < 14;
            u8::from(is_block || is_whisker || is_stair)
        });
        let line = outline(grid.unwrap());
        assert_eq!(crossings(&curve(&line).points), 0);
    }

    #[test]
    fn a_crumb_becomes_a_blob_of_its_size() {
        let corners = [[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        let blob = rounded(&corners, &[true, true, false, true]);
        assert!((area(&blob.points) - 1.0).abs() < 0.01);
        let far = |at: &Vector| length(minus(*at, [0.5, 0.5, 0.0]));
        let (least, most) =
            (blob.points.iter().map(far)).fold((9.0f32, 0.0f32), |(a, b), k| (a.min(k), b.max(k)));
        assert!(
            least > 0.5 && most < 0.62,
            "from {least} to {most}: nearly a circle"
        );
    }

    #[test]
    fn where_torn_meets_old_skin_a_corner_stays() {
        // The upper half of a disc, its lower side torn.
        let line = outline(VoxelGrid::ball(64, 1.0).unwrap());
        let is_above = |at: &Vector| at[1] > 0.5;
        let count = line.points.len();
        let upper: Vec<usize> = (0..count).filter(|&k| is_above(&line.points[k])).collect();
        let start = upper
            .iter()
            .position(|&k| !is_above(&line.points[before(k, count)]));
        let start = upper[start.unwrap()];
        let arc: Vec<Vector> = (0..upper.len())
            .map(|k| line.points[(start + k) % count])
            .collect();
        let (right, left) = (arc[0], arc[arc.len() - 1]);
        let side = (1..62).map(|k| between(left, right, k as f32 / 62.0));
        let points: Vec<Vector> = arc.iter().copied().chain(side).collect();
        let is_fresh: Vec<bool> = (0..points.len()).map(|k| k + 1 >= arc.len()).collect();
        let places = smoothed(&points, &is_fresh);
        assert_eq!((places[0], places[arc.len() - 1]), (right, left));
        let curve = rounded(&points, &is_fresh);
        assert!(crossings(&curve.points) == 0 && curve.is_fresh.contains(&false));
        let near = |corner| {
            curve
                .points
                .iter()
                .any(|&at| length(minus(at, corner)) < 0.002)
        };
        assert!(
            near(right) && near(left),
            "an eighth of a voxel away at most"
        );
    }

    #[test]
    fn what_is_no_outline_stays_what_it_is() {
        for count in 0..3 {
            let points = vec![[1.0, 2.0, 0.0]; count];
            let curve = rounded(&points, &vec![true; count]);
            assert!(curve.points.iter().all(|&at| at == [1.0, 2.0, 0.0]));
        }
    }
}
