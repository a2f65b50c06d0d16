//! Numbers of about 31 digits as sums of two doubles (Dekker 1971), and what a rod needs beyond their sums and products.

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// The sum of two doubles, the second at most half a unit in the last place of the first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Double {
    high: f64,
    low: f64,
}

pub fn double(value: f64) -> Double {
    Double { high: value, low: 0.0 }
}

/// A sum and its rounding error (Knuth).
fn two_sum(a: f64, b: f64) -> Double {
    let high = a + b;
    let b_part = high - a;
    Double { high, low: (a - (high - b_part)) + (b - b_part) }
}

/// The halves of a double, by which products are exact (Veltkamp).
fn split(a: f64) -> (f64, f64) {
    let c = 134_217_729.0 * a;
    let high = c - (c - a);
    (high, a - high)
}

/// A product and its rounding error (Dekker).
fn two_product(a: f64, b: f64) -> Double {
    let high = a * b;
    let ((ah, al), (bh, bl)) = (split(a), split(b));
    Double { high, low: ((ah * bh - high) + ah * bl + al * bh) + al * bl }
}

impl From<Double> for f64 {
    fn from(value: Double) -> Self {
        value.high
    }
}

impl Add for Double {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let (high, low) = (two_sum(self.high, other.high), two_sum(self.low, other.low));
        let first = two_sum(high.high, high.low + low.high);
        two_sum(first.high, first.low + low.low)
    }
}

impl Neg for Double {
    type Output = Self;
    fn neg(self) -> Self {
        Self { high: -self.high, low: -self.low }
    }
}

impl Mul for Double {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let product = two_product(self.high, other.high);
        two_sum(product.high, product.low + (self.high * other.low + self.low * other.high))
    }
}

impl Div for Double {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let first = double(self.high / other.high);
        let rest = self - other * first;
        let second = double(rest.high / other.high);
        let rest = rest - other * second;
        first + second + double(rest.high / other.high)
    }
}

impl Sub for Double {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

macro_rules! with_f64 {
    ($($name:ident $call:ident $operator:tt);*) => {$(
        impl $name<f64> for Double {
            type Output = Self;
            fn $call(self, other: f64) -> Self {
                self $operator double(other)
            }
        }
    )*};
}
with_f64!(Add add +; Sub sub -; Mul mul *; Div div /);

impl AddAssign for Double {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl AddAssign<f64> for Double {
    fn add_assign(&mut self, other: f64) {
        *self = *self + other;
    }
}

impl SubAssign<f64> for Double {
    fn sub_assign(&mut self, other: f64) {
        *self = *self - other;
    }
}

/// A square root by two steps of Newton's method from that in f64.
pub fn root(value: Double) -> Double {
    let mut root = double(value.high.sqrt());
    for _ in 0..2 {
        root = (root + value / root) * 0.5;
    }
    root
}

/// Sine and cosine: a series of the angle halved ten times, and doubled again.
pub fn sin_cos(angle: Double) -> (Double, Double) {
    let small = angle / 1024.0;
    let square = small * small;
    let (mut term, mut sin, mut versine) = (small, double(0.0), double(0.0));
    for k in 1..12 {
        let k = f64::from(k);
        sin += term;
        // 1 - cos, which keeps its digits
        versine += term * small / (2.0 * k);
        term = -(term * square / ((2.0 * k) * (2.0 * k + 1.0)));
    }
    for _ in 0..10 {
        let cos = double(1.0) - versine;
        (sin, versine) = (sin * cos * 2.0, sin * sin * 2.0);
    }
    (sin, double(1.0) - versine)
}

#[test]
fn functions_have_thirty_digits() {
    let off = |value: Double| value.high.abs();
    assert!(off(root(double(2.0)) * root(double(2.0)) - 2.0) < 1e-30);
    assert!(off(double(1.0) / 3.0 * 3.0 - 1.0) < 1e-31);
    let (sin, cos) = sin_cos(double(1.0));
    assert!(off(sin * sin + cos * cos - 1.0) < 1e-29);
    // sin pi = 0 for pi as the sum of two doubles
    let pi = double(std::f64::consts::PI) + 1.224_646_799_147_353_2e-16;
    assert!(off(sin_cos(pi).0) < 1e-28 && off(sin_cos(pi).1 + 1.0) < 1e-29);
    assert!((sin.high - 1_f64.sin()).abs() < 1e-16 && (cos.high - 1_f64.cos()).abs() < 1e-16);
}
