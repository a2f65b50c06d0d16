//! Whether the clocks of a sensor and of its stage are one, and the question where that is not known.

use super::rod;
use crate::inspect::InspectOptions;
use crate::inspect::clock::{DelayFound, delay, joined, range};
use crate::inspect::look::Look;
use crate::inspect::physics::{InFrame, Measured, Source};
use crate::inspect::report::{InspectedFile, Question};
use crate::inspect::shell_word::quoted;
use crate::inspect::stage_log::StageLog;
use crate::inspect::standing::{Contradiction, Standing};
use crate::inspect::timed::{Timed, changes};
use crate::inspect::values::factor;
use crate::live::{SensorTimes, origin_of};
use crate::{LiveScan, StageDelay};
use std::path::Path;
use vibrissa::hw::recording::Role;

/// How the question begins.
pub(super) const CLOCKS: &str = "how are the clocks of the sensor and of the stage related?";
/// Shift of the object by any delay that fits, in lengths of the rod, that needs no question: half of it is about the systematic error of an ordinary
/// laboratory. Times of two files that begin and end together, or count from 1970, are no reason to accept more: each may have a clock of its own.
const SHIFT: f64 = 0.015;
/// The same up to which a delay is proposed: the physics determines it, if not well.
const PROPOSED: f64 = 0.1;
/// Delays, evenly spaced, at which the frame is tried if it fits at none of these. A delay of a tenth of the motion leaves most of the work right.
const ANYWHERE: usize = 16;
/// Times to which the best delay is searched anew in the frame that it suggests.
const ROUNDS: usize = 2;

/// The delay that was stated.
pub(super) fn stage_delay(options: &InspectOptions) -> Option<StageDelay> {
    options.stage_delay.or(options.setup.as_ref().and_then(|setup| setup.1.stage_delay))
}

/// The times of a sensor and of its stage.
#[derive(Clone, Copy, Debug)]
pub(super) struct Clocks {
    sensor: [f64; 2],
    stage: [f64; 2],
    /// The larger step of both, s.
    step: f64,
    /// The smaller one.
    short: f64,
    /// The delay that was stated, s.
    stated: Option<f64>,
    /// What is subtracted from the times of the stage, s: the time 0 of a sensor that counts from the start of its file.
    origin: f64,
}

impl Clocks {
    /// None where the times of one are not known. `scan` reads the times of a sensor's file that is no table.
    pub fn of(sensor: &Look, stage: &Look, scan: Option<&LiveScan>, options: &InspectOptions) -> Option<Self> {
        let step = |look: &Look| {
            let column = look.table.as_ref().and_then(|table| table.1.of(Role::Time));
            column.map_or(0.0, |column| (factor(column) * column.values.step).abs())
        };
        let stated = stage_delay(options).map(StageDelay::seconds);
        let of_sensor = match sensor.table {
            Some(_) => SensorTimes { span: sensor.times()?, step: step(sensor), epoch: None },
            None => SensorTimes::read(&sensor.path, scan?)?,
        };
        let (step, short) = (of_sensor.step.max(step(stage)), of_sensor.step.min(step(stage)));
        let times = stage.times()?;
        let origin = origin_of(times[0], of_sensor.epoch);
        Some(Self { sensor: of_sensor.span, stage: times.map(|t| t - origin), step, short, stated, origin })
    }

    /// Whether they have times in common.
    pub fn overlap(&self) -> bool {
        let delay = self.stated.unwrap_or(0.0);
        self.sensor[0] < self.stage[1] + delay && self.stage[0] + delay < self.sensor[1]
    }

    /// Whether both begin and end together, as far as their steps allow: no proof of one clock, but no reason to doubt it either.
    pub fn are_alike(&self) -> bool {
        // half a step more for rounding
        let near = |k: usize, step: f64| (self.sensor[k] - self.stage[k]).abs() <= step + 0.5 * self.short;
        near(0, 0.0) && near(1, self.step)
    }

    /// Asks where the times leave it open.
    pub fn ask_without_physics(&self, file: &mut InspectedFile, options: &InspectOptions) {
        // where there are common times the physics may answer it
        if stage_delay(options).is_none() && !self.overlap() {
            self.ask(file, "The physics can be asked when the other questions are answered.", None, &|_| false);
        }
    }

