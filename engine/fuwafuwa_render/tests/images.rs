//! 2D pictures on any graphics adapter, Mesa's llvmpipe included. The tests that draw are ignored by default,
//! because they fail without an adapter; `cargo xtask test` runs them.

mod shared;

use fuwafuwa::{
    Blade, Dim, Dim2, Grading, Law, Material, PieceId, RigidBody, Shape, SoftBody, Vec2, Vec3,
    VoxelGrid, World, WorldConfig,
};
use fuwafuwa_render::frame::ElementColour;
use fuwafuwa_render::{
    Basket, Camera, Colour, Frame, ImageStage, Look, Palette, Particle, Renderer, image,
};
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
    world: &World<Dim2>,
    format: TextureFormat,
    change: impl Fn(&mut Frame<'a>),
) -> Picture {
    let (device, queue) = device();
    let camera = Camera::fit(Vec2::splat(-0.1), Vec2::splat(1.1), SIZE);
    let mut frame = Frame::new(camera, &PALETTE);
    change(&mut frame);
    let mut renderer = Renderer::new(&device, format);
    let pixels = renderer.render_to_image(&device, &queue, world, &frame, SIZE);
    let pixels = pixels.expect("rendering an image");
    Picture { camera, pixels }
}

impl Picture {
    /// Returns the bilinearly interpolated colour at a pixel.
    fn at_pixel(&self, [x, y]: [f32; 2]) -> Colour {
        let limit = |k: f32| k.clamp(0.5, SIZE[0] as f32 - 1.5);
        let (x, y) = (limit(x - 0.5), limit(y - 0.5));
        let pick = |x: f32, y: f32, k: usize| {
            f32::from(self.pixels[4 * (y as usize * SIZE[0] as usize + x as usize) + k]) / 255.0
        };
        [0, 1, 2].map(|k| {
            let (left, low) = (x.fract(), y.fract());
            let row = |y: f32| pick(x, y, k) * (1.0 - left) + pick(x + 1.0, y, k) * left;
            row(y) * (1.0 - low) + row(y + 1.0) * low
        })
    }

    /// Returns the mean colour around a point [m].
    fn around(&self, at: [f32; 2]) -> Colour {
        let [x, y] = self.camera.to_pixel(at.into(), SIZE);
        let mut sum = [0.0; 3];
        for k in 0..25 {
            let by = [(k % 5) as f32 - 2.0, (k / 5) as f32 - 2.0];
            let colour = self.at_pixel([x + by[0], y + by[1]]);
            (0..3).for_each(|k| sum[k] += colour[k] / 25.0);
        }
        sum
    }
}

fn floating() -> World<Dim2> {
    let gravity = Vec2::ZERO;
    let settings = WorldConfig {
        gravity,
        ..WorldConfig::default()
    };
    World::new(settings).unwrap()
}

/// Returns the first soft body of a world.
fn body_of(world: &World<Dim2>) -> &SoftBody<Dim2> {
    world.soft_bodies().next().unwrap().1
}

fn disc() -> World<Dim2> {
    let mut world = floating();
    let grid = VoxelGrid::ball(64, 1.0).unwrap();
    world
        .add_soft_body(SoftBody::new(grid, &[Material::default()]).unwrap())
        .unwrap();
    world
}

#[test]
#[ignore = "needs a graphics adapter, such as that of mesa-vulkan-drivers; `cargo xtask test` runs it"]
fn disc_is_warm_on_a_cool_floor_with_a_smooth_edge() {
    let world = disc();
    let picture = take(&world, TextureFormat::Rgba8Unorm, |_| ());
    assert!(is_warm(picture.around([0.5, 0.5])));
    let floor = picture.around([0.0, 1.0]);
    assert!(floor[2] > 0.8 && !is_warm(floor), "{floor:?}");

    let grid = body_of(&world).grid();
    let voxel = grid.voxel_size();
    let round = voxel * (grid.solid_count() as f32 / std::f32::consts::PI).sqrt();
    let warmth = |angle: f32, radius: f32| {
        let at = Vec2::splat(0.5) + radius * Vec2::from_angle(angle);
        let [red, _, blue] = picture.at_pixel(picture.camera.to_pixel(at, SIZE));
        red - blue
    };
    for degree in 0..360 {
        let angle = (degree as f32).to_radians();
        let half = 0.5 * (warmth(angle, round + 2.0 * voxel) + warmth(angle, round - voxel));
        // Searches inwards for the radius at which the colour is half-way between the warm body and the cool
        // floor.
        let steps = (0..400).map(|k| round + (2.0 - 0.01 * k as f32) * voxel);
        let edge = steps
            .into_iter()
            .find(|&radius| warmth(angle, radius) > half);
        let edge = edge.expect("an edge along the ray");
        let off = (edge - round).abs() / voxel;
        assert!(off < 0.25, "{off} voxels off at {degree}°");
    }
}

