//! Several converters as one.

use super::{Adc, AdcError};
use crate::raw::{Channels, RawSample};

/// Several converters side by side as one, whose channels are theirs in a row: a base with one chip a bridge.
///
/// A sample is whole when each chip has converted once. Their clocks are their own, so that values of one sample lie up to a
/// conversion apart; it has the time of the last. Its status is the bits of all, its temperature that of the first that has one.
///
/// ```
/// # use core::convert::Infallible;
/// use rod_hw::adc::{Adc, AdcError, Side};
/// use rod_hw::{Channels, RawSample};
/// struct Chip(f64);
/// impl Adc for Chip {
///     type Bus = Infallible;
///     const CHANNELS: usize = 1;
///     fn poll(&mut self, now: f64) -> Result<Option<RawSample>, AdcError<Infallible>> {
///         Ok(Some(RawSample::new(now, Channels::from([self.0]))))
///     }
/// }
/// let mut base = Side::new([Chip(1.0), Chip(2.0), Chip(3.0)]);
/// let sample = base.poll(0.1)?.ok_or("all are ready")?;
/// assert_eq!(*sample.channels, [1.0, 2.0, 3.0]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Side<A, const N: usize> {
    chips: [A; N],
    /// What has come of the next sample.
    have: [Option<RawSample>; N],
}

impl<A: Adc, const N: usize> Side<A, N> {
    /// These, in this order. More channels than a sample holds do not compile.
    pub fn new(chips: [A; N]) -> Self {
        const { assert!(N > 0 && N * A::CHANNELS <= Channels::MOST, "1 to 16 channels") };
        Self { chips, have: [None; N] }
    }

    /// The converters, to set them otherwise.
    pub fn chips(&mut self) -> &mut [A; N] {
        &mut self.chips
    }
}

impl<A: Adc, const N: usize> Adc for Side<A, N> {
    type Bus = A::Bus;
    const CHANNELS: usize = N * A::CHANNELS;

    /// What has come is kept over an error of one chip.
    fn poll(&mut self, now: f64) -> Result<Option<RawSample>, AdcError<Self::Bus>> {
        for (chip, have) in self.chips.iter_mut().zip(&mut self.have) {
            if have.is_none() {
                *have = chip.poll(now)?;
            }
        }
        if self.have.iter().any(Option::is_none) {
            return Ok(None);
        }
        let mut whole = RawSample { host_time: now, ..RawSample::default() };
        let (mut values, mut count) = ([0.0; Channels::MOST], 0);
        for sample in self.have.iter_mut().filter_map(Option::take) {
            whole.status |= sample.status;
            whole.quality |= sample.quality;
            whole.temperature = whole.temperature.or(sample.temperature);
            for (place, value) in values.iter_mut().skip(count).zip(sample.channels.iter()) {
                *place = *value;
                count += 1;
            }
        }
        whole.channels = values.get(..count).and_then(Channels::new).unwrap_or_default();
        Ok(Some(whole))
    }
}
