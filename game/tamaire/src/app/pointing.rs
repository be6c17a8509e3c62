//! Where mouse and fingers point, how far they raise the hand in space, and how the camera turns.

use super::fingers::Fingers;
use crate::game::{Game, Screen};
use egui::{Context, PointerButton, Pos2};
use fuwafuwa::Dim3;
use tamaire_play::{AnyRound, Round};

/// How far the wheel raises the hand [m/point].
const WHEEL: f32 = 0.002;
/// What share of a body it cuts off [1/point], and a key that is held [1/s].
const CUT: f32 = 0.0012;
const CUTTING: f32 = 0.4;
/// How far a mouse or a finger turns the camera [rad/point].
const DRAG: f32 = 0.006;
/// So near to an obstacle is on it [m].
const NEAR: f32 = 1e-3;
/// How fast a key or a stick that leans fully turns it [rad/s].
const TURN: f32 = 1.5;

/// Notes where the mouse or the first finger points, which counts until a tick has heard of it; on a button it does not
/// mean the hand, nor while it turns the camera.
pub(super) fn point(game: &mut Game, ctx: &Context, fingers: &Fingers) {
    // What a finger holds that presses a button is no place for a hand either, and another one may have a hand.
    let is_on_button =
        !fingers.are_down() && ctx.interaction_snapshot(|seen| !seen.hovered.is_empty());
    let is_on = game.screen() == Screen::Play;
    let devices = &mut game.controls.devices;
    if !is_on || is_on_button {
        (devices.pointer, devices.second) = (None, None);
        return;
    }
    let view = game.bout.view;
    let is_plane = matches!(game.bout.round(), AnyRound::Plane(_));
    let second = view.zip(fingers.second()).filter(|_| is_plane);
    devices.second = second.map(|(view, at)| view.in_world(at, 0.0));
    let at = match fingers.are_down() {
        true => fingers.first(),
        false => mouse_at(ctx),
    };
    let (Some(view), Some(at)) = (view, at) else {
        return;
    };
    let round = game.bout.round();
    let position = match round {
        AnyRound::Plane(_) => view.in_world(at, 0.0),
        // In space it points at the floor, where the hand's shadow is: so nothing jumps when the hand has risen.
        AnyRound::Space(in_space) => {
            let goal = game
                .controls
                .players
                .wanted(0)
                .unwrap_or(round.hands()[0].goal());
            let [x, _, z] = view.in_world(at, floor(in_space));
            [x, goal[1], z]
        }
    };
    game.controls.devices.pointer = Some(position.map(in_steps));
}

/// A coordinate in steps of 1/1024 m [m]: finer than what a pixel shows, and half as long in a link.
fn in_steps(at: f32) -> f32 {
    const STEPS: f32 = 1024.0;
    (at * STEPS).round() / STEPS
}

/// How high what the first hand begins above is [m]: the floor, or a shelf. It stays the same when the hand comes past
/// an edge, so that nothing jumps there.
fn floor(round: &Round<Dim3>) -> f32 {
    let lowest = round.level().arena()[0][1];
    let mut at = round.start(0);
    while at[1] > lowest {
        // So far down there is nothing.
        let obstacles = round.world().obstacles();
        let free = obstacles.map(|obstacle| obstacle.shape().distance(at).0);
        let free = free.fold(f32::MAX, f32::min);
        if free < NEAR {
            return at[1];
        }
        at[1] -= free;
    }
    lowest
}

/// Where the mouse points, if it does.
fn mouse_at(ctx: &Context) -> Option<Pos2> {
    ctx.input(|input| {
        let pointer = &input.pointer;
        // A window that opens under a mouse hears where it rests: that is no wish.
        let has_moved = pointer.delta() != egui::Vec2::ZERO;
        let points = pointer.button_down(PointerButton::Primary) || has_moved;
        let turns = pointer.button_down(PointerButton::Secondary);
        pointer.latest_pos().filter(|_| points && !turns)
    })
}

/// In space the wheel and a second finger raise the hand; where elements are seen, the wheel, keys and pads cut bodies open;
/// mouse, second finger, keys, sticks and pads turn the camera, a double click with the right button brings it back.
pub(super) fn look_around(game: &mut Game, ctx: &Context, fingers: &mut Fingers) {
    let (wheel, mouse, seconds) = ctx.input(|input| {
        let turns = input.pointer.button_down(PointerButton::Secondary);
        let mouse = if turns {
            input.pointer.delta()
        } else {
            egui::Vec2::ZERO
        };
        (input.smooth_scroll_delta.y, mouse, input.stable_dt.min(0.1))
    });
    let twice = ctx.input(|input| {
        input
            .pointer
            .button_double_clicked(PointerButton::Secondary)
    });
    let fingers = fingers.take();
    // The hand rises as far as the finger does.
    let metres = game.bout.view.map_or(0.0, |view| 1.0 / view.scale);
    game.controls.devices.lift += metres * fingers.up;
    let deeper =
        CUT * wheel + CUTTING * seconds * game.controls.devices.deeper(&game.settings.bindings);
    if game.bout.elements.is_none() {
        game.controls.devices.lift += WHEEL * wheel;
    } else if deeper != 0.0 {
        let still = game.settings.reduced_motion;
        game.bout.opening.cut(deeper, game.time, still);
    }
    game.bout
        .camera
        .orbit(-DRAG * (mouse.x + fingers.right), DRAG * mouse.y);
    let turn = TURN * seconds * game.controls.devices.turn(&game.settings.bindings);
    game.bout.camera.orbit(turn.x, turn.y);
    if twice {
        game.bout.camera.go_home();
    }
}
