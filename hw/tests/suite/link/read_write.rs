//! Streams as transports.

use rod_hw::*;
use std::io::{self, ErrorKind, Read, Write};
use std::time::{Duration, Instant};

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
    let mut transport = ReadWrite::new(Scripted(steps));
    let (mut buffer, wait) = ([0; 8], Duration::from_secs(5));
    assert_eq!(transport.receive(&mut buffer, wait).unwrap(), Some(3));
    assert_eq!(transport.receive(&mut buffer, wait).unwrap_err().kind(), ErrorKind::UnexpectedEof);
    let since = Instant::now();
    assert_eq!(transport.receive(&mut buffer, Duration::from_millis(20)).unwrap(), None);
    assert!(since.elapsed() >= Duration::from_millis(20));
    assert_eq!(transport.reconnect().unwrap_err().kind(), ErrorKind::Unsupported);
}

#[test]
fn writes_all_in_pieces() {
    let steps = vec![Ok(1), Err(ErrorKind::WouldBlock.into()), Ok(3)];
    ReadWrite::new(Scripted(steps)).send(&[1, 2, 3, 4]).unwrap();
    let broken = ReadWrite::new(Scripted(vec![Err(ErrorKind::BrokenPipe.into())])).send(&[1]);
    assert_eq!(broken.unwrap_err().kind(), ErrorKind::BrokenPipe);
    let stuck = ReadWrite::new(Scripted(vec![Ok(1)])).send(&[1, 2]);
    assert_eq!(stuck.unwrap_err().kind(), ErrorKind::WouldBlock, "not for ever");
}

#[test]
fn opened_again() {
    let mut streams = vec![Err(ErrorKind::NotFound), Ok(vec![Ok(2)]), Ok(vec![Ok(0)])];
    let open = || streams.pop().unwrap().map(Scripted).map_err(io::Error::from);
    let mut transport = ReadWrite::reopened(open).unwrap();
    let (mut buffer, wait) = ([0; 8], Duration::ZERO);
    assert_eq!(transport.receive(&mut buffer, wait).unwrap_err().kind(), ErrorKind::UnexpectedEof);
    transport.reconnect().unwrap();
    assert_eq!(transport.receive(&mut buffer, wait).unwrap(), Some(2));
    assert_eq!(transport.reconnect().unwrap_err().kind(), ErrorKind::NotFound);
    assert_eq!(transport.receive(&mut buffer, wait).unwrap_err().kind(), ErrorKind::NotConnected);
}
