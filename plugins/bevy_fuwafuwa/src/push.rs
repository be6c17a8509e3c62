//! Applies changed components to soft bodies: pose, velocity, impulse, gravity.

use crate::component::{ExternalImpulse, GravityScale, SoftBodyId, Velocity};
use crate::convert::{engine_rotation, engine_vector, engine_velocity};
use crate::dimension::Dimension;
use crate::message::Rejection;
use crate::pose::Pose;
use crate::problem::Problem;
use crate::world::{SoftWorld, SoftWorldConfig};
use crate::write::LastWritten;
use bevy_ecs::change_detection::{DetectChanges, Res, ResMut};
use bevy_ecs::message::MessageWriter;
use bevy_ecs::system::{Commands, Query};
use bevy_math::Quat;
use bevy_transform::components::Transform;
use fuwafuwa::{DimVector, Impulse, SoftBodyHandle};

/// Passes a changed configuration to the engine.
pub fn change_config<D: Dimension>(
    config: Res<SoftWorldConfig<D>>,
    mut world: ResMut<SoftWorld<D>>,
    mut rejections: MessageWriter<Rejection>,
) {
    if config.is_changed()
        && config.0 != *world.engine().config()
        && let Err(refused) = world.engine_mut().set_config(config.0)
    {
        let (entity, problem) = (None, refused.into());
        rejections.write(Rejection { entity, problem });
    }
}

/// Components of a soft body that can request a change.
type SoftChanges<'a> = (
    &'a SoftBodyId,
    &'a mut Transform,
    &'a mut LastWritten,
    Option<&'a mut Velocity>,
    Option<&'a ExternalImpulse>,
    Option<&'a GravityScale>,
);

/// Applies the changes of pose, velocity, gravity and impulse since the last tick to soft bodies.
pub fn push_bodies<D: Dimension>(
    mut world: ResMut<SoftWorld<D>>,
    mut bodies: Query<SoftChanges<'_>>,
    mut commands: Commands,
    mut rejections: MessageWriter<Rejection>,
) {
    for (id, entity) in world.soft_entities() {
        let Ok((own, mut transform, mut followed, velocity, impulse, gravity)) =
            bodies.get_mut(entity)
        else {
            continue;
        };
        if own.0 != id || world.engine().soft_body(id).is_err() {
            continue;
        }
        let mut reject = |problem| {
            let entity = Some(entity);
            rejections.write(Rejection { entity, problem });
        };
        let mut before = followed.velocity;
        if !followed.is_at(&transform) {
            match displace(&mut world, id, &transform, &mut followed) {
                // The engine has rotated the velocity together with the body. Rotating `before` as well makes
                // the code below undo this, because the user did not request it.
                Ok(turn) => {
                    before.linear = turn * before.linear;
                    before.angular = turn * before.angular;
                }
                Err(problem) => {
                    *transform = followed.transform;
                    reject(problem);
                }
            }
        }
        let wanted = velocity.as_deref().copied().unwrap_or(followed.velocity);
        if wanted != before {
            let gain = engine_velocity(Velocity {
                linear: wanted.linear - before.linear,
                angular: wanted.angular - before.angular,
            });
            if let Err(refused) = world.engine_mut().add_velocity(id, gain) {
                reject(refused.into());
                if let Some(mut velocity) = velocity {
                    *velocity = followed.velocity;
                }
            } else {
                followed.velocity = wanted;
            }
        }
        let scale = gravity.map_or(1.0, |gravity| gravity.0);
        if scale.to_bits() != followed.gravity.to_bits() {
            if let Err(refused) = world.engine_mut().set_gravity_scale(id, scale) {
                reject(refused.into());
            }
            followed.gravity = scale;
        }
        if let Some(push) = impulse {
            let impulse = Impulse::at(engine_vector(push.point), engine_vector(push.impulse));
            let outcome = world
                .engine_mut()
                .apply_impulse(id, impulse.within(push.radius));
            if let Err(refused) = outcome {
                reject(refused.into());
            }
            commands.entity(entity).try_remove::<ExternalImpulse>();
        }
    }
}

/// Moves and rotates a body from its last pose to the pose of a transform. Returns the rotation applied.
fn displace<D: Dimension>(
    world: &mut SoftWorld<D>,
    id: SoftBodyHandle,
    transform: &Transform,
    followed: &mut LastWritten,
) -> Result<Quat, Problem> {
    let (from, mut to) = (followed.pose, Pose::of(transform)?);
    if transform.scale != followed.transform.scale {
        return Err(Problem::InvalidTransform(
            "keep its scale: the size of a soft body is fixed once it has entered",
        ));
    }
    let engine = world.engine_mut();
    let by: D::Vector = engine_vector(to.translation - from.translation);
    if by != D::Vector::ZERO {
        engine.translate(id, by)?;
    }
    // The body is rotated only if the user changed the rotation; an unnecessary rotation in each tick would
    // add up rounding errors.
    let mut turn = Quat::IDENTITY;
    if transform.rotation == followed.transform.rotation {
        to.rotation = from.rotation;
    } else {
        turn = to.rotation * from.rotation.inverse();
        let centre = engine_vector(to.translation);
        engine.rotate_about(id, engine_rotation(turn), centre)?;
    }
    followed.pose = to;
    followed.transform = *transform;
    followed.is_settled = false;
    Ok(turn)
}
