//! Transitions: which condition of a contact set is violated, and from which point of the branch on.
//!
//! Each condition is one variant of [`Break`] and one row of this table: [`breaks`] watches it, [`Break::vanishing`] gives the
//! equation that holds where it breaks, and [`Break::change`] the contact sets on both sides.
//!
//! | condition | watched | equation at the transition | contact set after it |
//! |---|---|---|---|
//! | `Release` | force >= 0 | force = 0 | without the contact |
//! | `Border` | parameter within the stretch | parameter = border | on the next stretch, or merged in a notch |
//! | `TipToTangent` | tip above the contour's tangent | s = 1 of a tangential contact | the same, tangential |
//! | `TangentToTip` | s <= 1 | s = 1 | the same, of the tip |
//! | `OntoWall` | rod above both walls of a notch | slope angle = the wall's | one contact on each wall |
//! | `Slip` | force along the contour within friction's limit | force along the contour = the limit | the same: its modes are chosen anew |
//! | `Touch` | no crossing of rod and contour | force of one more contact = 0 | with that contact |

use crate::contact_set::edit::{as_tangent, as_tip, onto_neighbour, without_contact};
use crate::contact_set::notch::{
    lying_angle, merge_in_notch, split_at_notch, split_onto_walls, straddles, wall_run_into, with_cone,
};
use crate::contact_set::{ActiveContact, Configuration, FORCE_TOLERANCE, Unknown, tangent_hold};
use crate::continuation::branch::{Condition, Corrector, Tangent};
use crate::event::EventKind;
use crate::gap::Crossing;
use crate::limits::LIMITS;
use crate::scene::world::World;
use rod_contours::Range;
use rod_core::{Hold, PhysicalRod};
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
    /// Contact j, which sticks, has more force along the contour than friction can bear: the limit of f_t / f, with its sign.
    Slip(usize, f64),
    /// The rod goes through the contour.
    Touch(Crossing),
}

/// Calls `visit` with every violated condition of `configuration`, whose rod goes through the contour at `crossings`.
pub(crate) fn breaks(
    world: &World<'_>,
    configuration: &Configuration,
    crossings: &[Crossing],
    mut visit: impl FnMut(Break),
) {
    let n = configuration.count();
    let mut entered: SmallVec<[usize; 4]> = SmallVec::new();
    for j in 0..n {
        if configuration.force(j) < -FORCE_TOLERANCE {
            visit(Break::Release(j));
        }
        if let Some(ratio) = passed_slip_limit(world, configuration, j) {
            visit(Break::Slip(j, ratio));
        }
        let range = range_of_force(world, configuration.contacts[j].stretch);
        let t = configuration.t(j);
        let slack = LIMITS.transition.rounding * (1.0 + t.abs());
        let upwards = t > range.to + slack;
        if upwards || t < range.from - slack {
            let next = world.neighbour(configuration.contacts[j].stretch, upwards);
            // A rod that comes to lie on a straight edge comes upon the corner at its other end at once, and what runs past a
            // notch goes into its other wall.
            let beyond = next.and_then(|next| world.neighbour(next, upwards));
            let past_notch = next.is_some_and(|next| world.is_notch(next));
            entered.extend(next);
            entered.extend(beyond.filter(|beyond| past_notch || world.is_corner(*beyond)));
            visit(Break::Border(j, upwards));
        }
    }
    let mut lying_down = None;
    if let Some(last) = n.checked_sub(1) {
        if configuration.is_tip(last) {
            let angle = tip_angle(world, configuration);
            let stretch = configuration.contacts[last].stretch;
            if angle.sin() < -LIMITS.transition.rounding && !world.is_notch(stretch) {
                visit(Break::TipToTangent(angle));
                lying_down = Some(stretch);
            } else if let Some((wall, angle)) = wall_run_into(world, configuration, LIMITS.transition.rounding) {
                visit(Break::OntoWall(wall, angle));
                lying_down = Some(wall);
            }
        } else if configuration.s(last) > 1.0 + LIMITS.transition.rounding {
            visit(Break::TangentToTip);
        }
    }
    // a tip that has gone over goes through the contour just before it, and a contact that has left its stretch lies on
    // the next one: not touches of their own
    let is_new = |crossing: &&Crossing| Some(crossing.stretch) != lying_down && !entered.contains(&crossing.stretch);
    crossings.iter().filter(is_new).for_each(|crossing| visit(Break::Touch(*crossing)));
}

