//! Sweeps with Coulomb friction.

mod hard;
mod judge;
mod laws;
mod limits;
mod random;
mod scans;
mod sliding;
