//! Samples written as they come, in what the reader reads.

use super::recorded::Recorded;
use super::role::{Role, si};
use super::table::Table;
use crate::link::LinkCounters;
use crate::sample::Quality;
use std::io::{self, Write};
use std::marker::PhantomData;

/// Which columns a recording has besides what every sample of its kind has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Contents {
    /// The raw sample, with so many channels. A recording of raw samples needs it.
    pub raw: Option<usize>,
    /// Standard deviations.
    pub sigma: bool,
    /// Bounds of the systematic errors.
    pub systematic: bool,
    /// Of reactions: force and moments out of the plane.
    pub out_of_plane: bool,
}

impl Contents {
    /// All columns there may be; how many channels matters to nobody who only asks for these.
    pub(super) const EVERYTHING: Self = Self { raw: Some(0), sigma: true, systematic: true, out_of_plane: true };
}

/// What a recording is of, in words: one line each.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct About {
    /// The sensor: type, number, range.
    pub sensor: String,
    /// Which calibration, or its file.
    pub calibration: String,
    /// When and how it was tared, or the values.
    pub tare: String,
    /// How the sensor sits under the clamp.
    pub mounting: String,
    /// What the times are of.
    pub clock: String,
    /// Anything else, with a name.
    pub notes: Vec<(String, String)>,
}

impl About {
    /// What is said in front of a recording.
    pub fn of(table: &Table) -> Self {
        let note = |key: &str| table.note(key).unwrap_or_default().to_owned();
        let first = table.header_line().unwrap_or(u64::MAX);
        let known = ["sensor", "calibration", "tare", "mounting", "clock", "units", ""];
        let others = table.notes().filter(|note| note.line < first && !known.contains(&note.key.as_str()));
        Self {
            sensor: note("sensor"),
            calibration: note("calibration"),
            tare: note("tare"),
            mounting: note("mounting"),
            clock: note("clock"),
            notes: others.map(|note| (note.key.clone(), note.text.clone())).collect(),
        }
    }
}

/// Why a sample is not written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RecordError {
    /// The file cannot be written.
    #[error("cannot write the recording: {0}")]
    Io(#[from] io::Error),
    /// Another number of raw values than there are columns.
    #[error("the sample has {found} channels, expected {expected} as in the contents of the recording")]
    Channels {
        /// How many it has.
        found: usize,
        /// How many columns there are.
        expected: usize,
    },
}

/// Writes samples as they come, as CSV with comments in front: SI units, numbers that survive a round trip bit by bit, flags by
/// name. Nothing is kept: memory does not grow. Put a [`BufWriter`](std::io::BufWriter) in between where that matters.
///
/// ```
/// use rod_hw::recording::{About, ColumnMap, Contents, Recorder, Table, TableOptions};
/// use rod_hw::{Channels, Quality, RawSample};
/// let about = About { sensor: "K3D40, no. 12".into(), ..About::default() };
/// let mut recorder = Recorder::new(Vec::new(), &about, Contents { raw: Some(2), ..Contents::default() })?;
/// let sample = RawSample { quality: Quality::GAP_BEFORE, ..RawSample::new(0.1, Channels::from([1e-7, 0.1 + 0.2])) };
/// recorder.write(&sample)?;
/// let file = recorder.finish(None)?;
///
/// let table = Table::parse("raw.csv", &file, &TableOptions::default())?;
/// let samples = table.samples::<RawSample>(&ColumnMap::new())?.collect::<Result<Vec<_>, _>>()?;
/// assert_eq!((samples, About::of(&table).sensor), (vec![sample], about.sensor));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Recorder<W, S> {
    out: W,
    roles: Vec<Role>,
    channels: Option<usize>,
    samples: u64,
    flagged: u64,
    kind: PhantomData<fn(&S)>,
}

/// What the first line says.
const TITLE: &str = "# vibrissa recording 1";
/// The key of the last line.
const END: &str = "end of the recording, samples";

