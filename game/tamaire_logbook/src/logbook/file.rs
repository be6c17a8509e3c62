//! Opening and checking the file, and setting a damaged one aside.

use super::read;
use super::schema::{self, APPLICATION_ID, VERSION};
use crate::{Error, Id, Moment};
use rusqlite::config::DbConfig;
use rusqlite::{Connection, ErrorCode, OpenFlags};
use std::ffi::OsString;
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};
use tempfile::TempDir;

/// A damaged file that was renamed, together with SQLite's files beside it.
#[derive(Clone, Debug, PartialEq)]
pub struct SetAside {
    /// Path after the renaming.
    pub path: PathBuf,
    /// Description of the damage.
    pub reason: String,
}

/// Time for which SQLite waits for another program's lock.
const BUSY_TIMEOUT: Duration = Duration::from_secs(2);
/// Maximum number of copies made for reading, if a program writes the file during each.
const MAX_COPIES: usize = 5;
/// Suffixes of the files that SQLite creates beside a database.
const SIDECAR_SUFFIXES: [&str; 3] = ["-wal", "-shm", "-journal"];
/// A version number that is larger than [`VERSION`] by this amount or more counts as damage, not as a newer
/// version.
const MAX_VERSIONS_AHEAD: i64 = 1000;

/// Opens a file for writing, and creates it if it does not exist.
///
/// # Errors
/// [`Error::Damaged`] if the file is damaged or no logbook. The file is left unchanged.
pub fn open(path: &Path) -> Result<Connection, Error> {
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder).map_err(|error| unusable(path, &error))?;
    }
    // Looks for the write-ahead log before the database file. A program that creates a logbook creates the
    // file before its log, so a log without a file is always damage.
    let has_log = size(&sidecar_path(path, SIDECAR_SUFFIXES[0])) > 0;
    let is_there = path.try_exists().map_err(|error| unusable(path, &error))?;
    if !is_there && has_log {
        return Err(damaged(
            path,
            "the file is missing, and only its -wal file is left",
        ));
    }
    if !is_there {
        create(path)?;
    } else if size(path) == 0 {
        return Err(damaged(path, "the file is empty"));
    }
    let mut connection = connect(path, OpenFlags::SQLITE_OPEN_READ_WRITE)?;
    check(path, &connection)?;
    if connection
        .is_readonly("main")
        .map_err(|error| map_error(path, error))?
    {
        let opened = File::options().write(true).open(path);
        opened.map_err(|error| unusable(path, &error))?;
        return Err(damaged(path, "its header marks it as read-only"));
    }
    begin(&mut connection).map_err(|error| map_error(path, error))?;
    Ok(connection)
}

/// Opens a file for writing without the slow check of its content, which [`open`] has done already.
#[cfg(feature = "postgres")]
pub fn attach(path: &Path) -> Result<Connection, Error> {
    let mut connection = connect(path, OpenFlags::SQLITE_OPEN_READ_WRITE)?;
    check_kind(path, &connection)?;
    begin(&mut connection).map_err(|error| map_error(path, error))?;
    Ok(connection)
}

/// Opens a file for reading, so that no file is created beside it and none is changed. The folder returned, if
/// any, holds the copy that the connection reads, and must exist as long as the connection.
pub fn read(path: &Path) -> Result<(Connection, Option<TempDir>), Error> {
    let found = fs::metadata(path).map_err(|error| unusable(path, &error))?;
    if !found.is_file() {
        let reason = "expected a file, found a folder, a pipe or a device";
        return Err(unusable(path, &io::Error::other(reason)));
    }
    if found.len() == 0 {
        return Err(damaged(path, "the file is empty"));
    }
    let (connection, copy) = connect_for_reading(path)?;
    check(path, &connection).map_err(|error| match error {
        Error::Unusable { path, reason } => {
            let reason =
                format!("{reason}; copy the file and those beside it to a writable folder");
            Error::Unusable { path, reason }
        }
        other => other,
    })?;
    match schema::version(&connection).map_err(|error| map_error(path, error))? {
        VERSION => Ok((connection, copy)),
        _ => Err(damaged(
            path,
            "the logbook has an older version; open it in the game once to update it",
        )),
    }
}

