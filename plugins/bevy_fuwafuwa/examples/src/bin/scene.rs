//! Soft bodies on a table, a tower of wooden boxes, and a hand. One soft body has eyes and a mouth, through
//! which the hand presses. The detached pieces hit the tower. The arrow keys move the hand, and Q and Z raise
//! and lower it. Before the first key press, the hand moves by itself.
//!
//! Run it with `cargo run -p bevy_fuwafuwa_examples --bin scene`, in `plugins/bevy_fuwafuwa`. With `--
//! FOLDER` at the end, the program saves pictures of some moments in the folder, at maximum speed, and exits.

use bevy::asset::RenderAssetUsages;
use bevy::core_pipeline::tonemapping::Tonemapping;
use bevy::light::{CascadeShadowConfigBuilder, GlobalAmbientLight};
use bevy::prelude::*;
use bevy::render::render_resource::{Extent3d, TextureDimension, TextureFormat};
use bevy::render::view::screenshot::{Screenshot, save_to_disk};
use bevy::time::TimeUpdateStrategy;
use bevy_fuwafuwa::convert::engine_vector;
use bevy_fuwafuwa::prelude::*;
use std::path::PathBuf;
use std::time::Duration;

/// Simulated time per frame when pictures are taken [s].
const TICK: f64 = 1.0 / 60.0;
/// Times at which pictures are taken [ticks].
const MOMENTS: [u32; 8] = [2, 14, 45, 85, 115, 135, 170, 280];
/// Frames before the first tick, for compiling shaders.
const START: u32 = 120;
/// Start position of the hand [m].
const HAND: Vec3 = Vec3::new(0.02, 1.5, 0.0);
const HAND_RADIUS: f32 = 0.16;
/// Position of the tower [m]; `BOX` is the width of one of its boxes [m].
const TOWER: Vec3 = Vec3::new(0.36, 0.0, 0.26);
const BOX: f32 = 0.18;
/// Width of the texture on one side of a wooden box [pixels].
const PIXELS: u32 = 128;

#[derive(Component)]
struct Hand;

/// Output folder of the pictures, and the number of frames drawn so far.
#[derive(Resource)]
struct Album(PathBuf, u32);

fn main() {
    let mut app = App::new();
    let window = Window {
        title: "bevy_fuwafuwa".into(),
        resolution: (960, 540).into(),
        ..default()
    };
    app.add_plugins(DefaultPlugins.set(WindowPlugin {
        primary_window: Some(window),
        ..default()
    }))
    .add_plugins(FuwafuwaPlugin3d::default())
    .insert_resource(Time::<Fixed>::from_seconds(TICK))
    .insert_resource(ClearColor(Color::srgb_u8(0xfb, 0xee, 0xdd)))
    .insert_resource(GlobalAmbientLight {
        color: Color::srgb_u8(0xe8, 0xee, 0xff),
        brightness: 560.0,
        ..default()
    })
    .add_systems(Startup, (light, furnish, put_bodies, stack_boxes))
    .add_systems(FixedUpdate, move_hand)
    .add_systems(Update, report);
    if let Some(folder) = std::env::args_os().nth(1) {
        let frame = Duration::from_secs_f64(TICK);
        app.insert_resource(Album(folder.into(), 0))
            .insert_resource(TimeUpdateStrategy::ManualDuration(frame))
            .add_systems(Update, take_pictures);
        app.world_mut().resource_mut::<SoftWorld<Dim3>>().pause();
    }
    app.run();
}

fn light(mut commands: Commands) {
    commands.spawn((
        Camera3d::default(),
        Tonemapping::None,
        Transform::from_xyz(0.45, 2.2, 3.0).looking_at(Vec3::new(0.05, 0.38, 0.05), Vec3::Y),
    ));
    commands.spawn((
        DirectionalLight {
            color: Color::srgb_u8(0xff, 0xf1, 0xdc),
            illuminance: 4300.0,
            shadow_maps_enabled: true,
            ..default()
        },
        CascadeShadowConfigBuilder {
            num_cascades: 1,
            maximum_distance: 12.0,
            ..default()
        }
        .build(),
        Transform::from_xyz(-2.0, 4.0, 2.5).looking_at(Vec3::ZERO, Vec3::Y),
    ));
}

