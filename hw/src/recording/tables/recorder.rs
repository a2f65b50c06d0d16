//! Reactions written as they come, in what the reader reads.

use super::recorded::{ACROSS, RAW, SIGMA, SYSTEMATIC};
use super::role::{Role, si};
use super::table::Table;
use crate::link::LinkCounters;
use crate::sample::{OutOfPlane, Quality, RawSample, ReactionSample};
use rod_core::{Pose, Reactions};
use std::io::{self, Write};

/// Which columns a recording has besides time, pose, reactions and flags.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Contents {
    /// The raw sample, with so many channels.
    pub raw: Option<usize>,
    /// Standard deviations.
    pub sigma: bool,
    /// Bounds of the systematic errors.
    pub systematic: bool,
    /// Force and moments out of the plane.
    pub out_of_plane: bool,
}

/// Writes reactions as they come, as CSV with comments in front: SI units, numbers that survive a round trip bit by bit, flags by
/// name. Nothing is kept: memory does not grow. Put a [`BufWriter`](std::io::BufWriter) in between where that matters.
///
/// ```
/// use rod_core::{Pose, Reactions};
/// use rod_hw::recording::{ColumnMap, Contents, Recorder, Table, TableOptions};
/// use rod_hw::{OutOfPlane, Quality, RawSample, ReactionSample};
/// let mut recorder = Recorder::new(Vec::new(), &[("sensor", "K3D40, no. 12")], Contents::default())?;
/// let sample = ReactionSample {
///     t: 0.1,
///     pose: Pose { x: 0.08, y: -0.04, phi: 1.5 },
///     reactions: Reactions { f0x: 1e-7, f0y: 0.1 + 0.2, m0z: -1e-3 },
///     sigma: None,
///     systematic: None,
///     out_of_plane: OutOfPlane::default(),
///     quality: Quality::GAP_BEFORE,
///     raw: RawSample::default(),
/// };
/// recorder.write(&sample)?;
/// let file = recorder.finish(None)?;
///
/// let table = Table::parse("scan.csv", &file, &TableOptions::default())?;
/// let read = table.samples::<ReactionSample>(&ColumnMap::new())?.next().ok_or("empty")??;
/// assert_eq!((read.reactions, read.quality), (sample.reactions, sample.quality));
/// assert_eq!(table.note("sensor"), Some("K3D40, no. 12"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Recorder<W> {
    out: W,
    roles: Vec<Role>,
    channels: Option<usize>,
    samples: u64,
    flagged: u64,
}

/// The first line.
const TITLE: &str = "# vibrissa recording 1";
/// The key of the last line.
const END: &str = "end of the recording, samples";

impl<W: Write> Recorder<W> {
    /// Writes what stands in front: notes, each a name and a text (the sensor, its calibration, the tare, ...), then the columns.
    ///
    /// # Errors
    /// If that cannot be written.
    pub fn new(mut out: W, notes: &[(&str, &str)], contents: Contents) -> io::Result<Self> {
        let roles = roles(&contents);
        let channels = contents.raw;
        writeln!(out, "{TITLE}")?;
        for (key, text) in notes.iter().filter(|(_, text)| !text.is_empty()) {
            writeln!(out, "# {}: {}", one_line(key).replace(':', " "), one_line(text))?;
        }
        let units = roles.iter().filter_map(|role| Some(format!("{role} {}", si(role.dimension()?))));
        writeln!(out, "# units: {}", units.collect::<Vec<_>>().join(", "))?;
        let numbered = (1..=channels.unwrap_or_default()).map(|i| format!("channel{i}"));
        let names: Vec<String> = roles.iter().map(Role::to_string).chain(numbered).collect();
        writeln!(out, "{}", names.join(","))?;
        Ok(Self { out, roles, channels, samples: 0, flagged: 0 })
    }

    /// Writes a sample. What its contents do not tell of is left out.
    ///
    /// # Errors
    /// If it cannot be written, or has another number of channels than the contents say; then nothing is written of it.
    pub fn write(&mut self, sample: &ReactionSample) -> io::Result<()> {
        let raw = &sample.raw;
        if let Some(expected) = self.channels.filter(|expected| *expected != raw.channels.len()) {
            let found = raw.channels.len();
            return Err(io::Error::new(
                io::ErrorKind::InvalidInput,
                format!("the sample has {found} channels, expected {expected} as in the contents of the recording"),
            ));
        }
        let out = &mut self.out;
        for (i, role) in self.roles.iter().enumerate() {
            if i > 0 {
                out.write_all(b",")?;
            }
            match role {
                Role::Quality => flags(out, sample.quality)?,
                Role::RawQuality => flags(out, raw.quality)?,
                Role::Status => write!(out, "{}", raw.status)?,
                Role::Sequence => raw.sequence.map_or(Ok(()), |number| write!(out, "{number}"))?,
                // the shortest text that is read as the same number
                _ => value(sample, *role).map_or(Ok(()), |value| write!(out, "{value:?}"))?,
            }
        }
        if self.channels.is_some() {
            for value in raw.channels.iter() {
                write!(out, ",{value:?}")?;
            }
        }
        out.write_all(b"\n")?;
        self.samples += 1;
        self.flagged += u64::from(!sample.quality.is_empty());
        Ok(())
    }

    /// Writes what is at the end, perhaps what came over the link, and hands back where it was written to, flushed. Without it
    /// a recording is as readable, but does not tell that it is whole.
    ///
    /// # Errors
    /// If that cannot be written.
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

/// The columns in order, the raw values aside.
fn roles(contents: &Contents) -> Vec<Role> {
    let mut roles = vec![Role::Time, Role::X0, Role::Y0, Role::Phi0, Role::F0x, Role::F0y, Role::M0z];
    if contents.sigma {
        roles.extend(SIGMA);
    }
    if contents.systematic {
        roles.extend(SYSTEMATIC);
    }
    if contents.out_of_plane {
        roles.extend(ACROSS);
    }
    roles.push(Role::Quality);
    if contents.raw.is_some() {
        roles.extend(RAW);
    }
    roles
}

/// A number in SI units, where it is known.
fn value(sample: &ReactionSample, role: Role) -> Option<f64> {
    let ReactionSample { t, pose: Pose { x, y, phi }, reactions, sigma, systematic, .. } = *sample;
    let Reactions { f0x, f0y, m0z } = reactions;
    let OutOfPlane { f0z, m0x, m0y } = sample.out_of_plane;
    let RawSample { host_time, device_time, temperature, .. } = sample.raw;
    match role {
        Role::Time => Some(t),
        Role::X0 => Some(x),
        Role::Y0 => Some(y),
        Role::Phi0 => Some(phi),
        Role::F0x => Some(f0x),
        Role::F0y => Some(f0y),
        Role::M0z => Some(m0z),
        Role::SigmaF0x => sigma.map(|sigma| sigma.f0x),
        Role::SigmaF0y => sigma.map(|sigma| sigma.f0y),
        Role::SigmaM0z => sigma.map(|sigma| sigma.m0z),
        Role::SystematicF0x => systematic.map(|bound| bound.f0x),
        Role::SystematicF0y => systematic.map(|bound| bound.f0y),
        Role::SystematicM0z => systematic.map(|bound| bound.m0z),
        Role::F0z => Some(f0z),
        Role::M0x => Some(m0x),
        Role::M0y => Some(m0y),
        Role::HostTime => Some(host_time),
        Role::DeviceTime => device_time,
        Role::Temperature => temperature,
        _ => None,
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
