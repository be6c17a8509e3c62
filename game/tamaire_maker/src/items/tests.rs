use super::*;
use crate::draft::Draft;
use crate::palette::crayon;
use fuwafuwa::{Dim, Dim2, Dim3, DimVector, Layers, Rotation, World};
use fuwafuwa_scenes::scene::{BodyText, Form, WishText};
use std::f32::consts::{FRAC_PI_2, PI};
use std::sync::Arc;
use tamaire_play::level::built_in;
use tamaire_play::playground::Stuff;
use tamaire_play::{AnyRound, InputFrame, Joints, Level};

/// Text of a built-in level, the scene that was read from it, and that with embedded files.
pub(crate) fn start_of(id: &str) -> (&'static str, Scene, Scene) {
    let (_, text) = built_in().find(|(known, _)| *known == id).unwrap();
    let embedded = Level::open(id).unwrap().scene().clone();
    (text, Scene::read(id, text, &[]).unwrap(), embedded)
}

fn starts() -> Vec<(&'static str, Scene)> {
    let all = built_in();
    all.map(|(id, _)| (id, Level::open(id).unwrap().scene().clone()))
        .collect()
}

/// Scene whose bodies have few voxels, so that it is built fast.
pub(crate) fn small(scene: &Scene) -> Scene {
    let mut small = scene.clone();
    let most = if scene.dim == 2 { 20 } else { 10 };
    for body in &mut small.body {
        body.diced = None;
        if body.file.is_some() {
            *body = BodyText {
                shape: Some(Form::Ball),
                n: Some(most),
                width: body.width,
                at: body.at,
                rotation_vector: body.rotation_vector,
                ..BodyText::default()
            };
        }
        body.n = body.n.map(|n| n.min(most));
    }
    small
}

pub(crate) fn kind(random: &mut fastrand::Rng) -> Kind {
    let forms = [
        Form::Ball,
        Form::Box,
        Form::Ring,
        Form::Heart,
        Form::Flower,
        Form::Empty,
    ];
    match *random.choice(&Kind::ALL).unwrap() {
        Kind::Body(..) => {
            let form = *random.choice(&forms).unwrap();
            Kind::Body(form, *random.choice(&Stuff::ALL).unwrap())
        }
        kind => kind,
    }
}

fn vector(random: &mut fastrand::Rng, size: f32) -> Vec3 {
    Vec3::from([0; 3].map(|_| (random.f32() - 0.5) * 2.0 * size))
}

/// Makes a random change, and returns its description.
pub(crate) fn edit(scene: &mut Scene, random: &mut fastrand::Rng, clip: &mut Clip) -> String {
    let all = items(scene);
    let count = if random.u8(..8) == 0 {
        all.len()
    } else {
        random.usize(1..5)
    };
    let mut chosen: Vec<Item> = (0..count).map(|_| *random.choice(&all).unwrap()).collect();
    if count == all.len() {
        chosen = all;
    }
    let at = vector(random, 1.5);
    match random.u8(..9) {
        0 | 1 => {
            let size = if random.u8(..10) == 0 { 100.0 } else { 0.3 };
            let by = vector(random, size);
            translate(scene, &chosen, by);
            format!("translate {chosen:?} by {by}")
        }
        2 => {
            let size: f32 = if random.u8(..6) == 0 { 30.0 } else { 2.0 };
            let mut factors = Vec3::from([0; 3].map(|_| size.powf(random.f32() * 2.0 - 1.0)));
            if random.bool() {
                factors = Vec3::new(factors.x, 1.0, 1.0);
            }
            stretch(scene, &chosen, at, factors);
            format!("stretch {chosen:?} about {at} by {factors}")
        }
        3 | 4 => {
            let quarters = random.u8(..5) as f32 * FRAC_PI_2;
            let angle = if random.bool() {
                quarters
            } else {
                random.f32() * 7.0 - 3.5
            };
            let any = vector(random, 1.0);
            let axis = *random.choice(&[Vec3::X, Vec3::Y, Vec3::Z, any]).unwrap();
            rotate(scene, &chosen, at, axis, angle);
            format!("rotate {chosen:?} about {at}, {axis} by {angle}")
        }
        5 => {
            remove(scene, &chosen);
            format!("remove {chosen:?}")
        }
        6 => {
            *clip = copy(scene, &chosen);
            paste(scene, clip, vector(random, 0.3));
            format!("copy and paste {chosen:?}")
        }
        7 => {
            let own = clip.clone();
            paste(scene, &own, vector(random, 0.5));
            "paste".into()
        }
        _ => {
            let kind = kind(random);
            add(scene, kind, at);
            format!("add {kind:?} at {at}")
        }
    }
}

/// Whether a level may become unplayable for this reason.
fn is_excepted(reason: &str) -> bool {
    let known = [
        "bodies in the view",
        "solid voxels at most",
        "voxels at most, solid or empty",
        "letters",
    ];
    known.iter().any(|part| reason.contains(part))
}

#[test]
fn edits_keep_levels_playable() {
    let starts: Vec<_> = starts()
        .into_iter()
        .map(|(id, scene)| (id, small(&scene)))
        .collect();
    let mut random = fastrand::Rng::with_seed(7);
    let mut checks = 0;
    for round in 0..1000 {
        let (id, start) = random.choice(&starts).unwrap();
        let (mut scene, mut clip) = (start.clone(), Clip::default());
        let mut edits = Vec::new();
        for _ in 0..random.usize(1..13) {
            let before = scene.clone();
            edits.push(edit(&mut scene, &mut random, &mut clip));
            if random.u8(..2) > 0 {
                continue;
            }
            checks += 1;
            let Err(error) = Level::from_scene(id, small(&scene)) else {
                continue;
            };
            let error = error.to_string();
            if !is_excepted(&error) {
                let was_good = Level::from_scene(id, small(&before)).is_ok();
                panic!("{round}, {id}: {error} (before: {was_good})\n{edits:#?}");
            }
            break;
        }
    }
    assert!(checks > 1500, "{checks} checks");
}

