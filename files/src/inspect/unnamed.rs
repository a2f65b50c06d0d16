//! Columns whose names say too little: their values suggest what they may be, and each is a question.

use super::proposal::name_of;
use vibrissa::hw::recording::{Cell, ColumnGuess, ColumnMap, Quantity, Role, Sureness, Table, TableGuess, TableKind};
use vibrissa::reconstruct::noise_estimate::estimate;

/// Share of the rows that is the start, in which the rod is free, and the fewest of them.
const START: (usize, usize) = (50, 8);
/// Standard deviations of the noise within which values stay the same.
const SIGMAS: f64 = 6.0;
/// Residual of a straight line, relative to the range of the values, up to which a column is called linear.
const LINEAR: f64 = 1e-3;

/// Relative difference from the usual step, and the share of the steps that differ less: a stage has one speed most of the time, a reaction has not.
const ALIKE: (f64, f64) = (0.3, 0.6);

/// How the values of a column go on.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Behaviour {
    /// All are the same.
    Constant,
    /// They lie on a straight line over the rows, with this change per row.
    Linear(f64),
    /// They change without noise, mostly at one speed, as a coordinate of a stage.
    Smooth,
    /// They stay the same within the noise up to this row, as a reaction before the first contact.
    Rests(usize),
    /// None of these.
    Other,
}

impl Behaviour {
    fn is_of_stage(&self) -> bool {
        matches!(self, Self::Constant | Self::Linear(_) | Self::Smooth)
    }
}

/// How the values of a column go on; none with too few numbers.
pub(super) fn behaviour(table: &Table, column: &ColumnGuess) -> Option<Behaviour> {
    let number = |cell| if let Cell::Number(value) = cell { Some(value) } else { None };
    let values: Vec<f64> =
        table.rows().filter_map(|row| number(row.cell(column.column))).filter(|value| value.is_finite()).collect();
    if values.len() < START.1 {
        return None;
    }
    if column.values.is_constant() {
        return Some(Behaviour::Constant);
    }
    let range = column.values.range();
    let slope = (values[values.len() - 1] - values[0]) / (values.len() - 1) as f64;
    let line = |k: usize| values[0] + slope * k as f64;
    if values.iter().enumerate().all(|(k, value)| (value - line(k)).abs() <= LINEAR * range) {
        return Some(Behaviour::Linear(slope));
    }
    let rows: Vec<f64> = (0..values.len()).map(|k| k as f64).collect();
    let sigma = estimate(&rows, &values).sigma;
    let start = &values[..(values.len() / START.0).max(START.1)];
    let mean = start.iter().sum::<f64>() / start.len() as f64;
    let limit = SIGMAS * sigma + 1e-6 * range;
    let rest = values.iter().position(|value| (value - mean).abs() > limit).unwrap_or(0);
    // a stage reverses at few rows, noise at half of them
    let turns = values.windows(3).filter(|v| (v[1] - v[0]) * (v[2] - v[1]) < 0.0).count();
    let steps: Vec<f64> = values.windows(2).map(|v| (v[1] - v[0]).abs()).filter(|step| *step > 0.0).collect();
    let usual = steps.iter().filter(|step| (*step / column.values.step - 1.0).abs() < ALIKE.0).count();
    let has_steps_alike = usual as f64 >= ALIKE.1 * steps.len() as f64;
    if 50 * turns <= values.len() && has_steps_alike && column.values.repeats * 2 < values.len() {
        return Some(Behaviour::Smooth);
    }
    Some(if rest >= start.len() { Behaviour::Rests(rest) } else { Behaviour::Other })
}

/// In words, with the times of the rows where these are known, s.
pub(super) fn behaviour_text(behaviour: &Behaviour, times: Option<&[f64]>) -> String {
    let time = |row: usize| times.and_then(|times| times.get(row)).filter(|time| time.is_finite());
    match behaviour {
        Behaviour::Constant => "constant".to_owned(),
        Behaviour::Linear(slope) => {
            let step = times
                .filter(|times| times.len() > 1)
                .map(|times| (times[times.len() - 1] - times[0]) / (times.len() - 1) as f64);
            match step.filter(|step| *step > 0.0) {
                Some(step) => format!("linear, {:.4e} per second", slope / step),
                None => format!("linear, {slope:.4e} per row"),
            }
        }
        Behaviour::Smooth => "smooth".to_owned(),
        Behaviour::Rests(row) => match time(*row) {
            Some(time) => format!("at rest until {time:.3} s"),
            None => format!("at rest for {row} rows"),
        },
        Behaviour::Other => "changes from the start".to_owned(),
    }
}

/// A meaning that is supposed, and why.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Supposed {
    pub role: Role,
    pub column: usize,
    pub why: String,
}

