//! The files of a contour.

use super::{OutputError, Staged, write_csv};
use crate::{Error, Profile, figure};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// The columns of contour.csv.
const COLUMNS: [&str; 6] = ["x", "y", "tangent_angle", "curvature", "arc_length", "object"];

/// Writes the points of contours to the CSV file `out`, and a drawing of them beside it, with the extension svg, whose
/// name is returned. Neither appears before both are complete.
///
/// # Errors
/// [`Error::Output`], [`Error::Figure`].
pub fn write_profiles(name: &str, profiles: &[Profile], out: &Path) -> Result<PathBuf, Error> {
    let Some(file) = out.file_name().map(Path::new).filter(|file| file.extension().is_none_or(|is| is != "svg")) else {
        return Err(OutputError::Name { file: out.to_path_buf() }.into());
    };
    // The directory of a bare name is the empty path, which cannot be made.
    let directory = out.parent().filter(|directory| !directory.as_os_str().is_empty()).unwrap_or(".".as_ref());
    let drawing = file.with_extension("svg");
    let figure = figure::profile(name, profiles)?;
    let staged = Staged::new(directory)?;
    staged.write(file, |out| write_table(profiles, out))?;
    staged.write(&drawing, |out| out.write_all(figure.as_bytes()))?;
    staged.publish()?;
    Ok(out.with_extension("svg"))
}

/// One point a row, SI units and radians.
fn write_table(profiles: &[Profile], out: &mut dyn Write) -> io::Result<()> {
    let rows = profiles.iter().flat_map(|profile| {
        profile.points.iter().map(|point| {
            let crate::ProfilePoint { x, y, tangent_angle, curvature, arc_length } = *point;
            (x, y, tangent_angle, curvature, arc_length, profile.object)
        })
    });
    write_csv(out, &COLUMNS, rows)
}
