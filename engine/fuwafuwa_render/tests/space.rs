//! 3D pictures on any graphics adapter, Mesa's llvmpipe included. The tests that draw are ignored by default,
//! because they fail without an adapter; `cargo xtask test` runs them.

mod shared;

use fuwafuwa::{
    Blade, Dim3, Material, PieceId, RigidBody, Shape, SoftBody, Vec3, VoxelGrid, World, WorldConfig,
};
use fuwafuwa_render::frame::ElementColour;
use fuwafuwa_render::space::{Camera, Cut, Renderer};
use fuwafuwa_render::{Basket, Colour, Frame, Look, Mark, Palette, Particle, Sticker};
use shared::{device, device_with, difference, is_warm};
use std::sync::LazyLock;
use wgpu::TextureFormat;

const SIZE: [u32; 2] = [480, 480];
static PALETTE: LazyLock<Palette> = LazyLock::new(Palette::candy);

/// Picture with its camera.
struct Picture {
    camera: Camera,
    pixels: Vec<u8>,
}

fn take<'a>(
    world: &World<Dim3>,
    format: TextureFormat,
    change: impl Fn(&mut Frame<'a, Camera>),
) -> Picture {
    let (device, queue) = device();
    let mut frame = Frame::new(Camera::fit(Vec3::ZERO, Vec3::ONE, SIZE), &PALETTE);
    change(&mut frame);
    let mut renderer = Renderer::new(&device, format);
    let pixels = renderer.render_to_image(&device, &queue, world, &frame, SIZE);
    let (camera, pixels) = (frame.camera, pixels.expect("rendering an image"));
    Picture { camera, pixels }
}

impl Picture {
    /// Returns the mean colour around a pixel.
    fn at_pixel(&self, [x, y]: [f32; 2], reach: i32) -> Colour {
        let mut sum = [0.0; 3];
        let count = ((2 * reach + 1) * (2 * reach + 1)) as f32;
        for by_y in -reach..=reach {
            for by_x in -reach..=reach {
                let limit = |k: f32, by: i32, side: u32| (k as i32 + by).clamp(0, side as i32 - 1);
                let (x, y) = (limit(x, by_x, SIZE[0]), limit(y, by_y, SIZE[1]));
                let first = 4 * (y as usize * SIZE[0] as usize + x as usize);
                for (k, sum) in sum.iter_mut().enumerate() {
                    *sum += f32::from(self.pixels[first + k]) / 255.0 / count;
                }
            }
        }
        sum
    }

    /// Returns the mean colour around the pixel of a point [m].
    fn around(&self, at: impl Into<Vec3>) -> Colour {
        self.at_pixel(self.camera.to_pixel(at.into(), SIZE).unwrap(), 2)
    }
}

fn floating() -> World<Dim3> {
    let gravity = Vec3::ZERO;
    let settings = WorldConfig {
        gravity,
        ..WorldConfig::default()
    };
    let mut world = World::new(settings).unwrap();
    let floor = Shape::half_space(Vec3::Y, Vec3::ZERO);
    world.add_rigid_body(RigidBody::fixed(floor)).unwrap();
    world
}

fn ball() -> World<Dim3> {
    let mut world = floating();
    let grid = VoxelGrid::ball(32, 1.0).unwrap();
    world
        .add_soft_body(SoftBody::new(grid, &[Material::default()]).unwrap())
        .unwrap();
    world
}

fn lightness([red, green, blue]: Colour) -> f32 {
    0.3 * red + 0.6 * green + 0.1 * blue
}

