//! The files of a reconstruction.

use super::fit::FITTED_COLUMNS;
use super::points::PointRecord;
use super::report::ReportRecord;
use super::result::Reconstructed;
use crate::output::{pretty_json, write_csv};
use crate::{OutputError, Staged};
use std::io::{self, Write};
use std::path::Path;

/// Columns of contour.csv.
pub const COLUMNS: [&str; 7] = ["stretch", "kind", "x", "y", "alpha", "sigma", "sigma_systematic"];

impl Reconstructed {
    /// Writes points.jsonl, contour.csv and report.json, and fitted.csv where there is a fit, into `folder` of the staged directory.
    ///
    /// # Errors
    /// [`OutputError`].
    pub fn write(&self, staged: &Staged, folder: &Path) -> Result<(), OutputError> {
        staged.write(&folder.join("points.jsonl"), |file| self.write_points(file))?;
        staged.write(&folder.join("contour.csv"), |file| write_csv(file, &COLUMNS, self.contour.rows()))?;
        let fitted = folder.join("fitted.csv");
        match self.fitted_contour() {
            Some(points) => staged.write(&fitted, |file| write_csv(file, &FITTED_COLUMNS, points))?,
            None => staged.remove(&fitted)?,
        }
        staged.write(&folder.join("report.json"), |file| pretty_json(file, &ReportRecord::of(self)))?;
        Ok(())
    }

    /// One row of the recording a line, in order, as JSON.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write_points(&self, out: &mut dyn Write) -> io::Result<()> {
        let mut line = Vec::new();
        let mut sample = 0;
        for row in &self.recording.rows {
            let record = match row {
                Ok(_) => {
                    sample += 1;
                    PointRecord::of_sample(self, sample - 1)
                }
                Err(fault) => PointRecord::of_fault(fault),
            };
            line.clear();
            serde_json::to_writer(&mut line, &record)?;
            line.push(b'\n');
            out.write_all(&line)?;
        }
        Ok(())
    }
}
