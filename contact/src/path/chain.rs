//! Legs one after another.

use super::{ClampPath, Path, PathPoint};
use crate::error::ContactError;
use rod_core::Pose;
use std::fmt;
use std::sync::Arc;

/// Largest distance between the end of a leg and the start of the next one, relative to the largest coordinate of the begin, middle and
/// end of any leg, and largest difference of angles, rad: the rounding of poses that were computed.
const APART: f64 = 1e-9;

/// Paths one after another, each from where the one before ends. The sweep reports the last pose of each leg, and states tell their
/// leg ([`State::leg`](crate::State::leg)).
///
/// Its parameter is that of its legs, one after another.
///
/// ```
/// use rod_contact::{Chain, Path};
/// use rod_core::Pose;
/// let clamp = |x, y| Pose { x, y, phi: 1.5 };
/// let there_and_back = Chain::polyline(&[clamp(0.0, 0.0), clamp(0.1, 0.0), clamp(0.0, 0.0)])?;
/// assert_eq!((there_and_back.legs().len(), there_and_back.length()), (2, 0.2));
/// assert!((there_and_back.point(0.15).pose.x - 0.05).abs() < 1e-15);
/// // legs of several kinds
/// use rod_contact::{ClampArc, ClampPath};
/// use std::sync::Arc;
/// let approach = ClampPath::new(clamp(0.0, -0.1), clamp(0.0, 0.0))?;
/// let turn = ClampArc::about(clamp(0.0, 0.0), [0.0, -0.05], -0.5)?;
/// let legs: Vec<Arc<dyn Path>> = vec![Arc::new(approach), Arc::new(turn)];
/// assert_eq!(Chain::new(legs)?.legs().len(), 2);
/// # Ok::<(), rod_contact::ContactError>(())
/// ```
#[derive(Clone)]
pub struct Chain {
    legs: Vec<Arc<dyn Path>>,
    length: f64,
}

impl Chain {
    /// The legs in order.
    ///
    /// # Errors
    /// [`ContactError::Apart`] where a leg does not begin where the one before ends, [`ContactError::NoLegs`].
    pub fn new(legs: Vec<Arc<dyn Path>>) -> Result<Self, ContactError> {
        let legs: Vec<_> = legs.iter().flat_map(flat).collect();
        if legs.is_empty() {
            return Err(ContactError::NoLegs);
        }
        let poses = legs.iter().flat_map(|leg| [0.0, 0.5, 1.0].map(|part| leg.point(part * leg.length()).pose));
        let largest = poses.map(|pose| pose.x.abs().max(pose.y.abs())).fold(0.0, f64::max);
        for (leg, pair) in legs.windows(2).enumerate() {
            let [ends, starts] = [pair[0].point(pair[0].length()).pose, pair[1].point(0.0).pose];
            let apart = (starts.x - ends.x).hypot(starts.y - ends.y);
            let near = apart <= APART * largest && (ends.phi - starts.phi).abs() <= APART;
            if !near {
                return Err(ContactError::Apart { leg: leg + 1, ends, starts });
            }
        }
        let length = legs.iter().map(|leg| leg.length()).sum();
        Ok(Self { legs, length })
    }

    /// Straight legs from pose to pose.
    ///
    /// # Errors
    /// Those of [`ClampPath::new`], [`ContactError::NoLegs`] of fewer than two poses.
    pub fn polyline(poses: &[Pose]) -> Result<Self, ContactError> {
        let legs = poses.windows(2).map(|pair| Ok(Arc::new(ClampPath::new(pair[0], pair[1])?) as Arc<dyn Path>));
        Self::new(legs.collect::<Result<_, _>>()?)
    }
}

/// A leg, or the legs that it consists of.
fn flat(leg: &Arc<dyn Path>) -> Vec<Arc<dyn Path>> {
    if leg.legs().is_empty() { vec![leg.clone()] } else { leg.legs().iter().flat_map(flat).collect() }
}

impl fmt::Debug for Chain {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { legs, length } = self;
        f.debug_struct("Chain").field("legs", &legs.len()).field("length", length).finish()
    }
}

impl Path for Chain {
    fn point(&self, t: f64) -> PathPoint {
        let mut before = 0.0;
        let last = self.legs.len() - 1;
        for leg in &self.legs[..last] {
            if t < before + leg.length() {
                return leg.point(t - before);
            }
            before += leg.length();
        }
        self.legs[last].point(t - before)
    }

    fn length(&self) -> f64 {
        self.length
    }

    fn legs(&self) -> &[Arc<dyn Path>] {
        &self.legs
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::path::ClampArc;

    #[test]
    fn legs_that_do_not_meet_are_refused() {
        let pose = |x| Pose { x, y: 0.0, phi: 0.0 };
        let leg = |from, to| Arc::new(ClampPath::new(pose(from), pose(to)).unwrap()) as Arc<dyn Path>;
        let error = Chain::new(vec![leg(0.0, 1.0), leg(1.0, 2.0), leg(2.1, 3.0)]).unwrap_err();
        assert!(matches!(error, ContactError::Apart { leg: 2, .. }), "{error}");
        assert_eq!(Chain::new(Vec::new()).unwrap_err(), ContactError::NoLegs);
    }

    /// Such a leg was refused: it begins at 0, and the one before ends 1e-17 beside.
    #[test]
    fn a_leg_may_begin_at_the_origin_after_a_turn_about_a_pivot() {
        let turn = ClampArc::about(Pose { x: 0.0, y: 0.0, phi: 0.0 }, [0.3, 0.1], std::f64::consts::TAU).unwrap();
        let end = turn.point(turn.length()).pose;
        let next = ClampPath::new(Pose { x: 0.0, y: 0.0, ..end }, Pose { x: 0.1, y: 0.0, ..end }).unwrap();
        let legs: Vec<Arc<dyn Path>> = vec![Arc::new(turn), Arc::new(next)];
        assert_eq!(Chain::new(legs).unwrap().legs().len(), 2);
        let on_the_spot = ClampPath::new(Pose { x: 0.0, y: 0.0, phi: 0.0 }, Pose { x: 0.0, y: 0.0, phi: 1.0 }).unwrap();
        let away = ClampPath::new(Pose { x: 0.0, y: 0.0, phi: 1.0 }, Pose { x: 0.1, y: 0.0, phi: 1.0 }).unwrap();
        assert!(Chain::new(vec![Arc::new(on_the_spot) as Arc<dyn Path>, Arc::new(away)]).is_ok());
    }

    #[test]
    fn chains_of_chains_are_chains_of_their_legs() {
        let from = Pose { x: 1.0, y: 0.0, phi: 0.5 };
        let arc = ClampArc::about(from, [0.0, 0.0], 1.0).unwrap();
        let mid = arc.point(arc.length()).pose;
        let back = ClampArc::about(mid, [0.0, 0.0], -1.0).unwrap();
        let loop_ = Arc::new(Chain::new(vec![Arc::new(arc), Arc::new(back)]).unwrap()) as Arc<dyn Path>;
        let twice = Chain::new(vec![loop_.clone(), loop_]).unwrap();
        assert_eq!((twice.legs().len(), twice.length()), (4, 4.0));
        let end = twice.point(4.0).pose;
        assert!((end.x - 1.0).abs() < 1e-15 && (end.phi - 0.5).abs() < 1e-15);
    }
}
