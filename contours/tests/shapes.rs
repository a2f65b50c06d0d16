//! The shapes of the crate on random instances: the contract, closest points against brute force, rates against dual
//! numbers, cuts.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use proptest::collection::vec;
use proptest::prelude::*;
use rod_contours::{
    Bezier, CircularArc, Contour, Curve, DualNum, EllipticArc, Frame, Graph, Line, Motion, Moved, Parabola, Range,
    Reversed, Trimmed, contract,
};

/// Samples of brute force, before the nearest is refined between its neighbours.
const SAMPLES: usize = 4000;

fn samples() -> impl Strategy<Value = Vec<f64>> {
    vec(prop_oneof![8 => 0.0..=1.0, 1 => Just(0.0), 1 => Just(1.0)], 6)
}

/// A part of a range, as fractions of it.
fn part() -> impl Strategy<Value = (f64, f64)> {
    prop_oneof![1 => Just((0.0, 1.0)), 3 => (0.0..0.95, 0.001..1.0).prop_map(|(from, share): (f64, f64)| (from, from + share * (1.0 - from)))]
}

fn point() -> impl Strategy<Value = [f64; 2]> {
    [prop_oneof![9 => -3.0..3.0, 1 => Just(0.0)], prop_oneof![9 => -3.0..3.0, 1 => Just(0.0)]]
}

/// From one angle to another, either way round, sometimes a full turn.
fn angles() -> impl Strategy<Value = (f64, f64)> {
    (-10.0..10.0, prop_oneof![8 => -TAU..TAU, 1 => Just(TAU), 1 => Just(-TAU)])
        .prop_filter("an arc", |&(_, turn): &(f64, f64)| turn.abs() > 0.01)
        .prop_map(|(from, turn)| (from, from + turn))
}

/// Centre, radius and the arc.
fn circular() -> impl Strategy<Value = ([f64; 2], f64, CircularArc)> {
    (point(), 0.01..3.0, angles())
        .prop_map(|(center, radius, (from, to))| (center, radius, CircularArc::new(center, radius, from, to).unwrap()))
}

/// Centres and elliptic arcs with a ratio of the radii up to ten to the power of `exponent`.
fn elliptic(exponent: f64) -> impl Strategy<Value = ([f64; 2], EllipticArc)> {
    (point(), 0.1..2.0, -exponent..exponent, -4.0..4.0, angles()).prop_map(
        |(center, radius, exponent, rotation, (from, to)): (_, f64, f64, f64, _)| {
            let ratio = 10.0_f64.powf(-exponent.abs());
            let radii = if exponent > 0.0 { [radius, ratio * radius] } else { [ratio * radius, radius] };
            (center, EllipticArc::new(center, radii, rotation, from, to).unwrap())
        },
    )
}

fn control() -> impl Strategy<Value = [f64; 2]> {
    [-1.0..1.0, -1.0..1.0]
}

/// Bezier curves without turns so sharp that the differences of the contract would not resolve them.
fn bezier() -> impl Strategy<Value = Bezier> {
    bezier_points().prop_map(|points| Bezier::new(points).unwrap())
}

fn bezier_points() -> impl Strategy<Value = [[f64; 2]; 4]> {
    [control(), control(), control(), control()].prop_filter("a cusp or sharp turn", |points| {
        let is_mild = |curve: Bezier| (0..=100).all(|k| curve.frame(f64::from(k) / 100.0).turning.abs() < 100.0);
        Bezier::new(*points).is_ok_and(is_mild)
    })
}

/// Bezier curves that go only forward along their chord, and so neither cross themselves nor almost close.
fn forward_bezier() -> impl Strategy<Value = Bezier> {
    bezier().prop_filter("forward", |curve| {
        let [p, s] = [0.0, 1.0].map(|end| curve.frame(end));
        let angle = (s.y - p.y).atan2(s.x - p.x);
        (0..=100).all(|k| (curve.frame(f64::from(k) / 100.0).alpha - angle).cos() > 0.0)
    })
}

fn motion() -> impl Strategy<Value = Motion> {
    (-7.0..7.0, point(), 0.1..5.0, any::<bool>()).prop_map(|(rotation, translation, scale, mirror)| Motion {
        rotation,
        translation,
        scale,
        mirror,
    })
}

