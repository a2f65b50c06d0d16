//! The report of a live scan.

use super::latency::Latency;
use super::losses::Losses;
use super::scan::LiveScan;
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt::Write;
use vibrissa::hw::{LinkCounters, Quality, ReactionSample, SensorCheck, SensorFinding, Timekeeper};
use vibrissa::reconstruct::{Calibration, LiveSettings, Reading, SourceEstimate, Touch};
use vibrissa::{Label, Pose};

/// Probability of a label below which it is printed.
const UNSURE: f64 = 0.95;

/// Way of a clamp that only turns, in lengths of the rod: above the rounding of its pose.
const STANDS: f64 = 1e-6;

/// Why a live scan ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum End {
    /// The clamp has arrived.
    Stage,
    /// There are no more samples.
    Source,
    /// The sensor fell silent.
    Silence,
    /// On request.
    Stopped,
}

/// The report of a live scan.
#[derive(Clone, Debug)]
pub struct LiveReport {
    /// The sensor.
    pub sensor: String,
    /// Counters of the connection.
    pub counters: LinkCounters,
    /// Samples with reactions.
    pub samples: u64,
    /// Delays from the arrival of a sample to its reactions.
    pub latency: Latency,
    /// Why it ended.
    pub end: Option<End>,
    findings: Vec<SensorFinding>,
    /// Why the scan cannot be of its rod.
    misfits: Vec<String>,
    noise: [f64; 3],
    spacing: f64,
    delay: usize,
    pub(super) losses: Losses,
    labels: BTreeMap<String, u64>,
    unsure: u64,
    errors: Vec<SourceEstimate>,
    qualities: BTreeMap<&'static str, u64>,
    points: u64,
    misses: u64,
    first_miss: Option<String>,
    silent: u32,
    jitter: f64,
    /// Length of the rod, m.
    length: f64,
    /// The pose of the first sample.
    start: Option<Pose>,
}

impl LiveReport {
    pub(super) fn new(scan: &LiveScan, sensor: &str) -> Self {
        let check = scan.setup.rated.map(|rated| SensorCheck::new(scan.rod.units(), &rated, scan.setup.class));
        let findings = check.and_then(Result::ok).map_or_else(Vec::new, |check| check.findings().collect());
        Self {
            sensor: sensor.to_owned(),
            counters: LinkCounters::default(),
            samples: 0,
            latency: Latency::default(),
            end: None,
            findings,
            misfits: Vec::new(),
            noise: [0.0; 3],
            spacing: 0.0,
            delay: 0,
            losses: Losses::default(),
            labels: BTreeMap::new(),
            unsure: 0,
            errors: Vec::new(),
            qualities: BTreeMap::new(),
            points: 0,
            misses: 0,
            first_miss: None,
            silent: 0,
            jitter: 0.0,
            length: scan.rod.length(),
            start: None,
        }
    }

    /// Reasons against this sensor for this rod.
    pub fn findings(&self) -> &[SensorFinding] {
        &self.findings
    }

    /// Whether the scan is complete, to the end of the path or of the source, with a sensor that suits the rod, and can be of the rod.
    pub fn is_complete(&self) -> bool {
        let suits = !self.findings.iter().any(SensorFinding::is_misfit);
        !matches!(self.end, None | Some(End::Silence)) && suits && self.misfits.is_empty()
    }

    pub(super) fn misfit(&mut self, text: String) {
        self.misfits.push(text);
    }

    pub(super) fn begin(&mut self, settings: &LiveSettings, delay: usize) {
        (self.noise, self.spacing) = (settings.noise.map(|noise| noise.sigma), settings.spacing);
        self.delay = delay;
    }

    pub(super) fn sample(&mut self, sample: &ReactionSample) {
        self.samples += 1;
        self.start.get_or_insert(sample.pose);
        self.silent = 0;
        self.losses.push(sample);
        for name in sample.quality.names() {
            *self.qualities.entry(name).or_default() += 1;
        }
    }

