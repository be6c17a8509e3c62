//! Slow reference implementation of the figures, from the raw rows.

use crate::made_up::{Rows, rows};
use crate::{all_files, logbooks, report_on};
use jiff::Timestamp;
use jiff::tz::Offset;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use tamaire_logbook::{Logbook, Moment, Round, Visit};
use tamaire_play::Route;
use tamaire_report::Options;
use tamaire_report::figures::{Figures, Totals, Wins};

const ROUTES: [Route; 3] = [Route::Squeeze, Route::Shave, Route::Mix];

fn local(moment: Moment) -> jiff::civil::DateTime {
    let offset = Offset::from_seconds(moment.offset_s).unwrap();
    offset.to_datetime(Timestamp::from_millisecond(moment.utc_ms).unwrap())
}

fn day(moment: Moment) -> String {
    local(moment).date().to_string()
}

/// A visit with its rounds in order.
type Told<'a> = (&'a Visit, Vec<&'a Round>);

fn told<'a>(rows: &'a Rows, [from, to]: [Option<&str>; 2]) -> Vec<Told<'a>> {
    let mut told = Vec::new();
    for visit in &rows.visits {
        let day = day(visit.began);
        if from.is_some_and(|from| day.as_str() < from) || to.is_some_and(|to| day.as_str() > to) {
            continue;
        }
        let mut rounds: Vec<&Round> = rows
            .rounds
            .iter()
            .filter(|round| round.visit == visit.id)
            .collect();
        rounds.sort_by_key(|round| round.number);
        told.push((visit, rounds));
    }
    told
}

fn wins<'a>(rounds: impl IntoIterator<Item = &'a Round>) -> Wins {
    let rounds: Vec<&Round> = rounds.into_iter().collect();
    let of = |route| {
        rounds
            .iter()
            .filter(|round| round.route == Some(route))
            .count() as u64
    };
    Wins {
        all: rounds.len() as u64,
        squeeze: of(Route::Squeeze),
        shave: of(Route::Shave),
        mix: of(Route::Mix),
    }
}

fn won<'a>(rounds: &[&'a Round]) -> Vec<&'a Round> {
    rounds
        .iter()
        .copied()
        .filter(|round| round.route.is_some())
        .collect()
}

fn to_first_win(rounds: &[&Round]) -> Option<f64> {
    let first = won(rounds).first()?.number;
    let before = rounds.iter().filter(|round| round.number <= first);
    Some(before.map(|round| f64::from(round.seconds)).sum())
}

fn median(mut all: Vec<f64>) -> Option<f64> {
    all.sort_by(f64::total_cmp);
    let [low, high] = [all.len().checked_sub(1)? / 2, all.len() / 2];
    Some((500.0 * (all[low] + all[high])).round() / 1000.0)
}

fn totals(told: &[&Told]) -> Totals {
    let visits = told.len() as u64;
    let visits_won = told
        .iter()
        .filter(|(_, rounds)| !won(rounds).is_empty())
        .count() as u64;
    Totals {
        visits,
        visits_played: told.iter().filter(|(_, rounds)| !rounds.is_empty()).count() as u64,
        visits_won,
        share_won: (visits > 0).then(|| visits_won as f64 / visits as f64),
        rounds: wins(told.iter().flat_map(|(_, rounds)| rounds.iter().copied())),
        median_to_first_win: median(
            told.iter()
                .filter_map(|(_, rounds)| to_first_win(rounds))
                .collect(),
        ),
    }
}

