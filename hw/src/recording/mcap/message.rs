//! Messages of ROS from their bytes: CDR of ROS 2, in both byte orders, and the serialization of ROS 1.

use super::bytes::{Cursor, End, Order};
use super::error::McapFault;
use crate::sample::Wrench;

/// The type that is read, as ROS 2 calls it; in ROS 1 it has no `/msg`.
pub(super) const NAME: &str = "geometry_msgs/msg/WrenchStamped";

/// Header time, ns since 1970, where there is any, and the wrench of a message.
pub(super) fn decode(bytes: &[u8], is_ros1: bool) -> Result<(Option<i128>, Wrench), McapFault> {
    let mut fields = Fields::new(bytes, is_ros1)?;
    if is_ros1 {
        fields.u32()?; // a sequence number
    }
    let (seconds, nanoseconds) =
        if is_ros1 { (fields.u32()?.into(), fields.u32()?) } else { (fields.i32()?.into(), fields.u32()?) };
    let seconds: i64 = seconds;
    let stamp = i128::from(seconds) * 1_000_000_000 + i128::from(nanoseconds);
    fields.skip_text()?;
    let wrench = Wrench { force: fields.numbers()?, torque: fields.numbers()? };
    fields.finish()?;
    Ok(((stamp != 0).then_some(stamp), wrench))
}

/// The fields of a message in turn.
#[derive(Debug)]
struct Fields<'a> {
    cursor: Cursor<'a>,
    length: usize,
    is_ros1: bool,
}

/// In CDR four bytes come first; places are multiples of the size of a number from there on.
const ENCAPSULATION: usize = 4;

impl<'a> Fields<'a> {
    fn new(bytes: &'a [u8], is_ros1: bool) -> Result<Self, McapFault> {
        let length = bytes.len();
        if is_ros1 {
            return Ok(Self { cursor: Cursor::new(bytes, 0, Order::Little), length, is_ros1 });
        }
        let Some(&[high, low, _, _]) = bytes.first_chunk() else {
            return Err(McapFault::End { end: length, at: 0 });
        };
        let order = match u16::from_be_bytes([high, low]) {
            0 => Order::Big,
            1 => Order::Little,
            other => return Err(McapFault::Encapsulation(other)),
        };
        Ok(Self { cursor: Cursor::new(bytes, ENCAPSULATION, order), length, is_ros1 })
    }

    fn end(&self) -> impl Fn(End) -> McapFault + use<> {
        let end = self.length;
        move |End(at)| McapFault::End { end, at }
    }

    fn align(&mut self, size: usize) {
        if !self.is_ros1 {
            self.cursor.align(ENCAPSULATION, size);
        }
    }

    fn u32(&mut self) -> Result<u32, McapFault> {
        self.align(4);
        self.cursor.u32().map_err(self.end())
    }

    fn i32(&mut self) -> Result<i32, McapFault> {
        self.align(4);
        self.cursor.i32().map_err(self.end())
    }

    fn f64(&mut self) -> Result<f64, McapFault> {
        self.align(8);
        self.cursor.f64().map_err(self.end())
    }

    fn numbers<const N: usize>(&mut self) -> Result<[f64; N], McapFault> {
        let mut numbers = [0.0; N];
        for number in &mut numbers {
            *number = self.f64()?;
            if !number.is_finite() {
                return Err(McapFault::NotFinite(*number));
            }
        }
        Ok(numbers)
    }

    /// Over a text after its length.
    fn skip_text(&mut self) -> Result<(), McapFault> {
        let length = self.u32()? as usize;
        self.cursor.take(length).map_err(self.end()).map(drop)
    }

    /// At the end there may be bytes that fill up to a multiple of four.
    fn finish(&self) -> Result<(), McapFault> {
        let expected = self.cursor.at();
        let most = if self.is_ros1 { expected } else { expected.next_multiple_of(4) };
        if self.length > most {
            return Err(McapFault::Length { found: self.length, expected });
        }
        Ok(())
    }
}
