//! What a closed form buys a shape: queries and a whole sweep with the shapes' own `closest_in`, `bounds_in`, `cuts` and
//! `is_convex`, and with the defaults of the trait.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a bench may, and it is there to be read")]

mod measure;

use measure::objects::{COEFFICIENT, OBJECTS, path, sweep};
use measure::{Random, Time, interleaved, is_timed};
use std::f64::consts::PI;
use std::hint::black_box;
use vibrissa::contour::{Bounds, Closest, Frame, Range};
use vibrissa::{CircularArc, Composite, Contour, EllipticArc, Graph, Line, Parabola};

/// Points a round, and rounds.
const POINTS: usize = 512;
const ROUNDS: usize = 60;

/// Which defaults a [`Hidden`] shape takes instead of its own methods.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Defaults {
    /// `cuts` alone.
    Cuts,
    /// `is_convex` alone.
    Convex,
    /// `closest_in` alone.
    Closest,
    /// All four, as a shape has that is its frame and its range.
    All,
}

/// A shape some of whose closed forms are hidden.
#[derive(Clone, Copy, Debug)]
struct Hidden<C>(C, Defaults);

/// A shape without methods of its own: a way to the trait's defaults.
#[derive(Debug)]
struct Bare<'a, C>(&'a C);

impl<C: Contour> Contour for Bare<'_, C> {
    fn frame(&self, t: f64) -> Frame {
        self.0.frame(t)
    }

    fn range(&self) -> Range {
        self.0.range()
    }
}

impl<C: Contour> Contour for Hidden<C> {
    fn frame(&self, t: f64) -> Frame {
        self.0.frame(t)
    }

    fn range(&self) -> Range {
        self.0.range()
    }

    fn closest_in(&self, range: Range, x: f64, y: f64) -> Closest {
        match self.1 {
            Defaults::Closest | Defaults::All => Bare(&self.0).closest_in(range, x, y),
            Defaults::Cuts | Defaults::Convex => self.0.closest_in(range, x, y),
        }
    }

    fn bounds_in(&self, range: Range) -> Bounds {
        if self.1 == Defaults::All { Bare(&self.0).bounds_in(range) } else { self.0.bounds_in(range) }
    }

    fn cuts(&self, range: Range) -> Vec<f64> {
        match self.1 {
            Defaults::Cuts | Defaults::All => Bare(&self.0).cuts(range),
            Defaults::Convex | Defaults::Closest => self.0.cuts(range),
        }
    }

    fn is_convex(&self, range: Range) -> bool {
        match self.1 {
            Defaults::Convex | Defaults::All => Bare(&self.0).is_convex(range),
            Defaults::Cuts | Defaults::Closest => self.0.is_convex(range),
        }
    }
}

/// Gaps of all the points.
fn gaps(shape: &dyn Contour, points: &[[f64; 2]]) -> usize {
    for &[x, y] in points {
        black_box(black_box(shape).gap(x, y));
    }
    points.len()
}

/// Gaps of all the points from an eighth of the shape, as of a part of a composite.
fn gaps_of_part(shape: &dyn Contour, points: &[[f64; 2]]) -> usize {
    let whole = shape.range();
    let part = Range { from: whole.at(0.25), to: whole.at(0.375) };
    for &[x, y] in points {
        black_box(black_box(shape).closest_in(part, x, y).gap);
    }
    points.len()
}

/// O1, its parabolas cut off beyond the reach of the rod.
fn object(dress: impl Fn(Parabola) -> Box<dyn Contour>) -> Composite {
    let [left, right] = OBJECTS[0].pieces().map(|whole| whole.between(-1.0, 1.0).unwrap());
    Composite::joined(vec![dress(left), dress(right)]).unwrap()
}

fn scan(contour: &Composite) -> usize {
    black_box(sweep(black_box(contour), path(0.4, 0.8, -0.9), 1000));
    1
}

