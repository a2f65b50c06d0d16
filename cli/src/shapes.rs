//! The list of shapes that a scene can have.

use rod_files::table::Table;
use vibrissa::contour::description::{FieldInfo, FieldUnit, Shape};

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
            // the meaning of the first of two fields names the other one
            let other = |field: &FieldInfo| field.meaning.split("or else `").nth(1)?.split('`').next();
            let rival = other(field)
                .or_else(|| shape.fields.iter().find(|rival| other(rival) == Some(field.name)).map(|rival| rival.name));
            let needed = match (field.required, rival) {
                (true, _) => "yes".to_owned(),
                (false, Some(rival)) => format!("or {rival}"),
                (false, None) => "no".to_owned(),
            };
            table.row([field.name, field.kind, unit, &needed, field.meaning.trim()].map(str::to_owned));
        }
        format!("shape = \"{}\"  {}\n{table}", shape.name, shape.meaning.trim())
    });
    shapes.collect::<Vec<_>>().join("\n")
}
