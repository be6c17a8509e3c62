//! Tables on the server, and writing rows into them.

use crate::logbook::ChangedRow;
use crate::row::route_text;
use postgres::types::ToSql;
use postgres::{Client, Statement, Transaction};
use std::error::Error as _;

/// Statements that migrate the tables from each version to the next. Released statements must not be changed.
const MIGRATIONS: &[&str] = &[TABLES];

/// Key of the advisory lock that lets only one stand create tables at a time. Any number not used by other
/// programs will do.
const LOCK: i64 = 0x746d_6c62;

/// Tables of version 1.
///
/// `to_timestamp(began_ms / 1000.0)` converts a time. `book` is the id of a stand's file, and `seq` orders
/// the rows of one book. Rounds have no foreign key to visits: a visit changes when it ends, and its rounds
/// may then be sent before it.
const TABLES: &str = "
CREATE SCHEMA IF NOT EXISTS tamaire;
CREATE TABLE tamaire.version (version INTEGER NOT NULL);
INSERT INTO tamaire.version VALUES (0);
CREATE TABLE tamaire.books (
    book TEXT NOT NULL,
    stand TEXT NOT NULL,
    sent BIGINT NOT NULL,
    PRIMARY KEY (book, stand)
);
CREATE TABLE tamaire.visits (
    id TEXT PRIMARY KEY,
    book TEXT NOT NULL,
    seq BIGINT NOT NULL,
    stand TEXT NOT NULL,
    began_ms BIGINT NOT NULL,
    began_offset_s INTEGER NOT NULL,
    ended_ms BIGINT,
    ended_offset_s INTEGER,
    language TEXT NOT NULL
);
CREATE INDEX ON tamaire.visits (began_ms);
CREATE TABLE tamaire.rounds (
    id TEXT PRIMARY KEY,
    book TEXT NOT NULL,
    seq BIGINT NOT NULL,
    visit TEXT NOT NULL,
    stand TEXT NOT NULL,
    number BIGINT NOT NULL,
    began_ms BIGINT NOT NULL,
    began_offset_s INTEGER NOT NULL,
    seconds REAL NOT NULL,
    level TEXT NOT NULL,
    level_hash TEXT NOT NULL,
    players SMALLINT NOT NULL,
    ending TEXT NOT NULL,
    route TEXT,
    kept REAL NOT NULL,
    inside REAL NOT NULL,
    pieces BIGINT NOT NULL,
    lost BIGINT NOT NULL,
    dare TEXT,
    replay TEXT NOT NULL
);
CREATE INDEX ON tamaire.rounds (began_ms);
CREATE INDEX ON tamaire.rounds (visit);
CREATE TABLE tamaire.events (
    id TEXT PRIMARY KEY,
    book TEXT NOT NULL,
    seq BIGINT NOT NULL,
    stand TEXT NOT NULL,
    at_ms BIGINT NOT NULL,
    at_offset_s INTEGER NOT NULL,
    kind TEXT NOT NULL,
    text TEXT NOT NULL
);
CREATE INDEX ON tamaire.events (at_ms);
";

/// Makes an array of references to values of several types.
macro_rules! refs {
    ($($value:expr),*) => { [$(&$value as &(dyn ToSql + Sync)),*] };
}

/// Prepared statements that insert or update rows.
pub struct Inserts {
    visit: Statement,
    round: Statement,
    event: Statement,
    sent: Statement,
}

/// Creates or migrates the tables, and checks that this program supports their version.
pub fn begin(client: &mut Client) -> Result<Inserts, String> {
    begin_by(client, MIGRATIONS)
}

fn begin_by(client: &mut Client, migrations: &[&str]) -> Result<Inserts, String> {
    let encoding: String = of(client.query_one("SHOW server_encoding", &[]))?.get(0);
    if encoding != "UTF8" {
        return Err(format!(
            "the server's database has the encoding {encoding}: expected UTF8"
        ));
    }
    let newest = migrations.len();
    let mut found = of(version(client))?;
    if found < newest {
        let mut transaction = of(client.transaction())?;
        of(transaction.execute("SELECT pg_advisory_xact_lock($1)", &[&LOCK]))?;
        found = of(version(&mut transaction))?;
        for step in migrations.iter().skip(found) {
            of(transaction.batch_execute(step))?;
        }
        found = found.max(newest);
        let sql = "UPDATE tamaire.version SET version = $1";
        of(transaction.execute(sql, &[&(found as i32)]))?;
        of(transaction.commit())?;
    }
    if found > newest {
        return Err(format!(
            "the server's tables have version {found}: this program supports up to version {newest}; install a newer tamaire"
        ));
    }
    let prepared = Inserts::prepare(client);
    of(prepared)
}

/// Returns the version of the tables; 0 if there are no tables.
fn version(client: &mut impl postgres::GenericClient) -> Result<usize, postgres::Error> {
    let sql = "SELECT to_regclass('tamaire.version') IS NOT NULL";
    let is_there: bool = client.query_one(sql, &[])?.get(0);
    if !is_there {
        return Ok(0);
    }
    let version: i32 = client
        .query_one("SELECT version FROM tamaire.version", &[])?
        .get(0);
    Ok(usize::try_from(version).unwrap_or(0))
}

