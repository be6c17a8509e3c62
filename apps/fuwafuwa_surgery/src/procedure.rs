//! A procedure, tick by tick: what the hand wants goes in, and everything else follows from it.

use crate::case::{Case, CaseError, Table, bounds};
use crate::measures::{self, Sample};
use crate::tools::{Held, Tool, clearance};
use fuwafuwa::vector::{length, minus, plus, scaled};
use fuwafuwa::world::TICK;
use fuwafuwa::{Dim3, Event, Refused, RigidBody, Rotation, SoftBody, StepReport, Vector, World};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Goals are written in steps of a hundredth of a millimetre [m].
const STEP: f32 = 1e-5;
/// A part of a quaternion is written as so many steps for 1.
const PARTS: f32 = 32767.0;
/// A tool goes no faster than this [m/s], however fast a mouse jumps.
const FASTEST: f32 = 0.25;
/// It turns no faster than this [rad/s].
const SPIN: f32 = 5.0;
/// Tools come in so much of the height of the organ above it, or higher where they are large.
const ENTRY: f32 = 0.2;
/// The most ticks of a procedure: an hour.
pub const MOST_TICKS: usize = 60 * 60 * 60;
/// The bluntest knife [µm].
pub const BLUNTEST: u16 = 2000;

/// What the hand wants in a tick. It is written down as it is, so that the same comes of it again.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Input {
    /// What it holds.
    pub tool: Tool,
    /// Where to [0.01 mm].
    pub goal: [i32; 3],
    /// How it is turned: x, y, z, w of a quaternion, 32767 for 1.
    pub turn: [i16; 4],
    /// Whether it grips.
    pub grips: bool,
    /// Radius of the knife's edge [µm].
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
    /// The same with a tool somewhere [m], turned so.
    #[must_use]
    pub fn at(self, tool: Tool, goal: Vector, rotation: Rotation) -> Self {
        Self {
            tool,
            goal: goal.map(|k| (k / STEP).round() as i32),
            turn: rotation.quaternion().map(|k| (k * PARTS).round() as i16),
            ..self
        }
    }

    /// Where the tool is to be [m].
    pub fn place(&self) -> Vector {
        self.goal.map(|k| k as f32 * STEP)
    }

    /// How it is to be turned.
    pub fn rotation(&self) -> Rotation {
        Rotation::from_quaternion(self.turn.map(|k| f32::from(k) / PARTS))
    }
}

/// A procedure as it is now.
pub struct Procedure {
    case: Arc<Case>,
    table: Table,
    held: Held,
    /// Where the tool is sent, and how it is turned there: it follows what is wanted no faster than it may.
    goal: Vector,
    rotation: Rotation,
    inputs: Vec<Input>,
    samples: Vec<Sample>,
    hashes: Vec<u64>,
}

