//! Dates and times of day as they are written in tables.

/// Days from 0000-03-01 to 1970-01-01 in the Gregorian calendar.
const TO_1970: i64 = 719_468;

/// Seconds since 1970 of a date with a time of day, or since midnight of a time of day alone; `None` for other texts. A date is
/// `2026-11-28` or `28.11.2026`, then `T` or a blank; a time of day is `07:02:34`, with a fraction after a point or a comma. `Z` or `+01:00`
/// after a date state the zone; without one it is UTC.
pub(super) fn seconds(text: &str) -> Option<f64> {
    // most cells are no dates
    if text.len() > 40 || !text.contains(':') || !text.is_ascii() {
        return None;
    }
    let Some((date, time)) = text.split_once(['T', ' ']) else { return of_day(text) };
    let days = days(date)?;
    let time = time.trim();
    let (time, zone) = match (time.strip_suffix('Z'), time.rfind(['+', '-'])) {
        (Some(time), _) => (time, 0.0),
        (None, Some(at)) => (&time[..at], zone(&time[at..])?),
        (None, None) => (time, 0.0),
    };
    Some(days as f64 * 86_400.0 + of_day(time.trim_end())? - zone)
}

/// A number of so many digits.
fn digits(text: &str, count: std::ops::RangeInclusive<usize>) -> Option<u32> {
    let are_digits = text.bytes().all(|byte| byte.is_ascii_digit());
    if are_digits && count.contains(&text.len()) { text.parse().ok() } else { None }
}

/// Days since 1970.
fn days(date: &str) -> Option<i64> {
    let (year, month, day) = if date.contains('-') {
        let mut parts = date.split('-');
        (parts.next()?, parts.next()?, parts.next().filter(|_| parts.next().is_none())?)
    } else {
        let mut parts = date.split('.');
        let (day, month) = (parts.next()?, parts.next()?);
        (parts.next().filter(|_| parts.next().is_none())?, month, day)
    };
    let (year, month, day) = (digits(year, 4..=4)?, digits(month, 1..=2)?, digits(day, 1..=2)?);
    let is_leap = year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
    let longest = match month {
        2 => 28 + u32::from(is_leap),
        4 | 6 | 9 | 11 => 30,
        1..=12 => 31,
        _ => return None,
    };
    if !(1..=longest).contains(&day) {
        return None;
    }
    // years that begin in March end with the day of leap years
    let (year, month) = if month > 2 { (year, month - 3) } else { (year.checked_sub(1)?, month + 9) };
    let (year, month, day) = (i64::from(year), i64::from(month), i64::from(day));
    Some(365 * year + year / 4 - year / 100 + year / 400 + (153 * month + 2) / 5 + day - 1 - TO_1970)
}

/// Seconds since midnight.
fn of_day(time: &str) -> Option<f64> {
    let mut parts = time.split(':');
    let (hour, minute, second) = (parts.next()?, parts.next()?, parts.next().filter(|_| parts.next().is_none())?);
    let (whole, fraction) = second.split_once(['.', ',']).unwrap_or((second, "0"));
    let (hour, minute, whole) = (digits(hour, 1..=2)?, digits(minute, 2..=2)?, digits(whole, 2..=2)?);
    if hour > 23 || minute > 59 || whole > 60 || fraction.is_empty() || !fraction.bytes().all(|b| b.is_ascii_digit()) {
        return None;
    }
    let fraction: f64 = format!("0.{fraction}").parse().ok()?;
    Some(f64::from(3600 * hour + 60 * minute + whole) + fraction)
}

/// By how much the local time is ahead of UTC, s: of `+01:00`, `-0530` or `+01`.
fn zone(text: &str) -> Option<f64> {
    let sign = if text.starts_with('-') { -1.0 } else { 1.0 };
    let digits_of = text[1..].replace(':', "");
    let (hours, minutes) = match digits_of.len() {
        2 => (digits(&digits_of, 2..=2)?, 0),
        4 => (digits(&digits_of[..2], 2..=2)?, digits(&digits_of[2..], 2..=2)?),
        _ => return None,
    };
    Some(sign * f64::from(3600 * hours + 60 * minutes))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dates_and_times_of_day() {
        for (text, expected) in [
            ("1970-01-01T00:00:00Z", 0.0),
            ("2000-03-01 00:00:00", 951_868_800.0),
            ("2026-11-28 07:02:34.123", 1_795_849_354.123),
            ("2026-11-28T07:02:34,5", 1_795_849_354.5),
            ("2026-11-28T08:02:34.5+01:00", 1_795_849_354.5),
            ("2026-11-28T01:32:34.5-0530", 1_795_849_354.5),
            ("28.11.2026 07:02:34,5", 1_795_849_354.5),
            ("2024-02-29T00:00:00Z", 1_709_164_800.0),
            ("07:02:34.25", 25_354.25),
            ("7:02:34", 25_354.0),
        ] {
            assert_eq!(seconds(text), Some(expected), "{text}");
        }
        for text in [
            "",
            "12:30",
            "2026-11-28",
            "2025-02-29T00:00:00",
            "2026-13-01T00:00:00",
            "24:00:00",
            "1:2:3",
            "a:b:c",
            "T::",
            "::",
            "2026-11-28T07:02:34+1",
            "2026-11-28T07:02:34+x",
            "-:",
            "2026-11-28Tµ:00:00",
            "2026-11-28 07:02:34.",
        ] {
            assert_eq!(seconds(text), None, "{text}");
        }
    }
}
