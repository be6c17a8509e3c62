//! Draws 3D bodies that hands squeeze, tear and crumble, at several moments, into PNG files: `cargo run
//! --release -p fuwafuwa_render --example stills3d -- FOLDER [PART OF A NAME …]`. With `WGPU_BACKEND=gl` it
//! uses OpenGL ES, which is closest to browsers.

mod shared;

use fuwafuwa::{Dim3, Vec3, World};
use fuwafuwa_render::frame::ElementColour;
use fuwafuwa_render::space::{Camera, Cut, Renderer};
use fuwafuwa_render::{Ages, Basket, Frame, Look, Palette, Particle};
use fuwafuwa_scenes::Scene;
use shared::{device, write};
use std::error::Error;
use std::path::Path;
use std::time::Instant;

const SIZE: [u32; 2] = [960, 640];

/// Scene in which a hand pushes a ball with a cap of another colour between bars in a room.
const ROOM: &str = r#"
dim = 3
gravity = [0.0, -3.0, 0.0]
view = [[-1.4, 0.0, -1.0], [1.4, 1.0, 1.0]]

[[material]]
strength = 20000.0
[[material]]
strength = 20000.0

[[body]]
shape = "ball"
n = 32
at = [-1.0, 0.0, -0.5]
[[body.part]]
paint = 2
ball = { centre = [0.5, 1.1, 0.5], radius = 0.45 }

[[obstacle]]
half_space = { normal = [0.0, 1.0, 0.0], point = [0.0, 0.0, 0.0] }
[[obstacle]]
half_space = { normal = [1.0, 0.0, 0.0], point = [-1.5, 0.0, 0.0] }
[[obstacle]]
half_space = { normal = [-1.0, 0.0, 0.0], point = [1.5, 0.0, 0.0] }
[[obstacle]]
half_space = { normal = [0.0, 0.0, 1.0], point = [0.0, 0.0, -1.1] }
[[obstacle]]
half_space = { normal = [0.0, 0.0, -1.0], point = [0.0, 0.0, 1.1] }

[[obstacle]]
box = { centre = [0.87, 0.25, -0.46], half = [0.48, 0.25, 0.05] }
[[obstacle]]
box = { centre = [0.87, 0.25, 0.46], half = [0.48, 0.25, 0.05] }
[[obstacle]]
capsule = { from = [1.35, 0.1, -0.5], to = [1.35, 0.1, 0.5], radius = 0.06 }
[[obstacle]]
capsule = { from = [1.35, 0.5, -0.5], to = [1.35, 0.5, 0.5], radius = 0.06 }

[game]
name = { en = "Room" }
basket = { centre = [0.84, 0.36, 0.0], half = [0.44, 0.36, 0.40] }

[[hand]]
radius = 0.12
path = [[0.0, -1.35, 0.45, 0.0], [2.0, 0.5, 0.45, 0.0], [2.5, 0.0, 0.9, 0.3]]
[[hand]]
radius = 0.12
path = [[0.0, 0.9, 1.1, 0.3], [2.5, 0.9, 1.1, 0.3]]
"#;

/// Scene in which a hand breaks a ball of sand.
const CRUMBLE: &str = r#"
dim = 3
gravity = [0.0, -3.0, 0.0]
view = [[0.0, 0.0, 0.0], [1.0, 1.0, 1.0]]

[[material]]
strength = 500.0
toughness = 1.0

[[body]]
shape = "ball"
n = 20

[[obstacle]]
half_space = { normal = [0.0, 1.0, 0.0], point = [0.0, 0.0, 0.0] }

[[hand]]
radius = 0.12
path = [[0.0, 0.5, 1.2, 0.5], [0.8, 0.5, 0.13, 0.5], [1.2, 0.9, 0.13, 0.5], [1.6, 0.1, 0.13, 0.4], [2.5, 0.5, 1.0, 0.5]]
"#;

/// Scene in which shapes that are not round drop onto the floor.
const SHAPES: &str = r#"
dim = 3
gravity = [0.0, -3.0, 0.0]
view = [[-0.9, 0.0, -0.6], [0.9, 0.7, 0.6]]

[[material]]
[[material]]
[[material]]

[[body]]
shape = "box"
n = 14
width = 0.45
at = [-0.85, 0.1, 0.0]
[[body.part]]
paint = 2
box = { centre = [0.225, 0.225, 0.45], half = [0.08, 0.08, 0.05] }

[[body]]
shape = "heart"
n = 24
width = 0.6
at = [-0.3, 0.1, -0.2]

