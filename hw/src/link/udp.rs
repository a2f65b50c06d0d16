//! Datagrams to and from one device.

use super::TransportError;
use super::transport::Transport;
use core::time::Duration;
use std::io::{Error, ErrorKind};
use std::net::{Ipv4Addr, Ipv6Addr, SocketAddr, ToSocketAddrs, UdpSocket};
use std::time::Instant;

/// Size of the receive buffer that is requested from the system, bytes. Linux gives less unless told otherwise
/// (`net.core.rmem_max`), and counts some 0.8 KiB for a small datagram.
const ROOM: usize = 4 << 20;

/// The longest datagram there can be.
const LONGEST: usize = 65_535;

/// Datagrams to and from one device. What others send is left out and counted, and so are empty datagrams; of one longer
/// than the buffer comes its beginning, with its true length.
///
/// If a name has several addresses, the first one of IPv4 is used, which these devices speak, else the first one.
///
/// ```
/// use rod_hw::{Transport, Udp};
/// use std::{net::UdpSocket, time::Duration};
/// let device = UdpSocket::bind("127.0.0.1:0")?;
/// let mut udp = Udp::connect(&device.local_addr()?.to_string())?;
/// udp.send(b"start")?;
/// let (_, host) = device.recv_from(&mut [0; 16])?;
/// device.send_to(b"data", host)?;
/// let mut buffer = [0; 16];
/// assert_eq!(udp.receive(&mut buffer, Duration::from_secs(1))?, Some(4));
/// assert_eq!(&buffer[..4], b"data");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Udp {
    socket: UdpSocket,
    peer: SocketAddr,
    foreign: u64,
    /// As the socket has it: setting it anew for each datagram would double the calls of the system.
    wait: Option<Duration>,
    datagram: Box<[u8]>,
}

impl Udp {
    /// To `host:port`, a name or an address. That there is a device is not known before it answers.
    ///
    /// # Errors
    /// [`TransportError`].
    pub fn connect(host: &str) -> Result<Self, TransportError> {
        let failed = |cause| TransportError::Address { host: host.into(), cause };
        let addresses: Vec<SocketAddr> = host.to_socket_addrs().map_err(failed)?.collect();
        let version_4 = addresses.iter().find(|address| address.is_ipv4());
        match version_4.or(addresses.first()) {
            Some(&peer) => {
                let socket = Self::socket(peer)?;
                Ok(Self { socket, peer, foreign: 0, wait: None, datagram: vec![0; LONGEST].into() })
            }
            None => Err(failed(ErrorKind::AddrNotAvailable.into())),
        }
    }

    /// Not connected by the system, which would leave out what others send without counting.
    fn socket(peer: SocketAddr) -> Result<UdpSocket, TransportError> {
        let any = match peer {
            SocketAddr::V4(_) => SocketAddr::from((Ipv4Addr::UNSPECIFIED, 0)),
            SocketAddr::V6(_) => SocketAddr::from((Ipv6Addr::UNSPECIFIED, 0)),
        };
        let socket = UdpSocket::bind(any).map_err(|cause| TransportError::Socket { peer, cause })?;
        // more room is welcome, less will do
        let _ = socket2::SockRef::from(&socket).set_recv_buffer_size(ROOM);
        Ok(socket)
    }

    /// The device.
    pub fn peer(&self) -> SocketAddr {
        self.peer
    }

    fn broken(&self, cause: Error) -> TransportError {
        TransportError::UdpBroken { peer: self.peer, cause }
    }
}

impl core::fmt::Debug for Udp {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Udp").field("peer", &self.peer).field("foreign", &self.foreign).finish_non_exhaustive()
    }
}

impl Transport for Udp {
    type Error = TransportError;

    fn send(&mut self, bytes: &[u8]) -> Result<(), TransportError> {
        self.socket.send_to(bytes, self.peer).map(drop).map_err(|cause| self.broken(cause))
    }

    fn receive(&mut self, buffer: &mut [u8], wait: Duration) -> Result<Option<usize>, TransportError> {
        let since = Instant::now();
        // 0 would mean for ever
        let mut left = wait.max(Duration::from_micros(1));
        loop {
            if self.wait != Some(left) {
                self.socket.set_read_timeout(Some(left)).map_err(|cause| self.broken(cause))?;
                self.wait = Some(left);
            }
            match self.socket.recv_from(&mut self.datagram) {
                Ok((count @ 1.., from)) if from.ip() == self.peer.ip() && from.port() == self.peer.port() => {
                    let fits = count.min(buffer.len());
                    buffer[..fits].copy_from_slice(&self.datagram[..fits]);
                    return Ok(Some(count));
                }
                Ok(_) => self.foreign += 1,
                Err(cause) => match cause.kind() {
                    ErrorKind::WouldBlock | ErrorKind::TimedOut => return Ok(None),
                    // nobody listens at the other end (yet), which Windows tells here
                    ErrorKind::Interrupted | ErrorKind::ConnectionReset | ErrorKind::ConnectionRefused => {}
                    _ => return Err(self.broken(cause)),
                },
            }
            // a flood from elsewhere must not hold it up
            left = wait.saturating_sub(since.elapsed());
            if left.is_zero() {
                return Ok(None);
            }
        }
    }

    fn reconnect(&mut self) -> Result<(), TransportError> {
        self.socket = Self::socket(self.peer)?;
        self.wait = None;
        Ok(())
    }

    fn foreign(&self) -> u64 {
        self.foreign
    }
}
