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
    let start = [start.x, start.y, start.phi, start.kappa].map(TwoFloat::from);
    advanced(start, [a, b].map(TwoFloat::from), TwoFloat::from(s))
}

/// The same from a start, (x, y, phi, kappa), under a force (A, B), and over an arc length that are in double-double.
pub fn advanced([x, y, phi, kappa]: [TwoFloat; 4], force: [TwoFloat; 2], s: TwoFloat) -> [TwoFloat; 4] {
    let [cos, sin] = cos_sin(phi);
    let end = integrate(Point { x, y, phi, kappa, cos, sin }, force, s);
    [end.x, end.y, end.phi, end.kappa]
}

/// cos phi and sin phi: a circle of radius 1, walked from phi = 0.
pub fn cos_sin(phi: TwoFloat) -> [TwoFloat; 2] {
    let [zero, one] = [0.0, 1.0].map(TwoFloat::from);
    let origin = Point { x: zero, y: zero, phi: zero, kappa: one, cos: one, sin: zero };
    let turned = integrate(origin, [zero; 2], phi);
    [turned.cos, turned.sin]
}

/// Differences of a section to the exact one.
pub fn errors(section: &Section, exact: &[TwoFloat; 4]) -> [f64; 4] {
    let ours = [section.x, section.y, section.phi, section.kappa];
    std::array::from_fn(|i| f64::from(exact[i] - ours[i]).abs())
}

fn integrate(start: Point, force: [TwoFloat; 2], s: TwoFloat) -> Point {
    let [a, b] = force.map(f64::from);
    let rate = f64::from(start.kappa).abs() + 2.0 * a.hypot(b).sqrt();
    let steps = (f64::from(s).abs() * rate / REACH).ceil().max(1.0);
    let h = s / steps;
    (0..steps as usize).fold(start, |at, _| step(at, force, h))
}

fn step(at: Point, [a, b]: [TwoFloat; 2], h: TwoFloat) -> Point {
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
