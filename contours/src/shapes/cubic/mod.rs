//! One cubic: point, velocity, and where it stands still.

mod curvature;
mod nearest;
mod velocity;

use crate::point::{dot, lerp, minus, plus, scale};
use crate::{Bounds, Point, Vector};
pub(crate) use nearest::nearest;
pub(crate) use velocity::{Velocity, roots};

/// Times a cubic is halved in search of a place where it stands still: what remains is a speed below 1e-9 of how much
/// the velocity varies along the cubic.
const HALVINGS: u32 = 30;

/// A cubic Bezier curve over the parameters `from` to `from + width`; `s` below runs from 0 to 1 over the same.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cubic {
    pub control: [Point; 4],
    pub from: f64,
    pub width: f64,
}

impl Cubic {
    /// The one over the parameters 0 to 1.
    pub fn unit(control: [Point; 4]) -> Self {
        Self { control, from: 0.0, width: 1.0 }
    }

    /// The sides of the control polygon.
    pub fn sides(&self) -> [Vector; 3] {
        [0, 1, 2].map(|k| minus(self.control[k + 1], self.control[k]))
    }

    /// The first side of the control polygon, how the second differs from it, and how the third changes that.
    fn differences(&self) -> [Vector; 3] {
        let [first, second, third] = self.sides();
        let bend = minus(second, first);
        [first, bend, minus(minus(third, second), bend)]
    }

    /// The fraction of the cubic at the parameter `t`.
    pub fn fraction(&self, t: f64) -> f64 {
        (t - self.from) / self.width
    }

    pub fn point(&self, s: f64) -> Point {
        let [first, bend, twist] = self.differences();
        // From the start outwards: each term is small beside the one before.
        let inner = plus(scale(3.0, bend), s, twist);
        let outer = plus(scale(3.0, first), s, inner);
        plus(self.control[0], s, outer)
    }

    /// `dr/dt` as a polynomial in `s`.
    pub fn velocity(&self) -> Velocity {
        let [first, bend, twist] = self.differences();
        let per = 3.0 / self.width;
        Velocity { start: scale(per, first), linear: scale(2.0 * per, bend), square: scale(per, twist) }
    }

    /// The blossom: one of the three numbers in each round of de Casteljau's scheme. With three times `s` that is the
    /// point, and both ends come out exactly.
    pub fn blossom(&self, [r, s, t]: [f64; 3]) -> Point {
        let [a, b, c, d] = self.control;
        let [a, b, c] = [lerp(a, b, r), lerp(b, c, r), lerp(c, d, r)];
        let [a, b] = [lerp(a, b, s), lerp(b, c, s)];
        lerp(a, b, t)
    }

    /// The control points of the part between two fractions.
    pub fn part(&self, from: f64, to: f64) -> [Point; 4] {
        if from == 0.0 && to == 1.0 {
            return self.control;
        }
        [[from, from, from], [from, from, to], [from, to, to], [to, to, to]].map(|numbers| self.blossom(numbers))
    }

    /// Both halves, by de Casteljau's scheme.
    pub fn halves(&self) -> [Self; 2] {
        let [a, b, c, d] = self.control;
        let [ab, bc, cd] = [lerp(a, b, 0.5), lerp(b, c, 0.5), lerp(c, d, 0.5)];
        let [left, right] = [lerp(ab, bc, 0.5), lerp(bc, cd, 0.5)];
        let middle = lerp(left, right, 0.5);
        let width = 0.5 * self.width;
        [
            Self { control: [a, ab, left, middle], from: self.from, width },
            Self { control: [middle, right, cd, d], from: self.from + width, width },
        ]
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
fn standstill(control: [Point; 3], from: f64, to: f64, halvings: u32) -> Option<f64> {
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
    let (left, right) = (lerp(a, b, 0.5), lerp(b, c, 0.5));
    let half = lerp(left, right, 0.5);
    standstill([a, left, half], from, at, halvings - 1).or_else(|| standstill([half, right, c], at, to, halvings - 1))
}

#[cfg(test)]
mod tests {
    use super::*;

    pub fn cubic(control: [Point; 4]) -> Cubic {
        Cubic { control, from: 2.0, width: 0.5 }
    }

    /// Numbers from -0.5 to 0.5.
    pub fn random(mut seed: u32) -> impl FnMut() -> f64 {
        move || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(seed >> 8) / f64::from(1 << 24) - 0.5
        }
    }

    /// Curves of all kinds: S, loop, near cusps, three quarters of a turn and more.
    pub fn zoo() -> impl Iterator<Item = Cubic> {
        let mut random = random(1);
        (0..20_000).map(move |_| cubic([0; 4].map(|_| [random(), random()])))
    }

    #[test]
    fn parts_and_boxes() {
        for cubic in zoo().take(100) {
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
        assert!(zoo().all(|cubic| cubic.standstill().is_none()));
    }
}
