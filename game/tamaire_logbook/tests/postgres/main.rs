//! Rows reach a real PostgreSQL server, despite failures of the server or the stand.
#![cfg(unix)]

#[path = "../common/mod.rs"]
mod common;
mod server;

use common::{
    DAY, LONG, MINUTE, MORNING, STAND, all, entries, event, open, place, round, visit, wait_for,
};
use postgres::Client;
use server::Postgres;
use std::collections::BTreeSet;
use std::path::Path;
use std::thread;
use std::time::{Duration, Instant};
use tamaire_logbook::{Entry, Event, Kind, Moment, Options, Recorder, Server};
use tamaire_play::Route;

fn begin(path: &Path, stand: &str, server: &Server) -> Recorder {
    let options = Options {
        server: Some(server.clone()),
        ..Options::default()
    };
    Recorder::begin(path, stand, options)
}

/// Records a visit of three rounds.
fn record(recorder: &Recorder, began: Moment) {
    let entries = entries(began).into_iter();
    entries.for_each(|entry| recorder.record(entry));
}

/// Waits until the server has `rows` rows and no entry is waiting.
fn wait_for_rows(recorder: &Recorder, client: &mut Client, rows: i64) {
    let start = Instant::now();
    let count = |client: &mut Client| {
        let sql =
            "SELECT (SELECT count(*) FROM tamaire.visits) + (SELECT count(*) FROM tamaire.rounds)
            + (SELECT count(*) FROM tamaire.events)";
        client
            .query_one(sql, &[])
            .map_or(0, |row| row.get::<_, i64>(0))
    };
    while count(client) < rows {
        assert!(
            start.elapsed() < LONG,
            "{} of {rows}, {:?}",
            count(client),
            recorder.health()
        );
        thread::sleep(Duration::from_millis(20));
    }
    assert_eq!(count(client), rows);
    let health = wait_for(recorder, "everything sent", |health| {
        health.unsent == 0 && health.waiting == 0
    });
    assert_eq!(health.problem, None);
}

/// Returns the ids of a table and checks that none occurs twice.
fn ids(client: &mut Client, table: &str) -> BTreeSet<String> {
    let rows = client
        .query(&format!("SELECT id FROM tamaire.{table}"), &[])
        .unwrap();
    let ids: BTreeSet<String> = rows.iter().map(|row| row.get(0)).collect();
    assert_eq!(ids.len(), rows.len());
    ids
}

fn count(client: &mut Client, what: &str) -> i64 {
    client
        .query_one(&format!("SELECT count(*) FROM tamaire.{what}"), &[])
        .unwrap()
        .get(0)
}

/// The server is missing at first, then started, and killed and restarted several times while it receives
/// rows. The recorder is also ended and restarted meanwhile.
#[test]
fn rows_arrive_exactly_once_when_server_and_recorder_restart() {
    let Some(mut server) = Postgres::find() else {
        return;
    };
    let address = server.named("postgres");
    let (_folder, path) = place();
    let recorder = begin(&path, STAND, &address);
    record(&recorder, MORNING);
    let health = wait_for(&recorder, "away", |health| {
        health.problem.is_some() && health.unsent == 4
    });
    let trouble = health.problem.unwrap();
    assert!(
        trouble.starts_with("cannot send the logbook to the server: "),
        "{trouble}"
    );
    assert!(health.is_recording);
    server.start();
    wait_for_rows(&recorder, &mut server.ask("postgres"), 4);

    server.kill();
    let mut random = fastrand::Rng::with_seed(11);
    let mut rows = 4;
    let mut recorder = Some(recorder);
    for attempt in 0..8 {
        let writer = recorder
            .take()
            .unwrap_or_else(|| begin(&path, STAND, &address));
        for minute in 0..200 {
            record(&writer, MORNING.after(minute * MINUTE));
        }
        rows += 800;
        server.start();
        thread::sleep(Duration::from_millis(random.u64(0..1500)));
        server.kill();
        if attempt % 2 == 0 {
            assert_eq!(writer.finish(LONG).waiting, 0);
        } else {
            recorder = Some(writer);
        }
    }
    server.start();
    let recorder = recorder.unwrap_or_else(|| begin(&path, STAND, &address));
    let mut client = server.ask("postgres");
    wait_for_rows(&recorder, &mut client, rows);
    drop(recorder);
    let kept = all(&open(&path)).unwrap();
    let expected = kept.rounds.iter().map(|round| round.id.to_string());
    assert_eq!(ids(&mut client, "rounds"), expected.collect());
    let expected = kept.visits.iter().map(|visit| visit.id.to_string());
    assert_eq!(ids(&mut client, "visits"), expected.collect());
    assert_eq!(
        count(&mut client, "visits WHERE ended_ms IS NULL"),
        0,
        "later ends of visits must arrive"
    );
    assert_eq!(
        count(
            &mut client,
            "rounds JOIN tamaire.visits ON visit = visits.id"
        ),
        rows / 4 * 3
    );
}

