//! A thread that writes the logbook during play. Recording never blocks the caller, even if the disk is slow
//! or full.

#[cfg(not(feature = "postgres"))]
mod no_sender;
mod shared;
mod writer;

pub use shared::Health;
pub use writer::Options;

use crate::{Entry, Moment, Round, Today};
use shared::{Best, SharedState};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::thread;
use std::time::{Duration, Instant};
use writer::Writer;

#[cfg(feature = "postgres")]
use crate::sender::Sender;
#[cfg(not(feature = "postgres"))]
use no_sender::Sender;

/// Handle of the thread that writes a logbook. Dropping it blocks for at most 3 s to write the waiting
/// entries.
#[derive(Debug)]
pub struct Recorder {
    desk: Arc<SharedState>,
    sender: Option<Sender>,
}

/// Time limit for writing the waiting entries when a recorder is dropped.
const LAST: Duration = Duration::from_secs(3);

impl Recorder {
    /// Starts the thread that records for a stand into the file at `path`. If the thread cannot open the
    /// file, it tries again every 3 s.
    pub fn begin(path: &Path, stand: &str, options: Options) -> Self {
        let desk = Arc::new(SharedState::default());
        let writer = Writer::new(Arc::clone(&desk), path, stand, options.clone());
        let thread = thread::Builder::new().name("logbook".into());
        if let Err(error) = thread.spawn(move || writer.run()) {
            desk.close(format!(
                "cannot start the thread that writes the logbook: {error}"
            ));
        }
        let sender = options.server.as_ref();
        let sender = sender.map(|server| Sender::begin(path, stand, server));
        Self { desk, sender }
    }

    /// Queues an entry for writing. Never blocks on the disk.
    pub fn record(&self, entry: Entry) {
        self.desk.put(entry);
    }

    /// Returns the current state of the recorder.
    pub fn health(&self) -> Health {
        let mut health = self.desk.health();
        if let Some(sender) = &self.sender {
            let progress = sender.progress();
            health.unsent = progress.unsent;
            health.problem = health.problem.or(progress.trouble);
        }
        health
    }

    /// Requests a summary of the visits and rounds since a moment; [`Recorder::today`] returns it a little
    /// later.
    pub fn ask_today(&self, since: Moment) {
        self.desk.ask(|questions| questions.today = Some(since));
    }

    /// Returns the last answer to [`Recorder::ask_today`]; `None` before the first answer.
    pub fn today(&self) -> Option<Today> {
        self.desk.answer(|answers| answers.today.clone())
    }

    /// Requests the best rounds, as [`crate::Logbook::best`] does; [`Recorder::best`] returns them a little
    /// later.
    pub fn ask_best(&self, since: Moment, level: &str, level_hash: Option<u64>, most: usize) {
        let level = level.into();
        let best = Best {
            since,
            level,
            level_hash,
            most,
        };
        self.desk.ask(|questions| questions.best = Some(best));
    }

    /// Returns the last answer to [`Recorder::ask_best`]; `None` before the first answer.
    pub fn best(&self) -> Option<Vec<Round>> {
        self.desk.answer(|answers| answers.best.clone())
    }

    /// Requests a copy, as [`crate::Logbook::export`] does; [`Recorder::exported`] returns the result a
    /// little later.
    pub fn ask_export(&self, path: PathBuf) {
        self.desk.ask(|questions| questions.export = Some(path));
    }

    /// Takes the result of the last [`Recorder::ask_export`]: the path of the copy, or the reason why it
    /// failed.
    pub fn exported(&self) -> Option<Result<PathBuf, String>> {
        self.desk.answer(|answers| answers.export.take())
    }

    /// Writes the waiting entries for at most `within`, then stops. Returns the final state: entries still
    /// waiting then are lost.
    pub fn finish(self, within: Duration) -> Health {
        self.desk.finish(Instant::now() + within);
        self.health()
    }
}

impl Drop for Recorder {
    fn drop(&mut self) {
        self.desk.finish(Instant::now() + LAST);
    }
}
