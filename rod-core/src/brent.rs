//! Roots of functions of one variable, by Brent's method. The only file that knows `argmin`'s `BrentRoot`.

use crate::error::RodError;
use argmin::core::{CostFunction, Error, Executor, State, TerminationReason, TerminationStatus};
use argmin::solver::brent::BrentRoot;

/// A root and how well it was found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Root {
    /// Where.
    pub at: f64,
    /// Value of the function there.
    pub residual: f64,
    /// Number of iterations.
    pub iterations: u64,
}

/// Bisection alone needs 64 steps to exhaust the digits of a bracket, Brent's method rarely more than 15; this many are
/// spent on functions that defeat interpolation.
const MOST_ITERATIONS: u64 = 200;

/// A root of `f` between `from` and `to`, where `f` has opposite signs, within `tolerance` / 2 of a change of sign
/// (absolute; 0 asks for all digits: the rounding of the root, 4.4e-16 of it, is added). `what` names the function in
/// errors.
///
/// Of several roots it finds one, and which one depends on the bracket.
///
/// ```
/// let root = rod_core::find_root("cosine", |x| Ok(x.cos()), 0.0, 3.0, 0.0)?;
/// assert!((root.at - std::f64::consts::FRAC_PI_2).abs() < 1e-15);
/// assert!(rod_core::find_root("cosine", |x| Ok(x.cos()), 0.0, 1.0, 0.0).is_err());
/// # Ok::<(), rod_core::RodError>(())
/// ```
///
/// # Errors
/// The first error of `f`; [`RodError::NoRoot`] where the signs at the ends agree, a value or an end is not finite, or the
/// iterations run out (200).
pub fn find_root(
    what: &'static str,
    f: impl Fn(f64) -> Result<f64, RodError>,
    from: f64,
    to: f64,
    tolerance: f64,
) -> Result<Root, RodError> {
    let no_root = |reason: String| RodError::NoRoot { what, reason };
    if !(from.is_finite() && to.is_finite() && tolerance >= 0.0) {
        return Err(no_root(format!("bracket from {from} to {to}, tolerance {tolerance}")));
    }
    let result = Executor::new(Function { what, f: &f }, BrentRoot::new(from, to, tolerance))
        .configure(|state| state.max_iters(MOST_ITERATIONS))
        .ctrlc(false)
        .timer(false)
        .run();
    let state = match result {
        Ok(result) => result.state,
        // an error of ours comes back unchanged, any other is the solver's
        Err(error) => return Err(error.downcast::<RodError>().unwrap_or_else(|error| no_root(error.to_string()))),
    };
    if *state.get_termination_status() != TerminationStatus::Terminated(TerminationReason::SolverConverged) {
        return Err(no_root(format!("{MOST_ITERATIONS} iterations were not enough")));
    }
    // not the "best" one, which is the first of equals: the last is the one whose bracket closed
    match state.get_param() {
        Some(&at) => Ok(Root { at, residual: f(at)?, iterations: state.get_iter() }),
        None => Err(no_root("no value".into())),
    }
}

struct Function<'a, F> {
    what: &'static str,
    f: &'a F,
}

impl<F: Fn(f64) -> Result<f64, RodError>> CostFunction for Function<'_, F> {
    type Param = f64;
    type Output = f64;

    fn cost(&self, x: &f64) -> Result<f64, Error> {
        let value = (self.f)(*x)?;
        if value.is_finite() {
            return Ok(value);
        }
        // NaN has no sign: the solver would go on with it
        Err(RodError::NoRoot { what: self.what, reason: format!("the value at {x} is {value}") }.into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_roots_to_the_last_digit_from_either_side() {
        for (from, to) in [(0.0, 2.0), (2.0, 0.0), (2.0_f64.cbrt(), 5.0), (0.0, 2.0_f64.cbrt()), (-1e6, 1e6)] {
            let root = find_root("cube", |x| Ok(x * x * x - 2.0), from, to, 0.0).unwrap();
            assert!((root.at - 2.0_f64.cbrt()).abs() < 1e-15, "{root:?}");
            assert!(root.residual.abs() < 3e-15 && root.iterations < 100);
        }
    }

    #[test]
    fn tolerance_is_absolute_and_bounds_the_distance_to_the_change_of_sign() {
        for tolerance in [1e-2, 1e-5, 1e-9] {
            let root = find_root("cube", |x| Ok(x * x * x - 2.0), 0.0, 9.0, tolerance).unwrap();
            assert!((root.at - 2.0_f64.cbrt()).abs() <= 0.5 * tolerance + 1e-15, "{tolerance}");
        }
    }

    #[test]
    fn survives_steep_flat_and_broken_functions() {
        let step = find_root("step", |x| Ok(if x < 0.3 { -1.0 } else { 1.0 }), 0.0, 1.0, 1e-12).unwrap();
        assert!((step.at - 0.3).abs() < 1e-12);
        assert!(find_root("flat", |x: f64| Ok((x - 0.3).powi(9)), 0.0, 1.0, 1e-9).is_ok());
        for broken in [f64::NAN, f64::INFINITY] {
            let result = find_root("broken", |x| Ok(if x > 0.4 { broken } else { x - 0.5 }), 0.0, 1.0, 0.0);
            assert!(matches!(result, Err(RodError::NoRoot { what: "broken", .. })), "{result:?}");
        }
        assert!(matches!(find_root("same", |_| Ok(1.0), 0.0, 1.0, 0.0), Err(RodError::NoRoot { .. })));
        assert!(matches!(find_root("nan", Ok, f64::NAN, 1.0, 0.0), Err(RodError::NoRoot { .. })));
        assert!(matches!(find_root("tolerance", Ok, -1.0, 1.0, -1.0), Err(RodError::NoRoot { .. })));
    }

    #[test]
    fn an_error_of_the_function_comes_through() {
        let ours = RodError::NotFinite { what: "x", value: 1.0 };
        assert_eq!(find_root("f", |_| Err(ours.clone()), 0.0, 1.0, 0.0), Err(ours));
    }
}
