//! A simulated soft body to push against.

use crate::stick::Other;
use fuwafuwa::inspect::Elasticity;
use fuwafuwa::{
    Dim2, Material, MotionType, RigidBody, RigidBodyHandle, Shape, SoftBody, VoxelGrid, World,
    WorldConfig as WorldSettings,
};

/// A soft disc between three walls, open to the left.
pub struct Disc {
    pub world: World<Dim2>,
    hand: RigidBodyHandle,
}

impl Disc {
    /// Creates a disc with a Young's modulus [Pa] and `strength` times the default strength.
    pub fn new(young: f64, strength: f32) -> Self {
        let mut world = World::new(WorldSettings {
            gravity: [0.0; 3],
            drag: 1.0,
            ..WorldSettings::default()
        })
        .expect("the settings are valid");
        let usual = Material::default();
        let material = Material {
            elasticity: Elasticity {
                young,
                poisson: 0.3,
            },
            strength: strength * usual.strength,
            toughness: strength * usual.toughness,
            ..usual
        };
        let grid = VoxelGrid::ball(12, 1.0).expect("the grid is valid");
        world.add_soft_body(SoftBody::new(grid, &[material]).expect("the body is valid"));
        // The walls form a corner that keeps the disc from rolling away.
        for (normal, at) in [
            ([-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]),
            ([0.0, 1.0, 0.0], [0.0; 3]),
            ([0.0, -1.0, 0.0], [0.0, 1.0, 0.0]),
        ] {
            let wall = Shape::half_space(normal, at);
            world
                .add_rigid_body(RigidBody::fixed(wall).with_friction(0.5))
                .expect("the wall is valid");
        }
        let hand = RigidBody::coupled(Shape::ball(0.15))
            .at([-0.3, 0.5, 0.0])
            .with_motion_type(MotionType::default());
        let hand = world.add_rigid_body(hand).expect("the hand is valid");
        Self { world, hand }
    }
}

impl Other for Disc {
    fn tick(&mut self, goal: [f32; 2]) -> ([f32; 2], [f32; 2]) {
        self.world
            .set_target_position(self.hand, [goal[0], 0.5 + goal[1], 0.0])
            .expect("the goal is valid");
        self.world.step();
        let hand = self.world.rigid_body(self.hand).unwrap();
        let all = hand.reactions();
        let mean =
            |axis: usize| all.iter().map(|one| one.contact[axis]).sum::<f32>() / all.len() as f32;
        let [x, y, _] = hand.position();
        ([x, y - 0.5], [mean(0), mean(1)])
    }
}
