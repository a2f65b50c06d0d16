//! Contours without curvature where the rod meets them, and rods that lie down flat.
#![allow(clippy::unwrap_used)]

use std::f64::consts::{FRAC_PI_2, TAU};
use vibrissa::contact::Outcome;
use vibrissa::contour::{DualNum, Motion, Moved, Range};
use vibrissa::{ClampPath, Composite, Curve, Graph, Line, Pose, Rod, Sweep};

fn swept(contour: &Composite, from: [f64; 2], to: [f64; 2], phi: f64, step: f64) -> Outcome {
    let pose = |[x, y]: [f64; 2]| Pose { x, y, phi };
    let path = ClampPath::new(pose(from), pose(to)).unwrap();
    Sweep::new(&Rod::new(1.0, 1.0).unwrap(), contour, path, step).unwrap().run()
}

/// |x|^n + |y|^n = 1, turned.
fn superellipse(n: f64, turn: f64) -> Composite {
    let curve = Curve::new(Range { from: -0.3, to: TAU - 0.3 }, move |t| {
        let (sin, cos) = t.sin_cos();
        let power = |x: vibrissa::contour::Jet| (x * x).powf(0.5 * n);
        let r = (power(cos) + power(sin)).powf(-1.0 / n);
        [r * cos, r * sin]
    });
    let motion = Motion { rotation: turn, ..Motion::default() };
    Composite::single(Moved::new(curve.unwrap(), motion).unwrap()).unwrap()
}

/// A vertical rod meets the flat point of a superellipse: the way on is that of one turned by a millionth.
#[test]
fn a_flat_point_is_met() {
    for n in [4.0, 5.0, 6.0, 8.0] {
        let run = |turn| swept(&superellipse(n, turn), [1.2, -0.5], [0.9997, -0.5], FRAC_PI_2, 0.0001);
        let (flat, turned) = (run(0.0), run(1e-6));
        assert_eq!(flat.stop, None, "{n}");
        assert_eq!(turned.stop, None, "{n}");
        assert!((flat.events[0].pose().x - 1.0).abs() < 1e-8, "{n}");
        let (a, b) = (flat.states.last().unwrap(), turned.states.last().unwrap());
        assert_eq!(a.phase(), b.phase(), "{n}");
        // the contact of the turned one is (1e-6 / 4)^(1/3) L aside where they begin
        assert!((a.reactions.m0z - b.reactions.m0z).abs() < 1e-3, "{n}: {:?} {:?}", a.reactions, b.reactions);
    }
}

/// The same for the graph of x^4.
#[test]
fn a_flat_graph_is_met() {
    let quartic = || Graph::new(Range { from: -1.0, to: 1.0 }, |x| x.powi(4)).unwrap();
    let contour = Composite::single(quartic()).unwrap();
    let outcome = swept(&contour, [-0.5, -0.2], [-0.5, 0.03], 0.0, 0.01);
    assert_eq!(outcome.stop, None);
    assert!(outcome.events[0].pose().y.abs() < 1e-8);
    assert_eq!(outcome.states.last().unwrap().phase().to_string(), "B");
}

/// A rod that comes to lie flat on an edge goes on in the same way at every step.
#[test]
fn a_rod_lies_down_flat_alike_at_every_step() {
    let edge = Composite::single(Line::new([-2.0, 0.0], [2.0, 0.0]).unwrap()).unwrap();
    let ends: Vec<_> = [1.0, 0.999, 0.37, 0.125]
        .map(|part| swept(&edge, [0.0, -1.0], [0.0, -0.05], 0.9, 0.01 * part))
        .into_iter()
        .map(|outcome| {
            (
                outcome.stop.map(|stop| stop.reason),
                outcome.events.iter().map(|e| (e.kind, (e.pose().y * 1e9).round())).collect::<Vec<_>>(),
            )
        })
        .collect();
    assert_eq!((ends[0].0, ends[0].1.len()), (None, 2), "{ends:?}");
    assert!(ends.windows(2).all(|pair| pair[0] == pair[1]), "{ends:?}");
}
