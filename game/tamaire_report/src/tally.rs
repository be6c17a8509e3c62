//! Counting of rows into figures. Of each round, only the values that the summary of its visit needs are
//! kept.

use crate::day::hour;
use crate::figures::{Best, Count, Figures, Hour, LevelFigures, Pieces, Totals, Wins};
use crate::figures::{DayTotals, StandTotals};
use crate::spread::{median, thousandth, times};
use crate::story::{RoundSummary, VisitSummary};
use crate::visits::{VisitEntry, Visits};
use crate::{Day, figures};
use std::collections::{BTreeMap, HashMap};
use tamaire_logbook::{Event, Round, RoundEnd};
use tamaire_play::Route;

/// Last index of [`Figures::rounds_per_visit`]. Visits with more rounds count at this index.
const MOST_ROUNDS: usize = 20;
/// Number of pieces above which [`Figures::pieces`] has one entry for all larger numbers.
const MOST_PIECES: u32 = 128;
/// Maximum length of a replay that is kept for a clip [bytes]. Replays of fast wins are shorter.
const LONG_REPLAY: usize = 1 << 16;

/// Key of a level: its name and its hash.
pub type LevelKey = (String, u64);

/// Counts of the rounds and events added so far.
#[derive(Debug)]
pub struct Tally {
    figures: Figures,
    plays: Vec<RoundSummary>,
    levels: HashMap<LevelKey, LevelTally>,
    best: BTreeMap<(Day, Route), (Best, String)>,
    ends: BTreeMap<&'static str, u64>,
    events: BTreeMap<String, u64>,
}

#[derive(Debug, Default)]
struct LevelTally {
    rounds: Wins,
    won_in: Vec<f32>,
}

/// Totals of several visits, and their times to the first win, from which the median is computed.
#[derive(Default)]
struct Sum {
    totals: Totals,
    to_first_win: Vec<f64>,
}

impl Tally {
    /// Returns a tally without counts.
    pub fn new() -> Self {
        let pieces = |k: u32| Pieces {
            from: if k == 0 { 1 } else { (1 << (k - 1)) + 1 },
            to: Some(1 << k),
            rounds: Wins::default(),
        };
        let last = Pieces {
            from: MOST_PIECES + 1,
            to: None,
            rounds: Wins::default(),
        };
        let bins = MOST_PIECES.ilog2();
        let ends = [
            RoundEnd::Won,
            RoundEnd::Retried,
            RoundEnd::Left,
            RoundEnd::Cut,
        ];
        Self {
            figures: Figures {
                format: figures::FORMAT,
                rules: tamaire_play::replay::VERSION,
                hours: vec![Hour::default(); 24],
                tries: vec![Wins::default(); 4],
                rounds_per_visit: vec![0; MOST_ROUNDS + 1],
                pieces: (0..=bins).map(pieces).chain([last]).collect(),
                ..Figures::default()
            },
            plays: Vec::new(),
            levels: HashMap::new(),
            best: BTreeMap::new(),
            ends: ends.map(|end| (end.text(), 0)).into(),
            events: BTreeMap::new(),
        }
    }

    /// Counts a round of `visit`, which has the index `place`. With `keeps_replays`, keeps the replay if the
    /// round is one of the best.
    pub fn round(
        &mut self,
        round: &Round,
        (place, visit): (u32, &VisitEntry),
        keeps_replays: bool,
    ) {
        let route = round.route;
        self.plays.push(RoundSummary {
            visit: place,
            number: round.number,
            began_ms: round.began.utc_ms,
            seconds: round.seconds,
            route,
            dare: round.dare,
        });
        let figures = &mut self.figures;
        figures.total.rounds.add(route);
        figures.hours[hour(round.began)].rounds += 1;
        figures.tries[(round.number.max(1) as usize - 1).min(3)].add(route);
        let is_in = |bin: &&mut Pieces| bin.to.is_none_or(|to| round.pieces <= to);
        let bin = figures.pieces.iter_mut().find(is_in);
        bin.expect("the last bin has no upper limit")
            .rounds
            .add(route);
        *self.ends.entry(round.end.text()).or_default() += 1;
        if let Some(dare) = round.dare {
            let dares = &mut figures.dares;
            dares.rounds += 1;
            dares.won_as_dared += u64::from(route == Some(dare));
            dares.won_otherwise += u64::from(route.is_some_and(|route| route != dare));
        }
        self.in_level(round);
        if let Some(route) = route {
            self.win(round, route, Day::of(visit.began), keeps_replays);
        }
    }

    /// Counts an event.
    pub fn event(&mut self, event: &Event) {
        match self.events.get_mut(event.kind.text()) {
            Some(count) => *count += 1,
            None => drop(self.events.insert(event.kind.text().into(), 1)),
        }
    }

