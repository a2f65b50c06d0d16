//! Back from reactions: one inversion with its covariance, a scan of 65,000 samples identified, inverted and assembled, and
//! sample by sample.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a bench may, and it is there to be read")]

mod measure;

use criterion::Criterion;
use measure::objects::{OBJECTS, path, sweep};
use measure::{Time, interleaved, is_timed, kernel, machine, segments};
use nalgebra::{Matrix3, Vector3};
use std::hint::black_box;
use vibrissa::reconstruct::noise_estimate::ChannelNoise;
use vibrissa::reconstruct::{Assembly, Live, LiveSettings, NoiseModel, single};
use vibrissa::rod::Reactions;
use vibrissa::{Label, Rod, Sample, Settings, reconstruct};

/// A scan of O1 at q = 0.4 recorded at 500 Hz and 1 mm/s with a rod of 100 mm, all contact phases within.
const WAY: (f64, f64) = (0.68, -0.62);
const SAMPLES: usize = 65_000;
const SPACING: f64 = 2e-5;
/// 2.5 mN and 0.06 mN m in units of the paper's wire.
const SIGMA: [f64; 2] = [0.0396, 0.0095];

fn samples(noise: &NoiseModel) -> Vec<Sample> {
    let states = sweep(&OBJECTS[0].contour(), path(0.4, WAY.0, WAY.1), SAMPLES).states;
    let mut sensor = noise.generator(1).unwrap();
    states.iter().filter_map(|state| Some(Sample::new(state.pose, sensor.sample(state.reactions)?))).collect()
}

fn identified_and_assembled(rod: &Rod, samples: &[Sample]) -> usize {
    let found = reconstruct(rod, black_box(samples), &Settings::default()).unwrap();
    black_box(found.contour(&Assembly::default()));
    1
}

fn live(rod: &Rod, settings: &LiveSettings, samples: &[Sample]) -> usize {
    let mut live = Live::new(rod, settings).unwrap();
    let several =
        samples.iter().filter_map(|sample| live.push(black_box(sample))).filter(|r| r.label == Label::BB).count();
    black_box(several);
    samples.len()
}

fn main() {
    let rod = Rod::new(1.0, 1.0).unwrap();
    let white = Reactions { f0x: SIGMA[0], f0y: SIGMA[0], m0z: SIGMA[1] };
    let clean = samples(&NoiseModel::default());
    let noisy = samples(&NoiseModel { white, ..NoiseModel::default() });
    let noise = [SIGMA[0], SIGMA[0], SIGMA[1]].map(ChannelNoise::white);
    let settings = LiveSettings::new(noise, SPACING);
    let covariance = Matrix3::from_diagonal(&Vector3::new(white.f0x, white.f0y, white.m0z).map(|v| v * v));
    let touching: Vec<Sample> = clean
        .iter()
        .filter(|sample| single(&rod, sample.pose, sample.reactions, &covariance).is_ok())
        .copied()
        .collect();
    let inversions = || {
        for sample in &touching {
            black_box(single(&rod, black_box(sample.pose), black_box(sample.reactions), &covariance).ok());
        }
        touching.len()
    };

    let mut criterion = Criterion::default().configure_from_args();
    let mut group = criterion.benchmark_group("reconstruct");
    group.sample_size(10);
    group.bench_function("single contacts with covariance, 50,000", |b| b.iter(inversions));
    group.bench_function("65,000 clean samples", |b| b.iter(|| identified_and_assembled(&rod, &clean)));
    group.bench_function("65,000 noisy samples", |b| b.iter(|| identified_and_assembled(&rod, &noisy)));
    group.bench_function("65,000 noisy samples one by one", |b| b.iter(|| live(&rod, &settings, &noisy)));
    group.finish();
    criterion.final_summary();
    if !is_timed() {
        return;
    }

    println!("{}", machine::line());
    let segments = segments();
    let [kernel, inversion, clean_scan, noisy_scan, one_by_one]: [Time; 5] = interleaved(
        10,
        [
            &mut || kernel(&segments),
            &mut || inversions(),
            &mut || identified_and_assembled(&rod, &clean),
            &mut || identified_and_assembled(&rod, &noisy),
            &mut || live(&rod, &settings, &noisy),
        ],
    );
    println!("least of 10 interleaved rounds; kernel {}", kernel.show(1e6, "us"));
    println!("  one contact with covariance     {}   {} kernels", inversion.show(1e6, "us"), inversion.over(&kernel));
    println!("  65,000 clean samples            {}", clean_scan.show(1e3, "ms"));
    println!("  65,000 noisy samples            {}", noisy_scan.show(1e3, "ms"));
    println!("  one sample of them, as it comes {}", one_by_one.show(1e6, "us"));
    println!("  answered {} samples late", Live::new(&rod, &settings).unwrap().delay());
}
