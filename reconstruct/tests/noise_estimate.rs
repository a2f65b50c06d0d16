//! The estimate of the noise against noise of known make.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout)]

use crate::common::noise::Noise;
use rod_reconstruct::noise_estimate::estimate;

/// A curve with a kink and a jump, about as curved as reactions are.
fn curve(tau: f64) -> f64 {
    let bent = if tau > 0.6 { 30.0 * (tau - 0.6) } else { 0.0 };
    let jump = if tau > 1.1 { -2.0 } else { 0.0 };
    4.0 * (3.0 * tau).sin() + 0.5 * (20.0 * tau).cos() + bent + jump
}

fn places(count: usize) -> Vec<f64> {
    (0..count).map(|i| 1.7 * i as f64 / count as f64).collect()
}

#[test]
fn noise_of_known_make_is_found_again() {
    let tau = places(85_000);
    let clean: Vec<f64> = tau.iter().map(|t| curve(*t)).collect();
    let mut worst = [0.0_f64; 3];
    for (seed, rho) in [(1, 0.0), (2, 0.0), (3, 0.45), (4, 0.45), (5, -0.4)] {
        for sigma in [1e-8, 1e-3, 0.16] {
            let found = estimate(&tau, &Noise::new(seed, rho).add(sigma, &clean));
            let long_run = (1.0 + rho) / (1.0 - rho);
            worst[0] = worst[0].max((found.sigma / sigma - 1.0).abs());
            worst[1] = worst[1].max((found.lag1 - rho).abs());
            worst[2] = worst[2].max((found.long_run / long_run - 1.0).abs());
        }
    }
    println!("sigma {:.4} lag1 {:.4} long run {:.4}", worst[0], worst[1], worst[2]);
    assert!(worst[0] < 0.01 && worst[1] < 0.01 && worst[2] < 0.08, "{worst:?}");
}

/// Of few samples the correlation is hardly known; how little is told by `spread`.
#[test]
fn few_samples_tell_their_noise_roughly() {
    let tau: Vec<f64> = (0..500).map(|i| 2e-3 * f64::from(i)).collect();
    let clean: Vec<f64> = tau.iter().map(|t| 4.0 * (3.0 * t).sin()).collect();
    for (rho, within) in [(0.0, [0.8, 1.6]), (0.45, [0.45, 1.4])] {
        let long_run: f64 = (1.0 + rho) / (1.0 - rho);
        let of_seed = |seed| {
            let found = estimate(&tau, &Noise::new(seed, rho).add(0.1, &clean));
            let ratio = found.equivalent() / (0.1 * long_run.sqrt());
            (ratio, 2.0 * ratio.ln() / found.spread.sqrt())
        };
        let (mut ratios, mut z): (Vec<f64>, Vec<f64>) = (1..=100).map(of_seed).unzip();
        ratios.sort_by(f64::total_cmp);
        z.sort_by(f64::total_cmp);
        println!("{rho}: ratio {:.2} to {:.2}, z {:.1} to {:.1} in 80 %", ratios[10], ratios[89], z[10], z[89]);
        assert!(ratios[10] > within[0] && ratios[89] < within[1] && z[10] > -6.0 && z[89] < 4.0, "{rho}");
    }
}

#[test]
fn a_clean_curve_has_next_to_no_noise() {
    let tau = places(85_000);
    let clean: Vec<f64> = tau.iter().map(|t| curve(*t)).collect();
    let found = estimate(&tau, &clean);
    assert!((1e-16..1e-13).contains(&found.sigma), "{found:?}");
}

#[test]
fn few_samples_and_uneven_places_will_do() {
    let mut noise = Noise::new(7, 0.0);
    let tau: Vec<f64> = (0..170).map(|i| 0.01 * (f64::from(i) + 0.4 * noise.uniform())).collect();
    let smooth: Vec<f64> = tau.iter().map(|t| (3.0 * t).sin()).collect();
    let found = estimate(&tau, &noise.add(0.01, &smooth));
    assert!((found.sigma / 0.01 - 1.0).abs() < 0.25, "{found:?}");
    let tau: Vec<f64> = (0..20_000).map(|i| 1e-4 * (f64::from(i) + 0.4 * noise.uniform())).collect();
    let smooth: Vec<f64> = tau.iter().map(|t| curve(*t)).collect();
    let found = estimate(&tau, &noise.add(1e-3, &smooth));
    assert!((found.sigma / 1e-3 - 1.0).abs() < 0.03 && found.lag1.abs() < 0.04, "{found:?}");
}

#[test]
fn constant_and_quantised_channels_are_sane() {
    let tau = places(20_000);
    let free = estimate(&tau, &vec![0.0; tau.len()]);
    assert_eq!((free.sigma, free.long_run), (0.0, 1.0));
    let held = estimate(&tau, &vec![3.0; tau.len()]);
    assert!(held.sigma > 0.0 && held.sigma < 1e-14, "{held:?}");
    // a quantum far above the noise, and one below
    let quantised = |sigma: f64, quantum: f64| {
        let mut noise = Noise::new(3, 0.0);
        let clean: Vec<f64> = tau.iter().map(|t| (2.0 * t).sin()).collect();
        noise.add(sigma, &clean).iter().map(|y| (y / quantum).round() * quantum).collect::<Vec<_>>()
    };
    let coarse = estimate(&tau, &quantised(1e-4, 1e-2));
    assert!((0.9 * 1e-2 / 12.0_f64.sqrt()..1e-2).contains(&coarse.sigma), "{coarse:?}");
    let fine = estimate(&tau, &quantised(1e-2, 1e-2));
    let known = (1e-4_f64 + 1e-4 / 12.0).sqrt();
    assert!((fine.sigma / known - 1.0).abs() < 0.05, "{fine:?} {known}");
}

#[test]
fn outliers_gaps_and_scraps_do_no_harm() {
    let tau = places(20_000);
    let mut noise = Noise::new(9, 0.0);
    let mut channel = noise.add(0.01, &vec![0.0; tau.len()]);
    (0..50).for_each(|i| channel[i * 397] = if i % 2 == 0 { 5.0 } else { f64::NAN });
    let found = estimate(&tau, &channel);
    assert!((found.sigma / 0.01 - 1.0).abs() < 0.04, "{found:?}");
    for count in 0..20 {
        assert!(estimate(&tau[..count], &channel[1..=count]).sigma.is_finite());
    }
}
