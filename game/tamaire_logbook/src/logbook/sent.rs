//! What a server has got, and what not yet.

#[cfg(feature = "postgres")]
pub use since::{Change, Sent, changes, sent, set_sent, unsent};

use rusqlite::{Connection, params};

/// Keeps from now on what this server has not got, or no server. One that was not the last one has got nothing.
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

    /// A row that a server has not got as it is now.
    #[derive(Debug)]
    pub enum Change {
        Visit(Visit),
        Round(Round),
        Event(Event),
    }

    /// Up to where the server has got what is in a file.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Sent {
        /// By what the file is known.
        pub book: Id,
        /// The number of the last change that it has got.
        pub change: i64,
    }

    /// Changes after a number, in their order: the number of each, that of the row, and the row.
    pub fn changes(
        connection: &Connection,
        after: i64,
        most: usize,
    ) -> rusqlite::Result<Vec<(i64, i64, Change)>> {
        let sql = "
            SELECT change, seq, 0 FROM visits WHERE change > ?1
            UNION ALL SELECT seq, seq, 1 FROM rounds WHERE seq > ?1
            UNION ALL SELECT seq, seq, 2 FROM events WHERE seq > ?1
            ORDER BY 1 LIMIT ?2";
        // What is read is of one moment, whoever writes beside it.
        let moment = connection.unchecked_transaction()?;
        let mut statement = moment.prepare_cached(sql)?;
        let numbers = statement.query_map(params![after, most as i64], |row| {
            Ok((row.get(0)?, row.get(1)?, row.get(2)?))
        })?;
        let numbers = numbers.collect::<rusqlite::Result<Vec<(i64, i64, i64)>>>()?;
        let read = |(change, seq, table)| {
            let row = match table {
                0 => Change::Visit(moment.query_row(&VISITS.one(), [seq], VISITS.read)?),
                1 => Change::Round(moment.query_row(&ROUNDS.one(), [seq], ROUNDS.read)?),
                _ => Change::Event(moment.query_row(&EVENTS.one(), [seq], EVENTS.read)?),
            };
            Ok((change, seq, row))
        };
        numbers.into_iter().map(read).collect()
    }

    pub fn sent(connection: &Connection) -> rusqlite::Result<Sent> {
        connection.query_row("SELECT id, sent FROM book", [], |row| {
            Ok(Sent {
                book: Id(u128::from_be_bytes(row.get(0)?)),
                change: row.get(1)?,
            })
        })
    }

    /// Notes what this server has got, unless the file has another one now.
    pub fn set_sent(connection: &Connection, server: &str, sent: &Sent) -> rusqlite::Result<()> {
        let sql = "UPDATE book SET sent = ?1 WHERE id = ?2 AND server = ?3";
        connection.execute(sql, params![sent.change, sent.book.0.to_be_bytes(), server])?;
        Ok(())
    }

    /// How many rows wait for the server.
    pub fn unsent(connection: &Connection) -> rusqlite::Result<u64> {
        let sql = "
            SELECT (SELECT count(*) FROM visits WHERE change > sent) + (SELECT count(*) FROM rounds WHERE seq > sent)
                + (SELECT count(*) FROM events WHERE seq > sent)
            FROM book";
        connection.query_row(sql, [], |row| row.get(0))
    }
}
