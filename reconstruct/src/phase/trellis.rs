//! The most likely sequence of phases.

use super::diagram::{Break, transition_log_odds};
use super::label::Label;

/// Factor on all log-odds for the probabilities of labels. The criteria of neighbouring places and the breaks share errors, so that their
/// evidence counts several times. Larger: labels claim more than they hold; smaller: less. Chosen on 98 recordings of eleven scenes with noise
/// and shared errors: the log-likelihood of the true labels is largest, and the shares of right labels are those claimed.
const SHARED: f64 = 0.3;

/// The evidence of one place as the trellis uses it: the log-likelihood of each label, and the break between this place and the one before.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Observation {
    pub scores: [f64; 5],
    pub between: Option<Break>,
}

/// The most likely sequence of labels (Viterbi's algorithm) and the probability of each label (forward-backward algorithm). The
/// memory is kept from one run to the next.
#[derive(Clone, Debug, Default)]
pub(crate) struct Trellis {
    steps: Vec<[u8; 5]>,
    ahead: Vec<[f64; 5]>,
    labels: Vec<(Label, f64)>,
    /// Whether the probabilities of BA and BB are that of several contacts, because nothing tells one from the other.
    alike: bool,
}

impl Trellis {
    /// For a rod of which nothing tells BA from BB: the probability of either is that of several contacts.
    pub fn alike() -> Self {
        Self { alike: true, ..Self::default() }
    }

    /// With memory for this many places.
    pub fn with_capacity(places: usize) -> Self {
        let mut trellis = Self::default();
        trellis.steps.reserve(places);
        trellis.ahead.reserve(places);
        trellis.labels.reserve(places);
        trellis
    }

    /// The label of each place and its probability. `before` are the scores of the best sequences up to the first place, one for each label;
    /// they are equal where no place comes before.
    pub fn run(
        &mut self,
        before: &[f64; 5],
        observations: impl DoubleEndedIterator<Item = Observation> + Clone,
    ) -> &[(Label, f64)] {
        self.steps.clear();
        self.labels.clear();
        let mut best = *before;
        for observation in observations.clone() {
            let from;
            (best, from) = viterbi_step(&best, &observation);
            self.steps.push(from);
        }
        let mut label = most_likely(&best);
        for step in self.steps.iter().rev() {
            self.labels.push((Label::ALL[label], 0.0));
            label = usize::from(step[label]);
        }
        self.labels.reverse();
        self.set_probabilities(before, observations);
        &self.labels
    }

    /// The probability of each label at each place, from evidence that allows for shared errors itself. `before` are the logs of the
    /// [probabilities](forward_probabilities) up to there.
    pub fn label_probabilities(
        &mut self,
        before: &[f64; 5],
        observations: impl DoubleEndedIterator<Item = Observation> + Clone,
    ) -> &[[f64; 5]] {
        self.ahead.clear();
        let mut ahead = [0.0; 5];
        for observation in observations.clone().rev() {
            self.ahead.push(ahead);
            let with_own = std::array::from_fn(|i| ahead[i] + observation.scores[i]);
            ahead = sum_over_labels(&with_own, observation.between, true, 1.0);
        }
        let mut behind = *before;
        for (observation, ahead) in observations.zip(self.ahead.iter_mut().rev()) {
            behind = forward_probabilities(&behind, &observation);
            let both: [f64; 5] = std::array::from_fn(|i| behind[i] + ahead[i]);
            let total = log_sum_exp(both);
            *ahead = both.map(|score| (score - total).exp());
        }
        self.ahead.reverse();
        &self.ahead
    }

    fn set_probabilities(
        &mut self,
        before: &[f64; 5],
        observations: impl DoubleEndedIterator<Item = Observation> + Clone,
    ) {
        self.ahead.clear();
        let scaled = |scores: &[f64; 5]| scores.map(|score| SHARED * score);
        let mut ahead = [0.0; 5];
        for observation in observations.clone().rev() {
            self.ahead.push(ahead);
            let own = scaled(&observation.scores);
            let with_own = std::array::from_fn(|i| ahead[i] + own[i]);
            ahead = sum_over_labels(&with_own, observation.between, true, SHARED);
        }
        let mut behind = scaled(before);
        for ((observation, ahead), found) in observations.zip(self.ahead.iter().rev()).zip(&mut self.labels) {
            behind = sum_over_labels(&behind, observation.between, false, SHARED);
            let own = scaled(&observation.scores);
            behind = std::array::from_fn(|i| behind[i] + own[i]);
            let both: [f64; 5] = std::array::from_fn(|i| behind[i] + ahead[i]);
            let total = log_sum_exp(both);
            let of = |label: Label| (both[label as usize] - total).exp();
            let either = self.alike && found.0.several();
            found.1 = if either { (of(Label::BA) + of(Label::BB)).min(1.0) } else { of(found.0) };
        }
    }
}

/// Log of the probability of each label at a place, given the places up to it, from that at the place before.
pub(crate) fn forward_probabilities(before: &[f64; 5], observation: &Observation) -> [f64; 5] {
    let prior = sum_over_labels(before, observation.between, false, 1.0);
    let with_own: [f64; 5] = std::array::from_fn(|k| prior[k] + observation.scores[k]);
    let total = log_sum_exp(with_own);
    with_own.map(|score| score - total)
}