fn main() {
    let mut random = Random(1);
    let points: Vec<[f64; 2]> = (0..POINTS).map(|_| [random.within(1.5), random.within(1.5)]).collect();
    let parabola = Parabola::new([0.0, 0.0], COEFFICIENT).unwrap().between(-1.0, 1.0).unwrap();
    let graph = Graph::new(parabola.range(), |x| x * x * COEFFICIENT).unwrap();
    let circle = CircularArc::new([0.0, 0.0], 1.0, 0.0, 1.5 * PI).unwrap();
    let ellipse = EllipticArc::new([0.0, 0.0], [1.0, 0.5], 0.0, 0.0, 1.5 * PI).unwrap();
    let line = Line::new([-1.0, 0.1], [1.0, -0.2]).unwrap();
    let shapes: [(&str, &dyn Contour, &dyn Contour); 4] = [
        ("line", &line, &Hidden(line, Defaults::All)),
        ("circular arc", &circle, &Hidden(circle, Defaults::All)),
        ("parabola", &parabola, &Hidden(parabola, Defaults::All)),
        ("elliptic arc", &ellipse, &Hidden(ellipse, Defaults::All)),
    ];
    for (name, closed, default) in shapes {
        for [x, y] in &points {
            let (one, two) = (closed.gap(*x, *y), default.gap(*x, *y));
            assert!((one.abs() - two.abs()).abs() < 1e-12, "{name} at ({x}, {y}): {one} {two}");
        }
    }
    if !is_timed() {
        return;
    }

    println!("Closest points, least of {ROUNDS} interleaved rounds: closed form, the defaults, their ratio");
    let report = |name: &str, [closed, default]: [Time; 2]| {
        let (one, two) = (closed.show(1e6, "us"), default.show(1e6, "us"));
        println!("  {name:30} {one} {two}   {}", default.over(&closed));
    };
    for (name, closed, default) in shapes {
        report(name, interleaved(ROUNDS, [&mut || gaps(closed, &points), &mut || gaps(default, &points)]));
        report(
            &format!("{name}, an eighth of it"),
            interleaved(ROUNDS, [&mut || gaps_of_part(closed, &points), &mut || gaps_of_part(default, &points)]),
        );
    }
    report(
        "parabola, as a Graph",
        interleaved(ROUNDS, [&mut || gaps(&parabola, &points), &mut || gaps(&graph, &points)]),
    );
    let bare = Hidden(ellipse, Defaults::All);
    let bounds = |shape: &dyn Contour| {
        black_box(black_box(shape).bounds());
        1
    };
    report("elliptic arc, bounds", interleaved(ROUNDS, [&mut || bounds(&ellipse), &mut || bounds(&bare)]));

    println!(
        "A full scan of O1 at q = 0.4, 1000 states, least of 10 interleaved rounds, and in scans with closed forms"
    );
    let closed = object(|shape| Box::new(shape));
    let hidden = [Defaults::Cuts, Defaults::Convex, Defaults::Closest, Defaults::All];
    let [cuts, convex, closest, all] = hidden.map(|which| object(move |shape| Box::new(Hidden(shape, which))));
    let graphs = object(|shape| {
        let Frame { x: x0, y: y0, .. } = shape.frame(0.0);
        let range = shape.range().shifted(x0);
        Box::new(Graph::new(range, move |x| (x - x0) * (x - x0) * COEFFICIENT + y0).unwrap())
    });
    let times: [Time; 6] = interleaved(
        10,
        [
            &mut || scan(&closed),
            &mut || scan(&cuts),
            &mut || scan(&convex),
            &mut || scan(&closest),
            &mut || scan(&all),
            &mut || scan(&graphs),
        ],
    );
    let names =
        ["closed forms", "default cuts", "default is_convex", "default closest_in", "all defaults", "as Graphs"];
    for (name, time) in names.iter().zip(&times) {
        println!("  {name:30} {}   {}", time.show(1e3, "ms"), time.over(&times[0]));
    }
}
