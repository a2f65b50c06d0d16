//! Channels of a TDMS file as raw samples. The file itself is read by the package [`tdms_file`], whose types are here, too.

pub use tdms_file::*;

use crate::sample::{Channels, Quality, RawSample};

/// Channels of a group, at most 16, side by side: a source of their scaled values, for the volts of a
/// calibration matrix, for instance.
///
/// Counts of a card at their rail set [`Quality::SATURATED`]. What is wrong at the end, a channel that ends before the others or
/// a file that breaks off, comes once, as the last item.
///
/// ```
/// use rod_hw::recording::tdms::{TdmsFile, TdmsTime, samples};
/// use rod_hw::{Dimension, Unit};
/// let file = TdmsFile::read("tdms/tests/vectors/waveforms.tdms")?;
/// let unit = Unit::parse(file.channel("Measured", "Fx")?.unit().unwrap_or_default(), Dimension::Force)?;
/// assert_eq!(unit.name, "mN");
/// let second = samples(&file, "Measured", &["Fx", "Fy"], TdmsTime::Waveform)?.nth(1).ok_or("too short")??;
/// assert_eq!((second.time(), &second.channels[..]), (0.502, &[1.0, -0.125][..]));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`TdmsError`] where there is no such channel, it has no numbers, its scale is not known, or there is no time.
pub fn samples<'f>(
    file: &'f TdmsFile<'f>,
    group: &str,
    channels: &[&str],
    time: TdmsTime<'_>,
) -> Result<impl Iterator<Item = Result<RawSample, TdmsError>> + use<'f>, TdmsError> {
    Ok(file.rows(group, channels, time)?.map(|row| row.map(|row| of_row(&row))))
}

fn of_row(row: &TdmsRow) -> RawSample {
    const { assert!(TdmsRow::MOST <= Channels::MOST, "a sample holds a row") };
    let quality = if row.is_at_rail { Quality::SATURATED } else { Quality::empty() };
    let channels = Channels::new(row.values()).unwrap_or_default();
    RawSample { sequence: Some(row.number as u64), quality, ..RawSample::new(row.time, channels) }
}
