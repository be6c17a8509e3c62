//! Playgrounds: levels without a basket, in which players add bodies, change the tool of the hand, gravity and air.
//!
//! A [`Change`] is made between two ticks. It is part of the recording, so a replay and time that runs back make it again.

use crate::input::{position_of, units_of};
use crate::{Assist, Round};
use fuwafuwa::{
    Blade, Dim, DimVector, Joint, JointAnchor, JointHandle, Layers, Shape, SoftBody,
    SoftBodyHandle, Vec3, World,
};
use fuwafuwa_scenes::Scene;
use fuwafuwa_scenes::scene::{BodyText, Form, MaterialText};
use serde::{Deserialize, Serialize};

/// Maximum number of nodes of all bodies together. Then no more bodies can be added.
pub const MOST_NODES: usize = 9000;
/// Maximum number of changes in a recording.
pub(crate) const MOST_CHANGES: usize = 20_000;
/// Maximum number of changes between two ticks.
pub(crate) const MOST_AT_ONCE: usize = 32;
/// Maximum number of joints. Then no more pins can be added.
const MOST_JOINTS: usize = 200;

/// Width of an added body [m].
const WIDTH: f32 = 0.5;
/// Number of voxels across an added body, in 2D and 3D.
const VOXELS: [usize; 2] = [32, 10];
/// Distance from the surface of the hand within which it grabs and pins [m].
const REACH: f32 = 0.04;
/// Half the length of the knife's edge, which stands upright in 3D [m].
const EDGE: f32 = 0.35;

/// Material of an added body.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Stuff {
    /// Soft, and trembles for long, like a gel of gelatine.
    Jelly,
    /// Gives way at first and stiffens the more it is stretched or pressed, like silicone rubber. It bounces and does not
    /// tear.
    Rubber,
    /// Stiff and brittle.
    Biscuit,
    /// Keeps the shape into which it is pressed.
    Clay,
    /// Very stiff and heavy, and does not tear.
    Stone,
    /// Can be drawn out far, and keeps that shape.
    Caramel,
    /// Resists a blow and creeps under a slow hand; what was pressed flat rises again within seconds.
    Dough,
}

impl Stuff {
    /// All materials. Their numbers in added bodies follow this order, from 1.
    pub const ALL: [Self; 7] = [
        Self::Jelly,
        Self::Rubber,
        Self::Biscuit,
        Self::Clay,
        Self::Stone,
        Self::Caramel,
        Self::Dough,
    ];

    /// Returns the number of the material in added bodies, which decides their colour.
    pub fn number(self) -> u8 {
        let place = Self::ALL.iter().position(|known| *known == self);
        1 + place.expect("every material is listed") as u8
    }

    /// Returns the table of the material in a scene file, without a colour.
    pub fn material(self) -> MaterialText {
        let (young, tears) = match self {
            Self::Jelly => (2500.0, Some([4000.0, 500.0])),
            Self::Rubber => (7000.0, None),
            Self::Biscuit => (12_000.0, Some([1500.0, 120.0])),
            Self::Clay => (6000.0, Some([4000.0, 600.0])),
            Self::Stone => (20_000.0, None),
            Self::Caramel => (4000.0, Some([3000.0, 900.0])),
            Self::Dough => (400.0, Some([2500.0, 600.0])),
        };
        let like = match self {
            Self::Jelly => Some("gelatine-5"),
            Self::Rubber => Some("pdms-rtv615"),
            _ => None,
        };
        let prony = match self {
            Self::Dough => vec![[8.0, 0.3]],
            _ => Vec::new(),
        };
        let plastic = match self {
            Self::Clay => Some([0.05, 2.5]),
            Self::Caramel => Some([0.1, 4.0]),
            _ => None,
        };
        let mass_damping = match self {
            Self::Jelly | Self::Rubber => Some(1.0),
            Self::Caramel => Some(12.0),
            _ => None,
        };
        MaterialText {
            like: like.map(str::to_owned),
            young: Some(young),
            poisson: like.map(|_| 0.4),
            prony,
            density: (self == Self::Stone)
                .then_some(300.0)
                .or(like.map(|_| 100.0)),
            mass_damping,
            strength: tears.map(|[strength, _]| strength),
            toughness: tears.map(|[_, toughness]| toughness),
            yield_strain: plastic.map(|[strain, _]| strain),
            plastic_limit: plastic.map(|[_, limit]| limit),
            unbreakable: tears.is_none(),
            ..MaterialText::default()
        }
    }