#[test]
fn hostile_numbers_and_items_change_nothing_or_stay_in_range() {
    let odd = [
        f32::NAN,
        f32::INFINITY,
        f32::NEG_INFINITY,
        f32::MAX,
        f32::MIN_POSITIVE,
        -0.0,
        -1e30,
        1e10,
    ];
    let mut random = fastrand::Rng::with_seed(1);
    for (id, start) in starts().into_iter().step_by(4) {
        let start = small(&start);
        let mut chosen = items(&start);
        chosen.extend([
            Item::Body(999),
            Item::Joint(usize::MAX),
            Item::Basket(7),
            Item::Hand(99),
        ]);
        for _ in 0..12 {
            let mut number = || *random.choice(&odd).unwrap();
            let mut any = || Vec3::new(number(), number(), number());
            let mut scene = start.clone();
            let [a, b, c] = [any(), any(), any()];
            translate(&mut scene, &chosen, a);
            stretch(&mut scene, &chosen, a, b);
            let chosen = rotate(&mut scene, &chosen, c, a, b.x);
            let clip = copy(&scene, &chosen);
            paste(&mut scene, &clip, b);
            for kind in Kind::ALL {
                add(&mut scene, kind, a);
            }
            snapped(a, b.x);
            aligned(&scene, &chosen, a, b.x);
            let places = items(&scene)
                .into_iter()
                .filter_map(|item| bounds(&scene, item));
            for [low, high] in places {
                assert!(low.is_finite() && high.is_finite() && low.abs().max_element() < 2000.0);
            }
            if let Err(error) = Level::from_scene(id, scene) {
                assert!(is_excepted(&error.to_string()), "{id}: {error}");
            }
        }
    }
}

fn hull(places: impl Iterator<Item = Vec3>) -> [Vec3; 2] {
    let boxes = places.map(|place| [place, place]);
    boxes
        .reduce(|[low, high], [place, _]| [low.min(place), high.max(place)])
        .unwrap()
}

fn nodes_of<D: Dim>(world: &World<D>) -> Vec<Vec<Vec3>> {
    let bodies = world.soft_bodies();
    let nodes = bodies.map(|(_, body)| {
        let nodes = body.mesh().nodes();
        nodes
            .map(|(id, _)| body.node_state(id).0.to_vec3())
            .collect()
    });
    nodes.collect()
}

/// Boxes around the rigid bodies of a world, as the engine has them.
fn rigid_boxes<D: Dim>(world: &World<D>) -> Vec<[Vec3; 2]> {
    let bodies = world.rigid_bodies();
    bodies
        .map(|(_, body)| body.shape().bounds().map(DimVector::to_vec3))
        .collect()
}

fn check_bounds<D: Dim>(id: &str, scene: &Scene) {
    let world = scene.build::<D>().unwrap();
    for (index, nodes) in nodes_of(&world).into_iter().enumerate() {
        let [low, high] = bounds(scene, Item::Body(index)).unwrap();
        let [inner_low, inner_high] = hull(nodes.into_iter());
        let text = &scene.body[index];
        let voxel = super::bounds::grid_size(scene, text).voxel;
        assert!(
            (low - voxel).cmple(inner_low).all() && (high + voxel).cmpge(inner_high).all(),
            "{id}"
        );
        if text.shape == Some(Form::Box) && text.part.is_empty() {
            let apart = (low - inner_low).abs().max((high - inner_high).abs());
            assert!(apart.max_element() < 1e-4, "{id}, body {index}: {apart}");
        }
    }
    let lists = (0..scene.obstacle.len()).map(Item::Obstacle);
    let lists = lists.chain((0..scene.hand.len()).map(Item::Hand));
    let lists = lists.chain((0..scene.rigid_body.len()).map(Item::RigidBody));
    for (item, [low, high]) in lists.zip(rigid_boxes(&world)) {
        match bounds(scene, item) {
            None => assert!(
                !low.is_finite() || low.abs().max_element() > 1e30,
                "{id}, {item:?}"
            ),
            Some([own_low, own_high]) => {
                let apart = (low - own_low).abs().max((high - own_high).abs());
                assert!(apart.max_element() < 1e-4, "{id}, {item:?}: {apart}");
            }
        }
    }
}

#[test]
fn bounds_are_those_of_the_built_world() {
    for (id, scene) in starts() {
        let mut scene = if id == "cat" { scene } else { small(&scene) };
        // Rotated bodies have larger boxes.
        for _ in 0..2 {
            match scene.dim {
                2 => check_bounds::<Dim2>(id, &scene),
                _ => check_bounds::<Dim3>(id, &scene),
            }
            let all = items(&scene);
            rotate(&mut scene, &all, Vec3::ZERO, Vec3::new(1.0, 2.0, 3.0), 0.4);
        }
    }
}

fn check_motion<D: Dim>(id: &str, before: &Scene, after: &Scene, map: &dyn Fn(Vec3) -> Vec3) {
    let worlds = [before, after].map(|scene| scene.build::<D>().unwrap());
    let [old, new] = worlds.each_ref().map(nodes_of);
    for (index, (old, new)) in old.into_iter().zip(new).enumerate() {
        assert_eq!(old.len(), new.len(), "{id}, body {index}");
        for (old, new) in old.into_iter().zip(new) {
            let apart = map(old).distance(new);
            assert!(apart < 1e-4, "{id}, body {index}: {old} became {new}");
        }
    }
    let [old, new] = worlds.each_ref().map(|world| {
        let joints = world
            .joints()
            .map(|(joint, _)| world.joint_anchor_positions(joint));
        joints
            .map(|found| found.unwrap().unwrap().map(DimVector::to_vec3))
            .collect::<Vec<_>>()
    });
    for (old, new) in old.into_iter().flatten().zip(new.into_iter().flatten()) {
        // An anchor holds the nodes within a radius. A node at this radius may be held only before or only after.
        let apart = map(old).distance(new);
        assert!(apart < 0.03, "{id}, joint: {old} became {new}");
    }
}

