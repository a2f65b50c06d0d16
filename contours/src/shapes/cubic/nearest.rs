//! The nearest points of one cubic.

use super::Cubic;
use crate::nearest::search::zero;
use crate::point::{dot, minus};
use crate::{Point, Range};

/// Rounding of a slope, relative to the square of the largest distance it is made of.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// Times a part with several stationary points is halved: those that stay together are one to rounding.
const HALVINGS: u32 = 50;

/// Calls `look` with the fraction and the squared distance of every local minimum of the distance between `point` and
/// the cubic's part between two fractions, and of some other points of the part, its ends first.
///
/// `(r - p) . dr/ds` is a polynomial of degree 5. Its Bernstein coefficients have at least as many changes of sign as
/// it has roots: with one change, or where they only rise, the root is bracketed and found to rounding, else the part
/// is halved. No minimum is missed.
pub(crate) fn nearest(cubic: &Cubic, from: f64, to: f64, point: Point, look: &mut impl FnMut(f64, f64)) {
    let part = Cubic { control: cubic.part(from, to).map(|corner| minus(corner, point)), from, width: to - from };
    look(from, dot(part.control[0], part.control[0]));
    look(to, dot(part.control[3], part.control[3]));
    search(&part, HALVINGS, &mut |s, square| look(s.min(to), square));
}

/// Looks for the minima inside a part seen from the point; its parameter is the fraction of the whole.
fn search(part: &Cubic, halvings: u32, look: &mut impl FnMut(f64, f64)) {
    let (slopes, tiny) = slopes(part.control);
    let sure = |slope: &f64| slope.abs() > tiny;
    let mut changes = 0;
    let mut sign = 0.0;
    for slope in slopes.into_iter().filter(sure) {
        changes += u32::from(slope * sign < 0.0);
        sign = slope.signum();
    }
    let flat = sign == 0.0;
    let only = |sense: f64| slopes.windows(2).all(|pair| sense * (pair[1] - pair[0]) > tiny);
    let (rises, falls) = (only(1.0), only(-1.0));
    if flat || falls || (changes == 0 && slopes.iter().all(sure)) {
        return;
    }
    // An end that is itself a root to rounding does not bracket another, unless the slope only rises.
    if rises || (changes == 1 && sure(&slopes[0]) && sure(&slopes[5])) {
        if slopes[0] < 0.0 && slopes[5] > 0.0 {
            let along = Cubic::unit(part.control).velocity();
            let secant = slopes[0] / (slopes[0] - slopes[5]);
            let mut place = [0.0; 2];
            let s = zero(Range::UNIT, secant, f64::EPSILON, |s| {
                place = part.point(s);
                let velocity = along.at(s);
                [dot(place, velocity), dot(velocity, velocity) + dot(place, along.rate(s))]
            });
            look(part.from + s * part.width, dot(place, place));
        }
        return;
    }
    let [left, right] = part.halves();
    // The halves may both see a root here as an end.
    look(right.from, dot(right.control[0], right.control[0]));
    if halvings > 0 {
        search(&left, halvings - 1, look);
        search(&right, halvings - 1, look);
    }
}

/// A third of `r . dr/ds` in Bernstein form for a cubic with these control points, and what is rounding beside it.
fn slopes(control: [Point; 4]) -> ([f64; 6], f64) {
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
    (slopes, ROUNDING * control.iter().fold(0.0_f64, |most, &corner| most.max(dot(corner, corner))))
}

#[cfg(test)]
mod tests {
    use super::super::tests::random;
    use super::*;

    fn best(cubic: &Cubic, from: f64, to: f64, point: Point) -> (f64, f64) {
        let mut best = (f64::NAN, f64::INFINITY);
        nearest(cubic, from, to, point, &mut |s, square| {
            if square < best.1 {
                best = (s, square);
            }
        });
        (best.0, best.1.sqrt())
    }

    const WAVE: Cubic = Cubic { control: [[0.0, 0.0], [1.0, 3.0], [2.0, -3.0], [3.0, 0.0]], from: 0.0, width: 1.0 };

