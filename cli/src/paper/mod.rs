//! The nine scans of Merker et al. (2020): three objects at three distances.
//!
//! `naive` turns a scan back as if there were one contact, `resolved` with both contacts, and `report` is the tables of all
//! scans.

pub(crate) mod naive;
mod report;
pub(crate) mod resolved;

use crate::output::pretty_json;
use crate::{Error, Interrupt, Scan, Scene, Staged, figure};
use naive::Naive;
use rayon::prelude::*;
use resolved::Resolved;
use serde::Serialize;
use std::path::Path;

/// The objects.
pub(crate) const OBJECTS: [&str; 3] = ["O1", "O2", "O3"];
/// Distances of the clamp from the lowest vertex of the object, mm.
pub(crate) const DISTANCES: [u32; 3] = [20, 40, 60];

/// Object, distance (mm), name of the cycle in fig. 8a, file and text of the scene.
type Entry = (&'static str, u32, &'static str, &'static str, &'static str);

macro_rules! scene {
    ($object:literal, $distance:literal, $cycle:literal) => {
        (
            $object,
            $distance,
            $cycle,
            concat!("scenes/", $object, "_q", $distance, ".toml"),
            include_str!(concat!("../../../scenes/", $object, "_q", $distance, ".toml")),
        )
    };
}

const SCANS: [Entry; 9] = [
    scene!("O1", 20, "C1"),
    scene!("O1", 40, "C2"),
    scene!("O1", 60, "C3"),
    scene!("O2", 20, "C1"),
    scene!("O2", 40, "C1"),
    scene!("O2", 60, "C3"),
    scene!("O3", 20, "C2"),
    scene!("O3", 40, "C3"),
    scene!("O3", 60, "C3"),
];

/// One of the nine scans.
#[derive(Debug)]
pub struct PaperScan {
    /// O1, O2 or O3.
    pub object: &'static str,
    /// Distance q of the clamp from the lowest vertex, mm.
    pub distance: u32,
    /// Name of the paper's cycle.
    pub expected: &'static str,
    /// The scan.
    pub scan: Scan,
}

impl PaperScan {
    /// Whether the phases are those of the paper.
    pub fn matches(&self) -> bool {
        self.scan.cycle().name() == Some(self.expected)
    }
}

impl<'a> From<&'a PaperScan> for PaperScanRecord<'a> {
    fn from(of: &'a PaperScan) -> Self {
        let PaperScan { expected, scan, .. } = of;
        Self { name: &scan.scene.name, phases: scan.cycle().to_string(), expected, matches: of.matches() }
    }
}

/// The nine scans, or those of them that were done when they were interrupted.
#[derive(Debug)]
pub struct Paper {
    /// By object, then by distance.
    pub scans: Vec<PaperScan>,
}

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

impl Paper {
    /// How many scans there are.
    pub const SCANS: usize = SCANS.len();

    /// Runs all scans at once; `done` is called after each. Interrupted, it keeps those that are done.
    ///
    /// # Errors
    /// [`Error::Scene`] and [`Error::Contact`], were a scene of this crate no scene.
    pub fn run(interrupt: &Interrupt, done: impl Fn() + Sync) -> Result<Self, Error> {
        let scan = |(object, distance, expected, file, text): Entry| {
            let scan = Scan::run_until(Scene::parse(Path::new(file), text)?, interrupt)?;
            done();
            Ok(scan.interrupted.is_none().then_some(PaperScan { object, distance, expected, scan }))
        };
        let scans = SCANS.into_par_iter().map(scan).collect::<Result<Vec<_>, Error>>()?;
        Ok(Self { scans: scans.into_iter().flatten().collect() })
    }

    /// Whether all nine scans are there.
    pub fn is_complete(&self) -> bool {
        self.scans.len() == Self::SCANS
    }

    /// The scan of an object at a distance (mm).
    pub fn find(&self, object: &str, distance: u32) -> Option<&PaperScan> {
        self.scans.iter().find(|scan| scan.object == object && scan.distance == distance)
    }

    /// Writes the files of each scan into a folder of its own, and beside the folders paper.json, which says how the scans
    /// compare with the paper, and the figures of all scans: phase cycles and transitions, phase criterion, goodness of
    /// fit, contact points at one distance and at all three, and both contacts where there are two. Interrupted, or where
    /// scans are missing, it leaves these figures out. Returns whether everything was written.
    ///
    /// # Errors
    /// [`Error::Output`], [`Error::Figure`].
    pub fn write(&self, staged: &Staged, interrupt: &Interrupt) -> Result<bool, Error> {
        self.scans.par_iter().try_for_each(|scan| scan.scan.write(staged, Path::new(&scan.scan.scene.name)))?;
        let figures = if self.is_complete() { self.figures(interrupt)? } else { None };
        let complete = figures.is_some();
        for (name, figure) in figures.into_iter().flatten() {
            staged.write(Path::new(name), |file| file.write_all(figure.as_bytes()))?;
        }
        staged.write(Path::new("paper.json"), |file| pretty_json(file, &self.record(complete)))?;
        Ok(complete)
    }

    /// Name and content of the figures of all scans; none where they were interrupted.
    fn figures(&self, interrupt: &Interrupt) -> Result<Option<[(&'static str, String); 7]>, Error> {
        let naive: Vec<Naive<'_>> = self.scans.par_iter().map(Naive::of).collect::<Result<_, Error>>()?;
        let middle: Vec<&Naive<'_>> = naive.iter().filter(|scan| scan.scan.distance == 40).collect();
        if interrupt.is_raised() {
            return Ok(None);
        }
        let resolved: Vec<Resolved<'_>> =
            middle.par_iter().map(|scan| Resolved::of(scan.scan)).collect::<Result<_, Error>>()?;
        let middle_scans: Vec<&Scan> = middle.iter().map(|scan| &scan.scan.scan).collect();
        if interrupt.is_raised() {
            return Ok(None);
        }
        Ok(Some([
            ("goodness_of_fit.svg", figure::goodness(&naive)?),
            ("contact_points.svg", figure::contact_points(&middle)?),
            ("criterion.svg", figure::criterion(&middle_scans)?),
            ("phase_cycles.svg", figure::cycles(self)?),
            ("phase_diagram.svg", figure::transitions(self.scans.iter().map(|scan| &scan.scan))?),
            ("distances.svg", figure::distances(&naive)?),
            ("notches.svg", figure::notches(&resolved)?),
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
