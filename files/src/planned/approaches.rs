//! The first scans of an object of which only a box is known.

use super::files::{Pose3, pose};
use super::{LargestStress, PlanFileError, direction_degrees};
use crate::output::pretty_json;
use crate::{OutputError, Staged};
use serde::Serialize;
use std::fmt::Write;
use vibrissa::plan::{Abort, ExploreError, Explorer, ExplorerSettings, Rectangle};
use vibrissa::reconstruct::NoiseModel;
use vibrissa::rod::{AnyRod, Reactions};
use vibrissa::{ClampPath, Pose, Sample};

/// The scans to make of an object of which only a box is known: each of them if those before it touched nothing.
#[derive(Clone, Debug)]
pub struct Approaches {
    /// The object is in it, m.
    pub bounds: Rectangle,
    /// The paths of the clamp, and when the rig must stop.
    pub scans: Vec<(ClampPath, Abort)>,
}

impl Approaches {
    /// Up to `count` scans; `angles` are directions of the rod at its clamp, rad, none for 12 all around.
    ///
    /// # Errors
    /// [`PlanFileError`].
    pub fn new(
        rod: &AnyRod,
        bounds: Rectangle,
        angles: Option<Vec<f64>>,
        count: usize,
        largest_stress: LargestStress,
    ) -> Result<Self, PlanFileError> {
        let limit = largest_stress.limit(rod)?.ok_or(ExploreError::NoStress)?;
        let rod = *rod.uniform_on_rigid_clamp().ok_or(PlanFileError::NotUniform)?;
        let rod = rod.with_yield_stress(limit).map_err(|_| ExploreError::NoStress)?;
        let mut settings = ExplorerSettings::new(&rod, bounds, NoiseModel::default().channels())?;
        settings.angles = angles.unwrap_or(settings.angles);
        settings.most_scans = count;
        let mut explorer = Explorer::new(rod, settings)?;
        let mut scans = Vec::new();
        while let Some(proposal) = explorer.propose()? {
            let path = proposal.path;
            let free = |way: f64| Sample { t: None, pose: path.at(way), reactions: Reactions::default(), sigma: None };
            explorer.update(&[free(0.0), free(path.length())])?;
            scans.push((path, proposal.abort));
        }
        Ok(Self { bounds, scans })
    }

    /// The report, lengths in mm.
    pub fn report(&self) -> String {
        let mut text = String::new();
        let mm = |pose: Pose| format!("({:.2}, {:.2})", 1e3 * pose.x, 1e3 * pose.y);
        for (place, (path, abort)) in self.scans.iter().enumerate() {
            let [from, to] = [path.at(0.0), path.at(path.length())];
            // writing to a String cannot fail
            let _ = writeln!(
                text,
                "scan {}: clamp from {} to {} mm, angle {:.2} deg; stop at {:.3} N or {:.3} N mm",
                place + 1,
                mm(from),
                mm(to),
                direction_degrees(from.phi),
                abort.force,
                1e3 * abort.moment
            );
        }
        text += match self.scans.len() {
            0 => "no scan goes through the box and stays clear of it\n",
            1 => "",
            _ => "each scan is for the case that those before it touched nothing\n",
        };
        text
    }

    /// Writes plan.json into the staged directory.
    ///
    /// # Errors
    /// [`OutputError`].
    pub fn write(&self, staged: &Staged) -> Result<(), OutputError> {
        let scan = |(path, abort): &(ClampPath, Abort)| ApproachRecord {
            from: pose(path.at(0.0)),
            to: pose(path.at(path.length())),
            stop_force: abort.force,
            stop_moment: abort.moment,
        };
        let Rectangle { low, high } = self.bounds;
        let record = ApproachesRecord {
            version: env!("CARGO_PKG_VERSION"),
            r#box: [low, high],
            chosen: self.scans.iter().map(scan).collect(),
        };
        staged.write("plan.json".as_ref(), |file| pretty_json(file, &record))
    }
}

/// plan.json.
#[derive(Serialize)]
struct ApproachesRecord {
    version: &'static str,
    /// m
    r#box: [[f64; 2]; 2],
    chosen: Vec<ApproachRecord>,
}

#[derive(Serialize)]
struct ApproachRecord {
    from: Pose3,
    to: Pose3,
    /// N
    stop_force: f64,
    /// N m
    stop_moment: f64,
}
