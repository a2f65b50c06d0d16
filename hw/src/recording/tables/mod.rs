//! Recordings: tables of text read, samples of them, samples recorded.
//!
//! - [`Table`]: named columns with units, rows with their lines; from CSV, TSV, semicolons, blanks, LabVIEW's LVM.
//! - [`ColumnMap`]: which column means what ([`Role`]). [`Samples`]: raw samples, wrenches or reactions of a table, in SI units.
//! - [`Recorder`]: writes what these read.
//!
//! `split` cuts text into lines and cells, `layout` finds out how a table is written, `text` and `lvm` read one.

mod column_map;
mod columns;
mod error;
mod fault;
mod heading;
mod layout;
mod lvm;
mod number;
mod options;
mod recorded;
mod recorder;
mod role;
mod samples;
mod split;
mod table;
mod text;

pub use column_map::{ColumnError, ColumnMap};
pub use columns::Columns;
pub use error::TableError;
pub use fault::{RowFault, RowProblem};
pub use heading::Column;
pub use options::{Decimal, Delimiter, Header, TableOptions};
pub use recorded::Recorded;
pub use recorder::{About, Contents, RecordError, Recorder};
pub use role::Role;
pub use samples::Samples;
pub use table::{Cell, Note, Row, Table};

/// Most columns that are named in a message.
const MOST_NAMES: usize = 20;

fn listed<'n>(names: impl Iterator<Item = &'n str>) -> String {
    let names: Vec<&str> = names.collect();
    let more = if names.len() > MOST_NAMES { format!(" and {} more", names.len() - MOST_NAMES) } else { String::new() };
    names[..names.len().min(MOST_NAMES)].join(", ") + &more
}
