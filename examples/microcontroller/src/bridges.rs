//! Three strain gauge bridges, each at an HX711, read by the published driver of that chip.

use embedded_hal::delay::DelayNs;
use embedded_hal::digital::{InputPin, OutputPin};
use hx711::{Error, Hx711};

/// The converters of the three bridges, in the order of the channels of [`Sensor`](crate::Sensor).
pub struct Bridges<D, I, O>([Hx711<D, I, O>; 3]);

impl<D: DelayNs, I: InputPin, O: OutputPin> Bridges<D, I, O> {
    /// These converters. `Hx711::new` takes a delay, the data pin and the clock pin, and waits for the first conversion.
    pub fn new(converters: [Hx711<D, I, O>; 3]) -> Self {
        Self(converters)
    }

    /// One conversion of each bridge, 24 bits with sign. It waits for the slowest converter: 0.1 s at 10 Hz, 13 ms at 80 Hz; a
    /// converter without power keeps it waiting, so that a watchdog has to end that.
    ///
    /// # Errors
    /// Where a pin cannot be read or set.
    pub fn counts(&mut self) -> Result<[i32; 3], Error<I::Error, O::Error>> {
        let [x, y, moment] = &mut self.0;
        Ok([nb::block!(x.retrieve())?, nb::block!(y.retrieve())?, nb::block!(moment.retrieve())?])
    }
}
