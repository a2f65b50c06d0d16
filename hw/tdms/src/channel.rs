//! A channel and its values.

use super::TdmsFile;
use super::contents::ChannelContents;
use super::data_type::DataType;
use super::error::TdmsError;
use super::property::{TdmsProperties, TdmsValue};
use super::run::Series;
use super::scaling::Scaling;
use super::timestamp::TdmsTimestamp;

/// A channel of a file.
#[derive(Clone, Copy, Debug)]
pub struct TdmsChannel<'f> {
    file: &'f TdmsFile<'f>,
    contents: &'f ChannelContents,
}

/// When the values of a channel were taken: `offset + i * increment` for value `i`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimeAxis {
    /// When it all started, where it is told (`wf_start_time`).
    pub start: Option<TdmsTimestamp>,
    /// Time of the first value from there, s (`wf_start_offset`).
    pub offset: f64,
    /// From value to value, s (`wf_increment`).
    pub increment: f64,
}

impl TimeAxis {
    /// Time of value `i`, s.
    #[expect(clippy::cast_precision_loss, reason = "no file has 2^53 values")]
    pub fn at(&self, i: usize) -> f64 {
        self.offset + i as f64 * self.increment
    }
}

impl<'f> TdmsChannel<'f> {
    pub(super) fn new(file: &'f TdmsFile<'f>, contents: &'f ChannelContents) -> Self {
        Self { file, contents }
    }

    /// Name of its group.
    pub fn group(&self) -> &'f str {
        self.file.contents.groups.get(self.contents.group).map_or("", |group| &group.name)
    }

    /// Its name.
    pub fn name(&self) -> &'f str {
        &self.contents.name
    }

    /// How many values it has.
    pub fn len(&self) -> usize {
        self.contents.series.iter().map(|series| series.count).min().unwrap_or(0)
    }

    /// Whether it is empty.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The data type of its raw values; `None` if it has no values. With several DAQmx scalers it is that of the first.
    pub fn data_type(&self) -> Option<DataType> {
        self.contents.series.first()?.runs.first().map(|run| run.data_type)
    }

    /// Whether its raw values are as a card delivered them (DAQmx).
    pub fn is_daqmx(&self) -> bool {
        self.contents.series.first().is_some_and(|series| series.id.is_some())
    }

    /// Its properties.
    pub fn properties(&self) -> &'f TdmsProperties {
        &self.contents.properties
    }

    /// The property `unit_string`, of the scaled values, as it is written; `Unit::parse` understands it.
    pub fn unit(&self) -> Option<&'f str> {
        self.properties().get("unit_string")?.text()
    }

    /// The time axis, where it has one.
    ///
    /// # Errors
    /// [`TdmsError::NoTime`] where `wf_increment` is missing or no number above 0.
    pub fn time_axis(&self) -> Result<TimeAxis, TdmsError> {
        let find = |name: &str| self.properties().get(name);
        let increment = find("wf_increment").and_then(TdmsValue::number).filter(|&step| step.is_finite() && step > 0.0);
        let offset = find("wf_start_offset").and_then(TdmsValue::number).unwrap_or(0.0);
        let start = match find("wf_start_time") {
            Some(TdmsValue::Timestamp(time)) => Some(*time),
            _ => None,
        };
        match increment {
            Some(increment) if offset.is_finite() => Ok(TimeAxis { start, offset, increment }),
            _ => {
                let found = find("wf_increment").map_or("nothing".to_owned(), ToString::to_string);
                Err(TdmsError::NoTime { channel: self.name().to_owned(), found })
            }
        }
    }

    /// The values as they are in the file, without any scaling: counts, as a rule. Integers beyond 2^53 are rounded; booleans
    /// are 0 and 1, timestamps seconds since 1970. Of several DAQmx scalers it is the first one's.
    ///
    /// # Errors
    /// [`TdmsError::Type`] where they are texts or complex.
    pub fn raw(&self) -> Result<TdmsValues<'f>, TdmsError> {
        self.check_number()?;
        Ok(TdmsValues::new(self.file, self.contents, None))
    }

    /// The values in the unit of the channel: scaled where its properties, those of its group or of the file say how, raw
    /// otherwise. Known scales: linear, polynomial, sum, difference.
    ///
    /// # Errors
    /// [`TdmsError::Type`] as for [`raw`](Self::raw), [`TdmsError::Scaling`] where the scale is another one (thermocouple,
    /// strain, table ...): never raw values in their place.
    pub fn values(&self) -> Result<TdmsValues<'f>, TdmsError> {
        self.check_number()?;
        let contents = &self.file.contents;
        let group = contents.groups.get(self.contents.group).map_or(&contents.root, |group| &group.properties);
        let scaling = Scaling::new(self.contents, [self.properties(), group, &contents.root])?;
        Ok(TdmsValues::new(self.file, self.contents, scaling))
    }

    /// The values of a channel of texts; what is not UTF-8 is replaced.
    ///
    /// # Errors
    /// [`TdmsError::Type`] where they are not texts.
    pub fn texts(&self) -> Result<impl Iterator<Item = String> + use<'f>, TdmsError> {
        self.check(|found| found == DataType::Text, "texts")?;
        let bytes = &*self.file.bytes;
        let runs = self.contents.series.first().map_or(&[][..], |series| &series.runs);
        let places = runs.iter().flat_map(move |run| (0..run.count).map(move |i| run.text(bytes, i)));
        // each byte belongs to one text, whatever the table says, so that they are no longer than the file
        Ok(places.scan(0, move |reached, place| {
            let place = place.filter(|place| place.start >= *reached && place.start <= place.end).unwrap_or(0..0);
            *reached = place.end.max(*reached);
            Some(String::from_utf8_lossy(bytes.get(place).unwrap_or_default()).into_owned())
        }))
    }

    /// The values of a channel of timestamps, exact.
    ///
    /// # Errors
    /// [`TdmsError::Type`] where they are not timestamps.
    pub fn timestamps(&self) -> Result<impl Iterator<Item = TdmsTimestamp> + use<'f>, TdmsError> {
        self.check(|found| found == DataType::Timestamp, "timestamps")?;
        let bytes = &*self.file.bytes;
        let runs = self.contents.series.first().map_or(&[][..], |series| &series.runs);
        Ok(runs
            .iter()
            .flat_map(move |run| (0..run.count).filter_map(move |i| TdmsTimestamp::read(bytes, run.at(i)?, run.order))))
    }

    fn check_number(&self) -> Result<(), TdmsError> {
        self.check(DataType::is_number, "real numbers")
    }

    fn check(&self, is_right: impl Fn(DataType) -> bool, expected: &'static str) -> Result<(), TdmsError> {
        match self.data_type().filter(|&found| !is_right(found)) {
            Some(found) => Err(TdmsError::Type { channel: self.name().to_owned(), found, expected }),
            None => Ok(()),
        }
    }
}

