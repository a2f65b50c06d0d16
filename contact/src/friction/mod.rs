//! Coulomb friction: which contacts slip, stick or roll, and when that changes.
//!
//! The contact of the rod has gone a along the contour and s along the rod, which runs in the sense o = 1 of the contour or against it. The
//! slip coordinate g = a + o (1 - s) grows as the material point of the rod at the contact moves along the contour; it is constant where the rod sticks
//! (tip) or rolls (side). With the normal force f >= 0 and the force f_t on the rod along the contour:
//!
//! | mode | equation | holds while |
//! |---|---|---|
//! | slip+: g grows | f_t = -mu f | dg >= 0 |
//! | slip-: g falls | f_t = mu f | dg <= 0 |
//! | stick | g as it was | abs f_t <= mu f |
//!
//! A contact set that is `SMOOTH` throughout is one without friction, or one whose friction has not been decided yet.

mod landed;
mod law;
mod modes;
mod rates;
mod work;

pub use law::{Coefficients, Friction};

pub(crate) use landed::{with_drag, without_friction};
pub(crate) use modes::{Motion, UNLOADED, possible_motions, resists, without_unloaded};
pub(crate) use rates::{reversed_slips, slip_between, slip_coordinate, slip_rate};
pub(crate) use work::friction_work;
