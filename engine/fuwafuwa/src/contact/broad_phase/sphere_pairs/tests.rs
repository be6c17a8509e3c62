use super::*;
use crate::contact::broad_phase::contact_sphere::ContactSphere;
use crate::contact::broad_phase::sphere_pair::{MARGIN, renumber};
use crate::foundation::arena::BodySlot;
use crate::foundation::dim::{Dim2, Dim3};
use crate::foundation::ids::{ElementId, IndexVec, PieceId};
use crate::material::Material;
use crate::math::row::Row;
use crate::soft_body::SoftBody;
use crate::topology::grid::VoxelGrid;

/// Slot of the only body.
const BALL: BodySlot = BodySlot(0);
const SUBSTEPS: u32 = 8;
const SUBSTEP: f32 = 1.0 / 480.0;

fn random(seed: &mut u32) -> f32 {
    *seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
    (*seed >> 8) as f32 / (1 << 24) as f32 - 0.5
}

/// Starts a tick as a world does.
fn start_tick<D: Dim>(spheres: &mut Spheres, pairs: &mut SpherePairs, bodies: &SoftBodies<D>) {
    let numbers = spheres.start_tick(bodies, &mut pairs.changed);
    pairs.start_tick(numbers.is_some());
    if let Some(numbers) = numbers {
        renumber(&mut pairs.list, &numbers);
    }
}

/// Checks the list of pairs against a test of all pairs of spheres.
fn compare<D: Dim>(pairs: &SpherePairs, spheres: &Spheres, bodies: &SoftBodies<D>, when: &str) {
    assert!(pairs.list.is_sorted_by(|a, b| a.spheres < b.spheres));
    let all = &spheres.list;
    let centre = |sphere: &ContactSphere| sphere.mean::<D>(bodies.at(sphere.body).positions());
    for (b, second) in all.entries() {
        for (a, first) in all.entries().take(b.index()) {
            let apart = centre(first) - centre(second);
            let reach = (1.0 + MARGIN) * (first.radius + second.radius);
            let is_close = apart.dot(apart) < reach * reach;
            let is_found = pairs
                .list
                .binary_search_by(|pair| pair.spheres.cmp(&[a, b]))
                .is_ok();
            let both_sleep = first.asleep && second.asleep;
            let may_touch = is_close && !both_sleep && !first.site().is_held_to(&second.site());
            assert!(is_found || !may_touch, "{when}: {a} and {b} are missing");
            assert!(!is_found || !both_sleep, "{when}: {a} and {b} sleep");
        }
    }
}

/// Returns a set of bodies with a single ball.
fn ball<D: Dim>(n: usize) -> SoftBodies<D> {
    let grid = VoxelGrid::<D>::ball(n, 1.0).expect("the ball has voxels");
    let mut bodies = SoftBodies::default();
    bodies.insert(
        SoftBody::new(grid, &[Material::default()]).expect("the default material is valid"),
    );
    bodies
}

/// Moves crumbs at very different speeds, reverses some of them within a tick, and wakes some.
fn check<D: Dim>(n: usize) {
    let mut bodies = ball::<D>(n);
    let body = bodies.at_mut(BALL);
    body.crumble();
    let (size, count) = (body.grid().voxel_size(), body.pieces().list.len());
    let mut seed = 7;
    let (mut spheres, mut pairs) = (Spheres::default(), SpherePairs::default());
    let (mut again, mut whole) = (0, 0);
    for tick in 0..20 {
        // In even ticks about a third of the crumbs sleep, in odd ticks nearly all.
        let most = if tick % 2 == 0 { 0.2 } else { -0.45 };
        let sleepers: Vec<bool> = (0..count).map(|_| random(&mut seed) > most).collect();
        let sleepers = sleepers.into();
        let body = bodies.at_mut(BALL);
        body.set_asleep(&vec![true; count].into(), false);
        body.set_asleep(&sleepers, tick % 3 == 1);
        // Most crumbs move hardly one voxel per tick, some up to 30.
        let speeds: Vec<_> = (0..count)
            .map(|_| {
                let fast = if random(&mut seed) > 0.45 {
                    3600.0
                } else {
                    60.0
                };
                let mut speed = Row::ZERO;
                (0..D::N).for_each(|axis| speed[axis] = fast * size * random(&mut seed));
                speed
            })
            .collect();
        let speeds: IndexVec<PieceId, Row> = speeds.into();
        let velocity = |body: &mut SoftBody<D>, sign: &dyn Fn(PieceId) -> f32| {
            for node in body.positions().ids() {
                let piece = body.pieces().of_node(node);
                let moves = if body.pieces().list[piece].asleep {
                    0.0
                } else {
                    sign(piece)
                };
                body.velocities_mut()[node] = speeds[piece] * moves;
            }
        };
        velocity(body, &|_| 1.0);
        start_tick(&mut spheres, &mut pairs, &bodies);
        for substep in 0..SUBSTEPS {
            if substep == 3 {
                velocity(bodies.at_mut(BALL), &|piece| {
                    if piece.0 % 3 == 0 { -1.0 } else { 1.0 }
                });
            }
            if substep == 5 && tick % 3 == 1 {
                let marked: Vec<bool> = (0..count).map(|piece| piece % 2 == 0).collect();
                bodies.at_mut(BALL).set_asleep(&marked.into(), false);
                let woken = (0..count as u32).step_by(2);
                let woken: Vec<_> = woken.map(|piece| (BALL, PieceId(piece))).collect();
                spheres.wake(&woken, &mut pairs.changed);
            }
            whole += u32::from(pairs.bins.is_none());
            again += u32::from(pairs.follow(&mut spheres, &bodies, 1.0 / 960.0));
            compare(
                &pairs,
                &spheres,
                &bodies,
                &format!("tick {tick}, substep {substep}"),
            );
            spheres.set_close(pairs.list.iter().flat_map(|pair| pair.spheres));
            let mut furthest = 0.0f32;
            let body = bodies.at_mut(BALL);
            for node in body.positions().ids() {
                let step = body.velocities()[node] * SUBSTEP;
                furthest = furthest.max(step.length());
                body.positions_mut()[node] += step;
            }
            pairs.pass(SUBSTEP, furthest);
        }
    }
    assert!(
        again > whole + 10,
        "{again} updates, {whole} of them full: partial searches are expected"
    );
}