fn compare(figures: &Figures, told: &[Told]) {
    let all: Vec<&Told> = told.iter().collect();
    let rounds: Vec<&Round> = told
        .iter()
        .flat_map(|(_, rounds)| rounds.iter().copied())
        .collect();
    assert_eq!(figures.total, totals(&all));

    let names: BTreeSet<&str> = told.iter().map(|(visit, _)| visit.stand.as_str()).collect();
    assert_eq!(figures.stands.len(), names.len());
    for stand in &figures.stands {
        let of_it: Vec<&Told> = told
            .iter()
            .filter(|(visit, _)| visit.stand == stand.stand)
            .collect();
        assert_eq!(stand.totals, totals(&of_it), "{}", stand.stand);
    }
    let days: BTreeSet<String> = told.iter().map(|(visit, _)| day(visit.began)).collect();
    let found: Vec<String> = figures.days.iter().map(|of| of.day.to_string()).collect();
    assert_eq!(found, days.into_iter().collect::<Vec<_>>());
    assert_eq!(
        figures.first_day.map(|day| day.to_string()).as_ref(),
        found.first()
    );
    assert_eq!(
        figures.last_day.map(|day| day.to_string()).as_ref(),
        found.last()
    );
    for of_day in &figures.days {
        let of_it: Vec<&Told> = told
            .iter()
            .filter(|(visit, _)| day(visit.began) == of_day.day.to_string())
            .collect();
        assert_eq!(of_day.totals, totals(&of_it));
    }
    for (hour, found) in figures.hours.iter().enumerate() {
        let is_in = |moment: Moment| local(moment).hour() as usize == hour;
        assert_eq!(
            found.visits,
            told.iter().filter(|(visit, _)| is_in(visit.began)).count() as u64
        );
        assert_eq!(
            found.rounds,
            rounds.iter().filter(|round| is_in(round.began)).count() as u64
        );
    }
    for language in &figures.languages {
        let count = told
            .iter()
            .filter(|(visit, _)| visit.language == language.name)
            .count();
        assert_eq!(language.count, count as u64);
    }

    let keys: BTreeSet<(&str, u64)> = rounds
        .iter()
        .map(|round| (round.level.as_str(), round.level_hash))
        .collect();
    assert_eq!(figures.levels.len(), keys.len());
    for level in &figures.levels {
        let is_of = |round: &&&Round| {
            round.level == level.level && format!("{:016x}", round.level_hash) == level.level_hash
        };
        let of_it: Vec<&Round> = rounds.iter().filter(is_of).copied().collect();
        assert_eq!(level.rounds, wins(of_it.iter().copied()));
        let won_count = won(&of_it).len();
        match level.tries_per_win {
            Some(tries) => assert!(
                (tries * won_count as f64 - of_it.len() as f64).abs() < 1e-3 * won_count as f64
            ),
            None => assert_eq!(won_count, 0),
        }
        let seconds = won(&of_it)
            .iter()
            .map(|round| f64::from(round.seconds))
            .collect();
        assert_eq!(level.median_win, median(seconds));
    }
    for (k, found) in figures.tries.iter().enumerate() {
        let is_one = |round: &&&Round| round.number as usize == k + 1 || k == 3 && round.number > 4;
        assert_eq!(*found, wins(rounds.iter().filter(is_one).copied()));
    }
    for (k, &found) in figures.rounds_per_visit.iter().enumerate() {
        let is_one = |(_, rounds): &&Told| rounds.len() == k || k == 20 && rounds.len() > 20;
        assert_eq!(found, told.iter().filter(is_one).count() as u64);
    }
    for bin in &figures.pieces {
        let is_in = |round: &&&Round| {
            bin.from <= round.pieces && bin.to.is_none_or(|to| round.pieces <= to)
        };
        assert_eq!(bin.rounds, wins(rounds.iter().filter(is_in).copied()));
    }
    assert_eq!(
        figures.pieces.iter().map(|bin| bin.rounds.all).sum::<u64>(),
        rounds.len() as u64
    );
    for end in &figures.ends {
        let count = rounds
            .iter()
            .filter(|round| round.end.text() == end.name)
            .count();
        assert_eq!(end.count, count as u64);
    }

    let times: Vec<f64> = told
        .iter()
        .filter_map(|(_, rounds)| to_first_win(rounds))
        .collect();
    assert_eq!(figures.to_first_win.visits, times.len() as u64);
    for bin in &figures.to_first_win.bins {
        let is_in = |time: &&f64| bin.from <= **time && bin.to.is_none_or(|to| **time < to);
        assert_eq!(bin.visits, times.iter().filter(is_in).count() as u64);
    }
    for (share, found) in [0.1, 0.25, 0.5, 0.75, 0.9]
        .iter()
        .zip(figures.to_first_win.quantiles.into_iter().flatten())
    {
        let smaller = times.iter().filter(|time| **time <= found + 0.0006).count() as f64;
        let truly = times.iter().filter(|time| **time < found - 0.0006).count() as f64;
        let needed = share * times.len() as f64;
        assert!(smaller >= needed && truly <= needed, "{share} {found}");
    }

    let mut switched = [0, 0];
    for (k, route) in ROUTES.into_iter().enumerate() {
        let mut after = Wins::default();
        for (_, rounds) in told {
            let wins = won(rounds);
            if wins.first().and_then(|first| first.route) != Some(route) {
                continue;
            }
            after.add(wins.get(1).and_then(|next| next.route));
            if let Some(next) = wins.get(1).filter(|next| next.route != Some(route)) {
                let between =
                    |round: &&&Round| wins[0].number < round.number && round.number <= next.number;
                let is_dared = rounds
                    .iter()
                    .filter(between)
                    .any(|round| round.dare.is_some());
                switched[0] += 1;
                switched[1] += u64::from(!is_dared);
            }
        }
        assert_eq!(figures.switching.after[k], after);
    }
    assert_eq!(
        [
            figures.switching.switched,
            figures.switching.switched_undared
        ],
        switched
    );

    let dared: Vec<&&Round> = rounds.iter().filter(|round| round.dare.is_some()).collect();
    let as_dared = |round: &Round| round.dare.is_some() && round.dare == round.route;
    let dares = figures.dares;
    assert_eq!(dares.rounds, dared.len() as u64);
    assert_eq!(
        dares.won_as_dared,
        dared.iter().filter(|round| as_dared(round)).count() as u64
    );
    let won_at_all = dared.iter().filter(|round| round.route.is_some()).count() as u64;
    assert_eq!(dares.won_otherwise, won_at_all - dares.won_as_dared);
    let any = |what: &dyn Fn(&Round) -> bool| {
        let visits = told
            .iter()
            .filter(|(_, rounds)| rounds.iter().any(|round| what(round)));
        visits.count() as u64
    };
    assert_eq!(dares.visits, any(&|round| round.dare.is_some()));
    assert_eq!(dares.visits_as_dared, any(&as_dared));

    let mut best: BTreeMap<(String, Route), &Round> = BTreeMap::new();
    for (visit, rounds) in told {
        for round in won(rounds) {
            let key = (day(visit.began), round.route.unwrap());
            let known = best.entry(key).or_insert(round);
            if round.seconds < known.seconds {
                *known = round;
            }
        }
    }
    let expected: Vec<f64> = best
        .values()
        .map(|round| (1000.0 * f64::from(round.seconds)).round() / 1000.0)
        .collect();
    assert_eq!(
        figures
            .best
            .iter()
            .map(|best| best.seconds)
            .collect::<Vec<_>>(),
        expected
    );

    let endless = told
        .iter()
        .filter(|(visit, _)| visit.ended.is_none())
        .count() as u64;
    assert_eq!(figures.basis.visits_without_end, endless);
    let is_back = |(visit, rounds): &&Told| {
        let mut clock = vec![visit.began];
        clock.extend(rounds.iter().map(|round| round.began));
        !clock.is_sorted() || visit.ended.is_some_and(|ended| ended < visit.began)
    };
    assert_eq!(
        figures.basis.visits_with_clock_back,
        told.iter().filter(is_back).count() as u64
    );
}

