//! Files of results: those of a sweep, and how files are written.

mod records;
mod staged;
mod stages;
mod sweep;

pub use staged::{OutputError, Staged, check_output};
pub use stages::abandon;

use crate::Scan;
use records::{CONTACT_COLUMNS, EventRecord, ROLLER_COLUMNS, STATE_COLUMNS, StateRecord, contact_rows, state_row};
use std::io::{self, Write};
use std::path::Path;
use sweep::SweepRecord;

impl Scan {
    /// Writes states.jsonl, states.csv, contacts.csv, events.jsonl and sweep.json into `folder` of the staged directory.
    ///
    /// # Errors
    /// [`OutputError`].
    pub fn write(&self, staged: &Staged, folder: &Path) -> Result<(), OutputError> {
        staged.write(&folder.join("states.jsonl"), |file| self.write_states(file))?;
        staged.write(&folder.join("states.csv"), |file| self.write_table(file))?;
        staged.write(&folder.join("contacts.csv"), |file| self.write_contacts(file))?;
        staged.write(&folder.join("events.jsonl"), |file| self.write_events(file))?;
        staged.write(&folder.join("sweep.json"), |file| pretty_json(file, &SweepRecord::from(self)))?;
        Ok(())
    }

    /// One state a line, as JSON.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write_states(&self, out: &mut dyn Write) -> io::Result<()> {
        self.outcome.states.iter().try_for_each(|state| json_line(out, &StateRecord::from(state)))
    }

    /// One transition a line, as JSON.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write_events(&self, out: &mut dyn Write) -> io::Result<()> {
        self.outcome.events.iter().try_for_each(|event| json_line(out, &EventRecord::from(event)))
    }

    /// The states without their contacts, as CSV.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write_table(&self, out: &mut dyn Write) -> io::Result<()> {
        let mut columns = STATE_COLUMNS.to_vec();
        if self.scene.rod.roller().is_some() {
            columns.extend(ROLLER_COLUMNS);
        }
        write_csv(out, &columns, self.outcome.states.iter().enumerate().map(state_row))
    }

    /// The contacts of all states, one a row, as CSV.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write_contacts(&self, out: &mut dyn Write) -> io::Result<()> {
        write_csv(out, &CONTACT_COLUMNS, self.outcome.states.iter().enumerate().flat_map(contact_rows))
    }
}

/// Writes a table as CSV.
///
/// # Errors
/// Those of `out`.
pub fn write_csv(
    out: &mut dyn Write,
    columns: &[&str],
    rows: impl IntoIterator<Item = impl serde::Serialize>,
) -> io::Result<()> {
    let mut table = csv_writer(out);
    table.write_record(columns)?;
    rows.into_iter().try_for_each(|row| table.serialize(row))?;
    table.flush()
}

/// Writes rows as they are, the names of the columns being one of them.
pub fn csv_writer(out: &mut dyn Write) -> csv::Writer<&mut dyn Write> {
    csv::WriterBuilder::new().has_headers(false).from_writer(out)
}

/// Writes a record as JSON, for people to read.
///
/// # Errors
/// Those of `out`.
pub fn pretty_json(out: &mut dyn Write, record: &impl serde::Serialize) -> io::Result<()> {
    serde_json::to_writer_pretty(&mut *out, record)?;
    out.write_all(b"\n")
}

pub(crate) fn json_line(out: &mut dyn Write, record: &impl serde::Serialize) -> io::Result<()> {
    serde_json::to_writer(&mut *out, record)?;
    out.write_all(b"\n")
}
