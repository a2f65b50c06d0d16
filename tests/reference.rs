//! The scans of the paper against data of an independent solver (backward shooting, Taylor series of order 26).
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use crate::common::bumps::Bump;
use crate::common::golden::golden;
use crate::common::{OBJECTS, Scene, close};
use serde_json::Value;
use vibrissa::contact::{Contact, ContactKind, EventKind, Outcome};
use vibrissa::rod::{
    Elastica, Hold, Load, MultiPoint, NewtonOptions, NewtonWorkspace, Reactions, Support, Supports, Uniform, Units,
    solve,
};
use vibrissa::{Event, Pose, Rod, State};

const FILES: [(&str, &str); 3] = [
    ("O1_q40", include_str!("data/reference/O1_q40.json")),
    ("O1_q60", include_str!("data/reference/O1_q60.json")),
    ("O2_q40", include_str!("data/reference/O2_q40.json")),
];

/// A scan with what the other solver found, dimensionless.
struct Reference {
    name: &'static str,
    scene: Scene,
    events: Vec<Value>,
    states: Vec<Value>,
}

fn references() -> impl Iterator<Item = Reference> {
    FILES.into_iter().map(|(name, text)| {
        let data: Value = serde_json::from_str(text).unwrap();
        let object = &data["object"];
        assert_eq!(number(&object["x2"]), 0.3);
        let scene = Scene::paper(number(&object["y1"]), number(&object["y2"]), number(&data["q"]));
        assert_eq!((scene.from.y, scene.from.phi), (number(&data["y0"]), number(&data["phi0"])));
        let list = |key: &str| data[key].as_array().unwrap().clone();
        Reference { name, scene, events: list("events"), states: list("states") }
    })
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

fn text(value: &Value) -> &str {
    value.as_str().unwrap()
}

fn assert_close(what: &str, ours: f64, theirs: f64) {
    assert!(close(ours, theirs, 1e-9), "{what}: {ours:?} against {theirs:?}");
}

/// The other solver found touches by a penetration it could see, hence late.
const TOUCH_LATENESS: f64 = 2e-8;

fn check_events(reference: &Reference, outcome: &Outcome, units: Units) {
    assert_eq!(outcome.events.len(), reference.events.len(), "{}", reference.name);
    for (ours, theirs) in outcome.events.iter().zip(&reference.events) {
        let what = format!("{} at x0 = {}", reference.name, theirs["x0"]);
        let kind = match (text(&theirs["kind"]), text(&theirs["to"])) {
            ("first-contact", _) => EventKind::FirstContact,
            ("touch", _) => EventKind::Touch,
            ("release", _) => EventKind::Release,
            ("tip-becomes-tangent", _) => EventKind::TipToTangent,
            ("reaches-tip", _) => EventKind::TangentToTip,
            ("snap", "free") => EventKind::SnapOff,
            ("snap", _) => EventKind::Snap,
            other => panic!("{what}: {other:?}"),
        };
        assert_eq!(ours.kind, kind, "{what}");
        assert_eq!(ours.from().to_string(), text(&theirs["from"]), "{what}");
        assert_eq!(ours.to().to_string(), text(&theirs["to"]), "{what}");
        let off = (ours.pose().x / units.length - number(&theirs["x0"])).abs();
        let touch = kind == EventKind::Touch;
        assert!(off <= if touch { TOUCH_LATENESS } else { 1e-9 }, "{what}: off by {off:e}");
        if let (Some(reactions), false) = (theirs["reactions"].as_array(), touch) {
            let Reactions { f0x, f0y, m0z } = ours.before.reactions;
            let all = [f0x / units.force, f0y / units.force, m0z / units.moment];
            for (ours, theirs) in all.into_iter().zip(reactions) {
                assert_close(&what, ours, number(theirs));
            }
        }
    }
}

fn check_states(reference: &Reference, outcome: &Outcome, units: Units) {
    assert!(reference.states.len() > 100);
    for theirs in &reference.states {
        let x0 = number(&theirs["x0"]);
        let here = |state: &&State| (state.pose.x / units.length - x0).abs() < 1e-12;
        let ours = outcome.states.iter().find(here).unwrap();
        let what = format!("{} at x0 = {x0}", reference.name);
        assert_eq!(ours.phase().to_string(), text(&theirs["phase"]), "{what}");
        assert_close(&what, ours.reactions.f0x / units.force, number(&theirs["f0x"]));
        assert_close(&what, ours.reactions.f0y / units.force, number(&theirs["f0y"]));
        assert_close(&what, ours.reactions.m0z / units.moment, number(&theirs["m0z"]));
        let contacts = theirs["contacts"].as_array().unwrap();
        assert_eq!(ours.contacts.len(), contacts.len(), "{what}");
        for (ours, theirs) in ours.contacts.iter().zip(contacts) {
            let kind = if text(&theirs["kind"]) == "tip" { ContactKind::Tip } else { ContactKind::Tangent };
            assert_eq!(ours.kind, kind, "{what}");
            assert_eq!(ours.piece as u64 + 1, theirs["piece"].as_u64().unwrap(), "{what}");
            assert_close(&what, ours.s / units.length, number(&theirs["s"]));
            assert_close(&what, ours.x / units.length, number(&theirs["x"]));
            assert_close(&what, ours.y / units.length, number(&theirs["y"]));
            assert_close(&what, ours.alpha, number(&theirs["alpha"]));
            assert_close(&what, ours.force / units.force, number(&theirs["force"]));
        }
    }
}

#[test]
fn events_and_states_are_those_of_the_reference() {
    for reference in references() {
        let outcome = reference.scene.run_through();
        check_events(&reference, &outcome, Units::ONE);
        check_states(&reference, &outcome, Units::ONE);
    }
}

#[test]
fn and_so_they_are_in_si_units() {
    // the wire of the paper
    let wire = Rod::from_diameter(0.1, 0.5e-3, 206e9).unwrap();
    for reference in references() {
        let outcome = reference.scene.scaled(wire.length(), wire.bending_stiffness()).run_through();
        check_events(&reference, &outcome, wire.units());
        check_states(&reference, &outcome, wire.units());
    }
}

/// The contacts of a state as supports, by the abscissa.
struct Held<'a> {
    pieces: &'a [Bump],
    contacts: &'a [Contact],
    offsets: &'a [f64],
}

