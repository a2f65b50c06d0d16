//! The stream of an RDT sensor, record by record.

use proptest::prelude::*;
use rod_hw::device::rdt::*;
use rod_hw::*;

/// A stream that is running, and what it makes of packet and sample numbers at 1 ms.
struct Bench(Rdt, f64);

impl Bench {
    fn new(settings: RdtSettings) -> Self {
        let mut rdt = Rdt::new(settings);
        assert!(rdt.request(0.0).is_some());
        Self(rdt, 0.0)
    }

    fn put(&mut self, packet: u32, sample: u32) -> Option<RawSample> {
        self.1 += 1e-3;
        let bytes = RdtRecord { packet, sample, ..RdtRecord::default() }.to_bytes();
        self.0.decode(&mut &bytes[..], self.1).map(Result::unwrap)
    }

    /// Numbers of the samples handed on, and their flags.
    fn all(&mut self, records: &[(u32, u32)]) -> Vec<(u64, Quality)> {
        let taken = records.iter().filter_map(|&(packet, sample)| self.put(packet, sample));
        taken.map(|raw| (raw.sequence.unwrap(), raw.quality)).collect()
    }
}

fn net_ft() -> RdtSettings {
    RdtSettings::new(RdtProfile::NetFt)
}

const GOOD: Quality = Quality::empty();
const GAP: Quality = Quality::GAP_BEFORE;

#[test]
fn a_late_record_is_not_four_billion_lost() {
    let mut bench = Bench::new(net_ft());
    let taken = bench.all(&[(1, 10), (3, 30), (2, 20), (4, 40), (4, 40), (5, 50)]);
    assert_eq!(taken, [(10, GOOD), (30, GAP), (40, GOOD), (50, GOOD)]);
    let LinkCounters { samples, lost, gaps, reordered, repeated, restarts, .. } = bench.0.counters();
    assert_eq!((samples, lost, gaps, reordered, repeated, restarts), (4, 1, 1, 1, 1, 0));
}

#[test]
fn records_overtaken_together_are_no_restart() {
    let mut bench = Bench::new(net_ft());
    let taken = bench.all(&[(10, 10), (14, 14), (11, 11), (12, 12), (13, 13), (15, 15)]);
    assert_eq!(taken, [(10, GOOD), (14, GAP), (15, GOOD)]);
    let counters = bench.0.counters();
    assert_eq!((counters.lost, counters.reordered, counters.restarts), (3, 3, 0));
}

#[test]
fn one_more_start_is_no_loss() {
    let mut bench = Bench::new(net_ft());
    let taken = bench.all(&[(1, 7), (2, 14), (3, 21), (1, 28), (2, 35), (3, 42)]);
    assert_eq!(taken.iter().map(|(number, _)| *number).collect::<Vec<_>>(), [7, 14, 21, 28, 35, 42]);
    assert!(taken.iter().all(|(_, quality)| quality.is_empty()));
    // the first record of either start has number 1
    let mut bench = Bench::new(net_ft());
    assert_eq!(bench.all(&[(1, 7), (1, 70)]), [(7, GOOD), (70, GAP)]);
    assert_eq!(bench.0.counters().lost + bench.0.counters().repeated, 0);
}

#[test]
fn a_stalled_sensor_repeats_its_sample() {
    let mut bench = Bench::new(net_ft());
    assert_eq!(bench.all(&[(1, 7), (2, 7), (4, 7), (5, 14)]), [(7, GOOD), (14, GAP)]);
    assert_eq!((bench.0.counters().repeated, bench.0.counters().lost), (2, 1));
}

#[test]
fn a_device_that_counts_anew() {
    let restarted = Quality::RESTARTED | GAP;
    // its packets go on
    let mut bench = Bench::new(net_ft());
    let taken = bench.all(&[(1, 90_000), (2, 90_001), (3, 1), (4, 2), (5, 3)]);
    assert_eq!(taken, [(90_000, GOOD), (90_001, GOOD), (90_002, restarted), (90_003, GOOD)]);
    assert_eq!((bench.0.counters().restarts, bench.0.counters().lost, bench.0.counters().reordered), (1, 1, 1));
    // they begin anew, too
    let mut bench = Bench::new(net_ft());
    assert_eq!(bench.all(&[(5000, 90_000), (1, 1), (2, 2)]), [(90_000, GOOD), (90_001, restarted)]);
}

