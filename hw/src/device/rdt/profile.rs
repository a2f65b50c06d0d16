//! Status words of RDT sensors.

use crate::sample::Quality;

/// The family of a sensor: all have the same records, but different status words.
///
/// ```
/// use rod_hw::{Quality, device::rdt::RdtProfile};
/// let bit_30 = 0xC000_0000;
/// assert_eq!(RdtProfile::Axia.quality(bit_30), Quality::SATURATED);
/// assert_eq!(RdtProfile::NetFt.quality(bit_30), Quality::DEVICE_ERROR);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RdtProfile {
    /// ATI Net F/T (the box with a transducer at its cable).
    NetFt,
    /// ATI Ethernet Axia.
    Axia,
    /// OnRobot, before OptoForce, Ethernet converter.
    OnRobot,
}

/// Bits of one family: what they say.
struct Bits {
    /// Values beyond what the sensor can measure.
    saturated: u32,
    /// Values may be good.
    warning: u32,
    /// Values are wrong.
    error: u32,
    /// Something of the above; alone or with bits that are not known, an error.
    summary: u32,
}

impl RdtProfile {
    const fn bits(self) -> Bits {
        match self {
            // "transducer saturation or A/D error"; "monitor condition latched"; two bits are reserved
            Self::NetFt => Bits { saturated: 1 << 17, warning: 1 << 16, error: 0x7FFC_7FFE, summary: 1 << 31 },
            // force/torque and gauge out of range; latched; temperature, supply, broken gauge, busy, other, simulated,
            // checksum of the calibration
            Self::Axia => Bits { saturated: 1 << 30 | 1 << 27, warning: 1 << 16, error: 0x3000_002F, summary: 1 << 31 },
            // overload Fx to Tz; sensor missing or failed, converter or its connection failed; number of the sensor that
            // something is wrong with, and whether there are more
            Self::OnRobot => Bits { saturated: 0x03F0, warning: 0, error: 0xFC00, summary: 0x000F },
        }
    }

    /// What a status word says of its sample. Bits that are not known are a warning, together with the bit for any error an
    /// error.
    pub fn quality(self, status: u32) -> Quality {
        let Bits { saturated, warning, error, summary } = self.bits();
        let unknown = status & !(saturated | warning | error | summary);
        let unexplained = status & summary != 0 && (unknown != 0 || status & !summary == 0);
        let mut quality = Quality::empty();
        quality.set(Quality::SATURATED, status & saturated != 0);
        quality.set(Quality::DEVICE_WARNING, status & warning != 0 || unknown != 0);
        quality.set(Quality::DEVICE_ERROR, status & error != 0 || unexplained);
        quality
    }
}
