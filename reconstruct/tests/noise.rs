//! What comes out of a noise model has the statistics that the model says. Seeds are fixed; bounds are five standard
//! deviations of the estimate.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use rod_core::Reactions;
use rod_reconstruct::{Ar1, Dropout, NoiseModel};

const COUNT: usize = 200_000;
const SIGMAS: f64 = 5.0;
const CLEAN: Reactions = Reactions { f0x: 0.1, f0y: -0.3, m0z: 7e-3 };
const SPREAD: Reactions = Reactions { f0x: 2.5e-3, f0y: 1e-3, m0z: 6e-5 };

fn array(r: Reactions) -> [f64; 3] {
    [r.f0x, r.f0y, r.m0z]
}

/// The noise alone, over a constant load; the model loses nothing.
fn noise(model: &NoiseModel, seed: u64, count: usize) -> Vec<[f64; 3]> {
    let mut sensor = model.generator(seed).unwrap();
    let clean = array(CLEAN);
    let felt = (0..count).map(|_| array(sensor.sample(CLEAN).unwrap()));
    felt.map(|felt| std::array::from_fn(|i| felt[i] - clean[i])).collect()
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
    sum / count
}

/// Mean of the products of two channels, the second one `lag` samples later.
fn covariance(noise: &[[f64; 3]], i: usize, j: usize, lag: usize) -> f64 {
    mean(noise.iter().zip(&noise[lag..]).map(|(now, later)| now[i] * later[j]))
}

fn close(found: f64, expected: f64, sigma: f64, what: &str) {
    let off = (found - expected) / sigma;
    assert!(off.abs() < SIGMAS, "{what}: {found:e}, expected {expected:e}, {off:.1} standard deviations off");
}

#[test]
fn white_noise_is_white() {
    let model = NoiseModel { white: SPREAD, ..NoiseModel::default() };
    let noise = noise(&model, 1, COUNT);
    let n = COUNT as f64;
    for (i, sigma) in array(SPREAD).into_iter().enumerate() {
        let variance = sigma * sigma;
        close(mean(noise.iter().map(|e| e[i])), 0.0, sigma / n.sqrt(), "mean");
        close(covariance(&noise, i, i, 0), variance, variance * (2.0 / n).sqrt(), "variance");
        // The fourth moment is three squared variances, with a variance of (105 - 9) of their squares.
        let fourth = mean(noise.iter().map(|e| e[i].powi(4)));
        close(fourth, 3.0 * variance * variance, variance * variance * (96.0 / n).sqrt(), "fourth moment");
        for lag in 1..4 {
            close(covariance(&noise, i, i, lag), 0.0, variance / n.sqrt(), "correlation of samples");
        }
        let other = (i + 1) % 3;
        let product = sigma * array(SPREAD)[other];
        close(covariance(&noise, i, other, 0), 0.0, product / n.sqrt(), "correlation of channels");
    }
}

#[test]
fn autoregressive_noise_remembers() {
    for (seed, rho) in [(2, 0.45), (3, -0.3), (4, 0.95)] {
        let model = NoiseModel { ar1: Ar1 { sigma: SPREAD, correlation: rho }, ..NoiseModel::default() };
        let noise = noise(&model, seed, COUNT);
        // Bartlett's formula: as many independent samples as the correlation leaves.
        let long = ((1.0 + rho) / (1.0 - rho) / COUNT as f64).sqrt();
        let long_squares = (2.0 * (1.0 + rho * rho) / (1.0 - rho * rho) / COUNT as f64).sqrt();
        for (i, sigma) in array(SPREAD).into_iter().enumerate() {
            let variance = sigma * sigma;
            close(mean(noise.iter().map(|e| e[i])), 0.0, sigma * long, "mean");
            let found = covariance(&noise, i, i, 0);
            close(found, variance, variance * long_squares, "variance");
            for lag in [1, 2] {
                let correlation = covariance(&noise, i, i, lag) / found;
                close(correlation, rho.powi(lag as i32), 2.0 / (COUNT as f64).sqrt(), "correlation");
            }
        }
    }
}

