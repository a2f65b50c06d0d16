//! Sweeps of rods that are not uniform, and of clamps that give way.

mod any;
mod attack;
mod inversion;
mod parameters;
mod random;
mod restarts;
mod roller;
pub mod scans;
mod stress;
mod through_roller;
mod two_contacts;
