//! Why a table is no film.

use std::path::PathBuf;
use vibrissa::reconstruct::RestError;
use vibrissa::rod::RodError;

/// Why a table is no film.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FilmError {
    /// The file cannot be read, or is no table.
    #[error("cannot read the frames {}: {source}", file.display())]
    Unreadable {
        /// Which file.
        file: PathBuf,
        /// Why.
        source: csv::Error,
    },
    /// A column is missing.
    #[error("{}:1: no column {missing}, found {found}; expected {expected}", file.display())]
    Missing {
        /// Which file.
        file: PathBuf,
        /// Which column.
        missing: String,
        /// All there are.
        found: String,
        /// What a table has.
        expected: &'static str,
    },
    /// Columns that no rod of this length has.
    #[error("{}: {}", file.display(), faults.join("\n"))]
    Columns {
        /// Which file.
        file: PathBuf,
        /// Each with its name and what was expected.
        faults: Vec<String>,
    },
    /// Columns in N and N m, of a rod whose forces are known in E I / L^2 only.
    #[error(
        "{}:1: the columns {columns} are in N and N m, but the rod has no stiffness; expected bending_stiffness, or diameter and youngs_modulus, in its \
         table [rod]",
        file.display()
    )]
    NoStiffness {
        /// Which file.
        file: PathBuf,
        /// Which columns.
        columns: String,
    },
    /// A sensor is said to be turned or at a lever, but no table has its numbers.
    #[error("{}:1: no column of Fx, Fy, Fz, Tx, Ty, Tz, so that the mounting of the sensor (--setup) has no effect; expected one, or no mounting", file.display())]
    NoSensor {
        /// Which file should have them.
        file: PathBuf,
    },
    /// Rows that cannot be used, the first ones.
    #[error("{}: {}", file.display(), faults.join("\n"))]
    Rows {
        /// Which file.
        file: PathBuf,
        /// Each with its line, value and what was expected.
        faults: Vec<String>,
    },
    /// There is no row.
    #[error("{}: no frame, expected rows below the names of the columns", file.display())]
    Empty {
        /// Which file.
        file: PathBuf,
    },
    /// The frames of the free rod give no shape at rest.
    #[error("{}: {source}", file.display())]
    Rest {
        /// Which file.
        file: PathBuf,
        /// Why.
        source: AtRestError,
    },
}

/// Why frames of the free rod give no shape at rest.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum AtRestError {
    /// No curvature explains them.
    #[error(transparent)]
    Shape(#[from] RestError),
    /// The curvature is none that a rod can have.
    #[error(transparent)]
    Rod(#[from] RodError),
}