#[test]
fn counters_wrap() {
    let mut bench = Bench::new(RdtSettings { clock_rate: Some(1.0), ..net_ft() });
    let taken = bench.all(&[(u32::MAX, u32::MAX - 1), (0, u32::MAX), (1, 0), (3, 2)]);
    let from = u64::from(u32::MAX) - 1;
    assert_eq!(taken, [(from, GOOD), (from + 1, GOOD), (from + 2, GOOD), (from + 4, GAP)]);
    assert_eq!(bench.0.counters().lost, 1);
    // 16 bits of OnRobot
    let mut bench = Bench::new(RdtSettings::new(RdtProfile::OnRobot));
    assert_eq!(bench.all(&[(1, 65_535), (2, 0), (3, 65_537)]), [(65_535, GOOD), (65_536, GOOD), (65_537, GOOD)]);
}

#[test]
fn started_until_data_comes_and_after_a_silence() {
    let commands = |rdt: &mut Rdt, from: f64, to: f64| -> Vec<u8> {
        let times = (0..).map(|i| from + 0.01 * f64::from(i)).take_while(|t| *t < to);
        times.filter_map(|t| rdt.request(t)).map(|request| request[3]).collect()
    };
    // at 0, 0.1, 0.2 s
    let mut bench = Bench::new(net_ft());
    assert_eq!(commands(&mut bench.0, 0.0, 0.25), [2, 2]);
    bench.all(&[(1, 1)]);
    assert!(commands(&mut bench.0, 0.3, 1.25).is_empty());
    // the reader slept for long, there is data all the same
    bench.all(&[(2, 2)]);
    assert!(commands(&mut bench.0, 9.0, 9.9).is_empty());
    assert_eq!(commands(&mut bench.0, 9.9, 10.15), [2, 2]);
    assert_eq!(bench.all(&[(1, 3)]), [(3, Quality::RESTARTED | GAP)]);
    // asked to by the link
    bench.0.reset();
    assert_eq!(commands(&mut bench.0, 10.2, 10.25), [2]);
    assert_eq!(bench.0.farewell().as_deref(), Some(&RdtRequest::Stop.to_bytes()[..]));
}

#[test]
fn a_clock_that_went_on_vouches_for_the_zero() {
    for (sample, went_on) in [(3000, true), (300, false), (9000, false), (1, false)] {
        let mut bench = Bench::new(RdtSettings { clock_rate: Some(1000.0), ..net_ft() });
        bench.put(1, 1000).unwrap();
        bench.0.reset();
        bench.1 += 2.0;
        let raw = bench.put(1, sample).unwrap();
        assert_eq!(!raw.quality.contains(Quality::RESTARTED), went_on, "{sample}");
        assert!(raw.quality.contains(GAP));
        // the time of the device goes on either way
        assert!(raw.device_time.unwrap() > 1.0);
        assert_eq!(bench.0.counters().restarts, u64::from(sample < 1000));
    }
}

#[test]
fn several_records_in_a_datagram_are_a_fault() {
    let mut rdt = Rdt::new(net_ft());
    let datagram = [RdtRecord::default().to_bytes(); 2].concat();
    let mut bytes = &datagram[..];
    assert_eq!(rdt.decode(&mut bytes, 0.0), Some(Err(FrameFault::Length { found: 72, expected: 36 })));
    assert!(bytes.is_empty());
}

proptest! {
    #[test]
    fn any_bytes(datagrams in proptest::collection::vec(proptest::collection::vec(any::<u8>(), 0..200), 0..20)) {
        let mut rdt = Rdt::new(net_ft());
        let mut records = 0;
        for datagram in &datagrams {
            let mut bytes = &datagram[..];
            while !bytes.is_empty() {
                let before = bytes.len();
                let decoded = rdt.decode(&mut bytes, 0.0);
                prop_assert!(bytes.len() < before || decoded.is_none());
            }
            records += usize::from(!datagram.is_empty());
        }
        let counters = rdt.counters();
        let accounted = counters.samples + counters.repeated + counters.reordered + counters.malformed;
        prop_assert_eq!(accounted, records as u64);
    }

    #[test]
    fn any_numbers(numbers in proptest::collection::vec((any::<u8>(), any::<u8>(), any::<bool>()), 0..200)) {
        // low numbers and some near the wrap, so that all cases come up
        let mut bench = Bench::new(RdtSettings { clock_rate: Some(100.0), ..net_ft() });
        let (mut last, mut time) = (0, f64::NEG_INFINITY);
        for (packet, sample, high) in numbers {
            let place = |n: u8| if high { u32::MAX - u32::from(n) } else { u32::from(n) };
            if let Some(raw) = bench.put(place(packet), place(sample)) {
                let (number, now) = (raw.sequence.unwrap(), raw.device_time.unwrap());
                prop_assert!(number > last || time == f64::NEG_INFINITY);
                prop_assert!(now > time);
                (last, time) = (number, now);
            }
        }
    }
}
