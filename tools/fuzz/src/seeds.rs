//! Small valid input for each door. Large input is tested in the crates that read it.

use base64::Engine;
use base64::prelude::BASE64_URL_SAFE_NO_PAD as BASE64;
use flate2::Compression;
use flate2::write::GzEncoder;
use fuwafuwa::{
    Dim, Dim2, Dim3, DimVector, Joint, JointAnchor, JointKind, Knife, Material, RigidBody,
    Rotation, Shape, SoftBody, Vec3, VoxelGrid, World, WorldConfig, snapshot,
};
use fuwafuwa_scenes::import::Model;
use fuwafuwa_scenes::{Recording, Scene, scene};
use fuwafuwa_surgery::phantom;
use fuwafuwa_surgery::procedure::{Input, Procedure};
use fuwafuwa_surgery::tools::Tool;
use image::{DynamicImage, ImageFormat, Rgb, RgbImage};
use png::{BitDepth, ColorType};
use std::io::{Cursor, Write};
use std::sync::Arc;
use tamaire_play::level::built_in;
use tamaire_play::playground::{self, Change, Stuff};
use tamaire_play::{AnyRound, InputFrame, Level, Pack, Replay};

pub const CAT: &[u8] = include_bytes!("../../../game/tamaire_play/levels/cat.png");
pub const PUDDING: &[u8] = include_bytes!("../../../game/tamaire_play/levels/pudding.vox");

/// Magic number and version of a snapshot.
pub const SNAPSHOT_HEADER: [u8; 8] = {
    let [a, b, c, d] = snapshot::VERSION.to_le_bytes();
    [b'f', b'u', b'w', b'a', a, b, c, d]
};

/// Scene with features that the built-in scenes lack.
const RICH: &str = include_str!("rich.toml");

/// Number of voxels across the small bodies.
const FEW: usize = 8;

pub fn scenes() -> Vec<Vec<u8>> {
    let texts = small_scenes().into_iter().map(|scene| text_of(&scene));
    texts.chain([RICH.into()]).collect()
}

pub fn levels() -> Vec<Vec<u8>> {
    small_levels()
        .iter()
        .map(|level| text_of(level.scene()))
        .collect()
}

pub fn pictures() -> Vec<Vec<u8>> {
    let kinds = [
        (ColorType::Grayscale, BitDepth::One),
        (ColorType::Grayscale, BitDepth::Sixteen),
        (ColorType::GrayscaleAlpha, BitDepth::Eight),
        (ColorType::Rgb, BitDepth::Eight),
        (ColorType::Rgba, BitDepth::Eight),
        (ColorType::Rgba, BitDepth::Sixteen),
        (ColorType::Indexed, BitDepth::Two),
    ];
    let pictures = kinds
        .into_iter()
        .map(|(colour, depth)| picture(colour, depth));
    let photos = [
        ImageFormat::Jpeg,
        ImageFormat::WebP,
        ImageFormat::Gif,
        ImageFormat::Bmp,
    ];
    let others = photos.into_iter().map(photo);
    pictures.chain([CAT.to_vec()]).chain(others).collect()
}

pub fn models() -> Vec<Vec<u8>> {
    let cube = (0..27_u8).map(|k| [k % 3, k / 3 % 3, k / 9, 1 + k % 2]);
    // A model longer than 256 voxels is written in two blocks, with a scene that puts them together.
    let long = VoxelGrid::<Dim3>::from_fn([257, 1, 2], 1.0, |[x, ..]| u8::from(x % 128 < 2));
    let long = Model::of("a.vox", &long.expect("a valid grid"), &[]);
    vec![
        model(3, &cube.collect::<Vec<_>>()),
        PUDDING.to_vec(),
        long.expect("a small model").bytes(),
    ]
}

pub fn scans() -> Vec<Vec<u8>> {
    let plain = [scan(false), scan(true)];
    let zipped = plain.each_ref().map(|bytes| {
        let mut encoder = GzEncoder::new(Vec::new(), Compression::default());
        encoder
            .write_all(bytes)
            .expect("writing to a vector cannot fail");
        encoder.finish().expect("writing to a vector cannot fail")
    });
    plain.into_iter().chain(zipped).collect()
}

pub fn replays() -> Vec<Vec<u8>> {
    let texts = small_rounds().into_iter().map(|round| round.text());
    texts.map(String::into_bytes).collect()
}

