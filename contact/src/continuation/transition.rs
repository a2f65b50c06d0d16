//! Transitions: which condition of a contact set is broken, and where on the branch it broke.

use crate::contact_set::edit::{as_tangent, as_tip, onto_neighbour};
use crate::contact_set::notch::{lying_angle, merged, parted, straddles, wall_run_into};
use crate::contact_set::{Configuration, FORCE_TOLERANCE, Held, Unknown, lying};
use crate::continuation::branch::{Condition, Corrector, Tangent};
use crate::event::EventKind;
use crate::gap::Crossing;
use crate::gap::scan::Scan;
use rod_core::Hold;
use smallvec::SmallVec;

/// A condition of the contact set that no longer holds.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Break {
    /// Contact j would have to pull.
    Release(usize),
    /// The slope angle at the tip has come down to the contour's (or round to its opposite): here phi - alpha.
    TipToTangent(f64),
    /// The last tangential contact has run off the rod.
    TangentToTip,
    /// Contact j has left its stretch, upwards or downwards.
    Border(usize, bool),
    /// The rod, its tip in a notch, lies down on one of the walls: the wall, and phi(1) minus its angle.
    OntoWall(usize, f64),
    /// The rod goes through the contour.
    Touch(Crossing),
}

/// Arc lengths and angles beyond their limits by this are on them.
const LIMIT_TOLERANCE: f64 = 1e-13;

/// Parameters beyond the end of a stretch by no more than this are at its end.
const BEYOND_END: f64 = 1e-12;

/// Two contacts this near to each other in a notch have met there.
const MEETING: f64 = 1e-7;

/// Visits everything that is broken in `configuration`, whose rod `scan` has looked at.
pub(crate) fn breaks(
    corrector: &Corrector<'_>,
    configuration: &Configuration,
    scan: &Scan,
    mut visit: impl FnMut(Break),
) {
    let n = configuration.count();
    let mut entered: SmallVec<[usize; 4]> = SmallVec::new();
    for j in 0..n {
        if configuration.force(j) < -FORCE_TOLERANCE {
            visit(Break::Release(j));
        }
        let range = corrector.setup.world.range(configuration.contacts[j].stretch);
        let t = configuration.t(j);
        let slack = LIMIT_TOLERANCE * (1.0 + t.abs());
        let upwards = t > range.to + slack;
        if upwards || t < range.from - slack {
            let next = corrector.setup.world.neighbour(configuration.contacts[j].stretch, upwards);
            // A rod that comes to lie on a straight edge comes upon the corner at its other end at once, and what runs past a
            // notch goes into its other wall.
            let beyond = next.and_then(|next| corrector.setup.world.neighbour(next, upwards));
            let past_notch = next.is_some_and(|next| corrector.setup.world.is_notch(next));
            entered.extend(next);
            entered.extend(beyond.filter(|beyond| past_notch || corrector.setup.world.is_corner(*beyond)));
            visit(Break::Border(j, upwards));
        }
    }
    let mut lying_down = None;
    if let Some(last) = n.checked_sub(1) {
        if configuration.is_tip(last) {
            let angle = tip_angle(corrector, configuration);
            let stretch = configuration.contacts[last].stretch;
            if angle.sin() < -LIMIT_TOLERANCE && !corrector.setup.world.is_notch(stretch) {
                visit(Break::TipToTangent(angle));
                lying_down = Some(stretch);
            } else if let Some((wall, angle)) = wall_run_into(&corrector.setup.world, configuration, LIMIT_TOLERANCE) {
                visit(Break::OntoWall(wall, angle));
                lying_down = Some(wall);
            }
        } else if configuration.s(last) > 1.0 + LIMIT_TOLERANCE {
            visit(Break::TangentToTip);
        }
    }
    // a tip that has gone over goes through the contour just before it, and a contact that has left its stretch lies on
    // the next one: not touches of their own
    for crossing in scan
        .crossings
        .iter()
        .filter(|crossing| Some(crossing.stretch) != lying_down && !entered.contains(&crossing.stretch))
    {
        visit(Break::Touch(*crossing));
    }
}

/// phi(1) - alpha of a tip contact.
fn tip_angle(corrector: &Corrector<'_>, configuration: &Configuration) -> f64 {
    let last = configuration.count() - 1;
    let stretch = configuration.contacts[last].stretch;
    configuration.slope(last) - corrector.setup.world.support(stretch, configuration.t(last)).alpha
}

/// A transition, located.
#[derive(Clone, Debug)]
pub(crate) struct Transition {
    pub kind: EventKind,
    /// The contact set before, at the transition.
    pub before: Configuration,
    /// The contact set after, at the same pose.
    pub after: Configuration,
    /// How far along the tangent of the step it is.
    pub along: f64,
}

