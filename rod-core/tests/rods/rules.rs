//! The numbered rules of `RodModel`, for all models; symmetries of the equations; bad input.

use crate::reference::{Random, largest};
use rod_core::{Bent, Cone, Cut, Rod, RodError, RodModel, RodSection, Sections, Segment, Smooth, Uniform};
use std::f64::consts::PI;

fn sections() -> Sections {
    let section =
        |length, bending_stiffness, natural_curvature| RodSection { length, bending_stiffness, natural_curvature };
    Sections::new(&[section(0.3, 1.0, 0.4), section(0.3, 0.5, 0.0), section(0.4, 0.2, -1.0)]).unwrap()
}

fn models() -> Vec<(&'static str, Box<dyn RodModel>)> {
    vec![
        ("uniform", Box::new(Uniform)),
        ("sections", Box::new(sections())),
        ("cone", Box::new(Smooth::new(Cone { taper: 0.8 }).unwrap())),
        ("bent cone", Box::new(Smooth::new(Bent::new(Cone { taper: 0.5 }, |s| 0.5 + s)).unwrap())),
        ("from SI units", Box::new(Rod::tapered(0.1, 1e-3, 4e-4, 206e9).unwrap().with_natural_curvature(3.0).unwrap())),
        (
            "diameters",
            Box::new(
                Rod::from_diameters(0.1, &[[0.0, 1e-3], [0.03, 0.9e-3], [0.06, 0.95e-3], [0.1, 4e-4]], 206e9).unwrap(),
            ),
        ),
        ("closure", Box::new(Smooth::new(|s: f64| (-s).exp()).unwrap())),
    ]
}

fn distance(u: &Cut, v: &Cut) -> f64 {
    largest([u.x - v.x, u.y - v.y, u.phi - v.phi, u.moment - v.moment].map(f64::abs))
}

#[test]
fn rules_1_to_5() {
    let mut random = Random::new(5);
    for _ in 0..200 {
        let start = Cut { x: 0.1, y: -0.2, phi: random.within(PI), moment: random.within(0.1) };
        let (a, b) = (random.within(0.5), random.within(0.5));
        // beyond the ends too
        let [from, through, to] = [0.0; 3].map(|_| 0.5 + random.within(0.7));
        for (name, rod) in models() {
            assert_eq!(rod.carry(from, &start, a, b, 0.0), start, "rule 1: {name}");
            let whole = rod.carry(from, &start, a, b, to - from);
            let parts = rod.carry(through, &rod.carry(from, &start, a, b, through - from), a, b, to - through);
            assert!(distance(&parts, &whole) < 1e-11, "rule 2: {name} {:e}", distance(&parts, &whole));
            let balance = whole.moment - start.moment - a * (whole.x - start.x) - b * (whole.y - start.y);
            assert!(balance.abs() < 1e-14, "rule 3: {name} {balance:e}");
            let (end, d) = rod.carry_with_sensitivities(from, &start, a, b, to - from);
            assert!(distance(&end, &whole) < 1e-14, "rule 4: {name}");
            // fourth differences: near the soft tip of a cone second ones err by 1e-6
            let step = 1e-4;
            let moved = |ds: f64| {
                let Cut { x, y, phi, moment } = rod.carry(from + ds, &start, a, b, to - from - ds);
                [x, y, phi, moment]
            };
            let [up, down, far_up, far_down] = [step, -step, 2.0 * step, -2.0 * step].map(moved);
            let slope: [f64; 4] =
                std::array::from_fn(|i| (8.0 * (up[i] - down[i]) - (far_up[i] - far_down[i])) / (12.0 * step));
            // differences across a joint are none
            let joint = [0.0, 0.3, 0.6, 1.0].into_iter().any(|joint: f64| (joint - from).abs() <= 2.0 * step);
            let off = largest(std::array::from_fn(|i| (slope[i] - d.by_from[i]).abs() / (1.0 + slope[i].abs())));
            assert!(joint || off < 1e-6, "rule 4: {name} {off:e}");
        }
    }
    for (name, rod) in models() {
        for end in [0.0, 1.0] {
            let (inside, outside) = (rod.curvature_at(end - 1e-9, 0.3), rod.curvature_at(end + 1e-9, 0.3));
            assert!((inside - outside).abs() < 1e-5 * (1.0 + inside.abs()), "rule 5: {name} {inside} {outside}");
        }
    }
}

