//! Actions on bodies from outside: translation, rotation, velocity, impulse, sleep.

use super::{BodyHandle, World, WorldConfig};
use crate::contact::broad_phase::{bounds_of, supported_by_body, supported_by_rigid};
use crate::contact::solver::Hit;
use crate::error::{Error, require};
use crate::event::Event;
use crate::foundation::arena::{RigidBodyHandle, SoftBodyHandle};
use crate::foundation::dim::{Dim, DimVector, turning};
use crate::foundation::ids::{IndexVec, PieceId};
use crate::math::rotation::Rotation;
use crate::math::twist::Twist;
use crate::math::velocity::{Impulse, Velocity};
use crate::rigid_body::layers::Layers;
use crate::rigid_body::solid::flat;
use crate::rigid_body::{
    FARTHEST, MotionType, RigidState, check_friction, check_restitution, is_within_reach,
};
use crate::soft_body::{MAX_GRAVITY_SCALE, SoftBody};
use glam::Vec3;

impl<D: Dim> World<D> {
    /// Translates a body by the vector `by` [m] immediately; obstacles do not stop the body. The velocity
    /// stays the same. A kinematic or coupled body gets the new pose as its target. The body and sleeping
    /// objects in contact with it wake. Bookmarks of a soft body stay valid, because only positions change.
    ///
    /// # Errors
    /// [`Error`] if the handle is stale, a coordinate is not finite or beyond ±1e6 m, or a soft body would be
    /// out of its [range](SoftBody::range).
    pub fn translate(&mut self, body: impl Into<BodyHandle>, by: D::Vector) -> Result<(), Error> {
        self.translate_body(body.into(), by.to_vec3())
    }

    #[inline(never)]
    pub(crate) fn translate_body(&mut self, body: BodyHandle, by: Vec3) -> Result<(), Error> {
        let by = within("by", by, "at most 1e6 m on each axis")?;
        match body {
            BodyHandle::Soft(body) => {
                self.bodies.get(body)?.check_range(|at| at + by)?;
                self.displace(body, |body| body.shift(by))
            }
            BodyHandle::Rigid(rigid) => {
                let body = self.rigids.get(rigid)?;
                let (position, rotation) = (body.position() + by, body.rotation());
                self.place_rigid(rigid, position, rotation)
            }
        }
    }

    /// Rotates a body and its velocities about a point [m] immediately; obstacles do not stop the body. A
    /// kinematic or coupled body gets the new pose as its target. The body and sleeping objects in contact
    /// with it wake. Bookmarks of a soft body stay valid, because only positions change. In 2D only the part
    /// of the rotation about the third axis is applied.
    ///
    /// # Errors
    /// [`Error`] if the handle is stale, a coordinate of the point is not finite or beyond ±1e6 m, or a soft
    /// body would be out of its [range](SoftBody::range).
    pub fn rotate_about(
        &mut self,
        body: impl Into<BodyHandle>,
        rotation: Rotation,
        point: D::Vector,
    ) -> Result<(), Error> {
        self.rotate_body(body.into(), rotation, point.to_vec3())
    }

    #[inline(never)]
    pub(crate) fn rotate_body(
        &mut self,
        body: BodyHandle,
        rotation: Rotation,
        point: Vec3,
    ) -> Result<(), Error> {
        let point = within("point", point, "within 1e6 m of the origin")?;
        match body {
            BodyHandle::Soft(body) => {
                let turned = |at| rotation.seen_in::<D>().apply_about(at, flat::<D>(point));
                self.bodies.get(body)?.check_range(turned)?;
                self.displace(body, |body| body.turn(rotation, point))
            }
            BodyHandle::Rigid(rigid) => {
                let rotation = rotation.seen_in::<D>();
                let body = self.rigids.get(rigid)?;
                let position = rotation.apply_about(body.position(), flat::<D>(point));
                self.place_rigid(rigid, position, body.rotation().then(rotation))?;
                self.rigids.get_mut(rigid)?.rotate_velocity(rotation);
                Ok(())
            }
        }
    }

