//! The scenes in fuwafuwa.

use fuwafuwa::inspect::Elasticity;
use fuwafuwa::{MIN_SUBSTEPS, TICK};
use fuwafuwa::{Dim, Material, RigidBody, Shape, SoftBody, VoxelGrid, World, WorldConfig};

use crate::world::{Falling, Span};
use crate::{Drop, Result, WIDTH};

/// Largest value that [`WorldConfig::max_substeps`] accepts.
const MOST_SUBSTEPS: u32 = 1024;

/// Builds a world with an undamped, unbreakable body above a half-space. The world gets `substeps` substeps
/// or, for `None`, the fewest that do not soften the body, see [`SoftBody::stiffness_scale`].
pub fn world<D: Dim>(scene: &Drop, substeps: Option<usize>) -> Result<World<D>> {
    let material = Material {
        elasticity: Elasticity {
            young: scene.young.into(),
            poisson: scene.poisson.into(),
        },
        density: scene.density,
        damping: 0.0,
        friction: scene.friction,
        strength: f32::INFINITY,
        ..Material::default()
    };
    let body = SoftBody::new(VoxelGrid::<D>::ball(scene.n, WIDTH)?, &[material])?;
    let asked = (f64::from(TICK) / body.longest_substep()).ceil() as u32;
    let most = substeps.map_or(asked, |substeps| substeps as u32);
    let mut world = World::<D>::new(WorldConfig {
        gravity: [0.0, -scene.gravity, 0.0],
        drag: 0.0,
        max_substeps: most.clamp(MIN_SUBSTEPS, MOST_SUBSTEPS),
        ..WorldConfig::default()
    })?;
    let floor = Shape::half_space([0.0, 1.0, 0.0], [0.0; 3]);
    world.add_rigid_body(RigidBody::fixed(floor).with_friction(scene.friction))?;
    let lowest = span(&body).lowest;
    world.add_soft_body(body.translated([0.0, scene.height - lowest, 0.0]));
    Ok(world)
}

fn span<D: Dim>(body: &SoftBody<D>) -> Span {
    let pieces = body.piece_views();
    Span::of(
        pieces
            .iter()
            .flat_map(|piece| [piece.low[1], piece.high[1]]),
    )
}

impl<D: Dim> Falling for World<D> {
    fn engine(&self) -> String {
        let elements = self
            .soft_bodies().next().map(|(_, item)| item)
            .expect("world with a body")
            .mesh()
            .element_count();
        format!("fuwafuwa, {elements} elements")
    }

    fn step(&mut self) {
        World::step(self);
    }

    fn span(&self) -> Span {
        span(self.soft_bodies().next().map(|(_, item)| item).expect("world with a body"))
    }

    fn substeps(&self) -> usize {
        World::substeps(self) as usize
    }

    fn stiffness_scale(&self) -> f64 {
        self.soft_bodies().next().map(|(_, item)| item)
            .expect("world with a body")
            .stiffness_scale()
    }

    fn pieces(&self) -> usize {
        self.soft_bodies().next().map(|(_, item)| item)
            .expect("world with a body")
            .pieces()
            .list
            .len()
    }

    fn asleep(&self) -> f64 {
        let pieces = &self
            .soft_bodies().next().map(|(_, item)| item)
            .expect("world with a body")
            .pieces()
            .list;
        let asleep = pieces.iter().filter(|piece| piece.asleep).count();
        asleep as f64 / pieces.len() as f64
    }
}
