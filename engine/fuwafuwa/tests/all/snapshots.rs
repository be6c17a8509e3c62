//! Snapshots: a loaded world continues bit-identically to the saved world.

use crate::blades::Blades;
use crate::vectors::vector;
use fuwafuwa::inspect::Hash;
use fuwafuwa::snapshot::{VERSION, load, save};
use fuwafuwa::{
    Blade, Dim, Dim2, Dim3, DimVector, Error, Event, Joint, JointAnchor, JointKind, Knife,
    Material, RigidBody, Rotation, Shape, SoftBody, Vec2, Vec3, Velocity, VoxelGrid, World,
    WorldConfig, snapshot,
};

/// Returns a world in which a ball falls on a floor, while a hand presses it against a wall until it tears.
fn torn_world<D: Dim>(n: usize) -> World<D> {
    let mut world = World::<D>::new(WorldConfig::default()).unwrap();
    let floor = Shape::half_space(D::Vector::Y, D::Vector::ZERO);
    world
        .add_rigid_body(RigidBody::fixed(floor).with_friction(0.4))
        .unwrap();
    let wall = Shape::half_space(vector(-1.0, 0.0, 0.0), vector(1.1, 0.0, 0.0));
    world
        .add_rigid_body(RigidBody::fixed(wall).with_friction(0.2))
        .unwrap();
    let ball = VoxelGrid::ball(n, 1.0).unwrap();
    let body = SoftBody::new(ball, &[Material::default()]).unwrap();
    world
        .add_soft_body(body.translated(vector(0.0, 0.05, 0.0)))
        .unwrap();
    let depth = if D::N == 3 { 0.5 } else { 0.0 };
    let hand = RigidBody::coupled(Shape::ball(0.08)).at(vector(-0.3, 0.5, depth));
    world.add_rigid_body(hand).unwrap();
    world
}

fn push<D: Dim>(world: &mut World<D>, ticks: std::ops::Range<u32>) {
    let depth = if D::N == 3 { 0.5 } else { 0.0 };
    for tick in ticks {
        world
            .set_target_position(
                world.nth_target_follower(0).unwrap(),
                vector(-0.3 + tick as f32 * 0.03, 0.5, depth),
            )
            .unwrap();
        world.step();
    }
}

/// An impact is slowed for several ticks, and each of them can be loaded.
#[test]
fn loaded_world_continues_fast_impact() {
    fn check<D: Dim>() {
        let mut world = World::<D>::new(WorldConfig::default()).unwrap();
        let floor = Shape::half_space(D::Vector::Y, D::Vector::ZERO);
        world.add_rigid_body(RigidBody::fixed(floor)).unwrap();
        let ball = VoxelGrid::ball(12, 0.05).unwrap();
        let body = SoftBody::new(ball, &[Material::default()]).unwrap();
        let body = world
            .add_soft_body(body.translated(vector(0.0, 0.5, 0.0)))
            .unwrap();
        let linear = vector(3.0, -60.0, 0.0);
        let velocity = Velocity {
            linear,
            ..Velocity::default()
        };
        world.set_velocity(body, velocity).unwrap();
        let mut slowed = 0;
        for _ in 0..6 {
            let mut loaded = load::<D>(&save(&world)).unwrap();
            slowed += world.step().slowed_impacts;
            loaded.step();
            assert_eq!(loaded.hash(), world.hash());
        }
        assert!(slowed > 0);
    }
    check::<Dim2>();
    check::<Dim3>();
}

fn check_resumes<D: Dim>(n: usize) {
    let mut world = torn_world::<D>(n);
    push(&mut world, 0..40);
    let mut resumed = load::<D>(&save(&world)).unwrap();
    assert_eq!(resumed.hash(), world.hash());
    push(&mut world, 40..60);
    push(&mut resumed, 40..60);
    assert_eq!(resumed.hash(), world.hash());
}

#[test]
fn loaded_world_continues_with_same_bits() {
    check_resumes::<Dim2>(24);
    check_resumes::<Dim3>(12);
}

