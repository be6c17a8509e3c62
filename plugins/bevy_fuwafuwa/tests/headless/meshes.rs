//! Meshes follow their bodies and keep their buffers.

use super::{app, at, body, mesh, messages, run, transform, world};
use bevy_asset::{AssetEvent, Assets};
use bevy_ecs::entity::Entity;
use bevy_fuwafuwa::Dimension;
use bevy_fuwafuwa::fuwafuwa::inspect::closure;
use bevy_fuwafuwa::fuwafuwa::{Blade, Dim};
use bevy_fuwafuwa::prelude::*;
use bevy_math::Vec3;
use bevy_mesh::{Indices, Mesh, VertexAttributeValues};

fn positions(mesh: &Mesh) -> &[[f32; 3]] {
    match mesh.attribute(Mesh::ATTRIBUTE_POSITION) {
        Some(VertexAttributeValues::Float32x3(positions)) => positions,
        other => panic!("{other:?}"),
    }
}

/// Returns the triangles that are in use, as vertex indices.
fn triangles(mesh: &Mesh) -> Vec<[u32; 3]> {
    let Some(Indices::U32(indices)) = mesh.indices() else {
        panic!("the mesh has no indices");
    };
    let all = indices
        .chunks_exact(3)
        .map(|three| [three[0], three[1], three[2]]);
    all.filter(|[a, b, _]| a != b).collect()
}

fn corners(mesh: &Mesh) -> impl Iterator<Item = [Vec3; 3]> {
    let positions = positions(mesh);
    let place = |vertex: u32| Vec3::from(positions[vertex as usize]);
    triangles(mesh)
        .into_iter()
        .map(move |triangle| triangle.map(place))
}

fn area(mesh: &Mesh) -> f32 {
    corners(mesh)
        .map(|[a, b, c]| 0.5 * (b - a).cross(c - a).z)
        .sum()
}

fn volume(mesh: &Mesh) -> f32 {
    corners(mesh).map(|[a, b, c]| a.dot(b.cross(c)) / 6.0).sum()
}

fn cut<D: Dimension>(app: &mut bevy_app::App, ball: Entity, blade: &Blade<D>) {
    let mut world = app.world_mut().resource_mut::<SoftWorld<D>>();
    let id = world.soft_body_of(ball).expect("the body has entered");
    assert!(
        world
            .engine_mut()
            .cut(id, blade)
            .is_ok_and(|released| released > 0)
    );
}

#[test]
fn disc_mesh_has_a_vertex_per_node_and_keeps_its_buffers() {
    let mut app = app::<Dim2>();
    let ball = app
        .world_mut()
        .spawn((SoftBody2d::ball(24, 1.0), at(5.0, 9.0)))
        .id();
    run(&mut app, 2);
    let own = body::<Dim2>(&app, ball).mesh();
    // An element that fills only a part of its cell has corners without a node. The mesh has a separate
    // vertex at each such corner.
    let parts = own
        .elements()
        .filter(|(_, element)| element.children != Dim2::ALL_CORNERS);
    let lone = parts.map(|(_, element)| {
        let lone = closure::<Dim2>(element.children) & !own.element_class(element).mask;
        lone.count_ones() as usize
    });
    let expect = own.node_count() + lone.sum::<usize>();
    assert_eq!(mesh(&app, ball).count_vertices(), expect);
    // The diameter of the smooth disc is one voxel less than the width of its grid.
    let radius = 0.5 * 23.0 / 24.0;
    let theory = std::f32::consts::PI * radius * radius;
    assert!((area(mesh(&app, ball)) / theory - 1.0).abs() < 0.01);

    let buffer = positions(mesh(&app, ball)).as_ptr();
    let before = positions(mesh(&app, ball)).to_vec();
    run(&mut app, 30);
    assert_eq!(positions(mesh(&app, ball)).as_ptr(), buffer);
    // The transform falls with the ball, so the vertices, which are relative to the transform, do not change.
    assert!(transform(&app, ball).translation.y < 8.5);
    let after = positions(mesh(&app, ball));
    let moved = before
        .iter()
        .zip(after)
        .map(|(a, b)| Vec3::from(*a).distance(Vec3::from(*b)));
    assert!(moved.fold(0.0, f32::max) < 1e-3);
}

#[test]
fn disc_mesh_updated_after_cuts_equals_a_rebuilt_mesh() {
    let mut app = app::<Dim2>();
    let ball = app
        .world_mut()
        .spawn((SoftBody2d::ball(24, 1.0), at(0.0, 0.0)))
        .id();
    run(&mut app, 1);
    for (from, to) in [
        ([-0.9, 0.1], [0.1, 0.1]),
        ([0.13, -0.9], [0.1, 0.9]),
        ([-0.9, -0.6], [0.9, 0.5]),
    ] {
        cut::<Dim2>(&mut app, ball, &Blade::segment(from.into(), to.into()));
        run(&mut app, 3);
        let now = mesh(&app, ball).clone();
        let [followed, anew] = [now.clone(), of_new_reader(&mut app, ball)].map(|mesh| {
            let own = corners(&mesh).map(|corners| corners.map(|at| at.to_array().map(rounded)));
            let mut own: Vec<_> = own.map(first_first).collect();
            own.sort_unstable();
            own
        });
        assert!(
            followed == anew,
            "{} and {} triangles",
            followed.len(),
            anew.len()
        );
        // Smoothing moves the outline inwards along a crack, so the drawn area shrinks by less than one voxel
        // on both sides of the crack.
        assert!(
            (area(&now) / (0.25 * std::f32::consts::PI) - 0.93).abs() < 0.06,
            "{}",
            area(&now)
        );
    }
    assert!(body::<Dim2>(&app, ball).pieces().list.len() > 1);
}