    /// Returns the table of the material, which never tears if the level says so.
    fn material_of_level(self, is_unbreakable: bool) -> MaterialText {
        let material = self.material();
        match is_unbreakable {
            false => material,
            true => MaterialText {
                strength: None,
                toughness: None,
                unbreakable: true,
                ..material
            },
        }
    }
}

/// Tool of the first player's hand.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Tool {
    /// Pushes, as in all other levels.
    #[default]
    Push,
    /// Holds what it touches, while it is pressed.
    Grab,
    /// Cuts what it passes, while it is pressed. In a level in which nothing tears, it cuts nothing.
    Knife,
    /// Pins what it touches when it is pressed: two bodies to each other, or one to its place.
    Pin,
}

/// A change of a playground.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Change {
    /// Adds a body.
    Add {
        /// Shape.
        form: Form,
        /// Material.
        stuff: Stuff,
        /// Middle of the body [1/8192 m].
        at: [i16; 3],
    },
    /// Removes all bodies and pins.
    Clear,
    /// Gravity in halves of 1 m/s², up to 40.
    Gravity(u8),
    /// Drag of the air in tenths of 1/s, up to 50.
    Air(u8),
    /// Radius of the first player's hand in cm, 3 to 30.
    HandSize(u8),
    /// Tool of the first player's hand.
    Tool(Tool),
    /// Whether the tool is pressed.
    Press(bool),
}

impl Change {
    /// Returns the change that adds a body with its middle at a position [m].
    pub fn add(form: Form, stuff: Stuff, at: Vec3) -> Self {
        let at = units_of(at);
        Self::Add { form, stuff, at }
    }
}

/// A change and the number of ticks before it.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TimedChange {
    /// Number of ticks from the start of the round to the change.
    pub tick: u32,
    /// The change.
    pub change: Change,
}

/// Reason why a change is refused. It then changes nothing.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ChangeError {
    /// The level has a basket.
    #[error("expected a level without a basket")]
    NoPlayground,
    /// There are too many bodies.
    #[error("expected at most {MOST_NODES} nodes in all bodies")]
    Full,
    /// There are too many pins.
    #[error("expected at most {MOST_JOINTS} joints")]
    TooManyPins,
    /// There are too many changes, between two ticks or in the whole round.
    #[error("expected at most {MOST_AT_ONCE} changes at once, and {MOST_CHANGES} in a round")]
    TooMany,
    /// The change cannot be made.
    #[error("{0}")]
    Invalid(String),
}

/// State of the first player's tool.
#[derive(Clone, Debug, Default)]
pub(crate) struct ToolState {
    pub(crate) tool: Tool,
    pub(crate) is_pressed: bool,
    /// Pins that hold what is grabbed.
    grabbed: Vec<JointHandle>,
    /// Position of the hand after the last tick [m].
    last: Vec3,
}

impl<D: Dim> Round<D> {
    /// Makes a change of a playground at the beginning of the next tick, and records it.
    ///
    /// # Errors
    /// [`ChangeError`] if the level has a basket, or if there are too many bodies, pins or changes.
    pub fn change(&mut self, change: Change) -> Result<(), ChangeError> {
        if !self.baskets().is_empty() {
            return Err(ChangeError::NoPlayground);
        }
        if self.waiting().len() >= MOST_AT_ONCE || self.changes().len() >= MOST_CHANGES {
            return Err(ChangeError::TooMany);
        }
        let adds_joint = matches!(self.tool().0, Tool::Grab | Tool::Pin);
        let adds_joint = adds_joint && change == Change::Press(true);
        if adds_joint && self.world().joints().count() >= MOST_JOINTS {
            return Err(ChangeError::TooManyPins);
        }
        if let Change::Add { form, stuff, at } = change {
            let more = self.body_of(form, stuff, at)?.mesh().node_count();
            // A waiting change may clear the room, and bodies of the same size may be waiting.
            let cleared = self
                .waiting()
                .iter()
                .rposition(|change| *change == Change::Clear);
            let later = &self.waiting()[cleared.map_or(0, |place| place + 1)..];
            let adds = |change: &&Change| matches!(change, Change::Add { .. });
            let waiting = later.iter().filter(adds).count();
            let present = if cleared.is_some() { 0 } else { self.nodes() };
            if present + more * (1 + waiting) > MOST_NODES {
                return Err(ChangeError::Full);
            }
        }
        self.note_change(change);
        Ok(())
    }

