//! The change of a frame with each parameter of each shape, against differences of shapes whose parameter differs.

use proptest::prelude::*;
use rod_contours::{
    Bezier, CircularArc, Composite, Contour, EllipticArc, FrameRate, Line, Motion, Moved, Parabola, Range, Reversed,
    StretchKind, Trimmed, contract,
};

/// Step of the differences. With two of Richardson's extrapolations their error is about the sixth power of it over the
/// smallest length of the shape (0.3), and rounding over it.
const STEP: f64 = 1e-3;
/// Accepted error, relative to 1 + the rate.
const ERROR: f64 = 1e-9;

/// Central differences at h, h/2 and h/4, extrapolated to h = 0 by Romberg's table.
fn romberg(value: impl Fn(f64) -> [f64; 3]) -> [f64; 3] {
    let central = |h: f64| {
        let (up, down) = (value(h), value(-h));
        [0, 1, 2].map(|k| (up[k] - down[k]) / (2.0 * h))
    };
    let [coarse, middle, fine] = [1.0, 0.5, 0.25].map(|part| central(part * STEP));
    [0, 1, 2].map(|k| {
        let (first, second) = ((4.0 * middle[k] - coarse[k]) / 3.0, (4.0 * fine[k] - middle[k]) / 3.0);
        (16.0 * second - first) / 15.0
    })
}

/// What is wrong with the rates by the named parameters, whose changes `shape` takes in the same order.
fn check<C: Contour, const N: usize>(
    names: [&str; N],
    fractions: &[f64],
    shape: impl Fn([f64; N]) -> C,
) -> Result<(), TestCaseError> {
    let here = shape([0.0; N]);
    prop_assert_eq!(here.frame_rate(0.0, "no such parameter"), None);
    for fraction in fractions {
        let t = here.range().window(1.0).at(*fraction);
        for (k, name) in names.into_iter().enumerate() {
            contract::c13_frame_rate(&here, name, t).map_err(TestCaseError::fail)?;
            let FrameRate { x, y, alpha } = here.frame_rate(t, name).unwrap();
            let difference = romberg(|h| {
                let mut changes = [0.0; N];
                changes[k] = h;
                let frame = shape(changes).frame(t);
                [frame.x, frame.y, frame.alpha]
            });
            for (ours, expected) in [x, y, alpha].into_iter().zip(difference) {
                prop_assert!(
                    (ours - expected).abs() < ERROR * (1.0 + expected.abs()),
                    "{name} at {t}: {ours} {expected}"
                );
            }
        }
    }
    Ok(())
}

