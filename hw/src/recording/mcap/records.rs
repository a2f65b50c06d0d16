//! From record to record through a file. The only place that knows the crate `mcap`.

use super::bytes::{Cursor, End, Order};
use super::error::McapFault;
use core::iter::from_fn;
use mcap::records::{ChunkHeader, MessageHeader, op};
use mcap::sans_io::linear_reader::{LinearReadEvent, LinearReader, LinearReaderOptions};
use std::borrow::Cow;

/// What is of interest in a file.
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
        let mut chunk: Option<Box<dyn Iterator<Item = Result<Event<'a>, McapFault>> + 'a>> = None;
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
            return chunk(at, record, whole.is_none().then_some(truncated));
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
    Chunk(Box<dyn Iterator<Item = Result<Event<'a>, McapFault>> + 'a>),
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
fn chunk<'a>(at: usize, record: &'a [u8], cut: Option<McapFault>) -> Result<Step<'a>, McapFault> {
    let Some((header, data)) = record.get(HEAD..).and_then(chunk_header) else {
        let what = "the chunk is shorter than its header".to_owned();
        return Err(cut.unwrap_or(McapFault::Record { at, what }));
    };
    let size = usize::try_from(header.compressed_size).unwrap_or(usize::MAX);
    if cut.is_none() && size > data.len() {
        let what = format!("the chunk has {} bytes of records, expected {size}", data.len());
        return Err(McapFault::Record { at, what });
    }
    let data = data.get(..size).unwrap_or(data);
    let is_plain = header.compression.is_empty();
    // The crate takes for granted that records end where their chunk does. Where all is well, it checks the checksum.
    if is_plain && (cut.is_some() || !is_sound(data)) {
        let what = "a record in the chunk is not what it should be".to_owned();
        return Ok(Step::Chunk(plain(at, data, cut.unwrap_or(McapFault::Record { at, what }))));
    }
    let format = header.compression;
    let options = LinearReaderOptions::default()
        .with_skip_start_magic(true)
        .with_skip_end_magic(true)
        .with_validate_chunk_crcs(true)
        .with_record_length_limit(MOST);
    let mut reader = LinearReader::new_with_options(options);
    let (mut rest, mut cut, mut is_done) = (record, cut, false);
    Ok(Step::Chunk(Box::new(from_fn(move || {
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
    }))))
}

/// Most bytes of a record in a compressed chunk, which says itself how long it is.
const MOST: usize = 1 << 26;

/// Header and records of a chunk, also where these are not all there.
fn chunk_header(body: &[u8]) -> Option<(ChunkHeader, &[u8])> {
    let number =
        |at: usize| body.get(at..).and_then(|rest| rest.first_chunk::<8>()).map(|bytes| u64::from_le_bytes(*bytes));
    let short =
        |at: usize| body.get(at..).and_then(|rest| rest.first_chunk::<4>()).map(|bytes| u32::from_le_bytes(*bytes));
    let data = 32_usize.checked_add(usize::try_from(short(28)?).ok()?)?;
    let compression = String::from_utf8_lossy(body.get(32..data)?).into_owned();
    let header = ChunkHeader {
        message_start_time: number(0)?,
        message_end_time: number(8)?,
        uncompressed_size: number(16)?,
        uncompressed_crc: short(24)?,
        compression,
        compressed_size: number(data)?,
    };
    Some((header, body.get(data + 8..)?))
}

/// Whether a chunk has records that can be read, and nothing else.
fn is_sound(mut data: &[u8]) -> bool {
    while !data.is_empty() {
        let record = head(data).and_then(|(code, length)| {
            let (body, rest) = data.get(HEAD..)?.split_at_checked(usize::try_from(length).ok()?)?;
            decode(code, body).ok()??;
            Some(rest)
        });
        let Some(rest) = record else { return false };
        data = rest;
    }
    true
}

/// The events of records that are not compressed, up to one that is not all there.
fn plain<'a>(
    at: usize,
    mut data: &'a [u8],
    fault: McapFault,
) -> Box<dyn Iterator<Item = Result<Event<'a>, McapFault>> + 'a> {
    let mut fault = Some(fault);
    Box::new(from_fn(move || {
        loop {
            fault.as_ref()?;
            let record = head(data).and_then(|(code, length)| {
                let length = usize::try_from(length).ok()?;
                Some((code, data.get(HEAD..)?.split_at_checked(length)?))
            });
            let Some((code, (body, rest))) = record else { return fault.take().map(Err) };
            data = rest;
            match event(at, code, body) {
                Ok(Step::Event(event)) => return Some(Ok(event)),
                Ok(_) => {}
                Err(found) => {
                    fault = None;
                    return Some(Err(found));
                }
            }
        }
    }))
}
