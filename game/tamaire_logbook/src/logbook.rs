//! The file, over one connection.

mod file;
mod read;
mod schema;
mod sent;
mod write;

pub use file::SetAside;
#[cfg(feature = "postgres")]
pub(crate) use sent::{Change, Sent};

use crate::{Entry, Error, Event, Moment, Round, Today, Visit};
use read::Kept;
use rusqlite::{Connection, OptionalExtension};
use std::fs::{self, File};
use std::ops::RangeBounds;
use std::path::{Path, PathBuf};

/// A file of SQLite with what happened at a stand.
///
/// ```
/// use tamaire_logbook::{Entry, Error, Event, Id, Kind, Logbook, Moment};
///
/// let folder = tempfile::tempdir()?;
/// let (mut book, set_aside) = Logbook::open(&folder.path().join("logbook.sqlite"), "hall 2")?;
/// assert_eq!(set_aside, None);
/// let event = Event {
///     id: Id::random(),
///     stand: "hall 2".into(),
///     at: Moment::now(),
///     kind: Kind::Began,
///     text: String::new(),
/// };
/// book.write(&Entry::Event(event.clone()))?;
/// book.events(.., |found| {
///     assert_eq!(found, event);
///     Ok::<(), Error>(())
/// })?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Logbook {
    path: PathBuf,
    connection: Connection,
}

impl Logbook {
    /// Opens a stand's logbook to write it, and begins one, with its folder, where there is none. A file that is damaged or
    /// something else is set aside under a name with the date, and a new one begins: that is told beside it. All of it is
    /// read for that, a second for each gigabyte or so.
    ///
    /// # Errors
    /// [`Error::Newer`], with nothing changed; [`Error::Locked`], [`Error::Full`] and [`Error::Unusable`], after which
    /// it may be tried again.
    pub fn open(path: &Path, stand: &str) -> Result<(Self, Option<SetAside>), Error> {
        let opened = file::open(path);
        let (connection, set_aside) = match opened {
            Err(Error::Damaged { reason, .. }) => {
                let set_aside = file::set_aside(path, reason)?;
                (file::open(path)?, Some(set_aside))
            }
            other => (other?, None),
        };
        let book = Self::over(path, connection);
        let sql = "UPDATE book SET stand = ?1 WHERE stand <> ?1";
        book.told(book.connection.execute(sql, [stand]))?;
        Ok((book, set_aside))
    }

    /// Opens a logbook to read it: a stand's own while it writes, or a copy with what stood beside it (`-wal`).
    ///
    /// # Errors
    /// [`Error::Newer`], [`Error::Damaged`] and [`Error::Unusable`]. Nothing is changed or set aside.
    pub fn read(path: &Path) -> Result<Self, Error> {
        Ok(Self::over(path, file::read(path)?))
    }

    /// Writes an entry, once, however often it is told: what is written when this returns outlasts a program that is killed
    /// and a power cut. A round or an end of a visit that is not known yet brings it along.
    ///
    /// # Errors
    /// [`Error`]; then nothing of it is written.
    pub fn write(&mut self, entry: &Entry) -> Result<(), Error> {
        self.write_all(std::slice::from_ref(entry))
    }

    /// Writes all of these, or none.
    ///
    /// # Errors
    /// [`Error`]; then nothing of them is written.
    pub fn write_all(&mut self, entries: &[Entry]) -> Result<(), Error> {
        let written = write::write(&mut self.connection, entries);
        self.told(written)
    }

    /// Hands over the visits that began in a range, in the order in which they came, one at a time.
    ///
    /// # Errors
    /// [`Error`], and what the function returns, which ends it.
    pub fn visits<E: From<Error>>(
        &self,
        range: impl RangeBounds<Moment>,
        each: impl FnMut(Visit) -> Result<(), E>,
    ) -> Result<(), E> {
        self.stream(&read::VISITS, range, each)
    }

    /// Hands over the rounds that began in a range, in the order in which they came, one at a time.
    ///
    /// # Errors
    /// [`Error`], and what the function returns, which ends it.
    pub fn rounds<E: From<Error>>(
        &self,
        range: impl RangeBounds<Moment>,
        each: impl FnMut(Round) -> Result<(), E>,
    ) -> Result<(), E> {
        self.stream(&read::ROUNDS, range, each)
    }

    /// Hands over the events of a range, in the order in which they came, one at a time.
    ///
    /// # Errors
    /// [`Error`], and what the function returns, which ends it.
    pub fn events<E: From<Error>>(
        &self,
        range: impl RangeBounds<Moment>,
        each: impl FnMut(Event) -> Result<(), E>,
    ) -> Result<(), E> {
        self.stream(&read::EVENTS, range, each)
    }

    /// What happened since a moment.
    ///
    /// # Errors
    /// [`Error`].
    pub fn today(&self, since: Moment) -> Result<Today, Error> {
        self.told(read::today(&self.connection, since.utc_ms))
    }

    /// The fastest rounds of a level that were won since a moment and have a replay, the fastest first; where a hash is
    /// given, of that very level.
    ///
    /// # Errors
    /// [`Error`].
    pub fn best(
        &self,
        since: Moment,
        level: &str,
        level_hash: Option<u64>,
        most: usize,
    ) -> Result<Vec<Round>, Error> {
        let since = since.utc_ms;
        self.told(read::best(&self.connection, since, level, level_hash, most))
    }

