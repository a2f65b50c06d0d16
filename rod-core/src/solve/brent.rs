//! Roots of functions of one variable, by Brent's method.

use crate::error::RodError;

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
    let f = |x: f64| match f(x)? {
        value if value.is_finite() => Ok(value),
        // NaN has no sign: the bracket would not hold
        value => Err(no_root(format!("the value at {x} is {value}"))),
    };
    let (mut a, mut b) = (from, to);
    let (mut fa, mut fb) = (f(a)?, f(b)?);
    if fa * fb > 0.0 {
        return Err(no_root(format!("the values at {a} and {b}, {fa} and {fb}, have the same sign")));
    }
    // b is the best point, a the one before, c the other end of the bracket; d is the last step, e the one before
    let (mut c, mut fc, mut d, mut e) = (b, fb, f64::NAN, f64::NAN);
    for iterations in 1..=MOST_ITERATIONS {
        if (fb > 0.0 && fc > 0.0) || (fb < 0.0 && fc < 0.0) {
            (c, fc) = (a, fa);
            d = b - a;
            e = d;
        }
        if fc.abs() < fb.abs() {
            (a, b, c) = (b, c, b);
            (fa, fb, fc) = (fb, fc, fb);
        }
        let least = 2.0 * f64::EPSILON * b.abs() + 0.5 * tolerance;
        let middle = 0.5 * (c - b);
        if middle.abs() <= least || fb == 0.0 {
            return Ok(Root { at: b, residual: fb, iterations });
        }
        (d, e) = match interpolated([a, b, c], [fa, fb, fc]) {
            Some((p, q)) if e.abs() >= least && 2.0 * p < (3.0 * middle * q - (least * q).abs()).min((e * q).abs()) => {
                (p / q, d)
            }
            _ => (middle, middle),
        };
        (a, fa) = (b, fb);
        b += if d.abs() > least { d } else { least.copysign(middle) };
        fb = f(b)?;
    }
    Err(no_root(format!("{MOST_ITERATIONS} iterations were not enough")))
}

/// The step from b to the root of the inverse quadratic through the three points, or of the secant where a and c are the same,
/// as the quotient of a number that is not negative and another. None where b is not better than a.
fn interpolated([a, b, c]: [f64; 3], [fa, fb, fc]: [f64; 3]) -> Option<(f64, f64)> {
    if fa.abs() <= fb.abs() {
        return None;
    }
    let (middle, s) = (0.5 * (c - b), fb / fa);
    let (p, q) = if a == c {
        (2.0 * middle * s, 1.0 - s)
    } else {
        let (q, r) = (fa / fc, fb / fc);
        (s * (2.0 * middle * q * (q - r) - (b - a) * (r - 1.0)), (q - 1.0) * (r - 1.0) * (s - 1.0))
    };
    Some((p.abs(), if p > 0.0 { -q } else { q }))
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

    /// The same steps as the `BrentRoot` of `argmin`, to the last bit.
    #[cfg(feature = "argmin")]
    #[test]
    fn the_iterates_are_those_of_argmin() {
        use argmin::core::{CostFunction, Error, Executor, State};
        use argmin::solver::brent::BrentRoot;
        use std::cell::RefCell;

        struct Watched<'a>(&'a dyn Fn(f64) -> f64, RefCell<Vec<f64>>);
        impl CostFunction for &Watched<'_> {
            type Param = f64;
            type Output = f64;
            fn cost(&self, x: &f64) -> Result<f64, Error> {
                self.1.borrow_mut().push(*x);
                Ok((self.0)(*x))
            }
        }

        let functions: [&dyn Fn(f64) -> f64; 6] = [
            &|x| x.cos() - 0.3 * x,
            &|x| x * x * x - 2.0,
            &|x| (x - 0.7).powi(9),
            &|x| (5.0 * (x - 0.6)).tanh(),
            &|x| if x < 0.9 { -1.0 } else { x },
            &|x| x.exp() - 1.9,
        ];
        for (f, k) in functions.iter().flat_map(|f| (0..40).map(move |k| (f, k))) {
            let tolerance = [0.0, 1e-9, 1e-3][k % 3];
            let (from, to) = (-0.5 - 0.1 * k as f64, 1.3 + 0.07 * k as f64);
            if f(from) * f(to) > 0.0 {
                continue;
            }
            let theirs = Watched(f, RefCell::default());
            let solver = BrentRoot::new(from, to, tolerance);
            let result =
                Executor::new(&theirs, solver).configure(|state| state.max_iters(200)).ctrlc(false).run().unwrap();
            let ours = RefCell::new(Vec::new());
            let watched = |x: f64| {
                ours.borrow_mut().push(x);
                Ok(f(x))
            };
            let root = find_root("f", watched, from, to, tolerance).unwrap();
            assert_eq!(*ours.borrow(), *theirs.1.borrow());
            assert_eq!((Some(&root.at), root.iterations), (result.state().get_param(), result.state().get_iter()));
        }
    }
}
