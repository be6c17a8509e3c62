//! Cracks and slots in a continuum, as references of the checks of crack paths and of blunt slots.
//!
//! The displacement discontinuity method [Crouch 1976; Crouch and Starfield 1983, ch. 5] solves for the opening and the
//! sliding of straight elements along the crack and along the two free sides of a strip in tension. The crack grows in
//! small steps in the direction of maximal hoop stress [Erdogan and Sih 1963] of the stress intensities at its tip. There
//! is no lattice and no mesh of the interior, so the path has no preferred direction, and the end of a slot is round.

use anyhow::{Context, Result};
use std::f64::consts::PI;

/// Length of an element of the crack, and of a step of its growth [m].
const STEP: f64 = 0.008;
/// Length of an element of the sides [m].
const SIDE_STEP: f64 = 0.02;
/// Half length of the sides [m]. The crack does not disturb the stress farther away.
const SIDE: f64 = 0.6;

/// Straight element with constant displacement discontinuities.
#[derive(Copy, Clone, Debug)]
struct Element {
    middle: [f64; 2],
    /// Unit vector along the element.
    along: [f64; 2],
    half: f64,
}

impl Element {
    fn between(from: [f64; 2], to: [f64; 2]) -> Self {
        let [x, y] = [to[0] - from[0], to[1] - from[1]];
        let length = x.hypot(y);
        Self {
            middle: [0.5 * (from[0] + to[0]), 0.5 * (from[1] + to[1])],
            along: [x / length, y / length],
            half: 0.5 * length,
        }
    }

    fn normal(&self) -> [f64; 2] {
        [-self.along[1], self.along[0]]
    }

    /// Returns the stress [xx, yy, xy] at a point, in axes along the element, for a sliding and for an overlap of its
    /// faces of 1, with E' = 1.
    fn stress(&self, at: [f64; 2]) -> [[f64; 3]; 2] {
        let reach = [at[0] - self.middle[0], at[1] - self.middle[1]];
        let (x, y) = (dot(reach, self.along), dot(reach, self.normal()));
        let (near, far) = (x - self.half, x + self.half);
        let [r, s] = [near, far].map(|k| k * k + y * y);
        let c = 1.0 / (4.0 * PI);
        // Derivatives of the potential f.
        let xy = c * (y / r - y / s);
        let yy = -c * (near / r - far / s);
        let xyy = c * ((near * near - y * y) / (r * r) - (far * far - y * y) / (s * s));
        let yyy = 2.0 * c * y * (near / (r * r) - far / (s * s));
        [
            [2.0 * xy + y * xyy, -y * xyy, yy + y * yyy],
            [yy + y * yyy, yy - y * yyy, -y * xyy],
        ]
    }

