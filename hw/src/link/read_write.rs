//! Anything that reads and writes, as a transport.

use super::transport::Transport;
use std::io::{self, ErrorKind, Read, Write};
use std::time::{Duration, Instant};

/// How long to go on trying to write a request before that is an error: what a link's deadline may be exceeded by.
const PATIENCE: Duration = Duration::from_millis(200);

/// How long to sleep between reads of what does not wait by itself.
const NAP: Duration = Duration::from_millis(1);

/// A stream that reads and writes, as a [`Transport`]: a TCP connection, a pipe, a simulated device.
///
/// Reads that find nothing must come back, with [`WouldBlock`](ErrorKind::WouldBlock) or [`TimedOut`](ErrorKind::TimedOut),
/// for only then a link's deadline holds: set a read timeout, about 0.01 s, or non-blocking mode. A read of nothing at all
/// (`Ok(0)`) is the end: the other side closed the connection. A request that cannot be written within 0.2 s is an error, too.
///
/// ```
/// use rod_hw::device::framed::{Bota, Framed};
/// use rod_hw::{HostClock, Link, LinkError, LinkSettings, ReadWrite};
/// use std::net::{TcpListener, TcpStream};
/// use std::time::Duration;
/// let listener = TcpListener::bind("127.0.0.1:0")?; // a converter from serial to Ethernet
/// let address = listener.local_addr()?;
/// let open = move || {
///     let stream = TcpStream::connect(address)?;
///     stream.set_read_timeout(Some(Duration::from_millis(10)))?;
///     Ok(stream)
/// };
/// let transport = ReadWrite::reopened(open)?;
/// let settings = LinkSettings { deadline: 0.05, ..LinkSettings::default() };
/// let mut link = Link::new(transport, Framed::new(Bota), HostClock::new(), settings);
/// assert!(matches!(link.next(), Some(Err(LinkError::Timeout { .. })))); // it sends nothing
/// # Ok::<(), std::io::Error>(())
/// ```
#[derive(Debug)]
pub struct ReadWrite<RW, F = fn() -> io::Result<RW>> {
    stream: Option<RW>,
    open: Option<F>,
}

impl<RW: Read + Write> ReadWrite<RW> {
    /// This stream, which is not made anew when it breaks.
    pub fn new(stream: RW) -> Self {
        Self { stream: Some(stream), open: None }
    }
}

impl<RW: Read + Write, F: FnMut() -> io::Result<RW>> ReadWrite<RW, F> {
    /// What this opens, again where the connection breaks.
    ///
    /// # Errors
    /// What it reports the first time.
    pub fn reopened(mut open: F) -> io::Result<Self> {
        Ok(Self { stream: Some(open()?), open: Some(open) })
    }
}

impl<RW: Read + Write, F: FnMut() -> io::Result<RW>> Transport for ReadWrite<RW, F> {
    type Error = io::Error;

    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        send(self.stream.as_mut().ok_or_else(not_open)?, bytes)
    }

    fn receive(&mut self, buffer: &mut [u8], wait: Duration) -> io::Result<Option<usize>> {
        receive(self.stream.as_mut().ok_or_else(not_open)?, buffer, wait)
    }

    fn reconnect(&mut self) -> io::Result<()> {
        let message = "this stream cannot be opened again; expected one made by ReadWrite::reopened";
        let open = self.open.as_mut().ok_or_else(|| io::Error::new(ErrorKind::Unsupported, message))?;
        // closed before it is opened: a device may serve one at a time
        self.stream = None;
        self.stream = Some(open()?);
        Ok(())
    }
}

fn not_open() -> io::Error {
    io::Error::new(ErrorKind::NotConnected, "the stream is closed and could not be opened again")
}

/// Whether there was just nothing to read, or no room to write.
pub(crate) fn is_idle(error: &io::Error) -> bool {
    matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted)
}

/// Sends all bytes.
pub(crate) fn send(stream: &mut impl Write, mut bytes: &[u8]) -> io::Result<()> {
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
pub(crate) fn receive(stream: &mut impl Read, buffer: &mut [u8], wait: Duration) -> io::Result<Option<usize>> {
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
