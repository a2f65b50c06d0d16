//! Streams that may have nothing to read, or no room to write, for a while.

use std::io::{self, ErrorKind, Read, Write};
use std::time::{Duration, Instant};

/// How long to try to write a request before that is an error: a link may exceed its deadline by this.
const PATIENCE: Duration = Duration::from_millis(200);

/// How long to sleep between reads of what does not wait by itself.
const NAP: Duration = Duration::from_millis(1);

/// Whether there was just nothing to read, or no room to write.
fn is_idle(error: &io::Error) -> bool {
    matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted)
}

/// Sends all bytes.
pub(super) fn send(stream: &mut impl Write, mut bytes: &[u8]) -> io::Result<()> {
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
pub(super) fn receive(stream: &mut impl Read, buffer: &mut [u8], wait: Duration) -> io::Result<Option<usize>> {
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
