//! Contact points of a scan become stretches of a contour.
//!
//! [`Assembly`] takes the samples apart into consecutive runs of a kind, `leaps` cuts these where the contact leaps, `bins` averages the
//! points, `smooth` fits the bins with their tangents, and `line` puts them in order and leaves out what a polygon does not need
//! (`simplify`). [`Assembly`] does all this; the result is a [`ContourEstimate`] of [`Trace`]s and [`Gap`]s.

mod assembly;
mod bins;
mod estimate;
mod leaps;
mod line;
mod measured;
mod scatter;
mod simplify;
mod smooth;
#[cfg(test)]
mod tests;
mod trace;

pub use assembly::Assembly;
pub use estimate::{ContourEstimate, Gap, GapReason, TraceRow};
pub use measured::Measured;
#[cfg(feature = "contact")]
pub(crate) use simplify::corners;
pub(crate) use simplify::simplify;
pub use trace::{Trace, TraceKind, TracePoint};
