//! The closed form of the parabola: right against brute force, exact near the contour, and never lost.
#![allow(clippy::unwrap_used)]

use rod_contours::{Contour, Parabola, Range};

/// Smallest distance over 100 000 samples.
fn brute_force(shape: &dyn Contour, part: Range, x: f64, y: f64) -> f64 {
    (0..=100_000)
        .map(|k| shape.frame(part.at(f64::from(k) / 1e5)))
        .map(|frame| (frame.x - x).hypot(frame.y - y))
        .fold(f64::INFINITY, f64::min)
}

#[test]
fn closest_points_against_brute_force() {
    let points = [[0.0, 0.3], [0.01, 2.0], [-0.4, 0.1], [0.3, -1.0], [1.5, 1.5], [-0.07, 0.11]];
    for c in [5.0, 0.3, -2.0, 0.0] {
        let whole = Parabola::new([0.0, 0.0], c).unwrap();
        let parts = [
            Range { from: -2.0, to: 2.0 },
            Range { from: -0.2, to: 0.9 },
            Range { from: 0.1, to: 0.4 },
            Range { from: -3.0, to: -0.25 },
        ];
        for part in parts {
            let shape = whole.between(part.from, part.to).unwrap();
            for [x, y] in points {
                let expected = brute_force(&shape, part, x, y);
                let gap = shape.gap(x, y).abs();
                assert!((gap - expected).abs() < 1e-4 * expected + 1e-4, "{c} {part:?} {x} {y}");
                assert!(gap <= expected + 1e-15, "{c} {part:?} {x} {y}: {gap} {expected}");
            }
        }
    }
}

#[test]
fn gaps_near_a_parabola_are_exact_to_rounding() {
    let shape = Parabola::new([0.1, 0.0], 5.0).unwrap();
    for k in -200..=200 {
        let frame = shape.frame(f64::from(k) * 0.005);
        let (nx, ny) = frame.normal();
        for gap in [0.0, 1e-15, 1e-12, -1e-9, 1e-6, 1e-3] {
            let found = shape.gap(frame.x - gap * nx, frame.y - gap * ny);
            let scale = frame.x.abs().max(frame.y.abs()).max(1.0);
            assert!((found - gap).abs() <= 4.0 * f64::EPSILON * scale, "{k}: {gap:e} {found:e}");
        }
    }
}

#[test]
fn extreme_parabolas_converge() {
    for c in [1e-12, 1e-6, 1e3, 1e8, -1e8] {
        let shape = Parabola::new([0.0, 0.0], c).unwrap();
        for x in [0.0, 1e-300, 1e-9, -0.3, 1e6] {
            for y in [0.0, -1e6, 0.5 / c, 0.5 / c * (1.0 + 1e-15), 1.0, 1e9] {
                let closest = shape.closest(x, y);
                let frame = closest.frame;
                let distance = (frame.x - x).hypot(frame.y - y);
                let scale = x.abs().max(y.abs()).max(distance);
                assert!((closest.gap.abs() - distance).abs() <= 1e-12 * scale, "{c} {x} {y} {closest:?}");
                // No worse than what is straight above or below, and than the vertex.
                assert!(closest.gap.abs() <= (y - c * x * x).abs() * (1.0 + 1e-12));
                assert!(closest.gap.abs() <= x.hypot(y) * (1.0 + 1e-12));
            }
        }
    }
    assert!(Parabola::new([0.0, 0.0], 1.0).unwrap().gap(f64::NAN, 0.0).is_nan());
}
