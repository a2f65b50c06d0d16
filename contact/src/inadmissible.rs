//! Why an equilibrium of a contact set is none that a rod can be in.

use rod_core::SolveStatus;

/// Why the equilibrium of a given contact set is not one of the rod: the first of the conditions that it breaks.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Inadmissible {
    /// The equations were not solved.
    #[error("the equations are not solved ({0:?}); start from a better guess, or take the contact set from a sweep")]
    NotSolved(SolveStatus),
    /// A contact pulls the rod.
    #[error("contact {contact} pulls with {force:e} N; leave it out")]
    Pulls {
        /// Number of the contact, from 0 at the clamp.
        contact: usize,
        /// Its force, N, < 0.
        force: f64,
    },
    /// A tangential contact lies beyond the tip.
    #[error("the last contact is at {s} m, beyond the tip of a rod of {length} m; take a contact of the tip instead")]
    BeyondTip {
        /// Arc length, m.
        s: f64,
        /// Length of the rod, m.
        length: f64,
    },
    /// The contacts are not in the order of the guess along the rod.
    #[error("the contacts are not in order along the rod, or not on their pieces; give the guess in another order")]
    NotInOrder,
    /// The rod goes through an object.
    #[error("the rod is {depth:e} m inside an object; a contact is missing, or the one of the tip is tangential")]
    Inside {
        /// Depth, m.
        depth: f64,
    },
    /// The energy is not a minimum.
    #[error("the equilibrium is not stable; the rod would leave it")]
    Unstable,
}
