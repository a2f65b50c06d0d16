//! How near to each cliff of the problem the solver still works, how exact it is there, and what it says beyond.
//!
//! docs/stability.md holds the table; this prints it:
//! `cargo test --test suite hard_cases -- --nocapture --test-threads 1`
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test may, and its tables are there to be read"
)]

use crate::hard::exact::{Problem, Shape};
use crate::hard::made::{By, left, lying, right, with_tip};
use crate::hard::measure::{Measure, of_state};
use crate::hard::table::{check, powers, show, summary, towards};
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use vibrissa::contact::{Contact, ContactError, ContactKind, EventKind, Outcome, StopReason};
use vibrissa::contour::ContourError;
use vibrissa::rod::{RodError, SolveStatus, find_root};
use vibrissa::{CircularArc, ClampPath, Composite, Contour, Line, Parabola, Pose, Rod, State, Sweep, equilibrium};

/// Solved down to `last`.
fn assert_solved(rows: &[(f64, Measure)], last: f64) {
    let broken = rows.iter().find(|(value, measure)| *value >= last && !measure.status.is_solved());
    assert!(broken.is_none(), "{broken:?}");
}

/// Not called solved from `first` on.
fn assert_refused(rows: &[(f64, Measure)], first: f64) {
    let wrong = rows.iter().find(|(value, measure)| *value <= first && measure.status.is_solved());
    assert!(wrong.is_none(), "{wrong:?}");
}

#[test]
fn force_towards_zero() {
    let tip = towards("f, tip", powers(-2, -16), |f| with_tip(&[], f, 0.4, By::Bend(5.0)), |f| 1e-3 * f);
    let alone = towards("f, tangential", powers(-2, -16), |f| lying(&[left(0.8, f, By::Bend(5.0))]), |f| 1e-3 * f);
    let two = |f| lying(&[left(0.4, f, By::Bend(5.0)), left(0.9, 2.0, By::Bend(5.0))]);
    let two = towards("f, one of two", powers(-2, -16), two, |_| 1e-4);
    [tip, alone, two].iter().for_each(|rows| assert_solved(rows, 0.0));
}

#[test]
fn contact_towards_the_ends() {
    let tip = towards("1 - s", powers(-2, -16), |e| lying(&[left(1.0 - e, 2.0, By::Bend(5.0))]), |_| 1e-4);
    assert_solved(&tip, 0.0);
    let clamp = towards("s", powers(-1, -8), |e| lying(&[left(e, 2.0, By::Bend(5.0))]), |e| 1e-3 * e);
    assert_solved(&clamp, 0.9e-4);
    assert_refused(&clamp, 1.1e-6);
}

#[test]
fn contacts_merging() {
    let merge = |by| move |e: f64| lying(&[left(0.6 - e, 2.0, by), left(0.6, 1.0, by)]);
    for (case, by) in [("two on a curve", By::Bend(5.0)), ("two vertices", By::Vertex)] {
        let rows = towards(case, powers(-1, -10), merge(by), |e| 1e-2 * e * e);
        assert_solved(&rows, 0.9e-4);
        assert_refused(&rows, 1.1e-8);
    }
    let beside = |e: f64| with_tip(&[left(1.0 - e, 1.0, By::Bend(0.0))], 2.0, 0.4, By::Bend(0.0));
    assert_solved(&towards("tip and one before it", powers(-1, -10), beside, |e| 1e-2 * e * e), 0.0);
}

/// How far the tip is turned beyond the contour: a force that no contact has, for the rod would be inside. Only so does the
/// first integral kappa^2 / 2 - (A sin phi - B cos phi) become positive.
const BEYOND: f64 = -0.5;

/// The tip's force and that of a contact `apart` before it, against it: a couple but for the part `rest` of the force, so
/// that the rod before runs in a circle where that is 0. The separatrix, where the first integral is P, is at `rest` = sin
/// 0.5.
fn couple(apart: f64, rest: f64) -> (Problem, Vec<f64>) {
    // the contact's direction is that of the tip's force
    let angle = |c: f64| {
        let (_, u) = with_tip(&[right(0.0, c, By::Bend(0.0))], c, BEYOND, By::Vertex);
        let (problem, _) = with_tip(&[], c, BEYOND, By::Vertex);
        Ok(problem.clamp.phi - u[3])
    };
    let force = find_root("angle", angle, 0.1, 3.0, 0.0).unwrap().at / (apart * apart);
    let by = By::Bend(0.0);
    with_tip(&[right(1.0 - apart, force * (1.0 - rest), by)], force, BEYOND, By::Vertex)
}

