//! Handling of untrusted bytes by each door.

use crate::seeds::{CAT, PUDDING, SNAPSHOT_HEADER};
use crate::tick::{FEW_VOXELS, play, step};
use base64::Engine;
use base64::prelude::BASE64_URL_SAFE_NO_PAD as BASE64;
use fuwafuwa::MAX_EXTENT;
use fuwafuwa::inspect::Hash;
use fuwafuwa::{
    Dim, Dim2, Dim3, Material, SoftBody, Vec3, VoxelGrid, World, WorldConfig, snapshot,
};
use fuwafuwa_scan::{Options, Organ, Scan, Segmentation};
use fuwafuwa_scenes::import::{Colours, Model, Picture, PictureOptions};
use fuwafuwa_scenes::scene::BodyText;
use fuwafuwa_scenes::{Recording, Scene};
use fuwafuwa_surgery::record::Recording as Procedure;
use std::io;
use std::sync::Arc;
use tamaire_maker::draft::Draft;
use tamaire_play::{AnyRound, InputFrame, Level, Link, LinkError, Pack, Playback, Replay};

pub fn scene(bytes: &[u8]) -> bool {
    let Some(mut scene) = text(bytes).and_then(|text| Scene::read("a.toml", text, &[]).ok()) else {
        return false;
    };
    let written = toml::to_string(&scene).expect("a scene that was read can be serialized");
    let again = Scene::read("a.toml", &written, &[]).expect("what was written can be read");
    assert_eq!(toml::to_string(&again).ok(), Some(written));
    if scene.embed_files(&fetch).is_err() {
        return false;
    }
    match scene.dim {
        2 => play::<Dim2>(&scene),
        _ => play::<Dim3>(&scene),
    }
}

pub fn level(bytes: &[u8]) -> bool {
    let Ok(level) = Level::read("a.toml", bytes, &fetch) else {
        return false;
    };
    let text = level
        .text_to_keep()
        .expect("a short level is not too long to keep");
    let again = Level::read_kept("a.toml", text.as_bytes()).expect("what was stored can be read");
    assert_eq!(again.text_to_keep().ok(), Some(text));
    // The editor writes the level into its text.
    let source = std::str::from_utf8(bytes).ok();
    let edited = Draft::of_level(&level, source).text();
    let again = Level::read_kept("a.toml", edited.as_bytes()).expect("what was edited can be read");
    assert_eq!(again.scene(), level.scene());
    begin(level);
    true
}

pub fn png(bytes: &[u8]) -> bool {
    let Ok(picture) = Picture::decode("a.png", bytes) else {
        return false;
    };
    let mut colours = Colours::default();
    let plain = picture.grid(32, 0.1, &colours);
    colours.named.extend([([255, 0, 0], 1), ([0, 0, 255], 2)]);
    let coloured = picture.grid(MAX_EXTENT.min(48), 0.1, &colours);
    let options = PictureOptions {
        across: 32,
        voxel_size: 0.1,
        ..PictureOptions::default()
    };
    let drawn = picture.import(&options).map(|import| import.grid);
    let hollow = PictureOptions {
        fill: false,
        ..options
    };
    let hollow = picture.import(&hollow).map(|import| import.grid);
    [plain, coloured, drawn, hollow]
        .into_iter()
        .flatten()
        .for_each(drop_in);
    true
}

pub fn vox(bytes: &[u8]) -> bool {
    let Ok(model) = Model::decode("a.vox", bytes) else {
        return false;
    };
    let grid = model.grid(0.1, &Colours::default());
    let is_taken = grid.is_ok();
    grid.into_iter().for_each(drop_in);
    is_taken
}

pub fn scan(bytes: &[u8]) -> bool {
    let Ok(scan) = Scan::decode("a.nii", bytes, |_| {}) else {
        return false;
    };
    let [low, high] = scan.range();
    let tissue = [
        Segmentation::thresholds(&[(0.5 * (low + high)..=high, 2), (low..=high, 1)]),
        Segmentation::labels(&[(1, 1), (2, 2)]),
        Segmentation::Maps,
    ];
    let options = Options {
        resolution: 8,
        fills_holes: true,
    };
    let organs = tissue
        .iter()
        .map(|tissue| Organ::of(&[&scan], tissue, &options, |_| {}));
    organs.flatten().for_each(|organ| drop_in(organ.grid));
    true
}

pub fn replay(bytes: &[u8]) -> bool {
    let Ok(replay) = Replay::of_bytes(bytes) else {
        return false;
    };
    let text = replay.text();
    let again = Replay::read(&text).expect("the text of a replay can be read");
    assert_eq!(again.text(), text);
    watch(replay)
}

/// Reads a link. `bytes` are the letter of its kind and the payload. The checksum is added here, because
/// random changes would make it invalid.
pub fn link(bytes: &[u8]) -> bool {
    let Some((&kind, sent)) = bytes.split_first() else {
        return false;
    };
    let checksum = Hash::of(bytes) as u32;
    let body = BASE64.encode([&checksum.to_le_bytes(), sent].concat());
    let Ok(read) = Link::read(&format!("#{}1{body}z", kind as char)) else {
        return false;
    };
    match written(&read) {
        // Accepts that a level cannot be written again: with all default values written out, its text may be
        // too long.
        Err(LinkError::TooLong { .. } | LinkError::Level(_)) => {}
        again => {
            let again = again.expect("a link that was read can be written");
            let read = Link::read(&again).expect("what was written can be read");
            assert_eq!(written(&read).ok(), Some(again));
        }
    }
    match read {
        Link::Round(replay) => watch(*replay),
        Link::Level(level) => {
            begin(*level);
            true
        }
    }
}

