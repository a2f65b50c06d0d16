//! Strain gauges at HX711 converters, read by an Arduino.

use super::profile::{Await, Content, Framing, Head, Profile, Reading, SetupStep};
use crate::protocol::FrameFault;
use crate::raw::Channels;

/// Carriage return, line feed, 2024.0 as f32.
const DELIMITER: [u8; 6] = [0x0d, 0x0a, 0x00, 0x00, 0xfd, 0x44];

/// The stream of an array of HX711 as [whisker_sensor](https://github.com/biao-geng-me/whisker_sensor) sends it, 2,000,000
/// baud:
///
/// ```text
/// channels values f32, mV  0D 0A  2024.0 f32    little-endian
/// ```
///
/// Channels: mV at the bridge. There is no checksum: a frame is one that has a delimiter before and behind it, and the right
/// length in between. Hence a damaged delimiter costs two frames.
///
/// ```
/// use rod_hw::Protocol;
/// use rod_hw::framed::{Framed, Hx711};
/// let mut protocol = Framed::new(Hx711::new(2).ok_or("too many")?);
/// assert_eq!(*protocol.request(0.0).ok_or("none")?, *b"N=2\n");
/// let delimiter = [0x0d, 0x0a, 0, 0, 0xfd, 0x44];
/// let bytes = [&[0x20, 0xc1][..], &delimiter, &[0, 0, 0x80, 0x3f, 0, 0, 0x20, 0xc1], &delimiter].concat();
/// let sample = protocol.decode(&mut &bytes[..], 0.0).ok_or("no sample")??;
/// assert_eq!(sample.channels[..], [1.0, -10.0]); // mV
/// assert_eq!(protocol.counters().skipped_bytes, 2); // the end of a frame whose beginning was not heard
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Hx711 {
    channels: usize,
}

impl Hx711 {
    /// An array of so many; none where that is not 1 to 16.
    pub fn new(channels: usize) -> Option<Self> {
        (1..=Channels::MOST).contains(&channels).then_some(Self { channels })
    }
}

impl Framing for Hx711 {
    fn head(&self, bytes: &[u8]) -> Head {
        match bytes {
            _ if bytes.iter().zip(DELIMITER).any(|(a, b)| *a != b) => Head::Other,
            _ if bytes.len() < DELIMITER.len() => Head::Open,
            _ => Head::Length(4 * self.channels + 2 * DELIMITER.len()),
        }
    }

    fn overlap(&self) -> usize {
        DELIMITER.len()
    }

    fn check(&self, frame: &[u8]) -> Result<(), FrameFault> {
        let from = frame.len() - DELIMITER.len();
        let mut places = (from..).zip(frame[from..].iter().zip(DELIMITER));
        match places.find(|(_, (found, expected))| *found != expected) {
            Some((at, (&found, expected))) => Err(FrameFault::Marker { at, found, expected }),
            None => Ok(()),
        }
    }
}

impl Profile for Hx711 {
    fn content(&self, frame: &[u8]) -> Content {
        let values = super::doubles(&frame[DELIMITER.len()..frame.len() - DELIMITER.len()])
            .map(|four| f32::from_le_bytes(four).into());
        Content::Sample(Reading::new(super::channels(values)))
    }

    fn setup(&self, step: usize) -> Option<SetupStep> {
        let request = super::text(format_args!("N={}\n", self.channels));
        (step == 0).then_some(SetupStep { request, command: b'N', until: Await::Sample })
    }
}
