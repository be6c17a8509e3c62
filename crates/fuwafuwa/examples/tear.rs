//! Pushes a hand through a soft disc against a wall, and prints releases, energy and pieces.
//!
//! `cargo run --release -p fuwafuwa --example tear`

use fuwafuwa::{Body, Dim2, Drive, Event, Material, Rigid, Settings, Shape, VoxelGrid, World};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut world = World::<Dim2>::new(Settings {
        gravity: [0.0; 3],
        drag: 1.0,
        ..Settings::default()
    })?;
    world.add_rigid(Rigid::fixed(
        Shape::half_space([-1.0, 0.0, 0.0], [1.1, 0.0, 0.0]),
        0.2,
    ))?;
    let ball = world.add_body(Body::new(
        VoxelGrid::ball(64, 1.0)?,
        &[Material::default()],
    )?);
    // Stronger than the default hand, which gets stuck halfway.
    let strong = Drive::Coupled {
        mass: 2.0,
        stiffness: 10_000.0,
        damping: 0.9,
        limit: f32::INFINITY,
    };
    let hand = world.add_rigid(Rigid::hand([-0.2, 0.5, 0.0], 0.1).with_drive(strong))?;
    for tick in 0..120u8 {
        world.set_goal(hand, [-0.2 + 0.012 * f32::from(tick), 0.5, 0.0])?;
        let report = world.step();
        let energy: f32 = world
            .events()
            .iter()
            .map(|event| match event {
                Event::Released { energy, .. } => *energy,
                _ => 0.0,
            })
            .sum();
        let felt = world.rigids()[hand].reactions().last();
        let felt = felt.map_or(0.0, |reaction| -reaction.coupling[0]);
        if report.released > 0 || tick % 20 == 0 {
            println!(
                "tick {tick:3}: the hand pushes with {felt:5.0} N; {:2} nodes released ({energy:.2} J), {} pieces detached",
                report.released, report.parted
            );
        }
    }
    let mut pieces = world.bodies()[ball].piece_views();
    pieces.sort_by(|a, b| b.mass.total_cmp(&a.mass));
    for piece in pieces.iter().take(5) {
        println!("a piece of {:.2} kg at {:.2?}", piece.mass, piece.centre);
    }
    Ok(())
}
