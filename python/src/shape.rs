//! Shapes: what all of them can do.

use crate::array::{Column, Floats, Get, structured, two};
use crate::pickle::{Constructor, Reduced};
use crate::{errors, running};
use numpy::ndarray::{ArrayD, ArrayViewD, IxDyn};
use numpy::{IntoPyArray, PyArrayDyn};
use pyo3::prelude::*;
use std::sync::Arc;
use toml::Table;
use vibrissa::contour::description::Pieces;
use vibrissa::contour::{Closest, ContourError, Motion, Moved, Range, Reversed, Trimmed};
use vibrissa::{Composite, Contour};

/// Makes the pieces anew, for each composite that takes them.
type Make = Arc<dyn Fn() -> Pieces + Send + Sync>;

/// The border of a solid, travelled with the solid on its left.
///
/// Wherever a shape is expected, any object with a method ``frame`` will do, see :func:`vibrissa.check_contract`.
#[pyclass(frozen, subclass, name = "Shape", module = "vibrissa")]
pub struct PyShape {
    make: Make,
    /// The piece, or several as one contour.
    whole: Box<dyn Contour>,
    /// The pieces as tables of a scene file; none where they have no name there.
    pub written: Option<Vec<Table>>,
    /// How it was made; none of an object that was read.
    pub constructor: Option<Constructor>,
}

impl PyShape {
    /// A shape of one piece or several.
    pub fn new(
        make: impl Fn() -> Pieces + Send + Sync + 'static,
        written: Option<Vec<Table>>,
        constructor: Constructor,
    ) -> Result<Self, ContourError> {
        let mut pieces = make();
        let whole = match (pieces.pop(), pieces.is_empty()) {
            (Some(piece), true) => piece,
            (last, _) => {
                pieces.extend(last);
                Box::new(Composite::new(pieces)?)
            }
        };
        Ok(Self { make: Arc::new(make), whole, written, constructor: Some(constructor) })
    }

    /// A shape of one piece.
    pub fn single(
        shape: impl Contour + Clone + 'static,
        written: Option<Table>,
        constructor: Option<Constructor>,
    ) -> Self {
        let whole: Box<dyn Contour> = Box::new(shape.clone());
        let make = move || vec![Box::new(shape.clone()) as Box<dyn Contour>];
        Self { make: Arc::new(make), whole, written: written.map(|table| vec![table]), constructor }
    }

    pub fn pieces(&self) -> Pieces {
        (self.make)()
    }

    pub fn contour(&self) -> &dyn Contour {
        &*self.whole
    }
}

/// A function of a point for all points of two arrays, which are broadcast.
fn of_points<T: Send>(
    py: Python<'_>,
    x: &Floats<'_>,
    y: &Floats<'_>,
    value: impl Fn(f64, f64) -> T + Send + Sync,
) -> PyResult<ArrayD<T>> {
    let (x, y) = (x.view(), y.view());
    let size =
        if x.ndim() > y.ndim() || x.ndim() == y.ndim() && x.len() >= y.len() { x.raw_dim() } else { y.raw_dim() };
    let wide = |view: &ArrayViewD<'_, f64>| view.broadcast(size.clone()).map(|wide| wide.to_owned());
    let Some((x, y)) = wide(&x).zip(wide(&y)) else {
        let (one, other) = (x.shape(), y.shape());
        return Err(errors::value(format!(
            "x and y have shapes {one:?} and {other:?}, expected one of them or a number for both"
        )));
    };
    let values = running::run(py, || x.iter().zip(&y).map(|(&x, &y)| value(x, y)).collect::<Vec<T>>())?;
    ArrayD::from_shape_vec(size, values).map_err(errors::value)
}

const CLOSEST: &[Column<Closest>] = &[
    Column { name: "t", get: Get::Float(|closest| closest.t) },
    Column { name: "gap", get: Get::Float(|closest| closest.gap) },
    Column { name: "x", get: Get::Float(|closest| closest.frame.x) },
    Column { name: "y", get: Get::Float(|closest| closest.frame.y) },
    Column { name: "alpha", get: Get::Float(|closest| closest.frame.alpha) },
    Column { name: "interior", get: Get::Flag(|closest| closest.interior) },
];

/// A similarity from the arguments of `moved`.
pub fn motion(position: [f64; 2], angle: f64, scale: f64, mirror: bool) -> Motion {
    Motion { rotation: angle, translation: position, scale, mirror }
}

#[pymethods]
impl PyShape {
    /// The parameters of the two ends; infinite where the shape goes on for ever.
    #[getter]
    fn range(&self) -> (f64, f64) {
        let Range { from, to } = self.whole.range();
        (from, to)
    }

