//! All roots of a function of one variable with a derivative, by an adaptive scan.

use crate::solve::find_root;

/// Intervals of the scan before refinement.
const SCAN: usize = 128;
/// Most halvings of an interval of the scan.
const MOST_HALVINGS: u32 = 16;
/// Intervals of a coarse scan, and most halvings of one of them.
const COARSE: (usize, u32) = (48, 5);
/// Most evaluations of the scan.
const MOST_EVALUATIONS: usize = 40_000;
/// Deviation of the middle of an interval from the cubic through its ends, relative to the values there, at which the interval is resolved.
const RESOLVED: f64 = 0.02;
/// Size of an extremum (rad, E I / L) that counts as a double root.
const DOUBLE: f64 = 1e-12;

/// The scan of a function of one variable, which gives its value and derivative.
pub(super) struct Scan<F> {
    f: F,
    intervals: usize,
    most_halvings: u32,
    roots: Vec<f64>,
    evaluations: usize,
}

#[derive(Clone, Copy)]
struct At {
    x: f64,
    value: f64,
    slope: f64,
}

impl<F: Fn(f64) -> (f64, f64)> Scan<F> {
    pub fn new(f: F) -> Self {
        Self { f, intervals: SCAN, most_halvings: MOST_HALVINGS, roots: Vec::new(), evaluations: 0 }
    }

    /// One that may miss roots next to each other, but takes some hundred evaluations only.
    pub fn coarse(f: F) -> Self {
        Self { intervals: COARSE.0, most_halvings: COARSE.1, ..Self::new(f) }
    }

    /// All roots between two places, in order.
    pub fn all(mut self, from: f64, to: f64) -> Vec<f64> {
        let mut before = self.at(from);
        for k in 1..=self.intervals {
            let next = self.at(from + (to - from) * k as f64 / self.intervals as f64);
            self.refine(before, next, 0);
            before = next;
        }
        self.roots.sort_by(f64::total_cmp);
        self.roots.dedup();
        self.roots
    }

    fn at(&mut self, x: f64) -> At {
        self.evaluations += 1;
        let (value, slope) = (self.f)(x);
        At { x, value, slope }
    }

    fn refine(&mut self, a: At, b: At, halvings: u32) {
        let (middle, h) = (self.at(0.5 * (a.x + b.x)), b.x - a.x);
        let value = 0.5 * (a.value + b.value) + 0.125 * h * (a.slope - b.slope);
        let slope = 1.5 * (b.value - a.value) / h - 0.25 * (a.slope + b.slope);
        let steepest = a.slope.abs().max(b.slope.abs()).max(middle.slope.abs());
        let is_resolved = (middle.value - value).abs() <= RESOLVED * h * steepest
            && (middle.slope - slope).abs() <= 5.0 * RESOLVED * steepest;
        if is_resolved || halvings >= self.most_halvings || self.evaluations > MOST_EVALUATIONS {
            self.take(a, middle);
            self.take(middle, b);
        } else {
            self.refine(a, middle, halvings + 1);
            self.refine(middle, b, halvings + 1);
        }
    }

    /// The roots in an interval in which the function has at most one extremum.
    fn take(&mut self, a: At, b: At) {
        if a.value == 0.0 {
            self.roots.push(a.x);
        }
        // just behind a root the sign is that of the slope, just before it the opposite one
        let sign_a = if a.value == 0.0 { a.slope } else { a.value };
        let sign_b = if b.value == 0.0 { -b.slope } else { b.value };
        let from = if a.value == 0.0 { a.x + 1e-6 * (b.x - a.x) } else { a.x };
        let to = if b.value == 0.0 { b.x - 1e-6 * (b.x - a.x) } else { b.x };
        if sign_a * sign_b < 0.0 {
            self.between(from, to);
        } else if sign_a * a.slope < 0.0 && sign_b * b.slope > 0.0 {
            let slope = |x| Ok((self.f)(x).1);
            let Ok(extremum) = find_root("the slope", slope, a.x, b.x, 0.0) else { return };
            let (value, _) = (self.f)(extremum.at);
            if value * sign_a < 0.0 {
                self.between(from, extremum.at);
                self.between(extremum.at, to);
            } else if value.abs() <= DOUBLE {
                self.roots.push(extremum.at);
            }
        }
    }

    /// The root between two places, if the signs there differ.
    fn between(&mut self, from: f64, to: f64) {
        let root = find_root("the prescribed quantity at the tip", |x| Ok((self.f)(x).0), from, to, 0.0);
        self.roots.extend(root.ok().map(|root| root.at));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_scan_finds_close_double_and_exact_roots() {
        let roots = |f: &dyn Fn(f64) -> (f64, f64)| Scan::new(f).all(-1.0, 1.0);
        // a pitchfork just beyond its critical point: 0 and +-1e-4
        let found = roots(&|x| (x * (x * x - 1e-8), 3.0 * x * x - 1e-8));
        assert!(found.len() == 3 && (found[2] - 1e-4).abs() < 1e-12 && found[1] == 0.0, "{found:?}");
        let found = roots(&|x| ((x - 0.3).powi(2), 2.0 * (x - 0.3)));
        assert!(found.len() == 1 && (found[0] - 0.3).abs() < 1e-6, "{found:?}");
        let found = roots(&|x| ((40.0 * x).sin(), 40.0 * (40.0 * x).cos()));
        assert_eq!(found.len(), 25, "{found:?}");
        // two roots 2e-7 apart, far below the first intervals
        let found = roots(&|x| ((x - 0.123).powi(2) - 1e-14, 2.0 * (x - 0.123)));
        assert!(found.len() == 2 && (found[1] - found[0] - 2e-7).abs() < 1e-12, "{found:?}");
        assert!(roots(&|x| (x * x + 1e-3, 2.0 * x)).is_empty());
    }
}
