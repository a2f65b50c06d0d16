//! RDT over loopback UDP: a fake sensor goes wrong in each known way, and the account that the link keeps is the fake's own.

use rod_core::Pose;
use rod_fake_sensor::{FakeRdt, FakeRdtAccount, FakeRdtSettings, RdtFault};
use rod_hw::device::rdt::{Rdt, RdtProfile, RdtRecord, RdtRequest, RdtSettings, read_scaling};
use rod_hw::{
    Calibration, Frame, HostClock, Link, LinkCounters, LinkError, LinkSettings, Mounting, Quality, RawSample,
    SignalChain, Tare, TareLimits, TareWindow, TransportError, Udp, Wrench, WrenchChain, Zero, spawn,
};
use std::time::{Duration, Instant};

type Sensor = Link<Udp, Rdt, HostClock>;

const GAP: Quality = Quality::GAP_BEFORE;

fn link(fake: &FakeRdt, settings: RdtSettings) -> Sensor {
    link_within(fake, settings, 0.25)
}

fn link_within(fake: &FakeRdt, settings: RdtSettings, deadline: f64) -> Sensor {
    let udp = Udp::connect(&fake.address().to_string()).unwrap();
    Link::new(udp, Rdt::new(settings), HostClock::new(), LinkSettings { deadline, ..LinkSettings::default() })
}

/// Patient: the machine may be slow.
fn net_ft() -> RdtSettings {
    RdtSettings { silence: 20.0, ..RdtSettings::new(RdtProfile::NetFt) }
}

fn counts(count: i32) -> impl Iterator<Item = [i32; 6]> + Send + 'static {
    (0..count).map(|i| [i, -i, 300, 10, -20, 30])
}

/// All that comes until the fake has nothing more to send.
fn drain(link: &mut Sensor, fake: &FakeRdt) -> Vec<RawSample> {
    let mut samples = Vec::new();
    loop {
        let ended = fake.ended();
        match link.next().unwrap() {
            Ok(sample) => samples.push(sample),
            Err(LinkError::Timeout { .. }) if ended => return samples,
            Err(_) => {}
        }
    }
}

/// The link's account is the fake's: nothing is missing that the fake did not leave out, and nothing is more.
fn assert_same(counters: LinkCounters, account: FakeRdtAccount, counted_anew: u64) {
    let FakeRdtAccount { sent, dropped, damaged, stalled, overtaken, repeated, malformed, foreign, records, .. } =
        account;
    assert_eq!(records, sent + dropped + damaged, "{account:?}");
    let expected = LinkCounters {
        samples: sent - stalled - overtaken - counted_anew,
        lost: dropped + damaged + overtaken + counted_anew,
        repeated: repeated + stalled,
        reordered: overtaken + counted_anew,
        malformed,
        foreign,
        restarts: counted_anew,
        gaps: counters.gaps,
        requests: counters.requests,
        device_errors: counters.device_errors,
        ..LinkCounters::default()
    };
    assert_eq!(counters, expected, "{account:?}");
}

/// What comes of these faults.
fn run(faults: Vec<(u64, RdtFault)>) -> (Vec<RawSample>, LinkCounters, FakeRdtAccount) {
    let fake = FakeRdt::start(FakeRdtSettings { faults, ..FakeRdtSettings::default() }, counts(100)).unwrap();
    let mut link = link(&fake, net_ft());
    let samples = drain(&mut link, &fake);
    (samples, link.counters(), fake.account())
}

/// Which of the counts came.
fn came(samples: &[RawSample]) -> Vec<i32> {
    samples.iter().map(|raw| raw.channels[0] as i32).collect()
}

fn without(left_out: &[i32]) -> Vec<i32> {
    (0..100).filter(|i| !left_out.contains(i)).collect()
}

/// Counts of the samples with these flags.
fn flagged(samples: &[RawSample], flags: Quality) -> Vec<i32> {
    came(&samples.iter().copied().filter(|raw| raw.quality == flags).collect::<Vec<_>>())
}

