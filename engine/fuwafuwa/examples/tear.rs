//! Pushes a hand through a soft disc against a wall, and prints releases, energy and pieces.
//!
//! `cargo run --release -p fuwafuwa --example tear`

use fuwafuwa::{
    Dim2, Event, Material, MotionType, RigidBody, Shape, SoftBody, VoxelGrid, World, WorldConfig,
};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut world = World::<Dim2>::new(WorldConfig {
        gravity: [0.0; 3],
        drag: 1.0,
        ..WorldConfig::default()
    })?;
    world.add_rigid_body(
        RigidBody::fixed(Shape::half_space([-1.0, 0.0, 0.0], [1.1, 0.0, 0.0])).with_friction(0.2),
    )?;
    let ball = world.add_soft_body(SoftBody::new(
        VoxelGrid::ball(64, 1.0)?,
        &[Material::default()],
    )?);
    // Stronger than the default hand, which gets stuck halfway.
    let strong = MotionType::Coupled {
        mass: 2.0,
        stiffness: 10_000.0,
        damping: 0.9,
        limit: f32::INFINITY,
    };
    let hand = world.add_rigid_body(
        RigidBody::coupled(Shape::ball(0.1))
            .at([-0.2, 0.5, 0.0])
            .with_motion_type(strong),
    )?;
    for tick in 0..120u8 {
        world.set_target_position(hand, [-0.2 + 0.012 * f32::from(tick), 0.5, 0.0])?;
        let report = world.step();
        let energy: f32 = world
            .events()
            .iter()
            .map(|event| match event {
                Event::NodeSplit { energy, .. } => *energy,
                _ => 0.0,
            })
            .sum();
        let felt = world.rigid_body(hand).unwrap().reactions().last();
        let felt = felt.map_or(0.0, |reaction| -reaction.coupling[0]);
        if report.nodes_split > 0 || tick % 20 == 0 {
            println!(
                "tick {tick:3}: the hand pushes with {felt:5.0} N; {:2} nodes released ({energy:.2} J), {} pieces detached",
                report.nodes_split, report.pieces_detached
            );
        }
    }
    let mut pieces = world[ball].piece_views();
    pieces.sort_by(|a, b| b.mass.total_cmp(&a.mass));
    for piece in pieces.iter().take(5) {
        println!("a piece of {:.2} kg at {:.2?}", piece.mass, piece.centre);
    }
    Ok(())
}
