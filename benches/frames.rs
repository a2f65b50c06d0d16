//! Forces from frames of 40 points with noise of 0.0005 L: a uniform rod, one that tapers to 1/5, and that bent at rest. One frame is one element.
#![allow(clippy::unwrap_used, reason = "a bench may")]

use criterion::{Criterion, Throughput};
use std::hint::black_box;
use vibrissa::Rod;
use vibrissa::reconstruct::{ForceSettings, Frame, forces};
use vibrissa::rod::{AnyRod, Cut, RodModel};

const POINTS: usize = 40;
const FRAMES: usize = 50;
const SIGMA: f64 = 5e-4;

/// A frame of a rod of length 1 that a force pushes at an arc length, from there back to the base, with noise.
fn frame(rod: &AnyRod, s: f64, force: f64, noise: &mut impl FnMut() -> f64) -> Frame {
    let contact = Cut { x: 0.5, y: 0.1, phi: 0.2, moment: 0.0 };
    let [a, b] = [force * contact.phi.cos(), force * contact.phi.sin()];
    let place = |k: usize| {
        let at = k as f64 / (POINTS - 1) as f64;
        let [a, b] = if at < s { [a, b] } else { [0.0, 0.0] };
        let cut = rod.carry(s, &contact, a, b, at - s);
        [cut.x + noise(), cut.y + noise()]
    };
    Frame::from_base(&(0..POINTS).map(place).collect::<Vec<_>>())
}

fn main() {
    let cone = || Rod::tapered(1.0, 1e-2, 2e-3, 1.0).unwrap();
    let uniform = AnyRod::from(Rod::tapered(1.0, 1e-2, 1e-2, 1.0).unwrap().at_clamp().to_owned());
    let bent = cone().with_natural_curvature(|s: f64| 0.3 + 0.5 * s).unwrap();
    let mut random = 88_172_645_463_325_252_u64;
    let mut noise = || {
        // the sum of 12 uniform numbers
        let mut uniform = || {
            random ^= random << 13;
            random ^= random >> 7;
            random ^= random << 17;
            (random >> 11) as f64 / (1_u64 << 53) as f64
        };
        SIGMA * ((0..12).map(|_| uniform()).sum::<f64>() - 6.0)
    };
    let mut criterion = Criterion::default().sample_size(10).configure_from_args();
    let mut group = criterion.benchmark_group("forces");
    group.throughput(Throughput::Elements(FRAMES as u64));
    for (name, rod) in [("uniform", uniform), ("cone", AnyRod::from(cone())), ("bent cone", AnyRod::from(bent))] {
        let frames: Vec<Frame> = (0..FRAMES)
            .map(|k| frame(&rod, 0.35 + 0.4 * k as f64 / FRAMES as f64, 2.0 - k as f64 / FRAMES as f64, &mut noise))
            .collect();
        let settings = ForceSettings { sigma: Some(SIGMA), ..ForceSettings::default() };
        group.bench_function(name, |bencher| bencher.iter(|| forces(&rod, black_box(&frames), &settings)));
    }
    group.finish();
    criterion.final_summary();
}
