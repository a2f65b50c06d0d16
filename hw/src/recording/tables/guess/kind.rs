//! The kind of a table, by the quantities of its columns.

use super::super::role::Role;
use super::summary::ColumnSummary;
use super::words::Quantity;
use super::{Basis, Sureness};

/// The kind of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TableKind {
    /// Forces and moments beside poses of the clamp.
    Reactions,
    /// Forces and moments of a sensor, without poses.
    Wrench,
    /// Poses of the clamp with times, without forces.
    Stage,
    /// Raw values.
    Raw,
    /// Points on the rod, frame by frame.
    Frames,
    /// None of these.
    Other,
}

/// A column by its name alone.
pub(super) struct Named {
    pub quantity: Option<Quantity>,
    pub axis: Option<usize>,
    /// Where the name is one that the readers look for.
    pub role: Option<Role>,
    pub basis: Basis,
    pub unit_in_name: Option<&'static str>,
    /// Whether the caller said it.
    pub is_given: bool,
}

const WRENCH: [Role; 6] = [Role::Fx, Role::Fy, Role::Fz, Role::Tx, Role::Ty, Role::Tz];

pub(super) fn is_wrench(role: Role) -> bool {
    WRENCH.contains(&role)
}

pub(super) fn kind(columns: &[Named]) -> TableKind {
    let has = |quantity| columns.iter().any(|column| column.quantity == Some(quantity));
    let loads = has(Quantity::Force) || has(Quantity::Torque);
    let poses = has(Quantity::Position) || has(Quantity::Angle);
    match (has(Quantity::Frame), loads, poses) {
        (true, false, true) => TableKind::Frames,
        (_, true, true) => TableKind::Reactions,
        (_, true, false) => TableKind::Wrench,
        (_, false, true) => TableKind::Stage,
        _ if has(Quantity::Raw) => TableKind::Raw,
        _ => TableKind::Other,
    }
}

/// The meaning of a column in a table of this kind.
pub(super) fn role_in(kind: TableKind, column: &Named) -> Option<Role> {
    let planar = |x, y| match column.axis {
        Some(0) => Some(x),
        Some(1) => Some(y),
        _ => None,
    };
    match (kind, column.quantity?) {
        (TableKind::Frames, _) => None,
        (_, Quantity::Time) => Some(Role::Time),
        (TableKind::Reactions, Quantity::Force) => planar(Role::F0x, Role::F0y),
        (TableKind::Reactions, Quantity::Torque) => {
            (column.axis != Some(0) && column.axis != Some(1)).then_some(Role::M0z)
        }
        (TableKind::Wrench, Quantity::Force) => WRENCH[..3].get(column.axis?).copied(),
        (TableKind::Wrench, Quantity::Torque) => WRENCH[3..].get(column.axis?).copied(),
        (TableKind::Reactions | TableKind::Stage, Quantity::Position) => planar(Role::X0, Role::Y0),
        (TableKind::Reactions | TableKind::Stage, Quantity::Angle) => {
            (column.axis != Some(0) && column.axis != Some(1)).then_some(Role::Phi0)
        }
        _ => None,
    }
}

/// Meanings of columns without names: six or seven in the usual order of force/torque sensors, or that of `vibrissa simulate`.
pub(super) fn by_order(values: &[ColumnSummary]) -> Vec<Named> {
    let open = || Named {
        quantity: None,
        axis: None,
        role: None,
        basis: Basis { sureness: Sureness::Open, why: "no name".to_owned() },
        unit_in_name: None,
        is_given: false,
    };
    let timed = values.first().is_some_and(|first| first.is_growing() && first.step > 0.0);
    let rest = &values[usize::from(timed)..];
    let time = || Named {
        quantity: Some(Quantity::Time),
        basis: Basis { sureness: Sureness::Likely, why: "the first column, and it grows evenly".to_owned() },
        ..open()
    };
    let of = |(quantity, axis, sureness): (Quantity, usize, Sureness), why: &str| Named {
        quantity: Some(quantity),
        axis: Some(axis),
        basis: Basis { sureness, why: why.to_owned() },
        ..open()
    };
    // a clamp holds its angle in most scans, and moves along its first axis; no force is constant
    let posed =
        rest.len() == 6 && rest[2].is_constant() && rest[..2].iter().any(|pose| !pose.is_constant() && smooth(pose));
    let columns: Vec<Named> = match rest.len() {
        6 if posed => {
            let why = "the order x, y, angle, force x, force y, moment, and the third column is constant";
            let order = [
                (Quantity::Position, 0),
                (Quantity::Position, 1),
                (Quantity::Angle, 2),
                (Quantity::Force, 0),
                (Quantity::Force, 1),
                (Quantity::Torque, 2),
            ];
            order.map(|(quantity, axis)| of((quantity, axis, Sureness::Likely), why)).into()
        }
        6 => {
            let why = "the usual order of sensors: Fx, Fy, Fz, Tx, Ty, Tz";
            let order = [
                Quantity::Force,
                Quantity::Force,
                Quantity::Force,
                Quantity::Torque,
                Quantity::Torque,
                Quantity::Torque,
            ];
            order.into_iter().enumerate().map(|(k, quantity)| of((quantity, k % 3, Sureness::Likely), why)).collect()
        }
        3 if timed && rest.iter().all(|pose| pose.is_constant() || smooth(pose)) => {
            let why = "the order time, x, y, angle of a stage";
            let order = [(Quantity::Position, 0), (Quantity::Position, 1), (Quantity::Angle, 2)];
            order.map(|(quantity, axis)| of((quantity, axis, Sureness::Likely), why)).into()
        }
        _ => rest.iter().map(|_| open()).collect(),
    };
    timed.then(time).into_iter().chain(columns).collect()
}

/// Whether a column goes on as a stage does: all steps are about alike.
fn smooth(values: &ColumnSummary) -> bool {
    values.step > 0.0 && (values.rises == 0 || values.falls == 0) && values.longest_step < 5.0 * values.step
}
