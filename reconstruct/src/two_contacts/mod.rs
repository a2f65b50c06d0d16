//! Both contacts of a rod with several, from a scan.
//!
//! One sample does not determine two contacts, but a scan does. The reactions determine the rod up to its first contact, and
//! along the scan these shapes touch the contour: their normal speed vanishes there (`envelope`, `trail`). The force there and
//! the second contact follow from two conditions: the moment vanishes at the second contact, and that contact moves along its
//! own tangent, too (`conditions`). What the rod is, only [`Inverse`](crate::point::Inverse) knows.
//!
//! All conditions are imposed at once, in least squares over a whole run of stretches (`system`). The unknowns are the
//! coefficients of Legendre series in the path parameter (`unknowns`, `series`, `part`): reactions, which agree with the
//! measured ones within their noise, arc lengths, and the first force, which are smooth (`weights`).

mod bend;
mod beyond;
mod choice;
mod conditions;
mod displaced;
mod envelope;
mod guess;
mod pair;
mod part;
mod resolve;
mod run;
mod series;
mod single;
mod system;
#[cfg(test)]
mod tests;
mod trail;
mod unknowns;
mod unresolved;
mod weights;

pub(crate) use pair::{Limits, Pair};
pub(crate) use resolve::{Neighbour, Piece, Resolution, resolve};
pub(crate) use run::AS_GOOD;
pub use unresolved::Unresolved;
