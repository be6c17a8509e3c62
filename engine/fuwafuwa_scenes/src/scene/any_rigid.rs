//! Anything rigid, as it is written down: what stands, what is led, what falls, what only tells who is there.

use super::body::LayersText;
use super::build::rotation_of;
use super::error::{Wrong, require, require_vector};
use super::rigid::{BallText, BoxText, CapsuleText, HalfSpaceText, Shapes};
use super::state;
use fuwafuwa::{Dim, MotionType, Refused, RigidBody, RigidBodyHandle, Rotation, Shape, World};
use serde::{Deserialize, Serialize};

/// Something rigid as it is written down: one of the four shapes, as it would be at the origin, and what moves it; or a
/// `state`, which says all of it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RigidText {
    /// Everything below a plane; only where it stands still.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub half_space: Option<HalfSpaceText>,
    /// Middle and half widths [m].
    #[serde(rename = "box", default, skip_serializing_if = "Option::is_none")]
    pub boxed: Option<BoxText>,
    /// A bar with round ends.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub capsule: Option<CapsuleText>,
    /// A ball.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ball: Option<BallText>,
    /// All of it as it was; see [`Scene::of_world`](super::Scene::of_world).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub state: Option<String>,
    /// What moves it.
    #[serde(default)]
    pub drive: DriveText,
    /// Of what falls, which needs one, and of a hand [kg].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mass: Option<f32>,
    /// Of the spring of a hand [N/m].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stiffness: Option<f32>,
    /// Damping ratio of that.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub damping: Option<f32>,
    /// The strongest pull of that [N].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub limit: Option<f32>,
    /// How far it is moved from the origin [m].
    #[serde(default)]
    pub at: [f32; 3],
    /// How it is turned before that: axis times angle [rad]; in the plane about the third axis alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub turned: Option<[f32; 3]>,
    /// The same to the last bit, in place of that.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rotation: Option<Rotation>,
    /// Of what falls [m/s].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub velocity: Option<[f32; 3]>,
    /// Of what falls [rad/s].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub spin: Option<[f32; 3]>,
    /// Coulomb friction; 0.2, of what falls 0.5.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub friction: Option<f32>,
    /// Share of its speed with which it bounces off what is rigid.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub restitution: Option<f32>,
    /// Whether it touches nobody, and tells who comes into it.
    #[serde(default)]
    pub sensor: bool,
    /// Whom it touches.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub layers: Option<LayersText>,
    /// A number of the user's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub user_data: Option<u64>,
}

/// What moves something rigid, as it is written down: see [`fuwafuwa::MotionType`].
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DriveText {
    /// Nothing.
    #[default]
    Fixed,
    /// It is where it is sent.
    Kinematic,
    /// A spring draws it to where it is sent.
    Hand,
    /// It falls.
    Free,
}

impl RigidText {
    pub(super) fn add_to<D: Dim>(&self, world: &mut World<D>) -> Result<RigidBodyHandle, Wrong> {
        if let Some(state) = &self.state {
            let alone = Self {
                state: self.state.clone(),
                ..Self::default()
            };
            let expected = "expected nothing beside it: it says all of something rigid";
            require(*self == alone, "state", expected)?;
            let added = world.add_rigid_body(state::rigid::<D>(state)?);
            return added.map_err(|refused| Wrong::new("state", refused));
        }
        let rigid = self.rigid::<D>()?;
        let is_free = rigid.is_dynamic();
        let refused = |refused| match refused {
            Refused::RigidBody(bad) => Wrong::new(bad.field, format!("expected {}", bad.expected)),
            refused => Wrong::new("shape", refused),
        };
        let id = world.add_rigid_body(rigid).map_err(refused)?;
        let (velocity, spin) = (self.velocity, self.spin);
        let moves = velocity.is_some() || spin.is_some();
        require(
            is_free || !moves,
            "velocity",
            "expected of drive = \"free\" alone",
        )?;
        if moves {
            let [velocity, spin] = [velocity, spin].map(Option::unwrap_or_default);
            require_vector(D::N, "velocity", velocity)?;
            let set = world.set_velocity(id, velocity, spin);
            set.map_err(|refused| Wrong::new("velocity", refused))?;
        }
        Ok(id)
    }

