//! The clock of a recording, row by row.

use super::fault::RowProblem;

/// So many rows one after the other, earlier than one before them and growing, have the times of a clock that began anew. Fewer arrived out of order.
const ANEW: usize = 8;

/// The clock of a recording.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Clock {
    /// The latest time and its line.
    latest: Option<(f64, u64)>,
    /// The time of the row before.
    last: f64,
    /// Rows that are late one after the other, and the first of them.
    late: usize,
    first_late: (f64, u64),
}

impl Clock {
    /// Takes the time of a row, s.
    ///
    /// # Errors
    /// [`RowProblem::Late`] and [`RowProblem::Restarted`].
    pub fn take(&mut self, t: f64, line: u64) -> Result<(), RowProblem> {
        let before = std::mem::replace(&mut self.last, t);
        let Some((latest, of)) = self.latest else {
            self.latest = Some((t, line));
            return Ok(());
        };
        if self.late >= ANEW {
            let (t, line) = self.first_late;
            return Err(RowProblem::Restarted { line, t, before: latest });
        }
        if t > latest {
            (self.latest, self.late) = (Some((t, line)), 0);
            return Ok(());
        }
        // times that are rounded repeat
        if self.late == 0 && t < latest {
            (self.late, self.first_late) = (1, (t, line));
        } else if self.late > 0 && t > before {
            self.late += 1;
        }
        Err(RowProblem::Late { t, before: latest, of })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn taken(times: impl Iterator<Item = f64>) -> Vec<Result<(), RowProblem>> {
        let mut clock = Clock::default();
        times.zip(1..).map(|(t, line)| clock.take(t, line)).collect()
    }

    #[test]
    fn a_clock_that_begins_anew_has_no_samples_after_that() {
        let found = taken((0..100).chain(0..300).map(f64::from));
        assert!(found[..100].iter().all(Result::is_ok) && found[100..].iter().all(Result::is_err), "{found:?}");
        assert_eq!(found[399], Err(RowProblem::Restarted { line: 101, t: 0.0, before: 99.0 }));
    }

    #[test]
    fn rows_out_of_order_and_rounded_times_are_no_other_clock() {
        let swapped = taken((0..100).map(|k: i32| f64::from(k ^ 3)));
        assert!(swapped.iter().filter(|row| row.is_ok()).count() > 24, "{swapped:?}");
        let rounded = taken((0..1000).map(|k: i32| f64::from(k / 20)));
        assert_eq!(rounded.iter().filter(|row| row.is_ok()).count(), 50);
        assert!(!rounded.iter().any(|row| matches!(row, Err(RowProblem::Restarted { .. }))));
    }
}
