//! A strip of moments of a scene of the plane in the look of the game, with faces and captions.
//!
//! ```text
//! cargo run --release -p fuwafuwa_painter --example moments -- tear tear.png
//! ```

use fuwafuwa::world::TICK;
use fuwafuwa::{Dim2, Event, Shape, World};
use fuwafuwa_painter::soft::{self, Extras};
use fuwafuwa_painter::{Face, Mood, Painter, film};
use fuwafuwa_scenes::Scene;
use std::error::Error;

/// Moments in the strip, and how many stand side by side.
const MOMENTS: u64 = 9;
const COLUMNS: usize = 3;
/// Width of a moment [px].
const WIDTH: u32 = 460;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let name = arguments.next().unwrap_or("tear".into());
    let path = arguments.next().unwrap_or("moments.png".into());
    let scene = Scene::open(&name, &[])?;
    let [_, high] = scene.view;
    let basket = Shape::Box {
        centre: [high[0] - 0.45, 0.5, 0.0],
        half: [0.35, 0.42, 1.0],
    };
    let mut world = scene.build::<Dim2>()?;
    let mut moments = Vec::new();
    let mut last_tear = None;
    for tick in 0..scene.ticks() {
        scene.send(&mut world, tick);
        world.step();
        let is_torn = world
            .events()
            .iter()
            .any(|event| matches!(event, Event::Released { .. }));
        last_tear = if is_torn { Some(tick) } else { last_tear };
        if (tick + 1) % (scene.ticks() / MOMENTS) == 0 {
            let mood = match last_tear {
                Some(tear) if tick - tear < 20 => Mood::Shock,
                _ if is_in(&world, &basket) => Mood::Beam,
                _ if is_squeezed(&world) => Mood::Wince,
                _ => Mood::Calm,
            };
            let hand = world.hands().next();
            let look_at = hand.map_or([0.0, 2.0, 0.0], |(_, hand)| hand.position());
            let extras = Extras {
                basket: Some(basket),
                faces: world
                    .bodies()
                    .iter()
                    .filter_map(|body| Face::on(body, mood, look_at))
                    .collect(),
            };
            let (mut painter, frame) = Painter::for_view(scene.view, WIDTH);
            soft::world(&mut painter, frame, &world, &extras);
            painter.caption(&format!("{:.1} s, {mood:?}", (tick + 1) as f32 * TICK));
            moments.push(painter.pixels()?);
        }
    }
    std::fs::write(path, film::strip(&moments, COLUMNS)?.png()?)?;
    Ok(())
}

fn is_in(world: &World<Dim2>, basket: &Shape) -> bool {
    let bodies = || world.bodies().iter();
    let inside: f32 = bodies().map(|body| body.mass_inside(basket)).sum();
    let whole: f64 = bodies().map(|body| body.total_mass()).sum();
    inside > 0.6 * whole as f32
}

fn is_squeezed(world: &World<Dim2>) -> bool {
    let views = world.bodies().iter().flat_map(|body| body.element_views());
    views.filter(|view| view.strain > 0.2).count() > 60
}
