//! Removal of pieces from a world: all other objects are unaffected.

use crate::blades::Blades;
use crate::vectors::vector;
use fuwafuwa::inspect::CellHierarchy;
use fuwafuwa::inspect::Mesh;
use fuwafuwa::snapshot::{load, save};
use fuwafuwa::{
    Blade, Bookmark, Dim, Dim2, Dim3, DimAngular, DimVector, Event, Grading, Joint, JointAnchor,
    Material, ObjectRef, PieceId, PieceSize, Removed, RigidBody, Shape, SoftBody, SoftBodyHandle,
    Vec2, Vec3, Velocity, VoxelGrid, World, WorldConfig,
};

fn weightless<D: Dim>() -> WorldConfig<D> {
    WorldConfig {
        gravity: D::Vector::ZERO,
        ..WorldConfig::default()
    }
}

fn random(seed: &mut u32, below: usize) -> usize {
    *seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
    (*seed >> 8) as usize % below
}

/// Checks that the mesh of each body equals a newly graded mesh, and that a snapshot restores the world.
fn check_whole<D: Dim>(world: &World<D>, what: &str) {
    for (_, body) in world.soft_bodies() {
        let (grid, sharing) = (body.grid(), body.connectivity());
        let fresh = CellHierarchy::new(grid, sharing, Grading::Graded);
        let mesh = Mesh::grade(grid, sharing, &fresh).unwrap();
        assert!(
            body.mesh().is_same_as(&mesh),
            "{what}: the mesh differs from one graded from scratch"
        );
        let valid = body.mesh().validate(grid, sharing);
        valid.unwrap_or_else(|defect| panic!("{what}: {defect}"));
        assert_eq!(
            { body.mesh().elements() }
                .map(|(_, element)| body.mesh().voxels(element).count())
                .sum::<usize>(),
            grid.remaining_count(),
            "{what}"
        );
    }
    let loaded = load::<D>(&save(world)).unwrap_or_else(|bad| panic!("{what}: {bad}"));
    assert_eq!(loaded.hash(), world.hash(), "{what}");
}

#[test]
fn scaled_grid_keeps_voxels_removed() {
    let grid = VoxelGrid::<Dim2>::from_fn([4, 2, 1], 0.5, |_| 1).unwrap();
    let mut world = World::<Dim2>::new(weightless()).unwrap();
    let id = world
        .add_soft_body(SoftBody::new(grid, &[Material::default()]).unwrap())
        .unwrap();
    let middle = Blade::segment(Vec2::new(1.0, -1.0), Vec2::new(1.0, 2.0));
    world.cut(id, &middle).unwrap();
    let right = { world[id].piece_views().into_iter() }.find(|piece| piece.centre.x > 1.0);
    world.remove_piece(id, right.unwrap().number).unwrap();
    let scaled = world[id].grid().clone().scaled(2.0).unwrap();
    assert_eq!((scaled.solid_count(), scaled.remaining_count()), (8, 4));
    for voxel in scaled.voxels() {
        assert_eq!(scaled.is_present(voxel), voxel[0] < 2, "{voxel:?}");
    }
    // Four voxels of 1 m × 1 m × 1 m remain, of density 100 kg/m³.
    let half = SoftBody::new(
        scaled,
        &[Material {
            density: 100.0,
            ..Material::default()
        }],
    )
    .unwrap();
    assert!(
        (half.total_mass() - 400.0).abs() < 1e-3,
        "{}",
        half.total_mass()
    );
}

fn random_blade<D: Blades>(seed: &mut u32) -> Blade<D> {
    let mut number = || random(seed, 1000) as f32 / 1000.0;
    let corner = Vec3::new(0.1 + 0.8 * number(), -1.0 - number(), -2.0);
    let first = Vec3::new(number() - 0.5, 4.0, number() - 0.5);
    D::blade(corner, first, Vec3::Z * 5.0)
}

