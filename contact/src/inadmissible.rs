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
    #[error("the contacts are not in order along the rod; give the guess in another order")]
    NotInOrder,
    /// A contact lies on the curve of its piece, but beyond the end of the piece, or the force at a corner points out of the cone of its
    /// normals.
    #[error(
        "contact {contact} lies beyond the end of its piece; take the corner or the piece that follows there, or leave it out"
    )]
    OffPiece {
        /// Number of the contact, from 0 at the clamp.
        contact: usize,
    },
    /// The rod goes into or through an object.
    #[error(
        "the rod goes {depth:e} m into or through an object; a contact is missing, or the one of the tip is tangential"
    )]
    Inside {
        /// Depth, m; of a rod that comes out again, how far it is behind the contour where it went in.
        depth: f64,
    },
    /// The energy is not a minimum.
    #[error("the equilibrium is not stable; the rod would leave it")]
    Unstable,
}
