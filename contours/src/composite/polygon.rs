//! Contours of straight edges.

use crate::point::is_closed;
use crate::{Composite, Contour, ContourError, Line, Point, check};

impl Composite {
    /// The edges from point to point (lengths), with the solid on the left; closed if the last point is the first one.
    ///
    /// ```
    /// use rod_contours::{Composite, Contour};
    ///
    /// let step = Composite::polyline(&[[-1.0, 0.0], [0.0, 0.0], [0.0, 0.5], [1.0, 0.5]])?;
    /// assert_eq!((step.pieces(), step.is_closed()), (3, false));
    /// assert_eq!(step.gap(0.5, 0.3), 0.2);
    /// # Ok::<(), rod_contours::ContourError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// Fewer than two points ([`ContourError::TooFewPoints`]); a point that is not finite
    /// ([`ContourError::PointNotFinite`]) or the same as the one before ([`ContourError::RepeatedPoint`]); edges that cross
    /// ([`ContourError::Crosses`]).
    pub fn polyline(points: &[Point]) -> Result<Self, ContourError> {
        composite_of_edges(edges(points, false)?)
    }

    /// The edges from point to point (lengths) and back to the first one, counterclockwise: the solid is inside.
    ///
    /// The first point may be given again as the last one.
    ///
    /// ```
    /// use rod_contours::{Composite, Contour};
    ///
    /// let square = Composite::polygon(&[[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]])?;
    /// assert!(square.is_closed() && !square.is_cavity());
    /// assert_eq!((square.gap(1.0, -0.5), square.gap(1.0, 0.5)), (0.5, -0.5));
    /// # Ok::<(), rod_contours::ContourError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// Those of [`polyline`](Self::polyline), for fewer than three points; no area, as of points on one line
    /// ([`ContourError::NoArea`]); points that run clockwise ([`ContourError::Clockwise`]).
    pub fn polygon(points: &[Point]) -> Result<Self, ContourError> {
        let polygon = composite_of_edges(edges(points, true)?)?;
        check_area(points)?;
        if polygon.is_cavity() { Err(ContourError::Clockwise) } else { Ok(polygon) }
    }
}

/// Checks that the edges of a closed polygon enclose an area larger than rounding.
fn check_area(points: &[Point]) -> Result<(), ContourError> {
    let [first, rest @ ..] = points else { return Ok(()) };
    let (mut area, mut terms) = (0.0, 0.0);
    for pair in rest.windows(2) {
        let [[x0, y0], [x1, y1]] = [0, 1].map(|k| [0, 1].map(|axis| pair[k][axis] - first[axis]));
        area += 0.5 * (x0 * y1 - x1 * y0);
        terms += 0.5 * ((x0 * y1).abs() + (x1 * y0).abs());
    }
    let rounding = points.len() as f64 * f64::EPSILON * terms;
    if area.abs() <= rounding { Err(ContourError::NoArea { area }) } else { Ok(()) }
}

/// The edges from point to point, and back to the first one if they are closed.
pub(crate) fn edges(points: &[Point], closed: bool) -> Result<Vec<Box<dyn Contour>>, ContourError> {
    check::points(points)?;
    let mut corners = points.to_vec();
    if closed && is_closed(points) {
        corners.pop();
    }
    let (what, needed) = if closed { ("a polygon", 3) } else { ("a polyline", 2) };
    if let Some(index) = points.windows(2).position(|pair| pair[0] == pair[1]) {
        let [x, y] = points[index + 1];
        return Err(ContourError::RepeatedPoint { point: index + 2, x, y });
    }
    if corners.len() < needed {
        return Err(ContourError::TooFewPoints { what, count: corners.len(), needed });
    }
    if closed {
        corners.push(corners[0]);
    }
    let edge = |(index, pair): (usize, &[Point])| match Line::new(pair[0], pair[1]) {
        Ok(line) => Ok(Box::new(line) as Box<dyn Contour>),
        // Apart, but by less than a line can be long.
        Err(ContourError::SamePoint { x, y }) => Err(ContourError::RepeatedPoint { point: index + 2, x, y }),
        Err(error) => Err(error),
    };
    corners.windows(2).enumerate().map(edge).collect()
}

/// A contour of edges that do not cross.
fn composite_of_edges(edges: Vec<Box<dyn Contour>>) -> Result<Composite, ContourError> {
    let named = |error| match error {
        ContourError::Crosses { first, second, x, y, .. } => {
            ContourError::Crosses { what: "edge", first, second, x, y }
        }
        error => error,
    };
    let contour = Composite::new(edges).map_err(named)?;
    contour.without_self_crossing().map_err(named)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_on_one_line_are_no_polygon() {
        for tilt in [0.0, 0.3] {
            let line = [0.0, 0.4, 1.0, 0.7].map(|x: f64| [x, tilt * x]);
            assert!(matches!(Composite::polygon(&line), Err(ContourError::NoArea { .. })), "{tilt}");
        }
        assert!(Composite::polygon(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1e-12]]).is_ok());
    }

    const SQUARE: [Point; 4] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];

    fn message(result: Result<Composite, ContourError>) -> String {
        result.unwrap_err().to_string()
    }

    #[test]
    fn the_first_point_may_be_repeated() {
        let closed: Vec<Point> = SQUARE.into_iter().chain([SQUARE[0]]).collect();
        assert_eq!(Composite::polygon(&closed).unwrap().pieces(), 4);
        assert_eq!(Composite::polygon(&SQUARE).unwrap().pieces(), 4);
        assert!(Composite::polyline(&closed).unwrap().is_closed());
        assert!(!Composite::polyline(&SQUARE).unwrap().is_closed());
        // The last bit of a computed last point does not matter.
        let nearly: Vec<Point> = SQUARE.into_iter().chain([[1e-16, -1e-16]]).collect();
        assert_eq!(Composite::polygon(&nearly).unwrap().pieces(), 4);
    }

    #[test]
    fn points_that_make_no_polygon() {
        assert_eq!(message(Composite::polyline(&SQUARE[..1])), "a polyline needs at least 2 points, got 1");
        assert_eq!(message(Composite::polygon(&SQUARE[..2])), "a polygon needs at least 3 points, got 2");
        assert_eq!(message(Composite::polygon(&[])), "a polygon needs at least 3 points, got 0");
        let repeated = [SQUARE[0], SQUARE[1], SQUARE[1], SQUARE[2]];
        assert_eq!(
            message(Composite::polygon(&repeated)),
            "point 3 is (1, 0), the same as the one before it; leave one of them out"
        );
        assert!(message(Composite::polyline(&[[0.0, 0.0], [1e-200, 0.0]])).starts_with("point 2 is (0, 0)"));
        let error = message(Composite::polygon(&[SQUARE[0], SQUARE[1], [f64::NAN, 1.0]]));
        assert_eq!(error, "point 3 is (NaN, 1), expected finite numbers");
    }

    #[test]
    fn points_in_the_wrong_order() {
        let clockwise: Vec<Point> = SQUARE.into_iter().rev().collect();
        assert_eq!(
            message(Composite::polygon(&clockwise)),
            "the points run clockwise, which would put the solid outside; reverse them; `reversed` makes a cavity of the polygon"
        );
    }
}
