//! Why scans cannot be planned.

use rod_contact::ContactError;

/// Why scans cannot be planned.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PlanError {
    /// A distance at which a straight rod cannot touch the object, or the clamp could.
    #[error("distances has {value} m, expected more than 0 and less than the rod's length, {length} m")]
    Distance {
        /// The distance as given, m.
        value: f64,
        /// The rod's length, m.
        length: f64,
    },
    /// An angle that is no number.
    #[error("angles has {value} rad, expected a finite angle")]
    Angle {
        /// The angle as given, rad.
        value: f64,
    },
    /// A grid without scans.
    #[error("{what} is empty, expected one value at least")]
    Empty {
        /// `distances`, `angles` or `candidates`.
        what: &'static str,
    },
    /// An object that goes on for ever against the direction of the rod.
    #[error(
        "angles has {angle} rad, from where object {object} has no nearest place: it goes on for ever; expected an angle from where it \
         has one, or an object that ends"
    )]
    NoNearest {
        /// The object, from 0.
        object: usize,
        /// Direction of the rod, rad.
        angle: f64,
    },
    /// An object that goes on for ever along the path of the clamp.
    #[error(
        "object {object} goes on for ever within reach of the scans, expected one that ends, or bends away from the clamp"
    )]
    Endless {
        /// The object, from 0.
        object: usize,
    },
    /// No point of the contour is known from which a hypothesis could go on.
    #[error("no point of the contour is touched or bounded, expected a reconstruction with a fitted contour")]
    NothingKnown,
    /// A step or a path that is none.
    #[error(transparent)]
    Sweep(#[from] ContactError),
}
