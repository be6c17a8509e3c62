//! Visits of all logbooks. Each visit counts once, even if several files contain it.

use crate::{Day, Options};
use std::collections::HashMap;
use tamaire_logbook::{Id, Moment, Round, Visit};

/// Values of a visit that are kept in memory while rounds are counted.
#[derive(Clone, Debug, PartialEq)]
pub struct VisitEntry {
    /// Id of the visit.
    pub id: Id,
    /// Number of the stand in [`Visits::stands`].
    pub stand: u32,
    /// Number of the language in [`Visits::languages`].
    pub language: u32,
    /// Time at which the visit began.
    pub began: Moment,
    /// Time at which the visit ended, if known.
    pub ended: Option<Moment>,
    /// Whether the visit began on one of the selected days.
    pub counts: bool,
}

/// All visits read.
#[derive(Debug, Default)]
pub struct Visits {
    /// Visits in the order of reading.
    pub notes: Vec<VisitEntry>,
    /// Names of stands by number.
    pub stands: Names,
    /// Languages by number.
    pub languages: Names,
    /// Number of rows of visits that had been read already.
    pub repeated: u64,
    places: HashMap<Id, u32>,
    from: Option<Day>,
    to: Option<Day>,
}

/// Interned texts.
#[derive(Debug, Default)]
pub struct Names {
    texts: Vec<String>,
    numbers: HashMap<String, u32>,
}

impl Visits {
    /// Returns an empty set with the selected days of the options.
    pub fn new(options: &Options) -> Self {
        Self {
            from: options.from,
            to: options.to,
            ..Self::default()
        }
    }

    /// Adds a row of a visit. If several rows have the same id, the first one counts, with the end from the
    /// first row that has one. A row with an empty language was created by a round. The next row of the visit
    /// with a language replaces its values.
    pub fn add(&mut self, visit: &Visit) {
        let language = self.languages.number(&visit.language);
        let Some(&place) = self.places.get(&visit.id) else {
            self.insert(visit.id, &visit.stand, visit.began, visit.ended, language);
            return;
        };
        self.repeated += 1;
        let counts = self.is_selected(visit.began);
        let stand = self.stands.number(&visit.stand);
        let note = &mut self.notes[place as usize];
        note.ended = note.ended.or(visit.ended);
        if self.languages.text(note.language).is_empty() && !visit.language.is_empty() {
            (note.language, note.stand) = (language, stand);
            (note.began, note.counts) = (visit.began, counts);
        }
    }

    /// Returns the index of a round's visit; `None` if the visit began on no selected day. If no row of the
    /// visit was read, the visit is created and begins with this round.
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

    /// Returns whether a moment is on one of the selected days.
    pub fn is_selected(&self, moment: Moment) -> bool {
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
        let counts = self.is_selected(began);
        let stand = self.stands.number(stand);
        self.notes.push(VisitEntry {
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
    /// Returns the number of a text; adds the text if it is new.
    pub fn number(&mut self, text: &str) -> u32 {
        if let Some(&number) = self.numbers.get(text) {
            return number;
        }
        let number = self.texts.len() as u32;
        self.texts.push(text.into());
        self.numbers.insert(text.into(), number);
        number
    }

    /// Returns the text to which [`Names::number`] gave this number.
    pub fn text(&self, number: u32) -> &str {
        &self.texts[number as usize]
    }
}
