//! When samples were taken.

use crate::quality::Quality;
use crate::raw::RawSample;

/// So much faster or slower than the device's clock does time run while it is corrected: it never stands still.
const SLEW: f64 = 0.01;

/// The share of a period that a step of time keeps at least, whatever is corrected.
const LEAST_STEP: f64 = 0.5;

/// Samples before the fit knows how large residuals usually are.
const FAMILIAR: u32 = 32;

/// Residuals beyond so many times their mean size count as so large only.
const CLIP: f64 = 5.0;

/// The usual size of residuals, at least, in periods: without jitter every rounding would be an outlier.
const QUIET: f64 = 0.02;

/// So many outliers in a row by the same amount are samples that were lost. Those that come late in a heap are by less and
/// less.
const RUN: u32 = 32;

/// When samples were taken, in seconds of the host's clock; never earlier than the sample before.
///
/// One of four ways, by what the device tells:
/// - [`host`](Self::host): when they arrived. They are late, each by another amount.
/// - [`device`](Self::device): by the device's own clock, set to the host's by the sample that came with the least delay.
/// - [`counted`](Self::counted): numbers of samples times their period, which is fitted.
/// - [`paced`](Self::paced): numbers of samples times a period that is exact, from when the first one arrived.
///
/// ```
/// use rod_hw::{Channels, RawSample, Timekeeper};
/// // a sample every 11.4 ms, stamped in whole milliseconds: 11, 11, 12, 11, ...
/// let mut timekeeper = Timekeeper::counted(None);
/// let mut last = 0.0;
/// for n in 0..5000_u32 {
///     let host_time = (11.4 * f64::from(n)).floor() * 1e-3;
///     last = timekeeper.time(&RawSample::new(host_time, Channels::default()))?;
/// }
/// let period = timekeeper.period().ok_or("no period")?;
/// assert!((period - 11.4e-3).abs() < 1e-7);
/// assert!((last - (11.4e-3 * 4999.0 - 0.4e-3)).abs() < 0.03e-3); // stamps are 0.4 ms early on average
/// assert!((timekeeper.jitter() - 0.28e-3).abs() < 0.02e-3); // of 5 values 0.2 ms apart
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Timekeeper {
    way: Way,
    last: Option<f64>,
    /// Mean square of what the host's stamps are off, and of how many.
    scatter: f64,
    count: u64,
    restarts: u64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Way {
    Host,
    Device(Device),
    Counted(Counted),
    Paced(Paced),
}

/// Why a sample has no time.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TimingError {
    /// The device has no clock of its own.
    #[error("the sample has no time of the device, expected one; take the host's time, or count the samples")]
    NoDeviceTime,
    /// A time that is none.
    #[error("the {clock} time is {value}, expected a finite number of seconds")]
    NotFinite {
        /// Whose time.
        clock: &'static str,
        /// Its value.
        value: f64,
    },
    /// The host's time as it is, earlier than before.
    #[error(
        "the host's time is {t} s after one of {before} s, expected none that runs back; sort the recording, or leave the sample out"
    )]
    Backwards {
        /// The time, s.
        t: f64,
        /// That of the sample before, s.
        before: f64,
    },
}

impl Timekeeper {
    /// The host's time as it is; where it runs back, that is an error.
    pub fn host() -> Self {
        Self::of(Way::Host)
    }

    /// The device's time, plus the least difference to the host's within `window` (s): a sample may come late, but not
    /// early. The window should be so long that one sample in it is not delayed, and so short that the clocks do not
    /// drift: 10 s is.
    ///
    /// ```
    /// use rod_hw::{Channels, RawSample, Timekeeper};
    /// let mut timekeeper = Timekeeper::device(10.0);
    /// let raw = |device: f64, delay: f64| {
    ///     let host_time = device - 1000.0 + delay;
    ///     RawSample { device_time: Some(device), ..RawSample::new(host_time, Channels::default()) }
    /// };
    /// assert_eq!(timekeeper.time(&raw(1000.0, 0.001))?, 0.001);
    /// let late = timekeeper.time(&raw(1000.002, 0.030))?;
    /// assert!((late - 0.003).abs() < 1e-12); // 2 ms after the one before, not 31
    /// # Ok::<(), rod_hw::TimingError>(())
    /// ```
    pub fn device(window: f64) -> Self {
        Self::of(Way::Device(Device { window, ..Device::default() }))
    }

    /// The sample's number times a period, fitted to the host's times of the last 10,000 samples or so; `period` (s) is
    /// where that starts, if it is known. Samples without a number are counted.
    ///
    /// The fit is one of least squares that forgets, and residuals that are large beside the usual ones count as
    /// moderate. Its times are late by the mean delay. Where samples were lost that nobody counted, it starts anew with the period that it
    /// has.
    pub fn counted(period: Option<f64>) -> Self {
        Self::of(Way::Counted(Counted::new(period.filter(|period| period.is_finite() && *period > 0.0))))
    }

