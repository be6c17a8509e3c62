//! Mirror images of levels.

use fuwafuwa_scenes::Scene;
use fuwafuwa_scenes::scene::{
    BallText, BodyText, BoxText, CapsuleText, Form, HalfSpaceText, HandText, ObstacleText,
    RigidBodyText,
};

/// Returns the mirror image of a scene: left and right are swapped. `None` if it holds a body that has no mirror image in
/// a text: one made from a file, rotated, or with a given state.
pub(super) fn mirrored(scene: &Scene) -> Option<Scene> {
    let mut scene = scene.clone();
    let [low, high] = &mut scene.view;
    (low[0], high[0]) = (-high[0], -low[0]);
    flip(&mut scene.gravity);
    for body in &mut scene.body {
        turn_body(body)?;
    }
    scene.obstacle.iter_mut().for_each(turn_obstacle);
    scene.hand.iter_mut().for_each(turn_hand);
    for body in &mut scene.rigid_body {
        turn_rigid_body(body)?;
    }
    let anchors = scene.joint.iter_mut().flat_map(|joint| &mut joint.anchors);
    anchors.for_each(|anchor| flip(&mut anchor.point));
    for knife in &mut scene.knife {
        knife.edge.iter_mut().for_each(flip);
        flip(&mut knife.toward);
    }
    for switch in &mut scene.switch {
        turn_shapes(None, &mut switch.boxed, None, &mut switch.ball);
    }
    for field in &mut scene.field {
        turn_shapes(None, &mut field.boxed, None, &mut field.ball);
        field.acceleration.iter_mut().for_each(flip);
        field.centre.iter_mut().for_each(flip);
    }
    let game = scene.game.as_mut()?;
    turn_shapes(None, &mut game.basket, None, &mut None);
    game.baskets
        .iter_mut()
        .for_each(|basket| flip(&mut basket.centre));
    turn_path(&mut game.hint);
    Some(scene)
}

fn flip(vector: &mut [f32; 3]) {
    vector[0] = 0.0 - vector[0];
}

/// Mirrors a rotation vector, which keeps its component along the flipped axis.
fn turn_rotation(rotation: &mut [f32; 3]) {
    rotation[1] = 0.0 - rotation[1];
    rotation[2] = 0.0 - rotation[2];
}

fn turn_path(path: &mut [[f32; 4]]) {
    path.iter_mut().for_each(|point| point[1] = 0.0 - point[1]);
}

fn turn_shapes(
    half_space: Option<&mut HalfSpaceText>,
    boxed: &mut Option<BoxText>,
    capsule: Option<&mut CapsuleText>,
    ball: &mut Option<BallText>,
) {
    if let Some(plane) = half_space {
        flip(&mut plane.normal);
        flip(&mut plane.point);
    }
    if let Some(boxed) = boxed {
        flip(&mut boxed.centre);
    }
    if let Some(capsule) = capsule {
        flip(&mut capsule.from);
        flip(&mut capsule.to);
    }
    if let Some(ball) = ball {
        flip(&mut ball.centre);
    }
}

fn turn_obstacle(obstacle: &mut ObstacleText) {
    turn_shapes(
        obstacle.half_space.as_mut(),
        &mut obstacle.boxed,
        obstacle.capsule.as_mut(),
        &mut obstacle.ball,
    );
    turn_path(&mut obstacle.path);
    obstacle.pivot.iter_mut().for_each(flip);
    obstacle.angular_velocity.iter_mut().for_each(turn_rotation);
}

fn turn_hand(hand: &mut HandText) {
    turn_shapes(None, &mut hand.boxed, hand.capsule.as_mut(), &mut None);
    turn_path(&mut hand.path);
}

fn turn_rigid_body(body: &mut RigidBodyText) -> Option<()> {
    let is_plain =
        body.state.is_none() && body.rotation.is_none() && body.target_rotation.is_none();
    if !is_plain {
        return None;
    }
    turn_shapes(
        body.half_space.as_mut(),
        &mut body.boxed,
        body.capsule.as_mut(),
        &mut body.ball,
    );
    flip(&mut body.at);
    body.rotation_vector.iter_mut().for_each(turn_rotation);
    body.velocity.iter_mut().for_each(flip);
    body.angular_velocity.iter_mut().for_each(turn_rotation);
    body.target_position.iter_mut().for_each(flip);
    Some(())
}

fn turn_body(body: &mut BodyText) -> Option<()> {
    let is_symmetric = body.shape.is_some_and(|form| form != Form::Flower);
    if !is_symmetric || body.rotation_vector.is_some() {
        return None;
    }
    let width = body.width * body.proportions[0];
    body.at[0] = -(body.at[0] + width);
    flip(&mut body.velocity);
    for part in &mut body.part {
        let turn = |point: &mut [f32; 3]| point[0] = width - point[0];
        if let Some(plane) = &mut part.half_space {
            flip(&mut plane.normal);
            turn(&mut plane.point);
        }
        if let Some(boxed) = &mut part.boxed {
            turn(&mut boxed.centre);
        }
        if let Some(capsule) = &mut part.capsule {
            turn(&mut capsule.from);
            turn(&mut capsule.to);
        }
        if let Some(ball) = &mut part.ball {
            turn(&mut ball.centre);
        }
    }
    Some(())
}
