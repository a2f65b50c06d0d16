//! Errors of TDMS files.

use super::data_type::DataType;

/// Why there is no file, channel or value.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TdmsError {
    /// The file cannot be read.
    #[error("cannot read {path}: {source}")]
    Io {
        /// Which one.
        path: std::path::PathBuf,
        /// The message of the operating system.
        source: std::io::Error,
    },
    /// Not a TDMS file.
    #[error(
        "the file begins with {found:02x?}, expected the bytes of `TDSm`; is it a TDMS file? (`TDSh` begins a .tdms_index, \
         which has no data: open the .tdms beside it)"
    )]
    NotTdms {
        /// Its first bytes, at most 4.
        found: Vec<u8>,
    },
    /// No such group or channel.
    #[error("no channel `{channel}` in group `{group}`; there are {}{}", List(.present), Because(.fault))]
    NoChannel {
        /// The requested group.
        group: String,
        /// The requested channel.
        channel: String,
        /// Group and name of the channels there are.
        present: Vec<(String, String)>,
        /// The reason, if the file could not be read to its end.
        fault: Option<Box<TdmsFault>>,
    },
    /// Texts or complex numbers where real ones are wanted, or the other way round.
    #[error("channel `{channel}` is of {found}, expected {expected}; choose another channel")]
    Type {
        /// Its name.
        channel: String,
        /// Its kind.
        found: DataType,
        /// The requested data type.
        expected: &'static str,
    },
    /// A scaling that is not known here, or incomplete.
    #[error("channel `{channel}`: scale {scale} is {what}, expected one of {known}; its raw values can be read")]
    Scaling {
        /// Name of the channel.
        channel: String,
        /// Number of the scale, from 0.
        scale: usize,
        /// Its description.
        what: String,
        /// The known ones.
        known: &'static str,
    },
    /// No time axis.
    #[error(
        "channel `{channel}` has {found} as wf_increment, expected seconds from value to value above 0; name a channel with \
         the time, or the rate of the samples"
    )]
    NoTime {
        /// Its name.
        channel: String,
        /// The property `wf_increment`, or `nothing`.
        found: String,
    },
    /// Two channels of different time axes, side by side.
    #[error(
        "channel `{channel}` starts at {offset} s with steps of {increment} s, but `{first}` at {first_offset} s with \
         {first_increment} s; samples side by side need one time axis"
    )]
    TwoClocks {
        /// The first one.
        first: String,
        /// Its offset, s.
        first_offset: f64,
        /// Its step, s.
        first_increment: f64,
        /// The other one.
        channel: String,
        /// Its offset, s.
        offset: f64,
        /// Its step, s.
        increment: f64,
    },
    /// Too many channels side by side, or no channel.
    #[error("{found} channels side by side, expected 1 to {most}")]
    Count {
        /// The requested number.
        found: usize,
        /// How many there can be.
        most: usize,
    },
    /// A rate that is not a positive number.
    #[error("a rate of {0} samples/s, expected a finite number above 0")]
    Rate(f64),
    /// A time that is no number.
    #[error("value {row} of the time channel `{channel}` is {value}, expected a finite number of s")]
    Time {
        /// Name of the time channel.
        channel: String,
        /// Which value, from 0.
        row: usize,
        /// Its description.
        value: f64,
    },
    /// One of the channels ends before another.
    #[error("channel `{channel}` ends after {found} values, another has {most}; the other channels are cut there")]
    Uneven {
        /// The shortest one.
        channel: String,
        /// How many values it has.
        found: usize,
        /// How many the longest one has.
        most: usize,
    },
    /// The file could not be read to its end; what came before is complete.
    #[error(transparent)]
    Fault(#[from] TdmsFault),
}

/// Why a file could not be read to its end. Everything before is complete.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum TdmsFault {
    /// The file ends before its last segment does.
    #[error(
        "the file ends at byte {end}, but the segment at byte {segment} should reach to byte {expected}; {missing} bytes are \
         missing, what is complete was read"
    )]
    Truncated {
        /// Byte at which the segment begins.
        segment: usize,
        /// Length of the file.
        end: usize,
        /// Byte at which the segment should end.
        expected: u64,
        /// How many bytes there should be beyond the end.
        missing: u64,
    },
    /// The program that wrote the file did not come to finish its last segment.
    #[error(
        "the segment at byte {segment} was never finished: the program that wrote it was interrupted; the complete data up to the \
         end of the file, byte {end}, was read"
    )]
    Unfinished {
        /// Byte at which the segment begins.
        segment: usize,
        /// Length of the file.
        end: usize,
    },
    /// A lead-in without its tag.
    #[error(
        "the segment at byte {at} begins with {found:02x?}, expected the bytes of `TDSm`; nothing was read from there on"
    )]
    Tag {
        /// Byte at which it begins.
        at: usize,
        /// The bytes found there.
        found: [u8; 4],
    },
    /// The description of a segment breaks off.
    #[error("the description of the segment at byte {segment} breaks off at byte {at}; nothing was read from there on")]
    Metadata {
        /// Byte at which the segment begins.
        segment: usize,
        /// Where something should be that is not.
        at: usize,
    },
    /// Something in the description of a segment that is not understood.
    #[error(
        "byte {at}: {what} is {found:#x}, expected {expected}; nothing was read from the segment at byte {segment} on"
    )]
    Unknown {
        /// Byte at which the segment begins.
        segment: usize,
        /// Its byte.
        at: usize,
        /// Its name.
        what: &'static str,
        /// Its value.
        found: u64,
        /// The understood values.
        expected: &'static str,
    },
    /// An invalid path of an object.
    #[error(
        "byte {at}: the object path `{path}` is not of the form /'group'/'channel'; nothing was read from there on"
    )]
    Path {
        /// Its byte.
        at: usize,
        /// The path.
        path: String,
    },
    /// The description of a segment and its data do not go together.
    #[error("the segment at byte {segment}: {what}; nothing was read from there on")]
    Layout {
        /// Byte at which the segment begins.
        segment: usize,
        /// The contradiction.
        what: &'static str,
    },
}

/// The addition to an error message if the file is incomplete.
struct Because<'a>(&'a Option<Box<TdmsFault>>);

impl core::fmt::Display for Because<'_> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        self.0.as_ref().map_or(Ok(()), |fault| write!(f, " ({fault})"))
    }
}

/// Channels, for messages.
struct List<'a>(&'a [(String, String)]);

impl core::fmt::Display for List<'_> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        const SHOWN: usize = 20;
        if self.0.is_empty() {
            return f.write_str("none");
        }
        for (i, (group, channel)) in self.0.iter().take(SHOWN).enumerate() {
            write!(f, "{}`{channel}` in `{group}`", if i == 0 { "" } else { ", " })?;
        }
        match self.0.len().checked_sub(SHOWN) {
            None | Some(0) => Ok(()),
            Some(more) => write!(f, " and {more} more"),
        }
    }
}
