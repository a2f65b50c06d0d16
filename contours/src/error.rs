//! Errors of contours.

use std::fmt;

/// A line of the contract of [`Contour`](crate::Contour) that a shape breaks.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Broken {
    /// Number of the line.
    pub line: u8,
    /// The text of the line.
    pub says: &'static str,
    /// Where, the shape's own parameter.
    pub t: f64,
    /// The values found there.
    pub found: String,
}

impl Broken {
    pub(crate) fn new(line: u8, t: f64, found: String) -> Self {
        let says = match line {
            1 => "the frame is finite everywhere on the range",
            2 => "dr/dt = speed (cos alpha, sin alpha)",
            3 => "d alpha/dt = turning, and alpha does not jump",
            4 => "speed >= 0 and speed + |turning| > 0",
            5 => "the closest point's t lies in the range",
            7 => "the solid is on the left: gap > 0 against the normal, gap < 0 along it",
            9 => "the bounds contain the contour",
            _ => "curvature_in contains the curvature",
        };
        Self { line, says, t, found }
    }
}

impl fmt::Display for Broken {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { line, says, t, found } = self;
        write!(out, "breaks line {line} of the contract ({says}) at t = {t}: {found}")
    }
}

/// Why a contour could not be made. Pieces are counted from 1 in the messages and in the fields.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ContourError {
    /// A composite without pieces.
    #[error("a composite contour needs at least one piece, got none")]
    Empty,

    /// A number that is not finite.
    #[error("{what} is {value}, expected a finite number")]
    NotFinite {
        /// Which number.
        what: &'static str,
        /// Its value.
        value: f64,
    },

    /// A range without length, upside down, or with an end that is not a number.
    #[error("{what} runs from {from} to {to}, expected the start to be less than the end")]
    EmptyRange {
        /// Which range.
        what: &'static str,
        /// Its start.
        from: f64,
        /// Its end.
        to: f64,
    },

    /// A number that is not positive.
    #[error("{what} is {value}, expected a positive number")]
    NotPositive {
        /// Which number.
        what: &'static str,
        /// Its value.
        value: f64,
    },

    /// A value of a curve outside the limits that its author gave.
    #[error("{what} at t = {t} is {value}, but the limit of the part from {from} to {to} is {limit}; widen the limits")]
    BeyondLimit {
        /// Which value.
        what: &'static str,
        /// Where, the curve's parameter.
        t: f64,
        /// The value there.
        value: f64,
        /// The limit, which it exceeds or falls below.
        limit: f64,
        /// Start of the part.
        from: f64,
        /// End of the part.
        to: f64,
    },

    /// A line between two equal points.
    #[error("from and to are the same point ({x}, {y}), expected two different points")]
    SamePoint {
        /// First coordinate of the point.
        x: f64,
        /// Second coordinate of the point.
        y: f64,
    },

    /// An arc without length, or that goes round more than once.
    #[error("{what} runs from angle {from} to {to}, expected two different angles at most a full turn (2 pi) apart")]
    ArcAngle {
        /// Which arc.
        what: &'static str,
        /// Its first angle, rad.
        from: f64,
        /// Its last angle, rad.
        to: f64,
    },

    /// A curve whose speed vanishes: it has no tangent there.
    #[error(
        "{what} stands still at t = {t}, expected a positive speed everywhere; cut it there, or separate the points that coincide"
    )]
    Standstill {
        /// Which curve.
        what: &'static str,
        /// Parameter at which its speed is 0.
        t: f64,
    },

    /// A curve that jumps from one direction to another, where the angle cannot be followed.
    #[error("the direction of {what} jumps at t = {t}, expected a smooth curve; cut it there into two pieces")]
    Jump {
        /// Which curve.
        what: &'static str,
        /// Parameter at which the direction jumps.
        t: f64,
    },

    /// A function that is not finite somewhere on its range.
    #[error(
        "{what} is {value} at t = {t}, expected finite numbers on the whole range (up to 1e4 along an infinite one); trim the range"
    )]
    NotFiniteAt {
        /// Which number.
        what: &'static str,
        /// The parameter.
        t: f64,
        /// The value there.
        value: f64,
    },

    /// A part of a shape that is not within the shape.
    #[error("the part from {from} to {to} leaves the shape's range, {start} to {end}; expected a part of it")]
    NotWithin {
        /// Start of the part.
        from: f64,
        /// End of the part.
        to: f64,
        /// Start of the shape's range.
        start: f64,
        /// End of the shape's range.
        end: f64,
    },

    /// A piece of a composite whose own range or ends are unusable.
    #[error("piece {piece}: parameter runs from {from} to {to}, expected the start to be less than the end")]
    PieceRange {
        /// Number of the piece, from 1.
        piece: usize,
        /// Start of its range.
        from: f64,
        /// End of its range.
        to: f64,
    },

    /// A piece that breaks the contract of [`Contour`](crate::Contour), so that its contacts would be wrong.
    #[error("piece {piece} {broken}; test the shape with `contract::check`")]
    Contract {
        /// Number of the piece, from 1.
        piece: usize,
        /// Which line, and where.
        broken: Broken,
    },

    /// A piece is infinite, or ends in a point that is not finite, where it should meet its neighbour.
    #[error("piece {piece} has no finite end where it should meet piece {neighbour}; trim it, or use `joined`")]
    NoEnd {
        /// Number of the piece without an end, from 1.
        piece: usize,
        /// Number of the neighbour it should meet, from 1.
        neighbour: usize,
    },

    /// A contour comes back to its start after a number of turns that is not one.
    #[error(
        "the contour closes after {turns} turns, expected 1 (solid inside) or -1 (solid outside); it crosses itself"
    )]
    Loops {
        /// How many turns, counterclockwise ones counted as positive.
        turns: i32,
    },

    /// A contour that crosses itself, or touches itself at an angle.
    #[error("{what} {first} crosses {}, expected a contour that does not cross itself; {}", crossed(what, *first, *second, *x, *y), untangle(what))]
    Crosses {
        /// The kind of parts that are numbered: pieces or edges.
        what: &'static str,
        /// Number of the first of the two, from 1.
        first: usize,
        /// Number of the second, from 1; it may be the same one.
        second: usize,
        /// Coordinate of the crossing.
        x: f64,
        /// Coordinate of the crossing.
        y: f64,
    },

    /// A polygon without area: the sweep would not see the rod pass through it.
    #[error("the points enclose an area of {area:e}, no more than rounding; expected a polygon with an inside")]
    NoArea {
        /// The area, lengths squared.
        area: f64,
    },

    /// Points of a solid polygon in the order of a hole.
    #[error(
        "the points run clockwise, which would put the solid outside; reverse them; `reversed` makes a cavity of the polygon"
    )]
    Clockwise,

    /// Two consecutive pieces do not meet.
    #[error(
        "piece {piece} ends at ({x}, {y}), {distance:e} away from the start of piece {next}, expected at most {tolerance:e}"
    )]
    Apart {
        /// Number of the first of the two pieces, from 1.
        piece: usize,
        /// Number of the second, from 1.
        next: usize,
        /// Coordinate of the end of the first one.
        x: f64,
        /// Coordinate of the end of the first one.
        y: f64,
        /// Distance from there to the start of the second one, a length.
        distance: f64,
        /// The largest distance accepted, a length.
        tolerance: f64,
    },

    /// Two consecutive pieces do not cross.
    #[error(
        "piece {piece} does not enter the solid of piece {next} between t = {from} and t = {to}, expected a crossing from outside to inside"
    )]
    NoCrossing {
        /// Number of the first of the two pieces, from 1.
        piece: usize,
        /// Number of the second, from 1.
        next: usize,
        /// Where the search began, parameter of the first piece.
        from: f64,
        /// Where the search ended, parameter of the first piece.
        to: f64,
    },

    /// A piece leaves the composite before it has entered it: its neighbours hide it.
    #[error(
        "piece {piece} is met by the piece before it at t = {enters} but enters piece {next} already at t = {leaves}, expected a later crossing; the piece is hidden by its neighbours, leave it out"
    )]
    Hidden {
        /// Number of the hidden piece, from 1.
        piece: usize,
        /// Number of the piece after it, from 1.
        next: usize,
        /// Where the composite would come onto the piece, parameter of the piece.
        enters: f64,
        /// Where the composite would leave the piece, parameter of the piece.
        leaves: f64,
    },

    /// A negative number that must not be negative.
    #[error("{what} is {value}, expected a number not less than 0")]
    Negative {
        /// Which number.
        what: &'static str,
        /// Its value.
        value: f64,
    },

    /// Too few points for a curve.
    #[error("{what} needs at least {needed} points, got {count}")]
    TooFewPoints {
        /// Which curve.
        what: &'static str,
        /// How many points there are.
        count: usize,
        /// How many it needs.
        needed: usize,
    },

    /// A point of which a coordinate is not finite.
    #[error("point {point} is ({x}, {y}), expected finite numbers")]
    PointNotFinite {
        /// Number of the point, from 1.
        point: usize,
        /// Its x.
        x: f64,
        /// Its y.
        y: f64,
    },

    /// A point that does not lie apart from the one before it.
    #[error("point {point} is ({x}, {y}), the same as the one before it; leave one of them out")]
    RepeatedPoint {
        /// Number of the later of the two, from 1.
        point: usize,
        /// Its x.
        x: f64,
        /// Its y.
        y: f64,
    },

    /// A stored spline with a key of another kind.
    #[error("key {key} of the spline is of another kind, expected interpolation `stroke_bezier` with its two handles")]
    KeyKind {
        /// Number of the key, from 1.
        key: usize,
    },

    /// A stored spline with a number that is not finite.
    #[error("key {key} of the spline contains {value}, expected finite numbers")]
    KeyNotFinite {
        /// Number of the key, from 1.
        key: usize,
        /// The number.
        value: f64,
    },

    /// A stored spline whose parameters do not rise.
    #[error("key {key} of the spline is at t = {t}, expected more than the {before} of the key before it")]
    KeyOrder {
        /// Number of the key, from 1.
        key: usize,
        /// Its parameter.
        t: f64,
        /// The parameter of the key before it.
        before: f64,
    },

    /// A stored spline with a corner.
    #[error(
        "the spline turns by {turn} rad at its key {key}, expected both handles on one line through the point; make it two splines with a corner"
    )]
    Kink {
        /// Number of the key, from 1.
        key: usize,
        /// The angle by which the direction jumps, rad.
        turn: f64,
    },
}

