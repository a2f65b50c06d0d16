//! Random ripples against the numbered contract of the trait `Contour`.

use proptest::collection::vec;
use proptest::prelude::*;
use std::f64::consts::PI;

use custom_shape::Trochoid;
use vibrissa::contour::{Motion, Moved, Reversed, contract};
use vibrissa::{Composite, Contour, Line};

/// Random ripples over an angle that the documentation of the shape recommends.
fn ripples() -> impl Strategy<Value = Trochoid> {
    (0.1..2.0, 0.001..0.8, 1_u8..=4).prop_map(|(radius, ratio, half_turns)| {
        Trochoid::new(radius, ratio * radius, PI * f64::from(half_turns)).unwrap()
    })
}

fn samples() -> impl Strategy<Value = Vec<f64>> {
    vec(0.0..=1.0, 8)
}

fn check(shape: &dyn Contour, samples: &[f64]) -> Result<(), TestCaseError> {
    contract::check(shape, samples).map_err(TestCaseError::fail)
}

proptest! {
    #[test]
    fn ripples_keep_the_contract(shape in ripples(), samples in samples()) {
        check(&shape, &samples)?;
    }

    #[test]
    fn so_they_do_moved_and_reversed(shape in ripples(), turn in -3.0..3.0, samples in samples()) {
        check(&Moved::new(shape, Motion::rotation(turn)).unwrap(), &samples)?;
        check(&Reversed::new(shape), &samples)?;
    }
}

#[test]
fn and_joined() {
    let ripples = Trochoid::new(1.0, 0.5, 3.0 * PI).unwrap();
    let end = ripples.frame(ripples.range().to);
    let wall = Line::new([end.x, end.y], [end.x + 0.5, end.y + 2.0]).unwrap();
    let object = Composite::new(vec![Box::new(ripples), Box::new(wall)]).unwrap();
    let samples: Vec<f64> = (0..=40).map(|k| f64::from(k) / 40.0).collect();
    contract::check(&object, &samples).unwrap();
}

#[test]
fn ripples_that_cannot_be() {
    let message = |radius, arm, half| Trochoid::new(radius, arm, half).unwrap_err().to_string();
    assert_eq!(message(1.0, 1.0, 3.0), "radius - arm is 0, expected a positive number");
    assert!(message(1.0, f64::NAN, 3.0).starts_with("arm is NaN"));
    assert_eq!(message(1.0, 0.5, 0.0), "half the angle is 0, expected a positive number");
}
