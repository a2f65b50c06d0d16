//! Errors of MCAP files and their messages.

use std::sync::Arc;

/// Why there is no file, topic or message.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum McapError {
    /// The file cannot be read.
    #[error("cannot read {path}: {source}")]
    Io {
        /// Which one.
        path: std::path::PathBuf,
        /// The message of the operating system.
        source: std::io::Error,
    },
    /// Not an MCAP file.
    #[error("the file begins with {found:02x?}, expected [89, 4d, 43, 41, 50, 30, 0d, 0a]; is it an MCAP file?")]
    NotMcap {
        /// Its first bytes, at most 8.
        found: Vec<u8>,
    },
    /// No such topic.
    #[error("no topic `{topic}`; there are {}{}", List(.present), Because(.fault))]
    NoTopic {
        /// The requested topic.
        topic: String,
        /// Those there are.
        present: Vec<McapTopic>,
        /// The reason, if the file could not be read to its end.
        fault: Option<Box<McapFault>>,
    },
    /// A topic of another type.
    #[error("topic `{topic}` is of {found} in the encoding `{encoding}`, expected {expected} in `cdr` or `ros1`")]
    Type {
        /// Its name.
        topic: String,
        /// Its type.
        found: String,
        /// The encoding of its messages.
        encoding: String,
        /// The type that is wanted.
        expected: &'static str,
    },
    /// A message that is not what its type says.
    #[error("topic `{topic}`, logged at {log_time} ns: {what}")]
    Message {
        /// Name of the topic.
        topic: String,
        /// When it was logged, ns since 1970.
        log_time: u64,
        /// The fault.
        what: McapFault,
    },
    /// The file could not be read to its end; what came before is complete.
    #[error(transparent)]
    Fault(#[from] McapFault),
}

/// Why a file could not be read to its end (everything before is complete), or what is wrong with a message.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum McapFault {
    /// It breaks off.
    #[error("the file ends at byte {end}, within the record at byte {at}; the complete records were read")]
    Truncated {
        /// Byte at which the record begins.
        at: usize,
        /// Length of the file.
        end: usize,
    },
    /// It ends without the record that ends a file.
    #[error(
        "the file ends at byte {end} without a footer: the program that wrote it was interrupted; the data up to there were read"
    )]
    Unfinished {
        /// Length of the file.
        end: usize,
    },
    /// A chunk that cannot be decompressed here.
    #[error(
        "the chunk at byte {at} is compressed with `{format}`, expected one of: {known}; nothing was read from there on"
    )]
    Compression {
        /// Byte at which the chunk begins.
        at: usize,
        /// How it is compressed.
        format: String,
        /// The known compressions.
        known: &'static str,
    },
    /// A record that is not understood.
    #[error("the record at byte {at}: {what}; nothing was read from there on")]
    Record {
        /// Byte at which it begins; that of the chunk for a record in a chunk.
        at: usize,
        /// The fault.
        what: String,
    },
    /// Its first two bytes.
    #[error("the message begins with {0:#06x}, expected 0x0000 (CDR, big endian) or 0x0001 (CDR, little endian)")]
    Encapsulation(u16),
    /// It ends too early.
    #[error("the message ends at byte {end}, within a value from byte {at} on")]
    End {
        /// How many bytes it has.
        end: usize,
        /// Byte at which the value begins.
        at: usize,
    },
    /// It is too long.
    #[error("the message has {found} bytes, expected {expected}; is its type another version?")]
    Length {
        /// How many bytes it has.
        found: usize,
        /// How many it should have.
        expected: usize,
    },
    /// A value that is no number.
    #[error("a value of {0}, expected finite numbers")]
    NotFinite(f64),
}

/// A topic of a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct McapTopic {
    /// Its name.
    pub name: String,
    /// The type of its messages; empty where it is not told.
    pub type_name: Arc<str>,
    /// Their encoding.
    pub encoding: String,
    /// How many there are.
    pub messages: usize,
}

/// The addition to an error message if the file is incomplete.
struct Because<'a>(&'a Option<Box<McapFault>>);

impl core::fmt::Display for Because<'_> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        self.0.as_ref().map_or(Ok(()), |fault| write!(f, " ({fault})"))
    }
}

/// Most topics that are named in a message.
const MOST_NAMES: usize = 20;

/// Topics, for messages.
struct List<'a>(&'a [McapTopic]);

impl core::fmt::Display for List<'_> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        if self.0.is_empty() {
            return f.write_str("none");
        }
        for (i, topic) in self.0.iter().take(MOST_NAMES).enumerate() {
            write!(f, "{}`{}` of {}", if i == 0 { "" } else { ", " }, topic.name, topic.type_name)?;
        }
        match self.0.len().saturating_sub(MOST_NAMES) {
            0 => Ok(()),
            more => write!(f, " and {more} more"),
        }
    }
}
