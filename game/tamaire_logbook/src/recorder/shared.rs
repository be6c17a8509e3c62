//! State shared between the recorder and its writing thread.

use crate::row::memory_size;
use crate::{Entry, Moment, Round, SetAside, Today};
use std::collections::VecDeque;
use std::path::PathBuf;
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Instant;

/// State of a recorder.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Health {
    /// Whether new entries reach the file at present.
    pub is_recording: bool,
    /// Reason why entries do not reach the file or the server, as a sentence.
    pub problem: Option<String>,
    /// Number of entries that wait to be written.
    pub waiting: usize,
    /// Number of entries dropped since the start, because too many waited or because SQLite rejected them.
    pub dropped: u64,
    /// Size of the file [bytes].
    pub bytes: u64,
    /// Number of rows that the server has not received yet; 0 without a server.
    pub unsent: u64,
    /// The last damaged file that was set aside since the start.
    pub set_aside: Option<SetAside>,
}

/// Maximum number of entries that wait to be written, enough for weeks of visits.
const MOST_WAITING: usize = 1 << 16;
/// Maximum memory of the entries that wait to be written [bytes].
const MOST_BYTES: usize = 1 << 26;
/// Maximum number of entries written in one transaction.
const BATCH: usize = 256;

#[derive(Debug, Default)]
pub struct SharedState {
    state: Mutex<State>,
    /// Notified when there is new work, and when the thread has finished.
    condvar: Condvar,
}

#[derive(Debug, Default)]
struct State {
    queue: VecDeque<Entry>,
    bytes: usize,
    in_progress: usize,
    questions: Requests,
    answers: Answers,
    report: Report,
    dropped: u64,
    set_aside: Option<SetAside>,
    finish_by: Option<Instant>,
    is_closed: bool,
}

/// Open requests, at most one of each kind. A later request replaces an earlier one of its kind.
#[derive(Debug, Default)]
pub struct Requests {
    pub today: Option<Moment>,
    pub best: Option<Best>,
    pub export: Option<PathBuf>,
}

/// Arguments of a request for the best rounds.
#[derive(Debug)]
pub struct Best {
    pub since: Moment,
    pub level: String,
    pub level_hash: Option<u64>,
    pub most: usize,
}

/// Last answer to each kind of request.
#[derive(Debug, Default)]
pub struct Answers {
    pub today: Option<Today>,
    pub best: Option<Vec<Round>>,
    pub export: Option<Result<PathBuf, String>>,
}

/// State of the file, as last reported by the writing thread.
#[derive(Clone, Debug, Default)]
pub struct Report {
    pub is_recording: bool,
    pub trouble: Option<String>,
    pub bytes: u64,
}

impl SharedState {
    /// Queues an entry for writing. Drops and counts the entry if a limit is reached or recording has ended.
    pub fn put(&self, entry: Entry) {
        let mut state = self.state();
        let size = memory_size(&entry);
        let is_full = state.queue.len() >= MOST_WAITING || state.bytes + size > MOST_BYTES;
        if is_full || state.is_closed {
            state.dropped += 1;
            return;
        }
        state.bytes += size;
        state.queue.push_back(entry);
        self.condvar.notify_all();
    }

    pub fn ask(&self, ask: impl FnOnce(&mut Requests)) {
        ask(&mut self.state().questions);
        self.condvar.notify_all();
    }

    /// Takes the open requests.
    pub fn questions(&self) -> Requests {
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
            problem: report.trouble,
            waiting: state.queue.len() + state.in_progress,
            dropped: state.dropped,
            bytes: report.bytes,
            unsent: 0,
            set_aside: state.set_aside.clone(),
        }
    }

    /// Waits for work, but at most until `until`. With `is_resting`, new work does not end the wait. Returns
    /// `false` when the thread must end.
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
            let waited = self.condvar.wait_timeout(state, until - now);
            state = waited.unwrap_or_else(PoisonError::into_inner).0;
        }
    }

    /// Takes the next batch of entries. They count as waiting until [`SharedState::finish_batch`] is called.
    pub fn take_batch(&self) -> Vec<Entry> {
        let mut state = self.state();
        let count = state.queue.len().min(BATCH);
        let batch: Vec<Entry> = state.queue.drain(..count).collect();
        state.bytes -= batch.iter().map(memory_size).sum::<usize>();
        state.in_progress = count;
        batch
    }

    /// Ends a batch, of which all entries except `dropped` were written.
    pub fn finish_batch(&self, dropped: u64) {
        let mut state = self.state();
        state.in_progress = 0;
        state.dropped += dropped;
    }

    pub fn report(&self, report: Report) {
        self.state().report = report;
    }

    pub fn report_set_aside(&self, set_aside: SetAside) {
        self.state().set_aside = Some(set_aside);
    }

    /// Returns the deadline for writing the remaining entries, if the thread is to end.
    pub fn finish_by(&self) -> Option<Instant> {
        self.state().finish_by
    }

    /// Ends recording: later entries are dropped.
    pub fn close(&self, trouble: String) {
        let mut state = self.state();
        state.is_closed = true;
        if !trouble.is_empty() {
            state.report.trouble = Some(trouble);
        }
        self.condvar.notify_all();
    }

    /// Waits until the thread has written all entries and ended, but at most until `by`.
    pub fn finish(&self, by: Instant) {
        let mut state = self.state();
        let by = *state.finish_by.get_or_insert(by);
        self.condvar.notify_all();
        while !state.is_closed && Instant::now() < by {
            let waited = self.condvar.wait_timeout(state, by - Instant::now());
            state = waited.unwrap_or_else(PoisonError::into_inner).0;
        }
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
