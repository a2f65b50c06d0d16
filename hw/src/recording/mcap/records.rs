//! From record to record through a file. The only place that knows the crate `mcap`.

use super::bytes::{Cursor, End, Order};
use super::error::McapFault;
use core::iter::from_fn;
use crc::{CRC_32_ISO_HDLC, Crc};
use mcap::records::{MessageHeader, op};
use mcap::sans_io::linear_reader::{LinearReadEvent, LinearReader, LinearReaderOptions};
use std::borrow::Cow;

/// The records of a file that matter here.
pub(super) enum Event<'a> {
    Schema { id: u16, name: String },
    Channel { id: u16, schema: u16, topic: String, encoding: String },
    Message { header: MessageHeader, data: Cow<'a, [u8]> },
}

impl Event<'_> {
    fn into_owned(self) -> Event<'static> {
        match self {
            Self::Schema { id, name } => Event::Schema { id, name },
            Self::Channel { id, schema, topic, encoding } => Event::Channel { id, schema, topic, encoding },
            Self::Message { header, data } => Event::Message { header, data: data.into_owned().into() },
        }
    }
}

pub(super) const MAGIC: &[u8] = mcap::MAGIC;

const KNOWN: &str = if cfg!(feature = "mcap-compression") {
    "none, `lz4`, `zstd`"
} else {
    "none (`lz4` and `zstd` with the feature `mcap-compression`)"
};

/// Place of the records in a chunk.
const CRC: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);

/// Events in order; a fault is the last one.
type Events<'a> = Box<dyn Iterator<Item = Result<Event<'a>, McapFault>> + 'a>;

/// Opcode and length in front of a record.
const HEAD: usize = 9;

/// Events in the order of the file, after its magic bytes; a fault is the last one.
#[derive(Clone)]
pub(super) struct Records<'a> {
    bytes: &'a [u8],
    at: usize,
    is_done: bool,
}

impl<'a> Records<'a> {
    pub fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, at: MAGIC.len(), is_done: false }
    }

    /// All events, those in chunks, too.
    pub fn events(mut self) -> impl Iterator<Item = Result<Event<'a>, McapFault>> + use<'a> {
        let mut chunk: Option<Events<'a>> = None;
        from_fn(move || {
            loop {
                if let Some(events) = &mut chunk {
                    match events.next() {
                        Some(Ok(event)) => return Some(Ok(event)),
                        Some(Err(fault)) => {
                            chunk = None;
                            self.is_done = true;
                            return Some(Err(fault));
                        }
                        None => chunk = None,
                    }
                }
                if self.is_done {
                    return None;
                }
                match self.record() {
                    Ok(Step::Event(event)) => return Some(Ok(event)),
                    Ok(Step::Chunk(events)) => chunk = Some(events),
                    Ok(Step::Other) => {}
                    Ok(Step::End) => self.is_done = true,
                    Err(fault) => {
                        self.is_done = true;
                        return Some(Err(fault));
                    }
                }
            }
        })
    }

    fn record(&mut self) -> Result<Step<'a>, McapFault> {
        let (at, end) = (self.at, self.bytes.len());
        if at >= end {
            return Err(McapFault::Unfinished { end });
        }
        let truncated = McapFault::Truncated { at, end };
        let rest = self.bytes.get(at..).unwrap_or_default();
        let Some((code, length)) = head(rest) else { return Err(truncated) };
        let body = rest.get(HEAD..).unwrap_or_default();
        let whole = usize::try_from(length).ok().and_then(|length| body.get(..length));
        if code == op::CHUNK {
            self.at = at.saturating_add(HEAD).saturating_add(usize::try_from(length).unwrap_or(end));
            let record = rest.get(..HEAD + whole.unwrap_or(body).len()).unwrap_or(rest);
            return chunk(at, record, whole.is_none().then_some(truncated)).map(Step::Chunk);
        }
        let body = whole.ok_or(truncated)?;
        self.at = at + HEAD + body.len();
        match code {
            // what follows is a summary of what came before
            op::DATA_END | op::FOOTER => Ok(Step::End),
            _ => event(at, code, body),
        }
    }
}

enum Step<'a> {
    Event(Event<'a>),
    Chunk(Events<'a>),
    Other,
    End,
}

fn head(bytes: &[u8]) -> Option<(u8, u64)> {
    let (&code, rest) = bytes.split_first()?;
    Some((code, u64::from_le_bytes(*rest.first_chunk()?)))
}

fn event(at: usize, code: u8, body: &[u8]) -> Result<Step<'_>, McapFault> {
    let end = |End(place)| {
        let what = format!("its length {} ends it within a value at byte {place}", body.len());
        McapFault::Record { at, what }
    };
    Ok(decode(code, body).map_err(end)?.map_or(Step::Other, Step::Event))
}

/// The event of a record, checked to its end: the crate trusts the lengths that are written in a record, and allocates them.
fn decode(code: u8, body: &[u8]) -> Result<Option<Event<'_>>, End> {
    let mut cursor = Cursor::new(body, 0, Order::Little);
    Ok(Some(match code {
        op::SCHEMA => {
            let id = cursor.u16()?;
            let name = cursor.text()?;
            let _encoding = cursor.text()?;
            let length = cursor.u32()? as usize;
            cursor.take(length)?;
            Event::Schema { id, name }
        }
        op::CHANNEL => {
            let (id, schema) = (cursor.u16()?, cursor.u16()?);
            let (topic, encoding) = (cursor.text()?, cursor.text()?);
            let length = cursor.u32()? as usize;
            let mut metadata = Cursor::new(cursor.take(length)?, 0, Order::Little);
            while metadata.left() > 0 {
                metadata.text()?;
            }
            Event::Channel { id, schema, topic, encoding }
        }
        op::MESSAGE => {
            let (channel_id, sequence) = (cursor.u16()?, cursor.u32()?);
            let (log_time, publish_time) = (cursor.u64()?, cursor.u64()?);
            let header = MessageHeader { channel_id, sequence, log_time, publish_time };
            Event::Message { header, data: cursor.take(cursor.left())?.into() }
        }
        _ => return Ok(None),
    }))
}

