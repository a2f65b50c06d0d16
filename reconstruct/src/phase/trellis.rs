//! The most likely sequence of phases.

use super::diagram::{Break, passage};
use super::label::Label;

/// Factor on all log-odds for the probabilities of labels. The criteria of neighbouring places and the breaks share errors, so that their
/// evidence counts several times. Larger: labels claim more than they hold; smaller: less. Chosen on 98 recordings of eleven scenes with noise
/// and shared errors: the log-likelihood of the true labels is largest, and the shares of right labels are those claimed.
const SHARED: f64 = 0.3;

/// A place of a scan: the log-likelihood of each label there, and the break between it and the place before.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
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

    /// The label of each place and its probability. `before` are the scores of
    /// the best sequences up to the first place for each label: equal where there are none.
    pub fn run(
        &mut self,
        before: &[f64; 5],
        places: impl DoubleEndedIterator<Item = Place> + Clone,
    ) -> &[(Label, f64)] {
        self.steps.clear();
        self.labels.clear();
        let mut best = *before;
        for place in places.clone() {
            let from;
            (best, from) = forward(&best, &place);
            self.steps.push(from);
        }
        let mut label = greatest(&best);
        for step in self.steps.iter().rev() {
            self.labels.push((Label::ALL[label], 0.0));
            label = usize::from(step[label]);
        }
        self.labels.reverse();
        self.probabilities(before, places);
        &self.labels
    }

    /// The probability of each label at each place, from evidence that allows for shared errors itself. `before` are the logs of the
    /// [probabilities](passed) up to there.
    pub fn chances(
        &mut self,
        before: &[f64; 5],
        places: impl DoubleEndedIterator<Item = Place> + Clone,
    ) -> &[[f64; 5]] {
        self.ahead.clear();
        let mut ahead = [0.0; 5];
        for place in places.clone().rev() {
            self.ahead.push(ahead);
            let joined = std::array::from_fn(|i| ahead[i] + place.scores[i]);
            ahead = carry(&joined, place.between, true, 1.0);
        }
        let mut behind = *before;
        for (place, ahead) in places.zip(self.ahead.iter_mut().rev()) {
            behind = passed(&behind, &place);
            let both: [f64; 5] = std::array::from_fn(|i| behind[i] + ahead[i]);
            let total = sum(both);
            *ahead = both.map(|score| (score - total).exp());
        }
        self.ahead.reverse();
        &self.ahead
    }

    fn probabilities(&mut self, before: &[f64; 5], places: impl DoubleEndedIterator<Item = Place> + Clone) {
        self.ahead.clear();
        let scaled = |scores: &[f64; 5]| scores.map(|score| SHARED * score);
        let mut ahead = [0.0; 5];
        for place in places.clone().rev() {
            self.ahead.push(ahead);
            let own = scaled(&place.scores);
            let joined = std::array::from_fn(|i| ahead[i] + own[i]);
            ahead = carry(&joined, place.between, true, SHARED);
        }
        let mut behind = scaled(before);
        for ((place, ahead), found) in places.zip(self.ahead.iter().rev()).zip(&mut self.labels) {
            behind = carry(&behind, place.between, false, SHARED);
            let own = scaled(&place.scores);
            behind = std::array::from_fn(|i| behind[i] + own[i]);
            let both: [f64; 5] = std::array::from_fn(|i| behind[i] + ahead[i]);
            let total = sum(both);
            let of = |label: Label| (both[label as usize] - total).exp();
            let either = self.alike && found.0.several();
            found.1 = if either { (of(Label::BA) + of(Label::BB)).min(1.0) } else { of(found.0) };
        }
    }
}

/// Log of the probability of each label at a place, given the places up to it, from that at the place before.
pub(crate) fn passed(before: &[f64; 5], place: &Place) -> [f64; 5] {
    let carried = carry(before, place.between, false, 1.0);
    let joined: [f64; 5] = std::array::from_fn(|k| carried[k] + place.scores[k]);
    let total = sum(joined);
    joined.map(|score| score - total)
}

/// One step of Viterbi's algorithm: the best score of a sequence that ends in each label, and the label before it.
pub(crate) fn forward(before: &[f64; 5], place: &Place) -> ([f64; 5], [u8; 5]) {
    let mut best = [f64::NEG_INFINITY; 5];
    let mut from = [0; 5];
    for (to, label) in Label::ALL.into_iter().enumerate() {
        for (origin, start) in Label::ALL.into_iter().enumerate() {
            let score = before[origin] + passage(start, label, place.between);
            if score > best[to] {
                (best[to], from[to]) = (score, origin as u8);
            }
        }
        best[to] += place.scores[to];
    }
    (best, from)
}

