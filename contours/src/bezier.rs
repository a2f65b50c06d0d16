//! The cubic Bezier curve.

use crate::cubic::Cubic;
use crate::vector::{cross, dot, scaled};
use crate::{Bounds, Closest, Contour, ContourError, Frame, Range, cuts};

/// Smallest speed accepted, relative to the largest: below it the curve turns round within 1e-6 of its length, and
/// nothing that bends can follow.
const STANDSTILL: f64 = 1e-6;

/// Cells in which the least speed is looked for; its square has at most two minima.
const CELLS: usize = 64;

/// Steps of the refinement of the least speed by thirds, to 1e-8 of the range.
const THIRDS: usize = 40;

/// A cubic Bezier curve; the solid is on the left of the way from the first control point to the last.
///
/// The parameter runs from 0 to 1. The closest point is the least of all minima of the distance: the polynomial of degree
/// 5 whose roots they are is isolated by the signs of its Bernstein coefficients, so none is missed, and refined to
/// rounding. The bounds are exact, and so are the cuts at inflections.
///
/// Alpha is continuous along the whole curve, loops included, and beyond its ends.
///
/// ```
/// use rod_contours::{Bezier, Contour};
///
/// let arch = Bezier::new([[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0]])?;
/// let top = arch.frame(0.5);
/// assert_eq!((top.x, top.y), (0.5, 0.75));
/// // Travelled to the right over the top: the solid is above.
/// assert!((arch.gap(0.5, 0.5) - 0.25).abs() < 1e-15);
/// # Ok::<(), rod_contours::ContourError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bezier {
    cubic: Cubic,
    /// A direction whose opposite the tangent never has: alpha is its angle plus that from it to the tangent.
    ahead: [f64; 2],
}

impl Bezier {
    /// The curve with these control points, lengths.
    ///
    /// # Errors
    ///
    /// [`ContourError::NotFinite`] for a coordinate that is not finite; [`ContourError::Standstill`] for a curve whose speed
    /// vanishes somewhere, or falls below 1e-6 of the largest: a cusp, or an end whose first two (last two) control points
    /// coincide. There the curvature is infinite. A straight line so written is a [`Line`](crate::Line).
    pub fn new(control: [[f64; 2]; 4]) -> Result<Self, ContourError> {
        for [x, y] in control {
            for (what, value) in [("x of a control point", x), ("y of a control point", y)] {
                if !value.is_finite() {
                    return Err(ContourError::NotFinite { what, value });
                }
            }
        }
        let mut curve = Self { cubic: Cubic(control), ahead: [0.0; 2] };
        if let Some(t) = curve.standstill() {
            return Err(ContourError::Standstill { what: "the Bezier curve", t });
        }
        curve.ahead = curve.never_backwards();
        Ok(curve)
    }

    /// The quadratic curve with these control points, lengths, as a cubic one.
    ///
    /// # Errors
    ///
    /// As for [`new`](Self::new).
    ///
    /// ```
    /// use rod_contours::{Bezier, Contour};
    ///
    /// // y = x^2 from -1 to 1, by x = 2 t - 1.
    /// let parabola = Bezier::quadratic([[-1.0, 1.0], [0.0, -1.0], [1.0, 1.0]])?;
    /// let frame = parabola.frame(0.75);
    /// assert!((frame.y - frame.x * frame.x).abs() < 1e-15);
    /// # Ok::<(), rod_contours::ContourError>(())
    /// ```
    pub fn quadratic(control: [[f64; 2]; 3]) -> Result<Self, ContourError> {
        let [first, middle, last] = control;
        let towards = |end: [f64; 2]| [0, 1].map(|k| end[k] + 2.0 / 3.0 * (middle[k] - end[k]));
        Self::new([first, towards(first), towards(last), last])
    }

    /// The control points, lengths.
    pub fn control(&self) -> [[f64; 2]; 4] {
        self.cubic.0
    }

    fn speed(&self, t: f64) -> f64 {
        let [_, [dx, dy], _] = self.cubic.derivatives(t);
        dx.hypot(dy)
    }

