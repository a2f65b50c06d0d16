//! The scaling of a sensor that speaks RDT: any answer.
#![no_main]

use rod_hw::device::rdt::RdtScaling;
use rod_hw::{Calibration, Channels, RawSample};

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    let Ok(scaling) = RdtScaling::from_bytes(data) else { return };
    assert_eq!(scaling.to_bytes()[..12], data[..12]);
    if let Ok(calibration) = scaling.calibration::<f64>() {
        let _ = calibration.wrench(&RawSample::new(0.0, Channels::from([1e9; 6])));
    }
});