/// The range of the parameter on a stretch. In a notch with friction it contains the directions of the force in the friction cones of both walls.
pub(super) fn range_of_force(world: &World<'_>, stretch: usize) -> Range {
    let Range { from, to } = world.span(stretch);
    if !world.rubs() || !world.is_notch(stretch) {
        return Range { from, to };
    }
    let angle = world.coefficients(stretch).at_rest.atan() / world.support(stretch, from).turning.abs();
    Range { from: from - angle, to: to + angle }
}

/// The limit of f_t / f, with its sign, at contact j, if that sticks and its force exceeds the limit.
fn passed_slip_limit(world: &World<'_>, configuration: &Configuration, j: usize) -> Option<f64> {
    let held = configuration.contacts[j];
    // of one that would have to pull, its release tells on which side it has left the cone
    if !held.grip.sticks() || configuration.force(j) < -FORCE_TOLERANCE {
        return None;
    }
    let (limit, friction) = (world.coefficients(held.stretch).at_rest, configuration.friction(j));
    let passed = friction.abs() > limit * configuration.force(j) + FORCE_TOLERANCE;
    passed.then_some(limit.copysign(friction))
}

/// phi(1) - alpha of a tip contact.
fn tip_angle(world: &World<'_>, configuration: &Configuration) -> f64 {
    let last = configuration.count() - 1;
    let stretch = configuration.contacts[last].stretch;
    configuration.slope(last) - world.support(stretch, configuration.t(last)).alpha
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

/// Why a transition was not located.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum NoTransition {
    /// Newton's method did not converge to it. A shorter step may.
    NotLocated,
    /// The contour ends there.
    EndOfContour,
    /// The contact set after it is only followed without friction.
    FrictionInNotch,
}

impl Break {
    /// Arc length at which the rod meets the contour anew; minus infinity for a condition of an existing contact, which comes first.
    pub fn s(&self) -> f64 {
        if let Self::Touch(crossing) = self { crossing.s } else { f64::NEG_INFINITY }
    }

    /// Locates the point of the branch from which on the condition is violated. The solve starts from `broken`, a point where it is violated.
    pub fn locate<R: PhysicalRod>(
        self,
        corrector: &mut Corrector<'_, R>,
        broken: &Configuration,
        from: &Configuration,
        tangent: &Tangent,
    ) -> Result<Transition, NoTransition> {
        let at = if let Self::Slip(j, ratio) = self {
            let (friction, force) = (broken.friction_index(j), Unknown::Force(j).index(broken.z.len()));
            solve_where(corrector, broken.clone(), Condition::OnCone { friction, force, ratio })?
        } else {
            let (start, unknown, value) = self.vanishing(&corrector.setup.world, broken)?;
            solve_fixed(corrector, start, unknown, value)?
        };
        // a contact that sticks slips before its force vanishes, unless both its parts vanish at once
        if let Self::Release(j) = self
            && broken.contacts[j].grip.sticks()
            && at.friction(j).abs() > FORCE_TOLERANCE
        {
            let limit = corrector.setup.world.coefficients(at.contacts[j].stretch).at_rest;
            return Self::Slip(j, limit.copysign(at.friction(j))).locate(corrector, &at, from, tangent);
        }
        let (kind, before, after) = self.change(&corrector.setup.world, broken, at)?;
        // The tip-to-tangent point is compared as the tip contact it was.
        let along = tangent.along(&before.z, &from.z);
        Ok(Transition { kind, before, after, along })
    }

