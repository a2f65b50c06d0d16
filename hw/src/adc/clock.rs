//! A clock made of a delay.

use crate::clock::Clock;
use embedded_hal::delay::DelayNs;

/// A clock for boards that have a delay and no timer to read: its time is how long it has waited, so that it runs slow by
/// what is done between the waits. Good for deadlines; for the times of samples, better one that reads a timer.
///
/// ```
/// use rod_hw::{Clock, adc::DelayClock};
/// # use embedded_hal_mock::eh1::delay::NoopDelay as Delay;
/// let mut clock = DelayClock::new(Delay::new());
/// clock.wait(0.25);
/// assert_eq!(clock.now(), 0.25);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct DelayClock<D> {
    delay: D,
    waited: f64,
}

impl<D: DelayNs> DelayClock<D> {
    /// At 0.
    pub fn new(delay: D) -> Self {
        Self { delay, waited: 0.0 }
    }
}

impl<D: DelayNs> Clock for DelayClock<D> {
    fn now(&mut self) -> f64 {
        self.waited
    }

    fn wait(&mut self, seconds: f64) {
        // nothing of NaN or what is negative, an hour of what is longer: the argument of a delay ends there
        let micros = (seconds * 1e6).clamp(0.0, 3.6e9);
        let micros = if micros.is_nan() { 0.0 } else { micros };
        // the cast cuts
        self.delay.delay_us(micros as u32);
        self.waited += micros * 1e-6;
    }
}
