//! Splines: as exact as they say, right against brute force, and under the contract.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use proptest::collection::vec;
use proptest::prelude::*;
use rod_contours::{Contour, Range, Spline, SplineEnd, contract};

const ESTIMATED: SplineEnd = SplineEnd::Clamped { from: None, to: None };

fn circle(count: u32) -> Vec<[f64; 2]> {
    (0..count).map(|k| f64::from(k) * TAU / f64::from(count)).map(|a| [a.cos(), a.sin()]).collect()
}

/// A line of steps of length 1 with these turns between them.
fn walk(turns: &[f64]) -> Vec<[f64; 2]> {
    let mut points = vec![[0.0, 0.0]];
    let mut heading: f64 = 0.0;
    for (k, turn) in turns.iter().enumerate() {
        heading += turn;
        let [x, y] = points[k];
        points.push([x + heading.cos(), y + heading.sin()]);
    }
    points
}

/// A spiral of several turns, outwards.
fn spiral(count: u32) -> Vec<[f64; 2]> {
    (0..count).map(|k| 0.3 * f64::from(k)).map(|a| [(1.0 + 0.2 * a) * a.cos(), (1.0 + 0.2 * a) * a.sin()]).collect()
}

/// Closed, star-shaped about the origin, counterclockwise.
fn star(radii: &[f64]) -> Vec<[f64; 2]> {
    let step = TAU / radii.len() as f64;
    radii
        .iter()
        .enumerate()
        .map(|(k, radius)| [radius * (step * k as f64).cos(), radius * (step * k as f64).sin()])
        .collect()
}

/// Smallest distance over so many samples of the part.
fn brute_force(spline: &Spline, part: Range, samples: u32, [x, y]: [f64; 2]) -> f64 {
    (0..=samples)
        .map(|k| spline.frame(part.at(f64::from(k) / f64::from(samples))))
        .map(|frame| (frame.x - x).hypot(frame.y - y))
        .fold(f64::INFINITY, f64::min)
}

/// The largest deviation of a spline from a curve, of the part of its range between two fractions.
fn deviation(spline: &Spline, from: f64, to: f64, off: impl Fn(f64, f64) -> f64) -> f64 {
    (0..=4000)
        .map(|k| spline.frame(spline.range().at(from + (to - from) * f64::from(k) / 4000.0)))
        .map(|frame| off(frame.x, frame.y).abs())
        .fold(0.0, f64::max)
}

/// Distance of a point from y = sin x, to first order and a little better.
fn off_sine(x: f64, y: f64) -> f64 {
    let mut at = x;
    for _ in 0..20 {
        let (sin, cos) = at.sin_cos();
        at -= ((at - x) + (sin - y) * cos) / (1.0 + cos * cos - (sin - y) * sin);
    }
    (at - x).hypot(at.sin() - y)
}

