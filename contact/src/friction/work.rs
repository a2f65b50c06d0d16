//! The energy that friction dissipates along a step of a branch.

use crate::contact_set::Configuration;
use crate::continuation::branch::{Condition, Corrector, Tangent};
use crate::friction::rates::slip_rate;
use rod_core::PhysicalRod;

/// Gauss-Legendre points and weights on (0, 1), order 12.
const POINTS: [(f64, f64); 6] = [
    (0.033_765_242_898_423_99, 0.085_662_246_189_585_17),
    (0.169_395_306_766_867_74, 0.180_380_786_524_069_3),
    (0.380_690_406_958_401_54, 0.233_956_967_286_345_52),
    (0.619_309_593_041_598_5, 0.233_956_967_286_345_52),
    (0.830_604_693_233_132_3, 0.180_380_786_524_069_3),
    (0.966_234_757_101_576, 0.085_662_246_189_585_17),
];

/// int sum_j |f_t dg| along the branch from `from`, whose tangent is given, to `to` (E I / L). None where a point on the way is not found.
pub(crate) fn friction_work<R: PhysicalRod>(
    corrector: &mut Corrector<'_, R>,
    (from, tangent): (&Configuration, &Tangent),
    to: &Configuration,
) -> Option<f64> {
    let slips = |j: usize| from.friction(j) != 0.0 && !from.contacts[j].grip.sticks();
    if from.contacts != to.contacts
        || !(0..to.count()).any(|j| slips(j) || (!to.contacts[j].grip.sticks() && to.friction(j) != 0.0))
    {
        return Some(0.0);
    }
    let whole = tangent.along(&to.z, &from.z);
    let mut sum = 0.0;
    for (share, weight) in POINTS {
        let distance = share * whole;
        let mut here = from.clone();
        for (z, end) in here.z.iter_mut().zip(&to.z) {
            *z += share * (end - *z);
        }
        let plane = Condition::Plane { tangent, from: &from.z, distance };
        if !corrector.correct(&mut here, plane).status.is_solved() {
            return None;
        }
        let (there, _) = corrector.inspect(&here, plane);
        let stretch = tangent.component(&there.direction);
        let world = &corrector.setup.world;
        let power = (0..here.count())
            .filter(|j| !here.contacts[*j].grip.sticks())
            .map(|j| -here.friction(j) * slip_rate(world, &here, &there, j) / stretch);
        sum += weight * whole * power.sum::<f64>();
    }
    Some(sum)
}
