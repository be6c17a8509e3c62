//! Pins, springs and ropes between soft bodies, rigid bodies and fixed points.

use crate::vectors::vector;
use fuwafuwa::inspect::Elasticity;
use fuwafuwa::{
    Dim, Dim2, Dim3, DimAngular, DimVector, Event, Joint, JointAnchor, JointKind, Material,
    RigidBody, RigidBodyHandle, Rotation, Shape, SoftBody, SoftBodyHandle, Vec2, Vec3, VoxelGrid,
    World, WorldConfig,
};
use std::f32::consts::TAU;

fn world<D: Dim>(gravity: f32) -> World<D> {
    World::new(WorldConfig {
        gravity: vector(0.0, gravity, 0.0),
        ..WorldConfig::default()
    })
    .unwrap()
}

fn rubber() -> Material {
    Material {
        elasticity: Elasticity {
            young: 5e4,
            poisson: 0.3,
        },
        strength: f32::INFINITY,
        toughness: f32::INFINITY,
        ..Material::default()
    }
}

/// Adds a ball 1 m wide with its centre at `middle` [m].
fn soft<D: Dim>(world: &mut World<D>, middle: D::Vector) -> SoftBodyHandle {
    let grid = VoxelGrid::<D>::ball(10, 1.0).unwrap();
    let body = SoftBody::new(grid, &[rubber()]).unwrap();
    world
        .add_soft_body(body.translated(middle - D::Vector::splat(0.5)))
        .unwrap()
}

fn ball<D: Dim>(world: &mut World<D>, at: D::Vector, mass: f32) -> RigidBodyHandle {
    let shape = Shape::ball(0.1).translated(at);
    world
        .add_rigid_body(RigidBody::dynamic(shape, mass))
        .unwrap()
}

/// Returns the number of joints that broke in the last tick.
fn broken<D: Dim>(world: &World<D>) -> usize {
    let is_break = |event: &&Event<D>| matches!(event, Event::JointBroke { .. });
    world.events().iter().filter(is_break).count()
}

/// Checks that a pendulum swings for a minute without ever exceeding its initial energy.
fn no_energy_comes_from<D: Dim>(tie: JointKind) {
    let mut world = world::<D>(-9.81);
    let bob = ball(&mut world, D::Vector::X, 2.0);
    let at = match tie {
        JointKind::Rope { .. } => D::Vector::X,
        _ => D::Vector::ZERO,
    };
    let anchors = [
        JointAnchor::on(bob, at),
        JointAnchor::Point(D::Vector::ZERO),
    ];
    world.add_joint(Joint::new(anchors, tie)).unwrap();
    let (mut lowest, mut most) = (0.0f32, f32::MIN);
    for tick in 0..3600 {
        world.step();
        let rigid = world.rigid_body(bob).unwrap();
        let Vec3 { x, y, .. } = rigid.position().to_vec3();
        let velocity = rigid.velocity();
        let speed = velocity.linear.to_vec3().length_squared();
        let spin = velocity.angular.to_vec3().length_squared();
        // Moment of inertia about the centre, as a share of m r²: 2/5 for a ball, 1/2 for a disc.
        let share = if D::N == 2 { 0.5 } else { 0.4 };
        most = most.max(speed + share * 0.01 * spin + 2.0 * 9.81 * y);
        lowest = lowest.min(y);
        assert!((x * x + y * y).sqrt() < 1.02, "{tick}: {x} {y}");
    }
    assert!(lowest < -0.95, "{lowest}");
    // `most` is twice the highest energy per mass [m²/s²]; at the start, this energy is 0. For comparison,
    // the squared speed at the lowest point is 2 g l = 19.6 m²/s².
    assert!(most < 0.2, "{most}");
}

#[test]
fn pendulum_gains_no_energy_with_pin_and_rope() {
    for tie in [JointKind::Pin, JointKind::Rope { length: 1.0 }] {
        no_energy_comes_from::<Dim2>(tie);
        no_energy_comes_from::<Dim3>(tie);
    }
}

