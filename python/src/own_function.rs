//! Functions written in Python that the library calls: arrays in, arrays out.

use crate::array::Floats;
use crate::errors;
use crate::running::{has_raised, raise};
use numpy::PyArray1;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use std::collections::HashMap;
use std::sync::{Mutex, PoisonError};
use vibrissa::contour::Range;

/// Cells in which the library looks for closest points: their ends are asked for again and again.
const CELLS: u32 = 96;

/// Values that are kept: some 4 MB. With fewer, a scan asks Python for the same ones again.
const MOST_KEPT: usize = 1 << 16;

/// A function of one number with N numbers as its value. Values are kept, because the search for closest points begins at the same
/// parameters each time: so the interpreter is asked for few.
pub struct OwnFunction<const N: usize> {
    function: Py<PyAny>,
    /// What it is called, and what it returns, for messages.
    name: &'static str,
    returns: &'static str,
    kept: Mutex<HashMap<u64, [f64; N]>>,
}

impl<const N: usize> OwnFunction<N> {
    /// The function, which is called once with all parameters from which searches in `range` begin.
    pub fn new(function: Bound<'_, PyAny>, range: Range, name: &'static str, returns: &'static str) -> PyResult<Self> {
        let py = function.py();
        let own = Self { function: function.unbind(), name, returns, kept: Mutex::default() };
        let first: Vec<f64> = (0..=CELLS).map(|cell| range.at(f64::from(cell) / f64::from(CELLS))).collect();
        let values = own.ask(py, &first)?;
        own.keep(first.into_iter().zip(values));
        Ok(own)
    }

    /// The values at several parameters, by one call.
    fn ask(&self, py: Python<'_>, t: &[f64]) -> PyResult<Vec<[f64; N]>> {
        let found = self.function.bind(py).call1((PyArray1::from_slice(py, t),))?;
        let (n, Self { name, returns, .. }) = (t.len(), self);
        let named = |error: PyErr| PyTypeError::new_err(format!("{name}: {}", error.value(py)));
        // seven digits are too few for derivatives and contacts
        let bytes =
            found.getattr_opt("dtype")?.map(|dtype| dtype.getattr("itemsize")?.extract::<usize>()).transpose()?;
        if bytes.is_some_and(|bytes| bytes < size_of::<f64>()) {
            let dtype = found.getattr("dtype")?;
            return Err(PyTypeError::new_err(format!("{name} returns numbers of type {dtype}, expected float64")));
        }
        let array: Floats<'_> = found.extract().map_err(named)?;
        let array = array.view();
        let shape = array.shape();
        let (rows, last) = shape.split_at(shape.len().saturating_sub(1));
        if last != [n] || rows.iter().product::<usize>() != N {
            return Err(errors::value(format!(
                "{name} of an array of {n} parameters has shape {shape:?}, expected an array of shape {returns} with n = {n}"
            )));
        }
        let numbers: Vec<f64> = array.iter().copied().collect();
        Ok((0..n).map(|column| std::array::from_fn(|row| numbers[row * n + column])).collect())
    }

    fn keep(&self, values: impl IntoIterator<Item = (f64, [f64; N])>) {
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        if kept.len() >= MOST_KEPT {
            kept.clear();
        }
        kept.extend(values.into_iter().map(|(t, value)| (t.to_bits(), value)));
    }

    /// The value; NaN after an exception, which is kept for [`running::run`](crate::running::run).
    pub fn at(&self, t: f64) -> [f64; N] {
        let kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner).get(&t.to_bits()).copied();
        if let Some(value) = kept {
            return value;
        }
        if has_raised() {
            return [f64::NAN; N];
        }
        match Python::attach(|py| self.ask(py, &[t])) {
            Ok(values) => {
                let value = values.first().copied().unwrap_or([f64::NAN; N]);
                self.keep([(t, value)]);
                value
            }
            Err(error) => {
                raise(error);
                [f64::NAN; N]
            }
        }
    }
}