[[body]]
shape = "empty"
n = 24
width = 0.6
at = [0.4, 0.05, -0.3]
[[body.part]]
fill = 3
ball = { centre = [0.3, 0.2, 0.3], radius = 0.18 }
[[body.part]]
fill = 3
box = { centre = [0.3, 0.45, 0.3], half = [0.04, 0.13, 0.04] }
[[body.part]]
fill = 2
box = { centre = [0.3, 0.3, 0.3], half = [0.26, 0.025, 0.05] }

[[obstacle]]
half_space = { normal = [0.0, 1.0, 0.0], point = [0.0, 0.0, 0.0] }

[[hand]]
radius = 0.1
path = [[0.0, -0.6, 1.0, 0.3], [0.5, -0.6, 1.0, 0.3], [1.5, -0.6, 0.3, 0.3]]
"#;

/// Pictures to draw: name, scene text (empty: the built-in scene of that name), moments [ticks], camera turn
/// [rad].
const TAKES: [(&str, &str, &[u64], f32); 4] = [
    ("tear-3d", "", &[1, 50, 62, 70, 80, 90, 110, 130, 149], 0.5),
    ("room", ROOM, &[1, 60, 100, 140], 0.35),
    ("shapes", SHAPES, &[1, 90], 0.3),
    ("crumble", CRUMBLE, &[40, 70, 100, 149], 0.2),
];

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let folder = arguments.next().ok_or("expected a folder to write to")?;
    let chosen: Vec<String> = arguments.collect();
    std::fs::create_dir_all(&folder)?;
    let (device, queue) = device()?;
    let mut renderer = Renderer::new(&device, wgpu::TextureFormat::Rgba8Unorm);
    let (candy, safe) = (Palette::candy(), Palette::colour_safe());
    for (take, text, moments, turn) in TAKES {
        let scene = match text {
            "" => Scene::open(take, &[])?,
            text => Scene::read(take, text, &[])?,
        };
        let names = |tick| {
            ["skin", "levels", "strains", "safe"].map(|look| format!("{take}-{tick:03}-{look}"))
        };
        let is_chosen =
            |name: &String| chosen.is_empty() || chosen.iter().any(|part| name.contains(part));
        if !moments
            .iter()
            .any(|&tick| names(tick).iter().any(is_chosen))
        {
            continue;
        }
        let mut world: World<Dim3> = scene.build()?;
        let mut ages = Ages::default();
        let baskets = scene.baskets::<Dim3>()?.into_iter();
        let baskets: Vec<_> = baskets
            .map(|region| Basket {
                region,
                fill: 0.3,
                colour: None,
            })
            .collect();
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
            let cut = Some(Cut {
                direction: Vec3::Z,
                share: 0.5,
            });
            let looks = [
                (Look::Skin, &candy, None),
                (elements(ElementColour::Level), &candy, cut),
                (elements(ElementColour::Strain), &candy, cut),
                (Look::Skin, &safe, None),
            ];
            let particles = dust(&world);
            for (name, (look, palette, cut)) in names(tick).into_iter().zip(looks) {
                if !is_chosen(&name) {
                    continue;
                }
                let [low, high] = if take == "tear-3d" {
                    [Vec3::ZERO, Vec3::ONE]
                } else {
                    scene.view.map(Vec3::from)
                };
                let camera = Camera {
                    cut,
                    azimuth: turn,
                    ..Camera::fit(low, high, SIZE)
                };
                let frame = Frame {
                    look,
                    baskets: baskets.clone(),
                    particles: &particles,
                    seconds: tick as f64 / 60.0,
                    ..Frame::new(camera, palette)
                };
                let begin = Instant::now();
                let image = renderer.render_to_image(&device, &queue, &world, &frame, SIZE)?;
                let path = Path::new(&folder).join(format!("{name}.png"));
                println!("{} {:?}", path.display(), begin.elapsed());
                write(&path, &image, SIZE)?;
            }
        }
    }
    Ok(())
}

/// Returns particles beside the first hand, to show how particles look.
fn dust(world: &World<Dim3>) -> Vec<Particle> {
    let mut bodies = world.rigid_bodies().map(|(_, body)| body);
    let Some(hand) = bodies.find(|body| body.follows_target()) else {
        return Vec::new();
    };
    let around = (0..12).map(|k| {
        let (angle, reach) = (k as f32 * 2.4, 1.3 + 0.08 * k as f32);
        let reach = reach * hand.shape().inradius();
        let by = Vec3::new(reach * angle.cos(), 0.02 * k as f32, reach * angle.sin());
        Particle {
            at: hand.position() + by,
            radius: 0.006 + 0.001 * k as f32,
            colour: [1.0, 0.72, 0.66, 1.0 - 0.06 * k as f32],
        }
    });
    around.collect()
}
