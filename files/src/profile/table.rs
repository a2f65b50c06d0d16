//! The table of a contour.

use super::{Profile, ProfilePoint};
use crate::output::write_csv;
use std::io::{self, Write};

/// The columns of contour.csv.
const COLUMNS: [&str; 6] = ["x", "y", "tangent_angle", "curvature", "arc_length", "object"];

/// Writes the points of contours as CSV, one point a row, SI units and radians.
///
/// # Errors
/// Those of `out`.
pub fn write_profile_table(profiles: &[Profile], out: &mut dyn Write) -> io::Result<()> {
    let rows = profiles.iter().flat_map(|profile| {
        profile.points.iter().map(|point| {
            let ProfilePoint { x, y, tangent_angle, curvature, arc_length } = *point;
            (x, y, tangent_angle, curvature, arc_length, profile.object)
        })
    });
    write_csv(out, &COLUMNS, rows)
}
