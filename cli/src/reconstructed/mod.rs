//! A recording, turned back into contact points, phases and a contour.
//!
//! `points` is the line of a sample, `report` what is said of the whole, `summary` the same for people, and `truth` the
//! comparison with the scene that the recording is of.

mod points;
mod report;
mod summary;
mod truth;

pub(crate) use truth::naive_touch;
pub use truth::{Comparison, Transition, TruthError};

use crate::output::{pretty_json, write_csv};
use crate::{Error, Recording, Scene, Staged, figure};
pub(crate) use points::PointRecord;
use report::ReportRecord;
use std::io::{self, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};
use vibrissa::reconstruct::kink::Kink;
use vibrissa::reconstruct::{Assembly, ContourEstimate, Plausibility, Travel, plausibility};
use vibrissa::{Label, Pose, Rod, Sample, Settings, reconstruct};

/// Columns of contour.csv.
const COLUMNS: [&str; 6] = ["stretch", "kind", "x", "y", "alpha", "sigma"];

/// Why a recording says nothing at all.
#[derive(Debug, thiserror::Error)]
#[error("{}: {source}", file.display())]
pub struct ReconstructionError {
    /// Which recording.
    pub file: PathBuf,
    /// Why.
    pub source: vibrissa::reconstruct::ReconstructError,
}

/// What a recording says of an object.
#[derive(Debug)]
pub struct Reconstructed {
    /// What to call it: the name of the recording without its extension.
    pub name: String,
    /// The recording.
    pub recording: Recording,
    /// The rod that it is taken to be of.
    pub rod: Rod,
    /// The samples of its usable rows.
    pub samples: Vec<Sample>,
    /// Numbers of those rows, from 0.
    pub rows: Vec<usize>,
    /// What was found, one reading for each of the samples.
    pub found: vibrissa::reconstruct::Reconstruction,
    /// The contour. Its samples are numbered as `samples`.
    pub contour: ContourEstimate,
    /// What the physics says of the recording.
    pub check: Plausibility,
    /// How near it is to the truth, where that is known.
    pub comparison: Option<Comparison>,
}

impl Reconstructed {
    /// Reconstructs what a recording tells, as it is: nothing in it is corrected.
    ///
    /// # Errors
    /// [`Error::Reconstruction`]: too few samples are of use.
    pub fn new(recording: Recording, rod: Rod) -> Result<Self, Error> {
        let usable = recording.rows.iter().enumerate().filter_map(|(row, sample)| Some((row, *sample.as_ref().ok()?)));
        let (rows, samples): (Vec<usize>, Vec<Sample>) = usable.unzip();
        let found = reconstruct(&rod, &samples, &Settings::default())
            .map_err(|source| ReconstructionError { file: recording.file.clone(), source })?;
        let contour = found.contour(&Assembly::default());
        let check = plausibility(&rod, &samples);
        let name = recording.file.file_stem().unwrap_or(recording.file.as_os_str()).to_string_lossy().into_owned();
        Ok(Self { name, recording, rod, samples, rows, found, contour, check, comparison: None })
    }

    /// Compares with the scene that the recording is of, which is swept for it.
    ///
    /// # Errors
    /// [`Error::Contact`], [`Error::Truth`].
    pub fn compare(&mut self, scene: Scene) -> Result<(), Error> {
        self.comparison = Some(Comparison::of(self, scene)?);
        Ok(())
    }

    /// Writes points.jsonl, contour.csv, report.json, contour.svg and phases.svg.
    ///
    /// # Errors
    /// [`Error::Output`], [`Error::Figure`].
    pub fn write(&self, staged: &Staged) -> Result<(), Error> {
        staged.write(Path::new("points.jsonl"), |file| self.write_points(file))?;
        staged.write(Path::new("contour.csv"), |file| write_csv(file, &COLUMNS, self.contour.rows()))?;
        staged.write(Path::new("report.json"), |file| pretty_json(file, &ReportRecord::of(self)))?;
        for (name, figure) in [("contour.svg", figure::reconstruction(self)?), ("phases.svg", figure::reactions(self)?)]
        {
            staged.write(Path::new(name), |file| file.write_all(figure.as_bytes()))?;
        }
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

    /// The runs of samples with one label, in order.
    pub(crate) fn runs(&self) -> impl Iterator<Item = (Range<usize>, Label)> + '_ {
        let runs = &self.found.runs;
        let ends = runs.iter().skip(1).map(|run| run.0).chain([self.samples.len()]);
        runs.iter().zip(ends).map(|(&(first, label), end)| (first..end, label))
    }

    /// Where the clamp was at the kinks: between the samples on either side.
    pub(crate) fn kink_poses(&self) -> Vec<Pose> {
        let mut travel = Travel::new(&self.rod);
        let ways: Vec<f64> = self.samples.iter().map(|s| travel.go(&s.pose).unwrap_or(f64::NAN)).collect();
        let pose = |kink: &Kink| {
            let after = kink.next.clamp(1, self.samples.len() - 1);
            let [a, b] = [after - 1, after].map(|k| self.samples[k].pose);
            let part = (kink.tau - ways[after - 1]) / (ways[after] - ways[after - 1]);
            let part = if part.is_finite() { part.clamp(0.0, 1.0) } else { 0.5 };
            let between = |a: f64, b: f64| a + part * (b - a);
            Pose { x: between(a.x, b.x), y: between(a.y, b.y), phi: between(a.phi, b.phi) }
        };
        self.found.kinks.iter().map(pose).collect()
    }
}
