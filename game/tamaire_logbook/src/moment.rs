//! Points in time.

use jiff::tz::{Offset, TimeZone};
use jiff::{Timestamp, Zoned};
use serde::{Deserialize, Serialize};
use std::cmp::Ordering;
use std::fmt;

/// Time of the system clock with its offset from UTC. The clock may have been wrong. Moments are compared by
/// their UTC time only.
#[derive(Copy, Clone, Debug, Serialize, Deserialize)]
pub struct Moment {
    /// Time since 1970-01-01 00:00 UTC [ms].
    pub utc_ms: i64,
    /// Offset of local time from UTC, daylight saving time included [s]. East of Greenwich is positive.
    pub offset_s: i32,
}

impl Moment {
    /// Returns the current time of the system clock, in its time zone.
    pub fn now() -> Self {
        Self::of(&Zoned::now())
    }

    /// Returns the moment `ms` milliseconds later, or earlier if `ms` is negative.
    pub fn after(self, ms: i64) -> Self {
        let utc_ms = self.utc_ms.saturating_add(ms);
        Self { utc_ms, ..self }
    }

    /// Returns the midnight at which the local day of this moment began.
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

    /// Returns the local time; `None` if it is outside the calendar's range.
    fn zoned(self) -> Option<Zoned> {
        let offset = Offset::from_seconds(self.offset_s).ok()?;
        let time = Timestamp::from_millisecond(self.utc_ms).ok()?;
        Some(time.to_zoned(TimeZone::fixed(offset)))
    }

    /// Formats the local time for file names: `2026-11-23-101502`. Empty if the time is outside the
    /// calendar's range.
    pub(crate) fn file_stem(self) -> String {
        let time = self.zoned();
        time.map_or_else(String::new, |time| {
            time.strftime("%Y-%m-%d-%H%M%S").to_string()
        })
    }
}

/// Formats the local time with its offset: `2026-11-23 10:15:02+01:00`.
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
    fn moment_is_formatted_in_its_local_time() {
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
    fn moment_outside_the_calendar_is_formatted_in_milliseconds() {
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
