//! Why a frame cannot be used.

/// Why nothing is told of a frame.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FrameFault {
    /// Fewer numbers than a free rod has unknowns.
    #[error(
        "{points} points and {channels} channels, expected points at 3 places at least, or the pose of the base (three numbers) and one number more"
    )]
    TooFew {
        /// Points on the rod.
        points: usize,
        /// Measured numbers.
        channels: usize,
    },
    /// A number is not finite, or a standard deviation is not larger than 0.
    #[error("{what} of {of} is {value}, expected {expected}")]
    Number {
        /// The number, or its standard deviation.
        what: &'static str,
        /// Which point or channel.
        of: String,
        /// Its value.
        value: f64,
        /// What was expected.
        expected: &'static str,
    },
    /// The points reach along far more than the rod.
    #[error("the points lie along {measured:.4e} m, but the rod has {length:.4e} m: {hint}")]
    Length {
        /// Length of the chords between the points, m.
        measured: f64,
        /// Length of the rod, m.
        length: f64,
        /// What may be wrong.
        hint: String,
    },
    /// The points scatter by more than any noise.
    #[error(
        "the points scatter by {share:.0} % of the length of the rod across it, expected points of one rod: are two rods mixed?"
    )]
    Scatter {
        /// By how much, %.
        share: f64,
    },
    /// The points turn back on themselves.
    #[error(
        "the rod turns back at point {point} (from 0), expected points of one rod in order from the base to the tip: are two rods mixed?"
    )]
    Order {
        /// Number of the point, from 0.
        point: usize,
    },
    /// The points in reverse order are explained, as they are they are not.
    #[error(
        "the points fit the rod in reverse order only: they run from the tip to the base, or are mirrored; expected the base first, and y that counts up (is it an image?)"
    )]
    Reversed,
    /// The rod looks shorter than it is, by more than is allowed.
    #[error(
        "the rod looks {shortening:.1} % too short, expected at most {most:.1} %: it is bent out of the plane of the image, or an end is hidden"
    )]
    OutOfPlane {
        /// By how much, %.
        shortening: f64,
        /// The most that is allowed, %.
        most: f64,
    },
    /// No shape was found.
    #[error("no shape of the rod was found near the observations: is this the rod of the film?")]
    NoShape,
}
