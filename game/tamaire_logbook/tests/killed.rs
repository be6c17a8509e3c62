//! Written rows survive a killed process.
#![cfg(unix)]

mod common;

use common::{MORNING, STAND, all, event, long_replay, round, visit};
use std::collections::HashSet;
use std::env;
use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Command, Stdio};
use std::thread;
use std::time::Duration;
use tamaire_logbook::{Entry, Kind, Logbook};

/// Environment variable, set in the process to be killed: path of its logbook.
const VICTIM: &str = "LOGBOOK_OF_VICTIM";

/// Code of the child process: writes until it is killed, and prints the id of each written round. In a normal
/// test run [`VICTIM`] is not set, and this test does nothing.
#[test]
fn victim() {
    let Some(path) = env::var_os(VICTIM) else {
        return;
    };
    let (mut book, set_aside) = Logbook::open(Path::new(&path), STAND).unwrap();
    let mut out = std::io::stdout();
    if let Some(set_aside) = set_aside {
        writeln!(out, "aside {set_aside:?}").unwrap();
    }
    for count in 0.. {
        let visit = visit(MORNING);
        let mut round = round(&visit, 1, None);
        round.replay = long_replay();
        let id = round.id;
        book.write(&Entry::Round(round)).unwrap();
        writeln!(out, "wrote {id}").unwrap();
        if count % 50 == 0 {
            book.delete_before(MORNING.after(-1)).unwrap();
            book.write(&Entry::Event(event(MORNING, Kind::Began)))
                .unwrap();
        }
    }
}

#[test]
fn committed_rows_survive_a_killed_process() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("logbook.sqlite");
    let mut random = fastrand::Rng::with_seed(5);
    let mut told = HashSet::new();
    for attempt in 0..30 {
        let mut victim = Command::new(env::current_exe().unwrap())
            .args(["--exact", "victim", "--nocapture"])
            .env(VICTIM, &path)
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let mut lines = BufReader::new(victim.stdout.take().unwrap())
            .lines()
            .map_while(Result::ok);
        // Every fifth child is killed while it opens the file, the others during or between two rounds.
        let count = if attempt % 5 == 0 {
            0
        } else {
            random.usize(1..40)
        };
        let mut seen: Vec<String> = lines.by_ref().take(count).collect();
        thread::sleep(Duration::from_micros(random.u64(0..20_000)));
        victim.kill().unwrap();
        victim.wait().unwrap();
        seen.extend(lines);
        for line in seen {
            assert!(!line.contains("aside"), "{line}");
            if let Some((_, id)) = line.split_once("wrote ") {
                told.insert(id.to_owned());
            }
        }
    }
    let (book, set_aside) = Logbook::open(&path, STAND).unwrap();
    assert_eq!(set_aside, None);
    let kept = all(&book).unwrap().rounds;
    let ids: HashSet<String> = kept.iter().map(|round| round.id.to_string()).collect();
    assert_eq!(ids.len(), kept.len());
    assert!(told.is_subset(&ids), "{} of {}", ids.len(), told.len());
    assert!(told.len() > 200, "{}", told.len());
    // Each child may have written one more round without printing it.
    assert!(
        ids.len() <= told.len() + 30,
        "{} of {}",
        ids.len(),
        told.len()
    );
}
