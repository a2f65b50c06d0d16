//! Arrays of NumPy: floats from anything, and structured arrays, whose rows have named fields.

use numpy::ndarray::Ix2;
use numpy::{PyArray1, PyReadonlyArrayDyn};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use std::borrow::Cow;

/// Floats from numbers, lists or arrays.
pub struct Floats<'py>(PyReadonlyArrayDyn<'py, f64>);

impl<'py> FromPyObject<'py> for Floats<'py> {
    fn extract_bound(object: &Bound<'py, PyAny>) -> PyResult<Self> {
        let numpy = object.py().import("numpy")?;
        let wrong = |found: &str| PyTypeError::new_err(format!("expected numbers, found {found}"));
        let failed = |error: PyErr| PyTypeError::new_err(format!("expected numbers; {}", error.value(object.py())));
        let given = numpy.call_method1("asanyarray", (object,)).map_err(failed)?;
        // what NumPy would turn into a number in silence
        let dtype = given.getattr("dtype")?;
        let kind: char = dtype.getattr("kind")?.extract()?;
        let has_none = || given.call_method0("ravel")?.call_method0("tolist")?.contains(object.py().None());
        if !"fiubO".contains(kind) || kind == 'O' && has_none()? {
            return Err(wrong(&format!("{} of type {dtype}", object.str()?)));
        }
        let masked = numpy.getattr("ma")?.call_method1("is_masked", (&given,))?;
        if masked.is_truthy()? {
            return Err(wrong("masked ones"));
        }
        // a field of a structured array may be neither aligned nor in one piece
        let floats = numpy.call_method1("require", (given, "float64", ["C", "A"]));
        Ok(Self(floats.map_err(failed)?.extract()?))
    }
}

/// Two coordinates, for `from_py_with`.
pub fn two(object: &Bound<'_, PyAny>) -> PyResult<[f64; 2]> {
    let floats: Floats<'_> = object.extract()?;
    let numbers: Vec<f64> = floats.view().iter().copied().collect();
    let wrong = || PyTypeError::new_err(format!("expected two numbers, found {}", numbers.len()));
    numbers[..].try_into().map_err(|_| wrong())
}

/// Points of two coordinates, for `from_py_with`.
pub fn twos(object: &Bound<'_, PyAny>) -> PyResult<Vec<[f64; 2]>> {
    let floats: Floats<'_> = object.extract()?;
    let view = floats.view();
    let wrong = || {
        PyTypeError::new_err(format!(
            "expected points of two coordinates, of shape (n, 2), found the shape {:?}",
            view.shape()
        ))
    };
    let points = view.view().into_dimensionality::<Ix2>().map_err(|_| wrong())?;
    if points.ncols() != 2 {
        return Err(wrong());
    }
    Ok(points.rows().into_iter().map(|row| [row[0], row[1]]).collect())
}

/// A whole number that is not negative, for `from_py_with`.
pub fn whole<T: TryFrom<u64>>(object: &Bound<'_, PyAny>) -> PyResult<T> {
    let number = object.extract::<u64>().ok().and_then(|number| number.try_into().ok());
    number.ok_or_else(|| {
        let found = object.repr().map_or_else(|_| "something else".to_owned(), |text| text.to_string());
        PyTypeError::new_err(format!("expected a whole number from 0 to {}, found {found}", u64::MAX))
    })
}

/// The same, or none.
pub fn whole_or_none(object: &Bound<'_, PyAny>) -> PyResult<Option<u64>> {
    if object.is_none() { Ok(None) } else { whole(object).map(Some) }
}

impl Floats<'_> {
    pub fn view(&self) -> numpy::ndarray::ArrayViewD<'_, f64> {
        self.0.as_array()
    }
}

/// A field of a row.
pub struct Column<T> {
    pub name: &'static str,
    pub get: Get<T>,
}

