//! The thread that writes the logbook.

use super::shared::{Report, SharedState};
use crate::{Entry, Error, Event, Id, Kind, Logbook, Moment, Server};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Options of a recorder. The default keeps all rows, sets no size limit and uses no server.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Options {
    /// Age after which rows are deleted [days]; `None` keeps all rows.
    pub keep_days: Option<u32>,
    /// Maximum size of the file [bytes]. Beyond it, writing fails as on a full disk. `None` sets no limit.
    pub max_bytes: Option<u64>,
    /// Server to which the rows are sent.
    pub server: Option<Server>,
}

/// Delay before another attempt after an error.
const REST: Duration = Duration::from_secs(3);
/// Delay before another attempt after an error while the recorder ends.
const LAST_REST: Duration = Duration::from_millis(100);
/// Interval between two searches for old rows.
const SWEEP: Duration = Duration::from_secs(3600);
/// Maximum time span of the rows deleted after one search [days]. The limit reduces the loss if the clock is
/// years ahead.
const SWEPT_DAYS: i64 = 7;
/// Length of a day [ms].
const DAY: i64 = 86_400_000;

#[derive(Debug)]
pub struct Writer {
    desk: Arc<SharedState>,
    path: PathBuf,
    stand: String,
    options: Options,
    book: Option<Logbook>,
    /// Entries being written.
    batch: Vec<Entry>,
    trouble: Option<Error>,
    refused: Option<Error>,
    sweep_at: Instant,
}

impl Writer {
    pub fn new(desk: Arc<SharedState>, path: &Path, stand: &str, options: Options) -> Self {
        Self {
            desk,
            path: path.into(),
            stand: stand.into(),
            options,
            book: None,
            batch: Vec::new(),
            trouble: None,
            refused: None,
            sweep_at: Instant::now(),
        }
    }

    pub fn run(mut self) {
        loop {
            self.attempt();
            let rest = if self.trouble.is_some() { REST } else { SWEEP };
            if !self
                .desk
                .wait(Instant::now() + rest, self.trouble.is_some())
            {
                break;
            }
        }
        self.end();
        self.desk.close(String::new());
    }

    /// Writes the remaining entries until the deadline.
    fn end(&mut self) {
        loop {
            self.attempt();
            let now = Instant::now();
            let by = self.desk.finish_by().unwrap_or(now);
            if self.desk.health().waiting == 0 || now >= by {
                return;
            }
            if self.trouble.is_some() {
                std::thread::sleep(LAST_REST.min(by - now));
            }
        }
    }

    /// Does all pending work, up to the first error.
    fn attempt(&mut self) {
        let result = self.work();
        if let Err(error) = &result {
            // Closes the file after an error of another kind. The next attempt opens and checks the file
            // again.
            if !matches!(error, Error::Locked(_) | Error::Full(_)) {
                self.book = None;
            }
            let is_new = !matches!(self.trouble, Some(Error::Full(_)));
            if matches!(error, Error::Full(_)) && is_new {
                self.note(Kind::FullDisk, error.to_string());
            }
        }
        self.trouble = result.err();
        self.desk.report(Report {
            is_recording: self.trouble.is_none(),
            trouble: self
                .trouble
                .as_ref()
                .or(self.refused.as_ref())
                .map(Error::to_string),
            bytes: self.book.as_ref().map_or(0, Logbook::bytes),
        });
    }

    fn work(&mut self) -> Result<(), Error> {
        self.open()?;
        // Old rows are deleted first, because that frees space. Entries are written even if the deletion
        // fails.
        let swept = self.delete_old();
        self.write()?;
        self.answer()?;
        swept
    }

    fn open(&mut self) -> Result<(), Error> {
        if self.book.is_some() {
            return Ok(());
        }
        let (book, set_aside) = Logbook::open(&self.path, &self.stand)?;
        if let Some(set_aside) = set_aside {
            let name = set_aside.path.display();
            self.note(Kind::DamagedFile, format!("{name}: {}", set_aside.reason));
            self.desk.report_set_aside(set_aside);
        }
        if let Some(most) = self.options.max_bytes {
            book.set_size_limit(most)?;
        }
        match self.options.server.as_ref().map(Server::name) {
            None => book.set_server(None)?,
            Some(Ok(name)) => book.set_server(Some(&name))?,
            // An address that cannot be parsed may belong to the previous server. Rows that the previous
            // server has not received are therefore kept.
            Some(Err(_)) => {}
        }
        self.book = Some(book);
        Ok(())
    }

    fn write(&mut self) -> Result<(), Error> {
        loop {
            if self.batch.is_empty() {
                self.batch = self.desk.take_batch();
            }
            let Some(book) = self.book.as_mut().filter(|_| !self.batch.is_empty()) else {
                return Ok(());
            };
            let mut dropped = 0;
            match book.write_all(&self.batch) {
                // SQLite rejected an entry, so none of the batch was written. Each entry is now written on
                // its own.
                Err(Error::Refused { .. }) => {
                    for entry in &self.batch {
                        match book.write(entry) {
                            Err(error @ Error::Refused { .. }) => {
                                dropped += 1;
                                self.refused = Some(error);
                            }
                            other => other?,
                        }
                    }
                }
                other => other?,
            }
            self.batch.clear();
            self.desk.finish_batch(dropped);
        }
    }

    fn answer(&mut self) -> Result<(), Error> {
        let Some(book) = &self.book else {
            return Ok(());
        };
        let asked = self.desk.questions();
        if let Some(since) = asked.today {
            let today = book.today(since)?;
            self.desk.answer(|answers| answers.today = Some(today));
        }
        if let Some(best) = asked.best {
            let rounds = book.best(best.since, &best.level, best.level_hash, best.most)?;
            self.desk.answer(|answers| answers.best = Some(rounds));
        }
        if let Some(path) = asked.export {
            let copied = book
                .export(&path)
                .map(|()| path)
                .map_err(|error| error.to_string());
            self.desk.answer(|answers| answers.export = Some(copied));
        }
        Ok(())
    }

    /// Deletes rows that are older than the limit, a few days of rows at a time.
    fn delete_old(&mut self) -> Result<(), Error> {
        let now = Instant::now();
        let (Some(book), Some(days)) = (&mut self.book, self.options.keep_days) else {
            return Ok(());
        };
        if now < self.sweep_at {
            return Ok(());
        }
        self.sweep_at = now + SWEEP;
        let Some(oldest) = book.oldest()? else {
            return Ok(());
        };
        let before = Moment::now().after(-DAY * i64::from(days));
        let most = oldest.saturating_add(SWEPT_DAYS * DAY);
        let utc_ms = before.utc_ms.min(most);
        book.delete_before(Moment { utc_ms, ..before })
    }

    /// Records an event about the logbook itself.
    fn note(&self, kind: Kind, text: String) {
        self.desk.put(Entry::Event(Event {
            id: Id::random(),
            stand: self.stand.clone(),
            at: Moment::now(),
            kind,
            text,
        }));
    }
}