    /// Makes a change now.
    pub(crate) fn make(&mut self, change: Change) -> Result<(), ChangeError> {
        if !self.baskets().is_empty() {
            return Err(ChangeError::NoPlayground);
        }
        let hand = self.first_hand();
        let config = *self.world().config();
        match change {
            Change::Add { form, stuff, at } => {
                let body = self.body_of(form, stuff, at)?;
                if self.nodes() + body.mesh().node_count() > MOST_NODES {
                    return Err(ChangeError::Full);
                }
                self.world_mut().add_soft_body(body).map_err(invalid)?;
            }
            Change::Clear => {
                self.let_go();
                let bodies: Vec<_> = self.world().soft_bodies().map(|(body, _)| body).collect();
                for body in bodies {
                    self.world_mut().remove(body).map_err(invalid)?;
                }
            }
            Change::Gravity(halves) => {
                let strength = 0.5 * f32::from(halves.min(40));
                let gravity = -strength * D::Vector::Y.to_vec3();
                let gravity = D::Vector::from_vec3(gravity);
                let config = fuwafuwa::WorldConfig { gravity, ..config };
                self.world_mut().set_config(config).map_err(invalid)?;
            }
            Change::Air(tenths) => {
                let drag = 0.1 * f32::from(tenths.min(50));
                let config = fuwafuwa::WorldConfig { drag, ..config };
                self.world_mut().set_config(config).map_err(invalid)?;
            }
            Change::HandSize(centimetres) => {
                self.let_go();
                let radius = 0.01 * f32::from(centimetres.clamp(3, 30));
                self.resize_hand(radius).map_err(invalid)?;
            }
            Change::Tool(tool) => {
                self.let_go();
                let own = self.layers_of_hand();
                let layers = match tool {
                    Tool::Push => own,
                    _ => Layers { filters: 0, ..own },
                };
                self.world_mut().set_layers(hand, layers).map_err(invalid)?;
                *self.tool_mut() = ToolState {
                    tool,
                    ..ToolState::default()
                };
            }
            Change::Press(is_pressed) => self.press(is_pressed),
        }
        Ok(())
    }

    /// Presses the tool, or lets it go.
    fn press(&mut self, is_pressed: bool) {
        self.let_go();
        let hand = self.first_hand();
        let at = self.position_of_hand();
        self.tool_mut().is_pressed = is_pressed;
        self.tool_mut().last = at.to_vec3();
        if !is_pressed {
            return;
        }
        let radius = self.radius_of_hand() + REACH;
        let touched = bodies_near(self.world(), at, radius);
        let anchor = |body: SoftBodyHandle| JointAnchor::on(body, at).within(radius);
        if self.world().joints().count() >= MOST_JOINTS {
            return;
        }
        match self.tool_mut().tool {
            Tool::Grab => {
                for body in touched {
                    let pin = Joint::pin(JointAnchor::on(hand, at), anchor(body));
                    let pin = self.world_mut().add_joint(pin).ok();
                    self.tool_mut().grabbed.extend(pin);
                }
            }
            Tool::Pin => {
                let pin = match touched.as_slice() {
                    [] => return,
                    &[body] => Joint::pin(JointAnchor::Point(at), anchor(body)),
                    &[one, other, ..] => Joint::pin(anchor(one), anchor(other)),
                };
                // A pin that cannot be added, for example in crumbs, is left out.
                let _pin = self.world_mut().add_joint(pin);
            }
            Tool::Push | Tool::Knife => {}
        }
    }