    /// Sets the position [m] of a rigid body, and its rotation from local to world axes, immediately. The
    /// velocity stays the same. A kinematic or coupled body gets the new pose as its target. The body and
    /// sleeping objects in contact with it wake.
    ///
    /// # Errors
    /// [`Error`] if the handle is stale, or a coordinate is not finite or beyond ±1e6 m. The body then stays
    /// unchanged.
    #[inline(never)]
    pub fn set_pose(
        &mut self,
        rigid: RigidBodyHandle,
        position: D::Vector,
        rotation: Rotation,
    ) -> Result<(), Error> {
        self.place_rigid(rigid, position.to_vec3(), rotation)
    }

    fn place_rigid(
        &mut self,
        rigid: RigidBodyHandle,
        position: Vec3,
        rotation: Rotation,
    ) -> Result<(), Error> {
        self.change_rigid(rigid, |body| body.set_pose::<D>(position, rotation))?;
        self.overlaps.place(rigid.into());
        Ok(())
    }

    /// Returns the velocity of a body. For a soft body, this is the velocity of the rigid motion with the
    /// same linear and angular momentum.
    ///
    /// # Errors
    /// [`Error::InvalidHandle`] if the handle is stale.
    pub fn velocity(&self, body: impl Into<BodyHandle>) -> Result<Velocity<D>, Error> {
        self.velocity_of(body.into()).map(Velocity::from)
    }

    #[inline(never)]
    pub(crate) fn velocity_of(&self, body: BodyHandle) -> Result<Twist, Error> {
        match body {
            BodyHandle::Soft(body) => Ok(self.bodies.get(body)?.rigid_velocity()),
            BodyHandle::Rigid(rigid) => Ok(self.rigids.get(rigid)?.twist()),
        }
    }

    /// Sets the velocity of a soft body or a dynamic rigid body. In a soft body, each node gets the velocity of the
    /// rigid motion at its position, which ends all vibration; [fixed](SoftBody::fix_node) nodes keep their
    /// velocity. The body wakes.
    ///
    /// ```
    /// use fuwafuwa::{Dim3, RigidBody, Shape, Vec3, World, WorldConfig};
    ///
    /// let weightless = WorldConfig { gravity: Vec3::ZERO, ..WorldConfig::default() };
    /// let mut world = World::<Dim3>::new(weightless)?;
    /// let ball = world.add_rigid_body(RigidBody::dynamic(Shape::ball(0.1), 1.0))?;
    /// world.set_velocity(ball, Vec3::new(6.0, 0.0, 0.0))?;
    /// world.step();
    /// assert!((world.rigid_body(ball)?.position().x - 0.1).abs() < 1e-5);
    /// # Ok::<(), fuwafuwa::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error`] if the handle is stale, the rigid body is not dynamic, or a component is not finite or beyond ±1e6.
    pub fn set_velocity(
        &mut self,
        body: impl Into<BodyHandle>,
        velocity: impl Into<Velocity<D>>,
    ) -> Result<(), Error> {
        self.set_velocity_of(body.into(), velocity.into().twist())
    }

    #[inline(never)]
    pub(crate) fn set_velocity_of(
        &mut self,
        body: BodyHandle,
        velocity: Twist,
    ) -> Result<(), Error> {
        check_velocity(velocity)?;
        match body {
            BodyHandle::Soft(body) => {
                self.wake_soft(body)?;
                self.bodies.get_mut(body)?.set_velocity(velocity);
            }
            BodyHandle::Rigid(rigid) => {
                let rigid = self.dynamic_mut(rigid)?;
                rigid.velocity = flat::<D>(velocity.linear);
                rigid.angular_velocity = turning::<D>(velocity.angular);
            }
        }
        Ok(())
    }

