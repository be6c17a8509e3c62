//! Path of a crack in a continuum, as the reference of the check of crack paths.
//!
//! The displacement discontinuity method [Crouch 1976; Crouch and Starfield 1983, ch. 5] solves for the opening and the
//! sliding of straight elements along the crack and along the two free sides of a strip in tension. The crack grows in
//! small steps in the direction of maximal hoop stress [Erdogan and Sih 1963] of the stress intensities at its tip. There
//! is no lattice and no mesh of the interior, so the path has no preferred direction.

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
}
