//! 3D pictures on any graphics adapter, Mesa's llvmpipe included. The tests that draw are ignored by default,
//! because they fail without an adapter; `cargo xtask test` runs them.

mod shared;

use fuwafuwa::{
    Blade, Dim3, Material, PieceId, RigidBody, Shape, SoftBody, VoxelGrid, World, WorldConfig,
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
) -> Option<Picture> {
    let (device, queue) = device()?;
    let mut frame = Frame::new(Camera::fit([0.0; 3], [1.0; 3], SIZE), &PALETTE);
    change(&mut frame);
    let mut renderer = Renderer::new(&device, format);
    let pixels = renderer.render_to_image(&device, &queue, world, &frame, SIZE);
    let (camera, pixels) = (frame.camera, pixels.expect("rendering an image"));
    Some(Picture { camera, pixels })
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
    fn around(&self, at: [f32; 3]) -> Colour {
        self.at_pixel(self.camera.to_pixel(at, SIZE).unwrap(), 2)
    }
}

fn floating() -> World<Dim3> {
    let gravity = [0.0; 3];
    let settings = WorldConfig {
        gravity,
        ..WorldConfig::default()
    };
    let mut world = World::new(settings).unwrap();
    let floor = Shape::half_space([0.0, 1.0, 0.0], [0.0; 3]);
    world
        .add_rigid_body(RigidBody::fixed(floor).with_friction(0.2))
        .unwrap();
    world
}

fn ball() -> World<Dim3> {
    let mut world = floating();
    let grid = VoxelGrid::ball(32, 1.0).unwrap();
    world.add_soft_body(SoftBody::new(grid, &[Material::default()]).unwrap());
    world
}

fn lightness([red, green, blue]: Colour) -> f32 {
    0.3 * red + 0.6 * green + 0.1 * blue
}