#[test]
fn nothing_wrong() {
    let (samples, counters, account) = run(Vec::new());
    assert_eq!(came(&samples), without(&[]));
    assert!(samples.iter().all(|raw| raw.quality.is_empty() && raw.status == 0));
    assert_eq!(samples[7].channels[..], [7.0, -7.0, 300.0, 10.0, -20.0, 30.0]);
    assert!(samples.windows(2).all(|two| two[0].host_time <= two[1].host_time && two[0].sequence < two[1].sequence));
    assert_same(counters, account, 0);
}

#[test]
fn lost() {
    let (samples, counters, account) = run(vec![(20, RdtFault::Drop(1)), (30, RdtFault::Drop(5))]);
    assert_eq!(came(&samples), without(&[20, 30, 31, 32, 33, 34]));
    assert_eq!(flagged(&samples, GAP), [21, 35]);
    assert_eq!((account.dropped, counters.gaps), (6, 2));
    assert_same(counters, account, 0);
}

#[test]
fn repeated() {
    let (samples, counters, account) = run(vec![(20, RdtFault::Repeat(1)), (30, RdtFault::Repeat(3))]);
    assert_eq!(came(&samples), without(&[]));
    assert_eq!(account.repeated, 4);
    assert_same(counters, account, 0);
}

#[test]
fn overtaken() {
    let (samples, counters, account) = run(vec![(20, RdtFault::Overtaken(1)), (30, RdtFault::Overtaken(4))]);
    assert_eq!(came(&samples), without(&[20, 30]));
    assert_eq!(flagged(&samples, GAP), [21, 31]);
    // a public driver makes 4 billion lost of one
    assert_eq!((counters.lost, counters.reordered), (2, 2));
    assert_same(counters, account, 0);
}

#[test]
fn short_long_and_meaningless() {
    let faults = [
        (20, RdtFault::Cut(35)),
        (22, RdtFault::Cut(1)),
        (24, RdtFault::Extended(1)),
        (26, RdtFault::Extended(36)),
        // longer than the buffer of the link, nearly as long as a datagram can be
        (28, RdtFault::Extended(3000)),
        (30, RdtFault::Extended(60_000)),
        (32, RdtFault::Garbage(20)),
        (34, RdtFault::Garbage(72)),
    ];
    let (samples, counters, account) = run(faults.into());
    assert_eq!(came(&samples), without(&[20, 22, 24, 26, 28, 30]));
    assert_eq!((account.damaged, account.malformed), (6, 8));
    assert_same(counters, account, 0);
}

#[test]
fn from_elsewhere() {
    let (samples, counters, account) = run(vec![(20, RdtFault::Foreign(7))]);
    assert_eq!((came(&samples), counters.foreign), (without(&[]), 7));
    assert_same(counters, account, 0);
}

#[test]
fn stalled() {
    let (samples, counters, account) = run(vec![(20, RdtFault::Stall(3))]);
    assert_eq!((came(&samples), counters.repeated), (without(&[]), 3));
    assert_same(counters, account, 0);
}

#[test]
fn all_at_once() {
    let faults = [
        (20, RdtFault::Foreign(2)),
        (20, RdtFault::Repeat(2)),
        (22, RdtFault::Drop(1)),
        (25, RdtFault::Overtaken(3)),
        (27, RdtFault::Stall(2)),
        (27, RdtFault::Overtaken(2)),
        (30, RdtFault::Garbage(5)),
        (31, RdtFault::Cut(30)),
        (40, RdtFault::Pause(0.1)),
        (41, RdtFault::Drop(10)),
        (60, RdtFault::Repeat(1)),
        (60, RdtFault::Overtaken(1)),
    ];
    let (_, counters, account) = run(faults.into());
    assert_eq!((account.dropped, account.damaged, account.stalled, account.repeated), (11, 1, 2, 3));
    assert_eq!((account.overtaken, account.malformed, account.foreign, account.records), (3, 2, 2, 102));
    // of the copies that came late, both are late
    let counters = LinkCounters { reordered: counters.reordered - 1, repeated: counters.repeated + 1, ..counters };
    assert_same(counters, account, 0);
}

