//! Recordings, played back.

use super::error::LiveError;
use super::feed::{Fed, Feed, Miss, Sensor};
use crate::{ReadOptions, RecordingSetup, RecordingTime, SensorCalibration, Setup};
use std::error::Error as StdError;
use std::fmt::Display;
use std::path::Path;
use vibrissa::hw::recording::mcap::{McapError, McapFile};
use vibrissa::hw::recording::tdms::{self, TdmsError, TdmsFile, TdmsTime, TdmsTimestamp};
use vibrissa::hw::recording::{ColumnMap, Recorded, Role, RowFault, Table, TableError, TableProblem};
use vibrissa::hw::{LinkCounters, RawSample, ReactionSample, Scale, WrenchSample};

/// A recording, played back as fast as it is asked for.
struct RecordingFeed {
    samples: std::vec::IntoIter<Result<Fed, Miss>>,
    handed: u64,
}

/// The samples of a recording, their calibration if they have none, and their time 0, s since 1970, where the file has it beside them.
type Samples = (Rows, Option<SensorCalibration>, Option<f64>);
type Rows = Vec<Result<Fed, Miss>>;

/// Opens a recording: TDMS and MCAP by the end of its name, anything else as a table.
pub(super) fn open(file: &Path, setup: &Setup, how: &ReadOptions) -> Result<Sensor, LiveError> {
    let is = |end: &str| file.extension().is_some_and(|extension| extension.eq_ignore_ascii_case(end));
    let (samples, calibration, epoch) = if is("tdms") {
        labview(file, setup)
    } else if is("mcap") {
        mcap(file, setup)
    } else {
        table(file, setup, how).map(|(samples, calibration)| (samples, calibration, None))
    }?;
    let feed = Box::new(RecordingFeed { samples: samples.into_iter(), handed: 0 });
    Ok(Sensor { feed, calibration, name: address(file), epoch })
}

fn address(file: &Path) -> String {
    format!("file:{}", file.display())
}

fn sensor_error<E: StdError + Send + Sync + 'static>(file: &Path) -> impl Fn(E) -> LiveError {
    move |error| LiveError::Sensor { address: address(file), source: Box::new(error) }
}

/// The calibration of raw values, which the setup must give.
fn required_calibration(file: &Path, setup: &Setup) -> Result<SensorCalibration, LiveError> {
    setup.calibration.clone().ok_or_else(|| LiveError::NoScale { address: address(file) })
}

/// The error for a part of the file that the setup has to choose.
fn choose<T: Display>(
    file: &Path,
    field: &'static str,
    there: impl Iterator<Item = T>,
    fault: Option<&impl Display>,
) -> LiveError {
    let there: Vec<String> = there.map(|name| name.to_string()).collect();
    let found = if there.is_empty() { "none".to_owned() } else { there.join(", ") };
    let fault = fault.map_or_else(String::new, |fault| format!(" ({fault})"));
    LiveError::Choose { file: file.to_path_buf(), field, found: found + &fault }
}

/// A wrench in N and N m.
fn of_wrench(sample: WrenchSample) -> Fed {
    let WrenchSample { t, wrench, quality, raw, .. } = sample;
    Fed::Raw(RawSample { channels: wrench.components().into(), host_time: t, quality, ..raw })
}

fn of_file<E: Display>(file: &Path) -> impl Fn(E) -> Miss {
    move |error| Miss::Fault(format!("{}: {error}", file.display()))
}

/// Raw values of the channels of a group.
fn labview(file: &Path, setup: &Setup) -> Result<Samples, LiveError> {
    let opened = TdmsFile::read(file).map_err(sensor_error::<TdmsError>(file))?;
    let RecordingSetup { columns, group, time, .. } = &setup.recording;
    let group = group.as_ref().and_then(|name| opened.group(name)).ok_or_else(|| {
        choose(file, "group", opened.groups().map(|group| format!("`{}`", group.name())), opened.fault())
    })?;
    let columns = columns.as_ref().ok_or_else(|| {
        choose(file, "columns", group.channels().map(|channel| format!("`{}`", channel.name())), opened.fault())
    })?;
    let time = match time {
        RecordingTime::Own => TdmsTime::Waveform,
        RecordingTime::Named(channel) => TdmsTime::Channel(channel),
        RecordingTime::Rate(rate) => TdmsTime::Rate(*rate),
    };
    let names: Vec<&str> = columns.iter().map(String::as_str).collect();
    let samples = tdms::samples(&opened, group.name(), &names, time).map_err(sensor_error::<TdmsError>(file))?;
    let calibration = required_calibration(file, setup)?;
    let axis = names
        .first()
        .filter(|_| time == TdmsTime::Waveform)
        .and_then(|name| opened.channel(group.name(), name).ok()?.time_axis().ok());
    let epoch = axis.and_then(|axis| axis.start).map(TdmsTimestamp::unix_seconds);
    Ok((samples.map(|sample| sample.map(Fed::Raw).map_err(of_file(file))).collect(), Some(calibration), epoch))
}

