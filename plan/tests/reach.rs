//! What scans reach, against closed forms and against dense samples.
#![allow(clippy::unwrap_used)]

use rod_contact::{ClampPath, Contact, Sweep};
use rod_contours::{CircularArc, Composite, Contour, Parabola};
use rod_core::{Pose, Rod};
use rod_plan::{IntervalSet, Pass, PlanError, Reach, ReachGrid, reach};
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::sync::atomic::{AtomicUsize, Ordering};

fn rod() -> Rod {
    Rod::new(1.0, 1.0).unwrap()
}

fn circle(radius: f64) -> Composite {
    // starts aside, so that its lowest point is no end
    Composite::single(CircularArc::new([0.3, 0.2], radius, 0.4, 0.4 + TAU).unwrap()).unwrap()
}

/// O1 of Merker et al. (2020), in rod lengths.
fn o1() -> Composite {
    let parabola = |x: f64| Box::new(Parabola::new([x, 0.0], 5.0).unwrap()) as Box<dyn Contour>;
    Composite::joined(vec![parabola(0.0), parabola(0.3)]).unwrap()
}

fn found(object: &Composite, distances: &[f64], angles: &[f64], step: f64) -> Reach {
    let grid = ReachGrid { distances: distances.to_vec(), angles: angles.to_vec(), step };
    reach(&rod(), std::slice::from_ref(object), &grid, &|_| true).unwrap()
}

/// The straight rod meets a circle at the height of its tip, or along its side at the widest place. From there the contact moves to the lowest place,
/// and on the other side the pass the other way does the same.
#[test]
fn of_a_circle_the_near_half_is_touched_as_high_as_the_rod_ends() {
    for (radius, distance) in [(0.1, 0.4), (0.2, 0.85), (0.3, 0.75), (0.25, 0.5)] {
        for angle in [FRAC_PI_2, 0.3, -2.0] {
            let object = circle(radius);
            let reach = found(&object, &[distance], &[angle], 0.01);
            assert!(reach.scans.iter().all(|scan| scan.found.stop.is_none()), "{radius} {distance} {angle}");
            let height: f64 = (1.0_f64 - distance).min(radius);
            let free_side = 2.0 * radius * (1.0 - height / radius).acos();
            let union = reach.union();
            // a pass goes on beyond the lowest place, as far as the tip holds: not beyond the widest place
            let touched = union.single[0].length();
            assert!((touched - free_side).abs() < 1e-9, "{radius} {distance} {angle}: {touched} {free_side}");
            assert_eq!(union.several[0].length(), 0.0);
        }
    }
}

/// Each place is touched in a dense sweep exactly where the intervals say so.
#[test]
fn dense_samples_of_o1_fill_the_same_intervals() {
    let object = o1();
    for (distance, phases) in [(0.2, 2), (0.4, 2), (0.6, 2)] {
        let reach = found(&object, &[distance], &[FRAC_PI_2], 0.01);
        let scan = reach.scans.iter().find(|scan| scan.scan.pass == Pass::Left).unwrap();
        let clamp = |x: f64| Pose { x, y: -distance, phi: FRAC_PI_2 };
        let path = ClampPath::new(clamp(0.9), clamp(-1.4)).unwrap();
        let states = Sweep::new(&rod(), &object, path, 2e-5).unwrap().run().states;
        let outline = &reach.outlines[0];
        let mut hits = [Vec::new(), Vec::new()];
        for state in &states {
            for contact in &state.contacts {
                hits[usize::from(state.contacts.len() > 1)].push(arc_of(contact));
            }
        }
        for (hits, set) in hits.iter_mut().zip([&scan.found.touched.single[0], &scan.found.touched.several[0]]) {
            let start = arc_length(0.0, -((1.0 - distance) / 5.0_f64).sqrt());
            hits.iter_mut().for_each(|hit| *hit -= start);
            hits.sort_by(f64::total_cmp);
            // every hit is in an interval, and along every interval hits are close together
            assert!(
                hits.iter().all(|hit| set.parts().iter().any(|(from, to)| from - 1e-9 <= *hit && *hit <= to + 1e-9))
            );
            for (from, to) in set.parts() {
                let inside: Vec<f64> =
                    hits.iter().copied().filter(|hit| from - 1e-9 <= *hit && *hit <= to + 1e-9).collect();
                let first = inside.first().unwrap() - from;
                let last = to - inside.last().unwrap();
                // where a contact comes to rest before a jump it moves as the square root of the way
                assert!(first < 5e-3 && last < 5e-3, "{distance}: {first} {last} of {from} {to}");
                assert!(inside.windows(2).all(|pair| pair[1] - pair[0] < 5e-3));
            }
        }
        // the first touch: the tip of the straight rod on the right parabola
        let touch = outline.length();
        assert!(scan.found.touched.single[0].contains(touch - 1e-9), "{distance}");
        assert!(scan.found.touched.several[0].parts().len() >= phases, "{distance}: {:?}", scan.found.touched.several);
        // the notch itself is never touched, from none of the distances
        let notch = arc_length(0.0, 0.15) - arc_length(0.0, -((1.0 - distance) / 5.0_f64).sqrt());
        assert!(!scan.found.touched.all(0).contains(notch), "{distance}");
    }
}

