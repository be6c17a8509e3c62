//! Knives: cuts, cutting force and work.

use crate::vectors::vector;
use fuwafuwa::{
    Dim, Dim2, Dim3, DimAngular, DimVector, Elasticity, Error, Event, Knife, KnifeHandle, Material,
    MotionType, RigidBody, RigidBodyHandle, Rotation, Shape, SoftBody, SoftBodyHandle, Vec2, Vec3,
    VoxelGrid, World, WorldConfig,
};

fn weightless<D: Dim>() -> World<D> {
    let settings = WorldConfig {
        gravity: D::Vector::ZERO,
        ..WorldConfig::default()
    };
    World::new(settings).unwrap()
}

/// Adds a block with its bottom centred on the origin and fixed.
fn block<D: Dim>(
    world: &mut World<D>,
    size: [usize; 3],
    voxel: f32,
    material: Material,
) -> SoftBodyHandle {
    let grid = VoxelGrid::from_fn(size, voxel, |_| 1).unwrap();
    let [x, _, z] = size.map(|k| k as f32 * voxel);
    let depth = if D::N == 3 { -0.5 * z } else { 0.0 };
    let body = SoftBody::new(grid, &[material]).unwrap();
    let mut body = body.translated(vector(-0.5 * x, 0.0, depth));
    let bottom: Vec<_> = body
        .mesh()
        .nodes()
        .filter(|(_, node)| node.at[1] == 0)
        .collect();
    bottom.iter().for_each(|&(id, _)| body.fix_node(id));
    world.add_soft_body(body).unwrap()
}

/// Returns a material that cannot be torn.
fn rubber() -> Material {
    Material {
        strength: f32::INFINITY,
        toughness: f32::INFINITY,
        ..Material::default()
    }
}

/// Adds a kinematic hand with a knife that points down. The cutting edge has the half length `half` [m] and
/// lies along the third axis.
fn knife<D: Dim>(
    world: &mut World<D>,
    at: D::Vector,
    half: f32,
    radius: f32,
) -> (RigidBodyHandle, KnifeHandle) {
    let holder = RigidBody::kinematic(Shape::ball(0.01)).at(at);
    let holder = world.add_rigid_body(holder.with_sensor(true)).unwrap();
    let edge = [-half, half].map(|z| vector(0.0, 0.0, z));
    let mut knife = Knife::new(holder, edge, -D::Vector::Y);
    knife.radius = radius;
    (holder, world.add_knife(knife).unwrap())
}

fn height<D: Dim>(world: &World<D>, body: RigidBodyHandle) -> f32 {
    world.rigid_body(body).unwrap().position()[1]
}

/// Moves the hand that holds a knife to a position [m] at a speed [m/s], and calls `each` after every tick.
fn go<D: Dim>(
    world: &mut World<D>,
    holder: RigidBodyHandle,
    to: D::Vector,
    speed: f32,
    mut each: impl FnMut(&World<D>),
) {
    let from = world.rigid_body(holder).unwrap().position();
    let way = to - from;
    let ticks = (60.0 * way.length() / speed).ceil() as usize;
    for tick in 1..=ticks {
        let share = tick as f32 / ticks as f32;
        world
            .set_target_position(holder, from + way * share)
            .unwrap();
        world.step();
        each(world);
    }
}

/// Returns the area [m²] and the work [J] of the cuts of the last tick.
fn cut<D: Dim>(world: &World<D>) -> [f32; 2] {
    let cuts = world.events().iter().map(|event| match event {
        Event::Cut { area, work, .. } => [*area, *work],
        _ => [0.0; 2],
    });
    cuts.fold([0.0; 2], |sum, cut| [sum[0] + cut[0], sum[1] + cut[1]])
}

fn validated<D: Dim>(world: &World<D>, body: SoftBodyHandle) {
    let body = &world[body];
    body.mesh()
        .validate(body.grid(), body.connectivity())
        .unwrap();
}

/// Lets a knife cut from above into a slab. Returns the mean upward force on the knife [N], and the area [m²]
/// and the work [J] of the cut.
fn force_in_slab<D: Dim>(
    size: [usize; 3],
    voxel: f32,
    radius: f32,
    turned: f32,
) -> (f32, [f32; 2]) {
    let mut world = weightless::<D>();
    let body = block(&mut world, size, voxel, Material::default());
    let top = size[1] as f32 * voxel;
    // The knife moves in parallel to the lattice planes of the voxels, 0.13 voxel widths beside one of them.
    let (holder, id) = knife(
        &mut world,
        vector(0.13 * voxel, top + 0.01, 0.0),
        0.2,
        radius,
    );
    let turned = Rotation::about(Vec3::Y, turned);
    world.set_target_rotation(holder, turned).unwrap();
    world.step();
    let (mut forces, mut sums) = (Vec::new(), [0.0; 2]);
    go(
        &mut world,
        holder,
        vector(0.13 * voxel, 0.3 * top, 0.0),
        0.1,
        |world| {
            let at = height(world, holder);
            if at < 0.8 * top {
                let knife = world.knife(id).unwrap();
                forces.push(knife.force()[1]);
                assert!(knife.torque().to_vec3().is_finite());
            }
            let [area, work] = cut(world);
            sums = [sums[0] + area, sums[1] + work];
        },
    );
    validated(&world, body);
    forces.sort_by(f32::total_cmp);
    (forces.iter().sum::<f32>() / forces.len() as f32, sums)
}

