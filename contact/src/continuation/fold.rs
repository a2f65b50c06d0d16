//! The fold of a branch: where the path parameter stops to grow along it.

use crate::contact_set::Configuration;
use crate::continuation::branch::{Condition, Corrector, Tangent};
use crate::limits::LIMITS;
use crate::scene::Setup;
use rod_core::{PhysicalRod, RodError, find_root};
use std::cell::RefCell;

/// Tolerance of the first search, arclength. It only gives the second one its tangent and its bracket.
const FIRST_LOOK: f64 = 1e-6;

/// Distances of the bracket from the ends of the step, in steps, tried in order.
const BEYOND: [f64; 4] = [0.0, 0.1, 1.0, 10.0];

/// Half the bracket of the second search, in arclength. It must be larger than the error of the first.
const AROUND: f64 = 1e-5;

/// The first fold between `from`, whose tangent is given, and `to`, a point of the branch beyond the fold. None where it is not located, or
/// where the fold that is found lies before `from`: then it is another one, because up to the first fold the path parameter grows.
pub(crate) fn locate_fold<R: PhysicalRod>(
    corrector: &mut Corrector<'_, R>,
    from: &Configuration,
    tangent: &Tangent,
    to: &Configuration,
) -> Option<Configuration> {
    locate_zero(corrector, from, tangent, to, |_, _, tangent| tangent.by_tau())
}

/// The first point between `from` and `to` where `rate`, which is positive at `from`, vanishes along the branch.
pub(crate) fn locate_zero<R: PhysicalRod>(
    corrector: &mut Corrector<'_, R>,
    from: &Configuration,
    tangent: &Tangent,
    to: &Configuration,
    rate: impl Fn(&Setup<'_, R>, &Configuration, &Tangent) -> f64,
) -> Option<Configuration> {
    let whole = tangent.along(&to.z, &from.z);
    let guess = |distance: f64| {
        let mut here = from.clone();
        for (z, end) in here.z.iter_mut().zip(&to.z) {
            *z += distance / whole * (end - *z);
        }
        here
    };
    // The caller's slopes come from Jacobians that are one correction old: an end may be just on the other side of the
    // fold.
    let firsts = BEYOND.map(|d| -d * whole);
    let lasts = BEYOND.map(|d| (1.0 + d) * whole);
    let (fold, own) = between(corrector, from, tangent, guess, (&firsts, &lasts), (FIRST_LOOK, &rate))?;
    // The planes across a tangent at some distance meet the branch at an angle. Those across the tangent of the fold itself
    // find it to the last digits.
    let across = |distance| own.ahead(&fold, distance);
    let closer = between(corrector, &fold, &own, across, (&[-AROUND], &[AROUND]), (LIMITS.transition.fold, &rate));
    let (fold, _) = closer
        .or_else(|| between(corrector, from, tangent, guess, (&firsts, &lasts), (LIMITS.transition.fold, &rate)))?;
    (fold.tau() > from.tau() - LIMITS.transition.same_fold).then_some(fold)
}

/// The zero of `rate` on planes across `tangent`, and the tangent there. The bracket is the first of the distances `firsts` from `from` at which
/// the rate is positive, and the first of `lasts` at which it is negative.
fn between<R: PhysicalRod>(
    corrector: &mut Corrector<'_, R>,
    from: &Configuration,
    tangent: &Tangent,
    guess: impl Fn(f64) -> Configuration,
    (firsts, lasts): (&[f64], &[f64]),
    (tolerance, rate): (f64, &impl Fn(&Setup<'_, R>, &Configuration, &Tangent) -> f64),
) -> Option<(Configuration, Tangent)> {
    let corrector = RefCell::new(corrector);
    let point = |distance: f64| {
        let mut here = guess(distance);
        let condition = Condition::Plane { tangent, from: &from.z, distance };
        let mut corrector = corrector.borrow_mut();
        let solved = corrector.correct(&mut here, condition).status.is_solved();
        if !solved {
            return None;
        }
        let there = corrector.inspect(&here, condition).0;
        let rate = rate(&corrector.setup, &here, &there);
        Some((there, here, rate))
    };
    let slope = |distance: f64| {
        point(distance)
            .map(|(.., rate)| rate)
            .ok_or(RodError::NoRoot { what: "fold", reason: "lost the branch".into() })
    };
    let first = firsts.iter().find(|d| point(**d).is_some_and(|(.., rate)| rate > 0.0))?;
    let last = lasts.iter().find(|d| point(**d).is_some_and(|(.., rate)| rate < 0.0))?;
    let fold = find_root("d tau / d arclength", slope, *first, *last, tolerance).ok()?;
    point(fold.at).map(|(tangent, here, _)| (here, tangent))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact_set::ActiveContact;
    use crate::path::ClampPath;
    use rod_contours::{Composite, Parabola};
    use rod_core::{Hold, Pose, Rod};
    use std::f64::consts::FRAC_PI_2;

    /// An upright rod whose tip is dragged to the left over the ceiling y = 0.9 + x^2 / 2, from x = 0.3 until it slips through.
    #[test]
    fn the_path_parameter_is_largest_at_the_fold() {
        let pose = |x| Pose { x, y: 0.0, phi: FRAC_PI_2 };
        let ceiling = Composite::single(Parabola::new([0.0, 0.9], 0.5).unwrap()).unwrap();
        let path = ClampPath::new(pose(0.44), pose(-1.0)).unwrap();
        let setup = Setup::new(&Rod::new(1.0, 1.0).unwrap(), ceiling.as_ref(), path);
        let mut corrector = Corrector::new(setup);
        let mut here = Configuration::free(0.0);
        here.insert(0, ActiveContact::smooth(0, Hold::Tip), [0.44, 0.05, FRAC_PI_2 - 0.1]);
        assert!(corrector.solve_from_guess(&mut here, 0.0).status.is_solved());
        let mut tangent = corrector.inspect_at_pose(&here).0;
        let (from, to) = loop {
            let mut next = tangent.ahead(&here, 0.1);
            let plane = Condition::Plane { tangent: &tangent, from: &here.z, distance: 0.1 };
            assert!(corrector.correct(&mut next, plane).status.is_solved() && next.tau() < 1.4);
            let after = corrector.inspect(&next, plane).0;
            if after.by_tau() < 0.0 {
                break (here, next);
            }
            (here, tangent) = (next, after);
        };
        let fold = locate_fold(&mut corrector, &from, &tangent, &to).unwrap();
        let along = tangent.along(&fold.z, &from.z);
        assert!((0.0..0.11).contains(&along), "{along}");
        let mut tau = |distance: f64| {
            let mut beside = fold.clone();
            let plane = Condition::Plane { tangent: &tangent, from: &fold.z, distance };
            for (z, d) in beside.z.iter_mut().zip(&tangent.direction) {
                *z += distance * d;
            }
            assert!(corrector.correct(&mut beside, plane).status.is_solved());
            beside.tau()
        };
        let lost = [-2e-3, -1e-3, 1e-3, 2e-3].map(|distance| fold.tau() - tau(distance));
        assert!(lost.iter().all(|lost| *lost > 0.0), "{lost:?}");
        // a parabola about the fold
        assert!((lost[0] / lost[1] - 4.0).abs() < 0.05 && (lost[3] / lost[2] - 4.0).abs() < 0.05, "{lost:?}");
    }
}
