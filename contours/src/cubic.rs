//! The cubic polynomial curve: its derivatives, and where its distance from a point is least.

use crate::Range;
use crate::vector::{between, dot, minus, scaled};

/// Halvings after which two stationary points of the distance count as one.
const HALVINGS: u32 = 30;

/// Largest number of steps of one refinement; bisection alone reaches rounding in about 60.
const STEPS: usize = 80;

/// A cubic polynomial curve by its Bezier control points, lengths; its parameter runs from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Cubic(pub [[f64; 2]; 4]);

impl Cubic {
    /// The control points of the derivative, which is quadratic.
    pub fn hodograph(&self) -> [[f64; 2]; 3] {
        let [p, q, r, s] = self.0;
        [scaled(3.0, minus(q, p)), scaled(3.0, minus(r, q)), scaled(3.0, minus(s, r))]
    }

    /// Coefficients of t^2, t and 1 in the derivative.
    pub fn powers(&self) -> [[f64; 2]; 3] {
        let [u, v, w] = self.hodograph();
        let (uv, vw) = (minus(v, u), minus(w, v));
        [minus(vw, uv), scaled(2.0, uv), u]
    }

    /// Point, first and second derivative.
    pub fn derivatives(&self, t: f64) -> [[f64; 2]; 3] {
        let [p, q, r, s] = self.0;
        let (pq, qr, rs) = (between(p, q, t), between(q, r, t), between(r, s, t));
        let (left, right) = (between(pq, qr, t), between(qr, rs, t));
        let [u, v, w] = self.hodograph();
        let (uv, vw) = (between(u, v, t), between(v, w, t));
        [between(left, right, t), between(uv, vw, t), scaled(2.0, minus(vw, uv))]
    }

    /// The control points of the part between two parameters, less a point.
    fn part(&self, range: Range, point: [f64; 2]) -> [[f64; 2]; 4] {
        let [p, q, r, s] = self.0.map(|control| minus(control, point));
        let blossom = |[t, u, v]: [f64; 3]| {
            let (pq, qr, rs) = (between(p, q, t), between(q, r, t), between(r, s, t));
            between(between(pq, qr, u), between(qr, rs, u), v)
        };
        let Range { from, to } = range;
        [[from, from, from], [from, from, to], [from, to, to], [to, to, to]].map(blossom)
    }

    /// `(r - point) . dr/dt` and its rate.
    fn slope(&self, t: f64, point: [f64; 2]) -> [f64; 2] {
        let [place, velocity, acceleration] = self.derivatives(t);
        let way = minus(place, point);
        [dot(way, velocity), dot(velocity, velocity) + dot(way, acceleration)]
    }

    /// The minimum of the distance between two parameters, where it falls at the first and rises at the last.
    fn refine(&self, range: Range, point: [f64; 2]) -> f64 {
        let Range { from: mut low, to: mut high } = range;
        let mut t = 0.5 * (low + high);
        let mut step_before = high - low;
        for _ in 0..STEPS {
            let [slope, rate] = self.slope(t, point);
            if slope < 0.0 {
                low = t;
            } else {
                high = t;
            }
            let mut step = -slope / rate;
            // Newton only while it stays inside and converges faster than halving would.
            if !(t + step >= low && t + step <= high && step.abs() <= 0.5 * step_before.abs()) {
                step = 0.5 * (low + high) - t;
            }
            t += step;
            if step.abs() <= f64::EPSILON * t || slope == 0.0 {
                break;
            }
            step_before = step;
        }
        t
    }

    /// Calls `found` with each parameter in `range` where the distance from the point has a minimum, ends left out.
    pub fn minima(&self, range: Range, point: [f64; 2], mut found: impl FnMut(f64)) {
        let slope = slope_coefficients(self.part(range, point));
        Self::isolate(slope, range, HALVINGS, &mut |part| found(self.refine(part, point)));
    }

