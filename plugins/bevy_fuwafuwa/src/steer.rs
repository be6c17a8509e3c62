//! Applies changed components to rigid bodies: target, pose, velocity, impulse.

use crate::component::{ExternalImpulse, RigidBodyId, SoftBodyId, TargetPosition, Velocity};
use crate::convert::{engine_rotation, engine_vector, engine_velocity};
use crate::dimension::Dimension;
use crate::message::Rejection;
use crate::pose::Pose;
use crate::problem::Problem;
use crate::world::SoftWorld;
use crate::write::LastWritten;
use bevy_ecs::change_detection::ResMut;
use bevy_ecs::message::MessageWriter;
use bevy_ecs::query::Without;
use bevy_ecs::system::{Commands, Query};
use bevy_math::Vec3;
use bevy_transform::components::Transform;
use fuwafuwa::{Impulse, MotionType, RigidBodyHandle};

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
        let Ok((own, mut transform, mut followed, velocity, impulse, target)) =
            rigids.get_mut(entity)
        else {
            continue;
        };
        let motion_type = match world.engine().rigid_body(id) {
            Ok(rigid) if own.0 == id => rigid.motion_type(),
            _ => continue,
        };
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
                // Clears the target position last sent to the engine, so that the code below sends it again
                // after the move.
                (followed.transform, followed.target) = (*transform, None);
            } else {
                *transform = followed.transform;
            }
        }
        let engine = world.engine_mut();
        let target = target.map(|target| target.0);
        let bits = |target: Vec3| target.to_array().map(f32::to_bits);
        if target.map(bits) != followed.target.map(bits) {
            if let (Some(target), MotionType::Coupled { .. }) = (target, motion_type) {
                let outcome = engine.set_target_position(id, engine_vector(target));
                check(outcome.map_err(Problem::from));
            }
            // The target is stored even if the engine rejected it, so that the error is reported only once.
            followed.target = target;
        }
        if let Some(mut velocity) = velocity
            && *velocity != followed.velocity
        {
            let outcome = engine.set_velocity(id, engine_velocity(*velocity));
            if check(outcome.map_err(Problem::from)) {
                followed.velocity = *velocity;
            } else {
                *velocity = followed.velocity;
            }
        }
        if let Some(push) = impulse {
            let impulse = Impulse::at(engine_vector(push.point), engine_vector(push.impulse));
            let outcome = engine.apply_impulse(id, impulse);
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
        return Err(Problem::InvalidTransform(
            "keep its scale: the size of a rigid body is fixed once it has entered",
        ));
    }
    let engine = world.engine_mut();
    let position = engine_vector(pose.translation + pose.rotation * followed.middle);
    let rotation = engine_rotation(transform.rotation);
    let rigid = engine.rigid_body(id)?;
    if rigid.motion_type() == MotionType::Kinematic {
        engine.set_target_position(id, position)?;
        engine.set_target_rotation(id, rotation)?;
        return Ok(());
    }
    // The body is rotated only if the user changed the rotation; an unnecessary rotation in each tick would
    // add up rounding errors.
    let is_turned = transform.rotation != followed.transform.rotation;
    let rotation = if is_turned {
        rotation
    } else {
        rigid.rotation()
    };
    if is_turned || position != rigid.position() {
        engine.set_pose(id, position, rotation)?;
    }
    Ok(())
}
