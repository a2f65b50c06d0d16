//! A short interval of the rod, and how far a function of its points may fall below its values at the ends.

use crate::gap::shape::Node;
use crate::scene::rod::{self, Segment};
use rod_contours::Bounds;
use rod_core::{RodModel, Station};

/// A point of the rod: its arc length and where it is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Knot {
    pub s: f64,
    pub at: Station,
}

impl From<&Node> for Knot {
    fn from(node: &Node) -> Self {
        Self { s: node.s, at: node.at }
    }
}

impl Knot {
    /// The point of a segment at an arc length.
    pub fn on(rod: &impl RodModel, segment: &Segment, s: f64) -> Self {
        Self { s, at: Station::from(&rod::at(rod, segment, s)) }
    }
}

/// The rod between two points of one segment, with bounds that hold everywhere in between.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Interval {
    pub from: Knot,
    pub to: Knot,
    /// Number of the segment.
    pub segment: usize,
    force: f64,
    pub length: f64,
    /// Least and largest curvature.
    pub curvature: (f64, f64),
    /// Largest size of the curvature.
    pub bent: f64,
}

impl Interval {
    pub fn new(rod: &impl RodModel, from: Knot, to: Knot, segment: usize, force: f64) -> Self {
        let length = to.s - from.s;
        let (least, largest) = rod.curvature_bounds((from.s, from.at.moment), (to.s, to.at.moment), force);
        Self { from, to, segment, force, length, curvature: (least, largest), bent: least.abs().max(largest.abs()) }
    }

    /// The parts before and after the arc length `s`.
    pub fn split(&self, rod: &impl RodModel, segment: &Segment, s: f64) -> [Self; 2] {
        let middle = Knot::on(rod, segment, s);
        [(self.from, middle), (middle, self.to)].map(|(from, to)| Self::new(rod, from, to, self.segment, self.force))
    }

    /// How far at most it leaves its chord.
    pub fn bulge(&self) -> f64 {
        0.125 * self.bent * self.length * self.length
    }

    /// Lower bound of u . (r(s) - f) over the interval for a unit vector u: the second derivative is kappa N . u, with N . u
    /// between its end values widened by the rod's turn.
    pub fn least_height(&self, (fx, fy): (f64, f64), (ux, uy): (f64, f64)) -> f64 {
        let height = |at: &Station| (at.x - fx) * ux + (at.y - fy) * uy;
        let slope = |at: &Station| at.cos * ux + at.sin * uy;
        let across = |at: &Station| at.cos * uy - at.sin * ux;
        let (a, b) = (across(&self.from.at), across(&self.to.at));
        let turn = 0.5 * self.bent * self.length;
        let across = (a.min(b) - turn, a.max(b) + turn);
        let second = least_product(self.curvature, across);
        self.least((height(&self.from.at), slope(&self.from.at)), (height(&self.to.at), slope(&self.to.at)), second)
    }

    /// Lower bound of a function with values and slopes `(h0, d0)` and `(h1, d1)` at the ends and a second derivative of at
    /// least `second`. The two parabolas from the ends differ by a linear function and bend downwards, so that the larger
    /// one is least at an end or where they meet.
    pub fn least(&self, (h0, d0): (f64, f64), (h1, d1): (f64, f64), second: f64) -> f64 {
        let (l, c) = (self.length, (-second).max(0.0));
        let ends = h0.min(h1);
        // also where the slopes say so, nothing falls below the values at the ends
        let x = (h0 - h1 + d1 * l + 0.5 * c * l * l) / (d1 - d0 + c * l);
        if 0.0 < x && x < l { ends.min(h0 + x * (d0 - 0.5 * c * x)) } else { ends }
    }

