//! Graphs and curves with limits: proven closest points, boxes and convex parts; limits that are wrong.
#![allow(clippy::unwrap_used)]

use std::f64::consts::{PI, TAU};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use proptest::collection::vec;
use proptest::prelude::*;
use rod_contours::{
    Composite, Contour, ContourError, Curve, DualNum, EllipticArc, Graph, Limits, Moved, Range, Reversed, contract,
};

/// The least and the largest value of a product of two intervals.
fn product(one: [f64; 2], two: [f64; 2]) -> (f64, f64) {
    let all = [one[0] * two[0], one[0] * two[1], one[1] * two[0], one[1] * two[1]];
    (all.iter().copied().fold(f64::INFINITY, f64::min), all.iter().copied().fold(f64::NEG_INFINITY, f64::max))
}

/// The values of the cosine between two angles.
fn cosines(part: Range) -> [f64; 2] {
    let (one, two) = (part.from.cos(), part.to.cos());
    let passes = |angle: f64| ((part.from - angle) / TAU).ceil() * TAU + angle <= part.to;
    let (low, high) = (one.min(two) - 1e-15, one.max(two) + 1e-15);
    [if passes(PI) { -1.0 } else { low }, if passes(0.0) { 1.0 } else { high }]
}

/// `y = height cos x`.
fn waves(height: f64, range: Range) -> Graph {
    Graph::new(range, move |x| x.cos() * height).unwrap().with_limits(wave_limits(height)).unwrap()
}

fn wave_limits(height: f64) -> impl Fn(Range) -> Limits + Send + Sync + 'static {
    move |part| {
        let [low, high] = cosines(part);
        let slope = cosines(Range { from: part.from - 0.5 * PI, to: part.to - 0.5 * PI });
        let steep = slope[0].abs().max(slope[1].abs());
        let flat = if slope[0] <= 0.0 && slope[1] >= 0.0 { 0.0 } else { slope[0].abs().min(slope[1].abs()) };
        let speeds = [flat, steep].map(|sine| (1.0 + (height * sine).powi(2)).sqrt());
        let stretch = [speeds[1].powi(-3), speeds[0].powi(-3)];
        Limits { speed: speeds[1] * (1.0 + 1e-15), curvature: product([-height * high, -height * low], stretch) }
    }
}

/// An ellipse by its eccentric angle.
fn ellipse(a: f64, b: f64, range: Range) -> Curve {
    let curve = Curve::new(range, move |t| [t.cos() * a, t.sin() * b]).unwrap();
    let limits = move |part: Range| {
        let [low, high] = cosines(Range { from: 2.0 * part.from, to: 2.0 * part.to });
        // a^2 sin^2 + b^2 cos^2 by the double angle.
        let square = |cos: f64| 0.5 * (a * a + b * b - (a * a - b * b) * cos);
        let (one, two) = (square(low), square(high));
        let (least, largest) = (one.min(two).max(a.min(b).powi(2)), one.max(two));
        let curvature = [largest, least].map(|square| a * b / square.powf(1.5));
        Limits {
            speed: largest.sqrt() * (1.0 + 1e-15),
            curvature: (curvature[0] * (1.0 - 1e-14), curvature[1] * (1.0 + 1e-14)),
        }
    };
    curve.with_limits(limits).unwrap()
}

/// The least distance by brute force.
fn brute_force(shape: &dyn Contour, part: Range, [x, y]: [f64; 2]) -> f64 {
    let distance = |t: f64| {
        let frame = shape.frame(t);
        (frame.x - x).hypot(frame.y - y)
    };
    let at = |sample: u32| part.at(f64::from(sample) / 4000.0);
    let nearest = (0..=4000).min_by(|&one, &two| distance(at(one)).total_cmp(&distance(at(two)))).unwrap();
    let (mut low, mut high) = (at(nearest.saturating_sub(1)), at((nearest + 1).min(4000)));
    for _ in 0..100 {
        let (left, right) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
        (low, high) = if distance(left) <= distance(right) { (low, right) } else { (left, high) };
    }
    distance(at(nearest)).min(distance(0.5 * (low + high)))
}