    fn rigid<D: Dim>(&self) -> Result<RigidBody, Wrong> {
        require_vector(D::N, "at", self.at)?;
        let shapes = Shapes {
            half_space: self.half_space.as_ref(),
            boxed: self.boxed.as_ref(),
            capsule: self.capsule.as_ref(),
            ball: self.ball.as_ref(),
        };
        let rotation = match (self.turned, self.rotation) {
            (Some(_), Some(_)) => {
                let expected = "expected either turned or rotation";
                return Err(Wrong::new("rotation", expected));
            }
            (Some(turned), None) => rotation_of::<D>(turned)?,
            (None, rotation) => rotation.unwrap_or(Rotation::NONE),
        };
        let mut rigid = RigidBody::new(shapes.only::<D>()?, self.at, self.drive()?);
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

    fn drive(&self) -> Result<MotionType, Wrong> {
        let of_hands = [self.stiffness, self.damping, self.limit];
        let is_hand = self.drive == DriveText::Hand;
        let good = is_hand || of_hands == [None; 3];
        require(good, "stiffness", "expected of drive = \"hand\" alone")?;
        let bears = is_hand || self.drive == DriveText::Free;
        let expected = "expected of drive = \"free\" or \"hand\" alone";
        require(bears || self.mass.is_none(), "mass", expected)?;
        Ok(match self.drive {
            DriveText::Fixed => MotionType::Fixed,
            DriveText::Kinematic => MotionType::Kinematic,
            DriveText::Free => {
                let missing = || Wrong::new("mass", "expected the mass of what falls [kg]");
                let mass = self.mass.ok_or_else(missing)?;
                MotionType::Dynamic { mass }
            }
            DriveText::Hand => {
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

    /// What there is to say of something rigid; none where words would not make the same of it.
    pub(super) fn of<D: Dim>(rigid: &RigidBody) -> Option<Self> {
        let words = Self::in_words::<D>(rigid);
        let is_same = words.as_ref().is_some_and(|words| words.makes::<D>(rigid));
        match is_same {
            true => words,
            false => Some(Self {
                state: Some(state::of_rigid::<D>(rigid)?),
                ..Self::default()
            }),
        }
    }

    /// Whether these words make something rigid as it is, but for how long it has rested.
    fn makes<D: Dim>(&self, rigid: &RigidBody) -> bool {
        let Ok(mut world) = World::<D>::new(fuwafuwa::WorldConfig::default()) else {
            return false;
        };
        let Ok(id) = self.add_to(&mut world) else {
            return false;
        };
        let made = &world.rigid_bodies()[id];
        if rigid.follows_target() {
            // How its goal moves is seen from nowhere else.
            return made == rigid;
        }
        let both = [made, rigid];
        let [places, others] = both.map(|k| (k.position(), k.velocity(), k.angular_velocity()));
        let [turns, other_turns] = both.map(RigidBody::rotation);
        let [forms, other_forms] = both.map(|k| (*k.form(), k.motion_type, k.layers, k.is_sensor));
        let [numbers, other_numbers] = both.map(|k| (k.friction, k.restitution, k.user_data));
        (places, turns, forms, numbers) == (others, other_turns, other_forms, other_numbers)
    }

    fn in_words<D: Dim>(rigid: &RigidBody) -> Option<Self> {
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
            MotionType::Kinematic => text.drive = DriveText::Kinematic,
            MotionType::Dynamic { mass } => {
                (text.drive, text.mass) = (DriveText::Free, Some(mass));
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
                (text.drive, text.mass) = (DriveText::Hand, Some(mass));
                (text.stiffness, text.damping) = (Some(stiffness), Some(damping));
                text.limit = (limit < f32::INFINITY).then_some(limit);
            }
            _ => return None,
        }
        Some(text)
    }
}