fn furnish(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let mut matt = |hex: [u8; 3]| {
        let [red, green, blue] = hex;
        MeshMaterial3d(materials.add(StandardMaterial {
            base_color: Color::srgb_u8(red, green, blue),
            perceptual_roughness: 0.85,
            ..default()
        }))
    };
    let table = Mesh3d(meshes.add(Plane3d::default().mesh().size(40.0, 40.0)));
    commands.spawn((RigidBody3d::floor(), table, matt([0xea, 0xe5, 0xda])));
    let (half, radius) = (0.45 * Vec3::Y, 0.12);
    let log = Shape::capsule(engine_vector(-half), engine_vector(half), radius);
    let lying = Quat::from_rotation_y(0.9) * Quat::from_rotation_z(std::f32::consts::FRAC_PI_2);
    commands.spawn((
        RigidBody3d::fixed(log),
        Mesh3d(meshes.add(Capsule3d::new(radius, 0.9))),
        matt([0xe6, 0xb8, 0x77]),
        Transform::from_xyz(1.0, 0.12, 0.75).with_rotation(lying),
    ));
    commands.spawn((
        Hand,
        RigidBody3d::kinematic_ball(HAND_RADIUS),
        Mesh3d(meshes.add(Sphere::new(HAND_RADIUS))),
        matt([0x3f, 0x7f, 0xe0]),
        Transform::from_translation(HAND),
    ));
}

fn put_bodies(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let skin = MeshMaterial3d(materials.add(StandardMaterial {
        perceptual_roughness: 0.55,
        ..default()
    }));
    let [white, black] = [Color::WHITE, Color::srgb_u8(0x3a, 0x2b, 0x3f)];
    let [white, black] = [white, black].map(|colour| MeshMaterial3d(materials.add(colour)));
    let eye = Mesh3d(meshes.add(Sphere::new(0.1)));
    let pupil = Mesh3d(meshes.add(Sphere::new(0.05)));

    let firm = |strength: f32| SoftMaterial {
        elasticity: Elasticity {
            young: 12_000.0,
            poisson: 0.3,
        },
        strength,
        toughness: 0.2 * strength,
        ..default()
    };
    let tough = firm(8000.0);
    // Entities that are children of a soft body move with the body, here the eyes and the mouth. The parent
    // needs `Visibility` before its mesh exists.
    let ball = (SoftBody3d::ball(28, 1.1), SoftMaterials::from(firm(2600.0)));
    commands
        .spawn((
            ball,
            skin.clone(),
            Transform::from_xyz(-0.35, 0.75, 0.0),
            Visibility::default(),
        ))
        .with_children(|face| {
            let mouth =
                Transform::from_xyz(0.02, -0.07, 0.515).with_scale(Vec3::new(1.2, 0.8, 0.5));
            face.spawn((pupil.clone(), black.clone(), mouth));
            for side in [-1.0, 1.0] {
                let place = Vec3::new(0.15 * side + 0.02, 0.17, 0.47);
                face.spawn((
                    eye.clone(),
                    white.clone(),
                    Transform::from_translation(place),
                ));
                let place = place + Vec3::new(0.01 * side, 0.01, 0.065);
                face.spawn((
                    pupil.clone(),
                    black.clone(),
                    Transform::from_translation(place),
                ));
            }
        });
    let colours = |hex: u32| SoftColours {
        materials: vec![[hex >> 16 & 255, hex >> 8 & 255, hex & 255].map(|k| k as f32 / 255.0)],
        ..default()
    };
    commands.spawn((
        SoftBody3d::from(VoxelGrid::<Dim3>::flower(28, 0.95)),
        SoftMaterials::from(tough),
        colours(0xe58bc8),
        skin.clone(),
        Transform::from_xyz(0.85, 0.6, -0.5).with_rotation(Quat::from_rotation_x(-1.3)),
    ));
    commands.spawn((
        SoftBody3d::cube(14, 0.55),
        SoftMaterials::from(tough),
        colours(0x8fc46a),
        skin.clone(),
        Transform::from_xyz(-1.35, 0.8, 0.1).with_rotation(Quat::from_rotation_y(0.5)),
    ));
    commands.spawn((
        SoftBody3d::from(VoxelGrid::<Dim3>::ring(28, 0.9)),
        SoftMaterials::from(tough),
        colours(0xffb84d),
        skin,
        Transform::from_xyz(1.05, 0.75, 0.75).with_rotation(Quat::from_rotation_x(-1.3)),
    ));
}

/// Spawns a leaning tower of three boxes.
fn stack_boxes(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
    mut images: ResMut<Assets<Image>>,
) {
    let wood = MeshMaterial3d(materials.add(StandardMaterial {
        base_color_texture: Some(images.add(wood())),
        perceptual_roughness: 0.8,
        ..default()
    }));
    let cuboid = Mesh3d(meshes.add(Cuboid::from_length(BOX)));
    let shape = Shape::cuboid(engine_vector(Vec3::splat(0.5 * BOX)));
    for n in 0..3 {
        let n = n as f32;
        let place = TOWER + Vec3::new(0.05 * n, (n + 0.5) * BOX, 0.0);
        let turned = Quat::from_rotation_y(0.3 + 0.25 * n);
        commands.spawn((
            RigidBody3d::dynamic(shape, 0.6),
            cuboid.clone(),
            wood.clone(),
            Transform::from_translation(place).with_rotation(turned),
        ));
    }
}

