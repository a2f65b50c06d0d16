//! Where the values of a segment lie: one channel after the other, side by side, or as cards deliver them.

use super::contents::{Contents, Target};
use super::data_type::DataType;
use super::error::TdmsFault;
use super::layout::{Kind, Layout};
use super::run::Run;
use crate::bytes::Order;
use std::rc::Rc;

/// The raw data of a segment.
#[derive(Clone, Copy)]
pub(super) struct Raw {
    pub segment: usize,
    pub order: Order,
    pub from: usize,
    pub to: usize,
    /// Whether the file ends before it does.
    pub is_cut: bool,
}

impl Raw {
    fn len(self) -> usize {
        self.to - self.from
    }

    pub fn fault(self, what: &'static str) -> TdmsFault {
        TdmsFault::Layout { segment: self.segment, what }
    }
}

/// Notes where the values of objects lie that have any in the segment.
pub(super) fn places(
    contents: &mut Contents,
    raw: Raw,
    active: &[(Target, Rc<Layout>)],
    is_interleaved: bool,
) -> Result<(), TdmsFault> {
    let cards = active.iter().filter(|(_, layout)| matches!(layout.kind, Kind::Daqmx { .. })).count();
    if cards > 0 && cards < active.len() {
        return Err(raw.fault("data as a card delivers them are mixed with others"));
    }
    if cards > 0 {
        return daqmx(contents, raw, active);
    }
    if active.iter().all(|(_, layout)| layout.count == 0) {
        return Err(raw.fault("there are raw data, but no object that has values"));
    }
    let is_text = |layout: &Layout| matches!(layout.kind, Kind::Values { data_type: DataType::Text, .. });
    // a single channel of texts may be marked as interleaved
    if is_interleaved && !(active.len() == 1 && active.iter().all(|(_, layout)| is_text(layout))) {
        return interleaved(contents, raw, active);
    }
    contiguous(contents, raw, active)
}

/// Values side by side, a row for each instant.
fn interleaved(contents: &mut Contents, raw: Raw, active: &[(Target, Rc<Layout>)]) -> Result<(), TdmsFault> {
    let rows_of = |layout: &Layout| layout.count;
    if active.windows(2).any(|pair| matches!(pair, [(_, a), (_, b)] if rows_of(a) != rows_of(b))) {
        return Err(raw.fault("interleaved channels of different lengths"));
    }
    let mut columns = Vec::new();
    let mut width = 0_usize;
    for (target, layout) in active {
        let Kind::Values { data_type, .. } = layout.kind else { continue };
        let Some(size) = data_type.size() else { return Err(raw.fault("texts interleaved with others")) };
        columns.push((*target, data_type, width));
        width += size;
    }
    let count = raw.len() / width.max(1);
    if count == 0 {
        return Ok(());
    }
    for (target, data_type, offset) in columns {
        let first = raw.from + offset;
        let run = Run { data_type, order: raw.order, bit: 0, first, stride: width, per_chunk: count, chunk: 0, count };
        contents.add_run(target, None, run).map_err(|what| raw.fault(what))?;
    }
    Ok(())
}

/// In each chunk the values of one object after the other.
fn contiguous(contents: &mut Contents, raw: Raw, active: &[(Target, Rc<Layout>)]) -> Result<(), TdmsFault> {
    let size = |layout: &Layout| match layout.kind {
        Kind::Values { bytes, .. } => bytes,
        Kind::Daqmx { .. } => 0,
    };
    let chunk: u128 = active.iter().map(|(_, layout)| size(layout)).sum();
    if chunk == 0 {
        return Err(raw.fault("there are raw data, but no object that has values"));
    }
    let whole = usize::try_from(raw.len() as u128 / chunk).unwrap_or(0);
    let rest = (raw.len() as u128 % chunk) as usize;
    let tail = raw.to - rest;
    // where the whole chunks are none, this is used for none
    let chunk_bytes = usize::try_from(chunk).unwrap_or(usize::MAX);
    let mut first = raw.from;
    let mut tail_first = tail;
    let mut tail_is_open = rest > 0;
    let has_text = active.iter().any(|(_, l)| matches!(l.kind, Kind::Values { data_type: DataType::Text, .. }));
    for (target, layout) in active {
        let Kind::Values { data_type, bytes } = layout.kind else { continue };
        let stride = data_type.size().unwrap_or(0);
        let run = |first, per_chunk, count| Run {
            data_type,
            order: raw.order,
            bit: 0,
            first,
            stride,
            per_chunk,
            // where texts end, there is no more to read
            chunk: chunk_bytes,
            count,
        };
        if whole > 0
            && let Ok(per_chunk) = usize::try_from(layout.count)
            && per_chunk > 0
        {
            let size = usize::try_from(bytes).unwrap_or(usize::MAX);
            if data_type == DataType::Text && per_chunk > size / 4 {
                return Err(raw.fault("more texts than there are bytes for"));
            }
            let run = run(first, per_chunk, per_chunk.saturating_mul(whole));
            contents.add_run(*target, None, run).map_err(|what| raw.fault(what))?;
            first = first.saturating_add(size);
        }
        if !tail_is_open {
            continue;
        }
        // What is left of the last chunk: cut where the file ends, or else a shorter chunk in proportion.
        let left = raw.to - tail_first;
        let count = if raw.is_cut {
            let fits = left.checked_div(stride).unwrap_or(if bytes <= left as u128 { usize::MAX } else { 0 });
            u64::try_from(fits).unwrap_or(u64::MAX).min(layout.count)
        } else if has_text {
            0
        } else {
            u64::try_from(u128::from(layout.count).saturating_mul(rest as u128) / chunk).unwrap_or(0)
        };
        tail_is_open = if raw.is_cut { count == layout.count } else { !has_text };
        let taken = if stride > 0 { count as usize * stride } else { usize::try_from(bytes).unwrap_or(left) };
        if count > 0 {
            let count = count as usize;
            if data_type == DataType::Text && count > taken / 4 {
                return Err(raw.fault("more texts than there are bytes for"));
            }
            contents.add_run(*target, None, run(tail_first, count, count)).map_err(|what| raw.fault(what))?;
        }
        tail_first += taken.min(left);
    }
    Ok(())
}

