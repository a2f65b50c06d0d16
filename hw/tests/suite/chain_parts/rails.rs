//! Raw values at the ends of their range.

use rod_hw::*;

#[test]
fn refuses() {
    assert_eq!(
        Rails::new(&[(0.0, 1.0), (1.0, -1.0)]).unwrap_err().to_string(),
        "channel 2 reaches from 1 to -1, expected the lower end first"
    );
    assert!(Rails::new(&[(0.0, f64::NAN)]).is_err());
    assert_eq!(Rails::new(&[(0.0, 1.0); 17]).unwrap_err(), CalibrationDataError::Channels { count: 17 });
    assert!(Rails::of_bits(1, 6).is_none() && Rails::of_bits(54, 6).is_none() && Rails::of_bits(16, 17).is_none());
    let two = RawSample::new(0.0, Channels::from([0.0, 0.0]));
    assert_eq!(
        Rails::of_bits(16, 6).unwrap().check(&two).unwrap_err(),
        CalibrationError::Channels { found: 2, expected: 6 }
    );
}

#[test]
fn the_largest_and_smallest_counts_are_the_rails() {
    let rails = Rails::of_bits(16, 1).unwrap();
    for (count, quality) in [
        (32_766.0, Quality::empty()),
        (32_767.0, Quality::SATURATED),
        (-32_767.0, Quality::empty()),
        (-32_768.0, Quality::SATURATED),
    ] {
        assert_eq!(rails.check(&RawSample::new(0.0, Channels::from([count]))), Ok(quality));
    }
    let huge = RawSample::new(0.0, Channels::from([1e300; 16]));
    assert_eq!(Rails::none().check(&huge), Ok(Quality::empty()));
    assert!(Rails::none().check(&RawSample::new(0.0, Channels::from([f64::INFINITY]))).is_err());
}
