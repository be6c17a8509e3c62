//! Obstacles, hands and shapes of a scene file.

use super::body::LayersText;
use super::build::require_turning;
use super::error::{FieldError, require, vector_of};
use fuwafuwa::inspect::{FOLLOWING_HAND, MOVING_PART, is_hand};
use fuwafuwa::{Dim, DimVector, Error, MotionType, RigidBody, RigidBodyHandle, Shape, Vec3, World};
use serde::{Deserialize, Serialize};

/// An `[[obstacle]]` table: a rigid body that is fixed, or moves along a path, or turns. It requires exactly one shape.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ObstacleText {
    /// Half-space below a plane.
    pub half_space: Option<HalfSpaceText>,
    /// Axis-aligned box.
    #[serde(rename = "box")]
    pub boxed: Option<BoxText>,
    /// Capsule.
    pub capsule: Option<CapsuleText>,
    /// Ball.
    pub ball: Option<BallText>,
    /// Coulomb friction, default 0.2.
    #[serde(default = "usual_friction")]
    pub friction: f32,
    /// Contact layers.
    pub layers: Option<LayersText>,
    /// Path of a moving obstacle: time [s], then displacement from its place [m]; interpolated linearly.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub path: Vec<[f32; 4]>,
    /// What follows at the end of the path; default `once`.
    pub repeat: Option<RepeatText>,
    /// Angular velocity of a turning obstacle [rad/s]; in 2D only about the third axis.
    pub angular_velocity: Option<[f32; 3]>,
    /// Point about which it turns [m]; default the centre of its shape.
    pub pivot: Option<[f32; 3]>,
    /// Maximum force that moves it along its path [N]. Without it, nothing stops the obstacle.
    pub max_force: Option<f32>,
    /// Maximum torque that turns it [N m]. While bodies resist with a larger one, it stands still. Without it, nothing
    /// stops the obstacle.
    pub max_torque: Option<f32>,
    /// Number of a `[[switch]]`. While the switch is on, the obstacle moves forward on its path; while it is off, it
    /// moves back to the start. Without it, the obstacle always moves forward.
    pub switch: Option<usize>,
}

/// What follows at the end of the path of an obstacle.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RepeatText {
    /// It stays at the end.
    Once,
    /// It jumps to the beginning of the path, so both ends should coincide.
    Loop,
    /// It moves back along the path, and forward again.
    BackAndForth,
}

/// Half-space below a plane.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HalfSpaceText {
    /// Normal of the plane, pointing out of the half-space; any length except 0.
    pub normal: [f32; 3],
    /// A point of the plane [m].
    pub point: [f32; 3],
}

/// Axis-aligned box.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BoxText {
    /// Centre [m].
    pub centre: [f32; 3],
    /// Half widths on each axis [m]; the third is ignored in 2D.
    pub half: [f32; 3],
}

/// Capsule: a bar with round ends.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CapsuleText {
    /// Centre of one end [m].
    pub from: [f32; 3],
    /// Centre of the other end [m].
    pub to: [f32; 3],
    /// Radius [m].
    pub radius: f32,
}

/// Ball.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BallText {
    /// Centre [m].
    pub centre: [f32; 3],
    /// Radius [m].
    pub radius: f32,
}

/// A `[[hand]]` table: a rigid body that follows a path. It requires exactly one of `radius`, `box` and
/// `capsule`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HandText {
    /// Radius of a ball (2D: a disc) [m].
    pub radius: Option<f32>,
    /// Axis-aligned box, relative to the target.
    #[serde(rename = "box")]
    pub boxed: Option<BoxText>,
    /// Capsule, relative to the target.
    pub capsule: Option<CapsuleText>,
    /// Whether the hand is kinematic and follows its path exactly; otherwise a spring pulls it along.
    #[serde(default)]
    pub kinematic: bool,
    /// Maximum force of the spring [N], default 1000; not for a kinematic hand.
    pub max_force: Option<f32>,
    /// Coulomb friction, default 0.2.
    pub friction: Option<f32>,
    /// Contact layers.
    pub layers: Option<LayersText>,
    /// Whether the hand touches nothing, so that only a knife on it meets bodies; default false.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub sensor: bool,
    /// Number of the hand that this one follows: it moves as that hand does, at the same distance. Such hands are parts
    /// of a player's hand, as the tines of a fork.
    pub follows: Option<usize>,
    /// Axis on which the hand moves opposite to the one it follows.
    pub mirror: Option<AxisText>,
    /// Points of the path: time [s], then target position [m]; interpolated linearly. A hand that follows another one
    /// has one point, its place at the start.
    pub path: Vec<[f32; 4]>,
}