pub fn links() -> Vec<Vec<u8>> {
    let levels = small_levels().into_iter().map(|level| level.link());
    let rounds = small_rounds().into_iter().map(|round| round.link());
    levels
        .chain(rounds)
        .map(|link| sent(&link.expect("a short link")))
        .collect()
}

/// Returns packs of small levels. As levels have a door of their own, few are enough.
pub fn packs() -> Vec<Vec<u8>> {
    let text = |(number, level): (usize, Level)| {
        let text = level
            .text_to_keep()
            .expect("a short level is not too long to keep");
        (format!("level-{number}.toml"), text)
    };
    let levels = small_levels()
        .into_iter()
        .filter(|level| level.scene().dim == 2);
    let texts: Vec<(String, String)> = levels.take(3).enumerate().map(text).collect();
    vec![Pack::write(&texts), Pack::write(&texts[..1])]
}

/// Returns the part of a link that the door `link` takes: kind and payload.
fn sent(link: &str) -> Vec<u8> {
    let bytes = BASE64.decode(&link[2..link.len() - 1]);
    let bytes = bytes.expect("a link consists of base64url");
    [&link.as_bytes()[..1], &bytes[4..]].concat()
}

/// Returns a round in a playground with a change of each kind.
fn with_changes(level: Level) -> Replay {
    let mut round = AnyRound::new(Arc::new(level));
    let changes = [
        Change::Clear,
        Change::Gravity(4),
        Change::Air(10),
        Change::HandSize(8),
        Change::add(scene::Form::Ball, Stuff::Clay, Vec3::ZERO),
        Change::Tool(playground::Tool::Knife),
        Change::Press(true),
    ];
    for change in changes {
        round.change(change).expect("the room is not full");
        for tick in 0..9 {
            let away = 0.02 * tick as f32;
            round.step(InputFrame::towards(Vec3::new(away, 0.0, 0.0)));
        }
    }
    round.replay()
}

fn small_rounds() -> Vec<Replay> {
    let played = |level: Level| {
        let mut round = AnyRound::new(Arc::new(level));
        for tick in 0..61 {
            let away = 0.01 * tick as f32;
            let frame = InputFrame::towards(Vec3::new(away, 0.5, 0.0));
            round.step(frame.with(1, Vec3::new(-away, 0.5, 0.0)));
        }
        round.replay()
    };
    let few = ["classic", "twins", "donut", "classic-3d"];
    let playgrounds = ["sandbox", "sandbox-3d"];
    let [played_levels, playground_levels] = [&few[..], &playgrounds[..]].map(|names| {
        let levels = small_levels().into_iter();
        levels
            .filter(|level| names.contains(&level.id.as_str()))
            .collect::<Vec<_>>()
    });
    let changed = playground_levels.into_iter().map(with_changes);
    played_levels
        .into_iter()
        .map(played)
        .chain(changed)
        .collect()
}

pub fn recordings() -> Vec<Vec<u8>> {
    let recorded = |scene: &Scene| match scene.dim {
        2 => Recording::of::<Dim2>(scene, 2, |_| {}),
        _ => Recording::of::<Dim3>(scene, 2, |_| {}),
    };
    let text = |scene| recorded(&scene).expect("a small scene can be built").text();
    let texts = small_scenes().into_iter().map(text);
    texts
        .map(|text| text.expect("a short recording").into_bytes())
        .collect()
}

pub fn procedures() -> Vec<Vec<u8>> {
    let case = Arc::new(phantom::case(8).expect("the phantom is a valid body"));
    let inside = |tool: Tool| {
        let mut procedure = Procedure::new(case.clone()).expect("the phantom can be operated on");
        for tick in 0..3 {
            let at = Vec3::new(0.0, 0.06 - 0.01 * tick as f32, 0.0);
            let rotation = Rotation::about(Vec3::Y, 0.1);
            let input = Input {
                grips: tick > 1,
                ..Input::default().at(tool, at, rotation)
            };
            procedure.step(input).expect("the tool is within the room");
        }
        fuwafuwa_surgery::record::Recording::of(&procedure).inside()
    };
    Tool::ALL.map(inside).to_vec()
}

