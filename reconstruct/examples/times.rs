//! Time of `reconstruct` by the number of samples and the kind of noise.
//!
//! `cargo run --release -p rod-reconstruct --example times -- [ROWS ...]` prints a table: seconds, kinks found, and how many of
//! the transitions of the scan (O1 at 0.4 L) are among them within 0.01 L.
#![allow(missing_docs, clippy::unwrap_used, clippy::print_stdout)]

#[path = "../tests/common/mod.rs"]
mod common;

use common::nine_scans::{Clean, scan, shows};
use common::noise::Noise;
use rod_core::{Pose, Reactions, Rod, Sample};
use rod_reconstruct::kink::{KinkOptions, find_kinks};
use rod_reconstruct::noise_estimate::estimate;
use rod_reconstruct::{Settings, reconstruct};
use std::time::Instant;

/// Samples a second, by which frequencies become samples.
const RATE: f64 = 500.0;
/// EI/L^2 in N, EI/L in N m.
const UNITS: [f64; 3] = [0.0632, 0.0632, 0.00632];

const KINDS: [&str; 9] =
    ["clean", "white", "AR 0.45", "AR 0.99", "low-pass 5 Hz", "low-pass 1 Hz", "hum", "steps", "walk"];

/// The channel with noise of this kind.
fn spoilt(kind: &str, channel: usize, clean: &[f64], noise: &mut Noise) -> Vec<f64> {
    let unit = UNITS[channel];
    let small = if channel == 2 { 0.02e-3 / unit } else { 0.5e-3 / unit };
    let large = if channel == 2 { 0.2e-3 / unit } else { 5e-3 / unit };
    let white = |noise: &mut Noise| -> Vec<f64> { clean.iter().map(|y| y + small * noise.normal()).collect() };
    match kind {
        "clean" => clean.to_vec(),
        "low-pass 5 Hz" => low_pass(5.0, &white(noise)),
        "low-pass 1 Hz" => low_pass(1.0, &white(noise)),
        "hum" => {
            let turn = std::f64::consts::TAU * 50.0 / RATE;
            white(noise).iter().enumerate().map(|(i, y)| y + large * (turn * i as f64).sin()).collect()
        }
        "steps" => white(noise).iter().map(|y| (y / large).round() * large).collect(),
        "walk" => {
            let step = large / (clean.len() as f64).sqrt();
            let mut drift = 0.0;
            let white = white(noise);
            white
                .iter()
                .map(|y| {
                    drift += step * noise.normal();
                    y + drift
                })
                .collect()
        }
        _ => clean.iter().map(|y| y + small * noise.sample()).collect(),
    }
}

/// First-order filter, whose state starts at the first value.
fn low_pass(frequency: f64, values: &[f64]) -> Vec<f64> {
    let share = 1.0 - (-std::f64::consts::TAU * frequency / RATE).exp();
    let mut state = values[0];
    values
        .iter()
        .map(|y| {
            state += share * (y - state);
            state
        })
        .collect()
}

fn row(clean: &Clean, rows: usize, kind: &str) {
    let rho = match kind {
        "AR 0.45" => 0.45,
        "AR 0.99" => 0.99,
        _ => 0.0,
    };
    let mut noise = Noise::new(7, rho);
    let channels: [Vec<f64>; 3] = std::array::from_fn(|c| spoilt(kind, c, &clean.channels[c], &mut noise));
    let start = Instant::now();
    let found = [0, 1, 2].map(|c| estimate(&clean.tau, &channels[c]));
    let estimated = start.elapsed().as_secs_f64();
    let [a, b, c] = &channels;
    let start = Instant::now();
    let kinks = find_kinks(&clean.tau, [a, b, c], &found, KinkOptions::default());
    let searched = start.elapsed().as_secs_f64();
    let known: Vec<f64> = clean.events.iter().filter(|e| shows(e.1)).map(|e| e.0).collect();
    let near = known.iter().filter(|t| kinks.iter().any(|k| (k.tau - **t).abs() < 0.01)).count();
    let rod = Rod::new(0.1, 6.32e-4).unwrap();
    let samples: Vec<Sample> = (0..clean.tau.len())
        .map(|i| {
            let pose = Pose { x: 0.1 * (0.8 - clean.tau[i]), y: -0.04, phi: std::f64::consts::FRAC_PI_2 };
            let [f0x, f0y, m0z] = [0, 1, 2].map(|c| channels[c][i] * UNITS[c]);
            Sample::new(pose, Reactions { f0x, f0y, m0z })
        })
        .collect();
    let start = Instant::now();
    let whole = if std::env::var_os("KINKS_ONLY").is_some() {
        None
    } else {
        Some(reconstruct(&rod, &samples, &Settings::default()))
    };
    let total = start.elapsed().as_secs_f64();
    let failed = whole.is_some_and(|w| w.is_err());
    println!(
        "| {rows} | {kind} | {estimated:.2} | {searched:.2} | {total:.2} | {} ({near} of {}) | {:.2e} {:.0} |{}",
        kinks.len(),
        known.len(),
        found[1].sigma,
        found[1].long_run,
        if failed { " failed" } else { "" }
    );
}

fn main() {
    let asked: Vec<usize> = std::env::args().skip(1).filter_map(|a| a.parse().ok()).collect();
    let only: Vec<String> = std::env::args().skip(1).filter(|a| a.parse::<usize>().is_err()).collect();
    println!("| rows | noise | estimate, s | kinks, s | reconstruct, s | kinks (right ones) | sigma, long run |");
    println!("|---|---|---|---|---|---|---|");
    for rows in if asked.is_empty() { vec![10_000, 100_000, 1_000_000] } else { asked } {
        let clean = scan(1, 0.4, 1.7 / rows as f64);
        for kind in KINDS.iter().filter(|k| only.is_empty() || only.iter().any(|o| o == *k)) {
            row(&clean, rows, kind);
        }
    }
}