fn bad(at: usize, error: &mcap::McapError) -> McapFault {
    McapFault::Record { at, what: error.to_string() }
}

/// The events of a chunk, of which the end may be missing; then the fault of that.
fn chunk<'a>(at: usize, record: &'a [u8], cut: Option<McapFault>) -> Result<Events<'a>, McapFault> {
    let Some((header, data)) = record.get(HEAD..).and_then(Chunk::of) else {
        let what = "the chunk is shorter than its header".to_owned();
        return Err(cut.unwrap_or(McapFault::Record { at, what }));
    };
    let size = usize::try_from(header.size).unwrap_or(usize::MAX);
    if cut.is_none() && size > data.len() {
        let what = format!("the chunk has {} bytes of records, expected {size}", data.len());
        return Err(McapFault::Record { at, what });
    }
    // the crate takes for granted that records end where their chunk does
    if header.compression.is_empty() {
        return Ok(plain(at, data.get(..size).unwrap_or(data), header.crc, cut));
    }
    Ok(compressed(at, record, header.compression, cut))
}

/// The header of a chunk.
struct Chunk {
    compression: String,
    /// Of the records where they are not compressed; 0 where it is not known.
    crc: u32,
    /// Bytes of the records, compressed.
    size: u64,
}

impl Chunk {
    /// Header and records of a chunk, also where these are not all there.
    fn of(body: &[u8]) -> Option<(Self, &[u8])> {
        // two times and the size without compression come first
        let mut cursor = Cursor::new(body, 24, Order::Little);
        let crc = cursor.u32().ok()?;
        let compression = cursor.text().ok()?;
        let size = cursor.u64().ok()?;
        Some((Self { compression, crc, size }, cursor.take(cursor.left()).ok()?))
    }
}

/// The events of records that are not compressed, up to one that is not all there; then the fault that the end is missing, or
/// that the checksum differs.
fn plain<'a>(at: usize, data: &'a [u8], crc: u32, mut cut: Option<McapFault>) -> Events<'a> {
    let (mut rest, mut is_done) = (data, false);
    Box::new(from_fn(move || {
        while !is_done {
            let record = head(rest).and_then(|(code, length)| {
                Some((code, rest.get(HEAD..)?.split_at_checked(usize::try_from(length).ok()?)?))
            });
            let Some((code, (body, later))) = record else { break };
            rest = later;
            match event(at, code, body) {
                Ok(Step::Event(event)) => return Some(Ok(event)),
                Ok(_) => {}
                Err(fault) => {
                    is_done = true;
                    return Some(Err(fault));
                }
            }
        }
        if std::mem::replace(&mut is_done, true) {
            return None;
        }
        cut.take().or_else(|| end_of_records(at, rest, data, crc)).map(Err)
    }))
}

/// The fault at the end of the records of a chunk.
fn end_of_records(at: usize, rest: &[u8], data: &[u8], saved: u32) -> Option<McapFault> {
    let calculated = CRC.checksum(data);
    if !rest.is_empty() {
        let what = "a record in the chunk is not what it should be".to_owned();
        Some(McapFault::Record { at, what })
    } else if saved != 0 && saved != calculated {
        Some(bad(at, &mcap::McapError::BadChunkCrc { saved, calculated }))
    } else {
        None
    }
}

/// Most bytes of a record in a compressed chunk, which says itself how long it is.
const MOST: usize = 1 << 26;

/// The events of a chunk that is compressed, by the crate.
fn compressed<'a>(at: usize, record: &'a [u8], format: String, mut cut: Option<McapFault>) -> Events<'a> {
    let options = LinearReaderOptions::default()
        .with_skip_start_magic(true)
        .with_skip_end_magic(true)
        .with_validate_chunk_crcs(true)
        .with_record_length_limit(MOST);
    let mut reader = LinearReader::new_with_options(options);
    let (mut rest, mut is_done) = (record, false);
    Box::new(from_fn(move || {
        while !is_done {
            let fault = match reader.next_event() {
                Some(Ok(LinearReadEvent::ReadRequest(need))) => {
                    let (now, later) = rest.split_at(need.min(rest.len()));
                    reader.insert(now.len()).copy_from_slice(now);
                    reader.notify_read(now.len());
                    rest = later;
                    continue;
                }
                Some(Ok(LinearReadEvent::Record { data, opcode })) => match event(at, opcode, data) {
                    Ok(Step::Event(event)) => return Some(Ok(event.into_owned())),
                    Ok(_) => continue,
                    Err(fault) => Some(fault),
                },
                Some(Err(mcap::McapError::UnsupportedCompression(_))) => {
                    Some(McapFault::Compression { at, format: format.clone(), known: KNOWN })
                }
                Some(Err(error)) => cut.take().or_else(|| Some(bad(at, &error))),
                None => cut.take(),
            };
            is_done = true;
            return fault.map(Err);
        }
        None
    }))
}