/// Opens the file itself while a program has it open. Otherwise copies the file and its write-ahead log to a
/// temporary folder and opens the copy: SQLite would create files beside the original, and a program may begin
/// to write at any time.
fn connect_for_reading(path: &Path) -> Result<(Connection, Option<TempDir>), Error> {
    let state = || State::of(path).map_err(|error| unusable(path, &error));
    for _ in 0..MAX_COPIES {
        let before = state()?;
        if before.is_open() {
            let connection = connect(path, OpenFlags::SQLITE_OPEN_READ_ONLY)?;
            return Ok((connection, None));
        }
        let (folder, copy) = copied(path).map_err(|error| Error::Unusable {
            path: path.into(),
            reason: format!("no copy could be made in the temporary folder: {error}"),
        })?;
        if state()? == before {
            let connection = connect(&copy, OpenFlags::SQLITE_OPEN_READ_ONLY)?;
            return Ok((connection, Some(folder)));
        }
    }
    Err(Error::Locked(path.into()))
}

/// Copies a file and its write-ahead log, if any, to a temporary folder. Returns the folder and the path of the
/// copy.
fn copied(path: &Path) -> io::Result<(TempDir, PathBuf)> {
    // Without the permissions of the original, so that SQLite can write its log beside the copy.
    let copy_bytes = |from: &Path, to: &Path| {
        let mut from = File::open(from)?;
        io::copy(&mut from, &mut File::create(to)?)
    };
    let folder = tempfile::tempdir()?;
    let copy = folder.path().join("copy.sqlite");
    copy_bytes(path, &copy)?;
    let log = SIDECAR_SUFFIXES[0];
    match copy_bytes(&sidecar_path(path, log), &sidecar_path(&copy, log)) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => Err(error),
        _ => Ok((folder, copy)),
    }
}

/// State of a file and of SQLite's files beside it. Two equal states mean that no program wrote in between.
#[derive(PartialEq)]
struct State {
    file: Stamp,
    log: Option<Stamp>,
    has_memory: bool,
}

/// Length [bytes] and modification time of a file.
type Stamp = (u64, Option<SystemTime>);

impl State {
    fn of(path: &Path) -> io::Result<Self> {
        let stamp = |path: &Path| {
            let found = fs::metadata(path)?;
            Ok::<Stamp, io::Error>((found.len(), found.modified().ok()))
        };
        let [log, memory] =
            [SIDECAR_SUFFIXES[0], SIDECAR_SUFFIXES[1]].map(|suffix| sidecar_path(path, suffix));
        Ok(Self {
            file: stamp(path)?,
            log: stamp(&log).ok(),
            has_memory: memory.exists(),
        })
    }

    /// Returns whether a program has the file open, or was killed while it had. A `-shm` file alone is left
    /// over: SQLite creates it after the log and removes it before the log.
    fn is_open(&self) -> bool {
        self.has_memory && self.log.is_some()
    }
}

/// Renames a damaged file, and SQLite's files beside it, to a name with the date.
pub fn set_aside(path: &Path, reason: String) -> Result<SetAside, Error> {
    let aside = name_aside(path, Moment::now());
    let rename = |from: &Path, to: &Path| match fs::rename(from, to) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => Err(unusable(from, &error)),
        _ => Ok(()),
    };
    // The database is renamed first. If only its `-wal` file is left behind, the next start finds and renames
    // that file and never uses it for a new database.
    rename(path, &aside)?;
    for ending in SIDECAR_SUFFIXES {
        rename(&sidecar_path(path, ending), &sidecar_path(&aside, ending))?;
    }
    Ok(SetAside {
        path: aside,
        reason,
    })
}

/// Returns the size on the disk of the file and of SQLite's files beside it [bytes].
pub fn bytes(path: &Path) -> u64 {
    let others = SIDECAR_SUFFIXES.map(|ending| size(&sidecar_path(path, ending)));
    size(path) + others.iter().sum::<u64>()
}

