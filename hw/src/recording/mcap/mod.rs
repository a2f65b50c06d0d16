//! Recordings of ROS: MCAP files.
//!
//! Wrenches (`geometry_msgs/WrenchStamped`) of ROS 2 (CDR, both byte orders) and ROS 1. A file that breaks off gives what is
//! complete, and a [`McapFault`] that says where. Chunks that are compressed need the feature `mcap-compression`. Bags of ROS 1 and
//! databases of ROS 2 become MCAP files by `mcap convert`.
//!
//! A file is a slice of bytes, whole: read into memory or mapped by the caller. Chunks are
//! decompressed one by one; where nothing is compressed, memory stays in proportion to the file; a record
//! that is may have 64 MiB.

mod bytes;
mod error;
mod message;
mod records;

pub use error::{McapError, McapFault, McapTopic};

use crate::sample::{Channels, RawSample, WrenchSample};
use message::NAME;
use records::{Event, MAGIC, Records};
use std::borrow::Cow;
use std::collections::HashMap;
use std::path::Path;
use std::sync::Arc;

/// An MCAP file.
///
/// ```
/// use rod_hw::recording::mcap::McapFile;
/// let file = McapFile::read("tests/vectors/wrench.mcap")?;
/// let sample = file.wrenches("/ft_sensor/wrench")?.next().ok_or("no sample")??;
/// assert_eq!(sample.wrench.force, [0.1, -0.2, 0.3]); // N
/// let error = file.wrenches("/ft").err().ok_or("expected none")?.to_string();
/// assert!(error.starts_with("no topic `/ft`; there are `/ft_sensor/wrench` of geometry_msgs/msg/WrenchStamped"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct McapFile<'a> {
    bytes: Cow<'a, [u8]>,
    /// By the number of the channel; several can be of one topic.
    channels: HashMap<u16, usize>,
    topics: Vec<McapTopic>,
    origin: u64,
    fault: Option<McapFault>,
}

impl McapFile<'static> {
    /// The file at a path, read into memory whole.
    ///
    /// # Errors
    /// [`McapError::Io`], [`McapError::NotMcap`]. A file that breaks off is none: see [`fault`](Self::fault).
    pub fn read(path: impl AsRef<Path>) -> Result<Self, McapError> {
        let path = path.as_ref();
        let io = |source| McapError::Io { path: path.to_owned(), source };
        Self::new(std::fs::read(path).map_err(io)?.into())
    }
}

impl<'a> McapFile<'a> {
    /// The file of these bytes, which are gone through once for the topics.
    ///
    /// # Errors
    /// [`McapError::NotMcap`].
    pub fn parse(bytes: &'a [u8]) -> Result<Self, McapError> {
        Self::new(bytes.into())
    }

    fn new(bytes: Cow<'a, [u8]>) -> Result<Self, McapError> {
        if !bytes.starts_with(MAGIC) {
            return Err(McapError::NotMcap { found: bytes.iter().copied().take(MAGIC.len()).collect() });
        }
        let mut schemas: HashMap<u16, Arc<str>> = HashMap::new();
        let mut channels: HashMap<u16, usize> = HashMap::new();
        let mut places: HashMap<(String, Arc<str>, String), usize> = HashMap::new();
        let mut topics: Vec<McapTopic> = Vec::new();
        let mut origin = None;
        let mut fault = None;
        for event in Records::new(&bytes).events() {
            match event {
                Ok(Event::Schema { id, name }) => {
                    schemas.insert(id, name.into());
                }
                Ok(Event::Channel { id, schema, topic, encoding }) => {
                    // far more channels than there is room for their types' names may share one
                    let type_name = schemas.get(&schema).map_or_else(|| "".into(), Arc::clone);
                    let place =
                        places.entry((topic.clone(), type_name.clone(), encoding.clone())).or_insert_with(|| {
                            topics.push(McapTopic { name: topic, type_name, encoding, messages: 0 });
                            topics.len() - 1
                        });
                    channels.insert(id, *place);
                }
                Ok(Event::Message { header, .. }) => {
                    origin.get_or_insert(header.log_time);
                    if let Some(topic) = channels.get(&header.channel_id).and_then(|&place| topics.get_mut(place)) {
                        topic.messages += 1;
                    }
                }
                Err(found) => fault = Some(found),
            }
        }
        Ok(Self { bytes, channels, topics, origin: origin.unwrap_or(0), fault })
    }

    /// Why the file could not be read to its end, if it could not.
    pub fn fault(&self) -> Option<&McapFault> {
        self.fault.as_ref()
    }

    /// The time 0 of the wrenches, s since 1970: when the first message was logged. At today's dates to 0.2 us.
    #[expect(clippy::cast_precision_loss, reason = "the accuracy is stated")]
    pub fn origin(&self) -> f64 {
        self.origin as f64 / 1e9
    }

    /// The topics, in their order.
    pub fn topics(&self) -> &[McapTopic] {
        &self.topics
    }

    /// The wrenches of a topic, in the order they were logged, N and N m as ROS has them.
    /// Their time is that of the header where it has one, that of the log otherwise; the host's time is that of the log. It goes
    /// on after a message that is wrong; why the file breaks off, if it does, comes last.
    ///
    /// # Errors
    /// [`McapError::NoTopic`] with those there are, [`McapError::Type`] where it has messages of another type.
    pub fn wrenches(
        &self,
        topic: &str,
    ) -> Result<impl Iterator<Item = Result<WrenchSample, McapError>> + use<'_>, McapError> {
        let named = || self.topics.iter().enumerate().filter(|(_, found)| found.name == topic);
        if named().next().is_none() {
            return Err(McapError::NoTopic {
                topic: topic.to_owned(),
                present: self.topics.clone(),
                fault: self.fault.clone().map(Box::new),
            });
        }
        // one topic can have channels of several types or encodings
        let is_right = |found: &McapTopic| match found.encoding.as_str() {
            "cdr" | "ros1" => *found.type_name == *NAME || *found.type_name == NAME.replace("/msg/", "/"),
            _ => false,
        };
        if let Some((_, found)) = named().find(|(_, found)| !is_right(found)) {
            return Err(McapError::Type {
                topic: topic.to_owned(),
                found: found.type_name.to_string(),
                encoding: found.encoding.clone(),
                expected: NAME,
            });
        }
        let topic = topic.to_owned();
        Ok(Records::new(&self.bytes).events().filter_map(move |event| {
            let (header, data) = match event {
                Ok(Event::Message { header, data }) => (header, data),
                Ok(_) => return None,
                Err(fault) => return Some(Err(fault.into())),
            };
            let found = self.topics.get(*self.channels.get(&header.channel_id)?).filter(|found| found.name == topic)?;
            Some(match message::decode(&data, found.encoding == "ros1") {
                Ok((stamp, wrench)) => {
                    let device_time = stamp.map(|stamp| self.seconds(stamp));
                    let (log_time, channels) =
                        (self.seconds(header.log_time.into()), Channels::from(wrench.components()));
                    Ok(WrenchSample::of(&RawSample { device_time, ..RawSample::new(log_time, channels) }, wrench))
                }
                Err(what) => Err(McapError::Message { topic: topic.clone(), log_time: header.log_time, what }),
            })
        }))
    }

    /// From ns since 1970 to s from the origin: exact before it is rounded once.
    #[expect(clippy::cast_precision_loss, reason = "to a float's accuracy")]
    fn seconds(&self, time: i128) -> f64 {
        (time - i128::from(self.origin)) as f64 / 1e9
    }
}
