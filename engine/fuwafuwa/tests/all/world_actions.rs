//! Methods that act on bodies from outside: rotation, translation, impulses, sleep, configuration, fields.

use crate::vectors::vector;
use fuwafuwa::{
    Bookmark, Dim, Dim2, Dim3, DimAngular, DimVector, Error, Event, Hooks, Impulse, Material,
    MotionType, NodeId, RigidBody, Rotation, Shape, SoftBody, SoftBodyHandle, Substep, Vec2, Vec3,
    Velocity, VoxelGrid, World, WorldConfig, field_around,
};
use std::f32::consts::{FRAC_PI_2, PI};

fn weightless<D: Dim>() -> WorldConfig<D> {
    WorldConfig {
        gravity: D::Vector::ZERO,
        ..WorldConfig::default()
    }
}

fn somewhere<V: DimVector>() -> V {
    vector(3.0, -2.0, 0.0)
}

fn ball<D: Dim>(n: usize) -> SoftBody<D> {
    SoftBody::new(VoxelGrid::ball(n, 1.0).unwrap(), &[Material::default()]).unwrap()
}

fn with<D: Dim>(settings: WorldConfig<D>, body: SoftBody<D>) -> (World<D>, SoftBodyHandle) {
    let mut world = World::new(settings).unwrap();
    let id = world.add_soft_body(body).unwrap();
    (world, id)
}

fn nodes<D: Dim>(body: &SoftBody<D>) -> Vec<NodeId> {
    body.mesh().nodes().map(|(id, _)| id).collect()
}

fn places<D: Dim>(body: &SoftBody<D>) -> Vec<D::Vector> {
    let all = nodes(body).into_iter();
    all.map(|id| body.node_state(id).0).collect()
}

/// Returns the maximum distance between corresponding nodes of two bodies [m].
fn apart<D: Dim>(a: &SoftBody<D>, b: &SoftBody<D>) -> f32 {
    let both = places(a).into_iter().zip(places(b));
    let gaps = both.map(|(a, b)| (a - b).length());
    gaps.fold(0.0, f32::max)
}

fn floor<D: Dim>() -> RigidBody<D> {
    RigidBody::fixed(Shape::half_space(D::Vector::Y, D::Vector::ZERO)).with_friction(0.3)
}

fn check_turned<D: Dim>(rotation: Rotation) {
    let body = ball::<D>(16);
    let centre = body.centre_of_mass();
    let turned = body.clone().rotated_about(rotation, centre);
    assert!((turned.total_mass() - body.total_mass()).abs() < 1e-9);
    let (mut world, id) = with(weightless(), turned.clone().translated(somewhere()));
    for _ in 0..120 {
        let report = world.step();
        assert_eq!(
            (report.nodes_split, report.inverted),
            (0, 0),
            "{rotation:?}"
        );
    }
    let after = &world[id];
    assert!(
        after.kinetic_energy() < 1e-6,
        "{rotation:?}: {} J",
        after.kinetic_energy()
    );
    let gap = apart(after, &turned.translated(somewhere()));
    assert!(gap < 1e-4, "{rotation:?}: {gap} m");
}

#[test]
fn rotated_body_stays_at_rest() {
    for angle in [0.1, 1.0, FRAC_PI_2, 2.5, PI, -FRAC_PI_2] {
        check_turned::<Dim2>(Rotation::in_plane(angle));
        for axis in [Vec3::X, Vec3::Z * -2.0, Vec3::new(1.0, -1.0, 0.5)] {
            check_turned::<Dim3>(Rotation::about(axis, angle));
        }
    }
}