    /// Calls `found` for each part of `range` with one minimum of the distance in it; `slope` are the Bernstein
    /// coefficients of its derivative there.
    fn isolate(slope: [f64; 6], range: Range, halvings: u32, found: &mut impl FnMut(Range)) {
        let changes = slope.windows(2).filter(|pair| (pair[0] < 0.0) != (pair[1] < 0.0)).count();
        if changes == 0 {
            return;
        }
        if changes == 1 || halvings == 0 {
            if slope[0] < 0.0 && slope[5] >= 0.0 {
                found(range);
            }
            return;
        }
        let (mut left, mut right) = ([0.0; 6], slope);
        for (k, first) in left.iter_mut().enumerate() {
            *first = right[0];
            for j in 0..5 - k {
                right[j] = 0.5 * (right[j] + right[j + 1]);
            }
        }
        // The last of each round stayed where it was, so `right` now holds the coefficients of the right half.
        let middle = 0.5 * (range.from + range.to);
        Self::isolate(left, Range { to: middle, ..range }, halvings - 1, found);
        Self::isolate(right, Range { from: middle, ..range }, halvings - 1, found);
    }
}

/// The Bernstein coefficients of `r . dr/dt` (a third of it) of a cubic with these control points.
fn slope_coefficients(control: [[f64; 2]; 4]) -> [f64; 6] {
    let [p, q, r, s] = control;
    let (u, v, w) = (minus(q, p), minus(r, q), minus(s, r));
    [
        dot(p, u),
        0.6 * dot(q, u) + 0.4 * dot(p, v),
        0.3 * dot(r, u) + 0.6 * dot(q, v) + 0.1 * dot(p, w),
        0.1 * dot(s, u) + 0.6 * dot(r, v) + 0.3 * dot(q, w),
        0.4 * dot(s, v) + 0.6 * dot(r, w),
        dot(s, w),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    const WAVE: Cubic = Cubic([[0.0, 0.0], [1.0, 3.0], [2.0, -3.0], [3.0, 0.0]]);

    #[test]
    fn all_minima_are_found() {
        // Two minima seen from within the first bend, one from elsewhere, none inside a short part aside.
        let minima = |range, point| {
            let mut found = Vec::new();
            WAVE.minima(range, point, |t| found.push(t));
            found
        };
        let middle = minima(Range::UNIT, [1.5, 0.0]);
        assert!(middle.len() == 1 && (middle[0] - 0.5).abs() < 1e-15, "{middle:?}");
        assert_eq!(minima(Range::UNIT, [0.63, 0.2]).len(), 2);
        assert_eq!(minima(Range::UNIT, [0.8, 2.0]).len(), 1);
        assert!(minima(Range { from: 0.0, to: 0.1 }, [3.0, 1.0]).is_empty());
        for t in minima(Range::UNIT, [1.3, 0.4]) {
            assert!(WAVE.slope(t, [1.3, 0.4])[0].abs() < 1e-14);
        }
    }

    #[test]
    fn the_slope_of_a_part_is_the_slope_there() {
        let range = Range { from: 0.2, to: 0.7 };
        let coefficients = slope_coefficients(WAVE.part(range, [0.3, 0.4]));
        for (coefficient, t) in [(coefficients[0], 0.2), (coefficients[5], 0.7)] {
            let [slope, rate] = WAVE.slope(t, [0.3, 0.4]);
            assert!((coefficient * 3.0 - slope * range.length()).abs() < 1e-14);
            let near = WAVE.slope(t + 1e-6, [0.3, 0.4])[0] - WAVE.slope(t - 1e-6, [0.3, 0.4])[0];
            assert!((near - 2e-6 * rate).abs() < 1e-13);
        }
        assert_eq!(WAVE.derivatives(0.0)[0], [0.0, 0.0]);
        assert_eq!(WAVE.derivatives(1.0)[0], [3.0, 0.0]);
    }
}