    pub(super) fn answer(&mut self, reading: Option<&Reading>) {
        let Some(reading) = reading else { return };
        *self.labels.entry(reading.label.to_string()).or_default() += 1;
        self.points += u64::from(reading.touch.is_ok());
        self.unsure += u64::from(reading.probability < UNSURE);
    }

    /// A sample without reactions.
    pub(super) fn miss(&mut self, text: &str) {
        self.misses += 1;
        self.first_miss.get_or_insert_with(|| text.to_owned());
    }

    pub(super) fn first_miss(&self) -> Option<&str> {
        self.first_miss.as_deref()
    }

    /// Counts a silence; the number of consecutive ones.
    pub(super) fn silent(&mut self) -> u32 {
        self.silent += 1;
        self.silent
    }

    pub(super) fn end(
        &mut self,
        end: End,
        counters: LinkCounters,
        timekeeper: &Timekeeper,
        calibration: Option<&Calibration>,
    ) {
        (self.end, self.counters, self.jitter) = (Some(end), counters, timekeeper.jitter());
        self.counters.lost += self.losses.lost();
        self.errors = calibration.map_or_else(Vec::new, |calibration| calibration.sources.clone());
    }

    /// A line of progress: the answer, and the label `before` if it has changed.
    pub(super) fn line(&self, sample: &ReactionSample, reading: &Reading, before: Option<Label>) -> String {
        let phase = match before {
            Some(before) => format!("{before} -> {}", reading.label),
            None => reading.label.to_string(),
        };
        let sure = reading.probability >= UNSURE;
        let phase = if sure { phase } else { format!("{phase} ({:.0} %)", 100.0 * reading.probability) };
        let point = match &reading.touch {
            Ok(touch @ Touch { x, y, force, .. }) => format!(
                "contact ({:.3}, {:.3}) mm +- {:.0e} mm, {force:.4} N",
                1e3 * x,
                1e3 * y,
                1e3 * touch.sigma_normal()
            ),
            Err(reason) => reason.to_string(),
        };
        let good = if sample.quality == Quality::empty() { String::new() } else { format!("  [{}]", sample.quality) };
        let clamp = self.coordinate(sample.pose);
        format!("{:10.3} s  {clamp}  {phase:<10}  {point}{good}", sample.t)
    }

    /// The coordinate of the clamp that has changed most since the first sample, in words; x0 before any has.
    fn coordinate(&self, pose: Pose) -> String {
        let first = self.start.unwrap_or(pose);
        let [dx, dy] = [pose.x - first.x, pose.y - first.y].map(f64::abs);
        if dx.max(dy) <= STANDS * self.length && pose.phi != first.phi {
            format!("phi0 {:8.3} deg", pose.phi.to_degrees())
        } else if dy > dx {
            format!("y0 {:8.3} mm", 1e3 * pose.y)
        } else {
            format!("x0 {:8.3} mm", 1e3 * pose.x)
        }
    }

    /// The report as text.
    pub fn text(&self) -> String {
        let mut text = String::new();
        // Writing to a string cannot fail.
        let _ = self.tell(&mut text);
        text
    }

    fn tell(&self, text: &mut String) -> std::fmt::Result {
        let end = match self.end {
            Some(End::Stage) => "the clamp has arrived",
            Some(End::Source) => "no more samples",
            Some(End::Silence) => "the sensor fell silent",
            Some(End::Stopped) | None => "stopped",
        };
        writeln!(text, "{}: {end}; link: {}", self.sensor, self.counters)?;
        let labels: Vec<String> = self.labels.iter().map(|(label, count)| format!("{label} {count}")).collect();
        writeln!(text, "{} samples, {} contact points; {}", self.samples, self.points, labels.join(", "))?;
        if self.unsure > 0 {
            writeln!(text, "{} labels have a probability below {:.0} %", self.unsure, 100.0 * UNSURE)?;
        }
        for error in self.errors.iter().filter(|error| error.is_beyond()) {
            let SourceEstimate { source, value, sigma, given, .. } = error;
            let unit = source.name().1;
            writeln!(
                text,
                "{source}: {value:.2e} +- {sigma:.0e} {unit}, more than three times its budget of {given:.0e}"
            )?;
        }
        if let (Some(median), Some(most)) = (self.latency.quantile(0.5), self.latency.quantile(0.999)) {
            writeln!(
                text,
                "from arrival to reactions: median {:.3} ms, 99.9 % {:.3} ms, largest {:.3} ms",
                1e3 * median,
                1e3 * most,
                1e3 * self.latency.largest()
            )?;
        }
        for (name, count) in &self.qualities {
            writeln!(text, "flagged {name}: {count}")?;
        }
        if let Some(first) = &self.first_miss {
            writeln!(text, "{} without reactions, the first: {first}", self.misses)?;
        }
        self.findings.iter().try_for_each(|finding| writeln!(text, "sensor: {finding}"))?;
        self.misfits.iter().try_for_each(|misfit| writeln!(text, "physics: {misfit}"))
    }

