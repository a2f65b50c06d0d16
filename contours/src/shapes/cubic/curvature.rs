//! Bounds of the curvature of a cubic, proven by Bernstein coefficients.
//!
//! With the velocity v (quadratic in s), its rate a and `S = v . v`, the curvature is `k = C / S^(3/2)`, `C = v x a`
//! (quadratic, since the cubic terms cancel), and `dk/ds = N / S^(5/2)`, `N = C' S - 3 C (v . a)` (of degree 5). A polynomial
//! lies between its least and its largest Bernstein coefficient on a part (Farin, Curves and Surfaces for CAGD, 2002).

use super::{Cubic, Velocity};
use crate::Vector;
use crate::point::{cross, dot, plus, scale};
use crate::proof::limits::{ANY_CURVATURE, curvature_union};

/// Times a part is halved where the speed is not known to be positive. More would bound the curvature of sharper hairpins.
const HALVINGS: u32 = 12;

/// Of these, the ones by which a part is also halved where the curvature may have an extremum, to bound it more tightly.
const TIGHTENING: u32 = 2;

/// Rounding of a sum of products, relative to the largest value its terms can have; each sum has at most 8 terms.
const ROUNDING: f64 = 32.0 * f64::EPSILON;

/// Rounding of a control point that was itself computed, relative to its coordinates.
const COMPUTED: f64 = 8.0 * f64::EPSILON;

impl Cubic {
    /// The least and the largest curvature between two fractions, one over a length: the true values lie within. Their
    /// excess falls with the square of the part's length. Without bounds where the speed (almost) vanishes.
    pub fn curvature(&self, from: f64, to: f64) -> (f64, f64) {
        let (least, largest) = bounded(&self.velocity(), from, to, HALVINGS);
        (least / self.width, largest / self.width)
    }

    /// Whether the cubic bends only to the left (`sense` 1) or only to the right (-1), if at all, between two fractions. What
    /// rounding of the control points brings about does not count.
    pub fn bends(&self, sense: f64, from: f64, to: f64) -> bool {
        let velocity = self.velocity();
        let tolerance = self.tolerance(&velocity);
        let [first, middle, last] = velocity.bends(from, to);
        // The extremum of a quadratic polynomial, where there is one between the ends.
        let share = (first - middle) / (first - 2.0 * middle + last);
        let extremum = if share > 0.0 && share < 1.0 { first + share * (middle - first) } else { first };
        [first, extremum, last].iter().all(|bend| sense * bend >= -tolerance)
    }

    /// Error of a product of a velocity and a velocity or rate by the rounding of the control points.
    pub fn tolerance(&self, velocity: &Velocity) -> f64 {
        let scale = self.control.iter().flatten().fold(0.0_f64, |scale, side| scale.max(side.abs()));
        let size = velocity.size();
        size * (ROUNDING * size + 4.0 * COMPUTED * scale / self.width)
    }
}

impl Velocity {
    /// A bound of the velocity between 0 and 1; twice as much bounds its rate.
    fn size(&self) -> f64 {
        [self.start, self.linear, self.square].into_iter().map(|term| dot(term, term).sqrt()).sum()
    }

    /// The Bernstein coefficients of velocity x rate between two fractions.
    fn bends(&self, from: f64, to: f64) -> [f64; 3] {
        let constant = cross(self.start, self.linear);
        let linear = 2.0 * cross(self.start, self.square);
        let square = cross(self.linear, self.square);
        [(from, from), (from, to), (to, to)].map(|(a, b)| constant + 0.5 * (a + b) * linear + a * b * square)
    }
}

