//! A thread that sends the rows of a logbook to a PostgreSQL server. Each row is sent at least once and
//! stored once.
//!
//! Rows are sent in the order of their changes, at most 200 in a transaction. The transaction also stores the
//! number of its last change: this is the server's position in the file. While the server cannot be reached,
//! the thread keeps trying. The server may be a new one, or it may have lost rows because it was restored
//! from a backup. In both cases the thread sends all rows after the server's position that are still in the
//! file.

mod tables;

use crate::logbook::{ChangedRow, SyncPosition};
use crate::server::Progress;
use crate::{Error, Logbook, Server};
use postgres::{Client, NoTls};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::Duration;
use tables::Inserts;

/// Handle of the sending thread. Dropping it ends the thread; the next sender sends the remaining rows.
#[derive(Debug)]
pub struct Sender {
    progress: Arc<Mutex<Progress>>,
    /// Dropping this channel ends the thread.
    _end: mpsc::Sender<()>,
}

/// Maximum number of rows in a transaction.
const BATCH: usize = 200;
/// Interval between two searches for new rows, and first delay after a failure.
const POLL_INTERVAL: Duration = Duration::from_secs(1);
/// Number of consecutive failures after which the retry delay stops doubling and stays at 32 s.
const MOST_DOUBLINGS: u32 = 6;
/// Time limit for an answer of the server.
const TIMEOUT: Duration = Duration::from_secs(20);

impl Sender {
    /// Starts sending the rows of the file at `path`, and those that are added to it later.
    pub fn begin(path: &Path, stand: &str, server: &Server) -> Self {
        let progress = Arc::new(Mutex::default());
        let (end, ended) = mpsc::channel();
        let errand = SenderThread {
            path: path.into(),
            stand: stand.into(),
            server: server.clone(),
            line: None,
        };
        let thread = thread::Builder::new().name("logbook to server".into());
        let told = Arc::clone(&progress);
        let run = move || errand.run(&ended, |now| set(&told, now));
        if let Err(error) = thread.spawn(run) {
            let trouble = format!("cannot start the thread that sends the logbook: {error}");
            set(
                &progress,
                Progress {
                    unsent: 0,
                    trouble: Some(trouble),
                },
            );
        }
        Self {
            progress,
            _end: end,
        }
    }

    /// Returns the current progress.
    pub fn progress(&self) -> Progress {
        let progress = self.progress.lock();
        progress.unwrap_or_else(PoisonError::into_inner).clone()
    }
}

fn set(progress: &Mutex<Progress>, now: Progress) {
    *progress.lock().unwrap_or_else(PoisonError::into_inner) = now;
}

struct SenderThread {
    path: PathBuf,
    stand: String,
    server: Server,
    line: Option<Line>,
}

/// Connection to the server, with the position up to which the server has received the file.
struct Line {
    client: Client,
    inserts: Inserts,
    sent: SyncPosition,
}

/// Reason why nothing was sent.
#[derive(Debug)]
enum SendError {
    /// The file cannot be used at present, or does not exist yet. The recorder reports this problem, so the
    /// sender does not.
    Book,
    Server(String),
}

impl SenderThread {
    fn run(mut self, ended: &mpsc::Receiver<()>, tell: impl Fn(Progress)) {
        let (mut failures, mut unsent) = (0, 0);
        loop {
            let step = self.step();
            // Opens the file again for each batch, because the recorder may have replaced a damaged file.
            unsent = Logbook::attach(&self.path)
                .and_then(|book| book.unsent())
                .unwrap_or(unsent);
            let (trouble, rest) = match step {
                Ok(0) | Err(SendError::Book) => (None, POLL_INTERVAL),
                Ok(_) => (None, Duration::ZERO),
                Err(SendError::Server(trouble)) => {
                    self.line = None;
                    failures = MOST_DOUBLINGS.min(failures + 1);
                    (Some(trouble), POLL_INTERVAL * 2_u32.pow(failures - 1))
                }
            };
            if trouble.is_none() {
                failures = 0;
            }
            tell(Progress { unsent, trouble });
            if ended.recv_timeout(rest) != Err(RecvTimeoutError::Timeout) {
                return;
            }
        }
    }

    /// Sends one batch and returns its number of rows.
    fn step(&mut self) -> Result<usize, SendError> {
        let name = self.server.name().map_err(SendError::Server)?;
        let book = Logbook::attach(&self.path)?;
        let known = book.sent()?;
        let line = match self.line.take() {
            Some(line) if line.sent.book == known.book => self.line.insert(line),
            _ => {
                let line = Line::open(&self.server, &self.stand, known)?;
                book.set_sent(&name, &line.sent)?;
                self.line.insert(line)
            }
        };
        let changes = book.changes(line.sent.change, BATCH)?;
        // Closes the file, so that it is not locked while this thread waits for the server.
        drop(book);
        let Some((last, ..)) = changes.last() else {
            return Ok(0);
        };
        let sent = SyncPosition {
            change: *last,
            ..line.sent
        };
        line.send(&self.stand, &changes, &sent)?;
        line.sent = sent;
        Logbook::attach(&self.path)?.set_sent(&name, &line.sent)?;
        Ok(changes.len())
    }
}

impl Line {
    fn open(server: &Server, stand: &str, known: SyncPosition) -> Result<Self, SendError> {
        let mut config = server.config().map_err(SendError::Server)?;
        config.application_name("tamaire");
        config.connect_timeout(TIMEOUT);
        config.tcp_user_timeout(TIMEOUT);
        let mut client = config.connect(NoTls)?;
        let patience = TIMEOUT.as_millis();
        client.batch_execute(&format!("SET statement_timeout = {patience}"))?;
        let inserts = tables::begin(&mut client).map_err(SendError::Server)?;
        let got = inserts.sent(&mut client, &known.book.to_string(), stand)?;
        let sent = SyncPosition {
            change: known.change.min(got),
            ..known
        };
        Ok(Self {
            client,
            inserts,
            sent,
        })
    }

    /// Sends changes in one transaction.
    fn send(
        &mut self,
        stand: &str,
        changes: &[(i64, i64, ChangedRow)],
        sent: &SyncPosition,
    ) -> Result<(), SendError> {
        let book = sent.book.to_string();
        let mut transaction = self.client.transaction()?;
        for (_, seq, change) in changes {
            self.inserts.put(&mut transaction, &book, *seq, change)?;
        }
        self.inserts
            .put_sent(&mut transaction, &book, stand, sent.change)?;
        Ok(transaction.commit()?)
    }
}

impl From<Error> for SendError {
    fn from(_: Error) -> Self {
        Self::Book
    }
}

impl From<postgres::Error> for SendError {
    fn from(error: postgres::Error) -> Self {
        Self::Server(tables::told(&error))
    }
}
