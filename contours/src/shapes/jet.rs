//! Numbers that carry their first two derivatives, for contours given as functions.

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
