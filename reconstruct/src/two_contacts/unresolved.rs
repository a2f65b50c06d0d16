//! Why one of several contacts is not resolved.

/// Why a contact of a sample with several contacts is not known. This is an answer, not a failure.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Unresolved {
    /// The stretch has too few samples to determine rates.
    #[error("the stretch has {samples} samples, {least} are needed")]
    TooShort {
        /// Samples of the stretch, without the margins at its ends.
        samples: usize,
        /// How many are needed.
        least: usize,
    },
    /// The shapes of the rod along the scan have no envelope that touches the rod.
    #[error("the shapes of the rod have no envelope")]
    NoTouch,
    /// The force of the second contact is within its noise of zero, so that its place is not defined.
    #[error("the force of the second contact is within its noise of zero")]
    ForceVanishes,
    /// The force of the first contact is within its noise of zero, so that its existence is not certain.
    #[error("the force of the first contact is within its noise of zero")]
    FirstForceVanishes,
    /// Contacts at different places explain the reactions within their noise.
    #[error("contacts at different places explain the reactions equally well")]
    Ambiguous,
    /// The force of the first contact is known at neither end of the stretch. In noise: nor is a contact, so that there may be more than
    /// two.
    #[error("the force of the first contact is known at no end of the stretch")]
    NoAnchor,
    /// One of the contacts may stick, or the rod may roll on it, or slide the other way: its friction is not known.
    #[error("one of the contacts may stick, so that its friction is not known")]
    Sticks,
    /// The standard deviation of the position exceeds the limit.
    #[error("the standard deviation of the position is {sigma} lengths of the rod, too large")]
    TooNoisy {
        /// Standard deviation across the contour or, where that decided, along it, in lengths of the rod.
        sigma: f64,
    },
    /// The conditions of two contacts contradict each other or the signs of their forces.
    #[error("no two contacts agree with the reactions")]
    Inconsistent,
}
