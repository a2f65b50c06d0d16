//! Strain gauges at an Arduino: any stream.
#![no_main]

use rod_hw::framed::Hx711;
use rod_hw_fuzz::{Arduino, Choices, check};

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    let mut choices = Choices(data);
    let channels = choices.one([6, 1, 2, 16, 0, 17]);
    if let Some(profile) = Hx711::new(channels) {
        check(profile, &mut Arduino(channels), choices);
    }
});
