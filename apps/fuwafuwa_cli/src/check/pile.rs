//! Piles: a block of crumbs (pieces of one voxel) falls into a bin and comes to rest; no piece is lost.

use super::parallel;
use crate::report::{Findings, Outcome, Progress};
use anyhow::Result;
use fuwafuwa::{Dim, Dim2, Dim3, DimVector, MotionType, Shape, SoftBody};
use fuwafuwa_scenes::Scene;

const SCENES: [&str; 2] = ["pile", "pile-3d"];
/// Maximum time until a pile must be at rest [s].
const PATIENCE: f64 = 10.0;
/// Maximum penetration of a crumb into a wall [voxels].
const DEPTH: f64 = 0.5;

/// Measurements of a pile.
struct Pile {
    pieces: usize,
    lost: usize,
    /// Maximum penetration into a wall [voxels].
    depth: f64,
    /// Time at which all pieces were asleep [s]; infinite if that never happened.
    asleep: f64,
}

/// Drops the crumbs of the scenes `pile` and `pile-3d`.
pub fn check(progress: &Progress) -> Result<Findings> {
    let piles = parallel::each(&SCENES, progress, |name| {
        let scene = Scene::open(name, &[])?;
        match scene.dim {
            2 => fall::<Dim2>(&scene),
            _ => fall::<Dim3>(&scene),
        }
    })?;
    let mut outcomes = Vec::new();
    for (name, pile) in SCENES.iter().zip(piles) {
        let least = if name.ends_with("3d") { 1000.0 } else { 3000.0 };
        let case = |what: &str| format!("{name}, {what}");
        let (pieces, lost) = (pile.pieces as f64, pile.lost as f64);
        outcomes.push(Outcome::within(case("pieces"), pieces, least..=1e6));
        outcomes.push(Outcome::within(case("pieces lost"), lost, 0.0..=0.0));
        outcomes.push(Outcome::within(
            case("voxels into a wall"),
            pile.depth,
            0.0..=DEPTH,
        ));
        outcomes.push(Outcome::within(
            case("seconds until asleep"),
            pile.asleep,
            0.0..=PATIENCE,
        ));
    }
    Ok(outcomes.into())
}

fn fall<D: Dim>(scene: &Scene) -> Result<Pile> {
    let mut world = scene.build::<D>()?;
    let id = world.nth_soft_body(0).expect("the scene has a body");
    let body = &world[id];
    let (before, mass) = (body.piece_views().len(), body.total_mass());
    let bodies = world.rigid_bodies().map(|(_, body)| body);
    let fixed = bodies.filter(|body| body.motion_type() == MotionType::Fixed);
    let walls: Vec<Shape<D>> = fixed.map(|body| body.shape()).collect();
    let mut asleep = f64::INFINITY;
    let mut depth = 0.0f64;
    for tick in 0..(PATIENCE * 60.0) as usize {
        let report = world.step();
        anyhow::ensure!(report.quarantined == 0, "a piece was quarantined");
        depth = depth.max(deepest(&world[id], &walls));
        let pieces = &world[id].pieces().list;
        if pieces.iter().all(|piece| piece.asleep) {
            asleep = (tick + 1) as f64 / 60.0;
            break;
        }
    }
    let body = &world[id];
    let views = body.piece_views();
    let size = f64::from(body.grid().voxel_size());
    let outside = views.iter().filter(|view| {
        let centre = D::Vector::from_vec3(view.centre);
        walls.iter().any(|wall| wall.distance(centre).0 < 0.0)
    });
    let kept = body.total_mass() / mass;
    anyhow::ensure!(
        (kept - 1.0).abs() < 1e-6,
        "the mass changed by a factor of {kept}"
    );
    Ok(Pile {
        pieces: views.len(),
        lost: outside.count() + before.abs_diff(views.len()),
        depth: depth / size,
        asleep,
    })
}

/// Returns the maximum penetration of a node into a wall [m].
fn deepest<D: Dim>(body: &SoftBody<D>, walls: &[Shape<D>]) -> f64 {
    let mut deepest = 0.0f32;
    for (id, _) in body.mesh().nodes() {
        let at = body.node_state(id).0;
        for wall in walls {
            deepest = deepest.max(-wall.distance(at).0);
        }
    }
    f64::from(deepest)
}
