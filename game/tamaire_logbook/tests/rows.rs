//! Rows are read once each, in the order in which they were written, even if the clock was changed.

mod common;

use common::{
    All, DAY, MINUTE, MORNING, STAND, all, entries, event, long_replay, open, place, round, visit,
};
use std::ops::Bound;
use std::thread;
use tamaire_logbook::row::MAX_TEXT_BYTES;
use tamaire_logbook::{Entry, Error, Kind, Logbook, Moment, RoundEnd, Today};
use tamaire_play::Route;

#[test]
fn written_entries_are_read_back() {
    let (_folder, path) = place();
    let mut book = open(&path);
    let mut came = visit(MORNING);
    let mut first = round(&came, 1, None);
    first.replay = long_replay();
    first.end = RoundEnd::Cut;
    let mut second = round(&came, 2, Some(Route::Mix));
    second.replay.clear();
    let odd = event(MORNING, Kind::Other("weather".into()));
    let at = MORNING.after(9 * MINUTE);
    let told = [
        Entry::VisitBegan(came.clone()),
        Entry::Round(first.clone()),
        Entry::Event(odd.clone()),
        Entry::Round(second.clone()),
        Entry::VisitEnded {
            id: came.id,
            at,
            language: "pt".into(),
        },
    ];
    for entry in &told {
        book.write(entry).unwrap();
        let text = serde_json::to_string(entry).unwrap();
        assert_eq!(serde_json::from_str::<Entry>(&text).unwrap(), *entry);
    }
    came.ended = Some(at);
    came.language = "pt".into();
    let expected = All {
        visits: vec![came],
        rounds: vec![first, second],
        events: vec![odd],
    };
    assert_eq!(all(&book).unwrap(), expected);
    assert_eq!(all(&book).unwrap().visits[0].began.offset_s, 3600);
    assert!(book.bytes() > 4096);
    drop(book);
    assert_eq!(all(&open(&path)).unwrap(), expected);
    let book = Logbook::read(&path).unwrap();
    assert_eq!(all(&book).unwrap(), expected);
    assert_eq!(book.stand().unwrap(), STAND);
}

#[test]
fn write_adapts_values_that_databases_reject() {
    let (_folder, path) = place();
    let mut book = open(&path);
    let mut odd = event(MORNING, Kind::Other("a\0b".into()));
    odd.text = "ふわ\0".repeat(MAX_TEXT_BYTES);
    book.write(&Entry::Event(odd)).unwrap();
    let mut far = round(&visit(MORNING.after(i64::MAX)), u32::MAX, None);
    far.seconds = f32::NAN;
    far.kept = f32::INFINITY;
    far.level_hash = u64::MAX;
    far.replay = "r".repeat(tamaire_play::replay::MAX_BYTES + 1);
    book.write(&Entry::Round(far)).unwrap();
    let kept = all(&book).unwrap();
    assert_eq!(kept.events[0].kind, Kind::Other("ab".into()));
    let text = &kept.events[0].text;
    assert!(text.starts_with("ふわふわ") && text.len() <= MAX_TEXT_BYTES);
    let round = &kept.rounds[0];
    assert_eq!(
        (round.seconds, round.kept, round.number),
        (0.0, f32::INFINITY, u32::MAX)
    );
    assert_eq!((round.level_hash, round.replay.as_str()), (u64::MAX, ""));
}

/// Writing shuffled entries, some of them several times, gives the same rows as writing each entry once.
#[test]
fn writing_an_entry_again_has_no_effect() {
    let mut random = fastrand::Rng::with_seed(7);
    for _ in 0..10 {
        let mut told = entries(MORNING);
        told.extend(entries(MORNING.after(-DAY)));
        told.push(Entry::Event(event(MORNING, Kind::Began)));
        random.shuffle(&mut told);
        let (_once, path) = place();
        let mut once = open(&path);
        once.write_all(&told).unwrap();
        let (_often, path) = place();
        let mut often = open(&path);
        for end in 1..=told.len() {
            let begin = random.usize(..end);
            often.write_all(&told[begin..end]).unwrap();
            often.write_all(&told[end - 1..end]).unwrap();
        }
        let kept = all(&once).unwrap();
        assert_eq!(kept, all(&often).unwrap());
        assert_eq!((kept.visits.len(), kept.rounds.len()), (2, 6));
        // The first entry of a visit that is written creates the visit, whatever its kind. The entry for the
        // beginning of the visit then fills in the missing values.
        let mut found = kept.visits.clone();
        found.sort_by_key(|visit| visit.began);
        assert_eq!(
            (found[0].began, found[1].began),
            (MORNING.after(-DAY), MORNING)
        );
        assert!(
            found
                .iter()
                .all(|visit| visit.ended.is_some() && visit.language == "de")
        );
    }
}

