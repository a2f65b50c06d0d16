//! Factors of components.

use proptest::prelude::*;
use rod_hw::*;

fn unit(text: &str) -> Unit {
    Unit::find(text).unwrap()
}

#[test]
fn what_is_no_scale_is_refused() {
    for value in [0.0, -1e6, f64::NAN, f64::INFINITY, f64::MIN_POSITIVE] {
        let error = Scale::<f64>::from_counts(1e6, unit("N"), value, unit("kN m")).unwrap_err().to_string();
        assert!(error.starts_with(&format!("counts per unit of Tx are {value}, expected a positive")), "{error}");
    }
    // representable as f64, but not as the number it is applied in
    assert!(Scale::<f64>::from_counts(1e60, unit("N"), 1.0, unit("N m")).is_ok());
    assert!(Scale::<f32>::from_counts(1e60, unit("N"), 1.0, unit("N m")).is_err());
    let error = Scale::<f64>::from_counts(1e6, unit("N"), 1e6, unit("mN")).unwrap_err();
    assert!(matches!(error, CalibrationDataError::Unit { field: "torque unit", .. }), "{error}");
    let odd = Unit { name: "odd", dimension: Dimension::Force, factor: 0.0 };
    assert_eq!(
        Scale::<f64>::from_counts(1e6, odd, 1e6, unit("N m")).unwrap_err().to_string(),
        "force unit is 0, expected a positive, finite number"
    );
    let twice = [Some(Component::Fx), Some(Component::Fx)];
    assert_eq!(
        Scale::<f64>::si().with_channels(&twice).unwrap_err().to_string(),
        "Fx is given twice, expected at most once"
    );
    assert_eq!(Scale::<f64>::si().with_channels(&[None]), Err(CalibrationDataError::Nothing));
    assert!(Scale::<f64>::si().with_channels(&[None; 17]).is_err());
}

#[test]
fn bad_samples_are_refused() {
    let scale = Scale::<f32>::si();
    let of = |values: &[f64]| scale.wrench(&RawSample::new(0.0, Channels::new(values).unwrap())).unwrap_err();
    assert_eq!(of(&[1.0; 5]), CalibrationError::Channels { found: 5, expected: 6 });
    let error = of(&[0.0, 0.0, f64::INFINITY, 0.0, 0.0, 0.0]);
    assert_eq!(error, CalibrationError::NotFinite { channel: 3, value: f64::INFINITY });
    let error = of(&[0.0, 1e300, 0.0, 0.0, 0.0, 0.0]).to_string();
    assert!(error.starts_with("Fy is inf N after calibration"), "{error}");
}

proptest! {
    #[test]
    fn there_and_back(
        components in proptest::array::uniform6(-1e3..1e3_f64),
        counts in proptest::array::uniform6(1e-3..1e9_f64),
        shift in 0..6_usize,
    ) {
        let units = WrenchUnits::parse("lbf", "N mm").unwrap();
        let scale = Scale::<f64>::from_counts_per_axis(counts, units).unwrap();
        let mut order = Component::ALL.map(Some);
        order.rotate_left(shift);
        let scale = scale.with_channels(&order).unwrap();
        let wrench = Wrench::from_components(components);
        let raw = RawSample::new(0.0, scale.channels(&wrench));
        let back = scale.wrench(&raw).unwrap().wrench;
        for (a, b) in back.components().iter().zip(components) {
            prop_assert!((a - b).abs() <= 4.0 * f64::EPSILON * b.abs());
        }
    }
}