    /// The sample's number times `period` (s; positive), from the host's time of the first one on. Samples without a number are
    /// counted. For a stage that runs on the device's clock, or when that is better than the host's: distances of samples are
    /// exact, however late they come.
    ///
    /// ```
    /// use rod_hw::{Channels, RawSample, Timekeeper};
    /// let mut timekeeper = Timekeeper::paced(2e-3);
    /// let raw = |sequence, host_time| RawSample { sequence: Some(sequence), ..RawSample::new(host_time, Channels::default()) };
    /// let times = [raw(70, 1.0), raw(71, 1.0025), raw(75, 1.5)].map(|raw| timekeeper.time(&raw));
    /// assert_eq!(times, [Ok(1.0), Ok(1.002), Ok(1.01)]);
    /// ```
    pub fn paced(period: f64) -> Self {
        Self::of(Way::Paced(Paced { period, first: None, last: 0 }))
    }

    fn of(way: Way) -> Self {
        Self { way, last: None, scatter: 0.0, count: 0, restarts: 0 }
    }

    /// When this sample was taken, s.
    ///
    /// # Errors
    /// [`TimingError`]; the sample then leaves no trace.
    pub fn time(&mut self, raw: &RawSample) -> Result<f64, TimingError> {
        let host = number("host's", raw.host_time)?;
        let anew = raw.quality.contains(Quality::RESTARTED);
        let (time, residual, restarted) = match &mut self.way {
            Way::Host => match self.last {
                Some(before) if host < before => return Err(TimingError::Backwards { t: host, before }),
                _ => (host, 0.0, false),
            },
            Way::Device(device) => {
                let own = number("device's", raw.device_time.ok_or(TimingError::NoDeviceTime)?)?;
                device.time(host, own, anew)
            }
            Way::Counted(counted) => counted.time(host, raw.sequence, anew),
            Way::Paced(paced) => paced.time(host, raw.sequence, anew),
        };
        self.restarts += u64::from(restarted);
        self.count += 1;
        self.scatter += (residual * residual - self.scatter) / self.count as f64;
        let time = self.last.map_or(time, |last| time.max(last));
        self.last = Some(time);
        Ok(time)
    }

    /// How far the host's times scatter about these, root mean square, s.
    pub fn jitter(&self) -> f64 {
        rod_core::Scalar::sqrt(self.scatter)
    }

    /// The fitted period, s, where samples are counted and there were two.
    pub fn period(&self) -> Option<f64> {
        match &self.way {
            Way::Counted(counted) => counted.period,
            Way::Paced(paced) => Some(paced.period),
            _ => None,
        }
    }

    /// How often time started anew: the device did, or samples were lost that nobody counted.
    pub fn restarts(&self) -> u64 {
        self.restarts
    }
}

fn number(clock: &'static str, value: f64) -> Result<f64, TimingError> {
    if value.is_finite() { Ok(value) } else { Err(TimingError::NotFinite { clock, value }) }
}

/// The device's clock set to the host's.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Device {
    window: f64,
    /// Its time at the last sample, and what is added to it.
    last: Option<(f64, f64)>,
    /// Least differences in this half of the window, which began at a time of the device, and in the one before.
    since: f64,
    least: f64,
    before: f64,
}

impl Device {
    /// Time, what the host's stamp is off, and whether it started anew.
    fn time(&mut self, host: f64, own: f64, anew: bool) -> (f64, f64, bool) {
        let difference = host - own;
        let going = self.last.filter(|(last, _)| !anew && own >= *last);
        let Some((last, offset)) = going else {
            let restarted = self.last.is_some();
            *self = Self { last: Some((own, difference)), since: own, least: difference, before: difference, ..*self };
            return (host, 0.0, restarted);
        };
        if own - self.since > 0.5 * self.window {
            (self.since, self.before, self.least) = (own, self.least, difference);
        }
        self.least = self.least.min(difference);
        let most = SLEW * (own - last);
        let offset = offset + (self.least.min(self.before) - offset).clamp(-most, most);
        self.last = Some((own, offset));
        (own + offset, difference - offset, false)
    }
}

/// A straight line through host times over numbers of samples, by the filter that is the least-squares fit of all samples as
/// long as they are fewer than the memory (expanding memory, then fading; Brookner 1998, section 1.2.10).
#[derive(Clone, Copy, Debug, PartialEq)]
struct Counted {
    period: Option<f64>,
    /// The last sample: its number, where the line is there, what was handed on for it.
    last: Option<(u64, f64, f64)>,
    /// Samples in the fit.
    fitted: u32,
    /// Mean size of the residuals, the large ones clipped, and of how many.
    usual: f64,
    seen: u32,
    /// Outliers in a row by the same amount, and by which.
    run: (u32, f64),
}

impl Counted {
    const MEMORY: u32 = 10_000;

    fn new(period: Option<f64>) -> Self {
        // a period that is given counts as if it came from so many samples
        let fitted = if period.is_some() { FAMILIAR } else { 1 };
        Self { period, last: None, fitted, usual: 0.0, seen: 0, run: (0, 0.0) }
    }

