//! A thread that sends what is in a logbook to a PostgreSQL server, each row at least once and kept there once.
//!
//! Rows go in the order of their changes, some hundred in a transaction, and with them the number of the last change: the server
//! says itself up to where it has got a file. When it is away, it is tried again and again; when it comes back without what it had
//! got (another one, or one from a backup), all that is still in the file is sent again.

mod tables;

use crate::logbook::{Change, Sent};
use crate::server::Progress;
use crate::{Error, Logbook, Server};
use postgres::{Client, NoTls};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::Duration;
use tables::Inserts;

/// A thread that sends. It ends when this is dropped; what was not sent yet is sent by the next one.
#[derive(Debug)]
pub struct Sender {
    progress: Arc<Mutex<Progress>>,
    /// Hung up to end it.
    _end: mpsc::Sender<()>,
}

/// Most rows in a transaction.
const BATCH: usize = 200;
/// New rows are looked for so often.
const LOOK: Duration = Duration::from_secs(1);
/// After so much trouble in a row the rest between two attempts is not doubled any more: a minute.
const MOST_DOUBLINGS: u32 = 6;
/// Most that is waited for a server that says nothing.
const PATIENCE: Duration = Duration::from_secs(20);

impl Sender {
    /// Begins to send what is in this file, and what others write into it.
    pub fn begin(path: &Path, stand: &str, server: &Server) -> Self {
        let progress = Arc::new(Mutex::default());
        let (end, ended) = mpsc::channel();
        let errand = Errand {
            path: path.into(),
            stand: stand.into(),
            server: server.clone(),
            line: None,
        };
        let thread = thread::Builder::new().name("logbook to server".into());
        let told = Arc::clone(&progress);
        let run = move || errand.run(&ended, |now| set(&told, now));
        if let Err(error) = thread.spawn(run) {
            let trouble = format!("there is no thread to send the logbook: {error}");
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

    /// How it goes.
    pub fn progress(&self) -> Progress {
        let progress = self.progress.lock();
        progress.unwrap_or_else(PoisonError::into_inner).clone()
    }
}

fn set(progress: &Mutex<Progress>, now: Progress) {
    *progress.lock().unwrap_or_else(PoisonError::into_inner) = now;
}

struct Errand {
    path: PathBuf,
    stand: String,
    server: Server,
    line: Option<Line>,
}

/// A connection to the server, and up to where it has got the file.
struct Line {
    client: Client,
    inserts: Inserts,
    sent: Sent,
}

/// Why nothing was sent.
#[derive(Debug)]
enum Trouble {
    /// With the file, which others see to: it may not even be there yet.
    Book,
    Server(String),
}

impl Errand {
    fn run(mut self, ended: &mpsc::Receiver<()>, tell: impl Fn(Progress)) {
        let (mut failures, mut unsent) = (0, 0);
        loop {
            let step = self.step();
            // It is opened anew each time: a damaged one is set aside under others.
            unsent = Logbook::attach(&self.path)
                .and_then(|book| book.unsent())
                .unwrap_or(unsent);
            let (trouble, rest) = match step {
                Ok(0) | Err(Trouble::Book) => (None, LOOK),
                Ok(_) => (None, Duration::ZERO),
                Err(Trouble::Server(trouble)) => {
                    self.line = None;
                    failures = MOST_DOUBLINGS.min(failures + 1);
                    (Some(trouble), LOOK * 2_u32.pow(failures - 1))
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

    /// Sends a batch; how many rows it had.
    fn step(&mut self) -> Result<usize, Trouble> {
        let name = self.server.name().map_err(Trouble::Server)?;
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
        // Nobody waits for this file while a server does not answer.
        drop(book);
        let Some((last, ..)) = changes.last() else {
            return Ok(0);
        };
        let sent = Sent {
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
    fn open(server: &Server, stand: &str, known: Sent) -> Result<Self, Trouble> {
        let mut config = server.config().map_err(Trouble::Server)?;
        config.application_name("tamaire");
        config.connect_timeout(PATIENCE);
        config.tcp_user_timeout(PATIENCE);
        let mut client = config.connect(NoTls)?;
        let patience = PATIENCE.as_millis();
        client.batch_execute(&format!("SET statement_timeout = {patience}"))?;
        let inserts = tables::begin(&mut client).map_err(Trouble::Server)?;
        let got = inserts.sent(&mut client, &known.book.to_string(), stand)?;
        let sent = Sent {
            change: known.change.min(got),
            ..known
        };
        Ok(Self {
            client,
            inserts,
            sent,
        })
    }

    /// All of it, or nothing.
    fn send(
        &mut self,
        stand: &str,
        changes: &[(i64, i64, Change)],
        sent: &Sent,
    ) -> Result<(), Trouble> {
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

impl From<Error> for Trouble {
    fn from(_: Error) -> Self {
        Self::Book
    }
}

impl From<postgres::Error> for Trouble {
    fn from(error: postgres::Error) -> Self {
        Self::Server(tables::told(&error))
    }
}
