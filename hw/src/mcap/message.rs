//! Messages of ROS from their bytes: CDR of ROS 2, in both byte orders, and the serialization of ROS 1.

use super::error::MessageFault;
use crate::bytes::{Cursor, End, Order};
use crate::wrench::Wrench;
use rod_core::Pose;

/// A message with a header of time and frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Stamped<M> {
    /// When it was logged, s from the first message of the file, of whichever topic.
    pub log_time: f64,
    /// When it was measured, by its header, from the same origin, s; none where the header has no time.
    pub stamp: Option<f64>,
    /// The frame that it refers to.
    pub frame: String,
    /// What it says.
    pub message: M,
}

impl<M> Stamped<M> {
    /// Time, s: by its header where that has one, by the log otherwise.
    pub fn time(&self) -> f64 {
        self.stamp.unwrap_or(self.log_time)
    }
}

/// A type of message, of those that begin with a `std_msgs/Header`.
pub trait Message: Sized {
    /// Its name in ROS 2; in ROS 1 without `/msg`.
    const NAME: &'static str;

    /// What follows the header.
    #[doc(hidden)]
    fn read(fields: &mut Fields<'_>) -> Result<Self, MessageFault>;
}

/// Poses as ROS has them (`geometry_msgs/PoseStamped`).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RosPose {
    /// m.
    pub position: [f64; 3],
    /// Unit quaternion: x, y, z, w.
    pub orientation: [f64; 4],
}

impl RosPose {
    /// Its part in the plane of x and y: position (m, m) and the angle about z (rad).
    pub fn planar(&self) -> Pose {
        let ([x, y, _], [qx, qy, qz, qw]) = (self.position, self.orientation);
        Pose { x, y, phi: (2.0 * (qw * qz + qx * qy)).atan2(1.0 - 2.0 * (qy * qy + qz * qz)) }
    }
}

/// Joints by name (`sensor_msgs/JointState`).
#[derive(Clone, Debug, PartialEq)]
pub struct RosJoints {
    /// Their names.
    pub names: Vec<String>,
    /// m or rad, each in the place of its name; may be empty, as may the others.
    pub positions: Vec<f64>,
    /// m/s or rad/s.
    pub velocities: Vec<f64>,
    /// N or N m.
    pub efforts: Vec<f64>,
}

impl RosJoints {
    /// The position of a joint, m or rad.
    pub fn position(&self, name: &str) -> Option<f64> {
        self.positions.get(self.names.iter().position(|found| found == name)?).copied()
    }
}

impl Message for Wrench {
    const NAME: &'static str = "geometry_msgs/msg/WrenchStamped";

    fn read(fields: &mut Fields<'_>) -> Result<Self, MessageFault> {
        Ok(Self { force: fields.numbers()?, torque: fields.numbers()? })
    }
}

impl Message for RosPose {
    const NAME: &'static str = "geometry_msgs/msg/PoseStamped";

    fn read(fields: &mut Fields<'_>) -> Result<Self, MessageFault> {
        Ok(Self { position: fields.numbers()?, orientation: fields.numbers()? })
    }
}

impl Message for RosJoints {
    const NAME: &'static str = "sensor_msgs/msg/JointState";

    fn read(fields: &mut Fields<'_>) -> Result<Self, MessageFault> {
        Ok(Self {
            names: fields.list(4, Fields::text)?,
            positions: fields.list(8, Fields::f64)?,
            velocities: fields.list(8, Fields::f64)?,
            efforts: fields.list(8, Fields::f64)?,
        })
    }
}

