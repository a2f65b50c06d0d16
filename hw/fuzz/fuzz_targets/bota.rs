//! A Bota SensONE or Rokubi: any stream.
#![no_main]

use rod_fake_sensor::FakeBota;
use rod_hw::device::framed::Bota;
use rod_hw_fuzz::{Choices, check};

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    let mut choices = Choices(data);
    check(Bota, &mut FakeBota::new(800.0).with_time(choices.word()), choices);
});
