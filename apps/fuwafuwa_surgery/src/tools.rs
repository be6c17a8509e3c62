//! Tools of the trainee: a knife, forceps and a hook. Each is one rigid body, coupled to the hand by a
//! virtual coupling, so that the trainee feels its contacts.
//!
//! ```text
//!   knife    ╱╱         forceps  ║ ║          hook  ║
//!      ╔════╱                    ╲ ╱                 ║
//!      ╚═════  an edge           ╲╱  a tip           ╰════  a bar
//!         that cuts downwards       that grips          that pushes and pulls
//! ```
//!
//! The position of a tool is its working point: the middle of the edge, the tip, the middle of the bar.

use fuwafuwa::{
    Dim3, Error, Joint, JointAnchor, JointHandle, Knife, KnifeHandle, MotionType, RigidBody,
    RigidBodyHandle, RigidBodyRef, Rotation, Shape, SoftBody, SoftBodyHandle, Vec3, World,
};
use serde::{Deserialize, Serialize};

/// Coupling of a tool to the hand: a spring of 500 N/m (2 mm per newton) with a maximum force of 30 N.
const DRIVE: MotionType = MotionType::Coupled {
    mass: 0.1,
    stiffness: 500.0,
    damping: 1.0,
    max_force: 30.0,
};

/// Friction coefficient of steel on wet tissue.
const FRICTION: f32 = 0.15;
/// Size of the knife [m]: half length of the edge, height of the blade, and half thickness of the blade.
const BLADE: [f32; 3] = [0.015, 0.01, 0.0006];
/// Tip radius of the forceps [m]. [`THINNEST`] enlarges it for coarse organs.
const TIP: f32 = 0.002;
/// Minimum radius of the forceps' tip and the hook's bar [voxels of the organ]. A thinner tool would slip
/// between nodes when it is pressed in deeply. The jaws attach at least as large a region: a single node would be
/// pulled out of the smooth surface.
const THINNEST: f32 = 2.0;
/// Maximum distance from the surface of the tip at which tissue is gripped [m].
const REACH: f32 = 0.004;
/// Radius around the gripped point within which nodes are attached to the forceps [m]. [`THINNEST`] enlarges it
/// for coarse organs.
const JAW: f32 = 0.004;
/// Radius of the drawn jaws [m].
const JAW_RADIUS: f32 = 0.0013;
/// Pulling force at which gripped tissue slips out of the forceps [N].
const SLIPS: f32 = 8.0;
/// Size of the hook's bar [m]: half length and radius. [`THINNEST`] enlarges the radius for coarse organs.
const BAR: [f32; 2] = [0.014, 0.0025];
/// Length of the drawn handles [m].
const HANDLE: f32 = 0.11;

/// Kind of tool.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Tool {
    /// Blade that cuts tissue along its edge.
    #[default]
    Knife,
    /// Tip that grips tissue.
    Forceps,
    /// Bar that pushes tissue aside.
    Hook,
}

impl Tool {
    /// All tools.
    pub const ALL: [Self; 3] = [Self::Knife, Self::Forceps, Self::Hook];

    /// Returns the name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Knife => "Knife",
            Self::Forceps => "Forceps",
            Self::Hook => "Hook",
        }
    }
}

/// Tool in a world.
#[derive(Clone, Debug)]
pub struct HeldTool {
    tool: Tool,
    holder: RigidBodyHandle,
    /// Handle of the engine's knife, and edge radius [µm]; `None` if the tool is not a knife.
    edge: Option<(KnifeHandle, u16)>,
    grip: Option<JointHandle>,
    /// Gripped point relative to the working point, in the frame of the tool [m].
    gripped: Vec3,
    /// Whether the forceps are closed, with or without tissue.
    is_closed: bool,
}

