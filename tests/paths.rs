//! Paths of all kinds: the rod does not know how the clamp came to a pose.

use crate::common::{Scene, UP, close, difference};
use proptest::prelude::*;
use std::f64::consts::TAU;
use std::sync::Arc;
use vibrissa::contact::{
    Chain, ClampArc, ClampSpline, ContactError, EventKind, Item, Outcome, Path, PathPoint, StopReason,
};
use vibrissa::{ClampPath, Composite, Event, Pose, State, Sweep, equilibrium};

/// O1 at q = 0.4, and its contour.
fn scan() -> (Scene, Composite) {
    let scene = Scene::paper(0.0, 0.0, 0.4);
    let contour = scene.bumps.contour().unwrap();
    (scene, contour)
}

fn clamp(x: f64) -> Pose {
    Pose { x, y: -0.4, phi: UP }
}

fn assert_same_events(ours: &[Event], theirs: &[Event]) {
    let names =
        |events: &[Event]| events.iter().map(|e| format!("{} {} {}", e.kind, e.from(), e.to())).collect::<Vec<_>>();
    assert_eq!(names(ours), names(theirs));
    for (a, b) in ours.iter().zip(theirs) {
        // a fold in the parameter of a path of one's own is as exact as its root
        let off = difference(&a.before, &b.before, 1e-7);
        assert!(off.is_none() && (a.pose().x - b.pose().x).abs() < 1e-10, "{}: {off:?}", a.kind);
    }
}

/// The straight path in another parameter, which runs slowly at both ends.
#[test]
fn a_closure_leads_through_what_the_straight_path_does() {
    let (scene, contour) = scan();
    let straight = scene.run_through();
    let (from, to) = (scene.from, scene.to);
    let curve = move |t: f64| {
        let (sin, cos) = (0.5 * TAU * t).sin_cos();
        let (share, rate) = (0.5 * (1.0 - cos), 0.25 * TAU * sin);
        PathPoint {
            pose: Pose { x: from.x + share * (to.x - from.x), ..from },
            rate: Pose { x: rate * (to.x - from.x), y: 0.0, phi: 0.0 },
        }
    };
    let outcome = Sweep::new(&scene.rod(), &contour, curve, 0.05).unwrap().run();
    assert!(outcome.stop.is_none() && outcome.states.len() == 21);
    assert_same_events(&outcome.events, &straight.events);
    for state in &outcome.states {
        let same = straight.states.iter().find(|other| (other.pose.x - state.pose.x).abs() < 1e-12);
        if let Some(same) = same {
            let off = difference(state, same, 1e-9);
            assert!(off.is_none(), "{off:?}");
        }
    }
}

#[test]
fn legs_are_reported_to_their_ends_and_change_nothing() {
    let (scene, contour) = scan();
    let straight = scene.run_through();
    let path = Chain::polyline(&[scene.from, clamp(0.2345), clamp(-0.4321), scene.to]).unwrap();
    let outcome = Sweep::new(&scene.rod(), &contour, path, 0.1).unwrap().run();
    assert!(outcome.stop.is_none());
    assert_same_events(&outcome.events, &straight.events);
    let legs = |leg: usize| outcome.states.iter().filter(move |state| state.leg == leg).collect::<Vec<_>>();
    // each leg from its own start, its last pose included, the first one of a leg only once
    let x: Vec<_> = legs(1).iter().map(|state| (1e4 * state.pose.x).round() / 1e4).collect();
    assert_eq!(x, [0.1345, 0.0345, -0.0655, -0.1655, -0.2655, -0.3655, -0.4321]);
    assert_eq!((legs(0).len(), legs(2).len()), (7, 6));
    let leg_of = |x: f64| if x > 0.2345 { 0 } else { usize::from(x < -0.4321) + 1 };
    assert!(outcome.events.iter().all(|event| event.leg() == leg_of(event.pose().x)));
}

