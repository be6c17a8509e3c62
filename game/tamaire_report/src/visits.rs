//! The visits that were met, each once, whichever files it stands in.

use crate::{Day, Options};
use std::collections::HashMap;
use tamaire_logbook::{Id, Moment, Round, Visit};

/// What is kept of a visit while rounds are counted.
#[derive(Clone, Debug, PartialEq)]
pub struct Note {
    /// By what it is known.
    pub id: Id,
    /// The number of its stand.
    pub stand: u32,
    /// The number of its language.
    pub language: u32,
    /// When it began.
    pub began: Moment,
    /// When it ended, if that is known.
    pub ended: Option<Moment>,
    /// Whether it is of the days that were asked for.
    pub counts: bool,
}

/// The visits that were met.
#[derive(Debug, Default)]
pub struct Visits {
    /// In the order in which they were met.
    pub notes: Vec<Note>,
    /// The names of stands, by number.
    pub stands: Names,
    /// Languages, by number.
    pub languages: Names,
    /// Rows that were met before.
    pub repeated: u64,
    places: HashMap<Id, u32>,
    from: Option<Day>,
    to: Option<Day>,
}

/// Texts by number.
#[derive(Debug, Default)]
pub struct Names {
    texts: Vec<String>,
    numbers: HashMap<String, u32>,
}

impl Visits {
    /// Of the days that options ask for.
    pub fn new(options: &Options) -> Self {
        Self {
            from: options.from,
            to: options.to,
            ..Self::default()
        }
    }

    /// Takes a row. Of one that stands in several files the first counts, but for one without a language: that was brought
    /// along by a round, and another tells when it began. How it ended is taken from whichever tells it first.
    pub fn add(&mut self, visit: &Visit) {
        let language = self.languages.number(&visit.language);
        let Some(&place) = self.places.get(&visit.id) else {
            self.insert(visit.id, &visit.stand, visit.began, visit.ended, language);
            return;
        };
        self.repeated += 1;
        let counts = self.is_asked(visit.began);
        let stand = self.stands.number(&visit.stand);
        let note = &mut self.notes[place as usize];
        note.ended = note.ended.or(visit.ended);
        if self.languages.text(note.language).is_empty() && !visit.language.is_empty() {
            (note.language, note.stand) = (language, stand);
            (note.began, note.counts) = (visit.began, counts);
        }
    }

    /// Where the visit of a round stands among those met, if it counts. One without a row began with the first of its rounds
    /// that is met.
    pub fn of(&mut self, round: &Round) -> Option<u32> {
        let place = match self.places.get(&round.visit) {
            Some(&place) => place,
            None => {
                let language = self.languages.number("");
                self.insert(round.visit, &round.stand, round.began, None, language)
            }
        };
        self.notes[place as usize].counts.then_some(place)
    }

    /// Whether a moment is of the days that were asked for.
    pub fn is_asked(&self, moment: Moment) -> bool {
        let day = Day::of(moment);
        self.from.is_none_or(|from| from <= day) && self.to.is_none_or(|to| day <= to)
    }

    fn insert(
        &mut self,
        id: Id,
        stand: &str,
        began: Moment,
        ended: Option<Moment>,
        language: u32,
    ) -> u32 {
        let place = self.notes.len() as u32;
        self.places.insert(id, place);
        let counts = self.is_asked(began);
        let stand = self.stands.number(stand);
        self.notes.push(Note {
            id,
            stand,
            language,
            began,
            ended,
            counts,
        });
        place
    }
}

impl Names {
    /// The number of a text.
    pub fn number(&mut self, text: &str) -> u32 {
        if let Some(&number) = self.numbers.get(text) {
            return number;
        }
        let number = self.texts.len() as u32;
        self.texts.push(text.into());
        self.numbers.insert(text.into(), number);
        number
    }

    /// The text of a number that [`Names::number`] gave.
    pub fn text(&self, number: u32) -> &str {
        &self.texts[number as usize]
    }
}
