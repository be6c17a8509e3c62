//! What should not be asked for, and what should not be in a world: nothing panics, all stays
//! finite, and whoever asked is told.

use fuwafuwa::{
    Blade, Body, Dim, Dim2, Dim3, Drive, Event, Grading, Law, Manipulator, Material, Settings,
    Shape, VoxelGrid, With, World,
};

const FLOOR: Shape = Shape::HalfSpace {
    normal: [0.0, 1.0, 0.0],
    offset: 0.0,
};

fn world<D: Dim>() -> World<D> {
    let mut world = World::new(Settings::default()).unwrap();
    world.add_obstacle(FLOOR, 0.5).unwrap();
    world
}

fn ball<D: Dim>(n: usize) -> Body<D> {
    Body::new(VoxelGrid::ball(n, 1.0).unwrap(), &[Material::default()]).unwrap()
}

fn step<D: Dim>(world: &mut World<D>, ticks: usize) {
    for _ in 0..ticks {
        world.step();
    }
}

fn assert_finite<D: Dim>(world: &World<D>) {
    for body in world.bodies() {
        body.mesh().validate(body.grid(), body.sharing()).unwrap();
        for (id, _) in body.mesh().nodes() {
            let (at, velocity, mass) = body.node_state(id);
            let mut all = at.iter().chain(&velocity).chain([&mass]);
            assert!(all.all(|k| k.is_finite()), "{at:?} {velocity:?} {mass}");
            assert!(D::N == 3 || (at[2] == 0.0 && velocity[2] == 0.0), "{at:?}");
        }
    }
    for hand in world.manipulators() {
        let (at, velocity) = (hand.position(), hand.velocity());
        let mut all = at.iter().chain(&velocity);
        assert!(all.all(|k| k.is_finite()), "{at:?} {velocity:?}");
    }
}

/// A body that is nowhere is stopped, put to where it was made, and reported.
#[test]
fn a_body_that_is_no_place_is_quarantined() {
    for nowhere in [f32::NAN, f32::INFINITY] {
        let mut world = world::<Dim2>();
        world.add_body(ball(12).moved([nowhere, 0.0, 0.0]));
        world.add_body(ball(12).moved([3.0, 0.0, 0.0]).thrown([0.0, nowhere, 0.0]));
        let report = world.step();
        assert_eq!(report.quarantined, 2);
        assert_finite(&world);
        step(&mut world, 5);
        assert_finite(&world);
        let centres = world
            .bodies()
            .iter()
            .map(|body| body.piece_views()[0].centre);
        let expected = [[0.5, 0.5, 0.0], [3.5, 0.5, 0.0]];
        for (centre, expected) in centres.zip(expected) {
            let apart = (0..2).map(|axis| (centre[axis] - expected[axis]).abs());
            assert!(apart.fold(0.0, f32::max) < 0.01, "{centre:?}");
        }
    }
}

/// A prototype restored positions by node ids, which a release in the same tick had given to other
/// nodes, or to none: elements were stretched to the origin.
#[test]
fn a_piece_that_tears_in_its_last_tick_is_not_stretched() {
    let mut world = world::<Dim2>();
    world.add_body(ball(24).moved([5.0, 0.0, 0.0]));
    let hand = Manipulator::new([5.5, 1.1, 0.0], 0.08).driven(Drive::Kinematic);
    world.add_manipulator(hand).unwrap();
    let mut both = 0;
    for tick in 0..40u16 {
        world.set_goal(0, [5.5, 1.1 - 0.03 * f32::from(tick), 0.0]);
        world.step();
        let mut doomed = world.clone();
        let body = doomed.body_mut(0);
        *body = body.clone().thrown([f32::NAN; 3]);
        let report = doomed.step();
        both += u32::from(report.released > 0 && report.quarantined > 0);
        assert_finite(&doomed);
        let body = &doomed.bodies()[0];
        for (_, element) in body.mesh().elements() {
            let places = || element.nodes.iter().map(|&node| body.node_state(node).0);
            let width = element.cell.width() as f32 / 24.0;
            for axis in 0..2 {
                let low = places().map(|at| at[axis]).fold(f32::MAX, f32::min);
                let high = places().map(|at| at[axis]).fold(f32::MIN, f32::max);
                assert!(high - low < 6.0 * width, "tick {tick}: {low} to {high}");
            }
        }
    }
    assert!(both > 3, "{both} ticks with a release and a quarantine");
}