    /// Point, tangent angle and their rates at parameters.
    ///
    /// Parameters
    /// ----------
    /// t : array_like
    ///     Parameters of the shape.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray
    ///     Of shape ``(5,) + t.shape``: x (m), y (m), tangent angle alpha (rad), speed (m per unit of t), and turning (rad per unit
    ///     of t, positive where the solid is convex).
    fn frame<'py>(&self, py: Python<'py>, t: Floats<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let t = t.view().to_owned();
        let frames = running::run(py, || t.iter().map(|&t| self.whole.frame(t)).collect::<Vec<_>>())?;
        let mut values = Vec::with_capacity(5 * frames.len());
        values.extend(frames.iter().map(|frame| frame.x));
        values.extend(frames.iter().map(|frame| frame.y));
        values.extend(frames.iter().map(|frame| frame.alpha));
        values.extend(frames.iter().map(|frame| frame.speed));
        values.extend(frames.iter().map(|frame| frame.turning));
        let size: Vec<usize> = std::iter::once(5).chain(t.shape().iter().copied()).collect();
        Ok(ArrayD::from_shape_vec(IxDyn(&size), values).map_err(errors::value)?.into_pyarray(py))
    }

    /// Signed distance of points from the shape in m, positive outside the solid.
    ///
    /// Parameters
    /// ----------
    /// x, y : array_like
    ///     Coordinates in m.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray
    ///     Gaps in m, in the shape of x and y.
    fn gap<'py>(&self, py: Python<'py>, x: Floats<'py>, y: Floats<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        Ok(of_points(py, &x, &y, |x, y| self.whole.gap(x, y))?.into_pyarray(py))
    }

    /// The points of the shape that are nearest to given ones.
    ///
    /// Parameters
    /// ----------
    /// x, y : array_like
    ///     Coordinates in m.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray
    ///     A structured array in the shape of x and y with the fields ``t``, ``gap`` (m, positive outside the solid), ``x``, ``y``
    ///     (m), ``alpha`` (rad), and ``interior``: whether it is no end of the shape.
    fn closest<'py>(&self, py: Python<'py>, x: Floats<'py>, y: Floats<'py>) -> PyResult<Bound<'py, PyAny>> {
        let found = of_points(py, &x, &y, |x, y| self.whole.closest(x, y))?;
        let size = found.shape().to_vec();
        structured(py, CLOSEST, found.iter())?.call_method1("reshape", (size,))
    }

    /// The shape moved: mirrored (y becomes -y), scaled and turned about the origin, then shifted.
    ///
    /// Parameters
    /// ----------
    /// position : tuple of float, optional
    ///     Where the origin comes to, in m.
    /// angle : float, optional
    ///     Angle in rad, counter-clockwise.
    /// scale : float, optional
    ///     Factor of all lengths, positive.
    /// mirror : bool, optional
    ///     Whether y becomes -y before all else. The solid stays the solid.
    ///
    /// Returns
    /// -------
    /// Shape
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     A number is not finite, or the scale is not positive.
    #[pyo3(
        signature = (position=[0.0, 0.0], angle=0.0, scale=1.0, mirror=false),
        text_signature = "($self, position=(0.0, 0.0), angle=0.0, scale=1.0, mirror=False)"
    )]
    fn moved(
        slf: &Bound<'_, Self>,
        #[pyo3(from_py_with = two)] position: [f64; 2],
        angle: f64,
        scale: f64,
        mirror: bool,
    ) -> PyResult<Self> {
        let constructor = Constructor::method(slf, "moved", (position, angle, scale, mirror))?;
        let shape = slf.get();
        let motion = motion(position, angle, scale, mirror);
        Moved::new(shape.pieces().remove(0), motion).map_err(errors::value)?;
        let make = shape.make.clone();
        // the motion has been tried
        let moved = move || -> Pieces {
            make()
                .into_iter()
                .filter_map(|piece| Some(Box::new(Moved::new(piece, motion).ok()?) as Box<dyn Contour>))
                .collect()
        };
        Self::new(moved, None, constructor).map_err(errors::value)
    }

    /// The shape travelled the other way, which exchanges solid and outside.
    ///
    /// Returns
    /// -------
    /// Shape
    fn reversed(slf: &Bound<'_, Self>) -> PyResult<Self> {
        let constructor = Constructor::method(slf, "reversed", ())?;
        let make = slf.get().make.clone();
        let reversed = move || -> Pieces {
            make().into_iter().rev().map(|piece| Box::new(Reversed::new(piece)) as Box<dyn Contour>).collect()
        };
        Self::new(reversed, None, constructor).map_err(errors::value)
    }

    /// A part of a shape of one piece.
    ///
    /// Parameters
    /// ----------
    /// start, end : float
    ///     Parameters of the ends of the part.
    ///
    /// Returns
    /// -------
    /// Shape
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     The part is empty or leaves the range, or the shape has several pieces.
    fn trimmed(slf: &Bound<'_, Self>, start: f64, end: f64) -> PyResult<Self> {
        let constructor = Constructor::method(slf, "trimmed", (start, end))?;
        let mut pieces = slf.get().pieces();
        let range = Range { from: start, to: end };
        match (pieces.pop(), pieces.is_empty()) {
            (Some(piece), true) => Trimmed::new(piece, range).map_err(errors::value)?,
            _ => return Err(errors::value("the shape has several pieces, expected one piece to trim")),
        };
        let make = slf.get().make.clone();
        let trimmed = move || -> Pieces {
            make()
                .into_iter()
                .filter_map(|piece| Some(Box::new(Trimmed::new(piece, range).ok()?) as Box<dyn Contour>))
                .collect()
        };
        Self::new(trimmed, None, constructor).map_err(errors::value)
    }

    fn __repr__(slf: &Bound<'_, Self>) -> PyResult<String> {
        let (from, to) = slf.get().range();
        Ok(format!("<vibrissa.{} from t = {from:?} to {to:?}>", slf.get_type().name()?))
    }

    /// For `pickle` and `copy`: a function and its arguments.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        let none = || errors::value("the shape cannot be pickled, expected an object of its own: vibrissa.Composite");
        self.constructor.as_ref().map(|constructor| constructor.reduce(py)).ok_or_else(none)
    }
}
