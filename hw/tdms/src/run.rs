//! Where values lie in the file.

use super::data_type::DataType;
use crate::bytes::Order;
use core::ops::Range;

/// Values at regular places in the file: chunks of rows.
#[derive(Clone, Copy, Debug)]
pub(super) struct Run {
    pub data_type: DataType,
    pub order: Order,
    /// Which bit, where the values are bits.
    pub bit: u8,
    /// Byte of the first value.
    pub first: usize,
    /// Bytes from value to value in a chunk.
    pub stride: usize,
    /// Values in a chunk.
    pub per_chunk: usize,
    /// Bytes from chunk to chunk.
    pub chunk: usize,
    /// Values in all.
    pub count: usize,
}

impl Run {
    /// First byte of the chunk of a value, and its number in the chunk.
    fn place(&self, i: usize) -> (usize, usize) {
        let per_chunk = self.per_chunk.max(1);
        (self.first.saturating_add((i / per_chunk).saturating_mul(self.chunk)), i % per_chunk)
    }

    /// Value `i` as a number.
    pub fn number(&self, bytes: &[u8], i: usize) -> Option<f64> {
        let (chunk, row) = self.place(i);
        let at = chunk.checked_add(row.checked_mul(self.stride)?)?;
        match self.data_type {
            DataType::Bit => Some(f64::from(self.order.u8(bytes, at)? >> self.bit & 1)),
            data_type => data_type.number(bytes, at, self.order),
        }
    }

    /// Byte of value `i`, where all have the same size.
    pub fn at(&self, i: usize) -> Option<usize> {
        let (chunk, row) = self.place(i);
        chunk.checked_add(row.checked_mul(self.stride)?)
    }

    /// Where value `i` lies, a text: there is a table of where each one ends, then the texts.
    pub fn text(&self, bytes: &[u8], i: usize) -> Option<Range<usize>> {
        let (chunk, row) = self.place(i);
        let end_of = |k: usize| self.order.u32(bytes, chunk.checked_add(4 * k)?).map(|end| end as usize);
        let texts = chunk.checked_add(4 * self.per_chunk)?;
        let (from, to) = (if row == 0 { 0 } else { end_of(row - 1)? }, end_of(row)?);
        let limit = chunk.saturating_add(self.chunk).min(bytes.len());
        Some(texts.checked_add(from)?..texts.checked_add(to)?.min(limit))
    }
}

/// The values of a channel, or of one of its scalers, through all segments.
#[derive(Clone, Debug)]
pub(super) struct Series {
    /// Number of the scaler.
    pub id: Option<u32>,
    pub runs: Vec<Run>,
    pub count: usize,
}

impl Series {
    pub fn push(&mut self, run: Run) {
        self.count = self.count.saturating_add(run.count);
        self.runs.push(run);
    }
}
