//! Tick lengths: physical results do not depend on the length of a tick.

use crate::vectors::vector;
use fuwafuwa::{
    DEFAULT_TICK, Dim, Dim2, Dim3, DimAngular, DimVector, Error, Event, Hooks, MAX_TICK, MIN_TICK,
    Material, RigidBody, Shape, SoftBody, Substep, Vec2, VoxelGrid, World, WorldConfig,
};

const TICKS: [f32; 6] = [
    MIN_TICK,
    1.0 / 120.0,
    1.0 / 90.0,
    DEFAULT_TICK,
    1.0 / 50.0,
    MAX_TICK,
];

fn world<D: Dim>(tick: f32) -> World<D> {
    let settings = WorldConfig {
        tick,
        ..WorldConfig::default()
    };
    let mut world = World::new(settings).unwrap();
    let floor = Shape::half_space(D::Vector::Y, D::Vector::ZERO);
    world
        .add_rigid_body(RigidBody::fixed(floor).with_friction(0.4))
        .unwrap();
    world
}

fn ball<D: Dim>(n: usize) -> SoftBody<D> {
    let strong = Material {
        strength: f32::INFINITY,
        toughness: f32::INFINITY,
        ..Material::default()
    };
    SoftBody::new(VoxelGrid::ball(n, 1.0).unwrap(), &[strong]).unwrap()
}

/// Steps a world for a time [s] and calls `watch` after each tick.
fn pass<D: Dim>(world: &mut World<D>, seconds: f32, mut watch: impl FnMut(&World<D>)) {
    let ticks = (seconds / world.config().tick).round() as u32;
    for _ in 0..ticks {
        world.step();
        watch(world);
    }
}

fn check_fall<D: Dim>() {
    // A body falls 1.226 m in 0.5 s, whatever the length of a tick.
    for tick in TICKS {
        let mut world = world::<D>(tick);
        let ball = world
            .add_soft_body(ball::<D>(12).translated(vector(0.0, 5.0, 0.0)))
            .unwrap();
        let start = world[ball].centre_of_mass()[1];
        pass(&mut world, 0.5, |_| {});
        let seconds = (0.5 / tick).round() * tick;
        let fallen = start - world[ball].centre_of_mass()[1];
        let expected = 0.5 * 9.81 * seconds * seconds;
        assert!(
            (fallen / expected - 1.0).abs() < 0.01,
            "tick {tick}: {fallen} m"
        );
    }
}

#[test]
fn fall_distance_is_independent_of_tick() {
    check_fall::<Dim2>();
    check_fall::<Dim3>();
}

/// Returns the time at which a dropped ball first touches the floor [s], the lowest height of its centre [m],
/// and the time at which it falls asleep [s].
fn landing<D: Dim>(tick: f32) -> [f32; 3] {
    let mut world = world::<D>(tick);
    let ball = world
        .add_soft_body(ball::<D>(12).translated(vector(0.0, 0.5, 0.0)))
        .unwrap();
    let (mut lowest, mut touched, mut slept) = (f32::MAX, 0.0, 0.0);
    pass(&mut world, 30.0, |world| {
        let seconds = world.ticks() as f32 * tick;
        if touched == 0.0 && { world.events().iter() }
            .any(|event| matches!(event, Event::ContactForce(_)))
        {
            touched = seconds;
        }
        lowest = lowest.min(world[ball].centre_of_mass()[1]);
        if slept == 0.0 && world[ball].pieces().list.iter().all(|piece| piece.asleep) {
            slept = seconds;
        }
    });
    [touched, lowest, slept]
}

fn check_landing<D: Dim>() {
    let [touched, lowest, slept] = landing::<D>(DEFAULT_TICK);
    assert!(slept > 0.0, "the ball must fall asleep");
    for tick in TICKS {
        let [other, squashed, resting] = landing::<D>(tick);
        assert!(
            (other - touched).abs() <= tick + DEFAULT_TICK,
            "{tick}: {other} for {touched} s"
        );
        assert!(
            (squashed - lowest).abs() < 0.02,
            "{tick}: {squashed} for {lowest} m"
        );
        assert!(
            (resting / slept - 1.0).abs() < 0.3,
            "{tick}: {resting} for {slept} s"
        );
    }
}

