//! Several converters as one.

use super::{Adc, AdcError};
use crate::quality::Quality;
use crate::raw::{Channels, RawSample};

/// Several converters side by side as one, whose channels are theirs in a row: a base with one chip a bridge.
///
/// A sample is whole when each chip has converted at least once; of a faster chip the last conversion counts. Their clocks are
/// their own, so that values of one sample lie up to a conversion apart; it has the time of the last. Its status is the bits of
/// all, its temperature that of the first that has one.
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
    /// What those that an error threw away said of their chip.
    news: Quality,
}

impl<A: Adc, const N: usize> Side<A, N> {
    /// These, in this order. More channels than a sample holds do not compile.
    pub fn new(chips: [A; N]) -> Self {
        const { assert!(N > 0 && N * A::CHANNELS <= Channels::MOST, "1 to 16 channels") };
        Self { chips, have: [None; N], news: Quality::empty() }
    }

    /// The converters, to set them otherwise.
    pub fn chips(&mut self) -> &mut [A; N] {
        &mut self.chips
    }
}

impl<A: Adc, const N: usize> Adc for Side<A, N> {
    type Bus = A::Bus;
    const CHANNELS: usize = N * A::CHANNELS;

    /// All are asked, whatever one of them says: what one has told must not grow old while another fails.
    fn poll(&mut self, now: f64) -> Result<Option<RawSample>, AdcError<Self::Bus>> {
        let mut result = Ok(());
        for (chip, have) in self.chips.iter_mut().zip(&mut self.have) {
            match chip.poll(now) {
                Ok(Some(sample)) => {
                    self.news |= have.replace(sample).map_or(Quality::empty(), news);
                }
                Ok(None) => {}
                Err(error) => {
                    self.news |= have.take().map_or(Quality::empty(), news);
                    result = result.and(Err(error));
                }
            }
        }
        result?;
        if self.have.iter().any(Option::is_none) {
            return Ok(None);
        }
        let quality = core::mem::take(&mut self.news);
        let mut whole = RawSample { host_time: now, quality, ..RawSample::default() };
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

/// What a sample that is not handed on says of its chip: a rail is one of its own conversion, anything else is news.
fn news(sample: RawSample) -> Quality {
    sample.quality.difference(Quality::SATURATED)
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::convert::Infallible;

    /// Says what it is told to, then nothing more.
    struct Script(Vec<Result<Option<f64>, AdcError<Infallible>>>);

    impl Adc for Script {
        type Bus = Infallible;
        const CHANNELS: usize = 1;
        fn poll(&mut self, now: f64) -> Result<Option<RawSample>, AdcError<Infallible>> {
            let said = if self.0.is_empty() { Ok(None) } else { self.0.remove(0) };
            let flags = |value| if value == 1.0 { Quality::SATURATED | Quality::RESTARTED } else { Quality::empty() };
            said.map(|value| {
                value.map(|value| RawSample { quality: flags(value), ..RawSample::new(now, Channels::from([value])) })
            })
        }
    }

    #[test]
    fn the_last_conversion_of_a_faster_chip_counts() {
        let fast = [1.0, 2.0, 3.0].map(|value| Ok(Some(value)));
        let mut side = Side::new([Script(fast.into()), Script(vec![Ok(None), Ok(None), Ok(Some(9.0))])]);
        assert_eq!(side.poll(0.1), Ok(None));
        assert_eq!(side.poll(0.2), Ok(None));
        let sample = side.poll(0.3).unwrap().unwrap();
        assert_eq!((*sample.channels).to_vec(), [3.0, 9.0]);
        assert_eq!((sample.host_time, sample.quality), (0.3, Quality::RESTARTED));
        assert_eq!(side.poll(0.4), Ok(None), "each conversion once");
    }

    #[test]
    fn news_of_a_chip_outlive_its_error() {
        let restarts = Script(vec![Ok(Some(1.0)), Err(AdcError::StuckLine), Ok(Some(3.0))]);
        let works = Script(vec![Ok(None), Ok(None), Ok(Some(4.0)), Ok(Some(5.0))]);
        let mut side = Side::new([restarts, works]);
        assert_eq!(side.poll(0.1), Ok(None));
        assert_eq!(side.poll(0.2), Err(AdcError::StuckLine));
        assert_eq!(side.poll(0.3).unwrap().unwrap().quality, Quality::RESTARTED);
    }

    #[test]
    fn an_error_of_one_is_that_of_all_and_leaves_nothing_old() {
        for first in [true, false] {
            let works = Script([2.0, 3.0, 4.0].map(|value| Ok(Some(value))).into());
            let fails = Script(vec![Ok(None), Err(AdcError::StuckLine), Ok(Some(5.0))]);
            let mut side = Side::new(if first { [fails, works] } else { [works, fails] });
            assert_eq!(side.poll(0.1), Ok(None));
            assert_eq!(side.poll(0.2), Err(AdcError::StuckLine));
            let sample = side.poll(0.3).unwrap().unwrap();
            assert_eq!((*sample.channels).to_vec(), if first { [5.0, 4.0] } else { [4.0, 5.0] });
        }
    }
}
