//! Objects: contours of pieces.

use crate::array::two;
use crate::own_shape::shape;
use crate::pickle::{Constructor, Reduced, constructor};
use crate::scene_tables::Object;
use crate::shape::{PyShape, motion};
use crate::{errors, running};
use pyo3::prelude::*;
use vibrissa::Composite;
use vibrissa::contour::description::Pieces;

/// An object: pieces in order, as one contour.
///
/// Where a piece ends at the start of the next one they are joined, with a corner or a notch unless they have the same direction
/// there. Otherwise the two must cross, and both are cut at the crossing. The pieces are joined, then mirrored, scaled, turned and
/// shifted, then reversed, as in scene files.
///
/// Parameters
/// ----------
/// pieces : Shape, object with ``frame``, or sequence of these
///     The pieces, with the solid on their left.
/// position : tuple of float, optional
///     Where the origin of the pieces comes to, in m.
/// angle : float, optional
///     Rotation about that origin in rad, counter-clockwise.
/// scale : float, optional
///     Factor of all lengths, positive.
/// mirror : bool, optional
///     Whether y becomes -y; the solid stays the solid.
/// reversed : bool, optional
///     Whether solid and outside are exchanged.
///
/// Raises
/// ------
/// ValueError
///     Pieces neither meet nor cross, one is hidden by its neighbours, the contour crosses itself, or a number is not possible.
///
/// Examples
/// --------
/// >>> from vibrissa import Composite, Parabola
/// >>> left, right = Parabola((0.0, 0.0), 50.0), Parabola((0.03, 0.0), 50.0)
/// >>> Composite([left, right]).pieces
/// 2
#[pyclass(frozen, extends = PyShape, name = "Composite", module = "vibrissa")]
pub struct PyComposite {
    pub composite: Composite,
    pub object: Option<Object>,
}

impl PyComposite {
    /// The composite of shapes or objects of Python that have a frame.
    pub fn of(py: Python<'_>, pieces: &[Bound<'_, PyAny>]) -> PyResult<Self> {
        let shapes: Vec<_> = pieces.iter().map(shape).collect::<PyResult<_>>()?;
        let pieces: Pieces = shapes.iter().flat_map(|shape| shape.get().pieces()).collect();
        let composite = running::run(py, || {
            let composite = Composite::joined(pieces)?;
            match composite.self_crossing() {
                Some(crossing) => Err(crossing_error(&crossing)),
                None => Ok(composite),
            }
        })?;
        let written: Option<Vec<_>> = shapes.iter().map(|shape| shape.get().written.clone()).collect();
        let object = written.map(|pieces| Object::of_pieces(pieces.concat()));
        Ok(Self { composite: composite.map_err(errors::value)?, object })
    }

    /// With how it was made, as the class of Python.
    pub fn with_constructor(self, constructor: Constructor) -> (Self, PyShape) {
        let shape = PyShape::single(self.composite.clone(), None, Some(constructor));
        (self, shape)
    }

    /// One that was read, which its table makes.
    pub fn read(composite: Composite, object: Option<Object>) -> (Self, PyShape) {
        let shape = PyShape::single(composite.clone(), None, None);
        (Self { composite, object }, shape)
    }
}

/// The contours of objects, as the library takes them.
pub fn contours(objects: &[Bound<'_, PyComposite>]) -> Vec<Composite> {
    objects.iter().map(|object| object.get().composite.clone()).collect()
}

fn crossing_error(crossing: &vibrissa::contour::SelfCrossing) -> vibrissa::contour::ContourError {
    let ([first, second], [x, y]) = (crossing.pieces, crossing.point);
    vibrissa::contour::ContourError::Crosses { what: "piece", first: first + 1, second: second + 1, x, y }
}

/// The pieces, of which one may stand for itself.
fn list_of_pieces<'py>(pieces: &Bound<'py, PyAny>) -> PyResult<Vec<Bound<'py, PyAny>>> {
    if pieces.is_instance_of::<PyShape>() || pieces.hasattr("frame")? {
        return Ok(vec![pieces.clone()]);
    }
    pieces.try_iter()?.collect()
}

