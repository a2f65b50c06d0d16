#![doc = include_str!("../README.md")]
//!
//! Read are all segments of a file, in both byte orders, contiguous and interleaved, integers, floats, booleans, texts,
//! timestamps, and what cards deliver (DAQmx: format changing and digital line scalers). A file that breaks off gives what
//! is complete, and a [`TdmsFault`] that says what is missing. Not read: extended floats, fixed point numbers, and scales
//! other than linear, polynomial, sum and difference.
//!
//! A file is a slice of bytes, whole: read into memory or mapped by the caller. Beside it there is the index of segments,
//! not the values, which are decoded as they are asked for.
#![cfg_attr(test, allow(clippy::unwrap_used, clippy::expect_used, clippy::panic))]

mod bytes;
mod channel;
mod contents;
mod data_type;
mod error;
mod layout;
mod property;
mod raw_data;
mod rows;
mod run;
mod scaling;
mod segments;
mod timestamp;

pub use channel::{TdmsChannel, TdmsValues, TimeAxis};
pub use data_type::DataType;
pub use error::{TdmsError, TdmsFault};
pub use property::{TdmsProperties, TdmsValue};
pub use rows::{TdmsRow, TdmsRows, TdmsTime};
pub use timestamp::TdmsTimestamp;

use contents::{Contents, GroupContents};
use std::borrow::Cow;
use std::path::Path;

/// A TDMS file.
#[derive(Clone, Debug)]
pub struct TdmsFile<'a> {
    bytes: Cow<'a, [u8]>,
    contents: Contents,
    fault: Option<TdmsFault>,
}

impl TdmsFile<'static> {
    /// The file at a path, read into memory whole.
    ///
    /// # Errors
    /// [`TdmsError::Io`], [`TdmsError::NotTdms`]. A file that breaks off is none: see [`fault`](Self::fault).
    pub fn read(path: impl AsRef<Path>) -> Result<Self, TdmsError> {
        let path = path.as_ref();
        let io = |source| TdmsError::Io { path: path.to_owned(), source };
        Self::new(std::fs::read(path).map_err(io)?.into())
    }
}

impl<'a> TdmsFile<'a> {
    /// The file of these bytes.
    ///
    /// ```
    /// use tdms_file::{TdmsError, TdmsFile};
    /// let error = TdmsFile::parse(b"RIFF....").unwrap_err();
    /// assert!(matches!(error, TdmsError::NotTdms { .. }));
    /// ```
    ///
    /// # Errors
    /// [`TdmsError::NotTdms`].
    pub fn parse(bytes: &'a [u8]) -> Result<Self, TdmsError> {
        Self::new(bytes.into())
    }

    fn new(bytes: Cow<'a, [u8]>) -> Result<Self, TdmsError> {
        if !bytes.starts_with(b"TDSm") {
            return Err(TdmsError::NotTdms { found: bytes.iter().copied().take(4).collect() });
        }
        let (contents, fault) = segments::read(&bytes);
        Ok(Self { bytes, contents, fault })
    }

    /// Why the file could not be read to its end, if it could not.
    pub fn fault(&self) -> Option<&TdmsFault> {
        self.fault.as_ref()
    }

    /// The properties of the file.
    pub fn properties(&self) -> &TdmsProperties {
        &self.contents.root
    }

    /// The groups, in their order.
    pub fn groups(&self) -> impl Iterator<Item = TdmsGroup<'_>> {
        self.contents.groups.iter().map(|contents| TdmsGroup { file: self, contents })
    }

    /// The group of a name.
    pub fn group(&self, name: &str) -> Option<TdmsGroup<'_>> {
        let contents = self.contents.groups.get(self.contents.find_group(name)?)?;
        Some(TdmsGroup { file: self, contents })
    }

    /// All channels, in their order.
    pub fn channels(&self) -> impl Iterator<Item = TdmsChannel<'_>> {
        self.contents.channels.iter().map(|contents| TdmsChannel::new(self, contents))
    }

    /// The channel of a name.
    ///
    /// # Errors
    /// [`TdmsError::NoChannel`], with those there are.
    pub fn channel(&self, group: &str, channel: &str) -> Result<TdmsChannel<'_>, TdmsError> {
        let found = self.contents.find(group, channel).and_then(|index| self.contents.channels.get(index));
        found.map(|contents| TdmsChannel::new(self, contents)).ok_or_else(|| TdmsError::NoChannel {
            group: group.to_owned(),
            channel: channel.to_owned(),
            present: self.channels().map(|channel| (channel.group().to_owned(), channel.name().to_owned())).collect(),
            fault: self.fault.clone().map(Box::new),
        })
    }

    /// Channels of a group, at most 16, side by side: rows of their scaled values, with the time from where it is said.
    ///
    /// # Errors
    /// [`TdmsError`] where there is no such channel, it has no numbers, its scale is not known, or there is no time.
    pub fn rows(&self, group: &str, channels: &[&str], time: TdmsTime<'_>) -> Result<TdmsRows<'_>, TdmsError> {
        TdmsRows::new(self, group, channels, time)
    }
}

/// A group of channels.
#[derive(Clone, Copy, Debug)]
pub struct TdmsGroup<'f> {
    file: &'f TdmsFile<'f>,
    contents: &'f GroupContents,
}

impl<'f> TdmsGroup<'f> {
    /// Its name.
    pub fn name(&self) -> &'f str {
        &self.contents.name
    }

    /// Its properties.
    pub fn properties(&self) -> &'f TdmsProperties {
        &self.contents.properties
    }

    /// Its channels, in their order.
    pub fn channels(&self) -> impl Iterator<Item = TdmsChannel<'f>> + use<'f> {
        let file = self.file;
        let all = self.contents.channels.iter();
        all.filter_map(|&index| file.contents.channels.get(index)).map(|contents| TdmsChannel::new(file, contents))
    }
}
