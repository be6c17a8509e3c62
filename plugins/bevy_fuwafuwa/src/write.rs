//! Writes the results of a tick to components.

use crate::component::{GravityScale, RigidBodyId, SoftBodyId, Velocity};
use crate::convert::{bevy_rotation, bevy_vector, bevy_velocity};
use crate::dimension::Dimension;
use crate::drawn::BodyMesh;
use crate::pose::{Pose, motion_of};
use crate::world::SoftWorld;
use bevy_asset::Assets;
use bevy_ecs::change_detection::{Res, ResMut};
use bevy_ecs::component::Component;
use bevy_ecs::query::Without;
use bevy_ecs::system::Query;
use bevy_math::Vec3;
use bevy_mesh::Mesh;
use bevy_transform::components::Transform;
use fuwafuwa::MotionType;

/// Component values that the plugin wrote last. If a component has another value, the user has changed it.
#[derive(Component, Copy, Clone, Debug)]
pub struct LastWritten {
    pub pose: Pose,
    pub transform: Transform,
    pub velocity: Velocity,
    pub gravity: f32,
    /// Position of the engine's origin of a rigid body, in the frame of the entity [m].
    pub middle: Vec3,
    /// Target last sent to the engine, world space [m].
    pub target: Option<Vec3>,
    /// Whether the whole body slept at the last write.
    pub is_settled: bool,
}

impl LastWritten {
    pub fn new(
        pose: Pose,
        transform: Transform,
        velocity: Option<Velocity>,
        gravity: Option<GravityScale>,
    ) -> Self {
        Self {
            pose,
            transform,
            velocity: velocity.unwrap_or_default(),
            gravity: gravity.map_or(1.0, |own| own.0),
            middle: Vec3::ZERO,
            target: None,
            is_settled: false,
        }
    }

    /// Returns whether a transform is bitwise equal to the one written last. Bits are compared because NaN is
    /// not equal to itself: a comparison of numbers would find a change in every tick.
    pub fn is_at(&self, transform: &Transform) -> bool {
        let bits = |transform: &Transform| {
            let (translation, scale) = (transform.translation, transform.scale);
            let vectors = [translation, scale].map(|own| own.to_array().map(f32::to_bits));
            (vectors, transform.rotation.to_array().map(f32::to_bits))
        };
        bits(&self.transform) == bits(transform)
    }
}

/// Writes pose and velocity of soft bodies.
pub fn write_bodies<D: Dimension>(
    world: Res<SoftWorld<D>>,
    mut bodies: Query<(
        &SoftBodyId,
        &mut Transform,
        &mut LastWritten,
        Option<&mut Velocity>,
    )>,
) {
    if !world.has_ticked() {
        return;
    }
    for (id, entity) in world.soft_entities() {
        let (Ok(body), Ok((own, mut transform, mut followed, velocity))) =
            (world.engine().soft_body(id), bodies.get_mut(entity))
        else {
            continue;
        };
        let is_asleep = body.pieces().list.iter().all(|piece| piece.asleep);
        if own.0 != id || is_asleep && followed.is_settled {
            continue;
        }
        let mut motion = motion_of(body, followed.pose);
        if D::N == 2 {
            motion.pose.translation.z = transform.translation.z;
        }
        followed.pose = motion.pose;
        followed.transform = motion.pose.transform();
        *transform = followed.transform;
        followed.velocity = motion.velocity;
        followed.is_settled = is_asleep;
        if let Some(mut velocity) = velocity {
            *velocity = motion.velocity;
        }
    }
}

/// Writes the velocity of all moving rigid bodies, and the pose of coupled and dynamic ones. The transform of
/// a kinematic body is not written, because the user sets it.
pub fn write_rigids<D: Dimension>(
    world: Res<SoftWorld<D>>,
    mut rigids: Query<
        (
            &RigidBodyId,
            &mut Transform,
            &mut LastWritten,
            Option<&mut Velocity>,
        ),
        Without<SoftBodyId>,
    >,
) {
    if !world.has_ticked() {
        return;
    }
    for (id, entity) in world.rigid_entities() {
        let (Ok(rigid), Ok((own, mut transform, mut followed, velocity))) =
            (world.engine().rigid_body(id), rigids.get_mut(entity))
        else {
            continue;
        };
        let is_settled = followed.is_settled && rigid.is_asleep();
        let motion_type = rigid.motion_type();
        if own.0 != id || motion_type == MotionType::Fixed || is_settled {
            continue;
        }
        if motion_type != MotionType::Kinematic {
            if rigid.is_dynamic() {
                transform.rotation = bevy_rotation(rigid.rotation());
            }
            let middle = transform.rotation * followed.middle;
            let z = transform.translation.z;
            transform.translation = bevy_vector(rigid.position()) - middle;
            if D::N == 2 {
                transform.translation.z = z;
            }
            followed.transform = *transform;
        }
        let now = bevy_velocity(rigid.velocity());
        followed.velocity = now;
        followed.is_settled = rigid.is_asleep();
        if let Some(mut velocity) = velocity {
            *velocity = now;
        }
    }
}

/// Updates the meshes of all soft bodies.
pub fn write_meshes<D: Dimension>(
    world: Res<SoftWorld<D>>,
    meshes: Option<ResMut<Assets<Mesh>>>,
    mut bodies: Query<(&SoftBodyId, &LastWritten, &mut BodyMesh<D>)>,
) {
    let Some(mut meshes) = meshes else {
        return;
    };
    for (id, entity) in world.soft_entities() {
        let (Ok(body), Ok((own, followed, mut drawn))) =
            (world.engine().soft_body(id), bodies.get_mut(entity))
        else {
            continue;
        };
        if own.0 == id {
            drawn.follow(body, &followed.pose, &mut meshes);
        }
    }
}