#[test]
fn knife_force_is_fracture_energy_times_thickness() {
    let material = Material::default();
    let Elasticity { young, poisson } = material.elasticity;
    let toughness = f64::from(material.toughness);
    let energy = toughness * toughness * (1.0 - poisson * poisson) / young;
    for (radius, turned) in [(0.0, 0.0), (0.002, 0.0), (0.0, 0.4)] {
        let asked = energy as f32 + 2.0 * radius * material.strength;
        let (voxel, thick) = (0.02, 8);
        let (force, [area, work]) = force_in_slab::<Dim3>([24, 16, thick], voxel, radius, turned);
        let length = thick as f32 * voxel / libm::cosf(turned);
        let expected = asked * length;
        assert!(
            (force / expected - 1.0).abs() < 0.15,
            "{force} N of {expected}"
        );
        assert!(
            (work / (asked * area) - 1.0).abs() < 0.15,
            "{work} J for {area} m²"
        );
        let deep = 0.7 * 16.0 * voxel;
        assert!((area / (deep * length) - 1.0).abs() < 0.1, "{area} m²");
    }
    let (force, _) = force_in_slab::<Dim2>([24, 16, 1], 0.02, 0.0, 0.0);
    assert!(
        (force / energy as f32 - 1.0).abs() < 0.15,
        "{force} N of {energy}"
    );
}

/// Returns how deep a knife presses into a block before the first cut [m].
fn pressed_before<D: Dim>(size: [usize; 3], radius: f32) -> f32 {
    let voxel = 0.02;
    let mut world = weightless::<D>();
    block(&mut world, size, voxel, Material::default());
    let top = size[1] as f32 * voxel;
    let (holder, _) = knife(
        &mut world,
        vector(0.13 * voxel, top + 0.005, 0.0),
        0.15,
        radius,
    );
    let mut first = None;
    go(
        &mut world,
        holder,
        vector(0.13 * voxel, 0.5 * top, 0.0),
        0.1,
        |world| {
            if first.is_none() && cut(world) != [0.0; 2] {
                first = Some(top - height(world, holder));
            }
        },
    );
    first.expect("the knife must cut in the end")
}

#[test]
fn dull_edge_presses_deeper_before_cut() {
    let (sharp, dull) = (
        pressed_before::<Dim3>([16, 10, 6], 0.0),
        pressed_before::<Dim3>([16, 10, 6], 0.02),
    );
    assert!(sharp < 0.03 && dull > 2.0 * sharp, "{sharp} m and {dull} m");
    let (sharp, dull) = (
        pressed_before::<Dim2>([16, 10, 1], 0.0),
        pressed_before::<Dim2>([16, 10, 1], 0.02),
    );
    assert!(sharp < 0.03 && dull > 2.0 * sharp, "{sharp} m and {dull} m");
}

fn goes_through<D: Dim>(size: [usize; 3], slant: f32) {
    let voxel = 0.02;
    let mut world = weightless::<D>();
    let body = block(&mut world, size, voxel, Material::default());
    let top = size[1] as f32 * voxel;
    let left = 0.13 * voxel - 0.5 * slant;
    let start = vector(left, top + 0.02, 0.0);
    let (holder, id) = knife(&mut world, start, 0.15, 0.0);
    let (mut area, mut most) = (0.0, 0.0f32);
    let end = vector(left + slant, -0.02, 0.0);
    // Rotates the knife so that its blade points in the direction of motion.
    let turned = Rotation::in_plane(libm::atanf(slant / (top + 0.04)));
    world.set_target_rotation(holder, turned).unwrap();
    go(&mut world, holder, end, 0.5, |world| area += cut(world)[0]);
    validated(&world, body);
    let large = |world: &World<D>| {
        let pieces = world[body].piece_views();
        let total: f32 = pieces.iter().map(|piece| piece.mass).sum();
        pieces
            .iter()
            .filter(|piece| piece.mass > 0.2 * total)
            .count()
    };
    assert_eq!(large(&world), 2);
    let depth = if D::N == 3 {
        size[2] as f32 * voxel
    } else {
        1.0
    };
    let long = (slant * slant + (top + 0.04) * (top + 0.04)).sqrt() * top / (top + 0.04);
    assert!(
        (area / (long * depth) - 1.0).abs() < 0.1,
        "{area} m² of {}",
        long * depth
    );
    // Moves the knife back and forth through the finished cut; it must cut almost no further area.
    let mut again = 0.0;
    go(&mut world, holder, start, 0.5, |world| {
        again += cut(world)[0]
    });
    go(&mut world, holder, end, 0.5, |world| {
        again += cut(world)[0];
        most = most.max(world.knife(id).unwrap().force()[1]);
    });
    assert!(again < 0.1 * area, "{again} m² again");
    assert!(most < 4.0 * depth, "{most} N again");
}

