//! When something was, as people here write it.

use std::time::SystemTime;

/// A time of day where the machine stands: year, month, day, hour, minute.
pub fn local(time: SystemTime) -> String {
    let Ok(time) = jiff::Timestamp::try_from(time) else {
        return String::new();
    };
    let here = time.to_zoned(jiff::tz::TimeZone::system());
    here.strftime("%Y-%m-%d %H:%M").to_string()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn a_date_is_written_from_year_to_minute() {
        let text = local(SystemTime::UNIX_EPOCH + Duration::from_secs(86_400 * 400));
        assert!(text.starts_with("1971-02-0") && text.len() == 16, "{text}");
    }
}