#[test]
fn both_counters_wrap() {
    let settings = FakeRdtSettings {
        first_packet: u32::MAX - 30,
        first_sample: u32::MAX - 300,
        stride: 7,
        faults: vec![(29, RdtFault::Drop(4))],
        ..FakeRdtSettings::default()
    };
    let fake = FakeRdt::start(settings, counts(100)).unwrap();
    let mut link = link(&fake, RdtSettings { clock_rate: Some(7000.0), ..net_ft() });
    let samples = drain(&mut link, &fake);
    assert_eq!(came(&samples), without(&[29, 30, 31, 32]));
    assert_same(link.counters(), fake.account(), 0);
    let first = samples[0].device_time.unwrap();
    for raw in &samples {
        assert!((raw.device_time.unwrap() - first - 1e-3 * raw.channels[0]).abs() < 1e-9);
        assert_eq!(raw.sequence.unwrap(), u64::from(u32::MAX) - 300 + 7 * raw.channels[0] as u64);
    }
}

#[test]
fn a_sensor_that_counts_anew() {
    let settings = FakeRdtSettings {
        faults: vec![(50, RdtFault::CountAnew)],
        first_sample: 1,
        stride: 3,
        ..FakeRdtSettings::default()
    };
    let fake = FakeRdt::start(settings, counts(100)).unwrap();
    let mut link = link(&fake, net_ft());
    let samples = drain(&mut link, &fake);
    // the first one after it could be a late one
    assert_eq!(came(&samples), without(&[50]));
    assert_eq!(flagged(&samples, Quality::RESTARTED | GAP), [51]);
    assert_same(link.counters(), fake.account(), 1);
    // its zero is another one now
    let calibration = FakeRdtSettings::default().scaling.calibration::<f64>().unwrap();
    let begin = samples[0].host_time;
    let mut tare = Tare::single(Zero::known(Wrench::default(), Wrench::default(), begin).unwrap());
    let tared = samples.iter().map(|raw| tare.apply(&calibration.wrench(raw).unwrap()));
    let stale: Vec<bool> = tared.map(|sample| sample.quality.contains(Quality::TARE_STALE)).collect();
    assert_eq!(stale, came(&samples).iter().map(|count| *count >= 51).collect::<Vec<_>>());
}

/// From the datagrams to the reactions: what is measured after a restart is not good any more, until there is a new tare.
#[test]
fn a_restart_spoils_the_tare_of_the_chain() {
    let loads = std::iter::repeat_n([1000, -2000, 300, 10, -20, 30], 300);
    let faults = vec![(150, RdtFault::CountAnew)];
    let fake =
        FakeRdt::start(FakeRdtSettings { faults, first_sample: 1, ..FakeRdtSettings::default() }, loads).unwrap();
    let calibration = FakeRdtSettings::default().scaling.calibration::<f64>().unwrap();
    let stage = |_| Ok(Pose { x: 0.08, y: -0.04, phi: 1.571 });
    let wrenches = WrenchChain::new(stage, Mounting::new(Frame::same()));
    let mut chain = SignalChain::new(calibration, wrenches);
    let limits = TareLimits::new(1e-3, Wrench { force: [1e-3; 3], torque: [1e-3; 3] }).unwrap();
    let mut link = link(&fake, net_ft());
    let samples = drain(&mut link, &fake);
    assert_eq!((samples.len(), link.counters().restarts), (299, 1));

    let (unloaded, rest) = samples.split_at(100);
    let tare = |chain: &mut SignalChain<_, _>, samples: &[RawSample]| {
        let mut window = TareWindow::new(limits);
        samples.iter().for_each(|raw| window.push(&chain.wrench(raw).unwrap()).unwrap());
        chain.wrenches().set_tare(Some(Tare::single(window.finish().unwrap())));
    };
    tare(&mut chain, unloaded);
    let (before, after) = rest.split_at(50);
    for raw in before {
        let found = chain.take(raw).unwrap();
        assert!(found.quality.is_empty() && found.reactions.f0y.abs() < 1e-12, "{found:?}");
    }
    for (i, raw) in after[..50].iter().enumerate() {
        let expected = if i == 0 { Quality::TARE_STALE | Quality::RESTARTED | GAP } else { Quality::TARE_STALE };
        assert_eq!(chain.take(raw).unwrap().quality, expected);
    }
    tare(&mut chain, &after[50..90]);
    assert!(after[90..].iter().all(|raw| chain.take(raw).unwrap().quality.is_empty()));
}

