//! Several recordings of one object together.

use crate::{WriteError, figure};
use rod_files::Staged;
use rod_files::output::{pretty_json, write_csv};
use rod_files::table::Table;
use rod_files::{CONTOUR_COLUMNS, Reconstructed, Together};
use serde::Serialize;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use vibrissa::reconstruct::{Calibration, Combined, Comparison, ContourEstimate, Disagreement, Offset, align, merge};

/// Several recordings of one object, with one rod in one frame, together.
#[derive(Debug)]
pub struct Merged {
    scans: Vec<MergedScan>,
    /// The direction along which they were moved onto each other, radians; none where they were not.
    align: Option<f64>,
    /// The contour of those that fit their rod.
    pub contour: ContourEstimate,
    /// The errors that stay the same from scan to scan; none where no scan tells of them.
    combined: Option<Combined>,
    /// Where their contours disagree, in order of x.
    disagreements: Vec<Disagreement>,
    /// Whether one contour explains all; none where that was not looked at.
    together: Option<Together>,
}

/// Part of the merged contour's length in which contours may disagree by chance, as at corners.
const BY_CHANCE: f64 = 0.02;

/// One of the recordings.
#[derive(Debug, Serialize)]
struct MergedScan {
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
    scans: &'a [MergedScan],
    align: Option<f64>,
    together: Option<Together>,
    chi_squared: Option<f64>,
    freedom: Option<usize>,
    contradict: bool,
    disagree: Vec<DisagreementRecord>,
}

/// An interval in which contours disagree, m.
#[derive(Serialize)]
struct DisagreementRecord {
    from_x: f64,
    to_x: f64,
    gap: f64,
    sigma: f64,
}

impl Merged {
    /// Of reconstructions, whose names are made distinct: they are folders. With a direction (radians) for `direction`, scans are moved
    /// along it onto each other; otherwise their poses are in one frame. Scans that do not fit their rod do not count.
    pub fn of(found: &mut [Reconstructed], direction: Option<f64>, together: Option<Together>) -> Self {
        distinct(found);
        let fitting = || found.iter().filter(|one| one.fits());
        let contours: Vec<ContourEstimate> = fitting().map(|one| one.contour.clone()).collect();
        let offsets: Vec<Offset> = direction.map_or_else(Vec::new, |direction| align(&contours, direction));
        let contours = match direction {
            Some(direction) => contours.iter().zip(&offsets).map(|(one, by)| by.applied(one, direction)).collect(),
            None => contours,
        };
        let contour = merge(&contours);
        let disagreements = Comparison::default().disagreements(&contours);
        let passes = fitting().enumerate().flat_map(|(k, one)| one.found.passes.iter().map(move |pass| (k, pass)));
        let calibrations: Vec<(usize, Calibration)> =
            passes.filter_map(|(k, pass)| Some((k, pass.calibration.clone()?))).collect();
        let mut offsets = offsets.into_iter();
        let scan = |one: &Reconstructed| {
            let fits = one.fits();
            let offset = if fits { offsets.next() } else { None };
            MergedScan {
                recording: one.recording.file.clone(),
                folder: one.name.clone(),
                fits,
                offset: offset.map_or(0.0, |offset| offset.value),
                group: offset.map(|offset| offset.group),
            }
        };
        let scans = found.iter().map(scan).collect();
        // errors that were fitted together do not differ
        let is_one = together.is_some_and(|together| together.explains);
        let combined = if is_one { None } else { Combined::of(&calibrations) };
        Self { scans, align: direction, contour, combined, disagreements, together }
    }

    /// Why the scans contradict each other, if they do: errors of rod, sensor, clamp or stage that should stay the same differ, or contours
    /// of one place are apart, or no contour explains all.
    pub fn contradictions(&self) -> Vec<String> {
        let mut found: Vec<String> = self.together.iter().filter_map(Together::contradiction).collect();
        if let Some(Combined { chi_squared, freedom, .. }) = self.combined.as_ref().filter(|all| all.contradicts()) {
            found.push(format!(
                "the scans contradict each other: errors of rod, sensor, clamp or stage that should stay the same differ (chi-squared \
                 {chi_squared:.1} with {freedom} degrees of freedom); reconstruct them one by one to find the one that differs"
            ));
        }
        let apart: f64 = self.disagreements.iter().map(|here| here.to - here.from).sum();
        let worst = self.disagreements.iter().max_by(|a, b| a.significance().total_cmp(&b.significance()));
        if let Some(Disagreement { from, to, gap, sigma }) = worst.filter(|_| apart > BY_CHANCE * self.length()) {
            let hint = if self.align.is_some() { "" } else { ", or move them onto each other with --align" };
            found.push(format!(
                "the contours of the scans disagree: at x from {:.2} to {:.2} mm they are {:.3} mm apart, {:.0} standard deviations; \
                 check that object and frame are the same{hint}",
                1e3 * from,
                1e3 * to,
                1e3 * gap,
                gap / sigma
            ));
        }
        found
    }

    /// Length of the merged contour, m.
    fn length(&self) -> f64 {
        self.contour.traces.iter().map(|trace| trace.length()).sum()
    }

    /// Writes contour.csv, contour.svg and merged.json.
    ///
    /// # Errors
    /// [`WriteError`].
    pub fn write(&self, staged: &Staged) -> Result<(), WriteError> {
        let Self { scans, align, combined, together, .. } = self;
        let record = MergedRecord {
            scans,
            align: *align,
            together: *together,
            chi_squared: combined.as_ref().map(|combined| combined.chi_squared),
            freedom: combined.as_ref().map(|combined| combined.freedom),
            contradict: !self.contradictions().is_empty(),
            disagree: self.disagreements.iter().map(DisagreementRecord::from).collect(),
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
        for MergedScan { folder, fits, offset, group, .. } in &self.scans {
            let fits = if *fits { "yes" } else { "no, left out" };
            let group = group.map_or_else(|| "-".to_owned(), |group| (group + 1).to_string());
            table.row([folder.clone(), fits.to_owned(), format!("{:.4}", 1e3 * offset), group]);
        }
        text += &table.to_string();
        if let Some(Together { recordings, explains, chi_squared, degrees_of_freedom, .. }) = &self.together {
            let of = format!("chi squared {chi_squared:.0} of {degrees_of_freedom:.0} degrees of freedom");
            let _ = match explains {
                true => writeln!(
                    text,
                    "one contour explains {recordings} recordings, {of}; their labels, points and errors are its own"
                ),
                false => writeln!(text, "no contour was found that explains {recordings} recordings, {of}"),
            };
        }
        if let Some(Combined { chi_squared, freedom, .. }) = self.combined.as_ref().filter(|all| all.freedom > 0) {
            let verdict = if self.combined.as_ref().is_some_and(Combined::contradicts) {
                "they contradict each other"
            } else {
                "they agree"
            };
            // Writing to a string cannot fail.
            let _ = writeln!(
                text,
                "errors that stay the same from scan to scan: chi-squared of their differences {chi_squared:.1} with {freedom} \
                 degrees of freedom; {verdict}"
            );
        }
        let (length, traces, gaps) = (self.length(), self.contour.traces.len(), self.contour.gaps.len());
        let _ = writeln!(text, "merged contour: {traces} stretches of {:.1} mm together, {gaps} gaps", 1e3 * length);
        text
    }
}

impl From<&Disagreement> for DisagreementRecord {
    fn from(here: &Disagreement) -> Self {
        Self { from_x: here.from, to_x: here.to, gap: here.gap, sigma: here.sigma }
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
