//! The nine scans of the paper: their scenes, and running them.

use super::PaperError;
use rayon::prelude::*;
use rod_files::{Interrupt, Scan, Scene};
use std::path::Path;

/// The objects.
pub(crate) const OBJECTS: [&str; 3] = ["O1", "O2", "O3"];
/// Distances of the clamp from the lowest vertex of the object, mm.
pub(crate) const DISTANCES: [u32; 3] = [20, 40, 60];

/// Object, distance (mm), name of the cycle in fig. 8a, file and text of the scene.
pub(super) type Entry = (&'static str, u32, &'static str, &'static str, &'static str);

// Of the folder of this package, where they are links: a published package has nothing from outside of it.
macro_rules! scene {
    ($object:literal, $distance:literal, $cycle:literal) => {
        (
            $object,
            $distance,
            $cycle,
            concat!("scenes/", $object, "_q", $distance, ".toml"),
            include_str!(concat!("../../scenes/", $object, "_q", $distance, ".toml")),
        )
    };
}

pub(super) const SCANS: [Entry; 9] = [
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

/// The nine scans, or those of them that were done when they were interrupted.
#[derive(Debug)]
pub struct Paper {
    /// By object, then by distance.
    pub scans: Vec<PaperScan>,
}

impl Paper {
    /// How many scans there are.
    pub const SCANS: usize = SCANS.len();

    /// Runs all scans at once; `done` is called after each. Interrupted, it keeps those that are done.
    ///
    /// # Errors
    /// [`PaperError`].
    pub fn run(interrupt: &Interrupt, done: impl Fn() + Sync) -> Result<Self, PaperError> {
        let scan = |(object, distance, expected, file, text): Entry| {
            let scan = Scan::run_until(Scene::parse(Path::new(file), text)?, interrupt)?;
            done();
            Ok(scan.interrupted.is_none().then_some(PaperScan { object, distance, expected, scan }))
        };
        let scans = SCANS.into_par_iter().map(scan).collect::<Result<Vec<_>, PaperError>>()?;
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
}
