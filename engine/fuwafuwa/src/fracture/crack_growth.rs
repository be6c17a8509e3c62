//! Fracture: selects the shared nodes that are released next.
//!
//! A cut through a breakable node divides the voxels that share the node into sides A and B. The elements of
//! side A pull at the node with the force F_A, those of side B with F_B:
//!
//! ```text
//!       A │ B        T = (F_B − F_A) / 2      n = mean rotation · axis
//!     ────●────      σ = √(Tₙ² + ¼ Tₛ²) / area of the opened faces, both sides pulling apart
//!       A │ B
//! ```
//!
//! T is the pull across the cut, with the part Tₙ along the normal n of the cut and the part Tₛ in its plane.
//! The tension σ is compared with a threshold: the strength at a smooth surface, toughness / √voxel at the
//! tip of a crack. A node fails if it is overloaded for some milliseconds.

use crate::foundation::dim::{Dim, Point};
use crate::foundation::ids::NodeId;
use crate::foundation::threads;
use crate::fracture::breakable_nodes::{BreakableNode, NodeCut};
use crate::math::lanes::on_widest_lanes;
use crate::soft_body::SoftBody;
use crate::soft_body::cooldowns::is_near;
use crate::soft_body::element_forces::Row;
use fearless_simd::Simd;
use glam::Vec3;

/// Node that fails, so that its release advances a crack.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Failure {
    /// Id of the node.
    pub node: NodeId,
    /// Lattice point of the node.
    pub at: Point,
    /// Mask of the octants that the crack separates from the others at the node.
    pub side: u8,
    /// Axis normal to the faces that open.
    axis: usize,
    /// Tension divided by the threshold of the node.
    pub excess: f32,
    /// Estimate of the released elastic energy [J]: σ² / (2 Y) times the volume of a voxel, with the tension
    /// σ and Young's modulus Y.
    pub energy: f32,
}

/// Time until a node fails under 1.5 times its threshold tension [s]. With a shorter time, impacts shatter
/// the surface; with a longer one, fast rigid bodies push through without cutting.
const DAMAGE_TIME: f32 = 0.004;
/// Time in which a damaged node heals once it is no longer overloaded [s]. It is longer than [`DAMAGE_TIME`],
/// so that oscillating loads can break nodes too.
const HEALING_TIME: f32 = 4.0 * DAMAGE_TIME;
/// Upper limit of the overload, tension / threshold − 1, in the growth of damage. Because of this limit, a
/// short impact does less damage than a sustained pull.
const MAX_OVERLOAD: f32 = 3.0;
/// Factor on the threshold of cuts that would make a crumb or leave a voxel attached by a single face.
/// Without it, cracks leave a trail of crumbs.
const CRUMB_FACTOR: f32 = 1.3;
/// Cooldown after a release, as the distance that the fastest pressure wave travels in this time [voxels]. It
/// lasts until the wave of the release has reached nodes two voxels away and returned.
const COOLDOWN_VOXELS: f64 = 4.0;

/// Updates the damage of all breakable nodes after a fracture round of `duration` [s], and returns the nodes
/// that fail now, the most overloaded first. No two of these nodes are near each other, except along the
/// front of one crack.
pub fn failures<D: Dim>(body: &mut SoftBody<D>, duration: f32) -> Vec<Failure> {
    body.cooldowns_mut().pass(duration);
    if !body.can_tear() {
        return Vec::new();
    }
    let size = body.grid().voxel_size();
    let mut damage = std::mem::take(body.damage_mut());
    let found = threads::map(threads::chunks(&mut damage), |(first, damage)| {
        let mut found: Vec<Failure> = Vec::new();
        let nodes = body.breakable_nodes().among(first..first + damage.len());
        on_widest_lanes!(simd => for (id, node) in nodes {
            let damage = &mut damage[id.index() - first];
            // Tests undamaged nodes only in every second round, to save time.
            if body.pieces().sleeps(id)
                || *damage == 0.0 && (id.0 ^ body.cooldowns().rounds) & 1 == 1
            {
                continue;
            }
            // A fast test excludes most nodes: those far from failure.
            let failure = match is_surely_intact(simd, body, id, node) {
                true => None,
                false => worst_cut(body, id, node),
            };
            let Some(failure) = failure else {
                let healed = *damage - duration / HEALING_TIME;
                *damage = healed.max(0.0);
                continue;
            };
            let over = (failure.excess - 1.0).min(MAX_OVERLOAD);
            *damage += duration / DAMAGE_TIME * 2.0 * over;
            if *damage >= 1.0 && !body.cooldowns().covers(failure.at) {
                found.push(failure);
            }
        });
        found
    });
    *body.damage_mut() = damage;
    let mut found = found.concat();
    found.sort_by(|a, b| b.excess.total_cmp(&a.excess).then(a.node.cmp(&b.node)));
    let cooldown = (COOLDOWN_VOXELS * f64::from(size) / body.fastest_wave()) as f32;
    let chosen = without_worse_neighbour(found);
    let cooling = chosen.iter().map(|failure| failure.at);
    body.cooldowns_mut().start(cooling, cooldown);
    chosen
}