#[pymethods]
impl PyComposite {
    #[new]
    #[pyo3(
        signature = (pieces, *, position=[0.0, 0.0], angle=0.0, scale=1.0, mirror=false, reversed=false),
        text_signature = "(pieces, *, position=(0.0, 0.0), angle=0.0, scale=1.0, mirror=False, reversed=False)"
    )]
    fn new(
        pieces: &Bound<'_, PyAny>,
        #[pyo3(from_py_with = two)] position: [f64; 2],
        angle: f64,
        scale: f64,
        mirror: bool,
        reversed: bool,
    ) -> PyResult<(Self, PyShape)> {
        let (py, pieces) = (pieces.py(), list_of_pieces(pieces)?);
        let constructor = constructor!(py, "Composite", pieces, position, angle, scale, mirror, reversed);
        let joined = Self::of(py, &pieces)?;
        let moved = joined.moved_by(motion(position, angle, scale, mirror))?;
        let whole = if reversed { moved.turned() } else { moved };
        Ok(whole.with_constructor(constructor))
    }

    /// Number of pieces.
    #[getter]
    fn pieces(&self) -> usize {
        self.composite.pieces()
    }

    /// Whether the end meets the start.
    #[getter]
    fn is_closed(&self) -> bool {
        self.composite.is_closed()
    }

    /// Whether it is the border of a cavity, with the solid outside.
    #[getter]
    fn is_cavity(&self) -> bool {
        self.composite.is_cavity()
    }

    /// Whether gaps to it are proven, not sampled.
    #[getter]
    fn is_proven(&self) -> bool {
        self.composite.is_proven()
    }

    /// The object moved: mirrored (y becomes -y), scaled and turned about the origin, then shifted.
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
    ///     Whether y becomes -y before all else.
    ///
    /// Returns
    /// -------
    /// Composite
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
    ) -> PyResult<Py<PyComposite>> {
        let constructor = Constructor::method(slf, "moved", (position, angle, scale, mirror))?;
        Py::new(slf.py(), slf.get().moved_by(motion(position, angle, scale, mirror))?.with_constructor(constructor))
    }

    /// The object with solid and outside exchanged.
    ///
    /// Returns
    /// -------
    /// Composite
    fn reversed(slf: &Bound<'_, Self>) -> PyResult<Py<PyComposite>> {
        let constructor = Constructor::method(slf, "reversed", ())?;
        Py::new(slf.py(), slf.get().turned().with_constructor(constructor))
    }

    fn __repr__(&self) -> String {
        let kind = match (self.is_cavity(), self.is_closed()) {
            (true, _) => "cavity",
            (_, true) => "closed",
            _ => "open",
        };
        format!("<vibrissa.Composite of {} pieces, {kind}>", self.pieces())
    }

    /// For `pickle` and `copy`: a function and its arguments, of an object that was read the table of a scene file.
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        let py = slf.py();
        if let Some(constructor) = &slf.as_super().get().constructor {
            return Ok(constructor.reduce(py));
        }
        let Self { composite, object } = slf.get();
        let none = || errors::value("the object was read from a file that has no table for it");
        let table = object.as_ref().ok_or_else(none)?.table(composite.is_cavity());
        let objects = toml::Value::Array(vec![toml::Value::Table(table)]);
        let text = toml::to_string(&toml::Table::from_iter([("object".to_owned(), objects)])).map_err(errors::value)?;
        Ok((py.import("vibrissa._pickled")?.getattr("composite")?, (text,).into_pyobject(py)?))
    }
}

impl PyComposite {
    fn moved_by(&self, motion: vibrissa::contour::Motion) -> PyResult<Self> {
        let composite = self.composite.clone().moved(motion).map_err(errors::value)?;
        let object = self.object.clone().map(|object| Object { motion: object.motion.then(motion), ..object });
        Ok(Self { composite, object })
    }

    fn turned(&self) -> Self {
        let object = self.object.clone().map(|object| Object { reversed: !object.reversed, ..object });
        Self { composite: self.composite.clone().reversed(), object }
    }
}

/// One object or several, each a composite, a shape or an object of Python that has a frame.
pub fn objects<'py>(given: &Bound<'py, PyAny>) -> PyResult<Vec<Bound<'py, PyComposite>>> {
    if given.is_instance_of::<PyShape>() || given.hasattr("frame")? {
        return Ok(vec![object(given)?]);
    }
    given.try_iter()?.map(|one| object(&one?)).collect()
}

fn object<'py>(given: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyComposite>> {
    match given.downcast::<PyComposite>() {
        Ok(composite) => Ok(composite.clone()),
        Err(_) => {
            let (py, pieces) = (given.py(), vec![given.clone()]);
            let constructor = constructor!(py, "Composite", pieces);
            Bound::new(py, PyComposite::of(py, &pieces)?.with_constructor(constructor))
        }
    }
}
