//! Why there is no connection to a device.

use std::io;
use std::net::SocketAddr;

/// Why there is no connection to a device, or none any more.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TransportError {
    /// The name has no address.
    #[error("`{host}` has no address ({cause}), expected host:port like `192.168.1.1:49152`; check name and network")]
    Address {
        /// What was asked for.
        host: String,
        /// Why.
        cause: io::Error,
    },
    /// No socket to be had.
    #[error("no UDP socket for {peer} ({cause}); is there a network?")]
    Socket {
        /// The device.
        peer: SocketAddr,
        /// Why.
        cause: io::Error,
    },
    /// It does not take or bring datagrams any more.
    #[error("the UDP socket to {peer} fails ({cause}); check cable, network and address")]
    UdpBroken {
        /// The device.
        peer: SocketAddr,
        /// Why.
        cause: io::Error,
    },
    /// It cannot be opened.
    #[error(
        "cannot open the serial port {path} at {baud} baud: {source}; is the device plugged in, the port free, and may this \
         user open it (on Linux: group dialout)?"
    )]
    Open {
        /// Its path.
        path: String,
        /// Bits a second.
        baud: u32,
        /// Why not.
        source: io::Error,
    },
    /// It was open and broke, or is closed.
    #[error("the serial port {path} broke: {source}; is the device still plugged in and on?")]
    SerialBroken {
        /// Its path.
        path: String,
        /// Why.
        source: io::Error,
    },
    /// No serial sensor of this name.
    #[error("`{name}` is no serial sensor that is known, expected one of: {known}")]
    Profile {
        /// What was asked for.
        name: String,
        /// Those there are.
        known: String,
    },
}