/// Returns the world of `torn_world` with dynamic boxes, a sensor, a pin, a spring and a rope added.
fn tied_world<D: Dim>() -> World<D> {
    let mut world = torn_world::<D>(10);
    let depth = if D::N == 3 { 0.5 } else { 0.0 };
    let cube = |x, y| Shape::cuboid(D::Vector::splat(0.12)).translated(vector(x, y, depth));
    let gate = RigidBody::fixed(cube(0.5, 1.3)).with_friction(0.5);
    let gate = gate.rotated(Rotation::in_plane(0.3)).with_sensor(true);
    world.add_rigid_body(gate).unwrap();
    let boxes: Vec<_> = (0..6)
        .map(|k| {
            let free = RigidBody::dynamic(cube(0.4 + 0.03 * k as f32, 1.4 + 0.3 * k as f32), 0.5);
            let turned = free.rotated(Rotation::in_plane(0.4 * k as f32));
            world.add_rigid_body(turned).unwrap()
        })
        .collect();
    let on = |k: usize, y| JointAnchor::on(boxes[k], vector(0.4, y, depth));
    let ball = world.nth_soft_body(0).unwrap();
    let ball = JointAnchor::on(ball, vector(0.5, 1.0, depth)).within(0.2);
    let spring = JointKind::Spring {
        stiffness: 50.0,
        damping: 0.5,
        length: 0.3,
    };
    let place = JointAnchor::Point(vector(0.4, 4.0, depth));
    let ties = [
        (on(0, 1.4), ball, JointKind::Pin),
        (on(1, 1.7), on(2, 2.0), spring),
        (on(5, 2.9), place, JointKind::Rope { length: 1.5 }),
    ];
    for (first, second, tie) in ties {
        world.add_joint(Joint::new([first, second], tie)).unwrap();
    }
    world
}

fn check_tied_resumes<D: Dim>() {
    let mut world = tied_world::<D>();
    let (mut told, mut saves) = (0, 0);
    let mut resumed = load::<D>(&save(&world)).unwrap();
    for tick in 0..150 {
        push(&mut world, tick.min(60)..tick.min(60) + 1);
        push(&mut resumed, tick.min(60)..tick.min(60) + 1);
        assert_eq!(resumed.hash(), world.hash(), "{tick}");
        assert_eq!(resumed.events(), world.events(), "{tick}");
        let is_change = |event: &&Event<D>| {
            matches!(
                event,
                Event::ContactStarted(_)
                    | Event::ContactEnded { .. }
                    | Event::SensorEntered { .. }
                    | Event::SensorExited { .. }
            )
        };
        told += world.events().iter().filter(is_change).count();
        if tick % 20 == 7 {
            resumed = load::<D>(&save(&world)).unwrap();
            saves += 1;
        }
    }
    assert!(told > 10 && saves == 8, "{told} {saves}");
}

#[test]
fn loaded_world_continues_with_same_bits_with_joints_and_sensors() {
    check_tied_resumes::<Dim2>();
    check_tied_resumes::<Dim3>();
}

/// Checks that a world that is saved and loaded while a knife cuts through a falling ball continues
/// bit-identically.
fn check_cut_resumes<D: Dim>() {
    let mut world = torn_world::<D>(14);
    let depth = if D::N == 3 { 0.5 } else { 0.0 };
    let hand = world.nth_target_follower(0).unwrap();
    world.remove(hand).unwrap();
    let holder = RigidBody::kinematic(Shape::ball(0.05)).at(vector(-0.2, 0.45, depth));
    let holder = holder.with_sensor(true);
    let holder = world.add_rigid_body(holder).unwrap();
    let edge = [-0.4, 0.4].map(|z| vector(0.0, 0.0, z));
    world
        .add_knife(Knife::new(holder, edge, D::Vector::X))
        .unwrap();
    let (mut resumed, mut cuts) = (load::<D>(&save(&world)).unwrap(), 0);
    for tick in 0..90 {
        for world in [&mut world, &mut resumed] {
            let at = vector(-0.2 + 0.015 * tick as f32, 0.45, depth);
            world.set_target_position(holder, at).unwrap();
            world
                .set_target_rotation(holder, Rotation::in_plane(0.002 * tick as f32))
                .unwrap();
            world.step();
        }
        assert_eq!(resumed.hash(), world.hash(), "{tick}");
        assert_eq!(resumed.events(), world.events(), "{tick}");
        let is_cut = |event: &&Event<D>| matches!(event, Event::Cut { .. });
        cuts += world.events().iter().filter(is_cut).count();
        if tick % 7 == 3 {
            resumed = load::<D>(&save(&world)).unwrap();
        }
    }
    assert!(cuts > 10, "{cuts}");
}

