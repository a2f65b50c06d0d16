//! A short arc of the rod as a thick chord, to tell cheaply what it does not come near to.

use crate::shape::Node;
use rod_contours::Bounds;

/// Largest turn of an arc that is taken for a parabola over its chord.
const LARGEST_TURN: f64 = 0.3;

/// The rod between two of its nodes: a parabola over the chord, up to `error`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Arc {
    ends: Bounds,
    from: (f64, f64),
    /// Direction and length of the chord.
    along: (f64, f64),
    chord: f64,
    kappa: f64,
    error: f64,
}

impl Arc {
    pub fn new(from: &Node, to: &Node) -> Self {
        let (dx, dy) = (to.at.x - from.at.x, to.at.y - from.at.y);
        let chord = dx.hypot(dy);
        let length = to.s - from.s;
        let (kappa, change) = (0.5 * (from.at.kappa + to.at.kappa), (to.at.kappa - from.at.kappa).abs());
        // Where it turns far, all that is known is that it cannot leave its chord by more than half its length. What the
        // change of curvature and the parabola leave out is of higher order.
        let flat = length * (kappa.abs() + change) < LARGEST_TURN && chord > 0.0;
        let error = if flat { length * length * (change + length * kappa * kappa) } else { 0.5 * length };
        let along = if flat { (dx / chord, dy / chord) } else { (0.0, 0.0) };
        let ends = Bounds::EMPTY.with(from.at.x, from.at.y).with(to.at.x, to.at.y);
        Self { ends, from: (from.at.x, from.at.y), along, chord, kappa: if flat { kappa } else { 0.0 }, error }
    }

    /// A box around it.
    pub fn bounds(&self) -> Bounds {
        self.ends.grown(self.error + 0.125 * self.kappa.abs() * self.chord * self.chord)
    }

    /// Whether it may come nearer than `reach` to a part of a contour in `bounds`, whose box its own one meets, or may
    /// have gone through it: `alpha` is about the part's tangent angle.
    pub fn comes_near(&self, bounds: &Bounds, reach: f64, alpha: impl FnOnce() -> f64) -> bool {
        if self.along == (0.0, 0.0) || !bounds.is_finite() {
            return true;
        }
        let (cos, sin) = self.along;
        let half = [0, 1].map(|i| 0.5 * (bounds.max[i] - bounds.min[i]));
        let (x, y) = (bounds.min[0] + half[0] - self.from.0, bounds.min[1] + half[1] - self.from.1);
        let (ahead, aside) = (x * cos + y * sin, y * cos - x * sin);
        let (reach_ahead, reach_aside) =
            (half[0] * cos.abs() + half[1] * sin.abs(), half[0] * sin.abs() + half[1] * cos.abs());
        // the parabola at the box's middle, and how far it may run off that along the box
        let at = ahead.clamp(0.0, self.chord);
        let height = -0.5 * self.kappa * at * (self.chord - at);
        let slope = 0.5 * self.kappa.abs() * self.chord;
        let left = height - aside;
        // Beyond that distance, on the outer side it is out of reach; on the inner one it has been there.
        left.abs() <= reach_aside + slope * (reach_ahead + reach) + self.error + reach || {
            let (sin_alpha, cos_alpha) = alpha().sin_cos();
            left * (cos * cos_alpha + sin * sin_alpha) > 0.0
        }
    }
}
