//! Random rods, objects and ways of the clamp: whatever is reported is an equilibrium.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod common;

use common::Scene;
use common::bumps::Bumps;
use common::judge::judge;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestCaseError, TestRng, TestRunner};
use std::cell::RefCell;
use std::collections::BTreeMap;
use vibrissa::Pose;

const CASES: u32 = 150;

/// Two to four bumps that cross in order, dimensionless.
fn bumps() -> impl Strategy<Value = Bumps> {
    let bump = (0.1..0.6, -0.15..0.15, -0.3..1.5);
    prop::collection::vec(bump, 2..=4).prop_filter_map("neighbours do not cross", |all| {
        let mut x = -0.5;
        let pieces: Vec<_> = all
            .into_iter()
            .map(|(way, y, power): (f64, f64, f64)| {
                x += way;
                (x, y, 10_f64.powf(power))
            })
            .collect();
        Bumps::new(&pieces)
    })
}

/// How the clamp goes past the middle of its way: direction, half length, half turn.
fn way() -> impl Strategy<Value = (f64, f64, f64)> {
    let direction = prop_oneof![Just(0.0), Just(std::f64::consts::PI), -3.14..3.14];
    let turn = prop_oneof![Just(0.0), -0.8..0.8];
    prop_oneof![
        4 => (direction, 0.5..1.2, turn),
        1 => (Just(0.0), Just(0.0), prop_oneof![1.0..2.5, -2.5..-1.0]),
    ]
}

fn scene() -> impl Strategy<Value = Scene> {
    let clamp = (-0.5..0.9, 0.1..0.8, 0.7..2.4);
    let rod = (-3.0..2.0, -6.0..3.0);
    (bumps(), clamp, way(), rod).prop_filter_map("the clamp runs into the object", |(bumps, clamp, way, rod)| {
        let ((x, q, phi), (direction, half, turn), (length, stiffness)) = (clamp, way, rod);
        let y: f64 = bumps.lowest() - q;
        let pose = |k: f64| Pose { x: x + k * half * direction.cos(), y: y + k * half * direction.sin(), phi: phi + k * turn };
        let clear = |k: i32| {
            let at = pose(0.05 * f64::from(k));
            bumps.gap(at.x, at.y) > 0.05
        };
        let step = if half > 0.0 { half } else { turn.abs() } / 25.0;
        let (from, to) = (pose(-1.0), pose(1.0));
        (-20..=20).all(clear).then(|| {
            Scene { length: 1.0, stiffness: 1.0, bumps: bumps.clone(), from, to, step }
                .scaled(10_f64.powf(length), 10_f64.powf(stiffness))
        })
    })
}

#[derive(Default)]
struct Tally {
    sweeps: usize,
    phases: BTreeMap<String, usize>,
    kinds: BTreeMap<String, usize>,
    stops: Vec<String>,
}

#[test]
fn every_reported_state_is_an_equilibrium() {
    let config = Config { cases: CASES, failure_persistence: None, ..Config::default() };
    let mut runner = TestRunner::new_with_rng(config, TestRng::deterministic_rng(RngAlgorithm::ChaCha));
    let tally = RefCell::new(Tally::default());
    let outcome = runner.run(&scene(), |scene| {
        let ours = scene.bumps.contour();
        prop_assume!(ours.is_ok());
        let outcome = scene.run();
        let mut tally = tally.borrow_mut();
        tally.sweeps += 1;
        for state in &outcome.states {
            judge(&scene, state).map_err(TestCaseError::fail)?;
            *tally.phases.entry(state.phase().to_string()).or_default() += 1;
        }
        for event in &outcome.events {
            *tally.kinds.entry(event.kind.to_string()).or_default() += 1;
        }
        tally.stops.extend(outcome.stop.map(|stop| format!("{:?}: {stop}\n{}", stop.reason, scene.code())));
        Ok(())
    });
    if let Err(error) = outcome {
        panic!("{error}");
    }
    let Tally { sweeps, phases, kinds, stops } = tally.into_inner();
    assert!(50 * stops.len() <= sweeps, "{} of {sweeps} sweeps stopped:\n\n{}", stops.len(), stops.join("\n\n"));
    for phase in ["free", "A", "B", "BA", "BB"] {
        assert!(phases.contains_key(phase), "{phases:?}");
    }
    for kind in ["first-contact", "touch", "release", "tip-to-tangent", "tangent-to-tip", "snap", "snap-off"] {
        assert!(kinds.contains_key(kind), "{kinds:?}");
    }
}
