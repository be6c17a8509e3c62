//! Rigid bodies of a scene file: fixed, kinematic, coupled, dynamic, and sensors.

use super::body::LayersText;
use super::build::rotation_of;
use super::error::{FieldError, require, require_vector};
use super::shapes::{BallText, BoxText, CapsuleText, HalfSpaceText, ShapeChoice};
use super::state;
use fuwafuwa::{Dim, MotionType, RigidBody, RigidBodyHandle, Rotation, Shape, Velocity, World};
use serde::{Deserialize, Serialize};

/// A `[[rigid]]` table: one of the four shapes, given as if it stood at the origin, and its motion type; or
/// only a `state`, which contains everything.
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
    pub drive: MotionTypeText,
    /// Mass [kg]; required for `drive = "free"`, allowed for `drive = "hand"`.
    pub mass: Option<f32>,
    /// Stiffness of the coupling spring [N/m]; only for `drive = "hand"`.
    pub stiffness: Option<f32>,
    /// Damping ratio of the coupling spring; only for `drive = "hand"`.
    pub damping: Option<f32>,
    /// Maximum force of the coupling spring [N]; only for `drive = "hand"`.
    pub limit: Option<f32>,
    /// Translation from the origin [m].
    pub at: [f32; 3],
    /// Rotation before the translation: axis times angle [rad]; in 2D only about the third axis.
    pub turned: Option<[f32; 3]>,
    /// Exact rotation, in place of `turned`.
    pub rotation: Option<Rotation>,
    /// Velocity [m/s]; only for `drive = "free"`.
    pub velocity: Option<[f32; 3]>,
    /// Angular velocity [rad/s]; only for `drive = "free"`.
    pub spin: Option<[f32; 3]>,
    /// Coulomb friction; default 0.5 for dynamic rigid bodies, otherwise 0.2.
    pub friction: Option<f32>,
    /// Coefficient of restitution against other rigid bodies, default 0.
    pub restitution: Option<f32>,
    /// Whether the body is a sensor: it has no contact forces and reports bodies that enter and exit.
    pub sensor: bool,
    /// Contact layers.
    pub layers: Option<LayersText>,
    /// Arbitrary number of the user.
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
    Hand,
    /// Dynamic rigid body.
    Free,
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
            let added = world.add_rigid_body(state::rigid::<D>(state)?);
            return added.map_err(|refused| FieldError::new("state", refused));
        }
        let rigid = self.rigid::<D>()?;
        let is_free = rigid.is_dynamic();
        let added = world.add_rigid_body(rigid);
        let id = added.map_err(|error| FieldError::engine("shape", error))?;
        let (velocity, spin) = (self.velocity, self.spin);
        let moves = velocity.is_some() || spin.is_some();
        require(
            is_free || !moves,
            "velocity",
            "allowed only with drive = \"free\"",
        )?;
        if moves {
            let [linear, angular] = [velocity, spin].map(Option::unwrap_or_default);
            require_vector(D::N, "velocity", linear)?;
            let set = world.set_velocity(id, Velocity { linear, angular });
            set.map_err(|error| FieldError::new("velocity", error))?;
        }
        Ok(id)
    }

    fn rigid<D: Dim>(&self) -> Result<RigidBody, FieldError> {
        require_vector(D::N, "at", self.at)?;
        let shapes = ShapeChoice {
            half_space: self.half_space.as_ref(),
            boxed: self.boxed.as_ref(),
            capsule: self.capsule.as_ref(),
            ball: self.ball.as_ref(),
        };
        let rotation = match (self.turned, self.rotation) {
            (Some(_), Some(_)) => {
                let expected = "expected either turned or rotation";
                return Err(FieldError::new("rotation", expected));
            }
            (Some(turned), None) => rotation_of::<D>(turned)?,
            (None, rotation) => rotation.unwrap_or(Rotation::NONE),
        };
        let mut rigid = RigidBody::new(shapes.only::<D>()?, self.drive()?).at(self.at);
        if rotation != Rotation::NONE {
            rigid = rigid.rotated(rotation);
        }
        let usual = if rigid.is_dynamic() { 0.5 } else { 0.2 };
        rigid.friction = self.friction.unwrap_or(usual);
        rigid.restitution = self.restitution.unwrap_or(0.0);
        rigid.is_sensor = self.sensor;
        rigid.layers = self.layers.map(Into::into).unwrap_or_default();
        rigid.user_data = self.user_data.unwrap_or(0);
        Ok(rigid)
    }

    fn drive(&self) -> Result<MotionType, FieldError> {
        let of_hands = [self.stiffness, self.damping, self.limit];
        let is_hand = self.drive == MotionTypeText::Hand;
        let good = is_hand || of_hands == [None; 3];
        require(good, "stiffness", "allowed only with drive = \"hand\"")?;
        let bears = is_hand || self.drive == MotionTypeText::Free;
        let expected = "allowed only with drive = \"free\" or \"hand\"";
        require(bears || self.mass.is_none(), "mass", expected)?;
        Ok(match self.drive {
            MotionTypeText::Fixed => MotionType::Fixed,
            MotionTypeText::Kinematic => MotionType::Kinematic,
            MotionTypeText::Free => {
                let missing =
                    || FieldError::new("mass", "missing mass [kg], required with drive = \"free\"");
                let mass = self.mass.ok_or_else(missing)?;
                MotionType::Dynamic { mass }
            }
            MotionTypeText::Hand => {
                let mut drive = MotionType::default();
                if let MotionType::Coupled {
                    mass,
                    stiffness,
                    damping,
                    limit,
                } = &mut drive
                {
                    *mass = self.mass.unwrap_or(*mass);
                    *stiffness = self.stiffness.unwrap_or(*stiffness);
                    *damping = self.damping.unwrap_or(*damping);
                    *limit = self.limit.unwrap_or(*limit);
                }
                drive
            }
        })
    }

    /// Returns the text of a rigid body: its fields if they reproduce it exactly, otherwise its state.
    pub(super) fn of<D: Dim>(rigid: &RigidBody) -> Option<Self> {
        let words = Self::by_fields::<D>(rigid);
        let is_same = words
            .as_ref()
            .is_some_and(|words| words.reproduces::<D>(rigid));
        match is_same {
            true => words,
            false => Some(Self {
                state: Some(state::of_rigid::<D>(rigid)?),
                ..Self::default()
            }),
        }
    }

    /// Returns whether this text reproduces a rigid body, except for its sleep timer.
    fn reproduces<D: Dim>(&self, rigid: &RigidBody) -> bool {
        let Ok(mut world) = World::<D>::new(fuwafuwa::WorldConfig::default()) else {
            return false;
        };
        let Ok(id) = self.add_to(&mut world) else {
            return false;
        };
        let made = world.rigid_body(id).unwrap();
        if rigid.follows_target() {
            // The motion of the target has no getter, so the whole bodies are compared.
            return made == rigid;
        }
        let both = [made, rigid];
        let [places, others] = both.map(|k| (k.position(), k.velocity(), k.angular_velocity()));
        let [turns, other_turns] = both.map(RigidBody::rotation);
        let [forms, other_forms] = both.map(|k| (*k.form(), k.motion_type, k.layers, k.is_sensor));
        let [numbers, other_numbers] = both.map(|k| (k.friction, k.restitution, k.user_data));
        (places, turns, forms, numbers) == (others, other_turns, other_forms, other_numbers)
    }

    fn by_fields<D: Dim>(rigid: &RigidBody) -> Option<Self> {
        let mut text = Self {
            at: rigid.position(),
            friction: Some(rigid.friction),
            restitution: (rigid.restitution != 0.0).then_some(rigid.restitution),
            sensor: rigid.is_sensor,
            layers: LayersText::of(rigid.layers),
            user_data: (rigid.user_data != 0).then_some(rigid.user_data),
            ..Self::default()
        };
        match *rigid.form() {
            Shape::HalfSpace { normal, offset } => {
                let point = normal.map(|k| k * offset);
                text.half_space = Some(HalfSpaceText { normal, point });
            }
            Shape::Box { centre, mut half } => {
                half[D::N..].fill(1.0);
                text.boxed = Some(BoxText { centre, half });
            }
            Shape::Capsule { from, to, radius } => {
                text.capsule = Some(CapsuleText { from, to, radius });
            }
            Shape::Ball { centre, radius } => text.ball = Some(BallText { centre, radius }),
            Shape::OrientedBox { .. } => return None,
        }
        let rotation = rigid.rotation();
        text.rotation = (rotation != Rotation::NONE).then_some(rotation);
        match rigid.motion_type {
            MotionType::Fixed => {}
            MotionType::Kinematic => text.drive = MotionTypeText::Kinematic,
            MotionType::Dynamic { mass } => {
                (text.drive, text.mass) = (MotionTypeText::Free, Some(mass));
                let said = |vector: [f32; 3]| (vector != [0.0; 3]).then_some(vector);
                text.velocity = said(rigid.velocity());
                text.spin = said(rigid.angular_velocity());
            }
            MotionType::Coupled {
                mass,
                stiffness,
                damping,
                limit,
            } => {
                (text.drive, text.mass) = (MotionTypeText::Hand, Some(mass));
                (text.stiffness, text.damping) = (Some(stiffness), Some(damping));
                text.limit = (limit < f32::INFINITY).then_some(limit);
            }
            _ => return None,
        }
        Some(text)
    }
}
