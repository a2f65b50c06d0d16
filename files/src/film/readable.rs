//! Whether a table of points can be read.

use super::error::FilmError;
use super::options::{Ends, FilmOptions};
use super::points::points;
use super::table::Numbers;
use std::path::Path;
use vibrissa::reconstruct::ForceSettings;

/// Reads a table of points without looking for forces.
///
/// # Errors
/// [`FilmError`]: the table cannot be read, or has faults.
pub(crate) fn check_frames(file: &Path) -> Result<(), FilmError> {
    let options = FilmOptions {
        scale: 1.0,
        image: false,
        ends: Ends::Base,
        channels: None,
        mounting: None,
        rest: None,
        pole: None,
        settings: ForceSettings::default(),
    };
    points(Numbers::read(file)?, &options).map(|_| ())
}
