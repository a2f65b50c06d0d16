//! Scenes whose transitions an earlier version got wrong: they gained energy, began with a force, or depended on legs and steps.

use rod_files::Scene;
use std::path::Path;
use vibrissa::Event;
use vibrissa::contact::{EventKind, Outcome, SlipMode};

/// The sweep of a scene file with its steps times `share`.
fn swept(name: &str, share: f64) -> Outcome {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/transitions");
    let mut scene = Scene::read(&folder.join(format!("{name}.toml"))).unwrap();
    scene.step *= share;
    scene.legs.iter_mut().for_each(|leg| leg.step *= share);
    scene.sweep().unwrap().run()
}

/// Whether the energy rises at a pose.
fn gains(event: &Event) -> bool {
    event.before.pose == event.after.pose && event.after.energy > event.before.energy * (1.0 + 1e-9)
}

#[test]
fn no_transition_gains_energy() {
    for name in ["snap_raises_energy_a", "snap_raises_energy_b", "first_contact_with_force"] {
        let outcome = swept(name, 1.0);
        let wrong: Vec<_> = outcome.events.iter().filter(|event| gains(event)).collect();
        assert!(outcome.events.len() > 2 && wrong.is_empty(), "{name}: {wrong:#?}");
        let dissipated: Vec<f64> = outcome.events.iter().filter_map(|event| event.dissipated).collect();
        assert!(dissipated.len() == outcome.events.len() && dissipated.is_sorted(), "{name}: {dissipated:?}");
    }
}

#[test]
fn first_contacts_begin_without_force_and_stable() {
    for name in ["first_contact_with_force", "unstable_first_contact", "step_a"] {
        let outcome = swept(name, 1.0);
        let first = outcome.events.iter().filter(|event| event.kind == EventKind::FirstContact);
        let mut seen = 0;
        for event in first {
            let contact = &event.after.contacts[0];
            assert!(contact.force < 1e-9 && event.after.certificate.stable, "{name}: {event:#?}");
            seen += 1;
        }
        assert!(seen > 0, "{name}");
    }
}

fn told(outcome: &Outcome) -> (Vec<(EventKind, String)>, Option<String>) {
    let event = |event: &Event| (event.kind, format!("{}-{}", event.from(), event.to()));
    (outcome.events.iter().map(event).collect(), outcome.stop.as_ref().map(|stop| stop.reason.to_string()))
}

/// Poses differ by less than 1e-10 L.
fn assert_same(one: &Outcome, other: &Outcome) {
    assert_eq!(told(one), told(other));
    for (a, b) in one.events.iter().zip(&other.events) {
        let (p, q) = (a.pose(), b.pose());
        assert!((p.x - q.x).hypot(p.y - q.y) + (p.phi - q.phi).abs() < 1e-10, "{} {p:?} {q:?}", a.kind);
    }
}

#[test]
fn a_way_cut_in_legs_is_the_same_way() {
    assert_same(&swept("leg_whole", 1.0), &swept("leg_cut", 1.0));
}

#[test]
fn reported_poses_do_not_decide() {
    for name in ["step_a", "step_b"] {
        let outcome = swept(name, 1.0);
        for share in [0.5, 0.1, 5.0] {
            assert_same(&outcome, &swept(name, share));
        }
    }
}

/// The slip coordinate of a rolling contact is constant.
#[test]
fn a_side_that_rolls_does_not_slip() {
    let outcome = swept("slip_wobble", 1.0);
    let mut rolled = 0;
    for pair in outcome.states.windows(2) {
        let slips = [&pair[0], &pair[1]].map(|state| state.contacts.first().and_then(|contact| contact.friction));
        if let [Some(from), Some(to)] = slips
            && (from.mode, to.mode) == (SlipMode::Stick, SlipMode::Stick)
            && pair[0].leg == pair[1].leg
        {
            assert!((from.slip - to.slip).abs() < 1e-13, "{:e}", from.slip - to.slip);
            rolled += 1;
        }
    }
    assert!(rolled > 5, "{rolled}");
}