/// A coordinate axis.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum AxisText {
    /// First axis.
    X,
    /// Second axis.
    Y,
    /// Third axis.
    Z,
}

impl ObstacleText {
    pub(super) fn add_to<D: Dim>(&self, world: &mut World<D>) -> Result<(), FieldError> {
        let shape = ShapeChoice {
            half_space: self.half_space.as_ref(),
            boxed: self.boxed.as_ref(),
            capsule: self.capsule.as_ref(),
            ball: self.ball.as_ref(),
        };
        let obstacle = self
            .placed(shape.only()?)?
            .with_friction(self.friction)
            .with_layers(self.layers.map(Into::into).unwrap_or_default());
        let added = world.add_rigid_body(obstacle);
        added
            .map(|_| ())
            .map_err(|error| FieldError::engine("friction", error))
    }
}

/// Maximum coordinate of a moving obstacle [m]. The engine refuses targets beyond 1e6 m.
const FARTHEST: f32 = 5e5;

/// Coupling of a moving obstacle to its target: mass [kg], stiffness [N/m] and damping ratio.
const COUPLING: [f32; 3] = [10.0, 20_000.0, 1.0];

impl ObstacleText {
    /// Returns whether the obstacle moves.
    pub fn moves(&self) -> bool {
        !self.path.is_empty() || self.angular_velocity.is_some()
    }

    /// Returns the obstacle at its place, before layers and friction.
    fn placed<D: Dim>(&self, shape: Shape<D>) -> Result<RigidBody<D>, FieldError> {
        let rests = [
            (
                "repeat",
                self.repeat.is_some() && self.path.is_empty(),
                "path",
            ),
            (
                "pivot",
                self.pivot.is_some() && self.angular_velocity.is_none(),
                "angular_velocity",
            ),
            (
                "max_force",
                self.max_force.is_some() && self.path.is_empty(),
                "path",
            ),
            (
                "max_torque",
                self.max_torque.is_some() && self.angular_velocity.is_none(),
                "angular_velocity",
            ),
            ("switch", self.switch.is_some() && !self.moves(), "path"),
        ];
        for (field, is_vain, needed) in rests {
            let expected = format!("allowed only for an obstacle with {needed}");
            require(!is_vain, field, expected)?;
        }
        if !self.moves() {
            return Ok(RigidBody::fixed(shape));
        }
        let bounded = !matches!(shape, Shape::HalfSpace { .. });
        require(bounded, "half_space", "expected a bounded shape: it moves")?;
        check_path::<D>("path", &self.path)?;
        let turning = self.angular_velocity.unwrap_or_default();
        vector_of::<D>("pivot", self.pivot.unwrap_or_default())?;
        let finite = turning.iter().all(|speed| speed.is_finite());
        let expected = format!("expected numbers in rad/s, found {turning:?}");
        require(finite, "angular_velocity", expected)?;
        require_turning::<D>("angular_velocity", turning)?;
        for (field, limit) in [
            ("max_force", self.max_force),
            ("max_torque", self.max_torque),
        ] {
            let limit = limit.unwrap_or(1.0);
            let expected = format!("expected a positive number, found {limit}");
            require(limit > 0.0, field, expected)?;
        }
        let motion_type = match self.max_force {
            None => MotionType::Kinematic,
            Some(max_force) => {
                let [mass, stiffness, damping] = COUPLING;
                MotionType::Coupled {
                    mass,
                    stiffness,
                    damping,
                    max_force,
                }
            }
        };
        let pivot = self.pivot_of(&shape);
        for (index, &[_, x, y, z]) in self.path.iter().enumerate() {
            let at = pivot.to_vec3() + Vec3::new(x, y, z);
            let expected =
                format!("expected a place within {FARTHEST} m of the origin, found {at}");
            let field = format!("path.{}", index + 1);
            require(at.abs().max_element() <= FARTHEST, &field, expected)?;
        }
        let body = RigidBody::new(shape.translated(-pivot), motion_type).at(pivot);
        Ok(RigidBody {
            user_data: MOVING_PART,
            ..body
        })
    }

