//! Messages of the deserializer in words of TOML instead of Rust's.

/// A message in words for the user: what is there and what was expected.
pub(super) fn plain(message: &str) -> String {
    let message = message.trim().replace('\n', ", ");
    if let Some(key) = message.strip_prefix("missing field ") {
        return match key.contains("expected") {
            true => message,
            false => format!("missing field {key}, expected it in this table"),
        };
    }
    if let Some(rest) = message.strip_prefix("unknown variant ") {
        return format!("the value is {rest}");
    }
    if let Some(rest) = message.strip_prefix("unknown field ") {
        let names = quoted_names(rest);
        let hint = names.split_first().and_then(|(name, known)| meant(name, known));
        return hint.map_or_else(|| message.clone(), |hint| format!("{message}; {hint}"));
    }
    for kind in ["invalid type: ", "invalid value: "] {
        let parts = message.strip_prefix(kind).and_then(|rest| rest.split_once(", expected "));
        if let Some((found, expected)) = parts {
            // an integer of more than 64 bits is no number for the deserializer
            let hint = if found.ends_with("128") { " of this size with a decimal point or an exponent" } else { "" };
            return format!("the value is {}, expected {}{hint}", value(found), expected_in_words(expected));
        }
    }
    if let Some((count, expected)) = message.strip_prefix("invalid length ").and_then(|m| m.split_once(", expected ")) {
        return format!("the list has {count} values, expected {}", expected_in_words(expected));
    }
    message.replace("number overflowed", "number overflowed, expected at most 1.7e308 either way")
}

/// The name of a key that a table has twice, or of a table that is there twice.
pub(super) fn duplicate(message: &str, written: &str) -> Option<String> {
    let name = written.split(['=', ']']).next()?.trim_start_matches('[').trim();
    message.starts_with("duplicate key").then(|| format!("`{name}` is given twice, expected once"))
}

/// Tables of scene files that stand within another one.
const WITHIN: [(&str, &str); 6] = [
    ("section", "[[rod.section]]"),
    ("leg", "[[sweep.leg]]"),
    ("piece", "[[object.piece]]"),
    ("friction", "[contact]"),
    ("mu", "friction, in the table [contact], of an object or of a piece"),
    ("roller", "roller, in the table [clamp]"),
];

/// The names between backquotes.
fn quoted_names(text: &str) -> Vec<&str> {
    text.split('`').skip(1).step_by(2).collect()
}

/// What may have been meant by a name that is none of those known: the nearest one, or one that belongs elsewhere.
pub(crate) fn meant(name: &str, known: &[&str]) -> Option<String> {
    let changes = |other: &&&str| changes(name, other);
    let nearest = known.iter().min_by_key(changes).filter(|nearest| changes(nearest) <= (name.len() / 3).max(1));
    if let Some(nearest) = nearest {
        return Some(format!("did you mean `{nearest}`?"));
    }
    let (_, place) = WITHIN.iter().find(|(table, _)| *table == name)?;
    Some(format!("did you mean {place}?"))
}

/// How many letters must be left out, put in or changed to make one name of the other (Levenshtein).
fn changes(one: &str, other: &str) -> usize {
    let mut row: Vec<usize> = (0..=other.len()).collect();
    for (i, a) in one.bytes().enumerate() {
        let mut before = row[0];
        row[0] = i + 1;
        for (j, b) in other.bytes().enumerate() {
            let change = before + usize::from(a != b);
            before = row[j + 1];
            row[j + 1] = change.min(before + 1).min(row[j] + 1);
        }
    }
    row[other.len()]
}

/// Most digits and zeros of a number in a message; longer ones get an exponent.
const LONGEST: usize = 24;

/// The message with an exponent in numbers that would be hundreds of digits long.
pub(super) fn with_short_numbers(message: String) -> String {
    let is_part = |letter: char| letter.is_ascii_digit() || letter == '.';
    let mut short = String::with_capacity(message.len());
    let mut rest = message.as_str();
    while let Some(start) = rest.find(|letter: char| letter.is_ascii_digit()) {
        let end = rest[start..].find(|letter| !is_part(letter)).map_or(rest.len(), |length| start + length);
        let number = &rest[start..end];
        short.push_str(&rest[..start]);
        match number.parse::<f64>() {
            Ok(value) if number.len() > LONGEST => short.push_str(&format!("{value:e}")),
            _ => short.push_str(number),
        }
        rest = &rest[end..];
    }
    short + rest
}

