//! Dual numbers: a value with its exact first derivatives by `N` variables.

use super::scalar::Scalar;
use core::cmp::Ordering;
use core::ops::{Add, Div, Mul, Neg, Rem, Sub};

/// A number that carries its derivatives by `N` variables through every operation.
///
/// ```
/// use rod_core::{Dual, Scalar};
/// let x = Dual::variable(2.0_f64, 0);
/// let y = Dual::variable(3.0, 1);
/// let z = x * y + x.sqrt();
/// assert_eq!(z.derivatives, [3.0 + 0.5 / 2.0_f64.sqrt(), 2.0]);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Dual<T, const N: usize> {
    /// The number itself.
    pub value: T,
    /// Its derivatives, one by each variable.
    pub derivatives: [T; N],
}

impl<T: Scalar, const N: usize> Dual<T, N> {
    /// A number that depends on nothing.
    #[inline(always)]
    pub fn constant(value: T) -> Self {
        Self { value, derivatives: [T::from_f64(0.0); N] }
    }

    /// The variable number `index` (< `N`) itself.
    #[inline(always)]
    pub fn variable(value: T, index: usize) -> Self {
        Self { value, derivatives: core::array::from_fn(|i| T::from_f64(f64::from(u8::from(i == index)))) }
    }

    /// The value `value` of a function whose derivative by this number is `slope`.
    #[inline(always)]
    fn chain(self, value: T, slope: T) -> Self {
        Self { value, derivatives: self.derivatives.map(|d| slope * d) }
    }
}

impl<T: Scalar, const N: usize> Add for Dual<T, N> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self {
            value: self.value + other.value,
            derivatives: core::array::from_fn(|i| self.derivatives[i] + other.derivatives[i]),
        }
    }
}

impl<T: Scalar, const N: usize> Sub for Dual<T, N> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self {
            value: self.value - other.value,
            derivatives: core::array::from_fn(|i| self.derivatives[i] - other.derivatives[i]),
        }
    }
}

#[expect(clippy::suspicious_arithmetic_impl, reason = "the product rule adds")]
impl<T: Scalar, const N: usize> Mul for Dual<T, N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self {
            value: self.value * other.value,
            derivatives: core::array::from_fn(|i| {
                self.derivatives[i] * other.value + self.value * other.derivatives[i]
            }),
        }
    }
}

impl<T: Scalar, const N: usize> Div for Dual<T, N> {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        let inverse = T::from_f64(1.0) / other.value;
        let value = self.value * inverse;
        Self {
            value,
            derivatives: core::array::from_fn(|i| (self.derivatives[i] - value * other.derivatives[i]) * inverse),
        }
    }
}

impl<T: Scalar, const N: usize> Rem for Dual<T, N> {
    type Output = Self;
    #[inline(always)]
    fn rem(self, other: Self) -> Self {
        // self - trunc(self / other) other, the quotient being locally constant
        let value = self.value % other.value;
        let quotient = (self.value - value) / other.value;
        Self { value, derivatives: core::array::from_fn(|i| self.derivatives[i] - quotient * other.derivatives[i]) }
    }
}

impl<T: Scalar, const N: usize> Neg for Dual<T, N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { value: -self.value, derivatives: self.derivatives.map(|d| -d) }
    }
}

impl<T: Scalar, const N: usize> PartialEq for Dual<T, N> {
    #[inline(always)]
    fn eq(&self, other: &Self) -> bool {
        self.value == other.value
    }
}

impl<T: Scalar, const N: usize> PartialOrd for Dual<T, N> {
    #[inline(always)]
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        self.value.partial_cmp(&other.value)
    }
}

impl<T: Scalar, const N: usize> Scalar for Dual<T, N> {
    const EPSILON: f64 = T::EPSILON;
    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        Self::constant(T::from_f64(value))
    }
    #[inline(always)]
    fn to_f64(self) -> f64 {
        self.value.to_f64()
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.chain(root, T::from_f64(0.5) / root)
    }
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = self.value.sin_cos();
        (self.chain(sin, cos), self.chain(cos, -sin))
    }
    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        let scale = T::from_f64(1.0) / (self.value * self.value + x.value * x.value);
        Self {
            value: self.value.atan2(x.value),
            derivatives: core::array::from_fn(|i| {
                (x.value * self.derivatives[i] - self.value * x.derivatives[i]) * scale
            }),
        }
    }
}