#[test]
fn rule_6() {
    let mut random = Random::new(8);
    for (name, rod) in models() {
        let mut slack: f64 = 0.0;
        for _ in 0..100 {
            let start = Cut { x: 0.0, y: 0.0, phi: random.within(PI), moment: random.within(0.2) };
            let (a, b) = (random.within(0.5), random.within(0.5));
            let (first, second) = (0.5 + random.within(0.6), 0.5 + random.within(0.6));
            let (from, to) = (first.min(second), first.max(second));
            let moment = |s: f64| rod.carry(from, &start, a, b, s - from).moment;
            let (low, high) = rod.curvature_bounds((from, start.moment), (to, moment(to)), a.hypot(b));
            for i in 0..=60 {
                let s = from + (to - from) * f64::from(i) / 60.0;
                let kappa = rod.curvature_at(s, moment(s));
                // where sections meet, the place itself counts to the next one
                let is_in = kappa >= low - 1e-9 && kappa <= high + 1e-9;
                assert!(is_in || i == 60 && name == "sections", "rule 6: {name} {s}: {low} {kappa} {high}");
            }
            // next to each other the places leave no more than their distance
            let near = 1e-4;
            let (low, high) =
                rod.curvature_bounds((from, start.moment), (from + near, moment(from + near)), a.hypot(b));
            let jumps = [0.3, 0.6].iter().any(|joint| (joint - from) * (joint - from - near) <= 0.0);
            slack = if jumps && name == "sections" { slack } else { slack.max(high - low) };
        }
        println!("{name}: range of the curvature over 1e-4: {slack:.1e}");
        assert!(slack < 0.3, "rule 6: {name} {slack}");
    }
}

#[test]
fn rule_6_of_the_sign() {
    let mut random = Random::new(9);
    for (name, rod) in models() {
        let (mut told, mut changes) = (0, 0);
        for k in 0..600 {
            let start = Cut { x: 0.0, y: 0.0, phi: random.within(PI), moment: random.within(0.3) };
            // some so strong that the curvature changes its sign twice
            let strength = [0.5, 5.0, 200.0][k % 3] * rod.least_stiffness(0.0, 1.0).sqrt();
            let (a, b) = (random.within(strength), random.within(strength));
            let (first, second) = (0.5 + random.within(0.6), 0.5 + random.within(0.6));
            let (from, to) = (first.min(second), first.max(second));
            let moment = |s: f64| rod.carry(from, &start, a, b, s - from).moment;
            let curvatures: Vec<f64> = (0..60)
                .map(|i| from + (to - from) * (f64::from(i) + 0.5) / 60.0)
                .map(|s| rod.curvature_at(s, moment(s)))
                .collect();
            changes += usize::from(curvatures.windows(2).any(|pair| pair[0] * pair[1] < 0.0));
            let Some(sign) = rod.one_bend((from, start.moment), (to, moment(to)), a.hypot(b)) else { continue };
            told += 1;
            let rounding = 1e-9 * curvatures.iter().fold(1.0, |most: f64, kappa| most.max(kappa.abs()));
            let keeps = |kappa: &f64| kappa * sign > -rounding && (sign != 0.0 || kappa.abs() < rounding);
            assert!(curvatures.iter().all(keeps), "rule 6: {name} {sign} {curvatures:?}");
        }
        println!("{name}: of 600 segments {told} are told to keep the sign of their curvature, {changes} do not");
        assert!(told > 60 && changes > 60, "rule 6: {name} {told} {changes}");
    }
}

