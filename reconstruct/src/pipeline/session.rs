//! A live scan with samples of which some cannot be used.

use super::history::History;
use super::live::{LAG, Live};
use super::live_settings::LiveSettings;
use super::reading::Reading;
use super::settings::{ReconstructError, possible};
use crate::systematic::{Budget, Calibration, Known};
use rod_core::{Rod, Sample};
use std::collections::VecDeque;

/// [`Live`] for samples of type `S`, of which some may not be usable. Each sample is returned with its answer, in order; one that is not
/// usable without an answer.
///
/// ```
/// use rod_core::{Pose, Reactions, Rod};
/// use rod_reconstruct::{Live, LiveSession, LiveSettings, Sample, noise_estimate::ChannelNoise};
/// let rod = Rod::new(0.1, 6.3e-4)?;
/// let settings = LiveSettings::new([1e-3, 1e-3, 2e-5].map(ChannelNoise::white), 2e-6);
/// let mut session = LiveSession::new(Live::new(&rod, &settings)?);
/// let mut answers = Vec::new();
/// for k in 0..2000 {
///     let sample = Sample::new(Pose { x: 2e-6 * f64::from(k), y: 0.0, phi: 1.5 }, Reactions::default());
///     let usable = (k != 7).then_some(&sample); // the sensor was overloaded
///     session.push(k, usable, |k, reading| answers.push((k, reading.is_some())));
/// }
/// session.finish(|k, reading| answers.push((k, reading.is_some())));
/// assert!(answers.iter().enumerate().all(|(k, answer)| *answer == (k as i32, k != 7)));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct LiveSession<S> {
    live: Live,
    /// Samples without an answer, and whether they are usable.
    waiting: VecDeque<(S, bool)>,
    /// The places so far, where errors are estimated that all samples share.
    history: Option<History>,
    /// Number of the sample after the last place in `history`.
    next: usize,
}

impl<S> LiveSession<S> {
    /// Before the first sample. Samples and rod are taken as they are.
    pub fn new(live: Live) -> Self {
        let waiting = VecDeque::with_capacity(live.delay() + 1);
        Self { live, waiting, history: None, next: 0 }
    }

    /// Before the first sample of a scan whose samples share errors of this budget, but for what a calibration tells of them. The scan begins
    /// with a free rod. The errors are estimated as the scan goes on, taken off, and what is left of them is in labels and standard
    /// deviations, as in [`reconstruct`](crate::reconstruct): from at most 400 places, each time their number has grown by a fifth. Then a
    /// sample takes up to some tenths of a second; all others take microseconds.
    ///
    /// # Errors
    /// [`ReconstructError`]: a setting, a budget or a calibration that is not possible.
    pub fn with_errors(
        rod: &Rod,
        settings: &LiveSettings,
        budget: &Budget,
        known: &Known,
    ) -> Result<Self, ReconstructError> {
        possible(budget, known)?;
        let exact = budget.is_none() && known.is_nothing();
        let history = (!exact).then(|| History::new(rod, budget, known, LAG));
        Ok(Self { history, ..Self::new(Live::new(rod, settings)?) })
    }

    /// The number of usable samples after a sample at which its answer comes.
    pub fn delay(&self) -> usize {
        self.live.delay()
    }

    /// What was found so far of the errors that all samples share.
    pub fn calibration(&self) -> Option<&Calibration> {
        self.history.as_ref().and_then(History::calibration)
    }

    /// Takes a sample, with its pose and reactions if it is usable, and calls `answer` for each sample whose answer is due.
    pub fn push(&mut self, sample: S, usable: Option<&Sample>, mut answer: impl FnMut(S, Option<Reading>)) {
        self.waiting.push_back((sample, usable.is_some()));
        if let Some(reading) = usable.and_then(|usable| self.live.push(usable)) {
            self.settle(reading, &mut answer);
        }
        self.learn();
        self.skip(&mut answer);
    }

    /// Ends the scan: calls `answer` for each of the remaining samples.
    pub fn finish(&mut self, mut answer: impl FnMut(S, Option<Reading>)) {
        while let Some(reading) = self.live.finish() {
            self.settle(reading, &mut answer);
        }
        self.skip(&mut answer);
    }

    /// Adds new places to those before, and gives what they tell to the answers that follow.
    fn learn(&mut self) {
        let Some(history) = &mut self.history else { return };
        if self.live.open().next_back().is_none_or(|(_, place)| place.index < self.next) {
            return;
        }
        for (tau, place) in self.live.open().filter(|(_, place)| place.index >= self.next) {
            history.push(tau, place);
        }
        let first = self.live.open().next().map(|(_, place)| place.index);
        self.next = self.live.open().next_back().map_or(self.next, |(_, place)| place.index + 1);
        if let Some((learned, passed)) = first.and_then(|first| history.learn(first)) {
            self.live.learn(learned, passed);
        }
    }