    /// Where the speed (almost) vanishes.
    fn standstill(&self) -> Option<f64> {
        let at = |cell: usize| cell as f64 / CELLS as f64;
        let speeds: Vec<f64> = (0..=CELLS).map(|cell| self.speed(at(cell))).collect();
        let largest = speeds.iter().copied().fold(0.0, f64::max);
        for cell in 0..=CELLS {
            let (before, after) = (cell.saturating_sub(1), (cell + 1).min(CELLS));
            if speeds[cell] > speeds[before] || speeds[cell] > speeds[after] {
                continue;
            }
            let (mut low, mut high) = (at(before), at(after));
            for _ in 0..THIRDS {
                let (left, right) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
                if self.speed(left) <= self.speed(right) {
                    high = right;
                } else {
                    low = left;
                }
            }
            let slowest = [low, high, at(cell)].into_iter().min_by(|&a, &b| self.speed(a).total_cmp(&self.speed(b)))?;
            // Also where all speeds are 0.
            if self.speed(slowest) <= STANDSTILL * largest {
                return Some(slowest);
            }
        }
        None
    }

    /// A direction whose opposite the tangent never has.
    ///
    /// Where the tangent stays within a right angle of the mean direction of the ends it is that one, as always on a
    /// quadratic curve. Else the derivative is a parabola in its own plane, and the line through the origin along its axis meets it once, ahead of the origin or behind: the ray
    /// to the other side is never met.
    fn never_backwards(&self) -> [f64; 2] {
        let controls = self.cubic.hodograph();
        let unit = |[x, y]: [f64; 2]| scaled(1.0 / x.hypot(y), [x, y]);
        let ([x, y], [last_x, last_y]) = (unit(controls[0]), unit(controls[2]));
        let mean = [x + last_x, y + last_y];
        if controls.iter().all(|&control| dot(control, mean) > 0.0) {
            return mean;
        }
        let [axis, linear, constant] = self.cubic.powers();
        let (slope, offset) = (cross(axis, linear), cross(axis, constant));
        // The projection on the axis of where they meet, times the square of `slope`.
        let met = dot(axis, axis) * offset * offset - dot(axis, linear) * offset * slope
            + dot(axis, constant) * slope * slope;
        if met >= 0.0 { axis } else { scaled(-1.0, axis) }
    }
}

impl Contour for Bezier {
    fn frame(&self, t: f64) -> Frame {
        let [[x, y], velocity, acceleration] = self.cubic.derivatives(t);
        let square = dot(velocity, velocity);
        let [ahead_x, ahead_y] = self.ahead;
        let turned = cross(self.ahead, velocity).atan2(dot(self.ahead, velocity));
        Frame {
            x,
            y,
            alpha: ahead_y.atan2(ahead_x) + turned,
            speed: square.sqrt(),
            turning: cross(velocity, acceleration) / square,
        }
    }

    fn closest_in(&self, range: Range, x: f64, y: f64) -> Closest {
        let range = Range::UNIT.within(range);
        let point = [x, y];
        let distance = |t: f64| {
            let [place, ..] = self.cubic.derivatives(t);
            (place[0] - x).hypot(place[1] - y)
        };
        let mut best = (range.from, distance(range.from), false);
        let last = distance(range.to);
        if last < best.1 {
            best = (range.to, last, false);
        }
        self.cubic.minima(range, point, |t| {
            let distance = distance(t);
            // A foot as near as an end wins: its gap is the projection, which keeps its digits.
            if distance <= best.1 && range.from < t && t < range.to {
                best = (t, distance, true);
            }
        });
        let (t, _, interior) = best;
        Closest::new(t, self.frame(t), interior, x, y)
    }

    fn bounds_in(&self, range: Range) -> Bounds {
        let range = Range::UNIT.within(range);
        let [square, linear, constant] = self.cubic.powers();
        let mut bounds = Bounds::EMPTY;
        let turns = [0, 1].map(|k| roots(square[k], linear[k], constant[k]));
        for t in [range.from, range.to].into_iter().chain(turns.into_iter().flatten()) {
            if range.contains(t) {
                let [[x, y], ..] = self.cubic.derivatives(t);
                bounds = bounds.with(x, y);
            }
        }
        bounds
    }

    /// The inflections, and between them as many cuts as it takes at equal angles.
    fn cuts(&self, range: Range) -> Vec<f64> {
        let range = Range::UNIT.within(range);
        let [square, linear, constant] = self.cubic.powers();
        // The cross product of first and second derivative.
        let mut bends = roots(cross(linear, square), 2.0 * cross(constant, square), cross(constant, linear));
        bends.sort_by(f64::total_cmp);
        let inside: Vec<f64> = bends.into_iter().filter(|&t| range.from < t && t < range.to).collect();
        cuts::by_turn(self, range, &inside)
    }
}

