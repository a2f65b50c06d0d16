//! Pseudo-terminals, for devices that are programs.

use serialport::{SerialPort, TTYPort};
use std::io::{self, Read, Write};
use std::time::Duration;

/// The near end of a pseudo-terminal, whose far end is a path that programs open as a serial port.
///
/// The far end is there as long as this is, opened or not: dropping it is what unplugging a device is. It has no baud rate:
/// whatever is set, bytes pass as fast as they are read, and up to about 4 KiB wait. Reads and writes come back after 1 ms.
#[derive(Debug)]
pub struct Pty {
    near: TTYPort,
    /// Open, so that the path stays as it is while nobody has it open.
    _far: TTYPort,
    path: String,
}

/// A new pseudo-terminal.
///
/// ```
/// use rod_fake_sensor::open_pty;
/// use rod_hw::{SerialPort, Transport};
/// use std::io::Read;
/// let mut pty = open_pty()?;
/// let baud = if cfg!(target_os = "macos") { 0 } else { 115_200 }; // where it may not be set
/// let mut port = SerialPort::open(pty.path(), baud)?;
/// port.send(b"hello")?;
/// let mut heard = [0; 5];
/// pty.read_exact(&mut heard)?;
/// assert_eq!(&heard, b"hello");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// If the system has none left.
pub fn open_pty() -> io::Result<Pty> {
    let (mut near, far) = TTYPort::pair()?;
    near.set_timeout(Duration::from_millis(1))?;
    let path = far.name().ok_or_else(|| io::Error::other("the pseudo-terminal has no path"))?;
    Ok(Pty { near, _far: far, path })
}

impl Pty {
    /// The path to open as a serial port.
    pub fn path(&self) -> &str {
        &self.path
    }
}

impl Read for Pty {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.near.read(buffer)
    }
}

impl Write for Pty {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.near.write(bytes)
    }

    /// Nothing is buffered here. Waiting until all is read would block if nobody reads.
    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}
