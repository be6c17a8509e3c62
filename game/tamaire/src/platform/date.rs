//! Local date and time as text.

use std::time::SystemTime;

/// Formats a time in the local time zone as year, month, day, hour and minute.
pub fn local(time: SystemTime) -> String {
    let Ok(time) = jiff::Timestamp::try_from(time) else {
        return String::new();
    };
    let here = time.to_zoned(jiff::tz::TimeZone::system());
    here.strftime("%Y-%m-%d %H:%M").to_string()
}

/// Returns the date of today in the local time zone as year, month and day.
pub fn today() -> String {
    local(SystemTime::now()).chars().take(10).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn date_has_year_to_minute() {
        let text = local(SystemTime::UNIX_EPOCH + Duration::from_secs(86_400 * 400));
        assert!(text.starts_with("1971-02-0") && text.len() == 16, "{text}");
    }
}
