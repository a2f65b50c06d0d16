//! A check by the physics: whether a recording can be of the rod that is given.
//!
//! Wherever the last contact is tangential, whatever the object, the phase criterion vanishes: m0z^2 = 2 EI (f0y sin phi0 + f0x cos
//! phi0). `bins` averages the samples, `line` finds this straight line among them without knowing any phase (`fit`), `shares` counts
//! the samples that a single contact explains, and `findings` draws the conclusions. `mistake` undoes what may be wrong.

mod bins;
mod finding;
mod findings;
mod fit;
mod line;
mod mistake;
mod plausibility;
mod shares;

pub use finding::Finding;
pub use line::TangentialLine;
pub use mistake::Mistake;
pub use plausibility::{Plausibility, plausibility, plausibility_with_friction};
pub use shares::Shares;
