//! Where mouse and fingers point, how far they raise the hand in space, and how the camera turns.

use super::fingers::Fingers;
use crate::game::{Game, Screen};
use egui::{Context, Event, PointerButton};

/// How far the wheel raises the hand [m/point].
const WHEEL: f32 = 0.002;
/// What share of a body it cuts off [1/point].
const CUT: f32 = 0.0012;
/// How far a mouse or a finger turns the camera [rad/point].
const DRAG: f32 = 0.006;
/// How fast a key or a stick that leans fully turns it [rad/s].
const TURN: f32 = 1.5;

/// Notes where the mouse points, which counts until a tick has heard of it; on a button it does not mean the hand, nor
/// while it turns the camera.
pub(super) fn point(game: &mut Game, ctx: &Context) {
    let is_on_button = ctx.interaction_snapshot(|seen| !seen.hovered.is_empty());
    if game.screen != Screen::Play || is_on_button {
        game.devices.pointer = None;
        return;
    }
    let at = ctx.input(|input| {
        let pointer = &input.pointer;
        let has_moved = |event: &Event| matches!(event, Event::PointerMoved(_));
        let points =
            pointer.button_down(PointerButton::Primary) || input.events.iter().any(has_moved);
        let turns = pointer.button_down(PointerButton::Secondary);
        pointer.latest_pos().filter(|_| points && !turns)
    });
    let (Some(view), Some(at)) = (game.view, at) else {
        return;
    };
    // In space it points at the floor, where the hand's shadow is: so nothing jumps when the hand has risen.
    let round = game.session.round();
    let mut place = view.in_world(at, round.level().arena()[0][1]);
    if view.space.is_some() {
        let goal = game.players.wanted(0);
        place[1] = goal.unwrap_or(round.hands()[0].goal())[1];
    }
    game.devices.pointer = Some(place);
}

/// In space the wheel and a second finger raise the hand, or the wheel cuts bodies open where their elements are seen;
/// mouse, second finger, keys, sticks and pads turn the camera.
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
    let fingers = fingers.take();
    // The hand rises as far as the finger does.
    let metres = game.view.map_or(0.0, |view| 1.0 / view.scale);
    game.devices.lift += metres * fingers.up;
    if game.elements.is_none() {
        game.devices.lift += WHEEL * wheel;
    } else if wheel != 0.0 {
        let still = game.settings.reduced_motion;
        game.opening.cut(CUT * wheel, game.time, still);
    }
    game.camera
        .orbit(-DRAG * (mouse.x + fingers.right), DRAG * mouse.y);
    let turn = TURN * seconds * game.devices.turn(&game.settings.bindings);
    game.camera.orbit(turn.x, turn.y);
}
