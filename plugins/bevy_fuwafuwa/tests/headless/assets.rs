//! Shapes from files.

use super::{run, world};
use bevy_app::{App, TaskPoolPlugin, Update};
use bevy_asset::io::memory::{Dir, MemoryAssetReader};
use bevy_asset::io::{AssetSourceBuilder, AssetSourceId};
use bevy_asset::{AssetApp, AssetPlugin, AssetServer};
use bevy_ecs::entity::Entity;
use bevy_fuwafuwa::Dimension;
use bevy_fuwafuwa::asset::{Voxels, VoxelsSettings};
use bevy_fuwafuwa::prelude::*;
use bevy_fuwafuwa::{Problem, Rejected};
use bevy_mesh::{Mesh, VertexAttributeValues};
use std::path::Path;
use std::time::{Duration, Instant};

/// Returns an app whose asset folder contains exactly these files.
fn app_with<D: Dimension>(files: &[(&str, Vec<u8>)]) -> App {
    let folder = Dir::default();
    for (name, bytes) in files {
        folder.insert_asset(Path::new(name), bytes.clone());
    }
    let reader = move || {
        Box::new(MemoryAssetReader {
            root: folder.clone(),
        }) as Box<_>
    };
    let mut app = App::new();
    app.register_asset_source(AssetSourceId::Default, AssetSourceBuilder::new(reader));
    app.add_plugins((TaskPoolPlugin::default(), AssetPlugin::default()));
    app.add_plugins(FuwafuwaPlugin::<D>::default().in_schedule(Update));
    app
}

/// Runs the app until the body of an entity has entered the world or was rejected.
fn settle<D: Dimension>(app: &mut App, entity: Entity) {
    let late = Instant::now() + Duration::from_secs(60);
    while world::<D>(app).soft_body_of(entity).is_none()
        && app.world().get::<Rejected>(entity).is_none()
    {
        assert!(Instant::now() < late, "the asset neither loads nor fails");
        std::thread::sleep(Duration::from_millis(1));
        app.update();
    }
}

fn grid_of<D: Dimension>(app: &App, entity: Entity) -> VoxelGrid<D> {
    super::body::<D>(app, entity).grid().clone()
}

fn problem(app: &App, entity: Entity) -> String {
    match app.world().get::<Rejected>(entity) {
        Some(Rejected(Problem::Asset(problem))) => problem.clone(),
        other => panic!("{other:?}"),
    }
}

/// Returns a PNG file with a black stroke, six pixels long and two high, on white.
fn png() -> Vec<u8> {
    let pixels: Vec<u8> = (0..8 * 8)
        .map(|pixel| match (pixel % 8, pixel / 8) {
            (1..7, 3..5) => 0,
            _ => 255,
        })
        .collect();
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, 8, 8);
    encoder.set_color(png::ColorType::Grayscale);
    let mut writer = encoder.write_header().expect("the header can be written");
    writer.write_image_data(&pixels).expect("the pixels fit");
    writer.finish().expect("the file can be finished");
    bytes
}

/// Returns a `.vox` file with a model of 2 × 1 × 3 voxels (z up). One corner has palette index 2 (blue), one
/// voxel is empty, the others have index 1 (red).
fn vox() -> Vec<u8> {
    let chunk = |name: &[u8; 4], contents: &[u8], children: &[u8]| {
        let lengths = [contents.len() as u32, children.len() as u32].map(u32::to_le_bytes);
        [name, lengths.as_flattened(), contents, children].concat()
    };
    let size = [2u32, 1, 3].map(u32::to_le_bytes);
    let voxels = [
        [0, 0, 0, 2],
        [1, 0, 0, 1],
        [0, 0, 1, 1],
        [1, 0, 1, 1],
        [0, 0, 2, 1],
    ];
    let contents = [&5u32.to_le_bytes()[..], voxels.as_flattened()].concat();
    let mut palette = [[0; 4]; 256];
    (palette[0], palette[1]) = ([255, 0, 0, 255], [0, 0, 255, 255]);
    let model = [
        chunk(b"SIZE", size.as_flattened(), &[]),
        chunk(b"XYZI", &contents, &[]),
        chunk(b"RGBA", palette.as_flattened(), &[]),
    ];
    [
        b"VOX ",
        &150u32.to_le_bytes()[..],
        &chunk(b"MAIN", &[], &model.concat()),
    ]
    .concat()
}