    /// Lets go what is grabbed.
    fn let_go(&mut self) {
        self.tool_mut().is_pressed = false;
        for pin in std::mem::take(&mut self.tool_mut().grabbed) {
            // A pin that broke is gone.
            let _pin = self.world_mut().remove(pin);
        }
    }

    /// Cuts what the knife has passed in the last tick.
    pub(crate) fn use_tool(&mut self) {
        let ToolState {
            tool: Tool::Knife,
            is_pressed: true,
            last,
            ..
        } = *self.tool_mut()
        else {
            return;
        };
        let now = self.position_of_hand().to_vec3();
        self.tool_mut().last = now;
        if now == last || self.is_unbreakable() {
            return;
        }
        let edge = [-EDGE, EDGE].map(|height| D::Vector::from_vec3(last + height * Vec3::Y));
        let blade = Blade::swept(edge, D::Vector::from_vec3(now - last));
        let [low, high] = [
            last.min(now) - EDGE * Vec3::Y,
            last.max(now) + EDGE * Vec3::Y,
        ];
        let is_passed = |body: &SoftBody<D>| {
            let voxel = Vec3::splat(body.grid().voxel_size());
            let mut nodes = body
                .mesh()
                .nodes()
                .map(|(node, _)| body.positions()[node].xyz());
            let [low, high] = [low - voxel, high + voxel];
            nodes.any(|at| (0..D::N).all(|axis| (low[axis]..=high[axis]).contains(&at[axis])))
        };
        let bodies = self
            .world()
            .soft_bodies()
            .filter(|(_, body)| is_passed(body));
        let bodies: Vec<_> = bodies.map(|(body, _)| body).collect();
        for body in bodies {
            let cut = self.world_mut().cut(body, &blade);
            cut.expect("the body is in the world");
        }
    }

    /// Returns whether nothing tears in the level.
    fn is_unbreakable(&self) -> bool {
        self.level().game().assists.contains(&Assist::Unbreakable)
    }

    /// Builds a body to be added.
    fn body_of(&self, form: Form, stuff: Stuff, at: [i16; 3]) -> Result<SoftBody<D>, ChangeError> {
        let mut at = position_of(at).to_array().map(|k| k - 0.5 * WIDTH);
        if D::N == 2 {
            at[2] = 0.0;
        }
        let is_unbreakable = self.is_unbreakable();
        let invalid = |error: &dyn std::fmt::Display| ChangeError::Invalid(error.to_string());
        let scene = Scene::read("body", &format!("dim = {}", D::N), &[]);
        let mut scene = scene.map_err(|error| invalid(&error))?;
        scene.material = Stuff::ALL
            .map(|stuff| stuff.material_of_level(is_unbreakable))
            .into();
        scene.body.push(BodyText {
            shape: Some(form),
            n: Some(VOXELS[D::N - 2]),
            width: WIDTH,
            material: Some(stuff.number()),
            at,
            ..BodyText::default()
        });
        let mut world = scene.build::<D>().map_err(|error| invalid(&error))?;
        let body = world.nth_soft_body(0);
        let body = body.expect("the scene has a body");
        world.remove(body).map_err(|error| invalid(&error))
    }
}

fn invalid(error: fuwafuwa::Error) -> ChangeError {
    ChangeError::Invalid(error.to_string())
}

/// Returns the bodies with a node within a distance of a point, the nearest first.
fn bodies_near<D: Dim>(world: &World<D>, at: D::Vector, reach: f32) -> Vec<SoftBodyHandle> {
    let region = Shape::Ball {
        centre: at,
        radius: reach,
    };
    let distance = |body: &SoftBody<D>| {
        let nodes = body.nodes_in(&region);
        let away = nodes.map(|node| (body.positions()[node].xyz() - at.to_vec3()).length());
        away.fold(f32::INFINITY, f32::min)
    };
    let bodies = world
        .soft_bodies()
        .map(|(handle, body)| (distance(body), handle));
    let mut near: Vec<_> = bodies.filter(|(away, _)| away.is_finite()).collect();
    near.sort_by(|a, b| a.0.total_cmp(&b.0));
    near.into_iter().map(|(_, body)| body).collect()
}
