//! Converters of strain-gauge bridges and the like, on the pins of a microcontroller or a single-board computer.
//!
//! A base of strain gauges gives millivolts; one of these chips makes 24-bit counts of them: [`Ads131m04`] (four channels at
//! once, SPI), [`Nau7802`] (I2C), [`Hx711`] (two pins). Each is an [`Adc`]: asked, it hands over a conversion if there is one.
//! [`Side`] makes one sample of several chips, [`AdcSource`] a [`RawSource`](crate::RawSource) that waits, with a deadline.
//! Counts stay counts: what one of them is in volts a chip tells (`volts_per_count`), newtons are a matter of a
//! [`Calibration`](crate::Calibration).
//!
//! Buses, pins and delays are those of `embedded-hal` 1.0. Nothing is allocated; a driver is its bus and some bytes.

mod ads131m04;
mod clock;
mod error;
mod hx711;
mod nau7802;
mod side;
mod source;

pub use ads131m04::{Ads131m04, Ads131m04Settings, Oversampling};
pub use clock::DelayClock;
pub use error::AdcError;
pub use hx711::{Hx711, Hx711Input};
pub use nau7802::{Nau7802, Nau7802Rate, Nau7802Settings, Nau7802Supply};
pub use side::Side;
pub use source::{AdcSource, Polling};

use crate::quality::Quality;
use crate::raw::RawSample;

/// A converter that can be asked.
///
/// For driver authors: one method, which neither waits nor looks at a clock.
pub trait Adc {
    /// What the bus, or a pin, says where it fails.
    type Bus;

    /// How many values a conversion has.
    const CHANNELS: usize;

    /// The next conversion if there is one, each of them once. It arrived at `now`, s.
    ///
    /// # Errors
    /// [`AdcError`] of this attempt; the next one may be good.
    fn poll(&mut self, now: f64) -> Result<Option<RawSample>, AdcError<Self::Bus>>;
}

impl<A: Adc + ?Sized> Adc for &mut A {
    type Bus = A::Bus;
    const CHANNELS: usize = A::CHANNELS;

    fn poll(&mut self, now: f64) -> Result<Option<RawSample>, AdcError<Self::Bus>> {
        (**self).poll(now)
    }
}

/// The gain of an amplifier before a converter; the number that it is called by in the registers of all these chips.
///
/// ```
/// use rod_hw::adc::Gain;
/// assert_eq!((Gain::X128 as u8, Gain::X128.factor()), (7, 128.0));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Gain {
    /// None.
    #[default]
    X1 = 0,
    /// 2.
    X2,
    /// 4.
    X4,
    /// 8.
    X8,
    /// 16.
    X16,
    /// 32.
    X32,
    /// 64.
    X64,
    /// 128, for bridges.
    X128,
}

impl Gain {
    /// By how much.
    pub fn factor(self) -> f64 {
        f64::from(1_u8 << self as u8)
    }
}

/// Counts in one direction of a converter of 24 bits.
const FULL_SCALE: f64 = 8_388_608.0;

/// Counts of three bytes in two's complement, highest first.
fn counts(bytes: [u8; 3]) -> i32 {
    let [high, middle, low] = bytes;
    i32::from_be_bytes([high, middle, low, 0]) >> 8
}

/// What counts at one of their ends mean: the input is there or beyond.
fn quality(counts: i32) -> Quality {
    if matches!(counts, 0x7F_FFFF | -0x80_0000) { Quality::SATURATED } else { Quality::empty() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sign_and_ends() {
        for (bytes, value, end) in [
            ([0, 0, 0], 0, false),
            ([0, 0, 1], 1, false),
            ([0xFF, 0xFF, 0xFF], -1, false),
            ([0x7F, 0xFF, 0xFE], 8_388_606, false),
            ([0x7F, 0xFF, 0xFF], 8_388_607, true),
            ([0x80, 0x00, 0x01], -8_388_607, false),
            ([0x80, 0x00, 0x00], -8_388_608, true),
        ] {
            assert_eq!(counts(bytes), value);
            assert_eq!(quality(value).contains(Quality::SATURATED), end, "{value}");
        }
    }
}