    /// A reading is for the oldest usable sample; those before it have none.
    fn settle(&mut self, reading: Reading, answer: &mut impl FnMut(S, Option<Reading>)) {
        self.skip(answer);
        if let Some((sample, _)) = self.waiting.pop_front() {
            answer(sample, Some(reading));
        }
    }

    /// Answers the oldest samples as long as they are not usable.
    fn skip(&mut self, answer: &mut impl FnMut(S, Option<Reading>)) {
        while self.waiting.front().is_some_and(|(_, usable)| !usable)
            && let Some((sample, _)) = self.waiting.pop_front()
        {
            answer(sample, None);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::LiveSettings;
    use crate::noise_estimate::ChannelNoise;
    use rod_core::{Pose, Reactions, Rod};

    #[test]
    fn every_sample_is_answered_once_in_order() {
        let rod = Rod::new(0.1, 6.3e-4).unwrap();
        let noise = [1e-3, 1e-3, 2e-5].map(ChannelNoise::white);
        let live = Live::new(&rod, &LiveSettings { half_window: 1e-4, ..LiveSettings::new(noise, 2e-6) }).unwrap();
        let mut session = LiveSession::new(live);
        let mut answers = Vec::new();
        for k in 0..2000 {
            let usable = !matches!(k, 0..3 | 500 | 1999);
            // a clamp that turns back for one sample
            let x = 2e-6 * f64::from(if k == 800 { 600 } else { k });
            let sample = Sample::new(Pose { x, y: 0.0, phi: 1.5 }, Reactions::default());
            session.push(k as usize, usable.then_some(&sample), |k, reading| answers.push((k, reading)));
        }
        session.finish(|k, reading| answers.push((k, reading)));
        assert_eq!(answers.len(), 2000);
        assert!(answers.iter().enumerate().all(|(k, answer)| answer.0 == k));
        let without: Vec<usize> = (0..2000).filter(|&k| answers[k].1.is_none()).collect();
        assert_eq!(without, [0, 1, 2, 500, 1999]);
        let turned = answers[800].1.unwrap().touch.unwrap_err().to_string();
        assert!(turned.contains("turns back"), "{turned}");
    }

    /// Estimates that the scan does not need are not subtracted: they moved the points by some tenths of a millimetre.
    #[cfg(feature = "contact")]
    #[test]
    fn points_of_a_sensor_without_errors_are_those_of_the_whole_scan() {
        use crate::{NoiseModel, Settings, reconstruct};
        use rod_contact::{ClampPath, Sweep};
        use rod_contours::{Composite, Parabola};
        let rod = Rod::from_diameter(0.1, 0.5e-3, 206e9).unwrap();
        let object = Composite::single(Parabola::new([0.03, 0.0], 50.0).unwrap()).unwrap();
        let pose = |x| Pose { x, y: -0.04, phi: std::f64::consts::FRAC_PI_2 };
        // free, A, B
        let path = ClampPath::new(pose(0.08), pose(0.01)).unwrap();
        let states = Sweep::new(&rod, &object, path, 1e-5).unwrap().run().states;
        let white = Reactions { f0x: 5e-4, f0y: 5e-4, m0z: 2e-5 };
        let mut noise = NoiseModel { white, ..NoiseModel::default() }.generator(3).unwrap();
        let sample = |state: &rod_contact::State| Sample::new(state.pose, noise.sample(state.reactions).unwrap());
        let samples: Vec<Sample> = states.iter().map(sample).collect();
        let settings = LiveSettings::of_free_rod(&rod, &samples[..500], Reactions::default()).unwrap();
        let budget = Budget::laboratory(&rod);
        let mut session = LiveSession::with_errors(&rod, &settings, &budget, &Known::NOTHING).unwrap();
        let mut live = Vec::new();
        for sample in &samples {
            session.push((), Some(sample), |(), reading| live.extend(reading));
        }
        session.finish(|(), reading| live.extend(reading));
        let whole = reconstruct(&rod, &samples, &Settings::default()).unwrap();
        let off = |(live, whole): (&Reading, &Reading)| {
            let (live, whole) = (live.touch.ok()?, whole.touch.ok()?);
            let (sin, cos) = whole.alpha.sin_cos();
            Some(((live.x - whole.x) * sin - (live.y - whole.y) * cos).abs())
        };
        let mut off: Vec<f64> = live.iter().zip(&whole.readings).filter_map(off).collect();
        off.sort_by(f64::total_cmp);
        assert!(
            off.len() > 2000 && off[off.len() / 2] < 2e-5,
            "{} points, off {:?} m",
            off.len(),
            off.get(off.len() / 2)
        );
    }
}
