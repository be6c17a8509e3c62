//! What whoever records and the thread that writes leave for each other.

use crate::row::room_of;
use crate::{Entry, Moment, Round, SetAside, Today};
use std::collections::VecDeque;
use std::path::PathBuf;
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Instant;

/// How a recorder is.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Health {
    /// Whether what is recorded now gets on file.
    pub is_recording: bool,
    /// Why not, or why nothing gets to the server: a sentence.
    pub trouble: Option<String>,
    /// How many entries wait to be written.
    pub waiting: usize,
    /// How many had to be dropped since it began, because too many waited or one was refused.
    pub dropped: u64,
    /// How much room the file takes [bytes].
    pub bytes: u64,
    /// How many rows the server has not got yet; none without a server.
    pub unsent: u64,
    /// The file that was set aside last, since it began.
    pub set_aside: Option<SetAside>,
}

/// Most entries that wait, and most bytes of them: weeks of visits, in the memory of any machine that plays.
const MOST_WAITING: usize = 1 << 16;
const MOST_BYTES: usize = 1 << 26;
/// Most entries that are written at once.
const BATCH: usize = 256;

#[derive(Debug, Default)]
pub struct Desk {
    state: Mutex<State>,
    /// Told when there is something to do, and when all is done.
    bell: Condvar,
}

#[derive(Debug, Default)]
struct State {
    queue: VecDeque<Entry>,
    bytes: usize,
    in_hand: usize,
    questions: Questions,
    answers: Answers,
    report: Report,
    dropped: u64,
    set_aside: Option<SetAside>,
    finish_by: Option<Instant>,
    is_closed: bool,
}

/// What is asked for and not answered yet.
#[derive(Debug, Default)]
pub struct Questions {
    pub today: Option<Moment>,
    pub best: Option<Best>,
    pub export: Option<PathBuf>,
}

/// Which rounds are asked for.
#[derive(Debug)]
pub struct Best {
    pub since: Moment,
    pub level: String,
    pub level_hash: Option<u64>,
    pub most: usize,
}

/// What was answered last.
#[derive(Debug, Default)]
pub struct Answers {
    pub today: Option<Today>,
    pub best: Option<Vec<Round>>,
    pub export: Option<Result<PathBuf, String>>,
}

/// How the file is.
#[derive(Clone, Debug, Default)]
pub struct Report {
    pub is_recording: bool,
    pub trouble: Option<String>,
    pub bytes: u64,
}

impl Desk {
    /// Leaves an entry to be written; where too much waits already, it is dropped and counted.
    pub fn put(&self, entry: Entry) {
        let mut state = self.state();
        let size = room_of(&entry);
        let is_full = state.queue.len() >= MOST_WAITING || state.bytes + size > MOST_BYTES;
        if is_full || state.is_closed {
            state.dropped += 1;
            return;
        }
        state.bytes += size;
        state.queue.push_back(entry);
        self.bell.notify_all();
    }

    pub fn ask(&self, ask: impl FnOnce(&mut Questions)) {
        ask(&mut self.state().questions);
        self.bell.notify_all();
    }

    /// What is asked for, which counts as answered from now on.
    pub fn questions(&self) -> Questions {
        std::mem::take(&mut self.state().questions)
    }

    pub fn answer<T>(&self, of: impl FnOnce(&mut Answers) -> T) -> T {
        of(&mut self.state().answers)
    }

    pub fn health(&self) -> Health {
        let state = self.state();
        let report = state.report.clone();
        Health {
            is_recording: report.is_recording && !state.is_closed,
            trouble: report.trouble,
            waiting: state.queue.len() + state.in_hand,
            dropped: state.dropped,
            bytes: report.bytes,
            unsent: 0,
            set_aside: state.set_aside.clone(),
        }
    }

    /// Waits until there is something to do, or until a time; and, where trouble rests until then, for nothing else. Whether to go on.
    pub fn wait(&self, until: Instant, is_resting: bool) -> bool {
        let mut state = self.state();
        loop {
            let now = Instant::now();
            if state.finish_by.is_some() {
                return false;
            }
            let asked = &state.questions;
            let is_asked = asked.today.is_some() || asked.best.is_some() || asked.export.is_some();
            let has_work = !is_resting && (is_asked || !state.queue.is_empty());
            if has_work || now >= until {
                return true;
            }
            let waited = self.bell.wait_timeout(state, until - now);
            state = waited.unwrap_or_else(PoisonError::into_inner).0;
        }
    }

    /// Takes a handful of what waits; it counts as waiting until it is [`Desk::put_down`].
    pub fn take(&self) -> Vec<Entry> {
        let mut state = self.state();
        let count = state.queue.len().min(BATCH);
        let batch: Vec<Entry> = state.queue.drain(..count).collect();
        state.bytes -= batch.iter().map(room_of).sum::<usize>();
        state.in_hand = count;
        batch
    }

    /// All that was taken is written, but for some that had to be dropped.
    pub fn put_down(&self, dropped: u64) {
        let mut state = self.state();
        state.in_hand = 0;
        state.dropped += dropped;
    }

    pub fn report(&self, report: Report) {
        self.state().report = report;
    }

    pub fn report_set_aside(&self, set_aside: SetAside) {
        self.state().set_aside = Some(set_aside);
    }

    /// By when all is to be written, if it is to end.
    pub fn finish_by(&self) -> Option<Instant> {
        self.state().finish_by
    }

    /// Nothing is written from now on.
    pub fn close(&self, trouble: String) {
        let mut state = self.state();
        state.is_closed = true;
        if !trouble.is_empty() {
            state.report.trouble = Some(trouble);
        }
        self.bell.notify_all();
    }

    /// Waits until all is written and nothing is written any more, or until a time.
    pub fn finish(&self, by: Instant) {
        let mut state = self.state();
        let by = *state.finish_by.get_or_insert(by);
        self.bell.notify_all();
        while !state.is_closed && Instant::now() < by {
            let waited = self.bell.wait_timeout(state, by - Instant::now());
            state = waited.unwrap_or_else(PoisonError::into_inner).0;
        }
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
