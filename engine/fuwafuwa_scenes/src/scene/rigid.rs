//! What is rigid in a scene: obstacles and hands, and shapes as they are written down.

use super::error::{Wrong, require, require_vector};
use fuwafuwa::{Dim, MotionType, Refused, RigidBody, RigidBodyHandle, Shape, World};
use serde::{Deserialize, Serialize};

/// A rigid shape as it is written down: exactly one of the fields but `friction`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ObstacleText {
    /// Everything below a plane.
    pub half_space: Option<HalfSpaceText>,
    /// Middle and half widths [m].
    #[serde(rename = "box")]
    pub boxed: Option<BoxText>,
    /// A bar with round ends.
    pub capsule: Option<CapsuleText>,
    /// A ball.
    pub ball: Option<BallText>,
    /// Coulomb friction.
    #[serde(default = "usual_friction")]
    pub friction: f32,
}

/// A plane, and what is below it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HalfSpaceText {
    /// Points out of what is below; of any length but 0.
    pub normal: [f32; 3],
    /// A point of the plane [m].
    pub point: [f32; 3],
}

/// An upright box.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BoxText {
    /// Its middle [m].
    pub centre: [f32; 3],
    /// Half of its width on each axis [m]; the third does not count in 2D.
    pub half: [f32; 3],
}

/// A bar with round ends.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CapsuleText {
    /// One end [m].
    pub from: [f32; 3],
    /// The other end [m].
    pub to: [f32; 3],
    /// Half of its thickness [m].
    pub radius: f32,
}

/// A ball.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BallText {
    /// Its middle [m].
    pub centre: [f32; 3],
    /// [m]
    pub radius: f32,
}

/// A hand as it is written down.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HandText {
    /// Of a ball (2D: a disc) [m]. Either this or one of the next two.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub radius: Option<f32>,
    /// An upright box, where it would be if its goal were the origin.
    #[serde(rename = "box", default, skip_serializing_if = "Option::is_none")]
    pub boxed: Option<BoxText>,
    /// A bar with round ends, as the box.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub capsule: Option<CapsuleText>,
    /// Whether it goes where it is sent, whatever is in the way.
    #[serde(default)]
    pub kinematic: bool,
    /// Where its goal is when: seconds, then a place [m]; straight in between.
    pub path: Vec<[f32; 4]>,
}

impl ObstacleText {
    pub(super) fn add_to<D: Dim>(&self, world: &mut World<D>) -> Result<(), Wrong> {
        let shape = Shapes {
            half_space: self.half_space.as_ref(),
            boxed: self.boxed.as_ref(),
            capsule: self.capsule.as_ref(),
            ball: self.ball.as_ref(),
        };
        let good = self.friction >= 0.0;
        let found = format!("expected 0 or more, found {}", self.friction);
        require(good, "friction", found)?;
        let added = world.add_rigid_body(RigidBody::fixed(shape.only::<D>()?, self.friction));
        added
            .map(|_| ())
            .map_err(|reason| Wrong::new("friction", reason))
    }
}

/// The ways of writing down a shape, of which one has to be chosen.
pub(super) struct Shapes<'a> {
    pub(super) half_space: Option<&'a HalfSpaceText>,
    pub(super) boxed: Option<&'a BoxText>,
    pub(super) capsule: Option<&'a CapsuleText>,
    pub(super) ball: Option<&'a BallText>,
}

impl Shapes<'_> {
    /// The shape, checked.
    pub(super) fn only<D: Dim>(&self) -> Result<Shape, Wrong> {
        let vector = |field: &str, vector| require_vector(D::N, field, vector);
        let (name, shape) = match (self.half_space, self.boxed, self.capsule, self.ball) {
            (Some(text), None, None, None) => {
                vector("half_space.normal", text.normal)?;
                vector("half_space.point", text.point)?;
                let is_zero = text.normal == [0.0; 3];
                let expected = "expected a direction, found 0 on every axis";
                require(!is_zero, "half_space.normal", expected)?;
                let shape = Shape::half_space(text.normal, text.point);
                ("half_space", shape)
            }
            (None, Some(text), None, None) => {
                vector("box.centre", text.centre)?;
                let (centre, mut half) = (text.centre, text.half);
                half[D::N..].fill(1.0);
                ("box", Shape::Box { centre, half })
            }
            (None, None, Some(text), None) => {
                vector("capsule.from", text.from)?;
                vector("capsule.to", text.to)?;
                let (from, to, radius) = (text.from, text.to, text.radius);
                ("capsule", Shape::Capsule { from, to, radius })
            }
            (None, None, None, Some(text)) => {
                vector("ball.centre", text.centre)?;
                let (centre, radius) = (text.centre, text.radius);
                ("ball", Shape::Ball { centre, radius })
            }
            _ => {
                let expected = "expected exactly one of half_space, box, capsule and ball";
                return Err(Wrong::new("shape", expected));
            }
        };
        let wrong = |bad: fuwafuwa::shape::BadShape| {
            let field = format!("{name}.{}", bad.field);
            Wrong::new(&field, format!("expected {}", bad.expected))
        };
        shape.check().map(|()| shape).map_err(wrong)
    }
}

/// Most points of the path of a hand: it is gone through in each tick.
const MAX_POINTS: usize = 10_000;

impl HandText {
    pub(super) fn add_to<D: Dim>(&self, world: &mut World<D>) -> Result<(), Wrong> {
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
            require_vector(D::N, &field, [x, y, z])?;
            before = seconds;
        }
        let form = self.form::<D>()?;
        let drive = match self.kinematic {
            true => MotionType::Kinematic,
            false => MotionType::default(),
        };
        let hand = RigidBody::new(form, self.goal(0.0), drive);
        let added = world.add_rigid_body(hand);
        added
            .map(|_| ())
            .map_err(|reason| Wrong::new("shape", reason))
    }

    /// Its shape, where it would be if its goal were the origin.
    fn form<D: Dim>(&self) -> Result<Shape, Wrong> {
        let shapes = Shapes {
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
                let centre = [0.0; 3];
                Ok(Shape::Ball { centre, radius })
            }
            (None, Some(_), None) | (None, None, Some(_)) => shapes.only::<D>(),
            _ => {
                let expected = "expected exactly one of radius, box and capsule";
                Err(Wrong::new("radius", expected))
            }
        }
    }

    /// Where the goal is at a time [s].
    pub fn goal(&self, seconds: f32) -> [f32; 3] {
        let place = |point: &[f32; 4]| [point[1], point[2], point[3]];
        let after = self.path.iter().position(|point| point[0] >= seconds);
        match after {
            None => self.path.last().map_or([0.0; 3], place),
            Some(0) => place(&self.path[0]),
            Some(next) => {
                let (from, to) = (&self.path[next - 1], &self.path[next]);
                let share = (seconds - from[0]) / (to[0] - from[0]).max(1e-6);
                let (from, to) = (place(from), place(to));
                [0, 1, 2].map(|axis: usize| from[axis] + share * (to[axis] - from[axis]))
            }
        }
    }
}

/// Sends the hands of a world to goals, the first to the first. A hand whose goal is no place stays where it is.
pub(crate) fn send<D: Dim>(world: &mut World<D>, goals: &[[f32; 3]]) {
    let hands: Vec<RigidBodyHandle> = world.target_followers().map(|(hand, _)| hand).collect();
    for (hand, &goal) in hands.into_iter().zip(goals) {
        let _sent: Result<(), Refused> = world.set_target_position(hand, goal);
    }
}

fn usual_friction() -> f32 {
    0.2
}
