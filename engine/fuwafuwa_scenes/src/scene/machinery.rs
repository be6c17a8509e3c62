//! Moving parts of a scene: obstacles on paths, turning obstacles, switches and fields.

use super::error::{FieldError, require, vector_of};
use super::game::check_numbers;
use super::shapes::{BallText, BoxText, ShapeChoice};
use super::{ObstacleText, Scene};
use fuwafuwa::inspect::is_hand;
use fuwafuwa::{
    Dim, DimAngular, DimVector, Hooks, JointHandle, Reaction, RigidBodyHandle, RigidBodyRef,
    Rotation, Shape, StepReport, Vec3, World, field_around,
};
use serde::{Deserialize, Serialize};

/// A `[[switch]]` table: a region that is on while something is in it. It moves obstacles and opens joints. It requires
/// a box or a ball.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SwitchText {
    /// Axis-aligned box.
    #[serde(rename = "box")]
    pub boxed: Option<BoxText>,
    /// Ball.
    pub ball: Option<BallText>,
    /// What turns it on, default `body`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub by: Option<SwitchedBy>,
    /// Mass of soft bodies in the region from which it is on [kg]; default any. Only with `by = "body"`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mass: Option<f32>,
    /// Numbers of the bodies that turn it on, counted from 1; default all. Only with `by = "body"`.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub bodies: Vec<usize>,
    /// Whether it stays on after it was on once; default false.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub stays: bool,
}

/// What turns a switch on.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SwitchedBy {
    /// Nodes of soft bodies in the region.
    Body,
    /// The centre of a hand in the region.
    Hand,
}

/// A `[[field]]` table: an acceleration of soft bodies and dynamic rigid bodies, in addition to gravity. It requires
/// either `acceleration` or `centre`, `strength` and `reach`. In a scene with fields, bodies do not fall asleep.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct FieldText {
    /// Region in which it acts: an axis-aligned box. Without a region it acts everywhere.
    #[serde(rename = "box")]
    pub boxed: Option<BoxText>,
    /// Region in which it acts: a ball.
    pub ball: Option<BallText>,
    /// Uniform acceleration [m/s²].
    pub acceleration: Option<[f32; 3]>,
    /// Centre of attraction [m].
    pub centre: Option<[f32; 3]>,
    /// Acceleration towards the centre within the reach [m/s²]; negative repels. Beyond the reach it falls with the
    /// inverse square of the distance; see [`fuwafuwa::field_around`].
    pub strength: Option<f32>,
    /// Distance from the centre up to which the strength is the same [m].
    pub reach: Option<f32>,
}

impl SwitchText {
    /// Checks every field in a scene with `bodies` bodies.
    pub(super) fn check<D: Dim>(&self, bodies: usize) -> Result<(), FieldError> {
        let good = self.bodies.is_empty() || self.by != Some(SwitchedBy::Hand);
        require(good, "bodies", "allowed only with by = \"body\"")?;
        check_numbers("bodies", &self.bodies, bodies)?;
        self.region::<D>().map(|_| ())
    }

    /// Returns the checked region.
    pub(super) fn region<D: Dim>(&self) -> Result<Shape<D>, FieldError> {
        let mass = self.mass.unwrap_or(1.0);
        let expected = format!("expected a positive mass in kg, found {mass}");
        require(mass > 0.0, "mass", expected)?;
        let good = self.mass.is_none() || self.by != Some(SwitchedBy::Hand);
        require(good, "mass", "allowed only with by = \"body\"")?;
        region_of(self.boxed.as_ref(), self.ball.as_ref())
    }
}

impl FieldText {
    /// Returns the checked field.
    pub(super) fn field<D: Dim>(&self) -> Result<Field<D>, FieldError> {
        let region = match (&self.boxed, &self.ball) {
            (None, None) => None,
            (boxed, ball) => Some(region_of(boxed.as_ref(), ball.as_ref())?),
        };
        let acts = match (self.acceleration, self.centre, self.strength, self.reach) {
            (Some(acceleration), None, None, None) => {
                Acts::Along(vector_of::<D>("acceleration", acceleration)?)
            }
            (None, Some(centre), Some(strength), Some(reach)) => {
                let expected = format!("expected a number, found {strength}");
                require(strength.is_finite(), "strength", expected)?;
                let good = reach > 0.0 && reach.is_finite();
                let expected = format!("expected a positive number of metres, found {reach}");
                require(good, "reach", expected)?;
                Acts::Around {
                    centre: vector_of::<D>("centre", centre)?,
                    strength,
                    reach,
                }
            }
            _ => {
                let expected = "expected either acceleration or all of centre, strength and reach";
                return Err(FieldError::new("acceleration", expected));
            }
        };
        Ok(Field { region, acts })
    }
}