#[test]
fn a_sensor_without_power_for_a_while() {
    let faults = vec![(50, RdtFault::PowerOff(1.2))];
    let fake = FakeRdt::start(FakeRdtSettings { faults, ..FakeRdtSettings::default() }, counts(100)).unwrap();
    let mut link = link(&fake, RdtSettings { silence: 0.6, ..net_ft() });
    let samples = drain(&mut link, &fake);
    assert_eq!(came(&samples), without(&[]));
    assert_eq!(flagged(&samples, Quality::RESTARTED | GAP), [50]);
    let (counters, account) = (link.counters(), fake.account());
    assert_eq!((counters.restarts, counters.lost, counters.reordered), (1, 0, 0));
    assert!(account.starts >= 2 && account.ignored >= 1, "{account:?}");
}

#[test]
fn the_start_is_lost_three_times() {
    let settings = FakeRdtSettings { ignored_starts: 3, ..FakeRdtSettings::default() };
    let fake = FakeRdt::start(settings, counts(100)).unwrap();
    let mut link = link_within(&fake, net_ft(), 20.0);
    let first = link.next().unwrap().unwrap();
    assert_eq!((first.channels[0], first.quality), (0.0, Quality::empty()));
    assert!(first.host_time >= 0.3, "{}", first.host_time);
    assert_eq!(fake.account().ignored, 3);
    assert!(link.counters().requests >= 4);
}

#[test]
fn started_twice_is_no_loss() {
    // the first record comes after the second or third start
    let settings = FakeRdtSettings { start_delay: 0.25, ..FakeRdtSettings::default() };
    let fake = FakeRdt::start(settings, counts(100)).unwrap();
    let mut link = link(&fake, net_ft());
    let samples = drain(&mut link, &fake);
    assert_eq!(came(&samples), without(&[]));
    assert!(samples.iter().all(|raw| raw.quality.is_empty()));
    assert!(fake.account().starts >= 2);
    assert_same(link.counters(), fake.account(), 0);
}

#[test]
fn no_data_before_the_deadline() {
    let settings = FakeRdtSettings { ignored_starts: 8, ..FakeRdtSettings::default() };
    let fake = FakeRdt::start(settings, counts(100)).unwrap();
    let mut link = link_within(&fake, net_ft(), 0.2);
    let since = Instant::now();
    let Some(Err(LinkError::Timeout { waited, .. })) = link.next() else { panic!("data out of nothing") };
    assert!((0.19..10.0).contains(&waited) && since.elapsed() < Duration::from_secs(10));
    // asked again until it comes
    let found = std::iter::from_fn(|| link.next()).take(1000).find_map(Result::ok).unwrap();
    assert_eq!(found.channels[0], 0.0);
}

#[test]
fn status_of_each_family() {
    let bits = |at, bits| (at, RdtFault::Status { bits, count: 1 });
    let (saturated, warning, error) = (Quality::SATURATED, Quality::DEVICE_WARNING, Quality::DEVICE_ERROR);
    for (profile, of_saturated, of_warning, of_error) in [
        (RdtProfile::NetFt, 0x8002_0000, 0x8001_0000, 0xC000_0000),
        (RdtProfile::Axia, 0xC000_0000, 0x8001_0000, 0x8000_0002),
        (RdtProfile::OnRobot, 0x0000_0010, 0x0100_0000, 0x0000_2000),
    ] {
        let faults = vec![bits(20, of_saturated), bits(22, of_warning), bits(24, of_error)];
        let settings = FakeRdtSettings { faults, ..FakeRdtSettings::default() };
        let fake = FakeRdt::start(settings, counts(30)).unwrap();
        let mut link = link(&fake, RdtSettings { profile, ..net_ft() });
        let samples = drain(&mut link, &fake);
        assert_eq!(came(&samples), (0..30).collect::<Vec<_>>());
        for (at, flags, word) in [(20, saturated, of_saturated), (22, warning, of_warning), (24, error, of_error)] {
            assert_eq!((samples[at].quality, samples[at].status), (flags, word), "{profile:?}");
        }
        assert_eq!((link.counters().device_errors, fake.account().flagged), (2, 3));
    }
}

