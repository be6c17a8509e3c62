//! Ropes in the editor: to what they are tied, and that they are whole in the round.

use crate::making::{drag, place_of_item, slow_clock};
use crate::window::*;
use egui::{Pos2, vec2};
use egui_kittest::kittest::Queryable;
use fuwafuwa::Vec3;
use fuwafuwa_scenes::scene::{JointAnchorText, JointText};
use tamaire::game::Screen;
use tamaire::platform::Files;
use tamaire_maker::drawing::Brush;
use tamaire_maker::items::{self, Item, Kind};
use tamaire_play::AnyRound;

/// Opens a blank level with a paddle, a board and a rope on the body. The rope is selected.
fn roped(dim: u8) -> Window {
    let mut window = open(Files::nowhere(), vec2(1000.0, 640.0), 1.0);
    let game = game(&mut window);
    game.clock = slow_clock();
    game.edit_blank(dim);
    for (kind, x, y) in [(Kind::Paddle, 0.9, 0.5), (Kind::Plank, -1.0, 0.4)] {
        game.change_level(|scene| {
            items::add(scene, kind, Vec3::new(x, y, 0.0));
        });
    }
    game.select(Item::Body(0));
    game.add_thing(Kind::Rope);
    frames(&mut window, 3);
    window
}

fn rope(window: &mut Window) -> JointText {
    game(window).maker.draft.scene().joint[0].clone()
}

/// Returns the place of an end of the rope on the screen.
fn place_of_end(window: &mut Window, end: usize) -> Pos2 {
    let point = Vec3::from(rope(window).anchors[end].point);
    game(window).bout.view.unwrap().to_screen(point)
}

fn anchor(window: &mut Window, end: usize) -> JointAnchorText {
    rope(window).anchors[end].clone()
}

/// Returns the length of the rope minus the distance of its ends [m].
fn slack(window: &mut Window) -> f32 {
    let rope = rope(window);
    let [from, to] = [0, 1].map(|end: usize| Vec3::from(rope.anchors[end].point));
    rope.length.unwrap() - from.distance(to)
}

/// Plays the level for a moment and returns whether its rope is whole. Returns to the editor.
fn is_whole_in_the_round(window: &mut Window) -> bool {
    game(window).test_level();
    frames(window, 30);
    let count = match game(window).bout.round() {
        AnyRound::Plane(round) => round.world().joints().count(),
        AnyRound::Space(round) => round.world().joints().count(),
    };
    game(window).settings.reduced_motion = true;
    game(window).end_test();
    frames(window, 3);
    assert_eq!(screen(window), Screen::Editor);
    count == 1
}

#[test]
fn rope_is_tied_to_the_selected_body_and_follows_it() {
    for dim in [2, 3] {
        let mut window = roped(dim);
        assert_eq!(anchor(&mut window, 1).body, Some(1));
        assert_eq!(
            anchor(&mut window, 0),
            JointAnchorText {
                point: anchor(&mut window, 0).point,
                ..JointAnchorText::default()
            }
        );
        assert_eq!(notices(&window), "");
        let before = rope(&mut window);
        let at = place_of_item(&mut window, Item::Body(0));
        drag(&mut window, &[at, at + vec2(-150.0, 0.0)]);
        let after = rope(&mut window);
        assert!(
            after.length.unwrap() > before.length.unwrap() + 0.1,
            "{dim}D"
        );
        assert!(slack(&mut window).abs() < 1e-3);
        assert!(is_whole_in_the_round(&mut window), "{dim}D");
        game(&mut window).undo_edit(false);
        assert_eq!(rope(&mut window), before);
    }
}

