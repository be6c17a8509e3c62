//! The benchmark's scenes in fuwafuwa.

use fuwafuwa::inspect::Elasticity;
use fuwafuwa::{
    DEFAULT_TICK, Damping, Dim, DimVector, MIN_SUBSTEPS, Material, RigidBody, Shape, SoftBody, StiffBodies,
    VoxelGrid, World, WorldConfig,
};

use crate::world::{Falling, Span};
use crate::{Drop, Result, WIDTH};

/// Largest value that [`WorldConfig::max_substeps`] accepts.
const MAX_SUBSTEPS: u32 = 1024;

/// Builds a world with an undamped, unbreakable body above a half-space. The world gets `substeps` substeps
/// or, for `None`, the fewest that do not soften the body, see [`SoftBody::stiffness_scale`].
pub fn world<D: Dim>(scene: &Drop, substeps: Option<usize>) -> Result<World<D>> {
    let material = Material {
        elasticity: Elasticity {
            young: scene.young.into(),
            poisson: scene.poisson.into(),
        },
        density: scene.density,
        damping: Damping::NONE,
        friction: scene.friction,
        strength: f32::INFINITY,
        ..Material::default()
    };
    let body = SoftBody::new(VoxelGrid::<D>::ball(scene.n, WIDTH)?, &[material])?;
    let required = (f64::from(DEFAULT_TICK) / body.longest_substep()).ceil() as u32;
    let max_substeps = substeps.map_or(required, |substeps| substeps as u32);
    let mut world = World::<D>::new(WorldConfig {
        stiff_bodies: StiffBodies::Softened,
        gravity: D::Vector::Y * -scene.gravity,
        drag: 0.0,
        max_substeps: max_substeps.clamp(MIN_SUBSTEPS, MAX_SUBSTEPS),
        ..WorldConfig::default()
    })?;
    let floor = Shape::half_space(D::Vector::Y, D::Vector::ZERO);
    world.add_rigid_body(RigidBody::fixed(floor).with_friction(scene.friction))?;
    let lowest = span(&body).lowest;
    world.add_soft_body(body.translated(D::Vector::Y * (scene.height - lowest))).unwrap();
    Ok(world)
}

/// Returns the body of a world built by [`world`].
pub fn body<D: Dim>(world: &World<D>) -> &SoftBody<D> {
    let (_, body) = world.soft_bodies().next().expect("world with a body");
    body
}

fn span<D: Dim>(body: &SoftBody<D>) -> Span {
    let pieces = body.piece_views();
    Span::of(pieces.iter().flat_map(|piece| [piece.low.y, piece.high.y]))
}

impl<D: Dim> Falling for World<D> {
    fn engine(&self) -> String {
        let elements = body(self).mesh().element_count();
        format!("fuwafuwa, {elements} elements")
    }

    fn step(&mut self) {
        World::step(self);
    }

    fn span(&self) -> Span {
        span(body(self))
    }

    fn substeps(&self) -> usize {
        World::substeps(self) as usize
    }

    fn stiffness_scale(&self) -> f64 {
        body(self).stiffness_scale()
    }

    fn pieces(&self) -> usize {
        body(self).pieces().list.len()
    }

    fn asleep(&self) -> f64 {
        let pieces = &body(self).pieces().list;
        let asleep = pieces.iter().filter(|piece| piece.asleep).count();
        asleep as f64 / pieces.len() as f64
    }
}
