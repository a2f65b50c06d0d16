//! A stage whose positions were logged.

use super::{StageError, StageSource};
use rod_core::Pose;
use std::f64::consts::PI;

/// A stage whose poses were logged: between two of them they are interpolated linearly, beyond the first and last there are
/// none.
///
/// ```
/// use rod_core::Pose;
/// use rod_hw::{StageError, StageSource, StageTable};
/// let pose = |x| Pose { x, y: -0.04, phi: 1.571 };
/// let mut stage = StageTable::new(vec![(0.0, pose(0.08)), (1.0, pose(0.079)), (3.0, pose(0.075))])?;
/// assert!((stage.pose_at(2.0)?.x - 0.077).abs() < 1e-15);
/// assert_eq!(stage.pose_at(3.5), Err(StageError::Outside { t: 3.5, from: 0.0, to: 3.0 }));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct StageTable {
    rows: Vec<(f64, Pose)>,
}

impl StageTable {
    /// From times (s, strictly growing) and poses there (m, m, rad).
    ///
    /// # Errors
    /// [`StageError`] with the row.
    pub fn new(rows: Vec<(f64, Pose)>) -> Result<Self, StageError> {
        if rows.len() < 2 {
            return Err(StageError::Short { found: rows.len() });
        }
        let mut last: Option<(f64, Pose)> = None;
        for (row, &(t, pose)) in (1..).zip(&rows) {
            for (what, value) in [("the time", t), ("x", pose.x), ("y", pose.y), ("the angle", pose.phi)] {
                if !value.is_finite() {
                    return Err(StageError::RowNotFinite { row, what, value });
                }
            }
            if let Some((before, pose_before)) = last {
                let jump = pose.phi - pose_before.phi;
                if t <= before {
                    return Err(StageError::NotGrowing { row, t, before });
                }
                if jump.abs() >= PI {
                    return Err(StageError::Turns { row, jump });
                }
            }
            last = Some((t, pose));
        }
        Ok(Self { rows })
    }

    /// Times (s) and poses.
    pub fn rows(&self) -> &[(f64, Pose)] {
        &self.rows
    }
}

impl StageSource for StageTable {
    fn pose_at(&mut self, t: f64) -> Result<Pose, StageError> {
        if !t.is_finite() {
            return Err(StageError::NotFinite { t });
        }
        let after = self.rows.partition_point(|row| row.0 < t);
        let outside = || {
            let ends = self.rows.first().zip(self.rows.last());
            let (from, to) = ends.map_or((f64::NAN, f64::NAN), |(first, last)| (first.0, last.0));
            StageError::Outside { t, from, to }
        };
        let &(later, to) = self.rows.get(after).ok_or_else(outside)?;
        if later == t {
            return Ok(to);
        }
        let &(earlier, from) = after.checked_sub(1).and_then(|before| self.rows.get(before)).ok_or_else(outside)?;
        let share = (t - earlier) / (later - earlier);
        let between = |from: f64, to: f64| from + share * (to - from);
        Ok(Pose { x: between(from.x, to.x), y: between(from.y, to.y), phi: between(from.phi, to.phi) })
    }
}