/// Header time, ns since 1970, where there is any, frame and contents of a message.
pub(super) fn decode<M: Message>(bytes: &[u8], is_ros1: bool) -> Result<(Option<i128>, String, M), MessageFault> {
    let mut fields = Fields::new(bytes, is_ros1)?;
    if is_ros1 {
        fields.u32()?; // a sequence number
    }
    let (seconds, nanoseconds) =
        if is_ros1 { (fields.u32()?.into(), fields.u32()?) } else { (fields.i32()?.into(), fields.u32()?) };
    let seconds: i64 = seconds;
    let stamp = i128::from(seconds) * 1_000_000_000 + i128::from(nanoseconds);
    let frame = fields.text()?;
    let message = M::read(&mut fields)?;
    fields.finish()?;
    Ok(((stamp != 0).then_some(stamp), frame, message))
}

/// The fields of a message in turn.
#[doc(hidden)]
#[derive(Debug)]
pub struct Fields<'a> {
    cursor: Cursor<'a>,
    length: usize,
    is_ros1: bool,
}

/// In CDR four bytes come first; places are multiples of the size of a number from there on.
const ENCAPSULATION: usize = 4;

impl<'a> Fields<'a> {
    fn new(bytes: &'a [u8], is_ros1: bool) -> Result<Self, MessageFault> {
        let length = bytes.len();
        if is_ros1 {
            return Ok(Self { cursor: Cursor::new(bytes, 0, Order::Little), length, is_ros1 });
        }
        let kind = Order::Big.u16(bytes, 0).filter(|_| length >= ENCAPSULATION);
        let order = match kind.ok_or(MessageFault::End { end: length, at: 0 })? {
            0 => Order::Big,
            1 => Order::Little,
            other => return Err(MessageFault::Encapsulation(other)),
        };
        Ok(Self { cursor: Cursor::new(bytes, ENCAPSULATION, order), length, is_ros1 })
    }

    fn end(&self) -> impl Fn(End) -> MessageFault + use<> {
        let end = self.length;
        move |End(at)| MessageFault::End { end, at }
    }

    fn align(&mut self, size: usize) {
        if !self.is_ros1 {
            self.cursor.align(ENCAPSULATION, size);
        }
    }

    fn u32(&mut self) -> Result<u32, MessageFault> {
        self.align(4);
        self.cursor.u32().map_err(self.end())
    }

    fn i32(&mut self) -> Result<i32, MessageFault> {
        self.align(4);
        self.cursor.i32().map_err(self.end())
    }

    fn f64(&mut self) -> Result<f64, MessageFault> {
        self.align(8);
        self.cursor.f64().map_err(self.end())
    }

    fn numbers<const N: usize>(&mut self) -> Result<[f64; N], MessageFault> {
        let mut numbers = [0.0; N];
        for number in &mut numbers {
            *number = self.f64()?;
            if !number.is_finite() {
                return Err(MessageFault::NotFinite(*number));
            }
        }
        Ok(numbers)
    }

    /// A text after its length, which in CDR counts a zero at its end.
    fn text(&mut self) -> Result<String, MessageFault> {
        let length = self.u32()? as usize;
        let bytes = self.cursor.take(length).map_err(self.end())?;
        let bytes = if self.is_ros1 { bytes } else { bytes.strip_suffix(&[0]).unwrap_or(bytes) };
        Ok(String::from_utf8_lossy(bytes).into_owned())
    }

    /// Values after their number, of at least `size` bytes each.
    fn list<T>(
        &mut self,
        size: usize,
        item: impl Fn(&mut Self) -> Result<T, MessageFault>,
    ) -> Result<Vec<T>, MessageFault> {
        let count = self.u32()? as usize;
        if count > self.cursor.left() / size.max(1) {
            return Err(MessageFault::End { end: self.length, at: self.cursor.at() });
        }
        (0..count).map(|_| item(self)).collect()
    }

    /// At the end there may be bytes that fill up to a multiple of four.
    fn finish(&self) -> Result<(), MessageFault> {
        let expected = self.cursor.at();
        let most = if self.is_ros1 { expected } else { expected.next_multiple_of(4) };
        if self.length > most {
            return Err(MessageFault::Length { found: self.length, expected });
        }
        Ok(())
    }
}