/// Maps an error of SQLite to an [`Error`] about the file at `path`.
pub fn map_error(path: &Path, error: rusqlite::Error) -> Error {
    use rusqlite::Error as Sql;
    let (path, reason) = (path.to_path_buf(), error.to_string());
    match (error.sqlite_error_code(), &error) {
        (Some(ErrorCode::DatabaseBusy | ErrorCode::DatabaseLocked), _)
        | (Some(ErrorCode::FileLockingProtocolFailed), _) => Error::Locked(path),
        (Some(ErrorCode::DiskFull), _) => Error::Full(path),
        (Some(ErrorCode::DatabaseCorrupt | ErrorCode::NotADatabase | ErrorCode::TooBig), _) => {
            Error::Damaged { path, reason }
        }
        (Some(ErrorCode::ConstraintViolation | ErrorCode::TypeMismatch), _) => {
            Error::Refused { path, reason }
        }
        (Some(ErrorCode::Unknown), Sql::SqliteFailure(_, Some(reason))) if lacks(reason) => {
            let reason = reason.clone();
            Error::Damaged { path, reason }
        }
        // Treats missing values and values of an unexpected type as damage.
        (_, Sql::QueryReturnedNoRows | Sql::Utf8Error(..))
        | (_, Sql::InvalidColumnType(..) | Sql::IntegralValueOutOfRange(..))
        | (_, Sql::FromSqlConversionFailure(..)) => Error::Damaged { path, reason },
        _ => Error::Unusable { path, reason },
    }
}

/// Returns whether a message of SQLite means that the file does not have the expected tables.
fn lacks(reason: &str) -> bool {
    let texts = [
        "no such table",
        "no such column",
        " columns but ",
        "unsupported file format",
    ];
    texts.iter().any(|text| reason.contains(text))
}

pub fn unusable(path: &Path, error: &io::Error) -> Error {
    let (path, reason) = (path.into(), error.to_string());
    Error::Unusable { path, reason }
}

fn damaged(path: &Path, reason: &str) -> Error {
    let (path, reason) = (path.into(), reason.into());
    Error::Damaged { path, reason }
}

/// Creates a file under a temporary name and renames it when it is complete, so that no program opens an
/// incomplete file.
fn create(path: &Path) -> Result<(), Error> {
    let new = path.with_added_extension(format!("new-{}", Id::random()));
    let make = || {
        let mut connection = connect(
            &new,
            OpenFlags::SQLITE_OPEN_READ_WRITE | OpenFlags::SQLITE_OPEN_CREATE,
        )?;
        // Sets the journal mode before other programs see the file. If several connections tried to set it at
        // once, the first writer might wait in vain.
        begin(&mut connection).map_err(|error| map_error(path, error))?;
        drop(connection);
        match fs::hard_link(&new, path) {
            // Uses the file that another program has created meanwhile.
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => Ok(()),
            // Renames the new file instead if the file system does not support hard links.
            Err(_) => fs::rename(&new, path).map_err(|error| unusable(path, &error)),
            Ok(()) => Ok(()),
        }
    };
    let made = make();
    let _ = fs::remove_file(&new);
    made
}

fn connect(path: &Path, flags: OpenFlags) -> Result<Connection, Error> {
    let open = || {
        let flags = flags | OpenFlags::SQLITE_OPEN_NO_MUTEX;
        let connection = Connection::open_with_flags(path, flags)?;
        connection.busy_timeout(BUSY_TIMEOUT)?;
        // Triggers and functions stored in the file are turned off. Closing does not copy the log into the
        // database, so that an unusable file stays unchanged.
        connection.set_db_config(DbConfig::SQLITE_DBCONFIG_TRUSTED_SCHEMA, false)?;
        connection.set_db_config(DbConfig::SQLITE_DBCONFIG_ENABLE_TRIGGER, false)?;
        connection.set_db_config(DbConfig::SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, true)?;
        Ok(connection)
    };
    open().map_err(|error| map_error(path, error))
}