/// Cuts, splits, steps and removes pieces in random order, with checks after each change. Returns the number
/// of removed pieces.
fn check_history<D: Blades>(seed: u32, n: usize) -> usize {
    let mut seed_of = seed.wrapping_mul(2_654_435_761).wrapping_add(17);
    let seed = &mut seed_of;
    let soft = Material {
        strength: 400.0,
        toughness: 80.0,
        ..Material::default()
    };
    let mut world = World::<D>::new(WorldConfig::default()).unwrap();
    let floor = Shape::half_space(D::Vector::Y, D::Vector::ZERO);
    world
        .add_rigid_body(RigidBody::fixed(floor).with_friction(0.3))
        .unwrap();
    let body = SoftBody::new(VoxelGrid::<D>::ball(n, 1.0).unwrap(), &[soft]).unwrap();
    let id = world.add_soft_body(body).unwrap();
    let mut bookmark = world[id].bookmark();
    let mut gone = 0;
    for round in 0..12 {
        let what = format!("{}D, seed {seed}, round {round}", D::N);
        match random(seed, 3) {
            0 => drop(world.cut(id, &random_blade(seed)).unwrap()),
            1 => {
                let mut at = [0; 3];
                (0..D::N).for_each(|axis| at[axis] = random(seed, n + 1) as i32);
                let side = 1 + random(seed, (1 << D::CORNERS) - 2) as u8;
                world.soft_body_mut(id).unwrap().release(&[(at, side)]);
                bookmark = world[id].bookmark();
            }
            _ => drop((0..2).map(|_| world.step()).collect::<Vec<_>>()),
        }
        let views = world[id].piece_views();
        let left = views.iter().filter(|view| !view.removed).count();
        let largest = { views.iter() }.max_by_key(|view| view.element_count);
        let largest = largest.unwrap().number;
        if left < 2 {
            continue;
        }
        world[id].changes_since(&mut bookmark);
        let other = views
            .iter()
            .find(|view| view.number != largest && !view.removed && random(seed, 2) == 0);
        let removed = match other {
            Some(view) => world.remove_piece(id, view.number).unwrap(),
            None => world.remove_small_pieces(PieceSize::Voxels(3)).unwrap(),
        };
        gone += removed.pieces.len();
        check_whole(&world, &what);
        let body = &world[id];
        let pieces: Vec<PieceId> = removed.pieces.iter().map(|&(_, piece)| piece).collect();
        // Skips the comparison if `changes_since` returns `None`, as it does after too many changes.
        if let Some(changes) = body.changes_since(&mut bookmark) {
            assert_eq!(changes.removed, pieces, "{what}");
            assert!({ changes.elements.iter() }.all(|&id| body.mesh().element(id).is_none()));
            assert!({ changes.nodes.iter() }.all(|&id| !body.mesh().is_alive(id)));
        }
        let now = body.piece_views();
        assert!(
            pieces.iter().all(|piece| now[piece.index()].removed),
            "{what}"
        );
        // The world and its loaded snapshot must have the same hash after one more tick.
        let mut loaded = load::<D>(&save(&world)).unwrap();
        world.step();
        loaded.step();
        assert_eq!(loaded.hash(), world.hash(), "{what}");
        check_whole(&world, &what);
    }
    gone
}

#[test]
fn removal_leaves_mesh_as_graded_from_scratch() {
    let flat = (0..20).map(|seed| check_history::<Dim2>(seed, 12 + seed as usize % 9));
    assert!(flat.sum::<usize>() > 30, "too few pieces were removed");
    let solid = (0..8).map(|seed| check_history::<Dim3>(seed, 7 + seed as usize % 4));
    assert!(solid.sum::<usize>() > 10, "too few pieces were removed");
}

/// Returns a world with a cube that is cut into two halves, side by side.
fn halves<D: Blades>(settings: WorldConfig<D>) -> (World<D>, SoftBodyHandle) {
    let mut world = World::new(settings).unwrap();
    let cube = VoxelGrid::cube(8, 1.0).unwrap();
    let cube = SoftBody::new(cube, &[Material::default()]).unwrap();
    let cube = world.add_soft_body(cube).unwrap();
    let blade = D::blade(Vec3::new(0.5, -1.0, -1.0), Vec3::Y * 3.0, Vec3::Z * 3.0);
    world.cut(cube, &blade).unwrap();
    assert_eq!(world[cube].pieces().count(), 2);
    (world, cube)
}