pub fn snapshots() -> Vec<Vec<u8>> {
    let scenes = small_scenes().into_iter();
    let saved = |scene: Scene| match scene.dim {
        2 => saved::<Dim2>(&scene),
        _ => saved::<Dim3>(&scene),
    };
    let tied = [tied::<Dim2>(), tied::<Dim3>()];
    scenes.map(saved).chain(tied).collect()
}

/// Returns the snapshot of a world with features that scenes lack: dynamic rigid bodies, sensors, joints, a
/// knife.
fn tied<D: Dim>() -> Vec<u8> {
    let mut world =
        World::<D>::new(WorldConfig::default()).expect("the default settings are valid");
    let ball = VoxelGrid::ball(FEW, 1.0).expect("a small ball is a valid grid");
    let ball = SoftBody::new(ball, &[Material::default()]).expect("the material is given");
    let body = world.add_soft_body(ball).unwrap();
    let vector = |x: f32, y: f32, z: f32| D::Vector::from_vec3(Vec3::new(x, y, z));
    let cube = |height: f32| {
        let half = D::Vector::splat(0.2);
        Shape::cuboid(half).translated(vector(0.5, height, 0.5))
    };
    let turned = Rotation::about(Vec3::new(1.0, 2.0, 3.0), 0.4);
    let gate = RigidBody::fixed(cube(-0.5))
        .with_friction(0.5)
        .with_sensor(true)
        .rotated(turned);
    world.add_rigid_body(gate).expect("a valid rigid body");
    let free = RigidBody::dynamic(cube(1.3), 1.0).rotated(turned);
    let rigid = world.add_rigid_body(free).expect("a valid rigid body");
    let anchors = [
        JointAnchor::on(body, vector(0.5, 1.0, 0.5)).within(0.3),
        JointAnchor::on(rigid, vector(0.5, 1.1, 0.5)),
        JointAnchor::Point(vector(0.5, 2.0, 0.5)),
    ];
    let spring = JointKind::Spring {
        stiffness: 100.0,
        damping: 1.0,
        length: 0.5,
    };
    let rope = JointKind::Rope { length: 0.8 };
    for (first, second, kind) in [(0, 1, JointKind::Pin), (1, 2, spring), (0, 2, rope)] {
        let joint = Joint::new([anchors[first], anchors[second]], kind);
        world.add_joint(joint).expect("both anchors exist");
    }
    let holder = RigidBody::coupled(Shape::ball(0.1))
        .at(vector(0.5, 0.9, 0.5))
        .with_sensor(true);
    let holder = world.add_rigid_body(holder).expect("a valid rigid body");
    let edge = [-0.3, 0.3].map(|z| vector(0.0, 0.0, z));
    let knife = Knife::new(holder, edge, -D::Vector::Y);
    world.add_knife(knife).expect("the holder exists");
    world
        .set_target_position(holder, D::Vector::splat(0.5))
        .expect("the target is near");
    for _ in 0..5 {
        world.step();
    }
    state_of(&world)
}

/// Returns the built-in scenes with small bodies.
fn small_scenes() -> Vec<Scene> {
    let small = |name: &str| {
        let mut changes = vec![format!("body.n={FEW}"), "seconds=0.1".into()];
        if name == "diced" {
            changes.push("body.diced=0.5".into());
        }
        Scene::open(name, &changes).expect("a built-in scene or level")
    };
    // The doors refuse its thirty bodies, which have too many voxels together.
    let names = scene::NAMED.iter().map(|(name, _)| *name);
    let names = names.filter(|name| *name != "heap-3d");
    names.map(small).collect()
}

/// Returns the built-in levels, with small bodies where the size can be chosen.
pub fn small_levels() -> Vec<Level> {
    let small = |(id, text): (&str, &str)| {
        let level = Level::open(id).expect("a built-in scene or level");
        if level.scene().body[0].file.is_some() {
            return level;
        }
        let scene = Scene::read(id, text, &[format!("body.n={FEW}")]);
        let scene = scene.expect("a built-in scene or level");
        // A body too thin for so few voxels keeps its own number.
        Level::from_scene(id, scene).unwrap_or(level)
    };
    built_in().map(small).collect()
}

fn text_of(scene: &Scene) -> Vec<u8> {
    let text = toml::to_string(scene);
    text.expect("a scene that was read can be serialized")
        .into_bytes()
}

/// Returns the snapshot of a scene after a tick, in the form that the door `snapshot` takes.
fn saved<D: Dim>(scene: &Scene) -> Vec<u8> {
    let mut world = scene.build::<D>().expect("a small scene can be built");
    world.step();
    state_of(&world)
}

