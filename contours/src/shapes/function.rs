//! Shapes made of a function, and the numbers that carry its derivatives. Their closest points are proven where its author gives
//! limits, and come from samples where not.

use std::sync::Arc;

use crate::nearest::cuts;
use crate::nearest::search::{self, Probe};
use crate::proof::limits::{self, LimitsOf};
use crate::proof::{bending, branch_and_bound};
use crate::{Bounds, Closest, Contour, ContourError, Limits, Range, Vector, check};

/// A number with its first and second derivative (a second-order dual number): fields `re`, `v1` and `v2`.
///
/// Arithmetic works as with floating-point numbers, also mixed with them (the float on the right); functions such as
/// `sqrt`, `sin` and `powi` are methods of the trait [`DualNum`], which must be in scope.
///
/// ```
/// use rod_contours::{DualNum, Jet};
///
/// let x = Jet::from_re(2.0).derivative();
/// let y = x.powi(3) + x * 0.5;
/// assert_eq!((y.re, y.v1, y.v2), (9.0, 12.5, 12.0));
/// ```
pub use num_dual::Dual2_64 as Jet;

/// The functions of a [`Jet`].
pub use num_dual::DualNum;

/// The variable itself at `t`: derivative 1, second derivative 0.
pub(crate) fn variable(t: f64) -> Jet {
    Jet::from_re(t).derivative()
}

/// A shape made of a function.
pub(crate) trait Function: Contour + Sized {
    /// The limits over a part of the range, where they are known.
    fn limits(&self) -> Option<&LimitsOf>;

    /// r, r' and r'' at `t`.
    fn derivatives_at(&self, t: f64) -> [Vector; 3];
}

/// The limits that the author of a shape gives, after a check against samples of it.
pub(crate) fn check_limits(
    shape: &impl Function,
    limits: impl Fn(Range) -> Limits + Send + Sync + 'static,
) -> Result<LimitsOf, ContourError> {
    let Range { from, to } = shape.range();
    check::finite([("the start of the range", from), ("the end of the range", to)])?;
    let known: LimitsOf = Arc::new(limits);
    limits::check(|t| shape.frame(t), &known, shape.range())?;
    Ok(known)
}

/// The methods of [`Contour`] that a shape made of a function has from it.
macro_rules! methods_of_function {
    () => {
        fn closest_in(&self, range: Range, x: f64, y: f64) -> Closest {
            function::closest_in(self, range, x, y)
        }

        fn bounds_in(&self, range: Range) -> Bounds {
            function::bounds_in(self, range)
        }

        fn cuts(&self, range: Range) -> Vec<f64> {
            function::cuts(self, range)
        }

        /// Where the limits show that it bends one way only.
        fn is_convex(&self, range: Range) -> bool {
            function::is_convex(self, range)
        }

        fn curvature_in(&self, range: Range) -> (f64, f64) {
            function::curvature_in(self, range)
        }

        /// With limits.
        fn closest_is_exact(&self) -> bool {
            self.limits.is_some()
        }
    };
}
pub(crate) use methods_of_function;

pub(crate) fn closest_in(shape: &impl Function, range: Range, x: f64, y: f64) -> Closest {
    if let Some(limits) = shape.limits() {
        let range = shape.range().within(range);
        let t = branch_and_bound::closest_parameter(|t| shape.derivatives_at(t), &**limits, range, [x, y]);
        return Closest::new(t, shape.frame(t), range.is_interior(t), x, y);
    }
    search::closest_by(|t| shape.frame(t), shape.range(), range, x, y, |t| Probe::new(t, shape.derivatives_at(t), x, y))
}

pub(crate) fn bounds_in(shape: &impl Function, range: Range) -> Bounds {
    match shape.limits() {
        Some(known) => limits::bounds(|t| shape.frame(t), known, shape.range().within(range)),
        None => search::bounds(|t| shape.frame(t), range),
    }
}

pub(crate) fn cuts(shape: &impl Function, range: Range) -> Vec<f64> {
    let known = shape.limits().and_then(|known| bending::cuts(|t| shape.frame(t), known, shape.range().within(range)));
    known.unwrap_or_else(|| cuts::from_samples(|t| shape.frame(t), range))
}

pub(crate) fn is_convex(shape: &impl Function, range: Range) -> bool {
    shape.limits().is_some_and(|known| bending::is_convex(|t| shape.frame(t), known, shape.range().within(range)))
}

pub(crate) fn curvature_in(shape: &impl Function, range: Range) -> (f64, f64) {
    shape.limits().map_or(limits::ANY_CURVATURE, |known| known(shape.range().within(range)).curvature)
}