#[test]
fn circle() {
    assert_solved(&towards("P, circle", powers(-1, -16).chain([0.0]), |e| couple(0.4, e), |_| 1e-4), 0.0);
}

#[test]
fn separatrix() {
    for (case, side) in [("off the separatrix, outside", 1.0), ("off the separatrix, inside", -1.0)] {
        let beside = |e: f64| couple(0.4, 0.5_f64.sin() * (1.0 + side * e));
        assert_solved(&towards(case, powers(-1, -16).chain([0.0]), beside, |_| 1e-4), 0.0);
    }
}

/// The tip pushed along the rod, but for an angle: bent by that angle only, at Euler's load.
#[test]
fn column() {
    let euler = PI * PI / 4.0;
    let make = |e: f64| with_tip(&[], euler * (1.0 + e * e), FRAC_PI_2 - e, By::Bend(0.0));
    let rows = towards("bend of a column", powers(-1, -9).chain([0.0]), make, |e| 1e-4 * e);
    assert_solved(&rows, 0.9e-6);
    assert_refused(&rows, 1.1e-7);
}

#[test]
fn coils() {
    let lengths = [0.4, 0.2, 0.1, 0.05, 0.02, 0.01, 0.005, 0.002, 0.001];
    let rows = towards("coils", lengths.into_iter(), |apart| couple(apart, 0.1), |e| 1e-4 * e * e);
    assert_solved(&rows, 0.0);
    let (problem, u) = couple(0.001, 0.1);
    let turns = (problem.clamp.phi - u[5]).abs() / TAU;
    println!("coils: {turns:.0} turns");
    assert!(turns > 50.0);
}

#[test]
fn curvatures() {
    let off = |k: f64| 1e-4 / (1.0 + k);
    let values = || powers(6, -6).chain([0.0]);
    assert_solved(&towards("curvature, tangential", values(), |k| lying(&[left(0.8, 2.0, By::Bend(k))]), off), 0.0);
    assert_solved(&towards("curvature, tip", values(), |k| with_tip(&[], 2.0, 0.4, By::Bend(k)), off), 0.0);
}

#[test]
fn vertices_and_notches() {
    let vertex = towards("f on a vertex", powers(2, -16), |f| lying(&[left(0.8, f, By::Vertex)]), |f| 1e-4 * f);
    assert_solved(&vertex, 0.0);
    let notch = towards("f in a notch", powers(0, -16), |f| with_tip(&[], f, 0.4, By::Vertex), |f| 1e-4 * f);
    assert_solved(&notch, 0.09);
    assert_refused(&notch, 1.1e-5);
}

/// Most that a tolerance of 1e-13 leaves: what has converged is corrected once more, and what is measured is not only the
/// unknowns.
const TOLERANCE_LEAVES: f64 = 5e-13;

/// Coefficient of the parabolas.
const STEEP: f64 = 5.0;

fn rod() -> Rod {
    Rod::new(1.0, 1.0).unwrap()
}

/// Two parabolas y = 5 (x - v)^2, v = 0 and 0.3, and where a contact is on them.
fn bumps() -> Composite {
    let bump = |x| Box::new(Parabola::new([x, 0.0], STEEP).unwrap()) as Box<dyn Contour>;
    Composite::joined(vec![bump(0.0), bump(0.3)]).unwrap()
}

fn on_bump(contact: &Contact) -> (Shape, f64) {
    let x = [0.0, 0.3][contact.piece];
    (Shape::Bend { vertex: [x, 0.0], angle: 0.0, curvature: 2.0 * STEEP }, contact.x - x)
}

/// An upright clamp at a distance of 0.4.
fn up(x: f64) -> Pose {
    Pose { x, y: -0.4, phi: FRAC_PI_2 }
}

fn swept(contour: &Composite, from: Pose, to: Pose, step: f64) -> Outcome {
    Sweep::new(&rod(), contour, ClampPath::new(from, to).unwrap(), step).unwrap().run()
}

/// What a sweep reports `d` beyond a transition at `x`.
fn beyond(contour: &Composite, x: f64, d: f64) -> State {
    let (from, to) = (up(0.8), up(x - d));
    let length = ClampPath::new(from, to).unwrap().length();
    let outcome = swept(contour, from, to, length);
    assert_eq!((outcome.states.len(), &outcome.stop), (2, &None), "{d:e}");
    outcome.states[1].clone()
}

