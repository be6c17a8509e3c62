//! Pushes a hand through a soft disc against a wall, and prints split nodes, released energy and detached
//! pieces.
//!
//! `cargo run --release -p fuwafuwa --example tear`

use fuwafuwa::{
    Dim2, Event, Material, MotionType, RigidBody, Shape, SoftBody, Vec2, VoxelGrid, World,
    WorldConfig,
};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut world = World::<Dim2>::new(WorldConfig {
        gravity: Vec2::ZERO,
        drag: 1.0,
        ..WorldConfig::default()
    })?;
    let wall = Shape::half_space(Vec2::NEG_X, Vec2::new(1.1, 0.0));
    world.add_rigid_body(RigidBody::fixed(wall))?;
    let ball = world.add_soft_body(SoftBody::new(
        VoxelGrid::ball(64, 1.0)?,
        &[Material::default()],
    )?)?;
    // Stiffer coupling than the default. With the default, the hand would get stuck halfway through the disc.
    let strong = MotionType::Coupled {
        mass: 2.0,
        stiffness: 10_000.0,
        damping: 0.9,
        max_force: f32::INFINITY,
    };
    let hand = RigidBody::new(Shape::ball(0.1), strong).at(Vec2::new(-0.2, 0.5));
    let hand = world.add_rigid_body(hand)?;
    for tick in 0..120u8 {
        world.set_target_position(hand, Vec2::new(-0.2 + 0.012 * f32::from(tick), 0.5))?;
        let report = world.step();
        let energy: f32 = world
            .events()
            .iter()
            .map(|event| match event {
                Event::NodeSplit { energy, .. } => *energy,
                _ => 0.0,
            })
            .sum();
        let felt = world.rigid_body(hand)?.reactions().last();
        let felt = felt.map_or(0.0, |reaction| -reaction.coupling.x);
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
        println!("a piece of {:.2} kg at {:.2}", piece.mass, piece.centre);
    }
    Ok(())
}