/// Checks that `rotate_about` rotates the motion of a tearing body: after further ticks, the rotated body has
/// the rotated momentum and the kinetic energy of the original.
fn check_turned_in_motion<D: Dim>() {
    let rotation = Rotation::in_plane(PI);
    let (mut world, id) = with(weightless(), ball::<D>(16));
    let Vec3 { y, z, .. } = world[id].centre_of_mass().to_vec3();
    let impulse = Impulse::at(vector(0.0, y, z), vector(40.0, 0.0, 0.0));
    world.apply_impulse(id, impulse.within(0.3)).unwrap();
    (0..3).for_each(|_| _ = world.step());
    let mut turned = world.clone();
    turned.rotate_about(id, rotation, D::Vector::ZERO).unwrap();
    for _ in 0..20 {
        world.step();
        turned.step();
    }
    // Compares total momentum and energy instead of node positions, because rounding can change the path of
    // cracks.
    let [momentum, other] = [&world, &turned].map(|world| world[id].momentum().linear);
    let energies = [&world, &turned].map(|world| world[id].kinetic_energy());
    assert!(
        (momentum.x + other.x).abs() < 1e-3 * momentum.x.abs(),
        "{momentum:?} {other:?}"
    );
    assert!(
        (energies[0] / energies[1] - 1.0).abs() < 0.05,
        "{energies:?}"
    );
}

#[test]
fn rotated_world_moves_like_original() {
    check_turned_in_motion::<Dim2>();
    check_turned_in_motion::<Dim3>();
}

#[test]
fn scaled_grid_scales_mass_and_rejects_invalid_factors() {
    let small = VoxelGrid::<Dim3>::ball(8, 1.0).unwrap();
    let large = SoftBody::new(small.clone().scaled(2.0).unwrap(), &[Material::default()]).unwrap();
    let small = SoftBody::new(small, &[Material::default()]).unwrap();
    assert!((large.total_mass() / small.total_mass() - 8.0).abs() < 1e-5);
    for bad in [0.0, -1.0, f32::NAN, 1e9] {
        assert!(
            VoxelGrid::<Dim3>::ball(8, 1.0)
                .unwrap()
                .scaled(bad)
                .is_err(),
            "{bad}"
        );
    }
}

fn check_moved<D: Dim>() {
    let (mut world, id) = with(weightless(), ball::<D>(8));
    let before = world[id].clone();
    let mut bookmark = world[id].bookmark();
    world.translate(id, somewhere()).unwrap();
    world.step();
    let body = &world[id];
    assert!(apart(body, &before.translated(somewhere())) < 1e-5);
    assert_eq!(body.changes_since(&mut bookmark), Some(Default::default()));
    assert_eq!(body.changes_since(&mut Bookmark::default()), None);
}

#[test]
fn move_body_keeps_bookmarks_valid() {
    check_moved::<Dim2>();
    check_moved::<Dim3>();
}

/// Checks that a sleeping body wakes and falls when the body under it is moved away.
fn check_pulled_away<D: Dim>() {
    let mut world = World::<D>::new(WorldConfig::default()).unwrap();
    world.add_rigid_body(floor()).unwrap();
    let below = world
        .add_soft_body(
            SoftBody::new(VoxelGrid::cube(8, 1.0).unwrap(), &[Material::default()]).unwrap(),
        )
        .unwrap();
    let above = world
        .add_soft_body(
            SoftBody::new(VoxelGrid::cube(8, 1.0).unwrap(), &[Material::default()])
                .unwrap()
                .translated(vector(0.0, 1.001, 0.0)),
        )
        .unwrap();
    let sleeps = |world: &World<D>| {
        let is_still = |id: SoftBodyHandle| {
            let pieces = &world[id].pieces().list;
            pieces.iter().all(|piece| piece.asleep)
        };
        [below, above].map(is_still)
    };
    for id in [below, above] {
        world.put_to_sleep(id).unwrap();
    }
    (0..10).for_each(|_| _ = world.step());
    assert_eq!(sleeps(&world), [true; 2]);
    world.translate(below, vector(5.0, 0.0, 0.0)).unwrap();
    assert_eq!(sleeps(&world), [false; 2]);
    (0..120).for_each(|_| _ = world.step());
    let height = world[above].centre_of_mass()[1];
    assert!(height < 0.6, "{height}");
}

#[test]
fn move_body_wakes_bodies_in_contact_with_it() {
    check_pulled_away::<Dim2>();
    check_pulled_away::<Dim3>();
}

