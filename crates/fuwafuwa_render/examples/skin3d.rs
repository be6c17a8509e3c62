//! How long the skin of a ball takes while a hand tears it:
//! `cargo run --release -p fuwafuwa_render --example skin3d -- [body.n=64 …]`.

use fuwafuwa::Dim3;
use fuwafuwa_render::frame::ElementColour;
use fuwafuwa_render::space::{Camera, Cut, Geometry, Skin};
use fuwafuwa_render::{Frame, Look, Theme};
use fuwafuwa_scenes::Scene;
use std::error::Error;
use std::time::Instant;

fn main() -> Result<(), Box<dyn Error>> {
    let scene = Scene::open("tear-3d", &std::env::args().skip(1).collect::<Vec<_>>())?;
    let mut world = scene.build::<Dim3>()?;
    let theme = Theme::candy();
    let mut skin = Skin::default();
    let begin = Instant::now();
    skin.follow(&world.bodies()[0], &theme.materials);
    println!("first look: {:.1} ms", 1e3 * begin.elapsed().as_secs_f64());
    let (mut still, mut torn) = (Vec::new(), Vec::new());
    for tick in 0..150 {
        for (hand, goal) in scene.goals(tick).into_iter().enumerate() {
            world.set_goal(hand, goal);
        }
        world.step();
        let begin = Instant::now();
        let is_new = skin.follow(&world.bodies()[0], &theme.materials);
        let times = if is_new { &mut torn } else { &mut still };
        times.push(1e3 * begin.elapsed().as_secs_f64());
    }
    let triangles = skin.indices().len() / 3;
    println!(
        "{} vertices, {triangles} triangles, {} crumbs",
        skin.vertices().len(),
        skin.crumbs().len()
    );
    for (name, mut times) in [("unchanged", still), ("torn", torn)] {
        times.sort_by(f64::total_cmp);
        if let (Some(median), Some(worst)) = (times.get(times.len() / 2), times.last()) {
            println!(
                "{name}: {} ticks, median {median:.2} ms, worst {worst:.2} ms",
                times.len()
            );
        }
    }
    let mut geometry = Geometry::default();
    let frame = Frame {
        camera: Camera {
            cut: Some(Cut {
                towards: [0.0, 0.0, 1.0],
                share: 0.5,
            }),
            ..Camera::fit(scene.view[0], scene.view[1], [1, 1])
        },
        theme: &theme,
        look: Look::Elements {
            colour: ElementColour::Strain,
            ages: &[],
            nodes: false,
        },
        basket: None,
        particles: &[],
        stickers: &[],
        ghost: None,
        seconds: 0.0,
    };
    let times = (0..20).map(|_| {
        let begin = Instant::now();
        geometry.gather(&world, &frame);
        1e3 * begin.elapsed().as_secs_f64()
    });
    let best = times.fold(f64::INFINITY, f64::min);
    let count = geometry.vertex_count();
    println!("elements behind a cut: {count} vertices, best {best:.2} ms");
    Ok(())
}
