//! Motion of the nodes of a body in a substep.

use super::SoftBody;
use crate::foundation::dim::{Dim, DimVector, inner};
use crate::foundation::ids::ElementId;
use crate::foundation::threads::{self, RowChunk, Run};
use crate::math::lanes::on_widest_lanes;
use crate::math::row::Row;
use crate::soft_body::element_forces::VelocityUpdate;
use crate::soft_body::element_law::rotation_if_far_from;
use crate::soft_body::momentum::RigidMotionF32;
use glam::Vec3;

impl<D: Dim> SoftBody<D> {
    /// Advances an isolated body by `duration` [s] under `gravity` [m/s²], without contact or damping.
    /// Symplectic Euler, stable if `duration` is at most [`SoftBody::longest_substep`].
    #[inline(never)]
    pub fn advance(&mut self, duration: f32, gravity: D::Vector) {
        threads::in_pool(self.cache.awake.len(), || {
            self.apply_forces(duration, gravity.to_vec3());
            self.move_nodes(duration, 0.0);
        });
    }

    /// Adds to velocities the change that elastic forces and gravity [m/s²] cause in `duration` [s].
    pub(crate) fn apply_forces(&mut self, duration: f32, gravity: Vec3) {
        self.refresh_awake();
        if std::mem::take(&mut self.state.placed) {
            let all: Vec<ElementId> = self.topology.mesh.elements().map(|(id, _)| id).collect();
            self.reset_rotations(&all);
        }
        let before = self.velocities_of_slowed();
        self.evaluate_forces(duration);
        let gravity = Row::from(gravity) * self.state.gravity_scale;
        let update = VelocityUpdate {
            nodes: &self.cache.awake,
            inverse_mass: &self.state.inverse_mass,
            duration,
            gravity,
        };
        self.state
            .batches
            .update_velocities(&update, &mut self.state.velocity);
        self.complete_forces(duration, gravity);
        for (id, before) in before {
            let share = self.pace_share(self.topology.pieces.of_node(id));
            let velocity = &mut self.state.velocity[id];
            *velocity = before + (*velocity - before) * share;
        }
    }

    /// Computes the elastic forces, for a substep of `duration` [s]. The forces of each material are evaluated
    /// at positions that are extrapolated by its stiffness damping (Kelvin–Voigt). `ahead` has the positions
    /// for the largest stiffness damping; the others lie between these and the present positions.
    fn evaluate_forces(&mut self, duration: f32) {
        let (leads, longest) = self.leads(duration);
        let ahead = self.state.ahead.as_slice();
        let mut shorter: Vec<(f32, Vec<Row>)> = Vec::new();
        for &lead in leads.iter().filter(|&&lead| lead < longest) {
            if shorter.iter().all(|&(other, _)| other != lead) {
                let mut rows = self.state.position.as_slice().to_vec();
                for &id in &self.cache.awake {
                    let row = &mut rows[id.index()];
                    *row += (ahead[id.index()] - *row) * (lead / longest);
                }
                shorter.push((lead, rows));
            }
        }
        let of_lead = |lead: &f32| {
            let found = shorter.iter().find(|(other, _)| other == lead);
            found.map_or(ahead, |(_, rows)| rows)
        };
        let positions: Vec<&[Row]> = leads.iter().map(of_lead).collect();
        self.state.batches.evaluate(&positions, duration);
    }

    /// Adds to velocities the change that an acceleration field [m/s²] causes in `duration` [s].
    pub(crate) fn apply_field(
        &mut self,
        duration: f32,
        field: &(dyn Fn(D::Vector) -> D::Vector + Sync),
    ) {
        if self.topology.mass_scale > 1.0 {
            self.apply_field_to_scaled(duration, field);
            return;
        }
        for &id in &self.cache.awake {
            let duration = duration * self.pace_share(self.topology.pieces.of_node(id));
            let point = D::Vector::from_vec3(self.state.position[id].xyz());
            let acceleration = Row::from(field(point).to_vec3());
            if self.state.inverse_mass[id] > 0.0 && acceleration.is_finite() {
                for axis in 0..D::N {
                    self.state.velocity[id][axis] += acceleration[axis] * duration;
                }
            }
        }
    }

    /// Like [`SoftBody::apply_field`], in a body with a mass scale.
    fn apply_field_to_scaled(
        &mut self,
        duration: f32,
        field: &(dyn Fn(D::Vector) -> D::Vector + Sync),
    ) {
        for index in 0..self.cache.awake.len() {
            let id = self.cache.awake[index];
            let duration = duration * self.pace_share(self.topology.pieces.of_node(id));
            let point = D::Vector::from_vec3(self.state.position[id].xyz());
            let acceleration = field(point).to_vec3();
            if self.state.inverse_mass[id] > 0.0 && acceleration.is_finite() {
                let impulse = acceleration * (duration * self.state.mass[id]);
                self.state.velocity[id] += Row::from(impulse * self.state.inverse_mass[id]);
                self.push_responses(&[(id, 1.0)], impulse);
            }
        }
        self.apply_responses();
    }

