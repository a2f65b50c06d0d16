//! A GSV-8 or GSV-6: any stream.
#![no_main]

use rod_fake_sensor::FakeGsv8;
use rod_hw::device::framed::{Gsv, GsvValues};
use rod_hw_fuzz::{Choices, check};

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    let mut choices = Choices(data);
    let profile = Gsv {
        values: choices.one([GsvValues::F32, GsvValues::I24, GsvValues::I16]),
        channels: choices.one([None, Some(6), Some(1), Some(16), Some(17), Some(300)]),
        rate: choices.one([None, Some(500.0), Some(f32::NAN)]),
        zero: choices.one([false, true]),
    };
    let values = choices.one([GsvValues::F32, GsvValues::I24, GsvValues::I16]);
    check(profile, &mut FakeGsv8::new(choices.one([6, 1, 16]), 100.0, values), choices);
});
