//! How the table of a file is written.

use super::report::InspectedFile;
use crate::ReadOptions;
use std::path::Path;
use vibrissa::hw::recording::{
    Column, ColumnMap, Constant, Decimal, FileFormat, Header, Outline, Part, Table, TableError, TableOptions,
    TableProblem,
};

/// The table of a file, and where its names come from; none where it cannot be read, which is a fault.
pub(super) fn layout(
    path: &Path,
    read: &ReadOptions,
    file: &mut InspectedFile,
) -> Option<(Table, Header, ReadOptions)> {
    let constants = constants(path, read);
    let mut options = TableOptions { units: Vec::new(), constants: constants.clone(), ..read.options.clone() };
    let mut outline = Outline::read(path, &options);
    if matches!(&outline, Err(TableError { problem: TableProblem::NoHeader, .. })) {
        options.header = Header::None;
        outline = Outline::read(path, &options);
    }
    let found = outline.and_then(|outline| Ok((outline, Table::read(path, &options)?)));
    let (outline, table) = match found {
        Ok(found) => found,
        Err(error) => {
            refuse(&error, file);
            return None;
        }
    };
    describe(&outline, &table, file);
    file.first_other = outline.below.first().map(|part| part.line);
    if let Some(part) = outline.below.first() {
        let found = format!("a second table: {}", names(part));
        let more =
            if outline.below.len() > 1 { format!(", and {} more", outline.below.len() - 1) } else { String::new() };
        file.prevents(part.line, "table", found + &more, "one table; save each in a file of its own");
    }
    if let Some(part) = outline.beside.first() {
        let found = format!("a second table beside the first, behind an empty column: {}", names(part));
        file.prevents(part.line, "table", found, "one table; save each in a file of its own");
    }
    let mut read = of_this(&table, read);
    read.options.constants = constants;
    let mut table = table;
    if !read.options.units.is_empty() {
        let options = TableOptions { units: read.options.units.clone(), ..options.clone() };
        table = Table::read(path, &options).ok()?;
    }
    Some((table, options.header, read))
}

/// What the user said of values that stay the same: those of the table of a stage are for files with a coordinate of the clamp.
fn constants(path: &Path, read: &ReadOptions) -> Vec<Constant> {
    let mut constants = read.options.constants.clone();
    if let Some(stage) = read.stage.as_deref().filter(|stage| !stage.options.constants.is_empty()) {
        let without = TableOptions { units: Vec::new(), constants: Vec::new(), ..read.options.clone() };
        let assigned: Vec<&str> = stage.columns.assigned().map(|(_, name)| name).collect();
        let is_of_stage = |column: &Column| {
            matches!(column.name.as_str(), "x0" | "y0" | "phi0")
                || assigned.iter().any(|name| [&column.name, &column.heading].contains(&&(*name).to_owned()))
        };
        if Table::read(path, &without).is_ok_and(|table| table.columns().iter().any(is_of_stage)) {
            constants.extend(stage.options.constants.iter().cloned());
        }
    }
    constants
}

/// What the user said of columns that this file has: of several files one may have them.
fn of_this(table: &Table, read: &ReadOptions) -> ReadOptions {
    let has = |name: &str| table.columns().iter().any(|column| column.name == name || column.heading == name);
    let both = || [Some(read), read.stage.as_deref()].into_iter().flatten();
    let units = both().flat_map(|read| &read.options.units).filter(|(name, _)| has(name)).cloned().collect();
    let assigned = both().flat_map(|read| read.columns.assigned()).filter(|(_, name)| has(name));
    let columns = assigned.fold(ColumnMap::new(), |map, (role, name)| map.with(role, name));
    ReadOptions { options: TableOptions { units, ..read.options.clone() }, columns, stage: None }
}

fn names(part: &Part) -> String {
    part.names.iter().take(8).cloned().collect::<Vec<_>>().join(", ")
}

fn refuse(error: &TableError, file: &mut InspectedFile) {
    let text = error.problem.to_string();
    match text.split_once("expected ") {
        Some((value, expected)) => {
            let value = value.trim_end_matches([',', ' ', ';']);
            file.prevents(error.line, "table", value, expected);
        }
        None => file.prevents(error.line, "table", text, "a table of names and numbers"),
    }
}

fn describe(outline: &Outline, table: &Table, file: &mut InspectedFile) {
    let mark = if outline.decimal == Decimal::Comma { "comma" } else { "point" };
    match outline.format {
        FileFormat::Text => {
            file.fact("format", format!("text, {} between the cells, decimal {mark}", outline.delimiter));
        }
        FileFormat::Lvm => file.fact("format", "LabVIEW measurement file (LVM)"),
        FileFormat::Workbook => file.fact("format", "workbook of a spreadsheet (.xlsx); lines are rows of its sheet"),
    }
    let names = match (outline.header.or(table.header_line()), outline.units) {
        (Some(names), Some(units)) => format!("names in line {names}, units in line {units}"),
        (Some(names), None) => format!("names in line {names}"),
        (None, _) => "no names: columns are called 1, 2, ... (--header none)".to_owned(),
    };
    let above = outline.header.unwrap_or(outline.first).saturating_sub(1);
    let above = if above > 0 { format!(", {above} lines above it") } else { String::new() };
    file.fact("header", names + &above);
}