fn fractions() -> impl Strategy<Value = Vec<f64>> {
    proptest::collection::vec(0.0..=1.0, 4)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]

    #[test]
    fn parabolas(c in -3.0..3.0, fractions in fractions()) {
        let names = ["vertex_x", "vertex_y", "coefficient"];
        check(names, &fractions, |[x, y, d]| Parabola::new([0.1 + x, -0.2 + y], c + d).unwrap())?;
        let part = Range { from: -0.3, to: 0.8 };
        check(names, &fractions, |[x, y, d]| {
            Reversed::new(Trimmed::new(Parabola::new([0.1 + x, -0.2 + y], c + d).unwrap(), part).unwrap())
        })?;
    }

    #[test]
    fn arcs(radius in 0.3..3.0, from in -3.0..3.0, turn in prop_oneof![0.1..6.0, -6.0..-0.1], fractions in fractions()) {
        check(["center_x", "center_y", "radius"], &fractions, |[x, y, r]| {
            CircularArc::new([0.1 + x, y], radius + r, from, from + turn).unwrap()
        })?;
        let names = ["center_x", "center_y", "first_radius", "second_radius", "rotation"];
        check(names, &fractions, |[x, y, a, b, phi]| {
            EllipticArc::new([x, 0.3 + y], [radius + a, 0.7 + b], 0.4 + phi, from, from + turn).unwrap()
        })?;
    }

    #[test]
    fn lines(dx in 0.5..2.0, dy in -2.0..2.0, fractions in fractions()) {
        check(["from_x", "from_y", "to_x", "to_y"], &fractions, |[a, b, c, d]| {
            Line::new([0.2 + a, 0.1 + b], [0.2 + dx + c, 0.1 + dy + d]).unwrap()
        })?;
    }

    #[test]
    fn curves(bend in -1.0..1.0, fractions in fractions()) {
        let names = ["x0", "y0", "x1", "y1", "x2", "y2", "x3", "y3"];
        check(names, &fractions, |[a, b, c, d, e, f, g, h]| {
            Bezier::new([[a, b], [0.4 + c, bend + d], [1.1 + e, 0.6 + f], [1.7 + g, h]]).unwrap()
        })?;
    }

    #[test]
    fn moved_shapes(rotation in -3.0..3.0, scale in 0.4..2.0, mirror: bool, fractions in fractions()) {
        let names = ["rotation", "translation_x", "translation_y", "scale", "coefficient", "vertex_x"];
        check(names, &fractions, |[phi, x, y, s, c, vx]| {
            let shape = Parabola::new([0.3 + vx, 0.1], 1.5 + c).unwrap();
            let motion = Motion { rotation: rotation + phi, translation: [x, 0.2 + y], scale: scale + s, mirror };
            Moved::new(shape, motion).unwrap()
        })?;
    }

    /// Vertices of joined parabolas, and where they are on both.
    #[test]
    fn vertices(c in 0.6..3.0, height in -0.05..0.05, name in prop_oneof![Just(0), Just(1), Just(2)], piece in 0..2_usize) {
        let joined = |change: f64| {
            let pieces = [[0.0, 0.0, c], [0.5, height, 1.3]].into_iter().enumerate().map(|(number, mut p)| {
                p[name] += if number == piece { change } else { 0.0 };
                Box::new(Parabola::new([p[0], p[1]], p[2]).unwrap()) as Box<dyn Contour>
            });
            Composite::joined(pieces.collect()).unwrap()
        };
        let (here, parameter) = (joined(0.0), ["vertex_x", "vertex_y", "coefficient"][name]);
        let notch = here.find(StretchKind::Notch { before: 0 }).unwrap();
        let point = here.own_frame_rate(notch, 0.1, piece, parameter).unwrap();
        let ends = [(0, true), (2, false)];
        let expected = romberg(|change| {
            let at = joined(change).own_frame(notch, 0.0);
            [at.x, at.y, 0.0]
        });
        let borders = romberg(|change| {
            let other = joined(change);
            let [first, second] = ends.map(|(stretch, upper)| {
                let range = other.own_range(stretch);
                if upper { range.to } else { range.from }
            });
            [first, second, 0.0]
        });
        let turns = romberg(|change| {
            let other = joined(change);
            let turn = other.own_range(notch).to;
            // a joint of its own begins at 0; here both ends move
            [other.own_frame(notch, 0.0).alpha, other.own_frame(notch, turn).alpha, 0.0]
        });
        let ours = ends.map(|(stretch, upper)| here.own_border_rate(stretch, upper, piece, parameter).unwrap());
        // down a notch alpha falls by 1 per unit
        let angles = [false, true].map(|upper| -here.own_border_rate(notch, upper, piece, parameter).unwrap());
        let all = [(point.x, expected[0]), (point.y, expected[1]), (ours[0], borders[0]), (ours[1], borders[1]),
            (angles[0], turns[0]), (angles[1], turns[1])];
        for (ours, expected) in all {
            prop_assert!((ours - expected).abs() < 1e-7 * (1.0 + expected.abs()), "{parameter} of {piece}: {all:?}");
        }
        prop_assert_eq!(here.own_border_rate(0, false, piece, parameter), None);
        prop_assert_eq!(here.own_frame_rate(0, 0.0, 2, parameter), None);
    }
}