/// One step of Viterbi's algorithm: the best score of a sequence that ends in each label, and the label before it.
pub(crate) fn viterbi_step(before: &[f64; 5], observation: &Observation) -> ([f64; 5], [u8; 5]) {
    let mut best = [f64::NEG_INFINITY; 5];
    let mut from = [0; 5];
    for (to, label) in Label::ALL.into_iter().enumerate() {
        for (origin, start) in Label::ALL.into_iter().enumerate() {
            let score = before[origin] + transition_log_odds(start, label, observation.between);
            if score > best[to] {
                (best[to], from[to]) = (score, origin as u8);
            }
        }
        best[to] += observation.scores[to];
    }
    (best, from)
}

/// The number of the label with the greatest score.
pub(crate) fn most_likely(scores: &[f64; 5]) -> usize {
    (1..5).fold(0, |best, k| if scores[k] > scores[best] { k } else { best })
}

/// The log-probabilities behind a transition between two places: the sum over all labels before it or, with `back`, after it. The factor
/// multiplies the log-odds of the transition.
fn sum_over_labels(scores: &[f64; 5], between: Option<Break>, back: bool, factor: f64) -> [f64; 5] {
    std::array::from_fn(|to| {
        log_sum_exp(std::array::from_fn(|from| {
            let (u, v) = if back { (to, from) } else { (from, to) };
            scores[from] + factor * transition_log_odds(Label::ALL[u], Label::ALL[v], between)
        }))
    })
}

/// Log of a sum of exponentials.
fn log_sum_exp(scores: [f64; 5]) -> f64 {
    let most = scores.into_iter().fold(f64::NEG_INFINITY, f64::max);
    most + scores.into_iter().map(|score| (score - most).exp()).sum::<f64>().ln()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn observation(likely: Label, by: f64, between: Option<Break>) -> Observation {
        Observation { scores: Label::ALL.map(|label| if label == likely { by } else { 0.0 }), between }
    }

    #[test]
    fn one_doubtful_place_changes_nothing_and_a_break_lets_the_phase_change() {
        let kink = Break { index: 5, jump: false, score: 200.0 };
        let jump = Some(Break { jump: true, ..kink });
        let kink = Some(kink);
        let mut observations = vec![observation(Label::B, 8.0, None); 10];
        observations[3] = observation(Label::BB, 20.0, None);
        observations.truncate(6);
        observations.extend((0..4).map(|k| observation(Label::BB, 8.0, if k == 0 { kink } else { None })));
        let mut trellis = Trellis::default();
        let found = trellis.run(&[0.0; 5], observations.iter().copied()).to_vec();
        assert!(found[..6].iter().all(|f| f.0 == Label::B) && found[6..].iter().all(|f| f.0 == Label::BB), "{found:?}");
        assert!(found[1].1 > 0.99 && found[3].1 > 0.9 && found.iter().all(|f| (-1.0..=1.0).contains(&f.1)));
        // from A to BB no single contact comes or goes
        let observations =
            [observation(Label::A, 9.0, None), observation(Label::BB, 9.0, kink), observation(Label::B, 7.0, None)];
        assert_eq!(trellis.run(&[0.0; 5], observations.iter().copied())[1].0, Label::B);
        let observations = [observation(Label::A, 9.0, None), observation(Label::BB, 9.0, jump)];
        assert_eq!(trellis.run(&[0.0; 5], observations.iter().copied())[1].0, Label::BB);
    }

    #[test]
    fn two_labels_that_nothing_tells_apart_are_as_likely_together_as_one_of_them_alone() {
        // BA and BB are equally likely, against B
        let observations = vec![Observation { scores: [0.0, 0.0, 0.0, 30.0, 30.0], between: None }; 8];
        let of = |mut trellis: Trellis| trellis.run(&[0.0; 5], observations.iter().copied()).to_vec();
        let (told, alike) = (of(Trellis::default()), of(Trellis::alike()));
        assert!(told.iter().zip(&alike).all(|(one, other)| one.0 == other.0 && one.0.several()));
        assert!(told.iter().all(|found| found.1 < 0.6) && alike.iter().all(|found| found.1 > 0.999 && found.1 <= 1.0));
    }

    #[test]
    fn parts_one_after_the_other_are_the_whole() {
        let observations: Vec<Observation> = (0..40_u32)
            .map(|k| {
                observation(
                    Label::ALL[(k / 7) as usize % 5],
                    3.0,
                    (k % 7 == 0).then_some(Break { index: 0, jump: true, score: 99.0 }),
                )
            })
            .collect();
        let whole = Trellis::default().run(&[0.0; 5], observations.iter().copied()).to_vec();
        let before =
            observations[..20].iter().fold([0.0; 5], |before, observation| viterbi_step(&before, observation).0);
        let rest = Trellis::default().run(&before, observations[20..].iter().copied()).to_vec();
        assert!(whole[20..].iter().zip(&rest).all(|(u, v)| u.0 == v.0));
    }
}