#[test]
fn a_step_for_each_leg() {
    let (scene, contour) = scan();
    let path = Chain::polyline(&[clamp(1.0), clamp(0.9), clamp(0.8)]).unwrap();
    let steps = |steps: &[f64]| Sweep::with_steps(&scene.rod(), &contour, path.clone(), steps).map(Sweep::run);
    assert_eq!(steps(&[0.05, 0.02]).unwrap().states.len(), 3 + 5);
    let error = steps(&[0.05]).unwrap_err().to_string();
    assert_eq!(error, "there are 1 steps for a path of 2 legs, expected one for each leg");
}

/// Such paths were swept, and Newton's method was said to fail.
#[test]
fn rates_that_are_no_derivatives_are_refused() {
    let (scene, contour) = scan();
    let path = |factor: f64| {
        move |t: f64| PathPoint {
            pose: Pose { x: 1.0 - t * t, y: -0.4, phi: 1.5 },
            rate: Pose { x: -factor * t, y: 0.0, phi: 0.0 },
        }
    };
    assert!(Sweep::new(&scene.rod(), &contour, path(2.0), 0.1).is_ok());
    let error = Sweep::new(&scene.rod(), &contour, path(1.9), 0.1).unwrap_err().to_string();
    let expected = "the rate of x of the path is -0.059375 at the parameter 0.03125, expected -0.0625, by differences of its poses";
    assert!(error.starts_with(&expected[..72]) && error.contains("by differences"), "{error}");
}

/// There and back: the way back is another one where the rod has snapped.
#[test]
fn a_loop_shows_hysteresis_at_its_snaps() {
    let (scene, contour) = scan();
    let path = Chain::polyline(&[clamp(0.8), clamp(-1.0), clamp(1.3)]).unwrap();
    let outcome = Sweep::new(&scene.rod(), &contour, path, 0.01).unwrap().run();
    assert!(outcome.stop.is_none());
    let at = |x: f64, leg: usize| {
        let near = |state: &&State| state.leg == leg && (state.pose.x - x).abs() < 1e-9;
        outcome.states.iter().find(near).unwrap()
    };
    let snaps: Vec<_> = outcome.events.iter().filter(|event| event.kind == EventKind::SnapOff).collect();
    let [there, back] = snaps[..] else { panic!("{snaps:?}") };
    assert_eq!((there.leg(), back.leg()), (0, 1));
    // two equal parabolas about x = 0.15: the way back is the mirror of the way there
    assert!(close(there.pose().x + back.pose().x, 0.3, 1e-9));
    let open = |x: f64| difference(at(x, 0), at(x, 1), 1e-3).is_some();
    assert!(open(-0.3) && open(0.0) && open(0.6));
}

/// Protraction and retraction about a pivot behind the base, past a flank without snaps.
#[test]
fn whisking_returns_and_each_state_is_the_equilibrium_of_its_pose() {
    let (scene, contour) = scan();
    let rod = scene.rod();
    let from = Pose { x: 0.75, y: -0.3, phi: UP };
    let out = ClampArc::about(from, [0.75, -0.5], 0.5).unwrap();
    let end = out.point(out.length()).pose;
    let back = ClampArc::about(end, [0.75, -0.5], -0.5).unwrap();
    let path = Chain::new(vec![Arc::new(out), Arc::new(back)]).unwrap();
    let Outcome { states, events, stop, .. } = Sweep::new(&rod, &contour, path, 0.005).unwrap().run();
    assert!(stop.is_none() && states.len() == 41, "{stop:?} {}", states.len());
    assert!(states.iter().filter(|state| !state.contacts.is_empty()).count() > 10);
    assert!(events.iter().all(|event| event.kind != EventKind::Snap), "{events:?}");
    for (there, back) in states.iter().zip(states.iter().rev()) {
        let off = difference(there, back, 1e-9);
        assert!(off.is_none(), "{off:?}");
        let alone = equilibrium(&rod, &contour, there.pose, &there.contacts).unwrap().state;
        let off = difference(&alone, there, 1e-9);
        assert!(off.is_none(), "{off:?}");
        let on_circle = (there.pose.x - 0.75).hypot(there.pose.y + 0.5);
        assert!((on_circle - 0.2).abs() < 1e-14);
    }
}

