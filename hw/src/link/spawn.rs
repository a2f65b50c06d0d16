//! Samples read by a separate thread.

use super::clock::Clock;
use super::counters::LinkCounters;
use super::protocol::Protocol;
use super::protocol_link::{Link, LinkError};
use super::transport::Transport;
use crate::sample::{Quality, RawSample};
use std::io::Error;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, TrySendError, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{Builder, JoinHandle};

/// Samples of a link that a separate thread reads, as an iterator: made by [`spawn`].
///
/// Dropped, it tells the device to stop and waits for the thread, for at most the deadline of the link.
#[derive(Debug)]
pub struct Spawned<E> {
    samples: Receiver<Result<RawSample, LinkError<E>>>,
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
}

#[derive(Debug, Default)]
struct Shared {
    stop: AtomicBool,
    counters: Mutex<LinkCounters>,
}

/// Reads a link in a separate thread, so that a consumer that is busy at times loses nothing: up to `capacity` samples wait
/// for it. Their [`host_time`](RawSample::host_time) is that of their arrival.
///
/// If more samples would have to wait, the newest are discarded and counted as [`untaken`](LinkCounters::untaken); the next
/// sample has [`Quality::GAP_BEFORE`], and [`Quality::RESTARTED`] if a discarded one had it. At 7000 samples a
/// second, 70 000 are 10 s and 18 MB at most.
///
/// ```
/// # #[cfg(feature = "rdt")] {
/// use rod_fake_sensor::{FakeRdt, FakeRdtSettings};
/// use rod_hw::device::rdt::{Rdt, RdtProfile, RdtSettings};
/// use rod_hw::{HostClock, Link, LinkSettings, Udp, spawn};
/// let fake = FakeRdt::start(FakeRdtSettings::default(), [[1, 2, 3, 4, 5, 6]; 100])?;
/// let udp = Udp::connect(&fake.address().to_string())?;
/// let link = Link::new(udp, Rdt::new(RdtSettings::new(RdtProfile::NetFt)), HostClock::new(), LinkSettings::default());
/// let mut sensor = spawn(link, 1000)?;
/// std::thread::sleep(std::time::Duration::from_millis(50)); // busy
/// let samples = sensor.by_ref().take(100).collect::<Result<Vec<_>, _>>()?;
/// assert_eq!(samples.len(), 100);
/// assert_eq!(sensor.counters().lost + sensor.counters().untaken, 0);
/// # }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// If the system cannot start a thread.
pub fn spawn<T, P, C>(link: Link<T, P, C>, capacity: usize) -> Result<Spawned<T::Error>, Error>
where
    T: Transport<Error: Send> + Send + 'static,
    P: Protocol + Send + 'static,
    C: Clock + Send + 'static,
{
    let (sender, samples) = sync_channel(capacity.max(1));
    let shared = Arc::new(Shared::default());
    let theirs = Arc::clone(&shared);
    let thread = Builder::new().name("sensor".into()).spawn(move || read(link, &sender, &theirs))?;
    Ok(Spawned { samples, shared, thread: Some(thread) })
}

/// Reads until told to stop, or the link ends.
fn read<T, P, C>(mut link: Link<T, P, C>, sender: &SyncSender<Result<RawSample, LinkError<T::Error>>>, shared: &Shared)
where
    T: Transport,
    P: Protocol,
    C: Clock,
{
    let mut untaken = 0;
    // of those that were thrown away
    let mut flags = Quality::empty();
    while !shared.stop.load(Ordering::Relaxed) {
        let Some(mut item) = link.next() else { break };
        if let Ok(sample) = &mut item {
            sample.quality |= flags;
        }
        let full = match sender.try_send(item) {
            Ok(()) => None,
            Err(TrySendError::Full(item)) => Some(item),
            Err(TrySendError::Disconnected(_)) => break,
        };
        match full {
            None => flags = Quality::empty(),
            Some(Ok(sample)) => {
                untaken += 1;
                flags |= Quality::GAP_BEFORE | (sample.quality & Quality::RESTARTED);
            }
            // an error that nobody takes is over by the time that somebody does
            Some(Err(_)) => {}
        }
        *shared.counters.lock().unwrap_or_else(PoisonError::into_inner) = LinkCounters { untaken, ..link.counters() };
    }
    // a device that cannot be told is gone already
    let _ = link.stop();
}

impl<E> Spawned<E> {
    /// The counters of received and lost samples.
    pub fn counters(&self) -> LinkCounters {
        *self.shared.counters.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl<E> Iterator for Spawned<E> {
    type Item = Result<RawSample, LinkError<E>>;

    /// The next sample, which the link answers for within its deadline.
    fn next(&mut self) -> Option<Self::Item> {
        self.samples.recv().ok()
    }
}

impl<E> Drop for Spawned<E> {
    fn drop(&mut self) {
        self.shared.stop.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            // that it panicked has been told
            let _ = thread.join();
        }
    }
}