    /// Forgets what began before a moment, but for what a server has not got yet.
    ///
    /// # Errors
    /// [`Error`].
    pub fn forget_before(&mut self, moment: Moment) -> Result<(), Error> {
        self.told(write::forget_before(&self.connection, moment.utc_ms))
    }

    /// How much room it takes on the disk, with what stands beside it [bytes].
    pub fn bytes(&self) -> u64 {
        file::bytes(&self.path)
    }

    /// Makes a copy that is a single file, while others may write. What is at that path already stays.
    ///
    /// # Errors
    /// [`Error`], of the copy's path too, where something is there already.
    pub fn export(&self, path: &Path) -> Result<(), Error> {
        let failed = |error: std::io::Error| file::unusable(path, &error);
        if path.exists() {
            return Err(failed(std::io::ErrorKind::AlreadyExists.into()));
        }
        // Under another name until all of it is on the disk.
        let part = path.with_added_extension("part");
        let _ = fs::remove_file(&part);
        let name = part.to_string_lossy();
        let copied = self.connection.execute("VACUUM INTO ?1", [&name]);
        let copied = copied
            .map_err(|error| file::told(path, error))
            .and_then(|_| {
                let synced = File::options()
                    .append(true)
                    .open(&part)
                    .and_then(|file| file.sync_all());
                synced
                    .and_then(|()| fs::rename(&part, path))
                    .map_err(failed)
            });
        if copied.is_err() {
            let _ = fs::remove_file(&part);
        }
        copied
    }

    /// The stand that wrote it last.
    ///
    /// # Errors
    /// [`Error`].
    pub fn stand(&self) -> Result<String, Error> {
        let sql = "SELECT stand FROM book";
        self.told(self.connection.query_row(sql, [], |row| row.get(0)))
    }

    /// Holds it to a size [bytes]: where more would be written, it is as with a full disk.
    ///
    /// # Errors
    /// [`Error`].
    pub fn limit(&self, most_bytes: u64) -> Result<(), Error> {
        let limit = || {
            let page: i64 = self
                .connection
                .pragma_query_value(None, "page_size", |row| row.get(0))?;
            let pages = (most_bytes / page as u64).clamp(1, u32::MAX.into()) as i64;
            self.connection
                .pragma_update_and_check(None, "max_page_count", pages, |_| Ok(()))
        };
        self.told(limit())
    }

    /// When the oldest row is from, by the clock.
    pub(crate) fn oldest(&self) -> Result<Option<i64>, Error> {
        let sql = "SELECT min(began) FROM (SELECT min(began) AS began FROM visits
            UNION ALL SELECT min(began) FROM rounds UNION ALL SELECT min(at) FROM events)";
        let found = self.connection.query_row(sql, [], |row| row.get(0));
        self.told(found.optional().map(Option::flatten))
    }

    /// Keeps from now on what this server has not got yet, however old it is; or nothing for any.
    pub(crate) fn await_server(&self, server: Option<&str>) -> Result<(), Error> {
        self.told(sent::await_server(&self.connection, server))
    }

    fn over(path: &Path, connection: Connection) -> Self {
        let path = path.into();
        Self { path, connection }
    }

    fn told<T>(&self, result: rusqlite::Result<T>) -> Result<T, Error> {
        result.map_err(|error| file::told(&self.path, error))
    }

    fn stream<T, E: From<Error>>(
        &self,
        kept: &Kept<T>,
        range: impl RangeBounds<Moment>,
        mut each: impl FnMut(T) -> Result<(), E>,
    ) -> Result<(), E> {
        let sql = kept.in_range();
        let mut statement = self.told(self.connection.prepare_cached(&sql))?;
        let mut rows = self.told(statement.query(read::ends(&range)))?;
        while let Some(row) = self.told(rows.next())? {
            each(self.told((kept.read)(row))?)?;
        }
        Ok(())
    }
}

/// For who sends it to a server.
#[cfg(feature = "postgres")]
impl Logbook {
    /// Opens one that is in use already.
    pub(crate) fn attach(path: &Path) -> Result<Self, Error> {
        Ok(Self::over(path, file::attach(path)?))
    }

    /// Up to where the server has got it.
    pub(crate) fn sent(&self) -> Result<Sent, Error> {
        self.told(sent::sent(&self.connection))
    }

    pub(crate) fn set_sent(&self, server: &str, sent: &Sent) -> Result<(), Error> {
        self.told(sent::set_sent(&self.connection, server, sent))
    }

    /// How many rows the server has not got yet.
    pub(crate) fn unsent(&self) -> Result<u64, Error> {
        self.told(sent::unsent(&self.connection))
    }

    /// What changed after a change, in the order in which it did: the number of the change, that of the row, the row.
    pub(crate) fn changes(
        &self,
        after: i64,
        most: usize,
    ) -> Result<Vec<(i64, i64, Change)>, Error> {
        self.told(sent::changes(&self.connection, after, most))
    }
}
