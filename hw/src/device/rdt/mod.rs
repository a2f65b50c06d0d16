//! RDT, "raw data transfer": the UDP protocol of ATI Net F/T and Ethernet Axia sensors and of OnRobot's (before OptoForce's)
//! Ethernet converter. One decoder, [`Rdt`], for all of them; their [status words](RdtProfile) differ.
//!
//! With the feature `rdt`: the scaling asked for over TCP (`read_scaling`), and the transport, `Udp` of this crate.
//!
//! Sources: ATI 9620-05-Net FT (11 and C-Ethernet Axia-02), OptoForce Ethernet Converter 2.0 (2017).

mod packets;
mod protocol;
#[cfg(feature = "rdt")]
mod scaling;

pub use packets::{RdtRecord, RdtRequest};
pub use protocol::{Rdt, RdtProfile, RdtSettings};
#[cfg(feature = "rdt")]
pub use scaling::{RdtError, RdtScaling, read_scaling};
