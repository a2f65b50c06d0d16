//! Random rods, objects and ways of the clamp: whatever is reported is an equilibrium.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use crate::common::Scene;
use crate::common::bumps::Bumps;
use crate::common::judge::{judge, judge_certified_gap};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestCaseError, TestRng, TestRunner};
use std::cell::RefCell;
use std::collections::BTreeMap;
use vibrissa::Pose;
use vibrissa::contact::{EventKind, Outcome};

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
    let direction = prop_oneof![Just(0.0), Just(std::f64::consts::PI), -3.1..3.1];
    let turn = prop_oneof![Just(0.0), -0.8..0.8];
    prop_oneof![
        4 => (direction, 0.5..1.2, turn),
        1 => (Just(0.0), Just(0.0), prop_oneof![1.0..2.5, -2.5..-1.0]),
    ]
}

/// Where a sweep starts.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Start {
    /// The straight rod goes nowhere near the object.
    Free,
    /// The straight rod goes through it.
    InContact,
}

impl Start {
    fn is_that_of(self, bumps: &Bumps, at: Pose) -> bool {
        let (sin, cos) = at.phi.sin_cos();
        let gaps = (0..=100).map(|i| 0.01 * f64::from(i)).map(|s| bumps.gap(at.x + s * cos, at.y + s * sin));
        let least = gaps.fold(f64::INFINITY, f64::min);
        if self == Self::Free { least > 0.02 } else { least < 0.0 }
    }
}

fn scene(start: Start) -> impl Strategy<Value = Scene> {
    let clamp = (-0.5..0.9, 0.1..0.8, 0.7..2.4);
    let rod = (-3.0..2.0, -6.0..3.0);
    (bumps(), clamp, way(), rod).prop_filter_map(
        "the clamp runs into the object or starts otherwise",
        move |(bumps, clamp, way, rod)| {
            let ((x, q, phi), (direction, half, turn), (length, stiffness)) = (clamp, way, rod);
            let y: f64 = bumps.lowest() - q;
            let pose = |k: f64| Pose {
                x: x + k * half * direction.cos(),
                y: y + k * half * direction.sin(),
                phi: phi + k * turn,
            };
            let clear = |k: i32| {
                let at = pose(0.05 * f64::from(k));
                bumps.gap(at.x, at.y) > 0.05
            };
            let step = if half > 0.0 { half } else { turn.abs() } / 25.0;
            let (from, to) = (pose(-1.0), pose(1.0));
            ((-20..=20).all(clear) && start.is_that_of(&bumps, from)).then(|| {
                Scene { length: 1.0, stiffness: 1.0, bumps: bumps.clone(), from, to, step }
                    .scaled(10_f64.powf(length), 10_f64.powf(stiffness))
            })
        },
    )
}

/// Runs `check` on the sweeps of random scenes, the same in every run.
fn for_scenes(start: Start, check: impl Fn(&Scene, &Outcome) -> Result<(), String>) {
    let config = Config { cases: CASES, failure_persistence: None, ..Config::default() };
    let mut runner = TestRunner::new_with_rng(config, TestRng::deterministic_rng(RngAlgorithm::ChaCha));
    let outcome = runner.run(&scene(start), |scene| {
        prop_assume!(scene.bumps.contour().is_ok());
        check(&scene, &scene.run()).map_err(TestCaseError::fail)
    });
    if let Err(error) = outcome {
        panic!("{error}");
    }
}

/// What was seen in all sweeps.
#[derive(Default)]
struct Seen {
    phases: BTreeMap<String, usize>,
    events: BTreeMap<String, usize>,
    sweeps: usize,
    stops: Vec<String>,
}

/// Every reported state is an equilibrium, its certificate knows the smallest gap, and few sweeps stop.
fn judge_sweeps(start: Start, of_events: impl Fn(&Scene, &Outcome) -> Result<(), String>) -> Seen {
    let seen = RefCell::new(Seen::default());
    for_scenes(start, |scene, outcome| {
        let mut seen = seen.borrow_mut();
        for state in &outcome.states {
            judge(scene, state)?;
            judge_certified_gap(scene, state)?;
            *seen.phases.entry(state.phase().to_string()).or_insert(0) += 1;
        }
        of_events(scene, outcome)?;
        for event in &outcome.events {
            *seen.events.entry(event.kind.to_string()).or_insert(0) += 1;
        }
        seen.sweeps += 1;
        let stop = outcome.stop.as_ref();
        seen.stops.extend(stop.map(|stop| format!("{:?}: {stop}\n{}", stop.reason, scene.code())));
        Ok(())
    });
    let seen = seen.into_inner();
    for phase in ["free", "A", "B", "BA", "BB"] {
        assert!(seen.phases.get(phase).is_some_and(|n| *n > 5), "{:?}", seen.phases);
    }
    let (stops, sweeps) = (seen.stops.len(), seen.sweeps);
    assert!(50 * stops <= sweeps, "{stops} of {sweeps} sweeps stopped:\n\n{}", seen.stops.join("\n\n"));
    seen
}

/// Events change the contacts, only snaps change the shape, and all of them are at one pose.
fn judge_events(scene: &Scene, outcome: &Outcome) -> Result<(), String> {
    for event in &outcome.events {
        let (before, after) = (&event.before, &event.after);
        let wrong = |what: String| Err(format!("{} {what}\n{}", event.kind, scene.code()));
        if before.pose != after.pose {
            return wrong(format!("from {:?} to {:?}", before.pose, after.pose));
        }
        if matches!(event.kind, EventKind::Snap | EventKind::SnapOff) {
            if after.energy > before.energy * (1.0 + 1e-9) {
                return wrong(format!("up from {} to {}", before.energy, after.energy));
            }
            if (event.kind == EventKind::SnapOff) != after.contacts.is_empty() {
                return wrong(format!("to {}", event.to()));
            }
        } else {
            let unit = scene.rod().units().moment;
            let jump = (before.reactions.m0z - after.reactions.m0z).abs() / (unit + before.reactions.m0z.abs());
            if jump > 1e-9 {
                return wrong(format!("at {:?} with a jump of {jump:e}", before.pose));
            }
        }
    }
    Ok(())
}

#[test]
fn sweeps_of_a_free_rod_report_equilibria_and_their_changes() {
    let seen = judge_sweeps(Start::Free, judge_events);
    for kind in ["first-contact", "touch", "release", "tip-to-tangent", "tangent-to-tip", "snap", "snap-off"] {
        assert!(seen.events.contains_key(kind), "{:?}", seen.events);
    }
}

#[test]
fn sweeps_that_start_in_contact_report_equilibria() {
    judge_sweeps(Start::InContact, |_, _| Ok(()));
}