/// How a field is read from a row.
pub enum Get<T> {
    Float(fn(&T) -> f64),
    Int(fn(&T) -> i64),
    Flag(fn(&T) -> bool),
    Text(fn(&T) -> Cow<'static, str>),
}

/// Units of the fields of all arrays; those of plain numbers are left out.
const UNITS: &[(&str, &str)] = &[
    ("x0", "m"),
    ("y0", "m"),
    ("phi0", "rad"),
    ("f0x", "N"),
    ("f0y", "N"),
    ("m0z", "N m"),
    ("sigma_f0x", "N"),
    ("sigma_f0y", "N"),
    ("sigma_m0z", "N m"),
    ("t", "s"),
    ("min_gap", "m"),
    ("min_gap_bound", "m"),
    ("min_force", "N"),
    ("energy", "J"),
    ("max_stress", "Pa"),
    ("s", "m"),
    ("x", "m"),
    ("y", "m"),
    ("alpha", "rad"),
    ("force", "N"),
    ("friction", "N"),
    ("slip", "m"),
    ("dissipated", "J"),
    ("sigma", "m"),
    ("sigma_systematic", "m"),
    ("sigma_x", "m"),
    ("fx", "N"),
    ("fy", "N"),
    ("sigma_s", "m"),
    ("sigma_force", "N"),
    ("sigma_fx", "N"),
    ("sigma_fy", "N"),
    ("sigma_y", "m"),
    ("systematic_x", "m"),
    ("systematic_y", "m"),
    ("second_x", "m"),
    ("second_y", "m"),
    ("second_s", "m"),
    ("second_alpha", "rad"),
    ("second_force", "N"),
    ("second_sigma_x", "m"),
    ("second_sigma_y", "m"),
    ("x0_after", "m"),
    ("y0_after", "m"),
    ("phi0_after", "rad"),
    ("f0x_after", "N"),
    ("f0y_after", "N"),
    ("m0z_after", "N m"),
    ("angle", "rad"),
    ("distance", "m"),
    ("single", "m"),
    ("several", "m"),
    ("start", "m"),
    ("end", "m"),
    ("x_start", "m"),
    ("y_start", "m"),
    ("x_end", "m"),
    ("y_end", "m"),
    ("largest_moment", "N m"),
    ("largest_stress", "Pa"),
    ("x_from", "m"),
    ("y_from", "m"),
    ("x_to", "m"),
    ("y_to", "m"),
    ("gain", "m"),
    ("gain_sigma", "m"),
    ("touched", "m"),
    ("time", "s"),
    ("known_sigma_after", "m"),
];

/// The units by the names of the fields.
pub fn units(py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
    let units = PyDict::new(py);
    UNITS.iter().try_for_each(|(name, unit)| units.set_item(name, unit))?;
    Ok(units)
}

/// The rows as a structured array, which cannot be written to.
pub fn structured<'py, 'a, T: 'a>(
    py: Python<'py>,
    columns: &[Column<T>],
    rows: impl Iterator<Item = &'a T> + Clone,
) -> PyResult<Bound<'py, PyAny>> {
    // texts are made once, for their width and for the array
    let mut texts = Vec::with_capacity(columns.len());
    let mut formats = Vec::with_capacity(columns.len());
    for column in columns {
        let text: Vec<Cow<'static, str>> = match column.get {
            Get::Text(get) => rows.clone().map(get).collect(),
            _ => Vec::new(),
        };
        let width = text.iter().map(|text| text.chars().count()).max().unwrap_or(0).max(1);
        formats.push(match column.get {
            Get::Float(_) => (column.name, "<f8".to_owned()),
            Get::Int(_) => (column.name, "<i8".to_owned()),
            Get::Flag(_) => (column.name, "?".to_owned()),
            Get::Text(_) => (column.name, format!("<U{width}")),
        });
        texts.push(text);
    }
    let numpy = py.import("numpy")?;
    // aligned, so that each field is an ordinary array of numbers
    let dtype = numpy.getattr("dtype")?.call1((formats, true))?;
    let size: usize = dtype.getattr("itemsize")?.extract()?;
    let count = rows.clone().count();
    // `frombuffer` refuses an empty buffer
    if count == 0 {
        return numpy.call_method1("empty", (0, dtype));
    }
    let mut starts = Vec::with_capacity(columns.len());
    for column in columns {
        let (_, start): (Bound<'_, PyAny>, usize) = dtype.getattr("fields")?.get_item(column.name)?.extract()?;
        starts.push(start);
    }
    let bytes = PyBytes::new_with(py, count * size, |bytes| {
        for (number, (row, bytes)) in rows.zip(bytes.chunks_exact_mut(size)).enumerate() {
            for ((column, start), text) in columns.iter().zip(&starts).zip(&texts) {
                let cell = &mut bytes[*start..];
                match column.get {
                    Get::Float(get) => cell[..8].copy_from_slice(&get(row).to_le_bytes()),
                    Get::Int(get) => cell[..8].copy_from_slice(&get(row).to_le_bytes()),
                    Get::Flag(get) => cell[0] = u8::from(get(row)),
                    Get::Text(_) => {
                        for (letter, cell) in text[number].chars().zip(cell.chunks_exact_mut(4)) {
                            cell.copy_from_slice(&u32::from(letter).to_le_bytes());
                        }
                    }
                }
            }
        }
        Ok(())
    })?;
    numpy.call_method1("frombuffer", (bytes, dtype))
}

/// Lists of different lengths in the layout of Arrow: `vibrissa.Ragged`. `lengths` are those of the lists.
pub fn ragged<'py>(
    py: Python<'py>,
    lengths: impl Iterator<Item = usize>,
    values: Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyAny>> {
    let ends = lengths.scan(0, |end, length| {
        *end += length as i64;
        Some(*end)
    });
    let offsets: Vec<i64> = std::iter::once(0).chain(ends).collect();
    py.import("vibrissa._ragged")?.getattr("Ragged")?.call1((PyArray1::from_vec(py, offsets), values))
}