#[test]
fn loaded_world_continues_with_same_bits_during_cut() {
    check_cut_resumes::<Dim2>();
    check_cut_resumes::<Dim3>();
}

/// Checks that a saved and loaded world continues bit-identically while a hand moves through crumbs, some of
/// them asleep, and another body is cut.
fn check_crumbs_resume<D: Blades>(n: usize) {
    let mut world = torn_world::<D>(2 * n);
    let ball = world.nth_soft_body(0).unwrap();
    let cube = SoftBody::new(VoxelGrid::cube(n, 0.5).unwrap(), &[Material::default()]).unwrap();
    let crumbs = world
        .add_soft_body(cube.translated(vector(-1.5, 0.0, 0.3)))
        .unwrap();
    world.soft_body_mut(crumbs).unwrap().crumble();
    let hand = world
        .add_rigid_body(RigidBody::coupled(Shape::ball(0.1)).at(vector(-3.0, 0.1, 0.5)))
        .unwrap();
    let (mut mixed, mut resumed) = (0, load::<D>(&save(&world)).unwrap());
    for tick in 0..480 {
        let along = (tick as f32 - 100.0).max(0.0) * 0.02 - 3.0;
        for world in [&mut world, &mut resumed] {
            world
                .set_target_position(hand, vector(along, 0.1, 0.5))
                .unwrap();
            push(world, tick.min(50)..tick.min(50) + 1);
            if tick == 45 {
                let corner = Vec3::new(0.5, -2.0, -0.5);
                let blade = D::blade(corner, Vec3::new(0.1, 4.0, 0.0), Vec3::Z);
                assert!(world.cut(ball, &blade).unwrap() > 0);
            }
        }
        assert_eq!(resumed.hash(), world.hash(), "tick {tick}");
        let pieces = &world[crumbs].pieces().list;
        let asleep = pieces.iter().filter(|piece| piece.asleep).count();
        mixed += usize::from(asleep > 0 && asleep < pieces.len());
        if tick % 40 == 20 {
            resumed = load::<D>(&save(&world)).unwrap();
        }
    }
    assert!(mixed > 20, "{mixed}");
}

#[test]
fn loaded_world_continues_with_same_bits_with_sleeping_pieces() {
    check_crumbs_resume::<Dim2>(8);
    check_crumbs_resume::<Dim3>(4);
}

/// Checks snapshots of a world with bodies in every state: torn, fixed, moved by the program, quarantined,
/// asleep, and woken.
fn check_any_state<D: Dim>(n: usize) {
    let mut world = torn_world::<D>(n);
    let nowhere = VoxelGrid::ball(4, 0.2).unwrap();
    let nowhere = SoftBody::new(nowhere, &[Material::default()]).unwrap();
    let other = world
        .add_soft_body(
            nowhere
                .with_velocity(Velocity::linear(D::Vector::splat(f32::NAN)))
                .translated(vector(5.0, 3.0, 0.0)),
        )
        .unwrap();
    let ball = world.nth_soft_body(0).unwrap();
    for tick in 0..60 {
        push(&mut world, tick..tick + 1);
        match tick {
            20 => {
                let body = world.soft_body_mut(ball).unwrap();
                let held: Vec<_> = body.mesh().nodes().map(|(id, _)| id).take(9).collect();
                for id in held {
                    body.fix_node(id);
                    let at = vector(0.1, 0.2, 0.3);
                    body.set_node_state(id, at, D::Vector::splat(1.0)).unwrap();
                }
            }
            40 => drop(world.soft_body_mut(other).unwrap().crumble()),
            _ => {}
        }
        let loaded = load::<D>(&save(&world)).map(|world| world.hash());
        assert_eq!(loaded, Ok(world.hash()), "tick {tick}");
    }
}