#[test]
fn knife_cuts_block_in_two_only_once() {
    goes_through::<Dim3>([20, 12, 8], 0.0);
    goes_through::<Dim3>([20, 12, 8], 0.1);
    goes_through::<Dim2>([20, 12, 1], 0.0);
    goes_through::<Dim2>([20, 12, 1], 0.1);
}

#[test]
fn coupled_knife_cuts_only_with_enough_force() {
    // The force to advance a cut is 7.3 J/m² × 0.16 m of width = 1.16 N. It lies between the two limits of the
    // coupling force.
    let material = Material {
        toughness: 200.0,
        ..Material::default()
    };
    for (pull, cuts) in [(0.8, false), (2.0, true)] {
        let mut world = weightless::<Dim3>();
        let body = block(&mut world, [16, 12, 8], 0.02, material);
        let coupling = MotionType::Coupled {
            mass: 0.2,
            stiffness: 300.0,
            damping: 1.0,
            max_force: pull,
        };
        let holder = RigidBody::new(Shape::ball(0.01), coupling)
            .at(Vec3::new(0.003, 0.25, 0.0))
            .with_sensor(true);
        let holder = world.add_rigid_body(holder).unwrap();
        let edge = [Vec3::new(0.0, 0.0, -0.1), Vec3::new(0.0, 0.0, 0.1)];
        world
            .add_knife(Knife::new(holder, edge, Vec3::NEG_Y))
            .unwrap();
        let mut area = 0.0;
        for tick in 0..240 {
            let deep = 0.1f32.max(0.25 - 0.001 * tick as f32);
            world
                .set_target_position(holder, Vec3::new(0.003, deep, 0.0))
                .unwrap();
            world.step();
            area += cut(&world)[0];
        }
        validated(&world, body);
        let at = height(&world, holder);
        assert_eq!(area > 0.01, cuts, "{area} m² with {pull} N, at {at} m");
        assert_eq!(at < 0.12, cuts, "at {at} m with {pull} N");
    }
}

#[test]
fn blade_face_pushes_sideways() {
    let mut world = weightless::<Dim3>();
    let body = block(&mut world, [16, 12, 8], 0.02, Material::default());
    let (holder, id) = knife(&mut world, Vec3::new(0.003, 0.26, 0.0), 0.1, 0.0);
    go(&mut world, holder, Vec3::new(0.003, 0.12, 0.0), 0.2, |_| {});
    let before = world[body].centre_of_mass().x;
    go(
        &mut world,
        holder,
        Vec3::new(0.013, 0.12, 0.0),
        0.05,
        |_| {},
    );
    let force = world.knife(id).unwrap().force().x;
    let moved = world[body].centre_of_mass().x - before;
    assert!(force < -0.5, "{force} N");
    assert!(moved > 0.001, "{moved} m");
}

#[test]
fn knife_presses_unbreakable_block_and_wakes_it() {
    let mut world = weightless::<Dim3>();
    let body = block(&mut world, [12, 10, 6], 0.02, rubber());
    world.put_to_sleep(body).unwrap();
    let (holder, _) = knife(&mut world, Vec3::new(0.003, 0.22, 0.0), 0.1, 0.0);
    go(
        &mut world,
        holder,
        Vec3::new(0.003, 0.17, 0.0),
        0.2,
        |world| assert_eq!(cut(world), [0.0; 2]),
    );
    assert_eq!(world[body].piece_views().len(), 1);
    assert!(!world[body].piece_views()[0].asleep);
    let body = &world[body];
    let nodes = body.mesh().nodes().map(|(id, _)| body.node_state(id).0);
    let under = nodes.filter(|at| at.x.abs() < 0.015);
    let top = under.fold(0.0, |top: f32, at| top.max(at.y));
    assert!(top < 0.19, "pressed from 0.2 to {top}");
}

