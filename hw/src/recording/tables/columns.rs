//! The columns of one table, found.

use super::fault::{RowProblem, shown};
use super::role::Role;
use super::table::{Cell, Row, Table};
use crate::sample::{Channels, Quality};

/// Where a column is, and what one of its unit is in SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Place {
    pub at: usize,
    pub factor: f64,
}

/// The columns of one table, found by a [`ColumnMap`](super::ColumnMap).
#[derive(Clone, Debug, PartialEq)]
pub struct Columns {
    places: [Option<Place>; Role::COUNT],
    pub(super) channels: Vec<usize>,
    width: usize,
}

/// Counts are exact up to here.
const MOST_COUNT: f64 = 9_007_199_254_740_992.0;

impl Columns {
    pub(super) fn new(width: usize) -> Self {
        Self { places: [None; Role::COUNT], channels: Vec::new(), width }
    }

    pub(super) fn set(&mut self, role: Role, place: Place) {
        self.places[role as usize] = Some(place);
    }

    /// Whether there is a column for this.
    pub fn has(&self, role: Role) -> bool {
        self.places[role as usize].is_some()
    }

    /// Number of the column for this, from 0.
    pub fn position(&self, role: Role) -> Option<usize> {
        self.places[role as usize].map(|place| place.at)
    }

    /// Headings of the columns that mean nothing, in order.
    pub fn ignored<'t>(&self, table: &'t Table) -> impl Iterator<Item = &'t str> {
        let used: Vec<bool> = (0..self.width)
            .map(|at| self.channels.contains(&at) || self.places.iter().flatten().any(|place| place.at == at))
            .collect();
        table.columns().iter().zip(used).filter(|(_, used)| !used).map(|(column, _)| column.heading.as_str())
    }

    /// The value in SI units; `None` if there is no such column, or nothing in it.
    ///
    /// # Errors
    /// [`RowProblem`]: the row has a wrong number of cells, or there is something else than a finite number, or a negative one
    /// of a standard deviation or bound.
    pub fn value(&self, row: &Row<'_>, role: Role) -> Result<Option<f64>, RowProblem> {
        let Some(place) = self.places[role as usize] else {
            return Ok(None);
        };
        match row.cell(place.at) {
            Cell::Number(value) => {
                let value = value * place.factor;
                if !value.is_finite() {
                    return Err(RowProblem::NotFinite { column: role.name().to_owned(), value });
                }
                if value < 0.0 && role.is_spread() {
                    return Err(RowProblem::Negative { column: role.name().to_owned(), value });
                }
                Ok(Some(value))
            }
            Cell::Empty => row.check().map(|()| None),
            Cell::Text(text) => Err(RowProblem::no_number(role.name().to_owned(), text)),
        }
    }

    /// The value in SI units, which must be there.
    ///
    /// # Errors
    /// As [`value`](Self::value), and where there is none.
    pub fn needed(&self, row: &Row<'_>, role: Role) -> Result<f64, RowProblem> {
        self.value(row, role)?.ok_or_else(|| RowProblem::Missing { column: role.name().to_owned() })
    }

    /// All of several values, or none where they are all missing.
    ///
    /// # Errors
    /// As [`value`](Self::value), and where only some are missing.
    pub fn all<const N: usize>(&self, row: &Row<'_>, roles: [Role; N]) -> Result<Option<[f64; N]>, RowProblem> {
        let mut values = [0.0; N];
        let mut missing = None;
        let mut any = false;
        for (value, role) in values.iter_mut().zip(roles) {
            match self.value(row, role)? {
                Some(found) => (*value, any) = (found, true),
                None => missing = Some(role),
            }
        }
        match missing {
            Some(role) if any => Err(RowProblem::Missing { column: role.name().to_owned() }),
            Some(_) => Ok(None),
            None => Ok(Some(values)),
        }
    }

    /// A whole number, not negative.
    ///
    /// # Errors
    /// As [`value`](Self::value), and where it is another number.
    pub fn count(&self, row: &Row<'_>, role: Role) -> Result<Option<u64>, RowProblem> {
        let most = if role == Role::Status { f64::from(u32::MAX) } else { MOST_COUNT };
        match self.value(row, role)? {
            Some(value) if value.fract() != 0.0 || !(0.0..=most).contains(&value) => {
                Err(RowProblem::NoCount { column: role.name().to_owned(), value, most })
            }
            value => Ok(value.map(|value| value as u64)),
        }
    }

    /// Flags; `None` if there is no such column or nothing in it.
    ///
    /// # Errors
    /// [`RowProblem::NoFlag`], or a wrong number of cells.
    pub fn quality(&self, row: &Row<'_>, role: Role) -> Result<Quality, RowProblem> {
        let Some(place) = self.places[role as usize] else {
            return Ok(Quality::empty());
        };
        let no_flag = |text: &str| RowProblem::NoFlag { column: role.name().to_owned(), text: shown(text) };
        match row.cell(place.at) {
            Cell::Empty => row.check().map(|()| Quality::empty()),
            Cell::Number(value) => Err(no_flag(&value.to_string())),
            Cell::Text(text) => Quality::parse(text).ok_or_else(|| no_flag(text)),
        }
    }

    /// The raw values, which must be there.
    ///
    /// # Errors
    /// As [`Row::number`].
    pub fn channels(&self, row: &Row<'_>) -> Result<Channels, RowProblem> {
        let mut values = [0.0; Channels::MOST];
        for (value, at) in values.iter_mut().zip(&self.channels) {
            *value = row.number(*at)?;
        }
        let count = self.channels.len().min(Channels::MOST);
        Ok(Channels::new(&values[..count]).unwrap_or_default())
    }
}
