//! Contours as data: shapes by the names of their fields, and the files that hold them.

pub mod description;
pub mod file;