/// What is not finite touches nothing: a hand and a neighbour beside it are left as they are.
#[test]
fn a_body_out_of_hand_spoils_nothing_else() {
    let mut world = world::<Dim2>();
    for (place, x) in [0.0, 0.97].into_iter().enumerate() {
        world.add_body(ball(16).moved([x, 0.0, 0.0]));
        let hand = Manipulator::new([x + 0.5, 0.95, 0.0], 0.1);
        let drive = [Drive::Kinematic, Drive::default()][place];
        world.add_manipulator(hand.driven(drive)).unwrap();
    }
    step(&mut world, 10);
    let body = world.body_mut(0);
    *body = body.clone().thrown([f32::NAN; 3]);
    assert_eq!(world.step().quarantined, 1);
    assert_finite(&world);
    let forces = world
        .manipulators()
        .iter()
        .flat_map(|hand| hand.reactions());
    for reaction in forces {
        let mut all = reaction.contact.iter().chain(&reaction.coupling);
        assert!(all.all(|k| k.is_finite()), "{reaction:?}");
    }
}

#[test]
fn what_came_off_a_quarantined_piece_is_quarantined() {
    let mut world = world::<Dim2>();
    world.add_body(ball(12).thrown([f32::NAN, 0.0, 0.0]));
    world.step();
    world.cut(0, &Blade::segment([0.5, -1.0], [0.5, 2.0]));
    let views = world.bodies()[0].piece_views();
    assert_eq!(views.len(), 2);
    assert!(views.iter().all(|view| view.asleep && view.quarantined));
}

/// Grading::Coarse is for counting: its surface elements cannot be split.
fn check_coarse<D: Dim>(blade: Blade) {
    let grid = VoxelGrid::<D>::ball(12, 1.0).unwrap();
    let coarse = Body::with(
        grid,
        &[Material::default()],
        Law::PatchExact,
        Grading::Coarse,
    );
    let mut world = world::<D>();
    world.add_body(coarse.unwrap());
    let depth = if D::N == 3 { 0.5 } else { 0.0 };
    let hand = Manipulator::new([0.5, 1.2, depth], 0.1).driven(Drive::Kinematic);
    world.add_manipulator(hand).unwrap();
    for tick in 0..60u16 {
        world.set_goal(0, [0.5, 1.2 - 0.02 * f32::from(tick), depth]);
        assert_eq!(world.step().released, 0);
    }
    assert_eq!(world.cut(0, &blade), 0);
    assert!(world.body_mut(0).crumble().unwrap().is_empty());
    step(&mut world, 5);
    assert_finite(&world);
}

#[test]
fn a_coarse_body_neither_tears_nor_is_cut() {
    check_coarse::<Dim2>(Blade::segment([0.5, -0.1], [0.5, 1.1]));
    check_coarse::<Dim3>(Blade {
        from: [0.5, -0.1, -0.1],
        across: [0.0, 1.2, 0.0],
        along: [0.0, 0.0, 1.2],
    });
}

#[test]
fn hands_without_bounds_are_refused() {
    let mut world = world::<Dim2>();
    let usual = || Manipulator::new([0.0, 3.0, 0.0], 0.1);
    let Drive::Coupled {
        mass,
        stiffness,
        damping,
        limit,
    } = Drive::default()
    else {
        panic!("the usual hand is coupled");
    };
    let drive = |mass, stiffness, damping, limit| {
        usual().driven(Drive::Coupled {
            mass,
            stiffness,
            damping,
            limit,
        })
    };
    let infinite = f32::INFINITY;
    let mut slippery = usual();
    slippery.friction = infinite;
    let bad = [
        (Manipulator::new([0.0, 1e30, 0.0], 0.1), "position"),
        (Manipulator::new([0.0; 3], infinite), "radius"),
        (slippery, "friction"),
        (drive(infinite, stiffness, damping, limit), "mass"),
        (drive(1e-30, stiffness, damping, limit), "mass"),
        (drive(mass, infinite, damping, limit), "stiffness"),
        (drive(mass, stiffness, infinite, limit), "damping"),
        (drive(mass, stiffness, damping, f32::NAN), "limit"),
    ];
    for (hand, field) in bad {
        let message = world.add_manipulator(hand).unwrap_err().to_string();
        assert!(message.contains(field), "{message}");
    }
    assert!(world.add_obstacle(FLOOR, infinite).is_err());
    world
        .add_manipulator(drive(mass, stiffness, damping, infinite))
        .unwrap();
    world
        .add_manipulator(usual().driven(Drive::Kinematic))
        .unwrap();
    for hand in 0..2 {
        assert!(!world.set_goal(hand, [1e38, 0.0, 0.0]));
        assert!(world.set_goal(hand, [1e6, -1e6, 0.0]));
    }
    world.step();
    assert_finite(&world);
}

