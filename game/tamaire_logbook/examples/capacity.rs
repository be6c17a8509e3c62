//! Measures the speed and the size of a logbook: `capacity [ROUNDS]`, by default with a million rounds.

use std::env;
use std::error::Error;
use std::time::Instant;
use tamaire_logbook::{Entry, Id, Logbook, Moment, Round, RoundEnd, Visit};
use tamaire_play::Route;

const ROUNDS_A_VISIT: u32 = 5;
const VISITS_A_DAY: i64 = 60;

fn main() -> Result<(), Box<dyn Error>> {
    let rounds: u32 = env::args()
        .nth(1)
        .map_or(Ok(1_000_000), |text| text.parse())?;
    let folder = tempfile::tempdir_in(".")?;
    let path = folder.path().join("logbook.sqlite");
    let (mut book, _) = Logbook::open(&path, "hall 2")?;

    // Writes each entry in a commit of its own, as a stand does.
    let single: Vec<Entry> = (0..40)
        .flat_map(|visit| entries(visit, Moment::now()))
        .collect();
    let start = Instant::now();
    single.iter().try_for_each(|entry| book.write(entry))?;
    let each = start.elapsed() / single.len() as u32;
    println!(
        "one entry per commit: {each:?}, {:.0} entries/s",
        1.0 / each.as_secs_f64()
    );

    let first = Moment::now();
    let start = Instant::now();
    let (before, mut written) = (book.bytes(), 0);
    for visit in 0..i64::from(rounds / ROUNDS_A_VISIT) {
        let began = first.after(visit * 86_400_000 / VISITS_A_DAY);
        let entries = entries(visit, began);
        written += entries.len();
        book.write_all(&entries)?;
    }
    let took = start.elapsed().as_secs_f64();
    println!(
        "one visit per commit: {:.0} entries/s",
        written as f64 / took
    );
    println!(
        "size of a round: {} bytes",
        (book.bytes() - before) / u64::from(rounds)
    );

    let last = first.after(i64::from(rounds / ROUNDS_A_VISIT) * 86_400_000 / VISITS_A_DAY);
    for (name, since) in [("the last day", last.after(-86_400_000)), ("all", first)] {
        let start = Instant::now();
        let today = book.today(since)?;
        println!(
            "today over {name}: {:?}, {} rounds",
            start.elapsed(),
            today.rounds
        );
        let start = Instant::now();
        let best = book.best(since, "classic", None, 5)?;
        println!(
            "best over {name}: {:?}, {} rounds",
            start.elapsed(),
            best.len()
        );
        let (mut seen, start) = (0, Instant::now());
        book.rounds(since.., |_| {
            seen += 1;
            Ok::<_, tamaire_logbook::Error>(())
        })?;
        println!("rounds over {name}: {:?}, {seen} rounds", start.elapsed());
    }
    drop(book);
    let start = Instant::now();
    let (mut book, _) = Logbook::open(&path, "hall 2")?;
    println!(
        "opening and checking: {:?}, {} bytes",
        start.elapsed(),
        book.bytes()
    );
    let start = Instant::now();
    book.export(&folder.path().join("copy"))?;
    println!("export: {:?}", start.elapsed());
    let start = Instant::now();
    book.delete_before(first.after(7 * 86_400_000))?;
    println!("forget a week: {:?}", start.elapsed());
    Ok(())
}

/// Returns the entries of a visit of five rounds, of which the last is won.
fn entries(visit: i64, began: Moment) -> Vec<Entry> {
    let visit = Visit {
        id: Id::random(),
        stand: "hall 2".into(),
        began,
        ended: None,
        language: ["de", "en", "ja"][(visit % 3) as usize].into(),
    };
    let round = |number| {
        let won = (number == ROUNDS_A_VISIT).then_some(Route::Squeeze);
        // The replay has a typical length for a round of half a minute.
        let replay = (0..1500).map(|_| fastrand::alphanumeric()).collect();
        Entry::Round(Round {
            id: Id::random(),
            visit: visit.id,
            stand: visit.stand.clone(),
            number,
            began: began.after(i64::from(number) * 60_000),
            seconds: 10.0 + 50.0 * fastrand::f32(),
            level: ["classic", "cat", "hoop"][fastrand::usize(..3)].into(),
            level_hash: 0xfeed_face,
            players: 1,
            end: won.map_or(RoundEnd::Retried, |_| RoundEnd::Won),
            route: won,
            kept: 1.0,
            inside: 0.9,
            pieces: 1,
            lost: 0,
            dare: None,
            replay,
        })
    };
    let id = visit.id;
    let mut entries: Vec<Entry> = (1..=ROUNDS_A_VISIT).map(round).collect();
    entries.insert(0, Entry::VisitBegan(visit));
    entries.push(Entry::VisitEnded {
        id,
        at: began.after(600_000),
        language: String::new(),
    });
    entries
}
