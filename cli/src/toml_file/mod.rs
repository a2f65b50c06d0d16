//! TOML files: read, turned into something, and complained about with the place of what is wrong.

mod angle;
mod error;
mod number;

pub(crate) use error::{Fault, Source, place_of};
pub use error::{Invalid, SceneError};
pub(crate) use number::comma_in_list;

use std::path::Path;
use toml::Spanned;
use toml::de::DeTable;

/// The text of the file, which should be `what`, as in "the scene".
pub(crate) fn text(what: &'static str, file: &Path) -> Result<String, SceneError> {
    std::fs::read_to_string(file).map_err(|source| SceneError::Unreadable { what, file: file.to_path_buf(), source })
}

/// What `check` makes of the text, as a tree of values that know where they stand. `file` names it in messages.
pub(crate) fn parse<T>(
    file: &Path,
    text: &str,
    check: impl FnOnce(Spanned<DeTable<'_>>) -> Result<T, Fault>,
) -> Result<T, SceneError> {
    parse_angles(file, text, check).map(|(checked, _)| checked)
}

/// The same, with a warning for each angle that looks like radians or turns the clamp more than twice.
pub(crate) fn parse_angles<T>(
    file: &Path,
    text: &str,
    check: impl FnOnce(Spanned<DeTable<'_>>) -> Result<T, Fault>,
) -> Result<(T, Vec<String>), SceneError> {
    let table = DeTable::parse(text).map_err(|error| Fault::of_syntax(error, text).in_text(file, text, None))?;
    let in_text = |fault: Fault| fault.in_text(file, text, Some(table.get_ref()));
    let checked = check(table.clone()).map_err(in_text)?;
    let warnings = angle::suspicious(table.get_ref(), text).into_iter().map(|fault| in_text(fault).to_string());
    Ok((checked, warnings.collect()))
}
