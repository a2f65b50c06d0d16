//! Where a row is.

use std::fmt;

/// Where a row of a recording is, counted from 1: a line of a table, or a sample of what a sensor sent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// A line of the file.
    Line(u64),
    /// A sample. In a table, rows of numbers are counted.
    Sample(u64),
}

impl Place {
    /// Several of one kind, the first of them by number: "line 3", or "lines 3, 4, 5, 6, 7 and 12 more".
    pub(super) fn several(places: &[Self], most: usize) -> String {
        let numbers: Vec<String> = places.iter().take(most).map(|place| place.number().to_string()).collect();
        let kind = places.first().map_or("line", |place| place.kind());
        let plural = if places.len() == 1 { "" } else { "s" };
        let more = places.len().saturating_sub(most);
        let more = if more > 0 { format!(" and {more} more") } else { String::new() };
        format!("{kind}{plural} {}{more}", numbers.join(", "))
    }

    fn kind(self) -> &'static str {
        match self {
            Self::Line(_) => "line",
            Self::Sample(_) => "sample",
        }
    }

    fn number(self) -> u64 {
        match self {
            Self::Line(number) | Self::Sample(number) => number,
        }
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.kind(), self.number())
    }
}
