//! Shapes that approximate another one give its scan, the better the finer they are, with the order of their theory.
//!
//! A contour that is off by `delta` along its normal changes the energy by force times delta, and the reactions, which are
//! the energy's derivatives by the clamp's pose, by the derivative of that. So a cubic spline through points h apart (position
//! h^4, angle h^3) gives the energy to order 4 and the reactions to order 3, a polygon (h^2, h) to orders 2 and 1.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test may, and its tables are there to be read"
)]

use crate::common::{Scene, UP};
use std::f64::consts::{PI, TAU};
use vibrissa::contact::Outcome;
use vibrissa::contour::{Frame, SplineEnd};
use vibrissa::{CircularArc, ClampPath, Composite, Contour, Parabola, Pose, Rod, Spline, State, Sweep};

/// Poses nearer than this to a transition are left out: on which side of it they are may differ.
const AWAY: f64 = 0.02;

fn sweep(contour: &Composite, from: f64, to: f64, y: f64, step: f64) -> Outcome {
    let pose = |x| Pose { x, y, phi: UP };
    let path = ClampPath::new(pose(from), pose(to)).unwrap();
    let outcome = Sweep::new(&Rod::new(1.0, 1.0).unwrap(), contour, path, step).unwrap().run();
    assert_eq!(outcome.stop, None);
    outcome
}

/// Differences in reactions and in energy between scans, as root mean squares over the poses away from the transitions of
/// `exact`: from pose to pose the error of a polygon goes up and down with the distance to the next vertex.
fn errors(found: &Outcome, exact: &Outcome) -> (f64, f64) {
    assert_eq!(found.states.len(), exact.states.len());
    let near = |state: &State| exact.events.iter().any(|event| (event.pose().x - state.pose.x).abs() < AWAY);
    let (mut reactions, mut energy, mut count) = (0.0, 0.0, 0.0);
    for (a, b) in found.states.iter().zip(&exact.states).filter(|(_, b)| !near(b) && !b.contacts.is_empty()) {
        assert_eq!(a.phase(), b.phase(), "at {}", b.pose.x);
        let (u, v) = (a.reactions, b.reactions);
        for (u, v) in [(u.f0x, v.f0x), (u.f0y, v.f0y), (u.m0z, v.m0z)] {
            reactions += ((u - v) / (1.0 + v.abs())).powi(2);
        }
        energy += ((a.energy - b.energy) / (1.0 + b.energy)).powi(2);
        count += 1.0;
    }
    (f64::sqrt(reactions / count), f64::sqrt(energy / count))
}

/// The order from the first to the last of errors at sizes each twice as fine as the one before.
fn order(errors: &[f64]) -> f64 {
    (errors[0] / errors[errors.len() - 1]).log2() / (errors.len() - 1) as f64
}

/// The two parabolas of O1, as far as the rod gets on them.
fn halves() -> [(Parabola, [f64; 2]); 2] {
    [(0.0, [-0.42, 0.15]), (0.3, [0.15, 0.72])].map(|(x, ends)| (Parabola::new([x, 0.0], 5.0).unwrap(), ends))
}

/// n + 1 points on a half, evenly spread along x, and the tangent angles at its ends.
fn points((half, [from, to]): &(Parabola, [f64; 2]), n: usize) -> (Vec<[f64; 2]>, [f64; 2]) {
    let at = |k: usize| half.frame(from + (to - from) * k as f64 / n as f64 - half.frame(0.0).x);
    let points = (0..=n).map(at).map(|Frame { x, y, .. }| [x, y]).collect();
    (points, [at(0).alpha, at(n).alpha])
}

fn splines(n: usize) -> Composite {
    let pieces = halves().map(|half| {
        let (points, [from, to]) = points(&half, n);
        let end = SplineEnd::Clamped { from: Some(from), to: Some(to) };
        Box::new(Spline::through(&points, end).unwrap()) as Box<dyn Contour>
    });
    Composite::new(pieces.into()).unwrap()
}