#[test]
fn sweeps_just_beyond_a_transition() {
    let contour = bumps();
    let events = swept(&contour, up(0.8), up(-0.9), 0.01).events;
    for event in events.iter().take(6) {
        let case = format!("sweep beyond {} {}", event.from(), event.to());
        let rows: Vec<_> = powers(-2, -14)
            .filter_map(|d| {
                let state = beyond(&contour, event.pose().x, d);
                // the pose itself is a double: the nearest are 1e-16 apart
                if d > 1e-12 {
                    assert_eq!(state.phase(), event.to(), "{case} {d:e}");
                }
                (!state.contacts.is_empty()).then(|| (d, of_state(&state, SolveStatus::Converged, on_bump)))
            })
            .collect();
        rows.iter().for_each(|(d, m)| show(&case, *d, m));
        summary(&case, &rows);
        assert!(rows.iter().all(|(_, m)| m.forward < TOLERANCE_LEAVES), "{case}");
    }
}

#[test]
fn folds() {
    let contour = bumps();
    let events = swept(&contour, up(0.8), up(-0.9), 0.01).events;
    let fold = events.last().unwrap();
    assert_eq!(fold.kind, EventKind::SnapOff);
    let (x, guess) = (fold.pose().x, &fold.before.contacts);
    let at = |d: f64| {
        let found = equilibrium(&rod(), &contour, up(x + d), guess).unwrap();
        (d, of_state(&found.state, found.report.status, on_bump))
    };
    let rows: Vec<_> = powers(-2, -15).map(at).collect();
    rows.iter().for_each(|(d, m)| show("fold, before", *d, m));
    summary("distance to a fold", &rows);
    rows.iter().for_each(|(d, m)| check("fold", *d, m));
    assert_solved(&rows, 0.9e-12);
    let rows: Vec<_> = powers(-2, -15).map(|d| at(-d)).collect();
    rows.iter().for_each(|(d, m)| show("fold, beyond", *d, m));
    assert_refused(&rows, 0.0);
}

/// Largest difference of two states, forces relative to 1 + their size.
fn difference(a: &State, b: &State) -> f64 {
    assert_eq!(a.phase(), b.phase());
    let numbers = |s: &State| {
        let contacts = s.contacts.iter().flat_map(|c| [c.s, c.x, c.y, c.alpha, c.force]);
        [s.reactions.f0x, s.reactions.f0y, s.reactions.m0z].into_iter().chain(contacts).collect::<Vec<_>>()
    };
    numbers(a).iter().zip(numbers(b)).map(|(u, v)| (u - v).abs() / (1.0 + v.abs())).fold(0.0, f64::max)
}

/// Prints a row of what is compared with something else than the exact residual.
fn compared(case: &str, range: &str, forward: f64, states: &[State]) {
    let most = |f: fn(&State) -> f64| states.iter().map(f).fold(0.0, f64::max);
    let (residual, condition) = (most(|s| s.certificate.residual), most(|s| s.certificate.condition));
    println!("| {case} | {range} | {forward:.1e} | {residual:.1e} | {condition:.1e} |");
}

#[test]
fn a_hundred_thousand_pieces() {
    // an edge in one piece and in many
    let points = |n: u32| (0..=n).map(|i| [-1.0 + 2.0 * f64::from(i) / f64::from(n), 0.0]).collect::<Vec<_>>();
    let [one, many] = [1, 100_000].map(|n| Composite::polyline(&points(n)).unwrap());
    // the tip comes upon it 0.932 above the clamp
    let pose = |y| Pose { x: -0.5, y, phi: 1.2 };
    let run = |contour| swept(contour, pose(-0.94), pose(-0.9315), 5e-4);
    let (one, many) = (run(&one), run(&many));
    assert!(many.events.len() > 20, "{}", many.events.len());
    assert_eq!((&one.stop, &many.stop, one.states.len()), (&None, &None, many.states.len()));
    let off = one.states.iter().zip(&many.states).map(|(a, b)| difference(a, b)).fold(0.0, f64::max);
    compared("an edge in 1 and in 10^5 pieces", "10^5 pieces", off, &many.states);
    assert!(off < 1e-12, "{off:e}");
}

/// Where a contact on a polygon is: on a vertex, or on an edge through it.
fn on_polygon(contact: &Contact) -> (Shape, f64) {
    let at = [contact.x, contact.y];
    match contact.kind {
        ContactKind::Corner => (Shape::Vertex(at), contact.alpha),
        _ => (Shape::Bend { vertex: at, angle: contact.alpha, curvature: 0.0 }, 0.0),
    }
}