    /// Returns the normal and the shear stress on this element for a sliding and for an overlap of 1 of another.
    fn tractions(&self, other: &Self) -> [[f64; 2]; 2] {
        let normal = [
            dot(self.normal(), other.along),
            dot(self.normal(), other.normal()),
        ];
        let along = [
            dot(self.along, other.along),
            dot(self.along, other.normal()),
        ];
        other.stress(self.middle).map(|[xx, yy, xy]| {
            let pull = [
                xx * normal[0] + xy * normal[1],
                xy * normal[0] + yy * normal[1],
            ];
            [dot(pull, normal), dot(pull, along)]
        })
    }
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// Returns the angle by which a crack turns under K_II / K_I by maximal hoop stress [rad].
pub fn kink(ratio: f64) -> f64 {
    if ratio.abs() < 1e-9 {
        return -2.0 * ratio;
    }
    2.0 * ((1.0 - (1.0 + 8.0 * ratio * ratio).sqrt()) / (4.0 * ratio)).atan()
}

/// Returns the path of the right tip of a centre crack with a half length [m] and an angle to the horizontal [°], in a strip
/// of a width [m] under vertical tension, up to a horizontal coordinate `end` [m]. The first point is the tip of the crack.
pub fn path(half: f64, angle: f64, width: f64, end: f64) -> Result<Vec<[f64; 2]>> {
    let (sine, cosine) = angle.to_radians().sin_cos();
    let count = (half / STEP).round();
    let start: Vec<[f64; 2]> = (0..=count as usize)
        .map(|k| [cosine, sine].map(|share| share * half * k as f64 / count))
        .collect();
    let mut points = start.clone();
    while points[points.len() - 1][0] < end {
        let ratio = shear_ratio(&points, width)?;
        let [from, to] = [points[points.len() - 2], points[points.len() - 1]];
        let direction = (to[1] - from[1]).atan2(to[0] - from[0]) + kink(ratio);
        let (sine, cosine) = direction.sin_cos();
        points.push([to[0] + STEP * cosine, to[1] + STEP * sine]);
    }
    Ok(points.split_off(start.len() - 1))
}

/// Returns K_II / K_I at the right tip of a crack that is symmetric about the origin. `points` is its right half.
fn shear_ratio(points: &[[f64; 2]], width: f64) -> Result<f64> {
    let moved = solve(&elements(points, width))?;
    let tip = points.len() - 2;
    Ok(moved[2 * tip] / moved[2 * tip + 1])
}

/// Returns the elements of the right half of the crack, then of its left half, then of the sides.
fn elements(points: &[[f64; 2]], width: f64) -> Vec<Element> {
    let right = points
        .windows(2)
        .map(|ends| Element::between(ends[0], ends[1]));
    let mirrored = |at: [f64; 2]| [-at[0], -at[1]];
    let left =
        { points.windows(2) }.map(|ends| Element::between(mirrored(ends[1]), mirrored(ends[0])));
    let mut all: Vec<Element> = right.chain(left).collect();
    let count = (2.0 * SIDE / SIDE_STEP).round() as i32;
    for x in [-0.5 * width, 0.5 * width] {
        for k in 0..count {
            let y = |k: i32| -SIDE + f64::from(k) * SIDE_STEP;
            all.push(Element::between([x, y(k)], [x, y(k + 1)]));
        }
    }
    all
}

/// Returns the sliding and the overlap of every element that leave it free of stress under a vertical tension of 1.
fn solve(elements: &[Element]) -> Result<Vec<f64>> {
    let count = 2 * elements.len();
    let mut rows = Vec::with_capacity(count);
    for one in elements {
        let (normal, along) = (one.normal(), one.along);
        // Columns of the unknowns, and the right-hand side.
        let mut pair = [Vec::with_capacity(count + 1), Vec::with_capacity(count + 1)];
        for other in elements {
            for stress in one.tractions(other) {
                pair[0].push(stress[0]);
                pair[1].push(stress[1]);
            }
        }
        pair[0].push(-normal[1] * normal[1]);
        pair[1].push(-normal[1] * along[1]);
        rows.extend(pair);
    }
    // Gaussian elimination with partial pivoting.
    for pivot in 0..count {
        let best = { pivot..count }
            .max_by(|&a, &b| rows[a][pivot].abs().total_cmp(&rows[b][pivot].abs()))
            .context("the system has rows")?;
        rows.swap(pivot, best);
        let (done, rest) = rows.split_at_mut(pivot + 1);
        let top = &done[pivot];
        for row in rest {
            let share = row[pivot] / top[pivot];
            if share != 0.0 {
                for (value, top) in row[pivot..].iter_mut().zip(&top[pivot..]) {
                    *value -= share * top;
                }
            }
        }
    }
    let mut found = vec![0.0; count];
    for pivot in (0..count).rev() {
        let known: f64 = (pivot + 1..count).map(|k| rows[pivot][k] * found[k]).sum();
        found[pivot] = (rows[pivot][count] - known) / rows[pivot][pivot];
    }
    Ok(found)
}

/// Number of elements of the half circle at the end of a slot. It is odd, so that the root is in the middle of one.
const ARC: usize = 241;
/// Length of an element of the edges of a slot, and of the crack with which the slot is compared [m].
const FINE_STEP: f64 = 0.005;
/// Number of points over which the tension before a slot is averaged.
const SAMPLES: usize = 16;

/// Returns the mean vertical tension over a distance before the root of a slot [m], relative to the stress intensity of a
/// crack as deep as the slot [1/√m]. Both start from the left side of a strip of a width [m] under vertical tension.
pub fn slot_tension(depth: f64, radius: f64, width: f64, distance: f64) -> Result<f64> {
    let (edge, side) = (-0.5 * width, 1.2 * width);
    let right = line([-edge, -side], [-edge, side], SIDE_STEP);
    // The slot, from below.
    let middle = edge + depth - radius;
    let arc: Vec<[f64; 2]> = (0..=ARC)
        .map(|k| {
            let (sine, cosine) = (PI * (k as f64 / ARC as f64 - 0.5)).sin_cos();
            [middle + radius * cosine, radius * sine]
        })
        .collect();
    let parts = [
        line([edge, -side], [edge, -radius], SIDE_STEP),
        line([edge, -radius], [middle, -radius], FINE_STEP),
        arc.windows(2)
            .map(|ends| Element::between(ends[0], ends[1]))
            .collect(),
        line([middle, radius], [edge, radius], FINE_STEP),
        line([edge, radius], [edge, side], SIDE_STEP),
        right.clone(),
    ];
    let slot = parts.concat();
    let moved = solve(&slot)?;
    let at = |k: usize| (k as f64 + 0.5) / SAMPLES as f64 * distance;
    let tensions = (0..SAMPLES).map(|k| tension(&slot, &moved, [edge + depth + at(k), 0.0]));
    let mean = tensions.sum::<f64>() / SAMPLES as f64;
    // The stress intensity is proportional to the opening of the last element before the tip. That of a crack in an
    // infinite plane is known.
    let crack = line([edge, 0.0], [edge + depth, 0.0], FINE_STEP);
    let last = crack.len() - 1;
    let halves = [[edge, -side], [edge, 0.0], [edge, side]];
    let left = halves
        .windows(2)
        .map(|ends| line(ends[0], ends[1], SIDE_STEP))
        .collect::<Vec<_>>();
    let opening = solve(&[crack, left.concat(), right].concat())?[2 * last + 1];
    let half = 20.0 * FINE_STEP;
    let known = line([-half, 0.0], [half, 0.0], FINE_STEP);
    let known_opening = solve(&known)?[2 * known.len() - 1];
    let intensity = (PI * half).sqrt() * opening / known_opening;
    Ok(mean / intensity)
}

/// Returns elements of about the same length [m] along a line.
fn line(from: [f64; 2], to: [f64; 2], step: f64) -> Vec<Element> {
    let count = ((to[0] - from[0]).hypot(to[1] - from[1]) / step)
        .round()
        .max(1.0);
    let at = |k: usize| {
        let share = k as f64 / count;
        [0, 1].map(|axis| from[axis] + share * (to[axis] - from[axis]))
    };
    (0..count as usize)
        .map(|k| Element::between(at(k), at(k + 1)))
        .collect()
}

/// Returns the vertical tension at a point under a distant vertical tension of 1.
fn tension(elements: &[Element], moved: &[f64], at: [f64; 2]) -> f64 {
    let parts = elements
        .iter()
        .zip(moved.chunks_exact(2))
        .map(|(element, moved)| {
            let (along, normal) = (element.along[1], element.normal()[1]);
            let stresses = element.stress(at).into_iter().zip(moved);
            stresses
                .map(|([xx, yy, xy], moved)| {
                    moved * (xx * along * along + yy * normal * normal + 2.0 * xy * along * normal)
                })
                .sum::<f64>()
        });
    1.0 + parts.sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn opening_of_a_crack_matches_the_ellipse_of_griffith() {
        let points: Vec<[f64; 2]> = (0..=20).map(|k| [0.005 * f64::from(k), 0.0]).collect();
        // Sides that are far away.
        let moved = solve(&elements(&points, 20.0)).unwrap();
        let opening = -moved[1];
        assert!((opening / 0.4 - 1.0).abs() < 0.04, "{opening}");
    }

    #[test]
    fn first_step_of_an_oblique_crack_kinks_as_in_an_infinite_plane() {
        for angle in [15.0, 30.0, 45.0f64] {
            let points = path(0.08, angle, 20.0, 0.082).unwrap();
            let way = (points[1][1] - points[0][1]).atan2(points[1][0] - points[0][0]);
            let wanted = angle + kink(angle.to_radians().tan()).to_degrees();
            assert!(
                (way.to_degrees() - wanted).abs() < 2.0,
                "{angle}: {way} {wanted}"
            );
        }
    }

    #[test]
    fn kink_of_pure_shear_is_that_of_erdogan_and_sih() {
        assert!((kink(1e9).to_degrees() + 70.53).abs() < 0.01);
    }

    #[test]
    fn tension_before_a_crack_matches_westergaard() {
        let crack = line([-0.1, 0.0], [0.1, 0.0], 0.002);
        let moved = solve(&crack).unwrap();
        let at = 0.12f64;
        let exact = at / (at * at - 0.01).sqrt();
        let found = tension(&crack, &moved, [at, 0.0]);
        assert!((found / exact - 1.0).abs() < 0.02, "{found} {exact}");
    }
}