/// The values of a channel in turn, read from the bytes one by one.
#[derive(Clone, Debug)]
pub struct TdmsValues<'f> {
    bytes: &'f [u8],
    /// Of each series, where it is read, the run and the place in it.
    series: Vec<Option<(&'f Series, usize, usize)>>,
    raw: Vec<f64>,
    scaling: Option<Scaling>,
    left: usize,
}

impl<'f> TdmsValues<'f> {
    fn new(file: &'f TdmsFile<'f>, contents: &'f ChannelContents, scaling: Option<Scaling>) -> Self {
        let is_read = |index: usize| scaling.as_ref().map_or(index == 0, |scaling| scaling.takes(index));
        let all = contents.series.iter().enumerate();
        let series: Vec<_> = all.map(|(index, series)| is_read(index).then_some((series, 0, 0))).collect();
        let left = series.iter().flatten().map(|(series, ..)| series.count).min().unwrap_or(0);
        Self { bytes: &file.bytes, raw: vec![0.0; series.len()], series, scaling, left }
    }

    /// The next value, and whether a count of a card lies at its rail.
    pub(super) fn next_with_rail(&mut self) -> Option<(f64, bool)> {
        self.left = self.left.checked_sub(1)?;
        let mut is_rail = false;
        for (place, raw) in self.series.iter_mut().zip(&mut self.raw) {
            let Some((series, run_index, i)) = place else { continue };
            let mut run = series.runs.get(*run_index)?;
            while *i >= run.count {
                (*run_index, *i) = (*run_index + 1, 0);
                run = series.runs.get(*run_index)?;
            }
            *raw = run.number(self.bytes, *i)?;
            is_rail |= series.id.is_some() && run.data_type.is_rail(*raw);
            *i += 1;
        }
        let value = match &mut self.scaling {
            Some(scaling) => scaling.apply(&self.raw),
            None => *self.raw.first()?,
        };
        Some((value, is_rail))
    }
}

impl Iterator for TdmsValues<'_> {
    type Item = f64;

    fn next(&mut self) -> Option<f64> {
        self.next_with_rail().map(|(value, _)| value)
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        (self.left, Some(self.left))
    }
}

impl ExactSizeIterator for TdmsValues<'_> {}
