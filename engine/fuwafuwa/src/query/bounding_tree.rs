//! Bounding-volume hierarchy for queries.

use crate::rigid_body::shape::{Bounds, Vector};
use std::ops::Range;

/// Maximum number of boxes in a leaf. Smaller leaves make queries faster and construction slower. The tree is
/// built for each `Queries`, so 4 suits a small number of queries.
const LEAF: usize = 4;

/// Relative margin of a box around its content: ten times the tolerance of the primitives.
const LITTLE: f32 = 1e-3;

/// Bounding-volume hierarchy over boxes, which are known by their index in a list.
#[derive(Clone, Debug, Default)]
pub struct Tree {
    knots: Vec<Knot>,
    /// Indices of the list, in the order of the leaves.
    places: Vec<u32>,
}

#[derive(Clone, Debug)]
struct Knot {
    bounds: Bounds,
    /// Range of `places` in a leaf; empty for an inner node.
    leaf: Range<u32>,
    /// Children of an inner node.
    parts: [u32; 2],
}

impl Tree {
    /// Builds the hierarchy over boxes.
    pub fn new(boxes: &[Bounds]) -> Self {
        let mut tree = Self {
            knots: Vec::new(),
            places: (0..boxes.len() as u32).collect(),
        };
        if !boxes.is_empty() {
            tree.grow(boxes, 0..boxes.len());
        }
        tree
    }

    /// Adds a node over a range of `places`; returns its index.
    fn grow(&mut self, boxes: &[Bounds], range: Range<usize>) -> u32 {
        let places = &mut self.places[range.clone()];
        let bounds = { places.iter() }.map(|&place| boxes[place as usize]);
        let bounds = bounds.reduce(around).expect("ranges are not empty");
        let knot = self.knots.len() as u32;
        self.knots.push(Knot {
            bounds,
            leaf: 0..0,
            parts: [0; 2],
        });
        if range.len() <= LEAF {
            self.knots[knot as usize].leaf = range.start as u32..range.end as u32;
            return knot;
        }
        let extent = |axis: usize| bounds[1][axis] - bounds[0][axis];
        let axis = (0..3).fold(0, |most, axis| {
            if extent(axis) > extent(most) {
                axis
            } else {
                most
            }
        });
        let middle = |place: &u32| {
            let [low, high] = boxes[*place as usize];
            low[axis] + high[axis]
        };
        let half = range.len() / 2;
        places.select_nth_unstable_by(half, |a, b| middle(a).total_cmp(&middle(b)).then(a.cmp(b)));
        let half = range.start + half;
        let parts = [range.start..half, half..range.end].map(|part| self.grow(boxes, part));
        self.knots[knot as usize].parts = parts;
        knot
    }

    /// Visits the boxes with a cost below the smallest one found before. That limit begins at `least`.
    /// `cost` must not be larger for a box than for its content. `look` receives the index of a box and
    /// returns the cost of its content.
    pub fn search(
        &self,
        mut least: f32,
        cost: impl Fn(&Bounds) -> f32,
        mut look: impl FnMut(usize) -> f32,
    ) {
        let Some(root) = self.knots.first() else {
            return;
        };
        let mut stack = vec![(0, cost(&root.bounds))];
        while let Some((knot, at_least)) = stack.pop() {
            // False if `at_least` is NaN.
            if at_least < least {
                let Knot { leaf, parts, .. } = &self.knots[knot as usize];
                for place in leaf.clone() {
                    least = least.min(look(self.places[place as usize] as usize));
                }
                if leaf.is_empty() {
                    let mut parts =
                        parts.map(|part| (part, cost(&self.knots[part as usize].bounds)));
                    // The last one on the stack is visited first.
                    parts.sort_by(|a, b| b.1.total_cmp(&a.1));
                    stack.extend(parts);
                }
            }
        }
    }
}

/// Returns the box around two boxes.
pub fn around([a, b]: Bounds, [c, d]: Bounds) -> Bounds {
    let low = [0, 1, 2].map(|axis: usize| a[axis].min(c[axis]));
    let high = [0, 1, 2].map(|axis: usize| b[axis].max(d[axis]));
    [low.into(), high.into()]
}

/// Returns the box around points, with a margin against rounding.
pub fn around_all(points: impl IntoIterator<Item = Vector>) -> Bounds {
    let nothing = [f32::INFINITY, f32::NEG_INFINITY].map(Vector::splat);
    let points = points.into_iter();
    let [low, high] = points.fold(nothing, |bounds, at| around(bounds, [at, at]));
    let widths = (high - low).to_array();
    let little = Vector::splat(LITTLE * widths.into_iter().fold(0.0, f32::max));
    [low - little, high + little]
}

/// Returns the distance of a point from a box [m]; 0 inside.
pub fn distance_from([low, high]: &Bounds, at: Vector) -> f32 {
    let beyond = |axis: usize| (low[axis] - at[axis]).max(at[axis] - high[axis]).max(0.0);
    Vector::from([0, 1, 2].map(beyond)).length()
}

/// Returns the distance along a ray to the entry into a box, in multiples of the direction; infinite if the
/// ray misses the box.
pub fn entry([low, high]: &Bounds, from: Vector, direction: Vector) -> f32 {
    let (mut first, mut last) = (0.0f32, f32::INFINITY);
    for axis in 0..3 {
        if direction[axis] == 0.0 {
            if from[axis] < low[axis] || from[axis] > high[axis] {
                return f32::INFINITY;
            }
            continue;
        }
        let [one, other] = [low, high].map(|corner| (corner[axis] - from[axis]) / direction[axis]);
        first = first.max(one.min(other));
        last = last.min(one.max(other));
    }
    if first <= last { first } else { f32::INFINITY }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn search_finds_the_nearest_box_in_few_visits() {
        let places: Vec<Vector> = (0..500)
            .map(|k| {
                let at = |step: usize| (k * step % 101) as f32;
                Vector::new(at(37), at(53), at(71))
            })
            .collect();
        let boxes: Vec<Bounds> = places.iter().map(|&at| [at, at]).collect();
        let tree = Tree::new(&boxes);
        for goal in [
            Vector::ZERO,
            Vector::new(50.0, 20.0, 90.0),
            Vector::new(-7.0, 300.0, 3.0),
        ] {
            let (mut best, mut looked) = (f32::INFINITY, 0);
            tree.search(
                f32::INFINITY,
                |bounds| distance_from(bounds, goal),
                |place| {
                    looked += 1;
                    best = best.min(distance_from(&boxes[place], goal));
                    best
                },
            );
            let all = boxes.iter().map(|bounds| distance_from(bounds, goal));
            assert_eq!(best, all.fold(f32::INFINITY, f32::min));
            assert!(looked < 100, "{looked}");
        }
        Tree::new(&[]).search(
            1.0,
            |_| 0.0,
            |_| panic!("an empty tree has no boxes to visit"),
        );
    }

    #[test]
    fn entry_returns_distance_or_infinity() {
        let bounds = [Vector::new(1.0, -1.0, 0.0), Vector::new(2.0, 1.0, 0.0)];
        assert_eq!(entry(&bounds, Vector::ZERO, Vector::X), 1.0);
        assert_eq!(entry(&bounds, Vector::new(1.5, 0.0, 0.0), Vector::Y), 0.0);
        assert_eq!(entry(&bounds, Vector::ZERO, Vector::NEG_X), f32::INFINITY);
        assert_eq!(
            entry(&bounds, Vector::new(0.0, 2.0, 0.0), Vector::X),
            f32::INFINITY
        );
    }
}
