//! The numbers the segment kernel runs on.

use num_traits::NumOps;
use std::ops::Neg;

/// A field with the few functions that the closed form needs: `f32`, `f64`, [`Dual`](crate::Dual),
/// or a type of your own (double-double, intervals).
///
/// Comparisons look at the value alone: a dual number compares by its real part.
pub trait Scalar: Copy + PartialOrd + NumOps + Neg<Output = Self> {
    /// The nearest number of this type.
    fn from_f64(value: f64) -> Self;
    /// The value as `f64`, for decisions (how often to halve a segment, how often it coils) only.
    fn to_f64(self) -> f64;
    /// Square root.
    fn sqrt(self) -> Self;
    /// Sine and cosine of an angle in radians.
    fn sin_cos(self) -> (Self, Self);
    /// Angle of the point (`x`, `self`), in (-pi, pi].
    fn atan2(self, x: Self) -> Self;
}

macro_rules! scalar_from_float {
    ($($float:ty),*) => {$(
        impl Scalar for $float {
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
                num_traits::Float::sin_cos(self)
            }
            #[inline(always)]
            fn atan2(self, x: Self) -> Self {
                num_traits::Float::atan2(self, x)
            }
        }
    )*};
}
scalar_from_float!(f32, f64);
