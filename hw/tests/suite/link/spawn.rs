//! Samples read in a thread of their own.

use rod_hw::*;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

/// So many samples at once, then broken.
struct Burst(u64, Arc<AtomicU64>);

impl Transport for Burst {
    type Error = &'static str;
    fn send(&mut self, bytes: &[u8]) -> Result<(), &'static str> {
        self.1.fetch_add(u64::from(bytes == [9]), Ordering::SeqCst);
        Ok(())
    }
    fn receive(&mut self, buffer: &mut [u8], _: Duration) -> Result<Option<usize>, &'static str> {
        self.0 = self.0.checked_sub(1).ok_or("end")?;
        buffer[0] = 1;
        Ok(Some(1))
    }
    fn reconnect(&mut self) -> Result<(), &'static str> {
        Err("end")
    }
}

/// Numbers what comes; the fifth one is the first after a restart.
#[derive(Default)]
struct Numbers(LinkCounters);

impl Protocol for Numbers {
    fn decode(&mut self, bytes: &mut &[u8], now: f64) -> Option<Result<RawSample, FrameFault>> {
        if core::mem::take(bytes).is_empty() {
            return None;
        }
        self.0.samples += 1;
        let quality = if self.0.samples == 5 { Quality::RESTARTED } else { Quality::empty() };
        Some(Ok(RawSample { sequence: Some(self.0.samples), quality, ..RawSample::new(now, Channels::default()) }))
    }
    fn farewell(&self) -> Option<Request> {
        Some([9].into())
    }
    fn reset(&mut self) {}
    fn counters(&self) -> LinkCounters {
        self.0
    }
}

fn start(count: u64, capacity: usize) -> (Spawned<&'static str>, Arc<AtomicU64>) {
    let farewells = Arc::new(AtomicU64::new(0));
    let settings = LinkSettings { reconnect: Reconnect::Never, ..LinkSettings::default() };
    let link = Link::new(Burst(count, Arc::clone(&farewells)), Numbers::default(), HostClock::new(), settings);
    (spawn(link, capacity).unwrap(), farewells)
}

#[test]
fn nothing_lost_while_the_consumer_is_busy() {
    let (mut spawned, farewells) = start(1000, 2000);
    while spawned.counters().samples < 1000 {
        std::thread::sleep(Duration::from_millis(1));
    }
    let numbers: Vec<u64> = spawned.by_ref().map_while(|item| item.ok()?.sequence).collect();
    assert_eq!(numbers, (1..=1000).collect::<Vec<_>>());
    assert_eq!((spawned.counters().untaken, spawned.next()), (0, None));
    assert_eq!(farewells.load(Ordering::SeqCst), 1);
}

#[test]
fn what_nobody_takes_is_counted_and_flagged() {
    let (mut spawned, _) = start(10, 4);
    while spawned.counters().untaken < 6 {
        std::thread::sleep(Duration::from_millis(1));
    }
    let taken: Vec<u64> = spawned.by_ref().map_while(|item| item.ok()?.sequence).collect();
    assert_eq!((taken, spawned.counters().untaken), (vec![1, 2, 3, 4], 6));
}

#[test]
fn the_next_one_tells_of_the_gap() {
    // the transport waits for the consumer after the tenth
    struct Gate(Burst, std::sync::mpsc::Receiver<()>);
    impl Transport for Gate {
        type Error = &'static str;
        fn send(&mut self, bytes: &[u8]) -> Result<(), &'static str> {
            self.0.send(bytes)
        }
        fn receive(&mut self, buffer: &mut [u8], wait: Duration) -> Result<Option<usize>, &'static str> {
            if self.0.0 == 1 {
                self.1.recv().map_err(|_| "end")?;
            }
            self.0.receive(buffer, wait)
        }
        fn reconnect(&mut self) -> Result<(), &'static str> {
            Err("end")
        }
    }
    let (open, gate) = std::sync::mpsc::channel();
    let settings = LinkSettings { reconnect: Reconnect::Never, ..LinkSettings::default() };
    let transport = Gate(Burst(11, Arc::default()), gate);
    let mut spawned = spawn(Link::new(transport, Numbers::default(), HostClock::new(), settings), 3).unwrap();
    while spawned.counters().samples < 10 {
        std::thread::sleep(Duration::from_millis(1));
    }
    assert_eq!(spawned.by_ref().take(3).count(), 3);
    open.send(()).unwrap();
    let next = spawned.next().unwrap().unwrap();
    assert_eq!((next.sequence, next.quality), (Some(11), Quality::GAP_BEFORE | Quality::RESTARTED));
    assert_eq!(spawned.counters().untaken, 7);
}
