//! Samples that are missing where the counter of the sensor cannot tell: it started anew, or there is none.

use vibrissa::hw::{Quality, ReactionSample};

/// Weight of a new time from sample to sample in its mean. Larger: jitter of the times counts as samples.
const WEIGHT: f64 = 0.01;

/// Counts missing samples by the times of those that came.
#[derive(Clone, Debug, Default)]
pub(super) struct Losses {
    /// Time and number of the last sample.
    last: Option<(f64, Option<u64>)>,
    /// Mean time (s) and mean step of the number from sample to sample.
    period: Option<f64>,
    stride: Option<f64>,
    lost: u64,
}

impl Losses {
    /// Takes the next sample.
    pub fn push(&mut self, sample: &ReactionSample) {
        let here = (sample.t, sample.raw.sequence);
        let Some((t, number)) = self.last.replace(here) else { return };
        let (elapsed, ahead) =
            (sample.t - t, here.1.zip(number).map(|(now, before)| now.saturating_sub(before) as f64));
        if !sample.quality.intersects(Quality::GAP_BEFORE | Quality::RESTARTED) {
            mean(&mut self.period, elapsed);
            ahead.into_iter().for_each(|ahead| mean(&mut self.stride, ahead));
            return;
        }
        let Some(period) = self.period else { return };
        let by_time = (elapsed / period).round() - 1.0;
        let by_number = ahead.zip(self.stride).map_or(0.0, |(ahead, stride)| (ahead / stride).round() - 1.0);
        if sample.quality.contains(Quality::RESTARTED) || ahead.is_none() {
            self.lost += (by_time - by_number.max(0.0)).max(0.0) as u64;
        }
    }

    /// Mean time from sample to sample, s.
    pub fn period(&self) -> Option<f64> {
        self.period
    }

    /// Missing samples that no counter tells of.
    pub fn lost(&self) -> u64 {
        self.lost
    }
}

fn mean(of: &mut Option<f64>, value: f64) {
    if value > 0.0 {
        *of = Some(of.map_or(value, |mean| mean + WEIGHT * (value - mean)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use vibrissa::Pose;
    use vibrissa::hw::{Channels, OutOfPlane, RawSample};
    use vibrissa::rod::Reactions;

    fn sample(t: f64, number: Option<u64>, quality: Quality) -> ReactionSample {
        let raw = RawSample { sequence: number, quality, ..RawSample::new(t, Channels::from([0.0; 6])) };
        let pose = Pose { x: 0.0, y: 0.0, phi: 0.0 };
        let (reactions, out_of_plane) = (Reactions::default(), OutOfPlane::default());
        ReactionSample { t, pose, reactions, sigma: None, systematic: None, out_of_plane, quality, raw }
    }

    #[test]
    fn a_counter_that_starts_anew_hides_what_the_times_show() {
        let mut losses = Losses::default();
        (0..100_u32).for_each(|k| losses.push(&sample(1e-3 * f64::from(k), Some(k.into()), Quality::empty())));
        // the link counts these itself
        losses.push(&sample(0.11, Some(110), Quality::GAP_BEFORE));
        assert_eq!(losses.lost(), 0);
        // 500 ms without power
        losses.push(&sample(0.611, Some(111), Quality::GAP_BEFORE | Quality::RESTARTED));
        assert_eq!(losses.lost(), 500);
        let mut numberless = Losses::default();
        (0..100_u32).for_each(|k| numberless.push(&sample(1e-3 * f64::from(k), None, Quality::empty())));
        numberless.push(&sample(0.150, None, Quality::GAP_BEFORE));
        assert_eq!(numberless.lost(), 50);
    }
}
