//! Round trips: the text of a scene becomes a world, the world becomes a text, and this text becomes an equal
//! world.

use fuwafuwa::{
    Dim, Dim2, Dim3, DimVector, Event, Joint, JointAnchor, Layers, Material, RigidBody,
    RigidBodyRef, Rotation, Shape, SoftBody, StiffBodies, Vec2, Vec3, VoxelGrid, World,
    WorldConfig,
};
use fuwafuwa_scenes::Scene;
use fuwafuwa_scenes::scene::NAMED;

const RICH: &str = r#"
dim = DIM
gravity = [0.3, -9.0, 0.0]
drag = 0.1
tick = 0.0083333333
stiff_bodies = "softened"

[[material]]
young = 6000.0
unbreakable = true

[[material]]
density = 200.0
strength = 700.0

[[body]]
shape = "ball"
n = 12
width = 0.7
at = [0.1, 0.33, FLAT]
velocity = [0.4, 0.0, 0.0]
gravity_scale = 0.5
layers = { memberships = 2, filters = 5 }
user_data = 7

[[body.part]]
paint = 2
ball = { centre = [0.35, 0.35, HALF], radius = 0.15 }

[[body]]
shape = "box"
n = 6
width = 0.5
at = [1.3, 0.5, 0.0]
rotation_vector = [0.0, 0.0, 0.4]

[[obstacle]]
half_space = { normal = [0.0, 1.0, 0.0], point = [0.0, -0.2, 0.0] }

[[hand]]
radius = 0.1
path = [[0.0, -0.5, 0.5, 0.0], [1.0, 1.2, 0.5, 0.0]]

[[rigid_body]]
ball = { centre = [0.0, 0.0, 0.0], radius = 0.15 }
motion_type = "dynamic"
mass = 3.0
at = [0.4, 1.4, 0.0]
velocity = [0.0, -1.0, 0.0]
angular_velocity = [0.0, 0.0, 2.0]
restitution = 0.3

[[rigid_body]]
box = { centre = [0.0, 0.0, 0.0], half = [0.2, 0.1, 0.1] }
motion_type = "dynamic"
mass = 1.0
at = [1.6, 1.5, 0.0]
rotation_vector = [0.0, 0.0, 0.5]
layers = { memberships = 4 }
user_data = 9

[[rigid_body]]
capsule = { from = [-0.2, 0.0, 0.0], to = [0.2, 0.0, 0.0], radius = 0.05 }
motion_type = "kinematic"
at = [-0.6, 1.0, 0.0]

[[rigid_body]]
box = { centre = [0.5, 0.5, 0.0], half = [0.6, 0.6, 0.6] }
sensor = true

[[joint]]
kind = "pin"
anchors = [{ body = 2, point = [1.4, 0.9, 0.0], radius = 0.15 }, { rigid_body = 2, point = [1.6, 1.5, 0.0] }]

[[joint]]
kind = "rope"
length = 0.8
breaking_force = 900.0
anchors = [{ body = 1, point = [0.4, 0.9, 0.0] }, { point = [0.4, 1.6, 0.0] }]

[[joint]]
kind = "spring"
stiffness = 200.0
damping = 3.0
length = 0.4
anchors = [{ hand = 1, point = [-0.5, 0.5, 0.0] }, { rigid_body = 1, point = [0.4, 1.4, 0.0] }]

[[knife]]
rigid_body = 3
edge = [[-0.35, 1.0, FLAT], [-0.35, 1.0, 0.0]]
toward = [1.0, 0.0, 0.0]
radius = 1e-4
height = 0.1
"#;

fn rich(dim: u8) -> String {
    let [flat, half] = if dim == 2 {
        ["0.0", "0.0"]
    } else {
        ["-0.3", "0.35"]
    };
    let text = RICH.replace("DIM", &dim.to_string());
    text.replace("FLAT", flat).replace("HALF", half)
}

fn again<D: Dim>(world: &World<D>, what: &str) -> World<D> {
    let text = Scene::of_world(world).and_then(|scene| scene.text());
    let text = text.unwrap_or_else(|error| panic!("{what}: {error}"));
    let scene = Scene::read(what, &text, &[]).unwrap_or_else(|error| panic!("{error}"));
    scene.build::<D>().unwrap_or_else(|error| panic!("{error}"))
}