#[test]
fn motions_move_every_node_of_the_built_world() {
    for (id, scene) in starts() {
        let start = small(&scene);
        let all = items(&start);
        let check = |after: &Scene, map: &dyn Fn(Vec3) -> Vec3| match start.dim {
            2 => check_motion::<Dim2>(id, &start, after, map),
            _ => check_motion::<Dim3>(id, &start, after, map),
        };
        let by = flat(start.dim, Vec3::new(0.125, -0.25, 0.05));
        let mut moved = start.clone();
        translate(&mut moved, &all, by);
        check(&moved, &|place| place + by);

        let about = Vec3::new(0.1, 0.2, 0.0);
        let axis = if start.dim == 2 {
            Vec3::Z
        } else {
            Vec3::new(1.0, -2.0, 0.5)
        };
        let mut turned = start.clone();
        rotate(&mut turned, &all, about, axis, 0.7);
        let rotation = Rotation::about(axis, 0.7);
        check(&turned, &|place| about + rotation.apply(place - about));

        let mut stretched = start.clone();
        let factors = if start.dim == 2 {
            Vec3::new(1.25, 1.25, 1.0)
        } else {
            Vec3::splat(1.25)
        };
        stretch(&mut stretched, &all, about, factors);
        check(&stretched, &|place| about + (place - about) * factors);
    }
}

#[test]
fn translation_and_its_inverse_restore_the_level() {
    for (id, start) in starts() {
        let mut scene = start.clone();
        for item in items(&start) {
            translate(&mut scene, &[item], Vec3::new(0.25, 0.125, 0.0));
            let was_moved = scene != start;
            translate(&mut scene, &[item], Vec3::new(-0.25, -0.125, 0.0));
            let bounds_of = |scene: &Scene| bounds(scene, item);
            if let (Some(old), Some(new)) = (bounds_of(&start), bounds_of(&scene)) {
                let apart = old[0].distance(new[0]) + old[1].distance(new[1]);
                assert!(
                    apart < 1e-4 && was_moved || matches!(item, Item::Joint(_)),
                    "{id}, {item:?}"
                );
            }
        }
        // All numbers of these levels have few digits.
        let all = items(&start);
        translate(&mut scene, &all, Vec3::ZERO);
        let texts = [&scene, &start].map(|scene| toml::to_string(scene).unwrap());
        let differing = texts[0]
            .lines()
            .zip(texts[1].lines())
            .filter(|(a, b)| a != b)
            .count();
        assert!(differing <= 4, "{id}: {differing} lines differ");
    }
}

#[test]
fn four_quarter_turns_restore_the_boxes_of_a_level() {
    for (id, start) in starts() {
        let mut scene = start.clone();
        let all = items(&start);
        for quarter in 0..4 {
            let same = rotate(&mut scene, &all, Vec3::ZERO, Vec3::Z, FRAC_PI_2);
            assert_eq!(same, all, "{id}, {quarter}");
        }
        for item in all {
            let [old, new] = [&start, &scene].map(|scene| bounds(scene, item));
            assert_eq!(old.is_some(), new.is_some(), "{id}, {item:?}");
            if let (Some(old), Some(new)) = (old, new) {
                let apart = old[0].distance(new[0]) + old[1].distance(new[1]);
                assert!(apart < 1e-3, "{id}, {item:?}: {old:?} became {new:?}");
            }
        }
    }
}

#[test]
fn leaning_box_becomes_a_rigid_body_that_keeps_its_joints() {
    let mut scene = start_of("ducklings").2;
    let named = scene.joint[0].anchors[1].obstacle.unwrap();
    assert_eq!(scene.joint[0].anchors[1].obstacle, Some(5));
    let chosen = [Item::Obstacle(4), Item::Obstacle(0), Item::Hand(0)];
    let (rigid, obstacles) = (scene.rigid_body.len(), scene.obstacle.len());
    let half = scene.obstacle[named - 1].boxed.clone().unwrap().half;
    let new = rotate(&mut scene, &chosen, Vec3::ZERO, Vec3::Y, 0.3);
    assert_eq!(
        new,
        [
            Item::RigidBody(rigid + 1),
            Item::RigidBody(rigid),
            Item::Hand(0)
        ]
    );
    assert_eq!(scene.obstacle.len(), obstacles - 2);
    let anchor = &scene.joint[0].anchors[1];
    assert_eq!(
        (anchor.obstacle, anchor.rigid_body),
        (None, Some(rigid + 2))
    );
    assert_eq!(
        scene.rigid_body[rigid + 1].boxed.as_ref().unwrap().half,
        half
    );
    assert_eq!(
        scene.rigid_body[rigid + 1].rotation_vector,
        Some([0.0, 0.3, 0.0])
    );
    Level::from_scene("ducklings", small(&scene)).unwrap();
}

#[test]
fn moved_hand_takes_its_parts_knives_and_the_hint_along() {
    let mut scene = start_of("cake").2;
    let (edge, hint) = (
        scene.knife[0].edge,
        scene.game.as_ref().unwrap().hint.clone(),
    );
    let by = Vec3::new(0.1, 0.1, 0.0);
    translate(&mut scene, &[Item::Hand(0), Item::Knife(0)], by);
    for (old, new) in edge.into_iter().zip(scene.knife[0].edge) {
        assert!(
            (Vec3::from(old) + by).distance(Vec3::from(new)) < 1e-5,
            "it moves once"
        );
    }
    let moved = &scene.game.as_ref().unwrap().hint;
    assert!((moved[0][1] - hint[0][1] - 0.1).abs() < 1e-5 && moved[1..] == hint[1..]);
    let mut scene = start_of("spoon-race").2;
    let before = scene.hand.clone();
    translate(&mut scene, &[Item::Hand(0)], by);
    for (index, (old, new)) in before.iter().zip(&scene.hand).enumerate() {
        let moves = index == 0 || old.follows == Some(1);
        let apart = Vec3::from(new.target(0.0)).distance(Vec3::from(old.target(0.0)));
        assert_eq!(apart > 0.05, moves, "{old:?}");
    }
}

