//! The logbook file, accessed through one connection.

mod file;
mod read;
mod schema;
mod sent;
mod write;

pub use file::SetAside;
#[cfg(feature = "postgres")]
pub(crate) use sent::{ChangedRow, SyncPosition};

use crate::{Entry, Error, Event, Moment, Round, Today, Visit};
use read::TableReader;
use rusqlite::{Connection, OptionalExtension};
use std::fs::{self, File};
use std::ops::RangeBounds;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// SQLite file with the visits, rounds and events of a stand.
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
    /// Folder of the copy that is read. It must be dropped after the connection, so it stands behind it.
    _copy: Option<TempDir>,
}

impl Logbook {
    /// Opens the logbook of a stand for writing. Creates the file and its folder if they do not exist.
    ///
    /// A file that is damaged or no logbook is renamed with the date in its name, and a new logbook is
    /// created; the second value returned describes the renamed file. The check reads the whole file, about
    /// one second per gigabyte.
    ///
    /// # Errors
    /// [`Error::Newer`] if a later version of the program wrote the file, which is left unchanged. After
    /// [`Error::Locked`], [`Error::Full`] or [`Error::Unusable`] the caller may try again.
    pub fn open(path: &Path, stand: &str) -> Result<(Self, Option<SetAside>), Error> {
        let opened = file::open(path);
        let (connection, set_aside) = match opened {
            Err(Error::Damaged { reason, .. }) => {
                let set_aside = file::set_aside(path, reason)?;
                (file::open(path)?, Some(set_aside))
            }
            other => (other?, None),
        };
        let book = Self::from_connection(path, connection);
        let sql = "UPDATE book SET stand = ?1 WHERE stand <> ?1";
        book.map_error(book.connection.execute(sql, [stand]))?;
        Ok((book, set_aside))
    }

    /// Opens a logbook for reading: the file that a stand is writing, or a copy of it together with its
    /// `-wal` file. Nothing is written beside the file, which may be on a read-only medium.
    ///
    /// If no program has the file open, a temporary copy is read; rows written later are not in it. The copy
    /// is deleted when the logbook is dropped.
    ///
    /// # Errors
    /// [`Error::Newer`], [`Error::Damaged`] and [`Error::Unusable`]; [`Error::Locked`] if a program wrote the file
    /// whenever it was copied. The file is neither changed nor renamed.
    pub fn read(path: &Path) -> Result<Self, Error> {
        let (connection, copy) = file::read(path)?;
        let mut book = Self::from_connection(path, connection);
        book._copy = copy;
        Ok(book)
    }

    /// Writes an entry. Writing the same entry again has no effect.
    ///
    /// When this function returns, the entry is on the disk: it survives a killed process and a power cut. An
    /// entry for a round or for the end of a visit creates the visit if the logbook does not contain it.
    ///
    /// # Errors
    /// [`Error`]; then nothing of the entry is written.
    pub fn write(&mut self, entry: &Entry) -> Result<(), Error> {
        self.write_all(std::slice::from_ref(entry))
    }

    /// Writes all entries in one transaction.
    ///
    /// # Errors
    /// [`Error`]; then none of the entries is written.
    pub fn write_all(&mut self, entries: &[Entry]) -> Result<(), Error> {
        let written = write::write(&mut self.connection, entries);
        self.map_error(written)
    }

    /// Calls `each` for every visit that began in `range`, in the order in which they were written.
    ///
    /// # Errors
    /// [`Error`], or the first error of `each`, which stops the iteration.
    pub fn visits<E: From<Error>>(
        &self,
        range: impl RangeBounds<Moment>,
        each: impl FnMut(Visit) -> Result<(), E>,
    ) -> Result<(), E> {
        self.stream(&read::VISITS, range, each)
    }

    /// Calls `each` for every round that began in `range`, in the order in which they were written.
    ///
    /// # Errors
    /// [`Error`], or the first error of `each`, which stops the iteration.
    pub fn rounds<E: From<Error>>(
        &self,
        range: impl RangeBounds<Moment>,
        each: impl FnMut(Round) -> Result<(), E>,
    ) -> Result<(), E> {
        self.stream(&read::ROUNDS, range, each)
    }

    /// Calls `each` for every event in `range`, in the order in which they were written.
    ///
    /// # Errors
    /// [`Error`], or the first error of `each`, which stops the iteration.
    pub fn events<E: From<Error>>(
        &self,
        range: impl RangeBounds<Moment>,
        each: impl FnMut(Event) -> Result<(), E>,
    ) -> Result<(), E> {
        self.stream(&read::EVENTS, range, each)
    }

    /// Returns the summary of everything that began at `since` or later.
    ///
    /// # Errors
    /// [`Error`].
    pub fn today(&self, since: Moment) -> Result<Today, Error> {
        self.map_error(read::today(&self.connection, since.utc_ms))
    }