#[test]
fn the_order_of_convergence() {
    // The sine from 0.5 to 5.5, bent at both ends, and the circle.
    let sine =
        |n: u32| (0..=n).map(|k| 0.5 + 5.0 * f64::from(k) / f64::from(n)).map(|x| [x, x.sin()]).collect::<Vec<_>>();
    let exact = SplineEnd::Clamped { from: Some(0.5_f64.cos().atan()), to: Some(5.5_f64.cos().atan()) };
    let counts = [8, 16, 32, 64, 128];
    type Case<'a> = (&'a str, f64, Box<dyn Fn(u32) -> f64 + 'a>);
    let cases: [Case<'_>; 5] = [
        (
            "sine, tangents",
            4.0,
            Box::new(|n| deviation(&Spline::through(&sine(n), exact).unwrap(), 0.0, 1.0, off_sine)),
        ),
        (
            "sine, estimated",
            4.0,
            Box::new(|n| deviation(&Spline::through(&sine(n), ESTIMATED).unwrap(), 0.0, 1.0, off_sine)),
        ),
        (
            "sine, natural",
            2.0,
            Box::new(|n| deviation(&Spline::through(&sine(n), SplineEnd::Natural).unwrap(), 0.0, 1.0, off_sine)),
        ),
        (
            "the same, inside",
            4.0,
            Box::new(|n| deviation(&Spline::through(&sine(n), SplineEnd::Natural).unwrap(), 0.4, 0.6, off_sine)),
        ),
        (
            "circle, closed",
            4.0,
            Box::new(|n| {
                let spline = Spline::through(&circle(n), SplineEnd::Periodic).unwrap();
                deviation(&spline, 0.0, 1.0, |x, y| x.hypot(y) - 1.0)
            }),
        ),
    ];
    println!("{:>18} {:>9} {:>9} {:>9} {:>9} {:>9}  order", "deviation", 8, 16, 32, 64, 128);
    for (name, expected, error) in cases {
        let errors = counts.map(&error);
        let order = (errors[3] / errors[4]).log2();
        let row: String = errors.iter().map(|error| format!(" {error:9.2e}")).collect();
        println!("{name:>18}{row}  {order:.2}");
        assert!((order - expected).abs() < 0.3 || order > expected, "{name}: {order}");
        assert!(order < 5.5, "{name}: {order}");
    }
}

#[test]
fn the_crates_own_samples_agree() {
    let mut worst = 0.0_f64;
    for points in [spiral(40), walk(&[0.5, -1.0, 2.0, 0.1, -2.5, 1.0]), circle(7)] {
        for end in [SplineEnd::Natural, ESTIMATED, SplineEnd::Periodic] {
            let spline = Spline::through(&points, end).unwrap();
            for k in 0..=1000 {
                let t = spline.range().at(f64::from(k) / 1000.0);
                let (frame, [x, y]) = (spline.frame(t), spline.sample(t).unwrap());
                let scale = x.abs().max(y.abs()).max(1.0);
                worst = worst.max((frame.x - x).abs().max((frame.y - y).abs()) / scale);
            }
            assert!([-1e-9, spline.range().to + 1e-9, f64::NAN].iter().all(|&t| spline.sample(t).is_none()));
        }
    }
    println!("largest difference between frame and sample, relative: {worst:e}");
    assert!(worst <= 16.0 * f64::EPSILON);
}

#[test]
fn the_angle_goes_round_with_the_curve() {
    let outwards = Spline::through(&spiral(100), SplineEnd::Natural).unwrap();
    let turned = outwards.frame(outwards.range().to).alpha - outwards.frame(0.0).alpha;
    assert!((turned / (0.3 * 99.0) - 1.0).abs() < 0.05, "{turned}");
    let back: Vec<_> = spiral(100).into_iter().rev().collect();
    let inwards = Spline::through(&back, SplineEnd::Natural).unwrap();
    let back = inwards.frame(inwards.range().to).alpha - inwards.frame(0.0).alpha;
    assert!((back + turned).abs() < 1e-9);
    let disc = Spline::through(&circle(3), SplineEnd::Periodic).unwrap();
    assert!((disc.frame(disc.range().to).alpha - disc.frame(0.0).alpha - TAU).abs() < 1e-14);
    // An eight: once to the left, once to the right.
    let eight: Vec<_> = (0..24).map(|k| f64::from(k) * TAU / 24.0).map(|a| [a.sin(), a.sin() * a.cos()]).collect();
    let eight = Spline::through(&eight, SplineEnd::Periodic).unwrap();
    assert!((eight.frame(eight.range().to).alpha - eight.frame(0.0).alpha).abs() < 1e-13);
    for spline in [outwards, inwards, disc, eight] {
        let steps = 100_000;
        let mut before = spline.frame(0.0);
        for k in 1..=steps {
            let frame = spline.frame(spline.range().at(f64::from(k) / f64::from(steps)));
            assert!((frame.alpha - before.alpha).abs() < 1e-2);
            before = frame;
        }
    }
}

