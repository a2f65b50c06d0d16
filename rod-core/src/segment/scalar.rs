//! The numbers the segment kernel runs on.

use super::circular;
use core::ops::Neg;
use num_traits::NumOps;

/// A field with the few functions that the closed form needs: `f32`, `f64`, [`Dual`](crate::Dual),
/// or a type of your own (double-double, intervals).
///
/// Comparisons look at the value alone: a dual number compares by its real part.
pub trait Scalar: Copy + PartialOrd + NumOps + Neg<Output = Self> {
    /// Distance from 1 to the next larger number: it decides how far series reach and when iterations end. Constants are
    /// `f64`, so that a type more exact than that gains nothing from a smaller one.
    const EPSILON: f64 = f64::EPSILON;
    /// The nearest number of this type.
    fn from_f64(value: f64) -> Self;
    /// The value as `f64`, for decisions (how often a segment coils) only.
    fn to_f64(self) -> f64;
    /// Square root.
    fn sqrt(self) -> Self;
    /// Sine and cosine of an angle in radians.
    fn sin_cos(self) -> (Self, Self);
    /// Angle of the point (`x`, `self`), in (-pi, pi].
    fn atan2(self, x: Self) -> Self;
}

macro_rules! scalar_from_float {
    ($($float:ty, $sin_cos:path);*) => {$(
        impl Scalar for $float {
            const EPSILON: f64 = <$float>::EPSILON as f64;
            #[inline(always)]
            fn from_f64(value: f64) -> Self {
                value as $float
            }
            #[inline(always)]
            fn to_f64(self) -> f64 {
                self as f64
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                num_traits::Float::sqrt(self)
            }
            #[inline(always)]
            fn sin_cos(self) -> (Self, Self) {
                $sin_cos(self)
            }
            #[inline(always)]
            fn atan2(self, x: Self) -> Self {
                num_traits::Float::atan2(self, x)
            }
        }
    )*};
}
scalar_from_float!(f32, circular::sin_cos; f64, num_traits::Float::sin_cos);

/// What the tolerance `at_f64` of a method of this order is for numbers of this type: errors of order n allow the n-th root
/// of the ratio of the roundings.
pub(crate) const fn tolerance<T: Scalar>(at_f64: f64, order: u32) -> f64 {
    at_f64 * root(T::EPSILON / f64::EPSILON, order)
}

/// Whether it is neither infinite nor no number.
#[inline(always)]
pub(crate) fn is_finite<T: Scalar>(value: T) -> bool {
    let zero = T::from_f64(0.0);
    value * zero == zero
}

/// The n-th root of a number >= 1 by Newton's method, from above, exactly 1 for 1.
const fn root(value: f64, n: u32) -> f64 {
    let (mut root, mut left) = (value, 1000);
    while left > 0 {
        let (mut power, mut k) = (1.0, 1);
        while k < n {
            power *= root;
            k += 1;
        }
        root -= (root * power - value) / (n as f64 * power);
        left -= 1;
    }
    root
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tolerances_follow_the_rounding() {
        assert_eq!(tolerance::<f64>(3.2e-3, 6), 3.2e-3);
        assert!((tolerance::<f32>(1.0, 8) - 2_f64.powf(29.0 / 8.0)).abs() < 1e-13);
        assert!((tolerance::<f32>(1.0, 1) - 2_f64.powi(29)).abs() < 1e-6);
    }
}
