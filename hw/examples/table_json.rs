//! The tables in a file, as JSON: `cargo run -p rod-hw --features recordings --example table_json -- FILE...`.
#![allow(clippy::print_stdout)]

use rod_hw::recording::{Cell, Row, Table, TableOptions};
use serde_json::{Value, json};
use std::path::Path;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    for file in std::env::args().skip(1) {
        let tables = Table::read_all(Path::new(&file), &TableOptions::default())?;
        println!("{}", tables.iter().map(json_of).collect::<Value>());
    }
    Ok(())
}

fn json_of(table: &Table) -> Value {
    let columns = table.columns().iter().map(|column| json!({ "name": column.name, "unit": column.unit }));
    let cells = |row: Row<'_>| -> Value {
        let values = (0..table.columns().len()).map(|at| match row.cell(at) {
            Cell::Number(value) => json!(value), // null where it is not finite
            Cell::Empty => Value::Null,
            Cell::Text(text) => json!(text),
        });
        values.collect()
    };
    let rows = table.rows().map(cells);
    let faults = table.faults().map(|fault| fault.to_string());
    json!({
        "columns": columns.collect::<Value>(),
        "lines": table.rows().map(|row| row.line()).collect::<Value>(),
        "rows": rows.collect::<Value>(),
        "faults": faults.collect::<Value>(),
    })
}