impl HeldTool {
    /// Adds a tool to the world of an organ, at rest at a position [m].
    ///
    /// # Errors
    /// [`Error`] if the position is out of range.
    pub fn new(
        world: &mut World<Dim3>,
        organ: SoftBodyHandle,
        tool: Tool,
        at: Vec3,
        rotation: Rotation,
    ) -> Result<Self, Error> {
        let thinnest = thinnest(world.soft_body(organ)?);
        let rigid = RigidBody::new(form(tool, thinnest), DRIVE)
            .at(at)
            .rotated(rotation)
            .with_friction(FRICTION)
            // Makes the box of the knife a sensor. The engine's `Knife` provides its contact: it cuts with
            // its edge and presses with its flat sides.
            .with_sensor(tool == Tool::Knife);
        let holder = world.add_rigid_body(rigid)?;
        Ok(Self {
            tool,
            holder,
            edge: None,
            grip: None,
            gripped: Vec3::ZERO,
            is_closed: false,
        })
    }

    /// Removes the tool from the world and releases gripped tissue.
    ///
    /// # Errors
    /// [`Error`] if the tool is not in this world.
    pub fn put_away(mut self, world: &mut World<Dim3>) -> Result<(), Error> {
        self.open(world);
        if let Some((edge, _)) = self.edge.take() {
            world.remove(edge)?;
        }
        world.remove(self.holder)?;
        Ok(())
    }

    /// Sets the edge radius of the knife [µm]. A new radius replaces the engine's knife, so that contacts
    /// with the tissue around it start again. Does nothing for other tools.
    ///
    /// # Errors
    /// [`Error`] if the radius is out of range.
    pub fn set_edge_radius(&mut self, world: &mut World<Dim3>, dull: u16) -> Result<(), Error> {
        let is_so = self.edge.is_some_and(|(_, is)| is == dull);
        if self.tool != Tool::Knife || is_so {
            return Ok(());
        }
        if let Some((edge, _)) = self.edge.take() {
            world.remove(edge)?;
        }
        let [half, height, _] = BLADE;
        let edge = [-half, half].map(|x| Vec3::new(x, 0.0, 0.0));
        let knife = Knife {
            radius: 1e-6 * f32::from(dull),
            height,
            ..Knife::new(self.holder, edge, Vec3::NEG_Y)
        };
        self.edge = Some((world.add_knife(knife)?, dull));
        Ok(())
    }

    /// Returns the kind of tool.
    pub fn tool(&self) -> Tool {
        self.tool
    }

