//! The same bits after saving and loading.
#![cfg(feature = "serde")]

use fuwafuwa::Rigid;
use fuwafuwa::hash::Hash;
use fuwafuwa::{Body, Dim, Dim2, Dim3, Material, Settings, Shape, VoxelGrid, World};

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
        let mut changed = header[..9].to_vec();
        changed.extend(Hash::of(&state).to_le_bytes());
        changed.extend(state);
        let loaded = load::<Dim2>(&changed);
        broken += u32::from(matches!(loaded, Err(BadSnapshot::Broken { .. })));
    }
    assert!(broken > 500, "{broken} of {}", state.len());
}
