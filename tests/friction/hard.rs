//! What is hard with friction: starts in contact, inflections, rods that wrap around an object, many contacts. Each is followed rightly, or stops by
//! name.

use super::judge::{Counts, Judge, Shape};
use super::random::composite;
use crate::rods::scans::o1;
use std::f64::consts::{FRAC_PI_2, PI};
use vibrissa::contact::{Chain, Contact, ContactKind, Outcome, SlipMode, StopReason};
use vibrissa::rod::Pose;
use vibrissa::{ClampPath, Composite, Rod, Sweep, equilibrium};

fn uniform() -> Rod {
    Rod::new(1.0, 1.0).unwrap()
}

/// A sweep through these poses, judged.
fn judged(shapes: &[Shape], objects: &[Composite], mu: f64, poses: &[Pose], step: f64) -> (Counts, Vec<String>) {
    let coefficients = vec![mu; shapes.len()];
    let judge = Judge { law: &|_, m| m, compliance: [[0.0; 3]; 3], shapes, mu: &coefficients };
    let path = Chain::polyline(poses).unwrap();
    judge.run(Sweep::new(&uniform(), objects, path, step).unwrap().with_friction(mu).unwrap())
}

#[test]
fn starts_in_contact_obey_coulomb() {
    let shapes = [Shape::Parabolas(vec![([0.0, 0.0], 5.0), ([0.3, 0.0], 5.0)])];
    let objects = [o1()];
    let pose = |x: f64, y: f64, turn: f64| Pose { x, y: y - 0.4, phi: FRAC_PI_2 + turn };
    let starts = [0.5, 0.2, 0.0, -0.3, -0.47].map(|x| pose(x, 0.0, 0.0));
    let mut all = Counts::default();
    for start in starts {
        let ways =
            [(0.1, 0.0, 0.0), (-0.1, 0.0, 0.0), (0.0, 0.05, 0.0), (0.0, -0.05, 0.0), (0.0, 0.0, 0.2), (0.0, 0.0, -0.2)];
        for (x, y, turn) in ways {
            let end = Pose { x: start.x + x, y: start.y + y, phi: start.phi + turn };
            for mu in [0.1, 0.6] {
                let (counts, wrong) = judged(&shapes, &objects, mu, &[start, end], 2e-3);
                assert!(wrong.is_empty(), "{start:?} {end:?} {mu}: {wrong:#?}");
                all.add(counts);
            }
        }
    }
    println!("{all:?}");
    assert!(all.slips > 500 && all.sticks + all.rolls > 8, "{all:?}");
    // none of them ends for a reason that the objects do not give
    assert!(all.stops.keys().all(|reason| ["jammed", "no-start"].contains(&reason.as_str())), "{all:?}");
}

/// A start in contact is where a sweep from outside would have come.
#[test]
fn a_start_in_contact_comes_along_the_path() {
    let object = o1();
    let at = |x: f64| Pose { x, y: -0.4, phi: FRAC_PI_2 };
    let run = |from: f64| {
        let path = ClampPath::new(at(from), at(0.0)).unwrap();
        Sweep::new(&uniform(), &object, path, 0.01).unwrap().with_friction(0.3).unwrap().run().states
    };
    let (whole, rest) = (run(1.0), run(0.2));
    let (first, known) = (&rest[0], whole.iter().find(|state| (state.pose.x - 0.2).abs() < 1e-12).unwrap());
    assert_eq!(first.contacts[0].friction.unwrap().mode, SlipMode::Backward);
    assert!((first.reactions.f0x - known.reactions.f0x).abs() < 1e-9);
    assert!((rest.last().unwrap().reactions.f0x - whole.last().unwrap().reactions.f0x).abs() < 1e-9);
}

/// The scene of `tests/inflection.rs`: one contact parts into two at an inflection.
#[test]
fn an_inflection_is_followed_or_named() {
    let mut all = Counts::default();
    for d in [-0.1, -0.05, -0.02] {
        for mu in [1e-6, 0.05, 0.3] {
            let shapes = [Shape::Quartic([0.0, 0.0, 0.0, -0.3, -d])];
            let objects = [composite(&shapes[0])];
            let pose = |y: f64| Pose { x: 0.75, y, phi: PI - 0.6 };
            let (counts, wrong) = judged(&shapes, &objects, mu, &[pose(-0.6), pose(-0.14), pose(-0.6)], 2e-3);
            assert!(wrong.is_empty(), "{d} {mu}: {wrong:#?}");
            println!("{d} {mu} {:?} {:?}", counts.events, counts.stops);
            all.add(counts);
        }
    }
    let named = ["friction-in-notch", "line-contact", "undetermined"];
    assert!(all.stops.keys().all(|reason| named.contains(&reason.as_str())), "{all:?}");
    assert!(all.slips > 200, "{all:?}");
}

