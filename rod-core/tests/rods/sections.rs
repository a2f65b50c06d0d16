//! Rods of uniform sections: exact, and what they tend to when they become short.

use super::differences::{Interval, end, error_of_sensitivities, spread};
use super::judge::{Exact, errors};
use crate::reference::{Random, advanced, largest};
use rod_core::{Bent, Cone, Cut, RodModel, RodSection, Sections, Smooth, Uniform};
use std::f64::consts::PI;
use twofloat::TwoFloat;

/// Two to four sections with stiffness ratios up to 30 and natural curvatures up to 2.
fn random_sections(random: &mut Random) -> Vec<RodSection> {
    let count = 2 + (random.within(1.0).abs() * 3.0) as usize;
    let lengths: Vec<f64> = (0..count).map(|_| 0.1 + random.within(1.0).abs()).collect();
    let total: f64 = lengths.iter().sum();
    lengths
        .into_iter()
        .map(|length| RodSection {
            length: length / total,
            bending_stiffness: 30_f64.powf(-random.within(1.0).abs()),
            natural_curvature: random.within(2.0),
        })
        .collect()
}

fn interval(random: &mut Random) -> Interval {
    let start =
        Cut { x: random.within(1.0), y: random.within(1.0), phi: random.within(PI), moment: random.within(0.3) };
    let (s, to) = (random.within(1.0).abs(), random.within(1.0).abs());
    Interval { s, start, a: random.within(1.0), b: random.within(1.0), length: to - s }
}

/// The judge of the uniform rod, from joint to joint: the equation holds for kappa = m / EI + kappa0 under the force over EI.
fn solution(sections: &[RodSection]) -> impl Fn(TwoFloat, Exact, [TwoFloat; 2], TwoFloat) -> Exact + '_ {
    move |from, start, force, to| {
        let mut joints = vec![TwoFloat::from(-10.0)];
        let mut sum = 0.0;
        joints.extend(sections[..sections.len() - 1].iter().map(|section| {
            sum += section.length;
            TwoFloat::from(sum)
        }));
        joints.push(TwoFloat::from(10.0));
        let forward = to >= from;
        let mut order: Vec<usize> = (0..sections.len()).collect();
        if !forward {
            order.reverse();
        }
        let (mut at, mut state) = (from, start);
        for i in order {
            let (low, high) = (joints[i], joints[i + 1]);
            let next = if forward {
                if to < high { to } else { high }
            } else if to > low {
                to
            } else {
                low
            };
            if (forward && next <= at) || (!forward && next >= at) {
                continue;
            }
            let (stiffness, natural) = (sections[i].bending_stiffness, sections[i].natural_curvature);
            let [x, y, phi, moment] = state;
            let end = advanced([x, y, phi, moment / stiffness + natural], force.map(|f| f / stiffness), next - at);
            state = [end[0], end[1], end[2], (end[3] - natural) * stiffness];
            at = next;
        }
        state
    }
}

#[test]
fn error_on_random_rods() {
    let mut random = Random::new(1);
    let (mut values, mut derivatives) = (Vec::new(), Vec::new());
    for i in 0..1_000 {
        let sections = random_sections(&mut random);
        let (rod, interval) = (Sections::new(&sections).unwrap(), interval(&mut random));
        let Interval { s, start, a, b, length } = interval;
        let (ours, d) = rod.carry_with_sensitivities(s, &start, a, b, length);
        values.push(largest(errors(&ours, &end(&solution(&sections), &interval))));
        let plain = rod.carry(s, &start, a, b, length);
        assert!((plain.x - ours.x).abs() + (plain.phi - ours.phi).abs() < 1e-14);
        if i % 5 == 0 {
            derivatives.push(error_of_sensitivities(&solution(&sections), &interval, &d));
        }
    }
    let ([median, most, worst], of_derivatives) = (spread(values), spread(derivatives));
    println!("sections: median {median:.1e}, 99 % {most:.1e}, worst {worst:.1e}; derivatives: {of_derivatives:?}");
    assert!(median < 1e-15 && worst < 1e-13 && of_derivatives[0] < 1e-14 && of_derivatives[2] < 1e-11);
}

#[test]
fn a_single_section_is_the_uniform_rod_bent() {
    let straight =
        Sections::new(&[RodSection { length: 1.0, bending_stiffness: 1.0, natural_curvature: 0.0 }]).unwrap();
    let bent = Sections::new(&[RodSection { length: 1.0, bending_stiffness: 1.0, natural_curvature: 0.7 }]).unwrap();
    let start = Cut { x: 0.0, y: 0.0, phi: 0.3, moment: 1.2 };
    let uniform = Uniform.carry(0.0, &start, 2.0, -1.0, 0.8);
    let same = straight.carry(0.0, &start, 2.0, -1.0, 0.8);
    assert!((same.phi - uniform.phi).abs() < 1e-15 && (same.moment - uniform.moment).abs() < 1e-15);
    // the same curvature, so the same curve; the moment is that without the natural curvature
    let same = bent.carry(0.0, &Cut { moment: 1.2 - 0.7, ..start }, 2.0, -1.0, 0.8);
    assert!((same.phi - uniform.phi).abs() < 1e-15 && (same.moment + 0.7 - uniform.moment).abs() < 1e-15);
}

#[test]
fn many_sections_tend_to_a_cone_with_order_two() {
    let cone = Smooth::new(Bent::new(Cone { taper: 0.6 }, |s| 0.5 + s)).unwrap();
    let start = Cut { x: 0.0, y: 0.0, phi: 0.3, moment: 0.2 };
    let exact = cone.carry(0.0, &start, 0.3, -0.2, 1.0);
    let error = |n: usize| {
        let section = |i: usize| {
            let s = (i as f64 + 0.5) / n as f64;
            let bending_stiffness = (1.0 - 0.6 * s).powi(4);
            RodSection { length: 1.0 / n as f64, bending_stiffness, natural_curvature: 0.5 + s }
        };
        let rod = Sections::new(&(0..n).map(section).collect::<Vec<_>>()).unwrap();
        let end = rod.carry(0.0, &start, 0.3, -0.2, 1.0);
        (end.x - exact.x).hypot(end.y - exact.y) + (end.phi - exact.phi).abs()
    };
    let errors = [32, 64, 128, 256, 512].map(error);
    for pair in errors.windows(2) {
        let ratio = pair[0] / pair[1];
        assert!((ratio - 4.0).abs() < 0.1, "{errors:?}");
    }
    println!("sections of a cone, 32 to 512: {errors:?}");
    // two extrapolations on it agree with the cone
    let extrapolated = (4.0 * errors[4] - errors[3]).abs();
    assert!(extrapolated < 1e-3 * errors[4]);
}
