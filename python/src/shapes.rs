//! The shapes of the library by name.

use crate::array::{two, twos};
use crate::errors;
use crate::own_function::OwnFunction;
use crate::pickle::{Constructor, constructor};
use crate::running;
use crate::scene_tables::{degrees, piece};
use crate::shape::PyShape;
use pyo3::prelude::*;
use std::path::{Path, PathBuf};
use vibrissa::contour::description::{
    ArcFields, EllipseFields, LineFields, ParabolaFields, PolygonFields, Shape, SplineEndField, SplineFields, SvgFields,
};
use vibrissa::contour::{ContourError, Range, SplineEnd};
use vibrissa::{Bezier, CircularArc, Contour, Curve, EllipticArc, Graph, Line, Parabola, Spline};

pub fn add(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<PyLine>()?;
    module.add_class::<PyParabola>()?;
    module.add_class::<PyCircularArc>()?;
    module.add_class::<PyEllipticArc>()?;
    module.add_class::<PyBezier>()?;
    module.add_class::<PySpline>()?;
    module.add_class::<PyPolygon>()?;
    module.add_class::<PySvg>()?;
    module.add_class::<PyGraph>()?;
    module.add_class::<PyCurve>()
}

fn single(
    shape: Result<impl Contour + Clone + 'static, ContourError>,
    written: Option<&Shape>,
    constructor: Constructor,
) -> PyResult<PyShape> {
    Ok(PyShape::single(shape.map_err(errors::value)?, written.and_then(piece), Some(constructor)))
}

/// Shapes that the library makes from their description.
fn described_shape(shape: Shape, constructor: Constructor) -> PyResult<PyShape> {
    let named = |error: vibrissa::contour::description::ShapeError| match error.field {
        Some(field) => errors::value(format!("{field}: {error}")),
        None => errors::value(error),
    };
    shape.pieces(Path::new("")).map_err(named)?;
    let written = piece(&shape).map(|table| vec![table]);
    // the description has been tried
    PyShape::new(move || shape.pieces(Path::new("")).unwrap_or_default(), written, constructor).map_err(errors::value)
}

/// A straight line; the solid is on its left.
///
/// Parameters
/// ----------
/// start, end : tuple of float
///     The two points, in m.
///
/// Raises
/// ------
/// ValueError
///     A number is not finite, or the points coincide.
#[pyclass(frozen, extends = PyShape, name = "Line", module = "vibrissa")]
pub struct PyLine;

#[pymethods]
impl PyLine {
    #[new]
    fn new(
        py: Python<'_>,
        #[pyo3(from_py_with = two)] start: [f64; 2],
        #[pyo3(from_py_with = two)] end: [f64; 2],
    ) -> PyResult<(Self, PyShape)> {
        let constructor = constructor!(py, "Line", start, end);
        let written = Shape::Line(LineFields { from: start, to: end });
        Ok((Self, single(Line::new(start, end), Some(&written), constructor)?))
    }
}

/// A parabola ``y = vertex[1] + coefficient (x - vertex[0])^2``, travelled to +x: the solid is above.
///
/// Parameters
/// ----------
/// vertex : tuple of float
///     The vertex, in m.
/// coefficient : float
///     Coefficient of the square, in 1/m.
/// x_from, x_to : float, optional
///     Where it starts and ends, in m; without them it goes on for ever.
///
/// Raises
/// ------
/// ValueError
///     A number is not finite, or the range is empty.
///
/// Examples
/// --------
/// >>> import vibrissa
/// >>> float(vibrissa.Parabola((0.0, 0.0), 50.0).gap(0.0, -0.04))
/// 0.04
#[pyclass(frozen, extends = PyShape, name = "Parabola", module = "vibrissa")]
pub struct PyParabola;