fn check(shape: &dyn Contour, samples: &[f64]) -> Result<(), TestCaseError> {
    contract::check(shape, samples).map_err(TestCaseError::fail)
}

/// The contract but for line 8, of curves whose ends come near each other: there both sides of an open curve meet.
fn check_apart(shape: &dyn Contour, samples: &[f64]) -> Result<(), TestCaseError> {
    for &sample in samples {
        let t = shape.range().at(sample);
        for line in [
            contract::c1_finite,
            contract::c2_velocity,
            contract::c3_turning,
            contract::c4_moving,
            contract::c7_side,
            contract::c9_bounds,
        ] {
            line(shape, t).map_err(TestCaseError::fail)?;
        }
        let frame = shape.frame(t);
        let (nx, ny) = frame.normal();
        for away in [-0.7, -0.03, -1e-6, 0.0, 1e-6, 0.03, 0.7] {
            let point = [frame.x + away * nx, frame.y + away * ny];
            contract::c5_foot(shape, point).map_err(TestCaseError::fail)?;
            contract::c6_nearest(shape, point).map_err(TestCaseError::fail)?;
        }
    }
    Ok(())
}

/// The least distance of the part of a shape from a point: all minima of many samples, refined by thirds between their
/// neighbours.
fn brute_force(shape: &dyn Contour, part: Range, [x, y]: [f64; 2]) -> f64 {
    let distance = |t: f64| {
        let frame = shape.frame(t);
        (frame.x - x).hypot(frame.y - y)
    };
    let at = |sample: usize| part.at(sample as f64 / SAMPLES as f64);
    let distances: Vec<f64> = (0..=SAMPLES).map(|sample| distance(at(sample))).collect();
    let mut least = distances.iter().copied().fold(f64::INFINITY, f64::min);
    for sample in 0..=SAMPLES {
        let (before, after) = (sample.saturating_sub(1), (sample + 1).min(SAMPLES));
        let minimum = distances[sample] <= distances[before] && distances[sample] <= distances[after];
        if !minimum || distances[sample] > least * 1.1 + 0.01 {
            continue;
        }
        let (mut low, mut high) = (at(before), at(after));
        for _ in 0..60 {
            let (left, right) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
            if distance(left) <= distance(right) {
                high = right;
            } else {
                low = left;
            }
        }
        least = least.min(distance(0.5 * (low + high)));
    }
    least
}

/// The closest point of a part: as near as brute force finds, within the part, as far away as its gap says.
fn nearest(shape: &dyn Contour, (from, to): (f64, f64), point: [f64; 2]) -> Result<(), TestCaseError> {
    let range = shape.range();
    let part = Range { from: range.at(from), to: range.at(to) };
    let closest = shape.closest_in(part, point[0], point[1]);
    let least = brute_force(shape, part, point);
    prop_assert!(part.contains(closest.t), "{closest:?} outside {part:?}");
    prop_assert!((closest.gap.abs() - least).abs() < 1e-13, "{least} in {part:?}, but {closest:?}");
    prop_assert_eq!(closest.frame, shape.frame(closest.t));
    prop_assert!(closest.interior == (part.from < closest.t && closest.t < part.to), "{closest:?}");
    Ok(())
}

/// Every arc between cuts bends one way and turns by at most a right angle.
fn simple_arcs(shape: &dyn Contour, (from, to): (f64, f64)) -> Result<(), TestCaseError> {
    let range = shape.range();
    let part = Range { from: range.at(from), to: range.at(to) };
    let mut ends = vec![part.from];
    ends.extend(shape.cuts(part));
    ends.push(part.to);
    for pair in ends.windows(2) {
        prop_assert!(pair[0] < pair[1], "{ends:?}");
        let arc = Range { from: pair[0], to: pair[1] };
        let turn = shape.frame(arc.to).alpha - shape.frame(arc.from).alpha;
        prop_assert!(turn.abs() <= FRAC_PI_2 * (1.0 + 1e-8), "{arc:?} turns by {turn}");
        for k in 1..20 {
            let turning = shape.frame(arc.at(f64::from(k) / 20.0)).turning;
            prop_assert!(turning * turn >= -1e-6 * turning.abs(), "{arc:?} turns by {turn}, but {turning}");
        }
    }
    Ok(())
}