impl Supports for Held<'_> {
    fn count(&self) -> usize {
        self.contacts.len()
    }
    fn hold(&self, j: usize) -> Hold {
        match self.contacts[j].kind {
            ContactKind::Tip => Hold::Tip,
            _ => Hold::Tangent { offset: self.offsets[j] },
        }
    }
    fn support(&self, j: usize, x: f64) -> Support {
        let piece = self.pieces[self.contacts[j].piece];
        let slope = piece.slope(x);
        let steepness = slope.hypot(1.0);
        let turning = 2.0 * piece.coefficient / (steepness * steepness);
        Support { x, y: piece.height(x), alpha: slope.atan(), speed: steepness, turning }
    }
}

/// The equilibrium with the contacts of `state`, whether others are touched or not, with the clamp at `x0`.
fn continued(scene: &Scene, state: &State, x0: f64) -> (Elastica, Reactions) {
    let shape = state.elastica(&scene.rod()).unwrap();
    let contacts = &state.contacts;
    let offsets: Vec<_> = contacts.iter().map(|c| shape.at(c.s).phi - c.alpha).collect();
    let offsets: Vec<_> = offsets.iter().map(|o| (o / std::f64::consts::PI).round() * std::f64::consts::PI).collect();
    let supports = Held { pieces: &scene.bumps.pieces, contacts, offsets: &offsets };
    let third = |c: &Contact| if c.kind == ContactKind::Tip { shape.at(1.0).phi } else { c.s };
    let mut u: Vec<f64> = contacts.iter().flat_map(|c| [c.x, c.force, third(c)]).collect();
    let problem = MultiPoint { rod: Uniform, clamp: Pose { x: x0, ..state.pose }, supports: &supports };
    let report = solve(&problem, &mut u, &NewtonOptions::default(), &mut NewtonWorkspace::new());
    assert!(report.status.is_solved() && report.residual < 1e-13, "{report:?}");
    let loads: Vec<_> = (0..contacts.len())
        .map(|j| {
            let s = if contacts[j].kind == ContactKind::Tip { 1.0 } else { u[3 * j + 2] };
            Load { s, force: u[3 * j + 1], alpha: supports.support(j, u[3 * j]).alpha }
        })
        .collect();
    let shape = Elastica::from_clamp(Units::ONE, problem.clamp, -problem.clamp_curvature(&u), &loads).unwrap();
    let reactions = shape.reactions();
    (shape, reactions)
}

/// Smallest gap of the rod at its local minima, those at `contacts` left out.
fn smallest_other_gap(scene: &Scene, rod: &Elastica, contacts: &[Contact]) -> f64 {
    const SAMPLES: usize = 2000;
    let gap = |s: f64| {
        let at = rod.at(s);
        scene.bumps.gap(at.x, at.y)
    };
    let at = |i: usize| i as f64 / SAMPLES as f64;
    let gaps: Vec<f64> = (0..=SAMPLES).map(|i| gap(at(i))).collect();
    let mut least = f64::INFINITY;
    for i in 1..=SAMPLES {
        let beyond = gaps.get(i + 1).copied().unwrap_or(f64::INFINITY);
        if gaps[i] > gaps[i - 1] || gaps[i] > beyond {
            continue;
        }
        let s = golden(at(i - 1), at((i + 1).min(SAMPLES)), gap);
        if contacts.iter().all(|c| (c.s - s).abs() > 1e-3) {
            least = least.min(gap(s)).min(gaps[i]);
        }
    }
    least
}

fn touches(outcome: &Outcome) -> impl Iterator<Item = &Event> {
    outcome.events.iter().filter(|e| e.kind == EventKind::Touch)
}

