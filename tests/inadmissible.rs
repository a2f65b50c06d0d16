//! Equilibria that a rod cannot be in, each with its reason.

use std::f64::consts::{FRAC_PI_2, PI};
use vibrissa::contact::{Contact, ContactKind, Equilibrium, EventKind, Follower, Inadmissible, Outcome};
use vibrissa::{ClampPath, Composite, Parabola, Pose, Rod, Sweep, equilibrium};

fn rod() -> Rod {
    Rod::new(1.0, 1.0).unwrap()
}

/// O1 of Merker et al. (2020).
fn notched() -> Composite {
    let parabola = |x| Box::new(Parabola::new([x, 0.0], 5.0).unwrap());
    Composite::joined(vec![parabola(0.0), parabola(0.3)]).unwrap()
}

fn clamp(x: f64) -> Pose {
    Pose { x, y: -0.4, phi: FRAC_PI_2 }
}

fn scan() -> Outcome {
    Sweep::new(&rod(), &notched(), ClampPath::new(clamp(0.8), clamp(-0.9)).unwrap(), 1e-3).unwrap().run()
}

fn solved(x: f64, guess: &[Contact]) -> Equilibrium {
    equilibrium(&rod(), &notched(), clamp(x), guess).unwrap()
}

#[test]
fn a_rod_that_cannot_reach_the_contact_is_not_solved() {
    let tip = Contact {
        object: 0,
        piece: 1,
        kind: ContactKind::Tip,
        s: 1.0,
        x: 0.6,
        y: 0.45,
        alpha: 1.2,
        force: 1.0,
        friction: None,
    };
    // 1.2 L below, the vertex is out of reach
    let far = Pose { x: 0.3, y: -1.2, phi: FRAC_PI_2 };
    let found = equilibrium(&rod(), &notched(), far, &[tip]).unwrap();
    assert!(!found.report.status.is_solved());
    assert_eq!(found.is_admissible(), Err(Inadmissible::NotSolved(found.report.status)));
}

#[test]
fn contacts_that_change_places_are_not_in_order() {
    let outcome = scan();
    let states = outcome.states.iter().filter(|state| state.phase().to_string() == "BB");
    let mut seen = 0;
    for state in states {
        let mut guess = state.contacts.clone();
        guess.reverse();
        let found = solved(state.pose.x, &guess);
        assert_eq!(found.is_admissible(), Err(Inadmissible::NotInOrder), "{state:?}");
        assert!(found.report.residual < 1e-12 && found.state.contacts[0].s > found.state.contacts[1].s, "{found:?}");
        seen += 1;
    }
    assert!(seen > 50, "{seen}");
}

#[test]
fn a_contact_beyond_the_end_of_its_piece_is_off_it() {
    // the tip would rest on the line through the upper edge, right of the square
    let square = Composite::polygon(&[[-1.0, -0.5], [0.0, -0.5], [0.0, 0.0], [-1.0, 0.0]]).unwrap();
    let edge = Contact {
        object: 0,
        piece: 2,
        kind: ContactKind::Tip,
        s: 1.0,
        x: -0.1,
        y: 0.0,
        alpha: PI,
        force: 1.0,
        friction: None,
    };
    let pose = |x| Pose { x, y: 0.8, phi: -0.3 * PI };
    let on = equilibrium(&rod(), &square, pose(-1.1), &[edge]).unwrap();
    assert_eq!(on.is_admissible(), Ok(()), "{on:?}");
    let off = equilibrium(&rod(), &square, pose(1.1), &[edge]).unwrap();
    assert!(off.report.status.is_solved() && off.state.contacts[0].x > 0.01, "{off:?}");
    assert_eq!(off.is_admissible(), Err(Inadmissible::OffPiece { contact: 0 }));
    // from a state that is none a sweep does not go on
    assert!(Follower::from_state(&rod(), &square, &off.state).is_err());
}

#[test]
fn every_state_of_a_sweep_over_a_star_is_its_own_equilibrium() {
    let tip = |k: u32| {
        let (radius, angle) = (if k.is_multiple_of(2) { 0.3 } else { 0.12 }, 0.2 + 0.2 * PI * f64::from(k));
        [radius * angle.cos(), radius * angle.sin()]
    };
    let star = Composite::polygon(&(0..10).map(tip).collect::<Vec<_>>()).unwrap();
    let mut of_kind = [0; 4];
    for k in 0..60 {
        let pose = |x| Pose { x, y: -0.9 + 0.01 * f64::from(k), phi: FRAC_PI_2 - 0.005 * f64::from(k) };
        let states =
            Sweep::new(&rod(), &star, ClampPath::new(pose(0.9), pose(-0.9)).unwrap(), 0.02).unwrap().run().states;
        for state in states.iter().filter(|state| !state.contacts.is_empty()) {
            let found = equilibrium(&rod(), &star, state.pose, &state.contacts).unwrap();
            assert_eq!(found.is_admissible(), Ok(()), "{state:?} {:?}", found.state);
            assert!((found.state.reactions.m0z - state.reactions.m0z).abs() < 1e-10, "{state:?} {:?}", found.state);
            state.contacts.iter().for_each(|contact| of_kind[contact.kind as usize] += 1);
        }
    }
    assert!(of_kind[ContactKind::Tip as usize] > 100 && of_kind[ContactKind::Corner as usize] > 100, "{of_kind:?}");
    assert!(of_kind[ContactKind::Notch as usize] > 5, "{of_kind:?}");
}

#[test]
fn the_equilibrium_behind_a_fold_is_unstable() {
    let outcome = scan();
    let fold = outcome.events.iter().find(|event| event.kind == EventKind::SnapOff).unwrap();
    let at_fold = fold.before.contacts[0];
    for x in [-0.81, -0.8, -0.79] {
        let stable = outcome.states.iter().find(|state| (state.pose.x - x).abs() < 1e-9).unwrap();
        assert_eq!(stable.phase().to_string(), "A");
        // the other one is as far from the fold, on the other side
        let Contact { x: px, y: py, force, .. } = stable.contacts[0];
        let guess =
            Contact { x: 2.0 * at_fold.x - px, y: 2.0 * at_fold.y - py, force: 2.0 * at_fold.force - force, ..at_fold };
        let found = solved(x, &[guess]);
        assert_eq!(found.is_admissible(), Err(Inadmissible::Unstable));
        // a maximum of the energy between two minima
        assert!(found.state.energy > stable.energy && found.report.residual < 1e-12);
    }
}
