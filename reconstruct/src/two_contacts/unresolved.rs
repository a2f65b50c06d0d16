//! Why contacts of a rod with several could not be found.

/// Why a contact of a sample with several contacts is not known. Not a failure: an answer.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Unresolved {
    /// The stretch has too few samples for rates.
    #[error("the stretch has {samples} samples, {least} are needed")]
    TooShort {
        /// Samples of the stretch, without the margins at its ends.
        samples: usize,
        /// How many are needed.
        least: usize,
    },
    /// Nowhere along the rod do the known arcs touch an envelope.
    #[error("the rod's arcs touch no envelope")]
    NoTouch,
    /// The second contact's force is within its noise of nothing: its place is not defined.
    #[error("the force of the second contact is within its noise of zero")]
    ForceVanishes,
    /// No end of the stretch tells the first contact's force.
    #[error("the force of the first contact is known at no end of the stretch")]
    NoAnchor,
    /// The standard deviation of the position, in lengths of the rod, exceeds what was asked for.
    #[error("the position is uncertain by {sigma} lengths of the rod")]
    TooNoisy {
        /// Standard deviation across the contour or, where that decided, along it, in lengths of the rod.
        sigma: f64,
    },
    /// The conditions of two contacts contradict each other or the signs of their forces.
    #[error("no two contacts agree with the reactions")]
    Inconsistent,
}