#[test]
fn a_storm_is_an_error_and_passes() {
    let faults = vec![(20, RdtFault::Garbage(7)); 12];
    let fake = FakeRdt::start(FakeRdtSettings { faults, ..FakeRdtSettings::default() }, counts(100)).unwrap();
    let mut link = link(&fake, net_ft());
    assert_eq!(link.by_ref().filter_map(Result::ok).take(20).count(), 20);
    let error = link.next().unwrap().unwrap_err();
    assert!(matches!(error, LinkError::<TransportError>::Storm { count: 10, .. }));
    assert!(error.to_string().ends_with("a frame of 7 bytes, expected 36; is this the right protocol?"), "{error}");
    assert_eq!(came(&drain(&mut link, &fake)), (20..100).collect::<Vec<_>>());
    assert_same(link.counters(), fake.account(), 0);
}

#[test]
fn gone_and_back_at_the_same_port() {
    let settings = FakeRdtSettings { first_sample: 5000, ..FakeRdtSettings::default() };
    let fake = FakeRdt::start(settings.clone(), counts(1_000_000)).unwrap();
    let address = fake.address();
    let mut link = link_within(&fake, RdtSettings { silence: 0.2, ..net_ft() }, 0.3);
    assert!(link.by_ref().take(20).all(|item| item.is_ok()));
    drop(fake);
    let gone = std::iter::from_fn(|| link.next()).take(2000).any(|item| matches!(item, Err(LinkError::Timeout { .. })));
    assert!(gone);
    let again = FakeRdt::start(FakeRdtSettings { address, first_sample: 1, ..settings }, counts(100)).unwrap();
    let first = std::iter::from_fn(|| link.next()).take(1000).find_map(Result::ok).unwrap();
    assert_eq!((first.channels[0], first.quality), (0.0, Quality::RESTARTED | GAP));
    assert_eq!(drain(&mut link, &again).len(), 99);
    assert_eq!((link.counters().restarts, link.counters().lost), (1, 0));
}

#[test]
fn a_reader_busy_at_times_loses_nothing_unnoticed() {
    let settings = FakeRdtSettings { rate: Some(7000.0), ..FakeRdtSettings::default() };
    let fake = FakeRdt::start(settings, counts(7000)).unwrap();
    // a silence shorter than the reader's own
    let mut link = link_within(&fake, RdtSettings { silence: 0.3, ..net_ft() }, 5.0);
    let mut samples: Vec<RawSample> = link.by_ref().take(10).map(Result::unwrap).collect();
    std::thread::sleep(Duration::from_millis(450));
    while let Some(Ok(sample)) = link.next() {
        samples.push(sample);
        if sample.channels[0] == 6999.0 {
            break;
        }
    }
    let (counters, last) = (link.counters(), samples.last().unwrap());
    assert_eq!(counters.samples, samples.len() as u64);
    // what the system had no room for is counted
    assert_eq!(counters.samples + counters.lost, last.channels[0] as u64 + 1);
    // that nobody read was no reason to start it anew
    assert_eq!((fake.account().starts, counters.restarts, counters.reordered), (1, 0, 0));
}

