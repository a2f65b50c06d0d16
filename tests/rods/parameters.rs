//! Derivatives by what makes a rod and its clamp, against differences of order 6 of equilibria and sweeps of changed ones.

use super::scans::{cone, o1};
use std::f64::consts::FRAC_PI_2;
use vibrissa::contact::{Derivatives, Quantity, TransitionDerivatives};
use vibrissa::rod::{ElasticClamp, Mounted, Pose, RodParameter, RodSection, VaryingRod};
use vibrissa::{ClampPath, Rod, State, Sweep, equilibrium};

/// What a rod and its clamp are made of.
#[derive(Clone, Copy)]
struct Numbers {
    taper: Option<f64>,
    /// Stiffness and natural curvature.
    sections: [[f64; 2]; 2],
    bend: f64,
    stiffness: f64,
    length: f64,
    springs: [f64; 3],
}

const SOFT: Numbers = Numbers {
    taper: None,
    sections: [[1.0, 0.1], [0.5, -0.2]],
    bend: 0.0,
    stiffness: 1.0,
    length: 1.0,
    springs: [300.0, 100.0, 20.0],
};

impl Numbers {
    fn rod(&self) -> Mounted<VaryingRod> {
        let Self { taper, sections, bend, stiffness, length, springs: [x, y, phi] } = *self;
        let rod = match taper {
            Some(taper) => {
                let base = 0.01_f64;
                let youngs_modulus = stiffness * 64.0 / (std::f64::consts::PI * base.powi(4));
                let straight = Rod::tapered(length, base, base * (1.0 - taper), youngs_modulus).unwrap();
                straight.with_natural_curvature(bend / length).unwrap()
            }
            None => {
                let section = |[own, curvature]: [f64; 2]| RodSection {
                    length: 0.5 * length,
                    bending_stiffness: own * stiffness,
                    natural_curvature: (curvature + bend) / length,
                };
                Rod::sections(length, &sections.map(section)).unwrap()
            }
        };
        Mounted::new(rod, ElasticClamp::springs(Some(x), Some(y), Some(phi)).unwrap())
    }
}

