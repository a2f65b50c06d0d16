//! A live scan, from the first sample to the last.

use super::feed::{Fed, Miss};
use super::motion::Motion;
use super::record::Record;
use super::summary::{End, LiveReport};
use super::{Answer, Engine, LiveError, LiveScan, Sensor};
use crate::{Error, SensorCalibration};
use std::path::Path;
use vibrissa::hw::recording::About;
use vibrissa::hw::{
    Calibration, CalibrationError, ChainError, Mounting, RawSample, ReactionSample, Scale, SignalChain, StageError,
    Tare, TareLimits, TareWindow, Timekeeper, Wrench, WrenchChain, WrenchSample,
};
use vibrissa::noise_estimate::{ChannelNoise, estimate};
use vibrissa::{Label, Live, LiveSettings, Travel};

/// Change within a tare window that does not matter, in units of the rod.
const SMALL: f64 = 0.01;
/// So many samples from one step of a rounded signal to the next, about.
const STEP: f64 = 64.0;
/// Fewest samples that tell noise and spacing.
const FEWEST: usize = 100;
/// How long to listen before the first answer where there is no tare, s.
const LISTEN: f64 = 0.5;
/// Seconds without a sample that end a scan.
const PATIENCE: f64 = 3.0;
/// Seconds between two lines of progress.
const TICK: f64 = 1.0;
/// Window of a device's clock, s.
const WINDOW: f64 = 10.0;
/// Half-window of the identification: in lengths of the rod, but no fewer samples than this.
const HALF_WINDOW: f64 = 0.02;
const FEWEST_IN_HALF_WINDOW: f64 = 200.0;

/// What a sample is in N and N m, and how far it can be trusted.
struct Scaled<'a> {
    calibration: SensorCalibration,
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

type Chain<'a> = SignalChain<Scaled<'a>, Motion, Option<Tare>>;

/// What was heard before the first answer.
struct Head<'a> {
    chain: Chain<'a>,
    samples: Vec<ReactionSample>,
    /// Wrenches that wait for stage and tare.
    tare: String,
}

/// Runs a scan to its end. `tell` is handed lines to show; `stopped` asks it to end.
pub(super) fn run(
    scan: &LiveScan,
    mut sensor: Sensor,
    out: &Path,
    tell: &mut dyn FnMut(&str),
    stopped: &dyn Fn() -> bool,
) -> Result<LiveReport, Error> {
    let mut report = LiveReport::new(scan, &sensor.name);
    for finding in report.findings() {
        tell(&format!("warning: {finding}"));
    }
    let Head { mut chain, samples, tare } = head(scan, &mut sensor, &mut report, tell, stopped)?;
    tell(&format!("tare: {tare}"));
    let (noise, spacing) = noise(scan, &samples, &chain)?;
    let usual = (HALF_WINDOW * scan.rod.length()).max(FEWEST_IN_HALF_WINDOW * spacing);
    let half_window = scan.setup.half_window.unwrap_or(usual);
    let live = Live::new(&scan.rod, &LiveSettings { half_window, ..LiveSettings::new(noise, spacing) })?;
    report.begin(noise, spacing, live.delay());
    tell(&format!(
        "noise: f0x {:.1e} N, f0y {:.1e} N, m0z {:.1e} N m; answers {} samples late",
        noise[0].sigma,
        noise[1].sigma,
        noise[2].sigma,
        live.delay()
    ));
    let about =
        About { sensor: sensor.name.clone(), tare, clock: "seconds from the first sample".into(), ..About::default() };
    let mut recorded = Recorded { record: Record::new(out, about)?, report, label: None, told: 0.0, tell, fault: None };
    let mut engine = Engine::new(live);
    for sample in samples {
        recorded.sample(&sample);
        engine.push(sample, |answer| recorded.answer(&answer));
    }
    let (mut last, mut period) = (f64::NEG_INFINITY, 0.0);
    // those that came before had to wait for the tare
    let ready = sensor.feed.now();
    let end = loop {
        if let Some(error) = recorded.fault.take() {
            return Err(error.into());
        }
        if stopped() {
            break End::Stopped;
        }
        let fed = match sensor.feed.next() {
            None => break End::Source,
            Some(Ok(fed)) => fed,
            Some(Err(Miss::Silence(text))) => {
                // the next sample would have come after the end of the way
                if last + period >= chain.wrenches().stage().end() {
                    break End::Stage;
                }
                if recorded.silent(&text) {
                    break End::Silence;
                }
                continue;
            }
            Some(Err(Miss::Fault(text))) => {
                recorded.report.miss(&text);
                continue;
            }
        };
        let taken = match fed {
            Fed::Raw(raw) => chain.take(&raw),
            Fed::Reactions(sample) => Ok(sample),
        };
        match taken {
            Ok(sample) => {
                (period, last) = (sample.t - last, sample.t);
                recorded.sample(&sample);
                if let Some((now, ready)) = sensor.feed.now().zip(ready)
                    && sample.raw.host_time > ready
                {
                    recorded.report.latency.push(now - sample.raw.host_time);
                }
                engine.push(sample, |answer| recorded.answer(&answer));
            }
            Err(ChainError::Stage(StageError::Outside { .. })) => break End::Stage,
            Err(error) => recorded.report.miss(&error.to_string()),
        }
    };
    engine.finish(|answer| recorded.answer(&answer));
    let Recorded { record, mut report, fault, .. } = recorded;
    report.end(end, sensor.feed.counters(), chain.timekeeper());
    record.finish(&report.counters, &report.record())?;
    fault.map_or(Ok(report), |error| Err(error.into()))
}

