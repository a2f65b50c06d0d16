//! Plans against the truth that they do not know.
#![allow(clippy::unwrap_used)]

use rod_contours::{CircularArc, Composite, Contour};
use rod_core::Rod;
use rod_plan::{Measurement, Plan, PlanSettings, ReachGrid, plan, reach, straight_candidates};
use rod_reconstruct::{FittedObject, Knowledge};
use std::cell::Cell;
use std::f64::consts::{FRAC_PI_2, TAU};
use std::sync::atomic::{AtomicUsize, Ordering};

const RADIUS: f64 = 0.25;

fn rod() -> Rod {
    Rod::from_diameter(1.0, 0.005, 206e9).unwrap()
}

/// The lower part of a circle, as a scan from below leaves it.
fn known() -> Vec<FittedObject> {
    let (from, to, count) = (-2.4, -0.74, 40);
    let angle = |k: usize| from + (to - from) * k as f64 / (count - 1) as f64;
    vec![FittedObject {
        points: (0..count).map(|k| [RADIUS * angle(k).cos(), RADIUS * angle(k).sin()]).collect(),
        vertices: Vec::new(),
        known: vec![Knowledge::Touched { sigma: 1e-4 }; count],
    }]
}

fn grid(angles: usize) -> ReachGrid {
    let angle = |k: usize| FRAC_PI_2 + TAU * k as f64 / angles as f64;
    ReachGrid { distances: vec![0.4, 0.6], angles: (0..angles).map(angle).collect(), ..ReachGrid::of(&rod()) }
}

fn planned(angles: usize, settings: &PlanSettings) -> Plan {
    let candidates = straight_candidates(&rod(), &known(), &grid(angles), settings, &|| true).unwrap();
    plan(&rod(), &known(), &candidates, settings, &|_| true).unwrap()
}

/// The scans that add most are from the sides, and the first two of them see nearly all of a circle that three can see.
#[test]
fn greedy_scans_are_near_the_best_ones_and_come_from_other_sides() {
    let plan = planned(8, &PlanSettings { hypotheses: 3, ..PlanSettings::default() });
    assert_eq!(plan.forecasts.len(), 32);
    for count in 1..=3 {
        let choices = plan.greedy(count);
        let (best, value) = plan.best(count);
        assert!(best.len() <= count && choices.len() <= count);
        let share = choices.last().unwrap().value / value;
        let bound = 1.0 - (1.0 - 1.0 / count as f64).powi(count as i32);
        assert!(share >= bound - 1e-12 && share <= 1.0 + 1e-12, "{count}: {share}");
        assert!((plan.value(&best) - value).abs() < 1e-12);
    }
    // from below nothing is new but the sides
    let from_below = &plan.forecasts[0];
    let first = plan.greedy(1)[0];
    assert!(first.value > 2.0 * from_below.gain.unwrap().mean, "{first:?} {from_below:?}");
    let angle = plan.forecasts[first.candidate].candidate.scan.unwrap().angle;
    assert!((angle - FRAC_PI_2).abs() > 0.5);
}

/// The end is asked for within a scan, too: one alone may take minutes.
#[test]
fn a_plan_ends_within_a_scan() {
    let settings = PlanSettings { hypotheses: 1, ..PlanSettings::default() };
    let candidates = straight_candidates(&rod(), &known(), &grid(2), &settings, &|| true).unwrap();
    let left = Cell::new(3);
    let fewer = straight_candidates(&rod(), &known(), &grid(2), &settings, &|| left.replace(left.get() - 1) > 0);
    assert_eq!(fewer.unwrap().len(), 3);
    let asked = AtomicUsize::new(0);
    let ended = plan(&rod(), &known(), &candidates[..1], &settings, &|_| asked.fetch_add(1, Ordering::Relaxed) < 5);
    assert!(ended.unwrap().forecasts.is_empty());
    // at the first no, at the first state past the second object, and when the candidate is done
    assert_eq!(asked.load(Ordering::Relaxed), 8);
}

