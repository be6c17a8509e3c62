//! A real soft body to push at.

use crate::stick::Other;
use fuwafuwa::{
    Dim2, Elasticity, Material, MotionType, RigidBody, RigidBodyHandle, Shape, SoftBody, VoxelGrid,
    World, WorldConfig as WorldSettings,
};

/// A soft disc between three walls, open to the left.
pub struct Disc {
    pub world: World<Dim2>,
    hand: RigidBodyHandle,
}

impl Disc {
    /// Of this stiffness [Pa], and so many times as strong as usual.
    pub fn new(young: f64, strength: f32) -> Self {
        let mut world = World::new(WorldSettings {
            gravity: [0.0; 3],
            drag: 1.0,
            ..WorldSettings::default()
        })
        .expect("they are within bounds");
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
        let grid = VoxelGrid::ball(12, 1.0).expect("it is small");
        world.add_soft_body(SoftBody::new(grid, &[material]).expect("it is a disc"));
        // In a corner from which it does not roll away.
        for (normal, at) in [
            ([-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]),
            ([0.0, 1.0, 0.0], [0.0; 3]),
            ([0.0, -1.0, 0.0], [0.0, 1.0, 0.0]),
        ] {
            let wall = Shape::half_space(normal, at);
            world
                .add_rigid_body(RigidBody::fixed(wall, 0.5))
                .expect("it is a shape");
        }
        let hand =
            RigidBody::coupled_ball([-0.3, 0.5, 0.0], 0.15).with_motion_type(MotionType::default());
        let hand = world.add_rigid_body(hand).expect("it is a hand");
        Self { world, hand }
    }
}

impl Other for Disc {
    fn tick(&mut self, goal: [f32; 2]) -> ([f32; 2], [f32; 2]) {
        self.world
            .set_target_position(self.hand, [goal[0], 0.5 + goal[1], 0.0])
            .expect("it is a place");
        self.world.step();
        let hand = &self.world.rigid_bodies()[self.hand];
        let all = hand.reactions();
        let mean =
            |axis: usize| all.iter().map(|one| one.contact[axis]).sum::<f32>() / all.len() as f32;
        let [x, y, _] = hand.position();
        ([x, y - 0.5], [mean(0), mean(1)])
    }
}
