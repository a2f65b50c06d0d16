//! A stage by a table of poses.

use proptest::prelude::*;
use rod_core::Pose;
use rod_hw::*;

fn pose(x: f64) -> Pose {
    Pose { x, y: -2.0 * x, phi: 0.5 * x }
}

proptest! {
    #[test]
    fn linear_motion_is_exact(
        steps in proptest::collection::vec(1e-3_f64..1.0, 1..20), share in 0.0_f64..=1.0, speed in -1.0_f64..1.0,
    ) {
        let mut t = -3.0;
        let mut rows = vec![(t, pose(speed * t))];
        for step in steps {
            t += step;
            rows.push((t, pose(speed * t)));
        }
        let mut stage = StageTable::new(rows.clone()).unwrap();
        for &(t, there) in &rows {
            prop_assert_eq!(stage.pose_at(t), Ok(there));
        }
        let at = -3.0 + share * (t + 3.0);
        let found = stage.pose_at(at.clamp(-3.0, t)).unwrap();
        prop_assert!((found.x - speed * at).abs() < 1e-14 && (found.y + 2.0 * speed * at).abs() < 1e-14);
        let past = |to: f64| StageError::Outside { t: to, from: -3.0, to: t };
        prop_assert_eq!(stage.pose_at(t + 1e-9), Err(past(t + 1e-9)));
        prop_assert_eq!(stage.pose_at(-3.1), Err(past(-3.1)));
    }
}

#[test]
fn refuses() {
    for (rows, message) in [
        (vec![(0.0, pose(0.0))], "1 rows, expected at least 2"),
        (
            vec![(0.0, pose(0.0)), (1.0, pose(0.0)), (1.0, pose(0.0))],
            "row 3: the time is 1 s, expected more than 1 s, that of the row before",
        ),
        (vec![(0.0, pose(0.0)), (1.0, Pose { y: f64::NAN, ..pose(0.0) })], "row 2: y is NaN, expected a finite number"),
        (vec![(f64::INFINITY, pose(0.0)), (1.0, pose(0.0))], "row 1: the time is inf, expected a finite number"),
        (
            vec![(0.0, Pose { phi: 3.0, ..pose(0.0) }), (1.0, Pose { phi: -3.0, ..pose(0.0) })],
            "row 2: the angle jumps by -6 rad, expected less than half a turn from row to row; take out the whole turns",
        ),
    ] {
        assert_eq!(StageTable::new(rows).unwrap_err().to_string(), message);
    }
    let mut stage = StageTable::new(vec![(0.0, pose(0.0)), (1.0, pose(1.0))]).unwrap();
    assert!(matches!(stage.pose_at(f64::NAN), Err(StageError::NotFinite { .. })));
}
