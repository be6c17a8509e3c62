//! The same bits after saving and loading.
#![cfg(feature = "serde")]

use fuwafuwa::hash::Hash;
use fuwafuwa::{
    Blade, Body, Dim, Dim2, Dim3, Material, Rigid, Settings, Shape, VoxelGrid, World, snapshot,
};

/// A ball that falls on a floor while a hand pushes it against a wall and through.
fn torn_world<D: Dim>(n: usize) -> World<D> {
    let mut world = World::<D>::new(Settings::default()).unwrap();
    let floor = Shape::half_space([0.0, 1.0, 0.0], [0.0; 3]);
    world.add_rigid(Rigid::fixed(floor, 0.4)).unwrap();
    let wall = Shape::half_space([-1.0, 0.0, 0.0], [1.1, 0.0, 0.0]);
    world.add_rigid(Rigid::fixed(wall, 0.2)).unwrap();
    let ball = VoxelGrid::ball(n, 1.0).unwrap();
    let body = Body::new(ball, &[Material::default()]).unwrap();
    world.add_body(body.moved([0.0, 0.05, 0.0]));
    let depth = if D::N == 3 { 0.5 } else { 0.0 };
    let hand = Rigid::hand([-0.3, 0.5, depth], 0.08);
    world.add_rigid(hand).unwrap();
    world
}

fn push<D: Dim>(world: &mut World<D>, ticks: std::ops::Range<u32>) {
    let depth = if D::N == 3 { 0.5 } else { 0.0 };
    for tick in ticks {
        world
            .set_goal(
                world.nth_hand(0).unwrap(),
                [-0.3 + tick as f32 * 0.03, 0.5, depth],
            )
            .unwrap();
        world.step();
    }
}

use fuwafuwa::snapshot::{BadSnapshot, load, save};

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
fn a_saved_world_goes_on_to_the_same_bits() {
    check_resumes::<Dim2>(24);
    check_resumes::<Dim3>(12);
}

/// Torn, held, placed, gone out of hand, woken again or asleep: each is a state that a body can be in.
fn check_any_state<D: Dim>(n: usize) {
    let mut world = torn_world::<D>(n);
    let nowhere = VoxelGrid::ball(4, 0.2).unwrap();
    let nowhere = Body::new(nowhere, &[Material::default()]).unwrap();
    let other = world.add_body(nowhere.thrown([f32::NAN; 3]).moved([5.0, 3.0, 0.0]));
    let ball = world.nth_body(0).unwrap();
    for tick in 0..60 {
        push(&mut world, tick..tick + 1);
        match tick {
            20 => {
                let body = world.body_mut(ball).unwrap();
                let held: Vec<_> = body.mesh().nodes().map(|(id, _)| id).take(9).collect();
                for id in held {
                    body.hold(id);
                    assert!(body.set_node_state(id, [0.1, 0.2, 0.3], [1.0; 3]));
                }
            }
            40 => drop(world.body_mut(other).unwrap().crumble().unwrap()),
            _ => {}
        }
        let loaded = load::<D>(&save(&world)).map(|world| world.hash());
        assert_eq!(loaded, Ok(world.hash()), "tick {tick}");
    }
}

#[test]
fn a_world_can_be_loaded_whatever_befell_it() {
    check_any_state::<Dim2>(16);
    check_any_state::<Dim3>(8);
}

#[test]
fn what_is_not_as_it_was_saved_is_refused() {
    let bytes = save(&torn_world::<Dim2>(8));
    let refused = |bytes: &[u8]| load::<Dim2>(bytes).map(|_| ()).unwrap_err();
    let solid = load::<Dim3>(&bytes).map(|_| ());
    assert_eq!(solid, Err(BadSnapshot::Dimensions { found: 2 }));
    assert_eq!(refused(b"something else, long enough"), BadSnapshot::NotOne);
    let mut newer = bytes.clone();
    newer[4] = 200;
    assert_eq!(refused(&newer), BadSnapshot::Version { found: 200 });
    for length in 0..bytes.len() {
        refused(&bytes[..length]);
    }
    for place in 9..bytes.len() {
        let mut damaged = bytes.clone();
        damaged[place] ^= 4;
        assert_eq!(refused(&damaged), BadSnapshot::Damaged);
    }
}

