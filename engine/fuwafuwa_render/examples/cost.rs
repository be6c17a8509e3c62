//! Measures for one image: the CPU time for its vertices and the total time (best of several runs) [ms], the
//! draw calls and the bytes written to the GPU.

use fuwafuwa::{Dim2, Vec2};
use fuwafuwa_render::frame::ElementColour;
use fuwafuwa_render::{Camera, Frame, Geometry, Look, Palette, Renderer};
use fuwafuwa_scenes::Scene;
use std::error::Error;
use std::time::Instant;

const SIZE: [u32; 2] = [1280, 720];
/// Number of images drawn per scene and look.
const IMAGES: usize = 20;

fn main() -> Result<(), Box<dyn Error>> {
    let instance = wgpu::Instance::default();
    let adapter = pollster::block_on(instance.request_adapter(&Default::default()))?;
    let (device, queue) = pollster::block_on(adapter.request_device(&Default::default()))?;
    let mut renderer = Renderer::new(&device, wgpu::TextureFormat::Rgba8Unorm);
    println!("{}, {SIZE:?}", adapter.get_info().name);
    for (name, ticks) in [("squeeze", 130), ("tear", 140), ("diced", 120)] {
        let scene = Scene::open(name, &[])?;
        let mut world = scene.build::<Dim2>()?;
        for tick in 0..ticks {
            scene.set_hand_targets(&mut world, tick);
            world.step();
        }
        let palette = Palette::candy();
        let elements = Look::Elements {
            colour: ElementColour::Level,
            ages: &[],
            nodes: false,
        };
        for (look_name, look) in [("skin", Look::Skin), ("elements", elements)] {
            let [low, high] = scene.view.map(|[x, y, _]| Vec2::new(x, y));
            let camera = Camera::fit(low, high, SIZE);
            let frame = Frame {
                look,
                ..Frame::new(camera, &palette)
            };
            let mut geometry = Geometry::default();
            let gather = best(200, || geometry.gather(&world, &frame));
            let mut failure = None;
            let whole = best(IMAGES, || {
                let image = renderer.render_to_image(&device, &queue, &world, &frame, SIZE);
                failure = image.err();
            });
            if let Some(error) = failure {
                return Err(error.into());
            }
            let vertices = geometry.vertex_count();
            let cost = renderer.take_cost();
            let [draws, bytes] = [cost.draws, cost.bytes].map(|sum| sum / IMAGES as u64);
            println!(
                "{name:8} {look_name:8} {vertices:6} vertices: {gather:6.2} ms before the GPU, {whole:6.1} ms per image, {draws} draw calls, {bytes} bytes written"
            );
        }
    }
    Ok(())
}

/// Returns the shortest time of `count` runs [ms].
fn best(count: usize, mut run: impl FnMut()) -> f64 {
    let times = (0..count).map(|_| {
        let begin = Instant::now();
        run();
        1e3 * begin.elapsed().as_secs_f64()
    });
    times.fold(f64::INFINITY, f64::min)
}
