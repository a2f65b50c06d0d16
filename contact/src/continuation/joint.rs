//! A contact that slides over a joint of the rod, where its stiffness or natural curvature jumps: there the branch has a kink.

use crate::contact_set::{Configuration, Unknown};
use crate::continuation::branch::{Condition, Corrector, Tangent};
use rod_core::{PhysicalRod, RodModel, SolveReport};

/// Arc length (L) behind a joint at which a contact counts as being on its other side.
const BEYOND: f64 = 1e-11;

/// A point just behind a joint, and the branch from there on.
pub(crate) struct Passed {
    pub configuration: Configuration,
    pub tangent: Tangent,
    pub report: SolveReport,
}

/// The first joint that a contact goes over between two points of a branch: the point where it is just behind it. None where there is no
/// joint between them, or it cannot be located.
pub(crate) fn passed<R: PhysicalRod>(
    corrector: &mut Corrector<'_, R>,
    from: &Configuration,
    to: &Configuration,
) -> Option<Passed> {
    let joints = corrector.setup.rod.model().joints();
    let mut first: Option<(f64, usize, f64)> = None;
    for j in 0..to.count() {
        let (here, there) = (from.s(j), to.s(j));
        let way = there - here;
        for joint in joints {
            let beyond = joint + BEYOND.copysign(way);
            let share = (beyond - here) / way;
            if share > 0.0 && share < 1.0 && first.is_none_or(|(least, ..)| share < least) {
                first = Some((share, j, beyond));
            }
        }
    }
    let (share, j, value) = first?;
    let unknown = Unknown::ArcLength(j);
    let mut configuration = from.clone();
    for (z, end) in configuration.z.iter_mut().zip(&to.z) {
        *z += share * (end - *z);
    }
    let condition = Condition::Fixed { unknown, value };
    let report = corrector.correct(&mut configuration, condition);
    if !report.status.is_solved() {
        return None;
    }
    // by its own Jacobian, on the other side; with the arc length fixed, the direction in which that grows
    let (mut tangent, _) = corrector.inspect(&configuration, condition);
    if to.s(j) < from.s(j) {
        tangent.direction.iter_mut().for_each(|rate| *rate = -*rate);
    }
    Some(Passed { configuration, tangent, report })
}

/// Whether a contact is on another side of a joint at both points.
pub(crate) fn passes<R: PhysicalRod>(corrector: &Corrector<'_, R>, from: &Configuration, to: &Configuration) -> bool {
    let joints = corrector.setup.rod.model().joints();
    let side = |s: f64| joints.partition_point(|joint| *joint < s);
    !joints.is_empty() && (0..to.count()).any(|j| side(from.s(j)) != side(to.s(j)))
}
