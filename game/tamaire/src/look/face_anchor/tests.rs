use super::*;
use fuwafuwa::DEFAULT_TICK;
use fuwafuwa::{Blade, Dim3, Material, PieceId, VoxelGrid, World, WorldConfig};

const EYE: Vector = [0.5, 0.8, 6.0];

fn alone(grid: VoxelGrid<Dim3>) -> World<Dim3> {
    let mut world = World::new(WorldConfig::default()).expect("the defaults are valid");
    world.add_soft_body(
        SoftBody::new(grid, &[Material::default()]).expect("the defaults are valid"),
    );
    world
}

fn ball() -> World<Dim3> {
    alone(VoxelGrid::ball(20, 1.0).expect("the grid is valid"))
}

/// Moves all nodes from their rest positions.
fn deform(world: &mut World<Dim3>, to: impl Fn(PieceId, Vector) -> Vector) {
    let body = world
        .soft_body_mut(world.nth_soft_body(0).unwrap())
        .unwrap();
    let voxel = body.grid().voxel_size();
    let nodes = body.mesh().nodes();
    let nodes: Vec<_> = nodes.map(|(id, node)| (id, node.at)).collect();
    for (id, at) in nodes {
        let piece = body.pieces().of_node(id);
        let at = at.map(|k| k as f32 * voxel);
        body.set_node_state(id, to(piece, at), [0.0; 3]);
    }
}

/// Returns the share of the face that lies on original skin.
fn covered(perch: &FaceAnchor, body: &SoftBody<Dim3>) -> f32 {
    let skin = PieceSkin::of(body, perch.piece, &masses(body), Some(EYE));
    let size = perch.size;
    let at = plus(perch.at, scaled(perch.axes[2], INSIDE * size));
    skin.cover(at, perch.axes[2], size)
}

#[test]
fn perch_faces_camera_on_covered_skin() {
    let world = ball();
    let perch = FaceAnchor::new(world.soft_bodies().next().unwrap().1, Some(EYE));
    assert!(
        dot(perch.axes[2], ideal_direction([0.5; 3], EYE)) > 0.97,
        "{perch:?}"
    );
    assert!(perch.axes[0][0] > 0.97 && perch.size > 0.2, "{perch:?}");
    assert!(covered(&perch, world.soft_bodies().next().unwrap().1) > 0.9);
}

#[test]
fn perch_rolls_with_fast_skin() {
    let mut world = ball();
    let mut perch = FaceAnchor::new(world.soft_bodies().next().unwrap().1, Some(EYE));
    let (first, out) = (perch.at, perch.axes[2]);
    for tick in 1..20 {
        // The body rotates at 10 rad/s and moves away.
        let angle = 10.0 * TICK * tick as f32;
        let (sin, cos) = angle.sin_cos();
        let turn = |[x, y, z]: Vector| [cos * x + sin * y, cos * y - sin * x, z];
        let carried = |at: Vector| {
            let at = turn(minus(at, [0.5; 3]));
            plus(at, [0.5 + 0.1 * tick as f32, 0.5, 0.5])
        };
        deform(&mut world, |_, at| carried(at));
        perch.follow(
            world.soft_bodies().next().unwrap().1,
            Some(EYE),
            tick % 5 == 0,
            TICK,
        );
        assert!(dot(perch.axes[2], turn(out)) > 0.999, "at {tick}");
        assert!(length(minus(perch.at, carried(first))) < 0.01, "at {tick}");
    }
}

#[test]
fn perch_moves_seldom_while_body_rolls_and_ends_upright() {
    let mut world = ball();
    let mut perch = FaceAnchor::new(world.soft_bodies().next().unwrap().1, Some(EYE));
    let mut leaps = 0;
    let (mut angle, mut least) = (0.0f32, f32::MAX);
    for tick in 1..150 {
        // The body rolls to the right at 2 rad/s for about half a turn, then stops.
        angle += if tick < 100 { 2.0 * TICK } else { 0.0 };
        let (sin, cos) = angle.sin_cos();
        deform(&mut world, |_, at| {
            let [x, y, z] = minus(at, [0.5; 3]);
            plus([cos * x + sin * y, cos * y - sin * x, z], [0.5; 3])
        });
        let before = perch.axes[2];
        let body = world.soft_bodies().next().unwrap().1;
        perch.follow(body, Some(EYE), tick % 5 == 0, TICK);
        leaps += u32::from(length(minus(perch.axes[2], before)) > 0.2);
        least = least.min(dot(perch.axes[2], ideal_direction([0.5; 3], EYE)));
    }
    assert!(leaps <= 2 && least > 0.3, "{leaps} leaps, {least}");
    assert!(dot(perch.axes[1], UPRIGHT[1]) > 0.8, "{perch:?}");
}

#[test]
fn perch_returns_to_camera_after_body_turned() {
    let mut world = ball();
    let mut perch = FaceAnchor::new(world.soft_bodies().next().unwrap().1, Some(EYE));
    deform(&mut world, |_, [x, y, z]| [1.0 - x, y, 1.0 - z]);
    let mut least = f32::MAX;
    for tick in 0..60 {
        let before = perch.clone();
        perch.follow(
            world.soft_bodies().next().unwrap().1,
            Some(EYE),
            tick % 5 == 0,
            TICK,
        );
        least = least.min(perch.size);
        // The face never moves to another place while it is visible.
        let leap = tick > 0 && length(minus(perch.axes[2], before.axes[2])) > 0.1;
        assert!(!leap || perch.size < 0.05, "{perch:?}");
    }
    assert!(least < 0.05, "{least}");
    assert!(
        dot(perch.axes[2], ideal_direction([0.5; 3], EYE)) > 0.95,
        "{perch:?}"
    );
    assert!(perch.size > 0.2, "{perch:?}");
}

#[test]
fn perch_leaves_skin_that_was_cut_off() {
    let mut world = ball();
    let mut perch = FaceAnchor::new(world.soft_bodies().next().unwrap().1, Some(EYE));
    // Cuts off the part of the body that faces the camera and moves it away.
    let (from, across, along) = ([-0.5, 1.25, 0.0], [2.0, 0.0, 0.0], [0.0, -1.3, 1.3]);
    world
        .cut(
            world.nth_soft_body(0).unwrap(),
            &Blade {
                from,
                across,
                along,
            },
        )
        .unwrap();
    let masses = masses(world.soft_bodies().next().unwrap().1);
    let is_gone = |piece: PieceId| masses[piece] < masses.iter().sum::<f32>() * 0.5;
    deform(&mut world, |piece, at| match is_gone(piece) {
        true => plus(at, [9.0, 0.0, 0.0]),
        false => at,
    });
    for tick in 0..60 {
        perch.follow(
            world.soft_bodies().next().unwrap().1,
            Some(EYE),
            tick % 5 == 0,
            TICK,
        );
    }
    assert!(!is_gone(perch.piece) && perch.size > 0.08, "{perch:?}");
    assert!(
        covered(&perch, world.soft_bodies().next().unwrap().1) > 0.7,
        "{perch:?}"
    );
    // The face stays at the new place.
    let place = perch.place.expect("the face has a place").voxel;
    for tick in 0..120 {
        perch.follow(
            world.soft_bodies().next().unwrap().1,
            Some(EYE),
            tick % 5 == 0,
            TICK,
        );
        assert_eq!(perch.place.expect("the face has a place").voxel, place);
    }
}
