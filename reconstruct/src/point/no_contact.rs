//! Why there is no single contact.

use super::touch::Touch;
use crate::numeric::Number;

/// Why no single contact explains the reactions. This is an answer, not a failure, and holds the point where there is one.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NoContact<T: Number = f64> {
    /// The clamp carries no force beyond the noise.
    #[error("no force: the rod is free")]
    Free,
    /// The curvature keeps its sign however long the rod is: the moment vanishes nowhere.
    #[error("the moment vanishes nowhere along the rod")]
    NoMomentZero,
    /// The moment vanishes beyond the tip only, at the point given.
    #[error("the moment vanishes at {} m, beyond the tip", .0.s)]
    BeyondTip(Touch<T>),
    /// At the point given the rod would leave the object instead of pressing on it: the contact would have to pull.
    #[error("the contact at {} m would pull the rod", .0.s)]
    Pulling(Touch<T>),
    /// The pose, the reactions or the covariance are not finite.
    #[error("pose and reactions are not finite numbers")]
    NotFinite,
}

impl<T: Number> NoContact<T> {
    /// The point where the moment vanishes, if there is one: what a reconstruction that assumes single contacts would take for
    /// the contact.
    pub fn touch(&self) -> Option<Touch<T>> {
        match self {
            Self::BeyondTip(touch) | Self::Pulling(touch) => Some(*touch),
            _ => None,
        }
    }
}