fn it_hangs_on_a_nail<D: Dim>() {
    let mut world = world::<D>(-9.81);
    let id = soft(&mut world, D::Vector::ZERO);
    let top = vector(0.0, 0.5, 0.0);
    let anchor = JointAnchor::on(id, top).within(0.25);
    let nail = world
        .add_joint(Joint::pin(anchor, JointAnchor::Point(top)))
        .unwrap();
    for _ in 0..600 {
        world.step();
    }
    let [held, place] = world.joint_anchor_positions(nail).unwrap().unwrap();
    assert!((held - place).length() < 0.01, "{held:?}");
    let body = &world[id];
    let Vec3 { x, y, z } = body.centre_of_mass().to_vec3();
    assert!(
        (-0.9..0.1).contains(&y) && x.abs() < 0.05 && z.abs() < 0.05,
        "{x} {y} {z}"
    );
    let weight = body.total_mass() as f32 * 9.81;
    // The body may have fallen asleep while it vibrated a little.
    let force = world.joint(nail).unwrap().force();
    assert!((force / weight - 1.0).abs() < 0.15, "{force} {weight}");
    // The body wakes and falls when the joint is removed.
    world.remove(nail).unwrap();
    for _ in 0..60 {
        world.step();
    }
    assert!(world[id].centre_of_mass()[1] < y - 2.0);
}

#[test]
fn pinned_soft_body_hangs_until_joint_is_removed() {
    it_hangs_on_a_nail::<Dim2>();
    it_hangs_on_a_nail::<Dim3>();
}

fn it_follows<D: Dim>() {
    let mut world = world::<D>(0.0);
    let arm = Shape::cuboid(vector(1.0, 0.05, 0.05));
    let arm = world.add_rigid_body(RigidBody::kinematic(arm)).unwrap();
    let id = soft(&mut world, vector(1.6, 0.0, 0.0));
    let tip: D::Vector = vector(1.1, 0.0, 0.0);
    let anchor = JointAnchor::on(id, tip).within(0.2);
    let pin = world
        .add_joint(Joint::pin(anchor, JointAnchor::on(arm, tip)))
        .unwrap();
    let [first, place] = world.joint_anchor_positions(pin).unwrap().unwrap();
    assert!((first - place).length() < 1e-6 && (first - tip).length() < 0.2);
    for tick in 1..=300 {
        let share = tick as f32 / 300.0;
        let angle = TAU * share * share * (3.0 - 2.0 * share);
        let way = Rotation::in_plane(angle);
        world.set_target_rotation(arm, way).unwrap();
        world.step();
        let [held, place] = world.joint_anchor_positions(pin).unwrap().unwrap();
        assert!((held - place).length() < 0.02, "{tick}: {held:?} {place:?}");
        // On the arm, the pin stays at the point where the mean position of the pinned nodes was when the pin
        // was added.
        let away = place - way.apply(first);
        assert!(away.length() < 1e-3, "{tick}: {place:?}");
    }
}

#[test]
fn pinned_soft_body_follows_rotating_arm() {
    it_follows::<Dim2>();
    it_follows::<Dim3>();
}

#[test]
fn pin_keeps_two_soft_bodies_together() {
    let mut world = world::<Dim3>(0.0);
    let [a, b] = [-0.55, 0.55].map(|x| soft(&mut world, Vec3::new(x, 0.0, 0.0)));
    let anchor = |body: SoftBodyHandle, x: f32| JointAnchor::on(body, Vec3::X * x).within(0.2);
    let pin = world
        .add_joint(Joint::pin(anchor(a, -0.05), anchor(b, 0.05)))
        .unwrap();
    world.add_velocity(a, Vec3::new(-2.0, 0.0, 0.0)).unwrap();
    for _ in 0..120 {
        world.step();
    }
    let [held, place] = world.joint_anchor_positions(pin).unwrap().unwrap();
    assert!((held - place).length() < 0.02);
    // The pin transfers momentum between the bodies, but preserves the total momentum.
    let mass = world[a].total_mass();
    let [a, b] = [a, b].map(|id| world[id].momentum().linear.x);
    assert!(
        ((a + b) / (-2.0 * f64::from(mass as f32)) - 1.0).abs() < 1e-3,
        "{a} {b}"
    );
    assert!(b < -0.3 * f64::from(mass as f32), "{b}");
}