/// Compares the figures with the stand's own summary of the day.
fn compare_with_stand(figures: &Figures, file: &Path) {
    let ever = Moment {
        utc_ms: 0,
        offset_s: 0,
    };
    let today = Logbook::read(file).unwrap().today(ever).unwrap();
    let total = &figures.total;
    assert_eq!(
        (today.visits, today.rounds),
        (total.visits, total.rounds.all)
    );
    let wins = total.rounds;
    assert_eq!(
        [today.squeezed, today.shaved, today.mixed],
        [wins.squeeze, wins.shave, wins.mix]
    );
    let median = today.median_to_first_win.map(f64::from);
    let off = median
        .zip(total.median_to_first_win)
        .map(|(a, b)| (a - b).abs());
    assert_eq!(median.is_some(), total.median_to_first_win.is_some());
    assert!(off.is_none_or(|off| off < 0.01), "{median:?}");
}

/// Distributes the rows to three files. Some rows are in several files, and the rounds of a visit may be in
/// different files.
fn shared_out(rows: &Rows, seed: u64) -> Vec<Rows> {
    let mut random = fastrand::Rng::with_seed(seed);
    let mut files = vec![Rows::default(); 3];
    for visit in &rows.visits {
        for file in &mut files {
            file.visits.push(visit.clone());
        }
        files[random.usize(..3)]
            .visits
            .retain(|kept| kept.id != visit.id || random.bool());
    }
    for round in &rows.rounds {
        let first = random.usize(..3);
        files[first].rounds.push(round.clone());
        let again = random.usize(..3);
        if again != first {
            files[again].rounds.push(round.clone());
        }
    }
    for event in &rows.events {
        files[0].events.push(event.clone());
        files[2].events.push(event.clone());
    }
    files
}