#[test]
fn a_busy_consumer_loses_nothing() {
    let settings = FakeRdtSettings { rate: Some(7000.0), ..FakeRdtSettings::default() };
    let fake = FakeRdt::start(settings, counts(3500)).unwrap();
    let mut sensor = spawn(link_within(&fake, net_ft(), 5.0), 10_000).unwrap();
    let mut samples: Vec<RawSample> = Vec::new();
    while let Some(Ok(sample)) = sensor.next() {
        samples.push(sample);
        if samples.len().is_multiple_of(500) {
            std::thread::sleep(Duration::from_millis(100));
        }
        if sample.channels[0] == 3499.0 {
            break;
        }
    }
    let counters = sensor.counters();
    // only what the system had no room for, where this machine did not let the thread run for long
    assert_eq!((counters.untaken, samples.len() as u64 + counters.lost), (0, 3500));
    // the samples have the time of their arrival, not that of their use
    let waits = samples.windows(2).map(|two| two[1].host_time - two[0].host_time);
    assert!(waits.filter(|wait| *wait > 0.09).count() < 5);
    drop(sensor);
    let since = Instant::now();
    while fake.account().stops == 0 && since.elapsed() < Duration::from_secs(10) {
        std::thread::sleep(Duration::from_millis(1));
    }
    assert_eq!(fake.account().stops, 1);
}

#[test]
fn so_many_as_asked_for_and_status_from_the_source() {
    let records = (0..100).map(|i| RdtRecord { status: i, ..RdtRecord::from([7; 6]) });
    let fake = FakeRdt::start(FakeRdtSettings::default(), records).unwrap();
    let socket = std::net::UdpSocket::bind("127.0.0.1:0").unwrap();
    socket.set_read_timeout(Some(Duration::from_millis(500))).unwrap();
    socket.send_to(&RdtRequest::Start { count: 5 }.to_bytes(), fake.address()).unwrap();
    let mut bytes = [0; 36];
    let mut records = Vec::new();
    while let Ok(36) = socket.recv(&mut bytes) {
        records.push(RdtRecord::from_bytes(&bytes));
    }
    let expected = |i| RdtRecord { packet: i + 1, sample: i + 1, status: i, counts: [7; 6] };
    assert_eq!(records, (0..5).map(expected).collect::<Vec<_>>());
    socket.send_to(b"\x12\x34nonsense", fake.address()).unwrap();
    let since = Instant::now();
    while fake.account().unknown == 0 && since.elapsed() < Duration::from_secs(10) {
        std::thread::sleep(Duration::from_millis(1));
    }
    assert_eq!((fake.account().unknown, fake.account().starts), (1, 1));
}

#[test]
fn scaling_over_tcp() {
    let settings = FakeRdtSettings::default();
    let fake = FakeRdt::start(settings.clone(), [[0; 6]; 3]).unwrap();
    let host = fake.scaling_address().unwrap().to_string();
    for _ in 0..2 {
        assert_eq!(read_scaling(&host, Duration::from_secs(10)).unwrap(), settings.scaling);
    }
    assert_eq!(fake.account().answers, 2);
}

/// 7000 samples a second for a minute, and how long each is on its way:
/// `cargo test --release -p rod-hw --features rdt --test suite rdt -- --ignored --nocapture`
#[test]
#[ignore = "takes a minute, and measures"]
fn seven_thousand_a_second() {
    let origin = Instant::now();
    let micros = move || i32::try_from(origin.elapsed().as_micros()).unwrap();
    // each sample carries the time that it was made at, µs
    let source = std::iter::from_fn(move || Some([micros(), 0, 0, 0, 0, 0])).take(7000 * 60);
    let settings = FakeRdtSettings { rate: Some(7000.0), ..FakeRdtSettings::default() };
    let fake = FakeRdt::start(settings, source).unwrap();
    let mut link = link_within(&fake, net_ft(), 5.0);
    let (mut delays, mut made) = (Vec::new(), Vec::new());
    for _ in 0..7000 * 60 {
        let Some(Ok(sample)) = link.next() else { break };
        delays.push(micros() - sample.channels[0] as i32);
        made.push(sample.channels[0]);
    }
    delays.sort_unstable();
    let at = |share: f64| delays[((delays.len() - 1) as f64 * share) as usize];
    let seconds = 1e-6 * (made[made.len() - 1] - made[0]);
    println!("{} in {seconds:.3} s; {}", delays.len(), link.counters());
    println!("delay, µs: median {}, 99 % {}, 99.9 % {}, most {}", at(0.5), at(0.99), at(0.999), at(1.0));
    assert_eq!((delays.len(), link.counters().lost), (7000 * 60, 0));
}
