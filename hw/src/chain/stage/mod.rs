//! The pose of the clamp at a time.

mod constant_speed;
#[cfg(feature = "std")]
mod table;

pub use constant_speed::{ConstantSpeed, Velocity};
#[cfg(feature = "std")]
pub use table::StageTable;

use rod_core::Pose;

/// A source of clamp poses: where the stage has the clamp at a time. A closure of the time is one.
///
/// ```
/// use rod_core::Pose;
/// use rod_hw::StageSource;
/// let mut stage = |t: f64| Ok(Pose { x: 0.08 - 1e-3 * t, y: -0.04, phi: 1.5 + 0.01 * t.sin() });
/// assert_eq!(stage.pose_at(10.0)?.x, 0.07);
/// # Ok::<(), rod_hw::StageError>(())
/// ```
pub trait StageSource {
    /// Pose of the clamp (m, m, rad) at time `t` (s, on the clock of the samples).
    ///
    /// # Errors
    /// [`StageError`] where that is not known: a stage does not extrapolate.
    fn pose_at(&mut self, t: f64) -> Result<Pose, StageError>;
}

/// Why there is no pose, or no table of poses.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StageError {
    /// The time lies outside of what is known.
    #[error(
        "the stage is known from {from} s to {to} s, expected to cover the sample at {t} s; record the stage longer, or shift its clock"
    )]
    Outside {
        /// The requested time, s.
        t: f64,
        /// The first time known, s.
        from: f64,
        /// The last time known, s.
        to: f64,
    },
    /// The time, or the pose there, is no number.
    #[error("the pose at {t} s is not finite, expected finite numbers of m, m and rad")]
    NotFinite {
        /// The requested time, s.
        t: f64,
    },
    /// A motion that arrives before it leaves.
    #[error("the motion ends at {to} s, expected a time after its start at {from} s")]
    Backwards {
        /// When it leaves, s.
        from: f64,
        /// When it arrives, s.
        to: f64,
    },
    /// A table with nothing to interpolate.
    #[error("{found} rows, expected at least 2")]
    Short {
        /// How many there are.
        found: usize,
    },
    /// A time or a pose is no number.
    #[error("row {row}: {what} is {value}, expected a finite number")]
    RowNotFinite {
        /// Which row, from 1.
        row: usize,
        /// Its description.
        what: &'static str,
        /// Its value.
        value: f64,
    },
    /// Time stands still or runs back.
    #[error("row {row}: the time is {t} s, expected more than {before} s, that of the row before")]
    NotGrowing {
        /// Which row, from 1.
        row: usize,
        /// Its time, s.
        t: f64,
        /// The time of the row before, s.
        before: f64,
    },
    /// An angle that jumps by a whole turn.
    #[error(
        "row {row}: the angle jumps by {jump} rad, expected less than half a turn from row to row; take out the whole turns"
    )]
    Turns {
        /// Which row, from 1.
        row: usize,
        /// From the row before, rad.
        jump: f64,
    },
}

/// Whether a time and a pose are numbers.
fn finite(t: f64, pose: &Pose) -> Result<(), StageError> {
    let good = [t, pose.x, pose.y, pose.phi].iter().all(|value| value.is_finite());
    if good { Ok(()) } else { Err(StageError::NotFinite { t }) }
}

/// A closure of the time (s) is a stage.
impl<F: FnMut(f64) -> Result<Pose, StageError>> StageSource for F {
    fn pose_at(&mut self, t: f64) -> Result<Pose, StageError> {
        self(t)
    }
}
