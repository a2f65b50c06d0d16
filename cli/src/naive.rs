//! A scan turned back into contact points as if there were never more than one contact (Merker et al. 2021, fig. 6).

use crate::{Error, PaperScan, Scan};
use vibrissa::compare::signed_distance;
use vibrissa::{Pose, Reactions, Rod, Section, State, Sweep, advance, find_root, walk};

/// Clamp travel between the states that are turned back, m: a quarter of what is reported, for dense rows of points.
pub(crate) const STEP: f64 = 2.5e-4;
/// How far along the rod a contact is looked for, in its length, and in how many steps. Two contacts may look like one
/// beyond the tip; those of the nine scans are all found.
const REACH: f64 = 1.5;
const STEPS: usize = 300;
/// The ends of a step are moved outwards by so much: where the moment vanishes at one of them (at the tip, say),
/// rounding may put it on either side.
const SLACK: f64 = 1e-9;

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
    /// [`Error::Contact`] where the sweep cannot be made, which the scan excludes.
    pub fn of(scan: &'a PaperScan) -> Result<Self, Error> {
        let scene = &scan.scan.scene;
        let mut states = Sweep::new(&scene.rod, &scene.objects, scene.path, STEP)?.run().states;
        states.retain(|state| !state.contacts.is_empty());
        let points = states.iter().filter_map(|state| point(&scan.scan, state)).collect();
        Ok(Self { scan, states, points })
    }

    /// The largest error (m) of the points of one contact, or of several.
    pub fn largest_error(&self, several: bool) -> Option<f64> {
        let errors = self.points.iter().filter(|point| point.several == several).map(|point| point.error.abs());
        errors.reduce(f64::max)
    }
}

fn point(scan: &Scan, state: &State) -> Option<NaivePoint> {
    let [x, y] = single_contact(&scan.scene.rod, state.pose, state.reactions)?;
    let error = signed_distance(&scan.scene.objects, x, y)?;
    Some(NaivePoint { x, y, above: y - state.pose.y, several: state.contacts.len() > 1, error })
}

/// Where a single contact would be that gives these reactions (m): the elastica from the clamp to its first section
/// without moment. None where there is none within reach.
fn single_contact(rod: &Rod, pose: Pose, reactions: Reactions) -> Option<[f64; 2]> {
    let units = rod.units();
    let (a, b) = (reactions.f0y / units.force, -reactions.f0x / units.force);
    let (x, y) = (pose.x / units.length, pose.y / units.length);
    let clamp = Section { x, y, phi: pose.phi, kappa: -reactions.m0z / units.moment };
    let beyond = walk(&clamp, a, b, REACH, STEPS).position(|section| section.kappa * clamp.kappa <= 0.0)?;
    let step = REACH / STEPS as f64;
    let (from, to) = (step * beyond as f64 - SLACK, step * (beyond + 1) as f64 + SLACK);
    let root = find_root("moment", |s| Ok(advance(&clamp, a, b, s).kappa), from, to, 0.0).ok()?;
    let contact = advance(&clamp, a, b, root.at);
    Some([contact.x * units.length, contact.y * units.length])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Paper;

    #[test]
    fn one_contact_comes_back_and_two_do_not() {
        let paper = Paper::run(|| ()).unwrap();
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

    #[test]
    fn a_free_rod_has_no_contact() {
        let rod = Rod::new(0.1, 1e-3).unwrap();
        let pose = Pose { x: 0.0, y: 0.0, phi: 1.0 };
        assert_eq!(single_contact(&rod, pose, Reactions { m0z: 1e-3, ..Reactions::default() }), None);
    }
}
