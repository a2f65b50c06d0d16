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
    for kind in ["invalid type: ", "invalid value: "] {
        let parts = message.strip_prefix(kind).and_then(|rest| rest.split_once(", expected "));
        if let Some((found, expected)) = parts {
            return format!("the value is {}, expected {}", value(found), wanted(expected));
        }
    }
    if let Some((count, expected)) = message.strip_prefix("invalid length ").and_then(|m| m.split_once(", expected ")) {
        return format!("the list has {count} values, expected {}", wanted(expected));
    }
    message.replace("number overflowed", "number overflowed, expected at most 1.7e308 either way")
}

/// The name of a key that a table has twice, or of a table that is there twice.
pub(super) fn duplicate(message: &str, written: &str) -> Option<String> {
    let name = written.split(['=', ']']).next()?.trim_start_matches('[').trim();
    message.starts_with("duplicate key").then(|| format!("`{name}` is given twice, expected once"))
}

/// What was found, as it is written.
fn value(found: &str) -> String {
    let quoted = |kind: &str| found.strip_prefix(kind).map(|rest| rest.trim_matches('`').to_owned());
    let number = ["integer ", "floating point ", "boolean "].into_iter().find_map(quoted);
    number.unwrap_or_else(|| match found {
        "sequence" => "a list".to_owned(),
        "map" => "a table".to_owned(),
        other => other.replacen("string ", "the text ", 1),
    })
}

/// What was expected.
fn wanted(expected: &str) -> String {
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
        ] {
            assert_eq!(plain(raw), expected);
        }
        assert_eq!(duplicate("duplicate key", "length = 0.2").unwrap(), "`length` is given twice, expected once");
        assert_eq!(duplicate("duplicate key", "[rod]").unwrap(), "`rod` is given twice, expected once");
    }
}