/// Listens to the rod without contact: tare, time of the first sample, start of the stage.
fn head<'a>(
    scan: &'a LiveScan,
    sensor: &mut Sensor,
    report: &mut LiveReport,
    tell: &mut dyn FnMut(&str),
    stopped: &dyn Fn() -> bool,
) -> Result<Head<'a>, Error> {
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
        match sensor.feed.next() {
            None => break,
            Some(Ok(Fed::Raw(raw))) => {
                let chain = chain.get_or_insert_with(|| {
                    let wrench_chain = WrenchChain::new(Motion::Told, scan.setup.mounting).with_tare(None);
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
        return Err(LiveError::TooFew { samples: count, fewest: FEWEST, first }.into());
    }
    let (Some(mut chain), Some(start)) = (chain, wrenches.first().map(|wrench| wrench.t)) else {
        // everything is done already: nothing is left for a chain to do
        let wrench_chain = WrenchChain::new(Motion::Told, scan.setup.mounting).with_tare(None);
        let chain = SignalChain::new(scaled(), wrench_chain);
        return Ok(Head { chain, samples, tare: "as recorded".into() });
    };
    let motion = Motion::new(scan.stage.as_ref(), scan.path.as_ref(), start, &scan.reading)?;
    if matches!(motion, Motion::Told) {
        return Err(LiveError::NoStage { address: sensor.name.clone() }.into());
    }
    *chain.wrenches().stage() = motion;
    let mut tare = "none".to_owned();
    if seconds > 0.0 {
        let zero = zero(scan, &wrenches).map_err(|source| LiveError::Tare { seconds, source })?;
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
            // the first ones, at the edge of a table, may be outside
            Err(error) => report.miss(&error.to_string()),
        }
    }
    if samples.len() < FEWEST {
        let first = report.first_miss().map_or_else(String::new, |text| format!("; {text}"));
        return Err(LiveError::TooFew { samples: samples.len(), fewest: FEWEST, first }.into());
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

fn zero(scan: &LiveScan, wrenches: &[WrenchSample]) -> Result<vibrissa::hw::Zero, vibrissa::hw::TareError> {
    let units = scan.rod.units();
    let small = Wrench { force: [SMALL * units.force; 3], torque: [SMALL * units.moment; 3] };
    // samples are a period apart: the window of n of them lasts n periods, but not exactly the seconds asked for
    let limits = TareLimits::new(0.9 * scan.setup.tare.seconds, scan.setup.tare.change.unwrap_or(small))?;
    let mut window = TareWindow::new(limits);
    wrenches.iter().try_for_each(|wrench| window.push(wrench))?;
    window.finish()
}

/// Noise of the reactions of the free rod, no less than the rounding of the sensor's numbers, and the way from sample to sample.
fn noise(scan: &LiveScan, samples: &[ReactionSample], chain: &Chain<'_>) -> Result<([ChannelNoise; 3], f64), Error> {
    let mut travel = Travel::new(&scan.rod);
    let mut rows: Vec<(f64, [f64; 3])> = Vec::with_capacity(samples.len());
    for sample in samples.iter().filter(|sample| sample.quality.is_usable()) {
        if let Ok(way) = travel.go(&sample.pose) {
            rows.push((way, [sample.reactions.f0x, sample.reactions.f0y, sample.reactions.m0z]));
        }
    }
    if rows.len() < FEWEST {
        let first = "; the clamp does not move".to_owned();
        return Err(LiveError::TooFew { samples: rows.len(), fewest: FEWEST, first }.into());
    }
    let tau: Vec<f64> = rows.iter().map(|row| row.0).collect();
    let spacing = tau.last().copied().unwrap_or_default() / (tau.len() - 1) as f64;
    let rounding = rounding(chain.calibration(), &scan.setup.mounting, &samples[0]);
    let noise = [0, 1, 2].map(|c| {
        let channel: Vec<f64> = rows.iter().map(|row| row.1[c]).collect();
        let found = estimate(&tau, &channel);
        if found.sigma > rounding[c] {
            return found;
        }
        // without noise to blur it, rounding is off by the same for as many samples as the signal takes from step to step
        ChannelNoise { sigma: rounding[c], lag1: 1.0 - 1.0 / STEP, long_run: STEP }
    });
    Ok((noise, spacing))
}

/// Standard deviation of numbers rounded to one unit of the device: q / sqrt 12.
fn rounding(scaled: &Scaled<'_>, mounting: &Mounting, at: &ReactionSample) -> [f64; 3] {
    // the converter behind gauges is not known
    let SensorCalibration::Scale(scale) = &scaled.calibration else { return [0.0; 3] };
    let one = RawSample::new(0.0, scale.channels(&Wrench::default()));
    let ones = one.channels.iter().map(|_| 1.0).collect::<Vec<f64>>();
    let raw = vibrissa::hw::Channels::new(&ones).map(|channels| RawSample { channels, ..one });
    let quantum = raw.and_then(|raw| scale.wrench(&raw).ok()).map(|sample| sample.wrench).unwrap_or_default();
    // sensors that send N and N m as floats have no unit to round to
    let is_si = *scale == Scale::si();
    let sigma = quantum * if is_si { 0.0 } else { 12.0_f64.sqrt().recip() };
    let sample = WrenchSample { sigma: Some(sigma), ..WrenchSample::new(0.0, Wrench::default()) };
    mounting.reactions(&sample, at.pose).sigma.map_or([0.0; 3], |sigma| [sigma.f0x, sigma.f0y, sigma.m0z])
}

/// What is written and told of a scan while it runs.
struct Recorded<'a> {
    record: Record,
    report: LiveReport,
    /// Of the last answer.
    label: Option<Label>,
    /// When something was told last, s.
    told: f64,
    tell: &'a mut dyn FnMut(&str),
    fault: Option<crate::OutputError>,
}

impl Recorded<'_> {
    fn sample(&mut self, sample: &ReactionSample) {
        self.report.sample(sample);
        if let Err(error) = self.record.sample(sample) {
            self.fault.get_or_insert(error);
        }
    }

    fn answer(&mut self, answer: &Answer) {
        self.report.answer(answer);
        if let Err(error) = self.record.answer(answer) {
            self.fault.get_or_insert(error);
        }
        let Some(reading) = answer.reading else { return };
        let changed = self.label != Some(reading.label);
        if changed || answer.sample.t - self.told >= TICK {
            let line = self.report.line(answer, self.label.filter(|_| changed));
            (self.label, self.told) = (Some(reading.label), answer.sample.t);
            (self.tell)(&line);
            if let Err(error) = self.record.flush() {
                self.fault.get_or_insert(error);
            }
        }
    }

    /// Nothing came for a while; whether that is the end.
    fn silent(&mut self, text: &str) -> bool {
        (self.tell)(&format!("warning: {text}"));
        self.report.silent() as f64 >= PATIENCE
    }
}