#[test]
fn landing_is_independent_of_tick() {
    check_landing::<Dim2>();
    check_landing::<Dim3>();
}

/// Returns the number of nodes that split when a hand moves through a ball at 1.5 m/s, for any tick length.
fn torn<D: Dim>(tick: f32) -> u32 {
    let mut world = world::<D>(tick);
    let soft = Material {
        strength: 500.0,
        toughness: 100.0,
        ..Material::default()
    };
    let body = SoftBody::new(VoxelGrid::<D>::ball(12, 1.0).unwrap(), &[soft]).unwrap();
    world.add_soft_body(body).unwrap();
    let wall = Shape::half_space(vector(-1.0, 0.0, 0.0), vector(1.1, 0.0, 0.0));
    world
        .add_rigid_body(RigidBody::fixed(wall).with_friction(0.2))
        .unwrap();
    let depth = if D::N == 3 { 0.5 } else { 0.0 };
    let hand = world
        .add_rigid_body(RigidBody::coupled(Shape::ball(0.1)).at(vector(-0.3, 0.5, depth)))
        .unwrap();
    let mut released = 0;
    for number in 1..=(1.0 / tick).round() as u32 {
        let along = -0.3 + 1.5 * number as f32 * tick;
        world
            .set_target_position(hand, vector(along, 0.5, depth))
            .unwrap();
        released += world.step().nodes_split;
    }
    released
}

#[test]
fn tearing_is_similar_at_any_tick() {
    for tear in [torn::<Dim2>, torn::<Dim3>] {
        let usual = tear(DEFAULT_TICK);
        assert!(usual > 10);
        for tick in TICKS {
            let other = f64::from(tear(tick)) / f64::from(usual);
            assert!(
                (0.4..2.5).contains(&other),
                "tick {tick}: {other} of {usual}"
            );
        }
    }
}

#[test]
fn substeps_per_second_are_independent_of_tick() {
    for tick in TICKS {
        let mut world = world::<Dim2>(tick);
        world.add_soft_body(ball::<Dim2>(12)).unwrap();
        let a_second = world.step().substeps as f32 / tick;
        assert!(
            (a_second / 960.0 - 1.0).abs() < 0.05,
            "tick {tick}: {a_second}"
        );
    }
    // At any tick length, a body that is too stiff for the maximum number of substeps is softened by the same
    // factor.
    let scale = |tick| {
        let stiff = Material {
            elasticity: fuwafuwa::inspect::Elasticity::new(5e7, 0.3).unwrap(),
            ..Material::default()
        };
        let mut world = world::<Dim3>(tick);
        let body = SoftBody::new(VoxelGrid::ball(8, 0.2).unwrap(), &[stiff]).unwrap();
        let id = world.add_soft_body(body).unwrap();
        world[id].mass_scale()
    };
    let usual = scale(DEFAULT_TICK);
    assert!(usual > 2.0);
    for tick in TICKS {
        assert!((scale(tick) / usual - 1.0).abs() < 0.05, "tick {tick}");
    }
}

#[test]
fn config_rejects_tick_out_of_range() {
    for tick in [
        0.0,
        -DEFAULT_TICK,
        f32::NAN,
        f32::INFINITY,
        1.0 / 29.0,
        1.0 / 250.0,
    ] {
        let settings = WorldConfig {
            tick,
            ..WorldConfig::default()
        };
        let refused = World::<Dim2>::new(settings).unwrap_err();
        assert_eq!(
            refused.to_string(),
            format!("tick must be 1/240 to 1/30 s, given {tick:?}")
        );
        let mut world = world::<Dim2>(DEFAULT_TICK);
        assert!(matches!(
            world.set_config(settings),
            Err(Error::InvalidParameter { field, .. }) if field == "tick"
        ));
        assert_eq!(world.config().tick, DEFAULT_TICK);
    }
}

