//! A serial port by path.

use super::TransportError;
use super::transport::Transport;
use std::io::{self, ErrorKind, Read, Write};
use std::time::{Duration, Instant};

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
        let closed = || io::Error::new(ErrorKind::NotConnected, "it is closed");
        let done = self.port.as_mut().ok_or_else(closed).and_then(|port| f(port.as_mut()));
        done.map_err(|source| TransportError::SerialBroken { path: self.path.clone(), source })
    }
}

impl Transport for SerialPort {
    type Error = TransportError;

    fn send(&mut self, mut bytes: &[u8]) -> Result<(), TransportError> {
        self.with(|mut port| send(&mut port, std::mem::take(&mut bytes)))
    }

    fn receive(&mut self, buffer: &mut [u8], wait: Duration) -> Result<Option<usize>, TransportError> {
        self.with(|mut port| {
            port.set_timeout(wait)?;
            receive(&mut port, buffer, wait)
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

/// How long to try to write a request before that is an error: a link may exceed its deadline by this.
const PATIENCE: Duration = Duration::from_millis(200);

/// How long to sleep between reads of what does not wait by itself.
const NAP: Duration = Duration::from_millis(1);

/// Whether there was just nothing to read, or no room to write.
fn is_idle(error: &io::Error) -> bool {
    matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted)
}

/// Sends all bytes.
fn send(stream: &mut impl Write, mut bytes: &[u8]) -> io::Result<()> {
    let until = Instant::now() + PATIENCE;
    while !bytes.is_empty() {
        match stream.write(bytes) {
            Ok(0) => return Err(ErrorKind::WriteZero.into()),
            Ok(count) => bytes = bytes.get(count..).unwrap_or_default(),
            Err(error) if is_idle(&error) && Instant::now() < until => std::thread::sleep(NAP),
            Err(error) => return Err(error),
        }
    }
    Ok(())
}

/// Receives what comes in time.
fn receive(stream: &mut impl Read, buffer: &mut [u8], wait: Duration) -> io::Result<Option<usize>> {
    let until = Instant::now() + wait;
    loop {
        match stream.read(buffer) {
            Ok(0) => return Err(io::Error::new(ErrorKind::UnexpectedEof, "the other side closed the connection")),
            Ok(count) => return Ok(Some(count)),
            Err(error) if is_idle(&error) => {}
            Err(error) => return Err(error),
        }
        let left = until.saturating_duration_since(Instant::now());
        if left.is_zero() {
            return Ok(None);
        }
        std::thread::sleep(left.min(NAP));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Reads and writes as it is told to.
    struct Scripted(Vec<io::Result<usize>>);

    impl Scripted {
        fn step(&mut self) -> io::Result<usize> {
            if self.0.is_empty() { Err(ErrorKind::WouldBlock.into()) } else { self.0.remove(0) }
        }
    }

    impl Read for Scripted {
        fn read(&mut self, _: &mut [u8]) -> io::Result<usize> {
            self.step()
        }
    }

    impl Write for Scripted {
        fn write(&mut self, _: &[u8]) -> io::Result<usize> {
            self.step()
        }
        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn nothing_is_not_the_end_and_the_end_is_an_error() {
        let steps = vec![Err(ErrorKind::TimedOut.into()), Err(ErrorKind::Interrupted.into()), Ok(3), Ok(0)];
        let mut stream = Scripted(steps);
        let (mut buffer, wait) = ([0; 8], Duration::from_secs(5));
        assert_eq!(receive(&mut stream, &mut buffer, wait).unwrap(), Some(3));
        assert_eq!(receive(&mut stream, &mut buffer, wait).unwrap_err().kind(), ErrorKind::UnexpectedEof);
        let since = Instant::now();
        assert_eq!(receive(&mut stream, &mut buffer, Duration::from_millis(20)).unwrap(), None);
        assert!(since.elapsed() >= Duration::from_millis(20));
    }

    #[test]
    fn writes_all_in_pieces() {
        let steps = vec![Ok(1), Err(ErrorKind::WouldBlock.into()), Ok(3)];
        send(&mut Scripted(steps), &[1, 2, 3, 4]).unwrap();
        let broken = send(&mut Scripted(vec![Err(ErrorKind::BrokenPipe.into())]), &[1]);
        assert_eq!(broken.unwrap_err().kind(), ErrorKind::BrokenPipe);
        let stuck = send(&mut Scripted(vec![Ok(1)]), &[1, 2]);
        assert_eq!(stuck.unwrap_err().kind(), ErrorKind::WouldBlock, "not for ever");
    }
}
