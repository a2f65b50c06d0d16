//! One cubic of a spline: point, velocity, direction, and where it stands still.

use std::f64::consts::TAU;

use crate::Bounds;

/// Times a cubic is halved in search of a place where it stands still: what remains is a speed below 1e-9 of how much
/// the velocity varies along the cubic.
const HALVINGS: u32 = 30;

pub(super) fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

pub(super) fn cross(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

/// `a + s b`.
pub(super) fn plus(a: [f64; 2], s: f64, b: [f64; 2]) -> [f64; 2] {
    [a[0] + s * b[0], a[1] + s * b[1]]
}

pub(super) fn minus(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    plus(a, -1.0, b)
}

fn between(a: [f64; 2], b: [f64; 2], s: f64) -> [f64; 2] {
    [0, 1].map(|k| (1.0 - s) * a[k] + s * b[k])
}

/// A cubic Bezier curve over the parameters `from` to `from + width`; `s` below runs from 0 to 1 over the same.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cubic {
    pub control: [[f64; 2]; 4],
    pub from: f64,
    pub width: f64,
}

impl Cubic {
    /// The sides of the control polygon.
    pub fn sides(&self) -> [[f64; 2]; 3] {
        [0, 1, 2].map(|k| minus(self.control[k + 1], self.control[k]))
    }

    /// The fraction of the cubic at the parameter `t`.
    pub fn fraction(&self, t: f64) -> f64 {
        (t - self.from) / self.width
    }

    pub fn point(&self, s: f64) -> [f64; 2] {
        let [first, second, third] = self.sides();
        let bend = minus(second, first);
        let twist = minus(minus(third, second), bend);
        // From the start outwards: each term is small beside the one before.
        let inner = plus([3.0 * bend[0], 3.0 * bend[1]], s, twist);
        let outer = plus([3.0 * first[0], 3.0 * first[1]], s, inner);
        plus(self.control[0], s, outer)
    }

    /// `dr/dt` as a polynomial in `s`.
    pub fn velocity(&self) -> Velocity {
        let [first, second, third] = self.sides();
        let bend = minus(second, first);
        let twist = minus(minus(third, second), bend);
        let per = 3.0 / self.width;
        Velocity {
            start: first.map(|side| per * side),
            linear: bend.map(|side| 2.0 * per * side),
            square: twist.map(|side| per * side),
        }
    }

    /// The control points of the part between two fractions.
    pub fn part(&self, from: f64, to: f64) -> [[f64; 2]; 4] {
        if from == 0.0 && to == 1.0 {
            return self.control;
        }
        // The blossom of the cubic: one of the two numbers in each round of de Casteljau's scheme.
        let blossom = |r: f64, s: f64, t: f64| {
            let [a, b, c, d] = self.control;
            let [a, b, c] = [between(a, b, r), between(b, c, r), between(c, d, r)];
            let [a, b] = [between(a, b, s), between(b, c, s)];
            between(a, b, t)
        };
        [blossom(from, from, from), blossom(from, from, to), blossom(from, to, to), blossom(to, to, to)]
    }

    /// A box that contains the part between two fractions: that of its control points.
    pub fn bounds(&self, from: f64, to: f64) -> Bounds {
        self.part(from, to).into_iter().fold(Bounds::EMPTY, |bounds, [x, y]| bounds.with(x, y))
    }

    /// A fraction at which the velocity vanishes (to 1e-9 of its variation), if there is one.
    pub fn standstill(&self) -> Option<f64> {
        standstill(self.sides(), 0.0, 1.0, HALVINGS)
    }
}

/// Where the quadratic Bezier curve with these control points, which runs from `from` to `to`, meets the origin.
fn standstill(control: [[f64; 2]; 3], from: f64, to: f64, halvings: u32) -> Option<f64> {
    let [a, b, c] = control;
    // All on one side of a line through the origin, so that their hull does not contain it.
    let middle = plus(plus(a, 1.0, b), 1.0, c);
    if control.iter().all(|&corner| dot(corner, middle) > 0.0) {
        return None;
    }
    let at = 0.5 * (from + to);
    if halvings == 0 {
        return Some(at);
    }
    let (left, right) = (between(a, b, 0.5), between(b, c, 0.5));
    let half = between(left, right, 0.5);
    standstill([a, left, half], from, at, halvings - 1).or_else(|| standstill([half, right, c], at, to, halvings - 1))
}

/// The velocity `start + linear s + square s^2` of a cubic.
#[derive(Clone, Copy, Debug)]
pub(super) struct Velocity {
    pub start: [f64; 2],
    pub linear: [f64; 2],
    pub square: [f64; 2],
}

impl Velocity {
    pub fn at(&self, s: f64) -> [f64; 2] {
        plus(self.start, s, plus(self.linear, s, self.square))
    }

    /// Derivative by `s`.
    pub fn rate(&self, s: f64) -> [f64; 2] {
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
fn roots(a: f64, b: f64, c: f64) -> [f64; 2] {
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
    use super::*;

    fn cubic(control: [[f64; 2]; 4]) -> Cubic {
        Cubic { control, from: 2.0, width: 0.5 }
    }

    /// Curves of all kinds: S, loop, near cusps, three quarters of a turn and more.
    fn zoo() -> Vec<Cubic> {
        let mut zoo = Vec::new();
        let mut seed = 1_u32;
        let mut random = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(seed >> 8) / f64::from(1 << 24) - 0.5
        };
        for _ in 0..20_000 {
            zoo.push(cubic([0; 4].map(|_| [random(), random()])));
        }
        zoo
    }

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
    fn parts_and_boxes() {
        for cubic in zoo().into_iter().take(100) {
            let part = Cubic { control: cubic.part(0.2, 0.7), ..cubic };
            let bounds = cubic.bounds(0.2, 0.7).grown(1e-15);
            for step in 0..=10 {
                let u = f64::from(step) / 10.0;
                let [x, y] = part.point(u);
                let [x_too, y_too] = cubic.point(0.2 + 0.5 * u);
                assert!((x - x_too).abs() < 1e-15 && (y - y_too).abs() < 1e-15);
                assert!(bounds.contains(x, y));
            }
        }
    }

    #[test]
    fn a_cusp_stands_still_and_nothing_else_does() {
        let cusp = cubic([[0.0, 0.0], [1.0, 1.0], [0.0, 1.0], [1.0, 0.0]]);
        assert!((cusp.standstill().unwrap() - 0.5).abs() < 1e-9);
        let back = cubic([[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [0.0, 0.0]]);
        assert!((back.standstill().unwrap() - 0.5).abs() < 1e-9);
        let rounded = cubic([[0.0, 0.0], [1.0, 0.0], [1.0, 1e-6], [0.0, 0.0]]);
        assert_eq!(rounded.standstill(), None);
        assert!(zoo().iter().all(|cubic| cubic.standstill().is_none()));
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
