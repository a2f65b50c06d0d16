//! The requests to a fake sensor.

use super::account::{Shared, State};
use rod_hw::device::rdt::{RdtRequest, RdtScaling};
use std::io::{ErrorKind, Read, Write};
use std::net::{SocketAddr, TcpListener, TcpStream, UdpSocket};
use std::sync::atomic::Ordering;
use std::thread;
use std::time::{Duration, Instant};

/// How soon it notices that it is to end.
const TICK: Duration = Duration::from_millis(20);

/// Real ones hang up after so long without a request.
const IDLE: Duration = Duration::from_secs(1);

/// Listens for requests until told to end.
pub(super) fn serve_udp(shared: &Shared, socket: &UdpSocket) {
    let mut bytes = [0; 64];
    while !shared.stop.load(Ordering::Relaxed) {
        // without a time limit it would never look up: then rather none of it
        if socket.set_read_timeout(Some(TICK)).is_err() {
            return;
        }
        let Ok((count, from)) = socket.recv_from(&mut bytes) else { continue };
        shared.lock().answer(RdtRequest::from_bytes(&bytes[..count]), from);
        shared.changed.notify_all();
    }
}

impl State {
    /// Does what it is asked.
    fn answer(&mut self, request: Option<RdtRequest>, from: SocketAddr) {
        use RdtRequest::{Start, Stop};
        let account = &mut self.account;
        match request {
            _ if self.off => account.ignored += 1,
            Some(Start { .. }) if self.to_ignore > 0 => {
                self.to_ignore -= 1;
                account.ignored += 1;
            }
            Some(Start { count }) => {
                account.starts += 1;
                self.start += 1;
                self.client = Some(from);
                self.left = Some(count).filter(|count| *count > 0);
            }
            Some(Stop) => {
                account.stops += 1;
                self.client = None;
            }
            None => account.unknown += 1,
        }
    }
}

/// Listens for connections until told to end.
pub(super) fn serve_tcp(shared: &Shared, listener: &TcpListener, scaling: &RdtScaling) {
    if listener.set_nonblocking(true).is_err() {
        return;
    }
    while !shared.stop.load(Ordering::Relaxed) {
        match listener.accept() {
            // one at a time, as with OptoForce's
            Ok((stream, _)) => drop(serve(shared, stream, scaling)),
            Err(_) => thread::sleep(TICK),
        }
    }
}

/// Answers requests of 20 bytes until the other side hangs up or asks nothing for long.
fn serve(shared: &Shared, mut stream: TcpStream, scaling: &RdtScaling) -> Result<(), std::io::Error> {
    stream.set_nonblocking(false)?;
    stream.set_read_timeout(Some(TICK))?;
    let (mut request, mut count, mut since) = ([0; 20], 0, Instant::now());
    while !shared.stop.load(Ordering::Relaxed) && since.elapsed() < IDLE {
        match stream.read(&mut request[count..]) {
            Ok(0) => break,
            Ok(more) => count += more,
            Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => {}
            Err(error) => return Err(error),
        }
        if count == request.len() {
            (count, since) = (0, Instant::now());
            let mut state = shared.lock();
            if state.off {
                return Ok(());
            }
            if request[0] != 1 {
                return Ok(());
            }
            stream.write_all(&scaling.to_bytes())?;
            state.account.answers += 1;
        }
    }
    Ok(())
}
