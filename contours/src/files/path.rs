//! The segments of an SVG path: the seam to `kurbo`.

use kurbo::{Affine, BezPath, PathEl, PathSeg, Point, Shape};

use super::SvgError;
use crate::description::Pieces;
use crate::{Bezier, Contour, ContourError, Line};

/// Segments shorter than this, relative to the path, are what rounding leaves of a path that is closed already.
const TINY: f64 = 1e-10;

/// The contours of an SVG path's data (the attribute `d`), one for each subpath: the pieces of each in order, for
/// [`Composite::new`](crate::Composite::new).
///
/// One unit of the drawing is `scale` long, y is turned round, so that the picture stays upright, and a closed subpath
/// is made to run counterclockwise, with the solid inside. Lines become [`Line`], Bezier curves [`Bezier`]; arcs become
/// Bezier curves that leave the arc by less than 3e-4 of its radius.
///
/// ```
/// use rod_contours::{Composite, Contour, file};
///
/// // A rounded plate, 20 mm by 10 mm, drawn in mm.
/// let plate = file::subpaths("M5 0 H15 a5 5 0 0 1 0 10 H5 a5 5 0 0 1 0 -10 z", 1e-3)?.remove(0);
/// let plate = Composite::new(plate)?;
/// assert!(plate.is_closed() && !plate.is_cavity());
/// assert!((plate.gap(10e-3, 2e-3) - 2e-3).abs() < 1e-15);
/// assert!((plate.gap(-1e-3, -5e-3) - 1e-3).abs() < 3e-4 * 5e-3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
///
/// [`SvgError::Data`], [`SvgError::Empty`], and [`SvgError::Segment`] for a curve that cannot be part of a contour.
pub fn subpaths(data: &str, scale: f64) -> Result<Vec<Pieces>, SvgError> {
    let path = BezPath::from_svg(data).map_err(|error| SvgError::Data { message: error.to_string() })?;
    let upright = Affine::new([scale, 0.0, 0.0, -scale, 0.0, 0.0]);
    let mut contours = Vec::new();
    let mut segment = 0;
    for part in path.subpaths() {
        let mut part = upright * BezPath::from_vec(part.to_vec());
        let bounds = part.control_box();
        let tiny = TINY * bounds.width().hypot(bounds.height());
        let closed = is_closed(&part, tiny);
        if closed && part.area() < 0.0 {
            part = part.reverse_subpaths();
        }
        let mut pieces = Pieces::new();
        for found in part.segments() {
            segment += 1;
            pieces.extend(piece_of(found, tiny).map_err(|source| SvgError::Segment { segment, source })?);
        }
        if !pieces.is_empty() {
            contours.push(pieces);
        }
    }
    if contours.is_empty() { Err(SvgError::Empty) } else { Ok(contours) }
}

/// The pieces of the only subpath.
pub(crate) fn piece(data: &str, scale: f64) -> Result<Pieces, SvgError> {
    let mut contours = subpaths(data, scale)?;
    match (contours.pop(), contours.len()) {
        (Some(pieces), 0) => Ok(pieces),
        (_, others) => Err(SvgError::Subpaths { count: others + 1 }),
    }
}

fn is_closed(part: &BezPath, tiny: f64) -> bool {
    let elements = part.elements();
    let ends = [elements.first(), elements.last()].map(|element| element.and_then(PathEl::end_point));
    matches!(elements.last(), Some(PathEl::ClosePath))
        || matches!(ends, [Some(first), Some(last)] if elements.len() > 1 && first.distance(last) <= tiny)
}

/// A segment as a piece; `None` if it has no length.
fn piece_of(segment: PathSeg, tiny: f64) -> Result<Option<Box<dyn Contour>>, ContourError> {
    let xy = |point: Point| [point.x, point.y];
    let here = |one: Point, other: Point| one.distance(other) <= tiny;
    Ok(Some(match segment {
        PathSeg::Line(line) if here(line.p0, line.p1) => return Ok(None),
        PathSeg::Line(line) => Box::new(Line::new(xy(line.p0), xy(line.p1))?),
        PathSeg::Quad(quad) if here(quad.p0, quad.p1) && here(quad.p1, quad.p2) => return Ok(None),
        PathSeg::Quad(quad) if here(quad.p0, quad.p1) || here(quad.p1, quad.p2) => {
            Box::new(Line::new(xy(quad.p0), xy(quad.p2))?)
        }
        PathSeg::Quad(quad) => Box::new(Bezier::quadratic([quad.p0, quad.p1, quad.p2].map(xy))?),
        PathSeg::Cubic(cubic) if here(cubic.p0, cubic.p1) && here(cubic.p2, cubic.p3) => {
            // A line as drawing programs write it, with its handles drawn in.
            if here(cubic.p0, cubic.p3) {
                return Ok(None);
            }
            Box::new(Line::new(xy(cubic.p0), xy(cubic.p3))?)
        }
        PathSeg::Cubic(cubic) => Box::new(Bezier::new([cubic.p0, cubic.p1, cubic.p2, cubic.p3].map(xy))?),
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Composite;

    fn contour(data: &str) -> Composite {
        Composite::new(piece(data, 1.0).unwrap()).unwrap()
    }

    #[test]
    fn closed_paths_run_counterclockwise() {
        for square in ["M0 0h1v1h-1z", "M0 0v1h1v-1z", "M0 0h1v1h-1v-1z", "M0 0h1v1h-1v-1"] {
            let square = contour(square);
            assert_eq!((square.pieces(), square.is_closed(), square.is_cavity()), (4, true, false));
            // Down in the drawing is down here.
            assert_eq!((square.gap(0.5, -0.25), square.gap(0.5, 0.25)), (-0.25, 0.25));
        }
        let open = contour("M0 0 H1 V-1");
        assert_eq!((open.pieces(), open.is_closed()), (2, false));
        assert_eq!(open.gap(0.5, -0.1), 0.1);
    }

    #[test]
    fn curves_of_all_kinds() {
        let wave = contour("M0 0 Q1 1 2 0 T4 0 C5 -1 6 -1 7 0 S9 1 10 0 C10 0 11 0 11 0");
        assert_eq!(wave.pieces(), 5);
        assert!(wave.gap(1.0, -0.5).abs() < 1e-15);
        let circle = contour("M1 0A1 1 0 0 1-1 0A1 1 0 0 1 1 0");
        assert!(circle.is_closed());
        for k in 0..100 {
            let (sin, cos) = (0.0628 * f64::from(k)).sin_cos();
            assert!((circle.gap(2.0 * cos, 2.0 * sin) - 1.0).abs() < 3e-4);
        }
    }

    #[test]
    fn what_is_no_path() {
        let message = |data| piece(data, 1.0).unwrap_err().to_string();
        assert!(message("").starts_with("the path is empty"));
        assert!(
            message("M0 0").starts_with("the path is empty")
                && message("M0 0 L 0 0 z").starts_with("the path is empty")
        );
        assert!(message("M0 0 K1").starts_with("the data of the path cannot be read: Unknown command, \"K\""));
        assert!(message("M0 0h1M2 2h1").starts_with("the path has 2 subpaths, expected one"));
        let cusp = message("M0 0h-1M0 0C0 0 1 1 2 0".replace("M0 0h-1", "").as_str());
        assert!(cusp.starts_with("segment 1 of the path: the Bezier curve stands still at t = 0"), "{cusp}");
    }
}
