//! A procedure in time: done by hand, or played again.

use super::hand::Hand;
use crate::measures::{Part, Sample, parts};
use crate::procedure::Procedure;
use crate::record::{Playback, Recording};
use fuwafuwa::Vector;
use fuwafuwa::vector::{minus, plus};
use std::sync::Arc;
use tamaire::look::CameraRig;
use tamaire::pace::Pace;
use tamaire::platform::Clock;

/// Ticks between two looks at how large the pieces are.
const LOOKS: usize = 20;
/// Around the organ so much of its size is seen to the sides, below and above; and in slices.
const SEEN: [f32; 3] = [0.12, 0.0, 0.5];
const SLICED: [f32; 3] = [0.1, 0.05, 0.25];

/// Who moves the tool.
enum Course {
    Hand(Box<Procedure>),
    Again(Box<Playback>),
}

/// A procedure in time.
pub struct Session {
    course: Course,
    pace: Pace,
    /// The hand that moves the tool, where one does.
    pub hand: Hand,
    /// From where it is seen.
    pub camera: CameraRig,
    /// What is seen: from corner to corner [m].
    pub seen: [Vector; 2],
    /// What slices show.
    pub sliced: [Vector; 2],
    /// Whether it rests.
    pub rests: bool,
    /// The pieces, as of a moment ago.
    pub parts: Vec<Part>,
    looked: usize,
    /// What is to be said of a recording that was played, or of why it does not go on.
    pub verdict: Option<String>,
    /// Whether that was the end.
    has_ended: bool,
    torn: u32,
}

impl Session {
    /// One by hand.
    pub fn new(procedure: Procedure) -> Self {
        Self::of(Course::Hand(Box::new(procedure)))
    }

    /// One that was recorded.
    pub fn again(playback: Playback) -> Self {
        Self::of(Course::Again(Box::new(playback)))
    }

    fn of(course: Course) -> Self {
        let procedure = match &course {
            Course::Hand(procedure) => procedure,
            Course::Again(playback) => playback.procedure(),
        };
        let start = procedure.tool().position();
        let hand = match procedure.inputs().last() {
            Some(last) => Hand::holding(start, last),
            None => Hand::at(start, procedure.held().tool()),
        };
        let organ = procedure.span();
        Self {
            parts: parts(procedure.organ(), procedure.case().millilitres()),
            course,
            pace: Pace::default(),
            hand,
            camera: CameraRig::default(),
            seen: around(organ, SEEN),
            sliced: around(organ, SLICED),
            rests: false,
            looked: 0,
            verdict: None,
            has_ended: false,
            torn: 0,
        }
    }

    /// The procedure as it is now.
    pub fn procedure(&self) -> &Procedure {
        match &self.course {
            Course::Hand(procedure) => procedure,
            Course::Again(playback) => playback.procedure(),
        }
    }

    /// Whether it is done by hand.
    pub fn is_by_hand(&self) -> bool {
        matches!(self.course, Course::Hand(_))
    }

    /// How much of a recording was played, 0 to 1.
    pub fn played(&self) -> Option<f32> {
        match &self.course {
            Course::Hand(_) => None,
            Course::Again(playback) => {
                let all = playback.recording().ticks().max(1);
                Some(playback.procedure().ticks() as f32 / all as f32)
            }
        }
    }

    /// What was measured last.
    pub fn last(&self) -> Sample {
        let samples = self.procedure().samples();
        samples.last().copied().unwrap_or_default()
    }

    /// What a tick takes [s].
    pub fn cost(&self) -> f64 {
        self.pace.cost()
    }

    /// Goes on by hand from where a recording is.
    pub fn take_over(self) -> Self {
        match self.course {
            Course::Hand(_) => self,
            Course::Again(playback) => {
                let procedure = playback.into_procedure();
                let camera = self.camera;
                let next = Self::new(procedure);
                Self { camera, ..next }
            }
        }
    }

    /// What is needed to begin again.
    pub fn recording(&self) -> Arc<Recording> {
        Arc::new(Recording::of(self.procedure()))
    }

    /// Lets `seconds` pass.
    pub fn pass(&mut self, clock: &Clock, seconds: f64) {
        if self.rests || self.is_over() {
            self.pace.forget();
            return;
        }
        self.pace.begin(seconds);
        while self.pace.is_due() && !self.is_over() {
            let began = clock.now();
            self.tick();
            self.pace.note(clock.now() - began);
        }
        let ticks = self.procedure().ticks();
        if ticks >= self.looked + LOOKS {
            self.looked = ticks;
            let procedure = self.procedure();
            self.parts = parts(procedure.organ(), procedure.case().millilitres());
        }
    }

    /// How many nodes came apart since this was asked last.
    pub fn take_torn(&mut self) -> u32 {
        std::mem::take(&mut self.torn)
    }

    /// Whether there is nothing more to come.
    pub fn is_over(&self) -> bool {
        match &self.course {
            _ if self.has_ended => true,
            Course::Hand(procedure) => procedure.is_full(),
            Course::Again(playback) => playback.is_over(),
        }
    }

    fn tick(&mut self) {
        let before = self.last().released;
        match &mut self.course {
            Course::Hand(procedure) => {
                if let Err(refused) = procedure.step(self.hand.input()) {
                    self.verdict = Some(refused.to_string());
                }
            }
            Course::Again(playback) => match playback.step() {
                Ok(()) if playback.is_over() => {
                    self.verdict = Some("It came out as it was made, to the last bit.".into());
                }
                Ok(()) => {}
                Err(error) => self.verdict = Some(error.to_string()),
            },
        }
        self.has_ended |= self.verdict.is_some();
        self.torn += self.last().released.saturating_sub(before);
    }
}

/// A box and so much of its size around it: to the sides, below and above.
fn around([low, high]: [Vector; 2], [sides, below, above]: [f32; 3]) -> [Vector; 2] {
    let share = |k: [f32; 3]| [0, 1, 2].map(|axis: usize| k[axis] * (high[axis] - low[axis]));
    let least = minus(low, share([sides, below, sides]));
    [least, plus(high, share([sides, above, sides]))]
}
