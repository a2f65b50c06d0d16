//! The numbers of a table in SI units, by the guesses of its columns.

use vibrissa::hw::Unit;
use vibrissa::hw::recording::{Cell, ColumnGuess, Role, Row, Table, TableGuess};
use vibrissa::rod::Reactions;
use vibrissa::{Pose, Sample};

/// What one of the column's unit is in SI, with its sign; 1 where the unit is not known.
pub(super) fn factor(column: &ColumnGuess) -> f64 {
    let sign = if column.is_turned { -1.0 } else { 1.0 };
    sign * column.unit.and_then(Unit::find).map_or(1.0, |unit| unit.factor)
}

/// The column of a role in SI units, NaN where a row has no number or is not of the scan; none where there is no such column.
pub(super) fn channel(table: &Table, guess: &TableGuess, role: Role) -> Option<Vec<f64>> {
    let column = guess.of(role)?;
    let factor = factor(column);
    let number = |(row, is_of_scan): (Row<'_>, bool)| match row.cell(column.column) {
        Cell::Number(value) if is_of_scan => factor * value,
        _ => f64::NAN,
    };
    Some(table.rows().zip(of_scan(table, guess)).map(number).collect())
}

/// Whether each row is of the scan: none is that the readers leave out for a text in a column that they read, as those of means below a table.
pub(super) fn of_scan(table: &Table, guess: &TableGuess) -> Vec<bool> {
    let read = |column: &&ColumnGuess| column.role.is_some_and(|role| role.dimension().is_some());
    let columns: Vec<usize> = guess.columns.iter().filter(read).map(|column| column.column).collect();
    let is_of_scan = |row: Row<'_>| columns.iter().all(|column| !matches!(row.cell(*column), Cell::Text(_)));
    table.rows().map(is_of_scan).collect()
}

/// Poses of all rows that have one.
pub(super) fn poses(table: &Table, guess: &TableGuess) -> Option<Vec<Pose>> {
    let [x, y, phi] = [Role::X0, Role::Y0, Role::Phi0].map(|role| channel(table, guess, role));
    let (x, y, phi) = (x?, y?, phi?);
    let poses = x.into_iter().zip(y).zip(phi).map(|((x, y), phi)| Pose { x, y, phi });
    Some(poses.filter(|pose| pose.x.is_finite() && pose.y.is_finite() && pose.phi.is_finite()).collect())
}

/// Samples of all rows that are complete.
pub(super) fn samples(table: &Table, guess: &TableGuess) -> Option<Vec<Sample>> {
    let of = |role| channel(table, guess, role);
    let (x, y, phi) = (of(Role::X0)?, of(Role::Y0)?, of(Role::Phi0)?);
    let (f0x, f0y, m0z) = (of(Role::F0x)?, of(Role::F0y)?, of(Role::M0z)?);
    let all = (0..table.len()).map(|k| {
        let pose = Pose { x: x[k], y: y[k], phi: phi[k] };
        Sample::new(pose, Reactions { f0x: f0x[k], f0y: f0y[k], m0z: m0z[k] })
    });
    let is_complete = |sample: &Sample| {
        let Reactions { f0x, f0y, m0z } = sample.reactions;
        [sample.pose.x, sample.pose.y, sample.pose.phi, f0x, f0y, m0z].iter().all(|value| value.is_finite())
    };
    Some(all.filter(is_complete).collect())
}
