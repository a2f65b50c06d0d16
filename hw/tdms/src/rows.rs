//! Channels side by side, row by row.

use super::TdmsFile;
use super::channel::{TdmsChannel, TdmsValues, TimeAxis};
use super::error::{TdmsError, TdmsFault};

/// Where the time of the rows comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TdmsTime<'n> {
    /// The time axis of the channels (`wf_start_offset`, `wf_increment`), which must be one and the same.
    Waveform,
    /// A channel of the same group: its values are s, or timestamps.
    Channel(&'n str),
    /// So many rows a second, from 0 on.
    Rate(f64),
}

/// One value of each of several channels, taken at the same time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TdmsRow {
    /// Its place in the file, from 0.
    pub number: usize,
    /// The time of the row, s.
    pub time: f64,
    /// Whether a count of a card (DAQmx) is the smallest or largest one of its type: the true value may be beyond.
    pub is_at_rail: bool,
    values: [f64; Self::MOST],
    count: usize,
}

impl TdmsRow {
    /// Most channels side by side, so that a row needs no memory of its own.
    pub const MOST: usize = 16;

    /// The scaled values, in the order that the channels were asked for.
    pub fn values(&self) -> &[f64] {
        self.values.get(..self.count).unwrap_or_default()
    }
}

/// Channels side by side: an iterator of their scaled values.
///
/// What is wrong at the end, a channel that ends before the others or
/// a file that breaks off, comes once, as the last item.
#[derive(Clone, Debug)]
pub struct TdmsRows<'f> {
    columns: Vec<TdmsValues<'f>>,
    time: Time<'f>,
    row: usize,
    rows: usize,
    /// The faults to report at the end, the last one first.
    faults: Vec<Fault>,
}

#[derive(Clone, Debug)]
enum Time<'f> {
    Axis(TimeAxis),
    Channel(&'f str, TdmsValues<'f>),
}

#[derive(Clone, Debug)]
enum Fault {
    File(TdmsFault),
    Uneven { channel: String, found: usize, most: usize },
}

impl<'f> TdmsRows<'f> {
    pub(super) fn new(
        file: &'f TdmsFile<'f>,
        group: &str,
        names: &[&str],
        time: TdmsTime<'_>,
    ) -> Result<Self, TdmsError> {
        if names.is_empty() || names.len() > TdmsRow::MOST {
            return Err(TdmsError::Count { found: names.len(), most: TdmsRow::MOST });
        }
        let mut channels = names.iter().map(|name| file.channel(group, name)).collect::<Result<Vec<_>, _>>()?;
        let columns = channels.iter().map(TdmsChannel::values).collect::<Result<Vec<_>, _>>()?;
        let time = match time {
            TdmsTime::Rate(rate) if rate.is_finite() && rate > 0.0 => {
                Time::Axis(TimeAxis { start: None, offset: 0.0, increment: 1.0 / rate })
            }
            TdmsTime::Rate(rate) => return Err(TdmsError::Rate(rate)),
            TdmsTime::Waveform => Time::Axis(one_axis(&channels)?),
            TdmsTime::Channel(name) => {
                let channel = file.channel(group, name)?;
                channels.push(channel);
                Time::Channel(channel.name(), channel.values()?)
            }
        };
        let lengths = || channels.iter().map(TdmsChannel::len);
        let (rows, most) = (lengths().min().unwrap_or(0), lengths().max().unwrap_or(0));
        let mut faults: Vec<Fault> = file.fault().cloned().map(Fault::File).into_iter().collect();
        if let Some(shortest) = channels.iter().find(|channel| channel.len() == rows && rows < most) {
            faults.push(Fault::Uneven { channel: shortest.name().to_owned(), found: rows, most });
        }
        Ok(Self { columns, time, row: 0, rows, faults })
    }

    fn row(&mut self) -> Option<Result<TdmsRow, TdmsError>> {
        let (number, count) = (self.row, self.columns.len());
        let mut row = TdmsRow { number, time: 0.0, is_at_rail: false, values: [0.0; TdmsRow::MOST], count };
        for (column, value) in self.columns.iter_mut().zip(&mut row.values) {
            let (found, is_rail) = column.next_with_rail()?;
            *value = found;
            row.is_at_rail |= is_rail;
        }
        row.time = match &mut self.time {
            Time::Axis(axis) => axis.at(number),
            Time::Channel(channel, times) => match times.next()? {
                value if !value.is_finite() => {
                    return Some(Err(TdmsError::Time { channel: (*channel).to_owned(), row: number, value }));
                }
                time => time,
            },
        };
        Some(Ok(row))
    }
}

/// The time axis of all of them.
fn one_axis(channels: &[TdmsChannel<'_>]) -> Result<TimeAxis, TdmsError> {
    let mut found: Option<(TimeAxis, &str)> = None;
    for channel in channels {
        let axis = channel.time_axis()?;
        match found {
            None => found = Some((axis, channel.name())),
            Some((first, name)) if (first.offset, first.increment) != (axis.offset, axis.increment) => {
                return Err(TdmsError::TwoClocks {
                    first: name.to_owned(),
                    first_offset: first.offset,
                    first_increment: first.increment,
                    channel: channel.name().to_owned(),
                    offset: axis.offset,
                    increment: axis.increment,
                });
            }
            Some(_) => {}
        }
    }
    found.map(|(axis, _)| axis).ok_or(TdmsError::Count { found: 0, most: TdmsRow::MOST })
}

impl Iterator for TdmsRows<'_> {
    type Item = Result<TdmsRow, TdmsError>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.row < self.rows {
            let row = self.row();
            self.row += 1;
            if row.is_some() {
                return row;
            }
        }
        self.faults.pop().map(|fault| {
            Err(match fault {
                Fault::File(fault) => fault.into(),
                Fault::Uneven { channel, found, most } => TdmsError::Uneven { channel, found, most },
            })
        })
    }
}