fn check_rest_untouched<D: Blades>() {
    let (mut world, cube) = halves::<D>(weightless());
    world
        .add_velocity(
            cube,
            Velocity {
                linear: vector(0.3, 0.1, 0.0),
                angular: D::Angular::from_vec3(Vec3::Z * 0.5),
            },
        )
        .unwrap();
    (0..3).for_each(|_| _ = world.step());
    let states = |world: &World<D>, piece: u32| -> Vec<_> {
        let body = &world[cube];
        let nodes = body.mesh().nodes().map(|(id, _)| id);
        let own = nodes.filter(|&id| body.pieces().of_node(id) == PieceId(piece));
        own.map(|id| (id, body.node_state(id))).collect()
    };
    let (before, whole) = (states(&world, 0), world[cube].total_mass());
    let removed = world.remove_piece(cube, PieceId(1)).unwrap();
    assert_eq!(states(&world, 0), before);
    assert_eq!(states(&world, 1), []);
    let left = world[cube].total_mass();
    assert!((removed.mass + left - whole).abs() < 1e-9 * whole && removed.mass > 0.3 * whole);
    let events = [Event::PieceRemoved {
        body: cube,
        piece: PieceId(1),
    }];
    assert_eq!(world.events()[world.events().len() - 1..], events);
    // Removing the same piece again returns an error.
    let error = world.remove_piece(cube, PieceId(1)).unwrap_err();
    assert_eq!(
        error.to_string(),
        "piece must be the number of a piece that the body still has, given 1"
    );
    assert!(world.remove_piece(cube, PieceId(7)).is_err());
    let momentum = world[cube].momentum().linear;
    (0..30).for_each(|_| _ = world.step());
    let now = world[cube].momentum().linear;
    for axis in 0..3 {
        assert!(
            (now[axis] - momentum[axis]).abs() < 1e-3 * left,
            "{now:?} {momentum:?}"
        );
    }
}

#[test]
fn remove_piece_preserves_state_of_other_pieces() {
    check_rest_untouched::<Dim2>();
    check_rest_untouched::<Dim3>();
}

/// Checks that the removal of one half changes neither the forces, nor the damping, nor the strength of the
/// other half.
#[test]
fn remove_piece_has_no_effect_on_vibration_of_rest() {
    let (mut world, cube) = halves::<Dim2>(weightless());
    let (mut other, _) = halves::<Dim2>(weightless());
    world.remove_piece(cube, PieceId(1)).unwrap();
    let far = |world: &mut World<Dim2>| {
        let body = world.soft_body_mut(cube).unwrap();
        let nodes: Vec<_> = body.mesh().nodes().map(|(id, _)| id).collect();
        for id in nodes {
            let (mut at, _, _) = body.node_state(id);
            match body.pieces().of_node(id) {
                PieceId(0) => at[1] *= 1.1,
                _ => at[0] += 50.0,
            }
            body.set_node_state(id, at, Vec2::ZERO).unwrap();
        }
    };
    far(&mut world);
    far(&mut other);
    for _ in 0..30 {
        world.step();
        other.step();
    }
    let [alone, beside] = [&world, &other].map(|world| {
        let body = &world[cube];
        let nodes = body.mesh().nodes().map(|(id, _)| id);
        let own = nodes.filter(|&id| body.pieces().of_node(id) == PieceId(0));
        own.map(|id| body.node_state(id)).collect::<Vec<_>>()
    });
    assert_eq!(alone, beside);
}

