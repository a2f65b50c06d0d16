//! A part of a scan without contact points of a single contact.

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
