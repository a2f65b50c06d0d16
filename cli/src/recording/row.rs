//! One row of a recording.

use super::columns::{Columns, NAMES, SIGMA, TIME};
use csv::ByteRecord;
use std::fmt;
use vibrissa::{Pose, Reactions, Sample};

/// A row that cannot be used.
#[derive(Clone, Debug, PartialEq)]
pub struct RowFault {
    /// Its line in the file, from 1.
    pub line: u64,
    /// Where the clamp was, where the row tells it.
    pub pose: Option<Pose>,
    /// What is wrong.
    pub problem: RowProblem,
}

impl fmt::Display for RowFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {}: {}", self.line, self.problem)
    }
}

/// What is wrong with a row.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RowProblem {
    /// Too few cells, or too many.
    #[error("the number of cells is {found}, expected {expected}")]
    Cells {
        /// How many there are.
        found: usize,
        /// How many columns there are.
        expected: usize,
    },
    /// A cell that is no number.
    #[error("{column} is `{text}`, expected a number")]
    NoNumber {
        /// Name of its column.
        column: &'static str,
        /// What is written there, cut where it is long.
        text: String,
    },
    /// A number that is none.
    #[error("{column} is {value}, expected a finite number")]
    NotFinite {
        /// Name of its column.
        column: &'static str,
        /// Its value.
        value: f64,
    },
    /// A standard deviation that is none.
    #[error("{column} is {value}, expected a positive number")]
    NoSigma {
        /// Name of its column.
        column: &'static str,
        /// Its value.
        value: f64,
    },
    /// The clamp stands where it stood in the last usable row.
    #[error("the pose of line {of} is repeated, expected a clamp that moves")]
    Repeated {
        /// Line of that row.
        of: u64,
    },
    /// The clamp comes back.
    #[error("the pose turns back behind that of line {of}, expected a clamp that goes on in one direction")]
    TurnsBack {
        /// Line of the last usable row.
        of: u64,
    },
}

impl RowProblem {
    /// Its kind, in few words.
    pub(crate) fn name(&self) -> &'static str {
        match self {
            Self::Cells { .. } => "number of cells",
            Self::NoNumber { .. } => "no number",
            Self::NotFinite { .. } => "not finite",
            Self::NoSigma { .. } => "no standard deviation",
            Self::Repeated { .. } => "pose repeated",
            Self::TurnsBack { .. } => "turns back",
        }
    }
}

/// Most characters of a cell that are shown.
const MOST_SHOWN: usize = 24;

/// A cell without blanks and quotes around it.
pub(super) fn plain(cell: &[u8]) -> &[u8] {
    let cell = cell.trim_ascii();
    match cell {
        [b'"', inner @ .., b'"'] => inner.trim_ascii(),
        _ => cell,
    }
}

/// The sample, but for its place in the travel; or its problem, with the pose where there is one.
pub(super) fn sample(row: &ByteRecord, columns: &Columns) -> Result<Sample, (Option<Pose>, RowProblem)> {
    let extra = row.iter().skip(columns.width).any(|cell| !plain(cell).is_empty());
    if row.len() < columns.width || extra {
        return Err((None, RowProblem::Cells { found: row.len(), expected: columns.width }));
    }
    let mut values = [0.0; NAMES.len()];
    let mut problem = None;
    for (i, place) in columns.present() {
        match number(row.get(place).unwrap_or_default(), i) {
            Ok(value) => values[i] = value,
            // The pose, which is first, is as good as nothing if one part of it is missing.
            Err(what) if i < 3 => return Err((None, what)),
            Err(what) => problem = problem.or(Some(what)),
        }
    }
    let [x, y, phi, f0x, f0y, m0z, sigma_f0x, sigma_f0y, sigma_m0z, t] = values;
    let pose = Pose { x, y, phi };
    if let Some(problem) = problem {
        return Err((Some(pose), problem));
    }
    Ok(Sample {
        t: columns.has(TIME).then_some(t),
        pose,
        reactions: Reactions { f0x, f0y, m0z },
        sigma: columns.has(SIGMA).then_some(Reactions { f0x: sigma_f0x, f0y: sigma_f0y, m0z: sigma_m0z }),
    })
}

fn number(cell: &[u8], i: usize) -> Result<f64, RowProblem> {
    let column = NAMES[i].0;
    let cell = plain(cell);
    let Some(value) = std::str::from_utf8(cell).ok().and_then(|text| text.parse::<f64>().ok()) else {
        let text = String::from_utf8_lossy(cell).chars().take(MOST_SHOWN).collect();
        return Err(RowProblem::NoNumber { column, text });
    };
    if !value.is_finite() {
        return Err(RowProblem::NotFinite { column, value });
    }
    if (SIGMA..TIME).contains(&i) && value <= 0.0 {
        return Err(RowProblem::NoSigma { column, value });
    }
    Ok(value)
}
