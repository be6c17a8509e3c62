//! Pointing with mouse and fingers, raising the hand in 3D, and turning the camera.

use super::fingers::Fingers;
use crate::game::{Game, Screen};
use egui::{Context, PointerButton, Pos2};
use fuwafuwa::{Dim3, MotionType, Vec3};
use tamaire_play::{AnyRound, Round};

/// Height by which scrolling the wheel raises the hand [m/point].
const WHEEL: f32 = 0.002;
/// Fraction of a body that scrolling the wheel cuts off in the element view [1/point].
const CUT: f32 = 0.0012;
/// Fraction of a body that a held key or button cuts off in the element view [1/s].
const CUTTING: f32 = 0.4;
/// Camera rotation by a mouse or finger drag [rad/point].
const DRAG: f32 = 0.006;
/// Distance from an obstacle below which a point counts as lying on the obstacle [m].
const NEAR: f32 = 1e-3;
/// Camera rotation speed with a held key or a fully deflected stick [rad/s].
const TURN: f32 = 1.5;

/// Stores the position at which the mouse or the first finger points, until a tick has used it. Ignores a
/// pointer that is on a button or that turns the camera.
pub(super) fn point(game: &mut Game, ctx: &Context, fingers: &Fingers) {
    // A mouse on a button does not point. Fingers need no such check: `Fingers` leaves out a finger on a
    // button, while another finger may point.
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
    devices.second = second.map(|(view, at)| view.to_world(at, 0.0));
    let at = match fingers.are_down() {
        true => fingers.first(),
        false => mouse_at(ctx),
    };
    let (Some(view), Some(at)) = (view, at) else {
        return;
    };
    let round = game.bout.round();
    let position = match round {
        AnyRound::Plane(_) => view.to_world(at, 0.0),
        // In 3D the pointer is projected onto the floor and sets the horizontal position of the hand, which
        // keeps its height. Raising the hand therefore does not move it sideways.
        AnyRound::Space(in_space) => {
            let goal = game
                .controls
                .players
                .wanted(0)
                .unwrap_or(round.hands()[0].target);
            view.to_world(at, floor(in_space)).with_y(goal.y)
        }
    };
    game.controls.devices.pointer = Some(in_steps(position));
}

/// Rounds coordinates to multiples of 1/1024 m [m]. The steps are finer than a pixel and halve the length of
/// the coordinates in a link.
fn in_steps(at: Vec3) -> Vec3 {
    const STEPS: f32 = 1024.0;
    (at * STEPS).round() / STEPS
}

/// Height of the floor or shelf below the start position of the first hand [m]. The height does not depend on
/// the current position of the hand, so that nothing jumps when the hand passes an edge.
fn floor(round: &Round<Dim3>) -> f32 {
    let lowest = round.level().arena()[0].y;
    let bodies = round.world().rigid_bodies();
    let fixed = bodies.filter(|(_, body)| body.motion_type() == MotionType::Fixed);
    let mut at = round.start(0);
    while at.y > lowest {
        // Sphere tracing: no obstacle is closer than `free`, so a downward step of `free` cannot pass through
        // an obstacle.
        let free = fixed.clone().map(|(_, body)| body.shape().distance(at).0);
        let free = free.fold(f32::MAX, f32::min);
        if free < NEAR {
            return at.y;
        }
        at.y -= free;
    }
    lowest
}

/// Position of the mouse, or `None` if the mouse does not point. The mouse points while it moves or its
/// primary button is down, unless it turns the camera.
fn mouse_at(ctx: &Context) -> Option<Pos2> {
    ctx.input(|input| {
        let pointer = &input.pointer;
        // A mouse at rest does not point: a window that opens under it receives a pointer position that is
        // not the player's input.
        let has_moved = pointer.delta() != egui::Vec2::ZERO;
        let points = pointer.button_down(PointerButton::Primary) || has_moved;
        let turns = pointer.button_down(PointerButton::Secondary);
        pointer.latest_pos().filter(|_| points && !turns)
    })
}

/// Lifts the hand, cuts bodies open and moves the camera, as the player's input demands.
///
/// - Lift (in 3D): the wheel and a second finger.
/// - Cut bodies open (in the element view): the wheel, keys and pads.
/// - Turn the camera: mouse, second finger, keys, sticks and pads. A double click with the right button
///   resets the camera.
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
    // Converts the upward drag to metres in the world, so that the hand follows the finger.
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
        game.bout.camera.return_to_front();
    }
}
