//! Who leans on what is taken out of the world: such sleepers are to wake.

use super::bins::Bins;
use super::pair::MARGIN;
use super::sphere::ContactSphere;
use super::spheres::NONE;
use crate::body::{Bodies, Body};
use crate::dim::Dim;
use crate::ids::{NodeId, PieceId};
use crate::lanes::on_widest_lanes;
use crate::rigid::Rigid;
use crate::solve::Row;
use crate::vector::three;

/// The sleepers that lean on something rigid, by body and number in ascending order.
pub fn leaning_on_rigid<D: Dim>(rigid: &Rigid, bodies: &Bodies<D>) -> Vec<(u32, PieceId)> {
    let mut leaning = Vec::new();
    for (place, body) in bodies.placed() {
        let reach = MARGIN * body.truth.grid.voxel_size();
        let is_near = |node: NodeId| {
            let at = three(body.state.position[node]);
            body.truth.pieces.sleeps(node) && rigid.shape().distance(at).0 <= reach
        };
        let nodes = body.truth.mesh.nodes().map(|(node, _)| node);
        let nodes = nodes.filter(|&node| is_near(node));
        leaning.extend(nodes.map(|node| (place, body.truth.pieces.of_node(node))));
    }
    leaning.sort_unstable();
    leaning.dedup();
    leaning
}

/// The sleepers that lean on a body which is not among them, by body and number in ascending order.
pub fn leaning_on_body<D: Dim>(body: &Body<D>, bodies: &Bodies<D>) -> Vec<(u32, PieceId)> {
    let own: Vec<ContactSphere> = spheres_of(NONE, body).collect();
    let Some(radius) = own.first().map(|sphere| sphere.radius) else {
        return Vec::new();
    };
    let centres = own
        .iter()
        .map(|sphere| sphere.mean::<D>(&body.state.position));
    let centres: Vec<Row> = centres.collect();
    let bins = Bins::new::<D>(&centres, 2.0 * radius);
    let (mut leaning, mut near) = (Vec::new(), Vec::new());
    for (place, other) in bodies.placed() {
        for sphere in spheres_of(place, other).filter(|sphere| sphere.asleep) {
            let (at, reach) = (
                sphere.mean::<D>(&other.state.position),
                (1.0 + MARGIN) * (radius + sphere.radius),
            );
            on_widest_lanes!(simd => bins.near::<D, _>(simd, at, reach, |_| 0, &mut near));
            if !near.is_empty() {
                leaning.push((place, sphere.piece));
            }
        }
    }
    leaning.sort_unstable();
    leaning.dedup();
    leaning
}

fn spheres_of<D: Dim>(place: u32, body: &Body<D>) -> impl Iterator<Item = ContactSphere> {
    let ids = body.truth.mesh.elements().map(|(id, _)| id);
    ids.filter_map(move |id| ContactSphere::of(place, body, id))
}
