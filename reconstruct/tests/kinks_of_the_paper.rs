//! Kinks of the paper's nine scans in noise.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout)]

use crate::common::nine_scans::{Clean, nine, scan, shows};
use crate::common::noise::Noise;
use rod_reconstruct::kink::{Kink, KinkFilter, KinkOptions, find_kinks};
use rod_reconstruct::noise_estimate::estimate;
use std::time::Instant;

/// 1 mm on a rod of 100 mm.
const TOLERANCE: f64 = 0.01;
/// 2 um: the way of the clamp at 1 mm/s between samples at 500 Hz.
const STEP: f64 = 2e-5;

#[derive(Default, Debug)]
struct Tally {
    scans: usize,
    events: usize,
    found: usize,
    alarms: usize,
    errors: Vec<f64>,
    pulls: Vec<f64>,
    missed: Vec<String>,
    falsely: Vec<String>,
}

impl Tally {
    fn count(&mut self, clean: &Clean, kinks: &[Kink]) {
        self.scans += 1;
        let mut used = vec![false; kinks.len()];
        let mut order: Vec<_> = clean.events.iter().collect();
        order.sort_by_key(|e| !shows(e.1));
        for (at, kind, what) in order {
            let near = (0..kinks.len())
                .filter(|k| !used[*k] && (kinks[*k].tau - at).abs() <= TOLERANCE)
                .min_by(|a, b| (kinks[*a].tau - at).abs().total_cmp(&(kinks[*b].tau - at).abs()));
            if let Some(k) = near {
                used[k] = true;
            }
            if shows(*kind) {
                self.events += 1;
                match near {
                    Some(k) => {
                        self.found += 1;
                        self.errors.push((kinks[k].tau - at).abs());
                        self.pulls.push((kinks[k].tau - at).abs() / kinks[k].sigma_tau);
                    }
                    None => self.missed.push(format!("{} {at:.4} {kind} {what}", clean.name)),
                }
            }
        }
        for (kink, used) in kinks.iter().zip(used) {
            if !used {
                self.alarms += 1;
                self.falsely.push(format!("{} {:.5} {:?} score {:.0}", clean.name, kink.tau, kink.kind, kink.score));
            }
        }
    }

    fn quantile(values: &[f64], share: f64) -> f64 {
        let mut sorted = values.to_vec();
        sorted.sort_by(f64::total_cmp);
        sorted
            .get(((sorted.len() as f64 * share) as usize).min(sorted.len().saturating_sub(1)))
            .copied()
            .unwrap_or(f64::NAN)
    }

    fn row(&self, what: &str) -> String {
        format!(
            "{what:<28} recall {}/{} = {:.2} %  false/scan {:.3}  error median {:.2e} 95 % {:.2e}  pull median {:.2}",
            self.found,
            self.events,
            100.0 * self.found as f64 / self.events as f64,
            self.alarms as f64 / self.scans as f64,
            Self::quantile(&self.errors, 0.5),
            Self::quantile(&self.errors, 0.95),
            Self::quantile(&self.pulls, 0.5),
        )
    }
}

fn noisy(clean: &Clean, sigma: [f64; 3], correlation: f64, seed: u64) -> [Vec<f64>; 3] {
    let mut noise = Noise::new(seed, correlation);
    [0, 1, 2].map(|c| noise.add(sigma[c], &clean.channels[c]))
}

fn found(tau: &[f64], channels: &[Vec<f64>; 3]) -> Vec<Kink> {
    let noise = [0, 1, 2].map(|c| estimate(tau, &channels[c]));
    find_kinks(tau, [0, 1, 2].map(|c| &channels[c][..]), &noise, options())
}

/// From the environment, to try the table with others.
fn number(name: &str) -> Option<f64> {
    std::env::var(name).ok().and_then(|value| value.parse().ok())
}

fn options() -> KinkOptions {
    let usual = KinkOptions::default();
    KinkOptions {
        false_alarms: number("ALARMS").unwrap_or(usual.false_alarms),
        widest: number("WIDEST").unwrap_or(usual.widest),
    }
}

/// Sample by sample, with the noise of the whole recording.
fn found_online(tau: &[f64], channels: &[Vec<f64>; 3], options: KinkOptions) -> Vec<Kink> {
    let noise = [0, 1, 2].map(|c| estimate(tau, &channels[c]));
    let mut filter = KinkFilter::new(STEP, noise, options, tau.len());
    let mut kinks = Vec::new();
    for i in 0..tau.len() {
        kinks.extend(filter.push(tau[i], [0, 1, 2].map(|c| channels[c][i])));
    }
    kinks.extend(std::iter::from_fn(|| filter.finish()));
    kinks
}

