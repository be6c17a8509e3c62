//! Reading rows from the tables.

use crate::row::read_route;
use crate::{Event, Id, Kind, Moment, Round, RoundEnd, Today, Visit};
use rusqlite::types::Type;
use rusqlite::{Connection, Row, params};
use std::ops::{Bound, RangeBounds};
use tamaire_play::Route;

/// Description of a table for reading: its columns, its name and the conversion of a row.
#[derive(Debug)]
pub struct TableReader<T> {
    columns: &'static str,
    table: &'static str,
    /// Name of the column with the time of a row.
    time: &'static str,
    /// Converts a row.
    pub read: fn(&Row<'_>) -> rusqlite::Result<T>,
}

pub const VISITS: TableReader<Visit> = TableReader {
    columns: "id, stand, began, began_offset, ended, ended_offset, language",
    table: "visits",
    time: "began",
    read: visit,
};

pub const ROUNDS: TableReader<Round> = TableReader {
    columns: "id, visit, stand, number, began, began_offset, seconds, level, level_hash, players, ending, route, kept,
        inside, pieces, lost, dare, fragment",
    table: "rounds LEFT JOIN replays USING (seq)",
    time: "began",
    read: round,
};

pub const EVENTS: TableReader<Event> = TableReader {
    columns: "id, stand, at, at_offset, kind, text",
    table: "events",
    time: "at",
    read: event,
};

impl<T> TableReader<T> {
    /// Returns the SQL for all rows with a time from `?1` to `?2` inclusive, ordered by `seq`.
    ///
    /// Rows are mostly written in the order of time, so few other rows lie between the first and the last
    /// match. A scan of this range of `seq` is fast and needs no sorting.
    pub fn in_range(&self) -> String {
        let Self {
            columns,
            table,
            time,
            ..
        } = self;
        let name = table.split(' ').next().unwrap_or(table);
        let end = |which: &str| {
            format!("(SELECT {which}(seq) FROM {name} WHERE {time} BETWEEN ?1 AND ?2)")
        };
        let (first, last) = (end("min"), end("max"));
        format!(
            "SELECT {columns} FROM {table} WHERE seq BETWEEN {first} AND {last} AND +{time} BETWEEN ?1 AND ?2 ORDER BY seq"
        )
    }

