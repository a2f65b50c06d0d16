//! Connections to a device.

use core::time::Duration;

/// A connection that sends and receives bytes: datagrams (one a call), or a stream (as many bytes as there are).
pub trait Transport {
    /// Why it may fail.
    type Error;

    /// Sends all of the bytes.
    ///
    /// # Errors
    /// Where the connection is broken.
    fn send(&mut self, bytes: &[u8]) -> Result<(), Self::Error>;

    /// Puts what comes within `wait` at the front of the buffer and returns how many bytes that is; none where nothing
    /// comes. Of a datagram longer than the buffer, its beginning and its true length.
    ///
    /// # Errors
    /// Where the connection is broken, or ended by the other side.
    fn receive(&mut self, buffer: &mut [u8], wait: Duration) -> Result<Option<usize>, Self::Error>;

    /// Reconnects.
    ///
    /// # Errors
    /// Where that does not work (yet), or not at all for this transport.
    fn reconnect(&mut self) -> Result<(), Self::Error>;

    /// Number of datagrams that were ignored: from another address, or empty.
    fn foreign(&self) -> u64 {
        0
    }
}
