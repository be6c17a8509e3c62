//! A thread that writes a logbook while people play: whoever records never waits, whatever the disk does.

#[cfg(not(feature = "postgres"))]
mod absent;
mod desk;
mod writer;

pub use desk::Health;
pub use writer::Options;

use crate::{Entry, Moment, Round, Today};
use desk::{Best, Desk};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::thread;
use std::time::{Duration, Instant};
use writer::Writer;

#[cfg(feature = "postgres")]
use crate::sender::Sender;
#[cfg(not(feature = "postgres"))]
use absent::Sender;

/// A thread with a logbook. When it is dropped, what waits is written, as by [`Recorder::finish`].
#[derive(Debug)]
pub struct Recorder {
    desk: Arc<Desk>,
    sender: Option<Sender>,
}

/// For so long what waits is written when a recorder is dropped.
const LAST: Duration = Duration::from_secs(3);

impl Recorder {
    /// Begins to record for a stand, into this file. It is opened on the thread, which tries again when that fails.
    pub fn begin(path: &Path, stand: &str, options: Options) -> Self {
        let desk = Arc::new(Desk::default());
        let writer = Writer::new(Arc::clone(&desk), path, stand, options.clone());
        let thread = thread::Builder::new().name("logbook".into());
        if let Err(error) = thread.spawn(move || writer.run()) {
            desk.close(format!("there is no thread to write the logbook: {error}"));
        }
        let sender = options.server.as_ref();
        let sender = sender.map(|server| Sender::begin(path, stand, server));
        Self { desk, sender }
    }

    /// Has an entry written soon. Never waits.
    pub fn record(&self, entry: Entry) {
        self.desk.put(entry);
    }

    /// How it is now.
    pub fn health(&self) -> Health {
        let mut health = self.desk.health();
        if let Some(sender) = &self.sender {
            let progress = sender.progress();
            health.unsent = progress.unsent;
            health.trouble = health.trouble.or(progress.trouble);
        }
        health
    }

    /// Asks what happened since a moment; [`Recorder::today`] has it a little later.
    pub fn ask_today(&self, since: Moment) {
        self.desk.ask(|questions| questions.today = Some(since));
    }

    /// The last answer to [`Recorder::ask_today`].
    pub fn today(&self) -> Option<Today> {
        self.desk.answer(|answers| answers.today.clone())
    }

    /// Asks for the best rounds, as [`crate::Logbook::best`]; [`Recorder::best`] has them a little later.
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

    /// The last answer to [`Recorder::ask_best`].
    pub fn best(&self) -> Option<Vec<Round>> {
        self.desk.answer(|answers| answers.best.clone())
    }

    /// Asks for a copy, as [`crate::Logbook::export`]; [`Recorder::exported`] tells how it went a little later.
    pub fn ask_export(&self, path: PathBuf) {
        self.desk.ask(|questions| questions.export = Some(path));
    }

    /// How the last [`Recorder::ask_export`] went, once: the copy, or why there is none.
    pub fn exported(&self) -> Option<Result<PathBuf, String>> {
        self.desk.answer(|answers| answers.export.take())
    }

    /// Writes what waits, for no longer than this. How it is then: what waits still is lost.
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
