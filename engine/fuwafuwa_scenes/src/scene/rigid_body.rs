//! Rigid bodies of a scene file: fixed, kinematic, coupled, dynamic, and sensors.

use super::body::LayersText;
use super::build::{require_turning, rotation_of};
use super::error::{FieldError, require, vector_of};
use super::shapes::{BallText, BoxText, CapsuleText, HalfSpaceText, ShapeChoice};
use super::state;
use fuwafuwa::{
    Dim, DimAngular, DimVector, MotionType, RigidBody, RigidBodyHandle, RigidBodyRef, Rotation,
    Shape, Vec3, Velocity, World, WorldConfig,
};
use serde::{Deserialize, Serialize};

/// A `[[rigid_body]]` table: a motion type and one of the four shapes, given as if it stood at the origin. A
/// table with a `state` has no other fields.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct RigidBodyText {
    /// Half-space below a plane; only for fixed rigid bodies.
    pub half_space: Option<HalfSpaceText>,
    /// Axis-aligned box.
    #[serde(rename = "box")]
    pub boxed: Option<BoxText>,
    /// Capsule.
    pub capsule: Option<CapsuleText>,
    /// Ball.
    pub ball: Option<BallText>,
    /// Complete state of a rigid body; see [`Scene::of_world`](super::Scene::of_world).
    pub state: Option<String>,
    /// Motion type, default fixed.
    #[serde(alias = "drive")]
    pub motion_type: MotionTypeText,
    /// Mass [kg]; required for `motion_type = "dynamic"`, allowed for `"coupled"`.
    pub mass: Option<f32>,
    /// Stiffness of the coupling spring [N/m]; only for `motion_type = "coupled"`.
    pub stiffness: Option<f32>,
    /// Damping ratio of the coupling spring; only for `motion_type = "coupled"`.
    pub damping: Option<f32>,
    /// Maximum force of the coupling spring [N]; only for `motion_type = "coupled"`.
    #[serde(alias = "limit")]
    pub max_force: Option<f32>,
    /// Translation from the origin [m].
    pub at: [f32; 3],
    /// Rotation before the translation: axis times angle [rad]; in 2D only about the third axis.
    #[serde(alias = "turned")]
    pub rotation_vector: Option<[f32; 3]>,
    /// Exact rotation, in place of `rotation_vector`.
    pub rotation: Option<Rotation>,
    /// Velocity [m/s]; not for `motion_type = "fixed"`.
    pub velocity: Option<[f32; 3]>,
    /// Angular velocity [rad/s], in 2D only about the third axis; only for `motion_type = "dynamic"` or
    /// `"kinematic"`.
    #[serde(alias = "spin")]
    pub angular_velocity: Option<[f32; 3]>,
    /// Target position [m] of a kinematic or coupled rigid body; its present position if missing.
    pub target_position: Option<[f32; 3]>,
    /// Target rotation of a kinematic or coupled rigid body; its present rotation if missing.
    pub target_rotation: Option<Rotation>,
    /// Coulomb friction; default 0.5 for dynamic rigid bodies, otherwise 0.2.
    pub friction: Option<f32>,
    /// Coefficient of restitution against other rigid bodies, default 0.
    pub restitution: Option<f32>,
    /// Whether the body is a sensor: it has no contact forces and reports bodies that enter and exit.
    pub sensor: bool,
    /// Contact layers.
    pub layers: Option<LayersText>,
    /// User-defined number, which the engine ignores.
    pub user_data: Option<u64>,
}

/// Motion type of a rigid body; see [`fuwafuwa::MotionType`].
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MotionTypeText {
    /// Fixed rigid body.
    #[default]
    Fixed,
    /// Kinematic rigid body: it follows its target exactly.
    Kinematic,
    /// Coupled rigid body: a spring pulls it to its target.
    #[serde(alias = "hand")]
    Coupled,
    /// Dynamic rigid body.
    #[serde(alias = "free")]
    Dynamic,
}