#[test]
fn rule_7() {
    let good = [0.2, 0.0, 0.0, 0.3, 1.0, 2.0, 3.0, 0.5];
    for (name, rod) in models() {
        for i in 0..good.len() {
            for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300] {
                let mut v = good;
                v[i] = bad;
                let [s, x, y, phi, moment, a, b, length] = v;
                let (end, d) = rod.carry_with_sensitivities(s, &Cut { x, y, phi, moment }, a, b, length);
                let all = [end.x, end.y, end.phi, end.moment, d.by_phi[0], d.by_moment[1]];
                let asked = !(name == "uniform" && i == 0);
                assert!(bad == 1e300 || !asked || all.iter().any(|v| !v.is_finite()), "{name} {i} {bad}: {end:?}");
            }
        }
    }
}

/// A rod of one model mirrored, turned, scaled or walked from its other end is a rod of another.
#[test]
fn symmetries() {
    let rod = Smooth::new(Bent::new(Cone { taper: 0.7 }, |s| 0.5 + s)).unwrap();
    let mirrored = Smooth::new(Bent::new(Cone { taper: 0.7 }, |s| -0.5 - s)).unwrap();
    // from the tip: E I (1 - s), and a curvature that turns the other way
    let reversed = Smooth::new(Bent::new(|s: f64| (1.0 - 0.7 * (1.0 - s)).powi(4), |s| -(0.5 + 1.0 - s))).unwrap();
    let mut random = Random::new(6);
    for _ in 0..200 {
        let start = Cut { x: 0.0, y: 0.0, phi: random.within(PI), moment: random.within(0.1) };
        let (a, b, length) = (random.within(0.5), random.within(0.5), random.within(1.0).abs());
        let end = rod.carry(0.0, &start, a, b, length);
        let other = mirrored.carry(0.0, &Cut { phi: -start.phi, moment: -start.moment, ..start }, -a, b, length);
        let mirror = Cut { x: other.x, y: -other.y, phi: -other.phi, moment: -other.moment };
        assert!(distance(&mirror, &end) < 1e-14, "mirrored: {:e}", distance(&mirror, &end));

        let (sin, cos) = 0.7_f64.sin_cos();
        let turned =
            rod.carry(0.0, &Cut { phi: start.phi + 0.7, ..start }, a * cos - b * sin, a * sin + b * cos, length);
        let back = Cut {
            x: cos * turned.x + sin * turned.y,
            y: cos * turned.y - sin * turned.x,
            phi: turned.phi - 0.7,
            ..turned
        };
        assert!(distance(&back, &end) < 1e-13, "turned: {:e}", distance(&back, &end));

        // seen from the end, the tangent points the other way, and so do moment and force of the other side
        let seen = Cut { phi: end.phi + PI, moment: -end.moment, ..end };
        let there = reversed.carry(1.0 - length, &seen, -a, -b, length);
        let there = Cut { phi: there.phi - PI, moment: -there.moment, ..there };
        assert!(distance(&there, &start) < 1e-11, "reversed: {:e}", distance(&there, &start));

        // stiffness, moment and force c times as large
        let c = 3.0;
        let stiff = Smooth::new(Bent::new(|s: f64| c * (1.0 - 0.7 * s).powi(4), |s| 0.5 + s)).unwrap();
        let same = stiff.carry(0.0, &Cut { moment: c * start.moment, ..start }, c * a, c * b, length);
        let same = Cut { moment: same.moment / c, ..same };
        assert!(distance(&same, &end) < 1e-13, "scaled: {:e}", distance(&same, &end));
    }
}

/// 1/2 int m^2 / EI ds by Simpson's rule, and the largest curvature of samples.
fn sampled(rod: &dyn RodModel, segment: &Segment<Cut>, to: f64, n: usize) -> (f64, f64) {
    let h = (to - segment.s) / n as f64;
    let at = |i: usize| {
        let s = segment.s + h * i as f64;
        let moment = rod.carry(segment.s, &segment.start, segment.a, segment.b, s - segment.s).moment;
        let bent = rod.curvature_at(s, moment);
        (0.5 * moment * (bent - rod.natural_curvature(s)), bent.abs())
    };
    let points: Vec<_> = (0..=n).map(at).collect();
    let energy = (0..n).step_by(2).map(|i| h / 3.0 * (points[i].0 + 4.0 * points[i + 1].0 + points[i + 2].0)).sum();
    (energy, points.iter().fold(0.0, |most, point| most.max(point.1)))
}

