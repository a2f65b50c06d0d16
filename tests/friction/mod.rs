//! Sweeps with Coulomb friction.

mod judge;
mod laws;
mod limits;
mod random;
mod scans;
