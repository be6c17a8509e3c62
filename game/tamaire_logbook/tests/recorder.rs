//! Recording never blocks the game, and entries reach the file as soon as the disk allows it.

mod common;

use common::{
    DAY, LONG, MINUTE, MORNING, STAND, all, entries, event, execute, open, place, round, visit,
    wait_for,
};
use rusqlite::Connection;
use std::fs;
use std::path::Path;
use std::thread;
use std::time::{Duration, Instant};
use tamaire_logbook::{Entry, Health, Kind, Logbook, Moment, Options, Recorder};
use tamaire_play::Route;

fn begin(path: &Path) -> Recorder {
    Recorder::begin(path, STAND, Options::default())
}

/// Records entries and checks that no call blocks.
fn record(recorder: &Recorder, entries: Vec<Entry>) {
    for entry in entries {
        let start = Instant::now();
        recorder.record(entry);
        let took = start.elapsed();
        assert!(took < Duration::from_millis(100), "{took:?}");
    }
}

#[test]
fn recorder_writes_entries_and_answers_requests() {
    let (folder, path) = place();
    let recorder = begin(&path);
    record(&recorder, entries(MORNING));
    let health = wait_for(&recorder, "written", |health| {
        health.waiting == 0 && health.is_recording
    });
    assert_eq!(
        (health.problem, health.dropped, health.set_aside),
        (None, 0, None)
    );
    assert!(health.bytes > 4096 && health.unsent == 0);

    assert_eq!(
        (recorder.today(), recorder.best(), recorder.exported()),
        (None, None, None)
    );
    recorder.ask_today(MORNING);
    recorder.ask_best(MORNING, "classic", None, 3);
    let copy = folder.path().join("copy");
    recorder.ask_export(copy.clone());
    wait_for(&recorder, "answered", |_| {
        recorder.today().is_some() && recorder.best().is_some()
    });
    let today = recorder.today().unwrap();
    assert_eq!(
        (today.visits, today.rounds, today.wins, today.retries),
        (1, 3, 1, 2)
    );
    assert_eq!(recorder.best().unwrap()[0].route, Some(Route::Squeeze));
    let start = Instant::now();
    let exported = loop {
        if let Some(exported) = recorder.exported() {
            break exported;
        }
        assert!(start.elapsed() < LONG);
    };
    assert_eq!(exported, Ok(copy.clone()));
    assert_eq!(recorder.exported(), None, "taken only once");
    recorder.ask_export(copy.clone());
    record(&recorder, vec![Entry::Event(event(MORNING, Kind::Ended))]);
    let health = recorder.finish(LONG);
    assert_eq!((health.waiting, health.is_recording), (0, false));
    let kept = all(&open(&path)).unwrap();
    assert_eq!(
        (kept.visits.len(), kept.rounds.len(), kept.events.len()),
        (1, 3, 1)
    );
    assert_eq!(
        all(&Logbook::read(&copy).unwrap()).unwrap().rounds,
        kept.rounds
    );
}

#[test]
fn drop_writes_the_waiting_entries_of_several_threads() {
    let (_folder, path) = place();
    let recorder = begin(&path);
    thread::scope(|scope| {
        for _ in 0..4 {
            scope.spawn(|| {
                for minute in 0..50 {
                    record(&recorder, entries(MORNING.after(minute * MINUTE)));
                }
            });
        }
    });
    drop(recorder);
    let kept = all(&open(&path)).unwrap();
    assert_eq!((kept.visits.len(), kept.rounds.len()), (200, 600));
    assert!(kept.visits.iter().all(|visit| visit.ended.is_some()));
}

#[test]
fn recorder_retries_an_unwritable_folder() {
    let (folder, path) = place();
    fs::write(folder.path().join("kept"), "in the way").unwrap();
    let recorder = begin(&path);
    record(&recorder, entries(MORNING));
    let health = wait_for(&recorder, "trouble", |health| health.problem.is_some());
    assert_eq!((health.is_recording, health.waiting), (false, 5));
    assert!(
        health
            .problem
            .unwrap()
            .contains("logbook.sqlite: the logbook cannot be")
    );
    fs::remove_file(folder.path().join("kept")).unwrap();
    let health = wait_for(&recorder, "mended", |health| health.waiting == 0);
    let health = if health.is_recording {
        health
    } else {
        wait_for(&recorder, "mended", |health| health.is_recording)
    };
    assert_eq!((health.problem, health.dropped), (None, 0));
    drop(recorder);
    assert_eq!(all(&open(&path)).unwrap().rounds.len(), 3);
}

#[test]
fn recorder_waits_for_a_locked_file() {
    let (_folder, path) = place();
    open(&path);
    let recorder = begin(&path);
    wait_for(&recorder, "open", |health| health.is_recording);
    let other = Connection::open(&path).unwrap();
    other.execute_batch("BEGIN IMMEDIATE").unwrap();
    record(&recorder, entries(MORNING));
    let health = wait_for(&recorder, "locked", |health| health.problem.is_some());
    assert!(health.problem.unwrap().contains("another program"));
    record(&recorder, entries(MORNING));
    assert_eq!(recorder.health().waiting, 10);
    other.execute_batch("COMMIT").unwrap();
    wait_for(&recorder, "free", |health| health.waiting == 0);
    // `finish` must return after its time limit, even if the file is locked.
    other.execute_batch("BEGIN IMMEDIATE").unwrap();
    record(&recorder, entries(MORNING));
    let start = Instant::now();
    let health = recorder.finish(Duration::from_millis(300));
    assert_eq!(health.waiting, 5);
    assert!(
        start.elapsed() < Duration::from_secs(1),
        "{:?}",
        start.elapsed()
    );
    drop(other);
}

