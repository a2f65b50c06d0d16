//! The samples before the first answer: those of the free rod, their tare, and the start of the stage.

use super::error::LiveError;
use super::feed::{Fed, Miss, Sensor};
use super::motion::Motion;
use super::scan::LiveScan;
use super::summary::LiveReport;
use crate::SensorCalibration;
use vibrissa::hw::{
    Calibration, CalibrationError, Channels, Mounting, RawSample, ReactionSample, Scale, SignalChain, Tare, TareError,
    TareLimits, TareWindow, Timekeeper, Wrench, WrenchChain, WrenchSample, Zero,
};
use vibrissa::reconstruct::LiveSettings;
use vibrissa::rod::Reactions;

/// Largest change within a tare window, in units of the rod (EI/L^2, EI/L): it would move the tip by 0.3 % of the length.
const SMALL: f64 = 0.01;
/// Fewest samples of the free rod, for its noise and the spacing.
const FEWEST: usize = LiveSettings::FEWEST_FREE;
/// Time, s, of the samples of the free rod where there is no tare.
const LISTEN: f64 = 0.5;
/// Seconds without a sample that end a scan.
pub(super) const PATIENCE: f64 = 3.0;
/// Window, s, over which the clock of a device is compared with that of the host. Longer: less jitter, slower correction.
const WINDOW: f64 = 10.0;

/// The calibration of a sensor with its rated loads and accuracy.
pub(super) struct Scaled<'a> {
    pub calibration: SensorCalibration,
    scan: &'a LiveScan,
}

impl Calibration for Scaled<'_> {
    fn wrench(&self, raw: &RawSample) -> Result<WrenchSample, CalibrationError> {
        let sample = self.calibration.wrench(raw)?;
        let setup = &self.scan.setup;
        let sample = setup.rated.map_or(sample, |rated| rated.flag(&sample));
        Ok(setup.accuracy.map_or(sample, |accuracy| accuracy.fill(&sample)))
    }
}

pub(super) type Chain<'a> = SignalChain<Scaled<'a>, Motion>;

/// The samples before the first answer.
pub(super) struct Head<'a> {
    pub chain: Chain<'a>,
    pub samples: Vec<ReactionSample>,
    /// The tare, in words.
    pub tare: String,
}

/// Records the rod without contact: tare, time of the first sample, start of the stage. The stage is that of the scan, or moves by `motion`.
pub(super) fn head<'a>(
    scan: &'a LiveScan,
    sensor: &mut Sensor,
    motion: Option<Motion>,
    report: &mut LiveReport,
    tell: &mut dyn FnMut(&str),
    stopped: &dyn Fn() -> bool,
) -> Result<Head<'a>, LiveError> {
    let seconds = scan.setup.tare.seconds;
    let listen = if seconds > 0.0 { seconds } else { LISTEN };
    let calibration = sensor.calibration.clone().unwrap_or_else(|| SensorCalibration::Scale(Scale::si()));
    let scaled = || Scaled { calibration: calibration.clone(), scan };
    let mut chain: Option<Chain<'a>> = None;
    let mut wrenches: Vec<WrenchSample> = Vec::new();
    let mut samples: Vec<ReactionSample> = Vec::new();
    let mut silent = 0.0;
    loop {
        let heard = |from: Option<f64>, to: Option<f64>| from.zip(to).is_some_and(|(from, to)| to - from >= listen);
        let enough = heard(wrenches.first().map(|w| w.t), wrenches.last().map(|w| w.t))
            || heard(samples.first().map(|s| s.t), samples.last().map(|s| s.t));
        if stopped() || (enough && wrenches.len().max(samples.len()) >= FEWEST) {
            break;
        }
        let fed = sensor.feed.next();
        if matches!(fed, Some(Ok(_))) {
            silent = 0.0;
        }
        match fed {
            None => break,
            Some(Ok(Fed::Raw(raw))) => {
                let chain = chain.get_or_insert_with(|| {
                    let wrench_chain = WrenchChain::new(Motion::Told, scan.setup.mounting);
                    SignalChain::new(scaled(), wrench_chain)
                        .with_rails(calibration.rails())
                        .with_timekeeper(timekeeper(scan, sensor, &raw))
                });
                match chain.wrench(&raw) {
                    Ok(wrench) => wrenches.push(wrench),
                    Err(error) => report.miss(&error.to_string()),
                }
            }
            Some(Ok(Fed::Reactions(sample))) => samples.push(sample),
            Some(Err(miss)) => {
                let (Miss::Silence(text) | Miss::Fault(text)) = &miss;
                report.miss(text);
                tell(&format!("warning: {text}"));
                silent += if matches!(miss, Miss::Silence(_)) { 1.0 } else { 0.0 };
                if silent >= PATIENCE {
                    break;
                }
            }
        }
    }
    let count = wrenches.len().max(samples.len());
    if count < FEWEST {
        let first = report.first_miss().map_or_else(String::new, |text| format!("; {text}"));
        return Err(LiveError::TooFew { samples: count, fewest: FEWEST, first });
    }
    let (Some(mut chain), Some(start)) = (chain, wrenches.first().map(|wrench| wrench.t)) else {
        // the samples are reactions already: the chain is not used
        let wrench_chain = WrenchChain::new(Motion::Told, scan.setup.mounting);
        let chain = SignalChain::new(scaled(), wrench_chain);
        return Ok(Head { chain, samples, tare: "as recorded".into() });
    };
    let motion = match motion {
        Some(motion) => motion,
        None => Motion::new(scan, start, sensor.epoch)?,
    };
    if matches!(motion, Motion::Told) {
        return Err(LiveError::NoStage { address: sensor.name.clone() });
    }
    *chain.wrenches().stage() = motion;
    let mut tare = "none".to_owned();
    if seconds > 0.0 {
        let window = tare_window(&wrenches, seconds);
        let lasts = window.last().map_or(0.0, |wrench| wrench.t - start);
        let seconds = seconds.max((1e3 * lasts).round() / 1e3);
        let zero = zero(scan, window).map_err(|source| LiveError::Tare { seconds, source })?;
        let [fx, fy, fz, tx, ty, tz] = zero.wrench().components();
        tare = format!(
            "{fx:.4e} {fy:.4e} {fz:.4e} N, {tx:.4e} {ty:.4e} {tz:.4e} N m, the mean of {} samples",
            zero.count()
        );
        chain.wrenches().set_tare(Some(Tare::single(zero)));
    }
    for wrench in &wrenches {
        match chain.wrenches().take(wrench) {
            Ok(sample) => samples.push(sample),
            // the first samples may be before the start of a table of poses
            Err(error) => report.miss(&error.to_string()),
        }
    }
    // a table of poses may begin after the tare
    while samples.len() < FEWEST && !stopped() {
        match sensor.feed.next() {
            None => break,
            Some(Ok(Fed::Raw(raw))) => match chain.take(&raw) {
                Ok(sample) => samples.push(sample),
                Err(error) => report.miss(&error.to_string()),
            },
            Some(Ok(Fed::Reactions(sample))) => samples.push(sample),
            Some(Err(Miss::Silence(text))) => {
                report.miss(&text);
                break;
            }
            Some(Err(Miss::Fault(text))) => report.miss(&text),
        }
    }
    if samples.len() < FEWEST {
        let first = report.first_miss().map_or_else(String::new, |text| format!("; {text}"));
        return Err(LiveError::TooFew { samples: samples.len(), fewest: FEWEST, first });
    }
    Ok(Head { chain, samples, tare })
}

