//! Several recordings of one object together.

use crate::output::{pretty_json, write_csv};
use crate::reconstructed::{CONTOUR_COLUMNS, Reconstructed};
use crate::table::Table;
use crate::{Error, Staged, figure};
use serde::Serialize;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use vibrissa::reconstruct::{Calibration, Combined, ContourEstimate, Offset, align, merge};

/// Several recordings of one object, with one rod in one frame, together.
#[derive(Debug)]
pub struct Merged {
    scans: Vec<Scan>,
    /// The direction along which they were moved onto each other, radians; none where they were not.
    align: Option<f64>,
    /// The contour of those that fit their rod.
    pub contour: ContourEstimate,
    /// The errors that stay the same from scan to scan; none where no scan tells of them.
    combined: Option<Combined>,
}

/// One of the recordings.
#[derive(Debug, Serialize)]
struct Scan {
    recording: PathBuf,
    folder: String,
    /// Whether recording, units and rod fit together. If not, the merged contour is without it.
    fits: bool,
    /// How far it was moved, m.
    offset: f64,
    /// Scans of one group overlap: offsets are known within it.
    group: Option<usize>,
}

#[derive(Serialize)]
struct MergedRecord<'a> {
    scans: &'a [Scan],
    align: Option<f64>,
    chi_squared: Option<f64>,
    freedom: Option<usize>,
    contradict: bool,
}

impl Merged {
    /// Of reconstructions, whose names are made distinct: they are folders. With a direction (radians) for `direction`, scans are moved
    /// along it onto each other; otherwise their poses are in one frame. Scans that do not fit their rod do not count.
    pub fn of(found: &mut [Reconstructed], direction: Option<f64>) -> Self {
        distinct(found);
        let fitting = || found.iter().filter(|one| one.check.fits());
        let contours: Vec<ContourEstimate> = fitting().map(|one| one.contour.clone()).collect();
        let offsets: Vec<Offset> = direction.map_or_else(Vec::new, |direction| align(&contours, direction));
        let moved = contours.iter().zip(&offsets).map(|(one, offset)| offset.applied(one, direction.unwrap_or(0.0)));
        let contour = if direction.is_some() { merge(&moved.collect::<Vec<_>>()) } else { merge(&contours) };
        let passes = fitting().flat_map(|one| &one.found.passes);
        let calibrations: Vec<Calibration> = passes.filter_map(|pass| pass.calibration.clone()).collect();
        let mut offsets = offsets.into_iter();
        let scan = |one: &Reconstructed| {
            let fits = one.check.fits();
            let offset = if fits { offsets.next() } else { None };
            Scan {
                recording: one.recording.file.clone(),
                folder: one.name.clone(),
                fits,
                offset: offset.map_or(0.0, |offset| offset.value),
                group: offset.map(|offset| offset.group),
            }
        };
        let scans = found.iter().map(scan).collect();
        Self { scans, align: direction, contour, combined: Combined::of(&calibrations) }
    }

    /// Whether the scans contradict each other: errors of rod, sensor, clamp or stage that should stay the same differ.
    pub fn contradicts(&self) -> bool {
        self.combined.as_ref().is_some_and(Combined::contradicts)
    }

    /// Writes contour.csv, contour.svg and merged.json.
    ///
    /// # Errors
    /// [`Error::Output`], [`Error::Figure`].
    pub fn write(&self, staged: &Staged) -> Result<(), Error> {
        let Self { scans, align, combined, .. } = self;
        let record = MergedRecord {
            scans,
            align: *align,
            chi_squared: combined.as_ref().map(|combined| combined.chi_squared),
            freedom: combined.as_ref().map(|combined| combined.freedom),
            contradict: self.contradicts(),
        };
        staged.write(Path::new("contour.csv"), |file| write_csv(file, &CONTOUR_COLUMNS, self.contour.rows()))?;
        staged.write(Path::new("merged.json"), |file| pretty_json(file, &record))?;
        let drawing = figure::merged(&self.contour)?;
        staged.write(Path::new("contour.svg"), |file| file.write_all(drawing.as_bytes()))?;
        Ok(())
    }

    /// The scans with their offsets, what they say together, and the merged contour in words.
    pub fn summary(&self) -> String {
        let mut text = String::new();
        let mut table = Table::new(["recording", "fits its rod", "moved mm", "group"]);
        for Scan { folder, fits, offset, group, .. } in &self.scans {
            let fits = if *fits { "yes" } else { "no, left out" };
            let group = group.map_or_else(|| "-".to_owned(), |group| (group + 1).to_string());
            table.row([folder.clone(), fits.to_owned(), format!("{:.4}", 1e3 * offset), group]);
        }
        text += &table.to_string();
        if let Some(Combined { chi_squared, freedom, .. }) = self.combined.as_ref().filter(|all| all.freedom > 0) {
            let verdict = if self.contradicts() { "the scans contradict each other" } else { "the scans agree" };
            // Writing to a string cannot fail.
            let _ = writeln!(
                text,
                "errors that stay the same from scan to scan: chi-squared of their differences {chi_squared:.1} with {freedom} \
                 degrees of freedom; {verdict}"
            );
        }
        let length: f64 = self.contour.traces.iter().map(|trace| trace.length()).sum();
        let (traces, gaps) = (self.contour.traces.len(), self.contour.gaps.len());
        let _ = writeln!(text, "merged contour: {traces} stretches of {:.1} mm together, {gaps} gaps", 1e3 * length);
        text
    }
}

/// Gives each a name of its own.
fn distinct(found: &mut [Reconstructed]) {
    for k in 1..found.len() {
        let own = found[k].name.clone();
        let taken = |name: &str| found[..k].iter().any(|before| before.name == name);
        let mut name = own.clone();
        for number in 2.. {
            if !taken(&name) {
                break;
            }
            name = format!("{own}-{number}");
        }
        found[k].name = name;
    }
}
