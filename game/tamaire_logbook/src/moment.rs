//! When something was.

use jiff::tz::{Offset, TimeZone};
use jiff::{Timestamp, Zoned};
use serde::{Deserialize, Serialize};
use std::cmp::Ordering;
use std::fmt;

/// A moment by the clock on the wall, which may have been wrong, and where that wall was. Moments are equal, and come before
/// each other, by their time in UTC alone.
#[derive(Copy, Clone, Debug, Serialize, Deserialize)]
pub struct Moment {
    /// Since the beginning of 1970 in UTC [ms].
    pub utc_ms: i64,
    /// How far local time was ahead of UTC, summer time included [s].
    pub offset_s: i32,
}

impl Moment {
    /// By this machine's clock, in its time zone.
    pub fn now() -> Self {
        Self::of(&Zoned::now())
    }

    /// As long after this one [ms]; before it if negative.
    pub fn after(self, ms: i64) -> Self {
        let utc_ms = self.utc_ms.saturating_add(ms);
        Self { utc_ms, ..self }
    }

    /// The midnight at which the day of this moment began, in its own local time.
    pub fn midnight(self) -> Self {
        const DAY: i64 = 86_400_000;
        let local = self.utc_ms.saturating_add(1000 * i64::from(self.offset_s));
        self.after(-local.rem_euclid(DAY))
    }

    fn of(time: &Zoned) -> Self {
        Self {
            utc_ms: time.timestamp().as_millisecond(),
            offset_s: time.offset().seconds(),
        }
    }

    /// Local time; nothing of a moment that no calendar has.
    fn zoned(self) -> Option<Zoned> {
        let offset = Offset::from_seconds(self.offset_s).ok()?;
        let time = Timestamp::from_millisecond(self.utc_ms).ok()?;
        Some(time.to_zoned(TimeZone::fixed(offset)))
    }

    /// In local time, as digits that are fit for the name of a file: `2026-11-23-101502`.
    pub(crate) fn file_stem(self) -> String {
        let time = self.zoned();
        time.map_or_else(String::new, |time| {
            time.strftime("%Y-%m-%d-%H%M%S").to_string()
        })
    }
}

/// Local time with its offset, `2026-11-23 10:15:02+01:00`.
impl fmt::Display for Moment {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.zoned() {
            Some(time) => write!(formatter, "{}", time.strftime("%Y-%m-%d %H:%M:%S%:z")),
            None => write!(formatter, "{} ms", self.utc_ms),
        }
    }
}

impl PartialEq for Moment {
    fn eq(&self, other: &Self) -> bool {
        self.utc_ms == other.utc_ms
    }
}

impl Eq for Moment {}

impl PartialOrd for Moment {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Moment {
    fn cmp(&self, other: &Self) -> Ordering {
        self.utc_ms.cmp(&other.utc_ms)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_moment_is_told_in_the_time_of_its_place() {
        let moment = Moment {
            utc_ms: 1_795_428_902_345,
            offset_s: 3600,
        };
        assert_eq!(moment.to_string(), "2026-11-23 11:15:02+01:00");
        assert_eq!(moment.file_stem(), "2026-11-23-111502");
        assert_eq!(moment.midnight().to_string(), "2026-11-23 00:00:00+01:00");
        let west = Moment {
            offset_s: -11 * 3600,
            ..moment
        };
        assert_eq!(west.midnight().to_string(), "2026-11-22 00:00:00-11:00");
        assert_eq!(west, moment);
    }

    #[test]
    fn a_moment_that_no_calendar_has_is_borne() {
        for utc_ms in [i64::MIN, i64::MAX] {
            let moment = Moment {
                utc_ms,
                offset_s: i32::MAX,
            };
            assert_eq!(moment.to_string(), format!("{utc_ms} ms"));
            moment.midnight();
        }
        assert!(
            Moment::now()
                > Moment {
                    utc_ms: 1_700_000_000_000,
                    offset_s: 0
                }
        );
    }
}
