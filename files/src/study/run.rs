//! The rows of a study in files.

use super::document::StudyError;
use super::grid::Study;
use super::row::StudyRow;
use crate::output::{csv_writer, pretty_json};
use crate::{Interrupt, OutputError, Staged};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Scenes of a part: some seconds of work, which is all that a run that is broken off loses.
const PART: usize = 512;

/// The table of all rows, what the directory is of, and the folder of the parts while there are some.
const ROWS: &str = "rows.csv";
const STUDY: &str = "study.json";
const PARTS: &str = "parts";

/// study.json.
#[derive(PartialEq, Serialize, Deserialize)]
struct StudyRecord {
    version: String,
    study: String,
    scene: String,
    scenes: usize,
}

/// What came of a study.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct StudyRun {
    /// How many scenes there are.
    pub scenes: usize,
    /// How many rows an earlier run had written.
    pub found: usize,
    /// How many of all rows there are now, by status.
    pub done: usize,
    /// Swept, but not to the end of the path.
    pub stopped: usize,
    /// Not swept.
    pub refused: usize,
    /// The first scene that was not swept, and the reason.
    pub first_refusal: Option<(usize, String)>,
    /// Whether all rows are there.
    pub complete: bool,
}

impl Study {
    /// Sweeps all scenes, on all cores, and writes one row for each to `rows.csv` in the directory `out`, in order. The rows are
    /// written in parts; a run that is broken off, by `interrupt` or otherwise, goes on after the last complete part when it is
    /// started again, and the table is the same. Files that the scene names, beside its own, are taken to be the same.
    ///
    /// # Errors
    /// [`StudyError`]. A scene that cannot be swept is none: its row tells the reason.
    pub fn run(&self, out: &Path, interrupt: &Interrupt) -> Result<StudyRun, StudyError> {
        let scenes = self.count();
        let mut run = StudyRun { scenes, ..StudyRun::default() };
        if self.is_begun(out)? {
            if out.join(ROWS).exists() {
                run.count_all(&out.join(ROWS), true, self.names().count())?;
                return Ok(StudyRun { found: scenes, complete: true, ..run });
            }
        } else {
            let staged = Staged::new(out)?;
            staged.write(STUDY.as_ref(), |out| pretty_json(out, &self.record()))?;
            staged.publish()?;
        }
        for first in (0..scenes).step_by(PART) {
            let last = (first + PART).min(scenes);
            if part(out, first).exists() {
                run.found += last - first;
                run.count_all(&part(out, first), false, self.names().count())?;
                continue;
            }
            let row = |number| (!interrupt.is_raised()).then(|| self.row(number));
            let Some(rows) = (first..last).into_par_iter().map(row).collect::<Option<Vec<_>>>() else { return Ok(run) };
            (first..).zip(&rows).for_each(|(number, row)| run.count(number, row.status(), row.reason.as_deref()));
            self.write_part(out, first, &rows)?;
            interrupt.pass(last as f64 / scenes as f64);
        }
        self.join(out)?;
        run.complete = true;
        Ok(run)
    }

    /// Whether the directory has this study.
    fn is_begun(&self, out: &Path) -> Result<bool, StudyError> {
        let file = out.join(STUDY);
        let text = match fs::read(&file) {
            Ok(text) => text,
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(false),
            Err(source) => return Err(StudyError::Part { file, source }),
        };
        match serde_json::from_slice::<StudyRecord>(&text) {
            Ok(record) if record == self.record() => Ok(true),
            _ => Err(StudyError::Another { file }),
        }
    }

    fn record(&self) -> StudyRecord {
        let [study, scene] = self.texts.clone();
        StudyRecord { version: env!("CARGO_PKG_VERSION").to_owned(), study, scene, scenes: self.count() }
    }

    fn write_part(&self, out: &Path, first: usize, rows: &[StudyRow]) -> Result<(), OutputError> {
        let staged = Staged::new(out)?;
        let name = Path::new(PARTS).join(name(first));
        staged.write(&name, |out| {
            let mut table = csv_writer(out);
            rows.iter().try_for_each(|row| table.write_record(row.cells()))?;
            table.flush()
        })?;
        staged.publish()
    }

    /// One table of all parts, which are not needed any more.
    fn join(&self, out: &Path) -> Result<(), StudyError> {
        let firsts = || (0..self.count()).step_by(PART);
        let staged = Staged::new(out)?;
        staged.write(ROWS.as_ref(), |table| {
            let (scene, others) = (&StudyRow::COLUMNS[..1], &StudyRow::COLUMNS[1..]);
            let names: Vec<&str> = scene.iter().copied().chain(self.names()).chain(others.iter().copied()).collect();
            csv_writer(table).write_record(names)?;
            firsts().try_for_each(|first| table.write_all(&fs::read(part(out, first))?))
        })?;
        staged.publish()?;
        let file = out.join(PARTS);
        fs::remove_dir_all(&file).map_err(|source| StudyError::Part { file, source })?;
        Ok(())
    }
}

impl StudyRun {
    fn count(&mut self, number: usize, status: &str, reason: Option<&str>) {
        match status {
            "done" => self.done += 1,
            "stopped" => self.stopped += 1,
            _ => {
                self.refused += 1;
                self.first_refusal.get_or_insert_with(|| (number, reason.unwrap_or_default().to_owned()));
            }
        }
    }

    /// Counts the rows of a file, which have as many parameters.
    fn count_all(&mut self, file: &Path, has_names: bool, parameters: usize) -> Result<(), StudyError> {
        let broken = |source: csv::Error| StudyError::Part { file: file.to_owned(), source: source.into() };
        let mut table = csv::ReaderBuilder::new().has_headers(has_names).from_path(file).map_err(broken)?;
        for row in table.records() {
            let row = row.map_err(broken)?;
            let cell = |column: usize| row.get(column).unwrap_or_default();
            let number = cell(0).parse().unwrap_or_default();
            self.count(number, cell(1 + parameters), row.iter().next_back());
        }
        Ok(())
    }
}

/// The file of the part that begins with a scene.
fn part(out: &Path, first: usize) -> PathBuf {
    out.join(PARTS).join(name(first))
}

fn name(first: usize) -> String {
    format!("{first:08}.csv")
}