/// Texts of the things that a joint or a knife holds to, which tell whether its numbers are right after others change.
fn held_by(scene: &Scene, item: Item) -> Vec<String> {
    let text_of = |holder: Option<Item>| match holder {
        None => "a point".to_owned(),
        Some(Item::Body(index)) => format!("{:?}", scene.body[index]),
        Some(Item::Obstacle(index)) => {
            let text = &scene.obstacle[index];
            format!("{:?} {:?} {:?}", text.boxed, text.capsule, text.ball)
        }
        Some(Item::Hand(index)) => format!("{:?}", scene.hand[index].path),
        Some(Item::RigidBody(index)) => format!("{:?}", scene.rigid_body[index]),
        Some(item) => panic!("{item:?} holds nothing"),
    };
    match item {
        Item::Joint(index) => scene.joint[index]
            .anchors
            .iter()
            .map(|anchor| text_of(holder_of_anchor(anchor)))
            .collect(),
        Item::Knife(index) => vec![text_of(holder_of_knife(&scene.knife[index]))],
        _ => Vec::new(),
    }
}

#[test]
fn removal_keeps_what_all_numbers_name() {
    let mut random = fastrand::Rng::with_seed(2);
    for (id, start) in starts() {
        for _ in 0..20 {
            let mut scene = start.clone();
            let all = items(&start);
            let chosen: Vec<Item> = (0..3).map(|_| *random.choice(&all).unwrap()).collect();
            let Removed {
                removed, refused, ..
            } = remove(&mut scene, &chosen);
            assert!(
                chosen
                    .iter()
                    .all(|item| removed.contains(item) || refused.contains(item))
            );
            assert_eq!(items(&scene).len(), all.len() - removed.len(), "{id}");
            let ties = |scene: &Scene| -> Vec<Vec<String>> {
                let all = items(scene).into_iter();
                all.map(|item| held_by(scene, item))
                    .filter(|held| !held.is_empty())
                    .collect()
            };
            let left = all.iter().filter(|item| !removed.contains(item));
            let expected = left
                .map(|item| held_by(&start, *item))
                .filter(|held| !held.is_empty());
            assert_eq!(
                ties(&scene),
                expected.collect::<Vec<_>>(),
                "{id}, {chosen:?}"
            );
            check_switches_and_bodies(id, &start, &scene, &removed);
        }
    }
}

/// Checks that switches and rules name what they named before.
fn check_switches_and_bodies(id: &str, start: &Scene, scene: &Scene, removed: &[Item]) {
    let switch = |scene: &Scene, number: Option<usize>| {
        number.map(|number| {
            let text = &scene.switch[number - 1];
            (text.boxed.clone(), text.ball.clone())
        })
    };
    let obstacles =
        (0..start.obstacle.len()).filter(|index| !removed.contains(&Item::Obstacle(*index)));
    for (old, new) in obstacles.zip(&scene.obstacle) {
        let old = &start.obstacle[old];
        let stays = old
            .switch
            .filter(|number| !removed.contains(&Item::Switch(number - 1)));
        assert_eq!(switch(start, stays), switch(scene, new.switch), "{id}");
    }
    let named = |scene: &Scene, numbers: &[usize]| -> Vec<BodyText> {
        numbers
            .iter()
            .map(|number| scene.body[number - 1].clone())
            .collect()
    };
    let [old, new] = [start, scene].map(|scene| scene.game.as_ref().unwrap());
    let kept = |numbers: &[usize]| -> Vec<usize> {
        let numbers = numbers.iter().copied();
        numbers
            .filter(|number| !removed.contains(&Item::Body(number - 1)))
            .collect()
    };
    assert_eq!(
        named(start, &kept(&old.bodies)),
        named(scene, &new.bodies),
        "{id}"
    );
    let pairs = [(&old.require, &new.require)];
    for (old, new) in pairs {
        if let (Some(old), Some(new)) = (old, new) {
            assert_eq!(
                named(start, &kept(&old.whole)),
                named(scene, &new.whole),
                "{id}"
            );
        }
    }
}

#[test]
fn removal_refuses_the_last_body_and_hand_and_drops_impossible_goals() {
    for (id, start) in starts() {
        let mut scene = start.clone();
        let result = remove(&mut scene, &items(&start));
        assert_eq!(result.refused, [Item::Body(0), Item::Hand(0)], "{id}");
        assert_eq!(
            (scene.body.len(), scene.joint.len(), scene.obstacle.len()),
            (1, 0, 0),
            "{id}"
        );
        Level::from_scene(id, small(&scene)).unwrap();
        let old = start.game.as_ref().unwrap();
        let about_joints = old.wish.iter().filter(|wish| wish.joints.is_some());
        for wish in about_joints {
            assert!(
                result.dropped.contains(&Dropped::Goal(wish.clone())),
                "{id}: {wish:?}"
            );
        }
        assert_eq!(
            !old.routes.is_empty(),
            result
                .dropped
                .contains(&Dropped::Routes(old.routes.clone())),
            "{id}"
        );
    }
}

#[test]
fn removal_reports_lists_of_counted_bodies_that_become_empty() {
    let mut scene = Draft::blank(2).scene().clone();
    for kind in [Kind::ALL[0], Kind::Basket, Kind::Basket, Kind::Button] {
        add(&mut scene, kind, Vec3::ZERO);
    }
    let game = scene.game.as_mut().unwrap();
    game.bodies = vec![2];
    game.baskets[0].bodies = vec![1, 2];
    game.baskets[1].bodies = vec![2];
    scene.switch[0].bodies = vec![2];
    let others = remove(&mut scene.clone(), &[Item::Body(0)]);
    assert_eq!(others.dropped, []);
    let without_switch = remove(&mut scene.clone(), &[Item::Body(1), Item::Switch(0)]);
    let [level, basket, switch] =
        [None, Some(Item::Basket(1)), Some(Item::Switch(0))].map(Dropped::Counted);
    assert_eq!(without_switch.dropped, [level.clone(), basket.clone()]);
    let all = remove(&mut scene, &[Item::Body(1)]);
    assert_eq!(all.dropped, [level, basket, switch]);
    assert!(scene.switch[0].bodies.is_empty());
}