/// Returns those failures that have no worse failure nearby; `found` is sorted, the worst first. Failures in
/// one plane do not exclude each other: they form the front of one crack, in 3D a line, which advances as a
/// whole. If only the worst of them were released, cracks would advance too slowly, and the load would start
/// new ones.
fn without_worse_neighbour(found: Vec<Failure>) -> Vec<Failure> {
    let mut chosen: Vec<Failure> = Vec::new();
    for failure in found {
        let forestalls = |worse: &Failure| {
            let plane = |failure: &Failure| (failure.axis, failure.at[failure.axis]);
            is_near(failure.at, worse.at) && plane(&failure) != plane(worse)
        };
        if !chosen.iter().any(forestalls) {
            chosen.push(failure);
        }
    }
    chosen
}

/// Returns whether the node is certain to withstand all cuts through it, from a bound that is fast to
/// compute. The pull of a cut is at most half the sum of the force magnitudes |f| of the n voxels around the
/// node, and (Σ|f|)² ≤ n Σ|f|². The factor 0.2501 is ¼ and a margin for rounding. The area is that of one
/// face, the least that a cut opens.
#[inline(always)]
fn is_surely_intact<D: Dim, S: Simd>(
    simd: S,
    body: &SoftBody<D>,
    id: NodeId,
    node: &BreakableNode,
) -> bool {
    let threshold = face_area::<D>(body.grid().voxel_size()) * node.threshold;
    let squares = body.element_forces().squares_on(simd, id);
    0.2501 * node.group.count_ones() as f32 * squares <= threshold * threshold
}

/// Returns the most overloaded cut through a breakable node, if any is overloaded.
#[inline(never)]
fn worst_cut<D: Dim>(body: &SoftBody<D>, id: NodeId, node: &BreakableNode) -> Option<Failure> {
    let size = body.grid().voxel_size();
    let mut forces = [Row::ZERO; 8];
    for (octant, force) in octants(node.group).zip(body.element_forces().parts_on(id)) {
        forces[octant] = force;
    }
    let total = forces.into_iter().sum::<Row>();
    // Sum of the rotations of the elements around the node, computed only if a cut needs it.
    let mut turn: Option<[Vec3; 3]> = None;
    let mut worst: Option<(f32, f32, NodeCut)> = None;
    for cut in body.breakable_nodes().cuts(node) {
        let far = octants(cut.side).map(|octant| forces[octant]).sum::<Row>();
        let near = total - far;
        let pull = (far - near) * 0.5;
        let area = f32::from(cut.faces) * face_area::<D>(size);
        let is_crumb = cut.single_voxel_octants & node.crumbs != 0;
        let threshold = node.threshold * if is_crumb { CRUMB_FACTOR } else { 1.0 };
        let least = area * threshold * worst.map_or(1.0, |(excess, ..)| excess);
        // The tension is never larger than the pull, so cuts with a small pull are skipped.
        if pull.dot(pull) <= least * least {
            continue;
        }
        let turn = turn.get_or_insert_with(|| total_turn(body, id));
        let axis = cut.axis as usize;
        let direction = Row::from(Vec3::new(turn[0][axis], turn[1][axis], turn[2][axis]));
        let normal = direction * (1.0 / direction.length().max(1e-12));
        if far.dot(normal) <= 0.0 || near.dot(normal) >= 0.0 {
            continue;
        }
        let tension = tension(pull, normal);
        if tension > least {
            worst = Some((tension / (area * threshold), tension / area, *cut));
        }
    }
    let (excess, stress, cut) = worst?;
    let young = body.materials()[node.material as usize - 1]
        .elasticity
        .young as f32;
    let volume = (0..D::N).fold(1.0, |volume, _| volume * size);
    Some(Failure {
        node: id,
        at: body.mesh().node(id).at,
        side: cut.side,
        axis: cut.axis.into(),
        excess,
        energy: stress * stress / (2.0 * young) * volume,
    })
}

/// Iterates over the octants whose bits are set in a mask.
fn octants(mask: u8) -> impl Iterator<Item = usize> {
    (0..8).filter(move |octant| mask >> octant & 1 == 1)
}

/// Returns the sum of the rotation matrices of all elements around a node.
fn total_turn<D: Dim>(body: &SoftBody<D>, id: NodeId) -> [Vec3; 3] {
    let mut turn = [Vec3::ZERO; 3];
    for owner in body.mesh().carrier_ids(id) {
        let rotation = body.element_forces().rotation(owner);
        for row in 0..3 {
            turn[row] += rotation[row];
        }
    }
    turn
}

/// Returns the part of a voxel's face that belongs to one of its corners [m in 2D, m² in 3D]: half an edge in
/// 2D, a quarter of a square in 3D.
fn face_area<D: Dim>(size: f32) -> f32 {
    (1..D::N).fold(1.0, |area, _| area * 0.5 * size)
}

/// Returns √(Tₙ² + ¼ Tₛ²) [N] for a pull with the part Tₙ along a unit normal and the part Tₛ across it.
fn tension(pull: Row, normal: Row) -> f32 {
    let opening = pull.dot(normal);
    let shear = (pull.dot(pull) - opening * opening).max(0.0);
    (opening * opening + 0.25 * shear).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_worse_neighbour_keeps_front_of_crack_together() {
        let failure = |at: Point, axis| Failure {
            node: NodeId(0),
            at,
            side: 1,
            axis,
            excess: 2.0,
            energy: 0.0,
        };
        let worst = failure([8, 8, 8], 0);
        let along = failure([8, 9, 8], 0);
        let found = [
            worst,
            failure([9, 8, 8], 0),
            failure([8, 8, 9], 1),
            along,
            failure([11, 8, 8], 1),
        ];
        let far = found[4];
        assert_eq!(without_worse_neighbour(found.to_vec()), [worst, along, far]);
    }
}
