//! What can be wrong with a rod, a load or a solve.

/// Errors of this crate.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RodError {
    /// A quantity that must be a positive, finite number is not.
    #[error("{what} is {value}, expected a positive, finite number")]
    NotPositive {
        /// Which quantity.
        what: &'static str,
        /// Its value as given.
        value: f64,
    },
    /// A quantity that must be finite is not.
    #[error("{what} is {value}, expected a finite number")]
    NotFinite {
        /// Which quantity.
        what: &'static str,
        /// Its value as given.
        value: f64,
    },
    /// A wire that is thicker than it is long: no rod, and most often a length in m with a diameter in mm.
    #[error("diameter is {diameter:?} m, expected at most the length, {length:?} m")]
    TooThick {
        /// Diameter as given, m.
        diameter: f64,
        /// Length as given, m.
        length: f64,
    },
    /// A tapered wire whose ends differ too much in thickness.
    #[error(
        "tip_diameter is {tip_diameter:?} m, expected between 0.01 and 100 times the diameter at the clamp, {base_diameter:?} m"
    )]
    TooTapered {
        /// Diameter at the tip as given, m.
        tip_diameter: f64,
        /// Diameter at the clamp as given, m.
        base_diameter: f64,
    },
    /// Points of the diameters of a wire are not what a rod can have.
    #[cfg(feature = "std")]
    #[error("{}", .faults.join("; "))]
    Diameters {
        /// All that is wrong, each with its point, its value and what was expected.
        faults: Vec<String>,
    },
    /// The diameter of a wire changes within too short a way.
    #[error(
        "diameter changes from {from:?} to {to:?} m between the points {number} and {next}, expected points further apart there, or sections for a step", next = .number + 1
    )]
    Step {
        /// Number of the first of the two points, from 1.
        number: usize,
        /// Diameter at that point, m.
        from: f64,
        /// Diameter at the next one, m.
        to: f64,
    },
    /// The arc lengths of the loads do not grow from the clamp to the tip.
    #[error(
        "load {index} acts at arc length {s}, expected a value from {least} to {most}: loads are ordered from clamp to tip"
    )]
    LoadOrder {
        /// Number of the load, from 0.
        index: usize,
        /// Where it acts.
        s: f64,
        /// Arc length of the load before, or 0.
        least: f64,
        /// Length of the rod.
        most: f64,
    },
    /// Diameters for another number of sections than the rod has.
    #[error("diameters are given for {given} sections, expected one for each of the {sections} sections of the rod")]
    SectionDiameters {
        /// How many are given.
        given: usize,
        /// How many sections the rod has.
        sections: usize,
    },
    /// A quantity of a section of a rod is not what a rod can have.
    #[error("{what} of section {index} is {value}, expected {expected}")]
    Section {
        /// Number of the section, from 0 at the clamp.
        index: usize,
        /// Which quantity.
        what: &'static str,
        /// Its value as given.
        value: f64,
        /// What it should be.
        expected: &'static str,
    },
    /// The lengths of the sections of a rod do not add up to its length.
    #[error("the lengths of the sections add up to {total}, expected {expected}, the length of the rod")]
    SectionsLength {
        /// Their sum.
        total: f64,
        /// The length of the rod.
        expected: f64,
    },
    /// A stiffness of an elastic clamp is not what a spring can have.
    #[error("{what} of the clamp is {value:?}, expected {expected}")]
    ClampStiffness {
        /// Which: of x, y (N/m) or phi (N m/rad), or an entry of the matrix.
        what: &'static str,
        /// Its value as given.
        value: f64,
        /// What it should be.
        expected: &'static str,
    },
    /// A roller that is not between the clamp and the tip.
    #[error("clamp.roller is {value:?}, expected a number above 0 and below {length:?}, the length of the rod")]
    Roller {
        /// Arc length from the clamp as given.
        value: f64,
        /// The length of the rod.
        length: f64,
    },
    /// The bending stiffness of a rod is not a positive, finite number somewhere.
    #[error("stiffness is {value} at arc length {s}, expected a positive, finite number")]
    Stiffness {
        /// Where.
        s: f64,
        /// Its value there.
        value: f64,
    },
    /// The natural curvature of a rod is not finite somewhere.
    #[error("natural curvature is {value} at arc length {s}, expected a finite number")]
    NaturalCurvature {
        /// Where.
        s: f64,
        /// Its value there.
        value: f64,
    },
    /// Stiffness or natural curvature of a rod have a jump, a kink or a pole, or vary too fast.
    #[error(
        "stiffness or natural curvature are not smooth near arc length {s}, expected smooth functions: make each jump and kink a border"
    )]
    NotSmooth {
        /// Where.
        s: f64,
    },
    /// The borders between the smooth parts of a rod are out of order.
    #[error("border at arc length {s}, expected more than {least} and less than the length of the rod")]
    Border {
        /// The border.
        s: f64,
        /// The one before it, or 0.
        least: f64,
    },
    /// A point of the natural curvature is not beyond the point before it.
    #[error("point {number} of natural_curvature has the arc length {s} m, expected {expected}")]
    CurvaturePoint {
        /// Its number, from 1.
        number: usize,
        /// Its arc length as given, m.
        s: f64,
        /// What was expected.
        expected: &'static str,
    },
    /// The points of the natural curvature do not begin at the clamp or do not end at the tip.
    #[error(
        "point {number} of natural_curvature has the arc length {s:?} m, expected {expected:?} m: the points go from 0 to the length of the rod, {length:?} m"
    )]
    CurvatureEnd {
        /// Number of the point, from 1: the first or the last one.
        number: usize,
        /// Its arc length as given, m.
        s: f64,
        /// What it should be, m: 0 or the length.
        expected: f64,
        /// The length of the rod, m.
        length: f64,
    },
    /// A rod crosses itself at rest.
    #[error(
        "the rod crosses itself at rest, at the arc lengths {one} and {other}, expected a shape at rest without a loop"
    )]
    CrossesItself {
        /// Where.
        one: f64,
        /// Where it comes back.
        other: f64,
    },
    /// A rod is coiled up at rest.
    #[error("the natural curvature turns the rod by {turn} rad at rest, expected at most {most} rad")]
    Coiled {
        /// Difference of its largest and its smallest slope angle at rest, rad.
        turn: f64,
        /// The limit.
        most: f64,
    },
    /// An integrator of differential equations gave up.
    #[cfg(feature = "std")]
    #[error("the integration stopped at arc length {s}: {reason}")]
    Integration {
        /// How far it came.
        s: f64,
        /// Why.
        reason: String,
    },
    /// A scalar root-finding failed.
    #[cfg(feature = "std")]
    #[error("no root of {what} found: {reason}")]
    NoRoot {
        /// Of which function.
        what: &'static str,
        /// Why.
        reason: String,
    },
}

/// An error that says `what` where `value` is not finite.
#[cfg(feature = "std")]
pub(crate) fn finite(what: &'static str, value: f64) -> Result<(), RodError> {
    if value.is_finite() { Ok(()) } else { Err(RodError::NotFinite { what, value }) }
}
