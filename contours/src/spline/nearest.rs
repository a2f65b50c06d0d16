//! The nearest points of one cubic.

use super::cubic::{Cubic, dot, minus, plus};

/// Rounding of a slope, relative to the largest product it is made of.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// Times a part with several stationary points is halved: those that stay together are one to rounding.
const HALVINGS: u32 = 50;

/// Largest number of steps of one refinement; bisection alone reaches rounding in about 60.
const STEPS: usize = 80;

/// Calls `look` with the fraction and the squared distance of every local minimum of the distance between `point` and the
/// cubic's part between two fractions, and of some other points of the part, its ends among them.
///
/// `(r - p) . dr/ds` is a polynomial of degree 5. Its Bernstein coefficients have at least as many changes of sign as it
/// has roots: with one change the root is bracketed and found to rounding, with more the part is halved. No minimum is
/// missed.
pub(super) fn nearest(cubic: &Cubic, from: f64, to: f64, point: [f64; 2], look: &mut impl FnMut(f64, f64)) {
    let seen = Cubic { control: cubic.control.map(|corner| minus(corner, point)), ..*cubic };
    let part = seen.part(from, to);
    look(from, dot(part[0], part[0]));
    look(to, dot(part[3], part[3]));
    let (slopes, tiny) = slopes(part);
    Search { seen, tiny, look }.halve(slopes, from, to, HALVINGS);
}

struct Search<'a, F> {
    /// The cubic seen from the point.
    seen: Cubic,
    /// Slopes below are 0 to rounding.
    tiny: f64,
    look: &'a mut F,
}

impl<F: FnMut(f64, f64)> Search<'_, F> {
    fn halve(&mut self, slopes: [f64; 6], from: f64, to: f64, halvings: u32) {
        let mut changes = 0;
        let mut sign = 0.0;
        for slope in slopes.into_iter().filter(|slope| slope.abs() > self.tiny) {
            changes += u32::from(slope * sign < 0.0);
            sign = slope.signum();
        }
        if changes == 0 {
            return;
        }
        // An end that is itself a root to rounding does not bracket another: that needs a closer look.
        let bracketed = slopes[0].abs() > self.tiny && slopes[5].abs() > self.tiny;
        if changes == 1 && bracketed {
            // One root: a minimum if the slope rises through it.
            if sign > 0.0 {
                let secant = slopes[0] / (slopes[0] - slopes[5]);
                let s = refine(&self.seen, from, to, from + secant * (to - from));
                self.look_at(s);
            }
            return;
        }
        let middle = 0.5 * (from + to);
        // The halves may both see a root here as an end.
        self.look_at(middle);
        if halvings > 0 {
            let (left, right) = halved(slopes);
            self.halve(left, from, middle, halvings - 1);
            self.halve(right, middle, to, halvings - 1);
        }
    }

    fn look_at(&mut self, s: f64) {
        let place = self.seen.point(s);
        (self.look)(s, dot(place, place));
    }
}

/// A third of `r . dr/ds` in Bernstein form for a cubic with these control points, and what is rounding beside it.
fn slopes(control: [[f64; 2]; 4]) -> ([f64; 6], f64) {
    let [a, b, c, d] = control;
    let [u, v, w] = [minus(b, a), minus(c, b), minus(d, c)];
    let slopes = [
        dot(a, u),
        (2.0 * dot(a, v) + 3.0 * dot(b, u)) / 5.0,
        (dot(a, w) + 6.0 * dot(b, v) + 3.0 * dot(c, u)) / 10.0,
        (3.0 * dot(b, w) + 6.0 * dot(c, v) + dot(d, u)) / 10.0,
        (3.0 * dot(c, w) + 2.0 * dot(d, v)) / 5.0,
        dot(d, w),
    ];
    let longest = |sides: &[[f64; 2]]| sides.iter().fold(0.0_f64, |most, &side| most.max(dot(side, side)));
    (slopes, ROUNDING * (longest(&control) * longest(&[u, v, w])).sqrt())
}

/// The Bernstein coefficients of both halves, by de Casteljau's scheme.
fn halved(coefficients: [f64; 6]) -> ([f64; 6], [f64; 6]) {
    let (mut left, mut right) = (coefficients, coefficients);
    for (round, first) in left.iter_mut().enumerate() {
        *first = right[0];
        for k in 0..5 - round {
            right[k] = 0.5 * (right[k] + right[k + 1]);
        }
    }
    (left, right)
}

