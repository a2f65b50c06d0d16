#![allow(clippy::print_stdout, reason = "the errors that are measured are there to be read")]

use super::*;
use crate::numeric::seeded::Random;
use crate::phase::Label;
use crate::point::Touch;
use nalgebra::Matrix2;
use std::f64::consts::FRAC_PI_2;

/// Contacts along a path (x, y, alpha of 0 to 1), with noise of the position and the force, N.
fn touches(count: usize, sigma: f64, seed: u64, path: impl Fn(f64) -> (f64, f64, f64)) -> Vec<Touch> {
    let mut random = Random::new(seed);
    let force_noise = 5.0 * sigma;
    (0..count)
        .map(|k| {
            let (x, y, alpha) = path((k as f64 + 0.5) / count as f64);
            // Larger along one direction than across it, as from a rod.
            let (u, v) = (sigma * random.normal(), 0.3 * sigma * random.normal());
            let (fx, fy) =
                (0.3 * alpha.cos() + force_noise * random.normal(), 0.3 * alpha.sin() + force_noise * random.normal());
            let square = sigma * sigma;
            let covariance = Matrix2::new(0.545, 0.455, 0.455, 0.545) * square;
            let half = 0.5_f64.sqrt();
            let (x, y) = (x + half * (u - v), y + half * (u + v));
            Touch {
                s: 0.09,
                x,
                y,
                alpha: fy.atan2(fx),
                force: fx.hypot(fy),
                covariance,
                systematic: nalgebra::Matrix2::zeros(),
            }
        })
        .collect()
}

fn single(touches: &[Touch]) -> ContourEstimate {
    Assembly::default().assemble(touches.chunks(1).map(|one| Measured::new(Label::B, one)))
}

/// A parabola passed from the right to the left.
fn parabola(t: f64) -> (f64, f64, f64) {
    let x = 0.03 - 0.06 * t;
    (x, 50.0 * x * x, (100.0 * x).atan())
}

/// Distance from the parabola.
fn off_parabola(p: &TracePoint) -> f64 {
    let slope = 100.0 * p.x;
    // Newton's iteration for the foot.
    let mut x = p.x;
    for _ in 0..20 {
        let y = 50.0 * x * x;
        x -= (x - p.x + (y - p.y) * 100.0 * x) / (1.0 + 1e4 * x * x + (y - p.y) * 100.0 + slope * 0.0);
    }
    (p.x - x).hypot(p.y - 50.0 * x * x)
}

fn rms(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), value| (sum + value * value, count + 1.0));
    f64::sqrt(sum / count)
}

#[test]
fn a_clean_scan_is_kept_to_rounding() {
    let contour = single(&touches(30_000, 0.0, 0, parabola));
    assert_eq!((contour.traces.len(), contour.gaps.len()), (1, 0));
    let trace = &contour.traces[0];
    assert!(trace.reversed && trace.samples == (0..30_000));
    let worst = trace.points.iter().map(off_parabola).fold(0.0, f64::max);
    println!("{} points, worst {worst:e}", trace.points.len());
    assert!(worst < 1e-11 && trace.points.len() < 400);
    let (first, last) = (trace.points[0], trace.points[trace.points.len() - 1]);
    assert!((first.x - -0.03).abs() < 2e-6 && (last.x - 0.03).abs() < 2e-6);
    use rod_contours::{Contour, Spline, SplineEnd};
    let points: Vec<[f64; 2]> = trace.points.iter().map(|point| [point.x, point.y]).collect();
    let spline =
        Spline::through(&points, SplineEnd::Clamped { from: Some(first.alpha), to: Some(last.alpha) }).unwrap();
    let worst = (0..300).map(|k| parabola(f64::from(k) / 300.0 * 0.99 + 0.005)).map(|(x, y, _)| spline.gap(x, y).abs());
    assert!(worst.fold(0.0, f64::max) < 1e-7);
}

#[test]
fn the_error_shrinks_with_the_number_of_samples() {
    let mut before = f64::INFINITY;
    for count in [500, 5_000, 50_000] {
        let (mut errors, mut ratios) = (Vec::new(), Vec::new());
        for seed in 0..10 {
            let contour = single(&touches(count, 5e-4, seed, parabola));
            assert_eq!((contour.traces.len(), contour.gaps.len()), (1, 0));
            for p in &contour.traces[0].points {
                errors.push(off_parabola(p));
                ratios.push(off_parabola(p) / p.sigma);
            }
        }
        let (error, ratio) = (rms(errors.iter().copied()), rms(ratios.iter().copied()));
        println!("{count} samples: error {:.1} um, {ratio:.2} of what is stated", error * 1e6);
        assert!(error < 0.6 * before && (0.3..1.6).contains(&ratio));
        before = error;
    }
    assert!(before < 1e-5);
}

