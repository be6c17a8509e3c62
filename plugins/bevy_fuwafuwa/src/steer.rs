//! Applies changed components to rigid bodies: target, pose, velocity, impulse.

use crate::component::{ExternalImpulse, RigidBodyId, SoftBodyId, TargetPosition, Velocity};
use crate::dimension::Dimension;
use crate::message::Rejection;
use crate::pose::{Pose, engine_rotation, engine_velocity};
use crate::problem::Problem;
use crate::world::SoftWorld;
use crate::write::LastWritten;
use bevy_ecs::change_detection::ResMut;
use bevy_ecs::message::MessageWriter;
use bevy_ecs::query::Without;
use bevy_ecs::system::{Commands, Query};
use bevy_math::Vec3;
use bevy_transform::components::Transform;
use fuwafuwa::{MotionType, RigidBodyHandle};

/// Components of a rigid body that can request a change.
type RigidChanges<'a> = (
    &'a RigidBodyId,
    &'a mut Transform,
    &'a mut LastWritten,
    Option<&'a mut Velocity>,
    Option<&'a ExternalImpulse>,
    Option<&'a TargetPosition>,
);

/// Applies the changes of target, pose, velocity and impulse since the last tick to rigid bodies.
pub fn steer_rigids<D: Dimension>(
    mut world: ResMut<SoftWorld<D>>,
    mut rigids: Query<RigidChanges<'_>, Without<SoftBodyId>>,
    mut commands: Commands,
    mut rejections: MessageWriter<Rejection>,
) {
    for (id, entity) in world.rigid_entities() {
        let Ok((own, mut transform, mut followed, velocity, impulse, goal)) =
            rigids.get_mut(entity)
        else {
            continue;
        };
        if own.0 != id || world.engine().rigid_body(id).is_err() {
            continue;
        }
        let mut check = |outcome: Result<(), Problem>| match outcome {
            Ok(()) => true,
            Err(problem) => {
                let entity = Some(entity);
                rejections.write(Rejection { entity, problem });
                false
            }
        };
        if !followed.is_at(&transform) {
            if check(put(&mut world, id, &transform, &followed)) {
                // Forgets the target position, so that it is sent to the engine again after the move.
                (followed.transform, followed.goal) = (*transform, None);
            } else {
                *transform = followed.transform;
            }
        }
        let engine = world.engine_mut();
        let goal = goal.map(|goal| goal.0);
        let bits = |goal: Vec3| goal.to_array().map(f32::to_bits);
        if goal.map(bits) != followed.goal.map(bits) {
            if let (Some(goal), MotionType::Coupled { .. }) =
                (goal, engine.rigid_body(id).unwrap().motion_type)
            {
                check(
                    engine
                        .set_target_position(id, goal.into())
                        .map_err(Problem::from),
                );
            }
            // Also set on failure, so that the error is reported only once.
            followed.goal = goal;
        }
        if let Some(mut velocity) = velocity
            && *velocity != followed.velocity
        {
            let Velocity { linear, angular } = *velocity;
            let outcome = engine.set_velocity(id, engine_velocity(linear, angular));
            if check(outcome.map_err(Problem::from)) {
                followed.velocity = *velocity;
            } else {
                *velocity = followed.velocity;
            }
        }
        if let Some(push) = impulse {
            let outcome = engine.apply_impulse(
                id,
                fuwafuwa::Impulse::at(push.at.into(), push.impulse.into()),
            );
            check(outcome.map_err(Problem::from));
            commands.entity(entity).try_remove::<ExternalImpulse>();
        }
    }
}

/// Moves a rigid body to the pose of a transform. For a kinematic body the pose becomes its target.
fn put<D: Dimension>(
    world: &mut SoftWorld<D>,
    id: RigidBodyHandle,
    transform: &Transform,
    followed: &LastWritten,
) -> Result<(), Problem> {
    let pose = Pose::of(transform)?;
    if transform.scale != followed.transform.scale {
        return Err(Problem::Pose(
            "keep its scale: the size of a rigid body is fixed once it has entered",
        ));
    }
    let engine = world.engine_mut();
    let mut at = pose.translation + pose.rotation * followed.middle;
    if D::N == 2 {
        at.z = 0.0;
    }
    let rotation = engine_rotation(transform.rotation);
    let rigid = engine.rigid_body(id).unwrap();
    if rigid.motion_type == MotionType::Kinematic {
        engine.set_target_position(id, at.into())?;
        engine.set_target_rotation(id, rotation)?;
        return Ok(());
    }
    // The body is only rotated if the user changed the rotation; otherwise rounding errors would accumulate.
    let is_turned = transform.rotation != followed.transform.rotation;
    let rotation = if is_turned {
        rotation
    } else {
        rigid.rotation()
    };
    if is_turned || at != Vec3::from(rigid.position()) {
        engine.set_pose(id, at.into(), rotation)?;
    }
    Ok(())
}