    /// Compares the clocks by times and physics; asks where they leave it open. Returns the delay by which the samples are to be joined for
    /// other questions, s.
    pub fn compare(
        &self,
        file: &mut InspectedFile,
        scan: &LiveScan,
        path: &Path,
        log: Option<StageLog>,
        columns: &[Measured; 6],
        options: &InspectOptions,
    ) -> f64 {
        let stated = self.stated.unwrap_or(0.0);
        let Some(log) = log.map(|log| log.since(self.origin)) else { return stated };
        let Ok(samples) = scan.standing(path, log.at(0.0)) else { return stated };
        let sensed: Vec<Timed> = samples.iter().map(|sample| (sample.t, sample.reactions)).collect();
        let found = self.search(&sensed, &log, columns, options);
        let motion = log.motion();
        let speed = motion.map_or(0.0, |motion| motion.1);
        if let (Some((stage, _)), Some(forces)) = (motion, changes(&sensed)) {
            let [a, b, c, d] = [stage[0], stage[1], forces[0], forces[1]];
            file.fact(
                "clocks",
                format!(
                    "the stage moves from {a:.3} to {b:.3} s of its clock, the reactions change from {c:.3} to {d:.3} s of the sensor's clock"
                ),
            );
        }
        let standing = Standing::new(&sensed, &log);
        let is_refuted = |delay: f64| {
            let found = standing.as_ref().and_then(|standing| standing.contradiction(delay));
            found.is_some_and(|found| !is_outside(&found))
        };
        let contradiction =
            standing.as_ref().filter(|_| self.overlap()).and_then(|standing| standing.contradiction(stated));
        let contradicted = contradiction.map(|found| contradicted(&found, stated));
        if let Some(text) = &contradicted {
            file.fact("contradiction", text.clone());
        }
        let is_settled = self.stated.is_some() && contradiction.is_none_or(|found| is_outside(&found));
        let said = |text: String| contradicted.iter().cloned().chain([text]).collect::<Vec<_>>().join(" ");
        let Some(found) = found else {
            if !is_settled {
                let text = "Work and elastic energy agree at no delay, so that the physics does not determine it.";
                self.ask(file, &said(text.to_owned()), None, &is_refuted);
            }
            return stated;
        };
        let [least, most] = found.interval;
        let size = rod(options).map_or_else(|| way(&log), |rod| rod.rod.length());
        let farthest = (least - stated).abs().max((most - stated).abs());
        // half a step is the rounding of times
        let is_within = (least - 0.5 * self.short..=most + 0.5 * self.short).contains(&stated);
        let is_confirmed = is_within && speed * farthest <= SHIFT * size && contradicted.is_none();
        let is_determined = found.is_bounded == [true; 2] && speed * found.width_by_work <= PROPOSED * size;
        let text = sentence(&found, speed, is_determined);
        file.fact("delay of the stage's clock", text.clone());
        if is_confirmed || is_settled {
            return stated;
        }
        self.ask(file, &said(text), is_determined.then_some(&found), &is_refuted);
        if is_determined { found.best } else { stated }
    }

    /// The delay in the frame that explains the samples best: those of clocks that are one, begin together or end together.
    fn search(
        &self,
        sensed: &[Timed],
        log: &StageLog,
        columns: &[Measured; 6],
        options: &InspectOptions,
    ) -> Option<DelayFound> {
        let rod = rod(options).map(|rod| &rod.rod);
        let source = if options.setup.is_some() { Source::Setup } else { Source::Sensor };
        let at = |delay: f64| InFrame::of(&joined(sensed, log, delay), columns, source, rod);
        let mut starts: Vec<f64> = Vec::new();
        for delay in [self.stated.unwrap_or(0.0), self.sensor[0] - self.stage[0], self.sensor[1] - self.stage[1]] {
            if starts.iter().all(|known| (known - delay).abs() > self.step) {
                starts.push(delay);
            }
        }
        let best = |delays: Vec<f64>| delays.into_iter().filter_map(at).max_by(|a, b| a.score().total_cmp(&b.score()));
        let [least, most] = range(self.sensor, self.stage);
        let evenly = || (0..=ANYWHERE).map(|k| least + (most - least) * k as f64 / ANYWHERE as f64).collect();
        let mut frame = best(starts).or_else(|| best(evenly()))?;
        let mut found = delay(sensed, log, &frame, rod);
        for _ in 0..ROUNDS {
            let Some(best) = found.and_then(|found| at(found.best)) else { break };
            if best.score() <= frame.score() {
                break;
            }
            let again = delay(sensed, log, &best, rod);
            if again.is_none() {
                break;
            }
            (frame, found) = (best, again);
        }
        found
    }