/// In the plane third coordinates do not count: nothing is pushed out of it.
#[test]
fn what_stands_off_the_plane_pushes_nothing_out_of_it() {
    let shapes = [
        Shape::half_space([0.0, 1.0, 1.0], [0.0; 3]),
        Shape::Box {
            centre: [0.5, -0.5, 7.0],
            half: [2.0, 0.5, 0.0],
        },
        Shape::Capsule {
            from: [-1.0, -0.5, 0.2],
            to: [2.0, -0.5, -0.1],
            radius: 0.5,
        },
    ];
    for shape in shapes {
        let mut world = World::<Dim2>::new(Settings::default()).unwrap();
        world.add_obstacle(shape, 0.5).unwrap();
        world.add_body(ball(12).moved([0.0, 0.02, 0.0]));
        let hand = Manipulator::new([0.5, 0.9, 0.05], 0.1);
        world.add_manipulator(hand).unwrap();
        step(&mut world, 30);
        assert_finite(&world);
        let low = world.bodies()[0].piece_views()[0].low[1];
        assert!(low > -0.03, "{shape:?}: {low}");
    }
    let edge_on = Shape::half_space([0.0, 0.0, 1.0], [0.0; 3]);
    assert!(world::<Dim2>().add_obstacle(edge_on, 0.5).is_err());
    let body = ball::<Dim2>(12);
    let region = Shape::Box {
        centre: [0.5, 0.5, 3.0],
        half: [1.0, 1.0, 0.0],
    };
    let share = f64::from(body.mass_inside(&region)) / body.total_mass();
    assert!((share - 1.0).abs() < 1e-5, "{share}");
}

#[test]
fn a_body_in_the_place_of_another_may_have_fewer_nodes_and_pieces() {
    let mut world = world::<Dim2>();
    let mut dust = ball(16);
    dust.crumble().unwrap();
    world.add_body(dust);
    step(&mut world, 20);
    *world.body_mut(0) = ball(8);
    step(&mut world, 5);
    assert_finite(&world);
}

/// A body on a floor, a while later.
fn sleeper() -> World<Dim2> {
    let mut world = world::<Dim2>();
    let damped = Material {
        damping: 0.5,
        ..Material::default()
    };
    let grid = VoxelGrid::ball(16, 1.0).unwrap();
    world.add_body(Body::new(grid, &[damped]).unwrap());
    for _ in 0..900 {
        world.step();
        if world.bodies()[0].piece_views()[0].asleep {
            return world;
        }
    }
    panic!("the body does not fall asleep");
}

#[test]
fn a_sleeper_changed_from_outside_wakes() {
    let mut thrown = sleeper();
    let body = thrown.body_mut(0);
    *body = body.clone().thrown([0.0, 5.0, 0.0]);
    let woke = |event: &Event| matches!(event, Event::Woke { body: 0, piece: 0 });
    assert!(thrown.events().iter().any(woke));
    step(&mut thrown, 10);
    assert!(thrown.bodies()[0].piece_views()[0].low[1] > 0.3);

    let mut crumbled = sleeper();
    crumbled.body_mut(0).crumble().unwrap();
    let before = crumbled.bodies()[0].piece_views();
    step(&mut crumbled, 10);
    let after = crumbled.bodies()[0].piece_views();
    let frozen = before
        .iter()
        .zip(&after)
        .filter(|(before, after)| before.centre == after.centre);
    assert!(
        after.len() > 100 && frozen.count() == 0,
        "no crumb hangs in the air"
    );
}

#[test]
fn what_leant_on_what_is_removed_falls() {
    let mut world = sleeper();
    world.remove_obstacle(0);
    assert!(world.obstacles().is_empty());
    step(&mut world, 30);
    let view = world.bodies()[0].piece_views()[0];
    assert!(!view.asleep && view.high[1] < 0.5, "{view:?}");
}

