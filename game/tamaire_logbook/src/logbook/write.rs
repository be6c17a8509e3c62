//! Writing entries into the tables.

use crate::row::{MAX_TEXT_BYTES, route_text};
use crate::{Entry, Event, Id, Moment, Round, Visit};
use rusqlite::{Connection, Transaction, TransactionBehavior, named_params, params};
use std::borrow::Cow;
use tamaire_play::replay::MAX_BYTES;

/// Maximum number of rows deleted in one transaction. Other connections can write between the transactions.
const CHUNK: i64 = 1000;

/// Writes all entries in one transaction. Rows whose id exists already are left unchanged.
pub fn write(connection: &mut Connection, entries: &[Entry]) -> rusqlite::Result<()> {
    let transaction = Transaction::new(connection, TransactionBehavior::Immediate)?;
    let sql = "SELECT changes, stand FROM book";
    let (mut changes, stand): (i64, String) =
        transaction.query_row(sql, [], |row| Ok((row.get(0)?, row.get(1)?)))?;
    for entry in entries {
        let next = changes + 1;
        let changed = match entry {
            Entry::VisitBegan(visit) => begin_visit(&transaction, next, visit)?,
            Entry::VisitEnded { id, at, language } => {
                end_visit(&transaction, next, (*id, *at, language), &stand)?
            }
            Entry::Round(round) => add_round(&transaction, &mut changes, round)?,
            Entry::Event(event) => add_event(&transaction, next, event)?,
        };
        changes += i64::from(changed);
    }
    transaction.execute("UPDATE book SET changes = ?1", [changes])?;
    transaction.commit()
}

/// Inserts a visit. If an entry for a round or for the end of the visit has created its row with an empty
/// language, fills in the missing values instead. Returns whether the row changed.
fn begin_visit(connection: &Connection, change: i64, visit: &Visit) -> rusqlite::Result<bool> {
    let sql = "
        INSERT INTO visits VALUES (:change, :change, :id, :stand, :began, :began_offset, :ended, :ended_offset, :language)
        ON CONFLICT (id) DO UPDATE SET change = excluded.change, stand = excluded.stand, began = excluded.began,
            began_offset = excluded.began_offset, language = excluded.language
        WHERE visits.language = '' AND excluded.language <> ''";
    let changed = connection.prepare_cached(sql)?.execute(named_params! {
        ":change": change,
        ":id": visit.id.0.to_be_bytes(),
        ":stand": clean(&visit.stand),
        ":began": visit.began.utc_ms,
        ":began_offset": visit.began.offset_s,
        ":ended": visit.ended.map(|ended| ended.utc_ms),
        ":ended_offset": visit.ended.map(|ended| ended.offset_s),
        ":language": clean(&visit.language),
    })?;
    Ok(changed > 0)
}

fn end_visit(
    connection: &Connection,
    change: i64,
    (id, at, language): (Id, Moment, &str),
    stand: &str,
) -> rusqlite::Result<bool> {
    let sql = "
        INSERT INTO visits VALUES (?1, ?1, ?2, ?3, ?4, ?5, ?4, ?5, ?6)
        ON CONFLICT (id) DO UPDATE SET change = excluded.change, ended = excluded.ended, ended_offset = excluded.ended_offset,
            language = iif(excluded.language = '', visits.language, excluded.language)
        WHERE visits.ended IS NULL";
    let mut statement = connection.prepare_cached(sql)?;
    let id = id.0.to_be_bytes();
    let changed = statement.execute(params![
        change,
        id,
        stand,
        at.utc_ms,
        at.offset_s,
        clean(language)
    ])?;
    Ok(changed > 0)
}

