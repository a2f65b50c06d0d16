//! A Bota SensONE or Rokubi: any stream.
#![no_main]

use rod_fake_sensor::FakeBota;
use rod_hw::device::framed::{Bota, BotaFilter};
use rod_hw_fuzz::{Choices, check};

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    let mut choices = Choices(data);
    let filter = BotaFilter { sinc: 512, ..BotaFilter::default() };
    let profile = Bota { filter: choices.one([None, Some(filter)]) };
    check(profile, &mut FakeBota::new(800.0).with_time(choices.word()), choices);
});
