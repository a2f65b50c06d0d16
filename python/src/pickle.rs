//! How an object was made, for `pickle` and `copy`.

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

/// What Python's `__reduce__` gives: a function, and its arguments.
pub type Reduced<'py> = (Bound<'py, PyAny>, Bound<'py, PyTuple>);

/// A function that makes an object, and its arguments.
pub struct Constructor {
    function: Py<PyAny>,
    arguments: Py<PyTuple>,
}

impl Constructor {
    fn by<'py>(py: Python<'py>, function: &str, arguments: Bound<'py, PyTuple>) -> PyResult<Self> {
        let function = py.import("vibrissa._pickled")?.getattr(function)?.unbind();
        Ok(Self { function, arguments: arguments.unbind() })
    }

    /// By a class, with arguments by name.
    pub fn class(py: Python<'_>, class: &str, arguments: &Bound<'_, PyDict>) -> PyResult<Self> {
        Self::by(py, "made", (class, arguments).into_pyobject(py)?)
    }

    /// By a method of another object, with arguments by position.
    pub fn method<'py, A: IntoPyObject<'py, Target = PyTuple, Output = Bound<'py, PyTuple>>>(
        object: &Bound<'py, PyAny>,
        method: &str,
        arguments: A,
    ) -> PyResult<Self> {
        let py = object.py();
        let arguments = arguments.into_pyobject(py).map_err(Into::into)?;
        Self::by(py, "called", (object, method, arguments).into_pyobject(py)?)
    }

    /// As `__reduce__` gives it.
    pub fn reduce<'py>(&self, py: Python<'py>) -> Reduced<'py> {
        (self.function.bind(py).clone(), self.arguments.bind(py).clone())
    }
}

/// An object of a class with arguments that are named as these variables.
macro_rules! constructor {
    ($py:expr, $class:literal, $($name:ident),+) => {{
        let arguments = pyo3::types::PyDict::new($py);
        $(arguments.set_item(stringify!($name), $name.clone())?;)+
        $crate::pickle::Constructor::class($py, $class, &arguments)?
    }};
}
pub(crate) use constructor;
