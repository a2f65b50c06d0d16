//! An independent solution for any rod: Taylor series in double-double (32 digits) of
//! x' = cos phi, y' = sin phi, phi' = g(s) m + k(s), m' = A cos phi + B sin phi, with g = 1 / E I. It shares nothing with the library
//! but the equations.

use crate::reference::cos_sin;
use rod_core::Cut;
use twofloat::TwoFloat;

/// Terms of the series, and the step times the rate of the fastest thing in it: (0.1)^24 = 1e-24.
const TERMS: usize = 24;
const REACH: f64 = 0.1;

/// A rod as this judge knows it: E I = (1 - taper s)^4, kappa0 = bend[0] + bend[1] s.
#[derive(Clone, Copy)]
pub struct Tapered {
    pub taper: f64,
    pub bend: [f64; 2],
}

impl Tapered {
    pub fn stiffness(&self, s: f64) -> f64 {
        (1.0 - self.taper * s).powi(4)
    }

    pub fn natural_curvature(&self, s: f64) -> f64 {
        self.bend[0] + self.bend[1] * s
    }
}

/// A cut in double-double: x, y, phi, moment.
pub type Exact = [TwoFloat; 4];

pub fn exact_cut(&Cut { x, y, phi, moment }: &Cut) -> Exact {
    [x, y, phi, moment].map(TwoFloat::from)
}

/// The exact cut at arc length `to` from the one at `from`.
pub fn carried(rod: &Tapered, from: TwoFloat, start: Exact, force: [TwoFloat; 2], to: TwoFloat) -> Exact {
    let [cos, sin] = cos_sin(start[2]);
    let (mut at, mut state) = (from, [start[0], start[1], start[2], start[3], cos, sin]);
    let direction = if f64::from(to - from) < 0.0 { -1.0 } else { 1.0 };
    loop {
        let left = f64::from(to - at).abs();
        let [a, b] = force.map(f64::from);
        let width = 1.0 - rod.taper * f64::from(at);
        let compliance = width.powi(-4);
        let kappa = f64::from(state[3]) * compliance + rod.natural_curvature(f64::from(at));
        let rate = kappa.abs() + 2.0 * (a.hypot(b) * compliance).sqrt() + 8.0 * rod.taper.abs() / width;
        let h = (REACH / rate.max(1e-3)).min(left);
        let h = if h == left { to - at } else { TwoFloat::from(direction * h) };
        state = step(rod, at, state, force, h);
        at += h;
        if f64::from(to - at).abs() < 1e-30 {
            return [state[0], state[1], state[2], state[3]];
        }
    }
}

/// The quotient of two double-doubles to all their digits: that of the crate has 17 of them.
fn quotient(u: TwoFloat, v: TwoFloat) -> TwoFloat {
    let by = f64::from(v);
    (0..3).fold(u / by, |q, _| q + (u - q * v) / by)
}

fn step(rod: &Tapered, at: TwoFloat, state: [TwoFloat; 6], [a, b]: [TwoFloat; 2], h: TwoFloat) -> [TwoFloat; 6] {
    let zero = TwoFloat::from(0.0);
    let mut series = [[zero; TERMS]; 6];
    (0..6).for_each(|i| series[i][0] = state[i]);
    // (1 - taper (at + h))^-4 = width^-4 sum C(n + 3, 3) (taper / width)^n h^n
    let width = TwoFloat::from(1.0) - at * rod.taper;
    let ratio = quotient(TwoFloat::from(rod.taper), width);
    let mut compliance = [zero; TERMS];
    let square = width * width;
    compliance[0] = quotient(TwoFloat::from(1.0), square * square);
    for n in 1..TERMS {
        compliance[n] = compliance[n - 1] * ratio * ((n + 3) as f64) / (n as f64);
    }
    let mut natural = [zero; TERMS];
    natural[0] = at * rod.bend[1] + rod.bend[0];
    natural[1] = TwoFloat::from(rod.bend[1]);
    let mut kappa = [zero; TERMS];
    for n in 0..TERMS - 1 {
        let product = |u: &[TwoFloat], v: &[TwoFloat]| (0..=n).fold(zero, |sum, i| sum + u[i] * v[n - i]);
        kappa[n] = product(&compliance, &series[3]) + natural[n];
        let over = (n + 1) as f64;
        let [_, _, _, _, cos, sin] = &series;
        let next = [cos[n], sin[n], kappa[n], cos[n] * a + sin[n] * b, -product(sin, &kappa), product(cos, &kappa)];
        (0..6).for_each(|i| series[i][n + 1] = next[i] / over);
    }
    series.map(|c| c.iter().rev().fold(zero, |sum, &term| sum * h + term))
}

/// Differences of a cut to the exact one.
pub fn errors(&Cut { x, y, phi, moment }: &Cut, exact: &Exact) -> [f64; 4] {
    let ours = [x, y, phi, moment];
    std::array::from_fn(|i| f64::from(exact[i] - ours[i]).abs())
}
