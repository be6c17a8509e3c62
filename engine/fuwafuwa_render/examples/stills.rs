//! Draws named scenes at several moments into PNG files:
//! `cargo run --release -p fuwafuwa_render --example stills -- FOLDER [SCENE …]`.

mod shared;

use fuwafuwa::{Dim2, Shape, Vec2, Vec3, World};
use fuwafuwa_render::frame::ElementColour;
use fuwafuwa_render::{Ages, Basket, Camera, Frame, Look, Palette, Particle, Renderer, anchor};
use fuwafuwa_scenes::Scene;
use shared::{device, write};
use std::error::Error;
use std::path::Path;
use std::time::Instant;

const SIZE: [u32; 2] = [960, 600];
/// Scenes and the ticks at which they are drawn.
const MOMENTS: [(&str, &[u64]); 5] = [
    ("squeeze", &[1, 90, 130, 170]),
    ("tear", &[20, 60, 90, 140]),
    ("core", &[60, 120]),
    ("diced", &[1, 40, 120]),
    ("pile", &[60, 150]),
];

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let folder = arguments.next().ok_or("expected a folder to write to")?;
    let chosen: Vec<String> = arguments.collect();
    std::fs::create_dir_all(&folder)?;
    let (device, queue) = device()?;
    let mut renderer = Renderer::new(&device, wgpu::TextureFormat::Rgba8Unorm);
    let (candy, safe) = (Palette::candy(), Palette::colour_safe());
    for (name, moments) in MOMENTS {
        if !chosen.is_empty() && !chosen.iter().any(|one| one == name) {
            continue;
        }
        let scene = Scene::open(name, &[])?;
        let mut world = scene.build::<Dim2>()?;
        let mut ages = Ages::default();
        let [low, high] = scene.view.map(|[x, y, _]| Vec2::new(x, y));
        let camera = Camera::fit(low, high, SIZE);
        for tick in 0..=moments.iter().copied().max().unwrap_or(0) {
            scene.set_hand_targets(&mut world, tick);
            world.step();
            ages.update(&world, 1.0 / 60.0);
            if !moments.contains(&tick) {
                continue;
            }
            let elements = |colour| Look::Elements {
                colour,
                ages: &ages.seconds,
                nodes: false,
            };
            let particles = crumbs(&world);
            let looks = [
                ("skin", Look::Skin, &candy),
                ("levels", elements(ElementColour::Level), &candy),
                ("strains", elements(ElementColour::Strain), &candy),
                ("safe", Look::Skin, &safe),
            ];
            for (look_name, look, palette) in looks {
                let frame = Frame {
                    look,
                    baskets: Vec::from_iter((name == "squeeze").then_some(Basket {
                        region:
                            Shape::cuboid(Vec2::new(0.45, 0.425)).translated(Vec2::new(1.75, 0.5)),
                        fill: 0.0,
                        colour: None,
                    })),
                    particles: &particles,
                    seconds: tick as f64 / 60.0,
                    ..Frame::new(camera, palette)
                };
                let begin = Instant::now();
                let image = renderer.render_to_image(&device, &queue, &world, &frame, SIZE)?;
                let path = Path::new(&folder).join(format!("{name}-{tick:03}-{look_name}.png"));
                println!("{} {:?}", path.display(), begin.elapsed());
                write(&path, &image, SIZE)?;
            }
        }
    }
    Ok(())
}

/// Returns particles around the largest piece of the first body, to show how particles look.
fn crumbs(world: &World<Dim2>) -> Vec<Particle> {
    let Some((_, body)) = world.soft_bodies().next() else {
        return Vec::new();
    };
    let anchor = anchor(body);
    let around = (0..12).map(|k| {
        let angle = k as f32 * 2.4;
        let reach = anchor.scale * (1.15 + 0.02 * k as f32);
        Particle {
            at: anchor.position + reach * Vec3::new(angle.cos(), angle.sin(), 0.0),
            radius: 0.006 + 0.001 * k as f32,
            colour: [1.0, 0.62, 0.55, 1.0 - 0.06 * k as f32],
        }
    });
    around.collect()
}
