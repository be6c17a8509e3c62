//! What a tick did, written to entities.

use crate::component::{GravityScale, RigidBody, RigidBodyId, SoftBodyId, SoftVelocity};
use crate::dimension::Dimension;
use crate::drawn::Drawn;
use crate::pose::{Pose, motion_of};
use crate::world::SoftWorld;
use bevy_asset::Assets;
use bevy_ecs::change_detection::{Res, ResMut};
use bevy_ecs::component::Component;
use bevy_ecs::system::Query;
use bevy_math::Vec3;
use bevy_mesh::Mesh;
use bevy_transform::components::Transform;
use fuwafuwa::Drive;

/// What an entity was told last: what differs from it was changed by somebody else.
#[derive(Component, Copy, Clone, Debug)]
pub struct Followed {
    pub pose: Pose,
    pub transform: Transform,
    pub velocity: SoftVelocity,
    pub gravity: f32,
    /// Where a hand was sent last.
    pub goal: Option<Vec3>,
    /// Whether all of it slept then.
    pub is_settled: bool,
}

impl Followed {
    pub fn new(
        pose: Pose,
        transform: Transform,
        velocity: Option<SoftVelocity>,
        gravity: Option<GravityScale>,
    ) -> Self {
        Self {
            pose,
            transform,
            velocity: velocity.unwrap_or_default(),
            gravity: gravity.map_or(1.0, |own| own.0),
            goal: None,
            is_settled: false,
        }
    }
}

/// Tells entities where they are and how fast.
pub fn write_motion<D: Dimension>(
    world: Res<SoftWorld<D>>,
    mut bodies: Query<(
        &SoftBodyId,
        &mut Transform,
        &mut Followed,
        Option<&mut SoftVelocity>,
    )>,
    mut hands: Query<
        (&RigidBodyId, &RigidBody<D>, &mut Transform, &mut Followed),
        bevy_ecs::query::Without<SoftBodyId>,
    >,
) {
    if !world.has_ticked() {
        return;
    }
    for (id, entity) in world.soft_entities() {
        let (Ok(body), Ok((own, mut transform, mut followed, velocity))) =
            (world.engine().bodies().get(id), bodies.get_mut(entity))
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
        let now = SoftVelocity {
            linear: motion.linear,
            angular: motion.angular,
        };
        followed.velocity = now;
        followed.is_settled = is_asleep;
        if let Some(mut velocity) = velocity {
            *velocity = now;
        }
    }
    for (id, entity) in world.rigid_entities() {
        let (Ok(hand), Ok((own, rigid, mut transform, mut followed))) =
            (world.engine().rigids().get(id), hands.get_mut(entity))
        else {
            continue;
        };
        if own.0 == id && matches!(rigid.drive, Drive::Coupled { .. }) {
            transform.translation = Vec3::from(hand.position());
            followed.transform = *transform;
        }
    }
}

/// Brings meshes up to date.
pub fn write_meshes<D: Dimension>(
    world: Res<SoftWorld<D>>,
    meshes: Option<ResMut<Assets<Mesh>>>,
    mut bodies: Query<(&SoftBodyId, &Followed, &mut Drawn<D>)>,
) {
    let Some(mut meshes) = meshes else {
        return;
    };
    for (id, entity) in world.soft_entities() {
        let (Ok(body), Ok((own, followed, mut drawn))) =
            (world.engine().bodies().get(id), bodies.get_mut(entity))
        else {
            continue;
        };
        if own.0 == id {
            drawn.follow(body, &followed.pose, &mut meshes);
        }
    }
}
