//! Rounds that are run again.

use crate::made_up::{Rows, rows};
use crate::{logbooks, report_on};
use std::fs;
use std::sync::Arc;
use tamaire_logbook::{Id, Round, RoundEnd};
use tamaire_play::{AnyRound, Bot, BotKind, Level, Replay, Route};
use tamaire_report::figures::Reason;
use tamaire_report::{Options, Stage, report};

const RERUN: Options = Options {
    language: tamaire_report::Language::English,
    csv: false,
    json: true,
    from: None,
    to: None,
    rerun: true,
};

/// Lets a bot play a round, and returns its row. The id, the visit and the time of the row are copied from
/// `of`.
fn played(of: &Round, level: &str, kind: BotKind, ticks: usize, seed: u64) -> Round {
    let level = Arc::new(Level::open(level).unwrap());
    let mut round = AnyRound::new(level.clone());
    let mut bot = Bot::new(kind, seed);
    while round.frames().len() < ticks && round.progress().outcome.is_none() {
        let frame = round.ask(&mut bot);
        round.step(frame);
    }
    let progress = round.progress();
    let outcome = progress.outcome;
    Round {
        level: level.id.clone(),
        level_hash: level.hash(),
        seconds: round.frames().len() as f32 / 60.0,
        end: if outcome.is_some() {
            RoundEnd::Won
        } else {
            RoundEnd::Left
        },
        route: outcome.map(|won| won.route),
        kept: progress.kept,
        inside: progress.inside,
        pieces: progress.pieces as u32,
        lost: outcome.map_or(0, |won| won.lost as u32),
        replay: round.replay().fragment().unwrap(),
        ..of.clone()
    }
}

/// Returns a won round, a short one that was not won, one in 3D, and one without a replay.
fn honest() -> Rows {
    let mut rows = rows(3, 7);
    rows.rounds.truncate(4);
    assert_eq!(rows.rounds.len(), 4);
    let of = rows.rounds.clone();
    rows.rounds[0] = played(&of[0], "classic", BotKind::Squeeze, 3600, 1);
    rows.rounds[1] = played(&of[1], "classic", BotKind::Shave, 90, 2);
    rows.rounds[2] = played(&of[2], "hoop", BotKind::Random, 45, 3);
    (rows.rounds[3].end, rows.rounds[3].route) = (RoundEnd::Cut, None);
    assert_eq!(rows.rounds[0].route, Some(Route::Squeeze));
    rows
}

#[test]
fn rounds_that_match_their_replays_are_counted_and_shown_on_maps() {
    let rows = honest();
    let folder = tempfile::tempdir().unwrap();
    let files = logbooks(folder.path(), &[rows.clone(), rows.clone()]);
    let out = folder.path().join("out");
    let report = report_on(&files, &out, &RERUN).unwrap();
    let basis = &report.figures.basis;
    assert_eq!(
        (basis.rerun, basis.not_rerun, basis.refused.len()),
        (3, 1, 0),
        "{basis:?}"
    );
    let classic = rows.rounds[0].level_hash;
    let level = |hash| {
        let hash = format!("{hash:016x}");
        report
            .figures
            .levels
            .iter()
            .find(move |level| level.level_hash == hash)
            .unwrap()
    };
    let hands = level(classic).hands.as_ref().unwrap();
    assert_eq!((hands.rounds, hands.axes), (2, [0, 1]));
    let played: f64 = rows.rounds[..2]
        .iter()
        .map(|round| f64::from(round.seconds))
        .sum();
    let seen: f64 = hands.seconds.iter().sum();
    assert!((seen - played).abs() < 0.1, "{seen} s of {played} s");
    let hoop = level(rows.rounds[2].level_hash).hands.as_ref().unwrap();
    assert_eq!(hoop.axes, [0, 2]);
    let page = fs::read_to_string(&report.page).unwrap();
    assert_eq!(page.matches("Where hands moved: ").count(), 2);

    let options = Options {
        rerun: false,
        ..RERUN
    };
    let without = report_on(&files, &out, &options).unwrap();
    let page = fs::read_to_string(&without.page).unwrap();
    assert!(page.contains("Create the report with --rerun"));
    assert_eq!(without.figures.total, report.figures.total);
}

