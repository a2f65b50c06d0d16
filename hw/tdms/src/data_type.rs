//! The data types of values.

use super::timestamp::TdmsTimestamp;
use crate::bytes::Order;

/// The data type of a channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the names say it")]
pub enum DataType {
    I8,
    I16,
    I32,
    I64,
    U8,
    U16,
    U32,
    U64,
    F32,
    F64,
    Bool,
    Text,
    Timestamp,
    ComplexF32,
    ComplexF64,
    /// Counts of a card, each at a bit of its own (a line of a digital port).
    Bit,
}

impl DataType {
    /// By the code in the file.
    pub(super) fn from_code(code: u32) -> Option<Self> {
        Some(match code {
            1 => Self::I8,
            2 => Self::I16,
            3 => Self::I32,
            4 => Self::I64,
            5 => Self::U8,
            6 => Self::U16,
            7 => Self::U32,
            8 => Self::U64,
            // the others are the same with a unit, which is a property
            9 | 0x19 => Self::F32,
            10 | 0x1a => Self::F64,
            0x20 => Self::Text,
            0x21 => Self::Bool,
            0x44 => Self::Timestamp,
            0x08_000c => Self::ComplexF32,
            0x10_000d => Self::ComplexF64,
            _ => return None,
        })
    }

    /// By the code that DAQmx has for them.
    pub(super) fn from_daqmx_code(code: u32) -> Option<Self> {
        const TYPES: [DataType; 10] = [
            DataType::U8,
            DataType::I8,
            DataType::U16,
            DataType::I16,
            DataType::U32,
            DataType::I32,
            DataType::U64,
            DataType::I64,
            DataType::F32,
            DataType::F64,
        ];
        TYPES.get(code as usize).copied()
    }

    /// Bytes of a value; `None` if they differ.
    pub(super) fn size(self) -> Option<usize> {
        Some(match self {
            Self::I8 | Self::U8 | Self::Bool | Self::Bit => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::I64 | Self::U64 | Self::F64 | Self::ComplexF32 => 8,
            Self::Timestamp | Self::ComplexF64 => 16,
            Self::Text => return None,
        })
    }

    /// Whether its values are real numbers: integers, floats, booleans (0 and 1) and timestamps (s).
    pub fn is_number(self) -> bool {
        !matches!(self, Self::Text | Self::ComplexF32 | Self::ComplexF64)
    }

    /// A value as a number; `None` if the bytes end before, or where it is none.
    #[expect(clippy::cast_precision_loss, reason = "counts beyond 2^53 are documented to be rounded")]
    pub(super) fn number(self, bytes: &[u8], at: usize, order: Order) -> Option<f64> {
        Some(match self {
            Self::I8 => order.i8(bytes, at)?.into(),
            Self::I16 => order.i16(bytes, at)?.into(),
            Self::I32 => order.i32(bytes, at)?.into(),
            Self::I64 => order.i64(bytes, at)? as f64,
            Self::U8 | Self::Bit => order.u8(bytes, at)?.into(),
            Self::U16 => order.u16(bytes, at)?.into(),
            Self::U32 => order.u32(bytes, at)?.into(),
            Self::U64 => order.u64(bytes, at)? as f64,
            Self::F32 => order.f32(bytes, at)?.into(),
            Self::F64 => order.f64(bytes, at)?,
            Self::Bool => f64::from(order.u8(bytes, at)? != 0),
            Self::Timestamp => TdmsTimestamp::read(bytes, at, order)?.unix_seconds(),
            Self::Text | Self::ComplexF32 | Self::ComplexF64 => return None,
        })
    }

    /// Whether a number is the last one of a signed integer of this type, at either end.
    pub(super) fn is_rail(self, number: f64) -> bool {
        match self {
            Self::I8 => number == i8::MIN.into() || number == i8::MAX.into(),
            Self::I16 => number == i16::MIN.into() || number == i16::MAX.into(),
            Self::I32 => number == i32::MIN.into() || number == i32::MAX.into(),
            _ => false,
        }
    }
}

impl core::fmt::Display for DataType {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Self::I8 => "i8",
            Self::I16 => "i16",
            Self::I32 => "i32",
            Self::I64 => "i64",
            Self::U8 => "u8",
            Self::U16 => "u16",
            Self::U32 => "u32",
            Self::U64 => "u64",
            Self::F32 => "f32",
            Self::F64 => "f64",
            Self::Bool => "booleans",
            Self::Text => "texts",
            Self::Timestamp => "timestamps",
            Self::ComplexF32 => "complex f32",
            Self::ComplexF64 => "complex f64",
            Self::Bit => "bits",
        })
    }
}