/// The real roots of `a t^2 + b t + c`; what is no root is not a number.
fn roots(a: f64, b: f64, c: f64) -> [f64; 2] {
    let root = (b * b - 4.0 * a * c).sqrt();
    let sum = -0.5 * (b + if b < 0.0 { -root } else { root });
    [sum / a, c / sum]
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, PI};

    use super::*;

    /// Largest step of alpha between 1000 neighbours, from a little before the curve to a little beyond.
    fn continuity(curve: &Bezier) -> f64 {
        let frames: Vec<Frame> = (0..=1000).map(|k| curve.frame(f64::from(k) * 1.02e-3 - 0.01)).collect();
        for frame in &frames {
            assert!(frame.alpha.is_finite() && frame.speed > 0.0);
        }
        frames.windows(2).map(|pair| (pair[1].alpha - pair[0].alpha).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn alpha_is_continuous_round_loops_of_all_orientations() {
        // A loop that turns by more than a half turn, either way round, in every direction.
        for k in 0..64 {
            for flip in [1.0, -1.0] {
                let (sin, cos) = (f64::from(k) * 0.1).sin_cos();
                let control = [[0.0, 0.0], [3.0, 2.0], [-2.0, 2.0], [1.0, 0.0]]
                    .map(|[x, y]: [f64; 2]| [x * cos - flip * y * sin, x * sin + flip * y * cos]);
                let curve = Bezier::new(control).unwrap();
                assert!(continuity(&curve) < 0.05);
                let turn = curve.frame(1.0).alpha - curve.frame(0.0).alpha;
                let expected = 2.0 * PI - 2.0 * 2.0_f64.atan2(3.0);
                assert!((turn - flip * expected).abs() < 1e-14, "{k} {flip} {turn}");
            }
        }
    }

    #[test]
    fn alpha_is_continuous_on_hairpins_and_straight_curves() {
        for k in 0..64 {
            let (sin, cos) = (f64::from(k) * 0.1).sin_cos();
            let turned = |[x, y]: [f64; 2]| [x * cos - y * sin, x * sin + y * cos];
            // A quadratic hairpin whose ends differ by almost a half turn, and a straight curve with uneven speed.
            let hairpin = Bezier::quadratic([[0.0, 0.0], [9.0, 0.5], [0.5, 1.0]].map(turned)).unwrap();
            assert!(continuity(&hairpin) < 0.1);
            let straight = Bezier::new([[0.0, 0.0], [0.6, 0.0], [0.5, 0.0], [1.0, 0.0]].map(turned)).unwrap();
            assert!(continuity(&straight) < 1e-14);
            assert!(straight.cuts(Range::UNIT).len() <= 2);
        }
    }

    #[test]
    fn cuts_are_the_inflection_and_right_angles() {
        let wave = Bezier::new([[0.0, 0.0], [1.0, 1.0], [1.0, -1.0], [2.0, 0.0]]).unwrap();
        let cuts = wave.cuts(Range::UNIT);
        assert!(cuts.len() == 1 && (cuts[0] - 0.5).abs() < 1e-15, "{cuts:?}");
        let arch = Bezier::new([[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0]]).unwrap();
        let cuts = arch.cuts(Range::UNIT);
        assert!(cuts.len() == 1 && (cuts[0] - 0.5).abs() < 1e-15, "{cuts:?}");
        assert!((arch.frame(0.0).alpha - arch.frame(1.0).alpha - 2.0 * FRAC_PI_2).abs() < 1e-15);
    }

    #[test]
    fn bounds_are_exact() {
        let arch = Bezier::new([[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0]]).unwrap();
        assert_eq!(arch.bounds(), Bounds { min: [0.0, 0.0], max: [1.0, 0.75] });
        assert_eq!(arch.bounds_in(Range { from: 0.0, to: 0.5 }), Bounds { min: [0.0, 0.0], max: [0.5, 0.75] });
    }

    #[test]
    fn curves_that_stand_still() {
        let message = |control| Bezier::new(control).unwrap_err().to_string();
        assert_eq!(
            message([[0.0, 0.0], [0.0, 0.0], [1.0, 1.0], [2.0, 0.0]]),
            "the Bezier curve stands still at t = 0, expected a speed that vanishes nowhere; cut it there, or move apart the points that coincide"
        );
        assert!(message([[0.0, 0.0], [1.0, 1.0], [0.0, 1.0], [1.0, 0.0]]).contains("stands still at t = 0.5"));
        assert!(message([[1.0, 0.0]; 4]).contains("stands still"));
        assert!(message([[1.0, 0.0], [0.0, 0.0], [2.0, 0.0], [f64::NAN, 0.0]]).contains("x of a control point is NaN"));
    }
}