#[test]
fn a_sleeper_that_is_put_back_elsewhere_falls() {
    let mut world = sleeper();
    let body = world.remove_body(0).moved([0.0, 3.0, 0.0]);
    world.add_body(body);
    step(&mut world, 30);
    let view = world.bodies()[0].piece_views()[0];
    assert!(!view.asleep && view.low[1] < 2.5, "{view:?}");
}

#[test]
fn a_body_is_as_stiff_as_the_world_that_it_is_in_bears() {
    let stiff = Material {
        elasticity: fuwafuwa::Elasticity {
            young: 1e6,
            poisson: 0.3,
        },
        ..Material::default()
    };
    let world_of = |most_substeps| {
        let settings = Settings {
            most_substeps,
            ..Settings::default()
        };
        World::<Dim2>::new(settings).unwrap()
    };
    let (mut poor, mut rich) = (world_of(16), world_of(1024));
    poor.add_body(Body::new(VoxelGrid::ball(16, 1.0).unwrap(), &[stiff]).unwrap());
    let stiffness_scale = poor.bodies()[0].stiffness_scale();
    assert!(stiffness_scale < 0.2);
    rich.add_body(poor.remove_body(0));
    assert_eq!(rich.bodies()[0].stiffness_scale(), 1.0);
    poor.add_body(rich.remove_body(0));
    assert_eq!(poor.bodies()[0].stiffness_scale(), stiffness_scale);
}

#[test]
fn things_leave_and_the_rest_move_up() {
    let mut world = world::<Dim2>();
    for place in 0..3u8 {
        let x = 2.0 * f32::from(place);
        world.add_body(ball(8 + 4 * usize::from(place)).moved([x, 0.0, 0.0]));
        let hand = Manipulator::new([x + 0.5, 1.1, 0.0], 0.1);
        let hand = world.add_manipulator(hand).unwrap();
        world.set_goal(hand, [x + 0.5, 0.8, 0.0]);
    }
    step(&mut world, 10);
    assert_eq!(world.remove_body(1).grid().size()[0], 12);
    assert!(world.remove_manipulator(0).position()[0] < 1.0);
    step(&mut world, 30);
    assert_finite(&world);
    let sizes = world.bodies().iter().map(|body| body.grid().size()[0]);
    assert_eq!(sizes.collect::<Vec<_>>(), [8, 16]);
    let with = |event: &Event| match *event {
        Event::Touched { body, with, .. } => Some((body, with)),
        _ => None,
    };
    let touched: Vec<_> = world.events().iter().filter_map(with).collect();
    let hand = fuwafuwa::With::Manipulator;
    assert!(touched.contains(&(1, hand(1))), "{touched:?}");
    assert!(!touched.contains(&(0, hand(0))), "{touched:?}");
}

#[test]
fn a_held_node_that_is_let_go_falls() {
    let mut world = World::<Dim2>::new(Settings::default()).unwrap();
    let mut body = ball::<Dim2>(8);
    let nodes: Vec<u32> = body.mesh().nodes().map(|(id, _)| id).collect();
    nodes.iter().for_each(|&id| body.hold(id));
    world.add_body(body);
    let height = |world: &World<Dim2>| world.bodies()[0].piece_views()[0].centre[1];
    let start = height(&world);
    step(&mut world, 120);
    assert_eq!(height(&world), start);
    let body = world.body_mut(0);
    nodes.iter().for_each(|&id| body.let_go(id));
    step(&mut world, 30);
    assert!(height(&world) < start - 1.0);
}

#[test]
fn a_material_that_no_voxel_has_changes_nothing() {
    let stiff = Material {
        elasticity: fuwafuwa::Elasticity {
            young: 1e9,
            poisson: 0.3,
        },
        friction: 2.0,
        ..Material::default()
    };
    let hash_with = |materials: &[Material]| {
        let mut world = world::<Dim2>();
        world.add_body(Body::new(VoxelGrid::ball(16, 1.0).unwrap(), materials).unwrap());
        assert_eq!(world.bodies()[0].stiffness_scale(), 1.0);
        let hand = Manipulator::new([0.5, 1.1, 0.0], 0.1).driven(Drive::Kinematic);
        let hand = world.add_manipulator(hand).unwrap();
        let mut released = 0;
        for tick in 0..40u8 {
            world.set_goal(hand, [0.5, 1.1 - 0.03 * f32::from(tick), 0.0]);
            released += world.step().released;
        }
        assert!(released > 10, "it does not tear");
        world.hash()
    };
    let usual = Material::default();
    assert_eq!(hash_with(&[usual, stiff]), hash_with(&[usual]));
}