/// Arc length of y = 5 (x - vertex)^2 from the vertex.
fn arc_length(vertex: f64, x: f64) -> f64 {
    let slope = 10.0 * (x - vertex);
    (slope * slope.hypot(1.0) + slope.asinh()) / 20.0
}

/// Arc length along O1 from the vertex of its left parabola.
fn arc_of(contact: &Contact) -> f64 {
    let notch = arc_length(0.0, 0.15);
    if contact.piece == 0 { arc_length(0.0, contact.x) } else { 2.0 * notch + arc_length(0.3, contact.x) }
}

#[test]
fn the_ends_of_what_is_touched_do_not_depend_on_the_step() {
    let object = o1();
    let [coarse, fine] = [0.02, 0.001].map(|step| found(&object, &[0.15, 0.3, 0.45, 0.6, 0.75], &[FRAC_PI_2], step));
    for (coarse, fine) in coarse.scans.iter().zip(&fine.scans) {
        for (coarse, fine) in [
            (&coarse.found.touched.single[0], &fine.found.touched.single[0]),
            (&coarse.found.touched.several[0], &fine.found.touched.several[0]),
        ] {
            assert_eq!(coarse.parts().len(), fine.parts().len(), "{coarse:?} {fine:?}");
            for (one, other) in coarse.parts().iter().zip(fine.parts()) {
                assert!((one.0 - other.0).abs().max((one.1 - other.1).abs()) < 1e-8, "{one:?} {other:?}");
            }
        }
    }
}

/// A mirror turns a pass to the left into one to the right.
#[test]
fn passes_of_a_symmetric_object_mirror_each_other() {
    let reach = found(&o1(), &[0.3, 0.5], &[FRAC_PI_2], 0.01);
    let length = reach.outlines[0].length();
    for pair in reach.scans.chunks(2) {
        let mut mirrored = IntervalSet::default();
        pair[0].found.touched.all(0).parts().iter().for_each(|(from, to)| mirrored.insert(length - to, length - from));
        let other = pair[1].found.touched.all(0);
        assert_eq!(mirrored.parts().len(), other.parts().len());
        for (one, other) in mirrored.parts().iter().zip(other.parts()) {
            assert!((one.0 - other.0).abs().max((one.1 - other.1).abs()) < 1e-8);
        }
    }
}

#[test]
fn scans_that_cannot_be_are_refused() {
    let refused = |distances: &[f64], angles: &[f64]| {
        let grid = ReachGrid { distances: distances.to_vec(), angles: angles.to_vec(), step: 0.01 };
        reach(&rod(), &[o1()], &grid, &|_| true).unwrap_err().to_string()
    };
    assert_eq!(refused(&[], &[0.0]), "distances is empty, expected one value at least");
    assert_eq!(refused(&[1.0], &[0.0]), "distances has 1 m, expected more than 0 and less than the rod's length, 1 m");
    assert_eq!(refused(&[0.5], &[f64::NAN]), "angles has NaN rad, expected a finite angle");
    assert!(refused(&[0.5], &[-FRAC_PI_2]).starts_with("angles has -1.57"), "{}", refused(&[0.5], &[-FRAC_PI_2]));
    let floor = Composite::single(Parabola::new([0.0, 0.0], 0.0).unwrap()).unwrap();
    let grid = ReachGrid { distances: vec![0.5], angles: vec![0.25 * PI], step: 0.01 };
    assert!(matches!(reach(&rod(), &[floor], &grid, &|_| true), Err(PlanError::NoNearest { object: 0, .. })));
}

#[test]
fn the_work_ends_when_it_is_told_to() {
    let grid = ReachGrid { distances: vec![0.3; 40], angles: vec![FRAC_PI_2], step: 0.01 };
    let reach = reach(&rod(), &[circle(0.2)], &grid, &|done| done < 4).unwrap();
    assert!(reach.scans.len() < 80);
}

/// A scan of ten thousand states is not swept to its end.
#[test]
fn the_work_ends_within_a_scan() {
    let grid = ReachGrid { distances: vec![0.3], angles: vec![FRAC_PI_2], step: 1e-4 };
    let asked = AtomicUsize::new(0);
    let ended = reach(&rod(), &[circle(0.2)], &grid, &|_| asked.fetch_add(1, Ordering::Relaxed) < 5);
    assert!(ended.unwrap().scans.is_empty());
    // each of the two scans hears no at most once within, and once when it is done
    assert!(asked.load(Ordering::Relaxed) <= 9);
}
