//! Shapes that break the contract are refused when a composite is made.
#![allow(clippy::unwrap_used)]

use std::f64::consts::{PI, TAU};

use rod_contours::{
    Bezier, Bounds, Closest, Composite, Contour, ContourError, Curve, DualNum, Frame, Graph, Line, Motion, Moved, Range,
};

/// What is wrong with an [`Ellipse`].
#[derive(Clone, Copy, Debug, PartialEq)]
enum Mistake {
    None,
    Speed,
    SlightlyWrongSpeed,
    Alpha,
    Turning,
    Wrapped,
    NotFinite,
    NotFiniteAtTheEnd,
    Standstill,
    Side,
    Parameter,
    Bounds,
    Curvature,
}

/// Seven eighths of an ellipse with half axes 2 and 1, far from the origin.
#[derive(Clone, Copy, Debug)]
struct Ellipse(Mistake);

impl Contour for Ellipse {
    fn frame(&self, t: f64) -> Frame {
        let (sin, cos) = t.sin_cos();
        let speed = (2.0 * sin).hypot(cos);
        let leans = (sin * cos).atan2(2.0 * sin * sin + cos * cos);
        let (alpha, turning) = (t + 0.5 * PI + leans, 2.0 / (speed * speed));
        let right = Frame { x: 50.0 + 2.0 * cos, y: sin, alpha, speed, turning };
        match self.0 {
            Mistake::Speed => Frame { speed: 1.0, ..right },
            Mistake::SlightlyWrongSpeed => Frame { speed: 1.01 * speed, ..right },
            Mistake::Alpha => Frame { alpha: alpha + PI, ..right },
            Mistake::Turning => Frame { turning: 1.0 / speed, ..right },
            Mistake::Wrapped => Frame { alpha: alpha.sin().atan2(alpha.cos()), ..right },
            Mistake::NotFinite => Frame { y: if cos > 0.0 { f64::NAN } else { sin }, ..right },
            Mistake::NotFiniteAtTheEnd if t >= self.range().to => Frame { alpha: f64::NAN, ..right },
            Mistake::Standstill => Frame { speed: 0.0, turning: 0.0, ..right },
            _ => right,
        }
    }

    fn range(&self) -> Range {
        Range { from: 0.1, to: 0.1 + 0.875 * TAU }
    }

    fn closest_in(&self, range: Range, x: f64, y: f64) -> Closest {
        let sketch = Graphless(*self).closest_in(range, x, y);
        match self.0 {
            Mistake::Side => Closest { gap: -sketch.gap, ..sketch },
            Mistake::Parameter => Closest { t: sketch.t + TAU, ..sketch },
            _ => sketch,
        }
    }

    fn bounds_in(&self, range: Range) -> Bounds {
        let right = Graphless(*self).bounds_in(range);
        if self.0 == Mistake::Bounds { Bounds { min: [49.0, -1.0], ..right } } else { right }
    }

    fn curvature_in(&self, _: Range) -> (f64, f64) {
        if self.0 == Mistake::Curvature { (0.5, 2.0) } else { (0.25, 2.0) }
    }
}

/// The frame of an ellipse alone.
#[derive(Debug)]
struct Graphless(Ellipse);

impl Contour for Graphless {
    fn frame(&self, t: f64) -> Frame {
        self.0.frame(t)
    }

    fn range(&self) -> Range {
        self.0.range()
    }
}

fn line_of(error: ContourError) -> (usize, u8) {
    let ContourError::Contract { piece, broken } = error else { unreachable!("{error}") };
    (piece, broken.line)
}

#[test]
fn mistakes_are_named_by_their_line() {
    assert!(Composite::single(Ellipse(Mistake::None)).is_ok());
    for (mistake, line) in [
        (Mistake::Speed, 2),
        (Mistake::SlightlyWrongSpeed, 2),
        (Mistake::Alpha, 2),
        (Mistake::Turning, 3),
        (Mistake::Wrapped, 3),
        (Mistake::NotFinite, 1),
        (Mistake::NotFiniteAtTheEnd, 1),
        (Mistake::Standstill, 4),
        (Mistake::Side, 7),
        (Mistake::Parameter, 5),
        (Mistake::Bounds, 9),
        (Mistake::Curvature, 11),
    ] {
        let shape = Ellipse(mistake);
        assert_eq!(line_of(Composite::single(shape).unwrap_err()), (1, line), "{mistake:?}");
        // Wrapped in shapes of the crate it is no better.
        let mirror = Motion { rotation: 0.6, mirror: true, ..Motion::IDENTITY };
        let moved = Moved::new(Box::new(shape) as Box<dyn Contour>, mirror).unwrap();
        let error = Composite::joined(vec![Box::new(Line::new([0.0, 0.0], [1.0, 0.0]).unwrap()), Box::new(moved)]);
        assert_eq!(line_of(error.unwrap_err()), (2, line), "{mistake:?}");
    }
}

