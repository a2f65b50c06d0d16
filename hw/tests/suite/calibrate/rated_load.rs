//! Rated loads.

use rod_hw::*;

#[test]
fn ratings_are_positive() {
    for value in [0.0, -1.0, f64::NAN] {
        let error = RatedLoad::<f64>::in_units([1.0, 1.0, 1.0, 1.0, value, 1.0], WrenchUnits::SI).unwrap_err();
        let expected = format!("the rated load of Ty is {value}, expected a positive number, or infinity");
        assert!(error.to_string().starts_with(&expected), "{error}");
    }
}

#[test]
fn flags_are_never_taken_away() {
    let rated = RatedLoad::<f32>::in_units([1.0; 6], WrenchUnits::SI).unwrap();
    let mut sample = WrenchSample::new(0.0, Wrench::from_components([1.0_f32; 6]));
    assert_eq!(rated.flag(&sample), sample);
    sample.quality = Quality::SATURATED | Quality::SPIKE;
    assert_eq!(rated.flag(&sample), sample);
}
