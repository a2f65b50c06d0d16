//! The options that make a reader take a table as it was understood.

use crate::ReadOptions;
use vibrissa::hw::recording::{ColumnMap, Constant, Decimal, Delimiter, Header, Role, Table, TableOptions};

/// Meanings, units and layout, for the command line and for the readers.
#[derive(Clone, Debug, Default)]
pub(super) struct Proposal {
    /// How the table is written.
    pub layout: TableOptions,
    /// Meanings and names of their columns.
    pub columns: Vec<(Role, String)>,
    /// Names of columns and their units.
    pub units: Vec<(String, String)>,
}

impl Proposal {
    /// The same for the readers.
    pub fn read(&self) -> ReadOptions {
        let options = TableOptions { units: self.units.clone(), ..self.layout.clone() };
        let columns = self.columns.iter().fold(ColumnMap::new(), |map, (role, name)| map.with(*role, name));
        ReadOptions { options, columns, stage: None }
    }

    /// As options of the command. `stage` goes before names of the table of a stage.
    pub fn words(&self, stage: &str) -> Vec<String> {
        let mut words = Vec::new();
        for (role, name) in &self.columns {
            words.extend(["--column".to_owned(), format!("{stage}{role}={name}")]);
        }
        for Constant { role, value, unit } in &self.layout.constants {
            words.extend(["--column".to_owned(), format!("{stage}{role}={value}{unit}")]);
        }
        for (name, unit) in &self.units {
            words.extend(["--unit".to_owned(), format!("{stage}{name}={unit}")]);
        }
        words
    }

    /// The layout as options of the command.
    pub fn layout_words(&self) -> Vec<String> {
        let mut words = Vec::new();
        let mut option = |name: &str, value: String| words.extend([format!("--{name}"), value]);
        if let Some(delimiter) = self.layout.delimiter {
            let name = match delimiter {
                Delimiter::Comma => "comma",
                Delimiter::Semicolon => "semicolon",
                Delimiter::Tab => "tab",
                Delimiter::Blanks => "blanks",
            };
            option("delimiter", name.to_owned());
        }
        if let Some(decimal) = self.layout.decimal {
            option("decimal", if decimal == Decimal::Comma { "comma" } else { "point" }.to_owned());
        }
        match &self.layout.header {
            Header::Line(line) => option("header", line.to_string()),
            Header::None => option("header", "none".to_owned()),
            Header::Find | Header::Names(_) => {}
        }
        if let Some(segment) = self.layout.segment {
            option("segment", segment.to_string());
        }
        words
    }

    /// Sets the unit of a column.
    pub fn set_unit(&mut self, name: &str, unit: String) {
        self.units.retain(|known| known.0 != name);
        self.units.push((name.to_owned(), unit));
    }

    /// Sets the column of a meaning.
    pub fn set_column(&mut self, role: Role, name: &str) {
        self.columns.retain(|known| known.0 != role);
        self.columns.push((role, name.to_owned()));
    }
}

/// What a column is called in options: without its unit where that is enough.
pub(super) fn name_of(table: &Table, column: usize) -> String {
    let own = &table.columns()[column];
    let is_unique =
        table.columns().iter().filter(|other| other.name == own.name || other.heading == own.name).count() == 1;
    if is_unique { own.name.clone() } else { own.heading.clone() }
}
