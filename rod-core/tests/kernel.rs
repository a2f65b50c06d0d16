//! The closed form against independent solutions: how large its error is, measured.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test may, and the errors are there to be read: --nocapture"
)]

use crate::reference::{Random, errors, exact, largest};
use rod_core::{Section, advance, advance_with_sensitivities, walk};
use std::f64::consts::{FRAC_PI_2, PI};

/// A random segment in the range that the accuracy is claimed for: |A|, |B| <= 20, |kappa| <= 6, |s| <= 1.
fn segment(random: &mut Random) -> (Section, f64, f64, f64) {
    let start =
        Section { x: random.within(1.0), y: random.within(1.0), phi: random.within(PI), kappa: random.within(6.0) };
    (start, random.within(20.0), random.within(20.0), random.within(1.0))
}

#[test]
fn error_on_ten_thousand_random_segments() {
    let mut random = Random::new(1);
    let mut found: Vec<f64> = (0..10_000)
        .map(|_| {
            let (start, a, b, s) = segment(&mut random);
            largest(errors(&advance(&start, a, b, s), &exact(&start, a, b, s)))
        })
        .collect();
    found.sort_by(f64::total_cmp);
    let (median, worst) = (found[5_000], found[9_999]);
    println!("kernel: median {median:.1e}, 99 % {:.1e}, worst {worst:.1e}", found[9_900]);
    // measured: 9.5e-16, 7.6e-15, 1.5e-14
    assert!(median < 1.5e-15 && worst < 1e-13);
}

#[test]
fn walking_is_as_exact_as_jumping() {
    let mut random = Random::new(2);
    let worst = (0..2_000)
        .map(|_| {
            let (start, a, b, s) = segment(&mut random);
            let steps = 1 + (random.within(1.0).abs() * 300.0) as usize;
            largest(errors(&walk(&start, a, b, s, steps).last().unwrap(), &exact(&start, a, b, s)))
        })
        .fold(0.0, f64::max);
    println!("walk: worst {worst:.1e}");
    assert!(worst < 3e-14);
}

#[test]
fn degenerate_segments() {
    let worst = [
        // straight, circular, and next to it
        (0.3, 0.0, 0.0, 0.0),
        (0.3, 2.0, 0.0, 0.0),
        (0.3, 2.0, 1e-300, -1e-300),
        (0.3, 2.0, 1e-160, 1e-162),
        (0.3, 1e-300, 1e-8, -1e-9),
        (0.3, -2.0, 1e-12, 3e-13),
        (1.0, 1e-9, 20.0, 1.0),
        // at rest in the stable direction, and close to it
        (FRAC_PI_2, 0.0, 20.0, 0.0),
        (PI, 0.0, 0.0, 20.0),
        (PI, 1e-8, 0.0, 20.0),
        // at rest in the unstable direction, exactly, and close to it
        (0.0, 0.0, 0.0, 20.0),
        (0.0, 1e-9, 0.0, 20.0),
        (1e-7, -1e-7, 0.0, 20.0),
        // on the separatrix, and on both sides of it
        (PI, 2.0 * 5.0, 0.0, 25.0),
        (PI, 2.0 * 5.0 - 1e-9, 0.0, 25.0),
        (PI, 2.0 * 5.0 + 1e-9, 0.0, 25.0),
        (PI, -2.0 * 5.0, 0.0, 25.0),
        // whole turns
        (0.0, 2.0 * PI, 0.1, 0.0),
        (0.0, 4.0 * PI, 3.0, 1.0),
        (0.0, -20.0, 3.0, 1.0),
    ]
    .into_iter()
    .flat_map(|(phi, kappa, a, b)| [1.0, 0.37, -0.6, 1e-12].map(|s| (phi, kappa, a, b, s)))
    .map(|(phi, kappa, a, b, s)| {
        let start = Section { x: 0.0, y: 0.0, phi, kappa };
        let error = largest(errors(&advance(&start, a, b, s), &exact(&start, a, b, s)));
        assert!(error < 5e-14, "{phi} {kappa} {a} {b} {s}: {error:e}");
        error
    })
    .fold(0.0, f64::max);
    println!("degenerate: worst {worst:.1e}");
}

