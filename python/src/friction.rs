//! Coefficients of friction from and to Python.

use crate::errors;
use crate::scene_tables::piece_count;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyList, PyString, PyTuple};
use rod_files::SceneFriction;
use toml::{Table, Value};
use vibrissa::contact::{Coefficients, ContactError};
use vibrissa::rod::AnyRod;
use vibrissa::{Composite, Sweep};

/// What `friction` may be, for messages.
const EXPECTED: &str =
    "expected a coefficient, such as 0.3, a tuple (at_rest, slipping), or a list with one of these for each object";

/// Coefficients as Python gives them.
#[derive(Clone, Debug)]
pub enum Given {
    /// Of all objects.
    All(Coefficients),
    /// Of each object: of all its pieces, or of each.
    Each(Vec<Vec<Coefficients>>),
}

impl<'py> FromPyObject<'py> for Given {
    fn extract_bound(object: &Bound<'py, PyAny>) -> PyResult<Self> {
        if let Some(one) = coefficients(object)? {
            return Ok(Self::All(one));
        }
        let of_object = |object: Bound<'py, PyAny>| match coefficients(&object)? {
            Some(one) => Ok(vec![one]),
            None => items(&object)?.iter().map(|piece| coefficients(piece)?.ok_or_else(|| wrong(piece))).collect(),
        };
        items(object)?.into_iter().map(of_object).collect::<PyResult<_>>().map(Self::Each)
    }
}

/// A number or a tuple of two; none for anything else.
fn coefficients(object: &Bound<'_, PyAny>) -> PyResult<Option<Coefficients>> {
    let found = if let Ok(number) = object.extract::<f64>() {
        Coefficients::equal(number)
    } else if let Ok(pair) = object.downcast::<PyTuple>() {
        let (at_rest, slipping) = pair.extract().map_err(|_| wrong(object))?;
        Coefficients { at_rest, slipping }
    } else {
        return Ok(None);
    };
    if found.are_valid() {
        return Ok(Some(found));
    }
    let rule = if object.is_instance_of::<PyTuple>() {
        "(at_rest, slipping) with 0 < slipping <= at_rest, both finite"
    } else {
        "a finite coefficient, 0 or more"
    };
    Err(errors::value(format!("friction is {}, expected {rule}", representation(object))))
}

/// The items of a list, an array or another sequence.
fn items<'py>(object: &Bound<'py, PyAny>) -> PyResult<Vec<Bound<'py, PyAny>>> {
    if object.is_instance_of::<PyString>() {
        return Err(wrong(object));
    }
    object.try_iter().map_err(|_| wrong(object))?.collect()
}

fn wrong(object: &Bound<'_, PyAny>) -> PyErr {
    PyTypeError::new_err(format!("friction is {}, {EXPECTED}", representation(object)))
}

fn representation(object: &Bound<'_, PyAny>) -> String {
    object.repr().map_or_else(|_| "something else".to_owned(), |text| text.to_string())
}

impl Given {
    /// The friction of these objects; none where all coefficients are 0, as in scene files.
    pub fn of(&self, objects: &[Composite]) -> PyResult<Option<SceneFriction>> {
        let each = match self {
            Self::All(one) => vec![vec![*one]; objects.len()],
            Self::Each(each) => each.clone(),
        };
        if each.len() != objects.len() {
            let (found, count) = (each.len(), objects.len());
            return Err(errors::value(format!("friction is a list of {found}, expected {count}: one for each object")));
        }
        for (number, (found, object)) in each.iter().zip(objects).enumerate() {
            let pieces = object.pieces();
            if found.len() != 1 && found.len() != pieces {
                return Err(errors::value(format!(
                    "friction of object {number} is a list of {}, expected {pieces}: one for each piece",
                    found.len()
                )));
            }
        }
        Ok(Some(SceneFriction::new(each)).filter(SceneFriction::rubs))
    }
}

/// The sweep, with friction if there is any.
pub fn rubbing<'a>(
    sweep: Sweep<'a, AnyRod>,
    friction: Option<&SceneFriction>,
) -> Result<Sweep<'a, AnyRod>, ContactError> {
    match friction {
        Some(friction) => sweep.with_friction(friction.clone()),
        None => Ok(sweep),
    }
}

/// As Python takes it again: a list with one item for each object.
pub fn listed<'py>(py: Python<'py>, friction: &SceneFriction) -> PyResult<Bound<'py, PyList>> {
    let one = |found: &Coefficients| -> PyResult<Bound<'py, PyAny>> {
        if found.at_rest == found.slipping {
            return Ok(found.at_rest.into_pyobject(py)?.into_any());
        }
        Ok((found.at_rest, found.slipping).into_pyobject(py)?.into_any())
    };
    let of_object = |found: &Vec<Coefficients>| -> PyResult<Bound<'py, PyAny>> {
        match &found[..] {
            [only] => one(only),
            pieces => Ok(PyList::new(py, pieces.iter().map(one).collect::<PyResult<Vec<_>>>()?)?.into_any()),
        }
    };
    PyList::new(py, friction.objects().iter().map(of_object).collect::<PyResult<Vec<_>>>()?)
}

/// Writes the friction of an object into its table of a scene file.
pub fn write(table: &mut Table, found: &[Coefficients]) -> PyResult<()> {
    let put = |table: &mut Table, one: &Coefficients| table.insert("friction".to_owned(), table_value(one));
    if let Some((first, others)) = found.split_first()
        && others.iter().all(|other| other == first)
    {
        put(table, first);
        return Ok(());
    }
    let none = || {
        errors::value(
            "friction has one coefficient for each piece of an object that scene files give only one, because it is a file, mirrored, \
             reversed, or of shapes of many pieces; expected one coefficient for the object",
        )
    };
    if ["mirror", "reversed"].iter().any(|name| table.contains_key(*name)) {
        return Err(none());
    }
    let mut rest = found;
    for piece in table.get_mut("piece").and_then(Value::as_array_mut).into_iter().flatten() {
        let piece = piece.as_table_mut().ok_or_else(none)?;
        let (own, others) = rest.split_at_checked(piece_count(piece).ok_or_else(none)?).ok_or_else(none)?;
        let first = own.first().filter(|first| own.iter().all(|other| other == *first)).ok_or_else(none)?;
        put(piece, first);
        rest = others;
    }
    if rest.is_empty() { Ok(()) } else { Err(none()) }
}

fn table_value(found: &Coefficients) -> Value {
    if found.at_rest == found.slipping {
        return Value::Float(found.at_rest);
    }
    let fields = [("at_rest", found.at_rest), ("slipping", found.slipping)];
    Value::Table(fields.into_iter().map(|(name, value)| (name.to_owned(), Value::Float(value))).collect())
}