#[test]
fn list_contains_all_close_pairs_of_moving_crumbs() {
    check::<Dim2>(14);
    check::<Dim3>(6);
}

/// Returns the crack-face pairs, each as the body and element of both spheres, in ascending order.
fn crack_face_pairs(spheres: &Spheres) -> Vec<[(BodySlot, ElementId); 2]> {
    let key = |sphere: SphereId| spheres.list[sphere].key();
    let ascending = |[a, b]: [(BodySlot, ElementId); 2]| [a.min(b), a.max(b)];
    let mut pairs: Vec<_> = { spheres.crack_face_pairs.iter() }
        .map(|pair| ascending(pair.map(key)))
        .collect();
    pairs.sort_unstable();
    pairs
}

/// Tears a body at random. Compares the updated spheres and crack-face pairs with rebuilt ones, and
/// `is_held_to` with the shared nodes.
fn check_tears<D: Dim>(n: usize) {
    let mut bodies = ball::<D>(n);
    let mut seed = 5;
    let mut below = |count: usize| ((random(&mut seed) + 0.5) * count as f32) as usize % count;
    let (mut spheres, mut pairs) = (Spheres::default(), SpherePairs::default());
    for tick in 0..20 {
        start_tick(&mut spheres, &mut pairs, &bodies);
        for round in 0..4 {
            pairs.follow(&mut spheres, &bodies, 1.0 / 960.0);
            compare(
                &pairs,
                &spheres,
                &bodies,
                &format!("tick {tick}, round {round}"),
            );
            spheres.set_close(pairs.list.iter().flat_map(|pair| pair.spheres));
            let count = 1 + below(12);
            let sides = (0..count).map(|_| {
                let mut at = [0; 3];
                (0..D::N).for_each(|axis| at[axis] = below(n + 1) as i32);
                (at, 1 + below((1 << D::CORNERS) - 2) as u8)
            });
            let body = bodies.at_mut(BALL);
            let torn = body.tear(&sides.collect::<Vec<_>>());
            spheres.tear(BALL, body, &torn, &mut pairs.changed);
            let mut kept = spheres.list.clone();
            kept.sort_by_key(ContactSphere::key);
            let mut anew = Spheres::default();
            anew.start_tick(&bodies, &mut Vec::new());
            assert_eq!(kept, anew.list);
            assert_eq!(crack_face_pairs(&spheres), crack_face_pairs(&anew));
            let mut rebuilt = bodies.clone();
            rebuilt.at_mut(BALL).rebuild();
            let mut anew = Spheres::default();
            anew.start_tick(&rebuilt, &mut Vec::new());
            assert_eq!(kept, anew.list, "updated and rebuilt spheres differ");
        }
        for (b, second) in spheres.list.entries() {
            for first in spheres.list.iter().take(b.index()) {
                let both = [first, second];
                let [own, other] = both.map(ContactSphere::site);
                let axes = own.voxel.iter().zip(other.voxel);
                let apart = axes.map(|(own, other)| own.abs_diff(other)).max();
                let [first, second] = both.map(|sphere| &sphere.nodes[..D::CORNERS]);
                let shares = first.iter().any(|node| second.contains(node));
                if apart.is_some_and(|apart| apart <= 1) {
                    assert_eq!(own.is_held_to(&other), shares);
                }
                assert_eq!(own.is_held_to(&other), other.is_held_to(&own));
            }
        }
    }
    assert!(bodies.at(BALL).pieces().list.len() > 10);
}

#[test]
fn spheres_and_crack_faces_match_a_rebuild_after_each_tear() {
    check_tears::<Dim2>(14);
    check_tears::<Dim3>(8);
}
