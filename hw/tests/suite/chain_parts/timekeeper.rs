//! When samples were taken.

use proptest::prelude::*;
use rod_hw::*;

fn stamped(host: f64) -> RawSample {
    RawSample::new(host, Channels::default())
}

fn numbered(host: f64, sequence: u64) -> RawSample {
    RawSample { sequence: Some(sequence), ..stamped(host) }
}

/// Between 0 and 1, without a generator.
fn scattered(n: u32) -> f64 {
    (f64::from(n) * 0.618_033_988_749_895).fract()
}

#[test]
fn the_hosts_time_never_runs_back() {
    let mut timekeeper = Timekeeper::host();
    let times = [0.0, 1.0, 0.9, 1.0, 1.1].map(|host| timekeeper.time(&stamped(host)));
    assert_eq!(times, [Ok(0.0), Ok(1.0), Err(ChainError::HostBackwards { t: 0.9, before: 1.0 }), Ok(1.0), Ok(1.1)]);
    assert_eq!((timekeeper.jitter(), timekeeper.period()), (0.0, None));
}

#[test]
fn before_many_samples_the_line_is_that_of_least_squares() {
    let host = [0.0, 1.1, 1.9, 3.2, 3.9, 5.1, 5.8];
    let mut counted = Timekeeper::counted(None);
    let found = host.map(|host| counted.time(&RawSample::new(host, Channels::default())).unwrap())[6];
    let n = host.len() as f64;
    let (mean_x, mean_y) = (0.5 * (n - 1.0), host.iter().sum::<f64>() / n);
    let (sxy, sxx) = host.iter().zip(0..).fold((0.0, 0.0), |(sxy, sxx), (y, i)| {
        let x = f64::from(i) - mean_x;
        (sxy + x * (y - mean_y), sxx + x * x)
    });
    assert!((counted.period().unwrap() - sxy / sxx).abs() < 1e-14);
    assert!((found - (mean_y + sxy / sxx * (n - 1.0 - mean_x))).abs() < 1e-14);
}

#[test]
fn a_late_heap_of_samples_moves_little() {
    for with_number in [true, false] {
        let mut timekeeper = Timekeeper::counted(None);
        let mut worst = 0.0_f64;
        for n in 0..8000_u32 {
            let taken = 2e-3 * f64::from(n);
            // nothing is read for 0.2 s
            let read = if (5000..5100).contains(&n) { 2e-3 * 5100.0 } else { taken };
            let host = read + 2e-4 * scattered(n);
            let raw = if with_number { numbered(host, n.into()) } else { stamped(host) };
            let time = timekeeper.time(&raw).unwrap();
            if n > 100 {
                worst = worst.max((time - taken - 1e-4).abs());
            }
        }
        assert!(worst < 4e-5, "{worst}");
        assert_eq!(timekeeper.restarts(), 0);
    }
}

/// As many as a buffer holds may come at once before the first one that comes alone.
#[test]
fn samples_that_come_in_heaps_from_the_start() {
    for with_number in [true, false] {
        let mut timekeeper = Timekeeper::counted(None);
        let mut worst = 0.0_f64;
        for n in 0..40_000_u32 {
            // 4000 a second, read every 16 ms
            let taken = 2.5e-4 * f64::from(n);
            let read = 16e-3 * f64::from(n / 64 + 1);
            let raw = if with_number { numbered(read, n.into()) } else { stamped(read) };
            let time = timekeeper.time(&raw).unwrap();
            if n > 20_000 {
                // 8 ms late on average
                worst = worst.max((time - taken - 8e-3).abs());
            }
        }
        assert!((timekeeper.period().unwrap() - 2.5e-4).abs() < 1e-7, "{:?}", timekeeper.period());
        assert!(worst < 1e-3, "{worst}");
    }
}

#[test]
fn samples_lost_without_a_number_are_noticed() {
    let mut timekeeper = Timekeeper::counted(Some(2e-3));
    let mut off = 0.0;
    for n in 0..4000_u32 {
        let taken = 2e-3 * f64::from(if n < 2000 { n } else { n + 70 });
        off = timekeeper.time(&stamped(taken + 2e-4 * scattered(n))).unwrap() - taken;
    }
    assert_eq!(timekeeper.restarts(), 1);
    assert!((off - 1e-4).abs() < 3e-5, "{off}");
    assert!((timekeeper.period().unwrap() - 2e-3).abs() < 1e-7);
}