fn polygon(n: usize) -> Composite {
    let [(left, _), (right, _)] = halves().map(|half| points(&half, n));
    Composite::polyline(&[&left[..], &right[1..]].concat()).unwrap()
}

/// A table of errors, with the orders of reactions and energy.
fn table(what: &str, sizes: &[usize], exact: &Outcome, shape: impl Fn(usize) -> Outcome) -> [f64; 2] {
    println!("{what}\n     n   reactions      energy");
    let (mut reactions, mut energies) = (Vec::new(), Vec::new());
    for &n in sizes {
        let (reaction, energy) = errors(&shape(n), exact);
        println!("{n:6}  {reaction:10.2e}  {energy:10.2e}");
        reactions.push(reaction);
        energies.push(energy);
    }
    let orders = [order(&reactions), order(&energies)];
    println!(" order  {:10.2}  {:10.2}", orders[0], orders[1]);
    orders
}

#[test]
fn splines_through_the_parabolas_converge_to_their_scan() {
    let exact = Scene { step: 0.003, ..Scene::paper(0.0, 0.0, 0.4) }.run();
    let orders =
        table("splines through n + 1 points of either parabola of O1, q = 0.4", &[16, 32, 64, 128], &exact, |n| {
            sweep(&splines(n), 0.8, -1.0, -0.4, 0.003)
        });
    assert!((2.7..4.3).contains(&orders[0]), "{orders:?}");
    assert!((3.6..4.6).contains(&orders[1]), "{orders:?}");
}

#[test]
fn polygons_through_the_parabolas_converge_to_their_scan() {
    let exact = Scene { step: 0.003, ..Scene::paper(0.0, 0.0, 0.4) }.run();
    let orders =
        table("polygons through n + 1 points of either parabola of O1, q = 0.4", &[32, 64, 128, 256], &exact, |n| {
            sweep(&polygon(n), 0.8, -1.0, -0.4, 0.003)
        });
    assert!((0.7..1.5).contains(&orders[0]), "{orders:?}");
    assert!((1.7..2.4).contains(&orders[1]), "{orders:?}");
}

/// A circle as an arc, as a periodic spline, and as polygons up to one of 10^4 edges.
#[test]
fn a_circle_is_a_circle() {
    let (centre, radius) = ([0.0, 0.3], 0.25);
    let at = |k: usize, n: usize| {
        let (sin, cos) = (0.1 + TAU * k as f64 / n as f64).sin_cos();
        [centre[0] + radius * cos, centre[1] + radius * sin]
    };
    let points = |n: usize| (0..n).map(|k| at(k, n)).collect::<Vec<_>>();
    let arc = Composite::single(CircularArc::new(centre, radius, -0.5 * PI, 1.5 * PI).unwrap()).unwrap();
    assert!(arc.is_closed());
    // contact with the tip, tangentially, and with the tip again; the 10^4-gon on a part of the way
    let whole = |contour: &Composite| sweep(contour, 0.4, -0.8, -0.71, 0.003);
    let exact = whole(&arc);
    let spline = |n| Composite::single(Spline::through(&points(n), SplineEnd::Periodic).unwrap()).unwrap();
    let orders =
        table("a circle as a periodic spline through n points", &[16, 32, 64, 128], &exact, |n| whole(&spline(n)));
    assert!((2.7..4.5).contains(&orders[0]) && (3.6..4.6).contains(&orders[1]), "{orders:?}");
    let orders = table("a circle as a polygon of n edges", &[100, 200, 400, 800], &exact, |n| {
        whole(&Composite::polygon(&points(n)).unwrap())
    });
    assert!((0.7..1.5).contains(&orders[0]) && (1.7..2.4).contains(&orders[1]), "{orders:?}");

    let part = |contour: &Composite| sweep(contour, 0.3, 0.1, -0.71, 0.003);
    let (reactions, energy) = errors(&part(&Composite::polygon(&points(10_000)).unwrap()), &part(&arc));
    println!("a circle as a polygon of 10000 edges, a part of the way: {reactions:.1e}, {energy:.1e}");
    assert!(reactions < 1e-4 && energy < 1e-8);
}