/// In each chunk one buffer after the other, each with rows as a card delivers them.
fn daqmx(contents: &mut Contents, raw: Raw, active: &[(Target, Rc<Layout>)]) -> Result<(), TdmsFault> {
    let mut buffers: Vec<(u64, u64)> = Vec::new(); // rows, width
    for (i, (_, layout)) in active.iter().enumerate() {
        let Kind::Daqmx { scalers, widths } = &layout.kind else { continue };
        if i == 0 {
            buffers = widths.iter().map(|&width| (0, width.into())).collect();
        } else if !widths.iter().map(|&width| u64::from(width)).eq(buffers.iter().map(|buffer| buffer.1)) {
            return Err(raw.fault("its channels disagree about the widths of the card's rows"));
        }
        for scaler in scalers {
            let size = scaler.data_type.size().unwrap_or(0) as u64;
            match buffers.get_mut(scaler.buffer) {
                Some((rows, width)) if scaler.offset + size <= *width => *rows = layout.count.max(*rows),
                _ => return Err(raw.fault("a scaler lies outside of the card's rows")),
            }
        }
    }
    // a value takes a bit at least; otherwise the memory for their places would grow with the square of the file
    let places = active.iter().map(|(_, layout)| match &layout.kind {
        Kind::Daqmx { scalers, .. } => scalers.len(),
        Kind::Values { .. } => 0,
    });
    if places.sum::<usize>() > raw.len().saturating_mul(8) {
        return Err(raw.fault("more channels than bits"));
    }
    let mut chunk = 0_u128;
    let mut starts = Vec::with_capacity(buffers.len());
    for &(rows, width) in &buffers {
        starts.push(chunk);
        chunk += u128::from(rows) * u128::from(width);
    }
    if chunk == 0 {
        return Err(raw.fault("there are raw data, but no channel that has values"));
    }
    let whole = raw.len() as u128 / chunk;
    let rest = raw.len() as u128 % chunk;
    for (target, layout) in active {
        let Kind::Daqmx { scalers, .. } = &layout.kind else { continue };
        for scaler in scalers {
            let (Some(&(_, width)), Some(&start)) = (buffers.get(scaler.buffer), starts.get(scaler.buffer)) else {
                continue;
            };
            let tail = (rest.saturating_sub(start) / u128::from(width.max(1))).min(layout.count.into());
            let from = start + u128::from(scaler.offset);
            for (offset, rows, chunks) in [(from, layout.count.into(), whole), (whole * chunk + from, tail, 1)] {
                // what is there lies within the file, hence within usize
                let (Ok(offset), Ok(per_chunk), Ok(count)) =
                    (usize::try_from(offset), usize::try_from(rows), usize::try_from(rows * chunks))
                else {
                    continue;
                };
                if count == 0 {
                    continue;
                }
                let run = Run {
                    data_type: scaler.data_type,
                    order: raw.order,
                    bit: scaler.bit,
                    first: raw.from.saturating_add(offset),
                    stride: width as usize,
                    per_chunk,
                    chunk: usize::try_from(chunk).unwrap_or(usize::MAX),
                    count,
                };
                contents.add_run(*target, Some(scaler.id), run).map_err(|what| raw.fault(what))?;
            }
        }
    }
    Ok(())
}
