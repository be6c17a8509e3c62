//! Actions on bodies from outside: translation, rotation, velocity, impulse, sleep.

use super::{Refused, World, WorldConfig};
use crate::contact::broad_phase::{bounds_of, leaning_on_body, leaning_on_rigid};
use crate::contact::solver::Hit;
use crate::event::Event;
use crate::foundation::arena::{RigidBodyHandle, SoftBodyHandle};
use crate::foundation::dim::{Dim, turning};
use crate::foundation::ids::{IndexVec, PieceId};
use crate::math::rotation::Rotation;
use crate::rigid_body::layers::Layers;
use crate::rigid_body::shape::{Bounds, Vector, flat};
use crate::rigid_body::{FARTHEST, RigidBody};
use crate::soft_body::{MAX_GRAVITY_SCALE, SoftBody};

impl<D: Dim> World<D> {
    /// Translates a body `by` [m] at once, through anything in between. The body and sleepers in contact with
    /// it wake. Bookmarks stay valid, because only positions change.
    ///
    /// # Errors
    /// [`Refused`] if the handle is stale, or a coordinate is not finite or beyond ±1e6 m.
    #[inline(never)]
    pub fn translate_body(&mut self, body: SoftBodyHandle, by: Vector) -> Result<(), Refused> {
        let by = within("distance", by, FARTHEST, "at most 1e6 m on each axis")?;
        self.displace(body, |body| body.shift(by))
    }

    /// Rotates a body about a point [m] at once, its velocities included; otherwise like
    /// [`World::translate_body`]. See also [`SoftBody::rotated`].
    ///
    /// # Errors
    /// As for [`World::translate_body`].
    #[inline(never)]
    pub fn rotate_body(
        &mut self,
        body: SoftBodyHandle,
        rotation: Rotation,
        about: Vector,
    ) -> Result<(), Refused> {
        let about = within("centre", about, FARTHEST, "within 1e6 m of the origin")?;
        self.displace(body, |body| body.turn(rotation, about))
    }

    /// Adds a linear velocity [m/s], and an angular velocity [rad/s] about the centre of mass, to all nodes
    /// of a body. In 2D only the third component of `angular` counts. The body wakes.
    ///
    /// # Errors
    /// [`Refused`] if the handle is stale, or a component is not finite or beyond ±1e6.
    #[inline(never)]
    pub fn add_velocity(
        &mut self,
        body: SoftBodyHandle,
        linear: Vector,
        angular: Vector,
    ) -> Result<(), Refused> {
        let linear = within("velocity", linear, FARTHEST, "at most 1e6 m/s on each axis")?;
        let angular = within("spin", angular, FARTHEST, "at most 1e6 rad/s on each axis")?;
        self.wake_up(body)?;
        self.bodies.get_mut(body)?.add_velocity(linear, angular);
        Ok(())
    }

    /// Applies an impulse [N s] at a point [m]. It is distributed over the nodes within `radius` [m] so that
    /// all gain the same velocity; without nodes in the radius the nearest node gets all of it. A strong
    /// impulse can squash or tear the body there. The body wakes.
    ///
    /// ```
    /// use fuwafuwa::{SoftBody, Dim2, Material, WorldConfig, VoxelGrid, World};
    ///
    /// let grid = VoxelGrid::<Dim2>::ball(16, 1.0)?;
    /// let mut world = World::new(WorldConfig { gravity: [0.0; 3], ..WorldConfig::default() })?;
    /// let ball = world.add_body(SoftBody::new(grid, &[Material::default()])?);
    /// world.apply_impulse(ball, [0.5, 0.5, 0.0], 1.0, [2.0, 0.0, 0.0])?;
    /// let momentum = world.bodies()[ball].momentum().linear[0];
    /// assert!((momentum - 2.0).abs() < 1e-4);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`Refused`] if the handle is stale, a number is not finite or beyond ±1e6, or the radius is negative.
    #[inline(never)]
    pub fn apply_impulse(
        &mut self,
        body: SoftBodyHandle,
        at: Vector,
        radius: f32,
        impulse: Vector,
    ) -> Result<(), Refused> {
        let at = within("place", at, FARTHEST, "within 1e6 m of the origin")?;
        let impulse = within("impulse", impulse, FARTHEST, "at most 1e6 N s on each axis")?;
        require((0.0..=FARTHEST).contains(&radius), "radius", "0 to 1e6 m")?;
        self.wake_up(body)?;
        self.bodies.get_mut(body)?.add_impulse(at, radius, impulse);
        Ok(())
    }

    /// Moves a rigid body to a position [m] and a rotation relative to its form, at once. Its velocity stays,
    /// and a kinematic or coupled body gets the new pose as its target. The body and sleepers in contact with
    /// it wake.
    ///
    /// # Errors
    /// [`Refused`] if the handle is stale or the position is out of range. The body then stays unchanged.
    #[inline(never)]
    pub fn set_rigid_body_pose(
        &mut self,
        rigid: RigidBodyHandle,
        position: Vector,
        rotation: Rotation,
    ) -> Result<(), Refused> {
        let before = self.rigids.get(rigid)?;
        let was = before.shape().bounds();
        let leaning = leaning_on_rigid(before, &self.bodies);
        self.rigids.get_mut(rigid)?.place::<D>(position, rotation)?;
        self.wake(&leaning);
        self.forget_rigid(rigid, was)
    }