/// Standard deviations of force and moment: 0.2 mN / 0.02 mN m, 2.5 / 0.06, 10 / 0.5 on the paper's wire.
const LEVELS: [(&str, f64, f64); 3] =
    [("0.2 mN", 0.2 / 63.2, 0.02 / 6.32), ("2.5 mN", 2.5 / 63.2, 0.06 / 6.32), ("10 mN", 10.0 / 63.2, 0.5 / 6.32)];

#[test]
fn clean_scans_show_all_and_nothing_else() {
    for scan in nine(STEP).iter().step_by(2) {
        let mut tally = Tally::default();
        tally.count(scan, &found(&scan.tau, &scan.channels));
        assert!(tally.found == tally.events && tally.alarms == 0, "{tally:#?}");
        assert!(Tally::quantile(&tally.errors, 1.0) < STEP, "{tally:#?}");
    }
}

/// A part of the table below.
#[test]
fn noisy_scans_show_nearly_all_and_hardly_anything_else() {
    let scans = [scan(1, 0.4, STEP), scan(2, 0.2, STEP), scan(3, 0.6, STEP)];
    for (level, force, moment) in &LEVELS[..2] {
        for correlation in [0.0, 0.45] {
            let mut tally = Tally::default();
            for (index, scan) in scans.iter().enumerate() {
                for seed in 0..3 {
                    let channels = noisy(scan, [*force, *force, *moment], correlation, 100 * index as u64 + seed);
                    tally.count(scan, &found(&scan.tau, &channels));
                }
            }
            println!("{}", tally.row(&format!("{level} rho {correlation}")));
            // of 51 transitions one may be missed
            assert!(tally.found + 1 >= tally.events && 2 * tally.alarms <= tally.scans, "{tally:#?}");
            assert!(Tally::quantile(&tally.errors, 0.5) < 2e-4, "{tally:#?}");
        }
    }
}

/// With a sample a millimetre, most windows hold several transitions: most are found, and nothing that is none.
#[test]
fn coarse_scans_show_most() {
    let mut tally = Tally::default();
    for scan in nine(0.01) {
        tally.count(&scan, &found(&scan.tau, &scan.channels));
    }
    println!("{}\n{:#?}\n{:#?}", tally.row("170 samples"), tally.missed, tally.falsely);
    assert!(tally.alarms <= 9);
}

/// `cargo test --release -p rod-reconstruct --test suite kinks_of_the_paper -- --ignored --nocapture`
#[test]
#[ignore = "prints a table, minutes"]
fn table() {
    let seeds = number("SEEDS").unwrap_or(20.0) as u64;
    let scans = nine(STEP);
    let mut tally = Tally::default();
    let start = Instant::now();
    for scan in &scans {
        tally.count(scan, &found(&scan.tau, &scan.channels));
    }
    println!("{} {:.0} ms a scan", tally.row("clean"), 1e3 * start.elapsed().as_secs_f64() / scans.len() as f64);
    for (level, force, moment) in LEVELS {
        for correlation in [0.0, 0.45] {
            let mut tally = Tally::default();
            let mut time = 0.0;
            for (index, scan) in scans.iter().enumerate() {
                for seed in 0..seeds {
                    let channels = noisy(scan, [force, force, moment], correlation, 1000 * index as u64 + seed);
                    let start = Instant::now();
                    let kinks = found(&scan.tau, &channels);
                    time += start.elapsed().as_secs_f64();
                    tally.count(scan, &kinks);
                }
            }
            println!("{} {:.0} ms", tally.row(&format!("{level} rho {correlation}")), 1e3 * time / tally.scans as f64);
            if std::env::var("VERBOSE").is_ok() {
                let mut list = tally.missed.clone();
                list.sort();
                for group in list.chunk_by(|a, b| a == b) {
                    println!("    missed {}x {}", group.len(), group[0]);
                }
                let mut list = tally.falsely.clone();
                list.sort();
                for line in list.iter().take(40) {
                    println!("    false {line}");
                }
            }
        }
    }
    for widest in [0.02, 0.04, 0.08] {
        for correlation in [0.0, 0.45] {
            let mut tally = Tally::default();
            let mut time = 0.0;
            let mut samples = 0;
            let (_, force, moment) = LEVELS[1];
            for (index, scan) in scans.iter().enumerate() {
                for seed in 0..seeds {
                    let channels = noisy(scan, [force, force, moment], correlation, 1000 * index as u64 + seed);
                    let start = Instant::now();
                    let kinks = found_online(&scan.tau, &channels, KinkOptions { widest, ..options() });
                    time += start.elapsed().as_secs_f64();
                    samples += scan.tau.len();
                    tally.count(scan, &kinks);
                }
            }
            let row = tally.row(&format!("2.5 mN rho {correlation} online {widest}"));
            println!("{row} {:.2} us a sample", 1e6 * time / samples as f64);
        }
    }
}