    /// Adds a velocity to that of a soft body or a dynamic rigid body. In a soft body, each node gains the
    /// velocity of the rigid motion at its position, except [fixed](SoftBody::fix_node) nodes. The body
    /// wakes.
    ///
    /// # Errors
    /// [`Error`] if the handle is stale, the rigid body is not dynamic, or a component is not finite or
    /// beyond ±1e6.
    pub fn add_velocity(
        &mut self,
        body: impl Into<BodyHandle>,
        velocity: impl Into<Velocity<D>>,
    ) -> Result<(), Error> {
        self.add_velocity_to(body.into(), velocity.into().twist())
    }

    #[inline(never)]
    pub(crate) fn add_velocity_to(
        &mut self,
        body: BodyHandle,
        velocity: Twist,
    ) -> Result<(), Error> {
        check_velocity(velocity)?;
        let Twist { linear, angular } = velocity;
        match body {
            BodyHandle::Soft(body) => {
                self.wake_soft(body)?;
                self.bodies.get_mut(body)?.add_velocity(linear, angular);
            }
            BodyHandle::Rigid(rigid) => {
                let rigid = self.dynamic_mut(rigid)?;
                rigid.velocity += flat::<D>(linear);
                rigid.angular_velocity += turning::<D>(angular);
            }
        }
        Ok(())
    }

    /// Applies an impulse to a soft body or a dynamic rigid body. A strong impulse can squash or tear a soft body
    /// near the impulse's point. The body wakes.
    ///
    /// ```
    /// use fuwafuwa::{Dim2, Impulse, Material, SoftBody, Vec2, VoxelGrid, World, WorldConfig};
    ///
    /// let grid = VoxelGrid::<Dim2>::ball(16, 1.0)?;
    /// let mut world = World::new(WorldConfig { gravity: Vec2::ZERO, ..WorldConfig::default() })?;
    /// let ball = world.add_soft_body(SoftBody::new(grid, &[Material::default()])?)?;
    /// world.apply_impulse(ball, Impulse::at(Vec2::splat(0.5), 2.0 * Vec2::X).within(1.0))?;
    /// let momentum = world[ball].momentum().linear.x;
    /// assert!((momentum - 2.0).abs() < 1e-4);
    /// # Ok::<(), fuwafuwa::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error`] if the handle is stale, the rigid body is not dynamic, a number is not finite or beyond ±1e6, or the
    /// radius is negative.
    pub fn apply_impulse(
        &mut self,
        body: impl Into<BodyHandle>,
        impulse: Impulse<D>,
    ) -> Result<(), Error> {
        self.apply_impulse_to(body.into(), impulse)
    }

    #[inline(never)]
    pub(crate) fn apply_impulse_to(
        &mut self,
        body: BodyHandle,
        impulse: Impulse<D>,
    ) -> Result<(), Error> {
        let Impulse {
            point,
            impulse,
            radius,
        } = impulse;
        let point = within("point", point.to_vec3(), "within 1e6 m of the origin")?;
        let impulse = impulse.to_vec3();
        let impulse = within("impulse", impulse, "at most 1e6 N s on each axis")?;
        let is_valid = (0.0..=FARTHEST).contains(&radius);
        require(is_valid, "radius", "0 to 1e6 m", radius)?;
        match body {
            BodyHandle::Soft(body) => {
                self.wake_soft(body)?;
                let substep = self.config.tick / self.substeps() as f32;
                let body = self.bodies.get_mut(body)?;
                body.add_impulse(point, radius, impulse, substep);
            }
            BodyHandle::Rigid(rigid) => {
                let rigid = self.dynamic_mut(rigid)?;
                let lever = flat::<D>(point) - rigid.position();
                rigid.apply_impulse(flat::<D>(impulse), lever);
            }
        }
        Ok(())
    }

