//! Reactions that change while the clamp stands contradict the clocks.
//!
//! A clamp that has not started or has arrived, and one that stops on its way, cannot change the reactions of a quasi-static rod. A delay of
//! the stage's clock under which they change then is wrong, whatever work and energy say.

use super::stage_log::{STILL, StageLog, distance};
use super::timed::{SIGMAS, Timed, timed_averages};
use vibrissa::Pose;

/// Largest mean speed of a clamp that stands, in its largest speed: a slow motion within the resolution is none.
const SLOW: f64 = 0.02;
/// Part of the range of a reaction by which it may change without noise: the error of gains, creep, and what the resolution of the stage hides.
const CREEP: f64 = 0.01;

/// When the clamp stands, on the stage's clock, and how the reactions go on, on the sensor's clock.
pub(super) struct Standing {
    /// Intervals, s; the first begins and the last ends nowhere.
    rests: Vec<[f64; 2]>,
    /// Averages of the reactions with their times, s.
    averages: Vec<(f64, [f64; 3])>,
    /// Changes that are none.
    limits: [f64; 3],
    /// Time of an average, s.
    width: f64,
}

/// A change of the reactions while the clamp stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Contradiction {
    /// When, s on the sensor's clock.
    pub t: f64,
    /// From when to when the clamp stands, s on the sensor's clock.
    pub stands: [f64; 2],
}

impl Standing {
    /// None where there are too few samples, or the clamp never moves.
    pub fn new(sensed: &[Timed], stage: &StageLog) -> Option<Self> {
        let (averages, noise) = timed_averages(sensed)?;
        let averages: Vec<(f64, [f64; 3])> = averages
            .iter()
            .map(|sample| (sample.pose.x, [sample.reactions.f0x, sample.reactions.f0y, sample.reactions.m0z]))
            .collect();
        let limits = [0, 1, 2].map(|k: usize| {
            let values = averages.iter().map(|one| one.1[k]);
            let (least, most) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)));
            SIGMAS * noise[k] + CREEP * (most - least)
        });
        let width = (averages.last()?.0 - averages.first()?.0) / averages.len() as f64;
        Some(Self { rests: rests(stage)?, averages, limits, width })
    }

    /// A change of the reactions while the clamp stands, if the stage's clock has this delay, s.
    pub fn contradiction(&self, delay: f64) -> Option<Contradiction> {
        self.rests.iter().find_map(|rest| {
            let stands = rest.map(|t| t + delay);
            // an average at the edge is of moments on both sides
            let from = self.averages.partition_point(|one| one.0 < stands[0] + self.width);
            let to = self.averages.partition_point(|one| one.0 <= stands[1] - self.width);
            let within = self.averages.get(from..to).filter(|within| within.len() > 1)?;
            (0..3).find_map(|k: usize| {
                let mut sorted: Vec<f64> = within.iter().map(|one| one.1[k]).collect();
                sorted.sort_unstable_by(f64::total_cmp);
                let usual = sorted[sorted.len() / 2];
                let changed = within.iter().find(|one| (one.1[k] - usual).abs() > self.limits[k])?;
                Some(Contradiction { t: changed.0, stands })
            })
        })
    }
}

/// When the clamp stands; none if it never moves.
fn rests(stage: &StageLog) -> Option<Vec<[f64; 2]>> {
    let rows = stage.rows();
    let [way, turn] = stage.extent();
    if way == 0.0 && turn == 0.0 {
        return None;
    }
    let part = |part: f64, of: f64| if of > 0.0 { part / of } else { 0.0 };
    // in parts of the way or of the turn
    let apart = |a: &Pose, b: &Pose| part(distance(a, b), way).max(part((a.phi - b.phi).abs(), turn));
    let [from, to] = stage.span();
    let step = (to - from) / 100.0;
    let speeds = (0..100).map(|k| {
        let t = from + f64::from(k) * step;
        apart(&stage.at(t), &stage.at(t + step)) / step
    });
    let fastest = speeds.fold(0.0, f64::max);
    let mut rests: Vec<[f64; 2]> = vec![[f64::NEG_INFINITY, from]];
    let mut k = 0;
    while k + 1 < rows.len() {
        let (t, pose) = rows[k];
        let still = rows[k..].iter().take_while(|row| apart(&pose, &row.1) <= STILL).count();
        let (end, last) = rows[k + still - 1];
        if still > 1 && apart(&pose, &last) <= SLOW * fastest * (end - t) {
            match rests.last_mut() {
                Some(before) if before[1] == t => before[1] = end,
                _ => rests.push([t, end]),
            }
            k += still - 1;
        } else {
            k += 1;
        }
    }
    match rests.last_mut() {
        Some(last) if last[1] == to => last[1] = f64::INFINITY,
        _ => rests.push([to, f64::INFINITY]),
    }
    Some(rests)
}

#[cfg(test)]
mod tests {
    use super::*;
    use vibrissa::rod::Reactions;

    /// A clamp that stands for 2 s, moves for 4 s, stands for 3 s, moves on for 4 s and stands for 2 s; the force follows it.
    fn moved() -> (Vec<Timed>, StageLog) {
        let way = |t: f64| (t - 2.0).clamp(0.0, 4.0) + (t - 9.0).clamp(0.0, 4.0);
        let sensed = (0..1500).map(|k| {
            let t = 0.01 * f64::from(k);
            (t, Reactions { f0x: 0.1 * way(t), f0y: 0.0, m0z: 0.0 })
        });
        let rows = (0..=150).map(|k| {
            let t = 0.1 * f64::from(k);
            (t, Pose { x: 0.01 * way(t), y: 0.0, phi: 1.5 })
        });
        (sensed.collect(), StageLog::new(rows.collect()).unwrap())
    }

    #[test]
    fn a_clamp_that_stands_refutes_delays() {
        let (sensed, log) = moved();
        let standing = Standing::new(&sensed, &log).unwrap();
        assert_eq!(standing.rests.len(), 3, "{:?}", standing.rests);
        assert_eq!(standing.contradiction(0.0), None);
        assert_eq!(standing.contradiction(0.05), None);
        for delay in [0.5, -0.5, 2.0, 10.0, -10.0] {
            let found = standing.contradiction(delay).unwrap_or_else(|| panic!("{delay}"));
            assert!(found.stands[0] <= found.t && found.t <= found.stands[1], "{delay}: {found:?}");
        }
    }

    #[test]
    fn a_slow_motion_is_no_standing() {
        let rows = (0..=10_000).map(|k| (f64::from(k), Pose { x: 1e-5 * f64::from(k), y: 0.0, phi: 0.0 }));
        let log = StageLog::new(rows.collect()).unwrap();
        assert_eq!(rests(&log).unwrap(), [[f64::NEG_INFINITY, 0.0], [10_000.0, f64::INFINITY]]);
    }
}
