//! A procedure, tick by tick. Its state depends only on the case and the inputs.

use crate::case::{Case, CaseError, Table, bounds};
use crate::measures::{self, Sample};
use crate::tools::{HeldTool, Tool, clearance};
use fuwafuwa::{
    DEFAULT_TICK, Dim3, Error, Event, Reaction, RigidBodyRef, Rotation, SoftBody, StepReport, Vec3,
    World,
};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Resolution of recorded positions [m].
const STEP: f32 = 1e-5;
/// Integer that a recording stores for 1 in a component of a quaternion.
const PARTS: f32 = 32767.0;
/// Maximum speed of a tool [m/s], for example after a jump of the mouse.
const FASTEST: f32 = 0.25;
/// Maximum angular speed of a tool [rad/s].
const SPIN: f32 = 5.0;
/// Height above the organ at which tools enter, as a fraction of the organ's height. Tools enter higher if
/// the clearance of the largest tool requires it.
const ENTRY: f32 = 0.2;
/// Maximum length of a procedure [ticks]: one hour.
pub const MOST_TICKS: usize = 60 * 60 * 60;
/// Maximum edge radius of the knife [µm].
pub const BLUNTEST: u16 = 2000;

/// Input of a tick. It is quantized and recorded, so that a replay gives the same result.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Input {
    /// Tool in the hand.
    pub tool: Tool,
    /// Target position [0.01 mm].
    pub goal: [i32; 3],
    /// Target rotation: x, y, z, w of a quaternion, 32767 for 1.
    pub turn: [i16; 4],
    /// Whether the forceps close.
    pub grips: bool,
    /// Edge radius of the knife [µm].
    pub dull: u16,
}

impl Default for Input {
    fn default() -> Self {
        Self {
            tool: Tool::default(),
            goal: [0; 3],
            turn: [0, 0, 0, 32767],
            grips: false,
            dull: 100,
        }
    }
}

impl Input {
    /// Returns the input with the given tool, target position [m] and rotation; the other fields are kept.
    #[must_use]
    pub fn at(self, tool: Tool, goal: Vec3, rotation: Rotation) -> Self {
        Self {
            tool,
            goal: goal.to_array().map(|k| (k / STEP).round() as i32),
            turn: rotation.quaternion().map(|k| (k * PARTS).round() as i16),
            ..self
        }
    }

    /// Returns the target position [m].
    pub fn place(&self) -> Vec3 {
        Vec3::from(self.goal.map(|k| k as f32 * STEP))
    }

    /// Returns the target rotation.
    pub fn rotation(&self) -> Rotation {
        Rotation::from_quaternion(self.turn.map(|k| f32::from(k) / PARTS))
    }
}

/// Procedure in its current state.
pub struct Procedure {
    case: Arc<Case>,
    table: Table,
    held: HeldTool,
    /// Target position of the tool [m]. It follows the position in the input at limited speed.
    goal: Vec3,
    rotation: Rotation,
    inputs: Vec<Input>,
    samples: Vec<Sample>,
    hashes: Vec<u64>,
}

impl Procedure {
    /// Starts a procedure, with the organ on the table and a tool above it.
    ///
    /// # Errors
    /// [`CaseError`] if the organ cannot be laid on the table.
    pub fn new(case: Arc<Case>) -> Result<Self, CaseError> {
        let mut table = case.place_on_table()?;
        let [low, high] = table.room;
        let goal = (0.5 * (low + high)).with_y(entry(&table));
        let rotation = Rotation::NONE;
        let held = HeldTool::new(
            &mut table.world,
            table.organ,
            Tool::default(),
            goal,
            rotation,
        )?;
        Ok(Self {
            case,
            table,
            held,
            goal,
            rotation,
            inputs: Vec::new(),
            samples: Vec::new(),
            hashes: Vec::new(),
        })
    }

    /// Advances the procedure by a tick.
    ///
    /// # Errors
    /// [`Error`] if the world rejects the target. This does not occur, because targets are clamped to the
    /// room.
    pub fn step(&mut self, input: Input) -> Result<StepReport, Error> {
        self.take(input.tool)?;
        self.follow(&input);
        let world = &mut self.table.world;
        self.held.send(world, self.goal, self.rotation)?;
        self.held.set_edge_radius(world, input.dull.min(BLUNTEST))?;
        self.held.close(world, self.table.organ, input.grips)?;
        let report = world.step();
        self.inputs.push(input);
        self.samples.push(self.measure(&report));
        if self.ticks().is_multiple_of(60) {
            self.hashes.push(self.table.world.hash());
        }
        Ok(report)
    }

