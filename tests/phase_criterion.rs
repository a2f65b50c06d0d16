//! K = m0z^2 - 2 E I (f0y sin phi0 + f0x cos phi0) tells from the reactions alone whether the last contact is tangential.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use crate::common::{OBJECTS, Scene};
use std::collections::BTreeMap;
use vibrissa::{Pose, State};

/// K, relative to the size of what it is the difference of.
fn criterion(scene: &Scene, state: &State) -> f64 {
    let reactions = state.reactions;
    let size = reactions.m0z.powi(2) + 2.0 * scene.stiffness * reactions.f0x.hypot(reactions.f0y);
    reactions.phase_criterion(state.pose.phi, scene.stiffness) / size
}

/// Scans under many clamp angles, from both sides, near enough for the rod to reach the object.
fn scans() -> impl Iterator<Item = Scene> {
    let degrees = [25.0, 40.0, 55.0, 70.0, 80.0, 90.0, 95.0, 105.0, 120.0, 135.0, 155.0_f64];
    OBJECTS.into_iter().flat_map(move |(_, first, second)| {
        degrees.into_iter().flat_map(move |degrees| {
            [0.25, 0.5, 0.75].into_iter().map(move |share| {
                let phi = degrees.to_radians();
                let y = first.min(second) - share * phi.sin();
                let scene = Scene::paper(first, second, 0.4).scaled(0.1, 6.32e-4);
                let (from, to) = (1.2 - phi.cos(), -1.2 - phi.cos());
                let pose = |x: f64| Pose { x: 0.1 * x, y: 0.1 * y, phi };
                Scene { from: pose(from), to: pose(to), step: 1e-3, ..scene }
            })
        })
    })
}

#[test]
fn it_vanishes_exactly_where_the_last_contact_is_tangential() {
    let mut seen: BTreeMap<String, usize> = BTreeMap::new();
    for scene in scans() {
        for state in &scene.run().states {
            let Some(last) = state.contacts.last() else {
                assert_eq!(state.reactions.phase_criterion(state.pose.phi, scene.stiffness), 0.0);
                continue;
            };
            let phase = state.phase();
            let what = || format!("{phase} at {:?}\n{}", state.pose, scene.code());
            let k = criterion(&scene, state);
            if !phase.tip {
                assert!(k.abs() <= 1e-10, "{}: K is {k:e}", what());
            } else {
                // what the last contact leaves in the first integral
                let rod = state.elastica(&scene.rod()).unwrap();
                let angle = rod.at(rod.length()).phi - last.alpha;
                let reactions = state.reactions;
                let size = reactions.m0z.powi(2) + 2.0 * scene.stiffness * reactions.f0x.hypot(reactions.f0y);
                let expected = -2.0 * scene.stiffness * last.force * angle.sin() / size;
                assert!((k - expected).abs() <= 1e-10, "{}: K is {k:e}, not {expected:e}", what());
                // a tenth of a degree away from lying down
                if angle.sin().abs() > 2e-3 && last.force > 0.1 * reactions.f0x.hypot(reactions.f0y) {
                    assert!(k.abs() > 1e-5, "{}: K is {k:e}", what());
                }
            }
            *seen.entry(phase.to_string()).or_default() += 1;
        }
    }
    for phase in ["A", "B", "BA", "BB"] {
        assert!(seen.get(phase).is_some_and(|n| *n > 50), "{seen:?}");
    }
}

#[test]
fn so_it_does_with_three_tangential_contacts() {
    // three bumps on an arch, pressed from below by a rod that points along them
    let bumps = crate::common::bumps::Bumps::new(&[(0.0, 0.0, 5.0), (0.3, -0.05, 5.0), (0.6, -0.13, 5.0)]).unwrap();
    let (from, to) = (Pose { x: -0.15, y: -0.6, phi: 0.2 }, Pose { x: -0.15, y: 0.02, phi: 0.2 });
    let scene = Scene { length: 1.0, stiffness: 1.0, bumps, from, to, step: 0.001 };
    let outcome = scene.run_through();
    let three: Vec<_> = outcome.states.iter().filter(|s| s.phase().contacts >= 3 && !s.phase().tip).collect();
    assert!(three.len() > 5, "{:?}", outcome.events.iter().map(|e| e.to().to_string()).collect::<Vec<_>>());
    for state in three {
        let k = criterion(&scene, state);
        assert!(k.abs() <= 1e-10, "K is {k:e} at {:?}", state.pose);
    }
}
