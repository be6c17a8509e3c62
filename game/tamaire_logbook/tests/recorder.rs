//! Playing goes on whatever the disk does, and what was recorded gets on file as soon as it can.

mod common;

use common::{DAY, MINUTE, MORNING, STAND, all, entries, event, open, place, round, visit};
use rusqlite::Connection;
use std::fs;
use std::path::Path;
use std::thread;
use std::time::{Duration, Instant};
use tamaire_logbook::{Entry, Health, Kind, Logbook, Moment, Options, Recorder};
use tamaire_play::Route;

const LONG: Duration = Duration::from_secs(20);

fn begin(path: &Path) -> Recorder {
    Recorder::begin(path, STAND, Options::default())
}

/// Waits until it is as it should be.
fn wait_for(recorder: &Recorder, what: &str, is_so: impl Fn(&Health) -> bool) -> Health {
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

/// Records, and sees that nobody waits for it.
fn record(recorder: &Recorder, entries: Vec<Entry>) {
    for entry in entries {
        let start = Instant::now();
        recorder.record(entry);
        let took = start.elapsed();
        assert!(took < Duration::from_millis(100), "{took:?}");
    }
}

#[test]
fn what_is_recorded_is_on_file_and_summed_up() {
    let (folder, path) = place();
    let recorder = begin(&path);
    record(&recorder, entries(MORNING));
    let health = wait_for(&recorder, "written", |health| {
        health.waiting == 0 && health.is_recording
    });
    assert_eq!(
        (health.trouble, health.dropped, health.set_aside),
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
    assert_eq!(recorder.exported(), None, "once");
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
fn many_record_at_once_and_a_drop_writes_what_waits() {
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
fn a_folder_that_cannot_be_written_is_tried_again() {
    let (folder, path) = place();
    fs::write(folder.path().join("kept"), "in the way").unwrap();
    let recorder = begin(&path);
    record(&recorder, entries(MORNING));
    let health = wait_for(&recorder, "trouble", |health| health.trouble.is_some());
    assert_eq!((health.is_recording, health.waiting), (false, 5));
    assert!(
        health
            .trouble
            .unwrap()
            .contains("logbook.sqlite: it cannot be")
    );
    fs::remove_file(folder.path().join("kept")).unwrap();
    let health = wait_for(&recorder, "mended", |health| health.waiting == 0);
    let health = if health.is_recording {
        health
    } else {
        wait_for(&recorder, "mended", |health| health.is_recording)
    };
    assert_eq!((health.trouble, health.dropped), (None, 0));
    drop(recorder);
    assert_eq!(all(&open(&path)).unwrap().rounds.len(), 3);
}

#[test]
fn one_that_another_program_holds_is_waited_for() {
    let (_folder, path) = place();
    open(&path);
    let recorder = begin(&path);
    wait_for(&recorder, "open", |health| health.is_recording);
    let other = Connection::open(&path).unwrap();
    other.execute_batch("BEGIN IMMEDIATE").unwrap();
    record(&recorder, entries(MORNING));
    let health = wait_for(&recorder, "locked", |health| health.trouble.is_some());
    assert!(health.trouble.unwrap().contains("another program"));
    record(&recorder, entries(MORNING));
    assert_eq!(recorder.health().waiting, 10);
    other.execute_batch("COMMIT").unwrap();
    wait_for(&recorder, "free", |health| health.waiting == 0);
    // To end is not to wait for others longer than one may.
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
fn a_full_disk_is_waited_for_and_noted() {
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
        most_bytes: Some(1),
        ..Options::default()
    };
    let recorder = Recorder::begin(&path, STAND, options);
    let mut told = 0;
    let full = |health: &Health| {
        health
            .trouble
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
    // Somebody makes room.
    book.forget_before(Moment::now().after(-DAY / 2)).unwrap();
    wait_for(&recorder, "room", |health| {
        health.is_recording && health.waiting == 0
    });
    let health = recorder.finish(LONG);
    assert_eq!((health.dropped, health.trouble), (0, None));
    let kept = all(&open(&path)).unwrap();
    assert_eq!(kept.rounds.len(), told + 3);
    let kinds: Vec<_> = kept.events.iter().map(|event| event.kind.clone()).collect();
    assert_eq!(kinds, [Kind::FullDisk], "once");
}

#[test]
fn a_damaged_file_is_set_aside_and_noted() {
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
fn a_file_that_breaks_while_it_is_written_is_set_aside() {
    let (_folder, path) = place();
    let recorder = begin(&path);
    record(&recorder, entries(MORNING));
    wait_for(&recorder, "written", |health| {
        health.is_recording && health.waiting == 0
    });
    let other = Connection::open(&path).unwrap();
    other
        .execute_batch("PRAGMA writable_schema = on; DROP TABLE events")
        .unwrap();
    drop(other);
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
fn a_newer_file_is_left_alone_and_what_waits_has_a_bound() {
    let (_folder, path) = place();
    drop(open(&path));
    let later = Connection::open(&path).unwrap();
    later.execute_batch("PRAGMA user_version = 2").unwrap();
    drop(later);
    let recorder = begin(&path);
    wait_for(&recorder, "newer", |health| {
        health
            .trouble
            .as_ref()
            .is_some_and(|text| text.contains("it needs a newer tamaire"))
    });
    let mut long = round(&visit(MORNING), 1, None);
    long.replay = "r".repeat(1 << 25);
    for _ in 0..3 {
        recorder.record(Entry::Round(long.clone()));
    }
    let health = recorder.health();
    assert_eq!((health.waiting, health.dropped), (1, 2), "no more bytes");
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

/// A clock that is years ahead costs some days of the oldest, not all.
#[test]
fn what_is_old_is_forgotten_some_days_at_a_time() {
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
            Recorder::begin(&path, STAND, options).finish(LONG).trouble,
            None
        );
        all(&open(&path)).unwrap().visits.len()
    };
    assert_eq!(sweep(39), 39);
    assert_eq!(sweep(10), 32);
    assert_eq!(sweep(30), 30);
}
