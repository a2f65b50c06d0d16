//! The cubic Bezier curve.

use std::f64::consts::PI;

use super::cubic::{Cubic, nearest, roots};
use crate::contour::{Seal, Trust};
use crate::nearest::cuts;
use crate::point::{cross, dot, lerp, minus, nearest_turn, scale};
use crate::{Bounds, Closest, Contour, ContourError, Frame, FrameRate, Point, Range, Vector, check};

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
/// Alpha starts between -pi and pi and is continuous along the whole curve, loops included, and beyond its ends.
///
/// Parameters of [`frame_rate`](Contour::frame_rate): the coordinates of the control points, `x0`, `y0`, `x1`, ..., `y3`.
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
    control: [Point; 4],
    /// The tangent angle at the start, rad.
    start: f64,
}

impl Bezier {
    /// The curve with these control points, lengths.
    ///
    /// # Errors
    ///
    /// [`ContourError::NotFinite`] for a coordinate that is not finite; [`ContourError::Standstill`] for a curve whose
    /// speed vanishes somewhere, or falls below 1e-6 of the largest: a cusp, or an end whose first two (last two)
    /// control points coincide. There the curvature is infinite. A straight line so written is a [`Line`](crate::Line).
    pub fn new(control: [Point; 4]) -> Result<Self, ContourError> {
        check::finite(
            control.into_iter().flat_map(|[x, y]| [("x of a control point", x), ("y of a control point", y)]),
        )?;
        let [x, y] = minus(control[1], control[0]);
        let curve = Self { control, start: y.atan2(x) };
        match curve.standstill() {
            Some(t) => Err(ContourError::Standstill { what: "the Bezier curve", t }),
            None => Ok(curve),
        }
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
    pub fn quadratic(control: [Point; 3]) -> Result<Self, ContourError> {
        let [first, middle, last] = control;
        let towards = |end: Point| [0, 1].map(|k| end[k] + 2.0 / 3.0 * (middle[k] - end[k]));
        Self::new([first, towards(first), towards(last), last])
    }

    fn cubic(&self) -> Cubic {
        Cubic::unit(self.control)
    }

    /// Point, first and second derivative; both ends come out exactly.
    fn derivatives(&self, t: f64) -> [Vector; 3] {
        let cubic = self.cubic();
        let [u, v, w] = cubic.sides().map(|side| scale(3.0, side));
        let (uv, vw) = (lerp(u, v, t), lerp(v, w, t));
        [cubic.blossom([t; 3]), lerp(uv, vw, t), scale(2.0, minus(vw, uv))]
    }

    fn speed(&self, t: f64) -> f64 {
        let [_, [dx, dy], _] = self.derivatives(t);
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
}

impl Contour for Bezier {
    fn frame(&self, t: f64) -> Frame {
        let [[x, y], velocity, acceleration] = self.derivatives(t);
        let square = dot(velocity, velocity);
        Frame {
            x,
            y,
            alpha: nearest_turn(velocity[1].atan2(velocity[0]), self.start + self.cubic().velocity().turned(t)),
            speed: square.sqrt(),
            turning: cross(velocity, acceleration) / square,
        }
    }

    fn closest_in(&self, range: Range, x: f64, y: f64) -> Closest {
        let range = Range::UNIT.within(range);
        let (mut best, mut least) = (range.from, f64::INFINITY);
        nearest(&self.cubic(), range.from, range.to, [x, y], &mut |t, square| {
            // A foot as near as an end wins: its gap is the projection, which keeps its digits.
            if square < least || (square == least && range.is_interior(t)) {
                (best, least) = (t, square);
            }
        });
        Closest::new(best, self.frame(best), range.is_interior(best), x, y)
    }

    fn bounds_in(&self, range: Range) -> Bounds {
        let range = Range::UNIT.within(range);
        let velocity = self.cubic().velocity();
        let turns = [0, 1].map(|k| roots(velocity.square[k], velocity.linear[k], velocity.start[k]));
        [range.from, range.to]
            .into_iter()
            .chain(turns.into_iter().flatten())
            .filter(|&t| range.contains(t))
            .map(|t| self.cubic().blossom([t; 3]))
            .fold(Bounds::EMPTY, |bounds, [x, y]| bounds.with(x, y))
    }

    /// The inflections, and between them as many cuts as it takes at equal angles.
    fn cuts(&self, range: Range) -> Vec<f64> {
        let range = Range::UNIT.within(range);
        let bends: Vec<f64> = self.cubic().velocity().inflections().filter(|&t| range.is_interior(t)).collect();
        cuts::at_equal_turns(|t| self.frame(t), range, &bends)
    }

    /// Whether the part bends one way only and turns by at most a half turn: then it lies on one side of each of its tangents.
    fn is_convex(&self, range: Range) -> bool {
        let Range { from, to } = Range::UNIT.within(range);
        let cubic = self.cubic();
        let velocity = cubic.velocity();
        let one_way = cubic.bends(1.0, from, to) || cubic.bends(-1.0, from, to);
        one_way && (velocity.turned(to) - velocity.turned(from)).abs() <= PI
    }

    fn curvature_in(&self, range: Range) -> (f64, f64) {
        let Range { from, to } = Range::UNIT.within(range);
        self.cubic().curvature(from, to)
    }

    fn closest_is_exact(&self) -> bool {
        true
    }

    fn frame_rate(&self, t: f64, parameter: &str) -> Option<FrameRate> {
        let (axis, point) = parameter.split_at_checked(1)?;
        let u = 1.0 - t;
        // the Bernstein polynomial of the control point, and its derivative
        let (weight, slope) = match point {
            "0" => (u * u * u, -3.0 * u * u),
            "1" => (3.0 * t * u * u, 3.0 * u * (u - 2.0 * t)),
            "2" => (3.0 * t * t * u, 3.0 * t * (2.0 * u - t)),
            "3" => (t * t * t, 3.0 * t * t),
            _ => return None,
        };
        let [_, [dx, dy], _] = self.derivatives(t);
        let square = dx * dx + dy * dy;
        match axis {
            "x" => Some(FrameRate { x: weight, y: 0.0, alpha: -dy * slope / square }),
            "y" => Some(FrameRate { x: 0.0, y: weight, alpha: dx * slope / square }),
            _ => None,
        }
    }

    fn trust(&self, _: Seal) -> Trust {
        Trust::TESTED
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

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
                    .map(|[x, y]: Point| [x * cos - flip * y * sin, x * sin + flip * y * cos]);
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
            let turned = |[x, y]: Point| [x * cos - y * sin, x * sin + y * cos];
            // A quadratic hairpin whose ends differ by almost a half turn, and a straight curve with uneven speed.
            let hairpin = Bezier::quadratic([[0.0, 0.0], [9.0, 0.5], [0.5, 1.0]].map(turned)).unwrap();
            assert!(continuity(&hairpin) < 0.1);
            let straight = Bezier::new([[0.0, 0.0], [0.6, 0.0], [0.5, 0.0], [1.0, 0.0]].map(turned)).unwrap();
            assert!(continuity(&straight) < 1e-14);
            assert!(straight.cuts(Range::UNIT).len() <= 2);
        }
    }

    #[test]
    fn alpha_is_continuous_far_beyond_the_ends() {
        for k in 0..64 {
            let (sin, cos) = (f64::from(k) * 0.1).sin_cos();
            for control in
                [[[0.0, 0.0], [3.0, 2.0], [-2.0, 2.0], [1.0, 0.0]], [[0.0, 0.0], [1.0, 0.0], [1.7, 0.4], [2.0, 1.0]]]
            {
                let curve = Bezier::new(control.map(|[x, y]| [x * cos - y * sin, x * sin + y * cos])).unwrap();
                let alpha = |k: i32| curve.frame(f64::from(k) * 1e-3).alpha;
                assert!((-9000..9000).all(|k| (alpha(k + 1) - alpha(k)).abs() < 0.1));
            }
        }
    }

    #[test]
    fn both_ends_come_out_exactly() {
        let control = [[0.1, 0.2], [1.3, 3.7], [2.9, -3.1], [3.3, 0.7]];
        let curve = Bezier::new(control).unwrap();
        assert_eq!([0.0, 1.0].map(|t| curve.derivatives(t)[0]), [control[0], control[3]]);
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
            "the Bezier curve stands still at t = 0, expected a positive speed everywhere; cut it there, or separate the points that coincide"
        );
        assert!(message([[0.0, 0.0], [1.0, 1.0], [0.0, 1.0], [1.0, 0.0]]).contains("stands still at t = 0.5"));
        assert!(message([[1.0, 0.0]; 4]).contains("stands still"));
        assert!(message([[1.0, 0.0], [0.0, 0.0], [2.0, 0.0], [f64::NAN, 0.0]]).contains("x of a control point is NaN"));
    }
}