fn check_supported<D: Blades>() {
    let mut world = World::<D>::new(WorldConfig::default()).unwrap();
    let floor = Shape::half_space(D::Vector::Y, D::Vector::ZERO);
    world
        .add_rigid_body(RigidBody::fixed(floor).with_friction(0.5))
        .unwrap();
    let cube = |n, width| {
        let strong = Material {
            strength: f32::INFINITY,
            ..Material::default()
        };
        SoftBody::new(VoxelGrid::<D>::cube(n, width).unwrap(), &[strong]).unwrap()
    };
    let below = world
        .add_soft_body(cube(8, 0.8).translated(D::Vector::ZERO))
        .unwrap();
    let blade = D::blade(Vec3::new(0.4, -1.0, -1.0), Vec3::Y * 3.0, Vec3::Z * 3.0);
    world.cut(below, &blade).unwrap();
    // Three small cubes: one on each half of the cut cube, and one elsewhere on the floor.
    let on_left = world
        .add_soft_body(cube(3, 0.3).translated(vector(0.05, 0.82, 0.2)))
        .unwrap();
    let on_right = world
        .add_soft_body(cube(3, 0.3).translated(vector(0.45, 0.82, 0.2)))
        .unwrap();
    let far = world
        .add_soft_body(cube(3, 0.3).translated(vector(5.0, 0.01, 0.0)))
        .unwrap();
    let all_sleep = |world: &World<D>| {
        let mut bodies = world.soft_bodies();
        bodies.all(|(_, body)| body.pieces().list.iter().all(|piece| piece.asleep))
    };
    // The halves may take long to settle against each other, so the test puts all bodies to sleep by a method
    // call.
    (0..40).for_each(|_| _ = world.step());
    for id in [below, on_left, on_right, far] {
        world.put_to_sleep(id).unwrap();
    }
    (0..10).for_each(|_| _ = world.step());
    assert!(all_sleep(&world), "all pieces must be asleep");
    let touching = |world: &World<D>| -> Vec<Event<D>> {
        let ended = |event: &&Event<D>| matches!(event, Event::ContactEnded { .. });
        world.events().iter().filter(ended).copied().collect()
    };
    let asleep = |world: &World<D>, id: SoftBodyHandle, piece: usize| {
        world[id].pieces().list[PieceId(piece as u32)].asleep
    };
    let centre = world[on_right].centre_of_mass();
    let right = if { world[below].piece_views() }[0].centre[0] > 0.4 {
        0
    } else {
        1
    };
    world.remove_piece(below, PieceId(right as u32)).unwrap();
    assert!(
        !asleep(&world, on_right, 0),
        "the cube on the removed half must wake"
    );
    // The remaining half touched the removed half, so it wakes, and so does the small cube on it. The cube
    // elsewhere stays asleep.
    assert!(!asleep(&world, on_left, 0) && asleep(&world, far, 0));
    let woken = |event: &Event<D>| matches!(event, Event::WokeUp { body, .. } if *body == on_right);
    assert!(world.events().iter().any(woken));
    world.step();
    let gone = ObjectRef::Piece {
        body: below,
        piece: PieceId(right as u32),
    };
    let ended = touching(&world);
    let told =
        |event: &Event<D>| matches!(event, Event::ContactEnded { pair } if pair.contains(&gone));
    assert!(ended.iter().any(told), "{ended:?}");
    (0..40).for_each(|_| _ = world.step());
    let now = world[on_right].centre_of_mass();
    assert!(now[1] < centre[1] - 0.3, "{centre:?} to {now:?}");
    assert!(asleep(&world, far, 0));
}

#[test]
fn remove_piece_wakes_only_bodies_in_contact() {
    check_supported::<Dim2>();
    check_supported::<Dim3>();
}

fn check_ties<D: Blades>() {
    let (mut world, cube) = halves::<D>(weightless());
    let middle = if D::N == 3 { 0.5 } else { 0.0 };
    let sensor = Shape::ball(3.0).translated(vector(0.5, 0.5, middle));
    let sensor = RigidBody::fixed(sensor)
        .with_friction(0.0)
        .with_sensor(true);
    let sensor = world.add_rigid_body(sensor).unwrap();
    let [to_left, to_right] = [0.1, 0.9].map(|x| {
        let at = vector(x, 0.5, middle);
        let end = JointAnchor::on(cube, at).within(0.1);
        world
            .add_joint(Joint::pin(end, JointAnchor::Point(at)))
            .unwrap()
    });
    world.step();
    let views = world[cube].piece_views();
    let right = views
        .iter()
        .find(|view| view.centre[0] > 0.5)
        .unwrap()
        .number;
    world.remove_piece(cube, right).unwrap();
    world.step();
    let events = world.events();
    assert!(
        events.contains(&Event::JointBroke { joint: to_right }),
        "{events:?}"
    );
    let object = ObjectRef::Piece {
        body: cube,
        piece: right,
    };
    assert!(
        events.contains(&Event::SensorExited { sensor, object }),
        "{events:?}"
    );
    assert!(world.joint(to_left).is_ok() && world.joint(to_right).is_err());
}

#[test]
fn remove_piece_breaks_joints_and_exits_sensors() {
    check_ties::<Dim2>();
    check_ties::<Dim3>();
}

fn check_last<D: Blades>() {
    let (mut world, cube) = halves::<D>(WorldConfig::default());
    world.remove_piece(cube, PieceId(0)).unwrap();
    let removed = world.remove_piece(cube, PieceId(1)).unwrap();
    assert_eq!(
        (removed.pieces.len(), &removed.soft_bodies[..]),
        (1, &[cube][..])
    );
    assert!(world.soft_body(cube).is_err() && world.soft_bodies().next().is_none());
    assert!(
        world
            .events()
            .contains(&Event::SoftBodyRemoved { body: cube })
    );
    assert!(world.remove_piece(cube, PieceId(1)).is_err());
    world.step();
    // Another body can take the arena slot of the removed body, but the old handle stays stale.
    let ball = SoftBody::new(VoxelGrid::ball(6, 1.0).unwrap(), &[Material::default()]).unwrap();
    let ball = world.add_soft_body(ball).unwrap();
    (0..30).for_each(|_| _ = world.step());
    assert!(world.soft_body(ball).is_ok() && world.soft_body(cube).is_err());
    check_whole(&world, "after the last piece");
}