#[pymethods]
impl PyParabola {
    #[new]
    #[pyo3(signature = (vertex, coefficient, *, x_from=None, x_to=None))]
    fn new(
        py: Python<'_>,
        #[pyo3(from_py_with = two)] vertex: [f64; 2],
        coefficient: f64,
        x_from: Option<f64>,
        x_to: Option<f64>,
    ) -> PyResult<(Self, PyShape)> {
        let constructor = constructor!(py, "Parabola", vertex, coefficient, x_from, x_to);
        let written = Shape::Parabola(ParabolaFields { vertex, coefficient, from_x: x_from, to_x: x_to });
        let whole = Parabola::new(vertex, coefficient);
        let shape = match (x_from, x_to) {
            (None, None) => whole,
            (from, to) => {
                whole.and_then(|whole| whole.between(from.unwrap_or(f64::NEG_INFINITY), to.unwrap_or(f64::INFINITY)))
            }
        };
        Ok((Self, single(shape, Some(&written), constructor)?))
    }
}

/// An arc of a circle. Counter-clockwise (``angle_to`` larger) the solid is inside, clockwise outside.
///
/// Parameters
/// ----------
/// center : tuple of float
///     The centre, in m.
/// radius : float
///     The radius, in m.
/// angle_from, angle_to : float
///     Polar angles of start and end in rad, at most one turn apart.
///
/// Raises
/// ------
/// ValueError
///     A number is not finite, the radius is not positive, or the angles are equal or too far apart.
#[pyclass(frozen, extends = PyShape, name = "CircularArc", module = "vibrissa")]
pub struct PyCircularArc;

#[pymethods]
impl PyCircularArc {
    #[new]
    fn new(
        py: Python<'_>,
        #[pyo3(from_py_with = two)] center: [f64; 2],
        radius: f64,
        angle_from: f64,
        angle_to: f64,
    ) -> PyResult<(Self, PyShape)> {
        let constructor = constructor!(py, "CircularArc", center, radius, angle_from, angle_to);
        let (from_angle, to_angle) = (degrees(angle_from), degrees(angle_to));
        let written = Shape::Arc(ArcFields { center, radius, from_angle: Some(from_angle), to_angle: Some(to_angle) });
        Ok((Self, single(CircularArc::new(center, radius, angle_from, angle_to), Some(&written), constructor)?))
    }
}

/// An arc of an ellipse. Counter-clockwise (``angle_to`` larger) the solid is inside, clockwise outside.
///
/// Parameters
/// ----------
/// center : tuple of float
///     The centre, in m.
/// radii : tuple of float
///     The radii along its own axes, in m.
/// angle_from, angle_to : float
///     Eccentric angles of start and end in rad, at most one turn apart.
/// rotation : float, optional
///     Angle of the first axis in rad.
///
/// Raises
/// ------
/// ValueError
///     A number is not finite, a radius is not positive, or the angles are equal or too far apart.
#[pyclass(frozen, extends = PyShape, name = "EllipticArc", module = "vibrissa")]
pub struct PyEllipticArc;

#[pymethods]
impl PyEllipticArc {
    #[new]
    #[pyo3(signature = (center, radii, angle_from, angle_to, *, rotation=0.0))]
    fn new(
        py: Python<'_>,
        #[pyo3(from_py_with = two)] center: [f64; 2],
        #[pyo3(from_py_with = two)] radii: [f64; 2],
        angle_from: f64,
        angle_to: f64,
        rotation: f64,
    ) -> PyResult<(Self, PyShape)> {
        let constructor = constructor!(py, "EllipticArc", center, radii, angle_from, angle_to, rotation);
        let [turned, from_angle, to_angle] = [rotation, angle_from, angle_to].map(degrees);
        let (from_angle, to_angle) = (Some(from_angle), Some(to_angle));
        let written = Shape::Ellipse(EllipseFields { center, radii, rotation: turned, from_angle, to_angle });
        Ok((
            Self,
            single(EllipticArc::new(center, radii, rotation, angle_from, angle_to), Some(&written), constructor)?,
        ))
    }
}

/// A cubic or quadratic Bezier curve; the solid is on its left.
///
/// Parameters
/// ----------
/// control : sequence of tuples of float
///     Four control points, or three, in m.
///
/// Raises
/// ------
/// ValueError
///     A number is not finite, points coincide, or there are neither four nor three.
#[pyclass(frozen, extends = PyShape, name = "Bezier", module = "vibrissa")]
pub struct PyBezier;