#[test]
fn autoregressive_noise_is_stationary_from_the_first_sample_on() {
    let model = NoiseModel { ar1: Ar1 { sigma: SPREAD, correlation: 0.95 }, ..NoiseModel::default() };
    let seeds = 4000;
    let starts: Vec<_> = (0..seeds).map(|seed| noise(&model, seed, 4)).collect();
    for sample in [0, 3] {
        let variance = mean(starts.iter().map(|start| start[sample][0].powi(2)));
        let expected = SPREAD.f0x * SPREAD.f0x;
        close(variance, expected, expected * (2.0 / seeds as f64).sqrt(), "variance");
    }
}

#[test]
fn a_walk_starts_at_zero_and_grows_with_the_root() {
    let model = NoiseModel { random_walk: SPREAD, ..NoiseModel::default() };
    let seeds = 2000;
    let walks: Vec<_> = (0..seeds).map(|seed| noise(&model, seed, 401)).collect();
    for (i, step) in array(SPREAD).into_iter().enumerate() {
        assert!(walks.iter().all(|walk| walk[0][i] == 0.0));
        for steps in [1, 100, 400] {
            let expected = step * step * steps as f64;
            let found = mean(walks.iter().map(|walk| walk[steps][i].powi(2)));
            close(found, expected, expected * (2.0 / seeds as f64).sqrt(), "variance");
        }
    }
}

#[test]
fn a_quantum_leaves_multiples_of_it() {
    let quantum = Reactions { f0x: 2_f64.powi(-9), f0y: 0.0, m0z: 1e-5 };
    let model = NoiseModel { white: SPREAD, quantum, ..NoiseModel::default() };
    let mut rounded = model.generator(5).unwrap();
    let mut exact = NoiseModel { quantum: Reactions::default(), ..model }.generator(5).unwrap();
    for _ in 0..1000 {
        let (rounded, exact) = (rounded.sample(CLEAN).unwrap(), exact.sample(CLEAN).unwrap());
        assert_eq!((rounded.f0x / quantum.f0x).fract(), 0.0);
        assert!((rounded.f0x - exact.f0x).abs() <= quantum.f0x / 2.0);
        assert_eq!(rounded.f0y, exact.f0y);
        let steps = rounded.m0z / quantum.m0z;
        assert!((steps - steps.round()).abs() < 1e-12);
        assert!((rounded.m0z - exact.m0z).abs() <= quantum.m0z / 2.0 * (1.0 + 1e-9));
    }
}

#[test]
fn gain_crosstalk_and_offset_come_before_everything_else() {
    let model = NoiseModel {
        gain: Reactions { f0x: 0.01, f0y: 0.0, m0z: -0.02 },
        crosstalk: [[0.0, 0.03, 0.5], [0.0, 0.0, 0.0], [1e-3, 0.0, 0.0]],
        offset: Reactions { f0x: 0.0, f0y: 0.25, m0z: 0.0 },
        ..NoiseModel::default()
    };
    let read = model.generator(0).unwrap().sample(CLEAN).unwrap();
    let expected = [1.01 * 0.1 + 0.03 * -0.3 + 0.5 * 7e-3, -0.3 + 0.25, 0.98 * 7e-3 + 1e-3 * 0.1];
    for (read, expected) in array(read).into_iter().zip(expected) {
        assert!((read - expected).abs() < 1e-16, "{read} {expected}");
    }
    // A sensor that feels nothing still has all of its noise.
    let blind = Reactions { f0x: -1.0, f0y: -1.0, m0z: -1.0 };
    let model = NoiseModel { gain: blind, white: SPREAD, ..NoiseModel::default() };
    let plain = NoiseModel { white: SPREAD, ..NoiseModel::default() };
    let (mut blind, mut plain) = (model.generator(6).unwrap(), plain.generator(6).unwrap());
    for _ in 0..10 {
        assert_eq!(blind.sample(CLEAN), plain.sample(Reactions::default()));
    }
}