#[test]
#[ignore = "needs a graphics adapter, such as that of mesa-vulkan-drivers; `cargo xtask test` runs it"]
fn torn_face_is_paler_than_inside() {
    let mut world = disc();
    let soft = world.nth_soft_body(0).unwrap();
    let blade = Blade::segment(Vec2::new(0.5, -1.0), Vec2::new(0.5, 2.0));
    world.cut(soft, &blade).unwrap();
    let body = world.soft_body_mut(soft).unwrap();
    let ids: Vec<_> = body.mesh().nodes().map(|(id, _)| id).collect();
    let pieces: Vec<_> = ids.iter().map(|&id| body.pieces().of_node(id)).collect();
    for (id, piece) in ids.into_iter().zip(pieces) {
        let at = body.node_state(id).0;
        let apart = if piece == PieceId(0) { 0.05 } else { -0.05 };
        body.set_node_state(id, at + apart * Vec2::X, Vec2::ZERO)
            .unwrap();
    }
    let picture = take(&world, TextureFormat::Rgba8Unorm, |_| ());
    let gap = picture.around([0.5, 0.4]);
    assert!(!is_warm(gap), "{gap:?}");
    let paleness = |[red, green, blue]: Colour| (green + blue) / red;
    for side in [-1.0, 1.0] {
        // The drawn edge of the cut is rough, so the pale lip lies at 0.05 m or a little further inside.
        let lips = (0..20).map(|k| picture.around([0.5 + (0.052 + 0.001 * k as f32) * side, 0.4]));
        let lips = lips.filter(|&colour| is_warm(colour));
        let lip = lips.map(paleness).fold(0.0, f32::max);
        let inside = picture.around([0.5 + 0.2 * side, 0.4]);
        assert!(lip > paleness(inside) + 0.05, "{lip} {inside:?}");
    }
}

#[test]
#[ignore = "needs a graphics adapter, such as that of mesa-vulkan-drivers; `cargo xtask test` runs it"]
fn elements_have_the_colour_of_their_level() {
    let world = disc();
    let look = Look::Elements {
        colour: ElementColour::Level,
        ages: &[],
        nodes: true,
    };
    let picture = take(&world, TextureFormat::Rgba8Unorm, |frame| frame.look = look);
    let body = body_of(&world);
    let views: Vec<_> = body
        .element_views()
        .filter(|view| view.level > 1 && view.children == Dim2::ALL_CORNERS)
        .collect();
    assert!(views.len() > 8, "{} large elements", views.len());
    for view in views {
        let corner = view.child_corners::<Dim2>(0)[3].truncate();
        let quarter = body.grid().voxel_size() * 0.5 * f32::from(1u8 << (view.level - 1));
        let seen = picture.around((corner - quarter).into());
        let wanted = PALETTE.level(view.level);
        assert!(
            difference(seen, wanted) < 0.12,
            "level {}: {seen:?}, not {wanted:?}",
            view.level
        );
    }
}