/// What columns without a meaning may be, in the order of the table; nothing where all that is needed is known, or nothing suggests it.
pub(super) fn suppose(table: &Table, guess: &TableGuess) -> Vec<Supposed> {
    if guess.kind == TableKind::Frames {
        return Vec::new();
    }
    let free: Vec<(&ColumnGuess, Option<Behaviour>)> = guess
        .columns
        .iter()
        .filter(|column| column.role.is_none() && column.values.numbers > 0)
        .filter(|column| {
            !matches!(column.quantity, Some(Quantity::Other | Quantity::Spread | Quantity::Raw | Quantity::Frame))
        })
        .map(|column| (column, behaviour(table, column)))
        .collect();
    let has = |role: Role| guess.of(role).is_some();
    let is_load = |column: &ColumnGuess| matches!(column.quantity, Some(Quantity::Force | Quantity::Torque));
    let is_pose = |column: &ColumnGuess| matches!(column.quantity, Some(Quantity::Position | Quantity::Angle));
    let loads = guess.columns.iter().any(is_load)
        || free.iter().any(|(column, of)| {
            column.quantity.is_none() && matches!(of, Some(Behaviour::Rests(_) | Behaviour::Other))
        });
    let poses = guess.columns.iter().any(is_pose)
        || free.iter().any(|(column, of)| {
            column.quantity.is_none() && !column.values.is_growing() && of.as_ref().is_some_and(Behaviour::is_of_stage)
        });
    let mut found: Vec<Supposed> = Vec::new();
    let mut take = |role: Role, why: &str, may: &dyn Fn(&ColumnGuess, Option<&Behaviour>) -> bool| {
        if has(role) || found.iter().any(|one| one.role == role) {
            return;
        }
        let is_free = |column: &ColumnGuess, found: &[Supposed]| found.iter().all(|one| one.column != column.column);
        if let Some((column, _)) = free.iter().find(|(column, of)| is_free(column, &found) && may(column, of.as_ref()))
        {
            found.push(Supposed { role, column: column.column, why: why.to_owned() });
        }
    };
    let unknown = |column: &ColumnGuess| column.quantity.is_none();
    take(Role::Time, "it grows evenly", &|column, of| {
        (unknown(column) || column.quantity == Some(Quantity::Time))
            && column.values.is_growing()
            && (matches!(of, Some(Behaviour::Linear(_))) || column.quantity == Some(Quantity::Time))
    });
    let named = "the name has no axis, and the order of the columns suggests it";
    if poses {
        for role in [Role::X0, Role::Y0] {
            take(role, named, &|column, _| {
                column.quantity == Some(Quantity::Position) && axis_fits(column, role == Role::Y0)
            });
            take(role, "its values are those of a stage", &|column, of| {
                unknown(column) && of.is_some_and(Behaviour::is_of_stage)
            });
        }
        take(Role::Phi0, named, &|column, _| column.quantity == Some(Quantity::Angle));
        take(Role::Phi0, "its values are those of a stage", &|column, of| {
            unknown(column) && of.is_some_and(Behaviour::is_of_stage)
        });
    }
    if loads {
        let [x, y, moment] = if poses { [Role::F0x, Role::F0y, Role::M0z] } else { [Role::Fx, Role::Fy, Role::Tz] };
        let may_load = |of: Option<&Behaviour>| matches!(of, Some(Behaviour::Rests(_) | Behaviour::Other));
        // one name of a force among others that are not known, as `f` in a, b, c, d, e, f, g, means nothing
        let forces = free.iter().filter(|(column, _)| column.quantity == Some(Quantity::Force)).count();
        for role in [x, y] {
            if forces > 1 || has(x) || has(y) {
                take(role, named, &|column, _| {
                    column.quantity == Some(Quantity::Force) && axis_fits(column, role == y)
                });
            }
            take(role, "its values are those of a reaction", &|column, of| {
                (unknown(column) || column.quantity == Some(Quantity::Force) && forces == 1) && may_load(of)
            });
        }
        take(moment, named, &|column, _| column.quantity == Some(Quantity::Torque));
        take(moment, "its values are those of a reaction", &|column, of| unknown(column) && may_load(of));
    }
    // nothing is asked of a table of which hardly anything is understood
    let is_enough = guess.columns.iter().filter(|column| column.role.is_some()).count() + found.len() >= 3;
    if is_enough { found } else { Vec::new() }
}

/// Whether the axis of a column, if its name has one, is this one.
fn axis_fits(column: &ColumnGuess, is_y: bool) -> bool {
    column.axis.is_none_or(|axis| axis == usize::from(is_y))
}

/// The map with the meanings that are supposed.
pub(super) fn with_supposed(map: &ColumnMap, table: &Table, supposed: &[Supposed]) -> ColumnMap {
    supposed.iter().fold(map.clone(), |map, one| map.with(one.role, name_of(table, one.column)))
}

/// Marks the meanings that are supposed as open.
pub(super) fn mark_open(guess: &mut TableGuess, supposed: &[Supposed]) {
    for one in supposed {
        let column = &mut guess.columns[one.column];
        column.meaning.sureness = Sureness::Open;
        column.meaning.why.clone_from(&one.why);
    }
}