/// A cut on purpose is reported as a tear is, where it happened, but sets no energy free.
#[test]
fn a_cut_is_told_where_it_was() {
    let mut world = world::<Dim2>();
    world.add_body(ball(16).moved([3.0, 0.0, 0.0]));
    let count = world.cut(0, &Blade::segment([3.5, -0.1], [3.5, 1.1]));
    let mut places = 0;
    for event in world.events() {
        if let Event::Released { at, energy, .. } = event {
            assert!(
                (at[0] - 3.5).abs() < 0.07 && (0.0..=1.0).contains(&at[1]),
                "{at:?}"
            );
            assert_eq!(*energy, 0.0);
            places += 1;
        }
    }
    assert_eq!(places, count);
    let parted = |event: &&Event| matches!(event, Event::Parted { .. });
    assert_eq!(world.events().iter().filter(parted).count(), 1);
}

fn bar(size: [usize; 2]) -> Body<Dim2> {
    let grid = VoxelGrid::from_fn([size[0], size[1], 1], 0.03, |_| 1).unwrap();
    Body::new(grid, &[Material::default()]).unwrap()
}

#[test]
fn a_quarantined_body_still_holds_others_up() {
    let mut world = World::new(Settings::default()).unwrap();
    world.add_body(bar([24, 4]).moved([f32::INFINITY, 0.0, 0.0]));
    world.add_body(bar([6, 6]).moved([0.27, 0.25, 0.0]));
    step(&mut world, 30);
    let view = &world.bodies()[1].piece_views()[0];
    assert!(view.low[1] > 0.05, "it fell through: {view:?}");
}

#[test]
fn another_body_in_the_place_of_one_is_taken_for_what_it_is() {
    let mut world = world::<Dim2>();
    world.add_body(bar([2, 7]));
    world.step();
    *world.body_mut(0) = bar([2, 8]).thrown([0.0, -4.0, 0.0]);
    let mut touches = 0;
    for _ in 0..30 {
        world.step();
        let is_own = |event: &&Event| {
            let own = With::Piece { body: 0, piece: 0 };
            matches!(event, Event::Touched { with, .. } if *with == own)
        };
        touches += world.events().iter().filter(is_own).count();
    }
    assert!(
        touches < 10,
        "its neighbouring voxels push each other {touches} times"
    );
}

/// Two bars that fly at each other, with nothing else.
fn about_to_meet() -> World<Dim2> {
    let settings = Settings {
        gravity: [0.0; 3],
        ..Settings::default()
    };
    let mut world = World::new(settings).unwrap();
    world.add_body(bar([6, 6]).thrown([1.0, 0.0, 0.0]));
    let other = bar([6, 6]).moved([0.4, 0.0, 0.0]);
    world.add_body(other.thrown([-1.0, 0.0, 0.0]));
    world
}

fn assert_they_meet(mut world: World<Dim2>) {
    step(&mut world, 40);
    let [left, right] = [0, 1].map(|body| world.bodies()[body].piece_views()[0].centre[0]);
    assert!(
        left < right,
        "they went through each other: {left}, {right}"
    );
}

#[test]
fn others_still_meet_when_one_was_quarantined() {
    for nowhere in [f32::NAN, f32::INFINITY] {
        let mut world = about_to_meet();
        world.add_body(bar([2, 2]).moved([nowhere, -3.0, 0.0]));
        assert_eq!(world.step().quarantined, 1);
        assert_they_meet(world);
    }
}

#[test]
fn small_voxels_still_meet_when_large_ones_came() {
    let mut world = about_to_meet();
    world.step();
    let grid = VoxelGrid::from_fn([2, 2, 1], 1.0, |_| 1).unwrap();
    let large = Body::new(grid, &[Material::default()]).unwrap();
    world.add_body(large.moved([0.0, -9.0, 0.0]));
    assert_they_meet(world);
}
