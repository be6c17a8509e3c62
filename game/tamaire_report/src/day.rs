//! Days and hours in the local time of a stand.

use jiff::civil::Date;
use std::fmt;
use std::str::FromStr;
use tamaire_logbook::Moment;

/// 1 January 1970.
const EPOCH: Date = Date::constant(1970, 1, 1);
const DAY_MS: i64 = 86_400_000;
const HOUR_MS: i64 = 3_600_000;

/// Day of the calendar, without a time zone.
#[derive(Copy, Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Day(
    /// Days since 1 January 1970.
    pub i32,
);

/// Error of parsing a [`Day`] from a text.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("expected a day such as 2026-11-23, found {0:?}")]
pub struct NoDay(
    /// The text that was given.
    pub String,
);

impl Day {
    /// Returns the day of a moment in its local time.
    pub fn of(moment: Moment) -> Self {
        let days = local_ms(moment).div_euclid(DAY_MS);
        Self(days.clamp(i32::MIN.into(), i32::MAX.into()) as i32)
    }

    fn date(self) -> Option<Date> {
        let days = jiff::Span::new().try_days(self.0).ok()?;
        EPOCH.checked_add(days).ok()
    }
}

/// Returns the hour of a moment in its local time, 0 to 23.
pub fn hour(moment: Moment) -> usize {
    (local_ms(moment).rem_euclid(DAY_MS) / HOUR_MS) as usize
}

fn local_ms(moment: Moment) -> i64 {
    let offset = 1000 * i64::from(moment.offset_s);
    moment.utc_ms.saturating_add(offset)
}

/// Formats the day as `2026-11-23`.
impl fmt::Display for Day {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.date() {
            Some(date) => write!(formatter, "{date}"),
            None => write!(formatter, "day {}", self.0),
        }
    }
}

impl FromStr for Day {
    type Err = NoDay;

    fn from_str(text: &str) -> Result<Self, NoDay> {
        let is_plain = text.len() == 10 && text.bytes().all(|b| b.is_ascii_digit() || b == b'-');
        let date = text.parse::<Date>().ok().filter(|_| is_plain);
        let since = date.and_then(|day| day.since(EPOCH).ok());
        since
            .map(|span| Self(span.get_days()))
            .ok_or_else(|| NoDay(text.into()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn day_round_trips_as_text() {
        for text in ["1970-01-01", "2026-11-23", "1969-12-31", "2028-02-29"] {
            assert_eq!(text.parse::<Day>().unwrap().to_string(), text);
        }
        assert_eq!("2026-11-23".parse(), Ok(Day(20_780)));
        for wrong in [
            "",
            "today",
            "2026-11-31",
            "2026-1-1",
            "20261123",
            "2026-11-23T10:00",
        ] {
            assert_eq!(wrong.parse::<Day>(), Err(NoDay(wrong.into())));
        }
    }

    #[test]
    fn day_and_hour_are_in_local_time() {
        let at = |utc_ms, offset_s| Moment { utc_ms, offset_s };
        let late = 1_795_474_800_000; // 2026-11-23 23:00 UTC
        let days = [0, 3600, -7200].map(|offset| Day::of(at(late, offset)).to_string());
        assert_eq!(days, ["2026-11-23", "2026-11-24", "2026-11-23"]);
        assert_eq!(
            [0, 3600, -7200].map(|offset| hour(at(late, offset))),
            [23, 0, 21]
        );
        for utc_ms in [i64::MIN, i64::MAX] {
            Day::of(at(utc_ms, i32::MAX)).to_string();
            assert!(hour(at(utc_ms, i32::MIN)) < 24);
        }
    }
}
