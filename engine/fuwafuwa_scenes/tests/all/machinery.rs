//! Moving obstacles, switches, fields, and hands that follow another one.

use fuwafuwa::{Dim2, Event, RigidBodyRef, Vec2, World};
use fuwafuwa_scenes::Recording;
use fuwafuwa_scenes::scene::{Machinery, Scene};

const HEAD: &str = "dim = 2\ngravity = [0.0, 0.0, 0.0]\n";
const BALL: &str = "[[body]]\nshape = \"ball\"\nn = 8\nwidth = 0.2\nat = [-0.1, -0.1, 0.0]\n";

fn built(parts: &[&str]) -> (Scene, World<Dim2>, Machinery<Dim2>) {
    let scene = Scene::read("test", &(HEAD.to_string() + &parts.concat()), &[]).unwrap();
    let world = scene.build::<Dim2>().unwrap();
    let machinery = Machinery::new(&scene, &world);
    (scene, world, machinery)
}

fn run(world: &mut World<Dim2>, machinery: &mut Machinery<Dim2>, ticks: usize) {
    for _ in 0..ticks {
        machinery.step(world);
    }
}

fn rigid(world: &World<Dim2>, index: usize) -> RigidBodyRef<'_, Dim2> {
    world.rigid_bodies().nth(index).unwrap().1
}

#[test]
fn obstacle_follows_its_path_back_and_forth() {
    let bar = "[[obstacle]]\nbox = { centre = [1.0, 0.0, 0.0], half = [0.1, 0.1, 0.0] }\n\
               path = [[0.0, 0.0, 0.0, 0.0], [2.0, 0.6, 0.0, 0.0]]\n";
    for (repeat, expected) in [
        ("once", [1.3, 1.6, 1.6]),
        ("back_and_forth", [1.3, 1.6, 1.3]),
    ] {
        let repeat = format!("repeat = \"{repeat}\"\n");
        let (_, mut world, mut machinery) = built(&[bar, &repeat]);
        for x in expected {
            run(&mut world, &mut machinery, 60);
            let found = rigid(&world, 0).position();
            assert!(
                (found - Vec2::new(x, 0.0)).length() < 1e-3,
                "{repeat} {found}"
            );
        }
    }
}

#[test]
fn turning_obstacle_turns_about_its_pivot_until_a_torque_stops_it() {
    let paddle = "[[obstacle]]\nbox = { centre = [0.5, 0.0, 0.0], half = [0.5, 0.05, 0.0] }\n\
                  pivot = [0.0, 0.0, 0.0]\nangular_velocity = [0.0, 0.0, 0.5]\n";
    let (_, mut world, mut machinery) = built(&[paddle]);
    run(&mut world, &mut machinery, 120);
    let angle = |world: &World<Dim2>| rigid(world, 0).rotation().scaled_axis().z;
    assert!((angle(&world) - 1.0).abs() < 1e-3, "{}", angle(&world));
    let end = rigid(&world, 0)
        .shape()
        .distance(Vec2::new(1.0_f32.cos(), 1.0_f32.sin()))
        .0;
    assert!(end.abs() < 0.06, "the far end is on the circle: {end}");

    // A wall holds a block in the way of the paddle.
    let wall = "[[obstacle]]\nbox = { centre = [0.8, 0.6, 0.0], half = [0.3, 0.05, 0.0] }\n";
    let block = "[[body]]\nshape = \"box\"\nn = 16\nwidth = 0.3\nat = [0.65, 0.2, 0.0]\n\
                 [[material]]\nyoung = 50000.0\nunbreakable = true\n";
    let weak = format!("{paddle}max_torque = 20.0\n");
    let (_, mut world, mut machinery) = built(&[&weak, wall, block]);
    run(&mut world, &mut machinery, 600);
    assert!(angle(&world) < 0.7, "{}", angle(&world));
}