    /// Sets the motion type of a rigid body. If the type differs from the present one, the present pose becomes the
    /// target. The present contacts of the body are discarded and detected again. The body and sleeping objects in
    /// contact with it wake.
    ///
    /// ```
    /// use fuwafuwa::{Dim2, MotionType, RigidBody, Shape, Vec2, World, WorldConfig};
    ///
    /// let mut world = World::<Dim2>::new(WorldConfig::default())?;
    /// let ball = world.add_rigid_body(RigidBody::dynamic(Shape::ball(0.2), 1.0))?;
    /// world.set_motion_type(ball, MotionType::Fixed)?;
    /// world.step();
    /// assert_eq!(world.rigid_body(ball)?.position(), Vec2::ZERO);
    /// assert!(world.set_motion_type(ball, MotionType::Dynamic { mass: 0.0 }).is_err());
    /// # Ok::<(), fuwafuwa::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error`] if the handle is stale, or a parameter of the motion type is out of range. A dynamic type is an
    /// error if the shape is unbounded or not centred on its origin. A fixed or dynamic type is an error if the
    /// body holds a knife, and a dynamic or coupled one if it carries a [grip](crate::Grip).
    #[inline(never)]
    pub fn set_motion_type(
        &mut self,
        rigid: RigidBodyHandle,
        motion_type: MotionType,
    ) -> Result<(), Error> {
        let holds_knife = self.knives.iter().any(|knife| knife.holder == rigid);
        let expected = "kinematic or coupled, because the body holds a knife";
        let is_allowed = !holds_knife || motion_type.follows_target();
        require(is_allowed, "motion_type", expected, motion_type)?;
        let carries = { self.grips.iter() }.any(|grip| grip.carrier() == Some(rigid));
        let expected = "fixed or kinematic, because the body carries a grip";
        let is_carrier = matches!(motion_type, MotionType::Fixed | MotionType::Kinematic);
        require(!carries || is_carrier, "motion_type", expected, motion_type)?;
        self.change_rigid(rigid, |body| body.set_motion_type::<D>(motion_type))
    }

    /// Sets the [friction](crate::RigidBody::friction) coefficient of a rigid body. The present contacts of
    /// the body are discarded and detected again. The body and sleeping objects in contact with it wake.
    ///
    /// # Errors
    /// [`Error`] if the handle is stale, or the coefficient is negative or not finite.
    #[inline(never)]
    pub fn set_friction(&mut self, rigid: RigidBodyHandle, friction: f32) -> Result<(), Error> {
        check_friction(friction)?;
        self.change_rigid(rigid, |body| {
            body.friction = friction;
            Ok(())
        })
    }

    /// Sets the [restitution](crate::RigidBody::restitution) coefficient of a rigid body. The present
    /// contacts of the body are discarded and detected again. The body and sleeping objects in contact with
    /// it wake.
    ///
    /// # Errors
    /// [`Error`] if the handle is stale, or the coefficient is not 0 to 1.
    #[inline(never)]
    pub fn set_restitution(
        &mut self,
        rigid: RigidBodyHandle,
        restitution: f32,
    ) -> Result<(), Error> {
        check_restitution(restitution)?;
        self.change_rigid(rigid, |body| {
            body.restitution = restitution;
            Ok(())
        })
    }

    /// Sets whether a rigid body [is a sensor](crate::RigidBody::is_sensor). The present contacts of the body
    /// are discarded and detected again. The body and sleeping objects in contact with it wake.
    ///
    /// # Errors
    /// [`Error::InvalidHandle`] if the handle is stale.
    #[inline(never)]
    pub fn set_sensor(&mut self, rigid: RigidBodyHandle, is_sensor: bool) -> Result<(), Error> {
        self.change_rigid(rigid, |body| {
            body.is_sensor = is_sensor;
            Ok(())
        })?;
        self.overlaps.place(rigid.into());
        Ok(())
    }

    /// Sets the collision layers of a body. The body and sleeping objects in contact with it wake.
    ///
    /// # Errors
    /// [`Error::InvalidHandle`] if the handle is stale.
    pub fn set_layers(&mut self, body: impl Into<BodyHandle>, layers: Layers) -> Result<(), Error> {
        self.set_layers_of(body.into(), layers)
    }

    #[inline(never)]
    pub(crate) fn set_layers_of(&mut self, body: BodyHandle, layers: Layers) -> Result<(), Error> {
        match body {
            BodyHandle::Soft(body) => {
                self.displace(body, |body| body.set_layers(layers))?;
                self.nearby.nodes.request_full_search();
                Ok(())
            }
            BodyHandle::Rigid(rigid) => {
                self.change_rigid(rigid, |body| {
                    body.layers = layers;
                    Ok(())
                })?;
                self.overlaps.place(rigid.into());
                Ok(())
            }
        }
    }