/// The curvature times the width of the cubic.
fn bounded(velocity: &Velocity, from: f64, to: f64, halvings: u32) -> (f64, f64) {
    let halved = || {
        let middle = 0.5 * (from + to);
        curvature_union(bounded(velocity, from, middle, halvings - 1), bounded(velocity, middle, to, halvings - 1))
    };
    let size = velocity.size();
    let [u, v, w] = [(from, from), (from, to), (to, to)].map(|(a, b)| {
        let linear = scale(0.5 * (a + b), velocity.linear);
        plus(plus(velocity.start, 1.0, linear), a * b, velocity.square)
    });
    let squares = [dot(u, u), dot(u, v), (2.0 * dot(v, v) + dot(u, w)) / 3.0, dot(v, w), dot(w, w)];
    let (least, most) = extremes(&squares, ROUNDING * size * size);
    if least.is_nan() || most.is_nan() {
        return ANY_CURVATURE;
    }
    if least <= 0.0 {
        return if halvings > 0 { halved() } else { ANY_CURVATURE };
    }
    let bends = velocity.bends(from, to);
    let bend_slack = ROUNDING * size * size;
    let slopes = slopes(velocity, [u, v, w], squares, bends, [from, to]);
    let (falls, rises) = extremes(&slopes, 8.0 * ROUNDING * size.powi(4));
    if falls < 0.0 && rises > 0.0 && halvings > HALVINGS - TIGHTENING {
        return halved();
    }
    let over = |value: f64, power: f64| value / if value < 0.0 { least } else { most }.powf(power);
    let under = |value: f64, power: f64| value / if value > 0.0 { least } else { most }.powf(power);
    // From the extremes of both factors.
    let (least_bend, most_bend) = extremes(&bends, bend_slack);
    let direct = (over(least_bend, 1.5), under(most_bend, 1.5));
    // From the values at the ends and the slope.
    let [first, last] = [(bends[0], squares[0]), (bends[2], squares[4])].map(|(bend, square)| bend / square.powf(1.5));
    let sloped = between([first, last], [over(falls, 2.5), under(rises, 2.5)], to - from);
    let largest = first.abs().max(last.abs()).max(sloped.0.abs()).max(sloped.1.abs());
    let margin = bend_slack / least.powf(1.5) + ROUNDING * (1.0 + size / least.sqrt()) * largest;
    let bounds = (direct.0.max(sloped.0 - margin), direct.1.min(sloped.1 + margin));
    let last_bits = |value: f64| ROUNDING * value.abs();
    let bounds = (bounds.0 - last_bits(bounds.0), bounds.1 + last_bits(bounds.1));
    if bounds.0.is_nan() || bounds.1.is_nan() { ANY_CURVATURE } else { bounds }
}

/// The Bernstein coefficients of `N`.
fn slopes(velocity: &Velocity, [u, v, w]: [Vector; 3], s: [f64; 5], c: [f64; 3], [from, to]: [f64; 2]) -> [f64; 6] {
    let (a, b) = (velocity.rate(from), velocity.rate(to));
    let e = [dot(u, a), (2.0 * dot(v, a) + dot(u, b)) / 3.0, (dot(w, a) + 2.0 * dot(v, b)) / 3.0, dot(w, b)];
    // d(v x a)/ds = v x (2 square), as a x a vanishes.
    let [d, f] = [u, w].map(|there| 2.0 * cross(there, velocity.square));
    let bent = [
        c[0] * e[0],
        (3.0 * c[0] * e[1] + 2.0 * c[1] * e[0]) / 5.0,
        (3.0 * c[0] * e[2] + 6.0 * c[1] * e[1] + c[2] * e[0]) / 10.0,
        (c[0] * e[3] + 6.0 * c[1] * e[2] + 3.0 * c[2] * e[1]) / 10.0,
        (2.0 * c[1] * e[3] + 3.0 * c[2] * e[2]) / 5.0,
        c[2] * e[3],
    ];
    let at = |k: usize| s.get(k).copied().unwrap_or(0.0);
    [0, 1, 2, 3, 4, 5].map(|k| {
        let before = if k > 0 { k as f64 * f * s[k - 1] } else { 0.0 };
        ((5 - k) as f64 * d * at(k) + before) / 5.0 - 3.0 * bent[k]
    })
}

