//! A table of numbers by the names of its columns.

use super::error::FilmError;
use std::path::{Path, PathBuf};

/// Most faults that are told.
const MOST_FAULTS: usize = 5;

/// Most names of columns that are told.
const MOST_NAMES: usize = 20;

/// Up to here every whole number is a float.
const MOST_WHOLE: f64 = 9e15;

/// Whether a number can be a standard deviation.
pub(super) fn is_deviation(sigma: f64) -> bool {
    sigma > 0.0 && sigma.is_finite()
}

/// What separates the cells: of commas, semicolons and tabs what the line of names has most of.
fn delimiter(text: &[u8]) -> u8 {
    let names = text.split(|byte| *byte == b'\n').find(|line| !line.starts_with(b"#")).unwrap_or_default();
    let count = |delimiter: u8| names.iter().filter(|byte| **byte == delimiter).count();
    [b',', b';', b'\t'].into_iter().rev().max_by_key(|delimiter| count(*delimiter)).unwrap_or(b',')
}

/// Names and rows of a CSV file.
pub(super) struct Numbers {
    pub file: PathBuf,
    names: Vec<String>,
    rows: Vec<(u64, csv::StringRecord)>,
    faults: Vec<String>,
    left_out: usize,
}

impl Numbers {
    pub fn read(file: &Path) -> Result<Self, FilmError> {
        let unreadable = |source| FilmError::Unreadable { file: file.to_path_buf(), source };
        let text = std::fs::read(file).map_err(|source| unreadable(source.into()))?;
        let mut reader = csv::ReaderBuilder::new()
            .delimiter(delimiter(&text))
            .trim(csv::Trim::All)
            .comment(Some(b'#'))
            .flexible(true)
            .from_reader(text.as_slice());
        let names = reader
            .headers()
            .map_err(unreadable)?
            .iter()
            .map(|name| name.trim_start_matches('\u{feff}').to_owned())
            .collect();
        let mut rows = Vec::new();
        for record in reader.records() {
            let record = record.map_err(unreadable)?;
            rows.push((record.position().map_or(0, csv::Position::line), record));
        }
        let mut table = Self { file: file.to_path_buf(), names, rows, faults: Vec::new(), left_out: 0 };
        for row in 0..table.rows.len() {
            let (cells, columns) = (table.rows[row].1.len(), table.names.len());
            if cells != columns {
                table.fault(row, &format!("{cells} cells, expected {columns}, one for each column"));
            }
        }
        if table.rows.is_empty() { Err(FilmError::Empty { file: table.file }) } else { Ok(table) }
    }

    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// The names of some of the columns.
    pub fn names_where(&self, is_meant: impl Fn(usize) -> bool) -> Vec<String> {
        let columns = self.names.iter().enumerate();
        columns.filter(|(column, _)| is_meant(*column)).map(|(_, name)| name.clone()).collect()
    }

    pub fn len(&self) -> usize {
        self.rows.len()
    }

    pub fn column(&self, name: &str) -> Option<usize> {
        self.names.iter().position(|own| own.eq_ignore_ascii_case(name))
    }

    /// The column of this name.
    pub fn needed(&self, name: &str, expected: &'static str) -> Result<usize, FilmError> {
        self.column(name).ok_or_else(|| FilmError::Missing {
            file: self.file.clone(),
            missing: name.to_owned(),
            found: self.found(),
            expected: self.expected(expected),
        })
    }

    /// The names, each once, and not more than a person reads.
    pub fn found(&self) -> String {
        let mut names: Vec<&str> = Vec::new();
        for name in &self.names {
            if !names.contains(&name.as_str()) {
                names.push(name);
            }
        }
        let more = names.len().saturating_sub(MOST_NAMES);
        let listed = names.iter().take(MOST_NAMES).copied().collect::<Vec<_>>().join(", ");
        if more > 0 { format!("{listed} and {more} more") } else { listed }
    }

    /// What is expected of the table, or how the file of a tracker becomes one.
    pub fn expected(&self, expected: &'static str) -> &'static str {
        match self.names.first().map(String::as_str) {
            Some("scorer") => {
                "a table of points: this is a file of DeepLabCut, which vibrissa.tracking.read_deeplabcut in Python converts"
            }
            Some("track") if self.column("frame_idx").is_some() => {
                "a table of points: this is a file of SLEAP, which vibrissa.tracking.read_sleap in Python converts"
            }
            _ => expected,
        }
    }

    /// The number in a cell; none in an empty one, and where it is no number, which is a fault.
    pub fn number(&mut self, row: usize, column: usize) -> Option<f64> {
        let cell = self.rows[row].1.get(column).unwrap_or_default();
        if cell.is_empty() {
            return None;
        }
        match cell.parse::<f64>() {
            Ok(number) => Some(number).filter(|number| !number.is_nan()),
            Err(_) => {
                let fault = format!("{} is `{cell}`, expected a number", self.names[column]);
                self.fault(row, &fault);
                None
            }
        }
    }

    /// The number of a frame; none where it is none, which is a fault.
    pub fn whole(&mut self, row: usize, column: usize) -> Option<i64> {
        match self.number(row, column) {
            Some(number) if number.fract() == 0.0 && number.abs() < MOST_WHOLE => Some(number as i64),
            Some(number) => {
                self.fault(row, &format!("frame is {number}, expected a whole number"));
                None
            }
            None => {
                if self.rows[row].1.get(column).unwrap_or_default().is_empty() {
                    self.fault(row, "frame is empty, expected a whole number");
                }
                None
            }
        }
    }

    pub fn fault(&mut self, row: usize, fault: &str) {
        if self.faults.len() < MOST_FAULTS {
            self.faults.push(format!("line {}: {fault}", self.rows[row].0));
        } else {
            self.left_out += 1;
        }
    }

    /// The faults of all rows, if there are any.
    pub fn check(&mut self) -> Result<(), FilmError> {
        if self.faults.is_empty() {
            return Ok(());
        }
        let mut faults = std::mem::take(&mut self.faults);
        if self.left_out > 0 {
            faults.push(format!("and {} more", self.left_out));
        }
        Err(FilmError::Rows { file: self.file.clone(), faults })
    }
}