#[test]
fn switch_moves_a_door_opens_a_joint_and_stays_if_told() {
    let switch = "[[switch]]\nball = { centre = [0.0, 0.0, 0.0], radius = 0.3 }\nmass = 1.0\n";
    let door = "[[obstacle]]\nbox = { centre = [2.0, 0.0, 0.0], half = [0.1, 0.1, 0.0] }\n\
                path = [[0.0, 0.0, 0.0, 0.0], [0.5, 0.0, 1.0, 0.0]]\nswitch = 1\n";
    let rope = "[[joint]]\nkind = \"rope\"\nlength = 1.0\nswitch = 1\n\
                anchors = [{ body = 1, point = [0.0, 0.0, 0.0] }, { point = [0.0, 0.5, 0.0] }]\n";
    for stays in [false, true] {
        let stays_text = format!("stays = {stays}\n");
        let (_, mut world, mut machinery) = built(&[BALL, switch, &stays_text, door, rope]);
        assert_eq!(world.joints().count(), 1);
        run(&mut world, &mut machinery, 60);
        let height = |world: &World<Dim2>| rigid(world, 0).position().y;
        assert!((height(&world) - 1.0).abs() < 1e-3, "the door is open");
        assert_eq!(world.joints().count(), 0);
        let body = world.soft_bodies().next().unwrap().0;
        world.translate(body, Vec2::new(-1.0, 0.0)).unwrap();
        run(&mut world, &mut machinery, 60);
        let expected = if stays { 1.0 } else { 0.0 };
        assert!((height(&world) - expected).abs() < 1e-3, "stays: {stays}");
        assert_eq!(machinery.switches().next().unwrap().1, stays);
    }
}

#[test]
fn switch_with_bodies_is_on_only_for_them() {
    let second = BALL.replace("at = [-0.1", "at = [4.9");
    for (bodies, expected) in [("[1]", true), ("[2]", false), ("[1, 2]", true)] {
        let switch = format!(
            "[[switch]]\nball = {{ centre = [0.0, 0.0, 0.0], radius = 0.3 }}\nbodies = {bodies}\n"
        );
        let (_, mut world, mut machinery) = built(&[BALL, &switch, &second]);
        run(&mut world, &mut machinery, 2);
        assert_eq!(machinery.switches().next().unwrap().1, expected, "{bodies}");
    }
}

#[test]
fn field_accelerates_what_is_in_it() {
    let field = "[[field]]\nbox = { centre = [0.0, 0.0, 0.0], half = [9.0, 9.0, 0.0] }\n\
                 acceleration = [0.0, 2.0, 0.0]\n";
    let (_, mut world, mut machinery) = built(&[BALL, field]);
    run(&mut world, &mut machinery, 60);
    let body = world.soft_bodies().next().unwrap().0;
    let speed = world.velocity(body).unwrap().linear;
    assert!((speed - Vec2::new(0.0, 2.0)).length() < 0.01, "{speed}");

    let outside = field.replace("centre = [0.0", "centre = [20.0");
    let (_, mut world, mut machinery) = built(&[BALL, &outside]);
    run(&mut world, &mut machinery, 60);
    assert!(world.velocity(body).unwrap().linear.length() < 1e-4);

    let planet = "[[field]]\ncentre = [2.0, 0.0, 0.0]\nstrength = 4.0\nreach = 1.0\n";
    let (_, _, machinery) = built(&[planet]);
    // At twice the reach it is a quarter.
    assert_eq!(machinery.field_at(Vec2::ZERO), Vec2::new(1.0, 0.0));
}

#[test]
fn hand_follows_another_one_also_mirrored() {
    let hands = "[[hand]]\nradius = 0.1\npath = [[0.0, 0.0, 0.0, 0.0], [1.0, 0.6, 0.2, 0.0]]\n\
                 [[hand]]\nradius = 0.1\nfollows = 1\npath = [[0.0, 0.0, 1.0, 0.0]]\n\
                 [[hand]]\nradius = 0.1\nfollows = 1\nmirror = \"x\"\npath = [[0.0, 2.0, 0.0, 0.0]]\n";
    let (scene, ..) = built(&[hands]);
    let targets = scene.hand_targets(59);
    let expected = [[0.6, 0.2], [0.6, 1.2], [1.4, 0.2]];
    for (found, expected) in targets.iter().zip(expected) {
        for axis in 0..2 {
            assert!((found[axis] - expected[axis]).abs() < 1e-5, "{targets:?}");
        }
    }
}