#[test]
fn load_accepts_any_valid_state() {
    check_any_state::<Dim2>(16);
    check_any_state::<Dim3>(8);
}

#[test]
fn load_rejects_damaged_snapshot() {
    let bytes = save(&torn_world::<Dim2>(8));
    let refused = |bytes: &[u8]| load::<Dim2>(bytes).map(|_| ()).unwrap_err();
    let solid = load::<Dim3>(&bytes).map(|_| ());
    let (expected, found) = (3, 2);
    assert_eq!(solid, Err(Error::SnapshotDimensions { expected, found }));
    assert_eq!(
        solid.unwrap_err().to_string(),
        "the snapshot is of a world with 2 dimensions, expected 3"
    );
    let other = refused(b"something else, long enough");
    assert_eq!(other, Error::NotASnapshot);
    assert_eq!(
        other.to_string(),
        "not a snapshot: the header is missing or truncated"
    );
    let mut newer = bytes.clone();
    newer[4] = 200;
    let (expected, found) = (VERSION, 200);
    assert_eq!(refused(&newer), Error::SnapshotVersion { expected, found });
    assert_eq!(
        refused(&newer).to_string(),
        format!("unsupported snapshot format 200, expected format {VERSION}")
    );
    for length in 0..bytes.len() {
        let error = refused(&bytes[..length]);
        match length < 17 {
            true => assert_eq!(error, Error::NotASnapshot),
            false => assert_eq!(error, Error::DamagedSnapshot),
        }
    }
    for place in 9..bytes.len() {
        let mut damaged = bytes.clone();
        damaged[place] ^= 4;
        assert_eq!(refused(&damaged), Error::DamagedSnapshot);
    }
}

/// Loading a snapshot that was altered and given a valid checksum must not panic or hang. For example, lists
/// of cells or nodes could be cyclic, and ids could be out of range.
#[test]
fn load_survives_altered_state_with_valid_checksum() {
    let bytes = save(&torn_world::<Dim2>(6));
    let (header, state) = bytes.split_at(17);
    let mut broken = 0;
    for place in 0..state.len() {
        let mut state = state.to_vec();
        state[place] ^= 1 << (place % 7);
        let loaded = load::<Dim2>(&with_state(header, state));
        broken += u32::from(is_body_invalid(&loaded));
    }
    assert!(broken > 500, "{broken} of {}", state.len());
}

/// Returns whether loading failed because the first soft body is invalid.
fn is_body_invalid<T>(loaded: &Result<T, Error>) -> bool {
    match loaded {
        Err(Error::InvalidSnapshot { reason }) => reason.starts_with("soft body 0: "),
        _ => false,
    }
}

/// Returns a snapshot with the version and dimensions of `header`, the bytes of `state`, and a valid
/// checksum.
fn with_state(header: &[u8], state: Vec<u8>) -> Vec<u8> {
    let mut changed = header[..9].to_vec();
    changed.extend(Hash::of(&state).to_le_bytes());
    changed.extend(state);
    changed
}