#[test]
fn closest_points_against_brute_force() {
    let curves = [
        Spline::through(&spiral(60), SplineEnd::Natural).unwrap(),
        Spline::through(&walk(&[0.5, -1.0, 2.0, 0.1, -2.5, 1.0, 1.5, 1.5, -0.3]), ESTIMATED).unwrap(),
        Spline::through(&star(&[1.0, 0.4, 1.2, 0.8, 0.7, 1.5, 0.5]), SplineEnd::Periodic).unwrap(),
    ];
    for spline in curves {
        let whole = spline.range();
        let to = whole.to;
        let parts = [
            whole,
            Range { from: 0.1 * to, to: 0.13 * to },
            Range { from: 0.35 * to, to: 0.9 * to },
            Range { from: spline.knots().nth(2).unwrap(), to: spline.knots().nth(5).unwrap() },
            Range { from: f64::NEG_INFINITY, to: 0.5 * to },
        ];
        for part in parts {
            for k in 0..40 {
                let angle = f64::from(k) * 2.4;
                let point = [0.15 * f64::from(k) * angle.cos(), 0.15 * f64::from(k) * angle.sin()];
                let closest = spline.closest_in(part, point[0], point[1]);
                let inside = whole.within(part);
                let expected = brute_force(&spline, inside, 20_000, point);
                let gap = closest.gap.abs();
                assert!(gap <= expected + 1e-14 && expected - gap < 1e-3, "{part:?} {point:?}: {gap} {expected}");
                assert_eq!(closest.frame, spline.frame(closest.t));
                assert!(inside.contains(closest.t));
                assert_eq!(closest.interior, inside.from < closest.t && closest.t < inside.to);
                if closest.interior {
                    let (sin, cos) = closest.frame.alpha.sin_cos();
                    let ahead = (point[0] - closest.frame.x) * cos + (point[1] - closest.frame.y) * sin;
                    assert!(ahead.abs() < 1e-12, "{part:?} {point:?}: {ahead:e}");
                }
            }
            let bounds = spline.bounds_in(part).grown(1e-13);
            let inside = whole.within(part);
            for k in 0..=500 {
                let frame = spline.frame(inside.at(f64::from(k) / 500.0));
                assert!(bounds.contains(frame.x, frame.y));
            }
        }
        assert!(!spline.gap(f64::NAN, 0.0).is_finite() && !spline.gap(f64::INFINITY, 0.0).is_finite());
    }
}

#[test]
fn a_hundred_thousand_points() {
    let count = 100_000;
    let points: Vec<_> =
        (0..count).map(|k| f64::from(k) * TAU / f64::from(count)).map(|a| [a.cos(), a.sin()]).collect();
    let started = std::time::Instant::now();
    let disc = Spline::through(&points, SplineEnd::Periodic).unwrap();
    println!("{count} points: built in {:?}", started.elapsed());
    let started = std::time::Instant::now();
    for k in 0..10_000 {
        let angle = f64::from(k) * 2.4;
        let away = 0.1 + 1e-4 * f64::from(k);
        let gap = disc.gap((1.0 + away) * angle.cos(), (1.0 + away) * angle.sin());
        assert!((gap - away).abs() < 1e-14);
    }
    let elapsed = started.elapsed();
    println!("a closest point of the whole: {:?}", elapsed / 10_000);
    let started = std::time::Instant::now();
    for k in 0..10_000 {
        let from = 1e-4 * f64::from(k) * 6.0;
        let closest = disc.closest_in(Range { from, to: from + 1e-4 }, 2.0, 0.3);
        assert!(closest.gap.abs() > 0.9);
    }
    println!("a closest point of two cubics: {:?}", started.elapsed() / 10_000);
    // Direction and curvature suffer from the rounding of close points: 1e-16 / h and 1e-16 / h^2.
    let frames = (0..1000).map(|k| disc.frame(disc.range().at(f64::from(k) / 1000.0)));
    let (turn, bend) = frames.fold((0.0_f64, 0.0_f64), |(turn, bend), frame| {
        let off = (frame.alpha - frame.y.atan2(frame.x) - FRAC_PI_2 + PI).rem_euclid(TAU) - PI;
        (turn.max(off.abs()), bend.max((frame.curvature() - 1.0).abs()))
    });
    println!("error of the direction {turn:e}, of the curvature {bend:e}");
    assert!(turn < 1e-10 && bend < 1e-5);
}

