//! The nine scans of Merker et al. (2020): three objects at three distances.
//!
//! `scans` are the scenes, `naive` turns a scan back as if there were one contact, `resolved` with both contacts; `figures` and
//! `report` show all scans, and `files` writes them.

mod error;
mod figures;
mod files;
mod naive;
mod report;
mod resolved;
mod scans;

pub use error::PaperError;
pub use scans::{Paper, PaperScan};
