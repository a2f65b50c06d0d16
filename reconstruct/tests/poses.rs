//! Noisy, stepping and standing poses, and clamps that turn back.

use crate::common::nine_scans::{Clean, scan};
use crate::common::noise::Noise;
use rod_core::{Pose, Reactions, Rod, Sample};
use rod_reconstruct::{Assembly, Finding, Label, Settings, passes, reconstruct, reconstruct_passes};
use std::f64::consts::FRAC_PI_2;

/// Rod length, m, and units of force and moment.
const LENGTH: f64 = 0.1;
const UNITS: [f64; 3] = [0.0632, 0.0632, 0.00632];
/// The object is the graph of the lower of two parabolas 5 x^2 (in L).
const STEEPNESS: f64 = 5.0;

fn rod() -> Rod {
    Rod::new(LENGTH, 6.32e-4).unwrap()
}

/// Samples of O1 at 0.4 L with white noise of the reactions; `pose` gives the measured abscissa (L) from number and true abscissa.
fn samples(clean: &Clean, mut pose: impl FnMut(usize, f64) -> f64) -> Vec<Sample> {
    let mut noise = Noise::new(5, 0.0);
    (0..clean.tau.len())
        .map(|i| {
            let pose = Pose { x: LENGTH * pose(i, 0.8 - clean.tau[i]), y: -0.4 * LENGTH, phi: FRAC_PI_2 };
            let [f0x, f0y, m0z] =
                [0, 1, 2].map(|c| UNITS[c] * (clean.channels[c][i] + [3e-3, 3e-3, 1e-3][c] * noise.normal()));
            Sample::new(pose, Reactions { f0x, f0y, m0z })
        })
        .collect()
}

/// Share of the samples that are used, and the median distance (m) of the single contact points from the object.
fn quality(samples: &[Sample]) -> (f64, f64) {
    let whole = reconstruct(&rod(), samples, &Settings::default()).unwrap();
    let fault = |reason: &rod_reconstruct::Reason| matches!(reason, rod_reconstruct::Reason::Fault(_));
    let lost = whole.readings.iter().filter(|reading| reading.touch.as_ref().is_err_and(fault)).count();
    let mut off: Vec<f64> = whole
        .readings
        .iter()
        .filter(|reading| matches!(reading.label, Label::A | Label::B))
        .filter_map(|reading| reading.touch.ok())
        .map(|touch| {
            let x = touch.x / LENGTH;
            let height = |at: f64| STEEPNESS * (x - at) * (x - at);
            let slope = |at: f64| 2.0 * STEEPNESS * (x - at);
            let near = |at: f64| (touch.y / LENGTH - height(at)).abs() / (1.0 + slope(at) * slope(at)).sqrt();
            LENGTH * near(0.0).min(near(0.3))
        })
        .collect();
    assert!(off.len() > samples.len() / 5, "{} points of {}", off.len(), samples.len());
    off.sort_by(f64::total_cmp);
    (1.0 - lost as f64 / samples.len() as f64, off[off.len() / 2])
}

#[test]
fn a_first_sample_that_cannot_be_used_has_the_label_of_the_next() {
    let samples = samples(&scan(1, 0.4, 2e-5), |_, x| x);
    let whole = reconstruct(&rod(), &samples, &Settings::default()).unwrap();
    let first = whole.readings.iter().position(|reading| reading.label == Label::B).unwrap() + 2000;
    let mut in_contact = samples[first..].to_vec();
    in_contact[0].reactions.f0x = f64::NAN;
    let labels: Vec<Label> = reconstruct(&rod(), &in_contact, &Settings::default())
        .unwrap()
        .readings
        .iter()
        .map(|reading| reading.label)
        .collect();
    assert_eq!(labels[..2], [Label::B, Label::B]);
}

#[test]
fn noisy_and_stepping_poses_are_used() {
    let clean = scan(1, 0.4, 2e-5);
    let (_, best) = quality(&samples(&clean, |_, x| x));
    let mut noise = Noise::new(9, 0.0);
    let trembling = samples(&clean, |_, x| x + 5e-5 * noise.normal());
    let encoder = samples(&clean, |_, x| 5e-5 * (x / 5e-5).floor());
    for (name, samples) in [("noise of 5 um", trembling), ("steps of 5 um", encoder)] {
        assert_eq!(passes(&rod(), &samples).len(), 1, "{name}");
        let (used, off) = quality(&samples);
        println!("{name}: {:.2} % used, {:.2e} m off, {best:.2e} m with exact poses", 100.0 * used, off);
        assert!(used > 0.999 && off < 2.0 * best + 3e-6, "{name}: {used} {off:e} {best:e}");
    }
}

