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
    Cell, Column, ColumnMap, Columns, Contents, Decimal, Delimiter, Header, Recorded, Recorder, Role, Row, RowFault,
    RowProblem, Table, TableError, TableOptions, TableProblem,
};
