//! Example rows and helpers for the tests.
#![allow(dead_code)] // no test file uses all of these

use rusqlite::Connection;
use std::path::{Path, PathBuf};
use std::thread;
use std::time::{Duration, Instant};
use tamaire_logbook::{
    Entry, Error, Event, Health, Id, Kind, Logbook, Moment, Recorder, Round, RoundEnd, Visit,
};
use tamaire_play::Route;
use tempfile::TempDir;

pub const STAND: &str = "hall 2";
/// Monday, 2026-11-23, 09:00 at UTC+1.
pub const MORNING: Moment = Moment {
    utc_ms: 1_795_420_800_000,
    offset_s: 3600,
};
pub const MINUTE: i64 = 60_000;
pub const DAY: i64 = 24 * 60 * MINUTE;

/// Returns a folder and the path of a logbook in it. The folder is in memory if possible, because the disk
/// may be busy.
pub fn place() -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir_in("/dev/shm").or_else(|_| tempfile::tempdir());
    let folder = folder.unwrap();
    let path = folder.path().join("kept/logbook.sqlite");
    (folder, path)
}

/// Opens or creates a logbook, and checks that no damaged file was set aside.
pub fn open(path: &Path) -> Logbook {
    let (book, set_aside) = Logbook::open(path, STAND).unwrap();
    assert_eq!(set_aside, None);
    book
}

/// Executes SQL in a file, as another program would.
pub fn execute(path: &Path, sql: &str) {
    let other = Connection::open(path).unwrap();
    other.execute_batch(sql).unwrap();
}

/// Timeout of every wait in the tests.
pub const LONG: Duration = Duration::from_secs(60);

/// Waits until `is_so` holds, and returns that state. Panics with `what` after [`LONG`].
pub fn wait_for(recorder: &Recorder, what: &str, is_so: impl Fn(&Health) -> bool) -> Health {
    let start = Instant::now();
    loop {
        let health = recorder.health();
        if is_so(&health) {
            return health;
        }
        assert!(start.elapsed() < LONG, "{what}: {health:?}");
        thread::sleep(Duration::from_millis(5));
    }
}

pub fn visit(began: Moment) -> Visit {
    Visit {
        id: Id::random(),
        stand: STAND.into(),
        began,
        ended: None,
        language: "de".into(),
    }
}

pub fn round(visit: &Visit, number: u32, won: Option<Route>) -> Round {
    Round {
        id: Id::random(),
        visit: visit.id,
        stand: visit.stand.clone(),
        number,
        began: visit.began.after(i64::from(number) * MINUTE),
        seconds: 10.0 + number as f32,
        level: "classic".into(),
        level_hash: u64::MAX - 7,
        players: 1,
        end: won.map_or(RoundEnd::Retried, |_| RoundEnd::Won),
        route: won,
        kept: 0.987_654_3,
        inside: 0.5,
        pieces: 3,
        lost: 1,
        dare: (number > 1).then_some(Route::Shave),
        replay: "r1abcz".into(),
    }
}

pub fn event(at: Moment, kind: Kind) -> Event {
    Event {
        id: Id::random(),
        stand: STAND.into(),
        at,
        kind,
        text: "details of the event".into(),
    }
}

/// Returns the entries of a visit: its beginning, three rounds of which the last is won, and its end.
pub fn entries(began: Moment) -> Vec<Entry> {
    let visit = visit(began);
    let at = began.after(10 * MINUTE);
    let rounds = [None, None, Some(Route::Squeeze)];
    let rounds = (1..).zip(rounds);
    let rounds = rounds.map(|(number, won)| Entry::Round(round(&visit, number, won)));
    let mut all = vec![Entry::VisitBegan(visit.clone())];
    all.extend(rounds);
    let (id, language) = (visit.id, String::new());
    all.push(Entry::VisitEnded { id, at, language });
    all
}

/// Returns a replay of typical length.
pub fn long_replay() -> String {
    let letters = (0..3000).map(|k: u32| char::from(b'a' + (k * k % 23) as u8));
    format!("r1{}z", letters.collect::<String>())
}

/// All rows of a logbook.
#[derive(Debug, Default, PartialEq)]
pub struct All {
    pub visits: Vec<Visit>,
    pub rounds: Vec<Round>,
    pub events: Vec<Event>,
}

/// Returns a function that appends a row to `rows`.
fn into<T>(rows: &mut Vec<T>) -> impl FnMut(T) -> Result<(), Error> {
    |row| {
        rows.push(row);
        Ok(())
    }
}

pub fn all(book: &Logbook) -> Result<All, Error> {
    let mut all = All::default();
    book.visits(.., into(&mut all.visits))?;
    book.rounds(.., into(&mut all.rounds))?;
    book.events(.., into(&mut all.events))?;
    Ok(all)
}
