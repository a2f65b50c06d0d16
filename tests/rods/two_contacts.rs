//! From the reactions of a scan back to both contacts, for rods that are not uniform and clamps that give way.

use super::scans::{bent, cone, o1, two_sections};
use std::collections::BTreeMap;
use std::f64::consts::FRAC_PI_2;
use vibrissa::reconstruct::{Ar1, NoiseModel, Reading, Settings, Touch, noise_estimate, reconstruct_general};
use vibrissa::rod::{ElasticClamp, Mounted, PhysicalRod, Pose, Reactions, Rod, RodSection};
use vibrissa::{ClampPath, Composite, Contour, Sample, State, Sweep};

/// What became of the samples of a scan with two contacts.
#[derive(Debug, Default)]
struct Found {
    /// Samples with two contacts, and those of them whose label is right.
    samples: usize,
    right: usize,
    /// Contacts that are given, first and second, and how far they miss the true ones at most, rod lengths.
    given: [usize; 2],
    worst: [f64; 2],
    /// Points off the contour by more than six of their standard deviations and 1e-9 L, and the largest distance of all.
    wrong: usize,
    off: f64,
    /// Sum of the squared distances in standard deviations.
    squares: f64,
    /// Why there is none.
    reasons: BTreeMap<String, usize>,
}

impl Found {
    fn add(&mut self, object: &Composite, state: &State, reading: &Reading) {
        self.samples += 1;
        self.right += usize::from(state.phase().to_string() == reading.label.to_string());
        let touches = [Some(reading.touch), reading.second];
        for (k, (touch, contact)) in touches.into_iter().zip(&state.contacts).enumerate() {
            match touch {
                Some(Ok(touch)) if reading.label.several() => {
                    let Touch { x, y, .. } = touch;
                    self.given[k] += 1;
                    self.worst[k] = self.worst[k].max((x - contact.x).hypot(y - contact.y));
                    let off = object.closest(x, y).gap.abs();
                    self.off = self.off.max(off);
                    self.wrong += usize::from(off > 6.0 * touch.sigma_normal() + 1e-9);
                    self.squares += (off / touch.sigma_normal()).powi(2);
                }
                Some(Err(reason)) => *self.reasons.entry(reason.to_string()).or_default() += 1,
                _ => *self.reasons.entry("taken for one contact".into()).or_default() += 1,
            }
        }
    }

    /// Root mean square of the distances in standard deviations.
    fn deviation(&self) -> f64 {
        (self.squares / (self.given[0] + self.given[1]).max(1) as f64).sqrt()
    }
}

/// A scan of O1 from a distance of 0.4 L, exact or with coloured noise.
fn found(rod: &impl PhysicalRod, step: f64, noise: Option<u64>) -> Found {
    let at = |x| Pose { x, y: -0.4, phi: FRAC_PI_2 };
    let object = o1();
    let states = Sweep::new(rod, &object, ClampPath::new(at(1.0), at(-0.9)).unwrap(), step).unwrap().run().states;
    // 2.5 mN and 0.06 N mm on the rod of Merker et al. (2020)
    let ar1 = Ar1 { sigma: Reactions { f0x: 0.04, f0y: 0.04, m0z: 0.0095 }, correlation: 0.45 };
    let sensor = NoiseModel { ar1: noise.map_or(Ar1::default(), |_| ar1), ..NoiseModel::default() };
    let mut sensor = sensor.generator(noise.unwrap_or(0)).unwrap();
    let felt = |state: &State| Sample::new(state.pose, sensor.sample(state.reactions).unwrap());
    let samples: Vec<Sample> = states.iter().map(felt).collect();
    // next to a fold the reactions change so fast that exact ones look noisy
    let exact = [noise_estimate::ChannelNoise::white(0.0); 3];
    let settings = Settings { noise: noise.is_none().then_some(exact), ..Settings::default() };
    let answer = reconstruct_general(rod, &samples, &settings).unwrap();
    let mut found = Found::default();
    for (state, reading) in states.iter().zip(&answer.readings).filter(|(state, _)| state.contacts.len() > 1) {
        found.add(&object, state, reading);
    }
    println!("{:.2} {found:?}", found.deviation());
    found
}

/// Contacts on cones, on sections, where the first one passes a joint, on rods that are bent at rest, one of which touches a parabola twice,
/// and on a soft clamp: all are found, and so is which of BA and BB it is.
#[test]
fn both_contacts_of_exact_scans() {
    let soft = Mounted::new(cone(0.5), ElasticClamp::springs(Some(40.0), Some(30.0), Some(8.0)).unwrap());
    let section = |length, bending_stiffness| RodSection { length, bending_stiffness, natural_curvature: 0.0 };
    let joint = Rod::sections(1.0, &[section(0.6, 1.0), section(0.4, 0.24)]).unwrap();
    let other = Rod::new(1.0, 1.0).unwrap().with_natural_curvature(-0.5).unwrap();
    for (what, found) in [
        ("thin cone", found(&cone(0.3), 2e-4, None)),
        ("cone", found(&cone(0.8), 2e-4, None)),
        ("bent", found(&bent(), 2e-4, None)),
        ("bent the other way", found(&other, 2e-4, None)),
        ("sections", found(&two_sections(), 2e-4, None)),
        ("joint", found(&joint, 2e-4, None)),
        ("soft cone", found(&soft, 2e-4, None)),
    ] {
        let Found { samples, right, given, worst, off, .. } = found;
        assert!(samples > 600 && right == samples && given == [samples; 2], "{what}: {right} of {samples}, {given:?}");
        assert!(worst[0] < 1e-8 && worst[1] < 1e-6 && off < 1e-8, "{what}: {worst:?} {off:e}");
    }
}

/// In noise what is given is as good as it says, and what is not has a reason.
#[test]
fn both_contacts_in_noise() {
    let mut given = 0;
    for (rod, seed) in [(cone(0.8), 1), (cone(0.8), 2), (bent(), 1), (two_sections(), 1)] {
        let found = found(&rod, 5e-5, Some(seed));
        assert!(found.wrong == 0 && found.deviation() < 2.0 && found.off < 0.02, "{found:?}");
        given += found.given[0].min(found.given[1]);
    }
    assert!(given > 3000, "{given}");
}
