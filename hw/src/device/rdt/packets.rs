//! The packets of RDT: records and requests.

use crate::link::Request;

/// One record of a sensor, 36 bytes.
///
/// ```
/// use rod_hw::device::rdt::RdtRecord;
/// let record = RdtRecord { packet: 1, sample: 100, status: 0, counts: [100, -200, 300, 10, -20, 30] };
/// let bytes = record.to_bytes();
/// assert_eq!(bytes[16..20], [0xff, 0xff, 0xff, 0x38]);
/// assert_eq!(RdtRecord::from_bytes(&bytes), record);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RdtRecord {
    /// `rdt_sequence`: number of the record since the start that asked for it, from 1.
    pub packet: u32,
    /// `ft_sequence`: number of the sample by the clock of the sensor.
    pub sample: u32,
    /// Status word; its meaning is that of the [profile](super::RdtProfile).
    pub status: u32,
    /// Fx, Fy, Fz, Tx, Ty, Tz, counts.
    pub counts: [i32; 6],
}

impl RdtRecord {
    /// How many bytes it has.
    pub const BYTES: usize = 36;

    /// From nine words, the high byte first.
    pub fn from_bytes(bytes: &[u8; Self::BYTES]) -> Self {
        let mut words = [0; 9];
        for (word, four) in words.iter_mut().zip(bytes.chunks_exact(4)) {
            *word = four.iter().fold(0, |word, &byte| word << 8 | u32::from(byte));
        }
        let [packet, sample, status, counts @ ..] = words;
        Self { packet, sample, status, counts: counts.map(u32::cast_signed) }
    }

    /// As it is sent.
    pub fn to_bytes(&self) -> [u8; Self::BYTES] {
        let mut bytes = [0; Self::BYTES];
        let words = [self.packet, self.sample, self.status].into_iter().chain(self.counts.map(i32::cast_unsigned));
        for (four, word) in bytes.chunks_exact_mut(4).zip(words) {
            four.copy_from_slice(&word.to_be_bytes());
        }
        bytes
    }
}

impl From<[i32; 6]> for RdtRecord {
    /// Counts of Fx to Tz, all else 0.
    fn from(counts: [i32; 6]) -> Self {
        Self { counts, ..Self::default() }
    }
}

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
    /// Stop sending.
    Stop,
    /// Send this number of records, one a datagram; 0 means until stopped.
    Start {
        /// How many.
        count: u32,
    },
}

impl RdtRequest {
    /// Command and count.
    const fn parts(self) -> (u16, u32) {
        match self {
            Self::Stop => (0x0000, 0),
            Self::Start { count } => (0x0002, count),
        }
    }

    /// As it is sent: 0x1234, command, count, the high byte first.
    pub const fn to_bytes(self) -> [u8; 8] {
        let (command, count) = self.parts();
        let ([c, d], [e, f, g, h]) = (command.to_be_bytes(), count.to_be_bytes());
        [0x12, 0x34, c, d, e, f, g, h]
    }

    /// The request in these bytes; `None` if it is unknown.
    pub fn from_bytes(bytes: &[u8]) -> Option<Self> {
        let &[0x12, 0x34, c, d, e, f, g, h] = bytes else { return None };
        let count = u32::from_be_bytes([e, f, g, h]);
        Some(match u16::from_be_bytes([c, d]) {
            0x0000 => Self::Stop,
            0x0002 => Self::Start { count },
            _ => return None,
        })
    }
}

impl From<RdtRequest> for Request {
    fn from(request: RdtRequest) -> Self {
        request.to_bytes().into()
    }
}
