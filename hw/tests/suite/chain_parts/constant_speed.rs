//! A stage at constant speed.

use rod_core::Pose;
use rod_hw::*;

const START: Pose = Pose { x: 0.0, y: 0.0, phi: 0.0 };

#[test]
fn from_start_to_end_only() {
    let end = Pose { x: 0.03, y: -0.04, phi: 0.5 };
    let mut stage = ConstantSpeed::within(START, end, 1.0, 11.0).unwrap();
    assert_eq!(stage.motion(), (1.0, 11.0));
    assert_eq!(stage.pose_at(11.0), Ok(end));
    assert_eq!(stage.pose_at(0.5), Err(StageError::Outside { t: 0.5, from: 1.0, to: 11.0 }));
    assert!(matches!(stage.pose_at(f64::NAN), Err(StageError::NotFinite { .. })));
}

#[test]
fn refuses() {
    let end = Pose { x: 0.1, ..START };
    assert!(ConstantSpeed::within(START, end, 2.0, 2.0).is_err());
    let astray = Velocity { x: f64::INFINITY, ..Velocity::default() };
    assert!(ConstantSpeed::new(START, astray, 0.0).is_err());
}
