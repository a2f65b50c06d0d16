//! A live scan, from the first sample to the last.

use super::error::LiveError;
use super::feed::{Fed, Miss, Sensor};
use super::head::{Head, PATIENCE, head, rounding};
use super::physics::Physics;
use super::record::{LiveFiles, check};
use super::scan::LiveScan;
use super::summary::{End, LiveReport};
use std::path::Path;
use vibrissa::hw::{ChainError, ReactionSample, StageError};
use vibrissa::reconstruct::{LiveSession, LiveSettings, Reading, ReconstructError};
use vibrissa::rod::Reactions;
use vibrissa::{Label, Sample};

/// Seconds between two lines of progress.
const TICK: f64 = 1.0;

impl LiveScan {
    /// Listens to the sensor until the clamp has arrived, there are no more samples, the sensor falls silent, or `stopped`
    /// returns true. Writes recording.csv, points.jsonl and summary.json into `out`, the first two while it runs. `tell` gets the lines
    /// to show.
    ///
    /// The first samples, for [`TareSetup::seconds`](crate::TareSetup), must be of the free rod: tare and noise are computed from them.
    /// The stage starts with the first sample.
    ///
    /// # Errors
    /// [`LiveError`].
    pub fn run(
        &self,
        mut sensor: Sensor,
        out: &Path,
        tell: &mut dyn FnMut(&str),
        stopped: &dyn Fn() -> bool,
    ) -> Result<LiveReport, LiveError> {
        check(out, &self.inputs)?;
        let mut report = LiveReport::new(self, &sensor.name);
        for finding in report.findings() {
            tell(&format!("warning: {finding}"));
        }
        let Head { mut chain, samples, tare } = head(self, &mut sensor, None, &mut report, tell, stopped)?;
        tell(&format!("tare: {tare}"));
        let settings = settings(self, &samples, rounding(chain.calibration(), &self.setup.mounting, &samples[0]))?;
        let noise = settings.noise;
        let mut session = LiveSession::with_errors(&self.rod, &settings, &self.budget, &self.known)?;
        report.begin(&settings, session.delay());
        tell(&format!(
            "noise: f0x {:.1e} N, f0y {:.1e} N, m0z {:.1e} N m; answers {} samples late",
            noise[0].sigma,
            noise[1].sigma,
            noise[2].sigma,
            session.delay()
        ));
        let clock = "seconds from the first sample".to_owned();
        let notes = vec![("sensor", sensor.name.clone()), ("tare", tare), ("clock", clock)];
        let mut recorded = Recorded {
            record: LiveFiles::new(out, notes)?,
            report,
            physics: Physics::new(),
            label: None,
            told: 0.0,
            tell,
            fault: None,
        };
        for sample in samples {
            recorded.sample(&sample);
            session.push(sample, usable(&sample).as_ref(), |sample, reading| recorded.answer(&sample, reading));
        }
        let mut last = f64::NEG_INFINITY;
        // the latency of earlier samples includes the wait for the tare
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
                    // the next sample would be after the end of the path
                    if last + recorded.report.losses.period().unwrap_or(0.0) >= chain.wrenches().stage().end() {
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
                    last = sample.t;
                    recorded.sample(&sample);
                    if let Some((now, ready)) = sensor.feed.now().zip(ready)
                        && sample.raw.host_time > ready
                    {
                        recorded.report.latency.push(now - sample.raw.host_time);
                    }
                    session.push(sample, usable(&sample).as_ref(), |sample, reading| recorded.answer(&sample, reading));
                }
                Err(ChainError::Stage(StageError::Outside { .. })) => break End::Stage,
                Err(error) => recorded.report.miss(&error.to_string()),
            }
        };
        session.finish(|sample, reading| recorded.answer(&sample, reading));
        let Recorded { record, mut report, physics, tell, fault, .. } = recorded;
        report.end(end, sensor.feed.counters(), chain.timekeeper(), session.calibration());
        let misfits = physics.misfits(&self.rod, session.calibration());
        for misfit in misfits.into_iter().chain(physics.friction(&self.rod, self.budget, self.known)) {
            tell(&format!("warning: {misfit}"));
            report.misfit(misfit);
        }
        record.finish(&report.counters, &report.record())?;
        fault.map_or(Ok(report), |error| Err(error.into()))
    }
}

/// The sample for the reconstruction, if its quality allows.
fn usable(sample: &ReactionSample) -> Option<Sample> {
    sample.quality.is_usable().then(|| sample.sample())
}

/// The settings of the reconstruction from the first samples, which are of the free rod.
fn settings(scan: &LiveScan, free: &[ReactionSample], rounding: Reactions) -> Result<LiveSettings, LiveError> {
    let samples: Vec<Sample> = free.iter().filter_map(usable).collect();
    let settings = LiveSettings::of_free_rod(&scan.rod, &samples, rounding).map_err(|error| match error {
        ReconstructError::TooFew { usable: samples, fewest, .. } => {
            LiveError::TooFew { samples, fewest, first: "; the clamp does not move".into() }
        }
        other => LiveError::from(other),
    })?;
    let half_window = scan.setup.half_window.unwrap_or(settings.half_window);
    Ok(LiveSettings { half_window, ..settings })
}

/// The files and the lines of progress of a scan while it runs.
struct Recorded<'a> {
    record: LiveFiles,
    report: LiveReport,
    physics: Physics,
    /// The label of the last answer.
    label: Option<Label>,
    /// Time of the last line of progress, s.
    told: f64,
    tell: &'a mut dyn FnMut(&str),
    fault: Option<crate::OutputError>,
}

impl Recorded<'_> {
    fn sample(&mut self, sample: &ReactionSample) {
        self.report.sample(sample);
        if let Some(usable) = usable(sample) {
            self.physics.push(usable);
        }
        if let Err(error) = self.record.sample(sample) {
            self.fault.get_or_insert(error);
        }
    }

    fn answer(&mut self, sample: &ReactionSample, reading: Option<Reading>) {
        self.report.answer(reading.as_ref());
        if let Err(error) = self.record.answer(sample, reading.as_ref()) {
            self.fault.get_or_insert(error);
        }
        let Some(reading) = reading else { return };
        let changed = self.label != Some(reading.label);
        if changed || sample.t - self.told >= TICK {
            let line = self.report.line(sample, &reading, self.label.filter(|_| changed));
            (self.label, self.told) = (Some(reading.label), sample.t);
            (self.tell)(&line);
            if let Err(error) = self.record.flush() {
                self.fault.get_or_insert(error);
            }
        }
    }

    /// Reports a silence; whether the scan has to end.
    fn silent(&mut self, text: &str) -> bool {
        (self.tell)(&format!("warning: {text}"));
        self.report.silent() as f64 >= PATIENCE
    }
}
