//! What to say of a recording that can be used in part.

use super::{Place, Recording, RowFault, RowProblem};
use std::mem::{Discriminant, discriminant};
use vibrissa::hw::recording::RowProblem as CellProblem;

/// Most lines that are named for each kind of fault.
const MOST_LINES: usize = 5;

impl Recording {
    /// A line for each kind of fault, with the file, the first lines where it is, and how many there are; for a time
    /// that does not grow; for columns that are not looked at; and for an end that is missing.
    pub fn warnings(&self) -> Vec<String> {
        let file = self.file.display();
        let mut warnings = Vec::new();
        if !self.ignored.is_empty() {
            warnings.push(format!("{file}: columns not used: {}", self.ignored.join(", ")));
        }
        let mut kinds: Vec<(Kind, Vec<&RowFault>)> = Vec::new();
        for fault in self.faults() {
            let kind = kind_of(&fault.problem);
            match kinds.iter_mut().find(|(known, _)| *known == kind) {
                Some((_, faults)) => faults.push(fault),
                None => kinds.push((kind, vec![fault])),
            }
        }
        for (_, faults) in kinds {
            let places: Vec<Place> = faults.iter().map(|fault| fault.place).collect();
            let (count, rows) = (faults.len(), self.rows.len());
            warnings.push(format!(
                "{file}: {count} of {rows} rows cannot be used, {}: {}",
                Place::several(&places, MOST_LINES),
                faults[0].problem
            ));
        }
        if !self.late.is_empty() {
            let (count, rows) = (self.late.len(), self.rows.len());
            let at = Place::several(&self.late, MOST_LINES);
            warnings.push(format!("{file}: the time does not increase in {count} of {rows} rows, {at}"));
        }
        if self.cut {
            warnings.push(format!("{file}: the end of the recording is missing"));
        }
        if let Some(why) = &self.incomplete {
            warnings.push(format!("{file}: the recording is incomplete: {why}"));
        }
        warnings.extend(self.notes.iter().map(|note| format!("{file}: {note}")));
        warnings
    }
}

/// What kind of problem, also among those of cells.
pub(super) type Kind = (Discriminant<RowProblem>, Option<Discriminant<CellProblem>>);

pub(super) fn kind_of(problem: &RowProblem) -> Kind {
    let of_cell = if let RowProblem::Cell(problem) = problem { Some(discriminant(problem)) } else { None };
    (discriminant(problem), of_cell)
}
