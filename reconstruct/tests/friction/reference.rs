//! The recording with mu = 0.1, reconstructed.

use super::recording::{Recording, recording, rod};
use rod_reconstruct::{Budget, Finding, Friction, Reason, Reconstruction, Settings, Unresolved, reconstruct};

const MU: f64 = 0.1;

fn found(recording: &Recording, friction: Friction, budget: Option<Budget>) -> Reconstruction {
    reconstruct(&rod(), &recording.samples, &Settings { friction, budget, ..Settings::default() }).unwrap()
}

/// The largest distances of single, first and second contacts from the truth, of their tangents and of their forces; and how many have none.
fn off(recording: &Recording, found: &Reconstruction) -> ([f64; 3], f64, f64, usize) {
    let (mut places, mut tangents, mut forces, mut none) = ([0.0_f64; 3], 0.0_f64, 0.0_f64, 0);
    for contact in &recording.contacts {
        let reading = &found.readings[contact.row];
        let kind = if recording.labels[contact.row].several() { 1 + contact.contact } else { 0 };
        let touch = if contact.contact == 0 { reading.touch } else { reading.second.unwrap_or(reading.touch) };
        let Ok(touch) = touch else {
            none += 1;
            continue;
        };
        places[kind] =
            places[kind].max((touch.x - contact.x).hypot(touch.y - contact.y)).max((touch.s - contact.s).abs());
        tangents = tangents.max((touch.alpha - contact.alpha).abs());
        forces = forces.max((touch.force - contact.normal.hypot(contact.tangential)).abs());
    }
    (places, tangents, forces, none)
}

#[test]
fn labels_points_tangents_forces_and_the_coefficient_are_exact() {
    let recording = recording();
    for (friction, budget) in [
        (Friction::Estimate, Some(Budget::NONE)),
        (Friction::Known { mu: MU, sigma: 0.0 }, Some(Budget::NONE)),
        // errors that samples share are estimated, too, and none is found
        (Friction::Estimate, None),
    ] {
        let found = found(&recording, friction, budget);
        assert!(found.readings.iter().zip(&recording.labels).all(|(reading, label)| reading.label == *label));
        let pass = &found.passes[0];
        let friction = pass.friction.unwrap();
        assert!((pass.used_friction - MU).abs() < 1e-12 && (friction.mu - MU).abs() < 1e-12, "{friction:?}");
        assert!(friction.is_significant() && friction.is_identified() && friction.against == 0.0, "{friction:?}");
        let (places, tangents, forces, none) = off(&recording, &found);
        assert!(none == 0 && places[0] < 1e-12 && places[1] < 1e-10 && places[2] < 1e-10, "{none} {places:?}");
        assert!(tangents < 1e-10 && forces < 1e-9, "{tangents:e} {forces:e}");
        assert!(!found.findings().iter().any(Finding::is_misfit), "{:?}", found.findings());
    }
}

#[test]
fn without_asking_friction_is_named_as_what_does_not_fit() {
    let recording = recording();
    for budget in [Some(Budget::NONE), None] {
        let found = found(&recording, Friction::None, budget);
        let named = found.findings().into_iter().find(|finding| matches!(finding, Finding::Friction { .. })).unwrap();
        assert!(named.is_misfit() && named.to_string().contains("mu = 0.1000"), "{named}");
        assert_eq!(found.passes[0].used_friction, 0.0);
    }
}

/// A coefficient that is off by a tenth contradicts the plateau, and points that depend on it are not given without a word.
#[test]
fn a_wrong_coefficient_is_not_taken_without_a_word() {
    let recording = recording();
    let found = found(&recording, Friction::Known { mu: 0.11, sigma: 0.0 }, Some(Budget::NONE));
    let misfit = found.findings().iter().any(Finding::is_misfit);
    assert!(misfit, "{:?}", found.findings());
    let silent = found.readings.iter().filter(|reading| reading.touch == Err(Reason::Several(Unresolved::Sticks)));
    assert_eq!(silent.count(), 0, "all contacts slide");
}