/// A mass m on an undamped spring of stiffness k oscillates with ω² = k/m. The implicit integration damps the
/// oscillation slowly.
#[test]
fn spring_oscillates_at_natural_frequency() {
    let mut world = world::<Dim3>(0.0);
    let bob = ball(&mut world, Vec3::new(1.5, 0.0, 0.0), 2.0);
    let tie = JointKind::Spring {
        stiffness: 80.0,
        damping: 0.0,
        length: 1.0,
    };
    let anchors = [
        JointAnchor::on(bob, Vec3::new(1.5, 0.0, 0.0)),
        JointAnchor::Point(Vec3::ZERO),
    ];
    world.add_joint(Joint::new(anchors, tie)).unwrap();
    let mut crossings = Vec::new();
    let mut before = 0.5;
    for tick in 0..600 {
        world.step();
        let now = world.rigid_body(bob).unwrap().position()[0] - 1.0;
        if before > 0.0 && now <= 0.0 {
            crossings.push(tick as f32 + before / (before - now));
        }
        before = now;
    }
    let count = (crossings.len() - 1) as f32;
    let period = (crossings[crossings.len() - 1] - crossings[0]) / count / 60.0;
    let expected = TAU * (2.0f32 / 80.0).sqrt();
    assert!(
        (period / expected - 1.0).abs() < 0.01,
        "{period} {expected}"
    );
}

/// Checks that a mass m = 1 kg hangs at rest from parallel springs between one fixed point and its centre.
/// The springs stretch by m g / Σk, and each carries the share k / Σk of the weight. With the substep length
/// h, h² k / m is up to 0.4 per spring, so a single solver pass over the springs would be far from the
/// solution.
fn parallel_springs_hold_a_mass<D: Dim>() {
    let mut world = world::<D>(-9.81);
    let bob = ball(&mut world, D::Vector::ZERO, 1.0);
    let all = [4e5f32, 1e5, 2e5, 1e5, 3e5, 2e5];
    let joints = all.map(|stiffness| {
        let tie = JointKind::Spring {
            stiffness,
            damping: 2e-3 * stiffness,
            length: 0.1,
        };
        let anchors = [
            JointAnchor::on(bob, D::Vector::ZERO),
            JointAnchor::Point(vector(0.0, 0.1, 0.0)),
        ];
        world.add_joint(Joint::new(anchors, tie)).unwrap()
    });
    for _ in 0..300 {
        world.step();
    }
    let sum = all.iter().sum::<f32>();
    let stretch = -world.rigid_body(bob).unwrap().position()[1];
    let expected = 9.81 / sum;
    assert!(
        (stretch / expected - 1.0).abs() < 0.02,
        "{stretch} {expected}"
    );
    for (joint, stiffness) in joints.into_iter().zip(all) {
        let force = world.joint(joint).unwrap().force();
        let expected = 9.81 * stiffness / sum;
        assert!((force / expected - 1.0).abs() < 0.02, "{force} {expected}");
    }
}

#[test]
fn parallel_springs_stretch_and_share_load_by_stiffness() {
    parallel_springs_hold_a_mass::<Dim2>();
    parallel_springs_hold_a_mass::<Dim3>();
}

/// Checks that a mass m between four springs, two on each side, oscillates along their axis with ω² = Σk/m.
fn mass_between_springs_oscillates<D: Dim>() {
    let mut world = world::<D>(0.0);
    let bob = ball(&mut world, vector(0.1, 0.0, 0.0), 2.0);
    let (mut sum, mut crossings) = (0.0, Vec::new());
    for (stiffness, side) in [(40.0, 1.0), (10.0, -1.0), (20.0, 1.0), (30.0, -1.0)] {
        let tie = JointKind::Spring {
            stiffness,
            damping: 0.0,
            length: 1.0,
        };
        let anchors = [
            JointAnchor::on(bob, vector(0.1, 0.0, 0.0)),
            JointAnchor::Point(vector(side, 0.0, 0.0)),
        ];
        world.add_joint(Joint::new(anchors, tie)).unwrap();
        sum += stiffness;
    }
    let mut before = 0.1;
    for tick in 0..600 {
        world.step();
        let now = world.rigid_body(bob).unwrap().position()[0];
        if before > 0.0 && now <= 0.0 {
            crossings.push(tick as f32 + before / (before - now));
        }
        before = now;
    }
    let count = (crossings.len() - 1) as f32;
    let period = (crossings[crossings.len() - 1] - crossings[0]) / count / 60.0;
    let expected = TAU * (2.0f32 / sum).sqrt();
    assert!(
        (period / expected - 1.0).abs() < 0.01,
        "{period} {expected}"
    );
}

#[test]
fn mass_between_springs_oscillates_at_natural_frequency() {
    mass_between_springs_oscillates::<Dim2>();
    mass_between_springs_oscillates::<Dim3>();
}