/// Wrenches of a topic.
fn mcap(file: &Path, setup: &Setup) -> Result<Samples, LiveError> {
    let opened = McapFile::read(file).map_err(sensor_error::<McapError>(file))?;
    let topic = setup.recording.topic.as_ref().ok_or_else(|| {
        let named =
            |topic: &vibrissa::hw::recording::mcap::McapTopic| format!("`{}` of {}", topic.name, topic.type_name);
        choose(file, "topic", opened.topics().iter().map(named), opened.fault())
    })?;
    if setup.calibration.is_some() {
        return Err(LiveError::Calibrated { file: file.to_path_buf() });
    }
    let wrenches = opened.wrenches(topic).map_err(sensor_error::<McapError>(file))?;
    let samples = wrenches.map(|sample| sample.map(of_wrench).map_err(of_file(file)));
    Ok((samples.collect(), Some(SensorCalibration::Scale(Scale::si())), Some(opened.origin())))
}

/// Rows of a table: raw values if the setup has a matrix for them or names their columns; otherwise reactions with poses, wrenches in
/// the units of the file, or raw values, the first of these that the table contains.
fn table(file: &Path, setup: &Setup, how: &ReadOptions) -> Result<(Rows, Option<SensorCalibration>), LiveError> {
    let table = Table::read(file, &how.options).map_err(LiveError::Table)?;
    let RecordingSetup { columns, time, .. } = &setup.recording;
    let mut map = how.columns.clone();
    match time {
        RecordingTime::Own => {}
        RecordingTime::Named(column) => map = map.with(Role::Time, column),
        RecordingTime::Rate(_) => return Err(LiveError::Rate { file: file.to_path_buf() }),
    }
    if let Some(columns) = columns {
        map = map.with_channels(columns);
    }
    let mut complaint = None;
    if columns.is_none() && !matches!(setup.calibration, Some(SensorCalibration::Gauges(_))) {
        match rows::<ReactionSample>(&table, &map, Fed::Reactions) {
            Ok(samples) => return Ok((samples, None)),
            Err(error) => complaint = telling(error),
        }
        match rows::<WrenchSample>(&table, &map, of_wrench) {
            Ok(samples) => return Ok((samples, Some(SensorCalibration::Scale(Scale::si())))),
            Err(error) => complaint = complaint.or(telling(error)),
        }
    }
    match rows::<RawSample>(&table, &map, Fed::Raw) {
        Ok(samples) => Ok((samples, Some(required_calibration(file, setup)?))),
        Err(error) => {
            let TableError { file, line, problem } = complaint.unwrap_or(error);
            Err(match problem {
                TableProblem::NoChannels { found } => LiveError::NoSamples { file, line, found },
                problem => LiveError::Table(TableError { file, line, problem }),
            })
        }
    }
}

/// The error, unless it is that columns are missing: the table may be one of another kind.
fn telling(error: TableError) -> Option<TableError> {
    (!matches!(error.problem, TableProblem::Missing { .. })).then_some(error)
}

fn rows<S: Recorded>(table: &Table, map: &ColumnMap, fed: impl Fn(S) -> Fed) -> Result<Rows, TableError> {
    let fault = |error: RowFault| Miss::Fault(format!("{}: {error}", table.file()));
    Ok(table.samples::<S>(map)?.map(|row| row.map(&fed).map_err(fault)).collect())
}

impl Feed for RecordingFeed {
    fn next(&mut self) -> Option<Result<Fed, Miss>> {
        let next = self.samples.next()?;
        self.handed += u64::from(next.is_ok());
        Some(next)
    }

    fn counters(&self) -> LinkCounters {
        LinkCounters { samples: self.handed, ..LinkCounters::default() }
    }

    fn now(&self) -> Option<f64> {
        None
    }
}