fn check_round_trip<D: Dim>(scene: &Scene, what: &str) {
    let mut world = scene.build::<D>().unwrap_or_else(|error| panic!("{error}"));
    let mut other = again(&world, what);
    assert_eq!(other.config(), world.config(), "{what}");
    assert_eq!(other.hash(), world.hash(), "{what}, tick 0");
    // The world built from the written scene gives the same text again.
    let texts = [&world, &other].map(|world| Scene::of_world(world).unwrap().text().unwrap());
    assert_eq!(texts[0], texts[1], "{what}");
    for tick in 0..60 {
        scene.set_hand_targets(&mut world, tick);
        scene.set_hand_targets(&mut other, tick);
        world.step();
        other.step();
    }
    assert_eq!(other.hash(), world.hash(), "{what}, tick 60");
}

#[test]
fn of_world_round_trips_each_named_scene() {
    for (name, _) in NAMED {
        let n = if name == "pile-3d" {
            "body.n=6"
        } else {
            "body.n=10"
        };
        let small = [n, "body.diced=0.3"].map(String::from);
        let count = if name == "diced" { 2 } else { 1 };
        let scene = Scene::open(name, &small[..count]).unwrap();
        match scene.dim {
            2 => check_round_trip::<Dim2>(&scene, name),
            _ => check_round_trip::<Dim3>(&scene, name),
        }
    }
}

#[test]
fn of_world_round_trips_every_field() {
    for dim in [2, 3] {
        let scene = Scene::read("rich", &rich(dim), &[]).unwrap_or_else(|error| panic!("{error}"));
        match dim {
            2 => check_round_trip::<Dim2>(&scene, "rich"),
            _ => check_round_trip::<Dim3>(&scene, "rich-3d"),
        }
    }
}

#[test]
fn build_applies_fields_of_scene() {
    let scene = Scene::read("rich", &rich(2), &[]).unwrap();
    let world = scene.build::<Dim2>().unwrap();
    assert!((world.config().tick - 1.0 / 120.0).abs() < 1e-8);
    assert_eq!(world.config().stiff_bodies, StiffBodies::Softened);
    let bodies: Vec<&SoftBody<Dim2>> = world.soft_bodies().map(|(_, body)| body).collect();
    let layers = Layers {
        memberships: 2,
        filters: 5,
    };
    assert_eq!(
        (
            bodies[0].layers(),
            bodies[0].user_data(),
            bodies[0].gravity_scale()
        ),
        (layers, 7, 0.5)
    );
    let rigids: Vec<RigidBodyRef<Dim2>> = world.rigid_bodies().map(|(_, body)| body).collect();
    assert!(rigids[2].is_dynamic());
    assert_eq!(rigids[2].velocity().linear, Vec2::new(0.0, -1.0));
    assert_eq!(rigids[2].velocity().angular, 2.0);
    assert!(rigids[4].follows_target() && rigids[5].is_sensor());
    let (data, filters) = (rigids[3].user_data(), rigids[3].layers().filters);
    assert_eq!((data, filters), (9, u32::MAX));
    let Vec2 { x, y } = rigids[3].rotation().apply(Vec2::X);
    assert!((x - 0.5f32.cos()).abs() < 1e-6 && (y - 0.5f32.sin()).abs() < 1e-6);
    assert_eq!(world.joints().count(), 3);
    // The text describes bodies by readable fields if these suffice.
    let text = Scene::of_world(&world).unwrap().text().unwrap();
    assert!(
        text.contains("runs = ") && text.contains("motion_type = \"dynamic\""),
        "{text}"
    );
}

