//! From bytes to raw samples: protocols, transports, and the links that join them.

mod clock;
mod counters;
mod protocol;
mod protocol_link;
mod sequence;
#[cfg(feature = "serial")]
mod serial_port;
#[cfg(feature = "std")]
mod spawn;
mod transport;
#[cfg(feature = "rdt")]
mod udp;

pub use clock::Clock;
#[cfg(feature = "std")]
pub use clock::HostClock;
pub use counters::LinkCounters;
pub use protocol::{FrameFault, Protocol, Request};
pub use protocol_link::{Link, LinkError, LinkSettings, Reconnect};
pub use sequence::{Sequence, SequenceStep};
#[cfg(feature = "serial")]
pub use serial_port::SerialPort;
#[cfg(feature = "std")]
pub use spawn::{Spawned, spawn};
pub use transport::Transport;
#[cfg(feature = "std")]
pub use transport::TransportError;
#[cfg(feature = "rdt")]
pub use udp::Udp;
