//! Raw samples.

use super::quality::Quality;
use core::ops::Deref;

/// The values that a device sent for one instant, unchanged.
///
/// ```
/// use rod_hw::{Channels, RawSample};
/// let raw = RawSample { sequence: Some(7), ..RawSample::new(0.25, Channels::new(&[100.0, -200.0]).ok_or("too many")?) };
/// assert_eq!((raw.time(), raw.channels[1]), (0.25, -200.0));
/// # Ok::<(), &str>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RawSample {
    /// Number of the sample by the device's own counter, unwrapped.
    pub sequence: Option<u64>,
    /// Time by the device's own clock, s, unwrapped, from any origin.
    pub device_time: Option<f64>,
    /// When it arrived, s, from the start of the link or recording.
    pub host_time: f64,
    /// Status word as sent; its meaning is the device's.
    pub status: u32,
    /// Temperature of the sensor, degrees Celsius.
    pub temperature: Option<f64>,
    /// Counts, volts or whatever the device sends, in its order. Counts up to 2^53 are exact.
    pub channels: Channels,
    /// Quality flags, as far as the device and the link know.
    pub quality: Quality,
}

impl RawSample {
    /// Values that arrived at a time (s); nothing else is known.
    pub fn new(host_time: f64, channels: Channels) -> Self {
        Self { host_time, channels, ..Self::default() }
    }

    /// Time, s: by the device's clock where it has one, by the host's otherwise.
    pub fn time(&self) -> f64 {
        self.device_time.unwrap_or(self.host_time)
    }
}

/// Up to 16 values side by side.
#[derive(Clone, Copy, Default, PartialEq)]
pub struct Channels {
    values: [f64; Self::MOST],
    count: usize,
}

impl Channels {
    /// How many values there can be.
    pub const MOST: usize = 16;

    /// These values; `None` if there are more than [`MOST`](Self::MOST).
    pub fn new(values: &[f64]) -> Option<Self> {
        let mut channels = Self { values: [0.0; Self::MOST], count: values.len() };
        channels.values.get_mut(..values.len())?.copy_from_slice(values);
        Some(channels)
    }
}

impl<const N: usize> From<[f64; N]> for Channels {
    fn from(values: [f64; N]) -> Self {
        const { assert!(N <= Self::MOST, "at most 16 channels") };
        let mut channels = Self { values: [0.0; Self::MOST], count: N };
        channels.values[..N].copy_from_slice(&values);
        channels
    }
}

impl Deref for Channels {
    type Target = [f64];
    fn deref(&self) -> &[f64] {
        &self.values[..self.count]
    }
}

impl core::fmt::Debug for Channels {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_list().entries(self.iter()).finish()
    }
}
