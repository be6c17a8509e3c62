//! A procedure running in real time: by hand, or as a replay.

use super::hand::Hand;
use crate::measures::{PieceVolume, Sample, parts};
use crate::procedure::Procedure;
use crate::record::{Playback, Recording};
use crate::tools::Tool;
use app_shell::{CameraRig, Clock, Pace};
use fuwafuwa::Vec3;
use std::sync::Arc;

/// Number of ticks after which the volumes of the pieces are measured again.
const LOOKS: usize = 20;
/// Margins around the organ in the main view: to the sides, below and above, as fractions of the organ's
/// size.
const SEEN: [f32; 3] = [0.12, 0.0, 0.5];
/// Margins around the organ in slices: to the sides, below and above, as fractions of the organ's size.
const SLICED: [f32; 3] = [0.1, 0.05, 0.25];

/// Source of the tool's motion.
enum MotionSource {
    Hand(Box<Procedure>),
    Again(Box<Playback>),
}

/// Procedure running in real time.
pub struct Session {
    course: MotionSource,
    pace: Pace,
    /// Hand that moves the tool; unused in a replay.
    pub hand: Hand,
    /// Camera of the main view.
    pub camera: CameraRig,
    /// Region of the main view: low and high corner [m].
    pub seen: [Vec3; 2],
    /// Region of the slices: low and high corner [m].
    pub sliced: [Vec3; 2],
    /// Whether the tip of the tool stays under the pointer, because the mouse moved it last.
    pub follows_pointer: bool,
    /// Whether the forceps closed on nothing since the last message.
    pub has_gripped_nothing: bool,
    /// Whether the procedure is paused.
    pub is_paused: bool,
    /// Volumes of the pieces as of the last measurement.
    pub parts: Vec<PieceVolume>,
    looked: usize,
    /// Message at the end of a replay, or the error that stopped the procedure.
    pub verdict: Option<String>,
    /// Whether the procedure has ended.
    has_ended: bool,
    torn: u32,
}

impl Session {
    /// Creates a session in which the user operates.
    pub fn new(procedure: Procedure) -> Self {
        Self::of(MotionSource::Hand(Box::new(procedure)))
    }

    /// Creates a session that replays a recording.
    pub fn again(playback: Playback) -> Self {
        Self::of(MotionSource::Again(Box::new(playback)))
    }

    fn of(course: MotionSource) -> Self {
        let procedure = match &course {
            MotionSource::Hand(procedure) => procedure,
            MotionSource::Again(playback) => playback.procedure(),
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
            follows_pointer: false,
            has_gripped_nothing: false,
            is_paused: false,
            looked: 0,
            verdict: None,
            has_ended: false,
            torn: 0,
        }
    }

    /// Returns the procedure in its current state.
    pub fn procedure(&self) -> &Procedure {
        match &self.course {
            MotionSource::Hand(procedure) => procedure,
            MotionSource::Again(playback) => playback.procedure(),
        }
    }

    /// Returns whether the user moves the tool; false in a replay.
    pub fn is_by_hand(&self) -> bool {
        matches!(self.course, MotionSource::Hand(_))
    }

    /// Returns the replayed fraction of a recording, 0 to 1; `None` if the user moves the tool.
    pub fn played(&self) -> Option<f32> {
        match &self.course {
            MotionSource::Hand(_) => None,
            MotionSource::Again(playback) => {
                let all = playback.recording().ticks().max(1);
                Some(playback.procedure().ticks() as f32 / all as f32)
            }
        }
    }

    /// Returns the measurements of the last tick; zeros before the first tick.
    pub fn last(&self) -> Sample {
        let samples = self.procedure().samples();
        samples.last().copied().unwrap_or_default()
    }

    /// Returns the expected computing time of a tick [s].
    pub fn cost(&self) -> f64 {
        self.pace.cost()
    }

    /// Continues by hand from the current point of a replay.
    pub fn take_over(self) -> Self {
        match self.course {
            MotionSource::Hand(_) => self,
            MotionSource::Again(playback) => {
                let procedure = playback.into_procedure();
                let camera = self.camera;
                let next = Self::new(procedure);
                Self { camera, ..next }
            }
        }
    }

    /// Returns the recording of the procedure up to now.
    pub fn recording(&self) -> Arc<Recording> {
        Arc::new(Recording::of(self.procedure()))
    }

    /// Advances the procedure by `seconds`, or by less if the machine is too slow. `clock` measures the
    /// computing time of the ticks.
    pub fn pass(&mut self, clock: &Clock, seconds: f64) {
        if self.is_paused || self.is_over() {
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

    /// Returns the number of nodes split since the last call of this function.
    pub fn take_torn(&mut self) -> u32 {
        std::mem::take(&mut self.torn)
    }

    /// Returns whether the procedure has ended, so that no more ticks can follow.
    pub fn is_over(&self) -> bool {
        match &self.course {
            _ if self.has_ended => true,
            MotionSource::Hand(procedure) => procedure.is_full(),
            MotionSource::Again(playback) => playback.is_over(),
        }
    }

    fn tick(&mut self) {
        let before = self.last().released;
        match &mut self.course {
            MotionSource::Hand(procedure) => {
                let input = self.hand.input();
                let was_open = procedure.inputs().last().is_none_or(|last| !last.grips);
                if let Err(refused) = procedure.step(input) {
                    self.verdict = Some(refused.to_string());
                }
                let closes = input.tool == Tool::Forceps && input.grips && was_open;
                self.has_gripped_nothing |= closes && !procedure.held().grips();
            }
            MotionSource::Again(playback) => match playback.step() {
                Ok(()) if playback.is_over() => {
                    self.verdict =
                        Some("The replay is identical to the recording, bit for bit.".into());
                }
                Ok(()) => {}
                Err(error) => self.verdict = Some(error.to_string()),
            },
        }
        self.has_ended |= self.verdict.is_some();
        self.torn += self.last().released.saturating_sub(before);
    }
}

/// Returns a box enlarged by fractions of its size, given for the sides, below and above.
fn around([low, high]: [Vec3; 2], [sides, below, above]: [f32; 3]) -> [Vec3; 2] {
    let size = high - low;
    [
        low - Vec3::new(sides, below, sides) * size,
        high + Vec3::new(sides, above, sides) * size,
    ]
}