#[test]
fn rounds_that_differ_from_their_replays_are_listed_and_not_counted() {
    let good = honest();
    let mut rows = Rows {
        visits: good.visits.clone(),
        ..Rows::default()
    };
    let (won, lost) = (&good.rounds[0], &good.rounds[1]);
    let mut expected = Vec::new();
    let mut add = |round: Round, reason: Option<Reason>| {
        let id = Id(rows.rounds.len() as u128 + 1);
        expected.extend(reason.map(|reason| (id, reason)));
        rows.rounds.push(Round { id, ..round });
    };
    add(won.clone(), None);
    type Change = fn(&mut Round);
    let of_won: [(Change, Reason); 9] = [
        (|round| round.seconds -= 1.0, Reason::Differs),
        (|round| round.route = Some(Route::Shave), Reason::Differs),
        (
            |round| (round.end, round.route) = (RoundEnd::Left, None),
            Reason::Differs,
        ),
        (|round| round.level = "hoop".into(), Reason::Differs),
        (|round| round.level_hash = 7, Reason::Differs),
        (|round| round.pieces += 1, Reason::Differs),
        (|round| round.replay += "AA", Reason::Unreadable),
        (|round| round.replay = "hello".into(), Reason::Unreadable),
        (|round| round.replay = tampered(round), Reason::Astray),
    ];
    let of_lost: [(Change, Reason); 4] = [
        (|round| round.kept = 0.5, Reason::Differs),
        (
            |round| (round.end, round.route) = (RoundEnd::Won, Some(Route::Mix)),
            Reason::Differs,
        ),
        (|round| round.end = RoundEnd::Won, Reason::Contradictory),
        (|round| round.seconds = f32::INFINITY, Reason::Contradictory),
    ];
    for (honest, changes) in [(won, &of_won[..]), (lost, &of_lost)] {
        for (change, reason) in changes {
            let mut wrong = honest.clone();
            change(&mut wrong);
            add(wrong, Some(*reason));
        }
    }
    let folder = tempfile::tempdir().unwrap();
    let files = logbooks(folder.path(), &[rows]);
    let report = report_on(&files, &folder.path().join("out"), &RERUN).unwrap();
    let refused = &report.figures.basis.refused;
    let found: Vec<(Id, Reason)> = refused
        .iter()
        .map(|round| (round.round, round.reason))
        .collect();
    assert_eq!(found, expected, "{refused:?}");
    let figures = &report.figures;
    assert_eq!(
        (figures.total.rounds.all, figures.total.rounds.squeeze),
        (1, 1)
    );
    assert_eq!(figures.tries.iter().map(|wins| wins.all).sum::<u64>(), 1);
    assert_eq!(
        figures
            .levels
            .iter()
            .map(|level| level.rounds.all)
            .sum::<u64>(),
        1
    );
    assert_eq!(figures.total.visits, good.visits.len() as u64);
    let page = fs::read_to_string(&report.page).unwrap();
    for (id, _) in found {
        assert!(page.contains(&id.to_string()));
    }
}

/// Returns the replay of `round` with its first two hashes exchanged. This replay can be decoded but diverges
/// when run.
fn tampered(round: &Round) -> String {
    let text = Replay::of_fragment(&round.replay).unwrap().text();
    let hashes = text.lines().find(|line| line.starts_with("hashes = "));
    let all: Vec<&str> = hashes.unwrap().split('"').collect();
    let (first, second) = (all[1], all[3]);
    assert_ne!(first, second);
    let both = |a, b| format!("\"{a}\", \"{b}\"");
    let text = text.replacen(&both(first, second), &both(second, first), 1);
    Replay::read(&text).unwrap().fragment().unwrap()
}

#[test]
fn interrupted_rerun_continues_from_the_stored_results() {
    let rows = honest();
    let folder = tempfile::tempdir().unwrap();
    let files = logbooks(folder.path(), &[rows]);
    let out = folder.path().join("out");
    let whole = report_on(&files, &out, &RERUN).unwrap();
    let path = out.join("reruns.jsonl");
    let text = fs::read_to_string(&path).unwrap();
    assert_eq!(text.lines().count(), 3);
    // The file as a killed program leaves it, with an incomplete last line. Before that come a line with
    // other rules and a line that is not JSON.
    let lines: Vec<&str> = text.lines().collect();
    let old = lines[2].replace(
        &format!("\"rules\":{}", tamaire_play::replay::VERSION),
        "\"rules\":1",
    );
    assert_ne!(old, lines[2]);
    let killed = [lines[0], &old, "not JSON", &lines[1][..lines[1].len() / 2]].join("\n");
    fs::write(&path, &killed).unwrap();

    let mut told = Vec::new();
    let again = report(&files, &out, &RERUN, None, &mut |progress| {
        if progress.stage == Stage::Rerun {
            told.push((progress.done, progress.all));
        }
    });
    let again = again.unwrap();
    assert_eq!(again.figures, whole.figures);
    assert_eq!(
        told,
        [(1, Some(4)), (2, Some(4)), (3, Some(4)), (4, Some(4))]
    );
    let after = fs::read_to_string(&path).unwrap();
    let lines: Vec<&str> = after.lines().collect();
    assert_eq!(lines.len(), 5, "three stored lines and two new ones");
    assert!(after.starts_with(&[text.lines().next().unwrap(), &old, "not JSON"].join("\n")));

    // All results are stored already: nothing is added.
    report_on(&files, &out, &RERUN).unwrap();
    assert_eq!(fs::read_to_string(&path).unwrap(), after);
}

#[test]
fn best_rounds_are_shown_as_clips_if_their_replays_match() {
    let mut rows = honest();
    let folder = tempfile::tempdir().unwrap();
    let gif = b"GIF89a, nearly".to_vec();
    let clip = |replay: &Replay| match replay.ticks() {
        0 => Err("nothing was played".to_string()),
        _ => Ok(gif.clone()),
    };
    let files = logbooks(&folder.path().join("good"), &[rows.clone()]);
    let out = folder.path().join("out");
    let options = Options::default();
    let page = |files: &[_]| {
        let report = report(files, &out, &options, Some(&clip), &mut |_| {}).unwrap();
        fs::read_to_string(report.page).unwrap()
    };
    let good = page(&files);
    assert_eq!(
        good.matches("data:image/gif;base64,R0lGODlhLCBuZWFybHk=")
            .count(),
        1
    );
    rows.rounds[0].replay = tampered(&rows.rounds[0]);
    let files = logbooks(&folder.path().join("bad"), &[rows]);
    let bad = page(&files);
    assert!(!bad.contains("data:image/gif") && bad.contains("No clip of round"));
}
