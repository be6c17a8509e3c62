//! Solver rows between a cutting edge and the tissue around it.

use super::knife_state::{EdgePose, KnifeState};
use crate::foundation::arena::{BodySlot, SoftBodyHandle};
use crate::foundation::dim::Dim;
use crate::foundation::ids::{NodeId, PieceId};
use crate::material::Material;
use crate::math::row::Row;
use crate::rigid_body::{RigidBodies, RigidState};
use crate::soft_body::{SoftBodies, SoftBody};
use glam::Vec3;

/// Solver iterations over all rows per substep. Several are required because adjacent samples push the same
/// nodes. With 2 iterations, the two sides of a cut stay connected.
const ITERATIONS: usize = 8;

/// Share of the limit impulse at which a row counts as having reached its limit, so that the edge advances.
/// It is below 1 to allow for rounding.
const AT_LIMIT: f32 = 0.98;

/// Solver row between one sample of the edge and the tissue around the sample.
struct EdgeRow {
    body: SoftBodyHandle,
    /// Nodes of the element around the sample, with their interpolation weights.
    weights: Vec<(NodeId, f32)>,
    /// Inverse effective mass of the tissue at the sample [1/kg], in the cutting direction and sideways.
    inverse_mass: [f32; 2],
    /// Lever arm from the position of the holder to the sample [m].
    lever: Vec3,
    /// Maximum impulses in the substep: in the cutting direction, and sideways in both senses [N s].
    limits: [f32; 2],
    /// Impulses on the tissue in this substep: in the cutting direction, and sideways [N s].
    impulse: [f32; 2],
}

impl KnifeState {
    /// Solves the edge against the tissue for a substep of `duration` [s]. Returns the sleepers to wake.
    pub(crate) fn solve<D: Dim>(
        &mut self,
        bodies: &mut SoftBodies<D>,
        rigids: &mut RigidBodies,
        duration: f32,
    ) -> Vec<(BodySlot, PieceId)> {
        (self.force, self.torque) = (Vec3::ZERO, Vec3::ZERO);
        let Ok(holder) = rigids.get_mut(self.holder) else {
            return Vec::new();
        };
        let pose = self.edge_pose::<D>(holder);
        let mut woken = Vec::new();
        let mut rows = Vec::new();
        for place in 0..self.samples.len() {
            let Some((id, _)) = self.samples[place].inside else {
                continue;
            };
            let row = self.row(&pose, place, &bodies[id], duration);
            let piece = bodies[id].pieces().of_node(row.weights[0].0);
            if bodies[id].pieces().list[piece].asleep && holder.pushes() {
                woken.push((id.slot(), piece));
            }
            rows.push((place, row));
        }
        let ways = [pose.toward, pose.across];
        for _ in 0..ITERATIONS {
            for (_, row) in &mut rows {
                let body = bodies
                    .get_mut(row.body)
                    .expect("the body is alive in this substep");
                solve_row(row, body, holder, ways, duration);
            }
        }
        for (place, row) in &rows {
            let is_at = |way: usize| row.impulse[way].abs() >= AT_LIMIT * row.limits[way];
            let sample = &mut self.samples[*place];
            sample.slid |= is_at(0) || is_at(1);
            sample.cut |= is_at(0) && row.limits[0] > 0.0;
            let given = ways[0] * row.impulse[0] + ways[1] * row.impulse[1];
            let force = given * (-1.0 / duration);
            self.force += force;
            self.torque += row.lever.cross(force);
            let slip = slip(row, &bodies[row.body], holder);
            let work = |way: usize| row.impulse[way] * slip.dot(ways[way]);
            self.work += f64::from((work(0) + work(1)).max(0.0));
        }
        holder.add_torque(self.torque);
        woken
    }

