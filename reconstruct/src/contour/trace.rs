//! A stretch of the contour from one run of samples.

use std::fmt;
use std::ops::Range;

/// Which contacts a trace is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "lowercase"))]
pub enum TraceKind {
    /// Those of samples with one contact.
    Single,
    /// The first contacts of samples with several.
    First,
    /// The second contacts of samples with several.
    Second,
}

impl fmt::Display for TraceKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Single => "single",
            Self::First => "first",
            Self::Second => "second",
        })
    }
}

/// A point of a trace, SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct TracePoint {
    /// Position, m.
    pub x: f64,
    /// Position, m.
    pub y: f64,
    /// Tangent angle of the contour, radians, in (-pi, pi].
    pub alpha: f64,
    /// Standard deviation of the contour across its tangent, m.
    pub sigma: f64,
    /// The part of it that errors cause which all samples of a scan share, m.
    pub systematic: f64,
}

/// A stretch of the contour that the contact followed through consecutive samples, as points along the contour.
///
/// The points are in the direction of contours, with the solid on the left, whichever way the scan went. Points that were left out
/// depart from the polygon through the others by no more than half a standard deviation, or the tolerance of
/// [`Assembly`](crate::Assembly) where that is larger.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Trace {
    /// Which contacts.
    pub kind: TraceKind,
    /// The samples it is made of, numbered from 0; in a merged contour those of one of its scans.
    pub samples: Range<usize>,
    /// Whether the scan passed the points from the last to the first.
    pub reversed: bool,
    /// The points, one at least.
    pub points: Vec<TracePoint>,
}

impl Trace {
    /// Its length along the points, m.
    pub fn length(&self) -> f64 {
        self.points.windows(2).map(|pair| (pair[1].x - pair[0].x).hypot(pair[1].y - pair[0].y)).sum()
    }

    /// Where the scan entered it, m.
    pub fn entered(&self) -> Option<[f64; 2]> {
        self.end(self.reversed)
    }

    /// Where the scan left it, m.
    pub fn left(&self) -> Option<[f64; 2]> {
        self.end(!self.reversed)
    }

    fn end(&self, last: bool) -> Option<[f64; 2]> {
        let point = if last { self.points.last() } else { self.points.first() };
        point.map(|point| [point.x, point.y])
    }
}
