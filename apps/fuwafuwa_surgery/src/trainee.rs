//! Automatic trainee for tests, measurements and demonstration. It has no skill; each seed always gives the
//! same motions.

use crate::procedure::{Input, Procedure};
use crate::tools::Tool;
use fuwafuwa::{DEFAULT_TICK, Rotation, Vec3};

/// Straight motion of the tool between two points.
#[derive(Clone, Debug)]
struct Leg {
    tool: Tool,
    from: Vec3,
    to: Vec3,
    rotation: Rotation,
    grips: bool,
    ticks: usize,
}

/// Sequence of motions of an automatic trainee.
#[derive(Clone, Debug)]
pub struct Trainee {
    legs: Vec<Leg>,
    /// Edge radius of the knife [µm].
    dull: u16,
}

/// Sequence of motions under construction.
struct Plan {
    legs: Vec<Leg>,
    at: Vec3,
    random: fastrand::Rng,
}

impl Trainee {
    /// Creates the trainee for the organ of a new procedure. The seed selects its motions.
    pub fn new(procedure: &Procedure, seed: u64) -> Self {
        let [low, high] = procedure.span();
        let middle = (low + high) * 0.5;
        let size = high - low;
        let above = high.y + 0.15 * size.y;
        let mut plan = Plan {
            legs: Vec::new(),
            at: middle.with_y(above),
            random: fastrand::Rng::with_seed(seed),
        };
        let dull = plan.random.u16(20..=600);
        plan.cut(middle, size, above);
        plan.push_aside(middle, size, above);
        plan.pull_up(procedure, middle, size, above);
        Self {
            legs: plan.legs,
            dull,
        }
    }

    /// Returns the input for tick number `tick`, starting at 0.
    pub fn input(&self, tick: usize) -> Input {
        let dull = self.dull;
        let base = Input {
            dull,
            ..Input::default()
        };
        let mut left = tick;
        for leg in &self.legs {
            if left < leg.ticks {
                let share = left as f32 / leg.ticks as f32;
                let place = leg.from + (leg.to - leg.from) * share;
                let input = base.at(leg.tool, place, leg.rotation);
                let grips = leg.grips;
                return Input { grips, ..input };
            }
            left -= leg.ticks;
        }
        let last = self.legs.last();
        last.map_or(base, |leg| base.at(leg.tool, leg.to, leg.rotation))
    }

    /// Returns the number of ticks of the whole sequence.
    pub fn ticks(&self) -> usize {
        self.legs.iter().map(|leg| leg.ticks).sum()
    }
}

impl Plan {
    fn between(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.random.f32()
    }

    /// Appends a straight motion to the point `to` at a speed [m/s].
    fn go(&mut self, tool: Tool, to: Vec3, rotation: Rotation, grips: bool, speed: f32) {
        let far = to.distance(self.at);
        self.legs.push(Leg {
            tool,
            from: self.at,
            to,
            rotation,
            grips,
            ticks: (far / speed / DEFAULT_TICK).ceil().max(1.0) as usize,
        });
        self.at = to;
    }

    /// Appends a cut: the knife is lowered into the organ and drawn along.
    fn cut(&mut self, middle: Vec3, size: Vec3, above: f32) {
        let heading = self.between(-1.5, 1.5);
        let turned = Rotation::about(Vec3::Y, heading);
        let way = turned.apply(Vec3::new(self.between(0.25, 0.45) * size.x, 0.0, 0.0));
        let x = middle.x + self.between(-0.15, 0.15) * size.x;
        let z = middle.z + self.between(-0.15, 0.15) * size.z;
        let deep = above - self.between(0.35, 0.6) * size.y;
        let from = Vec3::new(x, above, z) - way * 0.5;
        let to = from + way;
        self.go(Tool::Knife, from, turned, false, 0.2);
        self.go(Tool::Knife, from.with_y(deep), turned, false, 0.05);
        self.go(Tool::Knife, to.with_y(deep), turned, false, 0.04);
        self.go(Tool::Knife, to, turned, false, 0.1);
    }

    /// Appends a push: the hook is pressed into the organ and drawn along.
    fn push_aside(&mut self, middle: Vec3, size: Vec3, above: f32) {
        let x = middle.x + self.between(-0.2, 0.2) * size.x;
        let z = middle.z + self.between(-0.2, 0.2) * size.z;
        let deep = above - self.between(0.25, 0.45) * size.y;
        let turned = Rotation::about(Vec3::Y, self.between(-1.5, 1.5));
        let aside = self.between(-0.15, 0.15) * size.x;
        self.go(Tool::Hook, Vec3::new(x, above, z), turned, false, 0.2);
        self.go(Tool::Hook, Vec3::new(x, deep, z), turned, false, 0.06);
        self.go(
            Tool::Hook,
            Vec3::new(x + aside, deep, z),
            turned,
            false,
            0.04,
        );
        self.go(Tool::Hook, Vec3::new(x, above, z), turned, false, 0.15);
    }

    /// Appends a pull: the forceps grip the top of the organ and rise.
    fn pull_up(&mut self, procedure: &Procedure, middle: Vec3, size: Vec3, above: f32) {
        let x = middle.x + self.between(-0.2, 0.2) * size.x;
        let z = middle.z + self.between(-0.2, 0.2) * size.z;
        let top = top_at(procedure, [x, z]).unwrap_or(middle.y);
        let none = Rotation::NONE;
        self.go(Tool::Forceps, Vec3::new(x, above, z), none, false, 0.2);
        self.go(
            Tool::Forceps,
            Vec3::new(x, top - 0.002, z),
            none,
            false,
            0.06,
        );
        let up = top + self.between(0.1, 0.25) * size.y;
        let aside = x + self.between(-0.1, 0.1) * size.x;
        self.go(Tool::Forceps, Vec3::new(aside, up, z), none, true, 0.04);
        self.go(Tool::Forceps, Vec3::new(x, above, z), none, false, 0.15);
    }
}

/// Returns the height of the organ's top near a point of the horizontal plane [m].
fn top_at(procedure: &Procedure, [x, z]: [f32; 2]) -> Option<f32> {
    let organ = procedure.organ();
    let reach = 1.5 * organ.grid().voxel_size();
    let nodes = organ.mesh().nodes().map(|(id, _)| organ.node_state(id).0);
    let near = nodes.filter(|at| (at.x - x).abs() < reach && (at.z - z).abs() < reach);
    near.map(|at| at.y).reduce(f32::max)
}