/// Inserts a round. Creates its visit without a language if the entry of the visit was dropped while the disk
/// was full. The created visit takes a change number, too.
fn add_round(connection: &Connection, changes: &mut i64, round: &Round) -> rusqlite::Result<bool> {
    let sql = "INSERT INTO visits VALUES (?1, ?1, ?2, ?3, ?4, ?5, NULL, NULL, '') ON CONFLICT (id) DO NOTHING";
    let brought = connection.prepare_cached(sql)?.execute(params![
        *changes + 1,
        round.visit.0.to_be_bytes(),
        clean(&round.stand),
        round.began.utc_ms,
        round.began.offset_s,
    ])?;
    *changes += brought as i64;
    let seq = *changes + 1;
    let sql = "
        INSERT INTO rounds VALUES (:seq, :id, :visit, :stand, :number, :began, :began_offset, :seconds, :level,
            :level_hash, :players, :ending, :route, :kept, :inside, :pieces, :lost, :dare)
        ON CONFLICT (id) DO NOTHING";
    let changed = connection.prepare_cached(sql)?.execute(named_params! {
        ":seq": seq,
        ":id": round.id.0.to_be_bytes(),
        ":visit": round.visit.0.to_be_bytes(),
        ":stand": clean(&round.stand),
        ":number": round.number,
        ":began": round.began.utc_ms,
        ":began_offset": round.began.offset_s,
        ":seconds": number(round.seconds),
        ":level": clean(&round.level),
        // SQLite has no unsigned integers: the bits are stored as a signed integer.
        ":level_hash": round.level_hash as i64,
        ":players": round.players,
        ":ending": round.end.text(),
        ":route": round.route.map(route_text),
        ":kept": number(round.kept),
        ":inside": number(round.inside),
        ":pieces": round.pieces,
        ":lost": round.lost,
        ":dare": round.dare.map(route_text),
    })?;
    let has_replay = !round.replay.is_empty() && round.replay.len() <= MAX_BYTES;
    if changed > 0 && has_replay {
        let sql = "INSERT INTO replays VALUES (?1, ?2)";
        let mut statement = connection.prepare_cached(sql)?;
        statement.execute(params![seq, round.replay.replace('\0', "")])?;
    }
    Ok(changed > 0)
}

fn add_event(connection: &Connection, seq: i64, event: &Event) -> rusqlite::Result<bool> {
    let sql = "INSERT INTO events VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7) ON CONFLICT (id) DO NOTHING";
    let changed = connection.prepare_cached(sql)?.execute(params![
        seq,
        event.id.0.to_be_bytes(),
        clean(&event.stand),
        event.at.utc_ms,
        event.at.offset_s,
        clean(event.kind.text()),
        clean(&event.text),
    ])?;
    Ok(changed > 0)
}

/// Deletes rows that began before `utc_ms` [ms of UTC], except rows that wait for a server and visits with
/// remaining rounds.
pub fn forget_before(connection: &Connection, utc_ms: i64) -> rusqlite::Result<()> {
    let tables = [
        ("rounds", "began < ?1 AND seq <= ?2"),
        ("events", "at < ?1 AND seq <= ?2"),
        (
            "visits",
            "began < ?1 AND change <= ?2 AND NOT EXISTS (SELECT * FROM rounds WHERE visit = visits.id)",
        ),
    ];
    for (table, old) in tables {
        let sent = "SELECT CASE WHEN server IS NULL THEN changes ELSE sent END FROM book";
        let sent: i64 = connection.query_row(sent, [], |row| row.get(0))?;
        let sql = format!(
            "DELETE FROM {table} WHERE seq IN (SELECT seq FROM {table} WHERE {old} LIMIT {CHUNK})"
        );
        while connection.execute(&sql, [utc_ms, sent])? > 0 {}
    }
    Ok(())
}

/// Returns a text fit for the database: at most [`MAX_TEXT_BYTES`] long, and without zero bytes, which
/// PostgreSQL refuses.
fn clean(text: &str) -> Cow<'_, str> {
    let end = text.floor_char_boundary(MAX_TEXT_BYTES);
    let text = &text[..end];
    match text.contains('\0') {
        true => text.replace('\0', "").into(),
        false => text.into(),
    }
}

/// Replaces NaN by 0, because SQLite stores NaN as NULL.
fn number(value: f32) -> f32 {
    if value.is_nan() { 0.0 } else { value }
}