fn samples() -> impl Strategy<Value = Vec<f64>> {
    vec(0.0..=1.0, 4)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn closest_points_are_exact(
        height in 0.01..5.0, from in -3.0..3.0, length in 0.01..40.0, x in -10.0..50.0, y in -6.0..6.0,
        share in 0.0..1.0,
    ) {
        let range = Range { from, to: from + length };
        let shape = waves(height, range);
        for part in [range, Range { from: range.at(0.5 * share), to: range.at(0.5 + 0.5 * share) }] {
            let closest = shape.closest_in(part, x, y);
            let least = brute_force(&shape, part, [x, y]);
            prop_assert!(part.contains(closest.t));
            prop_assert!(closest.gap.abs() <= least + 1e-14 * (1.0 + least), "{closest:?} {least}");
            prop_assert!((closest.frame.x - x).hypot(closest.frame.y - y) >= closest.gap.abs() - 1e-13);
        }
    }

    #[test]
    fn curves_with_limits_are_the_shapes_they_are_of(
        a in 0.05..3.0, b in 0.05..3.0, from in -3.0..3.0, length in 0.1..TAU, x in -3.0..3.0, y in -3.0..3.0,
    ) {
        let range = Range { from, to: from + length };
        let (curve, arc) = (ellipse(a, b, range), EllipticArc::new([0.0; 2], [a, b], 0.0, from, from + length).unwrap());
        for [x, y] in [[x, y], [x, 0.0], [0.0, y], [0.0, 0.0]] {
            prop_assert!((curve.gap(x, y).abs() - arc.gap(x, y).abs()).abs() < 1e-14, "{x} {y}");
        }
        let inside = arc.bounds();
        let outside = curve.bounds().grown(1e-14);
        prop_assert!((0..2).all(|k| outside.min[k] <= inside.min[k] && outside.max[k] >= inside.max[k]));
        let half = Range { from, to: from + length.min(3.0) };
        prop_assert!(curve.is_convex(half));
    }

    #[test]
    fn graphs_with_limits_keep_the_contract(height in 0.01..3.0, from in -3.0..3.0, length in 0.5..20.0, samples in samples()) {
        let shape = waves(height, Range { from, to: from + length });
        contract::check(&shape, &samples).map_err(TestCaseError::fail)?;
        contract::check(&Reversed::new(shape), &samples).map_err(TestCaseError::fail)?;
    }
}

#[test]
fn cuts_and_convex_parts_are_those_of_the_function() {
    let shape = waves(2.0, Range { from: 0.0, to: 400.0 });
    // Many more inflections than samples of the default.
    let cuts = shape.cuts(shape.range());
    let inflections: Vec<f64> = (0..127).map(|k| (f64::from(k) + 0.5) * PI).collect();
    for inflection in &inflections {
        assert!(cuts.iter().any(|cut| (cut - inflection).abs() < 1e-9), "{inflection}");
    }
    for pair in cuts.windows(2) {
        let cell = Range { from: pair[0], to: pair[1] };
        assert!(shape.is_convex(cell), "{cell:?}");
    }
    assert!(!shape.is_convex(Range { from: 1.0, to: 2.0 }));
    // The narrow trough that 97 samples do not see.
    assert!((shape.gap(101.0 * PI, -3.0).abs() - 1.0).abs() < 1e-14);
}

#[test]
fn a_closest_point_takes_a_few_tens_of_parts() {
    let asked = Arc::new(AtomicUsize::new(0));
    let count = asked.clone();
    let limits = wave_limits(1.0);
    let graph = Graph::new(Range { from: 0.0, to: 10.0 }, |x| x.cos()).unwrap();
    let shape = graph.with_limits(move |part| {
        count.fetch_add(1, Ordering::Relaxed);
        limits(part)
    });
    let shape = shape.unwrap();
    asked.store(0, Ordering::Relaxed);
    for k in 0..1000 {
        shape.gap(f64::from(k) * 0.01, (f64::from(k) * 0.7).sin() * 2.0);
    }
    let mean = asked.load(Ordering::Relaxed) / 1000;
    assert!(mean < 60, "{mean}");
}