/// Bounds of a function with these values at the ends of a part of this width and a slope between these two.
fn between([first, last]: [f64; 2], [falls, rises]: [f64; 2], width: f64) -> (f64, f64) {
    let (low, high) = (first.min(last), first.max(last));
    if falls >= 0.0 || rises <= 0.0 {
        return (low, high);
    }
    let change = last - first;
    // Where the steepest line from either end meets that from the other.
    let up = ((change - falls * width) / (rises - falls)).clamp(0.0, width);
    let down = ((rises * width - change) / (rises - falls)).clamp(0.0, width);
    (low.min(first + falls * down), high.max(first + rises * up))
}

fn extremes(coefficients: &[f64], slack: f64) -> (f64, f64) {
    let least = coefficients.iter().copied().fold(f64::INFINITY, f64::min);
    let most = coefficients.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    (least - slack, most + slack)
}

#[cfg(test)]
mod tests {
    use super::super::tests::{cubic, random, zoo};
    use super::*;

    fn curvature(cubic: &Cubic, s: f64) -> f64 {
        let velocity = cubic.velocity();
        let here = velocity.at(s);
        cross(here, velocity.rate(s)) / (dot(here, here).powf(1.5) * cubic.width)
    }

    #[test]
    fn no_curvature_lies_outside() {
        let mut random = random(3);
        for cubic in zoo() {
            let from = 0.5 + random();
            let to = from + (1.0 - from) * (0.5 + random()).powi(4);
            let (least, largest) = cubic.curvature(from, to);
            for step in 0..=50 {
                let here = curvature(&cubic, from + (to - from) * f64::from(step) / 50.0);
                assert!(least <= here && here <= largest, "{cubic:?} {from} {to}: {here} not in {least} {largest}");
            }
        }
    }

    #[test]
    fn the_excess_falls_with_the_square_of_the_length() {
        // Around the largest curvature of an arch, at its middle.
        let arch = cubic([[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0]]);
        let excess = |width: f64| {
            let (from, to) = (0.5 - 0.37 * width, 0.5 + 0.63 * width);
            let (least, largest) = arch.curvature(from, to);
            let values = [from, 0.5, to].map(|s| curvature(&arch, s));
            (largest - values.iter().fold(f64::NEG_INFINITY, |most, &value| most.max(value)))
                + (values.iter().fold(f64::INFINITY, |least, &value| least.min(value)) - least)
        };
        for k in 0..8 {
            let width = 0.5_f64.powi(k);
            assert!(excess(width) >= 0.0 && excess(width) < 0.5 * width * width + 1e-10, "{k}: {}", excess(width));
        }
    }

    #[test]
    fn a_part_that_stands_still_has_no_bounds() {
        let cusp = cubic([[0.0, 0.0], [1.0, 1.0], [0.0, 1.0], [1.0, 0.0]]);
        assert_eq!(cusp.curvature(0.0, 1.0), ANY_CURVATURE);
        assert!(cusp.curvature(0.6, 1.0).0.is_finite());
    }

    #[test]
    fn arcs_between_inflections_bend_one_way() {
        let s = cubic([[0.0, 0.0], [1.0, 1.0], [2.0, -1.0], [3.0, 0.0]]);
        let either = |cubic: &Cubic, from, to| [1.0, -1.0].map(|sense| cubic.bends(sense, from, to));
        assert_eq!(either(&s, 0.0, 0.5), [false, true]);
        assert_eq!(either(&s, 0.5, 1.0), [true, false]);
        assert_eq!(either(&s, 0.0, 1.0), [false, false]);
        for cubic in zoo() {
            let ends: Vec<f64> = [0.0].into_iter().chain(cubic.velocity().inflections()).chain([1.0]).collect();
            for pair in ends.windows(2) {
                assert!(either(&cubic, pair[0], pair[1]) != [false, false], "{cubic:?} {pair:?}");
            }
        }
    }
}
