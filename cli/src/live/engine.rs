//! Samples in, answers out, each with the sample that it is for.

use std::collections::VecDeque;
use vibrissa::hw::ReactionSample;
use vibrissa::reconstruct::{Live, Reading};

/// The answer to one sample.
#[derive(Clone, Copy, Debug)]
pub struct Answer {
    /// The sample.
    pub sample: ReactionSample,
    /// What was found; none where the sample is not usable, as its quality says.
    pub reading: Option<Reading>,
}

/// Live identification of samples some of which are not usable: those are left out of it, and answered in their turn.
#[derive(Debug)]
pub struct Engine {
    live: Live,
    /// Those not answered yet.
    waiting: VecDeque<ReactionSample>,
}

impl Engine {
    /// Before the first sample.
    pub fn new(live: Live) -> Self {
        let waiting = VecDeque::with_capacity(live.delay() + 1);
        Self { live, waiting }
    }

    /// Takes a sample and answers those that are due, in order.
    pub fn push(&mut self, sample: ReactionSample, mut answer: impl FnMut(Answer)) {
        self.waiting.push_back(sample);
        if sample.quality.is_usable()
            && let Some(reading) = self.live.push(&sample.sample())
        {
            self.settle(reading, &mut answer);
        }
        self.unusable(&mut answer);
    }

    /// No more samples come: answers those left.
    pub fn finish(&mut self, mut answer: impl FnMut(Answer)) {
        while let Some(reading) = self.live.finish() {
            self.settle(reading, &mut answer);
        }
        self.unusable(&mut answer);
    }

    /// A reading is for the oldest usable sample; those before it have none.
    fn settle(&mut self, reading: Reading, answer: &mut impl FnMut(Answer)) {
        self.unusable(answer);
        if let Some(sample) = self.waiting.pop_front() {
            answer(Answer { sample, reading: Some(reading) });
        }
    }

    /// Answers the samples at the front that are not usable.
    fn unusable(&mut self, answer: &mut impl FnMut(Answer)) {
        while let Some(&sample) = self.waiting.front().filter(|sample| !sample.quality.is_usable()) {
            self.waiting.pop_front();
            answer(Answer { sample, reading: None });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use vibrissa::hw::{OutOfPlane, Quality, RawSample};
    use vibrissa::reconstruct::LiveSettings;
    use vibrissa::reconstruct::noise_estimate::ChannelNoise;
    use vibrissa::rod::Reactions;
    use vibrissa::{Pose, Rod};

    #[test]
    fn every_sample_is_answered_once_in_order() {
        let rod = Rod::new(0.1, 6.3e-4).unwrap();
        let noise = [1e-3, 1e-3, 2e-5].map(ChannelNoise::white);
        let live = Live::new(&rod, &LiveSettings { half_window: 1e-4, ..LiveSettings::new(noise, 2e-6) }).unwrap();
        let mut engine = Engine::new(live);
        let mut answers = Vec::new();
        for k in 0..2000 {
            let quality = match k {
                0..3 | 500 | 1999 => Quality::SATURATED,
                700 => Quality::GAP_BEFORE,
                _ => Quality::empty(),
            };
            // a clamp that turns back for one sample
            let x = 2e-6 * f64::from(if k == 800 { 600 } else { k });
            let sample = ReactionSample {
                t: f64::from(k),
                pose: Pose { x, y: 0.0, phi: 1.5 },
                reactions: Reactions::default(),
                sigma: None,
                systematic: None,
                out_of_plane: OutOfPlane::default(),
                quality,
                raw: RawSample::default(),
            };
            engine.push(sample, |answer| answers.push(answer));
        }
        engine.finish(|answer| answers.push(answer));
        assert_eq!(answers.len(), 2000);
        assert!(answers.iter().enumerate().all(|(k, answer)| answer.sample.t == k as f64));
        let without: Vec<usize> = (0..2000).filter(|&k| answers[k].reading.is_none()).collect();
        assert_eq!(without, [0, 1, 2, 500, 1999]);
        let turned = answers[800].reading.unwrap().touch.unwrap_err().to_string();
        assert!(turned.contains("turns back"), "{turned}");
    }
}