/// Returns the texture of a box side: boards in a frame.
fn wood() -> Image {
    let pixel = |index: u32| {
        let [x, y] = [index % PIXELS, index / PIXELS].map(|k| k as f32 / PIXELS as f32);
        let edge = x.min(y).min(1.0 - x).min(1.0 - y);
        let is_frame = edge < 0.13;
        // Boards of the frame run upright at the left and right sides of the texture.
        let is_upright = is_frame && x.min(1.0 - x) < y.min(1.0 - y);
        let (along, across) = if is_upright { (y, x) } else { (x, y) };
        let board = (across * 4.0).floor();
        let waves = 40.0 * across + 1.5 * (5.0 * along + 2.0 * board).sin() + 3.0 * board;
        let grain = 0.5 + 0.5 * waves.sin();
        let seam = if is_frame {
            (0.13 - edge).min(edge + 0.015)
        } else {
            (edge - 0.13).min(0.25 * (0.5 - (across * 4.0 - board - 0.5).abs()))
        };
        let light = if is_frame { 1.0 } else { 0.88 };
        let shade = light * (1.0 - 0.14 * grain) * (0.62 + 0.38 * (seam / 0.015).min(1.0));
        let [red, green, blue] = [232.0, 178.0, 112.0].map(|own: f32| (own * shade) as u8);
        [red, green, blue, 255]
    };
    let size = Extent3d {
        width: PIXELS,
        height: PIXELS,
        depth_or_array_layers: 1,
    };
    Image::new(
        size,
        TextureDimension::D2,
        (0..PIXELS * PIXELS).flat_map(pixel).collect(),
        TextureFormat::Rgba8UnormSrgb,
        RenderAssetUsages::RENDER_WORLD,
    )
}

/// Presses the hand down through the ball and lifts it again. After the first key press, the keys move the
/// hand.
fn move_hand(
    keys: Res<ButtonInput<KeyCode>>,
    world: Res<SoftWorld<Dim3>>,
    mut hand: Single<&mut Transform, With<Hand>>,
    mut is_taken: Local<bool>,
) {
    let axis = |less, more| {
        f32::from(u8::from(keys.pressed(more))) - f32::from(u8::from(keys.pressed(less)))
    };
    let by = Vec3::new(
        axis(KeyCode::ArrowLeft, KeyCode::ArrowRight),
        axis(KeyCode::KeyZ, KeyCode::KeyQ),
        axis(KeyCode::ArrowUp, KeyCode::ArrowDown),
    );
    *is_taken |= by != Vec3::ZERO;
    if *is_taken {
        hand.translation += 0.02 * by;
        hand.translation.y = hand.translation.y.max(HAND_RADIUS);
        return;
    }
    let ticks = world.engine().ticks() as f32;
    let share = |from: f32, to: f32| ((ticks - from) / (to - from)).clamp(0.0, 1.0);
    let down = share(70.0, 140.0) - share(170.0, 240.0);
    hand.translation = HAND - Vec3::Y * (HAND.y - HAND_RADIUS - 0.02) * down;
}

fn report(mut detached: MessageReader<PieceDetached>, mut rejections: MessageReader<Rejection>) {
    let count = detached.read().count();
    if count > 0 {
        info!("{count} pieces came off");
    }
    for Rejection { entity, problem } in rejections.read() {
        warn!("{entity:?}: {problem}");
    }
}

fn take_pictures(
    mut commands: Commands,
    mut world: ResMut<SoftWorld<Dim3>>,
    mut album: ResMut<Album>,
    mut exit: MessageWriter<AppExit>,
) {
    let Album(folder, frame) = &mut *album;
    *frame += 1;
    if *frame == START {
        world.resume();
    }
    let tick = frame.saturating_sub(START);
    if MOMENTS.contains(&tick) {
        let file = folder.join(format!("scene-{tick:03}.png"));
        commands
            .spawn(Screenshot::primary_window())
            .observe(save_to_disk(file));
    }
    // Exits only 20 ticks after the last picture, because a screenshot is saved some frames after its
    // request.
    if tick > MOMENTS[MOMENTS.len() - 1] + 20 {
        exit.write(AppExit::Success);
    }
}