/// Checks that each field of a new configuration takes effect on a running world.
#[test]
fn set_config_takes_effect_immediately() {
    let usual = WorldConfig::default();
    let mut world = world::<Dim2>(DEFAULT_TICK);
    let ball = world
        .add_soft_body(ball::<Dim2>(12).translated(Vec2::new(0.0, 50.0)))
        .unwrap();
    let speed = |world: &World<Dim2>| {
        let body = &world[ball];
        body.momentum().linear[1] / body.total_mass()
    };
    let mut gain = |settings: WorldConfig<Dim2>| {
        world.set_config(settings).unwrap();
        let before = speed(&world);
        let substeps = world.step().substeps;
        (speed(&world) - before, before, substeps)
    };
    let near = |found: f64, expected: f64| {
        assert!((found - expected).abs() < 1e-3, "{found} for {expected}");
    };
    let tick = f64::from(DEFAULT_TICK);
    near(gain(usual).0, -9.81 * tick);
    let gravity = Vec2::new(0.0, 3.0);
    near(gain(WorldConfig { gravity, ..usual }).0, 3.0 * tick);
    let halved = WorldConfig {
        tick: 0.5 * DEFAULT_TICK,
        ..usual
    };
    let (found, _, substeps) = gain(halved);
    near(found, -9.81 * 0.5 * tick);
    assert_eq!(substeps, 8);
    let few = WorldConfig {
        max_substeps: 8,
        ..usual
    };
    assert_eq!(gain(few).2, 8);
    let braked = WorldConfig {
        drag: 10.0,
        gravity: Vec2::ZERO,
        ..usual
    };
    let (found, before, _) = gain(braked);
    let kept = 1.0f64 - 10.0 / 240.0;
    near(found / before, kept * kept * kept * kept - 1.0);
}

/// Checks that the hook after each substep receives the same forces and torques as are stored at the end of
/// the tick.
fn check_callback<D: Dim>(tick: f32) {
    let mut world = world::<D>(tick);
    world.add_soft_body(ball::<D>(12)).unwrap();
    let depth = if D::N == 3 { 0.5 } else { 0.0 };
    // The bar meets the ball with one end, so that the contact exerts a force and a torque on the bar.
    let bar = Shape::capsule(vector(-1.0, 0.0, 0.0), vector(0.3, 0.0, 0.0), 0.1);
    let hand = RigidBody::coupled(bar).at(vector(-0.2, 1.2, depth));
    let hand = world.add_rigid_body(hand).unwrap();
    let mut most = 0.0f32;
    for number in 1..=(0.5 / tick).round() as u32 {
        let down = (1.2 * number as f32 * tick).min(0.55);
        world
            .set_target_position(hand, vector(-0.2, 1.2 - down, depth))
            .unwrap();
        let mut felt = Vec::new();
        let mut time = 0.0;
        let mut note = |substep: &Substep<D>| {
            felt.push(substep.reaction(hand).unwrap());
            time += substep.duration;
        };
        let hooks = &mut Hooks {
            after_substep: Some(&mut note),
            ..Hooks::default()
        };
        let report = world.step_with(hooks);
        assert_eq!(felt.len(), report.substeps as usize);
        assert!((time - tick).abs() < 1e-6);
        let stored = world.rigid_body(hand).unwrap().reactions();
        assert_eq!(felt, stored.collect::<Vec<_>>());
        for reaction in felt {
            let torque = reaction.torque.to_vec3().z;
            most = most.max(torque);
            if reaction.contact[1] > 1.0 {
                // The contact is to the right of the hand's centre and pushes up, so its torque is
                // counterclockwise.
                assert!(torque > 0.0, "{reaction:?}");
            }
        }
    }
    assert!(most > 1.0, "tick {tick}: {most} N m");
}

#[test]
fn substep_hook_reports_stored_reactions() {
    for tick in [MIN_TICK, DEFAULT_TICK, MAX_TICK] {
        check_callback::<Dim2>(tick);
        check_callback::<Dim3>(tick);
    }
}
