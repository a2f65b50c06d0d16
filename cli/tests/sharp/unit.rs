//! A scene in another unit of length.

use toml::{Table, Value};

/// Fields that are lengths, or lists of them, wherever they stand.
const LENGTHS: [&str; 10] =
    ["length", "points", "from", "to", "center", "radius", "radii", "vertex", "position", "step"];

/// The scene file `text` with all lengths, and what depends on them, times `factor`: the same problem. By a power of two no
/// digit changes.
pub fn in_unit(text: &str, factor: f64) -> String {
    let mut scene: Table = text.parse().unwrap();
    scale(&mut scene, factor);
    scene.to_string()
}

fn scale(table: &mut Table, factor: f64) {
    for (name, value) in table {
        match name.as_str() {
            name if LENGTHS.contains(&name) => times(value, factor),
            "coefficient" => times(value, 1.0 / factor),
            "bending_stiffness" => times(value, factor * factor),
            _ => match value {
                Value::Table(table) => scale(table, factor),
                Value::Array(tables) => {
                    tables.iter_mut().filter_map(Value::as_table_mut).for_each(|t| scale(t, factor))
                }
                _ => {}
            },
        }
    }
}

fn times(value: &mut Value, factor: f64) {
    match value {
        Value::Float(number) => *number *= factor,
        Value::Integer(number) => *value = Value::Float(*number as f64 * factor),
        Value::Array(list) => list.iter_mut().for_each(|one| times(one, factor)),
        other => panic!("{other} is no length"),
    }
}