#[test]
fn goals_that_cannot_hold_are_not_possible() {
    let scene = start_of("classic").2;
    let of = |change: fn(&mut WishText)| {
        let mut wish = WishText::default();
        change(&mut wish);
        is_possible(&scene, &wish)
    };
    assert!(of(|wish| wish.pieces = Some(2)) && of(|wish| wish.whole = vec![1]));
    assert!(!of(|_| {}) && !of(|wish| wish.joints = Some(Joints::Whole)));
    assert!(!of(|wish| wish.kept = Some(2.0)) && !of(|wish| wish.whole = vec![1, 1]));
}

#[test]
fn removal_of_a_switch_brings_its_obstacles_to_rest() {
    let mut scene = start_of("dumbwaiter").2;
    let lift = scene
        .obstacle
        .iter()
        .position(|text| text.switch.is_some())
        .unwrap();
    remove(&mut scene, &[Item::Switch(0)]);
    assert!(!scene.obstacle[lift].moves() && scene.obstacle[lift].switch.is_none());
    Level::from_scene("dumbwaiter", small(&scene)).unwrap();
}

#[test]
fn pasted_items_are_the_copied_ones_and_hold_to_each_other() {
    for (id, start) in starts() {
        let all = items(&start);
        let clip = copy(&start, &all);
        let mut scene = start.clone();
        let by = flat(start.dim, Vec3::new(0.0625, 0.03125, 0.0));
        let new = paste(&mut scene, &clip, by);
        for item in &new {
            assert!(
                !all.contains(item) || matches!(item, Item::Basket(_)),
                "{id}, {item:?}"
            );
        }
        assert_eq!(
            scene.material, start.material,
            "{id}: materials are used again"
        );
        let leaders = |scene: &Scene| {
            scene
                .hand
                .iter()
                .filter(|hand| hand.follows.is_none())
                .count()
        };
        assert!(leaders(&scene) <= 2, "{id}");
        for (index, joint) in scene.joint.iter().enumerate().skip(start.joint.len()) {
            for anchor in &joint.anchors {
                let holder = holder_of_anchor(anchor);
                assert!(
                    holder.is_none_or(|holder| new.contains(&holder)),
                    "{id}, joint {index}"
                );
            }
        }
        for (copied, original) in scene.body[start.body.len()..].iter().zip(&start.body) {
            let moved = Vec3::from(original.at) + by;
            assert!(moved.distance(Vec3::from(copied.at)) < 2e-5, "{id}");
            assert_eq!(
                BodyText {
                    at: original.at,
                    ..copied.clone()
                },
                *original,
                "{id}"
            );
        }
        if let Err(error) = Level::from_scene(id, small(&scene)) {
            assert!(is_excepted(&error.to_string()), "{id}: {error}");
        }
    }
}

#[test]
fn pasted_bodies_keep_their_materials_in_another_level() {
    let starts = starts();
    for (id, from) in &starts {
        let bodies: Vec<Item> = (0..from.body.len()).map(Item::Body).collect();
        let clip = copy(from, &bodies);
        for (other, to) in starts
            .iter()
            .filter(|(_, to)| to.dim == from.dim)
            .step_by(5)
        {
            let mut scene = to.clone();
            let new = paste(&mut scene, &clip, Vec3::ZERO);
            let made = new.iter().filter(|item| matches!(item, Item::Body(_)));
            assert_eq!(made.count(), bodies.len(), "{id} into {other}");
            for (copied, original) in scene.body[to.body.len()..].iter().zip(&from.body) {
                let material = |scene: &Scene, body: &BodyText| {
                    let number = body.material.unwrap_or(1);
                    scene.material[usize::from(number) - 1].clone()
                };
                if original.shape.is_some_and(|form| form != Form::Empty) {
                    assert_eq!(
                        material(&scene, copied),
                        material(from, original),
                        "{id} into {other}"
                    );
                }
                for (new, old) in copied.part.iter().zip(&original.part) {
                    let number =
                        |fill: Option<u8>, paint: Option<u8>| usize::from(fill.or(paint).unwrap());
                    let [new, old] = [number(new.fill, new.paint), number(old.fill, old.paint)];
                    assert_eq!(new == 0, old == 0);
                    if old > 0 {
                        assert_eq!(
                            scene.material[new - 1],
                            from.material[old - 1],
                            "{id} into {other}"
                        );
                    }
                }
            }
        }
        let other_dim = starts.iter().find(|(_, to)| to.dim != from.dim).unwrap();
        assert_eq!(paste(&mut other_dim.1.clone(), &clip, Vec3::ZERO), []);
    }
}

#[test]
fn pasted_model_has_its_materials_in_a_level_with_others() {
    let (_, _, from) = start_of("pudding");
    let (_, _, mut to) = start_of("sandbox-3d");
    let before = to.body.len();
    paste(&mut to, &copy(&from, &[Item::Body(0)]), Vec3::ZERO);
    let tint_free = |scene: &Scene, index: usize| {
        let mut alone = scene.clone();
        alone.body = vec![scene.body[index].clone()];
        let world = alone.build::<Dim3>().unwrap();
        let grid = world.soft_bodies().next().unwrap().1.grid().clone();
        let voxels = grid.voxels().map(|voxel| grid.material(voxel));
        let voxels = voxels.map(|number| match number {
            0 => None,
            _ => Some(scene.material[usize::from(number) - 1].clone()),
        });
        voxels.collect::<Vec<_>>()
    };
    assert!(tint_free(&from, 0) == tint_free(&to, before));
}

#[test]
fn everything_can_be_added_to_every_level() {
    let mut random = fastrand::Rng::with_seed(4);
    for (id, start) in starts() {
        let start = small(&start);
        let mut scene = start.clone();
        for kind in Kind::ALL {
            let old = items(&scene);
            let at = vector(&mut random, 1.0);
            let before = scene.clone();
            let new = add(&mut scene, kind, at);
            assert!(new.iter().all(|item| item.is_in(&scene)), "{id}, {kind:?}");
            if new.is_empty() {
                assert!(
                    kind == Kind::SecondHand && scene == before,
                    "{id}, {kind:?}"
                );
            }
            assert_eq!(items(&scene).len(), old.len() + new.len(), "{id}, {kind:?}");
        }
        let checked = Level::from_scene(id, small(&scene));
        assert!(
            checked.as_ref().is_ok_and(Level::has_basket),
            "{id}: {:?}",
            checked.err()
        );
    }
}

