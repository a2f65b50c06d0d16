//! Recordings: tables of text read, samples of them, samples recorded.
//!
//! - [`Table`]: named columns with units, rows with their lines; from CSV, TSV, semicolons, blanks, LabVIEW's LVM.
//! - [`ColumnMap`]: which column means what ([`Role`]). [`Table::samples`]: raw samples, wrenches or reactions, in SI units.
//! - [`Recorder`]: writes reactions as they come, with the raw values.
//!
//! `split` cuts text into lines and cells, `layout` finds out how a table is written, `read` and `lvm` read one.

mod clock;
mod column_map;
mod columns;
mod date;
mod error;
mod fault;
mod guess;
mod heading;
mod layout;
mod lvm;
mod number;
mod options;
mod outline;
mod read;
mod recorded;
mod recorder;
mod role;
mod samples;
mod split;
mod table;
mod workbook;

pub use column_map::ColumnMap;
pub use columns::Columns;
pub use error::{TableError, TableProblem};
pub use fault::{RowFault, RowProblem};
pub use guess::{Basis, ColumnGuess, ColumnSummary, Quantity, Sureness, TableGuess, TableKind, guess};
pub use heading::Column;
pub use options::{Constant, Decimal, Delimiter, Header, TableOptions};
pub use outline::{FileFormat, Outline, Part};
pub use recorded::Recorded;
pub use recorder::{Contents, Recorder};
pub use role::Role;
pub use table::{Cell, Row, Table};
