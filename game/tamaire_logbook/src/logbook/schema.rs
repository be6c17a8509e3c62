//! Tables of the file and their migrations.

use rusqlite::{Connection, Transaction, TransactionBehavior};

/// SQLite application id of logbook files: the letters `tmlb`.
pub const APPLICATION_ID: i64 = 0x746d_6c62;

/// The newest version of the tables.
pub const VERSION: i64 = MIGRATIONS.len() as i64;

/// Statements that migrate the tables from each version to the next. Released statements must not be changed.
const MIGRATIONS: &[&str] = &[TABLES];

/// Tables of version 1.
///
/// Moments are milliseconds of UTC and an offset in seconds; ids are 16 bytes. One counter numbers the rows
/// of all tables and the changes of visits. `seq` is the number of a row and gives the order of writing.
/// `change` is the number of a visit's last change; the server has received all changes up to `book.sent`.
/// Replays have their own table, so that a scan of the rounds does not read them.
const TABLES: &str = "
CREATE TABLE book (
    one INTEGER PRIMARY KEY CHECK (one = 1),
    id BLOB NOT NULL CHECK (length(id) = 16),
    stand TEXT NOT NULL,
    changes INTEGER NOT NULL,
    server TEXT,
    sent INTEGER NOT NULL
) STRICT;
INSERT INTO book VALUES (1, randomblob(16), '', 0, NULL, 0);

CREATE TABLE visits (
    seq INTEGER PRIMARY KEY,
    change INTEGER NOT NULL UNIQUE,
    id BLOB NOT NULL UNIQUE CHECK (length(id) = 16),
    stand TEXT NOT NULL,
    began INTEGER NOT NULL,
    began_offset INTEGER NOT NULL,
    ended INTEGER,
    ended_offset INTEGER,
    language TEXT NOT NULL
) STRICT;
CREATE INDEX visits_by_time ON visits (began);

CREATE TABLE rounds (
    seq INTEGER PRIMARY KEY,
    id BLOB NOT NULL UNIQUE CHECK (length(id) = 16),
    visit BLOB NOT NULL REFERENCES visits (id),
    stand TEXT NOT NULL,
    number INTEGER NOT NULL,
    began INTEGER NOT NULL,
    began_offset INTEGER NOT NULL,
    seconds REAL NOT NULL,
    level TEXT NOT NULL,
    level_hash INTEGER NOT NULL,
    players INTEGER NOT NULL,
    ending TEXT NOT NULL CHECK (ending IN ('won', 'retried', 'left', 'cut')),
    route TEXT CHECK (route IN ('squeeze', 'shave', 'mix')),
    kept REAL NOT NULL,
    inside REAL NOT NULL,
    pieces INTEGER NOT NULL,
    lost INTEGER NOT NULL,
    dare TEXT CHECK (dare IN ('squeeze', 'shave', 'mix'))
) STRICT;
CREATE INDEX rounds_by_time ON rounds (began);
CREATE INDEX rounds_by_visit ON rounds (visit);
CREATE INDEX rounds_by_speed ON rounds (level, seconds, began, level_hash) WHERE ending = 'won';

CREATE TABLE replays (
    seq INTEGER PRIMARY KEY REFERENCES rounds (seq) ON DELETE CASCADE,
    fragment TEXT NOT NULL
) STRICT;

CREATE TABLE events (
    seq INTEGER PRIMARY KEY,
    id BLOB NOT NULL UNIQUE CHECK (length(id) = 16),
    stand TEXT NOT NULL,
    at INTEGER NOT NULL,
    at_offset INTEGER NOT NULL,
    kind TEXT NOT NULL,
    text TEXT NOT NULL
) STRICT;
CREATE INDEX events_by_time ON events (at);
";

/// Migrates the tables from any version, or from an empty file, to the newest one in a single transaction.
pub fn migrate(connection: &mut Connection) -> rusqlite::Result<()> {
    migrate_by(connection, MIGRATIONS)
}

fn migrate_by(connection: &mut Connection, migrations: &[&str]) -> rusqlite::Result<()> {
    let newest = migrations.len() as i64;
    if version(connection)? >= newest {
        return Ok(());
    }
    let transaction = Transaction::new(connection, TransactionBehavior::Immediate)?;
    // Reads the version again, because another program may have migrated the file before this transaction
    // locked it.
    let from = version(&transaction)?.clamp(0, newest);
    for step in &migrations[from as usize..] {
        transaction.execute_batch(step)?;
    }
    transaction.pragma_update(None, "application_id", APPLICATION_ID)?;
    transaction.pragma_update(None, "user_version", newest)?;
    transaction.commit()
}

/// Returns the version of the tables; 0 if there are no tables.
pub fn version(connection: &Connection) -> rusqlite::Result<i64> {
    number(connection, "user_version")
}

/// Returns the application id of the file.
pub fn application(connection: &Connection) -> rusqlite::Result<i64> {
    number(connection, "application_id")
}

fn number(connection: &Connection, pragma: &str) -> rusqlite::Result<i64> {
    connection.pragma_query_value(None, pragma, |row| row.get(0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn migration_reaches_the_newest_version_or_changes_nothing() {
        let column = "ALTER TABLE events ADD COLUMN weather TEXT NOT NULL DEFAULT 'fair';";
        let text = |connection: &Connection| {
            let text = "SELECT text || weather FROM events";
            connection.query_row(text, [], |row| row.get::<_, String>(0))
        };
        let event = "INSERT INTO events VALUES (1, randomblob(16), 's', 0, 0, 'began', 'it is ')";
        let mut old = Connection::open_in_memory().unwrap();
        migrate_by(&mut old, &[TABLES]).unwrap();
        old.execute(event, []).unwrap();
        migrate_by(&mut old, &[TABLES, column]).unwrap();
        assert_eq!(text(&old).unwrap(), "it is fair");
        assert_eq!(version(&old).unwrap(), 2);
        migrate_by(&mut old, &[TABLES, column]).unwrap();

        let mut new = Connection::open_in_memory().unwrap();
        migrate_by(&mut new, &[TABLES, column]).unwrap();
        assert_eq!(
            (version(&new).unwrap(), application(&new).unwrap()),
            (2, APPLICATION_ID)
        );

        let broken = "CREATE TABLE more (one INTEGER); CREATE TABLE more (one INTEGER);";
        assert!(migrate_by(&mut old, &[TABLES, column, broken]).is_err());
        assert_eq!(
            version(&old).unwrap(),
            2,
            "a failed migration must change nothing"
        );
        assert!(old.prepare("SELECT * FROM more").is_err());
    }
}