/// What `cuts` promises of the parts between them.
fn check_cuts(spline: &Spline, range: Range) -> usize {
    let cuts = spline.cuts(range);
    let stops: Vec<_> = [range.from].into_iter().chain(cuts.iter().copied()).chain([range.to]).collect();
    let knots: Vec<_> = spline.knots().collect();
    for pair in stops.windows(2) {
        assert!(pair[0] < pair[1], "{stops:?}");
        assert!(knots.iter().filter(|&&t| pair[0] < t && t < pair[1]).count() <= 3, "{stops:?}");
        let alpha = |k: u32| spline.frame(Range { from: pair[0], to: pair[1] }.at(f64::from(k) / 200.0)).alpha;
        let total = alpha(200) - alpha(0);
        assert!(total.abs() <= FRAC_PI_2 + 1e-6, "{pair:?}: {total}");
        for k in 0..200 {
            let step = alpha(k + 1) - alpha(k);
            assert!(step * total.signum() > -2e-9, "{pair:?} {k}: {step} of {total}");
        }
    }
    cuts.len()
}

#[test]
fn cuts_of_known_curves() {
    let disc = Spline::through(&circle(64), SplineEnd::Periodic).unwrap();
    assert_eq!(check_cuts(&disc, disc.range()), 15);
    let coarse = Spline::through(&circle(3), SplineEnd::Periodic).unwrap();
    assert!(check_cuts(&coarse, coarse.range()) <= 8);
    // A straight line off the axes, where rounding bends to and fro.
    let line: Vec<_> = (0..1001).map(|k| f64::from(k) * 0.01).map(|x| [x, 0.3 + x / 3.0]).collect();
    let line = Spline::through(&line, SplineEnd::Natural).unwrap();
    assert_eq!(check_cuts(&line, line.range()), 249);
    let one = Spline::through(&[[0.0, 0.0], [1.0, 0.0]], SplineEnd::Natural).unwrap();
    assert!(one.cuts(one.range()).is_empty());
    let hook = SplineEnd::Clamped { from: Some(2.5), to: Some(-2.5) };
    let loop_of_one = Spline::through(&[[0.0, 0.0], [1.0, 0.0]], hook).unwrap();
    assert!(check_cuts(&loop_of_one, loop_of_one.range()) >= 3);
}

/// A part that begins just before an inflection, so that it turns back by less than 1e-9 rad.
#[test]
fn a_short_turn_before_an_inflection_is_cut_off() {
    let wave = Spline::through(&[[0.0, 0.0], [1.0, 1.0], [2.0, 0.0], [3.0, 1.0]], SplineEnd::Natural).unwrap();
    let &[inflection] = wave.cuts(Range { from: 1.5, to: 3.0 }).as_slice() else { panic!() };
    for short in [1e-4, 1e-5, 1e-6] {
        let part = Range { from: inflection - short, to: inflection + 0.5 };
        assert_eq!(wave.cuts(part), [inflection]);
        assert!(wave.is_convex(Range { from: inflection, to: part.to }) && !wave.is_convex(part));
    }
}

fn end() -> impl Strategy<Value = SplineEnd> {
    let angle = || proptest::option::of(-0.5..0.5);
    prop_oneof![
        Just(SplineEnd::Natural),
        Just(ESTIMATED),
        (angle(), angle()).prop_map(|(from, to)| SplineEnd::Clamped { from, to }),
    ]
}

