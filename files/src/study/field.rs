//! A number of a scene file by its name, as messages write it: `contour.piece[2].vertex[1]`, counted from 1.

use crate::toml_file::meant;
use toml::{Table, Value};

/// The names and numbers on the way from the table to the value.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SceneField(Vec<NamePart>);

#[derive(Clone, Debug, PartialEq)]
enum NamePart {
    Name(String),
    /// From 0.
    Number(usize),
}

impl SceneField {
    /// None for a text that is no such name.
    pub fn parse(text: &str) -> Option<Self> {
        let mut parts = Vec::new();
        for name in text.split('.') {
            let mut rest = name.split('[');
            let name = rest.next().filter(|name| !name.is_empty() && !name.contains(']'))?;
            parts.push(NamePart::Name(name.to_owned()));
            for number in rest {
                let number: usize = number.strip_suffix(']')?.parse().ok()?;
                parts.push(NamePart::Number(number.checked_sub(1)?));
            }
        }
        Some(Self(parts))
    }

    /// Writes the number into the table: in place of the one that is there, or beside the others of a table that is there, or of one that scenes
    /// need not have.
    ///
    /// # Errors
    /// What is wrong with the name, for a message.
    pub fn set(&self, table: &mut Table, number: f64) -> Result<(), String> {
        let Some((NamePart::Name(first), rest)) = self.0.split_first() else { return Err("no name".to_owned()) };
        if rest.is_empty() {
            return insert_number(table, first, number);
        }
        let mut at = value_of(table, first)?;
        for (index, part) in rest.iter().enumerate() {
            let last = index + 1 == rest.len();
            at = match (part, at) {
                (NamePart::Name(name), Value::Table(table)) if last => return insert_number(table, name, number),
                (NamePart::Name(name), Value::Table(table)) => value_of(table, name)?,
                (NamePart::Number(n), Value::Array(array)) => {
                    let count = array.len();
                    let missing = || format!("the scene has {count}, expected a number from 1 to {count}");
                    array.get_mut(*n).ok_or_else(missing)?
                }
                (NamePart::Name(name), found) => {
                    return Err(format!("`{name}` follows a value of type {}, expected a table", found.type_str()));
                }
                (NamePart::Number(n), found) => {
                    return Err(format!("[{}] follows a value of type {}, expected a list", n + 1, found.type_str()));
                }
            };
        }
        replace(at, number)
    }
}

/// Tables that a scene need not have, and that hold numbers.
const OPTIONAL: [&str; 3] = ["contact", "clamp", "friction"];

/// What a table has under a name, which is made where it may be missing.
fn value_of<'a>(table: &'a mut Table, name: &str) -> Result<&'a mut Value, String> {
    if OPTIONAL.contains(&name) {
        return Ok(table.entry(name).or_insert_with(|| Value::Table(Table::new())));
    }
    let names: Vec<&str> = table.keys().map(String::as_str).collect();
    let hint = meant(name, &names).map_or_else(String::new, |hint| format!("; {hint}"));
    let names = names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
    table.get_mut(name).ok_or_else(|| format!("the scene has no `{name}` there, only {names}{hint}"))
}

fn insert_number(table: &mut Table, name: &str, number: f64) -> Result<(), String> {
    match table.get_mut(name) {
        Some(value) => replace(value, number),
        None => {
            table.insert(name.to_owned(), Value::Float(number));
            Ok(())
        }
    }
}

fn replace(value: &mut Value, number: f64) -> Result<(), String> {
    if !matches!(value, Value::Float(_) | Value::Integer(_)) {
        return Err(format!("the scene has a value of type {} there, expected a number", value.type_str()));
    }
    *value = Value::Float(number);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scene() -> Table {
        "[rod]\nlength = 1\n[[object]]\nposition = [1.0, 2.0]\n[[object.piece]]\nshape = \"parabola\"".parse().unwrap()
    }

    #[test]
    fn a_number_is_found_by_its_name() {
        let mut table = scene();
        for (name, number) in [("rod.length", 2.0), ("object[1].position[2]", 3.0), ("object[1].angle", 4.0)] {
            SceneField::parse(name).unwrap().set(&mut table, number).unwrap();
        }
        let expected: Table = "[rod]\nlength = 2.0\n[[object]]\nposition = [1.0, 3.0]\nangle = 4.0\n[[object.piece]]\nshape = \"parabola\""
            .parse()
            .unwrap();
        assert_eq!(table, expected);
    }

    #[test]
    fn wrong_names_are_told() {
        for text in ["", ".", "a[0]", "a[", "a]", "a[b]", "a..b", "a[1"] {
            assert_eq!(SceneField::parse(text), None, "{text}");
        }
        for (name, message) in [
            ("sweep.from[1]", "the scene has no `sweep` there, only `object`, `rod`"),
            ("objekt[1].angle", "the scene has no `objekt` there, only `object`, `rod`; did you mean `object`?"),
            ("object[2].angle", "the scene has 1, expected a number from 1 to 1"),
            ("object.angle", "`angle` follows a value of type array, expected a table"),
            ("rod[1]", "[1] follows a value of type table, expected a list"),
            ("object[1].piece[1].shape", "the scene has a value of type string there, expected a number"),
            ("object[1].position", "the scene has a value of type array there, expected a number"),
        ] {
            assert_eq!(SceneField::parse(name).unwrap().set(&mut scene(), 1.0), Err(message.to_owned()));
        }
    }
}