/// Regression: a 2D body with a node off the plane passed the checks, and the contact search panicked.
#[test]
fn load_rejects_node_off_plane_or_non_finite() {
    let mut world = torn_world::<Dim2>(6);
    push(&mut world, 0..3);
    let (_, body) = world.soft_bodies().next().unwrap();
    let (id, _) = body.mesh().nodes().nth(5).unwrap();
    let (at, velocity, mass) = body.node_state(id);
    let bytes = save(&world);
    let (header, state) = bytes.split_at(17);
    let written = |vector: Vec2| -> Vec<u8> {
        let row = [vector.x, vector.y, 0.0, 0.0];
        row.into_iter().flat_map(f32::to_le_bytes).collect()
    };
    let mut refused = 0;
    let mut check = |row: Vec<u8>, change: &dyn Fn(&mut [u8])| {
        let places = 0..state.len() - row.len();
        for place in places.filter(|&place| state[place..].starts_with(&row)) {
            let mut state = state.to_vec();
            change(&mut state[place..][..row.len()]);
            let loaded = load::<Dim2>(&with_state(header, state)).map(|_| ());
            assert!(is_body_invalid(&loaded), "{loaded:?}");
            refused += 1;
        }
    };
    for axis in 0..4 {
        for wrong in [f32::NAN, f32::INFINITY, 0.5] {
            // Skips finite values of the coordinates within the plane, because they give valid positions.
            if axis < 2 && wrong.is_finite() {
                continue;
            }
            let change =
                |row: &mut [u8]| row[4 * axis..][..4].copy_from_slice(&wrong.to_le_bytes());
            check(written(at), &change);
            check(written(velocity), &change);
        }
    }
    let lighter = |row: &mut [u8]| row.copy_from_slice(&(0.5 * mass).to_le_bytes());
    check(mass.to_le_bytes().to_vec(), &lighter);
    assert!(refused > 20, "{refused}");
}

/// The world changes between two ticks: one body is cut, another body is removed, and a third body takes its
/// arena slot.
#[test]
fn loaded_world_continues_with_same_bits_after_changes() {
    let ball = |x: f32| {
        let grid = VoxelGrid::<Dim2>::ball(16, 1.0).unwrap();
        let body = SoftBody::new(grid, &[Material::default()]).unwrap();
        body.translated(Vec2::new(x, 0.02))
    };
    let mut world = World::<Dim2>::new(WorldConfig::default()).unwrap();
    let floor = Shape::half_space(Vec2::Y, Vec2::ZERO);
    world
        .add_rigid_body(RigidBody::fixed(floor).with_friction(0.4))
        .unwrap();
    let ids = [0.0, 0.97, 1.94].map(|x| world.add_soft_body(ball(x)).unwrap());
    let (down, blade) = (
        RigidBody::coupled(Shape::ball(0.1)).at(Vec2::new(1.4, 1.2)),
        Blade::segment(Vec2::new(0.5, -1.0), Vec2::new(0.5, 2.0)),
    );
    let hand = world.add_rigid_body(down).unwrap();
    world
        .set_target_position(hand, Vec2::new(1.4, 0.7))
        .unwrap();
    (0..30).for_each(|_| {
        world.step();
    });
    type Change<'a> = &'a dyn Fn(&mut World<Dim2>);
    let changes: [Change<'_>; 4] = [
        &|world| assert!(world.cut(ids[0], &blade).unwrap() > 0),
        &|world| drop(world.remove(ids[1]).unwrap()),
        &|world| {
            assert_eq!(
                world.add_soft_body(ball(0.97)).unwrap(),
                world.nth_soft_body(1).unwrap()
            )
        },
        &|world| _ = world.remove(hand).unwrap(),
    ];
    for change in changes {
        let mut loaded = snapshot::load::<Dim2>(&snapshot::save(&world)).unwrap();
        change(&mut world);
        change(&mut loaded);
        let mut others = [
            loaded,
            world.clone(),
            snapshot::load(&snapshot::save(&world)).unwrap(),
        ];
        for _ in 0..5 {
            let report = world.step();
            for other in &mut others {
                assert_eq!(other.step(), report);
                assert_eq!(other.hash(), world.hash());
            }
        }
    }
}