#[test]
fn energy_and_largest_curvature_are_those_of_samples() {
    let mut random = Random::new(7);
    for (name, rod) in models() {
        for _ in 0..10 {
            let start = Cut { x: 0.0, y: 0.0, phi: random.within(PI), moment: random.within(0.2) };
            let segment = Segment { s: 0.0, start, a: random.within(0.5), b: random.within(0.5) };
            let end = rod.carry(0.0, &start, segment.a, segment.b, 1.0);
            let (energy, most) = sampled(&*rod, &segment, 1.0, 600);
            let ours = rod.bending_energy(&segment, 1.0, &end);
            // joints of the sections lie on multiples of 1/300, where the samples see one side
            let rule = if name == "sections" { 2e-3 } else { 1e-7 };
            assert!((ours - energy).abs() < rule * (1.0 + energy), "{name}: {ours} {energy}");
            let largest = rod.largest_curvature(&segment, 1.0, &end);
            assert!(largest >= most - 1e-9 && largest - most < 3e-4 * (1.0 + most), "{name}: {largest} {most}");
        }
    }
}

#[test]
fn bad_input_names_field_value_and_expectation() {
    let section =
        |length, bending_stiffness, natural_curvature| RodSection { length, bending_stiffness, natural_curvature };
    let message = |result: Result<(), RodError>| result.unwrap_err().to_string();
    let of_sections = |sections: &[RodSection]| message(Sections::new(sections).map(|_| ()));
    let of_profile = |profile: &dyn Fn(f64) -> f64, borders: &[f64]| {
        message(Smooth::with_borders(|s: f64| profile(s), borders).map(|_| ()))
    };
    for (message, expected) in [
        (of_sections(&[]), ["number of sections", "0", "positive"]),
        (of_sections(&[section(0.5, 1.0, 0.0)]), ["add up", "0.5", "expected 1"]),
        (
            of_sections(&[section(0.5, 1.0, 0.0), section(0.5, 0.0, 0.0)]),
            ["bending_stiffness of section 1", "is 0,", "positive"],
        ),
        (
            of_sections(&[section(-0.5, 1.0, 0.0), section(1.5, 1.0, 0.0)]),
            ["length of section 0", "is -0.5,", "positive"],
        ),
        (of_sections(&[section(1.0, 1.0, f64::NAN)]), ["natural_curvature of section 0", "is NaN,", "finite"]),
        (of_profile(&|s| 0.5 - s, &[]), ["stiffness is -", "arc length", "positive"]),
        (of_profile(&|_| f64::NAN, &[]), ["stiffness is NaN", "arc length", "positive"]),
        (of_profile(&|s| if s < 0.4 { 1.0 } else { 0.5 }, &[]), ["not smooth", "0.", "border"]),
        (of_profile(&|s| 1.0 - 0.5 * (s - 0.31).abs(), &[]), ["not smooth", "0.", "border"]),
        (of_profile(&|_| 1.0, &[0.4, 0.4]), ["border", "0.4", "more than 0.4"]),
        (of_profile(&|_| 1.0, &[1.0]), ["border", "1", "less than the length"]),
        (of_profile(&|_| 1.0, &[f64::NAN]), ["border", "NaN", "less than the length"]),
        (
            message(Smooth::new(Bent::new(Cone { taper: 0.5 }, |s| 1.0 / (s - s))).map(|_| ())),
            ["natural curvature is", "arc length", "finite"],
        ),
        (message(Smooth::new(Cone { taper: 1.1 }).map(|_| ())), ["not smooth", "0.", "border"]),
    ] {
        assert!(expected.iter().all(|part| message.contains(part)), "{message} {expected:?}");
    }
    // what jumps at a border is smooth beside it
    assert!(Smooth::with_borders(|s: f64| if s < 0.4 { 1.0 } else { 0.5 }, &[0.4]).is_ok());
}