#[test]
fn rows_keep_their_order_when_the_clock_is_changed() {
    let (_folder, path) = place();
    let mut book = open(&path);
    let hours = [0, 1, 25, 2, -24, -23, 24 * 365, 3, -24 * 365 * 60];
    let moments = hours.map(|hour| MORNING.after(hour * 60 * MINUTE));
    let mut told = Vec::new();
    for moment in moments {
        told.push(event(moment, Kind::ClockChanged));
        book.write(&Entry::Event(told[told.len() - 1].clone()))
            .unwrap();
        book.write_all(&entries(moment)).unwrap();
    }
    let kept = all(&book).unwrap();
    assert_eq!(kept.events, told, "in the order of writing");
    let began = kept.visits.iter().map(|visit| visit.began);
    assert_eq!(began.collect::<Vec<_>>(), moments);
    assert_eq!(kept.rounds.len(), 3 * moments.len());
    // A visit that ends before it begins is kept.
    let visit = visit(MORNING);
    let id = visit.id;
    let at = MORNING.after(-DAY);
    let language = String::new();
    book.write_all(&[
        Entry::VisitBegan(visit),
        Entry::VisitEnded { id, at, language },
    ])
    .unwrap();
    assert_eq!(all(&book).unwrap().visits.last().unwrap().ended, Some(at));
}

#[test]
fn range_selects_by_time_and_orders_by_sequence() {
    let (_folder, path) = place();
    let mut book = open(&path);
    let minutes = [0, 5, 3, 9, 1];
    for minute in minutes {
        let at = MORNING.after(minute * MINUTE);
        book.write(&Entry::Event(event(at, Kind::Began))).unwrap();
    }
    let at = |minute: i64| MORNING.after(minute * MINUTE);
    let read = |from: Bound<i64>, to: Bound<i64>| {
        let mut found = Vec::new();
        let range = (from.map(at), to.map(at));
        book.events(range, |event| {
            found.push((event.at.utc_ms - MORNING.utc_ms) / MINUTE);
            Ok::<(), Error>(())
        })
        .unwrap();
        found
    };
    use Bound::{Excluded, Included, Unbounded};
    assert_eq!(read(Unbounded, Unbounded), minutes);
    assert_eq!(read(Included(1), Excluded(5)), [3, 1]);
    assert_eq!(read(Included(1), Included(5)), [5, 3, 1]);
    assert_eq!(read(Excluded(1), Unbounded), [5, 3, 9]);
    assert_eq!(read(Included(10), Unbounded), [0; 0]);
    assert_eq!(read(Included(5), Excluded(1)), [0; 0]);
}

#[test]
fn error_of_the_callback_stops_the_iteration() {
    let (_folder, path) = place();
    let mut book = open(&path);
    book.write_all(&entries(MORNING)).unwrap();
    #[derive(Debug)]
    struct Enough(String);
    impl From<Error> for Enough {
        fn from(error: Error) -> Self {
            Self(error.to_string())
        }
    }
    let mut seen = 0;
    let result = book.rounds(.., |_| {
        seen += 1;
        Err(Enough("one is enough".into()))
    });
    assert_eq!((seen, result.unwrap_err().0.as_str()), (1, "one is enough"));
}

#[test]
fn today_sums_up_a_day() {
    let (_folder, path) = place();
    let mut book = open(&path);
    assert_eq!(book.today(MORNING).unwrap(), Today::default());
    book.write_all(&entries(MORNING.after(-DAY))).unwrap();
    // Times to the first win: 11, 11 + 12, 11 + 12 + 13 s, so the median is 23 s. Later wins and visits
    // without a win do not count.
    let routes = [Route::Squeeze, Route::Shave, Route::Mix];
    for (place, route) in routes.into_iter().enumerate() {
        let visit = visit(MORNING.after(place as i64 * MINUTE));
        book.write(&Entry::VisitBegan(visit.clone())).unwrap();
        for number in 1..=place as u32 {
            book.write(&Entry::Round(round(&visit, number, None)))
                .unwrap();
        }
        for number in 0..2 {
            let won = round(&visit, place as u32 + 1 + number, Some(route));
            book.write(&Entry::Round(won)).unwrap();
        }
    }
    let left = visit(MORNING);
    let mut round = round(&left, 1, None);
    round.end = RoundEnd::Left;
    book.write(&Entry::Round(round)).unwrap();
    let expected = Today {
        visits: 4,
        rounds: 10,
        wins: 6,
        squeezed: 2,
        shaved: 2,
        mixed: 2,
        retries: 3,
        median_to_first_win: Some(23.0),
    };
    assert_eq!(book.today(MORNING).unwrap(), expected);
}