    /// Time, what the host's stamp is off, and whether the line started anew.
    fn time(&mut self, host: f64, number: Option<u64>, anew: bool) -> (f64, f64, bool) {
        let known = self.last.filter(|_| !anew).and_then(|(last, line, handed)| {
            let number = number.unwrap_or(last.saturating_add(1));
            number.checked_sub(last).filter(|steps| *steps > 0).map(|steps| (number, steps as f64, line, handed))
        });
        let Some((reached, steps, line, handed)) = known else {
            return self.start(host, number.or(self.last.map(|last| last.0.saturating_add(1))).unwrap_or(0));
        };
        let period = self.period.unwrap_or((host - line) / steps);
        let residual = host - (line + period * steps);
        let usual = CLIP * self.usual.max(QUIET * period);
        // of samples that all came at once nothing is usual
        let most = if self.seen >= FAMILIAR && usual > 0.0 { usual } else { f64::INFINITY };
        let counts = residual.clamp(-most, most);
        if number.is_none() && self.lost(residual, most) {
            return self.start(host, reached);
        }
        let n = f64::from(self.fitted);
        let line = line + period * steps + counts * 2.0 * (2.0 * n + 1.0) / ((n + 1.0) * (n + 2.0));
        let period = period + counts / steps * 6.0 / ((n + 1.0) * (n + 2.0));
        if !(line.is_finite() && period.is_finite()) {
            *self = Self::new(None);
            return (self.start(host, reached).0, 0.0, true);
        }
        let handed = line.max(handed + LEAST_STEP * period.max(0.0) * steps);
        (self.period, self.last) = (Some(period), Some((reached, line, handed)));
        self.fitted = (self.fitted + 1).min(Self::MEMORY);
        self.seen = (self.seen + 1).min(Self::MEMORY);
        self.usual += (counts.abs() - self.usual) / f64::from(self.seen.min(1000));
        (handed, host - line, false)
    }

    /// Whether samples were lost, by the residuals of many.
    fn lost(&mut self, residual: f64, most: f64) -> bool {
        let (count, by) = self.run;
        self.run = match (residual.abs() > most, (residual - by).abs() <= most) {
            (false, _) => (0, 0.0),
            (true, true) if count > 0 => (count + 1, by),
            _ => (1, residual),
        };
        self.run.0 >= RUN
    }

    /// The line from here, with the period there is.
    fn start(&mut self, host: f64, number: u64) -> (f64, f64, bool) {
        let restarted = self.last.is_some();
        self.last = Some((number, host, host));
        self.fitted = self.fitted.min(FAMILIAR);
        self.run = (0, 0.0);
        (host, 0.0, restarted)
    }
}

/// Steps of one length.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Paced {
    period: f64,
    /// The first sample: its number and time.
    first: Option<(u64, f64)>,
    /// Number of the last one.
    last: u64,
}

impl Paced {
    /// Time, what the host's stamp is off, and whether it started anew.
    fn time(&mut self, host: f64, number: Option<u64>, anew: bool) -> (f64, f64, bool) {
        let going = self.first.filter(|_| !anew);
        let number = number.unwrap_or(if going.is_some() { self.last.saturating_add(1) } else { 0 });
        let (Some((first, start)), true) = (going, number >= self.last) else {
            let restarted = self.first.is_some();
            (self.first, self.last) = (Some((number, host)), number);
            return (host, 0.0, restarted);
        };
        self.last = number;
        // a product, not a sum of steps: nothing adds up
        let time = start + (number - first) as f64 * self.period;
        (time, host - time, false)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::raw::Channels;
    use proptest::prelude::*;

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
        assert_eq!(times, [Ok(0.0), Ok(1.0), Err(TimingError::Backwards { t: 0.9, before: 1.0 }), Ok(1.0), Ok(1.1)]);
        assert_eq!((timekeeper.jitter(), timekeeper.period()), (0.0, None));
    }

    #[test]
    fn before_many_samples_the_line_is_that_of_least_squares() {
        let host = [0.0, 1.1, 1.9, 3.2, 3.9, 5.1, 5.8];
        let mut counted = Counted::new(None);
        let found = host.map(|host| counted.time(host, None, false).0)[6];
        let n = host.len() as f64;
        let (mean_x, mean_y) = (0.5 * (n - 1.0), host.iter().sum::<f64>() / n);
        let (sxy, sxx) = host.iter().zip(0..).fold((0.0, 0.0), |(sxy, sxx), (y, i)| {
            let x = f64::from(i) - mean_x;
            (sxy + x * (y - mean_y), sxx + x * x)
        });
        assert!((counted.period.unwrap() - sxy / sxx).abs() < 1e-14);
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
            "the sample has no time of the device, expected one; take the host's time, or count the samples"
        );
        assert_eq!(
            message(Timekeeper::host(), stamped(f64::NAN)),
            "the host's time is NaN, expected a finite number of seconds"
        );
        let own = RawSample { device_time: Some(f64::INFINITY), ..stamped(0.0) };
        assert!(message(Timekeeper::device(1.0), own).starts_with("the device's time is inf"));
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
}
