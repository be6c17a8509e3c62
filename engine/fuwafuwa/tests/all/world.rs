//! Worlds: falling, rest, sleep, cuts, contacts, tears and access to pieces and surfaces.

use crate::vectors::vector;
use fuwafuwa::{
    Blade, Damping, Dim, Dim2, Dim3, DimVector, ElementId, Event, Facet, Material, MotionType,
    NodeId, PieceView, RigidBody, Shape, SoftBody, StiffBodies, Vec2, Vec3, Velocity, VoxelGrid,
    World, WorldConfig,
};

fn weightless<D: Dim>() -> WorldConfig<D> {
    WorldConfig {
        gravity: D::Vector::ZERO,
        ..WorldConfig::default()
    }
}

fn unbreakable() -> Material {
    Material {
        strength: f32::INFINITY,
        ..Material::default()
    }
}

fn ball<D: Dim>(n: usize, material: Material) -> SoftBody<D> {
    SoftBody::new(VoxelGrid::ball(n, 1.0).unwrap(), &[material]).unwrap()
}

fn validate<D: Dim>(world: &World<D>) {
    for (_, body) in world.soft_bodies() {
        body.mesh()
            .validate(body.grid(), body.connectivity())
            .unwrap();
    }
}

/// Returns the volume enclosed by all surface faces, by the divergence theorem [m³].
fn volume_inside<D: Dim>(body: &SoftBody<D>) -> f32 {
    let of = |facet: Facet| {
        let [a, b, c, d] = facet.corners;
        match D::N {
            2 => 0.5 * a.truncate().perp_dot(b.truncate()),
            _ => (a.dot(b.cross(c)) + a.dot(c.cross(d))) / 6.0,
        }
    };
    body.facets().map(of).sum()
}

fn check_cut_in_two<D: Dim>(n: usize, blade: Blade<D>) {
    let mut world = World::<D>::new(weightless()).unwrap();
    let id = world.add_soft_body(ball::<D>(n, unbreakable())).unwrap();
    let mass = world[id].total_mass();
    let volume = volume_inside(&world[id]);
    assert!(
        (f64::from(volume) * 100.0 / mass - 1.0).abs() < 1e-3,
        "{volume}"
    );
    assert!(world.cut(id, &blade).unwrap() > n / 2);
    validate(&world);
    let body = &world[id];
    let views = body.piece_views();
    assert_eq!(views.len(), 2);
    let total: f32 = views.iter().map(|view| view.mass).sum();
    assert!((f64::from(total) / mass - 1.0).abs() < 1e-4);
    assert!(views.iter().all(|view| view.mass > 0.2 * total));
    let fresh = body.facets().filter(|facet| facet.is_torn).count();
    assert!(fresh >= n, "{fresh} fresh faces");
    assert!((volume_inside(body) / volume - 1.0).abs() < 1e-3);
    for _ in 0..30 {
        world.step();
    }
    let kept: f64 = world[id].total_mass();
    assert!((kept / mass - 1.0).abs() < 1e-4);
}

#[test]
fn cut_splits_body_in_two() {
    let across = Blade::segment(Vec2::new(0.47, -0.1), Vec2::new(0.55, 1.1));
    check_cut_in_two::<Dim2>(24, across);
    let (first, second) = (Vec3::new(1.2, 0.1, 0.0), Vec3::new(0.0, 0.1, 1.2));
    let across = Blade::parallelogram(Vec3::new(-0.1, 0.45, -0.1), first, second);
    check_cut_in_two::<Dim3>(16, across);
}

#[test]
fn bare_faces_and_nodes_reveal_changes_of_cut() {
    let mut world = World::<Dim3>::new(weightless()).unwrap();
    let soft = world.add_soft_body(ball(16, unbreakable())).unwrap();
    let forms = |world: &World<Dim3>| -> Vec<(u8, Vec<NodeId>)> {
        let body = &world[soft];
        let form = |id| {
            let nodes = body.mesh().element(id).map(|element| element.nodes.clone());
            (body.bare_faces(id), nodes.unwrap_or_default())
        };
        let ids = (0..body.mesh().element_capacity() as u32).map(ElementId);
        ids.map(form).collect()
    };
    let before = forms(&world);
    let corner = Vec3::new(0.5, -0.2, -0.2);
    let blade = Blade::parallelogram(corner, Vec3::Y * 0.4, Vec3::Z * 1.4);
    world.cut(soft, &blade).unwrap();
    let (after, body) = (forms(&world), &world[soft]);
    let told: u32 = after.iter().map(|(bare, _)| bare.count_ones()).sum();
    assert_eq!(told as usize, body.facets().count());
    for facet in body.facets() {
        for (node, corner) in facet.nodes.iter().zip(facet.corners) {
            assert_eq!(body.positions()[*node].xyz(), corner);
        }
        let (old, new) = (
            before.get(facet.element.index()),
            &after[facet.element.index()],
        );
        let is_far = facet.corners[0][1] > 0.6;
        assert!(!is_far || old == Some(new), "{facet:?}");
        assert!(!facet.is_torn || old != Some(new), "{facet:?}");
    }
}

