//! The columns of a recording.

use super::RecordingError;
use std::path::Path;
use vibrissa::hw::recording::{ColumnMap, Columns, Role, Table, TableError, TableProblem};

/// What a recording must have, for messages.
pub(super) const EXPECTED: &str = "x0, y0 (m), phi0 (rad), f0x, f0y (N), m0z (N m) in any order, perhaps t (s), and perhaps all of sigma_f0x, sigma_f0y (N), sigma_m0z (N m)";

/// What else to do where some of the reactions were not measured.
const PART: &str = "; `vibrissa forces` takes a part of the reactions";

/// What else to do where there are no poses.
const STAGE: &str = "; for raw values or wrenches, --stage gives the poses";

/// What else to do where the clamp has not all coordinates.
const CONSTANT: &str = "; for an x0, y0 or phi0 that stays the same, the option --column phi0=90deg gives its value";

pub(super) const POSE: [Role; 3] = [Role::X0, Role::Y0, Role::Phi0];
pub(super) const REACTIONS: [Role; 3] = [Role::F0x, Role::F0y, Role::M0z];
pub(super) const SIGMAS: [Role; 3] = [Role::SigmaF0x, Role::SigmaF0y, Role::SigmaM0z];

/// The columns of pose, reactions, standard deviations (all or none), time, flags.
pub(super) fn find(file: &Path, table: &Table, map: &ColumnMap) -> Result<Columns, RecordingError> {
    let of_table = |error: TableError| match error.problem {
        TableProblem::Missing { missing, found, hint } => RecordingError::Missing {
            file: file.to_path_buf(),
            line: error.line.unwrap_or(1),
            // raw values and wrenches have no poses at all
            hint: match POSE.iter().filter(|role| missing.contains(role)).count() {
                3 => hint + STAGE,
                1 | 2 => hint + CONSTANT,
                0 if !REACTIONS.iter().all(|role| missing.contains(role)) => hint + PART,
                _ => hint,
            },
            missing: missing.iter().map(|role| role.name().to_owned()).collect(),
            found,
        },
        problem => RecordingError::Table(TableError { problem, ..error }),
    };
    let mut needed = [POSE, REACTIONS].concat();
    let mut welcome = vec![Role::Time, Role::Quality];
    welcome.extend(SIGMAS);
    let columns = map.find(table, &needed, &welcome).map_err(of_table)?;
    if !SIGMAS.iter().any(|role| columns.has(*role)) {
        return Ok(columns);
    }
    needed.extend(SIGMAS);
    map.find(table, &needed, &welcome[..2]).map_err(of_table)
}
