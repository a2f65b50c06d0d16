//! The parabola, the object of Merker et al. 2020.

use crate::contour::{Seal, Trust};
use crate::nearest::gap;
use crate::proof::limits;
use crate::{Bounds, Closest, Contour, ContourError, Frame, FrameRate, Point, Range, check};

/// Rounding of the curvature, relative.
const CURVATURE_ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Steps after which Newton's iteration gives up; from its starts it takes 2 to 6.
const STEPS: usize = 64;

/// Relative step after which the next one would be below rounding: the error of a step is at most 1.5 step^2 / t.
const LAST_STEP: f64 = 1e-8;

/// Relative first step below which the point's own abscissa is a good enough start: the point is near the contour.
const NEAR: f64 = 0.25;

/// `y = vertex.1 + coefficient (x - vertex.0)^2`, travelled to +x: the solid is above.
///
/// The parameter is `t = x - vertex.0`, all numbers unless trimmed. A coefficient of 0 is the straight line, a negative
/// one a bay in the solid (concave).
///
/// The closest point is the root of the cubic `2 c^2 t^3 + (1 - 2 c py) t - px = 0`, exact to a few units in the last
/// place of `t` (relative to the distance from the vertex), except near the focal curve, where the closest point itself is
/// ill-defined; the gap's absolute error is that of the coordinates. On the axis beyond the centre of curvature, where two
/// points are equally near, the one on the right is given.
///
/// Parameters of [`frame_rate`](Contour::frame_rate): `vertex_x`, `vertex_y`, `coefficient`.
///
/// ```
/// use rod_contours::{Contour, Parabola};
///
/// let shape = Parabola::new([0.0, 0.1], 5.0)?;
/// assert!((shape.gap(0.0, -0.2) - 0.3).abs() < 1e-16);
/// assert!(shape.gap(0.2, 0.1 + 5.0 * 0.2 * 0.2).abs() < 1e-16);
///
/// let right_half = shape.between(0.0, 1.0)?;
/// let closest = right_half.closest(-0.3, 0.1);
/// assert_eq!((closest.t, closest.gap, closest.interior), (0.0, 0.3, false));
/// # Ok::<(), rod_contours::ContourError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parabola {
    vertex: Point,
    coefficient: f64,
    range: Range,
}

impl Parabola {
    /// The unbounded parabola with this vertex (lengths) and coefficient (one over a length, any sign).
    ///
    /// # Errors
    ///
    /// [`ContourError::NotFinite`] for a number that is not finite.
    pub fn new(vertex: Point, coefficient: f64) -> Result<Self, ContourError> {
        check::finite([
            ("x of the parabola's vertex", vertex[0]),
            ("y of the parabola's vertex", vertex[1]),
            ("the parabola's coefficient", coefficient),
        ])?;
        Ok(Self { vertex, coefficient, range: Range::ALL })
    }

    /// The part of the same parabola with x between `x_from` and `x_to`, lengths, either of which may be infinite.
    ///
    /// # Errors
    ///
    /// [`ContourError::EmptyRange`] unless `x_from < x_to` (NaN included).
    pub fn between(self, x_from: f64, x_to: f64) -> Result<Self, ContourError> {
        let range = Range { from: x_from - self.vertex[0], to: x_to - self.vertex[0] };
        if range.from < range.to {
            Ok(Self { range, ..self })
        } else {
            Err(ContourError::EmptyRange { what: "x of the trimmed parabola", from: x_from, to: x_to })
        }
    }

    /// The height above the vertex at `t`; 0 on a straight line even at infinity.
    fn height(&self, t: f64) -> f64 {
        if self.coefficient == 0.0 { 0.0 } else { self.coefficient * t * t }
    }

    /// The nearest point of the part in `range` to `(px, py)`, seen from the vertex, when the nearest point `t` of the
    /// whole parabola is not in it: the other local minimum of the distance or an end.
    fn closest_beside(&self, t: f64, range: Range, px: f64, py: f64) -> (f64, bool) {
        let c = self.coefficient;
        // its square tells as much, and costs less
        let far = |t: f64| (px - t).powi(2) + (py - self.height(t)).powi(2);
        let mut best = (range.from, false);
        if far(range.to) < far(best.0) || !range.from.is_finite() {
            best = (range.to, false);
        }
        // The other two stationary points solve s^2 + s t + t^2 + b/a = 0; the outer one is the minimum. It has the
        // opposite sign, and loses digits only where it merges with the maximum.
        let (a, b) = (2.0 * c * c, 1.0 - 2.0 * c * py);
        let discriminant = -0.75 * t * t - b / a;
        if discriminant >= 0.0 {
            let mut other = -0.5 * t - discriminant.sqrt().copysign(t);
            for _ in 0..2 {
                let square = a * other * other;
                let step = ((square + b) * other - px) / (3.0 * square + b);
                if step.abs() < 0.5 * other.abs() {
                    other -= step;
                }
            }
            if range.contains(other) && far(other) < far(best.0) {
                best = (other, range.is_interior(other));
            }
        }
        best
    }
}

