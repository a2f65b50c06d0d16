//! Collocation along tapered and bent rods: how large its error is, measured.

use super::differences::{Interval, end, error_of_sensitivities, spread};
use super::judge::{Exact, Tapered, carried, errors};
use crate::reference::{Random, largest};
use rod_core::{Bent, Cone, Cut, Method, Ode, Profile, Propagator, RodModel, Smooth, Uniform};
use std::f64::consts::PI;
use twofloat::TwoFloat;

/// Random intervals of a rod.
struct Set {
    name: &'static str,
    rod: Tapered,
    /// Where they begin and end: anywhere between two arc lengths, or from the tip to the clamp.
    between: Option<[f64; 2]>,
    /// Largest force components, in the stiffness of the softest end.
    strength: f64,
}

const STRAIGHT: [f64; 2] = [0.0; 2];
const SETS: [Set; 5] = [
    Set {
        name: "cone 0.8, inner half",
        rod: Tapered { taper: 0.8, bend: STRAIGHT },
        between: Some([0.0, 0.5]),
        strength: 60.0,
    },
    Set {
        name: "cone 0.8, outer half",
        rod: Tapered { taper: 0.8, bend: STRAIGHT },
        between: Some([0.5, 1.0]),
        strength: 60.0,
    },
    Set {
        name: "cone 0.5, bent",
        rod: Tapered { taper: 0.5, bend: [0.5, 1.0] },
        between: Some([0.0, 1.0]),
        strength: 60.0,
    },
    Set {
        name: "cone 0.3, a spiral",
        rod: Tapered { taper: 0.3, bend: [-4.0, 12.0] },
        between: Some([0.0, 1.0]),
        strength: 20.0,
    },
    Set { name: "cone 0.8, whole", rod: Tapered { taper: 0.8, bend: STRAIGHT }, between: None, strength: 20.0 },
];

fn model(rod: Tapered) -> Smooth<Bent<Cone, impl Fn(f64) -> f64>> {
    Smooth::new(Bent::new(Cone { taper: rod.taper }, move |s| rod.natural_curvature(s))).unwrap()
}

impl Set {
    fn interval(&self, random: &mut Random) -> Interval {
        let place = |random: &mut Random, [least, most]: [f64; 2]| least + (most - least) * random.within(1.0).abs();
        let (s, to) = self.between.map_or((1.0, 0.0), |range| (place(random, range), place(random, range)));
        let soft = self.rod.stiffness(s.max(to));
        let moment = if self.between.is_some() { random.within(6.0 * soft) } else { 0.0 };
        let start = Cut { x: random.within(1.0), y: random.within(1.0), phi: random.within(PI), moment };
        let (a, b) = (random.within(self.strength * soft), random.within(self.strength * soft));
        Interval { s, start, a, b, length: to - s }
    }
}

fn solution(rod: Tapered) -> impl Fn(TwoFloat, Exact, [TwoFloat; 2], TwoFloat) -> Exact {
    move |from, start, force, to| carried(&rod, from, start, force, to)
}

#[test]
fn error_on_random_intervals() {
    for set in &SETS {
        let (mut random, model) = (Random::new(1), model(set.rod));
        let found = (0..500)
            .map(|_| {
                let interval = set.interval(&mut random);
                let Interval { s, start, a, b, length } = &interval;
                largest(errors(&model.carry(*s, start, *a, *b, *length), &end(&solution(set.rod), &interval)))
            })
            .collect();
        let [median, most, worst] = spread(found);
        println!("{}: median {median:.1e}, 99 % {most:.1e}, worst {worst:.1e}", set.name);
        assert!(median < 1e-14 && worst < 1e-12, "{}", set.name);
    }
}

#[test]
fn sensitivities_are_the_derivatives_of_the_exact_solution() {
    for set in &SETS {
        let (mut random, model) = (Random::new(2), model(set.rod));
        let found = (0..100)
            .map(|_| {
                let interval = set.interval(&mut random);
                let Interval { s, start, a, b, length } = interval;
                let (end, ours) = model.carry_with_sensitivities(s, &start, a, b, length);
                assert_eq!(end, model.carry(s, &start, a, b, length));
                error_of_sensitivities(&solution(set.rod), &interval, &ours)
            })
            .collect();
        let [median, most, worst] = spread(found);
        println!("{}: median {median:.1e}, 99 % {most:.1e}, worst {worst:.1e}", set.name);
        assert!(median < 1e-13 && worst < 1e-11, "{}", set.name);
    }
}

