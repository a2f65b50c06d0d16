//! Shapes made of a function: proven by the limits that its author gives, sampled without them.

use std::sync::Arc;

use crate::nearest::cuts;
use crate::nearest::search::{self, Probe};
use crate::proof::limits::{self, LimitsOf};
use crate::proof::{curvature, one_way, proven};
use crate::{Bounds, Closest, Contour, ContourError, Limits, Range, check};

/// A shape made of a function.
pub(crate) trait Function: Contour + Sized {
    /// The limits over a part of the range, where they are known.
    fn limits(&self) -> Option<&LimitsOf>;

    /// r, r' and r'' at `t`.
    fn derivatives_at(&self, t: f64) -> [[f64; 2]; 3];
}

/// Limits given for a shape, checked against samples of it.
pub(crate) fn checked(
    shape: &impl Function,
    limits: impl Fn(Range) -> Limits + Send + Sync + 'static,
) -> Result<LimitsOf, ContourError> {
    let Range { from, to } = shape.range();
    check::finite([("the start of the range", from), ("the end of the range", to)])?;
    let known: LimitsOf = Arc::new(limits);
    limits::check(shape, &known)?;
    Ok(known)
}

pub(crate) fn closest_in(shape: &impl Function, range: Range, x: f64, y: f64) -> Closest {
    if let Some(limits) = shape.limits() {
        let range = shape.range().within(range);
        let t = proven::nearest(|t| shape.derivatives_at(t), &**limits, range, [x, y]);
        return Closest::new(t, shape.frame(t), range.is_interior(t), x, y);
    }
    search::closest_by(shape, range, x, y, |t| Probe::new(t, shape.derivatives_at(t), x, y))
}

pub(crate) fn bounds_in(shape: &impl Function, range: Range) -> Bounds {
    match shape.limits() {
        Some(known) => limits::bounds(shape, known, shape.range().within(range)),
        None => search::bounds(shape, range),
    }
}

pub(crate) fn cuts(shape: &impl Function, range: Range) -> Vec<f64> {
    let known = shape.limits().and_then(|known| one_way::cuts(shape, known, shape.range().within(range)));
    known.unwrap_or_else(|| cuts::sampled(shape, range))
}

pub(crate) fn is_convex(shape: &impl Function, range: Range) -> bool {
    shape.limits().is_some_and(|known| one_way::is_convex(shape, known, shape.range().within(range)))
}

pub(crate) fn curvature_in(shape: &impl Function, range: Range) -> (f64, f64) {
    shape.limits().map_or(curvature::ANY, |known| known(shape.range().within(range)).curvature)
}
