//! What a study changes.

use super::document::{ParameterTable, SetTable};
use super::field::SceneField;
use crate::toml_file::Fault;
use toml::Spanned;

/// A number that takes several values, and the numbers of the scene that follow it.
#[derive(Clone, Debug)]
pub(super) struct Parameter {
    pub name: String,
    pub values: Vec<f64>,
    pub set: Vec<Set>,
}

/// A number of the scene: offset + scale * value.
#[derive(Clone, Debug)]
pub(super) struct Set {
    pub field: SceneField,
    pub offset: f64,
    pub scale: f64,
}

/// Most values of a parameter.
const MOST: usize = 10_000_000;

impl Parameter {
    pub fn new(table: &Spanned<ParameterTable>) -> Result<Self, Fault> {
        let ParameterTable { name, set, .. } = table.get_ref();
        let text = name.get_ref();
        let plain = |c: char| c.is_ascii_alphanumeric() || c == '_';
        if text.is_empty() || !text.chars().all(plain) {
            let message = format!("the name is {text:?}, expected letters, digits and _: it is the name of a column");
            return Err(Fault::new(name.span(), message));
        }
        if set.is_empty() {
            return Err(Fault::new(table.span(), "`set` is empty, expected a field of the scene at least".to_owned()));
        }
        let set = set.iter().map(setting).collect::<Result<_, _>>()?;
        Ok(Self { name: text.clone(), values: values(table)?, set })
    }
}

fn values(table: &Spanned<ParameterTable>) -> Result<Vec<f64>, Fault> {
    let ParameterTable { values, from, to, count, .. } = table.get_ref();
    match (values, from, to, count) {
        (Some(values), None, None, None) => {
            if values.get_ref().is_empty() {
                return Err(Fault::new(values.span(), "no values, expected at least one".to_owned()));
            }
            match values.get_ref().iter().find(|value| !value.is_finite()) {
                Some(value) => Err(Fault::new(values.span(), format!("a value is {value}, expected finite numbers"))),
                None => Ok(values.get_ref().clone()),
            }
        }
        (None, Some(from), Some(to), Some(count)) => {
            for end in [from, to] {
                if !end.get_ref().is_finite() {
                    return Err(Fault::new(end.span(), format!("it is {}, expected a finite number", end.get_ref())));
                }
            }
            let n = *count.get_ref();
            if !(2..=MOST).contains(&n) {
                return Err(Fault::new(count.span(), format!("count is {n}, expected a number from 2 to {MOST}")));
            }
            let (from, to, last) = (from.get_ref(), to.get_ref(), (n - 1) as f64);
            // both ends exactly
            Ok((0..n).map(|k| (from * (n - 1 - k) as f64 + to * k as f64) / last).collect())
        }
        _ => Err(Fault::new(table.span(), "expected either `values`, or `from`, `to` and `count`".to_owned())),
    }
}

fn setting(table: &Spanned<SetTable>) -> Result<Set, Fault> {
    let SetTable { field, offset, scale } = table.get_ref();
    let no_field = || {
        let message = format!(
            "the field is {:?}, expected a name such as contour.piece[1].vertex[2], with numbers from 1",
            field.get_ref()
        );
        Fault::new(field.span(), message)
    };
    for (what, value) in [("offset", offset), ("scale", scale)] {
        if !value.is_finite() {
            return Err(Fault::new(table.span(), format!("{what} is {value}, expected a finite number")));
        }
    }
    Ok(Set { field: SceneField::parse(field.get_ref()).ok_or_else(no_field)?, offset: *offset, scale: *scale })
}