#[test]
fn all_points_of_a_circle_are_equally_near_its_centre() {
    let asked = Arc::new(AtomicUsize::new(0));
    let count = asked.clone();
    let circle = Curve::new(Range { from: 0.0, to: TAU }, |t| [t.cos(), t.sin()]).unwrap();
    let circle = circle
        .with_limits(move |_| {
            count.fetch_add(1, Ordering::Relaxed);
            Limits { speed: 1.0 + 1e-15, curvature: (1.0 - 1e-14, 1.0 + 1e-14) }
        })
        .unwrap();
    asked.store(0, Ordering::Relaxed);
    for off in [0.0, 1e-16, 1e-12, 1e-6, 1e-3, 0.1] {
        assert!((circle.gap(off, 0.3 * off).abs() - (1.0 - off.hypot(0.3 * off))).abs() < 1e-15, "{off}");
    }
    assert!(asked.load(Ordering::Relaxed) < 6000, "{asked:?}");
}

#[test]
fn wrong_limits_are_refused() {
    let graph = || Graph::new(Range { from: 0.0, to: 10.0 }, |x| x.cos()).unwrap();
    let message = |speed, curvature| graph().with_limits(move |_| Limits { speed, curvature }).unwrap_err().to_string();
    assert!(message(1.2, (-9.0, 9.0)).starts_with("the speed at t = "));
    assert!(message(1.5, (-0.9, 9.0)).starts_with("the curvature at t = 0 is -1, but the limit of the part"));
    assert!(message(1.5, (-9.0, 0.9)).contains("is 0.9; widen the limits"));
    assert!(message(f64::NAN, (-9.0, 9.0)).starts_with("the speed"));
    assert!(message(9.0, (f64::NAN, 9.0)).starts_with("the curvature"));
    let whole = Graph::new(Range::ALL, |x| x * x).unwrap();
    assert!(matches!(
        whole.with_limits(|_| Limits { speed: 1.0, curvature: (0.0, 2.0) }),
        Err(ContourError::NotFinite { .. })
    ));
    // Nothing known is not wrong.
    let shape = graph().with_limits(|_| Limits { speed: 1.5, curvature: (f64::NEG_INFINITY, f64::INFINITY) }).unwrap();
    assert!((shape.gap(2.0, 2.0).abs() - graph().gap(2.0, 2.0).abs()).abs() < 1e-13);
    assert!(!shape.is_convex(Range { from: 0.0, to: 1.0 }));
}

#[test]
fn limits_that_are_wrong_between_the_samples_break_line_11() {
    // Right, but for parts shorter than any that are checked.
    let lies = Graph::new(Range { from: 0.0, to: 10.0 }, |x| x.cos()).unwrap().with_limits(move |part| {
        let right = wave_limits(1.0)(part);
        if part.length() > 0.01 { right } else { Limits { curvature: (-2.0, -1.5), ..right } }
    });
    let error = contract::c11_curvature(&lies.unwrap(), Range { from: 3.0, to: 3.005 });
    assert!(error.is_err_and(|error| error.starts_with("11: ")));
}

#[test]
fn composites_and_wrappers_are_as_exact() {
    let shape = waves(1.0, Range { from: 0.0, to: 3.0 });
    let motion = rod_contours::Motion::scale(2.0);
    assert!(Moved::new(shape.clone(), motion).unwrap().closest_is_exact());
    assert!(Composite::new(vec![Box::new(shape)]).unwrap().closest_is_exact());
    let plain = Graph::new(Range::UNIT, |x| x * x).unwrap();
    assert!(!plain.closest_is_exact() && plain.curvature_in(Range::UNIT) == (f64::NEG_INFINITY, f64::INFINITY));
}