#[test]
fn short_cut_leaves_slit_in_one_piece() {
    let mut world = World::<Dim2>::new(weightless()).unwrap();
    let id = world.add_soft_body(ball(24, unbreakable())).unwrap();
    let slit = Blade::segment(Vec2::new(0.5, -0.1), Vec2::new(0.5, 0.5));
    assert!(world.cut(id, &slit).unwrap() > 5);
    validate(&world);
    assert_eq!(world[id].pieces().list.len(), 1);
    assert_eq!(world[id].outlines().len(), 1, "the slit must join the rim");
    let inner = Blade::segment(Vec2::new(0.5, 0.7), Vec2::new(0.5, 0.8));
    assert!(world.cut(id, &inner).unwrap() > 0);
    assert_eq!(
        world[id].outlines().len(),
        2,
        "an inner cut must have its own outline"
    );
}

/// Returns the height of the lowest point of the smooth surface [m].
fn lowest<D: Dim>(body: &SoftBody<D>) -> f32 {
    let corners = body
        .skin_facets()
        .flat_map(|facet| facet.corners.into_iter().take(D::CORNERS / 2));
    corners.map(|corner| corner.y).fold(f32::INFINITY, f32::min)
}

fn check_falls_rests_and_sleeps<D: Dim>(n: usize) {
    let mut world = World::<D>::new(WorldConfig::default()).unwrap();
    let floor = Shape::half_space(D::Vector::Y, D::Vector::ZERO);
    world
        .add_rigid_body(RigidBody::fixed(floor).with_friction(0.5))
        .unwrap();
    let damped = Material {
        damping: Damping::at(0.3, 4.0),
        ..unbreakable()
    };
    let id = world
        .add_soft_body(ball::<D>(n, damped).translated(vector(0.0, 0.3, 0.0)))
        .unwrap();
    let (mut hit, mut slept) = (false, false);
    for _ in 0..900 {
        world.step();
        for event in world.events() {
            hit |= matches!(event, Event::ContactForce(contact) if contact.impulse > 1.0);
            slept |= matches!(event, Event::FellAsleep { .. });
        }
        if slept {
            break;
        }
    }
    let view = world[id].piece_views()[0];
    assert!(hit && slept && view.asleep, "{view:?}");
    let low = lowest(&world[id]);
    assert!(low > -0.01 && view.high[1] > 0.5, "{low} {view:?}");
    let still = world.hash();
    world.step();
    let depth = if D::N == 3 { 0.5 } else { 0.0 };
    let hand = RigidBody::kinematic(Shape::ball(0.1)).at(vector(0.5, 2.0, depth));
    let hand = world.add_rigid_body(hand).unwrap();
    assert_ne!(world.hash(), still, "the hash must change with the tick");
    let mut woke = false;
    for tick in 0..60 {
        let height = 2.0 - 1.5 * tick as f32 / 60.0;
        world
            .set_target_position(hand, vector(0.5, height, depth))
            .unwrap();
        world.step();
        woke |= world
            .events()
            .iter()
            .any(|event| matches!(event, Event::WokeUp { .. }));
    }
    assert!(woke, "a hand must wake the body it touches");
    let felt = world.rigid_body(hand).unwrap().reactions().last();
    let felt = felt.unwrap().contact;
    assert!(felt[1] > 1.0, "the body must push back: {felt:?}");
}

#[test]
fn ball_falls_sleeps_and_wakes_when_touched() {
    check_falls_rests_and_sleeps::<Dim2>(24);
    check_falls_rests_and_sleeps::<Dim3>(12);
}