#[test]
fn a_clamp_that_stops_now_and_then_loses_no_samples() {
    // 40 samples at each of 850 places 0.2 mm apart
    let coarse = scan(1, 0.4, 2e-3);
    let held = |values: &Vec<f64>| values.iter().flat_map(|v| std::iter::repeat_n(*v, 40)).collect::<Vec<f64>>();
    let stopped = Clean {
        name: coarse.name.clone(),
        tau: held(&coarse.tau),
        channels: coarse.channels.each_ref().map(held),
        events: coarse.events.clone(),
    };
    let (used, off) = quality(&samples(&stopped, |_, x| x));
    println!("stops: {:.2} % used, {off:.2e} m off", 100.0 * used);
    assert!(used > 0.999 && off < 2e-5, "{used} {off:e}");
}

/// The path was smoothed over the stop, which moved the poses beside it by up to a third of the scan.
#[test]
fn a_stop_leaves_the_poses_beside_it_as_they_are() {
    let clean = scan(1, 0.4, 2e-3);
    let best = quality(&samples(&clean, |_, x| x)).1;
    for (from, held) in [(0, 150), (390, 20), (390, 200)] {
        let stopped = |values: &Vec<f64>| {
            let (before, after) = values.split_at(from + 1);
            before.iter().chain(std::iter::repeat_n(&values[from], held)).chain(after).copied().collect::<Vec<f64>>()
        };
        let stopped = Clean {
            name: clean.name.clone(),
            tau: stopped(&clean.tau),
            channels: clean.channels.each_ref().map(stopped),
            events: clean.events.clone(),
        };
        let mut noise = Noise::new(9, 0.0);
        for trembling in [0.0, 5e-5] {
            let samples = samples(&stopped, |_, x| x + trembling * noise.normal());
            let (used, off) = quality(&samples);
            println!(
                "{held} at {from}, trembling {trembling}: {:.2} % used, {off:.2e} m off, {best:.2e} without",
                100.0 * used
            );
            assert!(used > 0.999 && off < 1.5 * best + 3e-6, "{held} at {from}: {used} {off:e} {best:e}");
        }
    }
}

#[test]
fn forth_and_back_are_two_passes() {
    let clean = scan(1, 0.4, 1e-4);
    let forth = samples(&clean, |_, x| x);
    let both: Vec<Sample> = forth.iter().chain(forth.iter().rev()).copied().collect();
    let found = reconstruct_passes(&rod(), &both, &Settings::default()).unwrap();
    let alone = reconstruct(&rod(), &forth, &Settings::default()).unwrap();
    let passes: Vec<_> = found.passes.iter().map(|pass| pass.samples.clone()).collect();
    assert!(passes.len() == 2 && passes[0].end.abs_diff(forth.len()) <= 1, "{passes:?}");
    assert_eq!(found.readings.len(), both.len());
    let second = found.runs.partition_point(|run| run.0 < passes[1].start);
    assert!(second.abs_diff(alone.runs.len()) <= 1 && found.runs.len() > second, "{:?}", found.runs);
    // the contour has the traces of both, in the numbers of the whole
    let assembly = Assembly::default();
    let (traces, once) = (found.contour(&assembly).traces, alone.contour(&assembly).traces);
    assert!(
        traces.len().abs_diff(2 * once.len()) <= 1 && traces.iter().any(|trace| trace.samples.start >= passes[1].start)
    );
}

#[test]
fn coarse_steps_are_told_of_several_passes_too() {
    let mut forth = samples(&scan(1, 0.4, 1e-4), |_, x| x);
    let step = 0.05 * rod().units().force;
    forth.iter_mut().for_each(|sample| sample.reactions.f0y = (sample.reactions.f0y / step).round() * step);
    let both: Vec<Sample> = forth.iter().chain(forth.iter().rev()).copied().collect();
    for recorded in [&forth, &both] {
        let found = reconstruct_passes(&rod(), recorded, &Settings::default()).unwrap();
        let told = found.findings().iter().any(|finding| matches!(finding, Finding::Coarse { channel: "f0y", .. }));
        assert!(told, "{} passes: {:?}", found.passes.len(), found.findings());
    }
}

#[test]
fn exact_poses_stay_as_they_are() {
    let clean = scan(1, 0.4, 1e-3);
    let mut samples = samples(&clean, |_, x| x);
    let before = reconstruct(&rod(), &samples, &Settings::default()).unwrap();
    // one sample held
    let held = samples[700].pose;
    samples[701].pose = held;
    let after = reconstruct(&rod(), &samples, &Settings::default()).unwrap();
    assert!(after.readings[701].touch.unwrap_err().to_string().contains("usable sample before"));
    assert!(before.readings[..100].iter().zip(&after.readings[..100]).all(|(a, b)| a.label == b.label));
}
