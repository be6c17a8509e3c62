use super::*;
use fuwafuwa::{
    Blade, DEFAULT_TICK, Dim3, Material, PieceId, SoftBodyHandle, VoxelGrid, World, WorldConfig,
};

const EYE: Vec3 = Vec3::new(0.5, 0.8, 6.0);
/// Centre of the ball [m].
const CENTRE: Vec3 = Vec3::splat(0.5);

fn ball() -> (World<Dim3>, SoftBodyHandle) {
    let mut world = World::new(WorldConfig::default()).expect("the defaults are valid");
    let grid = VoxelGrid::ball(20, 1.0).expect("the grid is valid");
    let body = SoftBody::new(grid, &[Material::default()]).expect("the defaults are valid");
    let body = world.add_soft_body(body).unwrap();
    (world, body)
}

/// Moves all nodes from their rest positions.
fn deform(world: &mut World<Dim3>, body: SoftBodyHandle, to: impl Fn(PieceId, Vec3) -> Vec3) {
    let body = world.soft_body_mut(body).unwrap();
    let voxel = body.grid().voxel_size();
    let nodes = body.mesh().nodes();
    let nodes: Vec<_> = nodes.map(|(id, node)| (id, node.at)).collect();
    for (id, at) in nodes {
        let piece = body.pieces().of_node(id);
        let at = Vec3::from(at.map(|k| k as f32 * voxel));
        body.set_node_state(id, to(piece, at), Vec3::ZERO).unwrap();
    }
}

/// Returns the share of the drawn face that lies on original skin.
fn covered(anchor: &FaceAnchor, body: &SoftBody<Dim3>) -> f32 {
    let skin = PieceSkin::of(body, anchor.piece, &masses(body), Some(EYE));
    let size = anchor.size;
    let at = anchor.at + anchor.axes[2] * (INSIDE * size);
    skin.cover(at, anchor.axes[2], size)
}

#[test]
fn anchor_faces_camera_on_covered_skin() {
    let (world, body) = ball();
    let anchor = FaceAnchor::new(&world[body], Some(EYE));
    assert!(
        anchor.axes[2].dot(ideal_direction(CENTRE, EYE)) > 0.97,
        "{anchor:?}"
    );
    assert!(anchor.axes[0][0] > 0.97 && anchor.size > 0.2, "{anchor:?}");
    assert!(covered(&anchor, &world[body]) > 0.9);
}

#[test]
fn anchor_rolls_with_fast_skin() {
    let (mut world, body) = ball();
    let mut anchor = FaceAnchor::new(&world[body], Some(EYE));
    let (first, out) = (anchor.at, anchor.axes[2]);
    for tick in 1..20 {
        // The body rotates at 10 rad/s and moves away.
        let angle = 10.0 * DEFAULT_TICK * tick as f32;
        let (sin, cos) = angle.sin_cos();
        let turn = |v: Vec3| Vec3::new(cos * v.x + sin * v.y, cos * v.y - sin * v.x, v.z);
        let carried = |at| turn(at - CENTRE) + CENTRE + Vec3::X * (0.1 * tick as f32);
        deform(&mut world, body, |_, at| carried(at));
        anchor.follow(&world[body], Some(EYE), tick % 5 == 0, DEFAULT_TICK);
        assert!(anchor.axes[2].dot(turn(out)) > 0.999, "at {tick}");
        assert!((anchor.at - carried(first)).length() < 0.01, "at {tick}");
    }
}

#[test]
fn anchor_moves_seldom_while_body_rolls_and_ends_upright() {
    let (mut world, body) = ball();
    let mut anchor = FaceAnchor::new(&world[body], Some(EYE));
    let mut leaps = 0;
    let (mut angle, mut least) = (0.0f32, f32::MAX);
    for tick in 1..150 {
        // The body rolls to the right at 2 rad/s for about half a turn, then stops.
        angle += if tick < 100 { 2.0 * DEFAULT_TICK } else { 0.0 };
        let (sin, cos) = angle.sin_cos();
        deform(&mut world, body, |_, at| {
            let v = at - CENTRE;
            Vec3::new(cos * v.x + sin * v.y, cos * v.y - sin * v.x, v.z) + CENTRE
        });
        let before = anchor.axes[2];
        anchor.follow(&world[body], Some(EYE), tick % 5 == 0, DEFAULT_TICK);
        leaps += u32::from((anchor.axes[2] - before).length() > 0.2);
        least = least.min(anchor.axes[2].dot(ideal_direction(CENTRE, EYE)));
    }
    assert!(leaps <= 2 && least > 0.3, "{leaps} leaps, {least}");
    assert!(anchor.axes[1].dot(UPRIGHT[1]) > 0.8, "{anchor:?}");
}

#[test]
fn anchor_returns_to_camera_after_body_turned() {
    let (mut world, body) = ball();
    let mut anchor = FaceAnchor::new(&world[body], Some(EYE));
    deform(&mut world, body, |_, at| {
        Vec3::new(1.0 - at.x, at.y, 1.0 - at.z)
    });
    let mut least = f32::MAX;
    for tick in 0..60 {
        let before = anchor.clone();
        anchor.follow(&world[body], Some(EYE), tick % 5 == 0, DEFAULT_TICK);
        least = least.min(anchor.size);
        // The drawn face never moves to another place while it is visible.
        let leap = tick > 0 && (anchor.axes[2] - before.axes[2]).length() > 0.1;
        assert!(!leap || anchor.size < 0.05, "{anchor:?}");
    }
    assert!(least < 0.05, "{least}");
    assert!(
        anchor.axes[2].dot(ideal_direction(CENTRE, EYE)) > 0.95,
        "{anchor:?}"
    );
    assert!(anchor.size > 0.2, "{anchor:?}");
}

#[test]
fn anchor_leaves_skin_that_was_cut_off() {
    let (mut world, body) = ball();
    let mut anchor = FaceAnchor::new(&world[body], Some(EYE));
    // Cuts off the part of the body that faces the camera and moves it away.
    let across = Vec3::new(2.0, 0.0, 0.0);
    let along = Vec3::new(0.0, -1.3, 1.3);
    let blade = Blade::parallelogram(Vec3::new(-0.5, 1.25, 0.0), across, along);
    world.cut(body, &blade).unwrap();
    let masses = masses(&world[body]);
    let is_gone = |piece: PieceId| masses[piece] < masses.iter().sum::<f32>() * 0.5;
    deform(&mut world, body, |piece, at| match is_gone(piece) {
        true => at + Vec3::X * 9.0,
        false => at,
    });
    for tick in 0..60 {
        anchor.follow(&world[body], Some(EYE), tick % 5 == 0, DEFAULT_TICK);
    }
    assert!(!is_gone(anchor.piece) && anchor.size > 0.08, "{anchor:?}");
    assert!(covered(&anchor, &world[body]) > 0.7, "{anchor:?}");
    // The drawn face stays at its new place.
    let place = anchor.place.expect("the face has a place").voxel;
    for tick in 0..120 {
        anchor.follow(&world[body], Some(EYE), tick % 5 == 0, DEFAULT_TICK);
        assert_eq!(anchor.place.expect("the face has a place").voxel, place);
    }
}
