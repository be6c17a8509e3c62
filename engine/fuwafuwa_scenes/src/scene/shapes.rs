//! Obstacles, hands and shapes of a scene file.

use super::body::LayersText;
use super::error::{FieldError, require, vector_of};
use fuwafuwa::{Dim, DimVector, Error, MotionType, RigidBody, RigidBodyHandle, Shape, Vec3, World};
use serde::{Deserialize, Serialize};

/// An `[[obstacle]]` table: a fixed rigid body. It requires exactly one shape.
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
    /// Points of the path: time [s], then target position [m]; interpolated linearly.
    pub path: Vec<[f32; 4]>,
}

impl ObstacleText {
    pub(super) fn add_to<D: Dim>(&self, world: &mut World<D>) -> Result<(), FieldError> {
        let shape = ShapeChoice {
            half_space: self.half_space.as_ref(),
            boxed: self.boxed.as_ref(),
            capsule: self.capsule.as_ref(),
            ball: self.ball.as_ref(),
        };
        let obstacle = RigidBody::fixed(shape.only()?)
            .with_friction(self.friction)
            .with_layers(self.layers.map(Into::into).unwrap_or_default());
        let added = world.add_rigid_body(obstacle);
        added
            .map(|_| ())
            .map_err(|error| FieldError::engine("friction", error))
    }
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

/// Maximum number of points in the path of a hand: each tick searches it from the beginning.
const MAX_POINTS: usize = 10_000;

impl HandText {
    pub(super) fn add_to<D: Dim>(&self, world: &mut World<D>) -> Result<(), FieldError> {
        require(
            !self.path.is_empty(),
            "path",
            "expected a point [seconds, x, y, z] at least",
        )?;
        let found = self.path.len();
        let expected = format!("expected {MAX_POINTS} points at most, found {found}");
        require(found <= MAX_POINTS, "path", expected)?;
        let mut before = 0.0;
        for (index, &[seconds, x, y, z]) in self.path.iter().enumerate() {
            let field = format!("path.{}", index + 1);
            let expected = format!("expected a time of {before} s or more, found {seconds}");
            require(seconds >= before && seconds.is_finite(), &field, expected)?;
            vector_of::<D>(&field, [x, y, z])?;
            before = seconds;
        }
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
        let hand = match self.friction {
            Some(friction) => hand.with_friction(friction),
            None => hand,
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

    /// Returns the target position [m] at a time [s].
    pub fn target(&self, seconds: f32) -> [f32; 3] {
        point_at(&self.path, seconds)
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
    let hands = world
        .rigid_bodies()
        .filter(|(_, body)| body.follows_target());
    let hands: Vec<RigidBodyHandle> = hands.map(|(hand, _)| hand).collect();
    for (hand, &target) in hands.into_iter().zip(targets) {
        let target = D::Vector::from_vec3(Vec3::from(target));
        let _sent: Result<(), Error> = world.set_target_position(hand, target);
    }
}

fn usual_friction() -> f32 {
    0.2
}
