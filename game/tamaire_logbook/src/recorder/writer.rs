//! The thread that writes.

use super::desk::{Desk, Report};
use crate::{Entry, Error, Event, Id, Kind, Logbook, Moment, Server};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// What a recorder is to do beside writing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Options {
    /// What is older is forgotten [days]; nothing is where there is no number.
    pub keep_days: Option<u32>,
    /// Most that the file may take [bytes]: past it, it is as with a full disk.
    pub most_bytes: Option<u64>,
    /// Where it is sent.
    pub server: Option<Server>,
}

/// After trouble it is tried again so much later.
const REST: Duration = Duration::from_secs(3);
/// The same when it is to end.
const LAST_REST: Duration = Duration::from_millis(100);
/// What is old is looked for so often.
const SWEEP: Duration = Duration::from_secs(3600);
/// Most days that are forgotten at once: a clock that is years ahead does not cost all of it.
const SWEPT_DAYS: i64 = 7;
/// [ms].
const DAY: i64 = 86_400_000;

#[derive(Debug)]
pub struct Writer {
    desk: Arc<Desk>,
    path: PathBuf,
    stand: String,
    options: Options,
    book: Option<Logbook>,
    /// What is being written.
    batch: Vec<Entry>,
    trouble: Option<Error>,
    refused: Option<Error>,
    sweep_at: Instant,
}

impl Writer {
    pub fn new(desk: Arc<Desk>, path: &Path, stand: &str, options: Options) -> Self {
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

    /// Writes what waits while there is time.
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

    /// Does all that is to be done, as far as it goes.
    fn attempt(&mut self) {
        let result = self.work();
        if let Err(error) = &result {
            // What is wrong with it is found as it is opened again.
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
        // First, so that there is room; but even where that fails there may be some.
        let swept = self.sweep();
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
        if let Some(most) = self.options.most_bytes {
            book.limit(most)?;
        }
        match self.options.server.as_ref().map(Server::name) {
            None => book.await_server(None)?,
            Some(Ok(name)) => book.await_server(Some(&name))?,
            // Whichever it was before may be meant.
            Some(Err(_)) => {}
        }
        self.book = Some(book);
        Ok(())
    }

    fn write(&mut self) -> Result<(), Error> {
        loop {
            if self.batch.is_empty() {
                self.batch = self.desk.take();
            }
            let Some(book) = self.book.as_mut().filter(|_| !self.batch.is_empty()) else {
                return Ok(());
            };
            let mut dropped = 0;
            match book.write_all(&self.batch) {
                // One of them is at fault: the others are written.
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
            self.desk.put_down(dropped);
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

    /// Forgets what is too old, some days of it at a time.
    fn sweep(&mut self) -> Result<(), Error> {
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
        book.forget_before(Moment { utc_ms, ..before })
    }

    /// Writes down what happened to the logbook itself.
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
