//! Local date and time as text.

use js_sys::Date;
use std::time::SystemTime;

/// Formats a time in the local time zone as year, month, day, hour and minute.
pub fn local(time: SystemTime) -> String {
    let since = time.duration_since(SystemTime::UNIX_EPOCH);
    let milliseconds = since.unwrap_or_default().as_millis() as f64;
    text(&Date::new(&milliseconds.into()))
}

/// Returns the date of today in the local time zone as year, month and day.
pub fn today() -> String {
    text(&Date::new_0()).chars().take(10).collect()
}

fn text(date: &Date) -> String {
    let (year, month, day) = (date.get_full_year(), date.get_month() + 1, date.get_date());
    let (hours, minutes) = (date.get_hours(), date.get_minutes());
    format!("{year:04}-{month:02}-{day:02} {hours:02}:{minutes:02}")
}
