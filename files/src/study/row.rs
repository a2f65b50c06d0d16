//! What is measured in one scene of a study.

use super::touched::touched_share;
use crate::{Scan, Scene, naive_touch};
use serde::Serialize;
use std::path::Path;
use vibrissa::contact::EventKind;
use vibrissa::reconstruct::score::signed_distance;
use vibrissa::{Sample, State};

/// One scene of a study.
#[derive(Clone, Debug, PartialEq)]
pub struct StudyRow {
    /// Its number, from 0.
    pub scene: usize,
    /// The values of the parameters.
    pub values: Vec<f64>,
    /// What came out; none where the numbers make no scene, or the sweep has not begun.
    pub measured: Option<Measured>,
    /// Why the sweep ended before its path, or there was none.
    pub reason: Option<String>,
}

/// What came out of a sweep, as far as it went. SI units.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Measured {
    /// The phases in order, as in `A B BB B A`.
    pub phases: String,
    /// C1, C2 or C3 of Merker et al. (2020), fig. 8a; none for another order.
    pub cycle: Option<&'static str>,
    /// How often the rod jumped to another equilibrium in contact.
    pub snaps: usize,
    /// Way of the clamp with two contacts or more: m, or rad where the clamp only turns.
    pub several: f64,
    /// Largest distance from the contour, m, of a contact point that is computed from the reactions as if there were one contact,
    /// where there are several: over the reported states and those at transitions. None for a rod that is not uniform.
    pub naive_error: Option<f64>,
    /// Share of the contour between its outermost touched points that a contact went over, 0 to 1; of a closed contour, all but
    /// its largest untouched part.
    pub touched: Option<f64>,
    /// Largest moment at the clamp, N m.
    pub largest_moment: f64,
    /// How many states the sweep reported.
    pub states: usize,
}

impl StudyRow {
    /// The columns beside those of the parameters, which stand after the first.
    pub const COLUMNS: [&'static str; 11] = [
        "scene",
        "status",
        "phases",
        "cycle",
        "snaps",
        "several",
        "naive_error",
        "touched",
        "largest_moment",
        "states",
        "reason",
    ];

    /// Sweeps a scene that is written as in a scene file, and measures it. Files that it names are relative to `file`, which is
    /// not opened.
    pub fn sweep(scene: usize, values: Vec<f64>, file: &Path, text: &str) -> Self {
        match Scene::parse(file, text) {
            Ok(read) => Self::of(scene, values, Scan::run(read).map_err(|error| error.to_string())),
            Err(error) => Self::without_scene(scene, values, error.without_place()),
        }
    }

    /// A scene that is none, and why.
    pub(super) fn without_scene(scene: usize, values: Vec<f64>, reason: String) -> Self {
        Self { scene, values, measured: None, reason: Some(reason) }
    }

    fn of(scene: usize, values: Vec<f64>, scan: Result<Scan, String>) -> Self {
        match scan {
            Ok(scan) => {
                let reason = scan.outcome.stop.as_ref().map(ToString::to_string);
                let measured = (!scan.is_empty()).then(|| Measured::of(&scan));
                Self { scene, values, measured, reason }
            }
            Err(reason) => Self::without_scene(scene, values, reason),
        }
    }

    /// `done`, `stopped` where the sweep ended before its path, or `refused` where it did not begin.
    pub fn status(&self) -> &'static str {
        match (&self.measured, &self.reason) {
            (Some(_), None) => "done",
            (Some(_), Some(_)) => "stopped",
            (None, _) => "refused",
        }
    }

    /// The cells of the table, in the order of the columns.
    pub(super) fn cells(&self) -> Vec<String> {
        let number = |value: f64| format!("{value:?}");
        let mut cells = vec![self.scene.to_string()];
        cells.extend(self.values.iter().copied().map(number));
        cells.push(self.status().to_owned());
        match &self.measured {
            Some(measured) => {
                let Measured { phases, cycle, snaps, several, naive_error, touched, largest_moment, states } = measured;
                cells.extend([
                    phases.clone(),
                    cycle.unwrap_or_default().to_owned(),
                    snaps.to_string(),
                    number(*several),
                    naive_error.map(number).unwrap_or_default(),
                    touched.map(number).unwrap_or_default(),
                    number(*largest_moment),
                    states.to_string(),
                ]);
            }
            None => cells.extend(std::iter::repeat_n(String::new(), 8)),
        }
        cells.push(self.reason.clone().unwrap_or_default());
        cells
    }
}

impl Measured {
    fn of(scan: &Scan) -> Self {
        let Scan { scene, outcome, .. } = scan;
        let intervals = scan.intervals();
        let several = || intervals.iter().filter(|interval| interval.phase.contacts > 1);
        let way = |state: &&State| scene.way(state);
        let ways = several().filter_map(|one| Some(way(one.states.last()?) - way(one.states.first()?)));
        let cycle = scan.cycle();
        // the point of a uniform rod is told from its base, which is not where the support of a clamp on springs is
        let is_told = scene.rod.uniform_on_rigid_clamp().is_some();
        let naive = several()
            .flat_map(|one| &one.states)
            .filter(|state| is_told && state.contacts.len() > 1)
            .filter_map(|state| {
                let touch = naive_touch(&scene.rod, &Sample::new(state.pose, state.reactions))?;
                signed_distance(&scene.objects, touch.x, touch.y).map(f64::abs)
            });
        Self {
            phases: cycle.to_string(),
            cycle: cycle.name(),
            snaps: outcome.events.iter().filter(|event| event.kind == EventKind::Snap).count(),
            // a sum of nothing is -0
            several: 0.0 + ways.sum::<f64>(),
            naive_error: naive.reduce(f64::max),
            touched: touched_share(scan),
            largest_moment: outcome.states.iter().map(|state| state.reactions.m0z.abs()).fold(0.0, f64::max),
            states: outcome.states.len(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// On springs the base is not at the pose of the support, from which a point would be told wrong.
    #[test]
    fn the_error_of_single_contacts_is_told_on_a_rigid_clamp_alone() {
        let scene = include_str!("../../../scenes/O1_q40.toml");
        let told = |clamp: &str| {
            let row = StudyRow::sweep(0, Vec::new(), "O1_q40.toml".as_ref(), &format!("{scene}\n{clamp}"));
            let measured = row.measured.unwrap();
            assert!(measured.several > 0.0, "{clamp}");
            measured.naive_error
        };
        assert!(told("").unwrap() > 1e-3);
        assert_eq!(told("[clamp]\nstiffness_phi = 0.4\n"), None);
        assert_eq!(told("[clamp]\nroller = 0.02\n"), None);
    }
}
