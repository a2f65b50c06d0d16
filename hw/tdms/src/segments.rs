//! From segment to segment through a file: which objects there are and where their values lie.

use super::contents::{Contents, Target};
use super::error::TdmsFault;
use super::layout::{Kind, Layout, Trouble};
use super::property::TdmsValue;
use super::raw_data::{self, Raw};
use crate::bytes::{Cursor, End, Order};
use std::collections::HashMap;
use std::rc::Rc;

const LEAD_IN: usize = 28;

/// Bits of the table of contents.
const METADATA: u32 = 1 << 1;
const NEW_LIST: u32 = 1 << 2;
const RAW_DATA: u32 = 1 << 3;
const INTERLEAVED: u32 = 1 << 5;
const BIG_ENDIAN: u32 = 1 << 6;
const DAQMX: u32 = 1 << 7;

/// An object, as the segments so far describe it.
struct Node {
    target: Target,
    layout: Option<Rc<Layout>>,
    /// Its place in the list of objects, and of which list.
    slot: (usize, usize),
    /// Whether it has values in the segment.
    has_data: bool,
}

/// Reads all segments up to the end of the file or the first that is at fault.
pub(super) fn read(bytes: &[u8]) -> (Contents, Option<TdmsFault>) {
    let mut reader = Reader {
        bytes,
        contents: Contents::default(),
        nodes: Vec::new(),
        paths: HashMap::new(),
        list: Vec::new(),
        list_number: 0,
        work: 0,
    };
    let mut at = 0;
    let mut fault = None;
    while at < bytes.len() && fault.is_none() {
        match reader.segment(at) {
            Ok(next) => at = next,
            Err(found) => fault = Some(found),
        }
    }
    (reader.contents, fault)
}

struct Reader<'a> {
    bytes: &'a [u8],
    contents: Contents,
    nodes: Vec<Node>,
    paths: HashMap<String, usize>,
    /// The objects of the segment, in the order of their values.
    list: Vec<usize>,
    /// How many lists there were before.
    list_number: usize,
    /// Objects looked at so far.
    work: usize,
}

