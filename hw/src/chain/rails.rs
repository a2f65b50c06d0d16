//! Raw values at their rails.

use crate::calibrate::{CalibrationDataError, CalibrationError, expect_channels, finite_channel};
use crate::sample::{Channels, Quality, RawSample};

/// The ends of the range of each channel, in raw units: counts or volts.
///
/// A value at an end, or beyond, says that the true one is at least that. As a matrix mixes the channels, one of them spoils
/// all components: the sample as a whole is marked.
///
/// ```
/// use rod_hw::{Channels, Quality, Rails, RawSample};
/// let rails = Rails::of_bits(24, 6).ok_or("no such converter")?;
/// let mut raw = RawSample::new(0.0, Channels::from([0.0, -8_388_608.0, 1.0, 2.0, 3.0, 4.0]));
/// assert_eq!(rails.check(&raw)?, Quality::SATURATED);
/// raw.channels = Channels::from([0.0, -8_388_607.0, 1.0, 2.0, 3.0, f64::NAN]);
/// assert_eq!(rails.check(&raw).unwrap_err().to_string(), "channel 6 is NaN, expected a finite number");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rails {
    low: [f64; Channels::MOST],
    high: [f64; Channels::MOST],
    count: Option<usize>,
}

impl Rails {
    /// Channels without ends: only numbers that are none are found.
    pub fn none() -> Self {
        let ends = [f64::INFINITY; Channels::MOST];
        Self { low: ends.map(|end| -end), high: ends, count: None }
    }

    /// Lower and upper end of each channel; infinite where it has none.
    ///
    /// ```
    /// use rod_hw::{Channels, Quality, Rails, RawSample};
    /// let rails = Rails::new(&[(-10.0, 10.0), (0.0, 5.0)])?; // V
    /// assert_eq!(rails.check(&RawSample::new(0.0, Channels::from([9.9, 0.1])))?, Quality::empty());
    /// assert_eq!(rails.check(&RawSample::new(0.0, Channels::from([9.9, 0.0])))?, Quality::SATURATED);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`CalibrationDataError`] where there are more than [`Channels::MOST`], or an end is not below the other.
    pub fn new(ends: &[(f64, f64)]) -> Result<Self, CalibrationDataError> {
        if ends.len() > Channels::MOST {
            return Err(CalibrationDataError::Channels { count: ends.len() });
        }
        let mut rails = Self { count: Some(ends.len()), ..Self::none() };
        for (i, &(low, high)) in ends.iter().enumerate() {
            if low.is_nan() || high.is_nan() || low >= high {
                return Err(CalibrationDataError::Ends { channel: i + 1, low, high });
            }
            (rails.low[i], rails.high[i]) = (low, high);
        }
        Ok(rails)
    }

    /// A converter of so many bits (2 to 53), with sign, on so many channels (up to 16).
    pub fn of_bits(bits: u32, channels: usize) -> Option<Self> {
        let half = (2..=53).contains(&bits).then(|| (1_u64 << (bits - 1)) as f64)?;
        Self::new([(-half, half - 1.0); Channels::MOST].get(..channels)?).ok()
    }

    /// [`Quality::SATURATED`] where a channel is at an end of its range or beyond, nothing otherwise.
    ///
    /// # Errors
    /// [`CalibrationError`] where a value is not finite, or there is another number of them.
    pub fn check(&self, raw: &RawSample) -> Result<Quality, CalibrationError> {
        self.count.map_or(Ok(()), |count| expect_channels(raw, count))?;
        let mut quality = Quality::empty();
        for (channel, (&low, &high)) in (0..raw.channels.len()).zip(self.low.iter().zip(&self.high)) {
            let value = finite_channel(raw, channel)?;
            if value <= low || value >= high {
                quality |= Quality::SATURATED;
            }
        }
        Ok(quality)
    }
}