    /// Sets the linear velocity [m/s] and the angular velocity [rad/s] of a dynamic rigid body. In 2D only
    /// the third component of `angular` counts. The body wakes.
    ///
    /// # Errors
    /// [`Refused`] if the handle is stale, the body is not dynamic, or a component is not finite or beyond
    /// ±1e6.
    #[inline(never)]
    pub fn set_velocity(
        &mut self,
        rigid: RigidBodyHandle,
        linear: Vector,
        angular: Vector,
    ) -> Result<(), Refused> {
        let linear = within("velocity", linear, FARTHEST, "at most 1e6 m/s on each axis")?;
        let angular = within("spin", angular, FARTHEST, "at most 1e6 rad/s on each axis")?;
        let free = self.free_mut(rigid)?;
        free.velocity = flat::<D>(linear);
        free.angular_velocity = turning::<D>(angular);
        Ok(())
    }

    /// Applies an impulse [N s] to a dynamic rigid body at a point [m]. The body wakes.
    ///
    /// # Errors
    /// As for [`World::set_velocity`].
    #[inline(never)]
    pub fn apply_rigid_body_impulse(
        &mut self,
        rigid: RigidBodyHandle,
        at: Vector,
        impulse: Vector,
    ) -> Result<(), Refused> {
        let at = within("place", at, FARTHEST, "within 1e6 m of the origin")?;
        let impulse = within("impulse", impulse, FARTHEST, "at most 1e6 N s on each axis")?;
        let free = self.free_mut(rigid)?;
        let lever = flat::<D>(at) - free.position();
        free.kick(flat::<D>(impulse), lever);
        Ok(())
    }

    /// Changes the public fields of a rigid body: friction, restitution, motion type, layers, sensor flag and
    /// user data. Its contacts restart; the body and sleepers in contact with it wake.
    ///
    /// ```
    /// use fuwafuwa::{Dim2, MotionType, RigidBody, WorldConfig, Shape, World};
    ///
    /// let mut world = World::<Dim2>::new(WorldConfig::default())?;
    /// let ball = Shape::Ball { centre: [0.0; 3], radius: 0.2 };
    /// let ball = world.add_rigid(RigidBody::dynamic(ball, 1.0))?;
    /// world.change_rigid(ball, |ball| ball.drive = MotionType::Fixed)?;
    /// world.step();
    /// assert_eq!(world.rigids()[ball].position(), [0.0; 3]);
    /// assert!(world.change_rigid(ball, |ball| ball.friction = -1.0).is_err());
    /// # Ok::<(), fuwafuwa::Refused>(())
    /// ```
    ///
    /// # Errors
    /// [`Refused`] if the handle is stale or a field is out of range. The body then stays unchanged.
    #[inline(never)]
    pub fn change_rigid(
        &mut self,
        rigid: RigidBodyHandle,
        change: impl FnOnce(&mut RigidBody),
    ) -> Result<(), Refused> {
        let mut changed = self.rigids.get(rigid)?.clone();
        let (drive, was) = (changed.motion_type, changed.shape().bounds());
        change(&mut changed);
        if changed.motion_type != drive {
            changed.stay();
        }
        let mut changed = changed.seen_in::<D>();
        changed.check()?;
        changed.wake();
        *self.rigids.get_mut(rigid)? = changed;
        self.forget_rigid(rigid, was)
    }

    /// Sets the collision layers of a body. The body and sleepers in contact with it wake.
    ///
    /// # Errors
    /// [`Refused::Gone`] if the handle is stale.
    #[inline(never)]
    pub fn set_layers(&mut self, body: SoftBodyHandle, layers: Layers) -> Result<(), Refused> {
        self.displace(body, |body| body.state.layers = layers)?;
        self.nearby.nodes.look_again();
        Ok(())
    }

    /// Sets the [`SoftBody::user_data`] of a body.
    ///
    /// # Errors
    /// [`Refused::Gone`] if the handle is stale.
    #[inline(never)]
    pub fn set_user_data(&mut self, body: SoftBodyHandle, data: u64) -> Result<(), Refused> {
        self.bodies.get_mut(body)?.state.user_data = data;
        Ok(())
    }

    /// Sets the gravity scale of a body: 1 is normal, 0 is no gravity, negative values pull upwards. The body
    /// wakes.
    ///
    /// # Errors
    /// [`Refused`] if the handle is stale, or the scale is not finite or beyond ±100.
    #[inline(never)]
    pub fn set_gravity_scale(&mut self, body: SoftBodyHandle, scale: f32) -> Result<(), Refused> {
        require(
            scale.abs() <= MAX_GRAVITY_SCALE,
            "gravity scale",
            "-100 to 100",
        )?;
        self.wake_up(body)?;
        self.bodies.get_mut(body)?.state.gravity_scale = scale;
        Ok(())
    }