    /// Sets the user data of a body, a number that the engine ignores; see [`SoftBody::user_data`] and
    /// [`RigidBody::user_data`](crate::RigidBody::user_data).
    ///
    /// # Errors
    /// [`Error::InvalidHandle`] if the handle is stale.
    pub fn set_user_data(&mut self, body: impl Into<BodyHandle>, data: u64) -> Result<(), Error> {
        match body.into() {
            BodyHandle::Soft(body) => self.bodies.get_mut(body)?.set_user_data(data),
            BodyHandle::Rigid(rigid) => self.rigids.get_mut(rigid)?.user_data = data,
        }
        Ok(())
    }

    /// Sets the gravity scale of a soft body: 1 is normal, 0 is no gravity, negative values pull upwards. The body
    /// wakes.
    ///
    /// # Errors
    /// [`Error`] if the handle is stale, or the scale is not finite or beyond ±100.
    #[inline(never)]
    pub fn set_gravity_scale(
        &mut self,
        body: SoftBodyHandle,
        gravity_scale: f32,
    ) -> Result<(), Error> {
        let is_valid = gravity_scale.abs() <= MAX_GRAVITY_SCALE;
        require(is_valid, "gravity_scale", "-100 to 100", gravity_scale)?;
        self.wake_soft(body)?;
        self.bodies.get_mut(body)?.set_gravity_scale(gravity_scale);
        Ok(())
    }

    /// Wakes a body and restarts its sleep timers. The body then stays awake for at least half a second, even
    /// if it does not move. Rigid bodies that are not dynamic never sleep.
    ///
    /// # Errors
    /// [`Error::InvalidHandle`] if the handle is stale.
    pub fn wake_up(&mut self, body: impl Into<BodyHandle>) -> Result<(), Error> {
        self.wake_up_body(body.into())
    }

    #[inline(never)]
    pub(crate) fn wake_up_body(&mut self, body: BodyHandle) -> Result<(), Error> {
        match body {
            BodyHandle::Soft(body) => self.wake_soft(body),
            BodyHandle::Rigid(rigid) => {
                self.rigids.get(rigid)?;
                self.wake_rigids(&[rigid.slot()]);
                Ok(())
            }
        }
    }

    fn wake_soft(&mut self, body: SoftBodyHandle) -> Result<(), Error> {
        self.bodies.get(body)?;
        self.wake_body(body);
        self.keep_awake(body);
        Ok(())
    }

    /// Puts a soft body or a dynamic rigid body to sleep at its present position, at rest. A sleeping body
    /// takes almost no computing time, and acts as an immovable wall until something moves against it.
    /// [Fixed](SoftBody::fix_node) nodes stop, too.
    ///
    /// # Errors
    /// [`Error`] if the handle is stale, or the rigid body is not dynamic.
    pub fn put_to_sleep(&mut self, body: impl Into<BodyHandle>) -> Result<(), Error> {
        self.put_body_to_sleep(body.into())
    }

    #[inline(never)]
    pub(crate) fn put_body_to_sleep(&mut self, body: BodyHandle) -> Result<(), Error> {
        let body = match body {
            BodyHandle::Soft(body) => body,
            BodyHandle::Rigid(rigid) => {
                self.dynamic_mut(rigid)?.fall_asleep();
                return Ok(());
            }
        };
        let sleeper = self.bodies.get_mut(body)?;
        let awake = sleeper.pieces().list.iter().map(|piece| !piece.asleep);
        let awake: IndexVec<PieceId, bool> = awake.collect();
        sleeper.set_asleep(&awake, true);
        sleeper.refresh_awake();
        let fallen = awake.ids().filter(|&piece| awake[piece]);
        let fallen = fallen.map(|piece| Event::FellAsleep { body, piece });
        self.events.extend(fallen);
        Ok(())
    }

