//! A live scan, from the first sample to the last.

use super::feed::{Fed, Miss};
use super::head::{Head, PATIENCE, head};
use super::noise::noise;
use super::record::Record;
use super::summary::{End, LiveReport};
use super::{Answer, Engine, LiveScan, Sensor};
use crate::Error;
use std::path::Path;
use vibrissa::hw::{ChainError, ReactionSample, StageError};
use vibrissa::{Label, Live, LiveSettings};

/// Seconds between two lines of progress.
const TICK: f64 = 1.0;
/// Half-window of the identification: in lengths of the rod, but no fewer samples than this.
const HALF_WINDOW: f64 = 0.02;
const FEWEST_IN_HALF_WINDOW: f64 = 200.0;

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
    let clock = "seconds from the first sample".to_owned();
    let notes = vec![("sensor", sensor.name.clone()), ("tare", tare), ("clock", clock)];
    let mut recorded = Recorded { record: Record::new(out, notes)?, report, label: None, told: 0.0, tell, fault: None };
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