/// Two equal stiff springs carry a weight of 39.2 N, so each carries 19.6 N. Both break if their breaking
/// force is below 19.6 N.
#[test]
fn parallel_springs_break_above_their_share_of_the_load() {
    for (limit, holds) in [(22.0, true), (18.0, false)] {
        let mut world = world::<Dim3>(-9.81);
        let at = Vec3::new(0.0, -1e-5, 0.0);
        let bob = ball(&mut world, at, 4.0);
        let joints = [0, 1].map(|_| {
            let tie = JointKind::Spring {
                stiffness: 2e6,
                damping: 4e3,
                length: 0.1,
            };
            let anchors = [
                JointAnchor::on(bob, at),
                JointAnchor::Point(Vec3::new(0.0, 0.1, 0.0)),
            ];
            let joint = Joint::new(anchors, tie).with_breaking_force(limit);
            world.add_joint(joint).unwrap()
        });
        for _ in 0..60 {
            world.step();
        }
        let held = joints.map(|joint| world.joint(joint).is_ok());
        assert_eq!(held, [holds; 2], "{limit}");
    }
}

#[test]
fn very_stiff_spring_keeps_length() {
    let mut world = world::<Dim2>(-9.81);
    let bob = ball(&mut world, Vec2::NEG_Y, 2.0);
    let tie = JointKind::Spring {
        stiffness: 1e9,
        damping: 0.0,
        length: 1.0,
    };
    let anchors = [
        JointAnchor::on(bob, Vec2::NEG_Y),
        JointAnchor::Point(Vec2::ZERO),
    ];
    world.add_joint(Joint::new(anchors, tie)).unwrap();
    for _ in 0..300 {
        world.step();
        assert!((world.rigid_body(bob).unwrap().position().y + 1.0).abs() < 0.01);
    }
}

#[test]
fn chain_of_ten_ropes_keeps_length() {
    let mut world = world::<Dim3>(-9.81);
    let mut above = JointAnchor::Point(Vec3::ZERO);
    let mut links = Vec::new();
    for k in 0..10 {
        let at = Vec3::new(0.25 * (k + 1) as f32, 0.0, 0.0);
        let link = ball(&mut world, at, 0.5);
        let anchor = JointAnchor::on(link, at);
        world.add_joint(Joint::rope(anchor, above, 0.25)).unwrap();
        above = anchor;
        links.push(link);
    }
    let (mut longest, mut lowest) = (0.0f32, 0.0f32);
    for _ in 0..1200 {
        world.step();
        let end = world.rigid_body(links[9]).unwrap().position();
        longest = longest.max(end.length());
        lowest = lowest.min(end.y);
    }
    assert!(longest < 2.7, "{longest}");
    assert!(lowest < -2.3, "{lowest}");
}

/// Checks that a vertical chain of pinned links hangs at rest, also if the lowest body is 20 times as heavy
/// as a link.
#[test]
fn chain_of_pins_stays_at_rest_under_load() {
    for heavy in [1.0, 10.0, 20.0] {
        let mut world = world::<Dim3>(-9.81);
        let mut above = JointAnchor::Point(Vec3::ZERO);
        let mut links = Vec::new();
        for k in 0..10 {
            let at = Vec3::new(0.0, -0.25 * (k + 1) as f32, 0.0);
            let link = ball(&mut world, at, if k == 9 { heavy } else { 1.0 });
            let top = Vec3::new(0.0, -0.25 * k as f32, 0.0);
            world
                .add_joint(Joint::pin(JointAnchor::on(link, top), above))
                .unwrap();
            above = JointAnchor::on(link, at);
            links.push(link);
        }
        let mut fastest = 0.0f32;
        for _ in 0..300 {
            world.step();
            for &link in &links {
                let velocity = world.rigid_body(link).unwrap().velocity().linear;
                fastest = fastest.max(velocity.length());
            }
        }
        assert!(fastest < 0.2, "{heavy}: {fastest}");
    }
}

#[test]
fn joint_breaks_above_breaking_force_with_event() {
    for (limit, holds) in [(60.0, true), (30.0, false)] {
        let mut world = world::<Dim3>(-9.81);
        // The body of 4 kg loads the hanging joint with 39.2 N.
        let bob = ball(&mut world, Vec3::NEG_Y, 4.0);
        let anchor = JointAnchor::on(bob, Vec3::NEG_Y);
        let joint = Joint::pin(anchor, JointAnchor::Point(Vec3::NEG_Y));
        let id = world.add_joint(joint.with_breaking_force(limit)).unwrap();
        let mut told = 0;
        for _ in 0..60 {
            world.step();
            told += broken(&world);
        }
        assert_eq!(world.joint(id).is_ok(), holds);
        assert_eq!(told, usize::from(!holds));
        assert_eq!(world.rigid_body(bob).unwrap().position().y < -2.0, !holds);
    }
}

