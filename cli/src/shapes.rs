//! The list of shapes that a scene can have.

use crate::table::Table;
use vibrissa::contour::description::{FieldUnit, Shape};

/// The shapes of scene files with their fields, types, units in scene files, and meanings.
///
/// ```
/// let list = vibrissa_cli::shapes_list();
/// assert!(list.contains("shape = \"arc\"") && list.contains("radius"));
/// ```
pub fn shapes_list() -> String {
    let shapes = Shape::ALL.iter().map(|shape| {
        let mut table = Table::new(["field", "type", "unit", "needed", "meaning"]);
        for field in shape.fields {
            let unit = match field.unit {
                FieldUnit::Length => "m",
                FieldUnit::PerLength => "1/m",
                FieldUnit::Degrees => "degrees",
                FieldUnit::None => "-",
            };
            let needed = if field.required { "yes" } else { "no" };
            table.row([field.name, field.kind, unit, needed, field.meaning.trim()].map(str::to_owned));
        }
        format!("shape = \"{}\"  {}\n{table}", shape.name, shape.meaning.trim())
    });
    shapes.collect::<Vec<_>>().join("\n")
}
