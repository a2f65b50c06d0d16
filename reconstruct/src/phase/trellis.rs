//! Which phase may follow which (Merker et al. 2020, fig. 8b), and the likeliest way through the diagram.

use crate::phase::label::Label;

/// A place between two samples where the reactions may break.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Break {
    /// The first sample after it.
    pub index: usize,
    /// Whether the reactions jump there, or only their rates.
    pub jump: bool,
    /// Its chi^2.
    pub score: f64,
}

/// Log-odds against a change of phase: where the reactions break, where they need not (between A and B they hardly do), where
/// they should but do not.
const AT_BREAK: f64 = -3.0;
const SMOOTH: f64 = -7.0;
const UNSEEN: f64 = -60.0;
/// Log-odds against a change that is not in the diagram.
const STRANGE: f64 = -12.0;
/// A break of this chi^2 may as well be a false alarm, and each so many more make it surer by one, up to a limit: a vertex
/// breaks the reactions too, without a change of phase.
const DOUBTFUL: f64 = 30.0;
const SURER: f64 = 4.0;
const SUREST: f64 = 8.0;

/// Whether one contact comes, goes or passes between tip and flank from one to the other: the diagram of fig. 8b with the
/// free rod, read in both directions.
fn neighbours(from: Label, to: Label) -> bool {
    use Label::{A, B, BA, BB, Free};
    let either = |u, v| (from, to) == (u, v) || (from, to) == (v, u);
    either(Free, A)
        || either(Free, B)
        || either(A, B)
        || either(A, BA)
        || either(B, BA)
        || either(B, BB)
        || either(BB, BA)
}

/// Log-odds of going on from one label to another across what lies between two places.
pub(crate) fn passage(from: Label, to: Label, between: Option<Break>) -> f64 {
    use Label::{A, B};
    let sure = between.map_or(0.0, |here| ((here.score - DOUBTFUL) / SURER).clamp(-SUREST, SUREST));
    if from == to {
        // a rod that snaps or slips may well land in the phase it left, and a third contact keeps the label of two
        let again = from.several() || between.is_some_and(|here| here.jump);
        let least = if again { AT_BREAK } else { f64::NEG_INFINITY };
        return (-sure.max(0.0)).max(least);
    }
    let strange = if neighbours(from, to) { 0.0 } else { STRANGE };
    match between {
        Some(Break { jump: true, .. }) => AT_BREAK,
        Some(_) => AT_BREAK + sure.min(0.0) + strange,
        None if matches!((from, to), (A, B) | (B, A)) => SMOOTH,
        None => UNSEEN + strange,
    }
}

/// A place: log-likelihood of each label, and what lies between it and the place before.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    pub scores: [f64; 5],
    pub between: Option<Break>,
}

/// The likeliest way through places in order, and how sure each label is (Viterbi's and the forward-backward algorithm).
/// Its memory is kept from one use to the next.
#[derive(Clone, Debug, Default)]
pub(crate) struct Trellis {
    steps: Vec<[u8; 5]>,
    ahead: Vec<[f64; 5]>,
    labels: Vec<(Label, f64)>,
}

impl Trellis {
    /// With memory for so many places.
    pub fn with_capacity(places: usize) -> Self {
        let mut trellis = Self::default();
        trellis.steps.reserve(places);
        trellis.ahead.reserve(places);
        trellis.labels.reserve(places);
        trellis
    }

    /// The labels of all places, and by how much the probability of each exceeds that of the next best label there.
    /// `before` are the scores of the ways that lead up to the first place, equal where it is the first of all.
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
        self.margins(before, places);
        &self.labels
    }

    fn margins(&mut self, before: &[f64; 5], places: impl DoubleEndedIterator<Item = Place> + Clone) {
        self.ahead.clear();
        let mut ahead = [0.0; 5];
        for place in places.clone().rev() {
            self.ahead.push(ahead);
            let joined = std::array::from_fn(|i| ahead[i] + place.scores[i]);
            ahead = carry(&joined, place.between, true);
        }
        let mut behind = *before;
        for ((place, ahead), found) in places.zip(self.ahead.iter().rev()).zip(&mut self.labels) {
            behind = carry(&behind, place.between, false);
            behind = std::array::from_fn(|i| behind[i] + place.scores[i]);
            let both: [f64; 5] = std::array::from_fn(|i| behind[i] + ahead[i]);
            let total = sum(both);
            let (own, mut other) = (found.0 as usize, f64::NEG_INFINITY);
            for (k, score) in both.into_iter().enumerate() {
                other = if k == own { other } else { other.max(score) };
            }
            found.1 = (both[own] - total).exp() - (other - total).exp();
        }
    }
}

/// One step of Viterbi's algorithm: the best score of a way that ends in each label, and where it came from.
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

fn greatest(scores: &[f64; 5]) -> usize {
    (1..5).fold(0, |best, k| if scores[k] > scores[best] { k } else { best })
}

/// Scores after (or, `back`, before) what lies between two places, from those on its other side.
fn carry(scores: &[f64; 5], between: Option<Break>, back: bool) -> [f64; 5] {
    std::array::from_fn(|to| {
        sum(std::array::from_fn(|from| {
            let (u, v) = if back { (to, from) } else { (from, to) };
            scores[from] + passage(Label::ALL[u], Label::ALL[v], between)
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