/// The same frame, alpha but for whole turns.
fn same(one: Frame, two: Frame) -> Result<(), TestCaseError> {
    let alpha = (one.alpha - two.alpha) / TAU;
    for (error, size) in [
        (one.x - two.x, 1.0),
        (one.y - two.y, 1.0),
        (TAU * (alpha - alpha.round()), 1.0),
        (one.speed - two.speed, two.speed),
        (one.turning - two.turning, two.turning.abs() + 1.0),
    ] {
        prop_assert!(error.abs() <= 1e-11 * size, "{one:?} {two:?}");
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn lines(from in point(), to in point(), samples in samples(), part in part(), p in point()) {
        prop_assume!((to[0] - from[0]).hypot(to[1] - from[1]) > 1e-3);
        let shape = Line::new(from, to).unwrap();
        check(&shape, &samples)?;
        nearest(&shape, part, p)?;
    }

    #[test]
    fn circular_arcs((center, radius, shape) in circular(), samples in samples(), part in part(), p in point()) {
        check(&shape, &samples)?;
        nearest(&shape, part, p)?;
        let from_center = shape.closest(center[0], center[1]);
        prop_assert!(from_center.interior && f64::abs(from_center.gap.abs() - radius) < 1e-14);
        simple_arcs(&shape, part)?;
    }

    #[test]
    fn elliptic_arcs((center, shape) in elliptic(2.0), samples in samples(), part in part(), p in point()) {
        check(&shape, &samples)?;
        nearest(&shape, part, p)?;
        nearest(&shape, part, center)?;
        simple_arcs(&shape, part)?;
        // The box is no larger than the arc.
        let bounds = shape.bounds();
        let frames: Vec<Frame> = (0..=4000).map(|k| shape.frame(shape.range().at(f64::from(k) / 4e3))).collect();
        let least = |coordinate: fn(&Frame) -> f64| frames.iter().map(coordinate).fold(f64::INFINITY, f64::min);
        prop_assert!((least(|frame| frame.x) - bounds.min[0]).abs() < 1e-5);
        prop_assert!((least(|frame| -frame.y) + bounds.max[1]).abs() < 1e-5);
    }

    #[test]
    fn points_on_the_axes_of_ellipses(
        radii in [0.1..2.0, 0.1..2.0], angles in angles(), part in part(), x in -3.0..3.0, across: bool,
    ) {
        let shape = EllipticArc::new([0.0, 0.0], radii, 0.0, angles.0, angles.1).unwrap();
        nearest(&shape, part, if across { [0.0, x] } else { [x, 0.0] })?;
    }

    #[test]
    fn thin_elliptic_arcs((center, shape) in elliptic(6.0), part in part(), p in point(), samples in samples()) {
        // Brute force does not resolve the sharp ends: no nearer than it, and perpendicular.
        let range = Range { from: shape.range().at(part.0), to: shape.range().at(part.1) };
        for point in [p, [center[0], p[1]], center] {
            let closest = shape.closest_in(range, point[0], point[1]);
            let least = brute_force(&shape, range, point);
            prop_assert!(closest.gap.abs() <= least + 1e-14, "{least} {closest:?}");
            let distance = (closest.frame.x - point[0]).hypot(closest.frame.y - point[1]);
            prop_assert!((closest.gap.abs() - distance).abs() < 1e-14, "{distance} {closest:?}");
        }
        for sample in samples {
            contract::c9_bounds(&shape, range.at(sample)).map_err(TestCaseError::fail)?;
        }
        simple_arcs(&shape, part)?;
    }

    #[test]
    fn beziers(shape in bezier(), forward in forward_bezier(), samples in samples(), part in part(), p in point()) {
        check(&forward, &samples)?;
        check_apart(&shape, &samples)?;
        nearest(&shape, part, [0.5 * p[0], 0.5 * p[1]])?;
        simple_arcs(&shape, part)?;
    }

    #[test]
    fn graphs(a in -2.0..2.0, b in 0.5..3.0, from in -3.0..0.0, length in 0.1..4.0, samples in samples(), p in point()) {
        let (a, b): (f64, f64) = (a, b);
        let shape = Graph::new(Range { from, to: from + length }, move |x| (x * b).sin() * a).unwrap();
        check(&shape, &samples)?;
        nearest(&shape, (0.0, 1.0), p)?;
        simple_arcs(&shape, (0.0, 1.0))?;
        // Written out.
        let same_shape = Graph::with_derivatives(shape.range(), move |x| {
            let (sin, cos) = (b * x).sin_cos();
            [a * sin, a * b * cos, -a * b * b * sin]
        })
        .unwrap();
        for sample in samples {
            let t = from + length * sample;
            same(shape.frame(t), same_shape.frame(t))?;
        }
    }

    #[test]
    fn curves(
        a in 0.5..2.0, b in 0.5..2.0, phase in -3.0..3.0, length in 0.1..4.0, turns in 1.0..9.0, samples in samples(), p in point(),
    ) {
        let (a, b, phase): (f64, f64, f64) = (a, b, phase);
        let rosette = |to: f64| Curve::new(Range { from: 0.0, to }, move |t| {
            let radius = (t * 0.7).sin() * 0.3 + 1.0;
            [radius * (t + phase).cos() * a, radius * (t + phase).sin() * b]
        }).unwrap();
        let shape = rosette(length);
        check(&shape, &samples)?;
        nearest(&shape, (0.0, 1.0), p)?;
        simple_arcs(&shape, (0.0, 1.0))?;
        // Round and round it crosses itself, but alpha goes on.
        let shape = rosette(TAU * turns);
        for sample in samples {
            let t = shape.range().at(sample);
            contract::c2_velocity(&shape, t).map_err(TestCaseError::fail)?;
            contract::c3_turning(&shape, t).map_err(TestCaseError::fail)?;
        }
        let turned = shape.frame(shape.range().to).alpha - shape.frame(0.0).alpha;
        prop_assert!(f64::abs(turned - TAU * turns) < 0.8 * PI, "{turned} {turns}");
        simple_arcs(&shape, (0.0, 1.0))?;
    }

    #[test]
    fn moved_shapes((.., arc) in circular(), (_, ellipse) in elliptic(1.0), curve in forward_bezier(), motion in motion(), samples in samples()) {
        let range = arc.range();
        check(&Moved::new(arc, motion).unwrap(), &samples)?;
        check(&Moved::new(Reversed::new(ellipse), motion).unwrap(), &samples)?;
        let boxed: Box<dyn Contour> = Box::new(curve);
        let mirror = Motion { rotation: 2.0, mirror: true, ..Motion::IDENTITY };
        let twice = Moved::new(Moved::new(boxed, motion).unwrap(), mirror).unwrap();
        check(&twice, &samples)?;
        simple_arcs(&twice, (0.1, 0.9))?;
        let once = Moved::new(curve, motion.then(mirror)).unwrap();
        same(once.frame(0.3), twice.frame(0.3))?;
        check(&Reversed::new(arc), &samples)?;
        check(&Trimmed::new(arc, Range { from: range.at(0.2), to: range.at(0.7) }).unwrap(), &samples)?;
        let open = Parabola::new([0.1, 0.2], 3.0).unwrap();
        check(&Moved::new(open, motion).unwrap(), &samples)?;
    }

    #[test]
    fn reversed_and_moved_closest_points(curve in bezier(), motion in motion(), part in part(), p in point()) {
        nearest(&Moved::new(curve, motion).unwrap(), part, p)?;
        nearest(&Reversed::new(curve), part, p)?;
    }

    #[test]
    fn rates_are_those_of_dual_numbers(
        c in point(), radii in [0.1..2.0, 0.1..2.0], rotation in -4.0..4.0, angles in angles(), controls in bezier_points(), u in 0.0..=1.0,
    ) {
        let (from, to) = angles;
        let sign = (to - from).signum();
        let circle = CircularArc::new(c, radii[0], from, to).unwrap();
        let radius = radii[0];
        let twin = Curve::new(circle.range(), move |t| {
            let angle = t * (sign / radius) + from;
            [angle.cos() * radius + c[0], angle.sin() * radius + c[1]]
        });
        same(circle.frame(circle.range().at(u)), twin.unwrap().frame(circle.range().at(u)))?;

        let ellipse = EllipticArc::new(c, radii, rotation, from, to).unwrap();
        let (sin, cos) = rotation.sin_cos();
        let twin = Curve::new(ellipse.range(), move |t| {
            let angle = t * sign + from;
            let (x, y) = (angle.cos() * radii[0], angle.sin() * radii[1]);
            [x * cos - y * sin + c[0], x * sin + y * cos + c[1]]
        });
        same(ellipse.frame(ellipse.range().at(u)), twin.unwrap().frame(ellipse.range().at(u)))?;

        let [p, q, r, s] = controls;
        let twin = Curve::new(Range::UNIT, move |t| {
            let left = -t + 1.0;
            [0, 1].map(|k| {
                left.powi(3) * p[k] + left.powi(2) * t * 3.0 * q[k] + left * t.powi(2) * 3.0 * r[k] + t.powi(3) * s[k]
            })
        });
        same(Bezier::new(controls).unwrap().frame(u), twin.unwrap().frame(u))?;
    }
}

#[test]
fn two_stationary_points_in_one_cell_of_the_default_search() {
    // Near the centre of curvature of the first cell the distance rises, falls and rises within it.
    let (a, b, from) = (-1.890350801307979_f64, 2.58429265554534, -0.35860417373796616);
    let shape = Graph::new(Range { from, to: from + 2.4183384137411514 }, move |x| (x * b).sin() * a).unwrap();
    nearest(&shape, (0.0, 1.0), [-3.330927293975991, 0.4983480196291845]).unwrap();
    let closest = shape.closest(-3.330927293975991, 0.4983480196291845);
    assert!(closest.interior && closest.t < from + shape.range().length() / 96.0);
}

#[test]
fn gaps_near_the_closed_forms_are_exact_to_rounding() {
    let shapes: [(&str, Box<dyn Contour>); 7] = [
        ("line", Box::new(Line::new([-1.0, 0.3], [0.9, 0.7]).unwrap())),
        ("circle", Box::new(CircularArc::new([0.1, 0.2], 0.7, 0.0, TAU).unwrap())),
        ("ellipse", Box::new(EllipticArc::new([0.1, 0.2], [0.7, 0.3], 0.4, 0.0, TAU).unwrap())),
        ("ellipse 1e3", Box::new(EllipticArc::new([0.1, 0.2], [0.7, 0.7e-3], 0.4, 0.0, TAU).unwrap())),
        ("ellipse 1e6", Box::new(EllipticArc::new([0.1, 0.2], [0.7, 0.7e-6], 0.4, 0.0, -TAU).unwrap())),
        ("bezier", Box::new(Bezier::new([[-1.0, 0.0], [0.2, 1.0], [0.5, -0.8], [1.0, 0.3]]).unwrap())),
        (
            "moved ellipse",
            Box::new(
                Moved::new(
                    EllipticArc::new([0.1, 0.2], [0.7, 0.3], 0.4, 0.0, PI).unwrap(),
                    Motion { rotation: 1.0, translation: [0.3, 0.2], scale: 0.7, mirror: true },
                )
                .unwrap(),
            ),
        ),
    ];
    for (name, shape) in shapes {
        let mut worst = 0.0_f64;
        for k in 1..1000 {
            let frame = shape.frame(shape.range().at(f64::from(k) / 1e3));
            let (nx, ny) = frame.normal();
            // Not farther than the nearest centre of curvature.
            let reach = (0.3 / frame.curvature().abs()).min(0.1);
            for gap in [0.0_f64, 1e-15, -1e-12, 1e-9, 1e-6, -1e-3, 0.1, -0.1] {
                // Within a thin ellipse the other side is as near.
                let other_side = name.contains("1e") && gap * frame.turning < 0.0;
                if gap.abs() <= reach && !other_side {
                    let found = shape.gap(frame.x - gap * nx, frame.y - gap * ny);
                    worst = worst.max((found - gap).abs() / f64::EPSILON);
                }
            }
        }
        println!("{name}: gaps exact to {worst:.2} epsilon of a coordinate 1");
        assert!(worst <= 4.0, "{name}: {worst}");
    }
}