#[test]
fn fixed_edge_cuts_moving_body_at_any_speed() {
    for speed in [0.5, 3.0, 8.0] {
        let mut world = weightless::<Dim2>();
        let soft = Material {
            toughness: 100.0,
            ..Material::default()
        };
        let grid = VoxelGrid::cube(24, 0.24).unwrap();
        let body = SoftBody::new(grid, &[soft]).unwrap();
        let body = world
            .add_soft_body(body.translated(Vec2::new(-0.12, 0.02)))
            .unwrap();
        world.add_velocity(body, Vec2::new(0.0, -speed)).unwrap();
        let (_, id) = knife(&mut world, Vec2::new(0.003, 0.0), 0.1, 0.0);
        let mut up = world.remove(id).unwrap();
        up.toward = Vec2::Y;
        world.add_knife(up).unwrap();
        let mut area = 0.0;
        for _ in 0..(60.0 * 0.4 / speed) as usize + 20 {
            world.step();
            area += cut(&world)[0];
        }
        let pieces = world[body].piece_views().len();
        assert_eq!(pieces, 2, "at {speed} m/s: {area} m²");
        assert!((area - 0.24).abs() < 0.03, "at {speed} m/s: {area} m²");
    }
}

#[test]
fn knife_without_height_has_finite_force_in_unbreakable_block() {
    let mut world = weightless::<Dim3>();
    block(&mut world, [6, 6, 6], 0.02, rubber());
    let (holder, id) = knife(&mut world, Vec3::new(0.003, 0.14, 0.0), 0.1, 0.0);
    let mut thin = world.remove(id).unwrap();
    thin.height = 0.0;
    let id = world.add_knife(thin).unwrap();
    let end = Vec3::new(0.003, 0.1, 0.0);
    go(&mut world, holder, end, 0.2, |world| {
        let force = world.knife(id).unwrap().force();
        assert!(force.is_finite(), "{force:?}");
    });
    world.remove(holder).unwrap();
    world.step();
    assert_eq!(world.knife(id).unwrap().force(), Vec3::ZERO);
}

#[test]
fn knife_cuts_body_with_all_nodes_fixed() {
    let mut world = weightless::<Dim2>();
    let grid = VoxelGrid::cube(8, 0.16).unwrap();
    let mut body = SoftBody::new(grid, &[Material::default()]).unwrap();
    let nodes: Vec<_> = body.mesh().nodes().map(|(id, _)| id).collect();
    nodes.iter().for_each(|&id| body.fix_node(id));
    let body = world.add_soft_body(body).unwrap();
    let (holder, id) = knife(&mut world, Vec2::new(0.083, 0.2), 0.1, 0.0);
    let (mut area, mut most) = (0.0, 0.0f32);
    go(&mut world, holder, Vec2::new(0.083, -0.05), 0.2, |world| {
        area += cut(world)[0];
        most = most.max(world.knife(id).unwrap().force().y);
    });
    assert_eq!(world[body].piece_views().len(), 2);
    assert!(
        (area - 0.16).abs() < 0.02 && most > 0.0,
        "{area} m², {most} N"
    );
}

#[test]
fn add_knife_names_invalid_field() {
    let mut world = weightless::<Dim3>();
    let (holder, id) = knife(&mut world, Vec3::ZERO, 0.1, 0.0);
    let good = world.knife(id).unwrap().definition();
    let wall = RigidBody::fixed(Shape::ball(0.1));
    let wall = world.add_rigid_body(wall).unwrap();
    let change = |change: &dyn Fn(&mut Knife<Dim3>)| {
        let mut knife = good;
        change(&mut knife);
        knife
    };
    let bad = [
        (change(&|knife| knife.edge = [Vec3::ZERO; 2]), "edge"),
        (change(&|knife| knife.edge[0].y = f32::NAN), "edge"),
        (change(&|knife| knife.toward = Vec3::ZERO), "toward"),
        (
            change(&|knife| knife.toward = Vec3::new(0.0, f32::NAN, 0.0)),
            "toward",
        ),
        (change(&|knife| knife.toward = Vec3::Z), "toward"),
        (change(&|knife| knife.radius = -1.0), "radius"),
        (change(&|knife| knife.height = f32::INFINITY), "height"),
        (change(&|knife| knife.holder = wall), "holder"),
    ];
    for (knife, word) in bad {
        let error = world.add_knife(knife).unwrap_err().to_string();
        assert!(error.starts_with(&format!("{word} must be")), "{error}");
    }
    world.remove(holder).unwrap();
    world.step();
    let error = world.add_knife(good).unwrap_err();
    assert!(matches!(
        error,
        Error::InvalidHandle {
            kind: "rigid body",
            ..
        }
    ));
    world.remove(id).unwrap();
    assert!(world.remove(id).is_err());
}
