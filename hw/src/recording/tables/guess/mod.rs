//! Guesses: what the columns of a table may mean, by their names, units and values, each with its reason.
//!
//! `words` understands names, `summary` describes values, `units` guesses units, `kind` says what a table is of.

mod kind;
mod summary;
mod units;
mod words;

pub use kind::TableKind;
pub use summary::ColumnSummary;
pub use words::Quantity;

use super::column_map::{ColumnMap, is_channel, recognized};
use super::role::{Role, si};
use super::table::Table;
use kind::{Named, kind, role_in};
use words::meaning;

/// How sure a guess is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Sureness {
    /// The file says so.
    Sure,
    /// Name or values suggest it, and nothing contradicts.
    Likely,
    /// It must be answered.
    Open,
}

/// How sure something is, and why.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Basis {
    /// How sure.
    pub sureness: Sureness,
    /// Why, in words.
    pub why: String,
}

impl Basis {
    fn sure(why: impl Into<String>) -> Self {
        Self { sureness: Sureness::Sure, why: why.into() }
    }

    fn of_name(name: &str) -> Self {
        Self::sure(format!("the name `{name}`"))
    }
}

/// The possible meanings of a column.
#[derive(Clone, Debug, PartialEq)]
pub struct ColumnGuess {
    /// Its number, from 0.
    pub column: usize,
    /// The quantity, if name or values show it.
    pub quantity: Option<Quantity>,
    /// Its axis: x, y or z.
    pub axis: Option<usize>,
    /// The meaning in a table of this kind.
    pub role: Option<Role>,
    /// Why, and how sure that is.
    pub meaning: Basis,
    /// Its unit.
    pub unit: Option<&'static str>,
    /// Whether a minus before the unit turns the sign.
    pub is_turned: bool,
    /// Why, and how sure that is.
    pub unit_basis: Basis,
    /// Whether the caller said what it means.
    pub is_given: bool,
    /// Whether the readers find the column by its name.
    pub is_recognized: bool,
    /// Whether they know the unit silently.
    pub is_unit_known: bool,
    /// Whether the file or the caller says the unit: the name of the role alone does not.
    pub is_unit_written: bool,
    /// The summary of its values.
    pub values: ColumnSummary,
}

/// The possible kind of a table and meanings of its columns.
#[derive(Clone, Debug, PartialEq)]
pub struct TableGuess {
    /// Its kind.
    pub kind: TableKind,
    /// Each column, in order.
    pub columns: Vec<ColumnGuess>,
}

impl TableGuess {
    /// The column that means this.
    pub fn of(&self, role: Role) -> Option<&ColumnGuess> {
        self.columns.iter().find(|column| column.role == Some(role))
    }
}

/// What a table may be of, and what its columns may mean. `named` says whether the file names its columns, `map` what is known of
/// them.
///
/// ```
/// use rod_hw::recording::{ColumnMap, Role, Sureness, Table, TableKind, TableOptions, guess};
/// let text = "Zeit (ms);Kraft X;pos_x\n0;0,1;80\n2;0,2;79,9\n4;0,3;79,8\n";
/// let table = Table::parse("scan.csv", text.as_bytes(), &TableOptions::default())?;
/// let found = guess(&table, true, &ColumnMap::new());
/// assert_eq!(found.kind, TableKind::Reactions);
/// assert_eq!((found.columns[1].role, found.columns[1].unit), (Some(Role::F0x), None)); // N or mN?
/// assert_eq!((found.columns[2].role, found.columns[2].unit), (Some(Role::X0), Some("mm")));
/// assert_eq!(found.columns[2].unit_basis.sureness, Sureness::Likely);
/// # Ok::<(), rod_hw::recording::TableError>(())
/// ```
pub fn guess(table: &Table, named: bool, map: &ColumnMap) -> TableGuess {
    let summaries: Vec<ColumnSummary> =
        (0..table.columns().len()).map(|column| ColumnSummary::of(table, column)).collect();
    let mut named = if named { by_names(table) } else { kind::by_order(&summaries) };
    for (named, heading) in named.iter_mut().zip(table.columns()) {
        if let Some((role, _)) = map.assigned().find(|(_, name)| heading.is(name)) {
            let basis = Basis::sure("it was given");
            *named = Named {
                quantity: quantity_of(role),
                axis: None,
                role: Some(role),
                basis,
                unit_in_name: named.unit_in_name,
                is_given: true,
            };
        } else {
            named.role = named.role.filter(|role| map.assigned().all(|(assigned, _)| assigned != *role));
        }
    }
    let kind = kind(&named);
    let mut taken: Vec<Role> = map.assigned().map(|(role, _)| role).collect();
    let columns = named.into_iter().zip(summaries).enumerate().map(|(column, (named, values))| {
        let role = named.role.or_else(|| role_in(kind, &named)).filter(|role| named.is_given || !taken.contains(role));
        taken.extend(role);
        column_guess(table, column, named, role, values)
    });
    let mut columns: Vec<ColumnGuess> = columns.collect();
    if matches!(kind, TableKind::Reactions | TableKind::Stage) {
        one_unit_of_positions(table, &mut columns);
    }
    doubt_own_names(&mut columns);
    TableGuess { kind, columns }
}

