//! Grids and guides by which items are placed.

use super::{Item, bounds, existing, items, rounded, union, with_followers};
use fuwafuwa::Vec3;
use fuwafuwa_scenes::Scene;

/// Line at which moved items are aligned.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Guide {
    /// Axis at right angles to the line: 0, 1 or 2.
    pub axis: usize,
    /// Coordinate [m].
    pub at: f32,
}

/// Returns the point of a grid nearest to a position [m]. A grid width that is not positive leaves the position as it is.
pub fn snapped(value: Vec3, grid: f32) -> Vec3 {
    if !(grid > 0.0 && grid.is_finite()) {
        return value;
    }
    let snap = |k: f32| {
        let nearest = (f64::from(k) / f64::from(grid)).round() * f64::from(grid);
        rounded(nearest as f32)
    };
    Vec3::from(value.to_array().map(snap))
}

/// Aligns items that are moved by `by` [m]. On each axis, an edge or the middle of the box around them moves to the nearest
/// line within `reach` [m]. Lines are the edges and middles of other items and of the view, and planes across the axis.
/// Returns the new translation, and the lines to draw.
pub fn aligned(scene: &Scene, moving: &[Item], by: Vec3, reach: f32) -> (Vec3, Vec<Guide>) {
    let moving = with_followers(scene, existing(scene, moving));
    let boxes = moving.iter().filter_map(|item| bounds(scene, *item));
    let hull = boxes.reduce(union);
    let Some([low, high]) = hull.filter(|_| by.is_finite()) else {
        return (by, Vec::new());
    };
    let lines = |axis: usize, [low, high]: [Vec3; 2]| {
        [low[axis], 0.5 * (low[axis] + high[axis]), high[axis]]
    };
    let still = items(scene).into_iter();
    let still = still.filter(|item| !moving.contains(item));
    let still = still.filter(|item| !matches!(item, Item::Joint(_) | Item::Knife(_)));
    let still: Vec<Item> = still.collect();
    let mut boxes: Vec<[Vec3; 2]> = still
        .iter()
        .filter_map(|item| bounds(scene, *item))
        .collect();
    boxes.push(scene.view.map(Vec3::from));
    let (mut by, mut guides) = (by, Vec::new());
    for axis in 0..usize::from(scene.dim.clamp(2, 3)) {
        let own = lines(axis, [low + by, high + by]);
        let others = boxes.iter().flat_map(|other| lines(axis, *other));
        let others = others.chain(planes(scene, axis));
        let pairs = others.flat_map(|other| own.map(|own| (other - own, other)));
        let near = pairs.filter(|(apart, _)| apart.abs() <= reach);
        if let Some((apart, at)) = near.min_by(|a, b| a.0.abs().total_cmp(&b.0.abs())) {
            by[axis] += apart;
            guides.push(Guide { axis, at });
        }
    }
    (by, guides)
}

/// Returns the coordinates of the planes across an axis.
fn planes(scene: &Scene, axis: usize) -> impl Iterator<Item = f32> {
    let planes = scene
        .obstacle
        .iter()
        .filter_map(|text| text.half_space.as_ref());
    let across = planes.filter(move |plane| {
        let mut others = (0..3).filter(|other| *other != axis);
        plane.normal[axis] != 0.0 && others.all(|other| plane.normal[other] == 0.0)
    });
    across.map(move |plane| plane.point[axis])
}

/// Numbers of places on each axis that [`free_place`] compares; in 2D without the third.
const PLACES: [usize; 3] = [7, 5, 3];

/// Distance from all items beyond which a place has enough room [m], in 2D and 3D. In 3D, places near the middle are seen best.
const ENOUGH: [f32; 2] = [10.0, 0.35];

/// Returns the place in the view that is farthest from all items [m], for a new one. Of places that are far enough, it is the
/// one nearest to the middle.
pub fn free_place(scene: &Scene) -> Vec3 {
    let boxes: Vec<[Vec3; 2]> = super::items(scene)
        .into_iter()
        .filter_map(|item| bounds(scene, item))
        .collect();
    let [low, high] = scene.view.map(Vec3::from);
    let middle = 0.5 * (low + high);
    let axes = usize::from(scene.dim.clamp(2, 3));
    let count = |axis: usize| if axis < axes { PLACES[axis] } else { 1 };
    let mut best = (f32::NEG_INFINITY, middle);
    for k in 0..count(0) * count(1) * count(2) {
        let index = [
            k % count(0),
            k / count(0) % count(1),
            k / (count(0) * count(1)),
        ];
        let at = Vec3::from([0, 1, 2].map(|axis: usize| {
            let share = (index[axis] as f32 + 0.5) / count(axis) as f32;
            low[axis] + share * (high[axis] - low[axis])
        }));
        let away = |[low, high]: &[Vec3; 2]| (at - at.clamp(*low, *high)).length();
        let nearest = boxes.iter().map(away).fold(f32::INFINITY, f32::min);
        let enough = ENOUGH[usize::from(axes == 3)];
        let worth = nearest.min(enough) - 0.01 * (at - middle).length();
        if worth > best.0 {
            best = (worth, at);
        }
    }
    best.1
}