#[test]
#[ignore = "needs a graphics adapter, such as that of mesa-vulkan-drivers; `cargo xtask test` runs it"]
fn ball_is_warm_on_a_cool_floor_with_a_round_edge_and_a_shadow() {
    let picture = take(&ball(), TextureFormat::Rgba8Unorm, |_| ());
    let [x, y] = picture.camera.to_pixel(Vec3::splat(0.5), SIZE).unwrap();
    assert!(is_warm(picture.at_pixel([x, y], 2)));
    let floor = picture.around([-0.3, 0.0, 1.0]);
    assert!(!is_warm(floor) && lightness(floor) > 0.85, "{floor:?}");
    // The light comes from the left, the front and above.
    let shadow = picture.around([1.0, 0.0, 0.5]);
    assert!(
        lightness(shadow) < lightness(floor) - 0.1,
        "{shadow:?} {floor:?}"
    );
    let below = picture.around([0.5, 0.0, 0.7]);
    assert!(
        lightness(below) < lightness(floor) - 0.1,
        "{below:?} {floor:?}"
    );

    // Radius at which the warm colour of the ball ends, in each direction. It deviates from a circle by less
    // than a voxel staircase would.
    let edges: Vec<f32> = (0..180)
        .map(|k| {
            let (sin, cos) = (k as f32 / 180.0 * std::f32::consts::TAU).sin_cos();
            let warmth = |radius: f32| {
                let [red, _, blue] = picture.at_pixel([x + radius * cos, y + radius * sin], 0);
                red - blue
            };
            let found = (0..200)
                .map(|k| 200.0 - k as f32)
                .find(|&radius| warmth(radius) > 0.2);
            found.expect("an edge along the ray")
        })
        .collect();
    let voxel = edges.iter().sum::<f32>() / 180.0 * 2.0 / 32.0;
    for k in 0..180 {
        let near = (0..13).map(|by| edges[(k + by) % 180]).sum::<f32>() / 13.0;
        let off = (edges[(k + 6) % 180] - near).abs() / voxel;
        assert!(off < 0.25, "{off} voxels off at {}°", 2 * k);
    }
}

#[test]
#[ignore = "needs a graphics adapter, such as that of mesa-vulkan-drivers; `cargo xtask test` runs it"]
fn torn_face_is_paler_and_closed_cut_shows_no_gap() {
    let mut world = ball();
    let soft = world.nth_soft_body(0).unwrap();
    let whole = take(&world, TextureFormat::Rgba8Unorm, |_| ());
    let corner = Vec3::new(0.5, -0.2, -0.2);
    let blade = Blade::parallelogram(corner, 1.4 * Vec3::Y, 1.4 * Vec3::Z);
    world.cut(soft, &blade).unwrap();
    let closed = take(&world, TextureFormat::Rgba8Unorm, |_| ());
    let body = world.soft_body_mut(soft).unwrap();
    let ids: Vec<_> = body.mesh().nodes().map(|(id, _)| id).collect();
    let left = (ids.iter()).find(|&&id| body.mesh().node(id).at[0] < 8);
    let left = body.pieces().of_node(*left.unwrap());
    for id in ids {
        let at = body.node_state(id).0;
        let far = if body.pieces().of_node(id) == left {
            0.0
        } else {
            20.0
        };
        body.set_node_state(id, at + far * Vec3::X, Vec3::ZERO)
            .unwrap();
    }
    let from_right = |frame: &mut Frame<'_, Camera>| frame.camera.azimuth = 1.0;
    let open = take(&world, TextureFormat::Rgba8Unorm, from_right);
    // A closed cut looks whole: the skin has the same colour all along it.
    for k in 0..20 {
        let rise = -0.4 + 0.07 * k as f32;
        let at = Vec3::splat(0.5) + 0.48 * Vec3::new(0.0, rise.sin(), rise.cos());
        let [x, y] = closed.camera.to_pixel(at, SIZE).unwrap();
        for by in -3..=3 {
            let [seen, expected] =
                [&closed, &whole].map(|picture| picture.at_pixel([x + by as f32, y], 0));
            assert!(
                difference(seen, expected) < 0.1,
                "{seen:?}, not {expected:?} at {at:?}"
            );
        }
    }
    let inside = open.around([0.5, 0.5, 0.5]);
    let skin = open.around([0.4, 0.5, 0.97]);
    let paleness = |[red, green, blue]: Colour| (green + blue) / red;
    assert!(
        paleness(inside) > paleness(skin) + 0.1,
        "{inside:?} {skin:?}"
    );
}

