//! Every shape of the crate, and shapes that know only their frame, against the numbered contract of the trait.
#![allow(clippy::unwrap_used)]

use std::fmt;

use proptest::collection::vec;
use proptest::prelude::*;
use rod_contours::{Bounds, Closest, Composite, Contour, ContourError, Frame, Parabola, Range, contract};

/// A shape that is its frame and nothing else, so that everything else is the trait's default.
struct Sketch<F> {
    range: Range,
    frame: F,
}

impl<F> fmt::Debug for Sketch<F> {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "Sketch({:?})", self.range)
    }
}

impl<F: Fn(f64) -> Frame + Send + Sync> Contour for Sketch<F> {
    fn frame(&self, t: f64) -> Frame {
        (self.frame)(t)
    }

    fn range(&self) -> Range {
        self.range
    }
}

/// A circular arc by its angle from the lowest point; a negative radius has the solid outside.
fn arc(centre: [f64; 2], radius: f64, from: f64, to: f64) -> impl Contour {
    let sign = radius.signum();
    Sketch {
        range: Range { from, to },
        frame: move |t: f64| {
            let (sin, cos) = (sign * t).sin_cos();
            Frame {
                x: centre[0] + radius * sin,
                y: centre[1] - radius * cos,
                alpha: sign * t,
                speed: radius.abs(),
                turning: sign,
            }
        },
    }
}

fn coefficient() -> impl Strategy<Value = f64> {
    prop_oneof![4 => -20.0..20.0, 1 => Just(0.0), 1 => -1e-3..1e-3]
}

fn samples() -> impl Strategy<Value = Vec<f64>> {
    vec(prop_oneof![8 => 0.0..=1.0, 1 => Just(0.0), 1 => Just(1.0)], 6)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn parabolas(vx in -1.0..1.0, vy in -1.0..1.0, c in coefficient(), samples in samples()) {
        let shape = Parabola::new([vx, vy], c).unwrap();
        contract::check(&shape, &samples).map_err(TestCaseError::fail)?;
    }

    #[test]
    fn trimmed_parabolas(c in coefficient(), from in -2.0..2.0, length in 0.01..3.0, samples in samples()) {
        let shape = Parabola::new([0.3, -0.2], c).unwrap().between(from, from + length).unwrap();
        contract::check(&shape, &samples).map_err(TestCaseError::fail)?;
    }

    #[test]
    fn parabolas_with_one_end(c in coefficient(), end in -2.0..2.0, left: bool, samples in samples()) {
        let whole = Parabola::new([0.3, -0.2], c).unwrap();
        let shape = if left { whole.between(f64::NEG_INFINITY, end) } else { whole.between(end, f64::INFINITY) };
        contract::check(&shape.unwrap(), &samples).map_err(TestCaseError::fail)?;
    }

    #[test]
    fn joined_parabolas(
        c in 0.5..10.0,
        steps in vec((0.1..0.5, -0.02..0.02), 1..4),
        samples in samples(),
    ) {
        let mut vertex = [0.0, 0.0];
        let mut pieces: Vec<Box<dyn Contour>> = vec![Box::new(Parabola::new(vertex, c).unwrap())];
        for (dx, dy) in steps {
            vertex = [vertex[0] + dx, vertex[1] + dy];
            pieces.push(Box::new(Parabola::new(vertex, c).unwrap()));
        }
        let count = pieces.len();
        match Composite::joined(pieces) {
            Ok(object) => {
                prop_assert_eq!(object.pieces(), count);
                prop_assert_eq!(object.stretches().len(), 2 * count - 1);
                contract::check(&object, &samples).map_err(TestCaseError::fail)?;
            }
            // Equal parabolas always cross; a high one between two low ones is hidden.
            Err(error) => prop_assert!(matches!(error, ContourError::Hidden { .. }), "{}", error),
        }
    }

    #[test]
    fn chains_of_corners_and_notches(slopes in vec((-3.0..3.0, -3.0..3.0), 2..6), samples in samples()) {
        // Pieces of width 1 with a given slope at either end.
        let mut start = [0.0, 0.0];
        let mut pieces: Vec<Box<dyn Contour>> = Vec::new();
        for (first, last) in slopes {
            let c: f64 = 0.5 * (last - first);
            prop_assume!(c.abs() > 0.05);
            let behind = first / (2.0 * c);
            let vertex = [start[0] - behind, start[1] - c * behind * behind];
            pieces.push(Box::new(Parabola::new(vertex, c).unwrap().between(start[0], start[0] + 1.0).unwrap()));
            start = [start[0] + 1.0, start[1] + 0.5 * (first + last)];
        }
        let object = Composite::new(pieces).unwrap();
        contract::check(&object, &samples).map_err(TestCaseError::fail)?;
        // The same as a shape without a closed form, and as the single piece of another composite.
        let copy = Composite::single(Composite::single(object).unwrap()).unwrap();
        contract::check(&copy, &samples).map_err(TestCaseError::fail)?;
    }

    #[test]
    fn arcs_with_the_defaults(
        radius in prop_oneof![0.01..3.0, -3.0..-0.01],
        from in -3.0..3.0,
        length in 0.01..5.5,
        samples in samples(),
    ) {
        let shape = arc([0.2, -0.1], radius, from, from + length);
        contract::check(&shape, &samples).map_err(TestCaseError::fail)?;
    }

    #[test]
    fn the_default_search_finds_what_the_closed_form_does(
        c in -10.0..10.0, from in -1.0..0.5, length in 0.1..2.0, x in -3.0..3.0, y in -3.0..3.0,
    ) {
        let shape = Parabola::new([0.0, 0.0], c).unwrap().between(from, from + length).unwrap();
        let sketch = Sketch { range: shape.range(), frame: move |t| shape.frame(t) };
        let (closed, searched) = (shape.closest(x, y), sketch.closest(x, y));
        prop_assert!((closed.gap.abs() - searched.gap.abs()).abs() < 1e-13, "{closed:?} {searched:?}");
        let whole = Parabola::new([0.0, 0.0], c).unwrap();
        let sketch = Sketch { range: Range::ALL, frame: move |t| whole.frame(t) };
        prop_assert!((whole.gap(x, y) - sketch.gap(x, y)).abs() < 1e-13);
    }
}