/// Moves a hand through a body 1 m wide at 20 m/s, and checks that the state stays valid.
fn check_slam<D: Dim>(n: usize, drive: MotionType) {
    let mut world = World::<D>::new(weightless()).unwrap();
    let soft = world
        .add_soft_body(ball::<D>(n, Material::default()))
        .unwrap();
    let depth = if D::N == 3 { 0.5 } else { 0.0 };
    let hand = RigidBody::coupled(Shape::ball(0.1))
        .at(vector(-0.5, 0.5, depth))
        .with_motion_type(drive);
    let hand = world.add_rigid_body(hand).unwrap();
    for tick in 0..60 {
        world
            .set_target_position(hand, vector(-0.5 + tick as f32 * 20.0 / 60.0, 0.5, depth))
            .unwrap();
        let report = world.step();
        assert_eq!(report.quarantined, 0, "tick {tick}");
    }
    validate(&world);
    let body = &world[soft];
    for (id, _) in body.mesh().nodes() {
        let (at, velocity, _) = body.node_state(id);
        assert!(at.is_finite() && velocity.is_finite());
    }
}

#[test]
fn world_stays_finite_when_hand_is_slammed() {
    for drive in [MotionType::Kinematic, MotionType::default()] {
        check_slam::<Dim2>(32, drive);
        check_slam::<Dim3>(12, drive);
    }
}

#[test]
fn inverted_body_recovers_and_stays_finite() {
    let mut world = World::<Dim2>::new(weightless()).unwrap();
    let mut body = ball::<Dim2>(24, unbreakable());
    let nodes: Vec<_> = body.mesh().nodes().map(|(id, _)| id).collect();
    for id in nodes {
        let (at, _, _) = body.node_state(id);
        let mirrored = Vec2::new(1.0 - at.x, at.y);
        body.set_node_state(id, mirrored, Vec2::ZERO).unwrap();
    }
    let soft = world.add_soft_body(body).unwrap();
    let inverted: Vec<u32> = (0..120).map(|_| world.step().inverted).collect();
    assert!(
        inverted[0] > 0,
        "inverted elements must be reported: {inverted:?}"
    );
    assert!(
        inverted[119] < inverted[0],
        "inverted elements must decrease: {inverted:?}"
    );
    let view = world[soft].piece_views()[0];
    assert!(view.high[0] - view.low[0] < 2.0, "{view:?}");
}

/// A body that is too stiff for the maximum number of substeps is softened, and `stiffness_scale` returns the
/// factor.
#[test]
fn too_stiff_body_is_softened() {
    let mut world = World::<Dim2>::new(WorldConfig {
        stiff_bodies: StiffBodies::Softened,
        ..WorldConfig::default()
    })
    .unwrap();
    let floor = Shape::half_space(Vec2::Y, Vec2::ZERO);
    world
        .add_rigid_body(RigidBody::fixed(floor).with_friction(0.5))
        .unwrap();
    let mut steel = unbreakable();
    steel.elasticity.young = 1e9;
    let id = world
        .add_soft_body(ball::<Dim2>(24, steel).translated(Vec2::new(0.0, 0.1)))
        .unwrap();
    assert!(world[id].stiffness_scale() < 0.1);
    assert_eq!(world.substeps(), 64);
    for _ in 0..60 {
        assert_eq!(world.step().quarantined, 0);
    }
    let view = world[id].piece_views()[0];
    assert!(view.low[1] > -0.05 && view.high[1] < 1.5, "{view:?}");
}

/// Checks that at 10 m/s, neither a body nor a cloud of crumbs passes through another body, which is 1 m
/// wide.
fn check_no_tunnelling<D: Dim>(n: usize) {
    for crumbles in [false, true] {
        let mut world = World::<D>::new(weightless()).unwrap();
        let mut flying = ball::<D>(n, unbreakable());
        if crumbles {
            flying.crumble();
        }
        let velocity = Velocity::linear(vector(10.0, 0.0, 0.0));
        let flying = flying.translated(vector(-1.2, 0.0, 0.0));
        let flying = world.add_soft_body(flying.with_velocity(velocity)).unwrap();
        let target = world.add_soft_body(ball::<D>(n, unbreakable())).unwrap();
        for tick in 0..40 {
            world.step();
            let target = world[target].piece_views()[0];
            let is_aside = |axis: usize, at: f32| (at - target.centre[axis]).abs() > 0.3;
            let pieces = world[flying].piece_views();
            let is_through = |piece: &&PieceView| {
                let aside = (1..D::N).any(|axis| is_aside(axis, piece.centre[axis]));
                !aside && piece.centre[0] > target.centre[0]
            };
            let through = pieces.iter().filter(is_through).count();
            assert_eq!(through, 0, "tick {tick}, of {}", pieces.len());
        }
    }
}

