//! A coordinate frame that follows a body, for example to paint eyes and a mouth on the body.

use fuwafuwa::{Dim, DimVector, PieceId, SoftBody};
use glam::{Mat3, Vec3};

/// Iterations of the polar decomposition. Each one doubles the number of correct digits near convergence.
const STEPS: usize = 12;
/// Flatness limit: smallest determinant of a matrix, divided by its cubed norm, that still defines a
/// rotation.
const FLAT: f32 = 1.0e-7;

/// Coordinate frame that follows the largest piece of a body.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Anchor {
    /// Centre of mass of the piece [m].
    pub position: Vec3,
    /// Current directions of the body's rest axes. Orthonormal.
    pub axes: [Vec3; 3],
    /// Radius of a disc (2D) with the piece's rest area or of a ball (3D) with its rest volume [m].
    pub scale: f32,
}

/// Returns the frame of the largest piece of a body. It translates and rotates with the piece and does not
/// shear.
///
/// The rotation is the least-squares fit of the motion: the rotation part of Σ m (x − x̄)(r − r̄)ᵀ over the
/// piece's nodes, with current positions x and rest positions r.
pub fn anchor<D: Dim>(body: &SoftBody<D>) -> Anchor {
    let (mesh, pieces) = (body.mesh(), body.pieces());
    let mut masses = vec![0.0f32; pieces.list.len()];
    for (id, _) in mesh.nodes() {
        masses[pieces.of_node(id).index()] += body.node_state(id).2;
    }
    let largest =
        (0..masses.len()).fold(0, |best, k| if masses[k] > masses[best] { k } else { best });
    let states = || {
        let own = mesh
            .nodes()
            .filter(|&(id, _)| pieces.of_node(id).index() == largest);
        own.map(|(id, node)| {
            let (at, _, mass) = body.node_state(id);
            (at.to_vec3(), Vec3::from(node.at.map(|k| k as f32)), mass)
        })
    };
    let (position, _, turn) = frame::<D, _>(states);
    let whole: f32 = masses.iter().sum();
    let voxels = body.grid().remaining_count() as f32 * masses[largest] / whole;
    Anchor {
        position,
        axes: columns(turn.unwrap_or_default()),
        scale: body.grid().voxel_size()
            * match D::N {
                2 => (voxels / std::f32::consts::PI).sqrt(),
                _ => (0.75 * voxels / std::f32::consts::PI).cbrt(),
            },
    }
}

/// Returns the current position [m] of the rest point `place` and the axes of the piece around it. Both are
/// fitted to the nodes of the piece within `reach` of `place`. `place` and `reach` are in voxels of the body
/// at rest. Returns `None` if these nodes are too few or too flat to define a rotation.
pub fn anchor_at<D: Dim>(
    body: &SoftBody<D>,
    piece: PieceId,
    place: Vec3,
    reach: f32,
) -> Option<(Vec3, [Vec3; 3])> {
    let states = || {
        let near = body.mesh().nodes().filter_map(move |(id, node)| {
            let rest = Vec3::from(node.at.map(|k| k as f32));
            let is_near = rest.distance_squared(place) < reach * reach;
            (is_near && body.pieces().of_node(id) == piece).then_some((id, rest))
        });
        near.map(|(id, rest)| {
            let (at, _, mass) = body.node_state(id);
            (at.to_vec3(), rest, mass)
        })
    };
    let (position, origin, turn) = frame::<D, _>(states);
    let turn = turn?;
    let moved = position + turn * ((place - origin) * body.grid().voxel_size());
    Some((moved, columns(turn)))
}

/// Returns the mean current position, the mean rest position and the rotation of nodes. Each item of the
/// iterator is one node: current position, rest position, mass.
fn frame<D: Dim, I: Iterator<Item = (Vec3, Vec3, f32)>>(
    states: impl Fn() -> I,
) -> (Vec3, Vec3, Option<Mat3>) {
    let whole: f32 = states().map(|(_, _, mass)| mass).sum();
    let (mut position, mut origin) = (Vec3::ZERO, Vec3::ZERO);
    for (at, rest, mass) in states() {
        let share = mass / whole;
        position += at * share;
        origin += rest * share;
    }
    let mut sums = Mat3::ZERO;
    for (at, rest, mass) in states() {
        let (x, r) = (mass * (at - position), rest - origin);
        sums += Mat3::from_cols(x * r.x, x * r.y, x * r.z);
    }
    (position, origin, turn_of::<D>(sums))
}

/// Returns the columns of a matrix.
pub(crate) fn columns(of: Mat3) -> [Vec3; 3] {
    [of.x_axis, of.y_axis, of.z_axis]
}

