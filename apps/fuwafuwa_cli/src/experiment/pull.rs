//! Slow pulling of a body until a crack grows, shared by the experiments of fracture.

use super::Setup;
use anyhow::{Result, bail};
use fuwafuwa::{Damping, Dim, DimVector, NodeId, SoftBody, StiffBodies, Vec3, World, WorldConfig};
use std::time::Instant;

/// Slow pull of a body by its held nodes.
pub struct Pull<D: Dim> {
    /// Body without fixed nodes.
    pub body: SoftBody<D>,
    /// Returns the direction in which a node at a lattice point is pulled, or `None` if the node is free.
    pub held: fn([i32; 3], [i32; 3]) -> Option<Vec3>,
    /// Axis along which the body is stretched uniformly, if there is one.
    pub along: Option<usize>,
    /// Speed of the held nodes [m/s].
    pub speed: f32,
    /// Longest time until a crack grows [s].
    pub longest: f32,
}

/// State of a pulled body when a crack begins to grow.
#[derive(Clone, Debug)]
pub struct Growth {
    /// Way of each held node [m].
    pub way: f64,
    /// Force on the nodes that are pulled along the positive direction of an axis, at the growth [N].
    pub load: f64,
    /// Discretisation; the number of voxels is that of the caller.
    pub setup: Setup,
}

impl<D: Dim> Pull<D> {
    /// Pulls until the first node is split.
    ///
    /// # Errors
    /// If no crack grows, or the world refuses the body.
    pub fn until_growth(mut self, n: usize) -> Result<Growth> {
        let start = Instant::now();
        let size = self.body.grid().size();
        let nodes: Vec<_> = self.body.mesh().nodes().collect();
        let mut far: Vec<NodeId> = Vec::new();
        for (id, node) in nodes {
            if let Some(axis) = self.along {
                // Begins in uniform motion, so that no wave runs through the body.
                let share = 2.0 * node.at[axis] as f32 / size[axis] as f32 - 1.0;
                let (at, mut velocity, _) = self.body.node_state(id);
                velocity[axis] = share * self.speed;
                self.body.set_node_state(id, at, velocity)?;
            }
            if let Some(direction) = (self.held)(node.at, size) {
                let (at, ..) = self.body.node_state(id);
                let velocity = D::Vector::from_vec3(direction * self.speed);
                self.body.set_node_state(id, at, velocity)?;
                self.body.fix_node(id);
                if direction.element_sum() > 0.0 {
                    far.push(id);
                }
            }
        }
        let mut world = still_world::<D>()?;
        let body = world.add_soft_body(self.body)?;
        let tick = world.config().tick;
        let (mut way, mut load) = (0.0, 0.0);
        while way < self.speed * self.longest {
            let report = world.step();
            way += self.speed * tick;
            if report.nodes_split > 0 {
                let setup = Setup {
                    n,
                    substeps: Some(report.substeps),
                    seconds: start.elapsed().as_secs_f64(),
                };
                return Ok(Growth {
                    way: f64::from(way),
                    load,
                    setup,
                });
            }
            let forces = far.iter().map(|&id| world[body].force_on(id).to_vec3());
            // Elastic forces pull the held nodes back.
            let force = forces
                .map(|force| f64::from(-force.element_sum()))
                .sum::<f64>();
            load = force;
        }
        bail!("no crack grew in {} s", self.longest)
    }
}

/// Returns a world without gravity and sleep, in which no body is scaled.
pub fn still_world<D: Dim>() -> Result<World<D>> {
    Ok(World::new(WorldConfig {
        gravity: D::Vector::ZERO,
        stiff_bodies: StiffBodies::Exact,
        sleep: false,
        ..WorldConfig::default()
    })?)
}

/// Returns the damping of a body that is pulled slowly: a ratio of 0.3 at a frequency [Hz].
pub fn calm(frequency: f64) -> Damping {
    Damping::at(0.3, frequency as f32)
}
