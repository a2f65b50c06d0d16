//! Times of samples.

use super::error::ChainError;
use crate::sample::{Quality, RawSample};

/// Largest correction of the clock, as a share of the elapsed time: the corrected time never stands still.
const SLEW: f64 = 0.01;

/// Shortest step of time from sample to sample, as a share of the period, however large the correction is.
const LEAST_STEP: f64 = 0.5;

/// Number of samples after which the fit knows the usual size of residuals.
const FAMILIAR: u32 = 32;

/// Residuals are clipped at this multiple of their mean size.
const CLIP: f64 = 5.0;

/// Smallest usual size of residuals, in periods: without jitter every rounding error would be an outlier.
const QUIET: f64 = 0.02;

/// This many outliers in a row by the same amount mean lost samples. Samples that arrive late together are late by less and
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
    /// Mean square of the residuals of the host's times, s^2, and their number.
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
    /// # Ok::<(), rod_hw::ChainError>(())
    /// ```
    pub fn device(window: f64) -> Self {
        Self::of(Way::Device(Device { window, ..Device::default() }))
    }

    /// The sample's number times a period, fitted to the host's times of the last 10,000 samples or so; `period` (s) is
    /// where that starts, if it is known. Samples without a number are counted.
    ///
    /// The fit is one of least squares that forgets, and residuals that are large beside the usual ones count as
    /// moderate. Its times are late by the mean delay. Where samples were lost that nobody counted, it restarts with the period that it
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

    /// Time of this sample, s.
    ///
    /// # Errors
    /// [`ChainError`]; the sample then leaves no trace.
    pub fn time(&mut self, raw: &RawSample) -> Result<f64, ChainError> {
        let host = number("host's", raw.host_time)?;
        let anew = raw.quality.contains(Quality::RESTARTED);
        let (time, residual, restarted) = match &mut self.way {
            Way::Host => match self.last {
                Some(before) if host < before => return Err(ChainError::HostBackwards { t: host, before }),
                _ => (host, 0.0, false),
            },
            Way::Device(device) => {
                let own = number("device's", raw.device_time.ok_or(ChainError::NoDeviceTime)?)?;
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

    /// How often time restarted: the device did, or samples were lost that nobody counted.
    pub fn restarts(&self) -> u64 {
        self.restarts
    }
}

fn number(clock: &'static str, value: f64) -> Result<f64, ChainError> {
    if value.is_finite() { Ok(value) } else { Err(ChainError::Clock { clock, value }) }
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
    /// Time, what the host's stamp is off, and whether it restarted.
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

    /// Time, what the host's stamp is off, and whether the line restarted.
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
    /// Time, what the host's stamp is off, and whether it restarted.
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