#[test]
fn figures_match_the_reference() {
    for (seed, visits) in [(1, 0), (2, 1), (3, 7), (4, 60), (5, 400)] {
        let rows = rows(seed, visits);
        let folder = tempfile::tempdir().unwrap();
        let one = logbooks(&folder.path().join("one"), std::slice::from_ref(&rows));
        let out = folder.path().join("report");
        let report = report_on(&one, &out, &all_files()).unwrap();
        compare(&report.figures, &told(&rows, [None, None]));
        compare_with_stand(&report.figures, &one[0]);
        let events: u64 = report.figures.events.iter().map(|event| event.count).sum();
        assert_eq!(events, rows.events.len() as u64);
        assert_eq!(report.figures.basis.repeated_rows, 0);
        let lines = |name: &str| {
            std::fs::read_to_string(out.join(name))
                .unwrap()
                .matches("\r\n")
                .count()
                - 1
        };
        let counts = [rows.visits.len(), rows.rounds.len(), rows.events.len()];
        assert_eq!(
            ["visits.csv", "rounds.csv", "events.csv"].map(lines),
            counts
        );

        let several = logbooks(&folder.path().join("several"), &shared_out(&rows, seed));
        let shared = report_on(&several, &out, &all_files()).unwrap().figures;
        compare(&shared, &told(&rows, [None, None]));
        let repeated = shared.basis.repeated_rows;
        assert_eq!(repeated > 0, visits > 0);
        // A file given twice only adds repeated rows.
        let twice = [&one[..], &one[..]].concat();
        let twice = report_on(&twice, &out, &all_files()).unwrap().figures;
        let rows_of_one = (rows.visits.len() + rows.rounds.len() + rows.events.len()) as u64;
        assert_eq!(twice.basis.repeated_rows, rows_of_one);
        compare(&twice, &told(&rows, [None, None]));
    }
}

#[test]
fn selected_days_are_in_the_local_time_of_the_stand() {
    let rows = rows(6, 300);
    let folder = tempfile::tempdir().unwrap();
    let files = logbooks(folder.path(), std::slice::from_ref(&rows));
    let (from, to) = ("2026-10-24", "2026-10-25");
    for (from, to) in [
        (Some(from), Some(to)),
        (Some(to), None),
        (None, Some(from)),
        (Some(from), Some(from)),
    ] {
        let options = Options {
            from: from.map(|day| day.parse().unwrap()),
            to: to.map(|day| day.parse().unwrap()),
            ..Options::default()
        };
        let report = report_on(&files, &folder.path().join("out"), &options).unwrap();
        let told = told(&rows, [from, to]);
        assert!(!told.is_empty() && told.len() < 300);
        compare(&report.figures, &told);
    }
}
