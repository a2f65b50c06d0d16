//! The way of a stage over its time.

use super::physics::InFrame;
use vibrissa::Pose;

/// Part of the way, and of the turn, within which a clamp stands: more than the resolution of a stage, and less than matters.
pub(super) const STILL: f64 = 1e-3;

/// Poses of the clamp on the stage's clock.
#[derive(Clone, Debug)]
pub(super) struct StageLog(Vec<(f64, Pose)>);

impl StageLog {
    /// Of rows in the order of time; none with fewer than two.
    pub fn new(rows: Vec<(f64, Pose)>) -> Option<Self> {
        (rows.len() > 1 && rows.windows(2).all(|pair| pair[0].0 < pair[1].0)).then_some(Self(rows))
    }

    /// With the times from `origin` (s) on.
    pub fn since(self, origin: f64) -> Self {
        Self(self.0.into_iter().map(|(t, pose)| (t - origin, pose)).collect())
    }

    /// Times and poses in the order of time.
    pub fn rows(&self) -> &[(f64, Pose)] {
        &self.0
    }

    /// First and last time, s.
    pub fn span(&self) -> [f64; 2] {
        [self.0[0].0, self.0[self.0.len() - 1].0]
    }

    /// The pose at a time; before the first and after the last row the clamp is taken to stand.
    pub fn at(&self, t: f64) -> Pose {
        let after = self.0.partition_point(|row| row.0 < t);
        match (after.checked_sub(1).map(|before| self.0[before]), self.0.get(after)) {
            (Some((earlier, from)), Some(&(later, to))) => {
                let share = (t - earlier) / (later - earlier);
                let between = |from: f64, to: f64| from + share * (to - from);
                Pose { x: between(from.x, to.x), y: between(from.y, to.y), phi: between(from.phi, to.phi) }
            }
            (None, Some(row)) => row.1,
            (last, None) => last.unwrap_or(self.0[0]).1,
        }
    }

    /// How far the clamp goes from its first pose, m, and how far it turns, rad.
    pub fn extent(&self) -> [f64; 2] {
        let first = &self.0[0].1;
        let most = |of: &dyn Fn(&Pose) -> f64| self.0.iter().map(|row| of(&row.1)).fold(0.0, f64::max);
        [most(&|pose| distance(pose, first)), most(&|pose| (pose.phi - first.phi).abs())]
    }

    /// When the clamp leaves its first and reaches its last pose, and its largest speed between, over a hundredth of the time, m/s; none if it stands.
    pub fn motion(&self) -> Option<([f64; 2], f64)> {
        let (first, last) = (self.0[0].1, self.0[self.0.len() - 1].1);
        let [size, turn] = self.extent();
        let leaves = |from: &Pose, pose: &Pose| {
            distance(from, pose) > STILL * size || (pose.phi - from.phi).abs() > STILL * turn.max(f64::MIN_POSITIVE)
        };
        let start = self.0.iter().position(|row| leaves(&first, &row.1))?.checked_sub(1)?;
        let end = (self.0.iter().rposition(|row| leaves(&last, &row.1))? + 1).min(self.0.len() - 1);
        let [from, to] = self.span();
        let step = (to - from) / 100.0;
        let speeds = (0..100).map(|k| {
            let t = from + f64::from(k) * step;
            distance(&self.at(t), &self.at(t + step)) / step
        });
        Some(([self.0[start].0, self.0[end].0], speeds.fold(0.0, f64::max)))
    }

    /// In the units and signs of a hypothesis.
    pub fn in_frame(&self, frame: &InFrame) -> Self {
        Self(self.0.iter().map(|(t, pose)| (*t, frame.pose(*pose))).collect())
    }
}

/// Way from one pose to another, m.
pub(super) fn distance(a: &Pose, b: &Pose) -> f64 {
    (a.x - b.x).hypot(a.y - b.y)
}
