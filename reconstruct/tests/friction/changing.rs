//! Friction that is strong, that changes, or that is not there.

use super::parabola::{State, scan};
use super::recording::rod;
use crate::common::noise::Noise;
use rod_core::Sample;
use rod_reconstruct::{Budget, Finding, Friction, FrictionEstimate, Label, Reconstruction, Settings, reconstruct};

/// Samples of the scans with noise, and of those without.
const FINE: f64 = 2e-5;
const COARSE: f64 = 4e-4;

/// The samples as an industrial sensor reads them, 2.5 mN and 0.06 mN m for a wire of 100 mm and 6.32e-4 N m^2.
fn noisy(states: &[State], seed: u64) -> Vec<Sample> {
    let mut noise = Noise::new(seed, 0.0);
    let sample = |state: &State| {
        let mut sample = state.sample;
        sample.reactions.f0x += 2.5 / 63.2 * noise.sample();
        sample.reactions.f0y += 2.5 / 63.2 * noise.sample();
        sample.reactions.m0z += 0.06 / 6.32 * noise.sample();
        sample
    };
    states.iter().map(sample).collect()
}

fn found(samples: &[Sample], friction: Friction, budget: Option<Budget>) -> Reconstruction {
    reconstruct(&rod(), samples, &Settings { friction, budget, ..Settings::default() }).unwrap()
}

fn estimate(found: &Reconstruction) -> FrictionEstimate {
    found.passes[0].friction.unwrap()
}

/// The distances of contact points across the contour, with their standard deviations; and the share of samples in contact without one.
fn off(states: &[State], found: &Reconstruction) -> (Vec<(f64, f64)>, f64) {
    let (mut off, mut none) = (Vec::new(), 0.0);
    for (reading, state) in found.readings.iter().zip(states) {
        let Some([_, x, y, alpha]) = state.contact else { continue };
        match reading.touch {
            Ok(touch) => {
                off.push(((alpha.cos() * (touch.y - y) - alpha.sin() * (touch.x - x)).abs(), touch.sigma_normal()));
            }
            Err(_) => none += 1.0,
        }
    }
    let touching = states.iter().filter(|state| state.contact.is_some()).count();
    (off, none / touching as f64)
}

fn right(states: &[State], found: &Reconstruction) -> f64 {
    let right = found.readings.iter().zip(states).filter(|(reading, state)| reading.label == state.label).count();
    right as f64 / states.len() as f64
}

#[test]
fn exact_samples_of_any_coefficient_and_either_direction() {
    for mu in [0.0, 0.1, 0.3, 0.6, -0.3] {
        let states = scan(COARSE, -0.3, |_| mu);
        let samples: Vec<Sample> = states.iter().map(|state| state.sample).collect();
        let found = found(&samples, Friction::Estimate, Some(Budget::NONE));
        assert!((found.passes[0].used_friction - mu).abs() < 1e-11, "{mu}: {:?}", found.passes[0]);
        assert!(right(&states, &found) > 0.999, "{mu}: {}", right(&states, &found));
        let (off, none) = off(&states, &found);
        assert!(none < 2e-3 && off.iter().all(|(off, _)| *off < 1e-10), "{mu}: {none} without");
        assert!(estimate(&found).is_significant() == (mu != 0.0), "{:?}", estimate(&found));
    }
}

#[test]
fn the_coefficient_is_found_in_noise_as_well_as_stated() {
    for (seed, mu) in [0.0, 0.02, 0.1, 0.3].into_iter().enumerate() {
        let states = scan(FINE, -0.3, |_| mu);
        let samples = noisy(&states, seed as u64);
        for budget in [Some(Budget::NONE), None] {
            let found = found(&samples, Friction::Estimate, budget);
            let against = |finding: &Finding| matches!(finding, Finding::FrictionAgainst { .. });
            assert!(!found.findings().iter().any(against), "{mu}: {:?}", found.findings());
            // what friction does not change is not measured by what friction lets it be
            let misfit = |finding: &Finding| matches!(finding, Finding::Misfit { .. });
            assert!(!found.findings().iter().any(misfit), "{mu}: {:?}", found.findings());
            let friction = estimate(&found);
            let z = (friction.mu - mu) / friction.sigma_of_noise;
            assert!(z.abs() < 5.0 && friction.sigma_of_noise < 1e-4, "{mu}: {friction:?}");
            assert!(right(&states, &found) > 0.995, "{mu}: {}", right(&states, &found));
            let (mut off, none) = off(&states, &found);
            let far = off.iter().filter(|(off, sigma)| *off > 6.0 * sigma).count();
            assert!(far == 0 && none < 0.02, "{mu}: {far} far, {none} without");
            off.sort_by(|a, b| a.0.total_cmp(&b.0));
            assert!(off[off.len() / 2].0 < 1e-4, "{mu}: {}", off[off.len() / 2].0);
            // errors of an ordinary laboratory explain friction of 0.02, not of 0.1
            if budget.is_none() {
                assert_eq!(friction.is_identified(), mu > 0.05, "{friction:?}");
                assert!(friction.sigma > 5e-3, "{friction:?}");
            } else {
                assert_eq!(friction.is_identified(), mu > 0.0, "{friction:?}");
            }
        }
    }
}