#[test]
#[ignore = "needs a graphics adapter, such as that of mesa-vulkan-drivers; `cargo xtask test` runs it"]
fn cut_element_view_shows_the_colour_of_levels() {
    let world = ball();
    let picture = take(&world, TextureFormat::Rgba8Unorm, |frame| {
        frame.look = Look::Elements {
            colour: ElementColour::Level,
            ages: &[],
            nodes: false,
        };
        frame.camera.cut = Some(Cut {
            direction: Vec3::Z,
            share: 0.5,
        });
        frame.camera.elevation = 0.1;
    });
    let hue = |[red, green, blue]: Colour| [red / green, blue / green, 0.0];
    let mut count = 0;
    let (_, body) = world.soft_bodies().next().unwrap();
    for view in body.element_views() {
        let width = body.grid().voxel_size() * f32::from(1u8 << view.level);
        let middle = view.slots[13];
        // Skips elements whose front face is not in the cut plane.
        if view.level < 2 || view.children != 255 || (middle.z + 0.5 * width - 0.5).abs() > 1e-3 {
            continue;
        }
        let seen = picture.around((middle + 0.2 * width).with_z(0.5));
        let wanted = PALETTE.level(view.level);
        assert!(
            difference(hue(seen), hue(wanted)) < 0.2,
            "level {}: {seen:?}, not {wanted:?}",
            view.level
        );
        count += 1;
    }
    assert!(count > 8, "{count} large elements");
}

#[test]
#[ignore = "needs a graphics adapter, such as that of mesa-vulkan-drivers; `cargo xtask test` runs it"]
fn sticker_is_visible_from_its_side_and_not_through_a_bar() {
    let outline = [[-0.3, -0.3], [0.3, -0.3], [0.3, 0.3], [-0.3, 0.3]].to_vec();
    let mark = Mark {
        outline,
        colour: [0.1, 0.2, 0.9, 1.0],
        bulge: 0.05,
        lift: 0.0,
    };
    let sticker = Sticker {
        body: 0,
        piece: PieceId(0),
        origin: Vec3::splat(0.5),
        axes: Vec3::AXES.map(|axis| 0.5 * axis),
        marks: vec![mark],
    };
    let stickers = [sticker];
    let is_seen = |world: &World<Dim3>, turn: f32| {
        let picture = take(world, TextureFormat::Rgba8Unorm, |frame| {
            frame.stickers = &stickers;
            frame.camera.azimuth = turn;
            frame.camera.elevation = 0.0;
        });
        let [red, _, blue] = picture.around([0.5; 3]);
        blue > red + 0.3
    };
    let mut world = ball();
    let from_the_front = is_seen(&world, 0.0);
    assert!(from_the_front);
    assert!(!is_seen(&world, std::f32::consts::PI));
    let bar = Shape::capsule(Vec3::new(0.0, 0.5, 1.2), Vec3::new(1.0, 0.5, 1.2), 0.1);
    world.add_rigid_body(RigidBody::fixed(bar)).unwrap();
    assert!(!is_seen(&world, 0.0));
}

#[test]
#[ignore = "needs a graphics adapter, such as that of mesa-vulkan-drivers; `cargo xtask test` runs it"]
fn ghost_is_transparent_and_hidden_by_an_equal_body() {
    let (world, mut ghost) = (floating(), floating());
    let grid = VoxelGrid::ball(16, 1.0).unwrap();
    ghost
        .add_soft_body(SoftBody::new(grid, &[Material::default()]).unwrap())
        .unwrap();
    let middle = |world: &World<Dim3>, ghost| {
        let picture = take(world, TextureFormat::Rgba8Unorm, |frame| {
            frame.ghost = ghost
        });
        picture.around([0.5; 3])
    };
    let floor = middle(&world, None);
    let seen = middle(&world, Some(&ghost));
    let less = lightness(floor) - lightness(seen);
    assert!((0.03..0.3).contains(&less), "{floor:?} {seen:?}");
    let alone = middle(&ghost, None);
    assert!(difference(alone, middle(&ghost, Some(&ghost))) < 0.01);
}