#[test]
fn the_ends_of_a_trace_are_those_of_the_run() {
    for seed in 0..10 {
        let contour = single(&touches(20_000, 5e-4, seed, parabola));
        let trace = &contour.traces[0];
        let [right, left] = [trace.entered().unwrap(), trace.left().unwrap()];
        let far = |a: [f64; 2], (x, y, _): (f64, f64, f64)| (a[0] - x).hypot(a[1] - y);
        assert!(far(right, parabola(0.0)) < 5e-4 && far(left, parabola(1.0)) < 5e-4, "{right:?} {left:?}");
    }
}

/// Down a line, around a vertex by a right angle while the contact stands still, and on.
fn vertex(t: f64) -> (f64, f64, f64) {
    match t {
        t if t < 0.4 => (0.05 * t - 0.02, 0.0, 0.0),
        t if t < 0.6 => (0.0, 0.0, FRAC_PI_2 * (t - 0.4) / 0.2),
        t => (0.0, 0.05 * (t - 0.6), FRAC_PI_2),
    }
}

#[test]
fn a_contact_that_stands_still_at_a_vertex_does_not_end_a_trace() {
    for (sigma, within) in [(0.0, 1e-10), (5e-4, 5e-5)] {
        let contour = single(&touches(20_000, sigma, 1, vertex));
        assert_eq!((contour.traces.len(), contour.gaps.len()), (1, 0), "{sigma}");
        let trace = &contour.traces[0];
        let edge = |on: bool, off: f64| if on { off.abs() } else { f64::INFINITY };
        let off = |p: &TracePoint| edge(p.x <= 0.0, p.y).min(edge(p.y >= 0.0, p.x)).min(p.x.hypot(p.y));
        let worst = trace.points.iter().map(off).fold(0.0, f64::max);
        println!("vertex, sigma {sigma}: {} points, worst {:.2} um", trace.points.len(), worst * 1e6);
        assert!(worst < within && !trace.reversed);
        // It comes by the vertex.
        let points: Vec<[f64; 2]> = trace.points.iter().map(|point| [point.x, point.y]).collect();
        use rod_contours::{Composite, Contour};
        assert!(Composite::polyline(&points).unwrap().gap(0.0, 0.0).abs() < 2.0 * within.max(1e-6));
    }
}

#[test]
fn a_tip_that_stands_in_a_notch_does_not_end_a_trace() {
    let notch = |t: f64| {
        let (x, y, alpha) = vertex(t);
        (x, -y, -alpha)
    };
    for sigma in [0.0, 5e-4] {
        let contour = single(&touches(20_000, sigma, 2, notch));
        assert_eq!((contour.traces.len(), contour.gaps.len()), (1, 0), "{sigma}");
    }
}

#[test]
fn gaps_are_where_there_is_no_single_contact() {
    let all = touches(10_000, 0.0, 0, parabola);
    let samples = |k: usize| match k {
        0..1000 | 9500.. => Measured::new(Label::Free, &[]),
        4000..5000 => Measured::new(if k < 4500 { Label::BB } else { Label::BA }, &all[k..k + 2]),
        // Second contact not known.
        5000..5200 => Measured::new(Label::BA, &all[k..k + 1]),
        7000..7040 => Measured { reason: Some("short"), ..Measured::new(Label::B, &[]) },
        8000..8100 => Measured { reason: Some("long"), ..Measured::new(Label::B, &[]) },
        _ => Measured::new(if k < 3000 { Label::A } else { Label::B }, &all[k..k + 1]),
    };
    let contour = Assembly::default().assemble((0..10_000).map(samples));
    let of = |kind| contour.of_kind(kind).map(|trace| trace.samples.clone()).collect::<Vec<_>>();
    assert_eq!(of(TraceKind::Single), [1000..4000, 5200..8000, 8100..9500]);
    assert!(
        of(TraceKind::First).into_iter().eq(std::iter::once(4000..5200))
            && of(TraceKind::Second).into_iter().eq(std::iter::once(4000..5000))
    );
    let gaps: Vec<_> = contour.gaps.iter().map(|gap| (gap.samples.clone(), gap.reason.to_string())).collect();
    let expected =
        [(0..1000, "no contact"), (4000..5200, "several contacts"), (8000..8100, "long"), (9500..10_000, "no contact")];
    assert_eq!(gaps, expected.map(|(samples, reason)| (samples, reason.to_owned())));
    let ends: Vec<_> = contour.gaps.iter().map(|gap| (gap.from.is_some(), gap.to.is_some())).collect();
    assert_eq!(ends, [(false, true), (true, true), (true, true), (true, false)]);
    let (from, to) = (contour.gaps[1].from.unwrap(), contour.gaps[1].to.unwrap());
    assert!((from[0] - all[3999].x).abs() < 1e-9 && (to[0] - all[5200].x).abs() < 1e-9);
    let rows: Vec<_> = contour.rows().collect();
    let mut table = csv::Writer::from_writer(Vec::new());
    rows.iter().for_each(|row| table.serialize(row).unwrap());
    let table = String::from_utf8(table.into_inner().unwrap()).unwrap();
    assert!(
        table.starts_with("stretch,kind,x,y,alpha,sigma,sigma_systematic\n0,single,") && table.contains("\n4,second,")
    );
    assert!(rows.windows(2).all(|pair| pair[0].stretch <= pair[1].stretch) && rows[0].kind == TraceKind::Single);
}

