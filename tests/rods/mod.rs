//! Sweeps of rods that are not uniform.

mod random;
mod restarts;
mod scans;
