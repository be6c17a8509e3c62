//! Time that runs back in a round.
//!
//! During play, a copy of the round is kept at regular marks. When time runs back, the ticks after a mark are computed
//! once more from the recorded inputs, and shown in reverse. The engine is deterministic, so they are the same to the bit.
//!
//! ```
//! use std::sync::Arc;
//! use tamaire_play::{AnyRound, InputFrame, Level, Rewind};
//!
//! let mut round = AnyRound::new(Arc::new(Level::open("classic")?));
//! let mut rewind = Rewind::new(&round);
//! let mut hashes = vec![round.hash()];
//! for _ in 0..60 {
//!     round.step(InputFrame::default());
//!     rewind.note(&round);
//!     hashes.push(round.hash());
//! }
//! rewind.begin(&round);
//! while round.ticks() > 30 {
//!     rewind.prepare(&round);
//!     rewind.back(&mut round);
//! }
//! assert_eq!(round.hash(), hashes[round.ticks() as usize]);
//! # Ok::<(), tamaire_play::level::LevelError>(())
//! ```

use crate::playground::TimedChange;
#[cfg(doc)]
use crate::round::MAX_TICKS;
use crate::round::RoundState;
use crate::{AnyRound, InputFrame};
use fuwafuwa::{Dim2, Dim3};
use std::collections::VecDeque;

/// Longest time that can run back [ticks]: 10 s.
pub const LONGEST: u64 = 600;
/// Memory for all copies of a round [bytes].
pub const MEMORY: usize = 64 << 20;

/// Memory of a copy per node of its bodies [bytes], in 2D and 3D: of one whose topology no other copy shares, and of one
/// that shares it with the copy before. A counting allocator found up to 645 and 861 in bodies that tear in every tick;
/// `--example rewind` measures the others.
const ALONE: [usize; 2] = [680, 900];
const SHARING: [usize; 2] = [540, 440];
/// Interval between two adaptations of the plan to the growing bodies [ticks].
const LOOK: u64 = 12;

/// State of a round in 2D or in 3D.
#[derive(Clone, Debug)]
enum AnyState {
    Plane(Box<RoundState<Dim2>>),
    Space(Box<RoundState<Dim3>>),
}

impl AnyState {
    fn of(round: &AnyRound) -> Self {
        match round {
            AnyRound::Plane(round) => Self::Plane(Box::new(round.state())),
            AnyRound::Space(round) => Self::Space(Box::new(round.state())),
        }
    }

    fn tick(&self) -> u64 {
        match self {
            Self::Plane(state) => state.tick(),
            Self::Space(state) => state.tick(),
        }
    }

    /// Returns whether all bodies share their topology with those of an earlier state.
    fn shares_topology_with(&self, before: &Self) -> bool {
        match (self, before) {
            (Self::Plane(state), Self::Plane(before)) => state.shares_topology_with(before),
            (Self::Space(state), Self::Space(before)) => state.shares_topology_with(before),
            _ => false,
        }
    }

    /// Returns a round of the same level as `round` that goes on from this state.
    fn continued(self, round: &AnyRound) -> AnyRound {
        match (self, round) {
            (Self::Plane(state), AnyRound::Plane(round)) => {
                AnyRound::Plane(round.continued(*state))
            }
            (Self::Space(state), AnyRound::Space(round)) => {
                AnyRound::Space(round.continued(*state))
            }
            _ => unreachable!("a round keeps its dimension"),
        }
    }

    /// Puts a round of the same level back into this state.
    fn restore(self, round: &mut AnyRound) {
        match (self, round) {
            (Self::Plane(state), AnyRound::Plane(round)) => round.restore(*state),
            (Self::Space(state), AnyRound::Space(round)) => round.restore(*state),
            _ => unreachable!("a round keeps its dimension"),
        }
    }
}

/// Distances between copies of a round.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
struct Plan {
    /// Distance between marks [ticks].
    mark: u64,
    /// Distance between the states that are shown when time runs back [ticks].
    shown: u64,
    /// Time that can run back [ticks].
    length: u64,
}