    /// Returns the case.
    pub fn case(&self) -> &Arc<Case> {
        &self.case
    }

    /// Returns the organ on its table.
    pub fn table(&self) -> &Table {
        &self.table
    }

    /// Returns the world of the organ.
    pub fn world(&self) -> &World<Dim3> {
        &self.table.world
    }

    /// Returns the organ.
    pub fn organ(&self) -> &SoftBody<Dim3> {
        &self.table.world[self.table.organ]
    }

    /// Returns the tool in the hand.
    pub fn held(&self) -> &HeldTool {
        &self.held
    }

    /// Returns the rigid body of the tool.
    pub fn tool(&self) -> RigidBodyRef<'_, Dim3> {
        self.held.rigid(&self.table.world)
    }

    /// Returns the number of ticks.
    pub fn ticks(&self) -> usize {
        self.inputs.len()
    }

    /// Returns whether the procedure has reached its maximum length.
    pub fn is_full(&self) -> bool {
        self.ticks() >= MOST_TICKS
    }

    /// Returns the input of each tick.
    pub fn inputs(&self) -> &[Input] {
        &self.inputs
    }

    /// Returns the measurements after each tick.
    pub fn samples(&self) -> &[Sample] {
        &self.samples
    }

    /// Returns the low and high corner of the organ's current bounding box [m].
    pub fn span(&self) -> [Vec3; 2] {
        bounds(self.organ())
    }

    /// Returns the height at which tools enter [m]: above the organ, but within the room.
    pub fn entry(&self) -> f32 {
        entry(&self.table)
    }

    /// Returns the world hashes, one after every 60 ticks.
    pub fn hashes(&self) -> &[u64] {
        &self.hashes
    }

    /// Changes the tool. The new tool enters above the organ, so that it does not start inside tissue.
    fn take(&mut self, tool: Tool) -> Result<(), Error> {
        if tool == self.held.tool() {
            return Ok(());
        }
        self.goal.y = self.entry();
        let Table { world, organ, .. } = &mut self.table;
        let next = HeldTool::new(world, *organ, tool, self.goal, self.rotation)?;
        std::mem::replace(&mut self.held, next).put_away(world)
    }

    /// Moves the target of the tool towards the position in the input, at limited speed and within the room.
    fn follow(&mut self, input: &Input) {
        let [low, high] = self.table.room;
        let way = input.place().clamp(low, high) - self.goal;
        let share = (FASTEST * DEFAULT_TICK / way.length().max(1e-9)).min(1.0);
        self.goal += way * share;
        let way = self.rotation.inverse().then(input.rotation()).scaled_axis();
        self.rotation = match way.length() > SPIN * DEFAULT_TICK {
            true => self
                .rotation
                .then(Rotation::about(way, SPIN * DEFAULT_TICK)),
            false => input.rotation(),
        };
    }

    fn measure(&self, report: &StepReport) -> Sample {
        let before = self.samples.last().copied().unwrap_or_default();
        let tool = self.tool();
        let mean = |of: fn(Reaction<Dim3>) -> Vec3| {
            let reactions = tool.reactions();
            let share = 1.0 / reactions.len().max(1) as f32;
            reactions.map(of).sum::<Vec3>() * share
        };
        let (mut area, mut work) = (0.0, 0.0);
        for event in self.table.world.events() {
            if let Event::Cut {
                area: more,
                work: done,
                ..
            } = *event
            {
                (area, work) = (area + f64::from(more), work + f64::from(done));
            }
        }
        let force = mean(|felt| felt.contact);
        let is_within = self.held.tool() == Tool::Knife && force != Vec3::ZERO;
        let far = match is_within && before.tool == Tool::Knife {
            true => f64::from(tool.position().distance(before.at)),
            false => 0.0,
        };
        Sample {
            area: before.area + area,
            work: before.work + work,
            path: before.path + far,
            tool: self.held.tool(),
            at: tool.position(),
            force,
            peak: tool
                .reactions()
                .map(|felt| felt.contact.length())
                .fold(0.0, f32::max),
            torque: mean(|felt| felt.torque),
            released: before.released + report.nodes_split,
            pieces: measures::pieces(self.organ()),
            grips: self.held.grips(),
        }
    }
}

fn entry(table: &Table) -> f32 {
    let organ = &table.world[table.organ];
    let [low, high] = bounds(organ);
    let above = (ENTRY * (high.y - low.y)).max(clearance(organ));
    (high.y + above).clamp(table.room[0].y, table.room[1].y)
}