impl RigidBodyText {
    pub(super) fn add_to<D: Dim>(
        &self,
        world: &mut World<D>,
    ) -> Result<RigidBodyHandle, FieldError> {
        if let Some(state) = &self.state {
            let alone = Self {
                state: self.state.clone(),
                ..Self::default()
            };
            let expected = "expected no other field: state is the whole rigid body";
            require(*self == alone, "state", expected)?;
            return state::add_rigid_body(state, world);
        }
        let added = world.add_rigid_body(self.rigid_body::<D>()?);
        added.map_err(|error| FieldError::engine("shape", error))
    }

    fn rigid_body<D: Dim>(&self) -> Result<RigidBody<D>, FieldError> {
        let at = vector_of::<D>("at", self.at)?;
        let shapes = ShapeChoice {
            half_space: self.half_space.as_ref(),
            boxed: self.boxed.as_ref(),
            capsule: self.capsule.as_ref(),
            ball: self.ball.as_ref(),
        };
        let rotation = match (self.rotation_vector, self.rotation) {
            (Some(_), Some(_)) => {
                let expected = "expected either rotation_vector or rotation";
                return Err(FieldError::new("rotation", expected));
            }
            (Some(vector), None) => rotation_of::<D>(vector)?,
            (None, rotation) => rotation.unwrap_or(Rotation::NONE),
        };
        let mut body = RigidBody::new(shapes.only()?, self.motion_type()?).at(at);
        if rotation != Rotation::NONE {
            body = body.rotated(rotation);
        }
        let target = self.target_position;
        let target = target.map(|target| vector_of::<D>("target_position", target));
        let follows = matches!(
            self.motion_type,
            MotionTypeText::Kinematic | MotionTypeText::Coupled
        );
        let expected = "allowed only with motion_type = \"kinematic\" or \"coupled\"";
        require(follows || target.is_none(), "target_position", expected)?;
        let good = follows || self.target_rotation.is_none();
        require(good, "target_rotation", expected)?;
        let is_dynamic = self.motion_type == MotionTypeText::Dynamic;
        let usual = if is_dynamic { 0.5 } else { 0.2 };
        Ok(RigidBody {
            velocity: self.velocity()?,
            target_position: target.transpose()?,
            target_rotation: self.target_rotation,
            friction: self.friction.unwrap_or(usual),
            restitution: self.restitution.unwrap_or(0.0),
            is_sensor: self.sensor,
            layers: self.layers.map(Into::into).unwrap_or_default(),
            user_data: self.user_data.unwrap_or(0),
            ..body
        })
    }

    fn motion_type(&self) -> Result<MotionType, FieldError> {
        let of_coupling = [self.stiffness, self.damping, self.max_force];
        let is_coupled = self.motion_type == MotionTypeText::Coupled;
        let good = is_coupled || of_coupling == [None; 3];
        let expected = "allowed only with motion_type = \"coupled\"";
        require(good, "stiffness", expected)?;
        let has_mass = is_coupled || self.motion_type == MotionTypeText::Dynamic;
        let expected = "allowed only with motion_type = \"dynamic\" or \"coupled\"";
        require(has_mass || self.mass.is_none(), "mass", expected)?;
        Ok(match self.motion_type {
            MotionTypeText::Fixed => MotionType::Fixed,
            MotionTypeText::Kinematic => MotionType::Kinematic,
            MotionTypeText::Dynamic => {
                let expected = "missing mass [kg], required with motion_type = \"dynamic\"";
                let missing = || FieldError::new("mass", expected);
                let mass = self.mass.ok_or_else(missing)?;
                MotionType::Dynamic { mass }
            }
            MotionTypeText::Coupled => {
                let mut motion_type = MotionType::default();
                if let MotionType::Coupled {
                    mass,
                    stiffness,
                    damping,
                    max_force,
                } = &mut motion_type
                {
                    *mass = self.mass.unwrap_or(*mass);
                    *stiffness = self.stiffness.unwrap_or(*stiffness);
                    *damping = self.damping.unwrap_or(*damping);
                    *max_force = self.max_force.unwrap_or(*max_force);
                }
                motion_type
            }
        })
    }