/// The crossed part and the place, for a message.
fn crossed(what: &str, first: usize, second: usize, x: f64, y: f64) -> String {
    let other = if first == second { "itself".to_owned() } else { format!("{what} {second}") };
    format!("{other} at ({x}, {y})")
}

/// The remedy, for a message.
fn untangle(what: &str) -> &'static str {
    if what == "edge" {
        "put the points in the order in which they are passed"
    } else {
        "trim the pieces, or move them apart"
    }
}

#[cfg(test)]
mod tests {
    use crate::{Composite, Contour, Parabola, Range};

    fn bump(x: f64, y: f64) -> Box<dyn Contour> {
        Box::new(Parabola::new([x, y], 5.0).unwrap())
    }

    fn part(from: f64, to: f64) -> Box<dyn Contour> {
        Box::new(Parabola::new([0.0, 0.0], 1.0).unwrap().between(from, to).unwrap())
    }

    fn message<T: std::fmt::Debug>(result: Result<T, super::ContourError>) -> String {
        result.unwrap_err().to_string()
    }

    #[test]
    fn numbers() {
        assert_eq!(
            message(Parabola::new([0.0, f64::NAN], 1.0)),
            "y of the parabola's vertex is NaN, expected a finite number"
        );
        let shape = Parabola::new([0.0, 0.0], 1.0).unwrap();
        assert_eq!(
            message(shape.between(2.0, 1.0)),
            "x of the trimmed parabola runs from 2 to 1, expected the start to be less than the end"
        );
        assert!(shape.between(1.0, 1.0).is_err() && shape.between(f64::NAN, 1.0).is_err());
    }