/// With its checksum put right, what somebody changed is still read without harm: a list of cells or nodes
/// could go round for ever, and an id lead out of its table.
#[test]
fn what_was_changed_by_someone_who_knows_the_checksum_does_no_harm() {
    let bytes = save(&torn_world::<Dim2>(6));
    let (header, state) = bytes.split_at(17);
    let mut broken = 0;
    for place in 0..state.len() {
        let mut state = state.to_vec();
        state[place] ^= 1 << (place % 7);
        let loaded = load::<Dim2>(&with_state(header, state));
        broken += u32::from(matches!(loaded, Err(BadSnapshot::Broken { .. })));
    }
    assert!(broken > 500, "{broken} of {}", state.len());
}

/// A header of a snapshot with what is behind it, and a checksum that fits.
fn with_state(header: &[u8], state: Vec<u8>) -> Vec<u8> {
    let mut changed = header[..9].to_vec();
    changed.extend(Hash::of(&state).to_le_bytes());
    changed.extend(state);
    changed
}

/// A body in the plane with a node beside it went through the checks, and contact search panicked.
#[test]
fn a_node_that_is_off_the_plane_or_nowhere_is_refused() {
    let mut world = torn_world::<Dim2>(6);
    push(&mut world, 0..3);
    let body = world.bodies().iter().next().unwrap();
    let (id, _) = body.mesh().nodes().nth(5).unwrap();
    let (at, velocity, mass) = body.node_state(id);
    let bytes = save(&world);
    let (header, state) = bytes.split_at(17);
    let written = |vector: [f32; 3]| -> Vec<u8> {
        let row = vector.into_iter().chain([0.0]);
        row.flat_map(f32::to_le_bytes).collect()
    };
    let mut refused = 0;
    let mut check = |row: Vec<u8>, change: &dyn Fn(&mut [u8])| {
        let places = 0..state.len() - row.len();
        for place in places.filter(|&place| state[place..].starts_with(&row)) {
            let mut state = state.to_vec();
            change(&mut state[place..][..row.len()]);
            let loaded = load::<Dim2>(&with_state(header, state)).map(|_| ());
            let broken = matches!(loaded, Err(BadSnapshot::Broken { body: 0, .. }));
            assert!(broken, "{loaded:?}");
            refused += 1;
        }
    };
    for axis in 0..4 {
        for wrong in [f32::NAN, f32::INFINITY, 0.5] {
            // In the plane it may be anywhere.
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

/// Between two ticks a body was cut, another one was taken out and a third put into its place.
#[test]
fn what_was_changed_since_the_last_tick_goes_on_to_the_same_bits() {
    let ball = |x: f32| {
        let grid = VoxelGrid::<Dim2>::ball(16, 1.0).unwrap();
        let body = Body::new(grid, &[Material::default()]).unwrap();
        body.moved([x, 0.02, 0.0])
    };
    let mut world = World::<Dim2>::new(Settings::default()).unwrap();
    let floor = Shape::half_space([0.0, 1.0, 0.0], [0.0; 3]);
    world.add_rigid(Rigid::fixed(floor, 0.4)).unwrap();
    let ids = [0.0, 0.97, 1.94].map(|x| world.add_body(ball(x)));
    let (down, blade) = (
        Rigid::hand([1.4, 1.2, 0.0], 0.1),
        Blade::segment([0.5, -1.0], [0.5, 2.0]),
    );
    let hand = world.add_rigid(down).unwrap();
    world.set_goal(hand, [1.4, 0.7, 0.0]).unwrap();
    (0..30).for_each(|_| {
        world.step();
    });
    let changes: [&dyn Fn(&mut World<Dim2>); 4] = [
        &|world| assert!(world.cut(ids[0], &blade).unwrap() > 0),
        &|world| drop(world.remove_body(ids[1]).unwrap()),
        &|world| assert_eq!(world.add_body(ball(0.97)), world.nth_body(1).unwrap()),
        &|world| drop(world.remove_rigid(hand).unwrap()),
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