#[test]
fn rest_in_the_unstable_direction_is_kept_exactly() {
    let start = Section { x: 0.0, y: 0.0, phi: 0.0, kappa: 0.0 };
    let end: Section = advance(&start, 0.0, 20.0, 1.0);
    assert_eq!((end.y, end.phi, end.kappa), (0.0, 0.0, 0.0));
    assert!((end.x - 1.0).abs() < 1e-15);
}

#[test]
fn the_separatrix_is_the_gudermannian() {
    // phi'' = P sin phi from phi = pi with kappa = 2 sqrt P: phi = 4 atan exp(sqrt P s), kappa = 2 sqrt P / cosh(sqrt P s)
    let start = Section { x: 0.0, y: 0.0, phi: PI, kappa: 8.0 };
    for s in [-1.0, -0.1, 0.3, 1.0, 2.0] {
        let end = advance(&start, 0.0, 16.0, s);
        assert!((end.phi - 4.0 * (4.0 * s).exp().atan()).abs() < 1e-13, "{s} {end:?}");
        assert!((end.kappa - 8.0 / (4.0 * s).cosh()).abs() < 4e-13, "{s} {end:?}");
        assert!((end.x - (s - 0.5 * (4.0 * s).tanh())).abs() < 1e-13, "{s} {end:?}");
    }
}

#[test]
fn a_hundred_turns_under_a_strong_force_are_counted() {
    // by parts that cannot coil
    for k in 0..200 {
        let kappa = (900.0 + f64::from(k)) * if k % 2 == 0 { 1.0 } else { -1.0 };
        let start = Section { x: 0.0, y: 0.0, phi: 0.01 * f64::from(k), kappa };
        let (a, b, s) = (4e4, 1e5, -0.999);
        let end = advance(&start, a, b, s);
        let parted = (0..2_000).fold(start, |at, _| advance(&at, a, b, s / 2_000.0));
        assert!((end.phi - parted.phi).abs() < 1e-8, "{kappa}: {} {}", end.phi, parted.phi);
    }
}

#[test]
fn coils_are_counted() {
    // the angle grows with the curvature, and so does the rounding: relative to |kappa|
    let mut random = Random::new(3);
    let worst = (0..300)
        .map(|_| {
            let (start, a, b, s) = segment(&mut random);
            let start = Section { kappa: random.within(100.0), ..start };
            largest(errors(&advance(&start, a, b, s), &exact(&start, a, b, s))) / start.kappa.abs().max(6.0)
        })
        .fold(0.0, f64::max);
    println!("coils: worst {worst:.1e} of kappa");
    assert!(worst < 1e-14);
}

#[test]
fn strong_forces() {
    // |A|, |B| <= 400, |kappa| <= 30: up to exp(24) times the rounding of the start comes through, hence quantiles
    let mut random = Random::new(4);
    let mut found: Vec<f64> = (0..500)
        .map(|_| {
            let (start, a, b, s) = segment(&mut random);
            let (start, a, b) = (Section { kappa: 5.0 * start.kappa, ..start }, 20.0 * a, 20.0 * b);
            largest(errors(&advance(&start, a, b, s), &exact(&start, a, b, s)))
        })
        .collect();
    found.sort_by(f64::total_cmp);
    println!("strong: median {:.1e}, 99 % {:.1e}, worst {:.1e}", found[250], found[495], found[499]);
    assert!(found[250] < 3e-14 && found[495] < 1e-12);
}

#[test]
fn single_precision() {
    let mut random = Random::new(5);
    let mut found: Vec<f64> = (0..2_000)
        .map(|_| {
            let (start, a, b, s) = segment(&mut random);
            let [x, y, phi, kappa, a, b, s] = [start.x, start.y, start.phi, start.kappa, a, b, s].map(|v| v as f32);
            let end = advance(&Section { x, y, phi, kappa }, a, b, s);
            let wide = |v: Section<f32>| Section {
                x: f64::from(v.x),
                y: f64::from(v.y),
                phi: f64::from(v.phi),
                kappa: f64::from(v.kappa),
            };
            let exact = exact(&wide(Section { x, y, phi, kappa }), f64::from(a), f64::from(b), f64::from(s));
            largest(errors(&wide(end), &exact))
        })
        .collect();
    found.sort_by(f64::total_cmp);
    println!("f32: median {:.1e}, worst {:.1e}", found[1_000], found[1_999]);
    assert!(found[1_000] < 8e-7 && found[1_999] < 2e-5);
}

