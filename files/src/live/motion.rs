//! The motion of the clamp in a live scan.

use super::error::LiveError;
use super::scan::LiveScan;
use super::stage::StageSpec;
use crate::ReadOptions;
use std::path::Path;
use vibrissa::Pose;
use vibrissa::hw::recording::{Role, Table};
use vibrissa::hw::{ConstantSpeed, StageError, StageSource, StageTable};

/// Times (s) beyond which a clock counts from 1970: the year 2001. No clock that begins with the recording gets there.
const SINCE_1970: f64 = 1e9;

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
    /// The motion of a scan. A constant speed starts at time `start` (s). The delay of the scan is added to the times of a table; if they
    /// count from 1970 and the time 0 of the sensor is at `epoch` (s since 1970), this is subtracted.
    pub fn new(scan: &LiveScan, start: f64, epoch: Option<f64>) -> Result<Self, LiveError> {
        match (&scan.stage, &scan.path) {
            (None, _) => Ok(Self::Told),
            (Some(StageSpec::Constant(_)), None) => Err(LiveError::NoPath),
            (Some(StageSpec::Constant(speed)), Some(path)) => {
                let duration = path.length() / speed;
                let motion = ConstantSpeed::within(path.at(0.0), path.at(path.length()), start, start + duration);
                Ok(Self::Constant(motion.map_err(LiveError::Stage)?))
            }
            (Some(StageSpec::Table(file)), _) => {
                let delay = scan.delay().unwrap_or_default().seconds();
                Ok(Self::Table(table(file, delay, epoch, &scan.read)?))
            }
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

/// What is subtracted from the times of a stage, of which the first is `first` (s), on the clock of a sensor whose time 0 is at `epoch` (s since 1970).
pub(crate) fn origin_of(first: f64, epoch: Option<f64>) -> f64 {
    epoch.filter(|_| first > SINCE_1970).unwrap_or(0.0)
}

/// The table of poses in a file, `delay` seconds later.
fn table(file: &Path, delay: f64, epoch: Option<f64>, how: &ReadOptions) -> Result<StageTable, LiveError> {
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
                t.map_err(of_line)?,
                Pose { x: x.map_err(of_line)?, y: y.map_err(of_line)?, phi: phi.map_err(of_line)? },
            ))
        })
        .collect();
    let mut rows = rows?;
    let origin = origin_of(rows.first().map_or(0.0, |row| row.0), epoch);
    rows.iter_mut().for_each(|(t, _)| *t += delay - origin);
    // a row that is there twice says nothing else
    rows.dedup();
    StageTable::new(rows).map_err(|source| LiveError::StageTable { file: file.to_path_buf(), source })
}
