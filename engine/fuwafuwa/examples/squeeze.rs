//! Squeezes a soft disc through a gap narrower than itself, in one piece.
//!
//! `cargo run --release -p fuwafuwa --example squeeze`

use fuwafuwa::{Body, Dim2, Material, Rigid, Settings, Shape, VoxelGrid, World};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut world = World::<Dim2>::new(Settings {
        gravity: [0.0; 3],
        drag: 1.0,
        ..Settings::default()
    })?;
    for (from, to) in [(-1.0, 0.1), (0.9, 2.0)] {
        let bar = Shape::Capsule {
            from: [1.2, from, 0.0],
            to: [1.2, to, 0.0],
            radius: 0.05,
        };
        world.add_rigid(Rigid::fixed(bar, 0.2))?;
    }
    let unbreakable = Material {
        strength: f32::INFINITY,
        ..Material::default()
    };
    let ball = world.add_body(Body::new(VoxelGrid::ball(64, 1.0)?, &[unbreakable])?);
    let hand = world.add_rigid(Rigid::hand([-0.2, 0.5, 0.0], 0.15))?;
    for tick in 0..=300u16 {
        let x = (-0.2 + 0.008 * f32::from(tick)).min(1.5);
        world.set_goal(hand, [x, 0.5, 0.0])?;
        world.step();
        if tick % 30 == 0 {
            let body = &world.bodies()[ball];
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
