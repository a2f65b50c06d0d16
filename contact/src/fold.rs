//! The fold of a branch: where the path parameter stops to grow along it.

use crate::branch::{Condition, Corrector, Tangent};
use crate::configuration::Configuration;

/// |d tau / d arclength| below which a point is the fold: tau is then off by about its square.
const FLAT: f64 = 1e-8;
/// Most evaluations.
const MOST_EVALUATIONS: usize = 60;

/// The fold between `from` and the point at `distance` along its `tangent`, where d tau / d arclength is `end_slope` < 0.
pub(crate) fn locate_fold(
    corrector: &mut Corrector<'_>,
    from: &Configuration,
    tangent: &Tangent,
    to: &Configuration,
    end_slope: f64,
) -> Option<Configuration> {
    let whole = tangent.along(&to.z, &from.z);
    // Illinois variant of regula falsi on the slope over the distance along the tangent
    let (mut lo, mut hi) = ((0.0, tangent.by_tau()), (whole, end_slope));
    let mut last_side = 0;
    for _ in 0..MOST_EVALUATIONS {
        let distance = (lo.0 * hi.1 - hi.0 * lo.1) / (hi.1 - lo.1);
        let mut here = from.clone();
        let part = distance / whole;
        for (z, end) in here.z.iter_mut().zip(&to.z) {
            *z += part * (end - *z);
        }
        let condition = Condition::Plane { tangent, from: &from.z, distance };
        if !corrector.correct(&mut here, condition).status.is_solved() {
            return None;
        }
        let slope = corrector.inspect(&here, condition).0.by_tau();
        if slope.abs() < FLAT || hi.0 - lo.0 < 1e-13 {
            return Some(here);
        }
        if slope > 0.0 {
            lo = (distance, slope);
            if last_side > 0 {
                hi.1 *= 0.5;
            }
            last_side = 1;
        } else {
            hi = (distance, slope);
            if last_side < 0 {
                lo.1 *= 0.5;
            }
            last_side = -1;
        }
    }
    None
}
