//! A Robotiq FT 300 or FT 150: any stream.
#![no_main]

use rod_fake_sensor::FakeRobotiq;
use rod_hw::device::framed::Robotiq;
use rod_hw_fuzz::{Choices, check};

libfuzzer_sys::fuzz_target!(|data: &[u8]| check(Robotiq, &mut FakeRobotiq::new(), Choices(data)));