fn region_of<D: Dim>(
    boxed: Option<&BoxText>,
    ball: Option<&BallText>,
) -> Result<Shape<D>, FieldError> {
    if boxed.is_some() == ball.is_some() {
        return Err(FieldError::new("box", "expected either a box or a ball"));
    }
    let shapes = ShapeChoice {
        half_space: None,
        boxed,
        capsule: None,
        ball,
    };
    shapes.only()
}

/// Field of acceleration.
#[derive(Clone, Debug)]
pub(super) struct Field<D: Dim> {
    region: Option<Shape<D>>,
    acts: Acts<D>,
}

#[derive(Clone, Debug)]
enum Acts<D: Dim> {
    Along(D::Vector),
    Around {
        centre: D::Vector,
        strength: f32,
        reach: f32,
    },
}

impl<D: Dim> Field<D> {
    /// Returns the acceleration at a position [m/s²].
    fn at(&self, position: D::Vector) -> D::Vector {
        let is_outside = |region: &Shape<D>| region.distance(position).0 > 0.0;
        if self.region.as_ref().is_some_and(is_outside) {
            return D::Vector::ZERO;
        }
        match self.acts {
            Acts::Along(acceleration) => acceleration,
            Acts::Around {
                centre,
                strength,
                reach,
            } => field_around(centre, strength, reach)(position),
        }
    }
}

/// Moving parts of a world that was built from a scene, with their present state. Hands are not among them.
#[derive(Clone, Debug)]
pub struct Machinery<D: Dim> {
    parts: Vec<Part<D>>,
    switches: Vec<Switch<D>>,
    fields: Vec<Field<D>>,
    /// Joints that a switch opens, and the indices of the switches.
    latches: Vec<(JointHandle, usize)>,
}

/// Obstacle that moves.
#[derive(Clone, Debug)]
struct Part<D: Dim> {
    body: RigidBodyHandle,
    text: ObstacleText,
    pivot: D::Vector,
    /// Time for which it has moved forward [s].
    forward: f32,
    /// Time for which it has turned [s].
    turned: f32,
}

#[derive(Clone, Debug)]
struct Switch<D: Dim> {
    text: SwitchText,
    region: Shape<D>,
    is_on: bool,
}

impl<D: Dim> Machinery<D> {
    /// Returns the moving parts of a world in its state after [`Scene::build`].
    pub fn new(scene: &Scene, world: &World<D>) -> Self {
        const CHECKED: &str = "the scene was checked when it was built";
        let handles = world.rigid_bodies().map(|(handle, _)| handle);
        let parts = scene.obstacle.iter().zip(handles);
        let parts = parts.filter(|(text, _)| text.moves());
        let parts = parts.map(|(text, body)| Part {
            body,
            text: text.clone(),
            pivot: world.rigid_body(body).expect(CHECKED).position(),
            forward: 0.0,
            turned: 0.0,
        });
        let joints = scene.joint.iter().zip(world.joints());
        let latches = joints.filter_map(|(text, (joint, _))| Some((joint, text.switch? - 1)));
        let switches = scene.switch.iter().map(|text| Switch {
            text: text.clone(),
            region: text.region().expect(CHECKED),
            is_on: false,
        });
        let fields = scene.field.iter();
        Self {
            parts: parts.collect(),
            switches: switches.collect(),
            fields: fields.map(|text| text.field().expect(CHECKED)).collect(),
            latches: latches.collect(),
        }
    }