#[test]
fn a_touch_is_where_the_gap_closes_and_the_reference_sees_it_late() {
    let mut compared = 0;
    let mut late = 0;
    for Reference { name, scene, events, .. } in references() {
        let outcome = scene.run_through();
        let theirs = events.iter().filter(|e| text(&e["kind"]) == "touch");
        for (event, theirs) in touches(&outcome).zip(theirs) {
            let contacts = &event.before.contacts;
            let ours = event.before.elastica(&scene.rod()).unwrap();
            let gap = smallest_other_gap(&scene, &ours, contacts);
            assert!(gap.abs() <= 1e-12, "{name}: the gap at the touch is {gap:e}");

            // the same contacts at the other solver's pose are what it found there, with the rod in the object already
            let x0 = number(&theirs["x0"]);
            let (shape, Reactions { f0x, f0y, m0z }) = continued(&scene, &event.before, x0);
            for (ours, theirs) in [f0x, f0y, m0z].into_iter().zip(theirs["reactions"].as_array().unwrap()) {
                assert_close(name, ours, number(theirs));
            }
            let gap = smallest_other_gap(&scene, &shape, contacts);
            let behind = event.pose().x - x0;
            assert!(behind.abs() < 1e-10 || (behind > 0.0) == (gap < 0.0), "{name}: {behind:e} late, gap {gap:e}");
            late += usize::from(gap < -1e-9);
            compared += 1;
        }
    }
    assert_eq!(compared, 2, "touches in the reference");
    assert!(late >= 1, "O2 at q = 0.4 was found late");
}

/// The cycles of the paper's table: the phases in order, with the kind of the transition that leads to each.
type Cycle = &'static [(EventKind, &'static str)];

const C1: Cycle = &[
    (EventKind::FirstContact, "A"),
    (EventKind::TipToTangent, "B"),
    (EventKind::Touch, "BB"),
    (EventKind::Release, "B"),
    (EventKind::TangentToTip, "A"),
    (EventKind::SnapOff, "free"),
];
const C2: Cycle = &[
    (EventKind::FirstContact, "A"),
    (EventKind::TipToTangent, "B"),
    (EventKind::Touch, "BB"),
    (EventKind::TangentToTip, "BA"),
    (EventKind::Release, "B"),
    (EventKind::TangentToTip, "A"),
    (EventKind::SnapOff, "free"),
];
const C3_WITH_A_SNAP: Cycle = &[
    (EventKind::FirstContact, "A"),
    (EventKind::TipToTangent, "B"),
    (EventKind::TangentToTip, "A"),
    (EventKind::Snap, "BA"),
    (EventKind::Release, "B"),
    (EventKind::TangentToTip, "A"),
    (EventKind::SnapOff, "free"),
];
const C3_WITH_A_TOUCH: Cycle = &[
    (EventKind::FirstContact, "A"),
    (EventKind::TipToTangent, "B"),
    (EventKind::TangentToTip, "A"),
    (EventKind::Touch, "BA"),
    (EventKind::Release, "B"),
    (EventKind::TangentToTip, "A"),
    (EventKind::SnapOff, "free"),
];

#[test]
fn the_nine_scans_go_through_the_cycles_of_the_paper() {
    let table = [[C1, C2, C3_WITH_A_SNAP], [C1, C1, C3_WITH_A_TOUCH], [C2, C3_WITH_A_SNAP, C3_WITH_A_SNAP]];
    for ((name, first, second), row) in OBJECTS.into_iter().zip(table) {
        for (q, cycle) in [0.2, 0.4, 0.6].into_iter().zip(row) {
            let outcome = Scene::paper(first, second, q).run_through();
            let ours: Vec<_> = outcome.events.iter().map(|e| (e.kind, e.to().to_string())).collect();
            let paper: Vec<_> = cycle.iter().map(|(kind, to)| (*kind, to.to_string())).collect();
            assert_eq!(ours, paper, "{name} at q = {q}");
            // each transition leaves the phase that the one before led to
            let from: Vec<_> = outcome.events.iter().map(|e| e.from().to_string()).collect();
            assert_eq!(from[0], "free");
            assert!(from[1..].iter().zip(&ours).all(|(from, (_, to))| from == to), "{name} at q = {q}: {from:?}");
        }
    }
}

#[test]
fn every_touch_of_the_nine_scans_is_where_the_gap_closes() {
    let mut count = 0;
    for (name, first, second) in OBJECTS {
        for q in [0.2, 0.4, 0.6] {
            let scene = Scene::paper(first, second, q);
            for event in touches(&scene.run_through()) {
                let shape = event.before.elastica(&scene.rod()).unwrap();
                let gap = smallest_other_gap(&scene, &shape, &event.before.contacts);
                assert!(gap.abs() <= 1e-12, "{name} at q = {q}, x0 = {}: {gap:e}", event.pose().x);
                count += 1;
            }
        }
    }
    assert_eq!(count, 6, "five of B -> BB, one of A -> BA");
}
