//! Starts in contact, notches, extreme steps and shapes, and ways that lead nowhere.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use crate::common::bumps::Bumps;
use crate::common::judge::judge;
use crate::common::{OBJECTS, Scene, UP, difference};
use std::f64::consts::PI;
use vibrissa::Pose;
use vibrissa::contact::{ContactKind, EventKind, Outcome, Phase, StopReason};

/// Runs to the end, with every state judged.
fn judged(scene: &Scene) -> Outcome {
    let outcome = scene.run_through();
    for state in &outcome.states {
        if let Err(what) = judge(scene, state) {
            panic!("{what}");
        }
    }
    outcome
}

fn between(from: Pose, to: Pose, step: f64) -> Scene {
    Scene { from, to, step, ..Scene::paper(0.0, 0.0, 0.4) }
}

fn kinds(outcome: &Outcome) -> Vec<EventKind> {
    outcome.events.iter().map(|e| e.kind).collect()
}

#[test]
fn starts_in_every_phase() {
    // beyond, the straight rod is free
    let phases =
        [(0.6, "A"), (0.5, "A"), (0.4, "B"), (0.15, "B"), (0.0, "B"), (-0.25, "B"), (-0.28, "BB"), (-0.34, "BB")];
    for (x, phase) in phases {
        let pose = |x| Pose { x, y: -0.4, phi: UP };
        let outcome = judged(&Scene { from: pose(x), to: pose(x - 0.05), ..Scene::paper(0.0, 0.1, 0.4) });
        assert_eq!(outcome.states[0].phase().to_string(), phase, "at {x}");
        assert_eq!(outcome.states.len(), 6);
    }
}

#[test]
fn starts_pressed_against_the_object() {
    // no pose further back along the line is free
    for (x, y) in [(-0.1, -0.2), (-0.1, -0.3), (0.05, -0.2), (0.05, -0.3)] {
        let scene = between(Pose { x, y, phi: 0.8 }, Pose { x, y: y - 0.6, phi: 0.8 }, 0.02);
        let outcome = judged(&scene);
        assert_ne!(outcome.states[0].phase(), Phase::FREE, "at {x}, {y}");
        assert_eq!(outcome.states[30].phase(), Phase::FREE, "at {x}, {y}");
    }
}

#[test]
fn the_tip_slides_into_the_notch_and_is_held_there() {
    for (x, side) in [(0.14, 1.0), (0.16, -1.0)] {
        let pose = |y| Pose { x, y, phi: UP };
        let scene = between(pose(-1.0), pose(-0.7), 0.002);
        let outcome = judged(&scene);
        let held: Vec<_> =
            outcome.states.iter().filter(|s| s.contacts.last().is_some_and(|c| c.kind == ContactKind::Notch)).collect();
        assert!(held.len() > 5, "{:?}", kinds(&outcome));
        for state in held {
            let notch = state.contacts.last().unwrap();
            assert!((notch.x - 0.15).abs() < 1e-12 && (notch.y - 0.1125).abs() < 1e-12, "{notch:?}");
            // the notch presses the tip down
            assert!(state.reactions.f0y > 0.0);
        }
        // the mirror image of the other side
        let first = outcome.events.iter().find(|e| e.kind == EventKind::Piece).unwrap();
        assert!((first.pose().x - 0.15) * side < 0.0);
    }
}

#[test]
fn a_notch_straight_ahead_is_met_at_its_bottom() {
    // The rod cannot yield but by buckling: there is no equilibrium that it could be followed into without a choice of side.
    let pose = |y| Pose { x: 0.15, y, phi: UP };
    let scene = between(pose(-1.0), pose(-0.8), 0.01);
    let outcome = scene.run();
    for state in &outcome.states {
        if let Err(what) = judge(&scene, state) {
            panic!("{what}");
        }
    }
    // free up to the bottom of the notch
    let free = outcome.states.iter().take_while(|s| s.contacts.is_empty()).count();
    assert_eq!(free, 12, "{:?}", outcome.stop);
    match outcome.stop {
        Some(stop) => assert!((stop.pose.y + 0.8875).abs() < 1e-9, "{stop}"),
        None => assert!((outcome.events[0].pose().y + 0.8875).abs() < 1e-9),
    }
}

