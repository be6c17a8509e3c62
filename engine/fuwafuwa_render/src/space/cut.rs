//! Cut planes of the pieces of a body for the element view.

use super::camera::Cut;
use crate::anchor::columns;
use fuwafuwa::{Dim3, SoftBody};
use glam::{Mat3, Vec3};

/// Minimum gain of the cosine between cut direction and cut axis for which the cut changes to another axis.
/// Prevents flickering when a piece trembles.
const BETTER: f32 = 0.15;
/// Minimum width of a piece that is cut [voxels]. Thinner pieces stay whole.
const THIN: f32 = 6.0;

/// Cut plane of a piece, in the rest frame of its body [voxels].
#[derive(Copy, Clone, Debug)]
pub struct Plane {
    /// Axis normal to the plane.
    pub axis: usize,
    /// Removed side: 1 or −1 along the axis.
    pub side: f32,
    /// Position of the plane along the axis, times `side`.
    at: f32,
}

impl Plane {
    /// Returns the depth of a rest point behind the plane [voxels].
    pub fn depth(&self, rest: Vec3) -> f32 {
        self.at - self.side * rest[self.axis]
    }
}

/// Returns the cut plane of each piece of a body. `before` has the axis and side of each piece's last cut.
pub fn planes(body: &SoftBody<Dim3>, cut: Cut, before: &[(usize, f32)]) -> Vec<Plane> {
    let nodes = || {
        body.mesh().nodes().map(|(id, node)| {
            (
                body.pieces().of_node(id).index(),
                body.positions()[id].xyz(),
                Vec3::from(node.at.map(|k| k as f32)),
            )
        })
    };
    let none = (Vec3::MAX, Vec3::MIN, Vec3::ZERO, 0.0f32);
    let mut spans = vec![none; body.pieces().list.len()];
    for (piece, at, rest) in nodes() {
        let (low, high, sum, count) = &mut spans[piece];
        (*low, *high) = (low.min(rest), high.max(rest));
        (*sum, *count) = (*sum + at, *count + 1.0);
    }
    // Approximate current directions of the grid axes, by piece.
    let mut axes = vec![Mat3::ZERO; spans.len()];
    for (piece, at, rest) in nodes() {
        let (low, high, sum, count) = spans[piece];
        let (by, along) = (at - sum / count, rest - low.midpoint(high));
        axes[piece] += Mat3::from_cols(by * along.x, by * along.y, by * along.z);
    }
    let plane = |(piece, (low, high, ..), axes): (usize, (Vec3, Vec3, _, _), Mat3)| {
        let facing = columns(axes).map(|axis| axis.normalize_or_zero().dot(cut.direction));
        let more = |a: &usize, b: &usize| facing[*a].abs().total_cmp(&facing[*b].abs());
        let best = (0..3).max_by(more).unwrap_or(0);
        let kept = before.get(piece).copied();
        let kept = kept.filter(|&(axis, side)| side * facing[axis] > facing[best].abs() - BETTER);
        let (axis, side) = kept.unwrap_or((best, 1.0f32.copysign(facing[best])));
        let wide = high[axis] - low[axis];
        let first = (side * low[axis]).min(side * high[axis]);
        let share = if wide < THIN { 2.0 } else { cut.share };
        Plane {
            axis,
            side,
            at: first + share * wide,
        }
    };
    let pieces = spans.into_iter().zip(axes).enumerate();
    pieces
        .map(|(piece, (span, axes))| plane((piece, span, axes)))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use fuwafuwa::{Material, VoxelGrid};

    #[test]
    fn cut_keeps_its_axis_until_another_faces_clearly_better() {
        let grid = VoxelGrid::<Dim3>::cube(8, 1.0).unwrap();
        let body = SoftBody::new(grid, &[Material::default()]).unwrap();
        let mut before = Vec::new();
        let mut axis = |degrees: f32| {
            let (sin, cos) = degrees.to_radians().sin_cos();
            let cut = Cut {
                direction: Vec3::new(sin, 0.0, cos),
                share: 0.5,
            };
            let plane = planes(&body, cut, &before)[0];
            before = vec![(plane.axis, plane.side)];
            before[0]
        };
        let degrees = [
            40.0, 46.0, 44.0, 49.0, 60.0, 46.0, 44.0, 41.0, 30.0, -60.0, 120.0,
        ];
        let (front, right, left) = ((2, 1.0), (0, 1.0), (0, -1.0));
        let wanted = [
            front, front, front, front, right, right, right, right, front, left, right,
        ];
        assert_eq!(degrees.map(&mut axis), wanted);
    }
}
