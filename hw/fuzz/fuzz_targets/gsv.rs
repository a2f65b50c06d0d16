//! A GSV-8 or GSV-6: any stream.
#![no_main]

use rod_fake_sensor::FakeGsv8;
use rod_hw::device::framed::Gsv;
use rod_hw_fuzz::{Choices, check};

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    let mut choices = Choices(data);
    check(Gsv, &mut FakeGsv8::new(choices.one([6, 1, 16]), 100.0), choices);
});