/// Returns a world with a tearing body, bodies in contact, a sleeping body, a quarantined body and a free
/// arena slot.
fn full_of_all<D: Dim>(n: usize) -> World<D> {
    let mut world = torn_world::<D>(n);
    let small = |at: D::Vector| {
        let grid = VoxelGrid::ball(2, 0.2).unwrap();
        let body = SoftBody::new(grid, &[Material::default()]).unwrap();
        body.translated(at)
    };
    world.add_soft_body(small(vector(0.4, 1.05, 0.4))).unwrap();
    world.add_soft_body(small(vector(-3.0, 0.0, 0.0))).unwrap();
    world.add_soft_body(small(vector(-2.9, 0.2, 0.0))).unwrap();
    world
        .add_soft_body(
            small(vector(5.0, 3.0, 0.0))
                .with_velocity(Velocity::linear(D::Vector::splat(f32::NAN))),
        )
        .unwrap();
    let gone = world.add_soft_body(small(vector(-5.0, 1.0, 0.0))).unwrap();
    push(&mut world, 0..40);
    world.remove(gone).unwrap();
    world
}

/// Random changes to a few bytes of a snapshot: flipped bits, replaced, removed and inserted bytes, and
/// unusual floating-point numbers.
struct Changer(u32);

impl Changer {
    fn below(&mut self, bound: usize) -> usize {
        self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (self.0 >> 8) as usize % bound
    }

    fn change(&mut self, state: &mut Vec<u8>) {
        for _ in 0..[1, 1, 2, 5][self.below(4)] {
            let place = self.below(state.len() - 4);
            match self.below(6) {
                0 => state[place] ^= 1 << self.below(8),
                1 => state[place] = self.below(256) as u8,
                2 => state[place] = [0, 0x7f, 0x80, 0xff][self.below(4)],
                3 => drop(state.remove(place)),
                4 => state.insert(place, self.below(256) as u8),
                _ => {
                    let odd = [f32::NAN, f32::INFINITY, -f32::MAX, 1e-40, -0.0, 1e20];
                    let odd = odd[self.below(odd.len())].to_le_bytes();
                    state[place..place + 4].copy_from_slice(&odd);
                }
            }
        }
    }
}

/// Checks that each altered snapshot is rejected or can be stepped. Returns the number of snapshots that
/// could be stepped.
fn check_changed<D: Dim>(n: usize, variants: u32) -> u32 {
    let bytes = save(&full_of_all::<D>(n));
    let (header, state) = bytes.split_at(17);
    let (mut stepped, mut panicked) = (0, Vec::new());
    for seed in 0..variants {
        let mut changed = state.to_vec();
        Changer(seed).change(&mut changed);
        let snapshot = with_state(header, changed);
        let ended = std::panic::catch_unwind(|| {
            let Ok(mut world) = load::<D>(&snapshot) else {
                return 0;
            };
            (0..3).for_each(|_| _ = world.step());
            let again = load::<D>(&save(&world)).map(|again| again.hash());
            assert_eq!(again, Ok(world.hash()));
            for body in world.soft_bodies().map(|(id, _)| id).collect::<Vec<_>>() {
                world.remove(body).unwrap();
            }
            1
        });
        match ended {
            Ok(count) => stepped += count,
            Err(_) => panicked.push(seed),
        }
    }
    assert!(panicked.is_empty(), "panics in {panicked:?}");
    stepped
}

/// Loading must not reserve memory for the length that a list states before the entries are read.
#[test]
fn load_reserves_no_memory_for_stated_length() {
    let bytes = save(&full_of_all::<Dim2>(6));
    let (header, state) = bytes.split_at(17);
    for place in 0..state.len() {
        for length in [&[0xff, 0xff, 0xff, 0xff, 0x0f][..], &[0xff; 9]] {
            let rest = state[place..].iter().skip(1);
            let changed = state[..place].iter().chain(length).chain(rest);
            drop(load::<Dim2>(&with_state(
                header,
                changed.copied().collect(),
            )));
        }
    }
}

/// Regression: element batches were loaded without checks, and their ids could be out of range.
#[test]
fn altered_snapshot_is_rejected_or_steppable() {
    let stepped = [
        check_changed::<Dim2>(8, 1500),
        check_changed::<Dim3>(4, 1000),
    ];
    println!("number of stepped worlds: {stepped:?}");
    assert!(stepped.iter().all(|&stepped| stepped > 150), "{stepped:?}");
}
