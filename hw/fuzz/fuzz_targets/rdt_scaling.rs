//! The scaling of a sensor that speaks RDT: any answer, any `netftapi2.xml`.
#![no_main]

use rod_hw::rdt::{RdtConfiguration, RdtScaling};
use rod_hw_fuzz::bounded;

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    if let Ok(scaling) = RdtScaling::from_bytes(data) {
        assert_eq!(scaling.to_bytes()[..], *data);
        usable(&scaling);
    }
    if let Ok(text) = str::from_utf8(data) {
        match bounded(data.len(), 200, || RdtConfiguration::from_xml(text)) {
            Ok(found) => {
                usable(&found.scaling);
                assert!([found.record_rate, found.clock_rate].iter().flatten().all(|rate| *rate > 0.0));
            }
            Err(error) => assert!(!error.to_string().is_empty()),
        }
    }
});

fn usable(scaling: &RdtScaling) {
    if let Ok(calibration) = scaling.calibration::<f64>() {
        use rod_hw::{Calibration, Channels, RawSample};
        let _ = calibration.wrench(&RawSample::new(0.0, Channels::from([1e9; 6])));
    }
}