#[test]
fn png_asset_becomes_a_body_with_default_and_custom_settings() {
    let mut app = app_with::<Dim2>(&[("stroke.png", png())]);
    let server = app.world().resource::<AssetServer>().clone();
    let usual = SoftBody2d::asset(server.load("stroke.png"));
    let usual = app.world_mut().spawn(usual).id();
    settle::<Dim2>(&mut app, usual);
    let grid = grid_of::<Dim2>(&app, usual);
    assert_eq!((grid.solid_count(), grid.voxel_size()), (12, 1.0 / 32.0));

    let small = |settings: &mut VoxelsSettings| {
        (settings.voxel_size, settings.max_across) = (0.5, 4);
    };
    let mut app = app_with::<Dim2>(&[("stroke.png", png())]);
    let server = app.world().resource::<AssetServer>().clone();
    let handle = server
        .load_builder()
        .with_settings(small)
        .load::<Voxels<Dim2>>("stroke.png");
    let scaled = app.world_mut().spawn(SoftBody2d::asset(handle)).id();
    settle::<Dim2>(&mut app, scaled);
    let grid = grid_of::<Dim2>(&app, scaled);
    // The margin around the stroke does not count.
    assert_eq!((grid.size(), grid.voxel_size()), ([4, 1, 1], 0.5));
}

#[test]
fn vox_asset_becomes_a_body_with_two_materials() {
    let mut app = app_with::<Dim3>(&[("dice.vox", vox())]);
    let server = app.world().resource::<AssetServer>().clone();
    let dice = SoftBody3d::asset(server.load("dice.vox"));
    let dice = app.world_mut().spawn(dice).id();
    settle::<Dim3>(&mut app, dice);
    let grid = grid_of::<Dim3>(&app, dice);
    assert_eq!((grid.size(), grid.solid_count()), ([2, 3, 1], 5));
    assert_eq!(
        [[0, 0, 0], [1, 0, 0], [1, 2, 0]].map(|at| grid.material(at)),
        [2, 1, 0]
    );
    run(&mut app, 3);
    let mesh = super::mesh(&app, dice);
    let Some(VertexAttributeValues::Float32x4(colours)) = mesh.attribute(Mesh::ATTRIBUTE_COLOR)
    else {
        panic!("the mesh has no colours");
    };
    for pure in [[1.0, 0.0, 0.0, 1.0], [0.0, 0.0, 1.0, 1.0]] {
        assert!(colours.contains(&pure), "{colours:?}");
    }
}

#[test]
fn invalid_file_is_rejected_with_its_name_and_position() {
    let whole = vox();
    let huge = [&b"VOX \x96\0\0\0MAIN"[..], &[255; 8]].concat();
    let files = [
        ("cut.vox", whole[..whole.len() - 3].to_vec()),
        ("huge.vox", huge),
        ("none.vox", Vec::new()),
    ];
    let mut app = app_with::<Dim3>(&files);
    let server = app.world().resource::<AssetServer>().clone();
    for name in ["cut.vox", "huge.vox", "none.vox", "missing.vox"] {
        let body = SoftBody3d::asset(server.load(name));
        let entity = app.world_mut().spawn(body).id();
        settle::<Dim3>(&mut app, entity);
        let problem = problem(&app, entity);
        assert!(problem.contains(name), "{problem}");
    }
    let mut app = app_with::<Dim2>(&[("text.png", b"no picture".to_vec())]);
    let server = app.world().resource::<AssetServer>().clone();
    let entity = SoftBody2d::asset(server.load("text.png"));
    let entity = app.world_mut().spawn(entity).id();
    settle::<Dim2>(&mut app, entity);
    let problem = problem(&app, entity);
    assert!(
        problem.contains("text.png: expected a picture") && problem.contains("found a text"),
        "{problem}"
    );
}
