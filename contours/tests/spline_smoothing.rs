//! Smoothing splines: the noise goes, the shape stays, within what the noise allows.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::f64::consts::PI;

use rod_contours::{Contour, Spline, SplineEnd};

/// The largest deviation of a spline from a curve, of the part of its range between two fractions.
fn deviation(spline: &Spline, from: f64, to: f64, off: impl Fn(f64, f64) -> f64) -> f64 {
    (0..=4000)
        .map(|k| spline.frame(spline.range().at(from + (to - from) * f64::from(k) / 4000.0)))
        .map(|frame| off(frame.x, frame.y).abs())
        .fold(0.0, f64::max)
}

/// A reproducible normal deviate, near enough: the sum of twelve uniform ones.
struct Noise(u64);

impl Noise {
    fn next(&mut self) -> f64 {
        let uniform = (0..12).map(|_| {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (self.0 >> 11) as f64 / (1_u64 << 53) as f64
        });
        uniform.sum::<f64>() - 6.0
    }
}

#[test]
fn smoothing_takes_off_the_noise() {
    let clean: Vec<_> = (0..=400).map(|k| 1.5 * PI * f64::from(k) / 400.0).map(|a| [a.cos(), a.sin()]).collect();
    let sigma = 1e-3;
    let mut noise = Noise(1);
    let noisy: Vec<_> = clean.iter().map(|[x, y]| [x + sigma * noise.next(), y + sigma * noise.next()]).collect();
    let smooth = Spline::smoothing(&noisy, sigma).unwrap();
    let exact = Spline::through(&noisy, SplineEnd::Natural).unwrap();
    let bend = |spline: &Spline| {
        let square = |k: u32| (spline.frame(spline.range().at(f64::from(k) / 1000.0)).curvature() - 1.0).powi(2);
        ((100..=900).map(square).sum::<f64>() / 801.0).sqrt()
    };
    let sum = |spline: &Spline| -> f64 {
        spline.points().zip(&noisy).map(|([x, y], [u, v])| (x - u).powi(2) + (y - v).powi(2)).sum()
    };
    println!(
        "curvature of a circle from noisy points is off by {:.3} (interpolated: {:.1})",
        bend(&smooth),
        bend(&exact)
    );
    assert!(bend(&smooth) < 0.05 * bend(&exact));
    let allowed = 2.0 * noisy.len() as f64 * sigma * sigma;
    println!("residual sum / allowed - 1 = {:e}", sum(&smooth) / allowed - 1.0);
    assert!((sum(&smooth) / allowed - 1.0).abs() < 1e-9);
    let off = deviation(&smooth, 0.1, 0.9, |x, y| x.hypot(y) - 1.0);
    println!("its distance from the circle is up to {:.2} sigma", off / sigma);
    assert!(off < sigma);
    // Without noise the points stay as they are; next to none moves them next to nothing.
    let same = Spline::smoothing(&clean, 0.0).unwrap();
    let through = Spline::through(&clean, SplineEnd::Natural).unwrap();
    for k in 0..=1000 {
        let t = through.range().at(f64::from(k) / 1000.0);
        assert_eq!(same.frame(t), through.frame(t));
    }
    for little in [1e-200, 1e-12, 1e-9, 1e-6] {
        let near = Spline::smoothing(&clean, little).unwrap();
        let moved = near.points().zip(&clean).map(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1])).fold(0.0, f64::max);
        assert!(moved <= 1e-15 + 2.0 * (401.0_f64).sqrt() * little, "{little:e}: {moved:e}");
    }
    // Beyond all measure: a straight line.
    let line = Spline::smoothing(&clean, 10.0).unwrap();
    assert!((line.frame(0.0).alpha - line.frame(line.range().to).alpha).abs() < 1e-9);
}

#[test]
fn smoothing_is_the_smoothest() {
    // Any other curve with the same residuals bends more: check against small changes of the fitted points.
    let mut noise = Noise(5);
    let noisy: Vec<_> = (0..30).map(|k| 0.2 * f64::from(k)).map(|x| [x, x.sin() + 0.02 * noise.next()]).collect();
    let bending = |points: &[[f64; 2]], knots: &[f64]| -> f64 {
        // Of the natural spline through the points at the knots, from its second derivatives by plain elimination.
        let n = points.len();
        let h = |k: usize| knots[k + 1] - knots[k];
        (0..2)
            .map(|side| {
                let slope = |k: usize| (points[k + 1][side] - points[k][side]) / h(k);
                let right: Vec<_> = (1..n - 1).map(|k| slope(k) - slope(k - 1)).collect();
                let mut m = vec![0.0; n];
                for _ in 0..400 {
                    for k in 1..n - 1 {
                        let beside = h(k - 1) * m[k - 1] + h(k) * m[k + 1];
                        m[k] = (6.0 * right[k - 1] - beside) / (2.0 * (h(k - 1) + h(k)));
                    }
                }
                (1..n - 1).map(|k| m[k] * right[k - 1]).sum::<f64>()
            })
            .sum()
    };
    let smooth = Spline::smoothing(&noisy, 0.02).unwrap();
    let knots: Vec<_> = smooth.knots().collect();
    let fitted: Vec<_> = smooth.points().collect();
    let least = bending(&fitted, &knots);
    let radius = |points: &[[f64; 2]]| -> f64 {
        points.iter().zip(&noisy).map(|(a, b)| (a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2)).sum::<f64>().sqrt()
    };
    let allowed = radius(&fitted);
    for _ in 0..200 {
        let changed: Vec<_> = fitted.iter().map(|[x, y]| [x + 1e-4 * noise.next(), y + 1e-4 * noise.next()]).collect();
        let back = (allowed / radius(&changed)).min(1.0);
        let inside: Vec<_> = changed
            .iter()
            .zip(&noisy)
            .map(|(a, b)| [b[0] + back * (a[0] - b[0]), b[1] + back * (a[1] - b[1])])
            .collect();
        assert!(bending(&inside, &knots) >= least * (1.0 - 1e-9));
    }
}

#[test]
fn many_points_are_smoothed_too() {
    let count = 100_000;
    let (sigma, mut noise) = (1e-6, Noise(3));
    let points: Vec<_> = (0..count)
        .map(|k| 5.0 * f64::from(k) / f64::from(count))
        .map(|x| [x + sigma * noise.next(), 0.2 * x.sin() + sigma * noise.next()])
        .collect();
    let started = std::time::Instant::now();
    let spline = Spline::smoothing(&points, sigma).unwrap();
    println!("{count} points smoothed in {:?}", started.elapsed());
    let sum: f64 = spline.points().zip(&points).map(|([x, y], [u, v])| (x - u).powi(2) + (y - v).powi(2)).sum();
    let ratio = sum / (2.0 * f64::from(count) * sigma * sigma);
    println!("residual sum / allowed = {ratio}");
    assert!(ratio <= 1.0 + 1e-9 && ratio > 0.9);
    let off = (1000..99_000).step_by(1000).map(|k| {
        let frame = spline.frame(spline.knots().nth(k).unwrap());
        let (slope, bend) = (0.2 * frame.x.cos(), -0.2 * frame.x.sin());
        frame.curvature() - bend / (1.0 + slope * slope).powf(1.5)
    });
    let off = off.fold(0.0_f64, |most, off| most.max(off.abs()));
    println!("its curvature is off by {off:e}");
    assert!(off < 0.05);
}
