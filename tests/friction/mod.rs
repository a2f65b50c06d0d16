//! Sweeps with Coulomb friction.

mod scans;