    /// Returns the SQL for the row with `seq = ?1`.
    #[cfg(feature = "postgres")]
    pub fn one(&self) -> String {
        let Self { columns, table, .. } = self;
        format!("SELECT {columns} FROM {table} WHERE seq = ?1")
    }
}

/// Returns the first and the last time in a range [ms of UTC]. For an empty range the first is after the
/// last.
pub fn ends(range: &impl RangeBounds<Moment>) -> (i64, i64) {
    let first = match range.start_bound() {
        Bound::Included(moment) => Some(moment.utc_ms),
        Bound::Excluded(moment) => moment.utc_ms.checked_add(1),
        Bound::Unbounded => Some(i64::MIN),
    };
    let last = match range.end_bound() {
        Bound::Included(moment) => Some(moment.utc_ms),
        Bound::Excluded(moment) => moment.utc_ms.checked_sub(1),
        Bound::Unbounded => Some(i64::MAX),
    };
    first.zip(last).unwrap_or((0, -1))
}

pub fn today(connection: &Connection, since: i64) -> rusqlite::Result<Today> {
    let visits = "SELECT count(*) FROM visits WHERE began >= ?1";
    let rounds = "
        SELECT count(*), count(*) FILTER (WHERE ending = 'won'), count(*) FILTER (WHERE route = 'squeeze'),
            count(*) FILTER (WHERE route = 'shave'), count(*) FILTER (WHERE route = 'mix'),
            count(*) FILTER (WHERE ending = 'retried')
        FROM rounds WHERE began >= ?1";
    let mut today = connection.query_row(rounds, [since], |row| {
        Ok(Today {
            rounds: row.get(0)?,
            wins: row.get(1)?,
            squeezed: row.get(2)?,
            shaved: row.get(3)?,
            mixed: row.get(4)?,
            retries: row.get(5)?,
            ..Today::default()
        })
    })?;
    today.visits = connection.query_row(visits, [since], |row| row.get(0))?;
    today.median_to_first_win = median_to_first_win(connection, since)?;
    Ok(today)
}

/// SQL for the playing time to the first win of each visit [s]. The index by time is forced: otherwise SQLite
/// scans all rounds by visit.
const TO_FIRST_WIN: &str = "
    SELECT (SELECT sum(seconds) FROM rounds WHERE rounds.visit = first.visit AND rounds.seq <= first.seq)
    FROM (
        SELECT visit, min(seq) AS seq FROM rounds INDEXED BY rounds_by_time
        WHERE began >= ?1 AND ending = 'won' GROUP BY visit
    ) AS first";

fn median_to_first_win(connection: &Connection, since: i64) -> rusqlite::Result<Option<f32>> {
    let mut statement = connection.prepare_cached(TO_FIRST_WIN)?;
    let times = statement.query_map([since], |row| row.get::<_, f32>(0))?;
    let mut times = times.collect::<rusqlite::Result<Vec<_>>>()?;
    times.sort_unstable_by(f32::total_cmp);
    let middle = |from: usize| times.get(from / 2).copied();
    // The mean of the two middle times; these are the same time if the count is odd.
    let low = times.len().checked_sub(1).and_then(middle);
    Ok(low
        .zip(middle(times.len()))
        .map(|(low, high)| 0.5 * (low + high)))
}

pub fn best(
    connection: &Connection,
    since: i64,
    level: &str,
    level_hash: Option<u64>,
    most: usize,
) -> rusqlite::Result<Vec<Round>> {
    let columns = ROUNDS.columns;
    let sql = format!(
        "SELECT {columns} FROM rounds INDEXED BY rounds_by_speed JOIN replays USING (seq)
        WHERE ending = 'won' AND level = ?1 AND began >= ?2 AND level_hash = coalesce(?3, level_hash)
        ORDER BY seconds, seq LIMIT ?4"
    );
    let mut statement = connection.prepare_cached(&sql)?;
    let (hash, most) = (level_hash.map(|hash| hash as i64), most.min(1 << 20) as i64);
    let rounds = statement.query_map(params![level, since, hash, most], ROUNDS.read)?;
    rounds.collect()
}

fn visit(row: &Row<'_>) -> rusqlite::Result<Visit> {
    let ended: Option<i64> = row.get(4)?;
    Ok(Visit {
        id: id(row, 0)?,
        stand: row.get(1)?,
        began: moment(row, 2)?,
        ended: ended.map(|_| moment(row, 4)).transpose()?,
        language: row.get(6)?,
    })
}

fn round(row: &Row<'_>) -> rusqlite::Result<Round> {
    let replay: Option<String> = row.get(17)?;
    Ok(Round {
        id: id(row, 0)?,
        visit: id(row, 1)?,
        stand: row.get(2)?,
        number: row.get(3)?,
        began: moment(row, 4)?,
        seconds: row.get(6)?,
        level: row.get(7)?,
        level_hash: row.get::<_, i64>(8)? as u64,
        players: row.get(9)?,
        end: word(row, 10, RoundEnd::read)?,
        route: route(row, 11)?,
        kept: row.get(12)?,
        inside: row.get(13)?,
        pieces: row.get(14)?,
        lost: row.get(15)?,
        dare: route(row, 16)?,
        replay: replay.unwrap_or_default(),
    })
}

fn event(row: &Row<'_>) -> rusqlite::Result<Event> {
    Ok(Event {
        id: id(row, 0)?,
        stand: row.get(1)?,
        at: moment(row, 2)?,
        kind: Kind::from(row.get::<_, String>(4)?),
        text: row.get(5)?,
    })
}

fn id(row: &Row<'_>, column: usize) -> rusqlite::Result<Id> {
    row.get(column).map(u128::from_be_bytes).map(Id)
}

/// Reads a moment from `column` (time) and the column after it (offset).
fn moment(row: &Row<'_>, column: usize) -> rusqlite::Result<Moment> {
    Ok(Moment {
        utc_ms: row.get(column)?,
        offset_s: row.get(column + 1)?,
    })
}

fn route(row: &Row<'_>, column: usize) -> rusqlite::Result<Option<Route>> {
    let is_there = row.get::<_, Option<String>>(column)?.is_some();
    is_there.then(|| word(row, column, read_route)).transpose()
}

fn word<T>(row: &Row<'_>, column: usize, read: fn(&str) -> Option<T>) -> rusqlite::Result<T> {
    let text: String = row.get(column)?;
    let unknown = || rusqlite::Error::InvalidColumnType(column, text.clone(), Type::Text);
    read(&text).ok_or_else(unknown)
}

#[cfg(test)]
mod tests {
    use super::super::schema::migrate;
    use super::*;

    #[test]
    fn median_to_first_win_reads_only_rounds_since_the_start_of_the_range() {
        let mut connection = Connection::open_in_memory().unwrap();
        migrate(&mut connection).unwrap();
        let sql = format!("EXPLAIN QUERY PLAN {TO_FIRST_WIN}");
        let mut statement = connection.prepare(&sql).unwrap();
        let steps = statement
            .query_map([0], |row| row.get::<_, String>(3))
            .unwrap();
        let steps: Vec<String> = steps.map(Result::unwrap).collect();
        assert!(
            !steps.iter().any(|step| step.contains("SCAN rounds")),
            "{steps:?}"
        );
        assert!(
            steps
                .iter()
                .any(|step| step.contains("rounds_by_time (began>?)")),
            "{steps:?}"
        );
    }
}