/// A rod that must not bend so far is given other scans, or none. Those are the ones of a plan without a limit that keep it, with the same gains, and a scan beyond it is
/// swept no further.
#[test]
fn scans_beyond_the_stress_are_left_out() {
    let settings = PlanSettings { hypotheses: 2, ..PlanSettings::default() };
    let all = planned(8, &settings);
    let stresses: Vec<f64> = all.forecasts.iter().map(|forecast| forecast.largest_stress.unwrap()).collect();
    let most = stresses.iter().copied().fold(0.0, f64::max);
    let least = stresses.iter().copied().fold(f64::INFINITY, f64::min);
    let within = |limit: f64| planned(8, &PlanSettings { most_stress: Some(limit), ..settings.clone() });
    assert!(within(0.9 * least).greedy(1).is_empty());
    let limit = 0.5 * (least + most);
    let some = within(limit);
    assert!(!some.greedy(3).is_empty());
    for ((one, own), stress) in all.forecasts.iter().zip(&some.forecasts).zip(&stresses) {
        let is_within = *stress <= limit;
        assert_eq!((own.gain, own.swept == 3), (one.gain.filter(|_| is_within), is_within || own.swept == 3));
        assert!(is_within || own.largest_stress.unwrap() > limit);
    }
    assert!(some.forecasts.iter().any(|own| own.swept == 1));
}

/// What is expected of a circle, of which all points have one curvature, is what a scan of the circle gives.
#[test]
fn the_expected_gain_of_a_circle_is_the_true_one() {
    let settings = PlanSettings { hypotheses: 3, ..PlanSettings::default() };
    let plan = planned(12, &settings);
    let circle = Composite::single(CircularArc::new([0.0, 0.0], RADIUS, 0.4, 0.4 + TAU).unwrap()).unwrap();
    let grid = grid(12);
    let truth = reach(&rod(), std::slice::from_ref(&circle), &grid, &|_| true).unwrap();
    let outline = &truth.outlines[0];
    let mut before = rod_plan::IntervalSet::default();
    let points = &known()[0].points;
    let ends = [points[0], points[points.len() - 1]].map(|[x, y]| outline.nearest(&circle, x, y).unwrap());
    before.insert(ends[0], ends[1]);
    let mut compared = 0;
    for (forecast, scan) in plan.forecasts.iter().zip(&truth.scans) {
        let angle = forecast.candidate.scan.unwrap().angle;
        let expected = forecast.gain.unwrap().mean;
        let gain = scan.found.touched.all(0).without(&before).length();
        assert!((expected - gain).abs() < 0.05 * RADIUS, "{angle}: {expected} {gain}");
        compared += 1;
    }
    assert_eq!(compared, 48);
    assert!(circle.gap(0.0, 0.0) < 0.0);
}

#[test]
fn twice_the_noise_is_twice_the_sigma_and_what_is_known_gets_better() {
    let measurement = |noise: f64| Measurement {
        sigma: [noise, noise, 0.1 * noise],
        long_run: [1.0; 3],
        spacing: 1e-3,
        resolution: 0.02,
        // so weak a prior that the noise decides
        bend: 1e4,
    };
    let stiffness = rod().bending_stiffness();
    let run = |noise: f64| {
        let measurement = Some(measurement(noise * stiffness));
        let settings = PlanSettings { hypotheses: 1, measurement, ..PlanSettings::default() };
        let candidates = straight_candidates(&rod(), &known(), &grid(4), &settings, &|| true).unwrap();
        plan(&rod(), &known(), &candidates[..2], &settings, &|_| true).unwrap().forecasts.swap_remove(0)
    };
    let [one, two] = [0.1, 0.2].map(run);
    assert!(one.sigmas.len() > 10);
    let middle = |forecast: &rod_plan::Forecast| forecast.sigmas[forecast.sigmas.len() / 2].sigma;
    let ratio = middle(&two) / middle(&one);
    assert!((1.8..=2.05).contains(&ratio), "{ratio}");
    let [before, after] = one.known_sigma().unwrap();
    assert!(after < before);
}