/// The number of the label with the greatest score.
pub(crate) fn greatest(scores: &[f64; 5]) -> usize {
    (1..5).fold(0, |best, k| if scores[k] > scores[best] { k } else { best })
}

/// Scores carried over the transition between two places, forwards or (`back`) backwards, with this factor on its log-odds.
fn carry(scores: &[f64; 5], between: Option<Break>, back: bool, factor: f64) -> [f64; 5] {
    std::array::from_fn(|to| {
        sum(std::array::from_fn(|from| {
            let (u, v) = if back { (to, from) } else { (from, to) };
            scores[from] + factor * passage(Label::ALL[u], Label::ALL[v], between)
        }))
    })
}

/// Log of a sum of exponentials.
fn sum(scores: [f64; 5]) -> f64 {
    let most = scores.into_iter().fold(f64::NEG_INFINITY, f64::max);
    most + scores.into_iter().map(|score| (score - most).exp()).sum::<f64>().ln()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn place(likely: Label, by: f64, between: Option<Break>) -> Place {
        Place { scores: Label::ALL.map(|label| if label == likely { by } else { 0.0 }), between }
    }

    #[test]
    fn one_doubtful_place_changes_nothing_and_a_break_lets_the_phase_change() {
        let kink = Break { index: 5, jump: false, score: 200.0 };
        let jump = Some(Break { jump: true, ..kink });
        let kink = Some(kink);
        let mut places = vec![place(Label::B, 8.0, None); 10];
        places[3] = place(Label::BB, 20.0, None);
        places.truncate(6);
        places.extend((0..4).map(|k| place(Label::BB, 8.0, if k == 0 { kink } else { None })));
        let mut trellis = Trellis::default();
        let found = trellis.run(&[0.0; 5], places.iter().copied()).to_vec();
        assert!(found[..6].iter().all(|f| f.0 == Label::B) && found[6..].iter().all(|f| f.0 == Label::BB), "{found:?}");
        assert!(found[1].1 > 0.99 && found[3].1 > 0.9 && found.iter().all(|f| (-1.0..=1.0).contains(&f.1)));
        // from A to BB no single contact comes or goes
        let places = [place(Label::A, 9.0, None), place(Label::BB, 9.0, kink), place(Label::B, 7.0, None)];
        assert_eq!(trellis.run(&[0.0; 5], places.iter().copied())[1].0, Label::B);
        let places = [place(Label::A, 9.0, None), place(Label::BB, 9.0, jump)];
        assert_eq!(trellis.run(&[0.0; 5], places.iter().copied())[1].0, Label::BB);
    }

    #[test]
    fn two_labels_that_nothing_tells_apart_are_as_likely_together_as_one_of_them_alone() {
        // BA and BB are equally likely, against B
        let places = vec![Place { scores: [0.0, 0.0, 0.0, 30.0, 30.0], between: None }; 8];
        let of = |mut trellis: Trellis| trellis.run(&[0.0; 5], places.iter().copied()).to_vec();
        let (told, alike) = (of(Trellis::default()), of(Trellis::alike()));
        assert!(told.iter().zip(&alike).all(|(one, other)| one.0 == other.0 && one.0.several()));
        assert!(told.iter().all(|found| found.1 < 0.6) && alike.iter().all(|found| found.1 > 0.999 && found.1 <= 1.0));
    }

    #[test]
    fn parts_one_after_the_other_are_the_whole() {
        let places: Vec<Place> = (0..40_u32)
            .map(|k| {
                place(
                    Label::ALL[(k / 7) as usize % 5],
                    3.0,
                    (k % 7 == 0).then_some(Break { index: 0, jump: true, score: 99.0 }),
                )
            })
            .collect();
        let whole = Trellis::default().run(&[0.0; 5], places.iter().copied()).to_vec();
        let before = places[..20].iter().fold([0.0; 5], |before, place| forward(&before, place).0);
        let rest = Trellis::default().run(&before, places[20..].iter().copied()).to_vec();
        assert!(whole[20..].iter().zip(&rest).all(|(u, v)| u.0 == v.0));
    }
}