/// To run this test for one minute instead of an hour: `AWAY=60 cargo test -p tamaire_logbook --features
/// postgres --test postgres -- --ignored --nocapture`.
#[test]
#[ignore = "takes an hour"]
fn server_receives_all_rows_after_an_hour_offline() {
    let Some(mut server) = Postgres::find() else {
        return;
    };
    let away = std::env::var("AWAY").map_or(3600, |seconds| seconds.parse().unwrap());
    let address = server.named("postgres");
    let (_folder, path) = place();
    let recorder = begin(&path, STAND, &address);
    server.start();
    let mut rows = 0;
    let mut record = |minute| {
        self::record(&recorder, MORNING.after(minute * MINUTE));
        rows += 4;
        rows
    };
    let known = record(0);
    wait_for_rows(&recorder, &mut server.ask("postgres"), known);
    server.kill();
    let left = Instant::now();
    let mut minute = 0;
    while left.elapsed() < Duration::from_secs(away) {
        minute += 1;
        record(minute);
        thread::sleep(Duration::from_secs(1));
    }
    let health = recorder.health();
    assert!(
        health.is_recording && health.problem.is_some(),
        "{health:?}"
    );
    server.start();
    let back = Instant::now();
    let rows = record(minute + 1);
    let mut client = server.ask("postgres");
    wait_for(&recorder, "everything sent", |health| {
        health.unsent == 0 && health.waiting == 0
    });
    wait_for_rows(&recorder, &mut client, rows);
    println!(
        "{rows} rows, all received {:.1?} after the server was back",
        back.elapsed()
    );
    drop(recorder);
    let kept = all(&open(&path)).unwrap();
    let expected = kept.rounds.iter().map(|round| round.id.to_string());
    assert_eq!(ids(&mut client, "rounds"), expected.collect());
}

/// Runs several cases on the same server, because starting a server is slow.
#[test]
fn sender_transfers_rows_to_a_running_server() {
    let Some(mut server) = Postgres::find() else {
        return;
    };
    server.start();
    every_column_arrives(&server);
    two_stands_do_not_disturb_each_other(&server);
    unsent_rows_are_kept(&server);
    lost_rows_are_sent_again(&server);
    tables_of_a_newer_version_are_left_alone(&server);
    invalid_addresses_are_reported(&server);
}

fn every_column_arrives(server: &Postgres) {
    let address = server.database("columns");
    let mut client = server.ask("columns");
    let (_folder, path) = place();
    let recorder = begin(&path, STAND, &address);
    let visit = visit(MORNING);
    let mut won = round(&visit, 2, Some(Route::Mix));
    won.number = u32::MAX;
    won.replay = common::long_replay();
    let mut odd: Event = event(MORNING.after(i64::MAX), Kind::Other("weather".into()));
    odd.text = "ふわ\0ふわ ' \\ \u{1f9fa}".into();
    recorder.record(Entry::VisitBegan(visit.clone()));
    recorder.record(Entry::Round(won.clone()));
    recorder.record(Entry::Event(odd.clone()));
    wait_for_rows(&recorder, &mut client, 3);
    let row = client
        .query_one("SELECT * FROM tamaire.visits", &[])
        .unwrap();
    assert_eq!(row.get::<_, String>("id"), visit.id.to_string());
    assert_eq!(row.get::<_, Option<i64>>("ended_ms"), None);
    let row = client
        .query_one("SELECT * FROM tamaire.rounds", &[])
        .unwrap();
    assert_eq!(row.get::<_, String>("visit"), visit.id.to_string());
    assert_eq!(row.get::<_, i64>("number"), u32::MAX.into());
    assert_eq!(row.get::<_, i64>("began_ms"), won.began.utc_ms);
    assert_eq!(row.get::<_, i32>("began_offset_s"), 3600);
    assert_eq!(row.get::<_, f32>("kept"), won.kept);
    assert_eq!(
        row.get::<_, String>("level_hash"),
        format!("{:016x}", won.level_hash)
    );
    let words = ["stand", "level", "ending", "route", "dare", "replay"];
    let words = words.map(|column| row.get::<_, Option<String>>(column).unwrap());
    assert_eq!(
        words,
        [STAND, "classic", "won", "mix", "shave", &won.replay]
    );
    let row = client
        .query_one("SELECT * FROM tamaire.events", &[])
        .unwrap();
    assert_eq!(row.get::<_, String>("kind"), "weather");
    assert_eq!(row.get::<_, String>("text"), odd.text.replace('\0', ""));
    // Records the end of the visit after all its rows, with the clock set back by a day.
    let at = MORNING.after(-DAY);
    let (id, language) = (visit.id, String::new());
    recorder.record(Entry::VisitEnded { id, at, language });
    let ended = format!("visits WHERE ended_ms = {}", at.utc_ms);
    let start = Instant::now();
    while count(&mut client, &ended) == 0 {
        assert!(start.elapsed() < LONG);
        thread::sleep(Duration::from_millis(20));
    }
    assert_eq!(count(&mut client, "visits"), 1);
}