    /// Delays that the standing clamp refutes are no answers.
    fn ask(&self, file: &mut InspectedFile, said: &str, found: Option<&DelayFound>, is_refuted: &dyn Fn(f64) -> bool) {
        let [first, last] = self.sensor;
        let [from, to] = self.stage;
        let text = format!(
            "{CLOCKS} The sensor's times are {first:.4} to {last:.4} s, the stage's {from:.4} to {to:.4} s. {said} --stage-delay TIME is added to the \
             times of the stage"
        );
        let mut delays: Vec<(f64, String)> = Vec::new();
        let mut answer = |delay: f64, why: &str| {
            if !is_refuted(delay) && delays.iter().all(|known| (known.0 - delay).abs() > self.step) {
                let value = format!("{} s", rounded(delay));
                delays.push((delay, format!("--stage-delay {} ({why})", quoted(&value))));
            }
        };
        if let Some(found) = found {
            answer(found.best, "by the physics");
        }
        if self.overlap() {
            answer(0.0, "both have one clock");
        }
        answer(first - from, "both files begin at the same moment");
        answer(last - to, "both files end at the same moment");
        file.questions.push(Question { text, answers: delays.into_iter().map(|delay| delay.1).collect() });
    }
}

/// Whether a change is before or after the log of the stage: a log that begins or ends within the motion is no clock that is wrong.
fn is_outside(found: &Contradiction) -> bool {
    found.stands.iter().any(|t| t.is_infinite())
}

/// Rounded to 0.1 ms.
fn rounded(seconds: f64) -> f64 {
    let rounded = (1e4 * seconds).round() / 1e4;
    if rounded == 0.0 { 0.0 } else { rounded }
}

/// Size of the path, m.
fn way(log: &StageLog) -> f64 {
    let [from, to] = log.span();
    log.motion().map_or(0.0, |motion| motion.1 * (to - from))
}

/// A change of the reactions while the clamp stands, in words.
fn contradicted(found: &Contradiction, delay: f64) -> String {
    let Contradiction { t, stands: [from, to] } = *found;
    let when = match (from.is_finite(), to.is_finite()) {
        (false, _) => format!("before it starts at {to:.3} s"),
        (true, false) => format!("after it arrives at {from:.3} s"),
        (true, true) => format!("while it stands from {from:.3} to {to:.3} s"),
    };
    let delay = if delay == 0.0 { "With one clock".to_owned() } else { format!("With a delay of {delay:.4} s") };
    format!("{delay} the reactions change at {t:.3} s although the clamp does not move, {when}.")
}

/// `is_determined` tells a delay that is known well enough to be proposed.
fn sentence(found: &DelayFound, speed: f64, is_determined: bool) -> String {
    let [least, most] = found.interval;
    let shift = 1e3 * speed * (most - least);
    let range = format!("{least:.4} to {most:.4} s");
    let effect = format!("within this range the object is shifted by up to {shift:.2} mm");
    let by = format!("concordance of work and elastic energy {:+.2}", found.concordance);
    match found.is_bounded {
        [true, true] if is_determined => {
            format!("The physics fits a delay of {:.4} s (95 %: {range}; {effect}; {by}).", found.best)
        }
        [true, true] | [false, false] => {
            format!("The physics does not determine the delay: {range} fit ({effect}; {by}).")
        }
        [false, true] => format!("The physics gives only an upper bound of the delay: {range} fit ({effect}; {by})."),
        [true, false] => format!("The physics gives only a lower bound of the delay: {range} fit ({effect}; {by})."),
    }
}