/// What was found, as it is written.
fn value(found: &str) -> String {
    let quoted = |kind: &str| found.strip_prefix(kind).and_then(|rest| rest.split('`').nth(1)).map(str::to_owned);
    let number = ["integer ", "floating point ", "boolean "].into_iter().find_map(quoted);
    number.unwrap_or_else(|| match found {
        "sequence" => "a list".to_owned(),
        "map" => "a table".to_owned(),
        other => other.replacen("string ", "the text ", 1),
    })
}

/// What was expected.
fn expected_in_words(expected: &str) -> String {
    let name = expected.split([' ', ',']).next().unwrap_or_default();
    let whole = "a whole number that is not negative";
    match name {
        "struct" | "map" => "a table of fields, as in { name = value }".to_owned(),
        "f64" => "a number".to_owned(),
        "u64" | "usize" | "u32" | "u16" | "u8" => whole.to_owned(),
        "i64" | "i32" => "a whole number".to_owned(),
        _ => match expected {
            "a sequence" => "a list".to_owned(),
            "a map" => "a table".to_owned(),
            "a string" | "path string" => "a text in quotes".to_owned(),
            "a boolean" => "true or false".to_owned(),
            other => other.replace("f64", "a number"),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_word_of_rust_is_left() {
        for (raw, expected) in [
            ("missing field `to`", "missing field `to`, expected it in this table"),
            ("missing field `to`, expected x", "missing field `to`, expected x"),
            (
                "unknown variant `circle`, expected one of `arc`, `line`",
                "the value is `circle`, expected one of `arc`, `line`",
            ),
            ("invalid type: string \"m\", expected f64", "the value is the text \"m\", expected a number"),
            (
                "invalid type: integer `3`, expected struct ChannelFields",
                "the value is 3, expected a table of fields, as in { name = value }",
            ),
            (
                "invalid type: floating point `1.5`, expected usize",
                "the value is 1.5, expected a whole number that is not negative",
            ),
            ("invalid type: map, expected a sequence", "the value is a table, expected a list"),
            ("invalid type: boolean `true`, expected a string", "the value is true, expected a text in quotes"),
            (
                "invalid type: integer `99999999999999999999` as i128, expected f64",
                "the value is 99999999999999999999, expected a number of this size with a decimal point or an exponent",
            ),
            (
                "unknown field `lenght`, expected one of `length`, `diameter`",
                "unknown field `lenght`, expected one of `length`, `diameter`; did you mean `length`?",
            ),
            (
                "unknown field `section`, expected one of `rod`, `sweep`",
                "unknown field `section`, expected one of `rod`, `sweep`; did you mean [[rod.section]]?",
            ),
            ("unknown field `colour`, expected `rod` or `sweep`", "unknown field `colour`, expected `rod` or `sweep`"),
        ] {
            assert_eq!(plain(raw), expected);
        }
        assert_eq!(duplicate("duplicate key", "length = 0.2").unwrap(), "`length` is given twice, expected once");
        assert_eq!(duplicate("duplicate key", "[rod]").unwrap(), "`rod` is given twice, expected once");
    }

    #[test]
    fn the_nearest_name_is_meant() {
        let known = ["length", "diameter", "youngs_modulus"];
        assert_eq!(meant("diametre", &known).unwrap(), "did you mean `diameter`?");
        assert_eq!(meant("young_modulus", &known).unwrap(), "did you mean `youngs_modulus`?");
        assert_eq!((meant("stiffness", &known), meant("x", &known), meant("a", &[])), (None, None, None));
        assert_eq!([changes("kitten", "sitting"), changes("", "abc"), changes("abc", "abc")], [3, 3, 0]);
    }

    #[test]
    fn numbers_of_hundreds_of_digits_get_an_exponent() {
        let shown = |value: f64| with_short_numbers(format!("length is {value}, expected at most 0.1 m"));
        assert_eq!(shown(1e300), "length is 1e300, expected at most 0.1 m");
        assert_eq!(shown(-2.5e-200), "length is -2.5e-200, expected at most 0.1 m");
        assert_eq!(shown(1.0 / 3.0), "length is 0.3333333333333333, expected at most 0.1 m");
        assert_eq!(with_short_numbers("a.b, c".to_owned()), "a.b, c");
    }
}
