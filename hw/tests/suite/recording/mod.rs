//! Tables of text.

mod lvm;
mod memory;
mod samples;
mod tables;
