//! The files of the nine scans: states, figures and paper.json.

use super::PaperError;
use super::figures::{contact_points, criterion, cycles, distances, goodness, notches, transitions};
use super::naive::Naive;
use super::resolved::ResolvedScan;
use super::scans::{Entry, Paper, PaperScan, SCANS};
use crate::results::write_sweep;
use rayon::prelude::*;
use rod_files::output::pretty_json;
use rod_files::{Interrupt, Scan, Staged};
use serde::Serialize;
use std::path::Path;

/// paper.json: whether all scans and figures are there, and how the scans compare with the paper.
#[derive(Serialize)]
struct PaperRecord<'a> {
    /// Whether all scans and the figures of all scans are there.
    complete: bool,
    scans: Vec<PaperScanRecord<'a>>,
    /// Names of the scans that were not done.
    missing: Vec<String>,
}

#[derive(Serialize)]
struct PaperScanRecord<'a> {
    name: &'a str,
    phases: String,
    expected: &'static str,
    matches: bool,
}

impl<'a> From<&'a PaperScan> for PaperScanRecord<'a> {
    fn from(of: &'a PaperScan) -> Self {
        let PaperScan { expected, scan, .. } = of;
        Self { name: &scan.scene.name, phases: scan.cycle().to_string(), expected, matches: of.matches() }
    }
}

impl Paper {
    /// Writes the files of each scan into a folder of its own, and beside the folders paper.json, which says how the scans
    /// compare with the paper, and the figures of all scans: phase cycles and transitions, phase criterion, goodness of
    /// fit, contact points at one distance and at all three, and both contacts where there are two. Interrupted, or where
    /// scans are missing, it leaves these figures out. Returns whether everything was written.
    ///
    /// # Errors
    /// [`PaperError::Write`].
    pub fn write(&self, staged: &Staged, interrupt: &Interrupt) -> Result<bool, PaperError> {
        self.scans.par_iter().try_for_each(|scan| write_sweep(&scan.scan, staged, Path::new(&scan.scan.scene.name)))?;
        let figures = if self.is_complete() { self.figures(interrupt)? } else { None };
        let complete = figures.is_some();
        for (name, figure) in figures.into_iter().flatten() {
            staged.write(Path::new(name), |file| file.write_all(figure.as_bytes()))?;
        }
        staged.write(Path::new("paper.json"), |file| pretty_json(file, &self.record(complete)))?;
        Ok(complete)
    }

    /// Name and content of the figures of all scans; none where they were interrupted.
    fn figures(&self, interrupt: &Interrupt) -> Result<Option<[(&'static str, String); 7]>, PaperError> {
        let naive: Vec<Naive<'_>> = self.scans.par_iter().map(Naive::of).collect::<Result<_, PaperError>>()?;
        let middle: Vec<&Naive<'_>> = naive.iter().filter(|scan| scan.scan.distance == 40).collect();
        if interrupt.is_raised() {
            return Ok(None);
        }
        let resolved: Vec<ResolvedScan<'_>> =
            middle.par_iter().map(|scan| ResolvedScan::of(scan.scan)).collect::<Result<_, PaperError>>()?;
        let middle_scans: Vec<&Scan> = middle.iter().map(|scan| &scan.scan.scan).collect();
        if interrupt.is_raised() {
            return Ok(None);
        }
        Ok(Some([
            ("goodness_of_fit.svg", goodness(&naive)?),
            ("contact_points.svg", contact_points(&middle)?),
            ("criterion.svg", criterion(&middle_scans)?),
            ("phase_cycles.svg", cycles(self)?),
            ("phase_diagram.svg", transitions(self.scans.iter().map(|scan| &scan.scan))?),
            ("distances.svg", distances(&naive)?),
            ("notches.svg", notches(&resolved)?),
        ]))
    }

    fn record(&self, complete: bool) -> PaperRecord<'_> {
        let is_missing = |entry: &&Entry| self.find(entry.0, entry.1).is_none();
        let name = |entry: &Entry| format!("{}_q{}", entry.0, entry.1);
        PaperRecord {
            complete,
            scans: self.scans.iter().map(PaperScanRecord::from).collect(),
            missing: SCANS.iter().filter(is_missing).map(name).collect(),
        }
    }
}
