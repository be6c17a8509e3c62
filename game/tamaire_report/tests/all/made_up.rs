//! Synthetic rows of several days at two stands.

use fastrand::Rng;
use std::path::Path;
use tamaire_logbook::{Entry, Event, Id, Kind, Logbook, Moment, Round, RoundEnd, Visit};
use tamaire_play::Route;

/// The rows of a logbook.
#[derive(Clone, Debug, Default)]
pub struct Rows {
    pub visits: Vec<Visit>,
    pub rounds: Vec<Round>,
    pub events: Vec<Event>,
}

/// Writes rows as a stand would.
pub fn write(path: &Path, rows: &Rows) {
    let (mut book, set_aside) = Logbook::open(path, "a stand").unwrap();
    assert_eq!(set_aside, None);
    let visits = rows.visits.iter().cloned().map(Entry::VisitBegan);
    let rounds = rows.rounds.iter().cloned().map(Entry::Round);
    let events = rows.events.iter().cloned().map(Entry::Event);
    let all: Vec<Entry> = visits.chain(rounds).chain(events).collect();
    book.write_all(&all).unwrap();
}

/// Returns rows of four days around the end of daylight saving time 2026 in central Europe. One stand is
/// there, the other in Japan.
pub fn rows(seed: u64, visits: usize) -> Rows {
    let mut random = Rng::with_seed(seed);
    let mut rows = Rows::default();
    // 2026-10-23 20:00 UTC [ms since 1970].
    let first = 1_792_785_600_000;
    for _ in 0..visits {
        let is_japan = random.bool();
        let began = moment(&mut random, first, is_japan);
        let visit = Visit {
            id: Id(random.u128(..)),
            stand: if is_japan {
                "名古屋"
            } else {
                "Berlin, \"left\""
            }
            .into(),
            began,
            ended: None,
            language: ["en", "ja", "de"][random.usize(..3)].into(),
        };
        let mut clock = began;
        let mut dare = None;
        for number in 1..=rounds_of(&mut random) {
            let round = round(&mut random, &visit, number, clock, dare);
            let back = if random.u8(..20) == 0 { -7_200_000 } else { 0 };
            clock = clock.after(1000 * round.seconds as i64 + back + random.i64(0..9000));
            clock.offset_s = offset_at(clock.utc_ms, is_japan);
            dare = match round.route {
                Some(Route::Squeeze) => Some(Route::Shave),
                Some(_) => Some(Route::Squeeze),
                None => dare.filter(|_| random.bool()),
            };
            rows.rounds.push(round);
        }
        let is_over = random.u8(..10) > 0;
        let ended = is_over.then_some(clock);
        rows.visits.push(Visit { ended, ..visit });
    }
    for _ in 0..visits / 10 {
        let at = moment(&mut random, first, false);
        rows.events.push(Event {
            id: Id(random.u128(..)),
            stand: "Berlin".into(),
            at,
            kind: [Kind::Began, Kind::Crashed, Kind::Other("<b>odd</b>".into())][random.usize(..3)]
                .clone(),
            text: "=cmd()".into(),
        });
    }
    rows
}

/// Returns a number of rounds: mostly few, sometimes none, sometimes many.
fn rounds_of(random: &mut Rng) -> u32 {
    match random.u8(..20) {
        0 => 0,
        1 => random.u32(15..40),
        _ => random.u32(1..6),
    }
}

fn moment(random: &mut Rng, first: i64, is_japan: bool) -> Moment {
    let utc_ms = first + random.i64(0..4 * 86_400_000);
    let offset_s = offset_at(utc_ms, is_japan);
    Moment { utc_ms, offset_s }
}

/// Daylight saving time in Berlin ends on 2026-10-25 at 1:00 UTC.
fn offset_at(utc_ms: i64, is_japan: bool) -> i32 {
    match is_japan {
        true => 9 * 3600,
        false if utc_ms < 1_792_890_000_000 => 2 * 3600,
        false => 3600,
    }
}

fn round(
    random: &mut Rng,
    visit: &Visit,
    number: u32,
    began: Moment,
    dare: Option<Route>,
) -> Round {
    let route = [
        Some(Route::Squeeze),
        Some(Route::Shave),
        Some(Route::Mix),
        None,
        None,
        None,
    ][random.usize(..6)];
    let ends = [RoundEnd::Retried, RoundEnd::Left, RoundEnd::Cut];
    let most_pieces = 1 << random.u32(..10);
    Round {
        id: Id(random.u128(..)),
        visit: visit.id,
        stand: visit.stand.clone(),
        number,
        began,
        seconds: 0.0167 * random.u32(30..9000) as f32,
        level: ["classic", "hoop", "my <level>"][random.usize(..3)].into(),
        level_hash: random.u64(..3) << 62,
        players: random.u8(1..3),
        end: if route.is_some() {
            RoundEnd::Won
        } else {
            ends[random.usize(..3)]
        },
        route,
        kept: random.f32(),
        inside: random.f32(),
        pieces: 1 + random.u32(..most_pieces),
        lost: 0,
        dare,
        replay: String::new(),
    }
}