impl Contour for Parabola {
    fn frame(&self, t: f64) -> Frame {
        let tangent = 2.0 * self.coefficient * t;
        let stretch = 1.0 + tangent * tangent;
        Frame {
            x: self.vertex[0] + t,
            y: self.vertex[1] + self.coefficient * t * t,
            alpha: tangent.atan(),
            speed: stretch.sqrt(),
            turning: 2.0 * self.coefficient / stretch,
        }
    }

    fn range(&self) -> Range {
        self.range
    }

    fn closest_in(&self, range: Range, x: f64, y: f64) -> Closest {
        let (px, py) = (x - self.vertex[0], y - self.vertex[1]);
        let t = nearest(self.coefficient, px, py);
        let (t, interior) = if range.is_interior(t) {
            (t, true)
        } else if range.contains(t) || t.is_nan() {
            (t, false)
        } else {
            self.closest_beside(t, range, px, py)
        };
        let frame = self.frame(t);
        // From the coordinates relative to the vertex, without the sine and cosine of alpha: shorter and more exact.
        let (dx, dy) = (px - t, py - self.coefficient * t * t);
        let outside = (dx * 2.0 * self.coefficient * t - dy) / frame.speed;
        Closest { t, gap: gap(interior, outside, [dx, dy]), frame, interior }
    }

    fn bounds_in(&self, range: Range) -> Bounds {
        let ends = Bounds::EMPTY.with(range.from, self.height(range.from)).with(range.to, self.height(range.to));
        let bounds = if range.contains(0.0) { ends.with(0.0, 0.0) } else { ends };
        let moved = |side: Point| [side[0] + self.vertex[0], side[1] + self.vertex[1]];
        Bounds { min: moved(bounds.min), max: moved(bounds.max) }
    }
    /// None: its closest points are exact on any part.
    fn cuts(&self, _: Range) -> Vec<f64> {
        Vec::new()
    }

    /// A parabola always.
    fn is_convex(&self, _: Range) -> bool {
        true
    }

    /// Greatest in absolute value at the vertex, from where it falls either way, to 0 at infinity.
    fn curvature_in(&self, range: Range) -> (f64, f64) {
        let at = |t: f64| {
            let tangent = 2.0 * self.coefficient * t;
            2.0 * self.coefficient / (1.0 + tangent * tangent).powf(1.5)
        };
        if self.coefficient == 0.0 {
            return (0.0, 0.0);
        }
        let vertex = range.contains(0.0).then_some(0.0);
        limits::curvature_bounds([range.from, range.to].into_iter().chain(vertex).map(at), CURVATURE_ROUNDING)
    }

    fn closest_is_exact(&self) -> bool {
        true
    }

    fn frame_rate(&self, t: f64, parameter: &str) -> Option<FrameRate> {
        match parameter {
            "vertex_x" => Some(FrameRate::ALONG_X),
            "vertex_y" => Some(FrameRate::ALONG_Y),
            "coefficient" => {
                let tangent = 2.0 * self.coefficient * t;
                Some(FrameRate { x: 0.0, y: t * t, alpha: 2.0 * t / (1.0 + tangent * tangent) })
            }
            _ => None,
        }
    }

    fn trust(&self, _: Seal) -> Trust {
        Trust::SIMPLE
    }
}

/// The parameter of the nearest point of the whole parabola `y = c x^2` to `(px, py)`.
///
/// By symmetry with q = |px| only. There the slope f = 2 c^2 t^3 + (1 - 2 c py) t - q is convex in t > 0 and f(0) <= 0,
/// so Newton's iteration falls monotonically to the root from any upper bound of it.
fn nearest(c: f64, px: f64, py: f64) -> f64 {
    let q = px.abs();
    let (a, b) = (2.0 * c * c, 1.0 - 2.0 * c * py);
    if q == 0.0 {
        return if b < 0.0 { (-b / a).sqrt() } else { px };
    }
    // The slope at q, in the form that is 0 for a point on the parabola.
    let value = 2.0 * c * q * (c * q * q - py);
    let rate = 3.0 * a * q * q + b;
    let step = value / rate;
    let mut t = q - step;
    if !(rate > 0.0 && step.abs() <= NEAR * q) {
        // One step from q is an upper bound when the rate is positive there, q itself when the slope is; so is the
        // root of the cubic without its linear term, moved out by the root without its constant term.
        let mut bound = above_cube_root(q / a) + (-b / a).max(0.0).sqrt();
        if b > 0.0 {
            bound = bound.min(q / b);
        }
        if value >= 0.0 {
            bound = bound.min(q);
        }
        if rate > 0.0 {
            bound = bound.min(t);
        }
        t = bound;
    }
    for _ in 0..STEPS {
        let square = a * t * t;
        let step = ((square + b) * t - q) / (3.0 * square + b);
        t -= step;
        if step.abs() <= LAST_STEP * t {
            break;
        }
    }
    t.copysign(px)
}

/// A number between the cube root of a positive one and 1.07 times that: a third of the exponent, to which the fraction is
/// nearly linear, taken from the bits.
fn above_cube_root(number: f64) -> f64 {
    const THIRD_OF_BIAS: u64 = 0x2AA0_1000_0000_0000;
    f64::from_bits(number.to_bits() / 3 + THIRD_OF_BIAS)
}