    fn velocity<D: Dim>(&self) -> Result<Velocity<D>, FieldError> {
        let is = |motion_type| self.motion_type == motion_type;
        let good = self.velocity.is_none() || !is(MotionTypeText::Fixed);
        let expected = "not allowed with motion_type = \"fixed\"";
        require(good, "velocity", expected)?;
        let linear = vector_of::<D>("velocity", self.velocity.unwrap_or_default())?;
        let turns = is(MotionTypeText::Dynamic) || is(MotionTypeText::Kinematic);
        let good = self.angular_velocity.is_none() || turns;
        let expected = "allowed only with motion_type = \"dynamic\" or \"kinematic\"";
        require(good, "angular_velocity", expected)?;
        let angular = self.angular_velocity.unwrap_or_default();
        require_turning::<D>("angular_velocity", angular)?;
        let angular = D::Angular::from_vec3(Vec3::from(angular));
        Ok(Velocity { linear, angular })
    }

    /// Returns the text of a rigid body: its fields if they reproduce it exactly, otherwise its state.
    pub(super) fn of<D: Dim>(body: RigidBodyRef<'_, D>) -> Option<Self> {
        let words = Self::by_fields(body);
        match words.as_ref().is_some_and(|words| words.reproduces(body)) {
            true => words,
            false => Some(Self {
                state: Some(state::of_rigid_body(body)?),
                ..Self::default()
            }),
        }
    }

    /// Returns whether this text reproduces a rigid body, except for its sleep timer.
    fn reproduces<D: Dim>(&self, body: RigidBodyRef<'_, D>) -> bool {
        let Ok(mut world) = World::new(WorldConfig::default()) else {
            return false;
        };
        let added = self.add_to(&mut world).ok();
        let made = added.and_then(|id| world.rigid_body(id).ok());
        made.is_some_and(|made| made.definition() == body.definition())
    }

    fn by_fields<D: Dim>(body: RigidBodyRef<'_, D>) -> Option<Self> {
        let RigidBody {
            motion_type,
            shape,
            position,
            rotation,
            velocity,
            target_position,
            target_rotation,
            friction,
            restitution,
            layers,
            is_sensor,
            user_data,
        } = body.definition();
        let numbers = |vector: D::Vector| vector.to_vec3().to_array();
        let unless_zero = |vector: Vec3| (vector != Vec3::ZERO).then_some(vector.to_array());
        let mut text = Self {
            at: numbers(position),
            rotation: (rotation != Rotation::NONE).then_some(rotation),
            velocity: unless_zero(velocity.linear.to_vec3()),
            angular_velocity: unless_zero(velocity.angular.to_vec3()),
            target_position: { target_position }
                .filter(|target| *target != position)
                .map(numbers),
            target_rotation: target_rotation.filter(|target| *target != rotation),
            friction: Some(friction),
            restitution: (restitution != 0.0).then_some(restitution),
            sensor: is_sensor,
            layers: LayersText::of(layers),
            user_data: (user_data != 0).then_some(user_data),
            ..Self::default()
        };
        match shape {
            Shape::HalfSpace { normal, offset } => {
                text.half_space = Some(HalfSpaceText {
                    normal: numbers(normal),
                    point: numbers(normal * offset),
                });
            }
            Shape::Box { centre, half } => {
                let mut half = numbers(half);
                half[D::N..].fill(1.0);
                text.boxed = Some(BoxText {
                    centre: numbers(centre),
                    half,
                });
            }
            Shape::Capsule { from, to, radius } => {
                text.capsule = Some(CapsuleText {
                    from: numbers(from),
                    to: numbers(to),
                    radius,
                });
            }
            Shape::Ball { centre, radius } => {
                text.ball = Some(BallText {
                    centre: numbers(centre),
                    radius,
                });
            }
            Shape::OrientedBox { .. } => return None,
        }
        match motion_type {
            MotionType::Fixed => {}
            MotionType::Kinematic => text.motion_type = MotionTypeText::Kinematic,
            MotionType::Dynamic { mass } => {
                (text.motion_type, text.mass) = (MotionTypeText::Dynamic, Some(mass));
            }
            MotionType::Coupled {
                mass,
                stiffness,
                damping,
                max_force,
            } => {
                (text.motion_type, text.mass) = (MotionTypeText::Coupled, Some(mass));
                (text.stiffness, text.damping) = (Some(stiffness), Some(damping));
                text.max_force = (max_force < f32::INFINITY).then_some(max_force);
            }
            _ => return None,
        }
        Some(text)
    }
}