#[test]
fn samples_are_lost_as_often_and_as_long_as_said() {
    for (seed, probability, mean_length) in
        [(7, 0.05, None), (8, 0.1, Some(5.0)), (9, 0.5, Some(1.0)), (10, 0.02, Some(1.0))]
    {
        let model = NoiseModel { dropout: Dropout { probability, mean_length }, ..NoiseModel::default() };
        let mut sensor = model.generator(seed).unwrap();
        let lost: Vec<bool> = (0..COUNT).map(|_| sensor.sample(CLEAN).is_none()).collect();
        let share = lost.iter().filter(|lost| **lost).count() as f64 / COUNT as f64;
        let length = mean_length.unwrap_or(1.0 / (1.0 - probability));
        // The chain forgets by this factor a sample.
        let rho = 1.0 - 1.0 / length - probability / ((1.0 - probability) * length);
        let sigma = (probability * (1.0 - probability) * (1.0 + rho) / (1.0 - rho) / COUNT as f64).sqrt();
        close(share, probability, sigma.max(1.0 / COUNT as f64), "share of lost samples");
        let gaps = lost.windows(2).filter(|pair| !pair[0] && pair[1]).count() as f64;
        // Lengths of gaps are geometric: variance length (length - 1).
        let sigma = (length * (length - 1.0) / gaps).sqrt().max(1.0 / gaps);
        close(share * COUNT as f64 / gaps, length, sigma, "mean length of a gap");
    }
}

#[test]
fn one_seed_is_one_stream() {
    let model = NoiseModel {
        white: SPREAD,
        ar1: Ar1 { sigma: SPREAD, correlation: 0.45 },
        random_walk: SPREAD,
        dropout: Dropout { probability: 0.1, mean_length: Some(3.0) },
        ..NoiseModel::default()
    };
    let run = |seed| {
        let mut sensor = model.generator(seed).unwrap();
        (0..1000).map(|_| sensor.sample(CLEAN)).collect::<Vec<_>>()
    };
    assert_eq!(run(11), run(11));
    let same = run(11).iter().zip(&run(12)).filter(|(a, b)| a.is_some() && a == b).count();
    assert_eq!(same, 0);
}

#[test]
fn the_parts_do_not_disturb_each_other() {
    let dropout = Dropout { probability: 0.2, mean_length: None };
    let white = NoiseModel { white: SPREAD, ..NoiseModel::default() };
    let all = NoiseModel { dropout, random_walk: Reactions { f0y: 1e-3, ..Reactions::default() }, ..white.clone() };
    let (mut white, mut all) = (white.generator(13).unwrap(), all.generator(13).unwrap());
    let mut lost = 0;
    for _ in 0..1000 {
        let white = white.sample(CLEAN).unwrap();
        match all.sample(CLEAN) {
            Some(all) => assert_eq!((all.f0x, all.m0z), (white.f0x, white.m0z)),
            None => lost += 1,
        }
    }
    assert!((100..300).contains(&lost));
}

#[test]
fn the_stream_of_a_seed_is_the_same_everywhere() {
    let model = NoiseModel { white: Reactions { f0x: 1.0, f0y: 1.0, m0z: 1.0 }, ..NoiseModel::default() };
    let first = model.generator(2021).unwrap().sample(Reactions::default()).unwrap();
    let expected = [0.8250265220327115, -0.1809969231659118, -0.9834729736265799];
    for (found, expected) in array(first).into_iter().zip(expected) {
        assert!((found - expected).abs() < 1e-12, "{first:?}");
    }
}

#[test]
fn a_model_of_zeros_changes_no_bit() {
    let mut sensor = NoiseModel::default().generator(14).unwrap();
    for value in [0.0, -0.0, 1.0 / 3.0, -1e300, f64::MIN_POSITIVE, f64::INFINITY] {
        let clean = Reactions { f0x: value, f0y: -value, m0z: value / 7.0 };
        let read = sensor.sample(clean).unwrap();
        for (read, clean) in array(read).into_iter().zip(array(clean)) {
            assert_eq!(read.to_bits(), clean.to_bits());
        }
    }
}
