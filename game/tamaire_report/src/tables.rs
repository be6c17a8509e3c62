//! CSV tables for analysis. `docs/report.md` describes their columns.

use crate::Error;
use crate::csv::{CsvRow, MARK};
use crate::drafts::{Draft, Drafts};
use crate::spread::thousandth;
use crate::story::VisitSummary;
use crate::visits::{VisitEntry, Visits};
use tamaire_logbook::row::route_text;
use tamaire_logbook::{Event, Round};
use tamaire_play::Route;

const VISITS: [&str; 12] = [
    "id",
    "stand",
    "began",
    "ended",
    "began_utc_ms",
    "ended_utc_ms",
    "language",
    "rounds",
    "wins",
    "first_route",
    "seconds_to_first_win",
    "next_route",
];
const ROUNDS: [&str; 18] = [
    "id",
    "visit",
    "stand",
    "number",
    "began",
    "began_utc_ms",
    "seconds",
    "level",
    "level_hash",
    "players",
    "end",
    "route",
    "kept",
    "inside",
    "pieces",
    "lost",
    "dare",
    "has_replay",
];
const EVENTS: [&str; 6] = ["id", "stand", "at", "at_utc_ms", "kind", "text"];

/// The files `visits.csv`, `rounds.csv` and `events.csv` while they are written.
#[derive(Debug)]
pub struct Tables {
    visits: Draft,
    rounds: Draft,
    events: Draft,
}

impl Tables {
    /// Starts the tables with their header rows.
    ///
    /// # Errors
    /// [`Error::Unwritable`].
    pub fn begin(drafts: &Drafts) -> Result<Self, Error> {
        let begin = |name: &str, columns: &[&str]| {
            let mut draft = drafts.begin(name)?;
            draft.write(MARK.as_bytes())?;
            draft.write(CsvRow::names(columns).bytes())?;
            Ok::<_, Error>(draft)
        };
        Ok(Self {
            visits: begin("visits.csv", &VISITS)?,
            rounds: begin("rounds.csv", &ROUNDS)?,
            events: begin("events.csv", &EVENTS)?,
        })
    }

    /// Writes a visit.
    ///
    /// # Errors
    /// [`Error::Unwritable`].
    pub fn visit(
        &mut self,
        visits: &Visits,
        note: &VisitEntry,
        story: &VisitSummary,
    ) -> Result<(), Error> {
        let row = CsvRow::default()
            .value(note.id)
            .text(visits.stands.text(note.stand));
        let row = row.value(note.began).maybe(note.ended);
        let row = row
            .value(note.began.utc_ms)
            .maybe(note.ended.map(|ended| ended.utc_ms));
        let row = row.text(visits.languages.text(note.language));
        let row = row
            .value(story.rounds)
            .value(story.wins)
            .maybe(text_of(story.first));
        let row = row
            .maybe(story.to_first_win.map(thousandth))
            .maybe(text_of(story.next));
        self.visits.write(row.end().bytes())
    }

    /// Writes a round.
    ///
    /// # Errors
    /// [`Error::Unwritable`].
    pub fn round(&mut self, round: &Round) -> Result<(), Error> {
        let row = CsvRow::default()
            .value(round.id)
            .value(round.visit)
            .text(&round.stand);
        let row = row
            .value(round.number)
            .value(round.began)
            .value(round.began.utc_ms);
        let row = row
            .value(thousandth(f64::from(round.seconds)))
            .text(&round.level);
        let row = row
            .value(format_args!("{:016x}", round.level_hash))
            .value(round.players);
        let row = row.value(round.end.text()).maybe(text_of(round.route));
        let row = row
            .value(round.kept)
            .value(round.inside)
            .value(round.pieces)
            .value(round.lost);
        let row = row
            .maybe(text_of(round.dare))
            .value(u8::from(!round.replay.is_empty()));
        self.rounds.write(row.end().bytes())
    }

    /// Writes an event.
    ///
    /// # Errors
    /// [`Error::Unwritable`].
    pub fn event(&mut self, event: &Event) -> Result<(), Error> {
        let row = CsvRow::default().value(event.id).text(&event.stand);
        let row = row.value(event.at).value(event.at.utc_ms);
        let row = row.text(event.kind.text()).text(&event.text);
        self.events.write(row.end().bytes())
    }

    /// Adds the complete tables to `drafts`.
    ///
    /// # Errors
    /// [`Error::Unwritable`].
    pub fn finish(self, drafts: &mut Drafts) -> Result<(), Error> {
        [self.visits, self.rounds, self.events]
            .into_iter()
            .try_for_each(|draft| drafts.add(draft))
    }
}

fn text_of(route: Option<Route>) -> Option<&'static str> {
    route.map(route_text)
}
