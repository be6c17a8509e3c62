//! A simulated soft body to push against.

use crate::stick::Other;
use fuwafuwa::{
    Damping, Elasticity, Material, Reaction, RigidBody, RigidBodyHandle, Shape, SoftBody, Vec2,
    VoxelGrid, World2, WorldConfig,
};

/// A soft disc between three walls, open to the left.
pub struct Disc {
    pub world: World2,
    hand: RigidBodyHandle,
}

impl Disc {
    /// Creates a disc with a Young's modulus [Pa] and `strength` times the default strength.
    pub fn new(young: f64, strength: f32) -> Self {
        let mut world = World2::new(WorldConfig {
            gravity: Vec2::ZERO,
            drag: 5.0,
            ..WorldConfig::default()
        })
        .expect("the configuration is valid");
        let usual = Material::default();
        let material = Material {
            elasticity: Elasticity {
                young,
                poisson: 0.3,
            },
            strength: strength * usual.strength,
            toughness: strength * usual.toughness,
            // The body itself comes to rest soon; a round body would roll to and fro for long.
            damping: Damping::at(0.3, 1.0),
            ..usual
        };
        let grid = VoxelGrid::ball(12, 1.0).expect("the grid is valid");
        world
            .add_soft_body(SoftBody::new(grid, &[material]).expect("the body is valid"))
            .unwrap();
        // The walls form a corner that keeps the disc from rolling away.
        for (normal, at) in [
            (Vec2::NEG_X, Vec2::X),
            (Vec2::Y, Vec2::ZERO),
            (Vec2::NEG_Y, Vec2::Y),
        ] {
            let wall = Shape::half_space(normal, at);
            world
                .add_rigid_body(RigidBody::fixed(wall).with_friction(0.5))
                .expect("the wall is valid");
        }
        let hand = RigidBody::coupled(Shape::ball(0.15)).at(Vec2::new(-0.3, 0.5));
        let hand = world.add_rigid_body(hand).expect("the hand is valid");
        Self { world, hand }
    }
}

impl Other for Disc {
    fn tick(&mut self, goal: [f32; 2]) -> ([f32; 2], [f32; 2]) {
        self.world
            .set_target_position(self.hand, Vec2::new(goal[0], 0.5 + goal[1]))
            .expect("the target is valid");
        self.world.step();
        let hand = self.world.rigid_body(self.hand);
        let hand = hand.expect("the hand is in the world");
        let all = hand.reactions();
        let count = all.len() as f32;
        let sum: Vec2 = all.map(|Reaction { contact, .. }| contact).sum();
        let Vec2 { x, y } = hand.position();
        ([x, y - 0.5], (sum / count).to_array())
    }
}