    /// Returns the point about which the obstacle turns [m].
    pub(super) fn pivot_of<D: Dim>(&self, shape: &Shape<D>) -> D::Vector {
        match self.pivot {
            Some(pivot) => D::Vector::from_vec3(Vec3::from(pivot)),
            None => {
                let [low, high] = shape.bounds();
                (low + high) * 0.5
            }
        }
    }

    /// Returns the displacement [m] after moving for `seconds` [s].
    pub fn displacement(&self, seconds: f32) -> [f32; 3] {
        let length = self.path.last().map_or(0.0, |end| end[0]);
        let seconds = match self.repeat {
            _ if length <= 0.0 => seconds,
            None | Some(RepeatText::Once) => seconds,
            Some(RepeatText::Loop) => seconds % length,
            Some(RepeatText::BackAndForth) => {
                let phase = seconds % (2.0 * length);
                phase.min(2.0 * length - phase)
            }
        };
        point_at(&self.path, seconds)
    }
}

/// Checks the times and places of a path, which is in the field `name`.
pub(super) fn check_path<D: Dim>(name: &str, path: &[[f32; 4]]) -> Result<(), FieldError> {
    let found = path.len();
    let expected = format!("expected {MAX_POINTS} points at most, found {found}");
    require(found <= MAX_POINTS, name, expected)?;
    let mut before = 0.0;
    for (index, &[seconds, x, y, z]) in path.iter().enumerate() {
        let field = format!("{name}.{}", index + 1);
        let expected = format!("expected a time of {before} s or more, found {seconds}");
        require(seconds >= before && seconds.is_finite(), &field, expected)?;
        vector_of::<D>(&field, [x, y, z])?;
        before = seconds;
    }
    Ok(())
}

/// The possible shapes of a table; exactly one must be present.
pub(super) struct ShapeChoice<'a> {
    pub(super) half_space: Option<&'a HalfSpaceText>,
    pub(super) boxed: Option<&'a BoxText>,
    pub(super) capsule: Option<&'a CapsuleText>,
    pub(super) ball: Option<&'a BallText>,
}

impl ShapeChoice<'_> {
    /// Checks that exactly one shape is present and valid, and returns it.
    pub(super) fn only<D: Dim>(&self) -> Result<Shape<D>, FieldError> {
        let (name, shape) = match (self.half_space, self.boxed, self.capsule, self.ball) {
            (Some(text), None, None, None) => {
                let normal = vector_of::<D>("half_space.normal", text.normal)?;
                let point = vector_of::<D>("half_space.point", text.point)?;
                let is_zero = normal == D::Vector::ZERO;
                let expected = "expected a direction, found 0 on every axis";
                require(!is_zero, "half_space.normal", expected)?;
                ("half_space", Shape::half_space(normal, point))
            }
            (None, Some(text), None, None) => {
                let centre = vector_of::<D>("box.centre", text.centre)?;
                let half = D::Vector::from_vec3(Vec3::from(text.half));
                ("box", Shape::Box { centre, half })
            }
            (None, None, Some(text), None) => {
                let from = vector_of::<D>("capsule.from", text.from)?;
                let to = vector_of::<D>("capsule.to", text.to)?;
                ("capsule", Shape::capsule(from, to, text.radius))
            }
            (None, None, None, Some(text)) => {
                let centre = vector_of::<D>("ball.centre", text.centre)?;
                let radius = text.radius;
                ("ball", Shape::Ball { centre, radius })
            }
            _ => {
                let expected = "expected exactly one of half_space, box, capsule and ball";
                return Err(FieldError::new("shape", expected));
            }
        };
        let wrong = |error: Error| FieldError::engine("shape", error).under(name);
        shape.check().map(|()| shape).map_err(wrong)
    }
}

/// Maximum number of points in a path: each tick searches it from the beginning.
const MAX_POINTS: usize = 10_000;