#[test]
fn fast_body_does_not_tunnel() {
    check_no_tunnelling::<Dim2>(16);
    check_no_tunnelling::<Dim3>(10);
}

/// Checks that the force for a force-feedback stick, updated 960 times a second, is smooth. The force must
/// not jitter while the hand rests on a body, nor jump between substeps while the hand pushes into the body.
fn check_smooth_reaction<D: Dim>(n: usize) {
    let mut world = World::<D>::new(WorldConfig::default()).unwrap();
    let floor = Shape::half_space(D::Vector::Y, D::Vector::ZERO);
    world
        .add_rigid_body(RigidBody::fixed(floor).with_friction(0.5))
        .unwrap();
    world.add_soft_body(ball::<D>(n, unbreakable())).unwrap();
    let z = if D::N == 3 { 0.5 } else { 0.0 };
    let hand = RigidBody::coupled(Shape::ball(0.15)).at(vector(0.5, 1.2, z));
    let hand = world.add_rigid_body(hand).unwrap();
    let (mut steps, mut pressed) = (Vec::new(), Vec::new());
    for tick in 0..480u16 {
        let down = 0.5 * f32::from(tick.min(120)) / 120.0;
        world
            .set_target_position(hand, vector(0.5, 1.2 - down, z))
            .unwrap();
        world.step();
        let felt = world.rigid_body(hand).unwrap().reactions();
        let up = felt.map(|reaction| reaction.coupling[1]);
        // Skips the first tick, in which the target does not move yet.
        if (1..120).contains(&tick) {
            steps.extend(up);
        } else if tick >= 420 {
            pressed.extend(up);
        }
    }
    let mean = pressed.iter().sum::<f32>() / pressed.len() as f32;
    assert!(mean.abs() > 20.0, "the hand must be pushed back: {mean} N");
    let furthest = pressed.iter().map(|up| (up - mean).abs());
    let furthest = furthest.fold(0.0, f32::max);
    assert!(
        furthest < 0.05 * mean.abs(),
        "at rest: {furthest} of {mean} N"
    );
    let jump = steps.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    let jump = jump.fold(0.0, f32::max);
    assert!(jump < 0.1 * mean.abs(), "pushing in: {jump} of {mean} N");
}

#[test]
fn hand_reaction_is_smooth_between_substeps() {
    check_smooth_reaction::<Dim2>(24);
    check_smooth_reaction::<Dim3>(12);
}

#[test]
fn squash_is_equal_with_8_and_16_substeps() {
    let [eight, sixteen] = [8, 16].map(|max_substeps| {
        let mut world = World::<Dim3>::new(WorldConfig {
            gravity: Vec3::new(0.0, -3.0, 0.0),
            drag: 0.5,
            max_substeps,
            ..WorldConfig::default()
        })
        .unwrap();
        let floor = Shape::half_space(Vec3::Y, Vec3::ZERO);
        world
            .add_rigid_body(RigidBody::fixed(floor).with_friction(0.4))
            .unwrap();
        let id = world
            .add_soft_body(ball::<Dim3>(16, unbreakable()))
            .unwrap();
        let hand = RigidBody::coupled(Shape::ball(0.2)).at(Vec3::new(0.5, 1.2, 0.5));
        let hand = world.add_rigid_body(hand).unwrap();
        let mut deepest = 0.0_f32;
        for tick in 0..90 {
            let height = 1.2 - 0.01 * tick.min(60) as f32;
            world
                .set_target_position(hand, Vec3::new(0.5, height, 0.5))
                .unwrap();
            assert_eq!(world.step().substeps, max_substeps);
            deepest = deepest.min(lowest(&world[id]));
        }
        assert_eq!(world[id].stiffness_scale(), 1.0);
        (world.rigid_body(hand).unwrap().position().y, deepest)
    });
    assert!(
        (eight.0 - sixteen.0).abs() < 0.002,
        "the hand must stop at the same height"
    );
    assert!(
        eight.1 > -0.006,
        "the ball may sink a tenth of a voxel into the floor"
    );
}
