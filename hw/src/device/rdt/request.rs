//! What is asked of a sensor.

use crate::device::onrobot_filter::OnRobotFilter;
use crate::link::Request;
use core::num::NonZeroU8;

/// What is asked of a sensor, in 8 bytes.
///
/// ```
/// use rod_hw::device::rdt::RdtRequest;
/// let start = RdtRequest::Start { count: 0 };
/// assert_eq!(start.to_bytes(), [0x12, 0x34, 0x00, 0x02, 0, 0, 0, 0]);
/// assert_eq!(RdtRequest::from_bytes(&start.to_bytes()), Some(start));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RdtRequest {
    /// Send no more.
    Stop,
    /// Send so many records, one a datagram; 0 means until stopped.
    Start {
        /// How many.
        count: u32,
    },
    /// Send so many records, several a datagram; 0 means until stopped. Not of OnRobot.
    StartBuffered {
        /// How many.
        count: u32,
    },
    /// Forget that a monitored condition was met. Not of OnRobot.
    ResetLatch,
    /// Take the load of now for zero.
    Bias,
    /// Forget the zero of [`Bias`](Self::Bias). OnRobot only: an ATI sensor would take it for another [`Bias`](Self::Bias).
    ClearBias,
    /// Filter so much. OnRobot only.
    Filter(OnRobotFilter),
    /// Send at this distance, ms. OnRobot only.
    Period(NonZeroU8),
}

impl RdtRequest {
    /// Command and count.
    const fn parts(self) -> (u16, u32) {
        match self {
            Self::Stop => (0x0000, 0),
            Self::Start { count } => (0x0002, count),
            Self::StartBuffered { count } => (0x0003, count),
            Self::ResetLatch => (0x0041, 0),
            // ATI sensors do not look at the number
            Self::Bias => (0x0042, 255),
            Self::ClearBias => (0x0042, 0),
            Self::Filter(filter) => (0x0081, filter as u32),
            Self::Period(period) => (0x0082, period.get() as u32),
        }
    }

    /// As it is sent: 0x1234, command, count, the high byte first.
    pub const fn to_bytes(self) -> [u8; 8] {
        let (command, count) = self.parts();
        let ([c, d], [e, f, g, h]) = (command.to_be_bytes(), count.to_be_bytes());
        [0x12, 0x34, c, d, e, f, g, h]
    }

    /// What these bytes ask; none where they ask nothing that is known.
    pub fn from_bytes(bytes: &[u8]) -> Option<Self> {
        let &[0x12, 0x34, c, d, e, f, g, h] = bytes else { return None };
        let count = u32::from_be_bytes([e, f, g, h]);
        Some(match u16::from_be_bytes([c, d]) {
            0x0000 => Self::Stop,
            0x0002 => Self::Start { count },
            0x0003 => Self::StartBuffered { count },
            0x0041 => Self::ResetLatch,
            0x0042 if count == 0 => Self::ClearBias,
            0x0042 => Self::Bias,
            0x0081 => Self::Filter(*OnRobotFilter::ALL.get(usize::try_from(count).ok()?)?),
            0x0082 => Self::Period(NonZeroU8::new(u8::try_from(count).ok()?)?),
            _ => return None,
        })
    }
}

impl From<RdtRequest> for Request {
    fn from(request: RdtRequest) -> Self {
        request.to_bytes().into()
    }
}
