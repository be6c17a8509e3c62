//! Draws a ball in space, torn by a hand, at several moments into PNG files:
//! `cargo run --release -p fuwafuwa_render --example stills3d -- FOLDER [NAME …]`.

use fuwafuwa::{Dim3, World};
use fuwafuwa_render::frame::ElementColour;
use fuwafuwa_render::space::{Camera, Renderer};
use fuwafuwa_render::{Ages, Frame, Look, Theme};
use fuwafuwa_scenes::Scene;
use std::error::Error;
use std::fs::File;
use std::io::BufWriter;
use std::path::Path;
use std::time::Instant;

const SIZE: [u32; 2] = [960, 640];

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let folder = arguments.next().ok_or("expected a folder to write to")?;
    let chosen: Vec<String> = arguments.collect();
    std::fs::create_dir_all(&folder)?;
    let instance = wgpu::Instance::default();
    let adapter = pollster::block_on(instance.request_adapter(&Default::default()))?;
    println!("{}", adapter.get_info().name);
    let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor {
        required_limits: wgpu::Limits::downlevel_webgl2_defaults(),
        ..Default::default()
    }))?;
    let mut renderer = Renderer::new(&device, wgpu::TextureFormat::Rgba8Unorm);
    let scene = Scene::open("tear-3d", &[])?;
    let mut world: World<Dim3> = scene.build()?;
    let theme = Theme::candy();
    let mut ages = Ages::default();
    for tick in 0..150u64 {
        for (hand, goal) in scene.goals(tick).into_iter().enumerate() {
            world.set_goal(hand, goal);
        }
        world.step();
        ages.follow(&world, 1.0 / 60.0);
        if ![1, 40, 60, 90, 130, 149].contains(&tick) {
            continue;
        }
        let elements = |colour| Look::Elements {
            colour,
            ages: &ages.seconds,
            nodes: false,
        };
        let looks = [
            ("skin", Look::Skin, None),
            (
                "levels",
                elements(ElementColour::Level),
                Some(([0.0, 0.0, 1.0], 0.5)),
            ),
            (
                "strains",
                elements(ElementColour::Strain),
                Some(([0.0, 0.0, 1.0], 0.5)),
            ),
        ];
        for (look_name, look, cut) in looks {
            let name = format!("tear-{tick:03}-{look_name}");
            if !chosen.is_empty() && !chosen.iter().any(|one| name.contains(one)) {
                continue;
            }
            let frame = Frame {
                camera: Camera {
                    cut,
                    turn: 0.5,
                    ..Camera::fit([0.0; 3], [1.0; 3], SIZE)
                },
                theme: &theme,
                look,
                basket: None,
                particles: &[],
                seconds: tick as f32 / 60.0,
            };
            let begin = Instant::now();
            let image = renderer.render_to_image(&device, &queue, &world, &frame, SIZE)?;
            let path = Path::new(&folder).join(format!("{name}.png"));
            println!("{} {:?}", path.display(), begin.elapsed());
            write(&path, &image)?;
        }
    }
    Ok(())
}

fn write(path: &Path, image: &[u8]) -> Result<(), Box<dyn Error>> {
    let file = BufWriter::new(File::create(path)?);
    let mut encoder = png::Encoder::new(file, SIZE[0], SIZE[1]);
    encoder.set_color(png::ColorType::Rgba);
    encoder.write_header()?.write_image_data(image)?;
    Ok(())
}
