//! The samples of a table.

use super::clock::Clock;
use super::column_map::{ColumnMap, found, of};
use super::columns::Columns;
use super::error::{TableError, TableProblem};
use super::fault::RowFault;
use super::recorded::Recorded;
use super::role::Role;
use super::table::Table;

impl Table {
    /// The samples of this kind, row by row: a source for a [`SignalChain`](crate::SignalChain), if they are raw samples.
    ///
    /// A row that cannot be used is an error with its line; the rows after it follow. So is one whose time is not later than that
    /// of the sample before. Where the clock begins anew, no row after that is a sample: their times are those of another clock.
    ///
    /// ```
    /// use rod_hw::recording::{ColumnMap, RowFault, Table, TableOptions};
    /// use rod_hw::WrenchSample;
    /// let text = "t,Fx [N],Fy [N],Fz [N],Mx [N mm],My [N mm],Mz [N mm]\n\
    ///     0.00,1,0,0,0,0,5\n0.01,1,?,0,0,0,5\n0.01,1,0,0,0,0,6\n0.01,1,0,0,0,0,7\n";
    /// let table = Table::parse("scan.csv", text.as_bytes(), &TableOptions::default())?;
    /// let mut faults: Vec<RowFault> = Vec::new();
    /// let samples = table.samples::<WrenchSample>(&ColumnMap::new())?;
    /// let good = samples.filter_map(|sample| sample.map_err(|fault| faults.push(fault)).ok());
    /// assert_eq!(good.map(|sample| sample.wrench.torque[2]).collect::<Vec<_>>(), [5e-3, 6e-3]);
    /// assert_eq!(faults[0].to_string(), "line 3: fy is `?`, expected a number");
    /// assert!(faults[1].to_string().starts_with("line 5: the time 0.01 s is not later than"));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`TableError`]: columns are missing, ambiguous, or of no unit.
    pub fn samples<'t, S: Recorded>(
        &'t self,
        map: &ColumnMap,
    ) -> Result<impl Iterator<Item = Result<S, RowFault>> + use<'t, S>, TableError> {
        let welcome = S::WELCOME.concat();
        let mut columns = map.find(self, S::NEEDED, &welcome)?;
        let has_time = [Role::Time, Role::HostTime, Role::DeviceTime].iter().any(|role| columns.has(*role));
        if S::NEEDED.is_empty() && !has_time {
            columns = map.find(self, &[Role::Time], &welcome)?;
        }
        if S::CHANNELS && columns.channels.is_empty() {
            return Err(of(self, TableProblem::NoChannels { found: found(self) }));
        }
        self.check_times(&columns)?;
        let mut clock = Clock::default();
        Ok(self.rows().map(move |row| {
            let line = row.line();
            let sample =
                S::from_row(&row, &columns).and_then(|sample| clock.take(sample.time(), line).map(|()| sample));
            sample.map_err(|problem| RowFault { line, problem })
        }))
    }

    /// Where channels have times of their own, whether these are the same.
    fn check_times(&self, columns: &Columns) -> Result<(), TableError> {
        let Some(first) = columns.position(Role::Time).filter(|at| self.columns()[*at].name == "X_Value") else {
            return Ok(());
        };
        let others = self.columns().iter().enumerate().filter(|(_, column)| column.name.starts_with("X_Value of "));
        for (other, column) in others {
            for row in self.rows() {
                if let (Ok(expected), Ok(value)) = (row.number(first), row.number(other))
                    && expected != value
                {
                    let (column, first) = (column.name.clone(), self.columns()[first].name.clone());
                    let problem = TableProblem::OtherTimes { column, value, first, expected };
                    return Err(problem.at(self.file(), row.line()));
                }
            }
        }
        Ok(())
    }
}