#[test]
fn recorder_waits_for_space_and_notes_a_full_disk() {
    let (_folder, path) = place();
    let mut book = open(&path);
    for day in 1..50 {
        let mut old = round(&visit(Moment::now().after(-day * DAY)), 1, None);
        old.replay = common::long_replay();
        book.write(&Entry::Round(old)).unwrap();
        book.write_all(&entries(Moment::now().after(-day * DAY)))
            .unwrap();
    }
    let options = Options {
        max_bytes: Some(1),
        ..Options::default()
    };
    let recorder = Recorder::begin(&path, STAND, options);
    let mut told = 0;
    let full = |health: &Health| {
        health
            .problem
            .as_ref()
            .is_some_and(|text| text.ends_with("the disk is full"))
    };
    while !full(&recorder.health()) {
        let visit = visit(Moment::now());
        let mut round = round(&visit, 1, None);
        round.replay = common::long_replay();
        record(&recorder, vec![Entry::Round(round)]);
        told += 1;
        assert!(told < 5000);
        thread::sleep(Duration::from_millis(1));
    }
    let health = recorder.health();
    assert!(!health.is_recording && health.waiting > 0, "{health:?}");
    record(&recorder, entries(Moment::now()));
    // Deletes rows, so that there is space again.
    book.delete_before(Moment::now().after(-DAY / 2)).unwrap();
    wait_for(&recorder, "room", |health| {
        health.is_recording && health.waiting == 0
    });
    let health = recorder.finish(LONG);
    assert_eq!((health.dropped, health.problem), (0, None));
    let kept = all(&open(&path)).unwrap();
    assert_eq!(kept.rounds.len(), told + 3);
    let kinds: Vec<_> = kept.events.iter().map(|event| event.kind.clone()).collect();
    assert_eq!(kinds, [Kind::FullDisk], "noted only once");
}

#[test]
fn recorder_sets_aside_a_damaged_file_and_notes_it() {
    let (_folder, path) = place();
    open(&path);
    let whole = fs::read(&path).unwrap();
    fs::write(&path, &whole[..5000]).unwrap();
    let recorder = begin(&path);
    let health = wait_for(&recorder, "set aside", |health| health.set_aside.is_some());
    let aside = health.set_aside.unwrap().path;
    assert_eq!(fs::read(&aside).unwrap(), whole[..5000]);
    drop(recorder);
    let kept = all(&open(&path)).unwrap();
    assert_eq!(kept.events[0].kind, Kind::DamagedFile);
    let name = aside.file_name().unwrap().to_str().unwrap();
    assert!(kept.events[0].text.contains(name), "{:?}", kept.events);
}

#[test]
fn recorder_sets_aside_a_file_damaged_during_recording() {
    let (_folder, path) = place();
    let recorder = begin(&path);
    record(&recorder, entries(MORNING));
    wait_for(&recorder, "written", |health| {
        health.is_recording && health.waiting == 0
    });
    execute(&path, "PRAGMA writable_schema = on; DROP TABLE events");
    record(&recorder, vec![Entry::Event(event(MORNING, Kind::Began))]);
    let health = wait_for(&recorder, "mended", |health| {
        health.waiting == 0 && health.is_recording && health.set_aside.is_some()
    });
    assert_eq!(health.dropped, 0);
    drop(recorder);
    let kinds = all(&open(&path)).unwrap().events;
    let kinds: Vec<_> = kinds.into_iter().map(|event| event.kind).collect();
    assert_eq!(kinds, [Kind::Began, Kind::DamagedFile]);
}

#[test]
fn recorder_leaves_a_newer_file_unchanged_and_limits_waiting_entries() {
    let (_folder, path) = place();
    drop(open(&path));
    execute(&path, "PRAGMA user_version = 2");
    let recorder = begin(&path);
    wait_for(&recorder, "newer", |health| {
        health
            .problem
            .as_ref()
            .is_some_and(|text| text.contains("install a newer tamaire"))
    });
    let mut long = round(&visit(MORNING), 1, None);
    long.replay = "r".repeat(1 << 25);
    for _ in 0..3 {
        recorder.record(Entry::Round(long.clone()));
    }
    let health = recorder.health();
    assert_eq!(
        (health.waiting, health.dropped),
        (1, 2),
        "the limit in bytes"
    );
    for _ in 0..70_000 {
        recorder.record(Entry::Event(event(MORNING, Kind::Began)));
    }
    let health = recorder.finish(Duration::from_millis(10));
    assert_eq!(health.waiting as u64 + health.dropped, 70_003);
    assert_eq!(health.waiting, 1 << 16);
    let later = Connection::open(&path).unwrap();
    let rows = later.query_row("SELECT count(*) FROM events", [], |row| {
        row.get::<_, i64>(0)
    });
    assert_eq!(rows, Ok(0));
}

/// If the clock is years ahead, only a few days of rows are deleted.
#[test]
fn recorder_deletes_old_rows_a_few_days_at_a_time() {
    let (_folder, path) = place();
    let mut book = open(&path);
    for day in 0..40 {
        book.write_all(&entries(Moment::now().after(-day * DAY - 10 * MINUTE)))
            .unwrap();
    }
    drop(book);
    let sweep = |days| {
        let options = Options {
            keep_days: Some(days),
            ..Options::default()
        };
        assert_eq!(
            Recorder::begin(&path, STAND, options).finish(LONG).problem,
            None
        );
        all(&open(&path)).unwrap().visits.len()
    };
    assert_eq!(sweep(39), 39);
    assert_eq!(sweep(10), 32);
    assert_eq!(sweep(30), 30);
}
