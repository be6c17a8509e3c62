//! Hashes.
use fuwafuwa::inspect::{Elasticity,Hash};
use fuwafuwa::*;
fn main() {
    let material = Material { elasticity: Elasticity::new(5000.0, 0.3).unwrap(), damping: 0.5, strength: 1000.0, toughness: 200.0, ..Material::default() };
    let mut world = World::<Dim2>::new(WorldConfig::default()).unwrap();
    world.add_rigid_body(RigidBody::fixed(Shape::half_space(Vec2::Y, Vec2::ZERO)).with_friction(0.6)).unwrap();
    for (x, lean) in [(-0.13, 1.0), (1.13, -1.0)] {
        let wall = Shape::Box { centre: Vec2::new(x - 0.05 * lean, 0.2), half: Vec2::new(0.08, 0.2) };
        world.add_rigid_body(RigidBody::fixed(wall).with_friction(0.4)).unwrap();
    }
    let b = world.add_soft_body(SoftBody::new(VoxelGrid::ball(40, 1.0).unwrap(), &[material]).unwrap());
    let hand = RigidBody::coupled(Shape::ball(0.055)).at(Vec2::new(0.46, 1.2)).with_motion_type(MotionType::Kinematic);
    let hand = world.add_rigid_body(hand).unwrap();
    for tick in 0..200 {
        let way = (tick as f32 / (200.0 * 0.8)).min(1.0);
        world.set_target_position(hand, Vec2::new(0.46 + 0.05 * way, 1.2 - 1.1 * way)).unwrap();
        world.step();
        let body = &world[b];
        let mut bytes = Vec::new();
        for (id, _) in body.mesh().nodes() {
            let (at, velocity, _) = body.node_state(id);
            for axis in 0..2 { bytes.extend((at[axis]+0.0).to_bits().to_le_bytes()); bytes.extend((velocity[axis]+0.0).to_bits().to_le_bytes()); }
        }
        println!("{tick} {:016x} {:016x}", Hash::of(&bytes), world.hash());
    }
}
