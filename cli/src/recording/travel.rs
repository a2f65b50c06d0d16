//! Whether the clamp goes on.

use super::row::RowProblem;
use vibrissa::Pose;

/// The way of the clamp so far, over the rows that could be used.
#[derive(Debug)]
pub(super) struct Travel {
    /// Rod length, which makes a length of an angle.
    length: f64,
    /// The last pose, and its line.
    last: Option<([f64; 3], u64)>,
    /// Sum of the directions of the last steps, each new one weighing more.
    direction: [f64; 3],
    /// Length of the way.
    way: f64,
}

/// Movements shorter than this, in rod lengths, are rounding.
const STANDING: f64 = 1e-12;
/// What a direction keeps of its weight with each step after it: some ten steps count, so that a clamp that trembles
/// sideways is no clamp that turns back.
const KEPT: f64 = 0.9;
/// A step this many times as long as the whole way before it starts anew.
const ANEW: f64 = 2.0;

impl Travel {
    pub fn new(length: f64) -> Self {
        Self { length, last: None, direction: [0.0; 3], way: 0.0 }
    }

    /// Goes on to the pose on a line, if that is one to go on to.
    pub fn go(&mut self, pose: &Pose, line: u64) -> Result<(), RowProblem> {
        let here = [pose.x, pose.y, self.length * pose.phi];
        let Some((last, of)) = self.last else {
            self.last = Some((here, line));
            return Ok(());
        };
        let step: [f64; 3] = std::array::from_fn(|i| here[i] - last[i]);
        let distance = dot(&step, &step).sqrt();
        if distance < STANDING * self.length {
            return Err(RowProblem::Repeated { of });
        }
        let back = dot(&step, &self.direction) < 0.0;
        let anew = distance > ANEW * self.way;
        if back && !anew {
            return Err(RowProblem::TurnsBack { of });
        }
        let kept = if anew { 0.0 } else { KEPT };
        self.direction = std::array::from_fn(|i| kept * self.direction[i] + step[i] / distance);
        self.way += distance;
        self.last = Some((here, line));
        Ok(())
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
        let mut travel = Travel::new(0.1);
        let mut kept = abscissas.to_vec();
        kept.retain(|&x| travel.go(&Pose { x, y: 0.3, phi: 1.0 }, 0).is_ok());
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
        let mut travel = Travel::new(0.1);
        for k in 0..1000 {
            // Once around a circle, trembling by half a step across, turning on the spot, and straight on.
            let angle = k as f64 * 1e-2;
            let radius = 1.0 + 5e-3 * f64::from(k % 2);
            assert_eq!(travel.go(&Pose { x: radius * angle.cos(), y: radius * angle.sin(), phi: 0.0 }, 7), Ok(()));
        }
        let mut turning = Travel::new(0.1);
        assert_eq!(turning.go(&Pose { x: 0.0, y: 0.0, phi: 0.0 }, 7), Ok(()));
        assert_eq!(turning.go(&Pose { x: 0.0, y: 0.0, phi: 0.1 }, 8), Ok(()));
        assert_eq!(turning.go(&Pose { x: 0.0, y: 0.0, phi: 0.1 + 1e-14 }, 9), Err(RowProblem::Repeated { of: 8 }));
        assert_eq!(turning.go(&Pose { x: 0.0, y: 0.0, phi: 0.05 }, 10), Err(RowProblem::TurnsBack { of: 8 }));
    }
}