#[test]
fn a_spline_leads_through_its_poses() {
    let (scene, contour) = scan();
    let pose = |x: f64| Pose { x, y: -0.4 + 0.05 * (4.0 * x).sin(), phi: UP + 0.2 * x };
    let spline = ClampSpline::through(&[0.8, 0.5, 0.3, 0.0, -0.2].map(pose)).unwrap();
    let outcome = Sweep::new(&scene.rod(), &contour, spline.clone(), 0.02).unwrap().run();
    assert!(outcome.stop.is_none() && outcome.states.iter().any(|state| state.contacts.len() == 1));
    for (k, state) in outcome.states.iter().enumerate() {
        let there = spline.point((0.02 * k as f64).min(spline.length())).pose;
        assert!(close(state.pose.x, there.x, 1e-14) && close(state.pose.phi, there.phi, 1e-14));
        let alone = equilibrium(&scene.rod(), &contour, state.pose, &state.contacts).unwrap().state;
        let off = difference(&alone, state, 1e-9);
        assert!(off.is_none(), "{off:?}");
    }
}

/// A start in contact on a path that begins at rest.
#[test]
fn a_path_may_begin_in_contact_and_at_rest() {
    let (scene, contour) = scan();
    let path = |t: f64| PathPoint {
        pose: Pose { x: 0.4 - 0.1 * t * t, y: -0.4, phi: UP },
        rate: Pose { x: -0.2 * t, y: 0.0, phi: 0.0 },
    };
    let items: Result<Vec<Item>, _> = Sweep::new(&scene.rod(), &contour, path, 0.5).unwrap().collect();
    let states =
        items.unwrap().into_iter().filter_map(|item| if let Item::State(state) = item { Some(state) } else { None });
    let states: Vec<_> = states.collect();
    assert!(states.len() == 3 && states.iter().all(|state| state.contacts.len() == 1));
    let alone = equilibrium(&scene.rod(), &contour, clamp(0.3), &states[2].contacts).unwrap().state;
    assert!(difference(&states[2], &alone, 1e-9).is_none());
}

#[test]
fn paths_that_are_none_are_refused() {
    let (scene, contour) = scan();
    let of = |rate: f64, x: f64| {
        move |t: f64| PathPoint {
            pose: Pose { x: x + rate * t, y: -0.4, phi: UP },
            rate: Pose { x: rate, y: 0.0, phi: 0.0 },
        }
    };
    let error = |rate: f64, x: f64| Sweep::new(&scene.rod(), &contour, of(rate, x), 0.1).unwrap_err();
    assert!(matches!(error(0.0, 0.0), ContactError::NoPath { .. }));
    assert!(matches!(error(1.0, f64::NAN), ContactError::NotFinite { .. }));
    assert!(matches!(error(f64::INFINITY, 0.0), ContactError::NotFinite { .. }));
    let other = ClampPath::new(clamp(0.31), clamp(0.2)).unwrap();
    let state = scene.run_through().states[50].clone();
    let elsewhere = Sweep::from_state(&scene.rod(), &contour, &state, other, 0.1);
    assert!(matches!(elsewhere.unwrap_err(), ContactError::Elsewhere { .. }));
}

