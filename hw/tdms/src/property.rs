//! Properties of a file, a group or a channel.

use super::data_type::DataType;
use super::timestamp::TdmsTimestamp;
use crate::bytes::{Cursor, End};
use std::collections::BTreeMap;

/// Properties by name.
pub type TdmsProperties = BTreeMap<String, TdmsValue>;

/// A property.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum TdmsValue {
    /// A signed integer.
    Integer(i64),
    /// An unsigned integer.
    Unsigned(u64),
    /// A float.
    Real(f64),
    /// A boolean.
    Bool(bool),
    /// A text.
    Text(String),
    /// A time.
    Timestamp(TdmsTimestamp),
}

impl TdmsValue {
    /// As a number: integers and floats.
    #[expect(clippy::cast_precision_loss, reason = "integers beyond 2^53 are documented to be rounded")]
    pub fn number(&self) -> Option<f64> {
        match *self {
            Self::Integer(value) => Some(value as f64),
            Self::Unsigned(value) => Some(value as f64),
            Self::Real(value) => Some(value),
            _ => None,
        }
    }

    /// As a text, where it is one.
    pub fn text(&self) -> Option<&str> {
        match self {
            Self::Text(text) => Some(text),
            _ => None,
        }
    }

    /// As a count, where it is one.
    pub(super) fn count(&self) -> Option<usize> {
        match *self {
            Self::Integer(value) => value.try_into().ok(),
            Self::Unsigned(value) => value.try_into().ok(),
            _ => None,
        }
    }

    /// The next property: its name, and its value where the type is known, otherwise the code of the type.
    pub(super) fn read(cursor: &mut Cursor<'_>) -> Result<(String, Result<Self, u32>), End> {
        let name = cursor.text()?;
        let code = cursor.u32()?;
        let order = cursor.order();
        let Some(data_type) = DataType::from_code(code) else { return Ok((name, Err(code))) };
        let Some(size) = data_type.size() else {
            return Ok((name, Ok(Self::Text(cursor.text()?))));
        };
        let at = cursor.at();
        let bytes = cursor.take(size)?;
        let value = match data_type {
            DataType::I8 => order.i8(bytes, 0).map(|value| Self::Integer(value.into())),
            DataType::I16 => order.i16(bytes, 0).map(|value| Self::Integer(value.into())),
            DataType::I32 => order.i32(bytes, 0).map(|value| Self::Integer(value.into())),
            DataType::I64 => order.i64(bytes, 0).map(Self::Integer),
            DataType::U8 => order.u8(bytes, 0).map(|value| Self::Unsigned(value.into())),
            DataType::U16 => order.u16(bytes, 0).map(|value| Self::Unsigned(value.into())),
            DataType::U32 => order.u32(bytes, 0).map(|value| Self::Unsigned(value.into())),
            DataType::U64 => order.u64(bytes, 0).map(Self::Unsigned),
            DataType::Bool => order.u8(bytes, 0).map(|value| Self::Bool(value != 0)),
            DataType::Timestamp => TdmsTimestamp::read(bytes, 0, order).map(Self::Timestamp),
            DataType::ComplexF32 | DataType::ComplexF64 => return Ok((name, Err(code))),
            _ => data_type.number(bytes, 0, order).map(Self::Real),
        };
        Ok((name, Ok(value.ok_or(End(at))?)))
    }
}

impl core::fmt::Display for TdmsValue {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Integer(value) => write!(f, "{value}"),
            Self::Unsigned(value) => write!(f, "{value}"),
            Self::Real(value) => write!(f, "{value}"),
            Self::Bool(value) => write!(f, "{value}"),
            Self::Text(text) => write!(f, "`{text}`"),
            Self::Timestamp(time) => write!(f, "{} s since 1970 UTC", time.unix_seconds()),
        }
    }
}