fn two_stands_do_not_disturb_each_other(server: &Postgres) {
    let address = server.database("stands");
    let mut client = server.ask("stands");
    let places = [place(), place()];
    let names = ["hall 1", "hall 2"];
    let stands = [0, 1].map(|stand| begin(&places[stand].1, names[stand], &address));
    for minute in 0..100 {
        for recorder in &stands {
            let mut entries = entries(MORNING.after(minute * MINUTE));
            entries.swap(1, 2);
            entries.into_iter().for_each(|entry| recorder.record(entry));
        }
    }
    wait_for_rows(&stands[0], &mut client, 800);
    wait_for_rows(&stands[1], &mut client, 800);
    assert_eq!(count(&mut client, "books"), 2);
    let apart = "(SELECT DISTINCT book, seq FROM tamaire.rounds) AS of";
    let sql = format!("SELECT count(*) FROM {apart}");
    assert_eq!(client.query_one(&sql, &[]).unwrap().get::<_, i64>(0), 600);
}

fn unsent_rows_are_kept(server: &Postgres) {
    let address = server.named("later");
    let (_folder, path) = place();
    let mut book = open(&path);
    for day in 0..20 {
        book.write_all(&entries(Moment::now().after(-day * DAY)))
            .unwrap();
    }
    drop(book);
    let options = Options {
        keep_days: Some(14),
        server: Some(address),
        ..Options::default()
    };
    let recorder = Recorder::begin(&path, STAND, options.clone());
    wait_for(&recorder, "away", |health| {
        health.unsent == 80 && health.is_recording
    });
    drop(recorder);
    assert_eq!(all(&open(&path)).unwrap().visits.len(), 20);
    server.database("later");
    let recorder = Recorder::begin(&path, STAND, options.clone());
    let mut client = server.ask("later");
    wait_for_rows(&recorder, &mut client, 80);
    drop(recorder);
    drop(Recorder::begin(&path, STAND, options));
    let kept = all(&open(&path)).unwrap().visits.len();
    assert!((14..=15).contains(&kept), "{kept}");
    assert_eq!(count(&mut client, "visits"), 20);
}

fn lost_rows_are_sent_again(server: &Postgres) {
    let address = server.database("lost");
    let (_folder, path) = place();
    for rows in [4, 8] {
        let recorder = begin(&path, STAND, &address);
        record(&recorder, MORNING);
        wait_for_rows(&recorder, &mut server.ask("lost"), rows);
        drop(recorder);
        let drop_it = "DROP DATABASE lost WITH (FORCE)";
        server.ask("postgres").batch_execute(drop_it).unwrap();
        server.database("lost");
    }
    let recorder = begin(&path, STAND, &address);
    wait_for_rows(&recorder, &mut server.ask("lost"), 8);
}

fn tables_of_a_newer_version_are_left_alone(server: &Postgres) {
    let address = server.database("newer");
    let (_folder, path) = place();
    let recorder = begin(&path, STAND, &address);
    record(&recorder, MORNING);
    let mut client = server.ask("newer");
    wait_for_rows(&recorder, &mut client, 4);
    drop(recorder);
    client
        .execute("UPDATE tamaire.version SET version = 7", &[])
        .unwrap();
    let recorder = begin(&path, STAND, &address);
    record(&recorder, MORNING);
    let health = wait_for(&recorder, "refused", |health| {
        health.problem.is_some() && health.unsent == 4
    });
    let expected = "the server's tables have version 7: this program supports up to version 1; install a newer tamaire";
    assert_eq!(health.problem.as_deref(), Some(expected));
    assert!(health.is_recording);
    assert_eq!(count(&mut client, "visits"), 1);
}

fn invalid_addresses_are_reported(server: &Postgres) {
    let (_folder, path) = place();
    for (address, expected) in [
        ("hots=hall", "the address of the server is invalid"),
        (
            "host=/nowhere user=stand password=secret",
            "cannot send the logbook",
        ),
        (
            &server.named("missing").address,
            "database \"missing\" does not exist",
        ),
    ] {
        let address = Server {
            address: address.into(),
        };
        let recorder = begin(&path, STAND, &address);
        let health = wait_for(&recorder, expected, |health| health.problem.is_some());
        let trouble = health.problem.unwrap();
        assert!(
            trouble.contains(expected) && !trouble.contains("secret"),
            "{trouble}"
        );
        assert!(!format!("{recorder:?} {address:?}").contains("secret"));
        wait_for(&recorder, "recording", |health| health.is_recording);
    }
}