    /// Whether it stays farther than `reach` from a box.
    pub fn misses(&self, bounds: &Bounds, reach: f64) -> bool {
        let (from, to) = (&self.from.at, &self.to.at);
        let grown = self.bulge() + reach;
        let (min_x, max_x) = (from.x.min(to.x) - grown, from.x.max(to.x) + grown);
        let (min_y, max_y) = (from.y.min(to.y) - grown, from.y.max(to.y) + grown);
        if min_x > bounds.max[0] || max_x < bounds.min[0] || min_y > bounds.max[1] || max_y < bounds.min[1] {
            return true;
        }
        if !bounds.is_finite() {
            return false;
        }
        // across the chord
        let (dx, dy) = (to.x - from.x, to.y - from.y);
        let (half_x, half_y) = (0.5 * (bounds.max[0] - bounds.min[0]), 0.5 * (bounds.max[1] - bounds.min[1]));
        let (x, y) = (bounds.min[0] + half_x - from.x, bounds.min[1] + half_y - from.y);
        let aside = (y * dx - x * dy).abs() - half_x * dy.abs() - half_y * dx.abs();
        aside > 0.0 && aside * aside > grown * grown * (dx * dx + dy * dy)
    }

    /// A box around it, grown by `reach`.
    pub fn bounds(&self, reach: f64) -> Bounds {
        let (from, to) = (&self.from.at, &self.to.at);
        Bounds::EMPTY.with(from.x, from.y).with(to.x, to.y).grown(self.bulge() + reach)
    }
}

/// Least product of a number of one range with one of another.
fn least_product((a0, a1): (f64, f64), (b0, b1): (f64, f64)) -> f64 {
    (a0 * b0).min(a0 * b1).min(a1 * b0).min(a1 * b1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use rod_core::{Cut, Uniform};

    proptest! {
        #[test]
        fn no_point_falls_below_the_bound(
            (phi, kappa, a, b) in (-3.2..3.2f64, -8.0..8.0f64, -60.0..60.0f64, -60.0..60.0f64),
            length in 1e-4..0.3f64,
            (fx, fy, turn) in (-0.3..0.3f64, -0.3..0.3f64, -3.2..3.2f64),
        ) {
            let segment = Segment { s: 0.0, start: Cut { x: 0.0, y: 0.0, phi, moment: kappa }, a, b };
            let (from, to) = (Knot::on(&Uniform, &segment, 0.0), Knot::on(&Uniform, &segment, length));
            let interval = Interval::new(&Uniform, from, to, 0, a.hypot(b));
            let (uy, ux) = turn.sin_cos();
            let least = interval.least_height((fx, fy), (ux, uy));
            let bounds = interval.bounds(0.0);
            let (dx, dy) = (to.at.x, to.at.y);
            for k in 0..=64 {
                let Knot { at, .. } = Knot::on(&Uniform, &segment, length * f64::from(k) / 64.0);
                let height = (at.x - fx) * ux + (at.y - fy) * uy;
                prop_assert!(height >= least - 1e-13, "{k}: {height} {least}");
                prop_assert!(at.moment >= interval.curvature.0 - 1e-12 && at.moment <= interval.curvature.1 + 1e-12);
                prop_assert!(bounds.grown(1e-13).distance(at.x, at.y) == 0.0);
                let aside = (at.y * dx - at.x * dy).abs() / dx.hypot(dy);
                prop_assert!(aside <= interval.bulge() + 1e-13);
                prop_assert!(!interval.misses(&Bounds::EMPTY.with(at.x, at.y), 1e-13));
            }
        }
    }

    #[test]
    fn the_bound_closes_in_on_the_least_height() {
        let segment = Segment { s: 0.0, start: Cut { x: 0.0, y: 0.1, phi: -0.5, moment: 2.0 }, a: 1.0, b: 0.5 };
        let excess = |parts: usize| {
            let knots: Vec<_> =
                (0..=parts).map(|k| Knot::on(&Uniform, &segment, 0.5 * k as f64 / parts as f64)).collect();
            let force = segment.a.hypot(segment.b);
            let bounds = knots.windows(2).map(|pair| Interval::new(&Uniform, pair[0], pair[1], 0, force));
            let least = bounds.map(|part| part.least_height((0.0, 0.0), (0.0, 1.0))).fold(f64::INFINITY, f64::min);
            let fine = (0..=20_000).map(|k| Knot::on(&Uniform, &segment, 0.5 * f64::from(k) / 20_000.0).at.y);
            fine.fold(f64::INFINITY, f64::min) - least
        };
        assert!(
            excess(16) < excess(4) / 4.0 && excess(256) < excess(16) / 100.0,
            "{} {} {}",
            excess(4),
            excess(16),
            excess(256)
        );
    }
}