fn samples() -> impl Strategy<Value = Vec<f64>> {
    vec(prop_oneof![8 => 0.0..=1.0, 1 => Just(0.0), 1 => Just(1.0)], 6)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn contract_of_open_splines(
        steps in vec((0.2..1.5, -1.0..1.0), 1..30), end in end(), scale in -3..3, samples in samples(),
    ) {
        // To the right with bounded slopes, so that the line does not meet itself.
        let size = 10_f64.powi(scale);
        let mut points = vec![[0.3, -0.1]];
        for (dx, slope) in steps {
            let [x, y]: [f64; 2] = points[points.len() - 1];
            points.push([x + size * dx, y + size * dx * slope]);
        }
        let spline = Spline::through(&points, end).unwrap();
        contract::check(&spline, &samples).map_err(TestCaseError::fail)?;
        check_cuts(&spline, spline.range());
    }

    #[test]
    fn contract_of_closed_splines(radii in vec(0.8..1.2, 5..24), samples in samples()) {
        let spline = Spline::through(&star(&radii), SplineEnd::Periodic).unwrap();
        // A loop in a sharp tip would be crossed unseen.
        prop_assume!((spline.frame(spline.range().to).alpha - spline.frame(0.0).alpha - TAU).abs() < 1e-9);
        contract::check(&spline, &samples).map_err(TestCaseError::fail)?;
        check_cuts(&spline, spline.range());
    }

    #[test]
    fn contract_of_smoothed_points(heights in vec(-0.1..0.1, 3..40), sigma in 0.0..0.2, samples in samples()) {
        let points: Vec<_> = heights.iter().enumerate().map(|(k, &y)| [0.3 * k as f64, y]).collect();
        let spline = Spline::smoothing(&points, sigma).unwrap();
        contract::check(&spline, &samples).map_err(TestCaseError::fail)?;
        let sum: f64 = spline.points().zip(&points).map(|(a, b)| (a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2)).sum();
        prop_assert!(sum <= 2.0 * points.len() as f64 * sigma * sigma * (1.0 + 1e-9) + 1e-28);
    }

    #[test]
    fn wild_walks(turns in vec(-2.8..2.8, 2..40), end in end(), x in -6.0..6.0, y in -6.0..6.0, part in (0.0..1.0, 0.0..1.0)) {
        // These cross themselves, loop and nearly stand still: all but the signs must hold.
        let end = if turns[0] > 1.5 { SplineEnd::Periodic } else { end };
        let Ok(spline) = Spline::through(&walk(&turns), end) else { return Ok(()) };
        let whole = spline.range();
        for sample in 0..40 {
            let t = whole.at(f64::from(sample) / 40.0 + 0.01);
            contract::c1_finite(&spline, t).map_err(TestCaseError::fail)?;
            contract::c2_velocity(&spline, t).map_err(TestCaseError::fail)?;
            contract::c3_turning(&spline, t).map_err(TestCaseError::fail)?;
            contract::c4_moving(&spline, t).map_err(TestCaseError::fail)?;
            contract::c9_bounds(&spline, whole.clamp(t)).map_err(TestCaseError::fail)?;
        }
        contract::c5_foot(&spline, [x, y]).map_err(TestCaseError::fail)?;
        contract::c6_nearest(&spline, [x, y]).map_err(TestCaseError::fail)?;
        let (from, to) = (whole.at(f64::min(part.0, part.1)), whole.at(f64::max(part.0, part.1)));
        for range in [whole, Range { from, to }] {
            let gap = spline.closest_in(range, x, y).gap.abs();
            prop_assert!(gap <= brute_force(&spline, range, 5000, [x, y]) + 1e-13);
        }
        if from < to {
            check_cuts(&spline, Range { from, to });
        }
    }
}
