//! What a change of units, a mirror, or another way to the same pose must and must not change.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use crate::common::bumps::Bumps;
use crate::common::{OBJECTS, Scene, UP, difference};
use std::f64::consts::PI;
use vibrissa::contact::Outcome;
use vibrissa::{Event, Pose, State};

fn paper_scenes() -> impl Iterator<Item = Scene> {
    OBJECTS.into_iter().flat_map(|(_, y1, y2)| [0.2, 0.4, 0.6].into_iter().map(move |q| Scene::paper(y1, y2, q)))
}

/// Turning and moving at once past three unequal bumps.
fn turning_scene() -> Scene {
    let bumps = Bumps::new(&[(-0.3, 0.05, 4.0), (0.0, 0.0, 8.0), (0.4, 0.1, 3.0)]).unwrap();
    let (from, to) = (Pose { x: 0.9, y: -0.4, phi: 1.2 }, Pose { x: -0.9, y: -0.3, phi: 2.2 });
    Scene { length: 1.0, stiffness: 1.0, bumps, from, to, step: 0.02 }
}

fn assert_same(what: &str, a: &State, b: &State) {
    if let Some(difference) = difference(a, b, 1e-9) {
        panic!("{what} at {:?}: {difference}", b.pose);
    }
}

fn assert_same_outcome(what: &str, a: &Outcome, b: &Outcome) {
    assert_eq!(a.states.len(), b.states.len());
    for (a, b) in a.states.iter().zip(&b.states) {
        assert_same(what, a, b);
    }
    let kinds = |o: &Outcome| o.events.iter().map(|e| (e.kind, e.from(), e.to())).collect::<Vec<_>>();
    assert_eq!(kinds(a), kinds(b), "{what}");
    assert!(!a.events.is_empty());
    for (a, b) in a.events.iter().zip(&b.events) {
        assert_same(what, &a.before, &b.before);
        assert_same(what, &a.after, &b.after);
    }
}

/// Every number of a state through a change of units or a mirror, then compared.
fn mapped(mut outcome: Outcome, map: impl Fn(State) -> State) -> Outcome {
    let event = |e: Event| Event { kind: e.kind, before: map(e.before), after: map(e.after), dissipated: None };
    outcome.states = outcome.states.into_iter().map(&map).collect();
    outcome.events = outcome.events.into_iter().map(event).collect();
    outcome
}

/// The sweep of a rod of another length and stiffness, back in dimensionless numbers by the scaling law.
fn in_other_units(scene: &Scene, length: f64, stiffness: f64) -> Outcome {
    let (force, moment) = (stiffness / length / length, stiffness / length);
    mapped(scene.scaled(length, stiffness).run_through(), |mut s| {
        s.pose = Pose { x: s.pose.x / length, y: s.pose.y / length, ..s.pose };
        s.reactions.f0x /= force;
        s.reactions.f0y /= force;
        s.reactions.m0z /= moment;
        s.energy /= moment;
        for c in &mut s.contacts {
            (c.s, c.x, c.y) = (c.s / length, c.x / length, c.y / length);
            c.force /= force;
        }
        s
    })
}

fn assert_only_units(units: &[(f64, f64)]) {
    for scene in paper_scenes().chain([turning_scene()]) {
        let plain = scene.run_through();
        for &(length, stiffness) in units {
            let back = in_other_units(&scene, length, stiffness);
            assert_same_outcome(&format!("in lengths of {length}"), &back, &plain);
        }
    }
}

#[test]
fn units_of_length_and_stiffness_are_only_units() {
    assert_only_units(&[(0.1, 6.32e-4), (25.4, 1e6), (1e3, 1e-9)]);
}

#[test]
fn so_they_are_for_rods_of_a_centimetre_and_less() {
    assert_only_units(&[(1e-2, 1.0), (1e-3, 1.0), (1e-4, 1.0), (2.5e-6, 4e9)]);
}

#[test]
fn a_mirrored_sweep_is_the_mirror_image() {
    for scene in paper_scenes().chain([turning_scene()]) {
        let last = scene.bumps.pieces.len() - 1;
        let image = mapped(scene.mirrored().run_through(), |mut s| {
            s.pose = Pose { x: -s.pose.x, y: s.pose.y, phi: PI - s.pose.phi };
            s.reactions.f0x = -s.reactions.f0x;
            s.reactions.m0z = -s.reactions.m0z;
            for c in &mut s.contacts {
                (c.x, c.alpha, c.piece) = (-c.x, -c.alpha, last - c.piece);
            }
            s
        });
        assert_same_outcome("in the mirror", &image, &scene.run_through());
    }
}