#[test]
fn corners_close_together() {
    let run = |d: f64| {
        let blunt = Composite::polygon(&[[0.0, 0.0], [d, 0.0], [0.5, 0.4], [-0.5, 0.4]]).unwrap();
        let pose = |y| Pose { x: -0.6, y, phi: 0.3 };
        swept(&blunt, pose(-0.5), pose(0.25), 0.01)
    };
    let mut rows = Vec::new();
    for d in powers(-1, -12) {
        let outcome = run(d);
        assert_eq!((outcome.stop, outcome.states.len()), (None, 76), "{d:e}");
        let touching = outcome.states.iter().filter(|state| !state.contacts.is_empty());
        rows.extend(touching.map(|state| (d, of_state(state, SolveStatus::Converged, on_polygon))));
    }
    summary("length of an edge between two corners", &rows);
    let worst = rows.iter().map(|(_, m)| m.forward).fold(0.0, f64::max);
    assert!(worst < TOLERANCE_LEAVES, "{worst:e}");
}

#[test]
fn long_steps() {
    let contour = bumps();
    let run = |step| swept(&contour, up(0.8), up(-0.95), step);
    let (usual, long) = (run(0.01), run(0.5));
    let off = long.states.iter().take(4).zip(usual.states.iter().step_by(50));
    let states = off.map(|(a, b)| difference(a, b)).fold(0.0, f64::max);
    let events =
        long.events.iter().zip(&usual.events).map(|(a, b)| (a.pose().x - b.pose().x).abs()).fold(0.0, f64::max);
    // the end of the path, too
    assert_eq!((long.states.len(), long.events.len()), (5, usual.events.len()));
    assert_eq!(long.states[4].pose.x, -0.95);
    compared("steps of 0.5 against 0.01", "any step", states.max(events), &long.states);
    assert!(states.max(events) < 1e-11, "{states:e} {events:e}");
}

#[test]
fn clamp_angles_all_around() {
    let disc = Composite::single(CircularArc::new([0.0, 0.0], 0.2, 0.0, 2.0 * PI).unwrap()).unwrap();
    assert!(disc.is_closed());
    let at = |turn: f64, d: f64, phi: f64| {
        let (sin, cos) = turn.sin_cos();
        Pose { x: -0.6 * cos + d * sin, y: -0.6 * sin - d * cos, phi: phi + turn }
    };
    // from beside the disc towards it
    let run = |turn: f64| swept(&disc, at(turn, 0.5, 0.0), at(turn, 0.05, 0.0), 0.01);
    let straight = run(0.0);
    let (mut off, mut states) = (0.0_f64, Vec::new());
    for degrees in (-180..=180).step_by(15) {
        let turn = f64::from(degrees).to_radians();
        let turned = run(turn);
        assert_eq!((turned.states.len(), &turned.stop), (straight.states.len(), &straight.stop), "{degrees}");
        let (sin, cos) = turn.sin_cos();
        for (a, b) in turned.states.iter().zip(&straight.states) {
            assert_eq!(a.phase(), b.phase(), "{degrees}");
            let (a, b) = (a.reactions, b.reactions);
            let back = [a.f0x * cos + a.f0y * sin, a.f0y * cos - a.f0x * sin, a.m0z];
            let part = back.iter().zip([b.f0x, b.f0y, b.m0z]).map(|(u, v)| (u - v).abs() / (1.0 + v.abs()));
            off = part.fold(off, f64::max);
        }
        states.extend(turned.states);
    }
    assert!(states.iter().any(|s| s.phase().contacts > 0));
    compared("a disc met at angles all around", "-180 to 180 degrees", off, &states);
    assert!(off < 1e-11, "{off:e}");
}

#[test]
fn starts_in_contact_and_inside() {
    let contour = Composite::single(Parabola::new([0.0, 0.0], STEEP).unwrap()).unwrap();
    let (mut off, mut states) = (0.0_f64, Vec::new());
    // brought there along the path, and started there
    let brought = swept(&contour, up(0.5), up(-0.3), 0.02);
    for state in &brought.states {
        let started = swept(&contour, state.pose, Pose { x: state.pose.x - 0.01, ..state.pose }, 0.01);
        off = off.max(difference(&started.states[0], state));
        states.push(started.states[0].clone());
    }
    compared("starts in contact", "as far as the branch goes", off, &states);
    assert!(off < 1e-10, "{off:e}");
    for depth in [1e-3, 0.1, 1.0, 10.0] {
        let pose = |depth| Pose { x: 0.0, y: depth, phi: FRAC_PI_2 };
        let inside = swept(&contour, pose(depth), pose(depth + 0.1), 0.1);
        assert_eq!((inside.stop.unwrap().reason, inside.states.len()), (StopReason::ClampInside, 0), "{depth}");
    }
}

