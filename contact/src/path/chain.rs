//! Legs one after another.

use super::{ClampPath, Path, PathPoint};
use crate::error::ContactError;
use rod_core::Pose;
use std::fmt;
use std::sync::Arc;

/// Largest distance between the end of a leg and the start of the next one, relative to the way of both, and largest difference of
/// angles, rad: the rounding of poses that were computed.
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
        for (leg, pair) in legs.windows(2).enumerate() {
            let [ends, starts] = [pair[0].point(pair[0].length()).pose, pair[1].point(0.0).pose];
            let begins = pair[0].point(0.0).pose;
            let scale = way(begins, ends) + ends.x.abs() + ends.y.abs();
            let near = way(ends, starts) <= APART * scale && (ends.phi - starts.phi).abs() <= APART;
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

fn way(from: Pose, to: Pose) -> f64 {
    (to.x - from.x).hypot(to.y - from.y)
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