impl Plan {
    /// Returns the plan for copies that take these amounts of memory [bytes]: on average at the marks, and at the shown
    /// ticks. It is as long as possible up to [`LONGEST`], and as smooth as possible. There are copies at all marks and,
    /// for two intervals between marks, at all shown ticks.
    fn of(at_mark: usize, shown_copy: usize) -> Self {
        let needed = |plan: &Plan| {
            let [marks, shown] = [
                plan.length / plan.mark + 1,
                2 * plan.mark.div_ceil(plan.shown) + 2,
            ];
            marks as usize * at_mark + shown as usize * shown_copy
        };
        for shown in 1..=3 {
            // The memory is smallest if marks and shown states take about the same.
            let marks = (8..=LONGEST / shown).map(|mark| Plan {
                mark: mark * shown,
                shown,
                length: LONGEST,
            });
            let best = marks.min_by_key(needed).expect("the range is not empty");
            if needed(&best) <= MEMORY {
                return best;
            }
        }
        let lengths = (1..=LONGEST / 30).rev().flat_map(|half_seconds| {
            [12, 18, 24, 36, 48].map(|mark| Plan {
                mark,
                shown: 3,
                length: 30 * half_seconds,
            })
        });
        let mut fitting = lengths.filter(|plan| needed(plan) <= MEMORY);
        fitting.next().unwrap_or(Plan {
            mark: 12,
            shown: 4,
            length: 24,
        })
    }
}

/// Copies of a round at earlier ticks, and the states between two of them.
#[derive(Clone, Debug)]
pub struct Rewind {
    plan: Plan,
    /// Copies at marks, in the order of their ticks, each with whether it shares its topology with the one before.
    marks: VecDeque<(AnyState, bool)>,
    /// Inputs of the round when time began to run back.
    frames: Vec<InputFrame>,
    /// Changes of a playground up to then.
    changes: Vec<TimedChange>,
    /// States that are shown next, in the order of their ticks; the last one comes first.
    shown: Vec<AnyState>,
    /// States before those, as far as they are computed.
    before: Vec<AnyState>,
    /// Round in which `before` is computed, and the tick up to which it runs. `None` while time runs forward, and when
    /// all states up to the earliest mark are computed.
    computing: Option<(AnyRound, u64)>,
}

impl Rewind {
    /// Begins with a round at its start.
    pub fn new(round: &AnyRound) -> Self {
        let marks = VecDeque::from([(AnyState::of(round), false)]);
        Self {
            plan: plan_for(round, &marks),
            marks,
            frames: Vec::new(),
            changes: Vec::new(),
            shown: Vec::new(),
            before: Vec::new(),
            computing: None,
        }
    }

    /// Notes the state of the round after a tick.
    pub fn note(&mut self, round: &AnyRound) {
        let tick = round.ticks();
        if tick.is_multiple_of(LOOK) {
            self.adapt(round);
        }
        if tick.is_multiple_of(self.plan.mark) {
            let state = AnyState::of(round);
            let before = self.marks.back();
            let shares = before.is_some_and(|(before, _)| state.shares_topology_with(before));
            self.marks.push_back((state, shares));
            let is_old = |mark: Option<&(AnyState, bool)>| {
                mark.is_some_and(|(mark, _)| mark.tick() + self.plan.length <= tick)
            };
            // The mark before the earliest tick that can be shown stays.
            while is_old(self.marks.get(1)) {
                self.marks.pop_front();
            }
        }
    }

    /// Makes a new plan if copies take more or less memory than before, as they do when bodies tear, and drops marks that
    /// are closer to each other than it asks for.
    fn adapt(&mut self, round: &AnyRound) {
        let plan = plan_for(round, &self.marks);
        if plan == self.plan {
            return;
        }
        self.plan = plan;
        let mut last = None;
        self.marks.retain(|(mark, _)| {
            let is_close = last.is_some_and(|last| mark.tick() < last + plan.mark);
            if !is_close {
                last = Some(mark.tick());
            }
            !is_close
        });
    }

    /// Returns for how many ticks time can still run back. After a win, and after [`MAX_TICKS`], it is 0.
    pub fn left(&self, round: &AnyRound) -> u64 {
        let is_recorded = round.frames().len() as u64 == round.ticks();
        if round.progress().outcome.is_some() || !is_recorded {
            return 0;
        }
        let earliest = self.marks.front().map_or(0, |(mark, _)| mark.tick());
        round.ticks().saturating_sub(earliest).min(self.plan.length)
    }