fn check_torn<D: Dim>() {
    let mut world = World::<D>::new(WorldConfig::default()).unwrap();
    let at = |x: f32, y: f32, z: f32| D::Vector::from_vec3(Vec3::new(x, y, z));
    let floor = Shape::half_space(D::Vector::Y, D::Vector::ZERO);
    world
        .add_rigid_body(RigidBody::fixed(floor).with_friction(0.3))
        .unwrap();
    let soft = Material {
        strength: 200.0,
        toughness: 40.0,
        ..Material::default()
    };
    let grid = VoxelGrid::<D>::ball(8, 0.5).unwrap();
    let ball = world
        .add_soft_body(
            SoftBody::new(grid, &[soft])
                .unwrap()
                .translated(at(0.0, 1.2, 0.0)),
        )
        .unwrap();
    let cube = Shape::cuboid(D::Vector::splat(0.1)).translated(at(0.2, 2.5, 0.2));
    let turned = Rotation::about(Vec3::new(1.0, 1.0, 0.0), 0.4);
    world
        .add_rigid_body(RigidBody::dynamic(cube, 4.0).rotated(turned))
        .unwrap();
    let hand = world
        .add_rigid_body(RigidBody::coupled(Shape::ball(0.1)).at(at(-1.0, 0.2, 0.2)))
        .unwrap();
    for tick in 0..50 {
        world
            .set_target_position(hand, at(-1.0 + 0.02 * tick as f32, 0.2, 0.2))
            .unwrap();
        world.step();
    }
    assert!(world[ball].pieces().count() > 1, "no piece was detached");
    let other = again(&world, "torn");
    let states = |world: &World<D>| -> Vec<_> {
        let body = world.soft_bodies().next().unwrap().1;
        let ids = body.mesh().nodes().map(|(id, _)| id);
        ids.map(|id| (id, body.node_state(id))).collect()
    };
    assert_eq!(states(&other), states(&world));
    let rigids = |world: &World<D>| -> Vec<_> {
        let bodies = world.rigid_bodies().map(|(_, body)| body);
        let target = |body: RigidBodyRef<D>| (body.target_position(), body.target_rotation());
        let follows = |body: RigidBodyRef<D>| body.follows_target().then_some(target(body));
        bodies
            .map(|body| (body.definition(), follows(body)))
            .collect()
    };
    assert_eq!(rigids(&other), rigids(&world));
    // The original and the rebuilt world behave alike in the following ticks.
    let (mut world, mut other) = (world, other);
    (0..30).for_each(|_| _ = (world.step(), other.step()));
    let centres =
        [&world, &other].map(|world| world.soft_bodies().next().unwrap().1.centre_of_mass());
    for axis in 0..D::N {
        assert!(
            (centres[0][axis] - centres[1][axis]).abs() < 0.05,
            "{centres:?}"
        );
    }
}

#[test]
fn of_world_stores_state_of_torn_bodies() {
    check_torn::<Dim2>();
    check_torn::<Dim3>();
}

fn complaint(scene: &str) -> String {
    let built = Scene::read("toy.toml", scene, &[]).and_then(|scene| scene.build::<Dim2>());
    built
        .err()
        .map_or_else(|| "fine".into(), |error| error.to_string())
}

#[test]
fn error_names_line_and_field() {
    let good = rich(2);
    assert_eq!(complaint(&good), "fine");
    for (replaced, by, expected) in [
        (
            "tick = 0.0083333333",
            "tick = 0.5",
            "tick: expected 1/240 to 1/30 s, found 0.5",
        ),
        (
            "mass = 3.0\n",
            "",
            "rigid_body 1, mass: missing mass [kg], required with motion_type = \"dynamic\"",
        ),
        (
            "motion_type = \"kinematic\"",
            "motion_type = \"kinematic\"\nmass = 1.0",
            "rigid_body 3, mass: allowed only with motion_type = \"dynamic\" or \"coupled\"",
        ),
        (
            "motion_type = \"kinematic\"",
            "motion_type = \"magic\"",
            "unknown variant `magic`",
        ),
        (
            "angular_velocity = [0.0, 0.0, 2.0]",
            "angular_velocity = [1.0, 0.0, 2.0]",
            "rigid_body 1, angular_velocity: expected 0 except on the third axis",
        ),
        (
            "sensor = true",
            "sensor = true\nvelocity = [1.0, 0.0, 0.0]",
            "rigid_body 4, velocity: not allowed with motion_type = \"fixed\"",
        ),
        (
            "sensor = true",
            "sensor = true\ntarget_position = [1.0, 0.0, 0.0]",
            "rigid_body 4, target_position: allowed only with motion_type = \"kinematic\" or \"coupled\"",
        ),
        (
            "body = 2, point",
            "body = 3, point",
            "joint 1, anchors 1, body: expected 1 to 2, found 3",
        ),
        (
            "kind = \"pin\"",
            "kind = \"pin\"\nlength = 1.0",
            "joint 1, length: allowed only with kind = \"spring\" or \"rope\"",
        ),
        (
            "{ point = [0.4, 1.6, 0.0] }",
            "{ point = [0.4, 1.6, 0.0], radius = 1.0 }",
            "joint 2, anchors 2, radius: allowed only with a body",
        ),
        (
            "rigid_body = 3\nedge",
            "rigid_body = 4\nedge",
            "knife 1, rigid_body: expected a hand, an obstacle with a path or an angular_velocity, or a kinematic",
        ),
        (
            "rigid_body = 3\nedge",
            "edge",
            "knife 1, hand: expected one of obstacle, hand and rigid_body",
        ),
        (
            "rigid_body = 3\nedge",
            "hand = 2\nedge",
            "knife 1, hand: expected 1, found 2",
        ),
        (
            "toward = [1.0, 0.0, 0.0]",
            "toward = [0.0, 0.0, 0.0]",
            "knife 1, toward: expected a direction, of a length of 0.01 to 100",
        ),
        (
            "radius = 1e-4",
            "radius = 2.0",
            "knife 1, radius: expected 0 to 1 m, found 2",
        ),
        (
            "breaking_force = 900.0",
            "breaking_force = -1.0",
            "joint 2, breaking_force: expected",
        ),
        (
            "layers = { memberships = 4 }",
            "layers = 4",
            "layers = 4: invalid type: integer `4`, expected a table",
        ),
        (
            "gravity_scale = 0.5",
            "gravity_scale = 500.0",
            "body 1, gravity_scale: expected -100 to 100, found",
        ),
        (
            "rotation_vector = [0.0, 0.0, 0.4]",
            "rotation_vector = [0.1, 0.0, 0.4]",
            "body 2, rotation_vector: expected 0 except on the third axis",
        ),
        (
            "at = [1.6, 1.5, 0.0]\n",
            "at = [1.6, 1.5, 0.0]\nstate = \"%\"\n",
            "rigid_body 2, state: expected no other field",
        ),
        (
            "shape = \"box\"",
            "state = \"%\"",
            "body 2, state: expected no other field",
        ),
    ] {
        assert!(good.contains(replaced), "{replaced}");
        let found = complaint(&good.replacen(replaced, by, 1));
        assert!(found.contains(expected), "{by}: {found}");
    }
    for (voxels, expected) in [
        ("size = [2, 2, 1], voxel_size = 0.1, runs = \"4x1\"", "fine"),
        (
            "size = [2, 2, 1], voxel_size = 0.1, runs = \"3x1\"",
            "voxels, runs: expected 4 voxels, found 3",
        ),
        (
            "size = [2, 2, 1], voxel_size = 0.1, runs = \"9999999999x1\"",
            "voxels, runs: expected 4 voxels, found more",
        ),
        (
            "size = [2, 2, 1], voxel_size = 0.1, runs = \"4y1\"",
            "voxels, runs: expected runs such as 12x1, found \"4y1\"",
        ),
        (
            "size = [2, 2, 2], voxel_size = 0.1, runs = \"8x1\"",
            "voxels, size: expected 1 on the third axis in 2D",
        ),
        (
            "size = [0, 2, 1], voxel_size = 0.1, runs = \"\"",
            "voxels, size: expected 1 to 1024 on each axis",
        ),
    ] {
        let scene = format!("dim = 2\n[[body]]\nvoxels = {{ {voxels} }}\n");
        let found = complaint(&scene);
        assert!(found.contains(expected), "{voxels}: {found}");
    }
    let state = "dim = 2\n[[body]]\nstate = \"AAAA\"\n";
    assert!(
        complaint(state)
            .contains("line 3: body 1, state: not a snapshot: the header is missing or truncated")
    );
}

