//! The hot path works without the heap: segments, walks, and solves that have been made once.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use crate::common::Scene;
use allocation_counter::measure;
use nalgebra::{Matrix3, Vector3};
use std::collections::BTreeMap;
use std::hint::black_box;
use vibrissa::contact::ContactKind;
use vibrissa::reconstruct::noise_estimate::ChannelNoise;
use vibrissa::reconstruct::{Ar1, Dropout, Live, LiveSettings, NoiseModel, single};
use vibrissa::rod::{
    Hold, MultiPoint, NewtonOptions, NewtonWorkspace, Reactions, Section, Support, Supports, Uniform, advance,
    advance_with_sensitivities, solve, walk,
};
use vibrissa::{Label, Pose, Rod, Sample, State, Sweep};

#[test]
fn the_counter_counts() {
    let counted = measure(|| drop(black_box(vec![1.0; 100])));
    assert_eq!((counted.count_total, counted.count_current), (1, 0));
}

#[test]
fn segments_and_walks_do_not_allocate() {
    let start = Section { x: 0.1, y: 0.2, phi: 1.0, kappa: 3.0 };
    let coiled = Section { kappa: 60.0, ..start };
    let counted = measure(|| {
        for start in [start, coiled] {
            black_box(advance(black_box(&start), 4.0, -2.0, 0.9));
            black_box(advance_with_sensitivities(black_box(&start), 4.0, -2.0, -0.9));
            for steps in [1, 10, 1000] {
                black_box(walk(black_box(&start), 4.0, -2.0, 0.9, steps).map(|at| at.x).sum::<f64>());
            }
        }
    });
    assert_eq!(counted.count_total, 0);
}

/// Two equal parabolas y = 5 (x - v)^2 by the abscissa from the vertex.
struct TwoParabolas<'a>(&'a [(f64, Hold)]);

impl Supports for TwoParabolas<'_> {
    fn count(&self) -> usize {
        self.0.len()
    }
    fn hold(&self, j: usize) -> Hold {
        self.0[j].1
    }
    fn support(&self, j: usize, t: f64) -> Support {
        let steepness = (10.0 * t).hypot(1.0);
        Support {
            x: self.0[j].0 + t,
            y: 5.0 * t * t,
            alpha: (10.0 * t).atan(),
            speed: steepness,
            turning: 10.0 / (steepness * steepness),
        }
    }
}

/// The contacts of a state as supports, and its unknowns.
fn unknowns(scene: &Scene, state: &State) -> (Vec<(f64, Hold)>, Vec<f64>) {
    let rod = state.elastica(&scene.rod()).unwrap();
    let mut supports = Vec::new();
    let mut u = Vec::new();
    for c in &state.contacts {
        let vertex = scene.bumps.pieces[c.piece].x;
        let phi = rod.at(c.s).phi;
        let (hold, third) = match c.kind {
            ContactKind::Tip => (Hold::Tip, phi),
            _ => {
                let turns = ((phi - c.alpha) / std::f64::consts::PI).round();
                (Hold::Tangent { offset: turns * std::f64::consts::PI }, c.s)
            }
        };
        supports.push((vertex, hold));
        u.extend([c.x - vertex, c.force, third]);
    }
    (supports, u)
}