fn check_pushed<D: Dim>() {
    let (mut world, id) = with(weightless(), ball::<D>(16));
    let impulse: D::Vector = vector(3.0, -1.0, 0.0);
    for radius in [0.0, 0.1, 10.0] {
        let before = world[id].momentum();
        let impulse = Impulse::at(vector(0.5, 1.0, 0.0), impulse).within(radius);
        world.apply_impulse(id, impulse).unwrap();
        let gained = world[id].momentum().less(before);
        assert!((0..2).all(|k| (gained.linear[k] - f64::from(impulse.impulse[k])).abs() < 1e-3));
    }
    let mass = world[id].total_mass();
    let mut gained = |angular: Vec3| {
        let before = world[id].momentum();
        let velocity = Velocity {
            linear: vector(0.0, 2.0, 0.0),
            angular: D::Angular::from_vec3(angular),
        };
        world.add_velocity(id, velocity).unwrap();
        world[id].momentum().less(before)
    };
    let straight = gained(Vec3::ZERO);
    assert!((straight.linear.y / mass - 2.0).abs() < 1e-3);
    let turning = gained(Vec3::Z * 3.0);
    assert!((turning.linear.y / mass - 2.0).abs() < 1e-3);
    // Moment of inertia about the centre, as a share of m r²: 1/2 for a disc, 2/5 for a ball.
    let share = if D::N == 2 { 0.5 } else { 0.4 };
    let inertia = share * mass * 0.25;
    let spin = turning.less(straight).angular.z / inertia;
    assert!((spin - 3.0).abs() < 0.6, "{spin}");
}

/// Checks that a body that is almost asleep stays awake when gravity is switched on. At first, the body still
/// moves slower than the sleep threshold.
#[test]
fn gravity_change_resets_sleep_timer() {
    let pulls: [fn(&mut World<Dim2>, SoftBodyHandle); 3] = [
        |world, _| {
            let settings = WorldConfig {
                gravity: Vec2::NEG_Y,
                ..weightless()
            };
            world.set_config(settings).unwrap();
        },
        |world, body| world.set_gravity_scale(body, 0.1).unwrap(),
        |world, body| world.set_gravity_scale(body, -0.1).unwrap(),
    ];
    for (index, pull) in pulls.into_iter().enumerate() {
        let gravity = match index {
            0 => Vec2::ZERO,
            _ => Vec2::new(0.0, -10.0),
        };
        let settings = WorldConfig {
            gravity,
            ..weightless()
        };
        let (mut world, body) = with(settings, ball(8));
        world.set_gravity_scale(body, 0.0).unwrap();
        (0..29).for_each(|_| _ = world.step());
        if index == 0 {
            world.set_gravity_scale(body, 1.0).unwrap();
            (0..29).for_each(|_| _ = world.step());
        }
        pull(&mut world, body);
        (0..60).for_each(|_| _ = world.step());
        let speed = world[body].momentum().linear.y / world[body].total_mass();
        assert!(speed.abs() > 0.9, "{index}: {speed}");
    }
}

#[test]
fn impulse_and_velocity_change_momentum_exactly() {
    check_pushed::<Dim2>();
    check_pushed::<Dim3>();
}

fn check_pull<D: Dim>() {
    let mut world = World::<D>::new(WorldConfig::default()).unwrap();
    let scales = [1.0, 0.5, 0.0, -2.0];
    let bodies: Vec<SoftBodyHandle> = (0..4)
        .map(|k| {
            world
                .add_soft_body(ball::<D>(8).translated(vector(3.0 * k as f32, 0.0, 0.0)))
                .unwrap()
        })
        .collect();
    for (&body, scale) in bodies.iter().zip(scales) {
        world.set_gravity_scale(body, scale).unwrap();
    }
    (0..12).for_each(|_| _ = world.step());
    for (&body, scale) in bodies.iter().zip(scales) {
        let body = &world[body];
        let speed = body.momentum().linear.y / body.total_mass();
        assert!(
            (speed + 9.81 * 0.2 * f64::from(scale)).abs() < 1e-3,
            "{scale}: {speed}"
        );
    }
}

#[test]
fn gravity_scale_multiplies_acceleration() {
    check_pull::<Dim2>();
    check_pull::<Dim3>();
}

