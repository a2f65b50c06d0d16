//! Laws of friction: what is refused, static coefficients above the kinetic ones, and pieces that differ.

use crate::rods::scans::o1;
use std::f64::consts::FRAC_PI_2;
use vibrissa::contact::{Chain, Coefficients, Contact, ContactError, EventKind, SlipMode, StopReason};
use vibrissa::contour::{Range, Trimmed};
use vibrissa::rod::Pose;
use vibrissa::{Composite, Parabola, Rod, Sweep};

fn at(x: f64) -> Pose {
    Pose { x, y: -0.4, phi: FRAC_PI_2 }
}

fn uniform() -> Rod {
    Rod::new(1.0, 1.0).unwrap()
}

fn sweep<'a>(object: &'a Composite, ways: &[f64], step: f64) -> Sweep<'a> {
    let path = Chain::polyline(&ways.iter().map(|x| at(*x)).collect::<Vec<_>>()).unwrap();
    Sweep::new(&uniform(), object, path, step).unwrap()
}

#[test]
fn coefficients_that_cannot_be_are_refused() {
    let object = o1();
    let refused = |made: Result<Sweep<'_>, ContactError>| match made {
        Err(error @ ContactError::Friction { object, .. }) => (object, error.to_string()),
        other => panic!("{other:?}"),
    };
    let new = || sweep(&object, &[1.0, 0.0], 0.1);
    for wrong in [-0.1, f64::NAN, f64::INFINITY] {
        let (number, told) = refused(new().with_friction(wrong));
        assert!(number == 0 && told.contains(&wrong.to_string()) && told.contains("expected"), "{told}");
        assert_eq!(refused(new().with_friction(vec![wrong])).0, 0);
    }
    let (number, told) = refused(new().with_friction(vec![0.1, 0.2]));
    assert!(number == 1 && told.contains("0.2"), "{told}");
    assert!(new().with_friction(vec![]).is_ok());
    // an own law that is wrong on its second piece only
    for (at_rest, slipping) in
        [(0.1, 0.2), (f64::NAN, 0.2), (f64::INFINITY, 0.1), (0.3, -0.1), (0.3, f64::NAN), (0.3, 0.0)]
    {
        let own = move |_: usize, piece: usize| {
            if piece == 1 { Coefficients { at_rest, slipping } } else { Coefficients::equal(0.1) }
        };
        assert_eq!(refused(new().with_friction(own)).0, 0);
    }
}

/// A rod that sticks holds more than one that slips: it turns back later, and the force falls where it begins to slip.
#[test]
fn a_rod_that_sticks_holds_more() {
    let object = o1();
    let law = |_: usize, _: usize| Coefficients { at_rest: 0.15, slipping: 0.1 };
    let equal = sweep(&object, &[1.0, 0.0, 0.02], 1e-3).with_friction(0.1).unwrap().run();
    let more = sweep(&object, &[1.0, 0.0, 0.02], 1e-3).with_friction(law).unwrap().run();
    assert!(more.stop.is_none(), "{:?}", more.stop);
    let slip = |outcome: &vibrissa::contact::Outcome| {
        outcome.events.iter().find(|event| event.leg() == 1 && event.kind == EventKind::Slip).unwrap().clone()
    };
    let (early, late) = (slip(&equal), slip(&more));
    assert!(late.pose().x > early.pose().x + 1e-4, "{} {}", late.pose().x, early.pose().x);
    let ratio = |state: &vibrissa::State| state.contacts[0].friction.unwrap().force / state.contacts[0].force;
    assert!((ratio(&late.before) + 0.15).abs() < 1e-9 && (ratio(&late.after) + 0.1).abs() < 1e-9);
    // it has slipped forward, and lost energy by the jump
    let slip_of = |state: &vibrissa::State| state.contacts[0].friction.unwrap().slip;
    assert!(slip_of(&late.after) > slip_of(&late.before) + 1e-6);
    assert!(late.after.energy < late.before.energy);
    // from there on it is as if it had slipped with the kinetic coefficient all the time
    let [one, other] = [&equal, &more].map(|outcome| outcome.states.last().unwrap().clone());
    assert!((one.reactions.f0x - other.reactions.f0x).abs() < 1e-9);
    assert_eq!(other.contacts[0].friction.unwrap().mode, SlipMode::Forward);
}

/// One parabola in two pieces: the coefficient changes where the contact, coming from the right, passes the joint between them.
#[test]
fn a_contact_passes_onto_another_piece() {
    let half = |from: f64, to: f64| {
        Box::new(Trimmed::new(Parabola::new([0.3, 0.0], 5.0).unwrap(), Range { from, to }).unwrap()) as _
    };
    let object = Composite::new(vec![half(-2.0, 0.2), half(0.2, 2.0)]).unwrap();
    for mu in [[0.1, 0.3], [0.0, 0.2], [0.3, 0.1], [0.2, 0.0]] {
        let law = move |_: usize, piece: usize| Coefficients::equal(mu[piece]);
        let outcome = sweep(&object, &[1.0, -0.3], 0.01).with_friction(law).unwrap().run();
        for contact in outcome.states.iter().flat_map(|state| &state.contacts) {
            let f_t = contact.friction.map_or(0.0, |friction| friction.force);
            assert!(f_t.abs() <= mu[contact.piece] * contact.force * (1.0 + 1e-9) + 1e-12, "{mu:?} {contact:?}");
        }
        let kinds: Vec<_> = outcome.events.iter().map(|event| event.kind).collect();
        if mu[0] > mu[1] {
            // where it rolls on the rougher piece it goes back to the smoother one, and where it slips there to the rougher one
            assert_eq!(outcome.stop.unwrap().reason, StopReason::RougherPiece, "{mu:?}");
            assert!(!kinds.contains(&EventKind::Snap) && !kinds.contains(&EventKind::SnapOff), "{mu:?} {kinds:?}");
            assert!(outcome.states.last().unwrap().contacts[0].piece == 1);
            continue;
        }
        assert!(outcome.stop.is_none(), "{mu:?}: {:?}", outcome.stop);
        let piece = outcome.events.iter().find(|event| event.kind == EventKind::Piece).unwrap();
        let [before, after] = [&piece.before, &piece.after].map(|state| state.contacts[0]);
        let ratio = |contact: Contact| contact.friction.map_or(0.0, |friction| friction.force / contact.force);
        assert!((ratio(before) - mu[1]).abs() < 1e-9 && (ratio(after) - mu[0]).abs() < 1e-9, "{mu:?}");
        // the force falls at once: the rod slips on, to the left, and loses energy
        assert!(after.x < before.x - 1e-6 && piece.after.energy < piece.before.energy, "{mu:?}");
        // as if it had come there with that coefficient
        let alone = sweep(&object, &[1.0, -0.3], 0.01).with_friction(mu[0]).unwrap().run();
        let known = alone.states.iter().find(|state| state.pose.x < piece.pose().x - 0.02).unwrap();
        let found = outcome.states.iter().find(|state| state.pose == known.pose).unwrap();
        assert!((found.reactions.f0x - known.reactions.f0x).abs() < 1e-9, "{mu:?}");
    }
}
