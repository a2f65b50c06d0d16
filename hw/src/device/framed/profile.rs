//! The traits that the author of a framed device implements.

use crate::link::{FrameFault, Request};
use crate::sample::{Channels, Quality};

/// The framing: beginning, end and check of frames.
///
/// For authors, the contract:
/// 1. [`head`](Self::head) decides by the first bytes alone: what it said of some bytes it says of all that begin with them,
///    but for [`Head::Open`]. Payload may look like the beginning or the end of a frame: length decides, a terminator
///    confirms.
/// 2. [`check`](Self::check) is handed frames of the length that `head` told.
pub trait Framing {
    /// Whether a frame begins with these bytes, at least one, and how long it is.
    fn head(&self, bytes: &[u8]) -> Head;

    /// Whether a frame is what was sent.
    ///
    /// # Errors
    /// [`FrameFault`]. The search goes on at its second byte.
    fn check(&self, frame: &[u8]) -> Result<(), FrameFault>;
}

/// The result of reading the beginning of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Head {
    /// No frame begins here.
    Other,
    /// It takes more bytes to tell.
    Open,
    /// A frame of so many bytes, 1 to [`LONGEST_FRAME`](super::LONGEST_FRAME).
    Length(usize),
}

/// A device with framed bytes, which [`Framed`](super::Framed) makes a [`Protocol`](crate::Protocol):
///
/// ```
/// use rod_hw::device::framed::{Content, Framed, Framing, Head, Profile, Reading};
/// use rod_hw::{Channels, FrameFault, Protocol};
/// /// GSV-3: `A5`, then 16 bits with an offset.
/// struct Gsv3;
/// impl Framing for Gsv3 {
///     fn head(&self, bytes: &[u8]) -> Head {
///         if bytes[0] == 0xa5 { Head::Length(3) } else { Head::Other }
///     }
///     fn check(&self, _: &[u8]) -> Result<(), FrameFault> {
///         Ok(()) // there is nothing to check it by
///     }
/// }
/// impl Profile for Gsv3 {
///     fn content(&self, frame: &[u8]) -> Content {
///         let count = f64::from(u16::from_be_bytes([frame[1], frame[2]])) - 32768.0;
///         Content::Sample(Reading::new(Channels::from([count])))
///     }
/// }
/// let mut protocol = Framed::new(Gsv3);
/// let sample = protocol.decode(&mut &[0xff, 0xa5, 0x80, 0x02][..], 0.0).ok_or("no sample")??;
/// assert_eq!((sample.channels[0], protocol.counters().skipped_bytes), (2.0, 1));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub trait Profile: Framing {
    /// The content of a frame that passed its check.
    fn content(&self, frame: &[u8]) -> Content;

    /// The requests that set the device up and start it, from step 0 on; none after the last one, or where it sends by
    /// itself.
    fn setup(&self, step: usize) -> Option<SetupStep> {
        let _ = step;
        None
    }

    /// The request that stops it.
    fn farewell(&self) -> Option<Request> {
        None
    }

    /// How many bits the counter of its samples has, where it has one that grows by 1 from sample to sample.
    fn counter_bits(&self) -> Option<u32> {
        None
    }
}

/// The content of a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Content {
    /// A sample.
    Sample(Reading),
    /// The device confirms a request.
    Answer,
    /// It did not, for the reason of this code.
    Refusal(u8),
}

/// A measurement of a device with its status.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reading {
    /// The values, in the order and unit of the device.
    pub channels: Channels,
    /// Status word as sent.
    pub status: u32,
    /// The flags of its status.
    pub quality: Quality,
    /// Temperature, degrees Celsius.
    pub temperature: Option<f64>,
    /// Number by the device's counter, which wraps as [`Profile::counter_bits`] says.
    pub number: Option<u32>,
    /// Time by the device's clock, us, which wraps at 2^32.
    pub microseconds: Option<u32>,
}

impl Reading {
    /// These values, and nothing else known.
    pub fn new(channels: Channels) -> Self {
        Self { channels, ..Self::default() }
    }
}

/// A request, and what shows that it was heard.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SetupStep {
    /// The request.
    pub request: Request,
    /// Its command, for messages.
    pub command: u8,
    /// The event before the next step. The request is repeated if the event does not come.
    pub until: Await,
}

/// The event that ends a wait.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Await {
    /// An answer.
    Answer,
    /// A sample.
    Sample,
    /// This time, s.
    Pause(f64),
}