impl Reader<'_> {
    /// The segment at a byte; where the next one begins, always further on.
    fn segment(&mut self, at: usize) -> Result<usize, TdmsFault> {
        let end_of_file = self.bytes.len();
        let truncated = |expected: u64| {
            let missing = expected.saturating_sub(end_of_file as u64);
            TdmsFault::Truncated { segment: at, end: end_of_file, expected, missing }
        };
        let Some(lead) = self.bytes.get(at..).and_then(|rest| rest.first_chunk::<LEAD_IN>()) else {
            return Err(truncated((at + LEAD_IN) as u64));
        };
        if let &[a, b, c, d, ..] = lead
            && [a, b, c, d] != *b"TDSm"
        {
            return Err(TdmsFault::Tag { at, found: [a, b, c, d] });
        }
        let mut cursor = Cursor::new(lead, 4, Order::Little);
        let cut = |_| truncated((at + LEAD_IN) as u64);
        // little endian always, what follows is as it says
        let contents = cursor.u32().map_err(cut)?;
        let order = if contents & BIG_ENDIAN == 0 { Order::Little } else { Order::Big };
        let mut cursor = Cursor::new(lead, 12, order);
        let (length, raw_offset) = (cursor.u64().map_err(cut)?, cursor.u64().map_err(cut)?);

        let body = at + LEAD_IN;
        let expected = (body as u64).saturating_add(length);
        let fault = if length == u64::MAX {
            Some(TdmsFault::Unfinished { segment: at, end: end_of_file })
        } else if expected > end_of_file as u64 {
            Some(truncated(expected))
        } else {
            None
        };
        let end = usize::try_from(expected).map_or(end_of_file, |end| end.min(end_of_file));
        let from =
            usize::try_from(raw_offset).ok().and_then(|offset| body.checked_add(offset)).filter(|&from| from <= end);
        let Some(from) = from else {
            let what = "its raw data begin beyond its end";
            return Err(fault.unwrap_or(TdmsFault::Layout { segment: at, what }));
        };
        let has_raw = contents & (RAW_DATA | DAQMX) != 0;
        if contents & METADATA != 0 {
            let limit = if has_raw { from } else { end };
            let described = self.bytes.get(..limit).unwrap_or(self.bytes);
            self.metadata(at, Cursor::new(described, body, order), contents & NEW_LIST != 0)?;
        }
        if has_raw && from < end {
            let raw = Raw { segment: at, order, from, to: end, is_cut: fault.is_some() };
            self.raw_data(raw, contents & INTERLEAVED != 0)?;
        }
        fault.map_or(Ok(end), Err)
    }

    fn metadata(&mut self, segment: usize, mut cursor: Cursor<'_>, new_list: bool) -> Result<(), TdmsFault> {
        let end = |end: End| TdmsFault::Metadata { segment, at: end.0 };
        if new_list {
            self.list.clear();
            self.list_number += 1;
        }
        let count = cursor.u32().map_err(end)?;
        for _ in 0..count {
            let at = cursor.at();
            let path = cursor.text().map_err(end)?;
            let index = match self.paths.get(&path) {
                Some(&index) => index,
                None => {
                    let target = self.contents.add(&path).ok_or(TdmsFault::Path { at, path: path.clone() })?;
                    self.nodes.push(Node { target, layout: None, slot: (usize::MAX, 0), has_data: false });
                    self.paths.insert(path, self.nodes.len() - 1);
                    self.nodes.len() - 1
                }
            };
            let Some(node) = self.nodes.get_mut(index) else { continue };
            let at = cursor.at();
            match cursor.u32().map_err(end)? {
                u32::MAX => node.has_data = false,
                0 if node.layout.is_none() => {
                    let (what, expected) = ("the raw data index", "one of its own, as the object had none before");
                    return Err(TdmsFault::Unknown { segment, at, what, found: 0, expected });
                }
                0 => node.has_data = true,
                header => {
                    let layout = Layout::read(header, &mut cursor).map_err(|trouble| match trouble {
                        Trouble::End => TdmsFault::Metadata { segment, at: cursor.at() },
                        Trouble::Unknown { at, what, found, expected } => {
                            TdmsFault::Unknown { segment, at, what, found, expected }
                        }
                    })?;
                    node.layout = Some(Rc::new(layout));
                    node.has_data = true;
                }
            }
            if node.slot.0 != self.list_number {
                node.slot = (self.list_number, self.list.len());
                self.list.push(index);
            }
            let target = node.target;
            let count = cursor.u32().map_err(end)?;
            for _ in 0..count {
                let at = cursor.at();
                let (name, value) = TdmsValue::read(&mut cursor).map_err(end)?;
                let value = value.map_err(|code| {
                    let expected = "1 to 10 (integers, floats), 0x20 (text), 0x21 (boolean) or 0x44 (time)";
                    TdmsFault::Unknown { segment, at, what: "the type of a property", found: code.into(), expected }
                })?;
                self.contents.properties_mut(target).map(|properties| properties.insert(name, value));
            }
        }
        Ok(())
    }

    fn raw_data(&mut self, raw: Raw, interleaved: bool) -> Result<(), TdmsFault> {
        // A list can be used again at no cost in bytes: then time would grow with the square of the file. Where objects have a
        // share of the data, this is never reached.
        const PER_BYTE: usize = 64;
        const FREE: usize = 1_000_000;
        self.work = self.work.saturating_add(self.list.len());
        let active: Vec<(Target, Rc<Layout>)> = self
            .list
            .iter()
            .filter_map(|&index| self.nodes.get(index))
            .filter(|node| node.has_data)
            .filter_map(|node| Some((node.target, Rc::clone(node.layout.as_ref()?))))
            .collect();
        let inner: usize = active
            .iter()
            .map(|(_, layout)| match &layout.kind {
                Kind::Values { .. } => 1,
                Kind::Daqmx { scalers, widths } => scalers.len() + widths.len(),
            })
            .sum();
        self.work = self.work.saturating_add(inner);
        if self.work > self.bytes.len().saturating_mul(PER_BYTE).saturating_add(FREE) {
            return Err(raw.fault("the file has far more objects than data"));
        }
        raw_data::places(&mut self.contents, raw, &active, interleaved)
    }
}
