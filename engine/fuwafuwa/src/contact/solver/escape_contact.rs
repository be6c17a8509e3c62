//! Escape contacts: they guide a sphere embedded in another piece to its exit, the nearest surface sphere of
//! that piece.

use super::contact_row::PUSH_OUT_SPEED;
use super::contact_sides::SphereNodeRows;
use super::scaled_pieces::inverse_masses_of_spheres;
use super::solver_velocities::SolverVelocities;
use crate::contact::broad_phase::{EmbeddedSphere, Spheres};
use crate::foundation::dim::{Dim, inner};
use crate::soft_body::SoftBodies;
use crate::soft_body::element_forces::Row;

/// Embedded sphere and its exit in one substep.
#[derive(Copy, Clone, Debug)]
pub struct EscapeContact {
    node_rows: [SphereNodeRows; 2],
    /// Effective mass of the embedded sphere and its exit [kg].
    effective_mass: f32,
    /// Target velocity of the embedded sphere relative to its exit [m/s].
    velocity: Row,
}

impl EscapeContact {
    /// Returns the escape contact that moves an embedded sphere to the front of its exit. Returns `None` if
    /// neither sphere can move, or if a position or velocity is not finite or too large.
    pub fn new<D: Dim>(
        embedded: &EmbeddedSphere,
        bodies: &SoftBodies<D>,
        spheres: &Spheres,
        velocities: &mut SolverVelocities,
        duration: f32,
    ) -> Option<Self> {
        let [a, b] = [embedded.sphere, embedded.exit];
        let both = [&spheres.list[a], &spheres.list[b]];
        // Length of a vector, at least 1e-9, because the code below divides by it.
        let length_of = |way: Row| inner::<D>(way, way).sqrt().max(1e-9);
        let out = both[1].outward::<D>(bodies.at(both[1].body).positions());
        let ahead = (both[0].radius + both[1].radius) / length_of(out);
        let goal = spheres.centres[b] + out * ahead;
        let way = goal - spheres.centres[a];
        let speed = PUSH_OUT_SPEED.min(length_of(way) / duration);
        let [first, second] = both.map(|sphere| sphere.inverse_mass(bodies));
        let centres = [a, b].map(|sphere| spheres.centres[sphere]);
        let (_, whole) = inverse_masses_of_spheres(bodies, both, centres, Row::ZERO);
        let inverse_mass = first + second + whole;
        // Skips an embedded sphere that is too fast, because it would accelerate its host piece. The
        // comparisons are false for NaN.
        let relative = spheres.velocities[a] - spheres.velocities[b];
        let most = (both[0].radius + both[1].radius) / duration;
        let squared = |row: Row| inner::<D>(row, row);
        let is_way = squared(way) < f32::INFINITY && squared(relative) < most * most;
        (is_way && inverse_mass > 0.0).then(|| Self {
            node_rows: both.map(|sphere| velocities.sphere_rows::<D>(sphere)),
            effective_mass: 1.0 / inverse_mass,
            velocity: way * (speed / length_of(way)),
        })
    }

    /// Gives the embedded sphere its escape velocity relative to the exit.
    pub fn solve<D: Dim>(&self, velocities: &mut SolverVelocities) {
        self.push::<D>(self.velocity, velocities);
    }

    /// After the position update, stops the embedded sphere relative to its exit.
    pub fn relax<D: Dim>(&self, velocities: &mut SolverVelocities) {
        self.push::<D>(Row::ZERO, velocities);
    }

    fn push<D: Dim>(&self, velocity: Row, velocities: &mut SolverVelocities) {
        let change = velocity - velocities.relative_of_spheres::<D>(&self.node_rows);
        velocities.apply_to_spheres::<D>(&self.node_rows, change * self.effective_mass);
    }
}
