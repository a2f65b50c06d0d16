//! One row of a recording.

use super::columns::{POSE, REACTIONS, SIGMAS};
use std::fmt;
use vibrissa::hw::Quality;
use vibrissa::hw::recording::{Columns, Role, Row, RowProblem as CellProblem};
use vibrissa::rod::Reactions;
use vibrissa::{Pose, Sample};

/// A row that cannot be used.
#[derive(Clone, Debug, PartialEq)]
pub struct RowFault {
    /// Where it is.
    pub place: Place,
    /// Where the clamp was, where the row tells it.
    pub pose: Option<Pose>,
    /// What is wrong.
    pub problem: RowProblem,
}

impl fmt::Display for RowFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.place, self.problem)
    }
}

/// What is wrong with a row.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RowProblem {
    /// A wrong number of cells, or one that is no number.
    #[error(transparent)]
    Cell(#[from] CellProblem),
    /// A standard deviation that is none.
    #[error("{column} is {value}, expected a positive number")]
    NoSigma {
        /// Name of its column.
        column: &'static str,
        /// Its value.
        value: f64,
    },
    /// Flags that speak against it.
    #[error("the sensor flagged the sample: {quality}, expected a sample without flags")]
    Flagged {
        /// The flags.
        quality: Quality,
    },
    /// The clamp stands where it stood in the last usable row.
    #[error("the pose of {of} is repeated, expected a clamp that moves")]
    Repeated {
        /// Place of that row.
        of: Place,
    },
    /// The clamp comes back.
    #[error("the pose turns back behind that of {of}, expected a clamp that goes on in one direction")]
    TurnsBack {
        /// Place of the last usable row.
        of: Place,
    },
    /// The raw values give no reactions, or nothing tells the pose of the clamp.
    #[error("{0}")]
    Sensor(String),
}

impl RowProblem {
    /// Its kind, in few words.
    pub(crate) fn name(&self) -> &'static str {
        match self {
            Self::Cell(CellProblem::Cells { .. }) => "number of cells",
            Self::Cell(CellProblem::NotFinite { .. }) => "not finite",
            Self::Cell(CellProblem::Missing { .. }) => "empty",
            Self::Cell(CellProblem::NoFlag { .. }) => "no flag",
            Self::Cell(_) => "no number",
            Self::Flagged { .. } => "flagged",
            Self::NoSigma { .. } => "no standard deviation",
            Self::Repeated { .. } => "pose repeated",
            Self::TurnsBack { .. } => "turns back",
            Self::Sensor(_) => "no reactions",
        }
    }
}

/// The sample, but for its place in the travel; or its problem, with the pose where there is one.
pub(super) fn sample(row: &Row<'_>, columns: &Columns) -> Result<Sample, (Option<Pose>, RowProblem)> {
    let number = |role| columns.needed(row, role).map_err(RowProblem::from);
    // The pose, which is first, is as good as nothing if one part of it is missing.
    let [x, y, phi] = all(POSE, number).map_err(|problem| (None, problem))?;
    let pose = Pose { x, y, phi };
    rest(row, columns, pose).map_err(|problem| (Some(pose), problem))
}

fn rest(row: &Row<'_>, columns: &Columns, pose: Pose) -> Result<Sample, RowProblem> {
    let number = |role| columns.needed(row, role).map_err(RowProblem::from);
    let [f0x, f0y, m0z] = all(REACTIONS, number)?;
    let sigma = if columns.has(Role::SigmaF0x) {
        let [f0x, f0y, m0z] = all(SIGMAS, |role| match number(role) {
            Err(RowProblem::Cell(CellProblem::Negative { value, .. })) | Ok(value @ ..=0.0) => {
                Err(RowProblem::NoSigma { column: role.name(), value })
            }
            other => other,
        })?;
        Some(Reactions { f0x, f0y, m0z })
    } else {
        None
    };
    let t = if columns.has(Role::Time) { Some(number(Role::Time)?) } else { None };
    let quality = columns.quality(row, Role::Quality)?;
    if !quality.is_usable() {
        return Err(RowProblem::Flagged { quality });
    }
    Ok(Sample { t, pose, reactions: Reactions { f0x, f0y, m0z }, sigma })
}

fn all<const N: usize>(
    roles: [Role; N],
    number: impl Fn(Role) -> Result<f64, RowProblem>,
) -> Result<[f64; N], RowProblem> {
    let mut values = [0.0; N];
    for (value, role) in values.iter_mut().zip(roles) {
        *value = number(role)?;
    }
    Ok(values)
}

/// Where a row of a recording is, counted from 1: a line of a table, or a sample of what a sensor sent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// A line of the file.
    Line(u64),
    /// A sample. In a table, rows of numbers are counted.
    Sample(u64),
}

impl Place {
    /// Several of one kind, the first of them by number: "line 3", or "lines 3, 4, 5, 6, 7 and 12 more".
    pub(super) fn several(places: &[Self], most: usize) -> String {
        let numbers: Vec<String> = places.iter().take(most).map(|place| place.number().to_string()).collect();
        let kind = places.first().map_or("line", |place| place.kind());
        let plural = if places.len() == 1 { "" } else { "s" };
        let more = places.len().saturating_sub(most);
        let more = if more > 0 { format!(" and {more} more") } else { String::new() };
        format!("{kind}{plural} {}{more}", numbers.join(", "))
    }

    fn kind(self) -> &'static str {
        match self {
            Self::Line(_) => "line",
            Self::Sample(_) => "sample",
        }
    }

    fn number(self) -> u64 {
        match self {
            Self::Line(number) | Self::Sample(number) => number,
        }
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.kind(), self.number())
    }
}
