//! Scans of object O1 at q = 0.4 with mu = 0.1, forwards and with reversals, against another solver whose states were integrated again by DOP853:
//! `tests/data/reference/friction`.

use crate::rods::scans::o1;
use serde_json::Value;
use std::f64::consts::FRAC_PI_2;
use vibrissa::contact::{Chain, EventKind, Outcome, SlipMode};
use vibrissa::{ClampPath, Pose, Rod, State, Sweep};

fn file(name: &str) -> Value {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/reference/friction").join(name);
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

fn at(x: f64) -> Pose {
    Pose { x, y: -0.4, phi: FRAC_PI_2 }
}

fn reactions(state: &State, known: [&Value; 3]) {
    let found = [state.reactions.f0x, state.reactions.f0y, state.reactions.m0z];
    for (found, known) in found.into_iter().zip(known.map(number)) {
        assert!((found - known).abs() < 1e-9 * (1.0 + known.abs()), "at {}: {found} {known}", state.pose.x);
    }
}

/// Phase and modes as the files write them: `B- A+`, `BoB-`.
fn named(state: &State) -> String {
    let phase = state.phase().to_string();
    let sign = |mode| match mode {
        SlipMode::Forward => '+',
        SlipMode::Backward => '-',
        _ => 'o',
    };
    let modes = state.contacts.iter().map(|contact| sign(contact.friction.unwrap().mode));
    if state.contacts.is_empty() {
        phase
    } else {
        phase.chars().zip(modes).flat_map(|(letter, mode)| [letter, mode]).collect()
    }
}

fn known_name(value: &Value) -> String {
    value.as_str().unwrap().replace(' ', "")
}

#[test]
fn a_scan() {
    let (file, object) = (file("forward_mu0.1.json"), o1());
    let path = ClampPath::new(at(1.0), at(-1.0)).unwrap();
    let outcome =
        Sweep::new(&Rod::new(1.0, 1.0).unwrap(), &object, path, 0.05).unwrap().with_friction(0.1).unwrap().run();
    assert!(outcome.stop.is_none(), "{:?}", outcome.stop);
    let events = file["events"].as_array().unwrap();
    assert_eq!(outcome.events.len(), events.len());
    for (event, known) in outcome.events.iter().zip(events) {
        assert!((event.pose().x - number(&known["x0"])).abs() < 1e-9, "{known} {}", event.pose().x);
        assert_eq!(named(&event.before), known_name(&known["frm"]));
        reactions(&event.before, [&known["reactions"][0], &known["reactions"][1], &known["reactions"][2]]);
    }
    let mut compared = 0;
    for known in file["states"].as_array().unwrap() {
        let Some(state) = outcome.states.iter().find(|state| (state.pose.x - number(&known["x0"])).abs() < 1e-9) else {
            continue;
        };
        reactions(state, ["f0x", "f0y", "m0z"].map(|field| &known[field]));
        for (contact, known) in state.contacts.iter().zip(known["contacts"].as_array().unwrap()) {
            let friction = contact.friction.unwrap();
            assert_eq!(friction.mode.to_string(), known["law"].as_str().unwrap());
            for (found, field) in
                [(contact.force, "force_n"), (friction.force, "force_t"), (contact.s, "s"), (contact.x, "x")]
            {
                assert!((found - number(&known[field])).abs() < 1e-9, "{field}: {known}");
            }
        }
        compared += 1;
    }
    assert!(compared > 15, "{compared}");
}

/// The work of the clamp is the change of the rod's energy plus what friction takes, phase by phase.
#[test]
fn energy_is_balanced() {
    let (file, object) = (file("forward_mu0.1.json"), o1());
    let path = ClampPath::new(at(1.0), at(-1.0)).unwrap();
    let outcome =
        Sweep::new(&Rod::new(1.0, 1.0).unwrap(), &object, path, 1.0).unwrap().with_friction(0.1).unwrap().run();
    let balance = file["energy_balance"].as_array().unwrap();
    for (pair, known) in outcome.events.windows(2).zip(balance) {
        let energy = pair[1].before.energy - pair[0].after.energy;
        // with what the rod loses in the jump at the end
        let jump = pair[1].before.energy - pair[1].after.energy;
        let dissipated = pair[1].dissipated.unwrap() - pair[0].dissipated.unwrap() - jump;
        // the first phase of the file begins 1e-4 beyond the touch; the last interval, at the fold, has its error of quadrature
        let (first, last) = (pair[0].from().contacts == 0, pair[1].to().contacts == 0);
        let tolerance = if last {
            1e-4
        } else if first {
            1e-7
        } else {
            1e-11
        };
        assert!((energy - number(&known[4])).abs() < tolerance, "{known} {energy}");
        assert!((dissipated - number(&known[5])).abs() < tolerance, "{known} {dissipated}");
    }
    assert!(outcome.dissipated.unwrap() >= outcome.events.last().unwrap().dissipated.unwrap());
}

/// The clamp goes to `x_r` and back.
fn there_and_back(x_r: f64) -> Outcome {
    let object = o1();
    let there = ClampPath::new(at(1.0), at(x_r)).unwrap();
    let back = ClampPath::new(at(x_r), at(x_r + 0.1)).unwrap();
    let path = Chain::new(vec![std::sync::Arc::new(there) as _, std::sync::Arc::new(back) as _]).unwrap();
    Sweep::new(&Rod::new(1.0, 1.0).unwrap(), &object, path, 5e-4).unwrap().with_friction(0.1).unwrap().run()
}

#[test]
fn the_clamp_turns_back() {
    let file = file("reversal_mu0.1.json");
    for (x_r, run) in file["runs"].as_object().unwrap() {
        let x_r: f64 = x_r.parse().unwrap();
        let outcome = there_and_back(x_r);
        // the file ends before the sweep does
        let end = number(&run["states"].as_array().unwrap().last().unwrap()["x0"]);
        let mut back: Vec<_> = outcome.events.iter().filter(|event| event.leg() == 1 && event.pose().x < end).collect();
        let turn = back.remove(0);
        assert_eq!((turn.kind, turn.pose().x), (EventKind::Stick, x_r));
        assert_eq!(turn.before.reactions, turn.after.reactions, "{x_r}");
        assert!(outcome.stop.is_none(), "{x_r}: {:?}", outcome.stop);
        let states: Vec<_> = outcome.states.iter().filter(|state| state.leg == 1).collect();
        let mut compared = 0;
        for known in run["states"].as_array().unwrap() {
            let Some(state) = states.iter().find(|state| (state.pose.x - number(&known["x0"])).abs() < 1e-9) else {
                continue;
            };
            assert_eq!(named(state), known_name(&known["phase"]), "{x_r}");
            reactions(state, ["f0x", "f0y", "m0z"].map(|field| &known[field]));
            compared += 1;
        }
        assert!(compared > 8, "{x_r}: {compared}");
        // the file has two events where the modes of two contacts change at one pose, the sweep one
        let known = run["events"].as_array().unwrap();
        let is_last = |k: &usize| known.get(k + 1).is_none_or(|next| number(&next["x0"]) != number(&known[*k]["x0"]));
        let is_first = |k: usize| k == 0 || number(&known[k - 1]["x0"]) != number(&known[k]["x0"]);
        for (event, last) in back.iter().zip((0..known.len()).filter(is_last)) {
            let first = (0..=last).rev().find(|k| is_first(*k)).unwrap();
            let (known, to) = (&known[first], known_name(&known[last]["to"]));
            assert!((event.pose().x - number(&known["x0"])).abs() < 1e-9, "{x_r}: {known} {}", event.pose().x);
            reactions(&event.before, [&known["reactions"][0], &known["reactions"][1], &known["reactions"][2]]);
            assert_eq!((named(&event.before), named(&event.after)), (known_name(&known["frm"]), to), "{x_r}");
            assert_eq!(
                event.kind == EventKind::Slip,
                known["kind"].as_str().unwrap().starts_with("slip"),
                "{x_r}: {known}"
            );
        }
        assert_eq!(back.len(), (0..known.len()).filter(is_last).count(), "{x_r}");
    }
}