/// How samples get their times: counted where the rate is known, by the device's clock where it has one.
fn timekeeper(scan: &LiveScan, sensor: &Sensor, first: &RawSample) -> Timekeeper {
    match scan.setup.rate {
        // recordings have their own times
        _ if sensor.feed.now().is_none() => Timekeeper::host(),
        Some(rate) => Timekeeper::paced(rate.recip()),
        None if first.device_time.is_some() => Timekeeper::device(WINDOW),
        None => Timekeeper::counted(None),
    }
}

/// The first samples, for so many seconds, or as many as a zero needs: the noise is estimated from more.
fn tare_window(wrenches: &[WrenchSample], seconds: f64) -> &[WrenchSample] {
    let start = wrenches.first().map_or(0.0, |wrench| wrench.t);
    let within = wrenches.partition_point(|wrench| wrench.t - start <= seconds);
    &wrenches[..within.max(TareWindow::FEWEST).min(wrenches.len())]
}

fn zero(scan: &LiveScan, wrenches: &[WrenchSample]) -> Result<Zero, TareError> {
    let units = scan.rod.units();
    let small = Wrench { force: [SMALL * units.force; 3], torque: [SMALL * units.moment; 3] };
    // samples are a period apart: the window of n of them lasts n periods, but not exactly the seconds asked for
    let limits = TareLimits::new(0.9 * scan.setup.tare.seconds, scan.setup.tare.change.unwrap_or(small))?;
    let mut window = TareWindow::new(limits);
    wrenches.iter().try_for_each(|wrench| window.push(wrench))?;
    window.finish()
}

/// Standard deviation of reactions from numbers rounded to one unit of the device, q / sqrt 12; zero where the unit is not known.
pub(super) fn rounding(scaled: &Scaled<'_>, mounting: &Mounting, at: &ReactionSample) -> Reactions {
    // the converter behind gauges is not known
    let SensorCalibration::Scale(scale) = &scaled.calibration else { return Reactions::default() };
    let one = RawSample::new(0.0, scale.channels(&Wrench::default()));
    let ones = one.channels.iter().map(|_| 1.0).collect::<Vec<f64>>();
    let raw = Channels::new(&ones).map(|channels| RawSample { channels, ..one });
    let quantum = raw.and_then(|raw| scale.wrench(&raw).ok()).map(|sample| sample.wrench).unwrap_or_default();
    // sensors that send N and N m as floats have no unit to round to
    let is_si = *scale == Scale::si();
    let sigma = quantum * if is_si { 0.0 } else { 12.0_f64.sqrt().recip() };
    let sample = WrenchSample { sigma: Some(sigma), ..WrenchSample::new(0.0, Wrench::default()) };
    mounting.reactions(&sample, at.pose).sigma.unwrap_or_default()
}