#[test]
#[ignore = "needs a graphics adapter, such as that of mesa-vulkan-drivers; `cargo xtask test` runs it"]
fn bars_hands_walls_basket_and_particles_are_visible() {
    let mut world = floating();
    let bar = Shape::capsule(Vec3::new(0.1, 0.1, 0.2), Vec3::new(0.4, 0.1, 0.2), 0.06);
    let wall = Shape::half_space(Vec3::Z, Vec3::new(0.0, 0.0, -0.6));
    let hand = RigidBody::coupled(Shape::ball(0.1));
    for body in [
        RigidBody::fixed(bar),
        RigidBody::fixed(wall),
        hand.at(Vec3::new(0.3, 0.9, -0.1)),
        hand.at(Vec3::new(0.7, 0.9, -0.1)),
    ] {
        world.add_rigid_body(body).unwrap();
    }
    let region = Shape::cuboid(Vec3::splat(0.15)).translated(Vec3::new(0.9, 0.2, 0.2));
    let particle = Particle {
        at: Vec3::new(0.5, 0.05, 0.5),
        radius: 0.04,
        colour: [0.8, 0.1, 0.1, 1.0],
    };
    let picture = take(&world, TextureFormat::Rgba8Unorm, |frame| {
        frame.baskets = vec![Basket {
            region,
            fill: 1.0,
            colour: None,
        }];
        frame.particles = std::slice::from_ref(&particle);
    });
    let floor = picture.around([0.5, 0.0, 0.7]);
    let bar = picture.around([0.2, 0.09, 0.26]);
    let [first, second] = [0.3, 0.7].map(|x| picture.around([x, 0.9, -0.1]));
    let (basket, dust) = (picture.around([0.9, 0.1, 0.3]), picture.around(particle.at));
    // Shadow straight below a hand.
    let below = picture.around([0.3, 0.0, -0.1]);
    let wall = picture.around([0.5, 0.05, -0.6]);
    for (name, seen) in [
        ("bar", bar),
        ("basket", basket),
        ("dust", dust),
        ("shadow", below),
        ("wall", wall),
    ] {
        assert!(
            difference(seen, floor) > 0.04,
            "{name}: {seen:?} on {floor:?}"
        );
    }
    assert!(bar[0] > bar[2] + 0.15, "{bar:?}");
    assert!(dust[0] > dust[1] + 0.3, "{dust:?}");
    assert!(difference(first, second) > 0.2, "{first:?} {second:?}");
}

#[test]
#[ignore = "needs a graphics adapter, such as that of mesa-vulkan-drivers; `cargo xtask test` runs it"]
fn picture_is_equal_in_every_format() {
    let formats = [
        TextureFormat::Rgba8Unorm,
        TextureFormat::Bgra8Unorm,
        TextureFormat::Rgba8UnormSrgb,
    ];
    let world = ball();
    let pictures = formats.map(|format| take(&world, format, |_| ()));
    for picture in &pictures {
        for at in [[0.5; 3], [0.0; 3], [1.0, 0.0, 1.0]] {
            let (seen, wanted) = (picture.around(at), pictures[0].around(at));
            assert!(difference(seen, wanted) < 0.06, "{seen:?}, not {wanted:?}");
        }
    }
}

#[test]
#[ignore = "needs a graphics adapter, such as that of mesa-vulkan-drivers; `cargo xtask test` runs it"]
fn small_targets_and_small_buffers_render_without_error() {
    let limits = wgpu::Limits {
        max_buffer_size: 100_000,
        ..wgpu::Limits::downlevel_webgl2_defaults()
    };
    let (device, queue) = device_with(limits);
    let mut renderer = Renderer::new(&device, TextureFormat::Rgba8Unorm);
    for (world, size) in [(ball(), [1, 1]), (floating(), [3, 200]), (ball(), [96, 96])] {
        let mut frame = Frame::new(Camera::fit(Vec3::ZERO, Vec3::ONE, size), &PALETTE);
        for colour in [None, Some(ElementColour::Strain)] {
            frame.look = colour.map_or(Look::Skin, |colour| Look::Elements {
                colour,
                ages: &[],
                nodes: true,
            });
            let image = renderer.render_to_image(&device, &queue, &world, &frame, size);
            assert_eq!(image.unwrap().len(), 4 * (size[0] * size[1]) as usize);
        }
    }
}

#[test]
fn renderer_is_send_sync_static() {
    fn is_kept<T: Send + Sync + 'static>() {}
    is_kept::<Renderer>();
}

#[test]
#[ignore = "needs a graphics adapter, such as that of mesa-vulkan-drivers; `cargo xtask test` runs it"]
fn unchanged_triangles_are_not_uploaded_again() {
    let (device, queue) = device();
    let world = ball();
    let frame = Frame::new(Camera::fit(Vec3::ZERO, Vec3::ONE, SIZE), &PALETTE);
    let mut renderer = Renderer::new(&device, TextureFormat::Rgba8Unorm);
    let mut cost = || {
        let image = renderer.render_to_image(&device, &queue, &world, &frame, SIZE);
        image.expect("rendering an image");
        renderer.take_cost()
    };
    let [first, second, third] = [(); 3].map(|()| cost());
    assert_eq!(first.draws, second.draws);
    assert!(second.bytes < first.bytes, "{first:?}, {second:?}");
    assert_eq!(second, third);
}
