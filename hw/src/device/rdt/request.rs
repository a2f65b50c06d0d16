//! Requests of RDT.

use crate::link::Request;

/// A request to a sensor, 8 bytes.
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
    /// Take the load of now for zero.
    Bias,
}

impl RdtRequest {
    /// Command and count.
    const fn parts(self) -> (u16, u32) {
        match self {
            Self::Stop => (0x0000, 0),
            Self::Start { count } => (0x0002, count),
            // ATI sensors do not look at the number; OnRobot's take 0 for the way back to the old zero
            Self::Bias => (0x0042, 255),
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
            0x0042 => Self::Bias,
            _ => return None,
        })
    }
}

impl From<RdtRequest> for Request {
    fn from(request: RdtRequest) -> Self {
        request.to_bytes().into()
    }
}