/// A rod lying under a bump, pressed against it by a clamp that rises.
fn pressed(vertex: f64, phi: f64) -> Scene {
    let bumps = Bumps::new(&[(vertex, 0.0, 5.0)]).unwrap();
    let (from, to) = (Pose { x: -0.2, y: -0.455, phi }, Pose { x: -0.2, y: 0.045, phi });
    Scene { length: 1.0, stiffness: 1.0, bumps, from, to, step: 0.01 }
}

#[test]
fn there_and_back_gives_the_same_states() {
    for (vertex, phi) in [(0.1, 0.0), (0.1, 0.1), (0.1, 0.2), (0.3, 0.1), (0.3, 0.2), (0.3, 0.3)] {
        let scene = pressed(vertex, phi);
        let there = scene.run_through();
        let back = scene.backwards().run_through();
        assert!(there.states.iter().filter(|s| !s.contacts.is_empty()).count() >= 5);
        assert!(there.events.iter().all(|e| !e.kind.to_string().starts_with("snap")));
        for (a, b) in there.states.iter().zip(back.states.iter().rev()) {
            assert_same("there and back", b, a);
        }
        assert_eq!(there.events.len(), back.events.len());
        for (a, b) in there.events.iter().zip(back.events.iter().rev()) {
            assert!((a.pose().y - b.pose().y).abs() < 1e-9, "{} and {}", a.kind, b.kind);
            assert_eq!((a.from(), a.to()), (b.to(), b.from()));
        }
    }
}

#[test]
fn across_a_snap_the_way_back_is_another() {
    for scene in paper_scenes() {
        let (there, back) = (scene.run_through(), scene.backwards().run_through());
        let off = there.events.last().unwrap();
        assert_eq!(off.kind.to_string(), "snap-off");
        // where the rod got free it stays free on the way back, for a long while
        let on = &back.events[0];
        assert_eq!(on.kind.to_string(), "first-contact");
        assert!(on.pose().x - off.pose().x > 0.1, "off at {}, on again at {}", off.pose().x, on.pose().x);
        // and between, the rod is dragged the other way
        let mut bent = 0;
        for (a, b) in there.states.iter().zip(back.states.iter().rev()) {
            assert!((a.pose.x - b.pose.x).abs() < 1e-12);
            if !a.contacts.is_empty() && !b.contacts.is_empty() {
                assert!(difference(a, b, 1e-3).is_some(), "the same state at {:?}", a.pose);
                bent += 1;
            }
        }
        assert!(bent > 10);
    }
}

#[test]
fn a_turn_there_and_back_across_a_snap_is_hysteretic() {
    let bumps = Bumps::new(&[(0.0, 0.0, 5.0), (0.3, 0.0, 5.0)]).unwrap();
    let pose = |phi| Pose { x: 0.15, y: -0.8, phi };
    let scene = Scene { length: 1.0, stiffness: 1.0, bumps, from: pose(-0.5), to: pose(PI + 0.5), step: 0.02 };
    let (there, back) = (scene.run_through(), scene.backwards().run_through());
    let (off, on) = (there.events.last().unwrap(), &back.events[0]);
    assert_eq!((off.kind.to_string(), on.kind.to_string()), ("snap-off".into(), "first-contact".into()));
    assert!(off.pose().phi - on.pose().phi > 0.1 && off.pose().phi > UP, "{} {}", off.pose().phi, on.pose().phi);
}

/// Whether the straight rod goes through the object there.
fn straight_rod_is_blocked(scene: &Scene, at: Pose) -> bool {
    let (sin, cos) = at.phi.sin_cos();
    (0..=1000).map(|i| f64::from(i) * 1e-3).any(|s| scene.bumps.gap(at.x + s * cos, at.y + s * sin) < 0.0)
}

#[test]
fn a_start_in_contact_is_what_a_sweep_from_further_back_brings() {
    for scene in paper_scenes() {
        let whole = scene.run_through();
        let mut started = 0;
        for state in whole.states.iter().filter(|s| straight_rod_is_blocked(&scene, s.pose)).step_by(5) {
            let short = Scene { from: state.pose, to: Pose { x: state.pose.x - 0.004, ..state.pose }, ..scene.clone() };
            let start = short.run_through().states.remove(0);
            assert_same("started here", &start, state);
            started += 1;
        }
        assert!(started >= 15, "{started}");
    }
}
