//! Results of a sweep through JSON and back.
#![allow(clippy::unwrap_used)]

use std::f64::consts::FRAC_PI_2;
use vibrissa::contact::{Outcome, Phase};
use vibrissa::{ClampPath, Composite, Parabola, Pose, Rod, State, Sweep, equilibrium};

fn read_again<T: serde::Serialize + serde::de::DeserializeOwned>(value: &T) -> T {
    serde_json::from_str(&serde_json::to_string(value).unwrap()).unwrap()
}

#[test]
fn a_sweep_survives() {
    let rod = Rod::new(0.1, 6e-4).unwrap();
    let object = Composite::single(Parabola::new([0.0, 0.0], 50.0).unwrap()).unwrap();
    let pose = |x| Pose { x, y: -0.04, phi: FRAC_PI_2 };
    let path = ClampPath::new(pose(0.09), pose(-0.09)).unwrap();
    let outcome: Outcome = Sweep::new(&rod, &object, path, 0.01).unwrap().run();
    assert_eq!(outcome.states[0].phase(), Phase::FREE);
    assert_eq!(outcome.states[0].certificate.min_force, None);
    assert_eq!(read_again(&outcome), outcome);
}

#[test]
fn infinite_bounds_survive() {
    let free = equilibrium(&Rod::new(1.0, 1.0).unwrap(), &[], Pose { x: 0.0, y: 0.0, phi: 0.0 }, &[]).unwrap();
    let mut state: State = free.state;
    state.certificate.min_gap.lower = f64::NEG_INFINITY;
    state.certificate.min_gap.seen = f64::INFINITY;
    assert_eq!(read_again(&state), state);
}

#[test]
fn names_are_those_of_the_command() {
    let phase: Phase = "BBA".parse().unwrap();
    assert_eq!(serde_json::to_string(&phase).unwrap(), "\"BBA\"");
    assert_eq!(read_again(&phase), phase);
    assert!(serde_json::from_str::<Phase>("\"AB\"").is_err());
}