    /// The equation that holds where the condition breaks: an unknown and its value, and a point near by to start from.
    fn vanishing(
        self,
        world: &World<'_>,
        broken: &Configuration,
    ) -> Result<(Configuration, Unknown, f64), NoTransition> {
        let last = broken.count().wrapping_sub(1);
        Ok(match self {
            Self::Release(j) => {
                (split_at_notch(world, broken).unwrap_or_else(|| broken.clone()), Unknown::Force(j), 0.0)
            }
            Self::Border(j, upwards) => {
                let here = broken.contacts[j].stretch;
                world.neighbour(here, upwards).ok_or(NoTransition::EndOfContour)?;
                let range = range_of_force(world, here);
                (broken.clone(), Unknown::Parameter(j), if upwards { range.to } else { range.from })
            }
            Self::OntoWall(..) if world.rubs() => return Err(NoTransition::FrictionInNotch),
            Self::OntoWall(wall, angle) => {
                (broken.clone(), Unknown::Slope(last), lying_angle(world, broken, wall, angle))
            }
            Self::TangentToTip => (broken.clone(), Unknown::ArcLength(last), 1.0),
            Self::TipToTangent(angle) => (as_tangent(broken.clone(), angle), Unknown::ArcLength(last), 1.0),
            // its condition is not that one unknown has a value
            Self::Slip(..) => return Err(NoTransition::NotLocated),
            Self::Touch(crossing) if world.is_notch(crossing.stretch) => return Err(NoTransition::NotLocated),
            Self::Touch(crossing) => {
                let (touching, j) = with_contact(broken, &crossing);
                (touching, Unknown::Force(j), 0.0)
            }
        })
    }

    /// The kind of event at `at`, the point where the condition breaks, and the contact sets before and after it. `at` was located from `broken`.
    fn change(
        self,
        world: &World<'_>,
        broken: &Configuration,
        at: Configuration,
    ) -> Result<(EventKind, Configuration, Configuration), NoTransition> {
        Ok(match self {
            Self::Release(j) => (EventKind::Release, at.clone(), without_contact(at, j)),
            Self::Border(j, upwards) => {
                let here = at.contacts[j].stretch;
                let next = world.neighbour(here, upwards).ok_or(NoTransition::EndOfContour)?;
                if world.rubs() && straddles(world, &at) {
                    return Err(NoTransition::FrictionInNotch);
                }
                let meets = |lying: usize| (1.0 - at.s(lying)).abs() < LIMITS.transition.meeting;
                if world.is_notch(next) && straddles(world, &at) && meets(at.count() - 2) {
                    let after = merge_in_notch(world, &at);
                    (EventKind::Release, at, after)
                } else if world.is_notch(next) && straddles(world, &at) && at.force(j) < LIMITS.transition.unloaded_tip
                {
                    // the rod is straight from the contact on its wall to the tip
                    (EventKind::Release, at.clone(), without_contact(at, j))
                } else {
                    let after = onto_neighbour(at.clone(), j, upwards, next, world);
                    let after = if world.rubs() { with_cone(world, &at, after, j, upwards) } else { after };
                    (EventKind::Piece, at, after)
                }
            }
            Self::Slip(..) => (EventKind::Slip, at.clone(), at),
            Self::OntoWall(wall, _) => {
                let after = split_onto_walls(world, &at, wall);
                (EventKind::Touch, at, after)
            }
            Self::TangentToTip => (EventKind::TangentToTip, at.clone(), as_tip(at, world)),
            Self::TipToTangent(_) => (EventKind::TipToTangent, as_tip(at.clone(), world), at),
            Self::Touch(crossing) => {
                let j = place_along_rod(broken, &crossing);
                let (range, t) = (world.span(crossing.stretch), at.t(j));
                if (t - range.clamp(t)).abs() > LIMITS.transition.beyond_stretch * (1.0 + t.abs()) {
                    // it has gone so deep that it is a neighbour that it met first
                    return Err(NoTransition::NotLocated);
                }
                let before = without_contact(at.clone(), j);
                let kind = if before.count() == 0 { EventKind::FirstContact } else { EventKind::Touch };
                (kind, before, at)
            }
        })
    }
}

