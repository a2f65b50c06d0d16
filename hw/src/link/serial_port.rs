//! A serial port by path.

use super::transport::Transport;
use super::{TransportError, read_write};
use std::io;
use std::time::Duration;

/// A serial port as a [`Transport`]: 8 bits, no parity, 1 stop bit, no flow control, for this program alone. Broken, it is
/// opened again by its path: name it by something that stays (on Linux in `/dev/serial/by-id`).
///
/// A USB converter may hold bytes back, those of FTDI 16 ms unless told otherwise (on Linux `latency_timer`): samples then
/// come in bunches, with one host time each.
///
/// ```no_run
/// use rod_hw::device::framed::{Bota, Framed};
/// use rod_hw::{HostClock, Link, LinkSettings, SerialPort, SerialProfile};
/// let port = SerialPort::open("/dev/ttyUSB0", SerialProfile::Bota.baud())?;
/// let link = Link::new(port, Framed::new(Bota), HostClock::new(), LinkSettings::default());
/// for sample in link.take(1000) {
///     println!("{:?}", sample?.channels); // N and N m
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct SerialPort {
    path: String,
    baud: u32,
    port: Option<Box<dyn serialport::SerialPort>>,
}

impl SerialPort {
    /// The port of this path (`/dev/ttyUSB0`, `COM3`), at so many bits a second. What arrived before is discarded.
    ///
    /// # Errors
    /// [`TransportError::Open`].
    pub fn open(path: &str, baud: u32) -> Result<Self, TransportError> {
        let mut port = Self { path: path.to_owned(), baud, port: None };
        port.reconnect()?;
        Ok(port)
    }

    fn with<T>(
        &mut self,
        f: impl FnOnce(&mut dyn serialport::SerialPort) -> io::Result<T>,
    ) -> Result<T, TransportError> {
        let closed = || io::Error::new(io::ErrorKind::NotConnected, "it is closed");
        let done = self.port.as_mut().ok_or_else(closed).and_then(|port| f(port.as_mut()));
        done.map_err(|source| TransportError::SerialBroken { path: self.path.clone(), source })
    }
}

impl Transport for SerialPort {
    type Error = TransportError;

    fn send(&mut self, mut bytes: &[u8]) -> Result<(), TransportError> {
        self.with(|mut port| read_write::send(&mut port, std::mem::take(&mut bytes)))
    }

    fn receive(&mut self, buffer: &mut [u8], wait: Duration) -> Result<Option<usize>, TransportError> {
        self.with(|mut port| {
            port.set_timeout(wait)?;
            read_write::receive(&mut port, buffer, wait)
        })
    }

    fn reconnect(&mut self) -> Result<(), TransportError> {
        // closed first, for it is open for one at a time
        self.port = None;
        let opened = serialport::new(&self.path, self.baud).timeout(Duration::from_millis(10)).open();
        let port = opened.map_err(|error| TransportError::Open {
            path: self.path.clone(),
            baud: self.baud,
            source: error.into(),
        })?;
        // of what came before the settings held nothing is known; where that cannot be discarded, the check of the frames must do
        let _ = port.clear(serialport::ClearBuffer::Input);
        self.port = Some(port);
        Ok(())
    }
}

impl std::fmt::Debug for SerialPort {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let open = self.port.is_some();
        f.debug_struct("SerialPort").field("path", &self.path).field("baud", &self.baud).field("open", &open).finish()
    }
}