    /// Moves all parts and advances the world by one tick.
    pub fn step(&mut self, world: &mut World<D>) -> StepReport {
        for switch in &mut self.switches {
            switch.update(world);
        }
        let switches = &self.switches;
        self.latches.retain(|&(joint, switch)| {
            let opens = switches[switch].is_on;
            // The joint may have broken before.
            let _removed = opens.then(|| world.remove(joint));
            !opens
        });
        for part in &mut self.parts {
            let switch = part.text.switch.map(|number| &switches[number - 1]);
            part.advance(switch.is_none_or(|switch| switch.is_on), world);
        }
        if self.fields.is_empty() {
            return world.step();
        }
        world.step_with(&mut Hooks {
            field: Some(&|position| self.field_at(position)),
            after_substep: None,
        })
    }

    /// Returns the regions of the switches, and whether they are on.
    pub fn switches(&self) -> impl Iterator<Item = (&Shape<D>, bool)> {
        let switches = self.switches.iter();
        switches.map(|switch| (&switch.region, switch.is_on))
    }

    /// Returns whether fields act in the world.
    pub fn has_fields(&self) -> bool {
        !self.fields.is_empty()
    }

    /// Returns the acceleration by all fields at a position [m/s²].
    pub fn field_at(&self, position: D::Vector) -> D::Vector {
        let fields = self.fields.iter().map(|field| field.at(position));
        fields.fold(D::Vector::ZERO, |sum, one| sum + one)
    }
}

impl<D: Dim> Part<D> {
    /// Sets the target at the end of the next tick.
    fn advance(&mut self, is_forward: bool, world: &mut World<D>) {
        let tick = world.config().tick;
        let body = world.rigid_body(self.body);
        let body = body.expect("obstacles stay in the world");
        let resists = { self.text.max_torque }.is_some_and(|most| torque_on(body) > most);
        self.forward = match is_forward {
            true => self.forward + tick,
            false => (self.forward.min(self.length()) - tick).max(0.0),
        };
        let moved = D::Vector::from_vec3(Vec3::from(self.text.displacement(self.forward)));
        let sent = world.set_target_position(self.body, self.pivot + moved);
        sent.expect("the path was checked");
        if let Some(turning) = self.text.angular_velocity {
            if is_forward && !resists {
                self.turned += tick;
            }
            let turning = Vec3::from(turning);
            let rotation = Rotation::about(turning, turning.length() * self.turned);
            let sent = world.set_target_rotation(self.body, rotation);
            sent.expect("the angular velocity was checked");
        }
    }

    /// Returns the duration of one way along the path [s].
    fn length(&self) -> f32 {
        self.text.path.last().map_or(f32::INFINITY, |end| end[0])
    }
}

/// Returns the mean torque of contacts on a body in the last tick [N m].
fn torque_on<D: Dim>(body: RigidBodyRef<'_, D>) -> f32 {
    let reactions = body.reactions();
    let count = reactions.len().max(1) as f32;
    let torques = reactions.map(|reaction: Reaction<D>| reaction.torque.to_vec3());
    torques.fold(Vec3::ZERO, |sum, one| sum + one).length() / count
}

impl<D: Dim> Switch<D> {
    fn update(&mut self, world: &World<D>) {
        if self.is_on && self.text.stays {
            return;
        }
        let is_in = |position: D::Vector| self.region.distance(position).0 < 0.0;
        self.is_on = match self.text.by.unwrap_or(SwitchedBy::Body) {
            SwitchedBy::Hand => {
                let mut bodies = world.rigid_bodies();
                bodies.any(|(_, body)| is_hand(body) && is_in(body.position()))
            }
            SwitchedBy::Body => {
                let least = self.text.mass.unwrap_or(f32::MIN_POSITIVE);
                let named = &self.text.bodies;
                let counts = |index: &usize| named.is_empty() || named.contains(&(index + 1));
                let bodies = world.soft_bodies().enumerate();
                let bodies = bodies.filter(|(index, _)| counts(index));
                let masses = bodies.map(|(_, (_, body))| {
                    let nodes = body.mesh().nodes().map(|(id, _)| body.node_state(id));
                    let inside = nodes.filter(|&(position, _, _)| is_in(position));
                    inside.map(|(_, _, mass)| mass).sum::<f32>()
                });
                masses.sum::<f32>() >= least
            }
        };
    }
}