fn rounded(value: f32) -> i32 {
    (value * 1e5).round() as i32
}

/// Rotates the corners of a triangle so that the smallest corner comes first, to make triangles comparable.
fn first_first([a, b, c]: [[i32; 3]; 3]) -> [[i32; 3]; 3] {
    [[a, b, c], [b, c, a], [c, a, b]]
        .into_iter()
        .min()
        .expect("there are three")
}

/// Returns the mesh of a body after a complete rebuild.
fn of_new_reader(app: &mut bevy_app::App, ball: Entity) -> Mesh {
    let mut world = app.world_mut().resource_mut::<SoftWorld<Dim2>>();
    world.pause();
    let id = world.soft_body_of(ball).expect("the body has entered");
    // A call of `soft_body_mut` makes everything that follows changes of the body rebuild, such as its mesh.
    assert!(world.engine_mut().soft_body_mut(id).is_ok());
    app.update();
    app.world_mut().resource_mut::<SoftWorld<Dim2>>().resume();
    mesh(app, ball).clone()
}

#[test]
fn ball_mesh_has_two_triangles_per_bare_face_while_it_tears() {
    let mut app = app::<Dim3>();
    let handle = {
        app.world_mut().spawn(RigidBody3d::floor());
        let ball = app
            .world_mut()
            .spawn((SoftBody3d::ball(12, 1.0), at(0.0, 0.6)))
            .id();
        let blade = RigidBody3d::kinematic_ball(0.12);
        let blade = app.world_mut().spawn((blade, at(0.1, 1.6))).id();
        (ball, blade)
    };
    let (ball, blade) = handle;
    run(&mut app, 1);
    let own = mesh(&app, ball);
    let whole = volume(own);
    assert!((whole / body::<Dim3>(&app, ball).total_mass() as f32 * 100.0 - 1.0).abs() < 0.1);
    let is_even = |app: &bevy_app::App| {
        let faces = body::<Dim3>(app, ball).facets().count();
        assert_eq!(triangles(mesh(app, ball)).len(), 2 * faces);
        faces
    };
    let before = is_even(&app);
    let mut torn = 0;
    let mut parted = 0;
    // The blade moves down into the ball, then sideways through it.
    for tick in 0..90 {
        let aside = 0.03 * f32::from(u8::saturating_sub(tick, 40));
        let down = at(0.1 + aside, 1.6 - 0.035 * f32::from(tick.min(40)));
        app.world_mut().entity_mut(blade).insert(down);
        app.update();
        torn += messages::<NodeSplit>(&app).len();
        parted += messages::<PieceDetached>(&app)
            .iter()
            .filter(|own| own.body == ball)
            .count();
        is_even(&app);
    }
    assert!(torn > 0 && parted > 0, "{torn} {parted}");
    assert!(is_even(&app) > before);
    assert_eq!(body::<Dim3>(&app, ball).pieces().list.len(), 1 + parted);
    // Pieces of the ball have fallen onto the floor, and the mesh shows them there.
    let pose = transform(&app, ball);
    let heights = corners(mesh(&app, ball))
        .flatten()
        .map(|at| pose.transform_point(at).y);
    let least = heights.fold(f32::MAX, f32::min);
    assert!((-0.05..0.1).contains(&least), "{least}");
}

#[test]
fn mesh_is_written_once_a_tick_and_never_while_asleep() {
    let mut app = app::<Dim3>();
    app.world_mut().spawn(RigidBody3d::floor());
    let cube = (SoftBody3d::cube(4, 0.5), at(0.0, 0.3));
    let cube = app.world_mut().spawn(cube).id();
    let writes = |app: &bevy_app::App| {
        let events = messages::<AssetEvent<Mesh>>(app);
        let modified = |event: &&AssetEvent<Mesh>| matches!(event, AssetEvent::Modified { .. });
        events.iter().filter(modified).count()
    };
    run(&mut app, 3);
    assert_eq!(writes(&app), 1);
    run(&mut app, 400);
    assert!(
        body::<Dim3>(&app, cube)
            .pieces()
            .list
            .iter()
            .all(|piece| piece.asleep)
    );
    assert_eq!(writes(&app), 0);
    // A sleeping body that the user moves is drawn at its new position.
    app.world_mut().entity_mut(cube).insert(at(2.0, 2.0));
    run(&mut app, 2);
    assert_eq!(writes(&app), 1);
    assert!((transform(&app, cube).translation.x - 2.0).abs() < 1e-3);
    assert_eq!(app.world().resource::<Assets<Mesh>>().len(), 1);
    assert_eq!(world::<Dim3>(&app).engine().soft_bodies().count(), 1);
}