    #[test]
    fn pieces_that_do_not_meet() {
        assert_eq!(message(Composite::new(Vec::new())), "a composite contour needs at least one piece, got none");
        assert!(Composite::joined(Vec::new()).is_err());
        assert_eq!(
            message(Composite::new(vec![part(0.0, 1.0), part(1.5, 2.0)])),
            "piece 1 ends at (1, 1), 1.346291201783626e0 away from the start of piece 2, expected at most 4e-9"
        );
        assert_eq!(
            message(Composite::new(vec![part(0.0, 1.0), bump(0.0, 0.0)])),
            "piece 2 has no finite end where it should meet piece 1; trim it, or use `joined`"
        );
    }

    #[test]
    fn pieces_that_do_not_cross() {
        let error = message(Composite::joined(vec![bump(0.0, 0.0), bump(0.0, 1.0)]));
        assert!(error.starts_with("piece 1 does not enter the solid of piece 2"), "{error}");
        let error = message(Composite::joined(vec![bump(0.0, 0.0), bump(0.1, 1.0), bump(0.2, 0.0)]));
        assert!(error.starts_with("piece 2 is met by the piece before it at t = "), "{error}");
        assert!(error.contains("enters piece 3 already"), "{error}");
    }

    #[test]
    fn shapes_without_a_range() {
        #[derive(Debug)]
        struct Nothing;
        impl Contour for Nothing {
            fn frame(&self, t: f64) -> crate::Frame {
                crate::Frame { x: t, y: 0.0, alpha: 0.0, speed: 1.0, turning: 0.0 }
            }
            fn range(&self) -> Range {
                Range { from: 1.0, to: 1.0 }
            }
        }
        let expected = "piece 1: parameter runs from 1 to 1, expected the start to be less than the end";
        assert_eq!(message(Composite::new(vec![Box::new(Nothing)])), expected);
        assert_eq!(message(Composite::joined(vec![Box::new(Nothing), bump(0.0, 0.0)])), expected);
    }
}
