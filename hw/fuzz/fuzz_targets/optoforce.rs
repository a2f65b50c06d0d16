//! An OptoForce sensor: any stream.
#![no_main]

use rod_fake_sensor::FakeOptoForce;
use rod_hw::device::framed::{OptoForce, OptoForceFilter, OptoForceRate, OptoForceSetup};
use rod_hw_fuzz::{Choices, check};

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    let mut choices = Choices(data);
    let setup = OptoForceSetup { rate: OptoForceRate::Hz100, filter: OptoForceFilter::Hz15, zero: true };
    let profile = OptoForce {
        setup: choices.one([None, Some(setup)]),
        stride: choices.one([1, 10, 0, 0x7fff, 0x8000, u16::MAX]),
    };
    let count = choices.word() as u16;
    check(profile, &mut FakeOptoForce::new(choices.one([3, 6, 12])).with_count(count), choices);
});
