//! A scan turned back into contact points as if there were never more than one contact (Merker et al. 2020, fig. 6).

use super::PaperError;
use super::scans::PaperScan;
use rod_files::Scan;
use rod_files::naive_touch;
use vibrissa::reconstruct::score::signed_distance;
use vibrissa::reconstruct::{Assembly, ContourEstimate, Measured, Touch};
use vibrissa::{Label, Sample, State, Sweep};

/// Clamp travel between the states that are turned back, m: a quarter of what is reported, for dense rows of points.
pub(crate) const STEP: f64 = 2.5e-4;

/// A contact point as the reactions of a single contact would have it, m.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NaivePoint {
    pub x: f64,
    pub y: f64,
    /// How high it is above the clamp.
    pub above: f64,
    /// Whether there were several contacts, so that the point is wrong.
    pub several: bool,
    /// Its distance from the true contours.
    pub error: f64,
    /// The contact as found.
    touch: Touch,
}

/// A scan of the paper with its naive points.
pub(crate) struct Naive<'a> {
    pub scan: &'a PaperScan,
    /// The states in contact, closer together than those reported.
    pub states: Vec<State>,
    /// Those of the states that have one.
    pub points: Vec<NaivePoint>,
}

impl<'a> Naive<'a> {
    /// Sweeps once more, in smaller steps.
    ///
    /// # Errors
    /// [`PaperError::Contact`] where the sweep cannot be made, which the scan excludes.
    pub fn of(scan: &'a PaperScan) -> Result<Self, PaperError> {
        let scene = &scan.scan.scene;
        let mut states = Sweep::new(&scene.rod, &scene.objects, scene.path, STEP)?.run().states;
        states.retain(|state| !state.contacts.is_empty());
        let points = states.iter().filter_map(|state| point(&scan.scan, state)).collect();
        Ok(Self { scan, states, points })
    }

    /// The contour as the points have it.
    pub fn contour(&self) -> ContourEstimate {
        let touches = self.points.iter().map(|point| Measured::new(Label::B, std::slice::from_ref(&point.touch)));
        Assembly::naive().assemble(touches)
    }

    /// The largest error (m) of the points of one contact, or of several.
    pub fn largest_error(&self, several: bool) -> Option<f64> {
        let errors = self.points.iter().filter(|point| point.several == several).map(|point| point.error.abs());
        errors.reduce(f64::max)
    }
}

fn point(scan: &Scan, state: &State) -> Option<NaivePoint> {
    let touch = naive_touch(&scan.scene.rod, &Sample::new(state.pose, state.reactions))?;
    let Touch { x, y, .. } = touch;
    let error = signed_distance(&scan.scene.objects, x, y)?;
    Some(NaivePoint { x, y, above: y - state.pose.y, several: state.contacts.len() > 1, error, touch })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Paper;
    use rod_files::Interrupt;

    #[test]
    fn one_contact_comes_back_and_two_do_not() {
        let paper = Paper::run(&Interrupt::default(), || ()).unwrap();
        for scan in &paper.scans {
            let naive = Naive::of(scan).unwrap();
            assert_eq!(naive.points.len(), naive.states.len(), "{}", scan.scan.scene.name);
            for (state, point) in naive.states.iter().zip(&naive.points).filter(|(_, point)| !point.several) {
                let contact = &state.contacts[0];
                let off = (contact.x - point.x).hypot(contact.y - point.y);
                assert!(off < 1e-12 && point.error.abs() < 1e-12, "{off} {point:?}");
            }
            let largest = naive.largest_error(true).unwrap();
            // O3 at 60 mm has two contacts for a short part of the path only.
            assert!((1e-6..1e-2).contains(&largest), "{}: {largest}", scan.scan.scene.name);
        }
    }
}