#[test]
fn end_of_a_rope_is_dragged_onto_things_and_off_them() {
    for dim in [2, 3] {
        let mut window = roped(dim);
        let items = [Item::RigidBody(0), Item::Hand(0), Item::Body(0)];
        let paddle = { game(&mut window).maker.draft.scene().obstacle.iter() }
            .position(|text| text.angular_velocity.is_some())
            .unwrap();
        for item in [Item::Obstacle(paddle)].into_iter().chain(items) {
            let from = place_of_end(&mut window, 0);
            let to = place_of_item(&mut window, item);
            drag(&mut window, &[from, to]);
            let tied = anchor(&mut window, 0);
            let holders = [
                tied.body.map(|number| Item::Body(number - 1)),
                tied.obstacle.map(|number| Item::Obstacle(number - 1)),
                tied.hand.map(|number| Item::Hand(number - 1)),
                tied.rigid_body.map(|number| Item::RigidBody(number - 1)),
            ];
            let holders: Vec<Item> = holders.into_iter().flatten().collect();
            assert_eq!(holders, [item], "{dim}D");
            assert_eq!(tied.radius.is_some(), tied.body.is_some());
            assert!(slack(&mut window) > -1e-3, "{dim}D, {item:?}");
            assert!(is_whole_in_the_round(&mut window), "{dim}D, {item:?}");
            game(&mut window).select_alone(Item::Joint(0));
            frames(&mut window, 2);
        }
        // Into the empty room, and out of it.
        let from = place_of_end(&mut window, 0);
        drag(&mut window, &[from, from + vec2(30.0, -260.0)]);
        let free = anchor(&mut window, 0);
        assert_eq!((free.body, free.radius), (None, None), "{dim}D");
        let from = place_of_end(&mut window, 0);
        drag(&mut window, &[from, from + vec2(-900.0, -500.0)]);
        let [low, high] = game(&mut window).maker.draft.scene().view.map(Vec3::from);
        let end = Vec3::from(anchor(&mut window, 0).point);
        assert!(end.cmpge(low).all() && end.cmple(high).all(), "{end}");
        // The other end has to hold something.
        let before = rope(&mut window);
        let needs_thing = game(&mut window).making().needs_thing;
        let from = place_of_end(&mut window, 1);
        drag(&mut window, &[from, from + vec2(0.0, -200.0)]);
        assert_eq!(
            (rope(&mut window), notices(&window).as_str()),
            (before, needs_thing)
        );
    }
}

#[test]
fn rope_that_is_too_short_is_told_on_the_last_page() {
    let mut window = roped(2);
    let text = game(&mut window).making().short_rope;
    for (length, is_told) in [(None, false), (Some(0.05), true)] {
        if let Some(length) = length {
            game(&mut window).change_level(|scene| scene.joint[0].length = Some(length));
        }
        game(&mut window).go(Screen::Finish);
        frames(&mut window, 3);
        assert_eq!(window.query_by_label_contains(text).is_some(), is_told);
        game(&mut window).go(Screen::Editor);
        frames(&mut window, 2);
    }
}

#[test]
fn weight_at_which_a_rope_tears_is_told_in_kilograms() {
    let mut window = roped(2);
    game(&mut window).go(Screen::Properties);
    frames(&mut window, 3);
    assert!(crate::told::tells(&window, "Breaks at a load of"));
    assert!(crate::told::tells(&window, "60 kg") && !crate::told::tells(&window, " N"));
    window.get_by_label("Length");
    assert_eq!(rope(&mut window).breaking_force, Some(600.0));
}

#[test]
fn things_are_numbered_by_kind_and_a_saw_is_a_saw() {
    let mut window = open(Files::nowhere(), vec2(1000.0, 640.0), 1.0);
    game(&mut window).edit_blank(2);
    for kind in [
        Kind::Wall,
        Kind::Saw,
        Kind::SeeSaw,
        Kind::Rope,
        Kind::Paddle,
    ] {
        game(&mut window).add_thing(kind);
    }
    frames(&mut window, 3);
    for name in [
        "Body 1", "Wall 1", "Saw 1", "Seesaw 1", "Pin 1", "Rope 1", "Paddle 1", "Hand 1",
    ] {
        button(&window, name);
    }
}

#[test]
fn rope_holds_a_body_that_is_drawn_anew() {
    let mut window = roped(2);
    let before = anchor(&mut window, 1);
    let now = game(&mut window);
    now.select_alone(Item::Body(0));
    now.draw_selected();
    // Only a strip in the middle is left, which is not where the rope was tied.
    for y in [8.0, 56.0] {
        let ends = [0.0, 64.0].map(|x| Vec3::new(x, y, 0.5));
        now.maker.paper.stroke(ends[0], ends[1], 20.0, Brush::Erase);
    }
    now.maker.paper.end_stroke();
    now.drop_drawing();
    assert_eq!(now.screen(), Screen::Editor);
    let after = anchor(&mut window, 1);
    assert!(
        after.point[1] < before.point[1] - 0.02,
        "{before:?} {after:?}"
    );
    let place = Vec3::from(after.point);
    let scene = game(&mut window).maker.draft.scene().clone();
    assert_eq!(items::holder_at(&scene, place), Some(Item::Body(0)));
    assert!(slack(&mut window).abs() < 1e-3);
    assert!(is_whole_in_the_round(&mut window));
}

#[test]
fn new_rope_is_tied_to_the_selected_one_of_two_bodies() {
    let mut window = roped(2);
    game(&mut window).add_thing(Kind::ALL[0]);
    for body in [0, 1] {
        let now = game(&mut window);
        now.select(Item::Body(body));
        now.add_thing(Kind::Rope);
        let joint = now.maker.draft.scene().joint.last().unwrap();
        assert_eq!(joint.anchors[1].body, Some(body + 1));
    }
}
