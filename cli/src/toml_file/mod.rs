//! TOML files: read, turned into something, and complained about with the place of what is wrong.

mod error;

pub(crate) use error::{Fault, place_of};
pub use error::{Invalid, SceneError};

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
    let table = DeTable::parse(text).map_err(|error| Fault::from(error).in_text(file, text, None))?;
    check(table.clone()).map_err(|fault| fault.in_text(file, text, Some(table.get_ref())))
}