#[test]
fn a_wire_that_yields() {
    // the paper's wire at a distance of 0.2 lengths
    let wire = Rod::from_diameter(0.1, 0.5e-3, 206e9).unwrap().with_yield_stress(2e9).unwrap();
    let bump = |x| Box::new(Parabola::new([x, 0.0], 50.0).unwrap()) as Box<dyn Contour>;
    let contour = Composite::joined(vec![bump(0.0), bump(0.03)]).unwrap();
    let pose = |x| Pose { x, y: -0.02, phi: FRAC_PI_2 };
    let outcome = Sweep::new(&wire, &contour, ClampPath::new(pose(0.08), pose(-0.1)).unwrap(), 1e-3).unwrap().run();
    assert_eq!(outcome.stop, None);
    // in phase B the first integral is 0, and kappa^2 = 2 P where the rod is most bent: where it runs along the force's normal
    let yielding = outcome.states.iter().filter(|s| s.max_stress > wire.yield_stress()).count();
    let most = outcome.states.iter().filter_map(|s| s.max_stress).fold(0.0, f64::max);
    let mut off = 0.0_f64;
    for state in outcome.states.iter().filter(|s| s.phase().contacts > 0) {
        let rod = state.elastica(&wire).unwrap();
        let sampled = rod.sample(20_001).map(|at| at.kappa.abs()).fold(0.0, f64::max);
        off = off.max((wire.bending_stress(sampled).unwrap() / state.max_stress.unwrap() - 1.0).abs());
    }
    compared("largest stress", "3.5 GPa and more", off, &outcome.states);
    println!("largest stress {most:.3e} Pa, {yielding} states beyond 2 GPa");
    assert!(most > 3.4e9 && most < 3.6e9 && yielding > 10 && off < 1e-7, "{most:e} {off:e}");
}

#[test]
fn what_the_default_tolerance_leaves() {
    let off = |value: f64| {
        move |u: &mut [f64]| u.iter_mut().enumerate().for_each(|(i, u)| *u += value * [1.0, -0.7, 0.4][i % 3])
    };
    let mut rows = Vec::new();
    for start in powers(-1, -8) {
        for (problem, mut u) in [
            lying(&[left(0.8, 1e-2, By::Bend(5.0))]),
            lying(&[left(0.8, 2.0, By::Bend(1.0))]),
            with_tip(&[], 2.0, 0.4, By::Bend(5.0)),
            lying(&[right(0.6, 2.0, By::Bend(5.0)), left(0.9, 2.0, By::Bend(5.0))]),
        ] {
            off(start)(&mut u);
            let measure = crate::hard::measure::solved(&problem, &mut u, 1e-13);
            rows.push((start, measure));
        }
    }
    rows.iter().for_each(|(d, m)| show("tolerance 1e-13", *d, m));
    summary("tolerance 1e-13", &rows);
    assert!(rows.iter().filter(|(_, m)| m.status.is_solved()).all(|(_, m)| m.forward < TOLERANCE_LEAVES));
}

#[test]
fn a_contact_set_that_is_not_the_right_one() {
    let contour = Composite::single(Parabola::new([0.0, 0.0], STEEP).unwrap()).unwrap();
    let guess = Contact {
        object: 0,
        piece: 0,
        kind: ContactKind::Tangent,
        s: 0.95,
        x: 0.3,
        y: 0.45,
        alpha: 1.2,
        force: 1.0,
        friction: None,
    };
    // the tip becomes tangent near x = 0.1514; beyond, a tangential contact would be off the rod
    for x in [0.152, 0.16, 0.2] {
        let found = equilibrium(&rod(), &contour, up(x), &[guess]).unwrap();
        assert!(found.report.status.is_solved() && found.state.contacts[0].s > 1.0, "{x}: {:?}", found.state);
        assert!(matches!(found.state.elastica(&rod()), Err(RodError::LoadOrder { .. })), "{x}");
    }
    let tip = Contact { kind: ContactKind::Tip, ..guess };
    for x in [0.1, 0.14, 0.15] {
        let found = equilibrium(&rod(), &contour, up(x), &[tip]).unwrap();
        assert!(
            found.report.status.is_solved() && found.state.certificate.min_gap.seen < -1e-6,
            "{x}: {:?}",
            found.state
        );
    }
    // the rod has gone by: it would have to be pulled
    let found = equilibrium(&rod(), &contour, up(0.6), &[tip]).unwrap();
    assert!(
        !found.report.status.is_solved() || found.state.certificate.min_force.is_some_and(|force| force < 0.0),
        "{:?}",
        found.state
    );
}

