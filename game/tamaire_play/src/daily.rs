//! Level of the day: a level of the path with a twist, the same for everybody.
//!
//! The pairs of a level and a twist stand in a list that ships with the game. `--example daily` makes it: in each pair,
//! the straight bots lose, and a way of the level still wins, also with a trembling hand.

mod mirror;
mod twist;

pub use twist::Twist;

use crate::Level;
use crate::level::{PATH, PathLevel};

/// Levels and twists: a line for each pair, with the name of the level and of the twist.
const LIST: &str = include_str!("../levels/daily.txt");

/// Beginning of the name of each level of the day; its date follows.
const PREFIX: &str = "daily-";

/// Returns all pairs of a level and a twist, in the order of the list.
pub fn pairs() -> Vec<(&'static PathLevel, Twist)> {
    let pair = |line: &'static str| {
        let (id, twist) = line.split_once(' ')?;
        let level = PATH.iter().find(|level| level.id == id)?;
        Some((level, Twist::named(twist)?))
    };
    LIST.lines().filter_map(pair).collect()
}

/// Returns the level of a day. `date` has the form 2026-11-28; `None` if it has another form.
pub fn level_of(date: &str) -> Option<Level> {
    let pairs = pairs();
    let (level, twist) = pairs.get(place_of(day_of(date)?, pairs.len())?)?;
    let mut twisted = twist.of(&level.open())?;
    twisted.id = format!("{PREFIX}{date}");
    Some(twisted)
}

/// Whether a level has the name of a level of the day.
pub fn is_daily(level: &Level) -> bool {
    level.id.starts_with(PREFIX)
}

/// Returns the place in a list of `count` entries for a day. In `count` days in a row each entry comes once, and
/// neighbours in the list are far apart. `None` if the list is empty.
fn place_of(day: u64, count: usize) -> Option<usize> {
    let count = u64::try_from(count).ok().filter(|&count| count > 0)?;
    let divides = |step: &u64| greatest_divisor(*step, count) == 1;
    // About the golden section of the list.
    let first = (count * 89 / 144).max(1);
    let step = (first..).find(divides)?;
    usize::try_from((day % count) * step % count).ok()
}

fn greatest_divisor(a: u64, b: u64) -> u64 {
    if b == 0 {
        a
    } else {
        greatest_divisor(b, a % b)
    }
}

/// Returns the number of days from 2000-03-01 to a date of the form 2026-11-28; `None` for another form, and for years
/// before 2001. A day that its month does not have counts as one of the next month.
fn day_of(date: &str) -> Option<u64> {
    let parts: Vec<u64> = { date.splitn(3, '-') }
        .map(|part| part.parse().ok())
        .collect::<Option<_>>()?;
    let &[year, month, day] = parts.as_slice() else {
        return None;
    };
    if !(2001..=9999).contains(&year) || !(1..=12).contains(&month) || !(1..=31).contains(&day) {
        return None;
    }
    // Years that begin in March have their leap day at the end.
    let (year, month) = if month > 2 {
        (year - 2000, month - 3)
    } else {
        (year - 2001, month + 9)
    };
    let before = 365 * year + year / 4 - year / 100 + year / 400;
    Some(before + (153 * month + 2) / 5 + day - 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn days_are_counted_over_months_and_leap_years() {
        for (date, expected) in [
            ("2001-03-01", 365),
            ("2004-02-29", 1460),
            ("2004-03-01", 1461),
            ("2026-11-28", 9768),
            ("2026-12-31", 9801),
            ("2027-01-01", 9802),
        ] {
            assert_eq!(day_of(date), Some(expected), "{date}");
        }
        for date in [
            "",
            "2026-11",
            "1999-01-01",
            "2026-13-01",
            "2026-01-32",
            "today",
        ] {
            assert_eq!(day_of(date), None, "{date}");
        }
    }

    #[test]
    fn each_entry_comes_once_before_the_first_one_returns() {
        for count in [1, 2, 3, 7, 60, 97, 144] {
            let mut places: Vec<_> = (500..500 + count)
                .filter_map(|day| place_of(day, count as usize))
                .collect();
            places.sort_unstable();
            assert_eq!(places, (0..count as usize).collect::<Vec<_>>());
        }
        assert_eq!(place_of(5, 0), None);
    }

    #[test]
    fn every_line_of_the_list_is_a_pair() {
        assert_eq!(pairs().len(), LIST.lines().count());
        assert!(pairs().len() >= 30, "{}", pairs().len());
    }

    #[test]
    fn same_date_gives_the_same_level() {
        let [a, b, c] =
            ["2026-11-28", "2026-11-28", "2026-11-29"].map(|date| level_of(date).unwrap());
        assert!(a == b && a.id == "daily-2026-11-28" && is_daily(&a));
        assert_ne!(a.scene(), c.scene());
    }
}
