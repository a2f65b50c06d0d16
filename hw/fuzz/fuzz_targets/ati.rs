//! Calibration files of ATI: any text.
#![no_main]

use rod_hw::{AtiCalibration, AtiFile, Calibration, Channels, RawSample};
use rod_hw_fuzz::bounded;

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    let Ok(text) = str::from_utf8(data) else { return };
    match bounded(data.len(), 500, || AtiFile::parse(text)) {
        Ok(file) => {
            let _ = file.calibration(None);
            for calibration in &file.calibrations {
                let _ = file.calibration(Some(&calibration.part_number));
                convert::<6>(calibration);
                convert::<16>(calibration);
                if calibration.gauges != 6 {
                    assert!(calibration.matrix::<6, f64>().is_err());
                }
            }
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
});

fn convert<const N: usize>(calibration: &AtiCalibration) {
    for matrix in [calibration.matrix::<N, f64>(), calibration.without_temperature::<N, f64>()].into_iter().flatten() {
        for count in [N, N + 1] {
            let Some(channels) = Channels::new(&[1.5; 17][..count]) else { continue };
            if let Ok(sample) = matrix.wrench(&RawSample::new(0.0, channels)) {
                assert!(sample.wrench.components().iter().all(|value| value.is_finite()));
            }
        }
    }
    if let Ok(matrix) = calibration.matrix::<N, f32>() {
        let channels = Channels::new(&[1e30; N]).unwrap_or_default();
        if let Ok(sample) = matrix.wrench(&RawSample::new(0.0, channels)) {
            assert!(sample.wrench.components().iter().all(|value| value.is_finite()));
        }
    }
}
