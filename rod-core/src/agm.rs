//! The arithmetic-geometric mean, which gives the period of a pendulum.

use crate::scalar::Scalar;

/// Arithmetic-geometric mean of two positive numbers: half the period of the pendulum is pi / agm(sqrt P, sqrt (P - M)).
#[inline]
pub(crate) fn agm<T: Scalar>(mut a: T, mut g: T) -> T {
    let half = T::from_f64(0.5);
    // converges quadratically: from any ratio above 1e-8 this many steps exhaust the digits
    for _ in 0..8 {
        (a, g) = (half * (a + g), (a * g).sqrt());
    }
    a
}