impl HandText {
    /// Adds the hand to a world. If it follows another one, `player` is the index of that one's player.
    pub(super) fn add_to<D: Dim>(
        &self,
        player: Option<usize>,
        world: &mut World<D>,
    ) -> Result<(), FieldError> {
        require(
            !self.path.is_empty(),
            "path",
            "expected a point [seconds, x, y, z] at least",
        )?;
        check_path::<D>("path", &self.path)?;
        let good = self.follows.is_none() || self.path.len() == 1;
        let expected = "expected one point: the hand follows another one";
        require(good, "path", expected)?;
        let good = self.follows.is_some() || self.mirror.is_none();
        require(good, "mirror", "allowed only for a hand with follows")?;
        let shape = self.shape::<D>()?;
        let mut motion_type = match self.kinematic {
            true => MotionType::Kinematic,
            false => MotionType::default(),
        };
        if let Some(force) = self.max_force {
            let expected = "not allowed with kinematic = true";
            require(!self.kinematic, "max_force", expected)?;
            let good = force > 0.0;
            let expected = format!("expected a positive force in N, found {force}");
            require(good, "max_force", expected)?;
            if let MotionType::Coupled { max_force, .. } = &mut motion_type {
                *max_force = force;
            }
        }
        let start = vector_of::<D>("path", self.target(0.0))?;
        let hand = RigidBody::new(shape, motion_type)
            .at(start)
            .with_layers(self.layers.map(Into::into).unwrap_or_default());
        let hand = RigidBody {
            friction: self.friction.unwrap_or(hand.friction),
            is_sensor: self.sensor,
            user_data: player.map_or(0, |player| FOLLOWING_HAND + player as u64),
            ..hand
        };
        let added = world.add_rigid_body(hand);
        added
            .map(|_| ())
            .map_err(|error| FieldError::engine("shape", error))
    }

    /// Returns the shape relative to the target.
    fn shape<D: Dim>(&self) -> Result<Shape<D>, FieldError> {
        let shapes = ShapeChoice {
            half_space: None,
            boxed: self.boxed.as_ref(),
            capsule: self.capsule.as_ref(),
            ball: None,
        };
        match (self.radius, &self.boxed, &self.capsule) {
            (Some(radius), None, None) => {
                let good = radius > 0.0 && radius.is_finite();
                let expected = format!("expected a positive number of metres, found {radius}");
                require(good, "radius", expected)?;
                Ok(Shape::ball(radius))
            }
            (None, Some(_), None) | (None, None, Some(_)) => shapes.only(),
            _ => {
                let expected = "expected exactly one of radius, box and capsule";
                Err(FieldError::new("radius", expected))
            }
        }
    }

    /// Returns the target position [m] at a time [s], of a hand that follows no other one.
    pub fn target(&self, seconds: f32) -> [f32; 3] {
        point_at(&self.path, seconds)
    }

    /// Returns the target position [m] of a hand that follows another one, which has moved by `moved` [m] from its
    /// start.
    pub fn following(&self, moved: [f32; 3]) -> [f32; 3] {
        let start = self.target(0.0);
        [0, 1, 2].map(|axis: usize| match self.mirror {
            Some(mirror) if mirror as usize == axis => start[axis] - moved[axis],
            _ => start[axis] + moved[axis],
        })
    }
}

/// Returns the position [m] on a path at a time [s]. The points of the path are a time [s] and a position [m], in
/// the order of time. Before the first point and after the last one the position stays; an empty path stays at 0.
pub fn point_at(path: &[[f32; 4]], seconds: f32) -> [f32; 3] {
    let place = |point: &[f32; 4]| [point[1], point[2], point[3]];
    let after = path.iter().position(|point| point[0] >= seconds);
    match after {
        None => path.last().map_or([0.0; 3], place),
        Some(0) => place(&path[0]),
        Some(next) => {
            let (from, to) = (&path[next - 1], &path[next]);
            let share = (seconds - from[0]) / (to[0] - from[0]).max(1e-6);
            let (from, to) = (place(from), place(to));
            [0, 1, 2].map(|axis: usize| from[axis] + share * (to[axis] - from[axis]))
        }
    }
}

/// Sets the targets of a world's hands, in order. A hand with a non-finite target keeps its old one.
pub(crate) fn set_hand_targets<D: Dim>(world: &mut World<D>, targets: &[[f32; 3]]) {
    let hands = world.rigid_bodies().filter(|&(_, body)| is_hand(body));
    let hands: Vec<RigidBodyHandle> = hands.map(|(hand, _)| hand).collect();
    for (hand, &target) in hands.into_iter().zip(targets) {
        let target = D::Vector::from_vec3(Vec3::from(target));
        let _sent: Result<(), Error> = world.set_target_position(hand, target);
    }
}

fn usual_friction() -> f32 {
    0.2
}