#[test]
#[ignore = "needs a graphics adapter, such as that of mesa-vulkan-drivers; `cargo xtask test` runs it"]
fn bars_hands_walls_basket_and_particles_are_visible() {
    let mut world = floating();
    let bar = Shape::capsule(Vec2::new(0.2, 0.9), Vec2::new(0.8, 0.9), 0.06);
    let wall = Shape::half_space(Vec2::Y, Vec2::new(0.0, 0.05));
    let hand = RigidBody::coupled(Shape::ball(0.1));
    for body in [
        RigidBody::fixed(bar),
        RigidBody::fixed(wall),
        hand.at(Vec2::new(0.2, 0.6)),
        hand.at(Vec2::new(0.5, 0.6)),
    ] {
        world.add_rigid_body(body).unwrap();
    }
    let region = Shape::cuboid(Vec2::splat(0.12)).translated(Vec2::new(0.85, 0.4));
    let particle = Particle {
        at: Vec3::new(0.3, 0.25, 0.0),
        radius: 0.05,
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
    let floor = picture.around([0.55, 0.3]);
    let [bar, wall, first, second, basket, dust] = [
        [0.5, 0.9],
        [0.5, 0.0],
        [0.2, 0.6],
        [0.5, 0.6],
        [0.85, 0.4],
        [0.3, 0.25],
    ]
    .map(|at| picture.around(at));
    for (name, seen) in [
        ("bar", bar),
        ("wall", wall),
        ("basket", basket),
        ("dust", dust),
    ] {
        assert!(
            difference(seen, floor) > 0.08,
            "{name}: {seen:?} on {floor:?}"
        );
    }
    assert!(bar[0] > bar[2] + 0.15 && dust[0] > dust[1] + 0.4);
    assert!(difference(first, second) > 0.2, "{first:?} {second:?}");
}

#[test]
#[ignore = "needs a graphics adapter, such as that of mesa-vulkan-drivers; `cargo xtask test` runs it"]
fn picture_is_equal_in_every_format() {
    let world = disc();
    let formats = [
        TextureFormat::Rgba8Unorm,
        TextureFormat::Bgra8Unorm,
        TextureFormat::Rgba8UnormSrgb,
    ];
    let pictures = formats.map(|format| take(&world, format, |_| ()));
    for picture in &pictures {
        for at in [[0.5, 0.5], [0.0, 0.0], [0.3, 0.7], [0.5, 0.1]] {
            let (seen, wanted) = (picture.around(at), pictures[0].around(at));
            assert!(difference(seen, wanted) < 0.06, "{seen:?}, not {wanted:?}");
        }
    }
}

#[test]
#[ignore = "needs a graphics adapter, such as that of mesa-vulkan-drivers; `cargo xtask test` runs it"]
fn empty_worlds_and_skinless_bodies_render_in_every_size() {
    let (device, queue) = device();
    let palette = Palette::colour_safe();
    let camera = Camera::fit(Vec2::ZERO, Vec2::ONE, [7, 5]);
    let mut renderer = Renderer::new(&device, TextureFormat::Rgba8Unorm);
    let mut coarse = floating();
    let grid = VoxelGrid::ball(32, 1.0).unwrap();
    let body = SoftBody::with_options(
        grid,
        &[Material::default()],
        Law::default(),
        Grading::Coarse,
    );
    coarse.add_soft_body(body.unwrap()).unwrap();
    let elements = Look::Elements {
        colour: ElementColour::Level,
        ages: &[],
        nodes: false,
    };
    for size in [[64, 48], [7, 5], [300, 2], [1, 1]] {
        let mut image = |world: &World<Dim2>, look| {
            let frame = Frame {
                look,
                ..Frame::new(camera, &palette)
            };
            let image = renderer.render_to_image(&device, &queue, world, &frame, size);
            image.unwrap()
        };
        let bare = image(&floating(), Look::Skin);
        assert_eq!(bare.len(), 4 * (size[0] * size[1]) as usize);
        // The body with coarse grading has elements but no skin, so the skin view shows an empty picture.
        assert_eq!(bare, image(&coarse, Look::Skin));
        let middle = 4 * (size[1] / 2 * size[0] + size[0] / 2) as usize;
        let shown = &image(&coarse, elements)[middle..middle + 3];
        let floor = &bare[middle..middle + 3];
        let apart = shown.iter().zip(floor).map(|(a, b)| a.abs_diff(*b)).max();
        assert!(apart > Some(40), "{size:?}: {shown:?} on {floor:?}");
    }
}

#[test]
#[ignore = "needs a graphics adapter, such as that of mesa-vulkan-drivers; `cargo xtask test` runs it"]
fn window_larger_than_the_texture_limit_is_drawn_smaller() {
    let (device, queue) = device();
    assert_eq!(device.limits().max_texture_dimension_2d, 2048);
    let mut renderer = Renderer::new(&device, TextureFormat::Rgba8Unorm);
    let size = [2560, 800];
    let frame = Frame::new(Camera::fit(Vec2::ZERO, Vec2::ONE, size), &PALETTE);
    let mut encoder = device.create_command_encoder(&Default::default());
    renderer.prepare(&device, &queue, &mut encoder, &disc(), &frame, size);
    queue.submit([encoder.finish()]);

    let refused = renderer.render_to_image(&device, &queue, &disc(), &frame, size);
    let refused = refused.unwrap_err().to_string();
    assert!(
        refused.contains("2560 x 800") && refused.contains("2048"),
        "{refused}"
    );
}

#[test]
#[ignore = "needs a graphics adapter, such as that of mesa-vulkan-drivers; `cargo xtask test` runs it"]
fn vertices_beyond_the_buffer_limit_are_dropped() {
    let limits = wgpu::Limits {
        max_buffer_size: 50_000,
        ..wgpu::Limits::downlevel_webgl2_defaults()
    };
    let (device, queue) = device_with(limits);
    let mut world = floating();
    let grid = VoxelGrid::ball(40, 1.0).unwrap();
    let body = SoftBody::with_options(
        grid,
        &[Material::default()],
        Law::default(),
        Grading::Uniform,
    );
    world.add_soft_body(body.unwrap()).unwrap();
    let mut renderer = Renderer::new(&device, TextureFormat::Rgba8Unorm);
    let size = [96, 96];
    let mut frame = Frame::new(Camera::fit(Vec2::ZERO, Vec2::ONE, size), &PALETTE);
    for colour in [None, Some(ElementColour::Level)] {
        frame.look = colour.map_or(Look::Skin, |colour| Look::Elements {
            colour,
            ages: &[],
            nodes: true,
        });
        let image = renderer.render_to_image(&device, &queue, &world, &frame, size);
        assert!(image.is_ok());
    }
}

#[test]
#[ignore = "needs a graphics adapter, such as that of mesa-vulkan-drivers; `cargo xtask test` runs it"]
fn paint_rigid_draws_hands_but_no_bodies() {
    let mut world = disc();
    let hand = RigidBody::coupled(Shape::ball(0.1)).at(Vec2::splat(0.5));
    world.add_rigid_body(hand).unwrap();
    let camera = Camera::fit(Vec2::splat(-0.1), Vec2::splat(1.1), SIZE);
    let half = |paint: fn(&Renderer, &mut wgpu::RenderPass<'static>)| {
        let (device, queue) = device();
        let format = TextureFormat::Rgba8Unorm;
        let frame = Frame::new(camera, &PALETTE);
        let mut renderer = Renderer::new(&device, format);
        let pixels = image(&device, &queue, (format, SIZE), |step| match step {
            ImageStage::Prepare(encoder) => {
                renderer.prepare(&device, &queue, encoder, &world, &frame, SIZE);
            }
            ImageStage::Paint(pass) => paint(&renderer, pass),
        });
        let pixels = pixels.expect("rendering an image");
        let picture = Picture { camera, pixels };
        let at = |x| picture.at_pixel(camera.to_pixel(Vec2::new(x, 0.5), SIZE));
        [at(0.52), at(0.8)]
    };
    let [under, body] = half(Renderer::paint_bodies);
    let [hand, beside] = half(Renderer::paint_rigid);
    assert!(is_warm(under) && is_warm(body), "{under:?} {body:?}");
    assert!(hand[2] > hand[0] + 0.2, "{hand:?}");
    assert!(!is_warm(beside), "bodies are not painted again: {beside:?}");
}

#[test]
#[ignore = "needs a graphics adapter, such as that of mesa-vulkan-drivers; `cargo xtask test` runs it"]
fn cost_is_equal_for_equal_pictures() {
    let (device, queue) = device();
    let world = disc();
    let camera = Camera::fit(Vec2::ZERO, Vec2::ONE, SIZE);
    let mut renderer = Renderer::new(&device, TextureFormat::Rgba8Unorm);
    let mut cost = |particles: &[Particle]| {
        let frame = Frame {
            particles,
            ..Frame::new(camera, &PALETTE)
        };
        let image = renderer.render_to_image(&device, &queue, &world, &frame, SIZE);
        image.expect("rendering an image");
        renderer.take_cost()
    };
    let bare = cost(&[]);
    assert!(bare.draws > 10 && bare.bytes > 1000, "{bare:?}");
    assert_eq!(cost(&[]), bare);
    let speck = Particle {
        at: Vec3::splat(0.5),
        radius: 0.01,
        colour: [1.0; 4],
    };
    let [one, ten] = [1, 10].map(|count| cost(&vec![speck; count]));
    // All particles are drawn in one call.
    assert_eq!([one.draws, ten.draws], [bare.draws; 2]);
    assert_eq!(ten.bytes - bare.bytes, 10 * (one.bytes - bare.bytes));
}

#[test]
fn renderer_is_send_sync_static() {
    fn is_kept<T: Send + Sync + 'static>() {}
    is_kept::<Renderer>();
}