#[test]
fn ball_is_warm_on_a_cool_floor_with_a_round_edge_and_a_shadow() {
    let Some(picture) = take(&ball(), TextureFormat::Rgba8Unorm, |_| ()) else {
        return;
    };
    let [x, y] = picture.camera.to_pixel([0.5; 3], SIZE).unwrap();
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

    // The edge is the radius where warmth ends. It deviates from a circle by less than a voxel staircase
    // would.
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
fn torn_face_is_paler_and_closed_cut_shows_no_gap() {
    let mut world = ball();
    let (from, across, along) = ([0.5, -0.2, -0.2], [0.0, 1.4, 0.0], [0.0, 0.0, 1.4]);
    world
        .cut(
            world.nth_soft_body(0).unwrap(),
            &Blade {
                from,
                across,
                along,
            },
        )
        .unwrap();
    let closed = take(&world, TextureFormat::Rgba8Unorm, |_| ());
    let body = world
        .soft_body_mut(world.nth_soft_body(0).unwrap())
        .unwrap();
    let ids: Vec<_> = body.mesh().nodes().map(|(id, _)| id).collect();
    let left = (ids.iter()).find(|&&id| body.mesh().node(id).at[0] < 8);
    let left = body.pieces().of_node(*left.unwrap());
    for id in ids {
        let [x, y, z] = body.node_state(id).0;
        let far = if body.pieces().of_node(id) == left {
            0.0
        } else {
            20.0
        };
        body.set_node_state(id, [x + far, y, z], [0.0; 3]);
    }
    let from_right = |frame: &mut Frame<'_, Camera>| frame.camera.azimuth = 1.0;
    let (Some(closed), Some(open)) = (closed, take(&world, TextureFormat::Rgba8Unorm, from_right))
    else {
        return;
    };
    // A closed cut looks whole: the skin is warm all along it.
    for k in 0..20 {
        let rise = -0.4 + 0.07 * k as f32;
        let at = [0.5, 0.5 + 0.48 * rise.sin(), 0.5 + 0.48 * rise.cos()];
        let [x, y] = closed.camera.to_pixel(at, SIZE).unwrap();
        for by in -3..=3 {
            let seen = closed.at_pixel([x + by as f32, y], 0);
            assert!(is_warm(seen), "{seen:?} at {at:?}");
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
fn cut_element_view_shows_the_colour_of_levels() {
    let world = ball();
    let picture = take(&world, TextureFormat::Rgba8Unorm, |frame| {
        frame.look = Look::Elements {
            colour: ElementColour::Level,
            ages: &[],
            nodes: false,
        };
        frame.camera.cut = Some(Cut {
            direction: [0.0, 0.0, 1.0],
            share: 0.5,
        });
        frame.camera.elevation = 0.1;
    });
    let hue = |[red, green, blue]: Colour| [red / green, blue / green, 0.0];
    let mut count = 0;
    for view in world.soft_bodies().next().unwrap().1.element_views() {
        let width = world.soft_bodies().next().unwrap().1.grid().voxel_size()
            * f32::from(1u8 << view.level);
        let [x, y, z] = view.slots[13];
        // Only elements with their front face in the cut.
        if view.level < 2 || view.children != 255 || (z + 0.5 * width - 0.5).abs() > 1e-3 {
            continue;
        }
        let seen = picture.around([x + 0.2 * width, y + 0.2 * width, 0.5]);
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
        origin: [0.5; 3],
        axes: [[0.5, 0.0, 0.0], [0.0, 0.5, 0.0], [0.0, 0.0, 0.5]],
        marks: vec![mark],
    };
    let stickers = [sticker];
    let is_seen = |world: &World<Dim3>, turn: f32| {
        let picture = take(world, TextureFormat::Rgba8Unorm, |frame| {
            frame.stickers = &stickers;
            frame.camera.azimuth = turn;
            frame.camera.elevation = 0.0;
        });
        let [red, _, blue] = picture?.around([0.5; 3]);
        Some(blue > red + 0.3)
    };
    let mut world = ball();
    let Some(from_the_front) = is_seen(&world, 0.0) else {
        return;
    };
    assert!(from_the_front);
    assert_eq!(is_seen(&world, std::f32::consts::PI), Some(false));
    let (from, to, radius) = ([0.0, 0.5, 1.2], [1.0, 0.5, 1.2], 0.1);
    let bar = Shape::Capsule { from, to, radius };
    world
        .add_rigid_body(RigidBody::fixed(bar).with_friction(0.2))
        .unwrap();
    assert_eq!(is_seen(&world, 0.0), Some(false));
}

#[test]
fn ghost_is_transparent_and_hidden_by_an_equal_body() {
    let (world, mut ghost) = (floating(), floating());
    let grid = VoxelGrid::ball(16, 1.0).unwrap();
    ghost.add_soft_body(SoftBody::new(grid, &[Material::default()]).unwrap());
    let middle = |world: &World<Dim3>, ghost| {
        let picture = take(world, TextureFormat::Rgba8Unorm, |frame| {
            frame.ghost = ghost
        });
        Some(picture?.around([0.5; 3]))
    };
    let Some(floor) = middle(&world, None) else {
        return;
    };
    let seen = middle(&world, Some(&ghost)).unwrap();
    let less = lightness(floor) - lightness(seen);
    assert!((0.03..0.3).contains(&less), "{floor:?} {seen:?}");
    let alone = middle(&ghost, None).unwrap();
    assert!(difference(alone, middle(&ghost, Some(&ghost)).unwrap()) < 0.01);
}

#[test]
fn bars_hands_walls_basket_and_particles_are_visible() {
    let mut world = floating();
    let (from, to, radius) = ([0.1, 0.1, 0.2], [0.4, 0.1, 0.2], 0.06);
    let bar = Shape::Capsule { from, to, radius };
    world
        .add_rigid_body(RigidBody::fixed(bar).with_friction(0.2))
        .unwrap();
    let wall = Shape::half_space([0.0, 0.0, 1.0], [0.0, 0.0, -0.6]);
    world
        .add_rigid_body(RigidBody::fixed(wall).with_friction(0.2))
        .unwrap();
    for x in [0.3, 0.7] {
        let hand = RigidBody::coupled(Shape::ball(0.1)).at([x, 0.9, -0.1]);
        world.add_rigid_body(hand).unwrap();
    }
    let region = Shape::Box {
        centre: [0.9, 0.2, 0.2],
        half: [0.15, 0.15, 0.15],
    };
    let particle = Particle {
        at: [0.5, 0.05, 0.5],
        radius: 0.04,
        colour: [0.8, 0.1, 0.1, 1.0],
    };
    let picture = take(&world, TextureFormat::Rgba8Unorm, |frame| {
        frame.basket = Some(Basket { region, fill: 1.0 });
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
fn picture_is_equal_in_every_format() {
    let formats = [
        TextureFormat::Rgba8Unorm,
        TextureFormat::Bgra8Unorm,
        TextureFormat::Rgba8UnormSrgb,
    ];
    let world = ball();
    let pictures = formats.map(|format| take(&world, format, |_| ()));
    for picture in pictures.iter().flatten() {
        for at in [[0.5; 3], [0.0; 3], [1.0, 0.0, 1.0]] {
            let wanted = pictures[0].as_ref().map(|first| first.around(at));
            let seen = picture.around(at);
            assert!(
                wanted.is_some_and(|wanted| difference(seen, wanted) < 0.06),
                "{seen:?}"
            );
        }
    }
}

#[test]
fn small_targets_and_small_buffers_render_without_error() {
    let limits = wgpu::Limits {
        max_buffer_size: 100_000,
        ..wgpu::Limits::downlevel_webgl2_defaults()
    };
    let Some((device, queue)) = device_with(limits) else {
        return;
    };
    let mut renderer = Renderer::new(&device, TextureFormat::Rgba8Unorm);
    for (world, size) in [(ball(), [1, 1]), (floating(), [3, 200]), (ball(), [96, 96])] {
        let mut frame = Frame::new(Camera::fit([0.0; 3], [1.0; 3], size), &PALETTE);
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
fn unchanged_triangles_are_not_uploaded_again() {
    let Some((device, queue)) = device() else {
        return;
    };
    let world = ball();
    let frame = Frame::new(Camera::fit([0.0; 3], [1.0; 3], SIZE), &PALETTE);
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