/// Why a transition could not be had.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum NoTransition {
    /// Newton's method did not come to it: try a shorter step.
    NotLocated,
    /// The contour ends there.
    EndOfContour,
}

impl Break {
    /// Arc length where the rod meets the contour anew; less than that for what concerns the contacts there are.
    pub fn s(&self) -> f64 {
        if let Self::Touch(crossing) = self { crossing.s } else { f64::NEG_INFINITY }
    }

    /// Finds where on the branch the condition broke, starting from `broken`, a point of the branch where it has.
    pub fn locate(
        self,
        corrector: &mut Corrector<'_>,
        broken: &Configuration,
        from: &Configuration,
        tangent: &Tangent,
    ) -> Result<Transition, NoTransition> {
        let last = broken.count().wrapping_sub(1);
        let (kind, before, after) = match self {
            Self::Release(j) => {
                let before = on(corrector, broken.clone(), Unknown::Force(j), 0.0)?;
                let mut after = before.clone();
                after.remove(j);
                (EventKind::Release, before, after)
            }
            Self::Border(j, upwards) => {
                let here = broken.contacts[j].stretch;
                let border = corrector.setup.world.border(here, upwards);
                let next = corrector.setup.world.neighbour(here, upwards).ok_or(NoTransition::EndOfContour)?;
                let before = on(corrector, broken.clone(), Unknown::Parameter(j), border)?;
                if corrector.setup.world.is_notch(next)
                    && straddles(&corrector.setup.world, &before)
                    && (1.0 - before.s(before.count() - 2)).abs() < MEETING
                {
                    let after = merged(&corrector.setup.world, &before);
                    (EventKind::Release, before, after)
                } else {
                    (EventKind::Piece, before.clone(), onto_neighbour(before, j, upwards, next, &corrector.setup.world))
                }
            }
            Self::OntoWall(wall, angle) => {
                let phi = lying_angle(&corrector.setup.world, broken, wall, angle);
                let before = on(corrector, broken.clone(), Unknown::Slope(last), phi)?;
                let after = parted(&corrector.setup.world, &before, wall);
                (EventKind::Touch, before, after)
            }
            Self::TangentToTip => {
                let before = on(corrector, broken.clone(), Unknown::ArcLength(last), 1.0)?;
                (EventKind::TangentToTip, before.clone(), as_tip(before, &corrector.setup.world))
            }
            Self::TipToTangent(angle) => {
                let after = on(corrector, as_tangent(broken.clone(), angle), Unknown::ArcLength(last), 1.0)?;
                (EventKind::TipToTangent, as_tip(after.clone(), &corrector.setup.world), after)
            }
            Self::Touch(crossing) if corrector.setup.world.is_notch(crossing.stretch) => {
                return Err(NoTransition::NotLocated);
            }
            Self::Touch(crossing) => {
                let (start, j) = with_contact(broken, &crossing);
                let after = on(corrector, start, Unknown::Force(j), 0.0)?;
                let (range, t) = (corrector.setup.world.range(crossing.stretch), after.t(j));
                if (t - range.clamp(t)).abs() > BEYOND_END * (1.0 + t.abs()) {
                    // it has gone so deep that it is a neighbour that it met first
                    return Err(NoTransition::NotLocated);
                }
                let mut before = after.clone();
                before.remove(j);
                let kind = if before.count() == 0 { EventKind::FirstContact } else { EventKind::Touch };
                (kind, before, after)
            }
        };
        // The tip-to-tangent point is compared as the tip contact it was.
        let along = tangent.along(&before.z, &from.z);
        Ok(Transition { kind, before, after, along })
    }
}

/// The point of the branch near `start` where one unknown has a given value.
pub(crate) fn on(
    corrector: &mut Corrector<'_>,
    mut start: Configuration,
    unknown: Unknown,
    value: f64,
) -> Result<Configuration, NoTransition> {
    let report = corrector.correct(&mut start, Condition::Fixed { unknown, value });
    if report.status.is_solved() { Ok(start) } else { Err(NoTransition::NotLocated) }
}

/// `configuration` with one more contact, without force, where the rod crosses the contour; and its number.
pub(crate) fn with_contact(configuration: &Configuration, crossing: &Crossing) -> (Configuration, usize) {
    let mut more = configuration.clone();
    let n = configuration.count();
    let j = (0..n).find(|&j| configuration.s(j) > crossing.s).unwrap_or(n);
    let (hold, third) =
        if crossing.tip { (Hold::Tip, crossing.phi) } else { (lying(crossing.phi - crossing.foot.alpha), crossing.s) };
    more.insert(j, Held { stretch: crossing.stretch, hold }, [crossing.foot.t, 0.0, third]);
    (more, j)
}
