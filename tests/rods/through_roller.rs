//! From reactions and the force of a roller back to the contact, and the check that the fourth reading is.

use super::scans::{cone, o1};
use crate::common::numbers::Numbers;
use std::f64::consts::FRAC_PI_2;
use vibrissa::reconstruct::nalgebra::{Matrix3, Matrix4, Vector4};
use vibrissa::reconstruct::{
    Budget, OneSample, Settings, beyond_roller, one_sample, reconstruct_passes, through_roller,
};
use vibrissa::rod::{Guided, PhysicalRod, Reactions};
use vibrissa::{ClampPath, Pose, Rod, Sample, State, Sweep};

/// Standard deviations of the noise, E I / L^2 and E I / L.
const NOISE: [f64; 4] = [1e-3, 1e-3, 3e-4, 1e-3];

fn uniform() -> Rod {
    Rod::new(1.0, 1.0).unwrap()
}

fn states(rod: &impl PhysicalRod, step: f64) -> Vec<State> {
    let at = |x| Pose { x, y: -0.4, phi: FRAC_PI_2 };
    let outcome = Sweep::new(rod, &o1(), ClampPath::new(at(0.8), at(-0.9)).unwrap(), step).unwrap().run();
    assert!(outcome.stop.is_none());
    outcome.states
}

fn force(state: &State) -> f64 {
    state.roller.as_ref().unwrap().force
}

/// What one sample of exact readings tells, by a rod whose stiffness is given too large.
fn exact(name: &str, rod: &Guided<impl PhysicalRod<Clamp = Pose>>, told_apart: bool) {
    let (mut one, mut several, mut worst, mut stiffness) = (0, 0, 0.0_f64, 0.0_f64);
    for state in states(rod, 0.01) {
        let found = through_roller(rod, state.pose, state.reactions, force(&state), &Matrix4::zeros()).unwrap();
        let beyond = beyond_roller(rod, &Sample::new(state.pose, state.reactions), force(&state)).unwrap();
        let as_rigid = one_sample(rod.rod(), beyond.pose, beyond.reactions, &Matrix3::zeros()).unwrap();
        assert!(found.miss.value.abs() < 1e-10, "{state:?}");
        match (state.phase().to_string().as_str(), found.contact, as_rigid) {
            ("free", OneSample::Free, OneSample::Free) => continue,
            ("A", OneSample::Tip(touch), OneSample::Tip(other))
            | ("B", OneSample::Tangent(touch), OneSample::Tangent(other)) => {
                let contact = &state.contacts[0];
                let off = (touch.x - contact.x).hypot(touch.y - contact.y).max((touch.s - contact.s).abs());
                worst = worst.max(off).max((touch.x - other.x).hypot(touch.y - other.y));
                assert!((touch.force - contact.force).abs() < 1e-8 * (1.0 + contact.force));
                one += 1;
            }
            // the reactions of BB on a uniform rod are those of one contact, also through a roller
            ("BB", OneSample::Tangent(_), OneSample::Tangent(_)) if !told_apart => several += 1,
            ("BA" | "BB", OneSample::Several(_), OneSample::Several(_)) => several += 1,
            other => panic!("{name}: {other:?} {state:?}"),
        }
        assert!((found.s - state.roller.as_ref().unwrap().s).abs() < 1e-10);
        let gain = found.moment_gain.unwrap();
        assert!((gain.value - 1.0).abs() < 1e-8 && gain.sigma == 0.0, "{gain:?}");
        if let Some(found) = found.bending_stiffness.filter(|_| state.reactions.m0z.abs() > 1.0) {
            stiffness = stiffness.max((found.value - 1.0).abs());
        }
    }
    println!(
        "{name}: {one} states of one contact, {several} of two, points off by {worst:e}, stiffness by {stiffness:e}"
    );
    assert!(one > 80 && several > 3 && worst < 1e-9 && stiffness < 1e-6, "{name}");
}

#[test]
fn exact_readings_give_the_contact_and_the_stiffness() {
    for distance in [0.1, 0.2, 0.3] {
        exact("uniform", &Guided::new(uniform(), distance).unwrap(), false);
    }
    exact("cone to 1/2", &Guided::new(cone(0.5), 0.2).unwrap(), true);
}

#[test]
fn the_stiffness_is_found_whatever_was_given() {
    let truth = Guided::new(uniform(), 0.2).unwrap();
    let given = Guided::new(Rod::new(1.0, 1.3).unwrap(), 0.2).unwrap();
    let mut found = 0;
    for state in states(&truth, 0.02).iter().filter(|state| state.reactions.m0z.abs() > 1.0) {
        let told = through_roller(&given, state.pose, state.reactions, force(state), &Matrix4::zeros());
        let Some(stiffness) = told.ok().and_then(|told| told.bending_stiffness) else { continue };
        assert!((stiffness.value - 1.0).abs() < 1e-6, "{stiffness:?}");
        found += 1;
    }
    assert!(found > 30, "{found}");
}