    /// Returns the figures and the replays of [`Figures::best`]. Calls `each` with the summary of every
    /// counted visit.
    ///
    /// # Errors
    /// The first error of `each`.
    pub fn finish<E>(
        mut self,
        visits: &Visits,
        mut each: impl FnMut(&VisitEntry, &VisitSummary) -> Result<(), E>,
    ) -> Result<(Figures, Vec<String>), E> {
        self.plays.sort_by_key(|play| (play.visit, play.number));
        let plays = std::mem::take(&mut self.plays);
        let mut all = Sum::default();
        let mut stands: BTreeMap<&str, Sum> = BTreeMap::new();
        let mut days: BTreeMap<Day, Sum> = BTreeMap::new();
        let mut languages: BTreeMap<&str, u64> = BTreeMap::new();
        let mut rest = plays.as_slice();
        for (place, note) in visits.notes.iter().enumerate() {
            let of_it = rest.partition_point(|play| play.visit as usize <= place);
            let (of_it, others) = rest.split_at(of_it);
            rest = others;
            if !note.counts {
                continue;
            }
            let story = VisitSummary::of(of_it);
            self.tell(note, of_it, &story);
            all.add(of_it, &story);
            let stand = stands.entry(visits.stands.text(note.stand)).or_default();
            stand.add(of_it, &story);
            let day = days.entry(Day::of(note.began)).or_default();
            day.add(of_it, &story);
            let language = visits.languages.text(note.language);
            *languages.entry(language).or_default() += 1;
            each(note, &story)?;
        }
        let mut figures = self.figures;
        figures.to_first_win = times(all.to_first_win.clone());
        figures.total = all.done();
        figures.first_day = days.keys().next().copied();
        figures.last_day = days.keys().last().copied();
        let of_stand = |(stand, sum): (&str, Sum)| StandTotals {
            stand: stand.into(),
            totals: sum.done(),
        };
        figures.stands = stands.into_iter().map(of_stand).collect();
        let of_day = |(day, sum): (Day, Sum)| DayTotals {
            day,
            totals: sum.done(),
        };
        figures.days = days.into_iter().map(of_day).collect();
        figures.languages = counts(languages);
        figures.ends = counts(self.ends);
        figures.events = counts(self.events);
        figures.levels = self.levels.into_iter().map(LevelTally::done).collect();
        let order = |a: &LevelFigures, b: &LevelFigures| {
            let by_rounds = b.rounds.all.cmp(&a.rounds.all);
            let by_name = || (&a.level, &a.level_hash).cmp(&(&b.level, &b.level_hash));
            by_rounds.then_with(by_name)
        };
        figures.levels.sort_by(order);
        let (best, replays) = self.best.into_values().unzip();
        figures.best = best;
        Ok((figures, replays))
    }

    fn in_level(&mut self, round: &Round) {
        let key = (round.level.clone(), round.level_hash);
        let level = self.levels.entry(key).or_default();
        level.rounds.add(round.route);
        if round.route.is_some() {
            level.won_in.push(round.seconds);
        }
    }

    fn win(&mut self, round: &Round, route: Route, day: Day, keeps_replays: bool) {
        let seconds = thousandth(f64::from(round.seconds));
        let known = self.best.get(&(day, route));
        let is_better = known.is_none_or(|(best, _)| {
            (seconds, round.id) < (best.seconds, best.round) && !best.seconds.is_nan()
        });
        if !is_better {
            return;
        }
        let best = Best {
            day,
            route,
            seconds,
            round: round.id,
            level: round.level.clone(),
            level_hash: format!("{:016x}", round.level_hash),
            stand: round.stand.clone(),
        };
        let keeps = keeps_replays && round.replay.len() <= LONG_REPLAY;
        let replay = if keeps {
            round.replay.clone()
        } else {
            String::new()
        };
        self.best.insert((day, route), (best, replay));
    }

    /// Adds a visit to the figures that depend on all of its rounds.
    fn tell(&mut self, note: &VisitEntry, plays: &[RoundSummary], story: &VisitSummary) {
        let figures = &mut self.figures;
        figures.hours[hour(note.began)].visits += 1;
        figures.rounds_per_visit[plays.len().min(MOST_ROUNDS)] += 1;
        figures.basis.visits_without_end += u64::from(note.ended.is_none());
        let early = plays.first();
        let is_back = story.is_clock_back
            || note.ended.is_some_and(|ended| ended < note.began)
            || early.is_some_and(|play| play.began_ms < note.began.utc_ms);
        figures.basis.visits_with_clock_back += u64::from(is_back);
        figures.dares.visits += u64::from(story.is_dared);
        figures.dares.visits_as_dared += u64::from(story.is_won_as_dared);
        if let Some(first) = story.first {
            figures.switching.after[first as usize].add(story.next);
        }
        if story.is_switched() {
            figures.switching.switched += 1;
            figures.switching.switched_undared += u64::from(!story.is_next_dared);
        }
    }
}

impl LevelTally {
    fn done(((level, hash), tally): (LevelKey, Self)) -> LevelFigures {
        let won_in = tally.won_in.iter().copied().map(f64::from);
        LevelFigures {
            level,
            level_hash: format!("{hash:016x}"),
            rounds: tally.rounds,
            tries_per_win: tally.rounds.tries_per_win(),
            median_win: median(won_in.collect()),
            hands: None,
        }
    }
}

impl Sum {
    fn add(&mut self, plays: &[RoundSummary], story: &VisitSummary) {
        let totals = &mut self.totals;
        totals.visits += 1;
        totals.visits_played += u64::from(!plays.is_empty());
        totals.visits_won += u64::from(story.wins > 0);
        for play in plays {
            totals.rounds.add(play.route);
        }
        self.to_first_win.extend(story.to_first_win);
    }

    fn done(self) -> Totals {
        let Totals {
            visits, visits_won, ..
        } = self.totals;
        Totals {
            share_won: (visits > 0).then(|| visits_won as f64 / visits as f64),
            median_to_first_win: median(self.to_first_win),
            ..self.totals
        }
    }
}

/// Returns the counts, largest first.
fn counts(of: BTreeMap<impl Into<String>, u64>) -> Vec<Count> {
    let named = |(name, count): (_, u64)| Count {
        name: Into::into(name),
        count,
    };
    let mut all: Vec<Count> = of.into_iter().map(named).collect();
    all.sort_by_key(|count| std::cmp::Reverse(count.count));
    all
}
