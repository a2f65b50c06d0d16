//! The stretches of a contour as one scan, or several, determine it, and the gaps between them.

use super::trace::{Trace, TraceKind, TracePoint};
use std::fmt;
use std::ops::Range;

/// Why there is a gap.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum GapReason {
    /// Several contacts. Their points are kept as traces of their own kinds.
    Several,
    /// The rod touched nothing.
    Free,
    /// The contact leapt between two samples: a snap or a slip.
    Leap,
    /// There is no contact point, for the reason that the first of the samples gave.
    NoAnswer(String),
}

impl fmt::Display for GapReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Several => f.pad("several contacts"),
            Self::Free => f.pad("no contact"),
            Self::Leap => f.pad("the contact leapt"),
            Self::NoAnswer(reason) => f.pad(reason),
        }
    }
}

/// A part of a scan in which the contour is not known, or a leap between two samples.
#[derive(Clone, Debug, PartialEq)]
pub struct Gap {
    /// The samples, numbered from 0; empty for a leap, which happens before the sample at which the range starts.
    pub samples: Range<usize>,
    /// Last point of single contact before it, m; none at the start of the scan.
    pub from: Option<[f64; 2]>,
    /// First point of single contact after it, m; none at the end of the scan.
    pub to: Option<[f64; 2]>,
    /// Why.
    pub reason: GapReason,
}

/// The parts of a contour that are known, and the gaps between them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ContourEstimate {
    /// Stretches that were followed: those of single contacts, then those of first and of second contacts, each in the
    /// order of the samples.
    pub traces: Vec<Trace>,
    /// Parts of the scan without points of a single contact, in the order of the samples.
    pub gaps: Vec<Gap>,
}

/// A point of a trace as a line of a table, SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct TraceRow {
    /// Number of the trace, from 0.
    pub stretch: usize,
    /// Which contacts it is made of.
    pub kind: TraceKind,
    /// Position, m.
    pub x: f64,
    /// Position, m.
    pub y: f64,
    /// Tangent angle, radians.
    pub alpha: f64,
    /// Standard deviation across the contour, m.
    pub sigma: f64,
    /// The part of it that errors cause which all samples of a scan share, m.
    pub sigma_systematic: f64,
}

impl ContourEstimate {
    /// The traces of one kind.
    pub fn of_kind(&self, kind: TraceKind) -> impl Iterator<Item = &Trace> {
        self.traces.iter().filter(move |trace| trace.kind == kind)
    }

    /// All points, with the number and the kind of their trace: the columns
    /// `stretch,kind,x,y,alpha,sigma,sigma_systematic`.
    pub fn rows(&self) -> impl Iterator<Item = TraceRow> {
        self.traces.iter().enumerate().flat_map(|(stretch, trace)| {
            let kind = trace.kind;
            trace.points.iter().map(move |&TracePoint { x, y, alpha, sigma, systematic }| TraceRow {
                stretch,
                kind,
                x,
                y,
                alpha,
                sigma,
                sigma_systematic: systematic,
            })
        })
    }
}