#[test]
fn of_world_keeps_joint_positions_after_motion() {
    let mut world = World::<Dim2>::new(WorldConfig::default()).unwrap();
    let grid = VoxelGrid::<Dim2>::cube(8, 0.5).unwrap();
    let unbreakable = Material {
        strength: f32::INFINITY,
        ..Material::default()
    };
    let cube = world
        .add_soft_body(SoftBody::new(grid, &[unbreakable]).unwrap())
        .unwrap();
    let point = Vec2::new(0.25, 0.5);
    let on_cube = JointAnchor::on(cube, point).within(0.1);
    world
        .add_joint(Joint::pin(on_cube, JointAnchor::Point(point)))
        .unwrap();
    (0..30).for_each(|_| _ = world.step());
    assert!(
        !world
            .events()
            .iter()
            .any(|event| matches!(event, Event::JointBroke { .. }))
    );
    let other = again(&world, "hanging");
    let places = [&world, &other].map(|world| {
        let joint = world.joints().map(|(id, _)| id).next().unwrap();
        world.joint_anchor_positions(joint).unwrap().unwrap()
    });
    assert!((places[0][0][1] - places[1][0][1]).abs() < 1e-3);
}

#[test]
fn text_rejects_too_long_scene() {
    let mut world = World::<Dim3>::new(WorldConfig::default()).unwrap();
    let grid = VoxelGrid::<Dim3>::ball(40, 1.0).unwrap();
    let ball = SoftBody::new(grid, &[Material::default()]).unwrap();
    let id = world.add_soft_body(ball).unwrap();
    assert!(
        Scene::of_world(&world).unwrap().text().is_ok(),
        "an intact body has a short text"
    );
    world.soft_body_mut(id).unwrap().crumble();
    let error = Scene::of_world(&world).unwrap().text().unwrap_err();
    assert!(
        error.to_string().contains("save a snapshot instead"),
        "{error}"
    );
}
