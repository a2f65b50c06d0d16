//! Numbers: those of values, and those that are written in a way that TOML does not take, with a decimal comma or in quotes.

use std::ops::Range;
use toml::Value;
use toml::de::DeValue;

/// The number that a value is, written with a decimal point or without.
pub(crate) fn number(value: &Value) -> Option<f64> {
    value.as_float().or_else(|| value.as_integer().map(|whole| whole as f64))
}

/// The same of a value that knows where it stands.
pub(crate) fn written_number(value: &DeValue<'_>) -> Option<f64> {
    match value {
        DeValue::Float(number) => number.as_str().parse().ok(),
        DeValue::Integer(whole) => i128::from_str_radix(whole.as_str(), whole.radix()).ok().map(|whole| whole as f64),
        _ => None,
    }
}

/// Where a number with a decimal comma stands on the line on which TOML found a mistake, and what to write instead.
pub(super) fn decimal_comma(text: &str, at: usize) -> Option<(Range<usize>, String)> {
    let start = text.get(..at)?.rfind('\n').map_or(0, |newline| newline + 1);
    let line = text[start..].lines().next()?;
    let value = line.find('=')? + 1;
    let code = line[value..].split('#').next()?;
    let from = value + code.len() - code.trim_start().len();
    let written = code.trim();
    let in_list = written.starts_with('[');
    let (place, found) = if in_list {
        // `[0,05, 1]`: TOML stops at the zero, `[0,5, 1,5]` is a list of four and no mistake here.
        let found = written.trim_matches(['[', ']']).split(", ").find(|number| with_point(number).is_some())?;
        (line.find(found)?, found)
    } else {
        (from, written)
    };
    let point = with_point(found)?;
    let span = start + place..start + place + found.len();
    Some((span, format!("the value is `{found}`, expected a decimal point: `{point}`")))
}

/// The number with a point in place of its only comma.
fn with_point(written: &str) -> Option<String> {
    let (whole, fraction) = written.trim().split_once(',')?;
    let digits = |text: &str| text.starts_with(|letter: char| letter.is_ascii_digit());
    let point = format!("{whole}.{fraction}");
    (digits(whole.trim_start_matches(['-', '+'])) && digits(fraction) && point.parse::<f64>().is_ok()).then_some(point)
}

/// What to do with the number in the message `the value is the text "0.5", expected a number`.
pub(super) fn hint_for_quoted_number(message: &str) -> Option<String> {
    let text = message.strip_prefix("the value is the text \"")?.strip_suffix("\", expected a number")?;
    let number = if text.parse::<f64>().is_ok() { text.to_owned() } else { with_point(text)? };
    Some(format!("write it without quotes: {number}"))
}

/// A hint for a list of too many numbers where two belong: `[0,5, 1,5]` has four.
pub(crate) fn comma_in_list(found: usize) -> &'static str {
    if (3..=4).contains(&found) { "; decimals have a point, as in [0.5, 1.5]" } else { "" }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_comma_becomes_a_point() {
        let hint = |text: &str| decimal_comma(text, text.find(',').unwrap());
        let (span, message) = hint("[rod]\nlength = 0,5  # m\n").unwrap();
        assert_eq!((span, message.as_str()), (15..18, "the value is `0,5`, expected a decimal point: `0.5`"));
        assert_eq!(hint("a = -1,5e-3").unwrap().0, 4..11);
        assert_eq!(hint("from = [1, 0,05]").unwrap().0, 11..15);
        assert!(hint("a = 1, b = 2").is_none() && hint("a = x,5").is_none() && hint("a = [1, 2 3]").is_none());
    }

    #[test]
    fn quotes_go() {
        let message =
            |text: &str| hint_for_quoted_number(&format!("the value is the text \"{text}\", expected a number"));
        assert_eq!(message("0.5").unwrap(), "write it without quotes: 0.5");
        assert_eq!(message("0,5").unwrap(), "write it without quotes: 0.5");
        assert!(message("long").is_none());
    }
}
