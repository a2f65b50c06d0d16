//! The files of a contour.

use super::WriteError;
use crate::figure;
use rod_files::{OutputError, Profile, Staged, write_profile_table};
use std::path::{Path, PathBuf};

/// Writes the points of contours to the CSV file `out`, and a drawing of them beside it, with the extension svg, whose
/// name is returned. Neither appears before both are complete, and neither replaces one of the `inputs`.
///
/// # Errors
/// [`WriteError`].
pub fn write_profiles(
    name: &str,
    profiles: &[Profile],
    out: &Path,
    inputs: Vec<PathBuf>,
) -> Result<PathBuf, WriteError> {
    if out.file_name().is_none_or(|file| Path::new(file).extension().is_some_and(|is| is == "svg")) {
        return Err(OutputError::Name { file: out.to_path_buf() }.into());
    }
    let figure = figure::profile(name, profiles)?;
    let (staged, file) = Staged::of_file(out)?;
    let staged = staged.keeping(inputs);
    staged.write(file, |out| write_profile_table(profiles, out))?;
    staged.write(&file.with_extension("svg"), |out| out.write_all(figure.as_bytes()))?;
    staged.publish()?;
    Ok(out.with_extension("svg"))
}