/// The zero of the slope between two fractions, from which on it is positive, to rounding.
fn refine(seen: &Cubic, from: f64, to: f64, start: f64) -> f64 {
    let [first, second, third] = seen.sides();
    let bend = minus(second, first);
    let twist = minus(minus(third, second), bend);
    let (mut low, mut high, mut s) = (from, to, start);
    let mut step_before = to - from;
    for _ in 0..STEPS {
        let place = seen.point(s);
        // Thirds of the first two derivatives.
        let velocity = plus(first, s, plus([2.0 * bend[0], 2.0 * bend[1]], s, twist));
        let change = plus([2.0 * bend[0], 2.0 * bend[1]], 2.0 * s, twist);
        let slope = dot(place, velocity);
        if slope < 0.0 {
            low = s;
        } else {
            high = s;
        }
        let mut step = -slope / (3.0 * dot(velocity, velocity) + dot(place, change));
        let mut next = s + step;
        // Newton only while it stays inside and converges faster than halving would.
        if !(next > low && next < high && step.abs() <= 0.5 * step_before.abs()) {
            if slope == 0.0 {
                break;
            }
            next = 0.5 * (low + high);
            step = next - s;
        }
        s = next;
        if step.abs() <= f64::EPSILON || high - low <= f64::EPSILON {
            break;
        }
        step_before = step;
    }
    s
}

#[cfg(test)]
mod tests {
    use super::*;

    fn best(cubic: &Cubic, from: f64, to: f64, point: [f64; 2]) -> (f64, f64) {
        let mut best = (f64::NAN, f64::INFINITY);
        nearest(cubic, from, to, point, &mut |s, square| {
            if square < best.1 {
                best = (s, square);
            }
        });
        (best.0, best.1.sqrt())
    }

    #[test]
    fn nothing_is_nearer_on_a_fine_grid() {
        let mut seed = 7_u32;
        let mut random = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(seed >> 8) / f64::from(1 << 24) - 0.5
        };
        for _ in 0..20_000 {
            let cubic = Cubic { control: [0; 4].map(|_| [random(), random()]), from: 0.0, width: 1.0 };
            let point = [2.0 * random(), 2.0 * random()];
            let (from, to) = (0.25 + 0.5 * random(), 0.75 + 0.5 * random());
            for (from, to) in [(0.0, 1.0), (from, to.max(from))] {
                let (s, distance) = best(&cubic, from, to, point);
                assert!(from <= s && s <= to);
                for step in 0..=400 {
                    let [dx, dy] = minus(cubic.point(from + (to - from) * f64::from(step) / 400.0), point);
                    assert!(dx.hypot(dy) >= distance - 1e-15, "{cubic:?} {from} {to} {point:?}: {s} {step}");
                }
            }
        }
    }

    #[test]
    fn a_maximum_at_the_end_does_not_hide_the_minimum() {
        // Seen along its last normal from beyond the centre of curvature.
        let cubic = Cubic { control: [[0.0, 0.0], [0.5, -0.2], [1.0, 0.0], [1.0, 0.3]], from: 0.0, width: 1.0 };
        for away in [0.3, 0.5, 0.7, 0.9] {
            let point = [1.0 - away, 0.3];
            let grid = (0..=1000).map(|k| minus(cubic.point(f64::from(k) / 1000.0), point));
            let least = grid.map(|way| dot(way, way).sqrt()).fold(f64::INFINITY, f64::min);
            let (_, distance) = best(&cubic, 0.0, 1.0, point);
            assert!(distance <= least && distance > least - 1e-5, "{away}: {distance} {least}");
        }
    }

    #[test]
    fn flat_distances_end_the_search() {
        // All but an arc about the point, and the point where a straight cubic turns back.
        let k = 0.552_284_749_830_793_6;
        let arc = Cubic { control: [[1.0, 0.0], [1.0, k], [k, 1.0], [0.0, 1.0]], from: 0.0, width: 1.0 };
        assert!((best(&arc, 0.0, 1.0, [0.0, 0.0]).1 - 1.0).abs() < 1e-15);
        let mut looks = 0;
        nearest(&arc, 0.0, 1.0, [1e-4, 1e-4], &mut |_, _| looks += 1);
        assert!(looks < 300, "{looks}");
        let back = Cubic { control: [[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [0.0, 0.0]], from: 0.0, width: 1.0 };
        assert!(best(&back, 0.0, 1.0, [0.75, 0.0]).1 < 1e-8);
        assert_eq!(best(&back, 0.0, 1.0, [0.0, 1.0]).1, 1.0);
        let mut looks = 0;
        nearest(&back, 0.0, 1.0, [f64::NAN, 0.0], &mut |_, _| looks += 1);
        assert_eq!(looks, 2);
    }
}
