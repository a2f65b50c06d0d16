//! Recordings: tables of text (feature `recordings`), files of LabVIEW and NI-DAQmx ([`tdms`], feature `tdms`), files of ROS
//! ([`mcap`], feature `mcap`).

#[cfg(feature = "mcap")]
pub mod mcap;
#[cfg(feature = "recordings")]
mod tables;
#[cfg(feature = "tdms")]
pub mod tdms;

#[cfg(feature = "recordings")]
pub use tables::{
    Basis, Cell, Column, ColumnGuess, ColumnMap, ColumnSummary, Columns, Constant, Contents, Decimal, Delimiter,
    FileFormat, Header, Outline, Part, Quantity, Recorded, Recorder, Role, Row, RowFault, RowProblem, Sureness, Table,
    TableError, TableGuess, TableKind, TableOptions, TableProblem, guess,
};