#[test]
fn body_is_removed_with_its_last_piece() {
    check_last::<Dim2>();
    check_last::<Dim3>();
}

fn check_sizes<D: Blades>() {
    let (mut world, cube) = halves::<D>(weightless());
    let half = 0.5 * world[cube].total_mass();
    let none = Removed::default();
    for size in [
        PieceSize::Mass(0.9 * half),
        PieceSize::Volume(0.45),
        PieceSize::Voxels(0),
        PieceSize::Voxels(4 * 8usize.pow(D::N as u32 - 1)),
    ] {
        assert_eq!(
            world.clone().remove_small_pieces(size),
            Ok(none.clone()),
            "{size:?}"
        );
    }
    for size in [
        PieceSize::Mass(1.1 * half),
        PieceSize::Volume(0.55),
        PieceSize::Voxels(5 * 8usize.pow(D::N as u32 - 1)),
    ] {
        let removed = world.clone().remove_small_pieces(size).unwrap();
        assert_eq!(removed.pieces.len(), 2, "{size:?}");
    }
    for bad in [f64::NAN, -1.0, f64::INFINITY] {
        let error = world.remove_small_pieces(PieceSize::Mass(bad)).unwrap_err();
        let expected = format!("size must be 0 or more, and finite, given {bad:?}");
        assert_eq!(error.to_string(), expected);
    }
}

#[test]
fn remove_small_pieces_compares_mass_volume_or_voxels() {
    check_sizes::<Dim2>();
    check_sizes::<Dim3>();
}

fn check_outside<D: Blades>() {
    let (mut world, cube) = halves::<D>(weightless());
    let views = world[cube].piece_views();
    let right = views
        .iter()
        .find(|view| view.centre[0] > 0.5)
        .unwrap()
        .number;
    let ball = |x| {
        let shape = Shape::ball(0.2).translated(vector(x, 0.0, 0.0));
        RigidBody::dynamic(shape, 1.0)
    };
    let near = world.add_rigid_body(ball(-2.1)).unwrap();
    let far = world.add_rigid_body(ball(-2.3)).unwrap();
    let hand = world
        .add_rigid_body(RigidBody::coupled(Shape::ball(0.1)).at(vector(-9.0, 0.0, 0.0)))
        .unwrap();
    let region = Shape::cuboid(vector(1.2, 3.0, 3.0)).translated(vector(-0.8, 0.0, 0.0));
    let removed = world.remove_outside(&region).unwrap();
    assert_eq!(
        (removed.pieces, removed.rigid_bodies),
        (vec![(cube, right)], vec![far])
    );
    assert!(world.rigid_body(near).is_ok() && world.rigid_body(hand).is_ok());
    assert!(
        world
            .events()
            .contains(&Event::RigidBodyRemoved { body: far })
    );
    let error = world.remove_outside(&Shape::ball(-1.0)).unwrap_err();
    assert_eq!(
        error.to_string(),
        "region: radius must be positive and finite, given -1.0"
    );
}

#[test]
fn remove_outside_removes_pieces_and_dynamic_bodies() {
    check_outside::<Dim2>();
    check_outside::<Dim3>();
}

/// `changes_since` reports a tear and a removal together if both happened since the bookmark.
#[test]
fn changes_since_reports_tear_and_removal_together() {
    let mut world = World::<Dim2>::new(weightless()).unwrap();
    let cube = SoftBody::new(VoxelGrid::cube(32, 1.0).unwrap(), &[Material::default()]).unwrap();
    let cube = world.add_soft_body(cube).unwrap();
    let mut bookmark: Bookmark = world[cube].bookmark();
    let blade = Blade::segment(Vec2::new(-0.1, 0.2), Vec2::new(0.2, -0.1));
    world.cut(cube, &blade).unwrap();
    world.remove_piece(cube, PieceId(1)).unwrap();
    let body = &world[cube];
    let changes = body.changes_since(&mut bookmark).unwrap();
    assert_eq!(
        (changes.detached, changes.removed),
        (vec![PieceId(1)], vec![PieceId(1)])
    );
    assert!(changes.elements.is_sorted() && changes.nodes.is_sorted());
}
