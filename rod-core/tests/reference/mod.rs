//! An independent solution of one segment: Taylor series of the differential equation in double-double (32 digits). It shares
//! nothing with the library but the equation.

use rod_core::Section;
use twofloat::TwoFloat;

/// Terms of the Taylor series, and the step |h| * rate: the series of a pendulum arc converges at worst like that of
/// tanh, (2 h / pi)^n: (0.127)^24 = 3e-22.
const TERMS: usize = 24;
const REACH: f64 = 0.2;

/// A point of the exact solution with cos phi and sin phi: the equations are polynomial in these six.
#[derive(Clone, Copy)]
struct Point {
    x: TwoFloat,
    y: TwoFloat,
    phi: TwoFloat,
    kappa: TwoFloat,
    cos: TwoFloat,
    sin: TwoFloat,
}

/// The exact end of a segment, rounded to double-double: (x, y, phi, kappa).
pub fn exact(start: &Section, a: f64, b: f64, s: f64) -> [TwoFloat; 4] {
    // cos phi and sin phi at the start: a circle of radius 1, walked from phi = 0.
    let zero = TwoFloat::from(0.0);
    let one = TwoFloat::from(1.0);
    let origin = Point { x: zero, y: zero, phi: zero, kappa: one, cos: one, sin: zero };
    let turned = integrate(origin, 0.0, 0.0, start.phi);
    let [x, y, phi, kappa] = [start.x, start.y, start.phi, start.kappa].map(TwoFloat::from);
    let end = integrate(Point { x, y, phi, kappa, cos: turned.cos, sin: turned.sin }, a, b, s);
    [end.x, end.y, end.phi, end.kappa]
}

/// Differences of a section to the exact one.
pub fn errors(section: &Section, exact: &[TwoFloat; 4]) -> [f64; 4] {
    let ours = [section.x, section.y, section.phi, section.kappa];
    std::array::from_fn(|i| f64::from(exact[i] - ours[i]).abs())
}

fn integrate(start: Point, a: f64, b: f64, s: f64) -> Point {
    let rate = f64::from(start.kappa).abs() + 2.0 * a.hypot(b).sqrt();
    let steps = (s.abs() * rate / REACH).ceil().max(1.0);
    let h = TwoFloat::from(s) / steps;
    (0..steps as usize).fold(start, |at, _| step(at, a, b, h))
}

fn step(at: Point, a: f64, b: f64, h: TwoFloat) -> Point {
    let zero = TwoFloat::from(0.0);
    let [mut x, mut y, mut phi, mut kappa, mut cos, mut sin] = [[zero; TERMS]; 6];
    (x[0], y[0], phi[0], kappa[0], cos[0], sin[0]) = (at.x, at.y, at.phi, at.kappa, at.cos, at.sin);
    for n in 0..TERMS - 1 {
        let product = |u: &[TwoFloat], v: &[TwoFloat]| (0..=n).fold(zero, |sum, i| sum + u[i] * v[n - i]);
        let over = (n + 1) as f64;
        x[n + 1] = cos[n] / over;
        y[n + 1] = sin[n] / over;
        phi[n + 1] = kappa[n] / over;
        kappa[n + 1] = (cos[n] * a + sin[n] * b) / over;
        let (cos_rate, sin_rate) = (-product(&sin, &kappa), product(&cos, &kappa));
        (cos[n + 1], sin[n + 1]) = (cos_rate / over, sin_rate / over);
    }
    let sum = |c: &[TwoFloat]| c.iter().rev().fold(zero, |sum, &term| sum * h + term);
    Point { x: sum(&x), y: sum(&y), phi: sum(&phi), kappa: sum(&kappa), cos: sum(&cos), sin: sum(&sin) }
}

/// The largest of several errors; NaN comes through.
pub fn largest(errors: [f64; 4]) -> f64 {
    errors.into_iter().fold(0.0, |most, e| if e > most || e.is_nan() { e } else { most })
}

/// Numbers that are the same in every run.
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// Uniform in [-`most`, `most`).
    pub fn within(&mut self, most: f64) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        most * ((self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0)
    }
}