fn check_sleep<D: Dim>() {
    let (mut world, sleeper) = with(WorldConfig::default(), ball::<D>(8));
    world.put_to_sleep(sleeper).unwrap();
    let before = world[sleeper].clone();
    (0..60).for_each(|_| _ = world.step());
    assert_eq!(apart(&world[sleeper], &before), 0.0);
    // A second body falls on the sleeping one and wakes it.
    world
        .add_soft_body(ball::<D>(8).translated(vector(0.0, 1.5, 0.0)))
        .unwrap();
    let woke = |world: &World<D>| {
        let events = world.events().iter();
        { events }.any(|event| matches!(event, Event::WokeUp { body, .. } if *body == sleeper))
    };
    assert!((0..60).any(|_| {
        world.step();
        woke(&world)
    }));
    world.put_to_sleep(sleeper).unwrap();
    world.wake_up(sleeper).unwrap();
    let at = world[sleeper].centre_of_mass()[1];
    (0..10).for_each(|_| _ = world.step());
    assert!(world[sleeper].centre_of_mass()[1] < at);
}

#[test]
fn put_to_sleep_lasts_until_impact_or_wake_up() {
    check_sleep::<Dim2>();
    check_sleep::<Dim3>();
}

#[test]
fn set_config_applies_to_running_world() {
    let (mut world, id) = with(WorldConfig::default(), ball::<Dim2>(8));
    let upwards = WorldConfig {
        gravity: Vec2::new(0.0, 9.81),
        ..WorldConfig::default()
    };
    world.set_config(upwards).unwrap();
    (0..12).for_each(|_| _ = world.step());
    assert!(world[id].momentum().linear.y > 0.0);
    let few = WorldConfig {
        max_substeps: 8,
        ..upwards
    };
    let hard = Material {
        elasticity: fuwafuwa::inspect::Elasticity {
            young: 1e6,
            poisson: 0.3,
        },
        ..Material::default()
    };
    let grid = VoxelGrid::<Dim2>::ball(32, 1.0).unwrap();
    let hard = world
        .add_soft_body(
            SoftBody::new(grid, &[hard])
                .unwrap()
                .translated(Vec2::new(5.0, 0.0)),
        )
        .unwrap();
    let few_substeps = world[hard].mass_scale();
    world.set_config(few).unwrap();
    let fewer_substeps = world[hard].mass_scale();
    assert!(
        fewer_substeps > few_substeps,
        "{fewer_substeps} {few_substeps}"
    );
    world.set_config(upwards).unwrap();
    assert_eq!(world[hard].mass_scale(), few_substeps);
    let bad = WorldConfig { drag: -1.0, ..few };
    let told = world.set_config(bad).unwrap_err();
    assert_eq!(told.to_string(), "drag must be 0 to 10, given -1.0");
    assert_eq!(*world.config(), upwards);
}

fn check_field<D: Dim>() {
    let mut world = World::<D>::new(weightless()).unwrap();
    let sides = [-3.0, 3.0].map(|x| {
        world
            .add_soft_body(ball::<D>(8).translated(vector(x, 0.0, 0.0)))
            .unwrap()
    });
    let planet = field_around::<D::Vector>(vector(0.5, 0.5, 0.0), 5.0, 1.0);
    let nowhere = |_| D::Vector::splat(f32::NAN);
    let fields: [&(dyn Fn(D::Vector) -> D::Vector + Sync); 2] = [&planet, &nowhere];
    for field in fields {
        for _ in 0..6 {
            let field = Some(field);
            world.step_with(&mut Hooks {
                field,
                ..Hooks::default()
            });
        }
        let speeds = sides.map(|id| {
            let body = &world[id];
            body.momentum().linear.x / body.total_mass()
        });
        // Up to its reach of 1 m, the field accelerates by 5 m/s². At the balls, 3 m from its centre, it
        // accelerates by a ninth of this for 0.1 s.
        assert!((speeds[0] - 5.0 / 9.0 * 0.1).abs() < 0.01, "{speeds:?}");
        assert!((speeds[0] + speeds[1]).abs() < 0.01, "{speeds:?}");
    }
}

#[test]
fn field_accelerates_towards_centre() {
    check_field::<Dim2>();
    check_field::<Dim3>();
}

