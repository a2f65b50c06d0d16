//! The fold of a branch: where the path parameter stops to grow along it.

use crate::contact_set::Configuration;
use crate::continuation::branch::{Condition, Corrector, Tangent};
use rod_core::{RodError, find_root};
use std::cell::RefCell;

/// How near the fold is found, in arclength of the branch: the path parameter, which is stationary there, is then off by
/// about the square of it.
const ARCLENGTH: f64 = 1e-13;
/// The same for the first look, which the second one only has to be around.
const FIRST_LOOK: f64 = 1e-6;

/// How far beyond the ends of the step, in steps, the fold may be.
const BEYOND: [f64; 4] = [0.0, 0.1, 1.0, 10.0];

/// Half the arclength within which a fold that has been found is looked for again.
const AROUND: f64 = 1e-5;

/// The fold between `from` and `to`, a point of the branch on the other side of it along `tangent`.
pub(crate) fn locate_fold(
    corrector: &mut Corrector<'_>,
    from: &Configuration,
    tangent: &Tangent,
    to: &Configuration,
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
    let (fold, own) = between(corrector, from, tangent, guess, (&firsts, &lasts), FIRST_LOOK)?;
    // The planes across a tangent at some distance meet the branch at an angle. Those across the tangent of the fold itself
    // find it to the last digits.
    let across = |distance| own.ahead(&fold, distance);
    if let Some((fold, _)) = between(corrector, &fold, &own, across, (&[-AROUND], &[AROUND]), ARCLENGTH) {
        return Some(fold);
    }
    between(corrector, from, tangent, guess, (&firsts, &lasts), ARCLENGTH).map(|(fold, _)| fold)
}

/// The fold on planes across `tangent` between one of the distances `firsts` and one of `lasts` from `from`, and its tangent.
fn between(
    corrector: &mut Corrector<'_>,
    from: &Configuration,
    tangent: &Tangent,
    guess: impl Fn(f64) -> Configuration,
    (firsts, lasts): (&[f64], &[f64]),
    tolerance: f64,
) -> Option<(Configuration, Tangent)> {
    let corrector = RefCell::new(corrector);
    let point = |distance: f64| {
        let mut here = guess(distance);
        let condition = Condition::Plane { tangent, from: &from.z, distance };
        let mut corrector = corrector.borrow_mut();
        let solved = corrector.correct(&mut here, condition).status.is_solved();
        solved.then(|| (corrector.inspect(&here, condition).0, here))
    };
    let slope = |distance: f64| {
        point(distance)
            .map(|(tangent, _)| tangent.by_tau())
            .ok_or(RodError::NoRoot { what: "fold", reason: "lost the branch".into() })
    };
    let first = firsts.iter().find(|d| point(**d).is_some_and(|(tangent, _)| tangent.by_tau() > 0.0))?;
    let last = lasts.iter().find(|d| point(**d).is_some_and(|(tangent, _)| tangent.by_tau() < 0.0))?;
    let fold = find_root("d tau / d arclength", slope, *first, *last, tolerance).ok()?;
    point(fold.at).map(|(tangent, here)| (here, tangent))
}