impl Procedure {
    /// One that begins: the organ lies on the table, and a tool hangs above it.
    ///
    /// # Errors
    /// [`CaseError`] says why the organ cannot be laid there.
    pub fn new(case: Arc<Case>) -> Result<Self, CaseError> {
        let mut table = case.lay()?;
        let [low, high] = table.room;
        let goal = [
            0.5 * (low[0] + high[0]),
            entry(&table),
            0.5 * (low[2] + high[2]),
        ];
        let rotation = Rotation::NONE;
        let held = Held::new(
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

    /// Lets a tick pass.
    ///
    /// # Errors
    /// [`Refused`] when the world does not take what is wanted: it never does, as that is kept within the room.
    pub fn step(&mut self, input: Input) -> Result<StepReport, Refused> {
        self.take(input.tool)?;
        self.follow(&input);
        let world = &mut self.table.world;
        self.held.send(world, self.goal, self.rotation)?;
        self.held.grind(world, input.dull.min(BLUNTEST))?;
        self.held.close(world, self.table.organ, input.grips)?;
        let report = world.step();
        self.inputs.push(input);
        self.samples.push(self.measure(&report));
        if self.ticks().is_multiple_of(60) {
            self.hashes.push(self.table.world.hash());
        }
        Ok(report)
    }

    /// What is operated on.
    pub fn case(&self) -> &Arc<Case> {
        &self.case
    }

    /// The organ on its table.
    pub fn table(&self) -> &Table {
        &self.table
    }

    /// The world that it lies in.
    pub fn world(&self) -> &World<Dim3> {
        &self.table.world
    }

    /// The organ.
    pub fn organ(&self) -> &SoftBody<Dim3> {
        &self.table.world.soft_bodies()[self.table.organ]
    }

    /// What is held.
    pub fn held(&self) -> &Held {
        &self.held
    }

    /// What follows the hand.
    pub fn tool(&self) -> &RigidBody {
        self.held.rigid(&self.table.world)
    }

    /// Ticks that have passed.
    pub fn ticks(&self) -> usize {
        self.inputs.len()
    }

    /// Whether it has come to its end: it is not written any longer.
    pub fn is_full(&self) -> bool {
        self.ticks() >= MOST_TICKS
    }

    /// What the hand wanted, tick by tick.
    pub fn inputs(&self) -> &[Input] {
        &self.inputs
    }

    /// What was measured, tick by tick.
    pub fn samples(&self) -> &[Sample] {
        &self.samples
    }

    /// The low and the high corner of what is left of the organ [m].
    pub fn span(&self) -> [Vector; 2] {
        bounds(self.organ())
    }

    /// The height at which a tool comes in [m]: above the organ, and in sight.
    pub fn entry(&self) -> f32 {
        entry(&self.table)
    }

    /// The world's hash after every sixtieth tick.
    pub fn hashes(&self) -> &[u64] {
        &self.hashes
    }

    /// Takes up another tool. It comes in from above, not amid the tissue.
    fn take(&mut self, tool: Tool) -> Result<(), Refused> {
        if tool == self.held.tool() {
            return Ok(());
        }
        self.goal[1] = self.entry();
        let Table { world, organ, .. } = &mut self.table;
        let next = Held::new(world, *organ, tool, self.goal, self.rotation)?;
        std::mem::replace(&mut self.held, next).put_away(world)
    }

    /// Moves the goal towards what is wanted, no faster than a tool goes, and within the room.
    fn follow(&mut self, input: &Input) {
        let [low, high] = self.table.room;
        let wanted = input.place();
        let wanted = [0, 1, 2].map(|axis: usize| wanted[axis].clamp(low[axis], high[axis]));
        let way = minus(wanted, self.goal);
        let share = (FASTEST * TICK / length(way).max(1e-9)).min(1.0);
        self.goal = plus(self.goal, scaled(way, share));
        let way = self.rotation.inverse().then(input.rotation()).scaled_axis();
        let angle = length(way);
        self.rotation = match angle > SPIN * TICK {
            true => self.rotation.then(Rotation::about(way, SPIN * TICK)),
            false => input.rotation(),
        };
    }

    fn measure(&self, report: &StepReport) -> Sample {
        let before = self.samples.last().copied().unwrap_or_default();
        let tool = self.tool();
        let reactions = tool.reactions();
        let mean = |of: fn(&fuwafuwa::Reaction) -> Vector| {
            let sum = reactions
                .iter()
                .fold([0.0; 3], |sum, felt| plus(sum, of(felt)));
            scaled(sum, 1.0 / reactions.len().max(1) as f32)
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
        let is_within = self.held.tool() == Tool::Knife && force != [0.0; 3];
        let far = match is_within && before.tool == Tool::Knife {
            true => f64::from(length(minus(tool.position(), before.at))),
            false => 0.0,
        };
        Sample {
            area: before.area + area,
            work: before.work + work,
            path: before.path + far,
            tool: self.held.tool(),
            at: tool.position(),
            force,
            peak: reactions
                .iter()
                .map(|felt| length(felt.contact))
                .fold(0.0, f32::max),
            torque: mean(|felt| felt.torque),
            released: before.released + report.nodes_split,
            pieces: measures::pieces(self.organ()),
            grips: self.held.grips(),
        }
    }
}

fn entry(table: &Table) -> f32 {
    let organ = &table.world.soft_bodies()[table.organ];
    let [low, high] = bounds(organ);
    let above = (ENTRY * (high[1] - low[1])).max(clearance(organ));
    (high[1] + above).clamp(table.room[0][1], table.room[1][1])
}
