//! The straight line from one point to another.

use crate::contour::{Seal, Trust};
use crate::nearest::gap;
use crate::{Bounds, Closest, Contour, ContourError, Frame, FrameRate, Point, Range, Vector, check};

/// A straight line from one point to another; the solid is on the left of the way from the first to the second.
///
/// The parameter is the arc length, from 0 to the distance of the two points. Both ends come out exactly, so lines that
/// share a point meet to the last bit. The closest point is the projection; it and the gap are exact to rounding, relative
/// to the distance from the nearer end. The angle alpha is between -pi and pi.
///
/// Parameters of [`frame_rate`](Contour::frame_rate): `from_x`, `from_y`, `to_x`, `to_y`.
///
/// ```
/// use rod_contours::{Contour, Line};
///
/// let slope = Line::new([0.0, 0.0], [3.0, 4.0])?;
/// let end = slope.frame(slope.range().to);
/// assert_eq!((end.x, end.y, end.turning), (3.0, 4.0, 0.0));
///
/// // The solid is above: a point below is outside.
/// assert!((slope.gap(4.0, -3.0) - 5.0).abs() < 1e-15);
/// let beyond = slope.closest(6.0, 8.0);
/// assert_eq!((beyond.t, beyond.gap, beyond.interior), (5.0, 5.0, false));
/// # Ok::<(), rod_contours::ContourError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    // No more than this: a polygon holds very many.
    from: Point,
    to: Point,
}

impl Line {
    /// The line between two points, lengths.
    ///
    /// # Errors
    ///
    /// [`ContourError::NotFinite`] for a coordinate, or a distance of the points, that is not finite;
    /// [`ContourError::SamePoint`] for points that coincide or are less than 1e-153 apart.
    pub fn new(from: Point, to: Point) -> Result<Self, ContourError> {
        let line = Self { from, to };
        let (length, _) = line.length_and_direction();
        check::finite([
            ("x of the line's first point", from[0]),
            ("y of the line's first point", from[1]),
            ("x of the line's second point", to[0]),
            ("y of the line's second point", to[1]),
            ("the line's length", length),
        ])?;
        // The square of a shorter length has lost digits.
        if length * length < f64::MIN_POSITIVE {
            return Err(ContourError::SamePoint { x: from[0], y: from[1] });
        }
        Ok(line)
    }

    /// Length and direction.
    fn length_and_direction(&self) -> (f64, Vector) {
        let (dx, dy) = (self.to[0] - self.from[0], self.to[1] - self.from[1]);
        let length = (dx * dx + dy * dy).sqrt();
        (length, [dx / length, dy / length])
    }

    /// The frame at `t` of a line with this length and direction: from the nearer end, so that both are exact.
    fn frame_along(&self, t: f64, length: f64, [cos, sin]: Vector) -> Frame {
        let (end, along) = if t <= 0.5 * length { (self.from, t) } else { (self.to, t - length) };
        Frame { x: end[0] + along * cos, y: end[1] + along * sin, alpha: sin.atan2(cos), speed: 1.0, turning: 0.0 }
    }
}

impl Contour for Line {
    fn frame(&self, t: f64) -> Frame {
        let (length, direction) = self.length_and_direction();
        self.frame_along(t, length, direction)
    }

    fn range(&self) -> Range {
        Range { from: 0.0, to: self.length_and_direction().0 }
    }

    fn closest_in(&self, range: Range, x: f64, y: f64) -> Closest {
        let (length, [cos, sin]) = self.length_and_direction();
        let (mut dx, mut dy) = (x - self.from[0], y - self.from[1]);
        let mut ahead = dx * cos + dy * sin;
        let mut foot = ahead;
        if ahead > 0.5 * length {
            (dx, dy) = (x - self.to[0], y - self.to[1]);
            ahead = dx * cos + dy * sin;
            foot = length + ahead;
        }
        let outside = dx * sin - dy * cos;
        let interior = range.is_interior(foot);
        let t = range.clamp(foot);
        let gap = gap(interior, outside, [foot - t, outside]);
        Closest { t, gap, frame: self.frame_along(t, length, [cos, sin]), interior }
    }