#[pymethods]
impl PyBezier {
    #[new]
    fn new(py: Python<'_>, #[pyo3(from_py_with = twos)] control: Vec<[f64; 2]>) -> PyResult<(Self, PyShape)> {
        let constructor = constructor!(py, "Bezier", control);
        let shape = match control[..] {
            [a, b, c, d] => Bezier::new([a, b, c, d]),
            [a, b, c] => Bezier::quadratic([a, b, c]),
            _ => {
                let found = control.len();
                return Err(errors::value(format!("control has {found} points, expected four or three")));
            }
        };
        Ok((Self, single(shape, None, constructor)?))
    }
}

/// A smooth curve through points, or near them; the solid is on its left.
///
/// Parameters
/// ----------
/// points : sequence of tuples of float
///     The points in order, in m.
/// end : {"natural", "clamped", "periodic"}, optional
///     What holds at the ends: no curvature, a direction, or that the curve closes.
/// angle_from, angle_to : float, optional
///     Tangent angles of a clamped curve in rad; estimated unless given.
/// smoothing : float, optional
///     Standard deviation of the noise in each coordinate in m: then the curve passes near the points.
///
/// Raises
/// ------
/// ValueError
///     Points are not finite, repeated or too few, or the arguments do not go together.
#[pyclass(frozen, extends = PyShape, name = "Spline", module = "vibrissa")]
pub struct PySpline;

#[pymethods]
impl PySpline {
    #[new]
    #[pyo3(signature = (points, *, end="natural", angle_from=None, angle_to=None, smoothing=None))]
    fn new(
        py: Python<'_>,
        #[pyo3(from_py_with = twos)] points: Vec<[f64; 2]>,
        end: &str,
        angle_from: Option<f64>,
        angle_to: Option<f64>,
        smoothing: Option<f64>,
    ) -> PyResult<(Self, PyShape)> {
        let constructor = constructor!(py, "Spline", points, end, angle_from, angle_to, smoothing);
        let (field, kind) = match end {
            "natural" => (SplineEndField::Natural, SplineEnd::Natural),
            "clamped" => (SplineEndField::Clamped, SplineEnd::Clamped { from: angle_from, to: angle_to }),
            "periodic" => (SplineEndField::Periodic, SplineEnd::Periodic),
            _ => {
                return Err(errors::value(format!(
                    "end is {end:?}, expected \"natural\", \"clamped\" or \"periodic\""
                )));
            }
        };
        if (angle_from.is_some() || angle_to.is_some()) && end != "clamped" {
            return Err(errors::value(
                "angle_from or angle_to given beside an end without a direction, expected end = \"clamped\"",
            ));
        }
        if smoothing.is_some() && end != "natural" {
            return Err(errors::value(
                "smoothing given beside end, expected natural ends: a smoothed curve has no others",
            ));
        }
        let shape = match smoothing {
            Some(sigma) => Spline::smoothing(&points, sigma),
            None => Spline::through(&points, kind),
        };
        let (from_angle, to_angle) = (angle_from.map(degrees), angle_to.map(degrees));
        let fields = SplineFields { points: Some(points), file: None, end: field, from_angle, to_angle, smoothing };
        Ok((Self, single(shape, Some(&Shape::Spline(fields)), constructor)?))
    }
}

/// Straight edges from point to point; the solid is on the left, inside if the points run counter-clockwise.
///
/// Parameters
/// ----------
/// points : sequence of tuples of float
///     The points in order, in m.
/// closed : bool, optional
///     Whether an edge leads from the last point to the first.
///
/// Raises
/// ------
/// ValueError
///     Points are not finite, repeated or too few.
#[pyclass(frozen, extends = PyShape, name = "Polygon", module = "vibrissa")]
pub struct PyPolygon;

#[pymethods]
impl PyPolygon {
    #[new]
    #[pyo3(signature = (points, *, closed=true))]
    fn new(
        py: Python<'_>,
        #[pyo3(from_py_with = twos)] points: Vec<[f64; 2]>,
        closed: bool,
    ) -> PyResult<(Self, PyShape)> {
        let constructor = constructor!(py, "Polygon", points, closed);
        Ok((
            Self,
            described_shape(Shape::Polygon(PolygonFields { points: Some(points), file: None, closed }), constructor)?,
        ))
    }
}