#[test]
fn warm_started_solves_do_not_allocate() {
    let scene = Scene::paper(0.0, 0.0, 0.4);
    let outcome = scene.run_through();
    let mut solved: BTreeMap<String, u32> = BTreeMap::new();
    let mut workspace = NewtonWorkspace::new();
    let options = NewtonOptions::default();
    for pair in outcome.states.windows(2) {
        let [before, after] = pair else { continue };
        if before.phase() != after.phase() || before.contacts.is_empty() {
            continue;
        }
        let (supports, start) = unknowns(&scene, before);
        let supports = TwoParabolas(&supports);
        let here = MultiPoint { rod: Uniform, clamp: before.pose, supports: &supports };
        let there =
            MultiPoint { rod: Uniform, clamp: Pose { x: before.pose.x - 1e-3, ..before.pose }, supports: &supports };
        let mut u = start.clone();
        // the workspace has seen the dimension
        let report = solve(&here, &mut u, &options, &mut workspace);
        assert!(report.status.is_solved() && report.residual < 1e-12, "{report:?}");
        assert!(u.iter().zip(&start).all(|(u, v)| (u - v).abs() < 1e-9 * (1.0 + v.abs())), "{u:?} {start:?}");
        let mut report = None;
        let counted = measure(|| report = Some(solve(&there, black_box(&mut u), &options, &mut workspace)));
        let report = report.unwrap();
        assert!(report.status.is_solved() && report.iterations > 0, "{report:?}");
        assert_eq!(counted.count_total, 0, "phase {}", before.phase());
        *solved.entry(before.phase().to_string()).or_default() += 1;
    }
    assert_eq!(solved.keys().collect::<Vec<_>>(), ["A", "B", "BA", "BB"], "{solved:?}");
}

#[test]
fn a_further_state_of_a_sweep_allocates_its_contacts_only() {
    let scene = Scene::paper(0.0, 0.0, 0.4);
    let (rod, contour) = (scene.rod(), scene.bumps.contour().unwrap());
    let allocations = |states: u64| {
        let path = scene.path();
        let step = path.length() / (states - 1) as f64;
        let sweep = Sweep::new(&rod, &contour, path, step).unwrap();
        measure(|| sweep.for_each(|item| drop(black_box(item.unwrap())))).count_total
    };
    let further = allocations(1501) - allocations(501);
    assert!(further <= 1000, "{further}");
}

#[test]
fn a_noisy_sensor_does_not_allocate() {
    let all = Reactions { f0x: 1.0, f0y: 1.0, m0z: 1.0 };
    let model = NoiseModel {
        gain: all,
        white: all,
        ar1: Ar1 { sigma: all, correlation: 0.5 },
        random_walk: all,
        quantum: all,
        dropout: Dropout { probability: 0.1, mean_length: Some(2.0) },
        ..NoiseModel::default()
    };
    let mut sensor = model.generator(0).unwrap();
    let counted = measure(|| {
        for _ in 0..1000 {
            black_box(sensor.sample(black_box(all)));
        }
    });
    assert_eq!(counted.count_total, 0);
}

#[test]
fn inversions_and_the_live_identification_do_not_allocate() {
    let rod = rod_of_one();
    let noise = [0.04, 0.04, 0.01];
    let covariance = Matrix3::from_diagonal(&Vector3::from(noise).map(|sigma| sigma * sigma));
    // in and out of contact several times, with noise that the model makes
    let white = Reactions { f0x: noise[0], f0y: noise[1], m0z: noise[2] };
    let mut sensor = NoiseModel { white, ..NoiseModel::default() }.generator(3).unwrap();
    let samples: Vec<Sample> = (0..40_000)
        .filter_map(|k| {
            let way = 2e-5 * f64::from(k);
            let force = (30.0 * way).sin().max(0.0);
            let felt = Reactions { f0x: -3.0 * force, f0y: force, m0z: 2.0 * force };
            Some(Sample::new(Pose { x: -way, y: 0.0, phi: 1.5 }, sensor.sample(felt)?))
        })
        .collect();
    let settings = LiveSettings { half_window: 5e-3, ..LiveSettings::new(noise.map(ChannelNoise::white), 2e-5) };
    let mut live = Live::new(&rod, &settings).unwrap();
    let mut labels = [0; 5];
    let counted = measure(|| {
        for sample in &samples {
            black_box(single(&rod, sample.pose, sample.reactions, &covariance).ok());
            if let Some(reading) = live.push(sample) {
                labels[reading.label as usize] += 1;
            }
        }
    });
    assert!(labels[Label::Free as usize] > 5000 && labels.iter().filter(|count| **count > 0).count() > 1, "{labels:?}");
    assert_eq!(counted.count_total, 0);
}

fn rod_of_one() -> Rod {
    Rod::new(1.0, 1.0).unwrap()
}
