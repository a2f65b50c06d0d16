//! The meanings of the columns of a table, by name or as given by the caller.

use super::columns::{Columns, Place};
use super::error::{TableError, TableProblem, listed};
use super::heading::Column;
use super::role::{Role, si};
use super::table::Table;
use crate::sample::{Channels, Dimension, Unit, UnitError};
use std::fmt::Write;

/// Which column means what. Without a word, columns are found by the names of roles; what is said here goes before.
///
/// ```
/// use rod_hw::recording::{ColumnMap, Role, Table, TableOptions};
/// use rod_hw::RawSample;
/// let text = b"Zeit (ms)\tDMS 1 (V)\tDMS 2 (V)\n0\t0.5\t-0.25\n2\t0.6\t-0.25\n";
/// let table = Table::parse("volts.tsv", text, &TableOptions::default())?;
/// let map = ColumnMap::new().with(Role::Time, "Zeit").with_channels(["DMS 1", "DMS 2"]);
/// let samples = table.samples::<RawSample>(&map)?.collect::<Result<Vec<_>, _>>()?;
/// assert_eq!((samples[1].host_time, &samples[1].channels[..]), (2e-3, &[0.6, -0.25][..]));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ColumnMap {
    assigned: Vec<(Role, String)>,
    channels: Option<Vec<String>>,
}

/// A column that may be meant, and its unit.
type Candidate<'t> = (usize, Option<&'t str>);

impl ColumnMap {
    /// Everything by its names.
    pub fn new() -> Self {
        Self::default()
    }

    /// The column of this name or heading is it.
    #[must_use]
    pub fn with(mut self, role: Role, name: impl Into<String>) -> Self {
        self.assigned.push((role, name.into()));
        self
    }

    /// These columns are the raw values, in this order, as they are: units do not matter to them. By default those named channel,
    /// ch, SG, gauge or voltage and a number, in the order of the file.
    #[must_use]
    pub fn with_channels<S: Into<String>>(mut self, names: impl IntoIterator<Item = S>) -> Self {
        self.channels = Some(names.into_iter().map(Into::into).collect());
        self
    }

    /// The given meanings with the names of their columns.
    pub fn assigned(&self) -> impl Iterator<Item = (Role, &str)> {
        self.assigned.iter().map(|(role, name)| (*role, name.as_str()))
    }

    /// Looks for columns: those that are needed, those that are welcome, and the channels.
    ///
    /// # Errors
    /// [`TableError`]. A column that is welcome, but goes by another than its own name and has no unit, is left out.
    pub fn find(&self, table: &Table, needed: &[Role], welcome: &[Role]) -> Result<Columns, TableError> {
        let mut columns = Columns::new(table.columns().len());
        let mut missing = Vec::new();
        let of_both = needed.iter().map(|role| (*role, true)).chain(welcome.iter().map(|role| (*role, false)));
        for (role, is_needed) in of_both {
            let assigned = self.assigned.iter().find(|(assigned, _)| *assigned == role);
            let candidate = match assigned {
                Some((_, name)) => Some(self.named(table, name)?),
                None => by_names(table, role)?,
            };
            match candidate {
                Some(candidate) => {
                    let strict = is_needed || assigned.is_some();
                    if let Some(place) = place(table, role, candidate, strict)? {
                        columns.set(role, place);
                    }
                }
                None if is_needed => missing.push(role),
                None => {}
            }
        }
        if !missing.is_empty() {
            let (found, hint) = (found(table), hint(table, &missing));
            return Err(of(table, TableProblem::Missing { missing, found, hint }));
        }
        columns.channels = self.find_channels(table)?;
        Ok(columns)
    }

    fn named<'t>(&self, table: &'t Table, name: &str) -> Result<Candidate<'t>, TableError> {
        let all = table.columns();
        // the whole heading tells columns apart whose names are the same without units
        let whole = |column: &Column| column.heading == name;
        let exact = all.iter().filter(|column| whole(column)).count() == 1;
        let is = |column: &Column| if exact { whole(column) } else { column.is(name) };
        let mut matching = all.iter().enumerate().filter(|(_, column)| is(column));
        match (matching.next(), matching.next()) {
            (Some((at, column)), None) => Ok((at, column.unit.as_deref())),
            (Some((_, first)), Some((_, second))) => Err(twice(table, first, second)),
            (None, _) => Err(of(table, TableProblem::NoSuchColumn { name: name.to_owned(), found: found(table) })),
        }
    }

    fn find_channels(&self, table: &Table) -> Result<Vec<usize>, TableError> {
        let channels: Vec<usize> = match &self.channels {
            Some(names) => {
                names.iter().map(|name| self.named(table, name).map(|(at, _)| at)).collect::<Result<_, _>>()?
            }
            None => {
                let all = table.columns().iter().enumerate();
                all.filter(|(_, column)| is_channel(&column.name)).map(|(at, _)| at).collect()
            }
        };
        if channels.len() > Channels::MOST {
            return Err(of(table, TableProblem::TooManyChannels { count: channels.len() }));
        }
        Ok(channels)
    }
}