#[test]
fn a_rod_swept_along_a_deep_notch_gets_into_it_and_out_again() {
    let bumps = Bumps::new(&[(0.0, 0.0, 40.0), (0.3, 0.0, 40.0)]).unwrap();
    let pose = |x| Pose { x, y: -0.5, phi: UP };
    let scene = Scene { bumps, ..between(pose(0.8), pose(-1.0), 0.01) };
    let outcome = judged(&scene);
    assert_eq!(outcome.events.last().map(|e| e.kind), Some(EventKind::SnapOff), "{:?}", kinds(&outcome));
}

#[test]
fn reported_states_and_events_do_not_depend_on_the_step() {
    for (name, first, second) in OBJECTS {
        let scene = Scene::paper(first, second, 0.4);
        let usual = judged(&scene);
        for (step, to) in [(0.5, scene.to), (3.0, scene.to), (1e-3, scene.to), (0.1 * PI, scene.to)] {
            let other = judged(&Scene { step, to, ..scene.clone() });
            // the end of the path, too
            assert_eq!(other.states.len(), (1.8 / step - 1e-9).ceil() as usize + 1);
            // after the last report the sweep is over
            let known = &usual.events[..other.events.len()];
            assert_eq!(kinds(&other), known.iter().map(|e| e.kind).collect::<Vec<_>>(), "{name} by {step}");
            for (a, b) in other.events.iter().zip(known) {
                let off = (a.pose().x - b.pose().x).abs();
                assert!(off < 1e-10, "{name} by {step}: {} off by {off:e}", a.kind);
            }
            for a in &other.states {
                let b = usual.states.iter().find(|b| (a.pose.x - b.pose.x).abs() < 1e-12);
                let difference = b.and_then(|b| difference(a, b, 1e-9));
                assert_eq!(difference, None, "{name} by {step} at {}", a.pose.x);
            }
        }
    }
}

#[test]
fn tiny_steps() {
    let pose = |x| Pose { x, y: -0.4, phi: UP };
    // across A -> B and across B -> BB
    for (second, at) in [(0.0, 0.451369186091), (0.1, -0.262377337398)] {
        let scene = Scene { from: pose(at + 5e-7), to: pose(at - 5e-7), ..Scene::paper(0.0, second, 0.4) };
        let outcome = judged(&Scene { step: 1e-8, ..scene });
        assert_eq!((outcome.states.len(), outcome.events.len()), (101, 1));
        assert!((outcome.events[0].pose().x - at).abs() < 1e-11);
    }
}

/// One bump and two, met from the side and from below.
fn shaped(coefficient: f64, phi: f64) -> Vec<Scene> {
    let (sin, cos) = phi.sin_cos();
    // the tip a little beside the first bump
    let pose = |x, y| Pose { x: x - 0.95 * cos, y: y - sin, phi };
    let across = between(pose(0.9, 0.4), pose(-0.9, 0.4), 0.02);
    let rising = between(pose(0.01, -0.1), pose(0.01, 0.4), 0.01);
    let single = Bumps::new(&[(0.0, 0.0, coefficient)]).unwrap();
    let pair = Bumps::new(&[(0.0, 0.0, coefficient), (0.3, 0.0, coefficient)]).unwrap();
    let scenes = [across, rising].into_iter();
    scenes.flat_map(|s| [&single, &pair].map(|bumps| Scene { bumps: bumps.clone(), ..s.clone() })).collect()
}

fn assert_touches(scene: &Scene) {
    assert!(judged(scene).states.iter().any(|s| !s.contacts.is_empty()), "{}", scene.code());
}

#[test]
fn very_flat_objects() {
    for c in [1e-3, 1e-2] {
        for phi in [0.7, 1.0, 2.0] {
            shaped(c, phi).iter().for_each(assert_touches);
        }
    }
}

#[test]
fn an_upright_rod_let_go_under_a_very_flat_object() {
    for c in [1e-3, 1e-2] {
        shaped(c, UP).iter().for_each(assert_touches);
    }
}

#[test]
fn very_sharp_objects() {
    for c in [1e2, 1e3] {
        for phi in [1.0, UP] {
            shaped(c, phi).iter().for_each(assert_touches);
        }
    }
}

#[test]
fn a_leaning_rod_under_very_sharp_objects() {
    for c in [1e2, 1e3] {
        for phi in [2.0, 2.2] {
            shaped(c, phi).iter().for_each(assert_touches);
        }
    }
}