/// Checks the torque on a coupled bar that presses on a body one metre to the right of the bar's centre. The
/// body pushes the bar up, so the torque is counterclockwise.
fn check_torque<D: Dim>() {
    let (mut world, _) = with(weightless(), ball::<D>(16));
    let bar = Shape::capsule(-D::Vector::X, vector(3.0, 0.0, 0.0), 0.1);
    let depth = if D::N == 2 { 0.0 } else { 0.5 };
    let bar = RigidBody::new(bar, MotionType::default()).at(vector(-0.5, 1.12, depth));
    let bar = world.add_rigid_body(bar).unwrap();
    world
        .set_target_position(bar, vector(-0.5, 1.0, depth))
        .unwrap();
    let (mut torque, mut force) = (Vec3::ZERO, 0.0);
    for _ in 0..10 {
        let mut feel = |substep: &Substep<D>| {
            let felt = substep.reaction(bar).unwrap();
            torque += felt.torque.to_vec3() * substep.duration;
            force += felt.contact[1] * substep.duration;
        };
        world.step_with(&mut Hooks {
            after_substep: Some(&mut feel),
            ..Hooks::default()
        });
    }
    assert!(force > 0.1, "{force}");
    // The contact is one metre to the right of the bar's centre, so the torque [N m] equals the force [N]
    // times 1 m.
    assert!((torque.z / force - 1.0).abs() < 0.1, "{torque:?} {force}");
    assert!(torque.x.abs() + torque.y.abs() < 0.1 * torque.z);
}

#[test]
fn coupled_body_reports_contact_torque() {
    check_torque::<Dim2>();
    check_torque::<Dim3>();
}

/// Number of different actions in `act`.
const ACTS: usize = 8;

fn act<D: Dim>(
    world: &mut World<D>,
    which: usize,
    body: SoftBodyHandle,
    k: f32,
) -> Result<(), Error> {
    let vector = Vec3::new(k, -0.5 * k, k);
    let (vector, angular) = (D::Vector::from_vec3(vector), D::Angular::from_vec3(vector));
    match which {
        0 => world.translate(body, vector),
        1 => world.rotate_about(body, Rotation::about(Vec3::new(1.0, k, 2.0), k), vector),
        2 => world.add_velocity(
            body,
            Velocity {
                linear: vector,
                angular,
            },
        ),
        3 => world.apply_impulse(body, Impulse::at(vector, vector).within(k)),
        4 => world.set_gravity_scale(body, k),
        5 => world.wake_up(body),
        6 => world.put_to_sleep(body),
        _ => world.set_config(WorldConfig {
            gravity: vector,
            drag: k,
            max_substeps: 16,
            ..WorldConfig::default()
        }),
    }
}

/// Calls random actions in random order, some with non-finite numbers or with handles of removed bodies.
fn check_any<D: Dim>(seeds: std::ops::Range<u64>) {
    let numbers = [
        0.0,
        0.3,
        -1.0,
        5.0,
        1e5,
        1e6,
        1e30,
        -1e30,
        f32::INFINITY,
        f32::NAN,
        f32::MIN_POSITIVE,
    ];
    for seed in seeds {
        let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
        let mut random = |below: usize| {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            (state >> 33) as usize % below
        };
        let (mut world, first) = with(WorldConfig::default(), ball::<D>(4));
        world.add_rigid_body(floor()).unwrap();
        let mut bodies = vec![first];
        for _ in 0..30 {
            let body = bodies[random(bodies.len())];
            match random(12) {
                0 => {
                    let by = vector(random(5) as f32, 1.0, 0.0);
                    bodies.push(world.add_soft_body(ball::<D>(4).translated(by)).unwrap());
                }
                1 => _ = world.remove(body),
                2..5 => _ = world.step(),
                _ => {
                    let is_there = world.soft_body(body).is_ok();
                    let which = random(ACTS);
                    let done = act(&mut world, which, body, numbers[random(numbers.len())]);
                    if which < ACTS - 1 && !is_there {
                        assert!(done.is_err());
                    }
                }
            }
        }
        world.step();
        for (_, body) in world.soft_bodies() {
            body.mesh()
                .validate(body.grid(), body.connectivity())
                .unwrap();
            assert!(places(body).iter().all(|at| at.is_finite()), "{seed}");
        }
    }
}

#[test]
fn world_stays_valid_under_random_calls() {
    check_any::<Dim2>(0..500);
    check_any::<Dim3>(500..1000);
}
