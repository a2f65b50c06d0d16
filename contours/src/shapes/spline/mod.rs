//! The cubic spline: a smooth contour through given points.

mod chords;
mod cuts;
mod end;
mod fit;
mod keys;
mod smooth;

use std::f64::consts::PI;
use std::ops::Range as Span;

pub use end::SplineEnd;

use crate::contour::{Seal, Trust};
use crate::point::{SMOOTH, cross, dot, nearest_turn};
use crate::proof::limits;
use crate::shapes::cubic::{Cubic, nearest};
use crate::{Bounds, Closest, Contour, ContourError, Frame, Point, Range, Vector, check};
use chords::Chords;
use keys::Keys;

/// Rounding of a handle, relative to the coordinates.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// A smooth curve through points, made of one cubic between each and the next; the solid is on its left.
///
/// [`Spline::through`] gives continuous curvature, with natural, clamped or periodic ends; [`Spline::smoothing`] does the
/// same for points that are known only up to noise. The parameter is a length, that of the polygon of the points, and the
/// speed is about 1. Point, direction and curvature are those of the cubics to rounding: at coordinates of
/// size `c` and points `h` apart that is `1e-16 c` in position, `1e-16 c / h` in the direction and `1e-16 c / h^2` in the
/// curvature.
///
/// The closest point is found whatever the spline, in a time that grows with the logarithm of the number of points. The
/// range ends where the first and last points are, for a closed curve as well: there `interior` is false at the point where
/// it closes.
///
/// With the feature `serde` a spline is serialised as a list of the keys of the crate `splines` (version 5, `Interpolation::StrokeBezier`:
/// parameter, point, handle before and handle after), and read from such a list as long as its keys are in order,
/// finite and smooth. Floating-point numbers that survive the format give back the same spline to the last bit.
///
/// ```
/// use rod_contours::{Contour, Spline, SplineEnd};
///
/// let hill = [[0.0, 0.0], [1.0, -0.3], [2.0, 0.0], [3.0, -0.1]];
/// let spline = Spline::through(&hill, SplineEnd::Natural)?;
/// let closest = spline.closest(1.0, -1.0);
/// assert!(closest.interior && (closest.gap - 0.7).abs() < 0.01);
/// assert_eq!(spline.frame(spline.range().to).x, 3.0);
/// # Ok::<(), rod_contours::ContourError>(())
/// ```
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Deserialize), serde(try_from = "Keys"))]
pub struct Spline {
    keys: Keys,
    /// Tangent angle at the start of each cubic, without jumps along the spline.
    angles: Vec<f64>,
    chords: Chords,
    bounds: Bounds,
}

impl Spline {
    /// The points that the spline passes, in order, lengths; a closed one ends with its first point.
    pub fn points(&self) -> impl ExactSizeIterator<Item = Point> + '_ {
        (0..self.keys.len()).map(|index| self.keys.point(index))
    }

    /// The parameters of the points.
    pub fn knots(&self) -> impl ExactSizeIterator<Item = f64> + '_ {
        (0..self.keys.len()).map(|index| self.keys.knot(index))
    }

    /// The point at `t` as the crate `splines` computes it from the same keys, equal to that of the frame to rounding; none
    /// outside the range.
    ///
    /// ```
    /// use rod_contours::{Spline, SplineEnd};
    ///
    /// let line = Spline::through(&[[0.0, 0.0], [3.0, 4.0]], SplineEnd::Natural)?;
    /// assert!(line.sample(2.5).is_some_and(|[x, y]| (x - 1.5).abs() < 1e-15 && (y - 2.0).abs() < 1e-15));
    /// assert_eq!(line.sample(5.1), None);
    /// # Ok::<(), rod_contours::ContourError>(())
    /// ```
    pub fn sample(&self, t: f64) -> Option<Point> {
        self.keys.sample(t)
    }

    /// The spline of keys that may come from anywhere.
    fn from_keys(keys: Keys) -> Result<Self, ContourError> {
        keys.check()?;
        let count = keys.len() - 1;
        let angles = angles(&keys)?;
        check::finite([("the length of the spline", (0..count).map(|index| rough_length(&keys.cubic(index))).sum())])?;
        let chords = Chords::new(count, |index| keys.cubic(index));
        let boxes = (0..count).map(|index| keys.cubic(index).bounds(0.0, 1.0));
        let bounds = boxes.fold(Bounds::EMPTY, |bounds, one| bounds.union(one));
        Ok(Self { keys, angles, chords, bounds })
    }

    /// The cubics that share more than an end with the range, at least one.
    fn span(&self, range: Range) -> Span<usize> {
        let (first, last) = (self.keys.cubic_at(range.from), self.keys.cubic_at(range.to));
        let ends_there = last > first && self.keys.knot(last) == range.to;
        first..last + usize::from(!ends_there)
    }

    /// The fractions between which a cubic lies in the range, and the parameters there.
    fn part(&self, index: usize, range: Range) -> (Point, Range) {
        let cubic = self.keys.cubic(index);
        let whole = Range { from: cubic.from, to: self.keys.knot(index + 1) };
        let part = whole.within(range);
        let fraction = |t: f64| if t == whole.to { 1.0 } else { cubic.fraction(t) };
        ([fraction(part.from), fraction(part.to)], part)
    }

    /// Whether the range bends one way only, or not at all.
    fn bends_one_way(&self, range: Range) -> bool {
        self.bends(1.0, range) || self.bends(-1.0, range)
    }

    /// Whether all cubics of the range bend only to the left (`sense` 1) or only to the right (-1), if at all, and no two of them meet at an angle that
    /// turns the other way (a spline from a file may turn by up to 1e-9 rad from one to the next). What rounding brings about does not count.
    fn bends(&self, sense: f64, range: Range) -> bool {
        let mut before: Option<Vector> = None;
        self.span(range).all(|index| {
            let cubic = self.keys.cubic(index);
            let ([from, to], _) = self.part(index, range);
            let velocity = cubic.velocity();
            let joint = before.replace(velocity.at(1.0)).map_or(0.0, |before| cross(before, velocity.start));
            cubic.bends(sense, from, to) && sense * joint >= -cubic.tolerance(&velocity)
        })
    }
}