/// x0 and y0 have one unit: the one that one of them states, or that both together suggest.
fn one_unit_of_positions(table: &Table, columns: &mut [ColumnGuess]) {
    let places: Vec<usize> =
        (0..columns.len()).filter(|k| matches!(columns[*k].role, Some(Role::X0 | Role::Y0))).collect();
    let &[first, second] = &places[..] else { return };
    let is_stated = |k: usize| columns[k].is_unit_written;
    let (unit, basis) = match [is_stated(first), is_stated(second)] {
        [true, true] => return,
        [false, false] => {
            let (a, b) = (&columns[first].values, &columns[second].values);
            let both = ColumnSummary {
                least: a.least.min(b.least),
                most: a.most.max(b.most),
                numbers: a.numbers + b.numbers,
                ..*a
            };
            // the range is that of each: where the origin is, does not matter
            let guess = units::of_positions(&both, a.range().max(b.range()));
            let is_si = guess.unit.is_none_or(|unit| unit == si(crate::sample::Dimension::Length));
            if is_si && columns[first].is_unit_known && columns[second].is_unit_known {
                return;
            }
            (guess.unit, guess.basis)
        }
        [first_states, _] => {
            let partner = &columns[if first_states { first } else { second }];
            let why = format!("as that of `{}`", table.columns()[partner.column].heading);
            (partner.unit, Basis { sureness: Sureness::Likely, why })
        }
    };
    for k in places {
        let column = &mut columns[k];
        if !column.is_unit_written {
            column.is_unit_known = column.is_unit_known && column.unit == unit;
            (column.unit, column.unit_basis) = (unit, basis.clone());
        }
    }
}

/// The names of roles stand for SI units: where one of them does not, the others of forces and moments may not either.
fn doubt_own_names(columns: &mut [ColumnGuess]) {
    let is_pose = |column: &&ColumnGuess| matches!(column.role, Some(Role::X0 | Role::Y0 | Role::Phi0));
    let is_bare = |column: &&ColumnGuess| column.is_recognized && !column.is_unit_written;
    let is_doubtful = columns.iter().filter(is_pose).filter(is_bare).any(|column| !column.is_unit_known);
    if !is_doubtful {
        return;
    }
    for column in columns.iter_mut() {
        if matches!(column.role, Some(Role::F0x | Role::F0y | Role::M0z))
            && column.is_unit_known
            && !column.is_unit_written
        {
            let why = "the name stands for SI, but those of the pose are not in SI".to_owned();
            (column.unit, column.is_unit_known) = (None, false);
            column.unit_basis = Basis { sureness: Sureness::Open, why };
        }
    }
}

