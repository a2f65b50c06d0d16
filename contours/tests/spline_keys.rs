//! What goes into a spline and its file, and what is refused.
#![allow(clippy::unwrap_used)]

use rod_contours::{Contour, ContourError, Spline, SplineEnd};

const ESTIMATED: SplineEnd = SplineEnd::Clamped { from: None, to: None };

/// A spiral of several turns, outwards.
fn spiral(count: u32) -> Vec<[f64; 2]> {
    (0..count).map(|k| 0.3 * f64::from(k)).map(|a| [(1.0 + 0.2 * a) * a.cos(), (1.0 + 0.2 * a) * a.sin()]).collect()
}

#[test]
fn a_spline_survives_its_file() {
    for end in [SplineEnd::Natural, ESTIMATED, SplineEnd::Periodic] {
        let spline = Spline::through(&spiral(50), end).unwrap();
        let text = serde_json::to_string(&spline).unwrap();
        let copy: Spline = serde_json::from_str(&text).unwrap();
        assert_eq!(serde_json::to_string(&copy).unwrap(), text);
        for k in -10..=1010 {
            let t = spline.range().at(f64::from(k) / 1000.0);
            assert_eq!(copy.frame(t), spline.frame(t));
        }
        assert_eq!(copy.closest(0.3, 0.4), spline.closest(0.3, 0.4));
    }
    let line = Spline::through(&[[0.0, 0.0], [3.0, 0.0]], SplineEnd::Natural).unwrap();
    assert_eq!(
        serde_json::to_string(&line).unwrap(),
        r#"[{"t":0.0,"value":[0.0,0.0],"interpolation":{"stroke_bezier":[[-1.0,0.0],[1.0,0.0]]}},"#.to_owned()
            + r#"{"t":3.0,"value":[3.0,0.0],"interpolation":{"stroke_bezier":[[2.0,0.0],[4.0,0.0]]}}]"#
    );
}

#[test]
fn unsound_keys_are_refused() {
    let key = |t: &str, x: f64, before: [f64; 2], after: [f64; 2]| {
        format!(r#"{{"t":{t},"value":[{x},0.0],"interpolation":{{"stroke_bezier":[{before:?},{after:?}]}}}}"#)
    };
    let first = key("0.0", 0.0, [-1.0, 0.0], [1.0, 0.0]);
    let last = key("3.0", 3.0, [2.0, 0.0], [4.0, 0.0]);
    let message = |keys: &[&str]| {
        let read: Result<Spline, _> = serde_json::from_str(&format!("[{}]", keys.join(",")));
        read.map_or_else(|error| error.to_string(), |spline| format!("fine, to {}", spline.range().to))
    };
    assert_eq!(message(&[&first, &last]), "fine, to 3");
    assert_eq!(message(&[]), "a spline needs at least 2 points, got 0");
    assert_eq!(message(&[&first]), "a spline needs at least 2 points, got 1");
    assert_eq!(
        message(&[&last, &first]),
        "key 2 of the spline is at t = 0, expected more than the 3 of the key before it"
    );
    assert_eq!(
        message(&[&first, &first]),
        "key 2 of the spline is at t = 0, expected more than the 0 of the key before it"
    );
    let linear = r#"{"t":3.0,"value":[3.0,0.0],"interpolation":"linear"}"#;
    assert_eq!(
        message(&[&first, linear]),
        "key 2 of the spline is of another kind, expected interpolation `stroke_bezier` with its two handles"
    );
    let corner = key("3.0", 3.0, [2.0, 0.0], [3.0, 1.0]);
    let end = key("4.0", 4.0, [3.0, 1.0], [4.0, 1.0]);
    assert_eq!(
        message(&[&first, &corner, &end]),
        "the spline turns by 1.5707963267948966 rad at its key 2, expected both handles on one line through the point; make it two splines with a corner"
    );
    let back = key("3.0", 0.0, [1.0, 0.0], [2.0, 0.0]);
    assert!(message(&[&first, &back]).starts_with("the spline stands still at t = "), "{}", message(&[&first, &back]));
    for number in ["null", "1e999", "\"a\""] {
        assert!(!message(&[&first, &key(number, 3.0, [2.0, 0.0], [4.0, 0.0])]).starts_with("fine"));
    }
    // Large beyond measure, though every number is finite.
    let far = key("3.0", 1e308, [2.0, 0.0], [1.7e308, 0.0]);
    assert!(!message(&[&first, &far]).starts_with("fine"), "{}", message(&[&first, &far]));
}

#[test]
fn unsound_points_are_refused() {
    let message = |points: &[[f64; 2]], end| Spline::through(points, end).unwrap_err().to_string();
    let line = [[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [2.0, 1.0]];
    assert_eq!(message(&[], SplineEnd::Natural), "a spline needs at least 2 points, got 0");
    assert_eq!(message(&line[..1], ESTIMATED), "a spline needs at least 2 points, got 1");
    assert_eq!(message(&[], SplineEnd::Periodic), "a closed spline needs at least 3 points, got 0");
    assert_eq!(message(&line[..2], SplineEnd::Periodic), "a closed spline needs at least 3 points, got 2");
    let there_and_back = [[0.0, 0.0], [1.0, 0.0], [0.0, 0.0]];
    assert_eq!(message(&there_and_back, SplineEnd::Periodic), "a closed spline needs at least 3 points, got 2");
    assert!(message(&there_and_back, SplineEnd::Natural).starts_with("the spline stands still at t = "));
    let repeated = "point 3 is (1, 0), the same as the one before it; leave one of them out";
    for end in [SplineEnd::Natural, ESTIMATED, SplineEnd::Periodic] {
        assert_eq!(message(&line, end), repeated);
    }
    assert_eq!(Spline::smoothing(&line, 0.1).unwrap_err().to_string(), repeated);
    assert_eq!(
        message(&[[0.0, 0.0], [f64::NAN, 2.0], [1.0, 1.0]], SplineEnd::Periodic),
        "point 2 is (NaN, 2), expected finite numbers"
    );
    assert_eq!(
        message(&line[..2], SplineEnd::Clamped { from: None, to: Some(f64::INFINITY) }),
        "the tangent angle at the spline's end is inf, expected a finite number"
    );
    assert_eq!(
        Spline::smoothing(&line, -0.5).unwrap_err().to_string(),
        "the noise of the spline's points is -0.5, expected a number not less than 0"
    );
    assert!(matches!(Spline::smoothing(&line, f64::NAN), Err(ContourError::NotFinite { .. })));
    assert!(Spline::through(&[[0.0, 0.0], [1e308, 1e308], [-1e308, 1e308]], SplineEnd::Natural).is_err());
}