/// Returns the boxes that the rigid bodies of a level without a moved hand have in a round of 4 s.
fn boxes_in_a_round(scene: &Scene) -> Vec<Vec<[Vec3; 2]>> {
    let level = Level::from_scene("round", scene.clone()).unwrap();
    let mut round = AnyRound::new(Arc::new(level));
    let boxes = (0..240).map(|_| {
        round.step(InputFrame::default());
        match &round {
            AnyRound::Plane(round) => rigid_boxes(round.world()),
            AnyRound::Space(round) => rigid_boxes(round.world()),
        }
    });
    boxes.collect()
}

#[test]
fn added_things_that_move_stay_inside_the_walls() {
    for (dim, corner) in [(2, [1.6, 1.0, 0.0]), (3, [1.6, 1.0, 1.0])] {
        let blank = Draft::blank(dim);
        for kind in [Kind::Lift, Kind::Paddle, Kind::Knife, Kind::Saw, Kind::Door] {
            for side in [-1.0, 1.0] {
                let mut scene = blank.scene().clone();
                scene.body[0].n = Some(6);
                let new = add(&mut scene, kind, side * Vec3::from(corner));
                let Some(&Item::Obstacle(index)) =
                    new.iter().find(|item| matches!(item, Item::Obstacle(_)))
                else {
                    panic!("{kind:?}: {new:?}");
                };
                // A door moves only while its button is pressed.
                scene.obstacle[index].switch = None;
                let [from, to] = scene.view.map(Vec3::from);
                let axes = if dim == 2 {
                    Vec3::new(1.0, 1.0, 0.0)
                } else {
                    Vec3::ONE
                };
                for boxes in boxes_in_a_round(&scene) {
                    let [low, high] = boxes[index];
                    let beyond = (from - low).max(high - to) * axes;
                    assert!(beyond.max_element() < 1e-3, "{kind:?} in {dim}D: {beyond}");
                }
            }
        }
    }
}

#[test]
fn new_body_has_a_crayon_that_a_new_level_has() {
    for dim in [2, 3] {
        for stuff in Stuff::ALL {
            let mut scene = Draft::blank(dim).scene().clone();
            let materials = scene.material.clone();
            add(&mut scene, Kind::Body(Form::Heart, stuff), Vec3::ZERO);
            assert_eq!(scene.material, materials);
            let number = scene.body.last().unwrap().material.unwrap_or(1);
            assert_eq!(materials[usize::from(number) - 1], crayon(stuff));
        }
    }
}

#[test]
fn obstacle_stops_what_it_was_set_to() {
    for dim in [2, 3] {
        let mut scene = Draft::blank(dim).scene().clone();
        add(&mut scene, Kind::Fork, Vec3::ZERO);
        add(&mut scene, Kind::Wall, Vec3::ZERO);
        let wall = scene.obstacle.len() - 1;
        let stopped = |scene: &Scene, obstacle: usize| {
            let text = scene.obstacle[obstacle].layers;
            let own: Layers = text.map(Into::into).unwrap_or_default();
            let mut hands = scene.hand.iter();
            let hands = hands.all(|hand| own.meet(hand.layers.map(Into::into).unwrap_or_default()));
            [hands, own.meet(Layers::default())]
        };
        for (stops, expected) in [
            (Stops::All, [true; 2]),
            (Stops::Hands, [true, false]),
            (Stops::Bodies, [false, true]),
            (Stops::All, [true; 2]),
        ] {
            set_stops(&mut scene, wall, stops);
            assert_eq!(stops_of(&scene, wall), Some(stops));
            assert_eq!(stopped(&scene, wall), expected, "{stops:?}");
            assert_eq!(stopped(&scene, 0), [true; 2], "the floor stops all");
            Level::from_scene("new", scene.clone()).unwrap();
        }
        assert_eq!(scene.obstacle[wall].layers, None);
        let before = scene.clone();
        set_stops(&mut scene, 99, Stops::Hands);
        assert!(scene == before && stops_of(&scene, 99).is_none());
        for (kind, stops) in [(Kind::Glass, Stops::Hands), (Kind::Curtain, Stops::Bodies)] {
            add(&mut scene, kind, Vec3::ZERO);
            assert_eq!(stops_of(&scene, scene.obstacle.len() - 1), Some(stops));
        }
        scene.obstacle[wall].layers = scene.hand[0].layers;
        assert_eq!(stops_of(&scene, wall), None);
    }
}

#[test]
fn body_with_a_missing_material_has_its_size_once_the_material_is_there() {
    let mut scene = start_of("pudding").2;
    let expected = bounds(&scene, Item::Body(0)).unwrap();
    let materials = std::mem::take(&mut scene.material);
    // Under another name, the body was not built yet.
    scene.body[0].file = Some("other".into());
    assert_ne!(bounds(&scene, Item::Body(0)), Some(expected));
    scene.material = materials;
    assert_eq!(bounds(&scene, Item::Body(0)), Some(expected));
}

#[test]
fn snapped_positions_are_multiples_of_the_grid() {
    let place = Vec3::new(0.124, -0.377, 3.0);
    assert_eq!(snapped(place, 0.05), Vec3::new(0.1, -0.4, 3.0));
    assert_eq!(snapped(place, 0.0), place);
    assert_eq!(snapped(place, f32::NAN), place);
}

#[test]
fn aligned_items_touch_lines_of_others() {
    let mut scene = start_of("classic").2;
    scene.body[0].width = 0.97;
    let [low, high] = bounds(&scene, Item::Body(0)).unwrap();
    // The floor is at −1, and the hands start at 0 and 0.7.
    let by = Vec3::new(0.0, -1.0 - low.y + 0.01, 0.0);
    let (moved, guides) = aligned(&scene, &[Item::Body(0)], by, 0.03);
    assert!((low.y + moved.y + 1.0).abs() < 1e-5, "{moved}");
    assert!(guides.contains(&Guide { axis: 1, at: -1.0 }), "{guides:?}");
    let (far, none) = aligned(&scene, &[Item::Body(0)], Vec3::new(0.0, 0.26, 0.0), 0.0001);
    assert_eq!(
        (far, none.iter().any(|guide| guide.axis == 1)),
        (Vec3::new(0.0, 0.26, 0.0), false)
    );
    assert!(high.x > low.x);
}

