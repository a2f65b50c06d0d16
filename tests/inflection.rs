//! The last contact at an inflection of a smooth contour: one parts into two, and the two run together again.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use vibrissa::contact::{EventKind, Outcome};
use vibrissa::contour::Range;
use vibrissa::{ClampPath, Composite, Event, Graph, Pose, Rod, Sweep};

/// Rate of the contour's curvature at its inflection, in x = 0.
const RATE: f64 = 1.8;

/// A rod of length and stiffness 1 from (0.75, `from`) to (0.75, `to`), pointing to the left and up, under a solid above
/// y = -0.3 x^3 - d x^4: convex on the left of x = 0, concave on its right, where the rod comes from.
fn sweep(d: f64, from: f64, to: f64) -> Outcome {
    let range = Range { from: -2.0, to: 0.7 };
    let wave = Graph::new(range, move |x| -x * x * x * 0.3 - x * x * x * x * d).unwrap();
    let contour = Composite::single(wave).unwrap();
    let rod = Rod::new(1.0, 1.0).unwrap();
    let pose = |y: f64| Pose { x: 0.75, y, phi: std::f64::consts::PI - 0.6 };
    let path = ClampPath::new(pose(from), pose(to)).unwrap();
    Sweep::new(&rod, &contour, path, 2e-3).unwrap().run()
}

fn between<'a>(outcome: &'a Outcome, from: &str, to: &str) -> &'a Event {
    let mut events = outcome.events.iter();
    events.find(|e| e.from().to_string() == from && e.to().to_string() == to).unwrap()
}

#[test]
fn one_contact_parts_into_two() {
    for d in [-0.1, -0.05, -0.02] {
        let outcome = sweep(d, -0.6, -0.14);
        assert!(outcome.stop.is_none());
        let event = between(&outcome, "B", "BB");
        assert_eq!(event.kind, EventKind::Touch);
        let (one, two) = (&event.before.contacts[0], &event.after.contacts);
        assert!(one.x.abs() < 1e-12, "at the inflection: {one:?}");
        // the two are 0.01 apart; the force next to the tip is the rate of curvature, but for that share of it
        assert!((two[1].force - RATE).abs() < 0.01 * RATE, "{two:?}");
        assert!((two[0].force + two[1].force - one.force).abs() < 0.01 * one.force, "{two:?}");
        assert!(event.after.pose.y - event.before.pose.y < 1e-3);
        for state in &outcome.states {
            assert!(state.certificate.stable && state.certificate.min_gap.lower > -2e-11, "{state:?}");
            assert!(state.pose.y < event.after.pose.y || state.contacts.len() == 2, "{state:?}");
        }
    }
}

#[test]
fn the_two_run_together_on_the_way_back() {
    for d in [-0.1, -0.05, -0.02] {
        let there = sweep(d, -0.6, -0.14);
        let back = sweep(d, -0.14, -0.6);
        assert!(back.stop.is_none());
        let event = between(&back, "BB", "B");
        assert_eq!(event.kind, EventKind::Release);
        let parting = between(&there, "B", "BB").before.pose.y;
        assert!((event.after.pose.y - parting).abs() < 1e-4, "{} {parting}", event.after.pose.y);
        let end = |outcome: &Outcome| outcome.states.iter().map(|s| s.energy).fold(f64::NAN, f64::max);
        assert!((end(&there) - end(&back)).abs() < 1e-9, "the same branch");
    }
}

/// To fourth order no two contacts near each other can hold the rod there: it jumps to a state with two that are apart.
#[test]
fn where_two_cannot_be_near_each_other_the_rod_snaps() {
    let outcome = sweep(0.02, -0.6, -0.14);
    assert!(outcome.stop.is_none());
    let event = between(&outcome, "B", "BB");
    assert_eq!(event.kind, EventKind::Snap);
    assert!(event.after.contacts[0].x > 0.1, "{event:?}");
    assert!(outcome.states.iter().all(|s| s.certificate.stable && s.certificate.min_gap.lower > -2e-11));
}