    /// Returns the distance between two states that are shown one after the other [ticks].
    pub fn stride(&self) -> u64 {
        self.plan.shown
    }

    /// Lets time run back from now on.
    pub fn begin(&mut self, round: &AnyRound) {
        self.frames = round.frames().to_vec();
        self.changes = round.changes().to_vec();
        self.shown.clear();
        self.before.clear();
        self.computing = None;
        self.compute_up_to(round, round.ticks());
    }

    /// Computes a tick of the states that will be shown. Returns whether there is nothing left to compute now.
    pub fn prepare(&mut self, round: &AnyRound) -> bool {
        if let Some((past, end)) = &mut self.computing {
            if past.ticks() < *end {
                let frame = self.frames.get(past.ticks() as usize);
                past.change_again(&self.changes);
                past.step(frame.copied().unwrap_or_default());
                if past.ticks() < *end && past.ticks().is_multiple_of(self.plan.shown) {
                    self.before.push(AnyState::of(past));
                }
                return false;
            }
            self.computing = None;
        }
        if self.shown.is_empty() && !self.before.is_empty() {
            self.shown = std::mem::take(&mut self.before);
            let first = self.shown[0].tick();
            self.compute_up_to(round, first);
        }
        self.computing.is_none()
    }

    /// Returns whether the next state to show is ready.
    pub fn is_ready(&self) -> bool {
        !self.shown.is_empty()
    }

    /// Puts the round back to the next earlier state that is ready. Returns whether there was one.
    pub fn back(&mut self, round: &mut AnyRound) -> bool {
        let Some(state) = self.shown.pop() else {
            return false;
        };
        let tick = state.tick();
        state.restore(round);
        while { self.marks.back() }.is_some_and(|(mark, _)| mark.tick() > tick) {
            self.marks.pop_back();
        }
        true
    }

    /// Lets time run forward again.
    pub fn end(&mut self) {
        self.frames = Vec::new();
        self.changes = Vec::new();
        self.shown = Vec::new();
        self.before = Vec::new();
        self.computing = None;
    }

    /// Begins to compute the states from the last mark before a tick up to that tick.
    fn compute_up_to(&mut self, round: &AnyRound, end: u64) {
        let mark = self.marks.iter().rfind(|(mark, _)| mark.tick() < end);
        let Some((mark, _)) = mark else {
            return;
        };
        self.before = vec![mark.clone()];
        self.computing = Some((mark.clone().continued(round), end));
    }
}

/// Returns the plan for further copies of a round, of which there are copies at marks.
fn plan_for(round: &AnyRound, marks: &VecDeque<(AnyState, bool)>) -> Plan {
    let nodes = round.nodes();
    let dim = match round {
        AnyRound::Plane(_) => 0,
        AnyRound::Space(_) => 1,
    };
    let alone = marks.iter().filter(|(_, shares)| !shares).count();
    let sharing = marks.len() - alone;
    let all = nodes * (alone * ALONE[dim] + sharing * SHARING[dim]);
    // The states of an interval in which bodies tear do not share their topology.
    let tears = marks.iter().skip(1).any(|(_, shares)| !shares);
    let shown = if tears { ALONE[dim] } else { SHARING[dim] };
    Plan::of(all / marks.len().max(1), nodes * shown)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plans_keep_to_the_memory() {
        for at_mark in (50_000..6_000_000).step_by(70_000) {
            for shown in [at_mark / 2, at_mark, 2 * at_mark] {
                let plan = Plan::of(at_mark, shown);
                // Marks, the states of two intervals between marks, and two copies in use.
                let marks = (plan.length / plan.mark + 1) as usize;
                let states = (2 * plan.mark.div_ceil(plan.shown) + 2) as usize;
                let all = marks * at_mark + states * shown;
                let is_least = plan.length == 24;
                assert!(all <= MEMORY || is_least, "{at_mark}, {shown}: {plan:?}");
            }
        }
        let long = Plan::of(700_000, 700_000);
        assert_eq!((long.length, long.shown), (LONGEST, 1));
        let torn = Plan::of(2_000_000, 2_000_000);
        assert!(torn.length >= 240 && torn.shown <= 3, "{torn:?}");
    }
}
