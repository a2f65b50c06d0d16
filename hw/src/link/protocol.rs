//! From bytes to raw samples, without any input or output.

use super::counters::LinkCounters;
use crate::sample::RawSample;
use core::ops::Deref;

/// A device's language: a state machine that is handed bytes and time, and neither reads nor writes, nor looks at a clock.
///
/// For protocol authors, the contract:
/// 1. [`decode`](Self::decode) returns `None` only when it has consumed all that it was handed. It tells at most one thing
///    for each byte that it ever consumed, so that asking until there is nothing to tell comes to an end. It never panics,
///    whatever the bytes, and keeps a bounded number of them.
/// 2. Of a stream, bytes one at a time give the same samples as all at once. Of datagrams, each call begins with a whole
///    one or with what an earlier call left of it.
/// 3. [`counters`](Self::counters) account for every frame and every byte outside of frames.
/// 4. What [`request`](Self::request) returns is to be sent at once; until the device answers, it asks again by itself.
pub trait Protocol {
    /// Consumes bytes from the front, which came at `now` (s), until there is something to tell or none are left.
    ///
    /// # Errors
    /// [`FrameFault`] of one frame; what follows may be good.
    fn decode(&mut self, bytes: &mut &[u8], now: f64) -> Option<Result<RawSample, FrameFault>>;

    /// The request to the device at `now` (s), if one is due: it sets up and starts the device, and is repeated if there is no answer.
    fn request(&mut self, now: f64) -> Option<Request> {
        let _ = now;
        None
    }

    /// The request that ends the samples, if there is one.
    fn farewell(&self) -> Option<Request> {
        None
    }

    /// The connection was re-established: parts of frames are forgotten, the device is to be started again.
    fn reset(&mut self);

    /// The counters so far. The link adds its own.
    fn counters(&self) -> LinkCounters;
}

#[cfg(feature = "std")]
impl<P: Protocol + ?Sized> Protocol for Box<P> {
    fn decode(&mut self, bytes: &mut &[u8], now: f64) -> Option<Result<RawSample, FrameFault>> {
        (**self).decode(bytes, now)
    }
    fn request(&mut self, now: f64) -> Option<Request> {
        (**self).request(now)
    }
    fn farewell(&self) -> Option<Request> {
        (**self).farewell()
    }
    fn reset(&mut self) {
        (**self).reset();
    }
    fn counters(&self) -> LinkCounters {
        (**self).counters()
    }
}

/// A fault of one frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum FrameFault {
    /// Its length.
    #[error("a frame of {found} bytes, expected {expected}; is this the right protocol?")]
    Length {
        /// How many bytes it has.
        found: usize,
        /// How many it should have.
        expected: usize,
    },
    /// Its header or terminator.
    #[error("a frame with {found:#04x} at byte {at}, expected {expected:#04x}; is this the right protocol?")]
    Marker {
        /// Which byte, from 0.
        at: usize,
        /// Its description.
        found: u8,
        /// The expected value.
        expected: u8,
    },
    /// Its checksum.
    #[error("a frame with checksum {found:#06x}, expected {expected:#06x}; check baud rate and cable")]
    Checksum {
        /// The checksum in the frame.
        found: u16,
        /// The checksum of its bytes.
        expected: u16,
    },
    /// The device refuses a request.
    #[error("the device refuses the request {request:#04x} with code {code:#04x}; check its settings")]
    Refused {
        /// Command of the request.
        request: u8,
        /// Its answer.
        code: u8,
    },
}

/// Bytes for a device, at most 64.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct Request {
    bytes: [u8; 64],
    count: usize,
}

impl<const N: usize> From<[u8; N]> for Request {
    fn from(bytes: [u8; N]) -> Self {
        const { assert!(N <= 64, "at most 64 bytes") };
        let mut request = Self { bytes: [0; 64], count: N };
        request.bytes[..N].copy_from_slice(&bytes);
        request
    }
}

impl Deref for Request {
    type Target = [u8];
    fn deref(&self) -> &[u8] {
        &self.bytes[..self.count]
    }
}

impl core::fmt::Debug for Request {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "Request({:02x?})", &**self)
    }
}