/// What the contract says of a line that lies about itself.
fn complaint(lie: fn(&mut Frame, f64)) -> String {
    let shape = Sketch {
        range: Range::UNIT,
        frame: move |t: f64| {
            let mut frame = Frame { x: 2.0 * t, y: 1.0, alpha: 0.0, speed: 2.0, turning: 0.0 };
            lie(&mut frame, t);
            frame
        },
    };
    contract::check(&shape, &[0.1, 0.5, 0.9]).unwrap_err()
}

#[test]
fn lies_are_noticed_under_their_number() {
    assert!(complaint(|frame, t| frame.y = t).starts_with("2: "));
    assert!(complaint(|frame, _| frame.y = f64::NAN).starts_with("1: "));
    assert!(complaint(|frame, _| frame.speed = 1.0).starts_with("2: "));
    assert!(complaint(|frame, _| frame.alpha = 0.1).starts_with("2: "));
    assert!(complaint(|frame, _| frame.turning = 1.0).starts_with("3: "));
    assert!(complaint(|frame, t| frame.alpha = if t > 0.5 { std::f64::consts::TAU } else { 0.0 }).starts_with("3: "));
    assert!(complaint(|frame, _| (frame.x, frame.speed) = (0.0, 0.0)).starts_with("4: "));
}

/// A disc whose closed forms are wrong, each in its own way.
#[derive(Debug)]
struct Wrong(u8);

impl Contour for Wrong {
    fn frame(&self, t: f64) -> Frame {
        arc([0.0, 0.0], 1.0, 0.0, 1.0).frame(t)
    }

    fn closest_in(&self, range: Range, x: f64, y: f64) -> Closest {
        let right = arc([0.0, 0.0], 1.0, 0.0, 1.0).closest_in(range, x, y);
        let wrong = match self.0 {
            5 => 2.0 * right.gap,
            7 => -right.gap,
            _ => right.gap,
        };
        if self.0 == 6 {
            return Closest::new(0.5, self.frame(0.5), false, x, y);
        }
        Closest { gap: wrong, ..right }
    }

    fn bounds_in(&self, _: Range) -> Bounds {
        if self.0 == 9 { Bounds::EMPTY } else { Bounds::ALL }
    }
}

#[test]
fn wrong_closed_forms_are_noticed_under_their_number() {
    let shape = Wrong(0);
    contract::check(&shape, &[0.1, 0.9]).unwrap();
    assert!(contract::c5_foot(&Wrong(5), [0.3, -2.0]).is_err_and(|error| error.starts_with("5: ")));
    assert!(contract::c6_nearest(&Wrong(6), [0.0, -2.0]).is_err_and(|error| error.starts_with("6: ")));
    assert!(contract::c7_side(&Wrong(7), 0.4).is_err_and(|error| error.starts_with("7: ")));
    assert!(contract::c8_lipschitz(&Wrong(5), [0.3, -2.0], [0.3, -2.2]).is_err_and(|error| error.starts_with("8: ")));
    assert!(contract::c9_bounds(&Wrong(9), 0.4).is_err_and(|error| error.starts_with("9: ")));
}

/// The curve y = t^3 that says to be convex, from `from` to 1.
#[derive(Debug)]
struct Bent {
    from: f64,
}

impl Contour for Bent {
    fn frame(&self, t: f64) -> Frame {
        let slope = 3.0 * t * t;
        let speed = slope.hypot(1.0);
        Frame { x: t, y: t * t * t, alpha: slope.atan(), speed, turning: 6.0 * t / (speed * speed) }
    }

    fn range(&self) -> Range {
        Range { from: self.from, to: 1.0 }
    }

    fn is_convex(&self, _: Range) -> bool {
        true
    }
}

#[test]
fn what_bends_both_ways_is_not_convex() {
    contract::check(&Bent { from: 0.0 }, &[0.0, 0.4, 1.0]).unwrap();
    assert!(contract::check(&Bent { from: -1.0 }, &[0.6]).is_err_and(|error| error.starts_with("10: ")));
}
