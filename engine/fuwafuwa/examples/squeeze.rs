//! Squeezes a soft disc through a gap narrower than itself, in one piece.
//!
//! `cargo run --release -p fuwafuwa --example squeeze`

use fuwafuwa::{Dim2, Material, RigidBody, Shape, SoftBody, Vector, VoxelGrid, World, WorldConfig};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut world = World::<Dim2>::new(WorldConfig {
        gravity: Vector::ZERO,
        drag: 1.0,
        ..WorldConfig::default()
    })?;
    for (from, to) in [(-1.0, 0.1), (0.9, 2.0)] {
        let bar = Shape::Capsule {
            from: Vector::new(1.2, from, 0.0),
            to: Vector::new(1.2, to, 0.0),
            radius: 0.05,
        };
        world.add_rigid_body(RigidBody::fixed(bar, 0.2))?;
    }
    let unbreakable = Material {
        strength: f32::INFINITY,
        ..Material::default()
    };
    let ball = world.add_soft_body(SoftBody::new(VoxelGrid::ball(64, 1.0)?, &[unbreakable])?);
    let hand = world.add_rigid_body(RigidBody::coupled_ball(Vector::new(-0.2, 0.5, 0.0), 0.15))?;
    for tick in 0..=300u16 {
        let x = (-0.2 + 0.008 * f32::from(tick)).min(1.5);
        world.set_target_position(hand, Vector::new(x, 0.5, 0.0))?;
        world.step();
        if tick % 30 == 0 {
            let body = &world.soft_bodies()[ball];
            let view = body.piece_views()[0];
            let through = body.mass_where(|at| at[0] > 1.2) / view.mass;
            println!(
                "{:.1} s: {:3.0} % through, {:.2} m wide and {:.2} m high",
                f32::from(tick) / 60.0,
                100.0 * through,
                view.high[0] - view.low[0],
                view.high[1] - view.low[1]
            );
        }
    }
    Ok(())
}
