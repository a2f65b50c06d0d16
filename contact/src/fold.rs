//! The fold of a branch: where the path parameter stops to grow along it.

use crate::branch::{Condition, Corrector, Tangent};
use crate::configuration::Configuration;
use rod_core::{RodError, find_root};
use std::cell::RefCell;

/// How near the fold is found, in arclength of the branch: the path parameter, which is stationary there, is then off by
/// about the square of it.
const ARCLENGTH: f64 = 1e-9;

/// How far beyond the ends of the step, in steps, the fold may be.
const BEYOND: [f64; 4] = [0.0, 0.1, 1.0, 10.0];

/// The fold between `from` and `to`, a point of the branch on the other side of it along `tangent`.
pub(crate) fn locate_fold(
    corrector: &mut Corrector<'_>,
    from: &Configuration,
    tangent: &Tangent,
    to: &Configuration,
) -> Option<Configuration> {
    let whole = tangent.along(&to.z, &from.z);
    let corrector = RefCell::new(corrector);
    let point = |distance: f64| {
        let mut here = from.clone();
        for (z, end) in here.z.iter_mut().zip(&to.z) {
            *z += distance / whole * (end - *z);
        }
        let condition = Condition::Plane { tangent, from: &from.z, distance };
        let mut corrector = corrector.borrow_mut();
        let solved = corrector.correct(&mut here, condition).status.is_solved();
        solved.then(|| (corrector.inspect(&here, condition).0.by_tau(), here))
    };
    let slope = |distance: f64| {
        point(distance)
            .map(|(slope, _)| slope)
            .ok_or(RodError::NoRoot { what: "fold", reason: "lost the branch".into() })
    };
    // The caller's slopes come from Jacobians that are one correction old: an end may be just on the other side of the
    // fold.
    let first = BEYOND.into_iter().map(|d| -d * whole).find(|d| point(*d).is_some_and(|(slope, _)| slope > 0.0))?;
    let last =
        BEYOND.into_iter().map(|d| (1.0 + d) * whole).find(|d| point(*d).is_some_and(|(slope, _)| slope < 0.0))?;
    let fold = find_root("d tau / d arclength", slope, first, last, ARCLENGTH).ok()?;
    point(fold.at).map(|(_, here)| here)
}