/// The point of the branch near `start` where one unknown has a given value.
pub(crate) fn solve_fixed<R: PhysicalRod>(
    corrector: &mut Corrector<'_, R>,
    start: Configuration,
    unknown: Unknown,
    value: f64,
) -> Result<Configuration, NoTransition> {
    solve_where(corrector, start, Condition::Fixed { unknown, value })
}

/// The point of the branch near `start` where a condition holds.
fn solve_where<R: PhysicalRod>(
    corrector: &mut Corrector<'_, R>,
    mut start: Configuration,
    condition: Condition<'_>,
) -> Result<Configuration, NoTransition> {
    let report = corrector.correct(&mut start, condition);
    if report.status.is_solved() { Ok(start) } else { Err(NoTransition::NotLocated) }
}

/// `configuration` with one more contact, without force, where the rod crosses the contour, and the number of this contact.
pub(crate) fn with_contact(configuration: &Configuration, crossing: &Crossing) -> (Configuration, usize) {
    let mut more = configuration.clone();
    let j = place_along_rod(configuration, crossing);
    let (hold, third) = if crossing.tip {
        (Hold::Tip, crossing.phi)
    } else {
        (tangent_hold(crossing.phi - crossing.foot.alpha), crossing.s)
    };
    more.insert(j, ActiveContact::smooth(crossing.stretch, hold), [crossing.foot.t, 0.0, third]);
    (more, j)
}