#[test]
fn a_leap_parts_a_trace() {
    for sigma in [0.0, 5e-4] {
        let leaping = |t: f64| if t < 0.5 { parabola(t) } else { parabola(t + 0.1) };
        let contour = single(&touches(20_000, sigma, 3, leaping));
        let samples: Vec<_> = contour.traces.iter().map(|trace| trace.samples.clone()).collect();
        assert_eq!(samples, [0..10_000, 10_000..20_000]);
        assert_eq!((contour.gaps.len(), &contour.gaps[0].reason), (1, &GapReason::Leap));
        assert_eq!((contour.gaps[0].from, contour.gaps[0].to), (contour.traces[0].left(), contour.traces[1].entered()));
    }
}

#[test]
fn correlated_noise_is_stated_as_larger() {
    let (mut errors, mut stated) = (Vec::new(), Vec::new());
    for seed in 0..10 {
        let mut noise = (Random::new(seed), [0.0; 4]);
        let mut all = touches(30_000, 0.0, 0, parabola);
        for touch in &mut all {
            for state in &mut noise.1 {
                *state = 0.45 * *state + (1.0 - 0.45_f64 * 0.45).sqrt() * noise.0.normal();
            }
            let [x, y, fx, fy] = noise.1;
            let force = [0.3 * touch.alpha.cos() + 2.5e-3 * fx, 0.3 * touch.alpha.sin() + 2.5e-3 * fy];
            touch.x += 5e-4 * x;
            touch.y += 5e-4 * y;
            touch.alpha = force[1].atan2(force[0]);
            touch.force = force[0].hypot(force[1]);
            touch.covariance = Matrix2::identity() * 2.5e-7;
        }
        for p in &single(&all).traces[0].points {
            errors.push(off_parabola(p));
            stated.push(p.sigma);
        }
    }
    let (error, stated) = (rms(errors.into_iter()), rms(stated.into_iter()));
    println!("correlated: error {:.1} um, stated {:.1} um", error * 1e6, stated * 1e6);
    assert!((0.3..1.6).contains(&(error / stated)));
}

#[test]
fn scans_that_say_little() {
    let assembly = Assembly::default();
    assert_eq!(assembly.assemble([]), ContourEstimate::default());
    let free = assembly.assemble([Measured::new(Label::Free, &[]); 5]);
    assert_eq!((free.traces.len(), free.gaps.len()), (0, 1));
    assert_eq!((free.gaps[0].from, free.gaps[0].to, &free.gaps[0].reason), (None, None, &GapReason::Free));
    let one = touches(1, 0.0, 0, parabola);
    let single = single(&one);
    assert_eq!((single.traces.len(), single.traces[0].points.len(), single.gaps.len()), (1, 1, 0));
}

#[test]
fn numbers_that_are_none_do_no_harm() {
    let clean = touches(400, 1e-5, 1, parabola);
    for bad in [f64::NAN, f64::INFINITY, -f64::INFINITY, 1e300, -1e-300] {
        for field in 0..6 {
            let mut all = clean.clone();
            for touch in all.iter_mut().skip(3).step_by(5) {
                match field {
                    0 => touch.x = bad,
                    1 => touch.y = bad,
                    2 => touch.alpha = bad,
                    3 => touch.force = bad,
                    4 => touch.covariance[(0, 0)] = bad,
                    _ => touch.covariance[(0, 1)] = bad,
                }
            }
            let contour = single(&all);
            assert!(!contour.traces.is_empty());
            if !bad.is_finite() && field < 3 {
                // Bridged.
                assert_eq!((contour.traces.len(), contour.gaps.len()), (1, 0), "{bad} {field}");
                assert!(contour.traces[0].points.iter().all(|p| off_parabola(p) < 5e-5));
            }
        }
        let all_bad: Vec<_> = clean.iter().map(|touch| Touch { x: bad, y: bad, ..*touch }).collect();
        let _ = single(&all_bad);
    }
    let nothing = single(&clean.iter().map(|touch| Touch { x: f64::NAN, ..*touch }).collect::<Vec<_>>());
    assert_eq!((nothing.traces.len(), nothing.gaps.len()), (0, 1));
    let _ = Assembly { tolerance: f64::NAN, ..Assembly::default() }
        .assemble(clean.chunks(1).map(|one| Measured::new(Label::B, one)));
}
