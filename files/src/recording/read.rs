//! From a file to a recording.

use super::columns::find;
use super::row::{RowFault, RowProblem, sample};
use super::{Place, ReadOptions, Recording, RecordingError, Row};
use crate::simulation::INCOMPLETE;
use std::path::{Path, PathBuf};
use vibrissa::Rod;
use vibrissa::hw::recording::{RowProblem as CellProblem, Table, TableError, TableProblem};
use vibrissa::reconstruct::{FEWEST_SAMPLES, Halt, Travel};

/// The column of a roller's reaction, perhaps with a unit behind its name.
const ROLLER: &str = "roller";

/// At most one row in so many may be left out because the clamp repeats a pose or turns back there.
const HALTS: usize = 20;

impl Recording {
    /// The recording in a file. The rod's length says how far a clamp that turns has gone.
    ///
    /// # Errors
    /// [`RecordingError`]: the file cannot be read, columns are missing, more than half of the rows cannot be used, or
    /// fewer than [`FEWEST_SAMPLES`] can.
    pub fn read(file: &Path, rod: &Rod, how: &ReadOptions) -> Result<Self, RecordingError> {
        Self::of_table(file, Table::read(file, &how.options), rod, how)
    }

    /// The recording in a text. `file` names it in messages; it is not opened.
    ///
    /// ```
    /// use rod_files::Recording;
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
        let how = ReadOptions::default();
        Self::of_table(file, Table::parse(&file.display().to_string(), text, &how.options), rod, &how)
    }

    fn of_table(
        file: &Path,
        table: Result<Table, TableError>,
        rod: &Rod,
        how: &ReadOptions,
    ) -> Result<Self, RecordingError> {
        let file = file.to_path_buf();
        let table = table.map_err(|error| match error.problem {
            TableProblem::Empty => RecordingError::Empty { file: file.clone() },
            TableProblem::Unreadable(source) => RecordingError::Unreadable { file: file.clone(), source },
            problem => RecordingError::Table(TableError { problem, ..error }),
        })?;
        let columns = find(&file, &table, &how.columns)?;
        if columns.ignored(&table).any(|name| name.split_whitespace().next() == Some(ROLLER)) {
            return Err(RecordingError::Roller { file });
        }
        let rows = table.rows().map(|row| {
            let place = Place::Line(row.line());
            (place, sample(&row, &columns).map_err(|(pose, problem)| RowFault { place, pose, problem }))
        });
        let recording = Self::of_rows(file, rows, rod)?;
        let ignored = columns.ignored(&table).map(str::to_owned).collect();
        let cut = |row: &Row| matches!(row, Err(RowFault { problem, .. }) if is_cut(problem));
        let cut = recording.rows.last().is_some_and(cut) || table.is_whole() == Some(false);
        let incomplete = table.note(INCOMPLETE).map(str::to_owned);
        Ok(Self { ignored, cut, incomplete, ..recording })
    }

    /// From rows with their places. The rod's length says how far a clamp that turns has gone.
    pub(crate) fn of_rows(
        file: PathBuf,
        placed: impl Iterator<Item = (Place, Row)>,
        rod: &Rod,
    ) -> Result<Self, RecordingError> {
        let (mut rows, mut late, mut places) = (Vec::<Row>::new(), Vec::new(), Vec::new());
        let mut time = f64::NEG_INFINITY;
        for (place, row) in placed {
            if let Ok(t) = row.as_ref().map(|sample| sample.t.unwrap_or(f64::NAN)) {
                if t <= time {
                    late.push(place);
                }
                time = t;
            }
            rows.push(row);
            places.push(place);
        }
        let halts = halts(&rows, &places, rod);
        // if there are more, the clamp trembles, stands or turns back on purpose: then the reconstruction needs all rows
        if HALTS * halts.len() <= rows.len() {
            halts.into_iter().for_each(|(row, fault)| rows[row] = Err(fault));
        }
        let usable = rows.iter().filter(|row| row.is_ok()).count();
        if 2 * usable < rows.len() {
            let count = rows.len();
            let faults = rows.into_iter().filter_map(Result::err).collect();
            return Err(RecordingError::Unusable { file, rows: count, faults });
        }
        if usable < FEWEST_SAMPLES {
            return Err(RecordingError::TooFew { file, usable, expected: FEWEST_SAMPLES });
        }
        Ok(Self { file, rows, ignored: Vec::new(), late, cut: false, incomplete: None, notes: Vec::new() })
    }
}

/// The rows at which the clamp does not go on.
fn halts(rows: &[Row], places: &[Place], rod: &Rod) -> Vec<(usize, RowFault)> {
    let (mut travel, mut of, mut halts) = (Travel::new(rod), Place::Line(0), Vec::new());
    for (number, (row, &place)) in rows.iter().zip(places).enumerate() {
        let Ok(sample) = row else { continue };
        let problem = match travel.go(&sample.pose) {
            Ok(_) => {
                of = place;
                continue;
            }
            Err(Halt::Repeated) => RowProblem::Repeated { of },
            Err(_) => RowProblem::TurnsBack { of },
        };
        halts.push((number, RowFault { place, pose: Some(sample.pose), problem }));
    }
    halts
}

fn is_cut(problem: &RowProblem) -> bool {
    matches!(problem, RowProblem::Cell(CellProblem::Cells { cut: true, .. }))
}