/// The length of a cubic within a factor of about 3: finite where speed and length are.
fn rough_length(cubic: &Cubic) -> f64 {
    let velocity = cubic.velocity();
    cubic.width * [0.0, 0.5, 1.0].iter().map(|&s| dot(velocity.at(s), velocity.at(s)).sqrt()).sum::<f64>()
}

/// The tangent angle at the start of each cubic, continued over whole turns.
fn angles(keys: &Keys) -> Result<Vec<f64>, ContourError> {
    let count = keys.len() - 1;
    let mut angles: Vec<f64> = Vec::with_capacity(count);
    let mut before: Option<(f64, f64)> = None;
    for index in 0..count {
        let cubic = keys.cubic(index);
        if let Some(s) = cubic.standstill() {
            return Err(ContourError::Standstill { what: "the spline", t: cubic.from + s * cubic.width });
        }
        let velocity = cubic.velocity();
        let [x, y] = velocity.start;
        let mut angle = y.atan2(x);
        let [first, _, last] = cubic.sides().map(|side| dot(side, side).sqrt());
        let scale = cubic.control.iter().flatten().fold(0.0_f64, |scale, side| scale.max(side.abs()));
        if let Some((expected, rounding)) = before {
            angle = nearest_turn(angle, expected);
            let turn = angle - expected;
            if turn.abs() > SMOOTH + rounding + ROUNDING * scale / first {
                return Err(ContourError::Kink { key: index + 1, turn });
            }
        }
        angles.push(angle);
        before = Some((angle + velocity.turned(1.0), ROUNDING * scale / last));
    }
    Ok(angles)
}

#[cfg(feature = "serde")]
impl TryFrom<Keys> for Spline {
    type Error = ContourError;

    fn try_from(keys: Keys) -> Result<Self, ContourError> {
        Self::from_keys(keys)
    }
}

#[cfg(feature = "serde")]
impl serde::Serialize for Spline {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.keys.serialize(serializer)
    }
}

impl Contour for Spline {
    fn frame(&self, t: f64) -> Frame {
        let index = self.keys.cubic_at(t);
        let cubic = self.keys.cubic(index);
        let s = cubic.fraction(t);
        let [x, y] = cubic.point(s);
        let velocity = cubic.velocity();
        let here = velocity.at(s);
        let square = dot(here, here);
        Frame {
            x,
            y,
            alpha: self.angles[index] + velocity.turned(s),
            speed: square.sqrt(),
            turning: cross(here, velocity.rate(s)) / (square * cubic.width),
        }
    }

    fn range(&self) -> Range {
        Range { from: self.keys.knot(0), to: self.keys.knot(self.keys.len() - 1) }
    }

    /// The best over the cubics; those whose chords are too far away are passed over together.
    fn closest_in(&self, range: Range, x: f64, y: f64) -> Closest {
        let range = self.range().within(range);
        let (mut best, mut least) = (range.from, f64::INFINITY);
        let points = |index| self.keys.point(index);
        self.chords.visit(self.span(range), [x, y], points, &mut |index| {
            let cubic = self.keys.cubic(index);
            let ([from, to], part) = self.part(index, range);
            nearest(&cubic, from, to, [x, y], &mut |s, square| {
                if square < least {
                    least = square;
                    best = if s == to { part.to } else { part.clamp(cubic.from + s * cubic.width) };
                }
            });
            least.sqrt()
        });
        Closest::new(best, self.frame(best), range.is_interior(best), x, y)
    }

    fn bounds(&self) -> Bounds {
        self.bounds
    }

    fn bounds_in(&self, range: Range) -> Bounds {
        let range = self.range().within(range);
        self.span(range).fold(Bounds::EMPTY, |bounds, index| {
            let ([from, to], _) = self.part(index, range);
            bounds.union(self.keys.cubic(index).bounds(from, to))
        })
    }

    /// Besides, no arc is longer than 4 cubics.
    fn cuts(&self, range: Range) -> Vec<f64> {
        self.parted(range)
    }

    /// Whether the part bends one way only and turns by at most a half turn: then it lies on one side of each of its tangents.
    fn is_convex(&self, range: Range) -> bool {
        let range = self.range().within(range);
        self.bends_one_way(range) && (self.frame(range.to).alpha - self.frame(range.from).alpha).abs() <= PI
    }

    fn curvature_in(&self, range: Range) -> (f64, f64) {
        let range = self.range().within(range);
        self.span(range).fold(limits::NO_CURVATURE, |bounds, index| {
            let ([from, to], _) = self.part(index, range);
            limits::curvature_union(bounds, self.keys.cubic(index).curvature(from, to))
        })
    }

    fn closest_is_exact(&self) -> bool {
        true
    }

    fn trust(&self, _: Seal) -> Trust {
        Trust::TESTED
    }
}
