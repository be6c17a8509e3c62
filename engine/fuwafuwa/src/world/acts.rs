//! What is done to bodies from outside: moved, turned, thrown, pushed, put to sleep.

use super::{Refused, Settings, World};
use crate::body::{Body, MOST_GRAVITY};
use crate::contact::Hit;
use crate::dim::{Dim, turning};
use crate::event::Event;
use crate::handle::{BodyId, RigidId};
use crate::ids::{PieceId, Table};
use crate::layers::Layers;
use crate::rigid::{FARTHEST, Rigid};
use crate::rotation::Rotation;
use crate::shape::{Bounds, Vector, flat};
use crate::touch::{bounds_of, leaning_on_body, leaning_on_rigid};
use crate::vector::minus;

impl<D: Dim> World<D> {
    /// Moves a body `by` [m] at once, through whatever is in between. It and what leant on it wake; who follows it by a
    /// bookmark need not begin anew, since nothing in it changes but places.
    ///
    /// # Errors
    /// [`Refused`] when there is no such body, or when one coordinate is more than 1e6 m or not finite.
    #[inline(never)]
    pub fn move_body(&mut self, body: BodyId, by: Vector) -> Result<(), Refused> {
        let by = within("distance", by, FARTHEST, "at most 1e6 m on each axis")?;
        self.displace(body, |body| body.shift(by))
    }

    /// Turns a body about a place [m] at once, with its velocities; as [`World::move_body`] and [`Body::rotated`].
    ///
    /// # Errors
    /// As [`World::move_body`].
    #[inline(never)]
    pub fn rotate_body(
        &mut self,
        body: BodyId,
        rotation: Rotation,
        about: Vector,
    ) -> Result<(), Refused> {
        let about = within("centre", about, FARTHEST, "within 1e6 m of the origin")?;
        self.displace(body, |body| body.turn(rotation, about))
    }

    /// Adds `linear` [m/s], and `angular` [rad/s] about the centre of mass, to the velocity of all of a body; in the plane
    /// the third component of `angular` counts alone. It wakes.
    ///
    /// # Errors
    /// [`Refused`] when there is no such body, or when a component is more than 1e6 or not finite.
    #[inline(never)]
    pub fn add_velocity(
        &mut self,
        body: BodyId,
        linear: Vector,
        angular: Vector,
    ) -> Result<(), Refused> {
        let linear = within("velocity", linear, FARTHEST, "at most 1e6 m/s on each axis")?;
        let angular = within("spin", angular, FARTHEST, "at most 1e6 rad/s on each axis")?;
        self.wake_up(body)?;
        self.bodies.get_mut(body)?.add_velocity(linear, angular);
        Ok(())
    }