/// A rod that is turned around a disc lies on it along a line in the end.
#[test]
fn a_rod_wraps_around_a_disc() {
    let mut all = Counts::default();
    for mu in [0.05, 0.3, 1.0] {
        for radius in [0.1, 0.2, 0.3] {
            let shapes = [Shape::Disc([0.3, radius + 0.01], radius)];
            let objects = [composite(&shapes[0])];
            let pose = |phi: f64| Pose { x: 0.0, y: 0.0, phi };
            let (counts, wrong) = judged(&shapes, &objects, mu, &[pose(-0.3), pose(1.3), pose(1.28), pose(3.2)], 5e-3);
            assert!(wrong.is_empty(), "{mu} {radius}: {wrong:#?}");
            println!("{mu} {radius} {:?} {:?}", counts.events, counts.stops);
            all.add(counts);
        }
    }
    let named = ["line-contact", "clamp-inside", "undetermined"];
    assert!(all.stops.keys().all(|reason| named.contains(&reason.as_str())), "{all:?}");
    assert!(all.slips > 200, "{all:?}");
}

/// A rod between discs above and below it in turn.
#[test]
fn more_contacts_than_can_be_tried_are_named() {
    for count in [3, 6, 7, 9] {
        let (radius, amplitude) = (0.02, 4e-3);
        let side = |j: usize| if j.is_multiple_of(2) { 1.0 } else { -1.0 };
        let centre = |j: usize| [0.95 * (j + 1) as f64 / count as f64, side(j) * (radius - amplitude)];
        let shapes: Vec<_> = (0..count).map(|j| Shape::Disc(centre(j), radius)).collect();
        let objects: Vec<_> = shapes.iter().map(composite).collect();
        let pose = |y: f64| Pose { x: 0.0, y, phi: 0.0 };
        let guess: Vec<_> = (0..count)
            .map(|j| Contact {
                object: j,
                piece: 0,
                kind: ContactKind::Tangent,
                s: centre(j)[0],
                x: centre(j)[0],
                y: -side(j) * amplitude,
                alpha: if side(j) > 0.0 { 0.0 } else { PI },
                force: 10.0,
                friction: None,
            })
            .collect();
        let start = equilibrium(&uniform(), &objects, pose(0.0), &guess).unwrap().state;
        assert_eq!(start.contacts.len(), count);
        let path = Chain::polyline(&[pose(0.0), pose(2e-3), pose(0.0)]).unwrap();
        let sweep = Sweep::from_state(&uniform(), &objects, &start, path, 2e-5).unwrap().with_friction(0.2).unwrap();
        let coefficients = vec![0.2; count];
        let judge = Judge { law: &|_, m| m, compliance: [[0.0; 3]; 3], shapes: &shapes, mu: &coefficients };
        let items: Vec<_> = sweep.collect();
        if count > 6 {
            assert!(matches!(&items[..], [Err(stop)] if stop.reason == StopReason::Undetermined), "{count}: {items:?}");
            continue;
        }
        let (counts, wrong) = judge.run(items.into_iter());
        println!("{count} {counts:?}");
        assert!(wrong.is_empty(), "{count}: {wrong:#?}");
        assert!(counts.stops.is_empty() && counts.rolls > 5, "{count}: {counts:?}");
    }
}

/// With hardly any friction an inflection is passed as without: one contact parts into two there, and the two run together on the way back.
#[test]
fn an_inflection_is_passed_as_without_friction() {
    for (d, mu) in [(-0.1, 1e-8), (-0.05, 1e-8), (-0.1, 0.05), (-0.05, 0.05)] {
        let objects = [composite(&Shape::Quartic([0.0, 0.0, 0.0, -0.3, -d]))];
        let pose = |y: f64| Pose { x: 0.75, y, phi: PI - 0.6 };
        let path = Chain::polyline(&[pose(-0.6), pose(-0.14), pose(-0.6)]).unwrap();
        let sweep = || Sweep::new(&uniform(), &objects, path.clone(), 2e-3).unwrap();
        let (smooth, rough) = (sweep().run(), sweep().with_friction(mu).unwrap().run());
        assert!(smooth.stop.is_none() && rough.stop.is_none(), "{d} {mu}: {:?}", rough.stop);
        let contacts = |outcome: &Outcome| {
            let events = outcome.events.iter().filter(|event| event.from() != event.to());
            events.map(|event| (event.kind, event.to().to_string())).collect::<Vec<_>>()
        };
        assert_eq!(contacts(&smooth), contacts(&rough), "{d} {mu}");
        let tolerance = if mu < 1e-6 { 1e-6 } else { 2.0 };
        for (smooth, rough) in smooth.states.iter().zip(&rough.states) {
            let off = (smooth.reactions.f0x - rough.reactions.f0x).abs();
            assert!(off < tolerance * (1.0 + smooth.reactions.f0x.abs()), "{d} {mu} {:?}: {off}", smooth.pose);
        }
    }
}
