//! Coulomb friction at the contacts.
//!
//! Friction turns the force of a sliding contact from the normal of the contour by rho, tan rho = mu. Of the statements that hold without
//! it, all kinematic ones hold with it: the contact is where the moment vanishes, s_c = 1 at the tip, contacts move along their
//! tangents. K = 0 becomes K = 2 |F| sin rho, |F| = hypot(f0x, f0y), so that K / (2 |F|) has one value along all tangential
//! contacts. `plateau` finds that value, [`Friction`] says what is known before, and [`FrictionEstimate`] what was found.

mod coefficient;
mod plateau;

pub(crate) use coefficient::{ANY, SPREAD};
pub use coefficient::{Friction, FrictionAlone, FrictionEstimate};
pub(crate) use plateau::{PlateauFriction, flatness, plateau_friction, shows_friction};