    fn bounds_in(&self, range: Range) -> Bounds {
        let (first, last) = (self.frame(range.from), self.frame(range.to));
        Bounds::EMPTY.with(first.x, first.y).with(last.x, last.y)
    }

    /// None: its closest points are exact on any part.
    fn cuts(&self, _: Range) -> Vec<f64> {
        Vec::new()
    }

    /// A line is its own tangent.
    fn is_convex(&self, _: Range) -> bool {
        true
    }

    fn curvature_in(&self, _: Range) -> (f64, f64) {
        (0.0, 0.0)
    }

    fn closest_is_exact(&self) -> bool {
        true
    }

    fn frame_rate(&self, t: f64, parameter: &str) -> Option<FrameRate> {
        let (length, [cos, sin]) = self.length_and_direction();
        // An end that moves across the line turns it about the other end; along the line it changes nothing at a fixed distance
        // from the first point, which moves with its end.
        let across = t / length;
        let second =
            |normal: f64| FrameRate { x: -sin * normal * across, y: cos * normal * across, alpha: normal / length };
        let first = |dx: f64, dy: f64| {
            let (ahead, normal) = (dx * cos + dy * sin, dy * cos - dx * sin);
            let left = normal * (1.0 - across);
            FrameRate { x: ahead * cos - left * sin, y: ahead * sin + left * cos, alpha: -normal / length }
        };
        match parameter {
            "from_x" => Some(first(1.0, 0.0)),
            "from_y" => Some(first(0.0, 1.0)),
            "to_x" => Some(second(-sin)),
            "to_y" => Some(second(cos)),
            _ => None,
        }
    }

    fn trust(&self, _: Seal) -> Trust {
        Trust::SIMPLE
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_polygon_of_many_lines_fits_into_memory() {
        assert_eq!(size_of::<Line>(), 32);
    }

    #[test]
    fn ends_are_exact() {
        for k in 0..1000 {
            let k = f64::from(k);
            let (from, to) = ([k * 0.37 - 5.0, (k * 0.71).sin()], [(k * 1.3).cos() * 1e3, k * 1e-3]);
            let line = Line::new(from, to).unwrap();
            let (first, last) = (line.frame(0.0), line.frame(line.range().to));
            assert_eq!(([first.x, first.y], [last.x, last.y]), (from, to));
            assert_eq!(line.closest(to[0], to[1]).gap, 0.0);
        }
    }

    #[test]
    fn gaps_are_exact_to_rounding() {
        let line = Line::new([0.1, -0.2], [1.3, 0.7]).unwrap();
        for k in 0..=100 {
            let frame = line.frame(0.0149 * f64::from(k) + 1e-3);
            let (nx, ny) = frame.normal();
            for gap in [0.0, 1e-15, -1e-9, 1e-3, -0.2] {
                let found = line.gap(frame.x - gap * nx, frame.y - gap * ny);
                assert!((found - gap).abs() <= 2.0 * f64::EPSILON);
            }
        }
    }

    #[test]
    fn lines_that_cannot_be() {
        let message = |from, to| Line::new(from, to).unwrap_err().to_string();
        assert_eq!(
            message([1.0, 2.0], [1.0, 2.0]),
            "from and to are the same point (1, 2), expected two different points"
        );
        assert!(message([0.0, 0.0], [1e-200, 0.0]).starts_with("from and to are the same point"));
        assert_eq!(
            message([0.0, 0.0], [0.0, f64::NAN]),
            "y of the line's second point is NaN, expected a finite number"
        );
        assert_eq!(message([-1e308, 0.0], [1e308, 0.0]), "the line's length is inf, expected a finite number");
    }
}
