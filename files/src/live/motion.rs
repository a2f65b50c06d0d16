//! The motion of the clamp in a live scan.

use super::error::LiveError;
use super::stage::StageSpec;
use crate::ReadOptions;
use std::path::Path;
use vibrissa::hw::recording::{Role, Table};
use vibrissa::hw::{ConstantSpeed, StageError, StageSource, StageTable};
use vibrissa::{ClampPath, Pose};

/// How the clamp moves.
#[derive(Clone, Debug)]
pub(super) enum Motion {
    /// Given by the samples.
    Told,
    /// At constant speed along a path.
    Constant(ConstantSpeed),
    /// From a table.
    Table(StageTable),
    /// At one place, at all times.
    Standing(Pose),
}

impl Motion {
    /// The motion of a `spec`; a constant speed starts at time `start` (s), and `delay` (s) is added to the times of a table.
    pub fn new(
        spec: Option<&StageSpec>,
        path: Option<&ClampPath>,
        start: f64,
        delay: f64,
        how: &ReadOptions,
    ) -> Result<Self, LiveError> {
        match (spec, path) {
            (None, _) => Ok(Self::Told),
            (Some(StageSpec::Constant(_)), None) => Err(LiveError::NoPath),
            (Some(StageSpec::Constant(speed)), Some(path)) => {
                let duration = path.length() / speed;
                let motion = ConstantSpeed::within(path.at(0.0), path.at(path.length()), start, start + duration);
                Ok(Self::Constant(motion.map_err(LiveError::Stage)?))
            }
            (Some(StageSpec::Table(file)), _) => Ok(Self::Table(table(file, delay, how)?)),
        }
    }

    /// Time of arrival, s; infinite where that is not known.
    pub fn end(&self) -> f64 {
        match self {
            Self::Told | Self::Standing(_) => f64::INFINITY,
            Self::Constant(motion) => motion.motion().1,
            Self::Table(table) => table.rows().last().map_or(f64::INFINITY, |row| row.0),
        }
    }
}

impl StageSource for Motion {
    fn pose_at(&mut self, t: f64) -> Result<Pose, StageError> {
        match self {
            Self::Told => Err(StageError::NotFinite { t }),
            Self::Constant(motion) => motion.pose_at(t),
            Self::Table(table) => table.pose_at(t),
            Self::Standing(pose) => Ok(*pose),
        }
    }
}

/// The table of poses in a file, `delay` seconds later.
fn table(file: &Path, delay: f64, how: &ReadOptions) -> Result<StageTable, LiveError> {
    let how = how.of_stage();
    let table = Table::read(file, &how.options).map_err(LiveError::Table)?;
    let roles = [Role::Time, Role::X0, Role::Y0, Role::Phi0];
    let columns = how.columns.find(&table, &roles, &[]).map_err(LiveError::Table)?;
    let rows: Result<Vec<(f64, Pose)>, _> = table
        .rows()
        .map(|row| {
            let number = |role| columns.needed(&row, role);
            let of_line = |problem| LiveError::StageRow { file: file.to_path_buf(), line: row.line(), problem };
            let [t, x, y, phi] = roles.map(number);
            Ok::<_, LiveError>((
                t.map_err(of_line)? + delay,
                Pose { x: x.map_err(of_line)?, y: y.map_err(of_line)?, phi: phi.map_err(of_line)? },
            ))
        })
        .collect();
    let mut rows = rows?;
    // a row that is there twice says nothing else
    rows.dedup();
    StageTable::new(rows).map_err(|source| LiveError::StageTable { file: file.to_path_buf(), source })
}