/// Reads a pack. Returns whether at least one of its levels was opened.
pub fn pack(bytes: &[u8]) -> bool {
    let Ok(pack) = Pack::read("a.zip", bytes) else {
        return false;
    };
    let text = |level: &Level| {
        let text = level.text_to_keep();
        (
            level.id.clone(),
            text.expect("a pack has no level that is too long to keep"),
        )
    };
    let texts: Vec<(String, String)> = pack.levels.iter().map(text).collect();
    if texts.is_empty() {
        return false;
    }
    let again = Pack::read("a.zip", &Pack::write(&texts)).expect("what was written can be read");
    assert!(again.refused.is_empty(), "{:?}", again.refused);
    let again: Vec<(String, String)> = again.levels.iter().map(text).collect();
    let scenes = |texts: Vec<(String, String)>| texts.into_iter().map(|(_, text)| text);
    assert!(scenes(again).eq(scenes(texts)));
    true
}

pub fn recording(bytes: &[u8]) -> bool {
    let text = text(bytes);
    let Some(mut recording) = text.and_then(|text| Recording::read("a.toml", text).ok()) else {
        return false;
    };
    let written = recording
        .text()
        .expect("a recording that was read is not too long");
    Recording::read("a.toml", &written).expect("what was stored can be read");
    recording.targets.truncate(2);
    match recording.scene.dim {
        2 => play::<Dim2>(&recording.scene) && recording.replay::<Dim2>(|_| {}).is_ok(),
        _ => play::<Dim3>(&recording.scene) && recording.replay::<Dim3>(|_| {}).is_ok(),
    }
}

/// Reads the recording of a procedure. `bytes` are its decompressed content without the checksum, which
/// random changes would make invalid.
pub fn procedure(bytes: &[u8]) -> bool {
    let Ok(recording) = Procedure::read_inside(bytes) else {
        return false;
    };
    let again = Procedure::read(&recording.bytes())
        .expect("a recording that was read can be written and read");
    // Compares bytes instead of values, because NaN is not equal to itself.
    assert_eq!(again.inside(), recording.inside());
    if recording.case.grid.voxels().count() > FEW_VOXELS {
        return false;
    }
    let Ok(mut playback) = fuwafuwa_surgery::record::Playback::new(Arc::new(recording)) else {
        return false;
    };
    let is_as_it_was = playback.step().is_ok();
    let organ = playback.procedure().organ();
    let checked = organ.mesh().validate(organ.grid(), organ.connectivity());
    checked.expect("a tick keeps every mesh consistent");
    is_as_it_was
}

/// Loads a snapshot. `bytes` are the dimension and the state without the checksum, which random changes would
/// make invalid.
pub fn snapshot(bytes: &[u8]) -> bool {
    let Some((&dim, state)) = bytes.split_first() else {
        return false;
    };
    let mut whole = SNAPSHOT_HEADER.to_vec();
    whole.push(dim);
    whole.extend(Hash::of(state).to_le_bytes());
    whole.extend(state);
    match dim {
        3 => go_on::<Dim3>(&whole),
        _ => go_on::<Dim2>(&whole),
    }
}

fn written(link: &Link) -> Result<String, LinkError> {
    match link {
        Link::Round(replay) => replay.link(),
        Link::Level(level) => level.link(),
    }
}

/// Plays a tick of a level if the level is small.
fn begin(level: Level) {
    if is_small(&level) {
        let mut round = AnyRound::new(Arc::new(level));
        round.step(InputFrame::towards(Vec3::splat(0.5)));
    }
}

/// Plays the first ticks of a replay. Returns whether they match the recorded hashes.
fn watch(replay: Replay) -> bool {
    let Ok(mut playback) = Playback::new(Arc::new(replay)) else {
        return false;
    };
    while playback.round().ticks() < 3 && is_small(playback.round().level()) {
        if playback.step().is_err() {
            return false;
        }
    }
    true
}

fn text(bytes: &[u8]) -> Option<&str> {
    std::str::from_utf8(bytes).ok()
}

/// Loads a file by the name that a scene gives.
fn fetch(name: &str) -> io::Result<Vec<u8>> {
    match name {
        "cat.png" => Ok(CAT.to_vec()),
        "pudding.vox" => Ok(PUDDING.to_vec()),
        _ => Err(io::ErrorKind::NotFound.into()),
    }
}

fn is_small(level: &Level) -> bool {
    let bodies = &level.scene().body;
    let across = |body: &BodyText| body.n.unwrap_or(usize::MAX);
    bodies.len() <= 4 && bodies.iter().all(|body| across(body) <= 12)
}

/// Adds a soft body with the voxels of `grid` to a world and plays a tick.
fn drop_in<D: Dim>(grid: VoxelGrid<D>) {
    if grid.solid_count() > FEW_VOXELS {
        return;
    }
    let mut world = World::new(WorldConfig::default()).expect("the default settings are valid");
    if let Ok(body) = SoftBody::new(grid, &[Material::default(); 255]) {
        let added = world.add_soft_body(body);
        added.expect("a body at the origin is in range");
        step(&mut world);
    }
}

fn go_on<D: Dim>(bytes: &[u8]) -> bool {
    let Ok(mut world) = snapshot::load::<D>(bytes) else {
        return false;
    };
    let again =
        snapshot::load::<D>(&snapshot::save(&world)).expect("a saved snapshot can be loaded");
    assert_eq!(again.hash(), world.hash());
    let counts = { world.soft_bodies() }.map(|(_, body)| body.grid().solid_count());
    let voxels: usize = counts.sum();
    if voxels <= FEW_VOXELS {
        step(&mut world);
    }
    true
}
