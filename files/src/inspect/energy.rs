//! The elastic energy of a rod with one contact.

use vibrissa::rod::{Elastica, Load, Reactions};
use vibrissa::{Rod, Sample};

/// Energy of bending from the clamp to the arc length `s`, where the rod carries the force of the clamp, J; none where `s` is no length of a rod.
pub(super) fn bending_energy(sample: &Sample, stiffness: f64, s: f64) -> Option<f64> {
    let Reactions { f0x, f0y, m0z } = sample.reactions;
    let units = Rod::new(s, stiffness).ok()?.units();
    // the force that the contact takes away
    let load = Load { s, force: f0x.hypot(f0y), alpha: (-f0x).atan2(f0y) };
    Elastica::from_clamp(units, sample.pose, m0z, &[load]).ok().map(|bent| bent.bending_energy())
}

#[cfg(test)]
mod tests {
    use super::*;
    use vibrissa::Pose;

    #[test]
    fn energy_is_that_of_the_whole_rod() {
        let rod = Rod::new(0.1, 6.3e-4).unwrap();
        let pose = Pose { x: 0.0, y: 0.0, phi: 1.5 };
        let bent = Elastica::under_loads(rod.units(), pose, &[Load { s: 0.08, force: 0.2, alpha: 1.2 }]).unwrap().0;
        let sample = Sample::new(pose, bent.reactions());
        let found = bending_energy(&sample, rod.bending_stiffness(), 0.08).unwrap();
        assert!((found / bent.bending_energy() - 1.0).abs() < 1e-12, "{found} {}", bent.bending_energy());
    }
}