/// A path of an SVG drawing, upright: lines, Bezier curves and arcs. Closed, it is made to run counter-clockwise.
///
/// Parameters
/// ----------
/// path : str, optional
///     The data of the path, as in its attribute ``d``; or else ``file``.
/// scale : float
///     Length of one unit of the drawing, in m.
/// file : str or os.PathLike, optional
///     The drawing.
/// id : str, optional
///     Which path of the drawing, where it has several.
///
/// Raises
/// ------
/// ValueError
///     The path or the drawing cannot be read, or the arguments do not go together.
#[pyclass(frozen, extends = PyShape, name = "Svg", module = "vibrissa")]
pub struct PySvg;

#[pymethods]
impl PySvg {
    #[new]
    #[pyo3(signature = (path=None, *, scale, file=None, id=None))]
    fn new(
        py: Python<'_>,
        path: Option<String>,
        scale: f64,
        file: Option<PathBuf>,
        id: Option<String>,
    ) -> PyResult<(Self, PyShape)> {
        let file = file.map(|file| std::path::absolute(&file).unwrap_or(file));
        let constructor = constructor!(py, "Svg", path, scale, file, id);
        Ok((Self, described_shape(Shape::Svg(SvgFields { file, path, id, scale }), constructor)?))
    }
}

/// The graph of a function, travelled to +x: the solid is above.
///
/// Parameters
/// ----------
/// function : callable
///     From an array of n values of x (m) to an array of shape (3, n): y (m), dy/dx, and d2y/dx2 (1/m).
/// x_from, x_to : float
///     Where it starts and ends, in m.
///
/// Raises
/// ------
/// ValueError
///     The range is empty, or the function has values that are not finite.
///
/// Examples
/// --------
/// >>> import numpy, vibrissa
/// >>> wave = vibrissa.Graph(lambda x: [numpy.cos(x), -numpy.sin(x), -numpy.cos(x)], -3.0, 3.0)
/// >>> float(wave.gap(0.0, 0.0))
/// 1.0
#[pyclass(frozen, extends = PyShape, name = "Graph", module = "vibrissa")]
pub struct PyGraph;

#[pymethods]
impl PyGraph {
    #[new]
    fn new(function: Bound<'_, PyAny>, x_from: f64, x_to: f64) -> PyResult<(Self, PyShape)> {
        let (py, range) = (function.py(), Range { from: x_from, to: x_to });
        let constructor = constructor!(py, "Graph", function, x_from, x_to);
        let own = OwnFunction::<3>::new(function, range, "the function", "(3, n)")?;
        let graph = running::run(py, || Graph::with_derivatives(range, move |x| own.at(x)))?;
        Ok((Self, single(graph, None, constructor)?))
    }
}

/// A curve by its parameter; the solid is on its left.
///
/// Parameters
/// ----------
/// function : callable
///     From an array of n parameters t to an array of shape (3, 2, n): the point (m), its first and its second derivative by t.
/// t_from, t_to : float
///     Parameters of start and end.
///
/// Raises
/// ------
/// ValueError
///     The range is empty, or the function has values that are not finite, a speed of 0, or a direction that jumps.
#[pyclass(frozen, extends = PyShape, name = "Curve", module = "vibrissa")]
pub struct PyCurve;

#[pymethods]
impl PyCurve {
    #[new]
    fn new(function: Bound<'_, PyAny>, t_from: f64, t_to: f64) -> PyResult<(Self, PyShape)> {
        let (py, range) = (function.py(), Range { from: t_from, to: t_to });
        let constructor = constructor!(py, "Curve", function, t_from, t_to);
        let own = OwnFunction::<6>::new(function, range, "the function", "(3, 2, n)")?;
        let derivatives = move |t| {
            let [x, y, dx, dy, ddx, ddy] = own.at(t);
            [[x, y], [dx, dy], [ddx, ddy]]
        };
        let curve = running::run(py, || Curve::with_derivatives(range, derivatives))?;
        Ok((Self, single(curve, None, constructor)?))
    }
}