#[test]
fn angles_of_rotated_bodies_add_up() {
    let mut scene = start_of("classic").2;
    for _ in 0..7 {
        rotate(&mut scene, &[Item::Body(0)], Vec3::ZERO, Vec3::Z, 1.0);
    }
    let vector = scene.body[0].rotation_vector.unwrap();
    assert!((vector[2] - (7.0 - 2.0 * PI)).abs() < 1e-4 && vector[..2] == [0.0; 2]);
    rotate(&mut scene, &[Item::Body(0)], Vec3::ZERO, Vec3::NEG_Z, 7.0);
    assert_eq!(scene.body[0].rotation_vector, None);
    let mut scene = start_of("classic-3d").2;
    let (x, y) = (Vec3::X * 0.5, Vec3::Y * 0.7);
    rotate(&mut scene, &[Item::Body(0)], Vec3::ZERO, Vec3::X, 0.5);
    rotate(&mut scene, &[Item::Body(0)], Vec3::ZERO, Vec3::Y, 0.7);
    let vector = Vec3::from(scene.body[0].rotation_vector.unwrap());
    let made = Rotation::about(vector, vector.length());
    for axis in Vec3::AXES {
        let expected = Rotation::about(y, 0.7).apply(Rotation::about(x, 0.5).apply(axis));
        assert!(made.apply(axis).distance(expected) < 1e-5);
    }
}

/// Returns a blank level with a rope from its body to a place above it.
fn roped(dim: u8) -> Scene {
    let mut scene = Draft::blank(dim).scene().clone();
    let rope = add_to(&mut scene, Kind::Rope, Vec3::ZERO, Some(Item::Body(0)));
    assert_eq!(rope, [Item::Joint(0)]);
    scene
}

/// Returns the number of joints that are left after some ticks without a hand.
fn joints_after(scene: &Scene, ticks: usize) -> usize {
    let level = Level::from_scene("roped", scene.clone()).unwrap();
    let mut round = AnyRound::new(Arc::new(level));
    for _ in 0..ticks {
        round.step(InputFrame::default());
    }
    match round {
        AnyRound::Plane(round) => round.world().joints().count(),
        AnyRound::Space(round) => round.world().joints().count(),
    }
}

#[test]
fn rope_follows_what_is_moved_and_is_whole_in_the_round() {
    for dim in [2, 3] {
        let start = roped(dim);
        let length = |scene: &Scene| scene.joint[0].length.unwrap();
        let span = |scene: &Scene| super::movement::span(&scene.joint[0]);
        let slack = 0.07;
        let mut loose = start.clone();
        loose.joint[0].length = Some(span(&start) + slack);
        for item in [Item::Body(0), Item::Joint(0)] {
            for by in [Vec3::X * -0.4, Vec3::Y * 0.2, Vec3::X * 0.4] {
                let mut scene = start.clone();
                translate(&mut scene, &[item], by);
                assert!((length(&scene) - span(&scene)).abs() < 1e-4, "{item:?}");
                assert_eq!(joints_after(&scene, 30), 1, "{item:?} moved by {by}");
                let mut scene = loose.clone();
                translate(&mut scene, &[item], by);
                assert!((length(&scene) - span(&scene) - slack).abs() < 1e-4);
            }
        }
        let mut turned = start.clone();
        rotate(
            &mut turned,
            &[Item::Body(0)],
            Vec3::new(0.0, 0.3, 0.0),
            Vec3::Z,
            2.0,
        );
        assert!(length(&turned) > span(&turned) - 1e-4);
        assert_eq!(joints_after(&turned, 30), 1);
        let mut together = start.clone();
        translate(
            &mut together,
            &[Item::Body(0), Item::Joint(0)],
            Vec3::X * 0.2,
        );
        assert_eq!(length(&together), length(&start));
        // A rope that is too short becomes whole when it is moved.
        let mut short = start.clone();
        short.joint[0].length = Some(0.05);
        translate(&mut short, &[Item::Joint(0)], Vec3::X * 0.2);
        assert_eq!(joints_after(&short, 30), 1);
    }
}

#[test]
fn new_rope_is_tied_to_the_chosen_or_nearest_body_however_far() {
    for dim in [2, 3] {
        let mut scene = Draft::blank(dim).scene().clone();
        let other = add(&mut scene, Kind::ALL[0], Vec3::new(1.0, -0.3, 0.0));
        let board = add(&mut scene, Kind::Plank, Vec3::new(0.5, 0.4, 0.0));
        for (at, holder, expected) in [
            (Vec3::X * -3.9, None, Item::Body(0)),
            (Vec3::X * -3.9, Some(other[0]), other[0]),
            (Vec3::X * -3.9, Some(board[0]), board[0]),
            (Vec3::X * -3.9, Some(Item::Hand(0)), Item::Hand(0)),
            (Vec3::X * -3.9, Some(Item::Obstacle(0)), Item::Body(0)),
        ] {
            for kind in [Kind::Rope, Kind::Spring, Kind::Pin] {
                let mut scene = scene.clone();
                let made = add_to(&mut scene, kind, at, holder);
                assert_eq!(made, [Item::Joint(0)]);
                let joint = &scene.joint[0];
                let holders: Vec<Item> = { joint.anchors.iter() }
                    .filter_map(holder_of_anchor)
                    .collect();
                assert_eq!(holders, [expected], "{kind:?}");
                if kind != Kind::Pin {
                    let [end, tied] = [0, 1].map(|end| Vec3::from(joint.anchors[end].point));
                    assert!(
                        end.y > tied.y + 0.1,
                        "{kind:?} hangs from above: {end} {tied}"
                    );
                    assert_eq!(holder_at(&scene, end), None);
                }
                assert_eq!(joints_after(&scene, 10), 1, "{kind:?} on {expected:?}");
            }
        }
    }
}