/// Returns the rotation part of a matrix, by repeated averaging with its inverse transpose [Higham 1986].
/// Returns `None` for flat or inverted matrices.
fn turn_of<D: Dim>(mut turn: Mat3) -> Option<Mat3> {
    let size = |of: Mat3| {
        let squares = columns(of).map(Vec3::length_squared);
        squares.iter().sum::<f32>().sqrt()
    };
    if D::N == 2 {
        // All 2D nodes lie in a plane. A third axis makes the matrix invertible and keeps the rotation in the
        // plane.
        turn.z_axis = Vec3::Z * size(turn);
    }
    for _ in 0..STEPS {
        let (large, volume) = (size(turn), turn.determinant());
        if volume.is_nan() || volume <= FLAT * large * large * large {
            return None;
        }
        let inverse = turn.inverse().transpose();
        // Scales the matrix and its inverse transpose to the same norm, so that the iteration converges
        // faster.
        let share = (size(inverse) / large).sqrt();
        turn = 0.5 * (share * turn + inverse / share);
    }
    Some(turn)
}

#[cfg(test)]
mod tests {
    use super::*;
    use fuwafuwa::{Blade, Dim2, Dim3, Material, NodeId, Vec2, VoxelGrid, World, WorldConfig};

    #[test]
    fn anchor_rotates_with_largest_piece_and_ignores_squash() {
        let mut world = World::<Dim2>::new(WorldConfig::default()).unwrap();
        let grid = VoxelGrid::ball(24, 1.0).unwrap();
        let soft = world
            .add_soft_body(SoftBody::new(grid, &[Material::default()]).unwrap())
            .unwrap();
        let rest = anchor(&world[soft]);
        assert!(
            (rest.scale - 0.48).abs() < 0.02 && (rest.axes[0].x - 1.0).abs() < 1e-6,
            "{rest:?}"
        );

        let blade = Blade::segment(Vec2::new(0.25, -1.0), Vec2::new(0.25, 2.0));
        world.cut(soft, &blade).unwrap();
        let body = world.soft_body_mut(soft).unwrap();
        let ids: Vec<_> = body.mesh().nodes().map(|(id, _)| id).collect();
        let (sin, cos) = 2.5f32.sin_cos();
        for id in ids {
            let at = body.node_state(id).0;
            // The test squashes, rotates and translates the body, and moves the piece that was cut off far
            // away.
            let squashed = at * Vec2::new(1.0, 0.6);
            let place = Vec2::new(cos, sin).rotate(squashed) + Vec2::new(3.0, -7.0);
            let largest = body.pieces().of_node(id) == body.pieces().of_node(middle(body));
            let is_cut_off = at.x < 0.25 || at.x == 0.25 && !largest;
            let gone = if is_cut_off { 100.0 } else { 0.0 };
            body.set_node_state(id, place + gone * Vec2::X, Vec2::ZERO)
                .unwrap();
        }
        let now = anchor(&world[soft]);
        let [right, up, _] = now.axes;
        assert!(
            (right.x - cos).abs() < 1e-3 && (right.y - sin).abs() < 1e-3,
            "{now:?}"
        );
        assert!((up.x + right.y).abs() < 1e-5 && (up.y - right.x).abs() < 1e-5);
        assert!(now.position.x.abs() < 10.0 && now.scale < rest.scale);
    }

    #[test]
    fn anchor_rotates_about_any_axis_in_3d() {
        let mut world = World::<Dim3>::new(WorldConfig::default()).unwrap();
        let grid = VoxelGrid::ball(12, 1.0).unwrap();
        let soft = world
            .add_soft_body(SoftBody::new(grid, &[Material::default()]).unwrap())
            .unwrap();
        let body = world.soft_body_mut(soft).unwrap();
        let ids: Vec<_> = body.mesh().nodes().map(|(id, _)| id).collect();
        for id in ids {
            // The test halves the body's height, then rotates the body so that x maps to y, y to z and z to
            // x.
            let [x, y, z] = body.node_state(id).0.to_array();
            let place = Vec3::new(z, x, 0.5 * y);
            body.set_node_state(id, place, Vec3::ZERO).unwrap();
        }
        let wanted = [Vec3::Y, Vec3::Z, Vec3::X];
        for (axis, wanted) in anchor(&world[soft]).axes.into_iter().zip(wanted) {
            assert!(axis.dot(wanted) > 0.9999, "{axis:?}, not {wanted:?}");
        }
    }

    fn middle(body: &SoftBody<Dim2>) -> NodeId {
        let nodes = body.mesh().nodes();
        let distance = |at: [i32; 3]| (at[0] - 16).abs() + (at[1] - 12).abs();
        nodes
            .min_by_key(|(_, node)| distance(node.at))
            .map(|(id, _)| id)
            .unwrap()
    }
}
