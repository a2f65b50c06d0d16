//! The elastic energy of a rod with one contact.

use vibrissa::Sample;
use vibrissa::rod::Reactions;

/// Steps along the rod. More: a smaller error, of the fourth order.
const STEPS: u32 = 40;

/// Energy of bending from the clamp to the arc length `s`, where the rod carries the force of the clamp: by Runge and Kutta's method, to 1e-4.
pub(super) fn bending_energy(sample: &Sample, stiffness: f64, s: f64) -> f64 {
    let Reactions { f0x, f0y, m0z } = sample.reactions;
    let (a, b) = (f0y / stiffness, -f0x / stiffness);
    let step = s / f64::from(STEPS);
    let slope = |phi: f64, kappa: f64| (kappa, a * phi.cos() + b * phi.sin());
    let (mut phi, mut kappa, mut energy) = (sample.pose.phi, -m0z / stiffness, 0.0);
    for _ in 0..STEPS {
        let first = slope(phi, kappa);
        let second = slope(phi + 0.5 * step * first.0, kappa + 0.5 * step * first.1);
        let third = slope(phi + 0.5 * step * second.0, kappa + 0.5 * step * second.1);
        let fourth = slope(phi + step * third.0, kappa + step * third.1);
        let before = kappa;
        phi += step / 6.0 * (first.0 + 2.0 * second.0 + 2.0 * third.0 + fourth.0);
        kappa += step / 6.0 * (first.1 + 2.0 * second.1 + 2.0 * third.1 + fourth.1);
        energy += step / 6.0 * (before * before + before * kappa + kappa * kappa);
    }
    stiffness * energy
}

#[cfg(test)]
mod tests {
    use super::*;
    use vibrissa::rod::{Elastica, Load};
    use vibrissa::{Pose, Rod};

    #[test]
    fn energy_is_that_of_the_closed_form() {
        let rod = Rod::new(0.1, 6.3e-4).unwrap();
        let pose = Pose { x: 0.0, y: 0.0, phi: 1.5 };
        let bent = Elastica::under_loads(rod.units(), pose, &[Load { s: 0.08, force: 0.2, alpha: 1.2 }]).unwrap().0;
        let sample = Sample::new(pose, bent.reactions());
        let found = bending_energy(&sample, rod.bending_stiffness(), 0.08);
        assert!((found / bent.bending_energy() - 1.0).abs() < 1e-3, "{found} {}", bent.bending_energy());
    }
}