#[test]
fn what_is_no_rod() {
    for value in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        for rod in [Rod::new(value, 1.0), Rod::new(1.0, value), Rod::from_diameter(1.0, value, 1.0)] {
            assert!(matches!(rod, Err(RodError::NotPositive { .. })), "{value}");
        }
    }
    assert!(matches!(Rod::from_diameter(0.1, 0.11, 1.0), Err(RodError::TooThick { .. })));
    // the unit of force, E I / L^2, is no number
    for (length, stiffness) in [(1e-200, 1.0), (1e200, 1.0), (1e-310, 1e-310)] {
        assert!(matches!(Rod::new(length, stiffness), Err(RodError::NotPositive { .. })), "{length:e}");
    }
}

#[test]
fn what_is_no_path_and_no_step() {
    let (here, there) = (up(0.0), up(1.0));
    for value in [f64::NAN, f64::INFINITY] {
        let lost = Pose { x: value, ..there };
        assert!(matches!(ClampPath::new(here, lost), Err(ContactError::NotFinite { .. })));
        assert!(matches!(equilibrium(&rod(), &bumps(), lost, &[]), Err(ContactError::NotFinite { .. })));
    }
    let turned = Pose { phi: -180.0, ..there };
    assert_eq!(ClampPath::new(here, turned), Err(ContactError::Angle { what: "to.phi", value: -180.0 }));
    let refused = equilibrium(&rod(), &bumps(), turned, &[]);
    assert_eq!(refused.unwrap_err(), ContactError::Angle { what: "pose.phi", value: -180.0 });
    assert!(matches!(ClampPath::new(here, here), Err(ContactError::NoPath { .. })));
    let (contour, path) = (bumps(), ClampPath::new(here, there).unwrap());
    for step in [0.0, -0.1, f64::NAN, f64::INFINITY, 1e-16, 1e-300] {
        assert!(matches!(Sweep::new(&rod(), &contour, path, step), Err(ContactError::Step { .. })), "{step:e}");
    }
}

#[test]
fn what_is_no_contour() {
    assert!(matches!(Composite::new(Vec::new()), Err(ContourError::Empty)));
    assert!(matches!(Composite::polygon(&[]), Err(ContourError::TooFewPoints { .. })));
    for value in [f64::NAN, f64::INFINITY] {
        assert!(matches!(Parabola::new([value, 0.0], 1.0), Err(ContourError::NotFinite { .. })));
        assert!(matches!(Composite::polyline(&[[0.0, 0.0], [1.0, value]]), Err(ContourError::PointNotFinite { .. })));
    }
    assert!(matches!(Line::new([1.0, 1.0], [1.0, 1.0]), Err(ContourError::SamePoint { .. })));
    let bow = [[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]];
    assert!(matches!(Composite::polyline(&bow), Err(ContourError::Crosses { .. })));
    let eight = Composite::polygon(&bow);
    assert!(matches!(eight, Err(ContourError::Crosses { .. } | ContourError::Loops { .. })), "{eight:?}");
}

/// Each test is a row of the page, and each name on the page is a test.
#[test]
fn the_page_names_the_tests() {
    let (page, source) = (include_str!("../docs/stability.md"), include_str!("hard_cases.rs"));
    let tests = source.split("#[test]\nfn ").skip(1).filter_map(|rest| rest.split("()").next());
    for test in tests.filter(|test| *test != "the_page_names_the_tests") {
        assert!(page.contains(&format!("`{test}` |")), "{test}");
    }
    let rows = page.lines().filter(|line| line.starts_with("| ") && line.ends_with("` |"));
    for row in rows {
        let name = row.trim_end_matches("` |").rsplit('`').next().unwrap();
        assert!(source.contains(&format!("fn {name}()")), "{name}");
        assert!(!row.contains("|  |") && !row.contains("| |"), "an empty cell: {row}");
    }
}
