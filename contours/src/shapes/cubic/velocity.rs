//! The velocity of a cubic: how its direction turns, and where it bends the other way.

use std::f64::consts::TAU;

use crate::Vector;
use crate::point::{cross, dot, plus};

/// The velocity `start + linear s + square s^2` of a cubic.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Velocity {
    pub start: Vector,
    pub linear: Vector,
    pub square: Vector,
}

impl Velocity {
    pub fn at(&self, s: f64) -> Vector {
        plus(self.start, s, plus(self.linear, s, self.square))
    }

    /// Derivative by `s`.
    pub fn rate(&self, s: f64) -> Vector {
        plus(self.linear, 2.0 * s, self.square)
    }

    /// The angle by which the velocity has turned from 0 to `s`, rad; between -2 pi and 2 pi.
    ///
    /// The velocity runs along a parabola, which a line through its start meets once more at most. Beyond that point,
    /// if it lies on the far side of the origin, more than half a turn has been made, and the angle between the two
    /// directions, which is at most half a turn, must be completed by a whole one.
    pub fn turned(&self, s: f64) -> f64 {
        let here = self.at(s);
        let (first, second) = (cross(self.start, self.linear), cross(self.start, self.square));
        // start x here = s (first + s second), which changes its sign where the line is met.
        let sine = s * (first + s * second);
        let cosine = dot(self.start, here);
        let sense = first * s;
        if sine * sense <= 0.0 && first != 0.0 && self.passes_behind(first, second) && s != 0.0 {
            return TAU.copysign(sense) - sine.abs().copysign(sense).atan2(cosine);
        }
        sine.atan2(cosine)
    }

    /// Whether the velocity at `s = -first / second` points against the start: that product, times `second^2`.
    fn passes_behind(&self, first: f64, second: f64) -> bool {
        let start = self.start;
        let square = dot(start, start) * second - dot(start, self.linear) * first;
        square * second + dot(start, self.square) * first * first < 0.0
    }

    /// Where between 0 and 1 the curvature changes its sign, in order; not where it only touches zero.
    pub fn inflections(&self) -> impl Iterator<Item = f64> {
        // velocity x rate, of which the terms in s^3 cancel.
        let constant = cross(self.start, self.linear);
        let linear = 2.0 * cross(self.start, self.square);
        let square = cross(self.linear, self.square);
        roots(square, linear, constant).into_iter().filter(|&s| s > 0.0 && s < 1.0)
    }
}

/// The simple real roots of `a s^2 + b s + c` in order, NaN for those there are not.
pub(crate) fn roots(a: f64, b: f64, c: f64) -> [f64; 2] {
    let discriminant = b * b - 4.0 * a * c;
    if discriminant <= 0.0 {
        return [f64::NAN; 2];
    }
    // The sum of two numbers of one sign does not cancel; the other root follows from the product.
    let sum = -0.5 * (b + discriminant.sqrt().copysign(b));
    let (one, other) = (c / sum, sum / a);
    if one <= other { [one, other] } else { [other, one] }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{cubic, zoo};
    use super::*;

    #[test]
    fn the_angle_turned_is_the_sum_of_small_ones() {
        let mut largest = 0.0_f64;
        for cubic in zoo() {
            let velocity = cubic.velocity();
            for (from, to) in [(0.0, 1.0), (0.0, -0.7)] {
                let mut sum = 0.0;
                let mut before = velocity.start;
                for step in 1..=2000 {
                    let s: f64 = from + (to - from) * f64::from(step) / 2000.0;
                    let here = velocity.at(s);
                    sum += cross(before, here).atan2(dot(before, here));
                    before = here;
                    if step % 100 == 0 {
                        let turned = velocity.turned(s);
                        // A sharp turn between two steps may be taken for one the other way by the sum.
                        let sharp = cubic.standstill().is_some() || before.iter().all(|side| side.abs() < 1e-2);
                        assert!(sharp || ((turned - sum + 1.0).rem_euclid(TAU) - 1.0).abs() < 1e-9);
                        if (turned - sum).abs() > 1e-9 {
                            let slowest = (0..=2000)
                                .map(|k| velocity.at(to * f64::from(k) / 2000.0))
                                .map(|v| dot(v, v).sqrt())
                                .fold(f64::INFINITY, f64::min);
                            assert!(slowest < 1e-2, "{cubic:?} {s}: {turned} {sum}");
                        }
                        largest = largest.max(turned.abs());
                    }
                }
            }
        }
        assert!(largest > 6.0 && largest < TAU, "{largest}");
    }

    #[test]
    fn the_angle_is_exact_where_half_a_turn_is_made() {
        // The velocity goes from (1, 0) over (-0.5, 0) to (-1, -4), counterclockwise.
        let velocity = Velocity { start: [1.0, 0.0], linear: [-4.0, 4.0], square: [2.0, -8.0] };
        assert_eq!(velocity.at(0.5), [-0.5, 0.0]);
        assert_eq!(velocity.turned(0.5), std::f64::consts::PI);
        assert!((velocity.turned(1.0) - TAU + (4.0_f64).atan2(-1.0)).abs() < 1e-15);
        assert_eq!(velocity.turned(0.0), 0.0);
    }

    #[test]
    fn inflections_are_where_the_curvature_changes_its_sign() {
        let s = cubic([[0.0, 0.0], [1.0, 1.0], [2.0, -1.0], [3.0, 0.0]]);
        let found: Vec<_> = s.velocity().inflections().collect();
        assert_eq!(found, [0.5]);
        for cubic in zoo() {
            let velocity = cubic.velocity();
            let curvature = |s: f64| cross(velocity.at(s), velocity.rate(s));
            for s in velocity.inflections() {
                let step = 1e-4;
                let around = curvature(s - step) * curvature(s + step);
                assert!(around < 0.0 || velocity.inflections().any(|other| other != s && (other - s).abs() < 2e-4));
            }
        }
    }
}