#[test]
fn joint_breaks_when_body_is_removed() {
    let mut world = world::<Dim3>(-9.81);
    let id = soft(&mut world, Vec3::ZERO);
    let anchor = JointAnchor::on(id, Vec3::Y).within(0.1);
    let joint = world
        .add_joint(Joint::pin(anchor, JointAnchor::Point(Vec3::Y)))
        .unwrap();
    world.step();
    world.remove(id).unwrap();
    assert_eq!(world.joint_anchor_positions(joint).unwrap(), None);
    world.step();
    assert_eq!(broken(&world), 1);
    assert!(world.remove(joint).is_err());
}

/// A pin stays attached to its voxels while the rest of the body crumbles.
#[test]
fn pin_keeps_voxels_while_body_crumbles() {
    let mut world = world::<Dim3>(-9.81);
    let grid = VoxelGrid::<Dim3>::ball(10, 1.0).unwrap();
    let id = world
        .add_soft_body(SoftBody::new(grid, &[Material::default()]).unwrap())
        .unwrap();
    let at = Vec3::new(0.5, 0.95, 0.5);
    let pin = world
        .add_joint(Joint::pin(JointAnchor::on(id, at), JointAnchor::Point(at)))
        .unwrap();
    for _ in 0..30 {
        world.step();
    }
    world.soft_body_mut(id).unwrap().crumble();
    for _ in 0..60 {
        world.step();
        let [held, place] = world.joint_anchor_positions(pin).unwrap().unwrap();
        assert!((held - place).length() < 0.15, "{held:?}");
    }
    assert!(world[id].centre_of_mass().y < -2.0);
}

#[test]
fn add_joint_names_invalid_field() {
    let mut world = world::<Dim2>(-9.81);
    let bob = ball(&mut world, Vec2::ZERO, 1.0);
    let good = [
        JointAnchor::on(bob, Vec2::ZERO),
        JointAnchor::Point(Vec2::ZERO),
    ];
    let spring = |stiffness, damping, length| JointKind::Spring {
        stiffness,
        damping,
        length,
    };
    let bad = [
        (Joint::new(good, spring(f32::NAN, 0.0, 1.0)), "stiffness"),
        (Joint::new(good, spring(1.0, -1.0, 1.0)), "damping"),
        (Joint::new(good, spring(1.0, 1.0, f32::INFINITY)), "length"),
        (Joint::new(good, JointKind::Rope { length: 0.0 }), "length"),
        (
            Joint::new(good, JointKind::Pin).with_breaking_force(f32::NAN),
            "breaking_force",
        ),
        (
            Joint::pin(good[0], JointAnchor::Point(Vec2::NAN)),
            "joint anchor 2: point",
        ),
        (Joint::pin(good[1], good[1]), "joint anchors"),
        (Joint::pin(good[0], good[0]), "joint anchors"),
    ];
    for (joint, word) in bad {
        let error = world.add_joint(joint).unwrap_err().to_string();
        assert!(error.starts_with(&format!("{word} must be")), "{error}");
    }
    world.remove(bob).unwrap();
    assert!(world.add_joint(Joint::new(good, JointKind::Pin)).is_err());
}

#[test]
fn slow_kinematic_body_moves_sleeping_load_by_joint() {
    let mut world = world::<Dim3>(-9.81);
    let crane = RigidBody::kinematic(Shape::ball(0.1));
    let crane = world.add_rigid_body(crane).unwrap();
    let load = ball(&mut world, Vec3::NEG_Y, 1.0);
    let [first, second] = [load, crane].map(|body| JointAnchor::on(body, Vec3::NEG_Y));
    world.add_joint(Joint::pin(first, second)).unwrap();
    for _ in 0..120 {
        world.step();
    }
    assert!(world.rigid_body(load).unwrap().is_asleep());
    for tick in 1..=240 {
        world
            .set_target_position(crane, Vec3::new(0.0, 0.05 * tick as f32 / 60.0, 0.0))
            .unwrap();
        world.step();
    }
    let height = world.rigid_body(load).unwrap().position().y;
    assert!((height + 0.8).abs() < 0.01, "{height}");
}