/// What is changed, and by what it is differentiated.
enum By {
    Rod(RodParameter),
    Quantity(Quantity<'static>),
}

type Change = (By, fn(&mut Numbers, f64));

fn changes(tapered: bool) -> Vec<Change> {
    let mut all: Vec<Change> = vec![
        (By::Rod(RodParameter::NaturalCurvature), |n, h| n.bend += h),
        (By::Quantity(Quantity::Stiffness), |n, h| n.stiffness += h),
        // stretched with it, curvature and all
        (By::Quantity(Quantity::Length), |n, h| n.length += h),
        (By::Quantity(Quantity::ClampStiffnessX), |n, h| n.springs[0] += 100.0 * h),
        (By::Quantity(Quantity::ClampStiffnessY), |n, h| n.springs[1] += 100.0 * h),
        (By::Quantity(Quantity::ClampStiffnessPhi), |n, h| n.springs[2] += 10.0 * h),
    ];
    if tapered {
        all.push((By::Rod(RodParameter::Taper), |n, h| *n.taper.as_mut().unwrap() += h));
    } else {
        all.push((By::Rod(RodParameter::SectionStiffness(0)), |n, h| n.sections[0][0] += h));
        all.push((By::Rod(RodParameter::SectionStiffness(1)), |n, h| n.sections[1][0] += h));
        all.push((By::Rod(RodParameter::SectionCurvature(0)), |n, h| n.sections[0][1] += h));
        all.push((By::Rod(RodParameter::SectionCurvature(1)), |n, h| n.sections[1][1] += h));
    }
    all
}

/// Units of the change that [`changes`] makes.
fn unit(by: &By) -> f64 {
    match by {
        By::Quantity(Quantity::ClampStiffnessX | Quantity::ClampStiffnessY) => 100.0,
        By::Quantity(Quantity::ClampStiffnessPhi) => 10.0,
        _ => 1.0,
    }
}

fn at(x: f64) -> Pose {
    Pose { x, y: -0.4, phi: FRAC_PI_2 }
}

/// A difference of order 6.
fn slope(h: f64, of: impl Fn(f64) -> f64) -> f64 {
    let across = |steps: f64| of(steps * h) - of(-steps * h);
    (45.0 * across(1.0) - 9.0 * across(2.0) + across(3.0)) / (60.0 * h)
}

#[test]
fn states_change_as_derivatives_say() {
    let object = o1();
    let (mut compared, mut worst) = (0, 0.0_f64);
    for numbers in [SOFT, Numbers { taper: Some(0.6), bend: 0.2, ..SOFT }] {
        let rod = numbers.rod();
        let path = ClampPath::new(at(1.0), at(-1.0)).unwrap();
        let states = Sweep::new(&rod, &object, path, 0.083).unwrap().run().states;
        for state in states.iter().filter(|state| !state.contacts.is_empty()) {
            let derivatives = Derivatives::new(&rod, &object, state).unwrap();
            if derivatives.condition() > 1e4 {
                continue;
            }
            for (by, change) in changes(numbers.taper.is_some()) {
                let found = match by {
                    By::Rod(parameter) => derivatives.by_rod(&rod, parameter).unwrap(),
                    By::Quantity(quantity) => derivatives.by(quantity).unwrap(),
                };
                let of = |h: f64| -> State {
                    let mut changed = numbers;
                    change(&mut changed, h);
                    let found = equilibrium(&changed.rod(), &object, state.pose, &state.contacts).unwrap();
                    assert!(found.report.status.is_solved());
                    found.state
                };
                let mut check = |what: f64, pick: &dyn Fn(&State) -> f64| {
                    let slope = slope(3e-4, |h| pick(&of(h))) / unit(&by);
                    worst = worst.max((what - slope).abs() * unit(&by) / (1.0 + slope.abs()));
                };
                check(found.reactions.f0x, &|state| state.reactions.f0x);
                check(found.reactions.m0z, &|state| state.reactions.m0z);
                for (j, contact) in found.contacts.iter().enumerate() {
                    check(contact.force, &|state| state.contacts[j].force);
                    check(contact.s, &|state| state.contacts[j].s);
                    check(contact.x, &|state| state.contacts[j].x);
                }
                compared += 1;
            }
        }
    }
    assert!(compared > 200 && worst < 1e-8, "{compared} {worst:e}");
}

/// Of a uniform rod the derivative has a closed form; one of a section is a rod as any other.
#[test]
fn a_uniform_rod_is_bent_at_rest_as_one_of_a_section_is() {
    let object = o1();
    let springs = ElasticClamp::springs(Some(300.0), Some(100.0), Some(20.0)).unwrap();
    let uniform = Mounted::new(Rod::new(1.0, 1.0).unwrap(), springs);
    let section = |bend: f64| RodSection { length: 1.0, bending_stiffness: 1.0, natural_curvature: bend };
    let of_section = |bend: f64| Mounted::new(Rod::sections(1.0, &[section(bend)]).unwrap(), springs);
    let path = ClampPath::new(at(1.0), at(-1.0)).unwrap();
    let states = Sweep::new(&uniform, &object, path, 0.083).unwrap().run().states;
    let (mut compared, mut worst) = (0, 0.0_f64);
    for state in states.iter().filter(|state| !state.contacts.is_empty()) {
        let derivatives = Derivatives::new(&uniform, &object, state).unwrap();
        if derivatives.condition() > 1e4 {
            continue;
        }
        let found = derivatives.by_rod(&uniform, RodParameter::NaturalCurvature).unwrap();
        let of = |h: f64| equilibrium(&of_section(h), &object, state.pose, &state.contacts).unwrap().state;
        let mut check = |what: f64, pick: &dyn Fn(&State) -> f64| {
            let slope = slope(3e-4, |h| pick(&of(h)));
            worst = worst.max((what - slope).abs() / (1.0 + slope.abs()));
        };
        check(found.reactions.f0x, &|state| state.reactions.f0x);
        check(found.reactions.m0z, &|state| state.reactions.m0z);
        for (j, contact) in found.contacts.iter().enumerate() {
            check(contact.force, &|state| state.contacts[j].force);
            check(contact.s, &|state| state.contacts[j].s);
        }
        compared += 1;
    }
    assert!(compared > 10 && worst < 1e-8, "{compared} {worst:e}");
}

#[test]
fn transitions_move_as_derivatives_say() {
    let object = o1();
    let path = ClampPath::new(at(0.7), at(-0.9)).unwrap();
    let (mut compared, mut worst) = (0, 0.0_f64);
    for numbers in [SOFT, Numbers { taper: Some(0.6), bend: 0.2, ..SOFT }] {
        let rod = numbers.rod();
        let events = Sweep::new(&rod, &object, path, 0.2).unwrap().run().events;
        for (by, change) in changes(numbers.taper.is_some()) {
            let swept = |h: f64| {
                let mut changed = numbers;
                change(&mut changed, h);
                Sweep::new(&changed.rod(), &object, path, 0.2).unwrap().run().events
            };
            let steps = [-3.0, -2.0, -1.0, 1.0, 2.0, 3.0].map(|steps| (steps * 3e-4, swept(steps * 3e-4)));
            for (k, event) in events.iter().enumerate() {
                let derivatives = TransitionDerivatives::new(&rod, &object, event, path.rate()).unwrap();
                let found = match by {
                    By::Rod(parameter) => derivatives.by_rod(&rod, parameter).unwrap(),
                    By::Quantity(quantity) => derivatives.by(quantity).unwrap(),
                };
                // the path runs to -x
                let moved = |h: f64| {
                    let (_, events) = steps.iter().find(|(step, _)| (step - h).abs() < 1e-9).unwrap();
                    assert_eq!((events.len(), events[k].kind), (steps[0].1.len(), event.kind));
                    -events[k].pose().x
                };
                let slope = slope(3e-4, moved) / unit(&by);
                worst = worst.max((found - slope).abs() * unit(&by) / (1.0 + slope.abs()));
                compared += 1;
            }
        }
    }
    assert!(compared > 80 && worst < 1e-7, "{compared} {worst:e}");
}

#[test]
fn a_parameter_that_a_rod_does_not_have_is_named() {
    let (object, rod) = (o1(), SOFT.rod());
    let path = ClampPath::new(at(0.4), at(0.2)).unwrap();
    let state = Sweep::new(&rod, &object, path, 0.1).unwrap().run().states.pop().unwrap();
    let derivatives = Derivatives::new(&rod, &object, &state).unwrap();
    for (parameter, name) in [
        (RodParameter::Taper, "taper"),
        (RodParameter::SectionStiffness(2), "bending stiffness of section 2"),
        (RodParameter::SectionCurvature(7), "natural curvature of section 7"),
    ] {
        let error = derivatives.by_rod(&rod, parameter).unwrap_err().to_string();
        assert!(error.contains(name), "{error}");
    }
    let error = derivatives.by_rod(&cone(0.8), RodParameter::Taper).unwrap_err().to_string();
    assert!(error.contains("of another rod"), "{error}");
}