    /// Returns the `most` fastest won rounds of a level that began at `since` or later and have a replay,
    /// fastest first. With `level_hash`, only rounds of exactly that version of the level.
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
        self.map_error(read::best(&self.connection, since, level, level_hash, most))
    }

    /// Deletes rows that began before `moment`, except rows that the server has not received yet and visits
    /// with remaining rounds.
    ///
    /// # Errors
    /// [`Error`].
    pub fn delete_before(&mut self, moment: Moment) -> Result<(), Error> {
        self.map_error(write::forget_before(&self.connection, moment.utc_ms))
    }

    /// Returns the size on the disk of the file and of SQLite's files beside it [bytes].
    pub fn bytes(&self) -> u64 {
        file::bytes(&self.path)
    }

    /// Writes a copy of the logbook to `path`, as a single file. Other connections may write meanwhile. An
    /// existing file at `path` is not overwritten.
    ///
    /// # Errors
    /// [`Error`]; [`Error::Unusable`] with the path of the copy if a file exists there.
    pub fn export(&self, path: &Path) -> Result<(), Error> {
        let failed = |error: std::io::Error| file::unusable(path, &error);
        if path.exists() {
            return Err(failed(std::io::ErrorKind::AlreadyExists.into()));
        }
        // The copy gets its final name only when all of it is on the disk.
        let part = path.with_added_extension("part");
        let _ = fs::remove_file(&part);
        let name = part.to_string_lossy();
        let copied = self.connection.execute("VACUUM INTO ?1", [&name]);
        let copied = copied
            .map_err(|error| file::map_error(path, error))
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

    /// Returns the name of the stand that opened the file for writing last.
    ///
    /// # Errors
    /// [`Error`].
    pub fn stand(&self) -> Result<String, Error> {
        let sql = "SELECT stand FROM book";
        self.map_error(self.connection.query_row(sql, [], |row| row.get(0)))
    }

    /// Limits the size of the file [bytes]. Writing beyond the limit returns [`Error::Full`].
    ///
    /// # Errors
    /// [`Error`].
    pub fn set_size_limit(&self, most_bytes: u64) -> Result<(), Error> {
        let limit = || {
            let page: i64 = self
                .connection
                .pragma_query_value(None, "page_size", |row| row.get(0))?;
            let pages = (most_bytes / page as u64).clamp(1, u32::MAX.into()) as i64;
            self.connection
                .pragma_update_and_check(None, "max_page_count", pages, |_| Ok(()))
        };
        self.map_error(limit())
    }

    /// Returns the earliest time in any row [ms of UTC]; `None` without rows.
    pub(crate) fn oldest(&self) -> Result<Option<i64>, Error> {
        let sql = "SELECT min(began) FROM (SELECT min(began) AS began FROM visits
            UNION ALL SELECT min(began) FROM rounds UNION ALL SELECT min(at) FROM events)";
        let found = self.connection.query_row(sql, [], |row| row.get(0));
        self.map_error(found.optional().map(Option::flatten))
    }

    /// Sets the server that must receive a row before [`Logbook::delete_before`] may delete it. With `None`,
    /// rows are deleted without waiting for a server.
    pub(crate) fn set_server(&self, server: Option<&str>) -> Result<(), Error> {
        self.map_error(sent::await_server(&self.connection, server))
    }

    fn from_connection(path: &Path, connection: Connection) -> Self {
        let path = path.into();
        Self {
            path,
            connection,
            _copy: None,
        }
    }

    fn map_error<T>(&self, result: rusqlite::Result<T>) -> Result<T, Error> {
        result.map_err(|error| file::map_error(&self.path, error))
    }

    fn stream<T, E: From<Error>>(
        &self,
        kept: &TableReader<T>,
        range: impl RangeBounds<Moment>,
        mut each: impl FnMut(T) -> Result<(), E>,
    ) -> Result<(), E> {
        let sql = kept.in_range();
        let mut statement = self.map_error(self.connection.prepare_cached(&sql))?;
        let mut rows = self.map_error(statement.query(read::ends(&range)))?;
        while let Some(row) = self.map_error(rows.next())? {
            each(self.map_error((kept.read)(row))?)?;
        }
        Ok(())
    }
}

/// Functions for the thread that sends rows to a server.
#[cfg(feature = "postgres")]
impl Logbook {
    /// Opens a logbook that the recorder has opened and checked already.
    pub(crate) fn attach(path: &Path) -> Result<Self, Error> {
        Ok(Self::from_connection(path, file::attach(path)?))
    }

    /// Returns the position up to which the server has received the file.
    pub(crate) fn sent(&self) -> Result<SyncPosition, Error> {
        self.map_error(sent::sent(&self.connection))
    }

    pub(crate) fn set_sent(&self, server: &str, sent: &SyncPosition) -> Result<(), Error> {
        self.map_error(sent::set_sent(&self.connection, server, sent))
    }

    /// Returns the number of rows that the server has not received yet.
    pub(crate) fn unsent(&self) -> Result<u64, Error> {
        self.map_error(sent::unsent(&self.connection))
    }

    /// Returns at most `most` rows that changed after change number `after`, in the order of their changes.
    /// Each item holds the change number, the row number and the row.
    pub(crate) fn changes(
        &self,
        after: i64,
        most: usize,
    ) -> Result<Vec<(i64, i64, ChangedRow)>, Error> {
        self.map_error(sent::changes(&self.connection, after, most))
    }
}