    /// Returns the rigid body of the tool.
    ///
    /// # Panics
    /// If the tool is not in this world.
    pub fn rigid<'a>(&self, world: &'a World<Dim3>) -> RigidBodyRef<'a, Dim3> {
        let rigid = world.rigid_body(self.holder);
        rigid.expect("a tool stays in its world until it is put away")
    }

    /// Returns whether the tool holds tissue.
    pub fn grips(&self) -> bool {
        self.grip.is_some()
    }

    /// Sets the target of the coupling: position [m] and rotation.
    ///
    /// # Errors
    /// [`Error`] if the target is out of range.
    pub fn send(
        &self,
        world: &mut World<Dim3>,
        goal: Vec3,
        rotation: Rotation,
    ) -> Result<(), Error> {
        world.set_target_position(self.holder, goal)?;
        if rotation != self.rigid(world).rotation() {
            world.set_target_rotation(self.holder, rotation)?;
        }
        Ok(())
    }

    /// Closes or opens the forceps. On closing they grip tissue near the tip; on opening they release it.
    ///
    /// # Errors
    /// [`Error`] if the organ is not in this world.
    pub fn close(
        &mut self,
        world: &mut World<Dim3>,
        organ: SoftBodyHandle,
        closes: bool,
    ) -> Result<(), Error> {
        if self.grip.is_some_and(|grip| world.joint(grip).is_err()) {
            // The grip slipped off. The forceps have to open before they can grip again.
            self.grip = None;
        }
        let begins = closes && !self.is_closed;
        self.is_closed = closes;
        if !closes {
            self.open(world);
        } else if begins
            && self.tool == Tool::Forceps
            && let Some(at) = nearest(world.soft_body(organ)?, &self.rigid(world).shape())
        {
            let jaw = JAW.max(thinnest(world.soft_body(organ)?));
            let soft = JointAnchor::on(organ, at).within(jaw);
            let rigid = JointAnchor::on(self.holder, at);
            let joint = Joint::pin(soft, rigid).with_breaking_force(SLIPS);
            let held = self.rigid(world);
            self.gripped = held.rotation().inverse().apply(at - held.position());
            self.grip = Some(world.add_joint(joint)?);
        }
        Ok(())
    }

    fn open(&mut self, world: &mut World<Dim3>) {
        if let Some(grip) = self.grip.take() {
            // Ignores the error: a grip that slipped off was already removed.
            let _ = world.remove(grip);
        }
    }

    /// Returns the pulling force of the grip [N].
    pub fn pull(&self, world: &World<Dim3>) -> f32 {
        let joint = self.grip.and_then(|grip| world.joint(grip).ok());
        joint.map_or(0.0, |joint| joint.force())
    }

    /// Returns the shapes that are drawn but have no contact: shafts and handles.
    pub fn looks(&self, world: &World<Dim3>) -> Vec<Shape<Dim3>> {
        let rigid = self.rigid(world);
        let (at, rotation) = (rigid.position(), rigid.rotation());
        let place = |own: Vec3| at + rotation.apply(own);
        let bar = |from: [f32; 2], to: [f32; 2], radius: f32| {
            let [from, to] = [from, to].map(|[x, y]| place(Vec3::new(x, y, 0.0)));
            Shape::capsule(from, to, radius)
        };
        match self.tool {
            Tool::Knife => {
                let [half, height, _] = BLADE;
                let end = [half + 0.8 * HANDLE, height + 0.5 * HANDLE];
                vec![bar([half - 0.002, height], end, 0.0032)]
            }
            Tool::Forceps => {
                let apart = if self.is_closed { 0.0005 } else { 0.004 };
                // The jaws meet at the tissue that they hold.
                let jaw = self.grip.map_or(Vec3::ZERO, |_| self.gripped);
                let arm = |side: f32| {
                    let middle = [side * 0.007, 0.5 * HANDLE];
                    let end = place(jaw + side * apart * Vec3::X);
                    let elbow = place(Vec3::new(middle[0], middle[1], 0.0));
                    [
                        Shape::capsule(end, elbow, JAW_RADIUS),
                        bar(middle, [0.0, HANDLE], 0.0018),
                    ]
                };
                [arm(-1.0), arm(1.0)].concat()
            }
            Tool::Hook => {
                let [half, _] = BAR;
                vec![
                    bar([-half, 0.0], [-half, 0.6 * HANDLE], 0.0015),
                    bar([-half, 0.6 * HANDLE], [-half, HANDLE], 0.0045),
                ]
            }
        }
    }
}

/// Returns the minimum radius of the forceps' tip and the hook's bar for an organ [m].
fn thinnest(organ: &SoftBody<Dim3>) -> f32 {
    THINNEST * organ.grid().voxel_size()
}

/// Returns a distance between organ and working point at which no tool touches the organ in any rotation [m].
pub(crate) fn clearance(organ: &SoftBody<Dim3>) -> f32 {
    let [half, radius] = BAR;
    half + radius.max(thinnest(organ)) + organ.grid().voxel_size()
}

/// Returns the contact shape of a tool with its working point at the origin. `thinnest` is the minimum radius
/// [m].
fn form(tool: Tool, thinnest: f32) -> Shape<Dim3> {
    match tool {
        Tool::Knife => {
            let [half, height, thin] = BLADE;
            let blade = Shape::cuboid(Vec3::new(half, 0.5 * height, thin));
            blade.translated(Vec3::new(0.0, 0.5 * height, 0.0))
        }
        Tool::Forceps => Shape::ball(TIP.max(thinnest)),
        Tool::Hook => {
            let [half, radius] = BAR;
            let end = Vec3::new(half, 0.0, 0.0);
            Shape::capsule(-end, end, radius.max(thinnest))
        }
    }
}

/// Returns the position of the node nearest to the surface of a tip [m], if it is within [`REACH`].
fn nearest(organ: &SoftBody<Dim3>, tip: &Shape<Dim3>) -> Option<Vec3> {
    let places = organ.mesh().nodes().map(|(id, _)| organ.node_state(id).0);
    let away = |place: &Vec3| tip.distance(*place).0;
    let nearest = places.min_by(|a, b| away(a).total_cmp(&away(b)))?;
    (away(&nearest) <= REACH).then_some(nearest)
}