/// In noise: points, misses and estimates are off by their standard deviations, and the fourth reading makes the points better.
#[test]
fn noisy_readings_are_off_by_their_standard_deviations() {
    let rod = Guided::new(uniform(), 0.2).unwrap();
    let covariance = Matrix4::from_diagonal(&Vector4::from(NOISE.map(|sigma| sigma * sigma)));
    // without a roller to tell of: the same, with a moment that is trusted as little as not at all
    let mut dice = Numbers(1);
    let states: Vec<State> = states(&rod, 0.01).into_iter().filter(|state| state.contacts.len() == 1).collect();
    let (mut points, mut misses, mut gains, mut stiffness) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let (mut told, mut alone) = (Vec::new(), Vec::new());
    let (mut weights, mut sum) = (0.0, 0.0);
    for state in states.iter().cycle().take(6 * states.len()) {
        let n = NOISE.map(|sigma| sigma * dice.normal());
        let Reactions { f0x, f0y, m0z } = state.reactions;
        let read = Reactions { f0x: f0x + n[0], f0y: f0y + n[1], m0z: m0z + n[2] };
        let roller = force(state) + n[3];
        let found = through_roller(&rod, state.pose, read, roller, &covariance).unwrap();
        misses.push(found.miss.value / found.miss.sigma);
        let contact = &state.contacts[0];
        let (sin, cos) = contact.alpha.sin_cos();
        if let Some(touch) = found.contact.touch().filter(|_| contact.force > 0.5) {
            let across = (touch.y - contact.y) * cos - (touch.x - contact.x) * sin;
            points.push(across / touch.sigma_normal());
            told.push(across);
            // three readings alone
            let beyond = beyond_roller(&rod, &Sample::new(state.pose, read), roller).unwrap();
            if let Some(other) =
                one_sample(rod.rod(), beyond.pose, beyond.reactions, &Matrix3::zeros()).ok().and_then(|o| o.touch())
            {
                alone.push((other.y - contact.y) * cos - (other.x - contact.x) * sin);
            }
        }
        if m0z.abs() > 0.5 {
            let gain = found.moment_gain.unwrap();
            gains.push((gain.value - 1.0) / gain.sigma);
            if let Some(found) = found.bending_stiffness {
                if found.sigma < 0.15 {
                    stiffness.push((found.value - 1.0) / found.sigma);
                }
                weights += found.sigma.powi(-2);
                sum += found.value * found.sigma.powi(-2);
            }
        }
    }
    let rms = |values: &[f64]| (values.iter().map(|v| v * v).sum::<f64>() / values.len() as f64).sqrt();
    let median = |values: &mut Vec<f64>| {
        values.iter_mut().for_each(|v| *v = v.abs());
        values.sort_by(f64::total_cmp);
        values[values.len() / 2]
    };
    println!(
        "z: points {:.3}, misses {:.3}, gains {:.3}, stiffness {:.3} ({})",
        rms(&points),
        rms(&misses),
        rms(&gains),
        rms(&stiffness),
        stiffness.len()
    );
    println!(
        "median error across the contour with four readings {:e}, with the walk alone {:e}",
        median(&mut told),
        median(&mut alone)
    );
    println!("stiffness of all samples: {} +- {}", sum / weights, weights.powf(-0.5));
    for (what, values) in [("misses", &misses), ("gains", &gains), ("points", &points)] {
        assert!((0.85..1.2).contains(&rms(values)), "{what}: {}", rms(values));
    }
    assert!(misses.len() > 600 && stiffness.len() > 20 && (0.7..1.4).contains(&rms(&stiffness)));
    assert!(median(&mut told) < median(&mut alone));
}

/// A whole recording without the roller: labels and both contacts, as of a rod on a rigid clamp.
#[test]
fn a_recording_beyond_the_roller_is_one_of_a_rigid_clamp() {
    let rod = Guided::new(uniform(), 0.1).unwrap();
    let states = states(&rod, 1e-3);
    let sample = |state: &State| beyond_roller(&rod, &Sample::new(state.pose, state.reactions), force(state)).unwrap();
    let samples: Vec<Sample> = states.iter().map(sample).collect();
    let settings = Settings { budget: Some(Budget::NONE), ..Settings::default() };
    let found = reconstruct_passes(&uniform(), &samples, &settings).unwrap();
    let (mut right, mut points, mut worst) = (0, 0, 0.0_f64);
    for (state, reading) in states.iter().zip(&found.readings) {
        right += usize::from(reading.label.to_string() == state.phase().to_string());
        let touches = [reading.touch.as_ref().ok(), reading.second.as_ref().and_then(|second| second.as_ref().ok())];
        for (touch, contact) in touches.iter().zip(&state.contacts) {
            let Some(touch) = touch else { continue };
            points += 1;
            worst = worst.max((touch.x - contact.x).hypot(touch.y - contact.y));
        }
    }
    println!("{} samples, {right} labels right, {points} points, off by {worst:e}", states.len());
    assert!(right as f64 > 0.97 * states.len() as f64 && points > 800);
}

#[test]
fn what_is_no_sample() {
    let rod = Guided::new(uniform(), 0.2).unwrap();
    let pose = Pose { x: 0.0, y: 0.0, phi: 0.0 };
    let told = |f0y: f64, m0z: f64, roller: f64| {
        through_roller(&rod, pose, Reactions { f0x: 0.0, f0y, m0z }, roller, &Matrix4::zeros())
    };
    assert_eq!(told(0.0, 0.0, 0.0).unwrap().contact, OneSample::Free);
    assert!(told(0.0, f64::NAN, 0.0).unwrap_err().to_string().contains("not finite"));
    assert!(told(0.0, 0.0, f64::INFINITY).unwrap_err().to_string().contains("not finite"));
    assert!(told(0.0, 0.5, 0.0).unwrap_err().to_string().contains("vanishes nowhere"));
    // force and moment that bend it to the same side: neither a stiffness nor a gain brings it to the roller
    let found = told(-1.0, 0.5, -3.0).unwrap();
    assert!(found.miss.value < -1e-3 && found.bending_stiffness.is_none() && found.moment_gain.is_none(), "{found:?}");
}
