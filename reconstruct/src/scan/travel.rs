//! The path length of the clamp, and whether it moves on.

use rod_core::{Pose, Rod};

/// Why a pose does not continue the path of the clamp.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Halt {
    /// The pose is that of the sample before.
    #[error("the pose is that of the usable sample before, expected a clamp that moves")]
    Repeated,
    /// The clamp moves backwards.
    #[error("the pose turns back, expected a clamp that goes on in one direction")]
    TurnsBack,
}

/// The path length of the clamp, over the poses that continue its path.
///
/// Distances are those of (x, y, L phi). The direction of the path is the mean of the last steps. A step that is longer than
/// twice the path so far starts a new direction, so that of a clamp that trembles before it sets off only the trembling is
/// lost.
///
/// ```
/// use rod_core::{Pose, Rod};
/// use rod_reconstruct::{Halt, Travel};
/// let mut travel = Travel::new(&Rod::new(0.1, 1e-3)?);
/// let at = |x| Pose { x, y: 0.0, phi: 1.5 };
/// assert_eq!((travel.go(&at(0.0)), travel.go(&at(-1e-3))), (Ok(0.0), Ok(1e-3)));
/// assert_eq!(travel.go(&at(-0.5e-3)), Err(Halt::TurnsBack));
/// # Ok::<(), rod_core::RodError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Travel {
    /// Rod length, m, by which angles become lengths.
    length: f64,
    last: Option<[f64; 3]>,
    /// Sum of the unit vectors of the last steps, older ones with less weight.
    direction: [f64; 3],
    /// Path length, m.
    way: f64,
}

/// Steps shorter than this (rod lengths) are rounding, and count as no movement.
const STANDING: f64 = 1e-12;
/// Factor on the weight of earlier steps in the direction, with each new step. At 0.9 about ten steps count. Smaller: a clamp
/// that trembles sideways is taken for one that turns back.
const KEPT: f64 = 0.9;
/// A step this many times as long as the whole path before it starts a new direction.
const ANEW: f64 = 2.0;

impl Travel {
    /// A clamp of this rod that has not moved yet.
    pub fn new(rod: &Rod) -> Self {
        Self { length: rod.length(), last: None, direction: [0.0; 3], way: 0.0 }
    }

    /// Moves on to a pose (m, radians; finite), and returns the path length up to there, m.
    ///
    /// # Errors
    /// [`Halt`] where the pose does not continue the path; it is left out.
    pub fn go(&mut self, pose: &Pose) -> Result<f64, Halt> {
        let here = [pose.x, pose.y, self.length * pose.phi];
        let Some(last) = self.last else {
            self.last = Some(here);
            return Ok(0.0);
        };
        let step: [f64; 3] = std::array::from_fn(|i| here[i] - last[i]);
        let distance = dot(&step, &step).sqrt();
        if distance < STANDING * self.length || distance.is_nan() {
            return Err(Halt::Repeated);
        }
        let back = dot(&step, &self.direction) < 0.0;
        let anew = distance > ANEW * self.way;
        if back && !anew {
            return Err(Halt::TurnsBack);
        }
        let kept = if anew { 0.0 } else { KEPT };
        self.direction = std::array::from_fn(|i| kept * self.direction[i] + step[i] / distance);
        self.way += distance;
        self.last = Some(here);
        Ok(self.way)
    }
}

fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Which of these abscissas are gone on to.
    fn kept(abscissas: &[f64]) -> Vec<f64> {
        let mut travel = Travel::new(&Rod::new(0.1, 1.0).unwrap());
        let mut kept = abscissas.to_vec();
        kept.retain(|&x| travel.go(&Pose { x, y: 0.3, phi: 1.0 }).is_ok());
        kept
    }

    #[test]
    fn a_step_back_is_left_out_until_it_is_made_good() {
        assert_eq!(kept(&[5.0, 4.0, 3.0, 3.5, 3.1, 3.0, 2.0, 1.0]), [5.0, 4.0, 3.0, 2.0, 1.0]);
        assert_eq!(kept(&[1.0, 2.0, 3.0, 2.0, 1.0]), [1.0, 2.0, 3.0]);
    }

    #[test]
    fn a_clamp_that_trembles_first() {
        let found = kept(&[0.0, -1e-9, 1e-9, -2e-9, -1e-9, 1e-6, 2e-6, 3e-6, 2.5e-6, 4e-6]);
        assert_eq!(found[found.len() - 4..], [1e-6, 2e-6, 3e-6, 4e-6]);
    }

    #[test]
    fn sideways_and_around() {
        let mut travel = Travel::new(&Rod::new(0.1, 1.0).unwrap());
        for k in 0..1000 {
            // Once around a circle, trembling by half a step across, turning on the spot, and straight on.
            let angle = k as f64 * 1e-2;
            let radius = 1.0 + 5e-3 * f64::from(k % 2);
            assert_eq!(
                travel.go(&Pose { x: radius * angle.cos(), y: radius * angle.sin(), phi: 0.0 }).map(|_| ()),
                Ok(())
            );
        }
        let mut turning = Travel::new(&Rod::new(0.1, 1.0).unwrap());
        assert_eq!(turning.go(&Pose { x: 0.0, y: 0.0, phi: 0.0 }).map(|_| ()), Ok(()));
        assert_eq!(turning.go(&Pose { x: 0.0, y: 0.0, phi: 0.1 }).map(|_| ()), Ok(()));
        assert_eq!(turning.go(&Pose { x: 0.0, y: 0.0, phi: 0.1 + 1e-14 }), Err(Halt::Repeated));
        assert_eq!(turning.go(&Pose { x: 0.0, y: 0.0, phi: 0.05 }), Err(Halt::TurnsBack));
    }
}