    /// Changes the configuration of the world from the next tick on. All pieces and rigid bodies wake. Bodies
    /// are scaled for the new maximum number of substeps, see [`WorldConfig::stiff_bodies`].
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] if a parameter is out of range. The world then stays unchanged.
    #[inline(never)]
    pub fn set_config(&mut self, config: WorldConfig<D>) -> Result<(), Error> {
        config.check()?;
        self.config = config;
        let mut all: Vec<Hit> = Vec::new();
        for (slot, body) in self.bodies.by_slot_mut() {
            body.scale_for(&config);
            let pieces = body.pieces().list.ids();
            all.extend(pieces.map(|piece| (slot, piece)));
        }
        self.wake(&all);
        self.wake_all_rigids();
        let all: Vec<SoftBodyHandle> = self.bodies.ids().collect();
        all.into_iter().for_each(|body| self.keep_awake(body));
        Ok(())
    }

    /// Changes the position or the layers of a soft body, discards its contacts, and wakes it. Also wakes the
    /// sleeping objects that are in contact with the body before or after the change.
    fn displace(
        &mut self,
        id: SoftBodyHandle,
        change: impl FnOnce(&mut SoftBody<D>),
    ) -> Result<(), Error> {
        let body = self.bodies.get(id)?;
        let own = id.slot();
        let supported = supported_by_body(body, &self.bodies);
        let supported: Vec<Hit> = supported.into_iter().filter(|hit| hit.0 != own).collect();
        let mut places = bounds_of(body, |_| true);
        self.nearby.remove_body(own);
        change(self.bodies.get_mut(id)?);
        self.wake_soft(id)?;
        places.extend(bounds_of(self.bodies.get(id)?, |_| true));
        self.wake_supported(supported, places);
        self.overlaps.place(id.into());
        Ok(())
    }

    /// Changes the pose or fields of a rigid body, discards its contacts, and wakes it. Also wakes the
    /// sleeping objects that are in contact with the body before or after the change. If `change` fails,
    /// nothing changes.
    fn change_rigid(
        &mut self,
        rigid: RigidBodyHandle,
        change: impl FnOnce(&mut RigidState) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let body = self.rigids.get(rigid)?;
        let was = body.shape().bounds();
        let supported = supported_by_rigid(body, &self.bodies);
        let body = self.rigids.get_mut(rigid)?;
        change(body)?;
        body.wake();
        let is = body.shape().bounds();
        self.wake(&supported);
        let supported = supported_by_rigid(self.rigids.get(rigid)?, &self.bodies);
        self.nearby.remove_rigid(rigid.slot());
        self.nearby.nodes.request_full_search();
        self.wake_supported(supported, vec![was, is]);
        Ok(())
    }

    /// Wakes a rigid body and returns it; an error unless the body is dynamic.
    fn dynamic_mut(&mut self, rigid: RigidBodyHandle) -> Result<&mut RigidState, Error> {
        let body = self.rigids.get(rigid)?;
        require(
            body.is_dynamic(),
            "motion_type",
            "dynamic",
            body.motion_type,
        )?;
        self.wake_rigids(&[rigid.slot()]);
        self.rigids.get_mut(rigid)
    }

    /// Restarts the sleep timers of all pieces of a body.
    fn keep_awake(&mut self, body: SoftBodyHandle) {
        if let Ok(body) = self.bodies.get_mut(body) {
            let pieces = body.pieces_mut().list.iter_mut();
            pieces.for_each(|piece| piece.sleep_timer = 0.0);
        }
    }
}

fn check_velocity(velocity: Twist) -> Result<(), Error> {
    within("linear", velocity.linear, "at most 1e6 m/s on each axis")?;
    within(
        "angular",
        velocity.angular,
        "at most 1e6 rad/s on each axis",
    )?;
    Ok(())
}

fn within(field: &'static str, vector: Vec3, expected: &'static str) -> Result<Vec3, Error> {
    let is_within = is_within_reach(vector);
    require(is_within, field, expected, vector).map(|()| vector)
}
