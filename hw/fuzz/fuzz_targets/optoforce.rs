//! An OptoForce sensor: any stream.
#![no_main]

use rod_fake_sensor::FakeOptoForce;
use rod_hw::device::framed::OptoForce;
use rod_hw_fuzz::{Choices, check};

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    let mut choices = Choices(data);
    let count = choices.word() as u16;
    check(OptoForce, &mut FakeOptoForce::new(choices.one([3, 6, 12])).with_count(count), choices);
});