#[test]
fn a_clamp_driven_into_the_object_stops_there() {
    let pose = |y| Pose { x: 0.0, y, phi: -UP };
    let outcome = between(pose(-0.5), pose(0.5), 0.01).run();
    let stop = outcome.stop.unwrap();
    assert_eq!(stop.reason, StopReason::ClampInside);
    assert!(stop.pose.y.abs() < 0.051, "{stop}");
    assert!(outcome.states.len() >= 45 && outcome.states.iter().all(|s| s.pose.y <= 0.0));
    // and so does one that starts inside
    let inside = between(pose(0.5), pose(1.5), 0.1).run();
    assert_eq!(inside.stop.map(|s| s.reason), Some(StopReason::ClampInside));
    assert!(inside.states.is_empty());
}

#[test]
fn a_pressed_rod_whose_clamp_runs_into_the_object() {
    // reported states on both sides of where the clamp meets the vertex, and one exactly there
    for step in [0.007, 0.01] {
        let pose = |y| Pose { x: 0.0, y, phi: UP - 0.3 };
        let scene = between(pose(-1.1), pose(0.2), step);
        let outcome = scene.run();
        let stop = outcome.stop.expect("a stop");
        assert!(stop.pose.y < 1e-9, "{stop}");
        assert_eq!(stop.reason, StopReason::ClampInside);
        assert!(!outcome.events.is_empty());
        for state in &outcome.states {
            if let Err(what) = judge(&scene, state) {
                panic!("{what}");
            }
        }
    }
}

/// A full turn past the object and back, to where the rod is free again.
fn assert_turns(x: f64, y: f64) {
    for (from, to) in [(-0.6, PI + 0.6), (PI + 0.6, -0.6)] {
        let outcome = judged(&between(Pose { x, y, phi: from }, Pose { x, y, phi: to }, 0.05));
        assert_eq!(outcome.events[0].kind, EventKind::FirstContact);
        assert_eq!(outcome.events.last().map(|e| e.kind), Some(EventKind::SnapOff));
        for state in &outcome.states {
            assert_eq!((state.pose.x, state.pose.y), (x, y));
        }
    }
}

#[test]
fn a_clamp_that_only_turns() {
    for (x, y) in [(-0.2, -0.5), (0.5, -0.5), (-0.2, -0.8), (0.15, -0.8), (0.5, -0.8)] {
        assert_turns(x, y);
    }
}

#[test]
fn a_clamp_that_only_turns_near_the_object() {
    for (x, y) in [(-0.2, -0.3), (0.15, -0.3), (0.5, -0.3), (0.15, -0.5)] {
        assert_turns(x, y);
    }
}

#[test]
fn a_rod_that_points_away_is_dragged_off() {
    // nearly along the way, over the higher bump first
    let phi = 155_f64.to_radians();
    let pose = |x: f64| Pose { x: x - phi.cos(), y: -0.25 * phi.sin(), phi };
    let scene = Scene { from: pose(1.2), to: pose(-1.2), ..Scene::paper(0.1, 0.0, 0.4) };
    assert_eq!(judged(&scene).events.last().map(|e| e.to()), Some(Phase::FREE));
}

#[test]
fn a_level_rod_meets_a_vertex_halfway() {
    // where the gap is smallest the rod runs along the tangent, at its very middle
    let bumps = Bumps::new(&[(0.3, 0.0, 5.0)]).unwrap();
    let pose = |y| Pose { x: -0.2, y, phi: 0.0 };
    let outcome = judged(&Scene { bumps, ..between(pose(-0.45), pose(0.05), 0.01) });
    assert_eq!(kinds(&outcome), [EventKind::FirstContact]);
    assert!(outcome.events[0].pose().y.abs() < 1e-10);
}

#[test]
fn a_level_rod_that_starts_through_a_vertex() {
    let bumps = Bumps::new(&[(0.3, 0.0, 5.0)]).unwrap();
    let pose = |y| Pose { x: -0.2, y, phi: 0.0 };
    let outcome = judged(&Scene { bumps, ..between(pose(0.05), pose(-0.45), 0.01) });
    assert_eq!(outcome.states[0].phase().to_string(), "B");
}

#[test]
fn a_way_that_never_touches() {
    let pose = |x| Pose { x, y: -1.001, phi: UP };
    let outcome = judged(&between(pose(0.8), pose(-1.0), 0.05));
    assert!(outcome.events.is_empty());
    assert_eq!(outcome.states.len(), 37);
    assert!(outcome.states.iter().all(|s| s.phase() == Phase::FREE && s.energy == 0.0));
    let least = outcome.states.iter().map(|s| s.certificate.min_gap.seen).fold(f64::INFINITY, f64::min);
    assert!((least - 0.001).abs() < 1e-12, "{least}");
}
