//! The player's way along the path: stars, and which chapters are open.

use crate::records::{Record, Records, WishName};
use tamaire_play::level::{CHAPTERS, OPENING_SHARE, PATH};
use tamaire_play::{Level, Wish};

/// Earned stars and all stars of some levels. A level has a star for the win and one for each of its goals.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub struct Stars {
    /// Earned stars.
    pub earned: usize,
    /// All stars.
    pub all: usize,
}

/// Returns the goal of each star of a level, and whether the star is earned: first that of the win, without a goal, then
/// those of the wishes. A playground has no win.
pub fn stars_of<'a>(
    level: &'a Level,
    record: Option<&'a Record>,
) -> impl Iterator<Item = (Option<&'a Wish>, bool)> {
    let has_basket = !level.game().all_baskets().is_empty();
    let won = has_basket.then(|| (None, record.is_some_and(Record::is_won)));
    let wishes = level.game().wish.iter().map(move |wish| {
        let name = WishName::of(wish);
        let is_reached = record.is_some_and(|record| record.wishes.contains(&name));
        (Some(wish), is_reached)
    });
    won.into_iter().chain(wishes)
}

impl Stars {
    /// Returns the stars of a level.
    pub fn of(level: &Level, records: &Records) -> Self {
        let stars = || stars_of(level, records.of_level(level));
        Self {
            earned: stars().filter(|(_, is_earned)| *is_earned).count(),
            all: stars().count(),
        }
    }

    fn and(self, other: Self) -> Self {
        Self {
            earned: self.earned + other.earned,
            all: self.all + other.all,
        }
    }
}

/// The player's stars in each chapter of the path.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub struct Journey {
    /// Stars of each chapter.
    pub chapters: [Stars; CHAPTERS.len()],
}

impl Journey {
    /// Returns the stars of the path among `levels`.
    pub fn of<'a>(levels: impl Iterator<Item = &'a Level>, records: &Records) -> Self {
        let mut chapters = [Stars::default(); CHAPTERS.len()];
        for level in levels {
            if let Some(chapter) = chapter_of(level) {
                let stars = &mut chapters[chapter - 1];
                *stars = stars.and(Stars::of(level, records));
            }
        }
        Self { chapters }
    }

    /// Returns the stars of the whole path.
    pub fn stars(&self) -> Stars {
        self.chapters.into_iter().fold(Stars::default(), Stars::and)
    }

    /// Returns what is missing until a chapter opens; `None` if it is open. A chapter without levels is skipped.
    pub fn lock(&self, chapter: usize) -> Option<Lock> {
        let mut earlier = (1..chapter).rev();
        let before = earlier.find(|&before| self.chapters[before - 1].all > 0)?;
        let Stars { earned, all } = self.chapters[before - 1];
        let needed = (all as f32 * OPENING_SHARE).ceil() as usize;
        let missing = needed.saturating_sub(earned);
        (missing > 0).then_some(Lock::Stars { missing, before })
    }
}

/// Reason why a chapter or a level is closed.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Lock {
    /// Stars are missing.
    Stars {
        /// Number of missing stars.
        missing: usize,
        /// Chapter in which they are missing, counted from 1.
        before: usize,
    },
    /// The level cannot be won in calm mode, because things must tear in it.
    Calm,
}

/// Part of the list of levels.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Section {
    /// The classic level and the playgrounds.
    First,
    /// The level of the day.
    Day,
    /// Chapter of the path, counted from 1.
    Chapter(usize),
    /// The other built-in levels.
    More,
    /// Levels that the player added.
    Own,
}

impl Section {
    /// All sections, in order.
    pub fn all() -> impl Iterator<Item = Self> {
        let chapters = (1..=CHAPTERS.len()).map(Self::Chapter);
        [Self::First, Self::Day]
            .into_iter()
            .chain(chapters)
            .chain([Self::More, Self::Own])
    }

    /// Returns the section of a level. `is_own` tells whether the player added it.
    pub fn of(level: &Level, is_own: bool) -> Self {
        const FIRST: [&str; 4] = ["classic", "classic-3d", "sandbox", "sandbox-3d"];
        match chapter_of(level) {
            _ if is_own => Self::Own,
            Some(chapter) => Self::Chapter(chapter),
            None if FIRST.contains(&level.id.as_str()) => Self::First,
            None => Self::More,
        }
    }
}

/// Returns the chapter of a level on the path, counted from 1.
pub fn chapter_of(level: &Level) -> Option<usize> {
    let mut path = PATH.iter();
    path.find(|known| known.id == level.id)
        .map(|level| level.chapter)
}

#[cfg(test)]
mod tests {
    use super::*;
    use tamaire_play::{Outcome, Route};

    #[test]
    fn chapter_opens_with_half_of_the_stars_before() {
        let levels: Vec<Level> = PATH.iter().map(|level| level.open()).collect();
        let mut records = Records::default();
        let journey = |records: &Records| Journey::of(levels.iter(), records);
        let start = journey(&records);
        assert_eq!((start.lock(1), start.stars().earned), (None, 0));
        assert!((2..=CHAPTERS.len()).all(|chapter| start.lock(chapter).is_some()));
        let first = levels.iter().filter(|level| chapter_of(level) == Some(1));
        let missing = |journey: Journey| match journey.lock(2) {
            Some(Lock::Stars { missing, .. }) => missing,
            _ => 0,
        };
        let mut expected = missing(start);
        for level in first {
            let outcome = Outcome {
                ticks: 600,
                route: Route::Squeeze,
                kept: 1.0,
                inside: 1.0,
                pieces: 1,
                lost: 0,
                broken: 0,
                torn: 0,
            };
            records.note(level, &outcome, 0);
            let earned = Stars::of(level, &records).earned;
            assert_eq!(earned, 1 + outcome.wishes(level.game()).len());
            expected = expected.saturating_sub(earned);
            assert_eq!(missing(journey(&records)), expected);
        }
        assert_eq!(expected, 0, "a win of each level opens the next chapter");
    }
}
