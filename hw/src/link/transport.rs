//! Connections to a device.

use core::time::Duration;

/// A connection that sends and receives bytes: datagrams (one a call), or a stream (as many bytes as there are).
pub trait Transport {
    /// Why it may fail.
    type Error;

    /// Sends all of the bytes.
    ///
    /// # Errors
    /// If the connection is broken.
    fn send(&mut self, bytes: &[u8]) -> Result<(), Self::Error>;

    /// Puts what comes within `wait` at the front of the buffer and returns how many bytes that is; `None` if nothing
    /// comes. Of a datagram longer than the buffer, its beginning and its true length.
    ///
    /// # Errors
    /// If the connection is broken, or closed by the other side.
    fn receive(&mut self, buffer: &mut [u8], wait: Duration) -> Result<Option<usize>, Self::Error>;

    /// Reconnects.
    ///
    /// # Errors
    /// If that fails, or this transport does not support it.
    fn reconnect(&mut self) -> Result<(), Self::Error>;

    /// Number of datagrams that were ignored: from another address, or empty.
    fn foreign(&self) -> u64 {
        0
    }
}

/// Why a connection to a device cannot be opened, or has broken.
#[cfg(feature = "std")]
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TransportError {
    /// The name has no address.
    #[error("`{host}` has no address ({cause}), expected host:port like `192.168.1.1:49152`; check name and network")]
    Address {
        /// The requested address.
        host: String,
        /// The reason.
        cause: std::io::Error,
    },
    /// No socket to be had.
    #[error("no UDP socket for {peer} ({cause}); is there a network?")]
    Socket {
        /// The device.
        peer: std::net::SocketAddr,
        /// The reason.
        cause: std::io::Error,
    },
    /// It does not take or bring datagrams any more.
    #[error("the UDP socket to {peer} fails ({cause}); check cable, network and address")]
    UdpBroken {
        /// The device.
        peer: std::net::SocketAddr,
        /// The reason.
        cause: std::io::Error,
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
        source: std::io::Error,
    },
    /// It was open and broke, or is closed.
    #[error("the serial port {path} broke: {source}; is the device still plugged in and on?")]
    SerialBroken {
        /// Its path.
        path: String,
        /// The reason.
        source: std::io::Error,
    },
    /// No serial sensor of this name.
    #[error("`{name}` is not a known serial sensor, expected one of: {known}")]
    Profile {
        /// The requested address.
        name: String,
        /// Those there are.
        known: String,
    },
}