#[test]
fn strong_friction_that_nobody_asked_for_is_named() {
    for mu in [0.1, 0.3] {
        let samples = noisy(&scan(FINE, -0.3, |_| mu), 7);
        for budget in [Some(Budget::NONE), None] {
            let found = found(&samples, Friction::None, budget);
            let named = found.findings().into_iter().any(|finding| matches!(finding, Finding::Friction { .. }));
            assert!(named, "{mu}: {:?}", found.findings());
        }
    }
}

/// A coefficient that changes along the scan, slowly and at once: what is off is not silent.
#[test]
fn friction_that_changes_is_told() {
    let slow = |x0: f64| 0.2 + 0.3 * x0;
    let at_once = |x0: f64| if x0 > 0.1 { 0.1 } else { 0.2 };
    for mu in [&slow as &dyn Fn(f64) -> f64, &at_once] {
        let states = scan(FINE, -0.3, mu);
        let samples = noisy(&states, 3);
        for budget in [Some(Budget::NONE), None] {
            let found = found(&samples, Friction::Estimate, budget);
            let told = found.findings();
            assert!(told.iter().any(|finding| matches!(finding, Finding::FrictionChanges { .. })), "{told:?}");
        }
    }
}

/// One piece of an object that is greased: a fifth of the tangential path has another coefficient.
#[test]
fn another_coefficient_along_a_part_of_the_path_is_told() {
    let told = |other: f64, noise: bool| {
        let states = scan(if noise { FINE } else { COARSE }, -0.3, |x0| if x0 > -0.15 { 0.15 } else { other });
        let exact = || states.iter().map(|state| state.sample).collect();
        let samples: Vec<Sample> = if noise { noisy(&states, 11) } else { exact() };
        let found = found(&samples, Friction::Estimate, Some(Budget::NONE));
        found.findings().into_iter().find(|finding| matches!(finding, Finding::FrictionChanges { .. }))
    };
    for noise in [false, true] {
        let Some(Finding::FrictionChanges { mu, spread, .. }) = told(0.1, noise) else {
            panic!("nothing told: {noise}")
        };
        assert!((mu - 0.15).abs() < 1e-3 && (spread - 0.05).abs() < 5e-3, "{mu} {spread}");
        assert_eq!(told(0.15, noise), None);
    }
}

/// A rod that sticks now and then: K / (2 |F|) is anywhere between -sin rho and sin rho there.
#[test]
fn samples_whose_friction_is_another_have_no_point_that_is_off() {
    let sticks = |x0: f64| if (0.0..0.04).contains(&x0) { 0.3 - 0.6 * (0.04 - x0) / 0.04 } else { 0.3 };
    let states = scan(FINE, -0.3, sticks);
    let found = found(&noisy(&states, 5), Friction::Estimate, Some(Budget::NONE));
    assert!((found.passes[0].used_friction - 0.3).abs() < 1e-3, "{:?}", found.passes[0]);
    for (reading, state) in found.readings.iter().zip(&states) {
        let (Ok(touch), Some([_, x, y, alpha])) = (reading.touch, state.contact) else { continue };
        let off = (alpha.cos() * (touch.y - y) - alpha.sin() * (touch.x - x)).abs();
        assert!(off < 0.01, "{off} at {}: {:?}", state.sample.pose.x, reading.label);
    }
    let slid = found.readings.iter().zip(&states).filter(|(_, state)| state.label == Label::B);
    let slid = slid.filter(|(_, state)| !(-0.01..0.05).contains(&state.sample.pose.x));
    let (all, kept) =
        slid.fold((0, 0), |(all, kept), (reading, _)| (all + 1, kept + usize::from(reading.touch.is_ok())));
    assert!(20 * kept > 19 * all, "{kept} of {all}");
}
