//! The files of what scans reach.

use super::{OutlinePart, Reached, Touch};
use crate::output::{pretty_json, write_csv};
use crate::{OutputError, Staged};
use serde::Serialize;
use vibrissa::plan::{ScanReach, StraightScan};

/// Columns of scans.csv.
const SCANS: [&str; 11] = [
    "angle",
    "distance",
    "pass",
    "status",
    "single",
    "several",
    "touched_share",
    "snaps",
    "largest_moment",
    "largest_stress",
    "reason",
];

/// Columns of outline.csv.
const OUTLINE: [&str; 8] = ["object", "from", "to", "touched", "x_from", "y_from", "x_to", "y_to"];

/// reach.json.
#[derive(Serialize)]
struct ReachRecord {
    version: &'static str,
    complete: bool,
    /// m
    outline: f64,
    /// Shares of the outline.
    single: f64,
    several: f64,
    never: f64,
    /// The scan that touches most.
    most: Option<MostRecord>,
    /// The largest distance at which a scan has several contacts, m.
    several_up_to: Option<f64>,
}

#[derive(Serialize)]
struct MostRecord {
    angle: f64,
    distance: f64,
    pass: String,
    touched_share: f64,
}

impl Reached {
    /// Writes scans.csv (what each scan touches), outline.csv (how each part of the outlines is touched by all of them) and reach.json into the
    /// staged directory.
    ///
    /// # Errors
    /// [`OutputError`].
    pub fn write(&self, staged: &Staged) -> Result<(), OutputError> {
        staged.write("scans.csv".as_ref(), |file| {
            write_csv(file, &SCANS, self.found.scans.iter().map(|scan| self.row(scan)))
        })?;
        staged.write("outline.csv".as_ref(), |file| {
            let row = |part: OutlinePart| {
                let OutlinePart { object, from, to, touch, ends: [[x, y], [x_to, y_to]] } = part;
                (object, from, to, touch.to_string(), x, y, x_to, y_to)
            };
            write_csv(file, &OUTLINE, self.outline_parts().into_iter().map(row))
        })?;
        staged.write("reach.json".as_ref(), |file| pretty_json(file, &self.record()))
    }

    fn row(&self, one: &ScanReach) -> impl Serialize + use<> {
        let StraightScan { distance, angle, pass } = one.scan;
        let length = |sets: &[vibrissa::plan::IntervalSet]| 0.0 + sets.iter().map(|set| set.length()).sum::<f64>();
        (
            angle,
            distance,
            pass.to_string(),
            if one.found.stop.is_none() { "done" } else { "stopped" },
            length(&one.found.touched.single),
            length(&one.found.touched.several),
            self.shares_of(&one.found.touched)[1],
            one.found.snaps,
            one.found.largest_moment,
            one.found.largest_stress,
            one.found.stop.as_ref().map(ToString::to_string),
        )
    }

    fn record(&self) -> ReachRecord {
        ReachRecord {
            version: env!("CARGO_PKG_VERSION"),
            complete: self.is_complete(),
            outline: self.found.length(),
            single: self.share(Touch::Single),
            several: self.share(Touch::Several),
            never: self.share(Touch::Never),
            most: self.most().map(|(scan, touched_share)| MostRecord {
                angle: scan.angle,
                distance: scan.distance,
                pass: scan.pass.to_string(),
                touched_share,
            }),
            several_up_to: self.several_up_to(),
        }
    }

    /// The scan that touches the largest share of the outlines, and that share.
    pub(super) fn most(&self) -> Option<(StraightScan, f64)> {
        let shares = self.found.scans.iter().map(|one| (one.scan, self.shares_of(&one.found.touched)[1]));
        // of several the first
        shares.reduce(|best, one| if one.1 > best.1 { one } else { best })
    }

    /// The largest distance at which a scan has several contacts, m.
    pub(super) fn several_up_to(&self) -> Option<f64> {
        let several = |one: &&ScanReach| one.found.touched.several.iter().any(|set| !set.parts().is_empty());
        self.found.scans.iter().filter(several).map(|one| one.scan.distance).reduce(f64::max)
    }
}