#[test]
fn agrees_with_dop853() {
    for set in &SETS {
        let (mut random, model, rod) = (Random::new(3), model(set.rod), set.rod);
        let law = move |s: f64, m: f64| m / rod.stiffness(s) + rod.natural_curvature(s);
        let ode = Ode::with_law(law, Method::Dop853, 1e-13).unwrap();
        for _ in 0..100 {
            let Interval { s, start, a, b, length } = set.interval(&mut random);
            let (ours, theirs) = (model.carry(s, &start, a, b, length), ode.advance(s, &start, a, b, length).unwrap());
            let off = [ours.x - theirs.x, ours.y - theirs.y, ours.phi - theirs.phi, ours.moment - theirs.moment];
            assert!(largest(off.map(f64::abs)) < 1e-11, "{}: {off:?}", set.name);
        }
    }
}

#[test]
fn no_taper_and_no_bend_is_the_uniform_rod() {
    let mut random = Random::new(4);
    let cone = Smooth::new(Cone { taper: 0.0 }).unwrap();
    let mut worst: f64 = 0.0;
    for _ in 0..1_000 {
        let start = Cut { x: 0.1, y: 0.2, phi: random.within(PI), moment: random.within(6.0) };
        let (a, b, s, to) =
            (random.within(20.0), random.within(20.0), random.within(1.0).abs(), random.within(1.0).abs());
        let (ours, exact) = (cone.carry(s, &start, a, b, to - s), Uniform.carry(s, &start, a, b, to - s));
        let off = [ours.x - exact.x, ours.y - exact.y, ours.phi - exact.phi, ours.moment - exact.moment];
        worst = worst.max(largest(off.map(f64::abs)));
    }
    println!("taper 0: worst {worst:.1e}");
    assert!(worst < 1e-12);
    // and slight tapers and bends differ from it by as much as they are slight
    let start = Cut { x: 0.0, y: 0.0, phi: 0.4, moment: 1.5 };
    let uniform = Uniform.carry(0.0, &start, 3.0, -2.0, 1.0).phi;
    for slight in [1e-3, 1e-6, 1e-9, 1e-12] {
        let rod = Smooth::new(Bent::new(Cone { taper: slight }, |_| slight)).unwrap();
        let off = rod.carry(0.0, &start, 3.0, -2.0, 1.0).phi - uniform;
        assert!(off.abs() < 10.0 * slight + 1e-15 && off.abs() > 0.1 * slight - 1e-15, "{slight}: {off}");
    }
}

/// A profile that jumps at a third, and is steep beside it.
struct Stepped;

impl Profile for Stepped {
    fn stiffness(&self, s: f64) -> f64 {
        if s < 1.0 / 3.0 { 1.0 + s } else { 0.2 * (-2.0 * s).exp() }
    }
    fn natural_curvature(&self, s: f64) -> f64 {
        if s < 1.0 / 3.0 { 0.5 } else { (5.0 * s).sin() }
    }
}

#[test]
fn jumps_at_borders_are_exact() {
    let third = 1.0 / 3.0;
    let rod = Smooth::with_borders(Stepped, &[third]).unwrap();
    let ode =
        Ode::with_law(|s, m| m / Stepped.stiffness(s) + Stepped.natural_curvature(s), Method::Dop853, 1e-13).unwrap();
    let start = Cut { x: 0.0, y: 0.0, phi: 0.3, moment: 0.4 };
    // the integrator is taken up to the jump, and on from it
    let before = third - f64::EPSILON;
    let half = ode.advance(0.0, &start, 0.3, -0.2, before).unwrap();
    let theirs = ode.advance(third, &half, 0.3, -0.2, 1.0 - third).unwrap();
    let (ours, d) = rod.carry_with_sensitivities(0.0, &start, 0.3, -0.2, 1.0);
    assert!((ours.x - theirs.x).abs() + (ours.y - theirs.y).abs() + (ours.phi - theirs.phi).abs() < 1e-11);
    // there and back, also with the joint for an end
    for at in [1.0, third, 0.7] {
        let end = rod.carry(0.0, &start, 0.3, -0.2, at);
        let back = rod.carry(at, &end, 0.3, -0.2, -at);
        assert!((back.x).abs() + (back.y).abs() + (back.phi - 0.3).abs() + (back.moment - 0.4).abs() < 1e-12, "{at}");
    }
    // at the joint each side has its own curvature
    let (end, d_there) = rod.carry_with_sensitivities(0.0, &start, 0.3, -0.2, third);
    assert!((d_there.by_to[2] - (end.moment / (4.0 / 3.0) + 0.5)).abs() < 1e-12);
    let (_, d_on) = rod.carry_with_sensitivities(third, &end, 0.3, -0.2, 1e-3);
    let stiffness = 0.2 * (-2.0 * third).exp();
    let kappa = end.moment / stiffness + (5.0 * third).sin();
    let moved = -(kappa * d_on.by_phi[2] + (0.3 * end.phi.cos() - 0.2 * end.phi.sin()) * d_on.by_moment[2]);
    assert!((d_on.by_from[2] - moved).abs() < 1e-9, "{} {moved}", d_on.by_from[2]);
    assert!(d.by_a[2].is_finite());
}