/// The error of the end in `f32` of these numbers, exactly as they are: by `advance`, and by `walk` in so many steps.
fn errors_in_f32(start: &Section, a: f64, b: f64, s: f64, steps: usize) -> [f64; 2] {
    let [x, y, phi, kappa, a, b, s] = [start.x, start.y, start.phi, start.kappa, a, b, s].map(|v| v as f32);
    let start = Section { x, y, phi, kappa };
    let wide = |v: Section<f32>| Section {
        x: f64::from(v.x),
        y: f64::from(v.y),
        phi: f64::from(v.phi),
        kappa: f64::from(v.kappa),
    };
    let exact = exact(&wide(start), f64::from(a), f64::from(b), f64::from(s));
    let walked = walk(&start, a, b, s, steps).last().unwrap();
    [advance(&start, a, b, s), walked].map(|end| largest(errors(&wide(end), &exact)))
}

#[test]
fn walks_in_single_precision() {
    let mut random = Random::new(7);
    let worst = (0..2_000)
        .map(|_| {
            let (start, a, b, s) = segment(&mut random);
            errors_in_f32(&start, a, b, s, 1 + (random.within(1.0).abs() * 300.0) as usize)[1]
        })
        .fold(0.0, f64::max);
    println!("f32 walk: worst {worst:.1e}");
    assert!(worst < 4e-5);
}

#[test]
fn coils_are_counted_in_single_precision() {
    let mut random = Random::new(8);
    let worst = (0..300)
        .map(|_| {
            let (start, a, b, s) = segment(&mut random);
            let start = Section { kappa: random.within(100.0), ..start };
            errors_in_f32(&start, a, b, s, 10)[0] / start.kappa.abs().max(6.0)
        })
        .fold(0.0, f64::max);
    println!("f32 coils: worst {worst:.1e} of kappa");
    assert!(worst < 5e-6);
}

#[test]
fn sensitivities_are_the_slopes_of_the_exact_solution() {
    // central differences of the 32-digit solution are good to h^2 = 1e-16 of the third derivative
    let h = 1e-8;
    let mut random = Random::new(6);
    let mut worst: f64 = 0.0;
    for i in 0..300 {
        let (start, mut a, mut b, s) = segment(&mut random);
        // with and without force, where the closed form's parts have no derivative
        let mut start = start;
        match i % 6 {
            0 => (a, b) = (0.0, 0.0),
            1 => (a, b) = (1e-12 * a, 1e-12 * b),
            2 => (a, b) = (1e-170 * a, 1e-170 * b),
            3 => start.kappa = 0.0,
            _ => {}
        }
        let (end, d) = advance_with_sensitivities(&start, a, b, s);
        assert_eq!(end, advance(&start, a, b, s));
        let at = |v: [f64; 5]| exact(&Section { phi: v[0], kappa: v[1], ..start }, v[2], v[3], v[4]);
        for (k, ours) in [d.by_phi, d.by_kappa, d.by_a, d.by_b, d.by_s].into_iter().enumerate() {
            let (mut high, mut low) = ([start.phi, start.kappa, a, b, s], [start.phi, start.kappa, a, b, s]);
            high[k] += h;
            low[k] -= h;
            let (above, below) = (at(high), at(low));
            for j in 0..4 {
                let slope = f64::from(above[j] - below[j]) / (high[k] - low[k]);
                let error = (ours[j] - slope).abs() / (1.0 + slope.abs());
                assert!(error < 1e-12, "segment {i}, variable {k}, component {j}: {} {slope}", ours[j]);
                worst = worst.max(error);
            }
        }
    }
    println!("sensitivities: worst {worst:.1e}");
}
