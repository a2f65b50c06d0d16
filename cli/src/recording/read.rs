//! From a file to a recording.

use super::columns::{Columns, Wrong};
use super::row::{RowFault, RowProblem, plain, sample};
use super::{Recording, RecordingError, Row};
use csv::ByteRecord;
use std::path::Path;
use vibrissa::{Halt, Rod, Travel};

/// Fewer samples than this are no scan: a curve through them would leave nothing to judge it by.
const FEWEST: usize = 10;

impl Recording {
    /// The recording in a file. The rod's length says how far a clamp that turns has gone.
    ///
    /// # Errors
    /// [`RecordingError`]: the file cannot be read, columns are missing, more than half of the rows cannot be used, or
    /// fewer than 10 can.
    pub fn read(file: &Path, rod: &Rod) -> Result<Self, RecordingError> {
        let text =
            std::fs::read(file).map_err(|source| RecordingError::Unreadable { file: file.to_path_buf(), source })?;
        Self::parse(file, &text, rod)
    }

    /// The recording in a text. `file` names it in messages; it is not opened.
    ///
    /// ```
    /// use vibrissa_cli::Recording;
    /// let rod = vibrissa::Rod::new(0.1, 6.32e-4)?;
    /// let mut text = "x0,y0,phi0,f0x,f0y,m0z\n".to_owned();
    /// for k in 0..20 {
    ///     text += &format!("{},-0.04,1.5,0,0,{}\n", 0.08 - 1e-3 * f64::from(k), if k == 7 { "oops" } else { "0" });
    /// }
    /// let recording = Recording::parse("recording.csv".as_ref(), text.as_bytes(), &rod)?;
    /// assert_eq!((recording.rows.len(), recording.samples().count()), (20, 19));
    /// let fault = recording.rows[7].as_ref().unwrap_err();
    /// assert_eq!(fault.to_string(), "line 9: m0z is `oops`, expected a number");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As [`read`](Self::read), but for an unreadable file.
    pub fn parse(file: &Path, text: &[u8], rod: &Rod) -> Result<Self, RecordingError> {
        let file = file.to_path_buf();
        // Numbers need no quotes, and a quote in a comment must not swallow the lines after it.
        let text = text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(text);
        let mut reader = csv::ReaderBuilder::new().has_headers(false).flexible(true).quoting(false).from_reader(text);
        let mut lines = Lines::new(text);
        let mut record = ByteRecord::new();
        if !next(&mut reader, &mut record) {
            return Err(RecordingError::Empty { file });
        }
        let line = lines.of(&record);
        let columns = Columns::find(&record).map_err(|wrong| {
            let file = file.clone();
            match wrong {
                Wrong::Missing { missing, found, hint } => RecordingError::Missing { file, line, missing, found, hint },
                Wrong::Twice(column) => RecordingError::Twice { file, line, column },
            }
        })?;

        let mut rows: Vec<Row> = Vec::new();
        let mut late = Vec::new();
        let mut time = f64::NEG_INFINITY;
        let mut travel = Travel::new(rod);
        // line of the last usable row
        let mut of = line;
        while next(&mut reader, &mut record) {
            let line = lines.of(&record);
            let row = sample(&record, &columns).and_then(|sample| match travel.go(&sample.pose) {
                Ok(_) => {
                    of = line;
                    Ok(sample)
                }
                Err(Halt::Repeated) => Err((Some(sample.pose), RowProblem::Repeated { of })),
                Err(_) => Err((Some(sample.pose), RowProblem::TurnsBack { of })),
            });
            if let Ok(t) = row.as_ref().map(|sample| sample.t.unwrap_or(f64::NAN)) {
                if t <= time {
                    late.push(line);
                }
                time = t;
            }
            rows.push(row.map_err(|(pose, problem)| RowFault { line, pose, problem }));
        }
        let usable = rows.iter().filter(|row| row.is_ok()).count();
        if 2 * usable < rows.len() {
            let count = rows.len();
            let faults = rows.into_iter().filter_map(Result::err).collect();
            return Err(RecordingError::Unusable { file, rows: count, faults });
        }
        if usable < FEWEST {
            return Err(RecordingError::TooFew { file, usable, expected: FEWEST });
        }
        Ok(Self { file, rows, ignored: columns.ignored, late })
    }
}

/// The next record that is neither blank nor a comment. Bytes in memory can always be read.
fn next(reader: &mut csv::Reader<&[u8]>, record: &mut ByteRecord) -> bool {
    while reader.read_byte_record(record).unwrap_or(false) {
        let first = plain(record.get(0).unwrap_or_default());
        let blank = first.is_empty() && record.len() == 1;
        if !blank && !first.starts_with(b"#") {
            return true;
        }
    }
    false
}

/// Counts lines.
struct Lines<'a> {
    text: &'a [u8],
    at: usize,
    line: u64,
}

impl<'a> Lines<'a> {
    fn new(text: &'a [u8]) -> Self {
        Self { text, at: 0, line: 1 }
    }

    /// Line of the next record, from 1. The reader's own count leaves out the blank lines just before it.
    fn of(&mut self, record: &ByteRecord) -> u64 {
        let start = record.position().map_or(0, |position| position.byte() as usize).min(self.text.len());
        let blank = self.text[start..].iter().take_while(|byte| matches!(byte, b'\r' | b'\n')).count();
        let start = start + blank;
        if let Some(passed) = self.text.get(self.at..start) {
            self.line += passed.iter().filter(|byte| **byte == b'\n').count() as u64;
            self.at = start;
        }
        self.line
    }
}