/// Checks that the file is an undamaged logbook of a supported version. Reads the whole file.
fn check(path: &Path, connection: &Connection) -> Result<(), Error> {
    check_kind(path, connection)?;
    let page = connection.pragma_query_value(None, "page_size", |row| row.get(0));
    let page: u64 = page.map_err(|error| map_error(path, error))?;
    // Without a write-ahead log, the size of an undamaged file is a multiple of the page size. With a log,
    // the last pages may be in the log only.
    let has_log = size(&sidecar_path(path, SIDECAR_SUFFIXES[0])) > 0;
    if !has_log && !size(path).is_multiple_of(page) {
        return Err(damaged(path, "the end of the file is missing"));
    }
    let check = "PRAGMA quick_check(1)";
    let found: rusqlite::Result<String> = connection.query_row(check, [], |row| row.get(0));
    match found.map_err(|error| map_error(path, error))?.as_str() {
        "ok" => check_tables(connection).map_err(|error| map_error(path, error)),
        reason => Err(damaged(path, reason.lines().last().unwrap_or(reason))),
    }
}

fn check_kind(path: &Path, connection: &Connection) -> Result<(), Error> {
    let ask = || {
        Ok((
            schema::application(connection)?,
            schema::version(connection)?,
        ))
    };
    match ask().map_err(|error| map_error(path, error))? {
        (APPLICATION_ID, 1..=VERSION) => Ok(()),
        (APPLICATION_ID, found) if (VERSION..VERSION + MAX_VERSIONS_AHEAD).contains(&found) => {
            let (path, known) = (path.into(), VERSION);
            Err(Error::Newer { path, found, known })
        }
        (APPLICATION_ID, _) => Err(damaged(path, "its version number is invalid")),
        _ => Err(damaged(path, "the database belongs to another program")),
    }
}

/// Checks that all columns that this version reads and writes exist.
fn check_tables(connection: &Connection) -> rusqlite::Result<()> {
    if schema::version(connection)? < VERSION {
        return Ok(());
    }
    for sql in [
        read::VISITS.in_range(),
        read::ROUNDS.in_range(),
        read::EVENTS.in_range(),
    ] {
        connection.prepare(&sql)?;
    }
    let book = "SELECT id, stand, changes, server, sent FROM book";
    connection.query_row(book, [], |row| row.get::<_, [u8; 16]>(0))?;
    Ok(())
}

/// Prepares a checked file for writing. With `synchronous = FULL` the log is flushed at every commit, so
/// committed rows survive a power cut.
fn begin(connection: &mut Connection) -> rusqlite::Result<()> {
    const MOST_LOG: i64 = 1 << 24;
    connection.pragma_update_and_check(None, "journal_mode", "wal", |_| Ok(()))?;
    connection.pragma_update(None, "synchronous", "full")?;
    connection.pragma_update(None, "foreign_keys", true)?;
    connection.pragma_update_and_check(None, "journal_size_limit", MOST_LOG, |_| Ok(()))?;
    schema::migrate(connection)?;
    connection.set_db_config(DbConfig::SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, false)?;
    Ok(())
}

fn sidecar_path(path: &Path, ending: &str) -> PathBuf {
    let mut name = OsString::from(path);
    name.push(ending);
    name.into()
}

fn size(path: &Path) -> u64 {
    fs::metadata(path).map_or(0, |found| found.len())
}

/// Returns a free name such as `logbook.damaged-2026-11-23-101502.sqlite`; a counter follows the date if that
/// name is taken.
fn name_aside(path: &Path, now: Moment) -> PathBuf {
    let part = |part: Option<&std::ffi::OsStr>| {
        part.map_or_else(String::new, |part| part.to_string_lossy().into_owned())
    };
    let stem = part(path.file_stem());
    let ending = path
        .extension()
        .map_or_else(String::new, |ending| format!(".{}", part(Some(ending))));
    let date = now.file_stem();
    let names = (1..).map(|count| match count {
        1 => format!("{stem}.damaged-{date}{ending}"),
        _ => format!("{stem}.damaged-{date}-{count}{ending}"),
    });
    let mut paths = names.map(|name| path.with_file_name(name));
    let is_free =
        |path: &PathBuf| !path.exists() && !sidecar_path(path, SIDECAR_SUFFIXES[0]).exists();
    paths.find(is_free).expect("the counter is unbounded")
}