impl<W: Write, S: Recorded> Recorder<W, S> {
    /// Writes what stands in front.
    ///
    /// # Errors
    /// Where that cannot be written.
    pub fn new(mut out: W, about: &About, contents: Contents) -> io::Result<Self> {
        let roles = S::roles(&contents);
        let channels = if S::CHANNELS { Some(contents.raw.unwrap_or_default()) } else { contents.raw };
        writeln!(out, "{TITLE}")?;
        let About { sensor, calibration, tare, mounting, clock, notes } = about;
        let named = [
            ("sensor", sensor),
            ("calibration", calibration),
            ("tare", tare),
            ("mounting", mounting),
            ("clock", clock),
        ];
        let others = notes.iter().map(|(key, text)| (key.as_str(), text));
        for (key, text) in named.into_iter().chain(others).filter(|(_, text)| !text.is_empty()) {
            writeln!(out, "# {}: {}", one_line(key).replace(':', " "), one_line(text))?;
        }
        let units = roles.iter().filter_map(|role| Some(format!("{role} {}", si(role.dimension()?))));
        writeln!(out, "# units: {}", units.collect::<Vec<_>>().join(", "))?;
        let numbered = (1..=channels.unwrap_or_default()).map(|i| format!("channel{i}"));
        let names: Vec<String> = roles.iter().map(Role::to_string).chain(numbered).collect();
        writeln!(out, "{}", names.join(","))?;
        Ok(Self { out, roles, channels, samples: 0, flagged: 0, kind: PhantomData })
    }

    /// Writes a sample. What its contents do not tell of is left out.
    ///
    /// # Errors
    /// [`RecordError`]; of a sample with a wrong number of channels nothing is written.
    pub fn write(&mut self, sample: &S) -> Result<(), RecordError> {
        let raw = sample.raw();
        if let Some(expected) = self.channels.filter(|expected| *expected != raw.channels.len()) {
            return Err(RecordError::Channels { found: raw.channels.len(), expected });
        }
        let out = &mut self.out;
        for (i, role) in self.roles.iter().enumerate() {
            if i > 0 {
                out.write_all(b",")?;
            }
            match role {
                Role::Quality => flags(out, sample.quality())?,
                Role::RawQuality => flags(out, raw.quality)?,
                Role::Status => write!(out, "{}", raw.status)?,
                Role::Sequence => raw.sequence.map_or(Ok(()), |number| write!(out, "{number}"))?,
                // the shortest text that is read as the same number
                _ => sample.value(*role).map_or(Ok(()), |value| write!(out, "{value:?}"))?,
            }
        }
        if self.channels.is_some() {
            for value in raw.channels.iter() {
                write!(out, ",{value:?}")?;
            }
        }
        out.write_all(b"\n")?;
        self.samples += 1;
        self.flagged += u64::from(!sample.quality().is_empty());
        Ok(())
    }

    /// Samples written.
    pub fn samples(&self) -> u64 {
        self.samples
    }

    /// Writes what is at the end, perhaps what came over the link, and hands back where it was written to, flushed. Without it
    /// a recording is as readable, but does not tell that it is whole.
    ///
    /// # Errors
    /// Where that cannot be written.
    pub fn finish(mut self, counters: Option<&LinkCounters>) -> io::Result<W> {
        if let Some(counters) = counters {
            writeln!(self.out, "# link: {counters}")?;
        }
        writeln!(self.out, "# flagged: {}", self.flagged)?;
        writeln!(self.out, "# {END}: {}", self.samples)?;
        self.out.flush()?;
        Ok(self.out)
    }
}

impl Table {
    /// Of a recording of a [`Recorder`]: whether it is whole, with as many rows as were written. None of other tables.
    pub fn is_whole(&self) -> Option<bool> {
        let title = comment_of(TITLE);
        let ours = self.notes().any(|note| note.key.is_empty() && note.text == title);
        ours.then(|| self.note(END).and_then(|count| count.parse().ok()) == Some(self.len()))
    }
}

fn comment_of(line: &str) -> &str {
    line.trim_start_matches('#').trim()
}

fn flags(out: &mut impl Write, quality: Quality) -> io::Result<()> {
    if quality.is_empty() {
        return out.write_all(b"good");
    }
    for (i, name) in quality.names().enumerate() {
        // commas separate cells
        write!(out, "{}{name}", if i == 0 { "" } else { "|" })?;
    }
    Ok(())
}

fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}
