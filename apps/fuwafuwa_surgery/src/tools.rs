//! What a trainee holds: a knife, forceps, a hook. Each is one rigid thing that follows the hand through a virtual
//! coupling, so that what it meets is felt.
//!
//! ```text
//!   knife    ╱╱         forceps  ║ ║          hook  ║
//!      ╔════╱                    ╲ ╱                 ║
//!      ╚═════  an edge           ╲╱  a tip           ╰════  a bar
//!         that cuts downwards       that grips          that pushes and pulls
//! ```
//!
//! The place of a tool is where it works: the middle of the edge, the tip, the middle of the bar.

use fuwafuwa::vector::plus;
use fuwafuwa::{
    Dim3, Joint, JointAnchor, JointHandle, Knife, KnifeHandle, MotionType, Refused, RigidBody,
    RigidBodyHandle, Rotation, Shape, SoftBody, SoftBodyHandle, Vector, World,
};
use serde::{Deserialize, Serialize};

/// How a hand holds a tool: it gives way by 2 mm for each newton, and never pushes harder than this [N].
const DRIVE: MotionType = MotionType::Coupled {
    mass: 0.1,
    stiffness: 500.0,
    damping: 1.0,
    limit: 30.0,
};

/// Steel on what is wet.
const FRICTION: f32 = 0.15;
/// Half of the length of the knife's edge, how high its blade is and half of how thick that is [m].
const BLADE: [f32; 3] = [0.015, 0.01, 0.0006];
/// Radius of the tip of the forceps for a fine organ [m].
const TIP: f32 = 0.002;
/// Tips and bars have a radius of so many voxels at the least: with 1.25, a tip slips in between nodes where it is pressed
/// in deeply.
const THINNEST: f32 = 1.5;
/// What is so near to the surface of the tip can be gripped [m].
const REACH: f32 = 0.004;
/// Nodes so near to the place that is gripped are held together [m].
const JAW: f32 = 0.004;
/// The forceps slip off at this force [N].
const SLIPS: f32 = 8.0;
/// Half of the length of the hook's bar, and its radius for a fine organ [m].
const BAR: [f32; 2] = [0.014, 0.0025];
/// How long the handles are that are drawn [m].
const HANDLE: f32 = 0.11;

/// A tool.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Tool {
    /// Cuts where its edge passes.
    #[default]
    Knife,
    /// Grips what is at its tip.
    Forceps,
    /// A bar that pushes tissue aside.
    Hook,
}

impl Tool {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Knife, Self::Forceps, Self::Hook];

    /// What it is called.
    pub fn name(self) -> &'static str {
        match self {
            Self::Knife => "Knife",
            Self::Forceps => "Forceps",
            Self::Hook => "Hook",
        }
    }
}

/// A tool in a world.
#[derive(Clone, Debug)]
pub struct Held {
    tool: Tool,
    holder: RigidBodyHandle,
    /// Its edge, and how dull that is [µm].
    edge: Option<(KnifeHandle, u16)>,
    grip: Option<JointHandle>,
    /// Whether the forceps closed on something or on nothing, and did not open since.
    is_closed: bool,
}

impl Held {
    /// Puts a tool for an organ into its world, at rest at a place [m].
    ///
    /// # Errors
    /// [`Refused`] when the place is out of reach.
    pub fn new(
        world: &mut World<Dim3>,
        organ: SoftBodyHandle,
        tool: Tool,
        at: Vector,
        rotation: Rotation,
    ) -> Result<Self, Refused> {
        let thinnest = thinnest(world.soft_bodies().get(organ)?);
        let mut rigid = RigidBody::new(form(tool, thinnest), at, DRIVE).rotated(rotation);
        rigid.friction = FRICTION;
        // Of a knife the edge alone touches, and its flat.
        rigid.is_sensor = tool == Tool::Knife;
        let holder = world.add_rigid_body(rigid)?;
        Ok(Self {
            tool,
            holder,
            edge: None,
            grip: None,
            is_closed: false,
        })
    }

    /// Takes it out of the world, with what it grips let go.
    ///
    /// # Errors
    /// [`Refused`] when it is not in this world.
    pub fn put_away(mut self, world: &mut World<Dim3>) -> Result<(), Refused> {
        self.open(world);
        if let Some((edge, _)) = self.edge.take() {
            world.remove_knife(edge)?;
        }
        world.remove_rigid_body(self.holder)?;
        Ok(())
    }

    /// Grinds the knife: its edge is as dull as is said [µm]. One that is within tissue begins anew there.
    ///
    /// # Errors
    /// [`Refused`] when that is out of range.
    pub fn grind(&mut self, world: &mut World<Dim3>, dull: u16) -> Result<(), Refused> {
        let is_so = self.edge.is_some_and(|(_, is)| is == dull);
        if self.tool != Tool::Knife || is_so {
            return Ok(());
        }
        if let Some((edge, _)) = self.edge.take() {
            world.remove_knife(edge)?;
        }
        let [half, height, _] = BLADE;
        let edge = [[-half, 0.0, 0.0], [half, 0.0, 0.0]];
        let mut knife = Knife::new(self.holder, edge, [0.0, -1.0, 0.0]);
        (knife.radius, knife.height) = (1e-6 * f32::from(dull), height);
        self.edge = Some((world.add_knife(knife)?, dull));
        Ok(())
    }

    /// Which one it is.
    pub fn tool(&self) -> Tool {
        self.tool
    }

