//! How the values of one object lie in a chunk of raw data, as its raw data index says.

use super::data_type::DataType;
use crate::bytes::{Cursor, End};

/// How the values of one object lie in a chunk.
#[derive(Debug)]
pub(super) struct Layout {
    /// Values in a chunk.
    pub count: u64,
    pub kind: Kind,
}

#[derive(Debug)]
pub(super) enum Kind {
    /// Values of one type; `bytes` in a chunk.
    Values { data_type: DataType, bytes: u128 },
    /// Bytes as a card delivers them: rows of so many bytes, one width for each buffer.
    Daqmx { scalers: Vec<Scaler>, widths: Vec<u32> },
}

/// Where a number lies in a row of a card's buffer.
#[derive(Debug)]
pub(super) struct Scaler {
    /// Number of the scale that takes it.
    pub id: u32,
    pub data_type: DataType,
    /// Which buffer.
    pub buffer: usize,
    /// Byte in the row.
    pub offset: u64,
    /// Bit of that byte, for a digital line.
    pub bit: u8,
}

/// Why there is no layout.
pub(super) enum Trouble {
    End,
    Unknown { at: usize, what: &'static str, found: u64, expected: &'static str },
}

impl From<End> for Trouble {
    fn from(_: End) -> Self {
        Self::End
    }
}

pub(super) const FORMAT_CHANGING: u32 = 0x1269;
pub(super) const DIGITAL_LINE: u32 = 0x126a;

impl Layout {
    /// After the header of the index, which is neither «none» nor «as before».
    pub fn read(header: u32, cursor: &mut Cursor<'_>) -> Result<Self, Trouble> {
        let at = cursor.at();
        let code = cursor.u32()?;
        let dimension = cursor.u32()?;
        if dimension != 1 {
            let found = dimension.into();
            return Err(Trouble::Unknown { at: at + 4, what: "the dimension of an array", found, expected: "1" });
        }
        let count = cursor.u64()?;
        if header == FORMAT_CHANGING || header == DIGITAL_LINE {
            // the type in front is that of the whole channel, which the scalers tell again
            return Self::read_daqmx(header == DIGITAL_LINE, count, cursor);
        }
        let Some(data_type) = DataType::from_code(code) else {
            let expected = "1 to 10 (integers, floats), 0x20 (text), 0x21 (boolean) or 0x44 (time)";
            return Err(Trouble::Unknown { at, what: "the type of a channel", found: code.into(), expected });
        };
        let bytes = match data_type.size() {
            Some(size) => u128::from(count) * size as u128,
            None => cursor.u64()?.into(),
        };
        Ok(Self { count, kind: Kind::Values { data_type, bytes } })
    }

    fn read_daqmx(digital: bool, count: u64, cursor: &mut Cursor<'_>) -> Result<Self, Trouble> {
        /// Each is looked up by its number among all of a channel; there are one or two in practice.
        const MOST: u32 = 64;
        let at = cursor.at();
        let scaler_count = cursor.u32()?;
        if scaler_count > MOST {
            let found = scaler_count.into();
            return Err(Trouble::Unknown {
                at,
                what: "the number of scalers of a channel",
                found,
                expected: "at most 64",
            });
        }
        let mut scalers: Vec<Scaler> = Vec::new();
        for _ in 0..scaler_count {
            let at = cursor.at();
            let code = cursor.u32()?;
            let buffer = cursor.u32()? as usize;
            let place = u64::from(cursor.u32()?);
            // a bit map of the sample's format, which plays no part
            let _ = if digital { cursor.u8()?.into() } else { cursor.u32()? };
            let id = cursor.u32()?;
            let Some(data_type) = DataType::from_daqmx_code(code) else {
                let expected = "0 to 9 (integers, floats)";
                return Err(Trouble::Unknown { at, what: "the type of a DAQmx scaler", found: code.into(), expected });
            };
            if scalers.iter().any(|other| other.id == id) {
                let expected = "one that the channel has not yet";
                return Err(Trouble::Unknown { at, what: "the number of a DAQmx scaler", found: id.into(), expected });
            }
            scalers.push(if digital {
                Scaler { id, data_type: DataType::Bit, buffer, offset: place / 8, bit: (place % 8) as u8 }
            } else {
                Scaler { id, data_type, buffer, offset: place, bit: 0 }
            });
        }
        let width_count = cursor.u32()? as usize;
        if width_count > cursor.left() / 4 {
            return Err(Trouble::End);
        }
        let widths = (0..width_count).map(|_| cursor.u32()).collect::<Result<Vec<u32>, End>>()?;
        Ok(Self { count, kind: Kind::Daqmx { scalers, widths } })
    }
}
