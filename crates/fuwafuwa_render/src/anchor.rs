//! A frame that follows a body, for a face to be painted in.

use crate::plane::{Flat, flat};
use fuwafuwa::vector::{minus, plus, scaled};
use fuwafuwa::{Body, Dim, Vector};

/// A frame that follows the largest piece of a body.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Anchor {
    /// Its centre of mass [m].
    pub position: Vector,
    /// What is to the right in the body at rest, now, as seen along z; of length 1.
    pub right: Flat,
    /// What is up in the body at rest, now; of length 1 and square to `right`.
    pub up: Flat,
    /// Radius of a disc of its area at rest, in space of a ball of its volume [m].
    pub scale: f32,
}

/// The frame of the largest piece of a body: it moves and turns with it, and does not shear.
///
/// The turn is the one that leaves the least of the motion unexplained: the rotation part of
/// Σ m (x − x̄)(r − r̄)ᵀ over its nodes, x where they are and r where they were at rest; in space the one around z.
pub fn anchor<D: Dim>(body: &Body<D>) -> Anchor {
    let (mesh, pieces) = (body.mesh(), body.pieces());
    let mut masses = vec![0.0f32; pieces.list.len()];
    for (id, _) in mesh.nodes() {
        masses[pieces.of_node(id) as usize] += body.node_state(id).2;
    }
    let largest =
        (0..masses.len()).fold(0, |best, k| if masses[k] > masses[best] { k } else { best });
    let states = || {
        let own = mesh
            .nodes()
            .filter(|&(id, _)| pieces.of_node(id) as usize == largest);
        own.map(|(id, node)| {
            let (at, _, mass) = body.node_state(id);
            (at, node.at.map(|k| k as f32), mass)
        })
    };
    let (mut position, mut origin) = ([0.0; 3], [0.0; 3]);
    for (at, rest, mass) in states() {
        let share = mass / masses[largest];
        position = plus(position, scaled(at, share));
        origin = plus(origin, scaled(rest, share));
    }
    let (mut cos, mut sin) = (0.0, 0.0);
    for (at, rest, mass) in states() {
        let (x, r) = (flat(minus(at, position)), flat(minus(rest, origin)));
        cos += mass * (x[0] * r[0] + x[1] * r[1]);
        sin += mass * (x[1] * r[0] - x[0] * r[1]);
    }
    let length = (cos * cos + sin * sin).sqrt();
    let right = match length > 0.0 {
        true => [cos / length, sin / length],
        false => [1.0, 0.0],
    };
    let whole: f32 = masses.iter().sum();
    let voxels = body.grid().solid_count() as f32 * masses[largest] / whole;
    Anchor {
        position,
        right,
        up: [-right[1], right[0]],
        scale: body.grid().voxel_size()
            * match D::N {
                2 => (voxels / std::f32::consts::PI).sqrt(),
                _ => (0.75 * voxels / std::f32::consts::PI).cbrt(),
            },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fuwafuwa::{Blade, Dim2, Material, Settings, VoxelGrid, World};

    #[test]
    fn it_turns_with_the_largest_piece_and_ignores_its_squash() {
        let mut world = World::<Dim2>::new(Settings::default()).unwrap();
        let grid = VoxelGrid::ball(24, 1.0).unwrap();
        world.add_body(Body::new(grid, &[Material::default()]).unwrap());
        let rest = anchor(&world.bodies()[0]);
        assert!(
            (rest.scale - 0.48).abs() < 0.02 && (rest.right[0] - 1.0).abs() < 1e-6,
            "{rest:?}"
        );

        world.cut(0, &Blade::segment([0.25, -1.0], [0.25, 2.0]));
        let body = world.body_mut(0);
        let ids: Vec<u32> = body.mesh().nodes().map(|(id, _)| id).collect();
        let (sin, cos) = 2.5f32.sin_cos();
        for id in ids {
            let [x, y, _] = body.node_state(id).0;
            // Squashed, turned, and away with what was cut off.
            let [x, y] = [x, 0.6 * y];
            let gone = if x < 0.25 { 100.0 } else { 0.0 };
            let place = [cos * x - sin * y + 3.0 + gone, sin * x + cos * y - 7.0, 0.0];
            if x != 0.25 {
                body.set_node_state(id, place, [0.0; 3]);
            } else {
                let largest = body.pieces().of_node(id) == body.pieces().of_node(middle(body));
                let gone = if largest { 0.0 } else { 100.0 };
                body.set_node_state(id, [place[0] + gone, place[1], 0.0], [0.0; 3]);
            }
        }
        let now = anchor(&world.bodies()[0]);
        assert!(
            (now.right[0] - cos).abs() < 1e-3 && (now.right[1] - sin).abs() < 1e-3,
            "{now:?}"
        );
        assert_eq!(now.up, [-now.right[1], now.right[0]]);
        assert!(now.position[0].abs() < 10.0 && now.scale < rest.scale);
    }

    fn middle(body: &Body<Dim2>) -> u32 {
        let nodes = body.mesh().nodes();
        let distance = |at: [i32; 3]| (at[0] - 16).abs() + (at[1] - 12).abs();
        nodes
            .min_by_key(|(_, node)| distance(node.at))
            .map(|(id, _)| id)
            .unwrap()
    }
}
