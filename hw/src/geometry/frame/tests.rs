use super::*;
use nalgebra::{Quaternion, UnitQuaternion};
use proptest::prelude::*;

pub(crate) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    Vector3::from(a).dot(&Vector3::from(b))
}

pub(crate) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    Vector3::from(a).cross(&Vector3::from(b)).into()
}

pub(crate) fn frames() -> impl Strategy<Value = Frame> {
    let quaternion = proptest::array::uniform4(-1.0_f64..1.0).prop_filter_map("too short", |q| {
        let norm = q.iter().map(|c| c * c).sum::<f64>().sqrt();
        (norm > 0.1).then(|| UnitQuaternion::from_quaternion(Quaternion::from(q)))
    });
    (quaternion, proptest::array::uniform3(-0.1..0.1))
        .prop_map(|(q, d)| Frame { rotation: *q.to_rotation_matrix().matrix(), origin: d.into() })
}

pub(crate) fn wrenches() -> impl Strategy<Value = Wrench> {
    proptest::array::uniform6(-2.0..2.0).prop_map(Wrench::from_components)
}

pub(crate) fn close(a: &Wrench, b: &Wrench) -> bool {
    (*a - *b).components().iter().all(|c| c.abs() < 1e-13)
}

proptest! {
    #[test]
    fn there_and_back(frame in frames(), wrench in wrenches()) {
        prop_assert!(close(&frame.inverse().wrench(&frame.wrench(&wrench)), &wrench));
        prop_assert!(close(&frame.wrench(&frame.inverse().wrench(&wrench)), &wrench));
    }

    #[test]
    fn what_stays(frame in frames(), wrench in wrenches()) {
        let new = frame.wrench(&wrench);
        prop_assert!((dot(new.force, new.force) - dot(wrench.force, wrench.force)).abs() < 1e-13);
        prop_assert!((dot(new.force, new.torque) - dot(wrench.force, wrench.torque)).abs() < 1e-13);
        // the rows say the same
        let rows = frame.rows();
        let by_rows = rows.map(|row| row.iter().zip(wrench.components()).map(|(r, c)| r * c).sum::<f64>());
        prop_assert!(close(&Wrench::from_components(by_rows), &new));
    }

    #[test]
    fn a_force_through_the_new_origin_has_no_moment_there(frame in frames(), force in proptest::array::uniform3(-2.0..2.0)) {
        let new = frame.wrench(&Wrench { force, torque: cross(frame.origin(), force) });
        prop_assert!(new.torque.iter().all(|c| c.abs() < 1e-14));
    }
}

#[test]
fn the_tool_transform_of_the_plane() {
    // m_z' = m_z - (d_x f_y - d_y f_x)
    let frame = Frame::same().with_origin([0.02, -0.05, 0.3]).unwrap();
    let found = frame.wrench(&Wrench { force: [0.3, -0.4, 0.0], torque: [0.0, 0.0, 0.011] });
    assert!((found.torque[2] - (0.011 - (0.02_f64 * -0.4 - -0.05 * 0.3))).abs() < 1e-17);
}

#[test]
fn refuses() {
    assert_eq!(Frame::<f64>::from_axes([Axis::X, Axis::MinusY, Axis::Z]), Err(GeometryError::LeftHanded));
    assert_eq!(Frame::<f64>::from_axes([Axis::X, Axis::MinusX, Axis::Z]), Err(GeometryError::SameAxis));
    assert!(Frame::<f32>::from_axes([Axis::MinusZ, Axis::MinusY, Axis::MinusX]).is_ok());
    assert!(Frame::planar(f64::INFINITY).is_err());
    assert!(Frame::same().with_origin([0.0, f64::NAN, 0.0]).is_err());
    assert_eq!("X".parse::<Axis>(), Err(GeometryError::NoAxis));
}
