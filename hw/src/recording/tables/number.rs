//! Numbers as they are written in tables.

use super::options::Decimal;

/// The spellings of missing numbers by other programs.
const NOT_A_NUMBER: [&str; 12] =
    ["NA", "N/A", "n/a", "#N/A", "#NUM!", "null", "NULL", "None", "-nan(ind)", "1.#QNAN", "1.#IND", "-1.#IND"];

/// The number, NaN and infinities included; `None` if the text is something else.
pub(super) fn number(text: &str, decimal: Decimal) -> Option<f64> {
    let parsed = match decimal {
        Decimal::Point => text.parse().ok(),
        Decimal::Comma => with_point(text),
    };
    parsed.or_else(|| unusual(text, decimal))
}

/// The number with a decimal comma; a point makes it none, for that would be a separator of thousands.
fn with_point(text: &str) -> Option<f64> {
    // longer than any number that a program writes
    let mut buffer = [0_u8; 64];
    let place = buffer.get_mut(..text.len())?;
    for (to, from) in place.iter_mut().zip(text.bytes()) {
        *to = match from {
            b',' => b'.',
            b'.' => return None,
            other => other,
        };
    }
    std::str::from_utf8(place).ok()?.parse().ok()
}

/// Spellings that Rust does not know: of other languages' missing values, Fortran's exponents, typeset minus signs, status
/// words in hexadecimal.
fn unusual(text: &str, decimal: Decimal) -> Option<f64> {
    if NOT_A_NUMBER.contains(&text) {
        return Some(f64::NAN);
    }
    if let Some(digits) = text.strip_prefix("0x").or_else(|| text.strip_prefix("0X")) {
        return u32::from_str_radix(digits, 16).ok().map(f64::from);
    }
    match text {
        "1.#INF" => return Some(f64::INFINITY),
        "-1.#INF" => return Some(f64::NEG_INFINITY),
        _ => {}
    }
    // a spreadsheet's mark of a number that is kept as text
    if let Some(rest) = text.strip_prefix('\'') {
        return if rest.starts_with('\'') { None } else { number(rest, decimal) };
    }
    let digits = text.strip_prefix(['+', '-', '\u{2212}']).unwrap_or(text);
    if text.len() > 64 || !digits.starts_with(|c: char| c.is_ascii_digit() || matches!(c, '.' | ',')) {
        return None;
    }
    let usual = text.replace('\u{2212}', "-").replace(['d', 'D'], "e");
    match decimal {
        Decimal::Point => usual.parse().ok(),
        Decimal::Comma => with_point(&usual),
    }
}

/// Whether this is a number with a fraction after this mark.
pub(super) fn has_fraction(text: &str, decimal: Decimal) -> bool {
    let mark = match decimal {
        Decimal::Point => '.',
        Decimal::Comma => ',',
    };
    text.contains(mark) && number(text, decimal).is_some()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spellings() {
        for (text, value) in [
            ("0.5", 0.5),
            ("-1e-3", -1e-3),
            (".5", 0.5),
            ("5.", 5.0),
            ("+2", 2.0),
            ("1.5D-3", 1.5e-3),
            ("\u{2212}0.25", -0.25),
            ("Inf", f64::INFINITY),
            ("-1.#INF", f64::NEG_INFINITY),
            ("0x80000001", 2_147_483_649.0),
            ("'0.5", 0.5),
        ] {
            assert_eq!(number(text, Decimal::Point), Some(value), "{text}");
        }
        for text in ["NaN", "nan", "NA", "N/A", "#N/A", "null", "-nan(ind)"] {
            assert!(number(text, Decimal::Point).unwrap().is_nan(), "{text}");
        }
        for text in ["", "0,5", "1 000", "1.2.3", "12:30", "OK", "e5", "D", "0x", "1,234.5", "--", "'", "''1"] {
            assert_eq!(number(text, Decimal::Point), None, "{text}");
        }
    }

    #[test]
    fn decimal_commas() {
        assert_eq!(number("3,906250E-5", Decimal::Comma), Some(3.906_25e-5));
        assert_eq!(number("7", Decimal::Comma), Some(7.0));
        for text in ["0.5", "1.234,5", "1,2,3"] {
            assert_eq!(number(text, Decimal::Comma), None, "{text}");
        }
        assert!(has_fraction("0,5", Decimal::Comma) && !has_fraction("5", Decimal::Comma));
        let long = "0,".to_owned() + &"1".repeat(1000);
        assert_eq!(number(&long, Decimal::Comma), None);
    }
}