#[test]
fn best_returns_the_fastest_rounds_with_a_replay() {
    let (_folder, path) = place();
    let mut book = open(&path);
    let visit = visit(MORNING);
    let won = |number, seconds| {
        let mut round = round(&visit, number, Some(Route::Shave));
        round.seconds = seconds;
        round
    };
    let mut silent = won(1, 1.0);
    silent.replay.clear();
    let mut other = won(2, 2.0);
    other.level = "cat".into();
    let mut easier = won(3, 3.0);
    easier.level_hash = 3;
    let mut retried = won(4, 4.0);
    (retried.end, retried.route) = (RoundEnd::Retried, None);
    let mut old = won(5, 5.0);
    old.began = MORNING.after(-DAY);
    let (fast, faster) = (won(6, 7.0), won(7, 6.0));
    for round in [&silent, &other, &easier, &retried, &old, &fast, &faster] {
        book.write(&Entry::Round(round.clone())).unwrap();
    }
    let best = |since: Moment, hash, most| book.best(since, "classic", hash, most).unwrap();
    assert_eq!(
        best(MORNING, None, 9),
        [easier.clone(), faster.clone(), fast.clone()]
    );
    assert_eq!(best(MORNING, Some(fast.level_hash), 1), [faster]);
    assert_eq!(best(MORNING.after(-DAY), None, 2), [easier, old]);
    assert_eq!(best(MORNING, None, 0), []);
}

#[test]
fn delete_before_removes_old_rows() {
    let (_folder, path) = place();
    let mut book = open(&path);
    for day in 0..5 {
        let began = MORNING.after(day * DAY);
        book.write_all(&entries(began)).unwrap();
        book.write(&Entry::Event(event(began, Kind::Began)))
            .unwrap();
    }
    // A visit that began before the time limit, with a round after it.
    let long = visit(MORNING);
    let mut late = round(&long, 1, None);
    late.began = MORNING.after(3 * DAY);
    book.write_all(&[Entry::VisitBegan(long.clone()), Entry::Round(late)])
        .unwrap();
    let cut = MORNING.after(2 * DAY);
    book.delete_before(cut).unwrap();
    let kept = all(&book).unwrap();
    assert!(kept.rounds.iter().all(|round| round.began >= cut));
    assert!(kept.events.iter().all(|event| event.at >= cut));
    let counts = (kept.visits.len(), kept.rounds.len(), kept.events.len());
    assert_eq!(counts, (4, 10, 3));
    assert!(kept.visits.contains(&long));
    book.delete_before(MORNING.after(9 * DAY)).unwrap();
    assert_eq!(all(&book).unwrap(), All::default());
    // New rows can be written after a deletion.
    book.write_all(&entries(MORNING)).unwrap();
    assert_eq!(all(&book).unwrap().rounds.len(), 3);
}

#[test]
fn readers_and_writers_do_not_block_each_other() {
    let (_folder, path) = place();
    let mut book = open(&path);
    book.write_all(&entries(MORNING)).unwrap();
    let reader = {
        let path = path.clone();
        thread::spawn(move || {
            let book = Logbook::read(&path).unwrap();
            let mut before = 0;
            for _ in 0..100 {
                let kept = all(&book).unwrap();
                assert!(kept.rounds.len() >= before && kept.rounds.len().is_multiple_of(3));
                before = kept.rounds.len();
            }
            before
        })
    };
    for minute in 0..100 {
        book.write_all(&entries(MORNING.after(minute * MINUTE)))
            .unwrap();
    }
    assert!(reader.join().unwrap() >= 3);
    // Writing works while a reader iterates over rows.
    let reader = Logbook::read(&path).unwrap();
    let mut seen = 0;
    reader
        .rounds(.., |_| {
            seen += 1;
            book.write_all(&entries(MORNING))
        })
        .unwrap();
    assert_eq!(seen, 303, "the rows present when the iteration began");
    assert_eq!(all(&reader).unwrap().rounds.len(), 303 + 3 * 303);
}

#[test]
fn export_writes_a_single_file() {
    let (folder, path) = place();
    let mut book = open(&path);
    book.write_all(&entries(MORNING)).unwrap();
    let expected = all(&book).unwrap();
    for (name, book) in [("one", &book), ("two", &Logbook::read(&path).unwrap())] {
        let copy = folder.path().join(name);
        book.export(&copy).unwrap();
        assert_eq!(all(&Logbook::read(&copy).unwrap()).unwrap(), expected);
        let again = book.export(&copy).unwrap_err().to_string();
        assert!(again.contains(name) && again.contains("exists"), "{again}");
        let taken = open(&copy);
        assert_eq!(all(&taken).unwrap(), expected);
    }
    let names = std::fs::read_dir(folder.path()).unwrap();
    let names = names.map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let mut names: Vec<_> = names.collect();
    names.sort();
    assert_eq!(names, ["kept", "one", "two"]);
    let nowhere = book.export(&folder.path().join("no/where")).unwrap_err();
    assert!(nowhere.to_string().contains("where"), "{nowhere}");
}