/// Returns the part of a snapshot that the door `snapshot` takes: the dimension, and the state after the
/// checksum.
fn state_of<D: Dim>(world: &World<D>) -> Vec<u8> {
    let bytes = snapshot::save(world);
    [&bytes[8..9], &bytes[17..]].concat()
}

/// Returns a PNG picture of this colour type and bit depth.
fn picture(colour: ColorType, depth: BitDepth) -> Vec<u8> {
    const SIDE: usize = 9;
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, SIDE as u32, SIDE as u32);
    encoder.set_color(colour);
    encoder.set_depth(depth);
    if colour == ColorType::Indexed {
        encoder.set_palette(&[255, 0, 0, 0, 0, 255, 250, 250, 250, 0, 0, 0][..]);
        encoder.set_trns(&[255, 255, 0][..]);
    }
    let row = (SIDE * colour.samples() * depth as usize).div_ceil(8);
    let samples: Vec<u8> = (0..SIDE * row).map(|k| (k * k * 37) as u8).collect();
    let mut writer = encoder
        .write_header()
        .expect("writing to a vector cannot fail");
    writer
        .write_image_data(&samples)
        .expect("writing to a vector cannot fail");
    writer.finish().expect("writing to a vector cannot fail");
    bytes
}

/// Returns a small picture in another format than PNG: a dark square on bright paper.
fn photo(format: ImageFormat) -> Vec<u8> {
    let is_dark = |x: u32, y: u32| (2..7).contains(&x) && (3..8).contains(&y);
    let pixel = |x, y| {
        Rgb(if is_dark(x, y) {
            [40, 20, 90]
        } else {
            [250; 3]
        })
    };
    let picture = DynamicImage::from(RgbImage::from_fn(12, 10, pixel));
    let mut bytes = Cursor::new(Vec::new());
    picture
        .write_to(&mut bytes, format)
        .expect("writing to a vector cannot fail");
    bytes.into_inner()
}

/// Returns a MagicaVoxel model.
fn model(side: u32, voxels: &[[u8; 4]]) -> Vec<u8> {
    let chunk = |name: &[u8; 4], contents: &[u8], children: &[u8]| {
        let lengths = [contents, children].map(|part| (part.len() as u32).to_le_bytes());
        [name, lengths.as_flattened(), contents, children].concat()
    };
    let count = (voxels.len() as u32).to_le_bytes();
    let chunks = [
        chunk(b"SIZE", [side.to_le_bytes(); 3].as_flattened(), &[]),
        chunk(b"XYZI", &[&count, voxels.as_flattened()].concat(), &[]),
        chunk(b"RGBA", &[200; 1024], &[]),
    ];
    let main = chunk(b"MAIN", &[], &chunks.concat());
    [b"VOX ", &150_u32.to_le_bytes()[..], &main].concat()
}

/// Returns a scan in NIfTI-1, in either byte order.
fn scan(is_big_endian: bool) -> Vec<u8> {
    const SIDE: i16 = 6;
    let mut bytes = vec![0; 352];
    let mut put = |at: usize, number: &[u8]| {
        let end = at + number.len();
        bytes[at..end].copy_from_slice(number);
        if is_big_endian {
            bytes[at..end].reverse();
        }
    };
    put(0, &348_i32.to_le_bytes());
    for (at, number) in [
        (40, 3),
        (42, SIDE),
        (44, SIDE),
        (46, SIDE),
        (70, 4),
        (72, 16),
        (254, 1),
    ] {
        put(at, &i16::to_le_bytes(number));
    }
    // Header fields of a scan: offset of the voxels, slope and intercept of the values, and an affine matrix
    // with some shear.
    let reals = [
        (108, 352.0),
        (112, 0.5),
        (116, -1.0),
        (280, 0.9),
        (284, 0.4),
        (300, 1.5),
        (320, -2.0),
    ];
    for (at, number) in reals {
        put(at, &f32::to_le_bytes(number));
    }
    for voxel in 0..SIDE.pow(3) {
        let number = voxel % 5 + 2;
        bytes.extend(if is_big_endian {
            number.to_be_bytes()
        } else {
            number.to_le_bytes()
        });
    }
    bytes[344..348].copy_from_slice(b"n+1\0");
    bytes
}