    /// Returns the pieces that contain samples of the edge. They stay awake while the edge moves.
    pub(crate) fn pieces_inside<D: Dim>(&self, bodies: &SoftBodies<D>) -> Vec<(BodySlot, PieceId)> {
        let inside = self.samples.iter().filter_map(|sample| sample.inside);
        let pieces = inside.filter_map(|(id, point)| {
            let body = bodies.get(id).ok()?;
            let owner = body.mesh().owner(point.voxel)?;
            Some((id.slot(), body.pieces().of_element(owner)))
        });
        let mut pieces: Vec<(BodySlot, PieceId)> = pieces.collect();
        pieces.sort_unstable();
        pieces.dedup();
        pieces
    }

    /// Returns the solver row of a sample that is in a body.
    fn row<D: Dim>(
        &self,
        pose: &EdgePose,
        place: usize,
        body: &SoftBody<D>,
        duration: f32,
    ) -> EdgeRow {
        let (id, point) = self.samples[place].inside.expect("the sample is in a body");
        let mesh = body.mesh();
        let owner = mesh
            .owner(point.voxel)
            .expect("the sample is in a solid voxel");
        let element = mesh.element(owner).expect("owners are alive");
        let material = body.material(element);
        let ways = [pose.along, pose.toward];
        let [along, toward] = point.rest_directions(body, ways).unwrap_or(ways);
        let weights = body.weights(element, point.at);
        let lever = self.lever(pose, place);
        let forth = match point.is_uncut_ahead(body, along, toward) {
            true => self.cutting_force(material, self.samples[place].speed),
            false => 0.0,
        };
        let share = self.share::<D>(pose, place) * duration;
        let inverse_masses = weights
            .iter()
            .map(|&(node, weight)| weight * weight * body.inverse_masses()[node]);
        let (own, whole): (f32, _) = (inverse_masses.sum(), body.response_matrix(&weights));
        let inverse_mass = |way: Vec3| own + way.dot(whole.map(|row| row.dot(way)).into());
        EdgeRow {
            body: id,
            inverse_mass: [pose.toward, pose.across].map(inverse_mass),
            weights,
            lever,
            // A sample that represents no length, in unbreakable material, gives 0 · ∞ = NaN, which `max`
            // turns into 0.
            limits: [forth, material.strength * self.height].map(|k| (share * k).max(0.0)),
            impulse: [0.0; 2],
        }
    }

    /// Returns the force per metre of edge that cuts a material [N/m] with a `speed` of the edge in it [m/s].
    fn cutting_force(&self, material: &Material, speed: f32) -> f32 {
        let dull = match self.radius > 0.0 {
            true => 2.0 * self.radius * material.strength,
            false => 0.0,
        };
        material.fracture_energy_at(speed) + dull
    }
}

/// Returns the velocity of the edge relative to the tissue, at a sample [m/s].
fn slip<D: Dim>(row: &EdgeRow, body: &SoftBody<D>, holder: &RigidState) -> Vec3 {
    holder.velocity_at(row.lever) - body.velocity_of(&row.weights)
}

/// Applies the impulse that stops the edge relative to the tissue, within the limits of the row.
fn solve_row<D: Dim>(
    row: &mut EdgeRow,
    body: &mut SoftBody<D>,
    holder: &mut RigidState,
    ways: [Vec3; 2],
    duration: f32,
) {
    for (way, direction) in ways.into_iter().enumerate() {
        // If neither the tissue nor the holder can move, the division by 0 drives the impulse to its limit.
        let total_inverse_mass =
            row.inverse_mass[way] + holder.inverse_effective_mass(row.lever, direction);
        let speed = slip(row, body, holder).dot(direction);
        let least = if way == 0 { 0.0 } else { -row.limits[way] };
        let wanted = (row.impulse[way] + speed / total_inverse_mass).clamp(least, row.limits[way]);
        let change = wanted - row.impulse[way];
        if !change.is_finite() {
            continue;
        }
        row.impulse[way] = wanted;
        let push = direction * change;
        for &(node, weight) in &row.weights {
            let change = Row::from(push) * (weight * body.inverse_masses()[node]);
            body.velocities_mut()[node] += change;
        }
        body.push_responses(&row.weights, push);
        holder.apply_contact_impulse_at(-push, row.lever, duration);
    }
}