fn by_names(table: &Table) -> Vec<Named> {
    let of = |column: &super::heading::Column| {
        let words = meaning(&column.name);
        let sure = |role: Role| Named {
            quantity: words.map(|words| words.quantity).or_else(|| quantity_of(role)),
            axis: words.and_then(|words| words.axis),
            role: Some(role),
            basis: Basis::of_name(&column.name),
            unit_in_name: None,
            is_given: false,
        };
        // a wrench beside poses is that of the clamp, and not looked for under these names
        if let Some((role, _)) = recognized(column).filter(|(role, _)| !kind::is_wrench(*role)) {
            return sure(role);
        }
        if is_channel(&column.name) {
            return Named {
                quantity: Some(Quantity::Raw),
                axis: None,
                role: None,
                basis: Basis::of_name(&column.name),
                unit_in_name: None,
                is_given: false,
            };
        }
        let why = match words {
            Some(_) => format!("the words of `{}`", column.name),
            None => String::new(),
        };
        let sureness = if words.is_some() { Sureness::Likely } else { Sureness::Open };
        Named {
            quantity: words.map(|words| words.quantity),
            axis: words.and_then(|words| words.axis),
            role: None,
            basis: Basis { sureness, why },
            unit_in_name: words.and_then(|words| words.unit),
            is_given: false,
        }
    };
    table.columns().iter().map(of).collect()
}

/// The quantity of a role.
fn quantity_of(role: Role) -> Option<Quantity> {
    use crate::sample::Dimension;
    if role.is_spread() {
        return Some(Quantity::Spread);
    }
    Some(match role.dimension() {
        Some(Dimension::Force) => Quantity::Force,
        Some(Dimension::Torque) => Quantity::Torque,
        Some(Dimension::Length) => Quantity::Position,
        Some(Dimension::Angle) => Quantity::Angle,
        Some(Dimension::Time) => Quantity::Time,
        _ => Quantity::Other,
    })
}

fn column_guess(table: &Table, column: usize, named: Named, role: Option<Role>, values: ColumnSummary) -> ColumnGuess {
    let heading = &table.columns()[column];
    let found = recognized(heading).filter(|(found, _)| Some(*found) == role);
    let is_own = role.is_some_and(|role| heading.name == role.name());
    let quantity = named.quantity.filter(|_| role.is_none_or(|role| !role.is_spread()));
    let written = heading.unit.as_deref().or(found.and_then(|found| found.1));
    let is_turned = written.is_some_and(|unit| unit.starts_with('-'));
    let written = written.map(|unit| unit.trim_start_matches('-'));
    let (unit, unit_basis, is_unit_known) = match (quantity, written) {
        (Some(Quantity::Time), Some("s")) if table.is_dated(column) => {
            (Some("s"), Basis::sure("dates and times of day are read in s"), true)
        }
        (Some(quantity), Some(text)) if quantity.dimension().is_some() => match units::of_spelling(quantity, text) {
            Some((unit, basis)) => (Some(unit), basis.clone(), basis.sureness == Sureness::Sure),
            None => {
                let why = format!(
                    "the unit `{text}` was not understood, expected one of {}",
                    quantity.dimension().map_or_else(String::new, |d| d.to_string())
                );
                (None, Basis { sureness: Sureness::Open, why }, false)
            }
        },
        (Some(quantity), _) if quantity.dimension().is_some() => match named.unit_in_name {
            Some(unit) if units::of_spelling(quantity, unit).is_some() => {
                (Some(unit), Basis::sure("it ends the name"), false)
            }
            _ => {
                let guess = units::of_values(quantity, &values);
                let own = quantity.dimension().map(si);
                // the name stands for SI, unless the values contradict
                if is_own && guess.unit.is_none_or(|unit| Some(unit) == own) {
                    (own, Basis::sure(format!("the name `{}` stands for it", heading.name)), true)
                } else {
                    (guess.unit, guess.basis, false)
                }
            }
        },
        _ => (None, Basis::sure(""), true),
    };
    ColumnGuess {
        column,
        quantity: named.quantity,
        axis: named.axis,
        role,
        meaning: if found.is_some() && !named.is_given { Basis::of_name(&heading.name) } else { named.basis },
        unit,
        is_turned,
        unit_basis,
        is_given: named.is_given,
        is_recognized: found.is_some(),
        is_unit_known,
        // a unit that is not understood says nothing
        is_unit_written: (written.is_some() && unit.is_some()) || named.unit_in_name.is_some(),
        values,
    }
}