#[test]
fn the_message_says_what_and_where() {
    let message = Composite::single(Ellipse(Mistake::Speed)).unwrap_err().to_string();
    assert!(
        message.starts_with("piece 1 breaks line 2 of the contract (dr/dt = speed (cos alpha, sin alpha)) at t = 0.26"),
        "{message}"
    );
    assert!(message.contains("but speed is 1.000000"), "{message}");
}

#[test]
fn wrong_derivatives_of_functions_are_refused() {
    let right = Graph::with_derivatives(Range::ALL, |x| [x * x, 2.0 * x, 2.0]).unwrap();
    assert!(Composite::single(right).is_ok());
    let wrong = Graph::with_derivatives(Range::ALL, |x| [x * x, x, 1.0]).unwrap();
    assert_eq!(line_of(Composite::single(wrong).unwrap_err()), (1, 2));
    let wrong = Graph::with_derivatives(Range::UNIT, |x| [x * x, 2.0 * x, -2.0]).unwrap();
    assert_eq!(line_of(Composite::single(wrong).unwrap_err()), (1, 3));
    let wrong = Curve::with_derivatives(Range::UNIT, |t| [[t, t * t], [1.0, t], [0.0, 1.0]]).unwrap();
    assert_eq!(line_of(Composite::single(wrong).unwrap_err()), (1, 2));
}

#[test]
fn shapes_that_are_hard_to_differentiate_pass() {
    for graph in [
        // Steep, wavy, tiny, huge, far away, with an end where the derivatives end.
        Graph::new(Range { from: -1.0, to: 1.0 }, |x| (x * 1e3).atan()),
        Graph::new(Range { from: 0.0, to: 1.0 }, |x| (x * 1e3).sin() * 1e-2),
        Graph::new(Range { from: 0.0, to: 1e-9 }, |x| x * x * 1e9),
        Graph::new(Range { from: 0.0, to: 1e9 }, |x| x * x * 1e-9),
        Graph::new(Range { from: 1e6, to: 1e6 + 1e-3 }, |x| (x * 1e3).sin()),
        Graph::new(Range { from: 1e-6, to: 1.0 }, |x| x.sqrt()),
        Graph::new(Range { from: -1.0, to: 1.0 }, |x| (x * x + 1e-8).sqrt()),
        Graph::new(Range { from: 0.0, to: f64::INFINITY }, |x| (x + 1.0).recip()),
    ] {
        let graph = graph.unwrap();
        let shape = format!("{graph:?}");
        assert!(Composite::single(graph.clone()).is_ok(), "{shape}: {:?}", Composite::single(graph).err());
    }
    // Values with noise in the tenth digit.
    let noisy = |x: f64| x * x + 1e-10 * (x * 1e9).sin();
    let graph = Graph::with_derivatives(Range::UNIT, move |x| [noisy(x), 2.0 * x, 2.0]).unwrap();
    assert!(Composite::single(graph).is_ok());
    // A coil of 40 turns that turns by more than a whole turn from one place to the next.
    let spiral = Curve::new(Range { from: 1.0, to: 250.0 }, |t| [t * t.cos(), t * t.sin()]).unwrap();
    assert!(Composite::single(spiral).is_ok());
}

#[test]
fn curves_that_cross_themselves_are_refused() {
    let crosses = |result: Result<Composite, ContourError>| {
        let error = result.unwrap_err();
        assert!(matches!(error, ContourError::Crosses { first: 1, second: 1, .. }), "{error}");
    };
    // A closed figure eight, a part of it that is open, and an open loop; a spiral does not cross itself.
    let eight = |from: f64, to: f64| Curve::new(Range { from, to }, |t| [t.sin(), (t * 2.0).sin() * 0.5]).unwrap();
    crosses(Composite::single(eight(0.0, TAU)));
    crosses(Composite::single(eight(-0.5, PI + 0.5)));
    assert!(Composite::single(eight(0.2, PI - 0.2)).is_ok());
    let cross = Bezier::new([[0.0, 0.0], [3.0, 2.0], [-2.0, 2.0], [1.0, 0.0]]).unwrap();
    crosses(Composite::single(cross));
    let round = Curve::new(Range { from: 0.0, to: TAU }, |t| [t.cos() * 2.0, t.sin()]).unwrap();
    assert!(Composite::single(round).unwrap().is_closed());
}
