//! A converter as a source that waits.

use super::{Adc, AdcError};
use crate::clock::Clock;
use crate::quality::Quality;
use crate::raw::RawSample;

/// How a converter is waited for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Polling {
    /// How long at most, s.
    pub deadline: f64,
    /// Between one look and the next, s; less than a conversion takes.
    pub pause: f64,
}

impl Default for Polling {
    /// A look every 0.1 ms for 0.5 s: enough for chips from 10 to some thousand conversions a second.
    fn default() -> Self {
        Self { deadline: 0.5, pause: 1e-4 }
    }
}

/// A [`RawSource`](crate::RawSource) from a converter: it waits for each conversion, with a deadline, and never ends. The first
/// sample after an error says that there may be a gap before it.
///
/// ```
/// # use embedded_hal_mock::eh1::delay::NoopDelay;
/// # use core::convert::Infallible;
/// use rod_hw::adc::{Adc, AdcError, AdcSource, DelayClock, Polling};
/// use rod_hw::{Channels, Quality, RawSample};
///
/// /// A chip that is ready at every third look.
/// struct Slow(u32);
/// impl Adc for Slow {
///     type Bus = Infallible;
///     const CHANNELS: usize = 1;
///     fn poll(&mut self, now: f64) -> Result<Option<RawSample>, AdcError<Infallible>> {
///         self.0 += 1;
///         Ok((self.0 % 3 == 0).then(|| RawSample::new(now, Channels::from([f64::from(self.0)]))))
///     }
/// }
/// let clock = DelayClock::new(NoopDelay::new());
/// let mut source = AdcSource::new(Slow(0), clock, Polling { deadline: 1.0, pause: 0.25 });
/// let sample = source.next().ok_or("a converter never ends")??;
/// assert_eq!((sample.host_time, sample.channels[0]), (0.5, 3.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct AdcSource<A, C> {
    adc: A,
    clock: C,
    polling: Polling,
    failed: bool,
}

impl<A: Adc, C: Clock> AdcSource<A, C> {
    /// From a converter that is set up.
    pub fn new(adc: A, clock: C, polling: Polling) -> Self {
        Self { adc, clock, polling, failed: false }
    }

    /// Waits for the next conversion.
    ///
    /// # Errors
    /// [`AdcError::NotReady`] after the deadline, and what the converter says.
    pub fn read(&mut self) -> Result<RawSample, AdcError<A::Bus>> {
        let result = self.wait();
        if let Ok(mut sample) = result {
            if core::mem::take(&mut self.failed) {
                sample.quality |= Quality::GAP_BEFORE;
            }
            return Ok(sample);
        }
        self.failed = true;
        result
    }

    fn wait(&mut self) -> Result<RawSample, AdcError<A::Bus>> {
        let since = self.clock.now();
        loop {
            let now = self.clock.now();
            if let Some(sample) = self.adc.poll(now)? {
                return Ok(sample);
            }
            let left = self.polling.deadline - (now - since);
            // so that a deadline that is no number has passed, too
            if left > 0.0 {
                // of a clock that counts its waits no time passes without one
                self.clock.wait(self.polling.pause.max(1e-6).min(left));
            } else {
                return Err(AdcError::NotReady { waited: now - since });
            }
        }
    }

    /// The converter, to set it otherwise.
    pub fn adc(&mut self) -> &mut A {
        &mut self.adc
    }
}

impl<A: Adc, C: Clock> Iterator for AdcSource<A, C> {
    type Item = Result<RawSample, AdcError<A::Bus>>;

    fn next(&mut self) -> Option<Self::Item> {
        Some(self.read())
    }
}