/// The number that a contact at the crossing has along the rod.
fn place_along_rod(configuration: &Configuration, crossing: &Crossing) -> usize {
    let n = configuration.count();
    (0..n).find(|&j| configuration.s(j) > crossing.s).unwrap_or(n)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gap::Scanner;
    use crate::path::ClampPath;
    use crate::scene::Setup;
    use rod_contours::{Composite, Line, Motion, Moved, Parabola};
    use rod_core::{Pose, Rod};
    use std::f64::consts::{FRAC_PI_2, PI};

    /// Two edges that meet in a convex corner at the origin; the solid is above.
    fn wedge() -> Composite {
        Composite::polyline(&[[-1.0, 1.0], [0.0, 0.0], [1.0, 1.0]]).unwrap()
    }

    fn names(world: &World<'_>, held: ActiveContact, unknowns: [f64; 3], crossings: &[Crossing]) -> Vec<String> {
        let mut configuration = Configuration::free(0.0);
        configuration.insert(0, held, unknowns);
        let mut found = Vec::new();
        breaks(world, &configuration, crossings, |b| {
            found.push(format!("{b:?}").split(['(', ' ']).next().unwrap().into())
        });
        found
    }

    #[test]
    fn each_condition_is_watched() {
        let wedge = wedge();
        let world = World::new(wedge.as_ref(), 1.0);
        let corner = (0..3).find(|stretch| world.is_corner(*stretch)).unwrap();
        let edge = world.neighbour(corner, true).unwrap();
        let (from, to) = (world.border(edge, false), world.border(edge, true));
        let (middle, alpha) = (0.5 * (from + to), world.support(edge, from).alpha);
        let tip = ActiveContact::smooth(edge, Hold::Tip);
        let side = ActiveContact::smooth(edge, Hold::Tangent { offset: 0.0 });
        let phi = alpha + 0.5;
        assert!(names(&world, tip, [middle, 1.0, phi], &[]).is_empty());
        assert!(names(&world, side, [middle, 1.0, 0.7], &[]).is_empty());
        assert_eq!(names(&world, tip, [middle, -1e-3, phi], &[]), ["Release"]);
        assert_eq!(names(&world, tip, [to + 1e-6, 1.0, phi], &[]), ["Border"]);
        assert_eq!(names(&world, tip, [from - 1e-6, 1.0, phi], &[]), ["Border"]);
        assert_eq!(names(&world, tip, [middle, 1.0, alpha - 1e-6], &[]), ["TipToTangent"]);
        assert_eq!(names(&world, tip, [middle, 1.0, alpha + PI + 1e-6], &[]), ["TipToTangent"]);
        assert_eq!(names(&world, side, [middle, 1.0, 1.0 + 1e-6], &[]), ["TangentToTip"]);
        let crossing = |stretch| Crossing { stretch, s: 0.5, phi, foot: world.foot(stretch, 0.1, 0.2), tip: false };
        let before = world.neighbour(corner, false).unwrap();
        assert_eq!(names(&world, side, [middle, 1.0, 0.7], &[crossing(before)]), ["Touch"]);
        // the corner that a contact has run onto is no touch of its own
        assert_eq!(names(&world, side, [from - 1e-6, 1.0, 0.7], &[crossing(corner)]), ["Border"]);
    }

    /// A straight rod that stands upright, its clamp on the way along y = 0 from x = 1 to the left.
    fn upright(objects: &Composite) -> Setup<'_> {
        let pose = |x| Pose { x, y: 0.0, phi: FRAC_PI_2 };
        let path = ClampPath::new(pose(1.0), pose(-1.0)).unwrap();
        Setup::new(&Rod::new(1.0, 1.0).unwrap(), objects.as_ref(), path)
    }

    /// The first break at `tau`, located from the free rod at 0.
    fn first_transition_at(objects: &Composite, tau: f64) -> Transition {
        let mut corrector = Corrector::new(upright(objects));
        let (from, broken) = (Configuration::free(0.0), Configuration::free(tau));
        let scan = Scanner::default().scan(&corrector.setup, &broken);
        let tangent = corrector.inspect_at_pose(&from).0;
        let mut found = None;
        breaks(&corrector.setup.world, &broken, &scan.crossings, |b| found = Some(b));
        found.unwrap().locate(&mut corrector, &broken, &from, &tangent).unwrap()
    }

    #[test]
    fn a_tip_touches_where_the_straight_rod_reaches() {
        // the tip, at (1 - tau, 1), meets y = 0.75 + x^2 at x = 1/2
        let ceiling = Composite::single(Parabola::new([0.0, 0.75], 1.0).unwrap()).unwrap();
        let Transition { kind, before, after, along } = first_transition_at(&ceiling, 0.52);
        assert_eq!(kind, EventKind::FirstContact);
        assert_eq!((before.count(), after.count()), (0, 1));
        assert!(after.ends_at_tip() && after.force(0) == 0.0);
        assert!((before.tau() - 0.5).abs() < 1e-13 && (after.t(0) - 0.5).abs() < 1e-13 && (along - 0.5).abs() < 1e-13);
    }

    #[test]
    fn a_side_touches_where_the_straight_rod_is_tangential() {
        // the solid is left of x = -0.2 - (y - 0.6)^2
        let wall = Parabola::new([0.0, 0.0], 1.0).unwrap();
        let motion = Motion { rotation: FRAC_PI_2, translation: [-0.2, 0.6], ..Motion::IDENTITY };
        let wall = Composite::single(Moved::new(wall, motion).unwrap()).unwrap();
        let Transition { kind, after, .. } = first_transition_at(&wall, 1.23);
        assert_eq!(kind, EventKind::FirstContact);
        assert!(!after.ends_at_tip() && (after.s(0) - 0.6).abs() < 1e-10 && (after.tau() - 1.2).abs() < 1e-13);
    }

    #[test]
    fn the_end_of_a_contour_is_said() {
        let line = Composite::single(Line::new([0.0, 1.0], [1.0, 1.0]).unwrap()).unwrap();
        let mut corrector = Corrector::new(upright(&line));
        let mut broken = Configuration::free(0.9);
        broken.insert(0, ActiveContact::smooth(0, Hold::Tip), [-1e-3, 1.0, FRAC_PI_2]);
        let tangent = Tangent { direction: SmallVec::from_elem(0.5, 4), weights: SmallVec::from_elem(1.0, 4) };
        let at_end = Break::Border(0, false).locate(&mut corrector, &broken, &broken, &tangent);
        assert!(matches!(at_end, Err(NoTransition::EndOfContour)), "{at_end:?}");
    }
}
