//! Record of the rows that the server has received.

#[cfg(feature = "postgres")]
pub use since::{ChangedRow, SyncPosition, changes, sent, set_sent, unsent};

use rusqlite::{Connection, params};

/// Sets the server for which unsent rows are kept. If `server` is another server than before, all rows count
/// as unsent.
pub fn await_server(connection: &Connection, server: Option<&str>) -> rusqlite::Result<()> {
    let sql = "UPDATE book SET server = ?1, sent = CASE WHEN ?1 IS NULL THEN sent ELSE 0 END WHERE server IS NOT ?1";
    connection.execute(sql, params![server])?;
    Ok(())
}

#[cfg(feature = "postgres")]
mod since {
    use super::super::read::{EVENTS, ROUNDS, VISITS};
    use crate::{Event, Id, Round, Visit};
    use rusqlite::{Connection, params};

    /// A new or changed row that the server has not received yet.
    #[derive(Debug)]
    pub enum ChangedRow {
        Visit(Visit),
        Round(Round),
        Event(Event),
    }

    /// Position up to which the server has received a logbook file.
    #[derive(Clone, Debug, PartialEq)]
    pub struct SyncPosition {
        /// Id of the file.
        pub book: Id,
        /// Number of the last change that the server has received.
        pub change: i64,
    }

    /// Returns at most `most` changes after change number `after`, in the order of their numbers. Each item
    /// holds the change number, the row number and the row.
    pub fn changes(
        connection: &Connection,
        after: i64,
        most: usize,
    ) -> rusqlite::Result<Vec<(i64, i64, ChangedRow)>> {
        let sql = "
            SELECT change, seq, 0 FROM visits WHERE change > ?1
            UNION ALL SELECT seq, seq, 1 FROM rounds WHERE seq > ?1
            UNION ALL SELECT seq, seq, 2 FROM events WHERE seq > ?1
            ORDER BY 1 LIMIT ?2";
        // Reads all rows in one transaction, so that they belong to the same state even if another connection
        // writes meanwhile.
        let moment = connection.unchecked_transaction()?;
        let mut statement = moment.prepare_cached(sql)?;
        let numbers = statement.query_map(params![after, most as i64], |row| {
            Ok((row.get(0)?, row.get(1)?, row.get(2)?))
        })?;
        let numbers = numbers.collect::<rusqlite::Result<Vec<(i64, i64, i64)>>>()?;
        let read = |(change, seq, table)| {
            let row = match table {
                0 => ChangedRow::Visit(moment.query_row(&VISITS.one(), [seq], VISITS.read)?),
                1 => ChangedRow::Round(moment.query_row(&ROUNDS.one(), [seq], ROUNDS.read)?),
                _ => ChangedRow::Event(moment.query_row(&EVENTS.one(), [seq], EVENTS.read)?),
            };
            Ok((change, seq, row))
        };
        numbers.into_iter().map(read).collect()
    }

    pub fn sent(connection: &Connection) -> rusqlite::Result<SyncPosition> {
        connection.query_row("SELECT id, sent FROM book", [], |row| {
            Ok(SyncPosition {
                book: Id(u128::from_be_bytes(row.get(0)?)),
                change: row.get(1)?,
            })
        })
    }

    /// Stores the position that `server` has reached. Has no effect if the file or its server was replaced
    /// meanwhile.
    pub fn set_sent(
        connection: &Connection,
        server: &str,
        sent: &SyncPosition,
    ) -> rusqlite::Result<()> {
        let sql = "UPDATE book SET sent = ?1 WHERE id = ?2 AND server = ?3";
        connection.execute(sql, params![sent.change, sent.book.0.to_be_bytes(), server])?;
        Ok(())
    }

    /// Returns the number of rows that wait for the server.
    pub fn unsent(connection: &Connection) -> rusqlite::Result<u64> {
        let sql = "
            SELECT (SELECT count(*) FROM visits WHERE change > sent) + (SELECT count(*) FROM rounds WHERE seq > sent)
                + (SELECT count(*) FROM events WHERE seq > sent)
            FROM book";
        connection.query_row(sql, [], |row| row.get(0))
    }
}