impl Inserts {
    fn prepare(client: &mut Client) -> Result<Self, postgres::Error> {
        let visit = "book seq stand began_ms began_offset_s ended_ms ended_offset_s language";
        let round = "book seq visit stand number began_ms began_offset_s seconds level level_hash players ending route kept \
            inside pieces lost dare replay";
        let event = "book seq stand at_ms at_offset_s kind text";
        let mut prepare = |table: &str, columns: &str| client.prepare(&upsert(table, columns));
        Ok(Self {
            visit: prepare("visits", visit)?,
            round: prepare("rounds", round)?,
            event: prepare("events", event)?,
            sent: client.prepare(
                "INSERT INTO tamaire.books VALUES ($1, $2, $3)
                ON CONFLICT (book, stand) DO UPDATE SET sent = excluded.sent",
            )?,
        })
    }

    /// Returns the number of the last change that the server has received of a stand's file; 0 if it has
    /// received none.
    pub fn sent(
        &self,
        client: &mut Client,
        book: &str,
        stand: &str,
    ) -> Result<i64, postgres::Error> {
        let sql = "SELECT sent FROM tamaire.books WHERE book = $1 AND stand = $2";
        let row = client.query_opt(sql, &[&book, &stand])?;
        Ok(row.map_or(0, |row| row.get(0)))
    }

    pub fn put_sent(
        &self,
        transaction: &mut Transaction<'_>,
        book: &str,
        stand: &str,
        change: i64,
    ) -> Result<(), postgres::Error> {
        transaction.execute(&self.sent, &[&book, &stand, &change])?;
        Ok(())
    }

    pub fn put(
        &self,
        transaction: &mut Transaction<'_>,
        book: &str,
        seq: i64,
        change: &ChangedRow,
    ) -> Result<(), postgres::Error> {
        let id = match change {
            ChangedRow::Visit(visit) => visit.id,
            ChangedRow::Round(round) => round.id,
            ChangedRow::Event(event) => event.id,
        };
        let id = id.to_string();
        let mut values: Vec<&(dyn ToSql + Sync)> = vec![&id, &book, &seq];
        match change {
            ChangedRow::Visit(visit) => {
                let ended = visit.ended;
                let (ms, offset) = (ended.map(|at| at.utc_ms), ended.map(|at| at.offset_s));
                values.extend(refs![
                    visit.stand,
                    visit.began.utc_ms,
                    visit.began.offset_s,
                    ms,
                    offset,
                    visit.language
                ]);
                transaction.execute(&self.visit, &values)?;
            }
            ChangedRow::Round(round) => {
                let visit = round.visit.to_string();
                let hash = format!("{:016x}", round.level_hash);
                let [number, pieces, lost] =
                    [round.number, round.pieces, round.lost].map(i64::from);
                let players = i16::from(round.players);
                let ending = round.end.text();
                let [route, dare] = [round.route, round.dare].map(|route| route.map(route_text));
                values.extend(refs![
                    visit,
                    round.stand,
                    number,
                    round.began.utc_ms,
                    round.began.offset_s,
                    round.seconds,
                    round.level,
                    hash,
                    players,
                    ending,
                    route,
                    round.kept,
                    round.inside,
                    pieces,
                    lost,
                    dare,
                    round.replay
                ]);
                transaction.execute(&self.round, &values)?;
            }
            ChangedRow::Event(event) => {
                let kind = event.kind.text();
                values.extend(refs![
                    event.stand,
                    event.at.utc_ms,
                    event.at.offset_s,
                    kind,
                    event.text
                ]);
                transaction.execute(&self.event, &values)?;
            }
        }
        Ok(())
    }
}

/// Returns the SQL that inserts a row, or updates the existing row with the same id.
fn upsert(table: &str, columns: &str) -> String {
    let columns: Vec<&str> = columns.split_whitespace().collect();
    let places: Vec<String> = (1..=columns.len() + 1)
        .map(|place| format!("${place}"))
        .collect();
    let set: Vec<String> = columns
        .iter()
        .map(|name| format!("{name} = excluded.{name}"))
        .collect();
    format!(
        "INSERT INTO tamaire.{table} (id, {}) VALUES ({}) ON CONFLICT (id) DO UPDATE SET {}",
        columns.join(", "),
        places.join(", "),
        set.join(", ")
    )
}

/// Formats an error as a sentence.
pub fn told(error: &postgres::Error) -> String {
    let reason = match (error.as_db_error(), error.source()) {
        (Some(error), _) => error.message().to_string(),
        (None, Some(source)) => format!("{error}: {source}"),
        (None, None) => error.to_string(),
    };
    format!("cannot send the logbook to the server: {reason}")
}

fn of<T>(result: Result<T, postgres::Error>) -> Result<T, String> {
    result.map_err(|error| told(&error))
}