#[test]
fn lost_and_numbered_samples_leave_their_place() {
    let mut timekeeper = Timekeeper::counted(None);
    let mut worst = 0.0_f64;
    for n in (0..6000_u32).filter(|n| n % 7 != 3 && !(2000..2500).contains(n)) {
        let taken = 1e-3 * f64::from(n);
        let time = timekeeper.time(&numbered(taken + 3e-4 * scattered(n), n.into())).unwrap();
        if n > 100 {
            worst = worst.max((time - taken - 1.5e-4).abs());
        }
    }
    assert!(worst < 5e-5, "{worst}");
}

#[test]
fn a_device_that_starts_anew() {
    let anew = |raw: RawSample| RawSample { quality: Quality::RESTARTED, ..raw };
    let mut counted = Timekeeper::counted(None);
    for n in 0..100_u32 {
        counted.time(&numbered(1e-3 * f64::from(n), n.into())).unwrap();
    }
    assert_eq!(counted.time(&anew(numbered(5.0, 101))).unwrap(), 5.0);
    assert!((counted.time(&numbered(5.001, 102)).unwrap() - 5.001).abs() < 1e-12);

    let of_device = |own: f64, host: f64| RawSample { device_time: Some(own), ..stamped(host) };
    let mut device = Timekeeper::device(10.0);
    device.time(&of_device(70.0, 1.0)).unwrap();
    assert_eq!(device.time(&anew(of_device(0.5, 3.0))).unwrap(), 3.0);
    // also where nobody says so
    assert_eq!(device.time(&of_device(0.1, 4.0)).unwrap(), 4.0);
    assert_eq!((counted.restarts(), device.restarts()), (1, 2));
}

/// 100 ppm of drift against the host, delays of 0.2 ms and more.
#[test]
fn the_device_clock_drifts() {
    let mut timekeeper = Timekeeper::device(10.0);
    let mut worst = 0.0_f64;
    for n in 0..120_000_u32 {
        let taken = 1e-3 * f64::from(n);
        let delay = 2e-4 + 5e-3 * scattered(n).powi(4);
        let raw = RawSample { device_time: Some(7.0 + taken * 1.0001), ..stamped(taken + delay) };
        let time = timekeeper.time(&raw).unwrap();
        if n > 2000 {
            worst = worst.max((time - taken - 2e-4).abs());
        }
    }
    // as much as the clocks drift apart in the window
    assert!(worst < 1.1e-3, "{worst}");
    assert!((timekeeper.jitter() - 1.9e-3).abs() < 0.5e-3, "{}", timekeeper.jitter());
}

#[test]
fn refuses() {
    let message = |mut timekeeper: Timekeeper, raw| timekeeper.time(&raw).unwrap_err().to_string();
    assert_eq!(
        message(Timekeeper::device(1.0), stamped(0.0)),
        "time: the sample has no time of the device, expected one; take the host's time, or count the samples"
    );
    assert_eq!(
        message(Timekeeper::host(), stamped(f64::NAN)),
        "time: the host's time is NaN, expected a finite number of seconds"
    );
    let own = RawSample { device_time: Some(f64::INFINITY), ..stamped(0.0) };
    assert!(message(Timekeeper::device(1.0), own).starts_with("time: the device's time is inf"));
}

proptest! {
    /// Neither do the largest numbers break it.
    #[test]
    fn any_numbers(
        way in 0..3,
        samples in proptest::collection::vec((any::<f64>(), proptest::option::of(any::<u64>()), any::<f64>()), 1..200),
    ) {
        let mut timekeeper = match way {
            0 => Timekeeper::device(1.0),
            1 => Timekeeper::paced(1e-2),
            _ => Timekeeper::counted(None),
        };
        let mut last = f64::NEG_INFINITY;
        for (host, sequence, own) in samples {
            let sequence = sequence.map(|number| if number % 3 == 0 { u64::MAX } else { number });
            let raw = RawSample { sequence, device_time: Some(own), ..stamped(host) };
            let time = timekeeper.time(&raw).unwrap();
            prop_assert!(time >= last, "{time} {last}");
            last = time;
        }
    }

    /// Whatever the stamps and numbers are, time is finite and never runs back.
    #[test]
    fn monotonic(
        way in 0..3,
        samples in proptest::collection::vec((0.0_f64..10.0, 0_u64..50, 0.0_f64..10.0, any::<bool>()), 1..200),
    ) {
        let mut timekeeper = match way {
            0 => Timekeeper::device(1.0),
            1 => Timekeeper::paced(1e-2),
            _ => Timekeeper::counted(None),
        };
        let mut last = f64::NEG_INFINITY;
        for (host, sequence, own, anew) in samples {
            let quality = if anew { Quality::RESTARTED } else { Quality::empty() };
            let raw = RawSample { device_time: Some(own), quality, ..numbered(host, sequence) };
            let time = timekeeper.time(&raw).unwrap();
            prop_assert!(time.is_finite() && time >= last);
            last = time;
        }
    }
}