    #[test]
    fn all_minima_are_found() {
        // Two minima seen from within the first bend, one from elsewhere, none inside a short part aside.
        let minima = |from, to, point| {
            let slope = |s: f64| dot(minus(WAVE.blossom([s; 3]), point), WAVE.velocity().at(s));
            let mut found = Vec::new();
            nearest(&WAVE, from, to, point, &mut |s, _| {
                if from < s && s < to && slope(s).abs() < 1e-14 && slope(s + 1e-6) > 0.0 {
                    found.push(s);
                }
            });
            found.dedup();
            found
        };
        let middle = minima(0.0, 1.0, [1.5, 0.0]);
        assert!(middle.len() == 1 && (middle[0] - 0.5).abs() < 1e-15, "{middle:?}");
        assert_eq!(minima(0.0, 1.0, [0.63, 0.2]).len(), 2);
        assert_eq!(minima(0.0, 1.0, [0.8, 2.0]).len(), 1);
        assert!(minima(0.0, 0.1, [3.0, 1.0]).is_empty());
        assert_eq!(minima(0.0, 1.0, [1.3, 0.4]).len(), 2);
    }

    #[test]
    fn the_slope_of_a_part_is_the_slope_there() {
        let seen = Cubic::unit(WAVE.control.map(|corner| minus(corner, [0.3, 0.4])));
        let (slopes, _) = slopes(seen.part(0.2, 0.7));
        for (coefficient, s) in [(slopes[0], 0.2), (slopes[5], 0.7)] {
            let slope = dot(seen.point(s), seen.velocity().at(s));
            assert!((coefficient * 3.0 - slope * 0.5).abs() < 1e-14);
        }
    }

    #[test]
    fn nothing_is_nearer_on_a_fine_grid() {
        let mut random = random(7);
        for _ in 0..20_000 {
            let cubic = Cubic::unit([0; 4].map(|_| [random(), random()]));
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
        let cubic = Cubic::unit([[0.0, 0.0], [0.5, -0.2], [1.0, 0.0], [1.0, 0.3]]);
        for away in [0.3, 0.5, 0.7, 0.9] {
            let point = [1.0 - away, 0.3];
            let grid = (0..=1000).map(|k| minus(cubic.point(f64::from(k) / 1000.0), point));
            let least = grid.map(|way| dot(way, way).sqrt()).fold(f64::INFINITY, f64::min);
            let (_, distance) = best(&cubic, 0.0, 1.0, point);
            assert!(distance <= least && distance > least - 1e-5, "{away}: {distance} {least}");
        }
    }

    #[test]
    fn a_far_maximum_at_the_end_does_not_hide_the_minimum_either() {
        // Seen along the last normal from twenty times as far as the cubic is long.
        let control = [[0.45, -0.31], [-0.44, -0.18], [-0.07, 0.13], [-0.45, -0.44]];
        let [third, last] = [control[2], control[3]];
        let side = minus(last, third);
        for away in 0..1000 {
            let away = (20.0 + 0.01 * f64::from(away)) / dot(side, side).sqrt();
            let point = [last[0] + away * side[1], last[1] - away * side[0]];
            let (s, _) = best(&Cubic::unit(control), 0.5, 1.0, point);
            assert!((s - 0.76).abs() < 0.02, "{away}: {s}");
        }
    }

    #[test]
    fn the_foot_next_to_an_end_that_almost_stands_still_is_found() {
        let control = [
            [1.1254852, -0.9629395],
            [1.182276, -1.4285806],
            [0.5602904460, -0.8338374910],
            [0.56029001329, -0.83383908347],
        ];
        let cubic = Cubic::unit(control);
        for k in 1..100 {
            let s = 1.0 - 1e-7 * f64::from(k);
            assert!(best(&cubic, 0.0, 1.0, cubic.blossom([s; 3])).1 < 1e-15, "{s}");
        }
    }

    #[test]
    fn flat_distances_end_the_search() {
        // All but an arc about the point, and the point where a straight cubic turns back.
        let k = 0.552_284_749_830_793_6;
        let arc = Cubic::unit([[1.0, 0.0], [1.0, k], [k, 1.0], [0.0, 1.0]]);
        assert!((best(&arc, 0.0, 1.0, [0.0, 0.0]).1 - 1.0).abs() < 1e-15);
        let mut looks = 0;
        nearest(&arc, 0.0, 1.0, [1e-4, 1e-4], &mut |_, _| looks += 1);
        assert!(looks < 300, "{looks}");
        let back = Cubic::unit([[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [0.0, 0.0]]);
        assert!(best(&back, 0.0, 1.0, [0.75, 0.0]).1 < 1e-8);
        assert_eq!(best(&back, 0.0, 1.0, [0.0, 1.0]).1, 1.0);
        let mut looks = 0;
        nearest(&back, 0.0, 1.0, [f64::NAN, 0.0], &mut |_, _| looks += 1);
        assert_eq!(looks, 2);
    }
}
