//! A contact that slides over a joint of the rod, where its stiffness or natural curvature jumps: there the branch has a kink.

use crate::contact_set::{Configuration, Unknown};
use crate::continuation::branch::{Condition, Corrector, Tangent};
use crate::limits::LIMITS;
use rod_core::{PhysicalRod, RodModel, SolveReport};

/// A point just behind a joint, and the branch from there on.
pub(crate) struct BehindJoint {
    pub configuration: Configuration,
    pub tangent: Tangent,
    pub report: SolveReport,
}

/// The point of the branch where a contact is just behind the first joint that it crosses between two points. None where no joint is crossed or
/// the point is not located; also where the branch, whose tangent at `from` is `start`, turns before the joint: a fold is on the way, or the
/// point is on another branch.
pub(crate) fn cross_joint<R: PhysicalRod>(
    corrector: &mut Corrector<'_, R>,
    (from, start): (&Configuration, &Tangent),
    to: &Configuration,
) -> Option<BehindJoint> {
    let joints = corrector.setup.rod.model().joints();
    let mut first: Option<(f64, usize, f64)> = None;
    for j in 0..to.count() {
        let (here, there) = (from.s(j), to.s(j));
        let way = there - here;
        for joint in joints {
            let beyond = joint + LIMITS.step.behind_joint.copysign(way);
            let share = (beyond - here) / way;
            if share > 0.0 && share < 1.0 && first.is_none_or(|(least, ..)| share < least) {
                first = Some((share, j, beyond));
            }
        }
    }
    let (share, j, value) = first?;
    let mut guess = from.clone();
    for (z, end) in guess.z.iter_mut().zip(&to.z) {
        *z += share * (end - *z);
    }
    let way = to.s(j) - from.s(j);
    // just before the joint, where the branch is still smooth
    let before = value - 2.0 * LIMITS.step.behind_joint.copysign(way);
    if (before - from.s(j)) * way > 0.0 {
        let BehindJoint { tangent, .. } = solve_at_arc_length(corrector, guess.clone(), j, before, way)?;
        if tangent.by_tau() <= 0.0 || tangent.cosine(&start.direction) < LIMITS.step.least_cosine {
            return None;
        }
    }
    solve_at_arc_length(corrector, guess, j, value, way)
}

/// The point of the branch near `guess` where contact j is at the arc length `value`, and the tangent there by its own Jacobian, in the sense in
/// which that arc length changes by `way`.
fn solve_at_arc_length<R: PhysicalRod>(
    corrector: &mut Corrector<'_, R>,
    mut configuration: Configuration,
    j: usize,
    value: f64,
    way: f64,
) -> Option<BehindJoint> {
    let condition = Condition::Fixed { unknown: Unknown::ArcLength(j), value };
    let report = corrector.correct(&mut configuration, condition);
    if !report.status.is_solved() {
        return None;
    }
    // with the arc length fixed, the direction in which that grows
    let (mut tangent, _) = corrector.inspect(&configuration, condition);
    if way < 0.0 {
        tangent.direction.iter_mut().for_each(|rate| *rate = -*rate);
    }
    Some(BehindJoint { configuration, tangent, report })
}

/// Whether any contact is on different sides of a joint at the two points.
pub(crate) fn crosses_joint<R: PhysicalRod>(
    corrector: &Corrector<'_, R>,
    from: &Configuration,
    to: &Configuration,
) -> bool {
    let joints = corrector.setup.rod.model().joints();
    let side = |s: f64| joints.partition_point(|joint| *joint < s);
    !joints.is_empty() && (0..to.count()).any(|j| side(from.s(j)) != side(to.s(j)))
}
