//! The largest value of a function of one variable.

/// Part of the interval to which the place is found: the value is flat there, and right to the square of it.
const PLACE: f64 = 1e-8;
const MOST_STEPS: usize = 60;
/// 1 - 1 / golden ratio
const GOLDEN: f64 = 0.381_966_011_250_105_1;

/// The largest value in an interval of a function that has one maximum there, by parabolas and golden sections (Brent, Algorithms for
/// Minimization without Derivatives, 1973, chapter 5).
pub(super) fn maximum_within((from, to): (f64, f64), f: impl Fn(f64) -> f64) -> f64 {
    let (mut low, mut high) = (from.min(to), from.max(to));
    let tolerance = PLACE * (high - low);
    let best = low + GOLDEN * (high - low);
    // the best three places so far, with their values
    let mut places = [(best, f(best)); 3];
    let (mut step, mut before): (f64, f64) = (0.0, 0.0);
    for _ in 0..MOST_STEPS {
        let [(x, at_x), (w, at_w), (v, at_v)] = places;
        let middle = 0.5 * (low + high);
        if (x - middle).abs() + 0.5 * (high - low) <= 2.0 * tolerance {
            break;
        }
        // the top of the parabola through the three
        let (r, q) = ((x - w) * (at_x - at_v), (x - v) * (at_x - at_w));
        let (numerator, denominator) = ((x - v) * q - (x - w) * r, 2.0 * (q - r));
        let parabolic = -numerator / denominator;
        let inside = x + parabolic > low && x + parabolic < high;
        if inside && parabolic.abs() < 0.5 * before.abs() {
            (before, step) = (step, parabolic);
        } else {
            before = if x < middle { high - x } else { low - x };
            step = GOLDEN * before;
        }
        let next = x + if step.abs() < tolerance { tolerance.copysign(step) } else { step };
        let value = f(next);
        if value >= at_x {
            if next >= x {
                low = x
            } else {
                high = x
            }
            places = [(next, value), (x, at_x), (w, at_w)];
        } else {
            if next < x {
                low = next
            } else {
                high = next
            }
            if value >= at_w || w == x {
                places = [(x, at_x), (next, value), (w, at_w)];
            } else if value >= at_v || v == x || v == w {
                places[2] = (next, value);
            }
        }
    }
    places[0].1
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::Cell;

    #[test]
    fn finds_maxima_wherever_they_are() {
        for (from, to) in [(0.0_f64, 1.0_f64), (1.0, 0.0), (-0.3, 0.9)] {
            for top in [0.0_f64, 1e-6, 0.3, 0.5, 0.77, 0.9, 1.5] {
                let count = Cell::new(0);
                let f = |x: f64| {
                    count.set(count.get() + 1);
                    (2.0 * (x - top)).cos() + 0.1 * (x - top).powi(3)
                };
                let clamped = top.clamp(from.min(to), from.max(to));
                let exact = (2.0 * (clamped - top)).cos() + 0.1 * (clamped - top).powi(3);
                let found = maximum_within((from, to), f);
                // at an end the value is not flat
                let bound = if clamped == top { 1e-14 } else { 1e-7 };
                assert!((found - exact).abs() < bound && count.get() < 45, "{top}: {found} {exact} {}", count.get());
            }
        }
        assert!(maximum_within((0.0, 1.0), |_| f64::NAN).is_nan());
    }
}