#[test]
fn recording_of_moving_parts_runs_alike() {
    let parts = "[[obstacle]]\nbox = { centre = [0.0, -0.3, 0.0], half = [0.2, 0.1, 0.0] }\n\
                 path = [[0.0, 0.0, 0.0, 0.0], [0.5, 0.0, 0.3, 0.0]]\nrepeat = \"loop\"\n";
    let (scene, ..) = built(&[BALL, parts]);
    let recording = Recording::of::<Dim2>(&scene, 90, |_| {}).unwrap();
    let again = Recording::read("test", &recording.text().unwrap()).unwrap();
    assert_eq!(again.replay::<Dim2>(|_| {}).unwrap().differs_at, None);
}

#[test]
fn mistakes_name_line_and_field() {
    let bar = "[[obstacle]]\nbox = { centre = [1.0, 0.0, 0.0], half = [0.1, 0.1, 0.0] }\n";
    for (text, expected) in [
        (
            format!("{bar}switch = 1\npath = [[0.0, 0.0, 0.0, 0.0]]\n"),
            "expected a [[switch]] in the scene",
        ),
        (
            format!("{bar}max_torque = 1.0\n"),
            "allowed only for an obstacle with angular_velocity",
        ),
        (
            "[[obstacle]]\nhalf_space = { normal = [0.0, 1.0, 0.0], point = [0.0, 0.0, 0.0] }\n\
             path = [[0.0, 0.0, 0.0, 0.0]]\n"
                .into(),
            "expected a bounded shape",
        ),
        (
            "[[switch]]\nmass = 1.0\n".into(),
            "expected either a box or a ball",
        ),
        (
            "[[switch]]\nball = { centre = [0.0, 0.0, 0.0], radius = 0.3 }\nbodies = [3]\n".into(),
            "expected no number, because the scene has none of these, found 3",
        ),
        (
            "[[switch]]\nball = { centre = [0.0, 0.0, 0.0], radius = 0.3 }\nby = \"hand\"\nbodies = [1]\n"
                .into(),
            "allowed only with by = \"body\"",
        ),
        (
            "[[field]]\nstrength = 1.0\n".into(),
            "expected either acceleration or all of centre",
        ),
        (
            "[[hand]]\nradius = 0.1\nfollows = 1\npath = [[0.0, 0.0, 0.0, 0.0]]\n".into(),
            "expected the number of a hand that follows no other one, found 1",
        ),
    ] {
        let scene = Scene::read("test", &(HEAD.to_string() + &text), &[]).unwrap();
        let error = scene.build::<Dim2>().unwrap_err().to_string();
        assert!(
            error.contains(expected) && error.contains("line"),
            "{error}"
        );
    }
}

#[test]
fn knife_on_a_hand_cuts_a_body_in_two() {
    let floor =
        "[[obstacle]]\nhalf_space = { normal = [0.0, 1.0, 0.0], point = [0.0, -0.1, 0.0] }\n";
    let hand = "[[hand]]\nradius = 0.05\nsensor = true\npath = [[0.0, 0.0, 0.6, 0.0], [2.0, 0.0, 0.0, 0.0]]\n";
    let knife = "[[knife]]\nhand = 1\nedge = [[0.01, 0.4, 0.0], [0.01, 0.4, 0.0]]\ntoward = [0.0, -1.0, 0.0]\n";
    for (parts, pieces) in [
        (&[BALL, floor, hand][..], 1),
        (&[BALL, floor, hand, knife], 2),
    ] {
        let (scene, mut world, _) = built(parts);
        for tick in 0..150 {
            scene.set_hand_targets(&mut world, tick);
            world.step();
        }
        let body = world.soft_bodies().next().unwrap().1;
        assert_eq!(body.piece_views().len(), pieces);
    }
}

#[test]
fn knife_on_a_turning_obstacle_cuts_what_it_meets() {
    let saw = "[[obstacle]]\nball = { centre = [0.3, 0.0, 0.0], radius = 0.1 }\nangular_velocity = [0.0, 0.0, 6.0]\n";
    let knife = "[[knife]]\nobstacle = 1\nedge = [[0.55, 0.0, 0.0], [0.55, 0.0, 0.0]]\ntoward = [0.0, 1.0, 0.0]\n";
    let (_, mut world, mut machinery) = built(&[BALL, saw, knife]);
    let mut cuts = 0;
    for _ in 0..120 {
        machinery.step(&mut world);
        cuts += { world.events().iter() }
            .filter(|event| matches!(event, Event::Cut { .. }))
            .count();
    }
    assert!(cuts > 0);
}