    /// The report as a record of summary.json.
    pub(super) fn record(&self) -> impl Serialize {
        SummaryRecord {
            sensor: self.sensor.clone(),
            end: self.end,
            complete: self.is_complete(),
            link: LinkRecord::from(&self.counters),
            samples: self.samples,
            points: self.points,
            labels: self.labels.clone(),
            unsure: self.unsure,
            errors: self.errors.clone(),
            flagged: self.qualities.clone(),
            without_reactions: self.misses,
            first_without: self.first_miss.clone(),
            noise: LiveNoiseRecord { f0x: self.noise[0], f0y: self.noise[1], m0z: self.noise[2] },
            spacing: self.spacing,
            delay: self.delay,
            latency: LatencyRecord {
                median: self.latency.quantile(0.5),
                p999: self.latency.quantile(0.999),
                largest: self.latency.largest(),
            },
            jitter: self.jitter,
            findings: self.findings.iter().map(ToString::to_string).chain(self.misfits.iter().cloned()).collect(),
        }
    }
}

/// summary.json, SI units.
#[derive(Serialize)]
struct SummaryRecord {
    sensor: String,
    end: Option<End>,
    complete: bool,
    link: LinkRecord,
    samples: u64,
    points: u64,
    labels: BTreeMap<String, u64>,
    /// Labels with a probability below 0.95.
    unsure: u64,
    /// What was found of the errors that all samples share.
    errors: Vec<SourceEstimate>,
    flagged: BTreeMap<&'static str, u64>,
    without_reactions: u64,
    first_without: Option<String>,
    /// Standard deviations.
    noise: LiveNoiseRecord,
    /// Path length of the clamp from sample to sample, m.
    spacing: f64,
    /// Number of samples after a sample at which its answer came.
    delay: usize,
    latency: LatencyRecord,
    /// Jitter of the host's times of arrival, s.
    jitter: f64,
    findings: Vec<String>,
}

#[derive(Serialize)]
struct LiveNoiseRecord {
    f0x: f64,
    f0y: f64,
    m0z: f64,
}

#[derive(Serialize)]
struct LatencyRecord {
    median: Option<f64>,
    /// The delay that 99.9 % of the samples do not exceed.
    p999: Option<f64>,
    largest: f64,
}

#[derive(Serialize)]
struct LinkRecord {
    samples: u64,
    lost: u64,
    gaps: u64,
    repeated: u64,
    reordered: u64,
    malformed: u64,
    bad_checksum: u64,
    foreign: u64,
    skipped_bytes: u64,
    device_errors: u64,
    restarts: u64,
    requests: u64,
    reconnects: u64,
    untaken: u64,
}

impl From<&LinkCounters> for LinkRecord {
    fn from(c: &LinkCounters) -> Self {
        Self {
            samples: c.samples,
            lost: c.lost,
            gaps: c.gaps,
            repeated: c.repeated,
            reordered: c.reordered,
            malformed: c.malformed,
            bad_checksum: c.bad_checksum,
            foreign: c.foreign,
            skipped_bytes: c.skipped_bytes,
            device_errors: c.device_errors,
            restarts: c.restarts,
            requests: c.requests,
            reconnects: c.reconnects,
            untaken: c.untaken,
        }
    }
}