    /// Recomputes the rotations of elements that are new or whose nodes were placed, because such a rotation
    /// may be far from the orientation of the nodes. The iteration in the force evaluation follows only small
    /// turns, and does not correct a rotation that is wrong by half a turn. Has no effect in 2D, where the
    /// force evaluation computes the rotation directly.
    pub(crate) fn reset_rotations(&mut self, elements: &[ElementId]) {
        if D::N == 2 {
            return;
        }
        for &id in elements {
            let element = self
                .topology
                .mesh
                .element(id)
                .expect("only rotations of live elements are reset");
            let wide = |rows: [Vec3; 3]| rows.map(|row| row.as_dvec3());
            let (rotation, deformation) = (
                self.state.batches.rotation(id),
                self.elastic_part(id, element),
            );
            if let Some(turned) = rotation_if_far_from(&wide(rotation), &wide(deformation)) {
                self.state
                    .batches
                    .set_rotation(id, turned.map(|part| part as f32));
            }
        }
    }

    /// Moves every awake node by its velocity for `duration` [s]; during a fast impact, by the share in its
    /// [`Pace`]. Also extrapolates the positions by `lead` [s], for the next evaluation of forces. The
    /// extrapolation uses velocities relative to the rigid motion of the piece, so that pure rotation is not
    /// damped. Returns the distance that the fastest node has moved [m].
    pub(crate) fn move_nodes(&mut self, duration: f32, lead: f32) -> f32 {
        // Gives pieces that were created since the last damping round a rigid motion of zero.
        self.cache
            .rigid
            .resize(self.topology.pieces.list.len(), RigidMotionF32::default());
        let (rigid, pieces) = (self.cache.rigid.as_slice(), &self.topology.pieces);
        let paces = self.cache.paces.as_slice();
        let is_paced = !paces.is_empty();
        let (velocities, inverse_mass) = (&self.state.velocity, &self.state.inverse_mass);
        let lists = [&mut self.state.position, &mut self.state.ahead];
        let rows = threads::rows(&self.cache.awake, lists.map(|rows| rows.as_mut_slice()));
        let fastest = threads::map(rows, move |rows| {
            // Lets the compiler use the instructions of wide lanes for the rows.
            on_widest_lanes!(_simd => {
                let RowChunk { ids: nodes, first, lists: [positions, ahead] } = rows;
                let mut fastest = 0.0f32;
                for Run { ids, rows } in threads::runs(nodes, first) {
                    let places = positions[rows.clone()].iter_mut().zip(&mut ahead[rows]);
                    let masses = &inverse_mass.as_slice()[ids.clone()];
                    let velocities = velocities.as_slice()[ids.clone()].iter();
                    let nodes = velocities.zip(masses).zip(pieces.of_nodes(ids));
                    for ((position, ahead), ((&velocity, &inverse_mass), piece)) in places.zip(nodes) {
                        let piece = piece.index();
                        let (mut moved, mut lead) = (velocity, lead);
                        if is_paced && inverse_mass > 0.0 {
                            (moved, lead) = (paces[piece].of(velocity), lead * paces[piece].share);
                        }
                        let squared = inner::<D>(moved, moved);
                        // A comparison is faster than `f32::max`, with which each iteration of the loop would wait
                        // for the previous one.
                        if squared > fastest {
                            fastest = squared;
                        }
                        *position += moved * duration;
                        let vibration = velocity - rigid[piece].at::<D>(*position);
                        *ahead = *position + vibration * lead;
                    }
                }
                fastest
            })
        });
        let fastest = fastest.into_iter().fold(0.0, f32::max).sqrt();
        self.cache.fastest = if is_paced { f32::INFINITY } else { fastest };
        fastest * duration
    }

    /// Recomputes the list of awake nodes if it is outdated.
    pub(crate) fn refresh_awake(&mut self) {
        if !self.cache.awake_is_stale {
            return;
        }
        self.cache.awake_is_stale = false;
        let mut awake = std::mem::take(&mut self.cache.awake);
        awake.clear();
        let nodes = self.topology.mesh.nodes().map(|(id, _)| id);
        awake.extend(nodes.filter(|&id| !self.topology.pieces.sleeps(id)));
        self.cache.awake = awake;
    }
}
