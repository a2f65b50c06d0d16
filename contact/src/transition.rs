//! Transitions: which condition of a contact set is broken, and where on the branch it broke.

use crate::branch::{Condition, Corrector, Tangent};
use crate::configuration::{Configuration, Held, lying};
use crate::event::EventKind;
use crate::gap::Crossing;
use crate::notch::{lying_angle, merged, parted, straddles, wall_run_into};
use crate::scan::Scan;
use crate::world::World;
use rod_core::Hold;
use smallvec::SmallVec;
use std::f64::consts::TAU;

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

/// Forces down to minus this count as zero.
pub(crate) const FORCE_TOLERANCE: f64 = 1e-12;
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
        let range = corrector.world.range(configuration.contacts[j].stretch);
        let t = configuration.t(j);
        let slack = LIMIT_TOLERANCE * (1.0 + t.abs());
        let upwards = t > range.to + slack;
        if upwards || t < range.from - slack {
            let next = corrector.world.neighbour(configuration.contacts[j].stretch, upwards);
            // A rod that comes to lie on a straight edge comes upon the corner at its other end at once, and what runs past a
            // notch goes into its other wall.
            let beyond = next.and_then(|next| corrector.world.neighbour(next, upwards));
            let past_notch = next.is_some_and(|next| corrector.world.is_notch(next));
            entered.extend(next);
            entered.extend(beyond.filter(|beyond| past_notch || corrector.world.is_corner(*beyond)));
            visit(Break::Border(j, upwards));
        }
    }
    let mut lying_down = None;
    if let Some(last) = n.checked_sub(1) {
        if configuration.is_tip(last) {
            let angle = tip_angle(corrector, configuration);
            let stretch = configuration.contacts[last].stretch;
            if angle.sin() < -LIMIT_TOLERANCE && !corrector.world.is_notch(stretch) {
                visit(Break::TipToTangent(angle));
                lying_down = Some(stretch);
            } else if let Some((wall, angle)) = wall_run_into(&corrector.world, configuration, LIMIT_TOLERANCE) {
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
    configuration.z[3 * last + 2] - corrector.world.support(stretch, configuration.t(last)).alpha
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
                let before = on(corrector, broken.clone(), 3 * j + 1, 0.0)?;
                let mut after = before.clone();
                after.remove(j);
                (EventKind::Release, before, after)
            }
            Self::Border(j, upwards) => {
                let here = broken.contacts[j].stretch;
                let border = corrector.world.border(here, upwards);
                let next = corrector.world.neighbour(here, upwards).ok_or(NoTransition::EndOfContour)?;
                let before = on(corrector, broken.clone(), 3 * j, border)?;
                if corrector.world.is_notch(next)
                    && straddles(&corrector.world, &before)
                    && (1.0 - before.s(before.count() - 2)).abs() < MEETING
                {
                    let after = merged(&corrector.world, &before);
                    (EventKind::Release, before, after)
                } else {
                    (EventKind::Piece, before.clone(), onto_neighbour(before, j, upwards, next, &corrector.world))
                }
            }
            Self::OntoWall(wall, angle) => {
                let phi = lying_angle(&corrector.world, broken, wall, angle);
                let before = on(corrector, broken.clone(), 3 * last + 2, phi)?;
                let after = parted(&corrector.world, &before, wall);
                (EventKind::Touch, before, after)
            }
            Self::TangentToTip => {
                let before = on(corrector, broken.clone(), 3 * last + 2, 1.0)?;
                (EventKind::TangentToTip, before.clone(), as_tip(before, corrector))
            }
            Self::TipToTangent(angle) => {
                let after = on(corrector, as_tangent(broken.clone(), angle), 3 * last + 2, 1.0)?;
                (EventKind::TipToTangent, as_tip(after.clone(), corrector), after)
            }
            Self::Touch(crossing) if corrector.world.is_notch(crossing.stretch) => {
                return Err(NoTransition::NotLocated);
            }
            Self::Touch(crossing) => {
                let (start, j) = with_contact(broken, &crossing);
                let after = on(corrector, start, 3 * j + 1, 0.0)?;
                let (range, t) = (corrector.world.range(crossing.stretch), after.t(j));
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
    index: usize,
    value: f64,
) -> Result<Configuration, NoTransition> {
    let report = corrector.correct(&mut start, Condition::Fixed { index, value });
    if report.status.is_solved() { Ok(start) } else { Err(NoTransition::NotLocated) }
}

/// Contact j moved over the border of its stretch to where `next` begins. The angle of a closed contour jumps by whole
/// turns where it begins anew.
pub(crate) fn onto_neighbour(
    mut configuration: Configuration,
    j: usize,
    upwards: bool,
    next: usize,
    world: &World<'_>,
) -> Configuration {
    let here = configuration.contacts[j].stretch;
    let (leaves, enters) = (world.border(here, upwards), world.border(next, !upwards));
    if let Hold::Tangent { offset } = &mut configuration.contacts[j].hold {
        let jump = world.support(here, leaves).alpha - world.support(next, enters).alpha;
        *offset += TAU * (jump / TAU).round();
    }
    configuration.contacts[j].stretch = next;
    configuration.z[3 * j] = enters;
    configuration
}

/// The tip, at an end of its piece where there is a convex corner, on the piece beyond that: on the corner itself it cannot
/// rest.
pub(crate) fn beyond_corner(mut configuration: Configuration, world: &World<'_>) -> Option<Configuration> {
    let last = configuration.count().checked_sub(1).filter(|last| configuration.is_tip(*last))?;
    let (here, t) = (configuration.contacts[last].stretch, configuration.t(last));
    let range = world.range(here);
    let upwards = t - range.from > range.to - t;
    let corner = world.neighbour(here, upwards).filter(|next| world.is_corner(*next))?;
    let beyond = world.neighbour(corner, upwards)?;
    configuration.contacts[last].stretch = beyond;
    configuration.z[3 * last] = world.border(beyond, !upwards);
    Some(configuration)
}

/// The last contact, new on a corner and at s = 1, as a contact of the tip on each of the two pieces that end there.
pub(crate) fn beside_corner(configuration: &Configuration, corrector: &Corrector<'_>) -> SmallVec<[Configuration; 2]> {
    let world = &corrector.world;
    let is_new = |j: usize| !configuration.is_tip(j) && configuration.force(j).abs() < FORCE_TOLERANCE;
    let at_tip = |j: usize| (configuration.s(j) - 1.0).abs() < BEYOND_END;
    let on_corner = |j: usize| world.is_corner(configuration.contacts[j].stretch);
    let last = configuration.count().checked_sub(1).filter(|j| is_new(*j) && at_tip(*j) && on_corner(*j));
    let Some(last) = last else { return SmallVec::new() };
    let corner = configuration.contacts[last].stretch;
    let pieces = [false, true].into_iter().filter_map(|after| Some((world.neighbour(corner, after)?, after)));
    let on_piece = |(piece, after): (usize, bool)| {
        let mut beside = as_tip(configuration.clone(), corrector);
        beside.contacts[last].stretch = piece;
        beside.z[3 * last] = world.border(piece, !after);
        beside
    };
    pieces.map(on_piece).collect()
}

/// The last contact, tangential at s = 1, as a contact of the tip.
pub(crate) fn as_tip(mut configuration: Configuration, corrector: &Corrector<'_>) -> Configuration {
    let last = configuration.count() - 1;
    let Held { stretch, hold } = configuration.contacts[last];
    if let Hold::Tangent { offset } = hold {
        configuration.z[3 * last + 2] = corrector.world.support(stretch, configuration.t(last)).alpha + offset;
        configuration.contacts[last].hold = Hold::Tip;
    }
    configuration
}

/// The contact at the tip, where phi(1) - alpha is about `angle`, as a tangential one at s = 1.
pub(crate) fn as_tangent(mut configuration: Configuration, angle: f64) -> Configuration {
    let last = configuration.count() - 1;
    configuration.contacts[last].hold = lying(angle);
    configuration.z[3 * last + 2] = 1.0;
    configuration
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