    /// Gives a body an impulse [N s] at a place [m], spread over its nodes within `radius` [m] so that they gain the same
    /// velocity: it is squashed or torn there if that is more than it bears. Where no node is within, the nearest one has
    /// all of it. The body wakes.
    ///
    /// ```
    /// use fuwafuwa::{Body, Dim2, Material, Settings, VoxelGrid, World};
    ///
    /// let grid = VoxelGrid::<Dim2>::ball(16, 1.0)?;
    /// let mut world = World::new(Settings { gravity: [0.0; 3], ..Settings::default() })?;
    /// let ball = world.add_body(Body::new(grid, &[Material::default()])?);
    /// world.apply_impulse(ball, [0.5, 0.5, 0.0], 1.0, [2.0, 0.0, 0.0])?;
    /// let momentum = world.bodies()[ball].momentum().linear[0];
    /// assert!((momentum - 2.0).abs() < 1e-4);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`Refused`] when there is no such body, when a number is not finite or more than 1e6, or when the radius is negative.
    #[inline(never)]
    pub fn apply_impulse(
        &mut self,
        body: BodyId,
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

    /// Puts something rigid somewhere [m] at once, turned from its form as `rotation` says, with the velocity that it has; a
    /// hand with its goal. Everything wakes that leant on it, and all that is free.
    ///
    /// # Errors
    /// [`Refused`], and it stays where it was, when there is no such thing or the position is out of reach.
    #[inline(never)]
    pub fn place_rigid(
        &mut self,
        rigid: RigidId,
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

    /// Sets the velocity [m/s] and the angular velocity [rad/s] of something that is free; in the plane the third component
    /// of that counts alone. It wakes.
    ///
    /// # Errors
    /// [`Refused`] when there is no such thing, when it is not free, or when a component is more than 1e6 or not finite.
    #[inline(never)]
    pub fn set_velocity(
        &mut self,
        rigid: RigidId,
        linear: Vector,
        angular: Vector,
    ) -> Result<(), Refused> {
        let linear = within("velocity", linear, FARTHEST, "at most 1e6 m/s on each axis")?;
        let angular = within("spin", angular, FARTHEST, "at most 1e6 rad/s on each axis")?;
        let free = self.free_mut(rigid)?;
        free.velocity = flat::<D>(linear);
        free.spin = turning::<D>(angular);
        Ok(())
    }

    /// Gives something that is free an impulse [N s] at a place [m]. It wakes.
    ///
    /// # Errors
    /// As [`World::set_velocity`].
    #[inline(never)]
    pub fn push_rigid(
        &mut self,
        rigid: RigidId,
        at: Vector,
        impulse: Vector,
    ) -> Result<(), Refused> {
        let at = within("place", at, FARTHEST, "within 1e6 m of the origin")?;
        let impulse = within("impulse", impulse, FARTHEST, "at most 1e6 N s on each axis")?;
        let free = self.free_mut(rigid)?;
        let lever = minus(flat::<D>(at), free.position());
        free.kick(flat::<D>(impulse), lever);
        Ok(())
    }

    /// Changes what may be changed of something rigid: friction, restitution, drive, layers, whether it is a sensor. What it
    /// touched counts as new; it wakes, with all that leant on it.
    ///
    /// ```
    /// use fuwafuwa::{Dim2, Drive, Rigid, Settings, Shape, World};
    ///
    /// let mut world = World::<Dim2>::new(Settings::default())?;
    /// let ball = Shape::Ball { centre: [0.0; 3], radius: 0.2 };
    /// let ball = world.add_rigid(Rigid::free(ball, 1.0))?;
    /// world.change_rigid(ball, |ball| ball.drive = Drive::Fixed)?;
    /// world.step();
    /// assert_eq!(world.rigids()[ball].position(), [0.0; 3]);
    /// assert!(world.change_rigid(ball, |ball| ball.friction = -1.0).is_err());
    /// # Ok::<(), fuwafuwa::Refused>(())
    /// ```
    ///
    /// # Errors
    /// [`Refused`], and it stays as it was, when there is no such thing or a field is out of range.
    #[inline(never)]
    pub fn change_rigid(
        &mut self,
        rigid: RigidId,
        change: impl FnOnce(&mut Rigid),
    ) -> Result<(), Refused> {
        let mut changed = self.rigids.get(rigid)?.clone();
        let (drive, was) = (changed.drive, changed.shape().bounds());
        change(&mut changed);
        if changed.drive != drive {
            changed.stay();
        }
        let mut changed = changed.seen_in::<D>();
        changed.check()?;
        changed.wake();
        *self.rigids.get_mut(rigid)? = changed;
        self.forget_rigid(rigid, was)
    }

    /// Says which layers a body is in and which it meets. It and what leant on it wake.
    ///
    /// # Errors
    /// [`Refused::Gone`] when there is no such body.
    #[inline(never)]
    pub fn set_layers(&mut self, body: BodyId, layers: Layers) -> Result<(), Refused> {
        self.displace(body, |body| body.state.layers = layers)?;
        self.nearby.nodes.look_again();
        Ok(())
    }

    /// Keeps a number with a body: [`Body::user_data`].
    ///
    /// # Errors
    /// [`Refused::Gone`] when there is no such body.
    #[inline(never)]
    pub fn set_user_data(&mut self, body: BodyId, data: u64) -> Result<(), Refused> {
        self.bodies.get_mut(body)?.state.user_data = data;
        Ok(())
    }

    /// Lets gravity pull on a body `scale` times as strongly as on others: 0 not at all, negative upwards. It wakes.
    ///
    /// # Errors
    /// [`Refused`] when there is no such body, or when the scale is beyond ±100 or not finite.
    #[inline(never)]
    pub fn set_gravity_scale(&mut self, body: BodyId, scale: f32) -> Result<(), Refused> {
        require(scale.abs() <= MOST_GRAVITY, "gravity scale", "-100 to 100")?;
        self.wake_up(body)?;
        self.bodies.get_mut(body)?.state.gravity_scale = scale;
        Ok(())
    }

    /// Wakes a body, and keeps it awake for half a second at the least, however slow it is.
    ///
    /// # Errors
    /// [`Refused::Gone`] when there is no such body.
    #[inline(never)]
    pub fn wake_up(&mut self, body: BodyId) -> Result<(), Refused> {
        self.bodies.get(body)?;
        self.wake_body(body);
        self.keep_awake(body);
        Ok(())
    }

    /// Puts a body to sleep where it is, at rest: it costs next to nothing, and stands like a wall until something moves
    /// against it. Nodes that are [held](Body::hold) stop too.
    ///
    /// # Errors
    /// [`Refused::Gone`] when there is no such body.
    #[inline(never)]
    pub fn put_to_sleep(&mut self, body: BodyId) -> Result<(), Refused> {
        let sleeper = self.bodies.get_mut(body)?;
        let awake = sleeper.truth.pieces.list.iter().map(|piece| !piece.asleep);
        let awake: Table<PieceId, bool> = awake.collect();
        sleeper.set_asleep(&awake, true);
        sleeper.refresh_awake();
        let fallen = awake.ids().filter(|&piece| awake[piece]);
        let fallen = fallen.map(|piece| Event::FellAsleep { body, piece });
        self.events.extend(fallen);
        Ok(())
    }

    /// Changes what holds for the whole world, from the next tick on. Everything wakes. Bodies are softened or stiffened as
    /// the most substeps ask for now: see [`Body::stiffness_scale`].
    ///
    /// # Errors
    /// [`Refused::Setting`], and all stays as it was, when a setting is out of range.
    #[inline(never)]
    pub fn set_settings(&mut self, settings: Settings) -> Result<(), Refused> {
        settings.check().map_err(Refused::setting)?;
        self.settings = settings;
        let shortest = settings.shortest_substep();
        let mut all: Vec<Hit> = Vec::new();
        for (slot, body) in self.bodies.by_slot_mut() {
            body.scale_stiffness_for(shortest);
            let pieces = body.truth.pieces.list.ids();
            all.extend(pieces.map(|piece| (slot, piece)));
        }
        self.wake(&all);
        self.wake_all_rigids();
        let all: Vec<BodyId> = self.bodies.ids().collect();
        all.into_iter().for_each(|body| self.keep_awake(body));
        Ok(())
    }

    /// Changes where a body is: those that leant on it wake, as it does itself, and nothing of what pressed on it counts.
    fn displace(&mut self, id: BodyId, change: impl FnOnce(&mut Body<D>)) -> Result<(), Refused> {
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

    /// Something rigid is not what or where it was: nothing of what pressed on it counts, and who leans on it wakes.
    fn forget_rigid(&mut self, id: RigidId, was: Bounds) -> Result<(), Refused> {
        let rigid = self.rigids.get(id)?;
        let is = rigid.shape().bounds();
        let leaning = leaning_on_rigid(rigid, &self.bodies);
        self.nearby.remove_rigid(id.slot());
        self.nearby.nodes.look_again();
        self.wake_leaning(leaning, vec![was, is]);
        Ok(())
    }

    /// Something that is free, awake.
    fn free_mut(&mut self, rigid: RigidId) -> Result<&mut Rigid, Refused> {
        require(
            self.rigids.get(rigid)?.is_free(),
            "rigid thing",
            "one that is free",
        )?;
        self.wake_rigids(&[rigid.slot()]);
        Ok(self.rigids.get_mut(rigid)?)
    }

    /// Counts anew for how long a body has been slow.
    fn keep_awake(&mut self, body: BodyId) {
        if let Ok(body) = self.bodies.get_mut(body) {
            let pieces = body.truth.pieces.list.iter_mut();
            pieces.for_each(|piece| piece.still = 0.0);
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
    let is_good = vector.iter().all(|k| k.abs() <= most);
    require(is_good, field, expected).map(|()| vector)
}