    /// Wakes a body and restarts its sleep timers. It then stays awake for at least half a second, even if it
    /// does not move.
    ///
    /// # Errors
    /// [`Refused::Gone`] if the handle is stale.
    #[inline(never)]
    pub fn wake_up(&mut self, body: SoftBodyHandle) -> Result<(), Refused> {
        self.bodies.get(body)?;
        self.wake_body(body);
        self.keep_awake(body);
        Ok(())
    }

    /// Puts a body to sleep at its present position, at rest. A sleeping body costs next to nothing and acts
    /// as a wall until something moves against it. Its [fixed](SoftBody::fix_node) nodes stop, too.
    ///
    /// # Errors
    /// [`Refused::Gone`] if the handle is stale.
    #[inline(never)]
    pub fn put_to_sleep(&mut self, body: SoftBodyHandle) -> Result<(), Refused> {
        let sleeper = self.bodies.get_mut(body)?;
        let awake = sleeper
            .topology
            .pieces
            .list
            .iter()
            .map(|piece| !piece.asleep);
        let awake: IndexVec<PieceId, bool> = awake.collect();
        sleeper.set_asleep(&awake, true);
        sleeper.refresh_awake();
        let fallen = awake.ids().filter(|&piece| awake[piece]);
        let fallen = fallen.map(|piece| Event::FellAsleep { body, piece });
        self.events.extend(fallen);
        Ok(())
    }

    /// Changes the world settings from the next tick on. Everything wakes. Bodies are softened or stiffened
    /// for the new maximum number of substeps, see [`SoftBody::stiffness_scale`].
    ///
    /// # Errors
    /// [`Refused::Setting`] if a setting is out of range. Everything then stays unchanged.
    #[inline(never)]
    pub fn set_config(&mut self, settings: WorldConfig) -> Result<(), Refused> {
        settings.check().map_err(Refused::setting)?;
        self.settings = settings;
        let shortest = settings.shortest_substep();
        let mut all: Vec<Hit> = Vec::new();
        for (slot, body) in self.bodies.by_slot_mut() {
            body.scale_stiffness_for(shortest);
            let pieces = body.topology.pieces.list.ids();
            all.extend(pieces.map(|piece| (slot, piece)));
        }
        self.wake(&all);
        self.wake_all_rigids();
        let all: Vec<SoftBodyHandle> = self.bodies.ids().collect();
        all.into_iter().for_each(|body| self.keep_awake(body));
        Ok(())
    }

    /// Changes the position or the layers of a body, discards its contacts, and wakes it together with
    /// sleepers in contact with it.
    fn displace(
        &mut self,
        id: SoftBodyHandle,
        change: impl FnOnce(&mut SoftBody<D>),
    ) -> Result<(), Refused> {
        let body = self.bodies.get(id)?;
        let own = id.slot();
        let leaning = leaning_on_body(body, &self.bodies);
        let leaning: Vec<Hit> = leaning.into_iter().filter(|hit| hit.0 != own).collect();
        let mut places = bounds_of(body, |_| true);
        self.nearby.remove_body(own);
        change(self.bodies.get_mut(id)?);
        self.wake_up(id)?;
        places.extend(bounds_of(self.bodies.get(id)?, |_| true));
        self.wake_leaning(leaning, places);
        Ok(())
    }

    /// Discards the contacts of a rigid body after a change of its pose or fields, and wakes sleepers in
    /// contact with its old and its new bounds.
    fn forget_rigid(&mut self, id: RigidBodyHandle, was: Bounds) -> Result<(), Refused> {
        let rigid = self.rigids.get(id)?;
        let is = rigid.shape().bounds();
        let leaning = leaning_on_rigid(rigid, &self.bodies);
        self.nearby.remove_rigid(id.slot());
        self.nearby.nodes.look_again();
        self.wake_leaning(leaning, vec![was, is]);
        Ok(())
    }

    /// Returns a dynamic rigid body and wakes it.
    fn free_mut(&mut self, rigid: RigidBodyHandle) -> Result<&mut RigidBody, Refused> {
        require(
            self.rigids.get(rigid)?.is_dynamic(),
            "rigid body",
            "free (dynamic)",
        )?;
        self.wake_rigids(&[rigid.slot()]);
        Ok(self.rigids.get_mut(rigid)?)
    }

    /// Restarts the sleep timers of a body.
    fn keep_awake(&mut self, body: SoftBodyHandle) {
        if let Ok(body) = self.bodies.get_mut(body) {
            let pieces = body.topology.pieces.list.iter_mut();
            pieces.for_each(|piece| piece.sleep_timer = 0.0);
        }
    }
}

fn require(is_good: bool, field: &'static str, expected: &'static str) -> Result<(), Refused> {
    is_good
        .then_some(())
        .ok_or(Refused::Argument { field, expected })
}

fn within(
    field: &'static str,
    vector: Vector,
    most: f32,
    expected: &'static str,
) -> Result<Vector, Refused> {
    let is_good = vector.to_array().iter().all(|k| k.abs() <= most);
    require(is_good, field, expected).map(|()| vector)
}