#[test]
fn a_state_of_another_rod_is_refused() {
    let (scene, contour) = scan();
    let state = scene.run_through().states.into_iter().find(|state| state.contacts.len() == 1).unwrap();
    let longer = vibrissa::Rod::new(1.1, 1.0).unwrap();
    let path = ClampPath::new(state.pose, clamp(0.0)).unwrap();
    let wrong = Sweep::from_state(&longer, &contour, &state, path, 0.1).unwrap_err();
    assert!(matches!(wrong, ContactError::NotEquilibrium { .. }), "{wrong}");
    let mut pulling = state.clone();
    pulling.contacts[0].force = -pulling.contacts[0].force;
    assert!(Sweep::from_state(&scene.rod(), &contour, &pulling, path, 0.1).is_err());
}

/// A follower goes where a sweep goes, stays where it was when a move fails, and its clone goes its own way.
#[test]
fn a_follower_moves_and_stays() {
    use vibrissa::contact::Follower;
    let (scene, contour) = scan();
    let sweep = scene.run_through();
    let mut rod = Follower::new(&scene.rod(), &contour, clamp(0.8)).unwrap();
    let mut events = Vec::new();
    for state in &sweep.states[1..] {
        let items = rod.to(state.pose).unwrap();
        events.extend(
            items.iter().filter_map(|item| if let Item::Event(event) = item { Some(event.clone()) } else { None }),
        );
        assert!(matches!(items.last(), Some(Item::State(last)) if last == rod.state()));
        let off = difference(rod.state(), state, 1e-8);
        assert!(off.is_none(), "{off:?}");
    }
    assert_same_events(&events, &sweep.events);
    let at = sweep.states.iter().find(|state| state.contacts.len() == 2).unwrap();
    let mut rod = Follower::from_state(&scene.rod(), &contour, at).unwrap();
    let before = rod.state().clone();
    // up into the object
    let stop = rod.to(Pose { y: 2.0, ..at.pose }).unwrap_err();
    assert!(stop.tau > 0.0 && stop.tau <= 1.0 && stop.reason != StopReason::NoPose, "{stop:?}");
    assert_eq!(rod.state(), &before);
    assert_eq!(rod.to(Pose { x: f64::NAN, ..at.pose }).unwrap_err().reason, StopReason::NoPose);
    let mut tried = rod.clone();
    tried.to(Pose { y: at.pose.y - 0.01, ..at.pose }).unwrap();
    assert_eq!(rod.state(), &before);
    let mine = rod.to(Pose { y: at.pose.y - 0.01, ..at.pose }).unwrap();
    let Some(Item::State(mine)) = mine.last() else { panic!() };
    assert!(difference(mine, tried.state(), 1e-12).is_none());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]
    /// The rate is the derivative of the pose, by central differences.
    #[test]
    fn rates_are_derivatives(
        x in -1.0..1.0_f64, y in -1.0..1.0_f64, phi in -3.0..3.0_f64, turn in 0.1..3.0_f64, to in -3.0..3.0_f64, share in 0.01..0.99_f64,
    ) {
        let from = Pose { x, y, phi };
        let spline: Vec<_> =
            (0..5).map(f64::from).map(|k| Pose { x: x + k, y: y * k * k, phi: phi + (to * k).sin() }).collect();
        let paths: [Box<dyn Path>; 3] = [
            Box::new(ClampArc::new(from, [y, to], turn, to).unwrap()),
            Box::new(ClampArc::about(from, [y, to], -turn).unwrap()),
            Box::new(ClampSpline::through(&spline).unwrap()),
        ];
        for path in paths {
            let (t, e) = (share * path.length(), 1e-6 * path.length());
            let [before, after] = [t - e, t + e].map(|t| path.point(t).pose);
            let rate = path.point(t).rate;
            for (off, scale) in [
                ((after.x - before.x) / (2.0 * e) - rate.x, rate.x),
                ((after.y - before.y) / (2.0 * e) - rate.y, rate.y),
                ((after.phi - before.phi) / (2.0 * e) - rate.phi, rate.phi),
            ] {
                prop_assert!(off.abs() < 1e-6 * (1.0 + scale.abs()) * (1.0 + 1.0 / path.length()), "{off} of {scale}");
            }
        }
    }
}
