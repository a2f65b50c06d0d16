//! A simulated sensor.

mod account;
mod pace;
mod requests;
mod settings;
mod stream;

pub use account::FakeRdtAccount;
pub use settings::{FakeRdtSettings, RdtFault};

use account::Shared;
use rod_hw::device::rdt::RdtRecord;
use std::io::Error;
use std::net::{SocketAddr, TcpListener, UdpSocket};
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

/// How long to wait for a source of samples that blocks, on the way out.
const PATIENCE: Duration = Duration::from_secs(1);

/// A sensor that is none: an RDT server over UDP with the scaling over TCP, in threads of its own, which does what a real one
/// does and, where told so, goes wrong as a real one does. It keeps account of what it did. Dropped, it is gone from the
/// network.
///
/// ```
/// use rod_fake_sensor::{FakeRdt, FakeRdtSettings, RdtFault};
/// use rod_hw::device::rdt::{Rdt, RdtProfile, RdtSettings, read_scaling};
/// use rod_hw::{HostClock, Link, LinkSettings, Quality, Udp};
///
/// // 50 samples at 1000 a second, of which the fourth and fifth get lost
/// let settings = FakeRdtSettings { faults: vec![(3, RdtFault::Drop(2))], ..FakeRdtSettings::default() };
/// let fake = FakeRdt::start(settings, (0..50).map(|i| [i, -i, 300, 10, -20, 30]))?;
///
/// let scaling = read_scaling(&fake.scaling_address().ok_or("no TCP")?.to_string(), std::time::Duration::from_secs(5))?;
/// assert_eq!(scaling.counts_per_force, 1e6);
/// let udp = Udp::connect(&fake.address().to_string())?;
/// let link = Link::new(udp, Rdt::new(RdtSettings::new(RdtProfile::NetFt)), HostClock::new(), LinkSettings::default());
/// let samples = link.take(5).collect::<Result<Vec<_>, _>>()?;
/// assert_eq!(samples[4].channels[0], 6.0);
/// assert_eq!(samples[3].quality, Quality::GAP_BEFORE);
/// assert_eq!(fake.account().dropped, 2);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct FakeRdt {
    shared: Arc<Shared>,
    address: SocketAddr,
    scaling_address: Option<SocketAddr>,
    stream: Option<JoinHandle<()>>,
    servers: Vec<JoinHandle<()>>,
}

impl FakeRdt {
    /// Goes on the network and waits to be started. Each time that a record is due the next of the samples is asked for:
    /// counts of Fx to Tz, or records, of which counts and status are taken. They may block, as samples of something live do;
    /// after the last one nothing is sent any more.
    ///
    /// # Errors
    /// Where an address cannot be had, mostly because it is taken.
    pub fn start<I>(settings: FakeRdtSettings, samples: I) -> Result<Self, Error>
    where
        I: IntoIterator<Item: Into<RdtRecord>, IntoIter: Send + 'static>,
    {
        let socket = UdpSocket::bind(settings.address)?;
        let foreign = UdpSocket::bind(SocketAddr::new(settings.address.ip(), 0))?;
        let listener = settings.scaling_address.map(TcpListener::bind).transpose()?;
        let address = socket.local_addr()?;
        let scaling_address = listener.as_ref().map(TcpListener::local_addr).transpose()?;
        let shared = Arc::new(Shared::new(&settings));
        let mut servers = Vec::new();
        servers.push({
            let (shared, socket) = (Arc::clone(&shared), socket.try_clone()?);
            thread::Builder::new().name("fake RDT requests".into()).spawn(move || {
                requests::serve_udp(&shared, &socket);
            })?
        });
        // dropped on the way out, it takes along what runs already
        let mut fake = Self { shared, address, scaling_address, stream: None, servers };
        if let Some(listener) = listener {
            let (shared, scaling) = (Arc::clone(&fake.shared), settings.scaling);
            fake.servers.push(thread::Builder::new().name("fake RDT scaling".into()).spawn(move || {
                requests::serve_tcp(&shared, &listener, &scaling);
            })?);
        }
        let (shared, samples) = (Arc::clone(&fake.shared), samples.into_iter());
        fake.stream = Some(thread::Builder::new().name("fake RDT stream".into()).spawn(move || {
            stream::Stream::new(&shared, &settings, socket, foreign).run(samples.map(Into::into));
        })?);
        Ok(fake)
    }

    /// Where it listens for requests.
    pub fn address(&self) -> SocketAddr {
        self.address
    }

    /// Where it tells its scaling over TCP.
    pub fn scaling_address(&self) -> Option<SocketAddr> {
        self.scaling_address
    }

    /// The account so far.
    pub fn account(&self) -> FakeRdtAccount {
        self.shared.lock().account
    }

    /// Whether all samples are sent.
    pub fn ended(&self) -> bool {
        self.stream.as_ref().is_none_or(JoinHandle::is_finished)
    }
}

impl Drop for FakeRdt {
    fn drop(&mut self) {
        self.shared.stop.store(true, Ordering::Relaxed);
        self.shared.changed.notify_all();
        let since = Instant::now();
        while !self.ended() && since.elapsed() < PATIENCE {
            thread::sleep(Duration::from_millis(1));
        }
        // a source that blocks for longer is left to itself: its thread ends with the next sample
        let stream = self.stream.take().filter(JoinHandle::is_finished);
        for thread in self.servers.drain(..).chain(stream) {
            // that it panicked, in the iterator of the user, has been told
            let _ = thread.join();
        }
    }
}
