//! The filter that takes samples as they come, against the whole recording at once.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout)]

use crate::common::noise::Noise;
use rod_reconstruct::kink::{KinkFilter, KinkOptions, find_kinks};
use rod_reconstruct::noise_estimate::ChannelNoise;

const STEP: f64 = 1e-4;
const OPTIONS: KinkOptions = KinkOptions { false_alarms: 0.05, widest: 0.04 };
const NOISE: ChannelNoise = ChannelNoise { sigma: 0.002, lag1: 0.0, long_run: 1.0, spread: 0.0 };

fn recording(seed: u64) -> (Vec<f64>, [Vec<f64>; 3]) {
    let mut noise = Noise::new(seed, 0.0);
    let tau: Vec<f64> = (0..17_000).map(|i| STEP * f64::from(i)).collect();
    let bend = |t: f64, at: f64| (t - at).max(0.0);
    let curve = |c: f64, t: f64| {
        let jump = if t > 1.3 { 0.5 } else { 0.0 };
        (2.0 * t + c).sin() + 8.0 * bend(t, 0.21) - 20.0 * bend(t, 0.5) + 15.0 * c * bend(t, 0.55) + jump
    };
    let channels = [0.0, 1.0, 2.0].map(|c| tau.iter().map(|t| curve(c, *t) + NOISE.sigma * noise.sample()).collect());
    (tau, channels)
}

#[test]
fn it_finds_what_the_whole_recording_shows_within_its_delay() {
    for seed in 0..5 {
        let (tau, channels) = recording(seed);
        let [a, b, c] = &channels;
        let whole = find_kinks(&tau, [a, b, c], &[NOISE; 3], OPTIONS);
        assert_eq!(whole.len(), 4, "{whole:#?}");
        let mut filter = KinkFilter::new(STEP, [NOISE; 3], OPTIONS, tau.len());
        let mut came = Vec::new();
        for i in 0..tau.len() {
            if let Some(kink) = filter.push(tau[i], [a[i], b[i], c[i]]) {
                assert!(i <= kink.next + filter.delay() + 4, "{i} {kink:?}");
                came.push(kink);
            }
        }
        came.extend(std::iter::from_fn(|| filter.finish()));
        assert_eq!(came.len(), whole.len(), "{came:#?}");
        for (a, b) in came.iter().zip(&whole) {
            assert_eq!(a.kind, b.kind);
            assert!((a.tau - b.tau).abs() <= 2.0 * b.sigma_tau.max(a.sigma_tau), "{a:?} {b:?}");
        }
    }
}

#[test]
fn it_takes_no_memory_once_made() {
    let (tau, [a, b, c]) = recording(1);
    let mut filter = KinkFilter::new(STEP, [NOISE; 3], OPTIONS, tau.len());
    let mut count = 0;
    let taken = allocation_counter::measure(|| {
        for i in 0..tau.len() {
            count += usize::from(filter.push(tau[i], [a[i], b[i], c[i]]).is_some());
        }
        while filter.finish().is_some() {
            count += 1;
        }
    });
    assert_eq!(taken.count_total, 0);
    assert_eq!(count, 4);
}

#[test]
fn it_leaves_out_what_is_no_sample() {
    let (tau, [a, b, c]) = recording(2);
    let transitions = |faulty: bool| {
        let mut filter = KinkFilter::new(STEP, [NOISE; 3], OPTIONS, tau.len());
        let mut found = Vec::new();
        for i in 0..tau.len() {
            found.extend(filter.push(tau[i], [a[i], b[i], c[i]]));
            if faulty && i % 100 == 0 {
                found.extend(filter.push(tau[i], [0.0; 3]));
                found.extend(filter.push(f64::NAN, [0.0; 3]));
                found.extend(filter.push(tau[i] + 0.5 * STEP, [0.0, f64::INFINITY, 0.0]));
            }
        }
        found.extend(std::iter::from_fn(|| filter.finish()));
        found.iter().map(|kink| kink.next).collect::<Vec<_>>()
    };
    let clean = transitions(false);
    assert_eq!((clean.len(), &clean), (4, &transitions(true)));
}
