//! TOML files: read, turned into something, and complained about with the place of what is wrong.

mod angle;
mod error;
mod message;
mod number;
mod quantity;

pub(crate) use error::{Fault, SourceText, place_of};
pub use error::{Invalid, SceneError};
pub(crate) use message::meant;
pub(crate) use number::{comma_in_list, number, written_number};
pub(crate) use quantity::Quantities;

use std::path::Path;
use toml::Spanned;
use toml::de::DeTable;

/// The text of the file, which should be `what`, as in "the scene".
pub(crate) fn text(what: &'static str, file: &Path) -> Result<String, SceneError> {
    let unreadable = |source| SceneError::Unreadable { what, file: file.to_path_buf(), source };
    let bytes = std::fs::read(file).map_err(unreadable)?;
    // a byte of zero is text by the rules, and the sign of a binary file
    let zero = bytes.iter().position(|byte| *byte == 0);
    let wrong = std::str::from_utf8(&bytes).err().map(|error| error.valid_up_to());
    let Some(at) = wrong.into_iter().chain(zero).min() else {
        return Ok(String::from_utf8_lossy(&bytes).into_owned());
    };
    let (before, byte) = (bytes.get(..at).unwrap_or_default(), bytes.get(at).copied().unwrap_or_default());
    let line = before.iter().filter(|byte| **byte == b'\n').count() + 1;
    Err(SceneError::NoText { what, file: file.to_path_buf(), line, byte })
}

/// What `check` makes of the text, as a tree of values that know where they stand. `file` names it in messages.
pub(crate) fn parse<T>(
    file: &Path,
    text: &str,
    check: impl FnOnce(Spanned<DeTable<'_>>) -> Result<T, Fault>,
) -> Result<T, SceneError> {
    parse_angles(file, text, |_| Ok(Quantities::default()), check).map(|(checked, _)| checked)
}

/// The same of a text in which numbers may have units: `quantities` finds them.
pub(crate) fn parse_quantities<T>(
    file: &Path,
    text: &str,
    quantities: impl FnOnce(&Spanned<DeTable<'_>>) -> Result<Quantities, Fault>,
    check: impl FnOnce(Spanned<DeTable<'_>>) -> Result<T, Fault>,
) -> Result<T, SceneError> {
    parse_angles(file, text, quantities, check).map(|(checked, _)| checked)
}

/// The same, with a warning for each angle that looks like radians or turns the clamp more than twice.
pub(crate) fn parse_angles<T>(
    file: &Path,
    text: &str,
    quantities: impl FnOnce(&Spanned<DeTable<'_>>) -> Result<Quantities, Fault>,
    check: impl FnOnce(Spanned<DeTable<'_>>) -> Result<T, Fault>,
) -> Result<(T, Vec<String>), SceneError> {
    let table = DeTable::parse(text).map_err(|error| Fault::of_syntax(error, text).in_text(file, text, None))?;
    let in_text = |fault: Fault| fault.in_text(file, text, Some(table.get_ref()));
    let quantities = quantities(&table).map_err(in_text)?;
    let mut numbers = table.clone();
    quantities.put(numbers.get_mut());
    let checked = check(numbers).map_err(in_text)?;
    let warnings = angle::suspicious(table.get_ref(), text).into_iter().map(|fault| in_text(fault).to_string());
    Ok((checked, warnings.collect()))
}