#[test]
fn end_of_a_rope_is_tied_to_what_it_is_dropped_on() {
    let mut scene = roped(2);
    let paddle = add(&mut scene, Kind::Paddle, Vec3::new(0.8, 0.4, 0.0))[0];
    let bar = add(&mut scene, Kind::Bar, Vec3::new(-0.8, 0.5, 0.0))[0];
    let board = add(&mut scene, Kind::Plank, Vec3::new(0.8, -0.3, 0.0))[0];
    let middle = |item| {
        let [low, high] = bounds(&scene, item).unwrap();
        0.5 * (low + high)
    };
    let hand = Item::Hand(0);
    let places = [paddle, bar, board, hand, Item::Body(0)].map(|item| (Some(item), middle(item)));
    let nothing = (None, Vec3::new(0.0, 0.75, 0.0));
    for (holder, at) in places.into_iter().chain([nothing]) {
        let mut scene = scene.clone();
        assert!(tie_end(&mut scene, 0, 0, at), "{holder:?}");
        let anchor = &scene.joint[0].anchors[0];
        assert_eq!(holder_of_anchor(anchor), holder);
        assert_eq!(anchor.radius.is_some(), anchor.body.is_some());
        let joint = &scene.joint[0];
        let slack = joint.length.unwrap() - super::movement::span(joint);
        assert!(slack > -1e-4, "{holder:?}: {slack}");
        assert_eq!(joints_after(&scene, 10), 1, "{holder:?}");
    }
    // The room has walls.
    assert!(tie_end(&mut scene, 0, 0, Vec3::new(-30.0, 30.0, 0.0)));
    let [low, high] = scene.view.map(Vec3::from);
    let end = Vec3::from(scene.joint[0].anchors[0].point);
    assert!(end.cmpge(low).all() && end.cmple(high).all(), "{end}");
    // A rope that holds nothing is none, and neither is one that ties a board to itself.
    let before = scene.clone();
    assert!(!tie_end(&mut scene, 0, 1, nothing.1));
    assert_eq!(scene, before);
    let on_board = Vec3::new(0.8, -0.3, 0.0);
    assert!(tie_end(&mut scene, 0, 0, on_board));
    let before = scene.clone();
    assert!(!tie_end(&mut scene, 0, 1, on_board + Vec3::X * 0.1));
    assert_eq!(scene, before);
}

#[test]
fn rope_at_the_edge_of_a_body_is_as_long_as_it_seems() {
    fn real_span<D: Dim>(scene: &Scene) -> f32 {
        let world = scene.build::<D>().unwrap();
        let (joint, _) = world.joints().next().unwrap();
        let [from, to] = world.joint_anchor_positions(joint).unwrap().unwrap();
        from.to_vec3().distance(to.to_vec3())
    }
    for dim in [2, 3] {
        let mut scene = roped(dim);
        let [low, high] = bounds(&scene, Item::Body(0)).unwrap();
        let middle = 0.5 * (low + high);
        for edge in [low.x + 0.01, high.x - 0.01] {
            assert!(tie_end(&mut scene, 0, 1, middle.with_x(edge)));
            let real = match dim {
                2 => real_span::<Dim2>(&scene),
                _ => real_span::<Dim3>(&scene),
            };
            let length = scene.joint[0].length.unwrap();
            assert!((real - length).abs() < 3e-3, "{dim}D: {real} {length}");
        }
    }
}

#[test]
fn rope_is_tied_again_to_a_body_that_was_drawn_anew() {
    for dim in [2, 3] {
        let mut scene = roped(dim);
        scene.body[0].width *= 0.3;
        let far = holder_at(&scene, Vec3::from(scene.joint[0].anchors[1].point));
        assert_eq!(far, None);
        tie_again(&mut scene, 0);
        let joint = &scene.joint[0];
        let near = holder_at(&scene, Vec3::from(joint.anchors[1].point));
        assert_eq!(near, Some(Item::Body(0)));
        assert!((joint.length.unwrap() - super::movement::span(joint)).abs() < 1e-4);
        assert_eq!(joints_after(&scene, 10), 1);
    }
}

#[test]
fn hole_of_a_ring_is_no_place_to_tie_a_rope() {
    let mut scene = Draft::blank(2).scene().clone();
    let ring = add(
        &mut scene,
        Kind::Body(Form::Ring, Stuff::Jelly),
        Vec3::Y * 0.4,
    )[0];
    let [low, high] = bounds(&scene, ring).unwrap();
    let middle = 0.5 * (low + high);
    assert_eq!(holder_at(&scene, middle), None);
    assert_eq!(holder_at(&scene, middle.with_x(low.x + 0.05)), Some(ring));
}

#[test]
fn ray_hits_the_first_thing() {
    let scene = Draft::blank(3).scene().clone();
    let [low, high] = bounds(&scene, Item::Body(0)).unwrap();
    let from = (0.5 * (low + high)).with_z(high.z + 2.0);
    let hit = first_hit(&scene, (from, Vec3::NEG_Z), 5.0).unwrap();
    assert_eq!(holder_at(&scene, hit), Some(Item::Body(0)));
    assert!((hit.z - high.z).abs() < 0.1, "{hit}");
    assert_eq!(first_hit(&scene, (from, Vec3::Z), 5.0), None);
}

#[test]
fn things_are_numbered_by_kind() {
    let mut scene = Draft::blank(2).scene().clone();
    let kinds = [
        Kind::Wall,
        Kind::Saw,
        Kind::Rope,
        Kind::Wall,
        Kind::Paddle,
        Kind::Saw,
    ];
    let made: Vec<Item> = kinds
        .map(|kind| add(&mut scene, kind, Vec3::ZERO)[0])
        .into();
    let numbers = numbers(&scene);
    assert_eq!(
        made.iter().map(|item| numbers[item]).collect::<Vec<_>>(),
        [1, 1, 1, 2, 1, 2]
    );
    assert_eq!(
        made.iter()
            .filter_map(|&item| kind_of(&scene, item))
            .collect::<Vec<_>>(),
        kinds
    );
    assert_eq!(numbers[&Item::Body(0)], 1);
}
