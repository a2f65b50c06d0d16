//! The samples of a table.

use super::column_map::{ColumnError, ColumnMap};
use super::columns::Columns;
use super::fault::{RowFault, RowProblem};
use super::recorded::Recorded;
use super::recorder::Contents;
use super::role::Role;
use super::table::Table;
use std::marker::PhantomData;

/// The samples of a table, row by row: an iterator of results, so that of raw samples a [`RawSource`](crate::RawSource) and of
/// wrenches a [`WrenchSource`](crate::WrenchSource).
///
/// A row that cannot be used is an error with its line; the rows after it follow. So is one whose time is not later than that of
/// the sample before, unless such are [kept](Self::keep_late).
///
/// ```
/// use rod_hw::recording::{ColumnMap, Table, TableOptions};
/// use rod_hw::WrenchSample;
/// let text = "t,Fx [N],Fy [N],Fz [N],Mx [N mm],My [N mm],Mz [N mm]\n\
///     0.00,1,0,0,0,0,5\n0.01,1,?,0,0,0,5\n0.01,1,0,0,0,0,6\n0.01,1,0,0,0,0,7\n";
/// let table = Table::parse("scan.csv", text.as_bytes(), &TableOptions::default())?;
/// let mut samples = table.samples::<WrenchSample>(&ColumnMap::new())?.skip_faults();
/// let torques: Vec<f64> = samples.by_ref().flatten().map(|sample| sample.wrench.torque[2]).collect();
/// assert_eq!((torques, samples.faulty()), (vec![5e-3, 6e-3], 2));
/// assert_eq!(samples.first_faults()[0].to_string(), "line 3: fy is `?`, expected a number");
/// assert_eq!(samples.late(), [5]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Samples<'t, S> {
    table: &'t Table,
    columns: Columns,
    next: usize,
    last: Option<(f64, u64)>,
    late: Vec<u64>,
    keeps_late: bool,
    skips: bool,
    faulty: u64,
    first_faults: Vec<RowFault>,
    kind: PhantomData<fn() -> S>,
}

/// Faults that are kept for a report.
const MOST_FAULTS: usize = 20;

impl Table {
    /// The samples of this kind.
    ///
    /// # Errors
    /// [`ColumnError`]: columns are missing, ambiguous, or of no unit.
    pub fn samples<S: Recorded>(&self, map: &ColumnMap) -> Result<Samples<'_, S>, ColumnError> {
        // a time of any kind, and whatever a recorder would write
        let mut welcome = vec![Role::Time];
        welcome.extend(S::roles(&Contents::EVERYTHING));
        welcome.retain(|role| !S::NEEDED.contains(role));
        let mut columns = map.find(self, S::NEEDED, &welcome)?;
        if S::NEEDED.is_empty() && ![Role::Time, Role::HostTime, Role::DeviceTime].iter().any(|role| columns.has(*role))
        {
            columns = map.find(self, &[Role::Time], &welcome)?;
        }
        if S::CHANNELS && columns.channels.is_empty() {
            let found = super::listed(self.columns().iter().map(|column| column.heading.as_str()));
            return Err(ColumnError::NoChannels { file: self.file().to_owned(), line: self.header_line(), found });
        }
        self.check_times(&columns)?;
        Ok(Samples {
            table: self,
            columns,
            next: 0,
            last: None,
            late: Vec::new(),
            keeps_late: false,
            skips: false,
            faulty: 0,
            first_faults: Vec::new(),
            kind: PhantomData,
        })
    }

    /// Where channels have times of their own, whether these are the same.
    fn check_times(&self, columns: &Columns) -> Result<(), ColumnError> {
        let Some(first) = columns.position(Role::Time).filter(|at| self.columns()[*at].name == "X_Value") else {
            return Ok(());
        };
        let others = self.columns().iter().enumerate().filter(|(_, column)| column.name.starts_with("X_Value of "));
        for (other, column) in others {
            for row in self.rows() {
                if let (Ok(expected), Ok(value)) = (row.number(first), row.number(other))
                    && expected != value
                {
                    return Err(ColumnError::OtherTimes {
                        file: self.file().to_owned(),
                        line: row.line(),
                        column: column.name.clone(),
                        value,
                        first: self.columns()[first].name.clone(),
                        expected,
                    });
                }
            }
        }
        Ok(())
    }
}

impl<S> Samples<'_, S> {
    /// Hands on samples whose time is not later than that of the one before; [`late`](Self::late) tells where.
    #[must_use]
    pub fn keep_late(mut self) -> Self {
        self.keeps_late = true;
        self
    }

    /// Leaves out rows that cannot be used, and counts them.
    #[must_use]
    pub fn skip_faults(mut self) -> Self {
        self.skips = true;
        self
    }

    /// Rows so far that cannot be used.
    pub fn faulty(&self) -> u64 {
        self.faulty
    }

    /// What is wrong with the first 20 of them.
    pub fn first_faults(&self) -> &[RowFault] {
        &self.first_faults
    }

    /// Lines so far whose time is not later than that of the sample before.
    pub fn late(&self) -> &[u64] {
        &self.late
    }

    /// Which columns are read.
    pub fn columns(&self) -> &Columns {
        &self.columns
    }
}

impl<S: Recorded> Iterator for Samples<'_, S> {
    type Item = Result<S, RowFault>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            let row = self.table.row(self.next)?;
            self.next += 1;
            let line = row.line();
            let sample = S::from_row(&row, &self.columns).and_then(|sample| {
                let t = sample.time();
                if let Some((before, of)) = self.last.filter(|(before, _)| t <= *before) {
                    self.late.push(line);
                    if !self.keeps_late {
                        return Err(RowProblem::Late { t, before, of });
                    }
                }
                self.last = Some((t, line));
                Ok(sample)
            });
            match sample {
                Ok(sample) => return Some(Ok(sample)),
                Err(problem) => {
                    let fault = RowFault { line, problem };
                    self.faulty += 1;
                    if self.first_faults.len() < MOST_FAULTS {
                        self.first_faults.push(fault.clone());
                    }
                    if !self.skips {
                        return Some(Err(fault));
                    }
                }
            }
        }
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        (0, Some(self.table.len().saturating_sub(self.next)))
    }
}