/// All columns there are.
pub(super) fn found(table: &Table) -> String {
    listed(table.columns().iter().map(|column| column.heading.as_str()))
}

/// At the line of the names.
pub(super) fn of(table: &Table, problem: TableProblem) -> TableError {
    problem.at(table.file(), table.header_line())
}

fn twice(table: &Table, first: &Column, second: &Column) -> TableError {
    of(table, TableProblem::Twice { name: first.heading.clone(), other: second.heading.clone() })
}

/// The column that goes by the role's own name, or else by one of the others; also with a unit after it, as `Fx_mN`.
fn by_names(table: &Table, role: Role) -> Result<Option<Candidate<'_>>, TableError> {
    for names in [std::slice::from_ref(&role.name()), role.aliases()] {
        let mut matching = table
            .columns()
            .iter()
            .enumerate()
            .filter_map(|(at, column)| unit_under(column, names, role).map(|unit| (at, unit)));
        if let Some(first) = matching.next() {
            let columns = table.columns();
            return match matching.next() {
                Some(second) => Err(twice(table, &columns[first.0], &columns[second.0])),
                None => Ok(Some(first)),
            };
        }
    }
    Ok(None)
}

/// The unit of a column that goes by one of these names, if it has one; `None` if it goes by another name.
fn unit_under<'c>(column: &'c Column, names: &[&str], role: Role) -> Option<Option<&'c str>> {
    names.iter().find_map(|name| {
        let rest = column.name.strip_prefix(name)?;
        if rest.is_empty() {
            return Some(column.unit.as_deref());
        }
        let unit = rest.strip_prefix('_').filter(|_| column.unit.is_none())?;
        role.dimension().and_then(|dimension| Unit::parse(unit, dimension).ok()).map(|_| Some(unit))
    })
}

/// The role that a column is found by, and its unit if it has one, silently in a map.
pub(super) fn recognized(column: &Column) -> Option<(Role, Option<&str>)> {
    let under = |names: fn(Role) -> &'static [&'static str]| {
        Role::all().find_map(|role| unit_under(column, names(role), role).map(|unit| (role, unit)))
    };
    let own = Role::all().find_map(|role| unit_under(column, &[role.name()], role).map(|unit| (role, unit)));
    own.or_else(|| under(Role::aliases))
}

/// The column with the factor of its unit; `None` if it is better left out.
fn place(table: &Table, role: Role, candidate: Candidate<'_>, strict: bool) -> Result<Option<Place>, TableError> {
    let (at, unit) = candidate;
    let Some(dimension) = role.dimension() else {
        return Ok(Some(Place { at, factor: 1.0 }));
    };
    let column = &table.columns()[at];
    let own = column.name == role.name();
    match unit {
        None if own => Ok(Some(Place { at, factor: 1.0 })),
        None if strict => Err(of(table, TableProblem::NoUnit { column: column.heading.clone(), role, dimension })),
        None => Ok(None),
        Some(unit) => match signed(unit, dimension) {
            Ok(factor) => Ok(Some(Place { at, factor })),
            Err(source) if strict || own => {
                Err(of(table, TableProblem::Unit { column: column.heading.clone(), source: Box::new(source) }))
            }
            Err(_) => Ok(None),
        },
    }
}

/// Factor of a unit to SI: negative if a minus before the unit reverses the sign of the column, as in `-mN`.
fn signed(unit: &str, dimension: Dimension) -> Result<f64, UnitError> {
    match unit.strip_prefix('-') {
        Some(turned) => Unit::parse(turned, dimension).map(|unit| -unit.factor),
        None => Unit::parse(unit, dimension).map(|unit| unit.factor),
    }
}

pub(super) fn is_channel(name: &str) -> bool {
    const PREFIXES: [&str; 9] = ["channel", "Channel", "ch", "Ch", "CH", "SG", "gauge", "Gauge", "voltage"];
    PREFIXES.iter().filter_map(|prefix| name.strip_prefix(prefix)).any(|rest| {
        let digits = rest.trim_start_matches([' ', '_', '-']);
        !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit())
    })
}

/// A suggestion from the names that were found.
fn hint(table: &Table, missing: &[Role]) -> String {
    let mut hint = String::new();
    for role in missing {
        let (name, unit) = (role.name(), role.dimension().map_or("", si));
        let alike = table.columns().iter().find_map(|column| {
            let lower = column.name.to_lowercase();
            let rest = lower.strip_prefix(name)?;
            (!rest.starts_with(char::is_alphanumeric)).then_some((&column.heading, rest.is_empty()))
        });
        let _ = match alike {
            Some((found, true)) => write!(hint, "; `{found}` is {name} but for its letters' case"),
            Some((found, false)) => write!(hint, "; is `{found}` {name}? Give it in {unit} and name it {name}"),
            None => Ok(()),
        };
    }
    hint
}