    /// What follows the hand.
    pub fn rigid<'a>(&self, world: &'a World<Dim3>) -> &'a RigidBody {
        &world.rigid_bodies()[self.holder]
    }

    /// Whether it holds tissue.
    pub fn grips(&self) -> bool {
        self.grip.is_some()
    }

    /// Sends it somewhere [m], turned so.
    ///
    /// # Errors
    /// [`Refused`] when that is out of reach.
    pub fn send(
        &self,
        world: &mut World<Dim3>,
        goal: Vector,
        rotation: Rotation,
    ) -> Result<(), Refused> {
        world.set_target_position(self.holder, goal)?;
        if rotation != self.rigid(world).rotation() {
            world.set_target_rotation(self.holder, rotation)?;
        }
        Ok(())
    }

    /// Closes or opens the forceps.
    ///
    /// # Errors
    /// [`Refused`] when the organ is not in this world.
    pub fn close(
        &mut self,
        world: &mut World<Dim3>,
        organ: SoftBodyHandle,
        closes: bool,
    ) -> Result<(), Refused> {
        if self
            .grip
            .is_some_and(|grip| world.joints().get(grip).is_err())
        {
            // It slipped: forceps that are closed take nothing up.
            self.grip = None;
        }
        let begins = closes && !self.is_closed;
        self.is_closed = closes;
        if !closes {
            self.open(world);
        } else if begins
            && self.tool == Tool::Forceps
            && let Some(at) = nearest(world, organ, self.rigid(world))
        {
            let soft = JointAnchor::Soft {
                body: organ,
                at,
                radius: JAW,
            };
            let rigid = JointAnchor::RigidBody {
                rigid: self.holder,
                at,
            };
            let joint = Joint::pin(soft, rigid).breaking_at(SLIPS);
            self.grip = Some(world.add_joint(joint)?);
        }
        Ok(())
    }

    fn open(&mut self, world: &mut World<Dim3>) {
        if let Some(grip) = self.grip.take() {
            // One that slipped is gone already.
            let _ = world.remove_joint(grip);
        }
    }

    /// How strongly the grip pulls [N].
    pub fn pull(&self, world: &World<Dim3>) -> f32 {
        let joint = self.grip.and_then(|grip| world.joints().get(grip).ok());
        joint.map_or(0.0, Joint::force)
    }

    /// What of it is drawn beside what touches: shafts and handles.
    pub fn looks(&self, world: &World<Dim3>) -> Vec<Shape> {
        let rigid = self.rigid(world);
        let (at, rotation) = (rigid.position(), rigid.rotation());
        let place = |own: Vector| plus(at, rotation.apply(own));
        let bar = |from: Vector, to: Vector, radius: f32| Shape::Capsule {
            from: place(from),
            to: place(to),
            radius,
        };
        match self.tool {
            Tool::Knife => {
                let [half, height, _] = BLADE;
                let end = [half + 0.8 * HANDLE, height + 0.5 * HANDLE, 0.0];
                vec![bar([half - 0.002, height, 0.0], end, 0.0032)]
            }
            Tool::Forceps => {
                let apart = if self.is_closed { 0.0005 } else { 0.004 };
                let arm = |side: f32| {
                    [
                        bar(
                            [side * apart, 0.0, 0.0],
                            [side * 0.007, 0.5 * HANDLE, 0.0],
                            0.0013,
                        ),
                        bar(
                            [side * 0.007, 0.5 * HANDLE, 0.0],
                            [0.0, HANDLE, 0.0],
                            0.0018,
                        ),
                    ]
                };
                [arm(-1.0), arm(1.0)].concat()
            }
            Tool::Hook => {
                let [half, _] = BAR;
                vec![
                    bar([-half, 0.0, 0.0], [-half, 0.6 * HANDLE, 0.0], 0.0015),
                    bar([-half, 0.6 * HANDLE, 0.0], [-half, HANDLE, 0.0], 0.0045),
                ]
            }
        }
    }
}

/// What is round is no thinner than this [m].
fn thinnest(organ: &SoftBody<Dim3>) -> f32 {
    THINNEST * organ.grid().voxel_size()
}

/// So far from an organ no tool touches it, however it is turned [m].
pub(crate) fn clearance(organ: &SoftBody<Dim3>) -> f32 {
    let [half, radius] = BAR;
    half + radius.max(thinnest(organ)) + organ.grid().voxel_size()
}

/// What of a tool touches, with its place at the origin; what is round is not thinner than this [m].
fn form(tool: Tool, thinnest: f32) -> Shape {
    match tool {
        Tool::Knife => {
            let [half, height, thin] = BLADE;
            Shape::Box {
                centre: [0.0, 0.5 * height, 0.0],
                half: [half, 0.5 * height, thin],
            }
        }
        Tool::Forceps => Shape::Ball {
            centre: [0.0; 3],
            radius: TIP.max(thinnest),
        },
        Tool::Hook => {
            let [half, radius] = BAR;
            Shape::Capsule {
                from: [-half, 0.0, 0.0],
                to: [half, 0.0, 0.0],
                radius: radius.max(thinnest),
            }
        }
    }
}

/// The node of an organ that is nearest to the surface of a tip, if one is within reach: where it is [m].
fn nearest(world: &World<Dim3>, organ: SoftBodyHandle, tip: &RigidBody) -> Option<Vector> {
    let body = world.soft_bodies().get(organ).ok()?;
    let places = body.mesh().nodes().map(|(id, _)| body.node_state(id).0);
    let away = |place: &Vector| tip.shape().distance(*place).0;
    let nearest = places.min_by(|a, b| away(a).total_cmp(&away(b)))?;
    (away(&nearest) <= REACH).then_some(nearest)
}
