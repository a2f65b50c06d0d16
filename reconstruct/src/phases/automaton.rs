//! Which phase may follow which (Merker et al. 2021, fig. 8b), and the likeliest way through the diagram.

use crate::label::Label;

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
        // a rod that snaps or slips may well land in the phase it left
        let least = if between.is_some_and(|here| here.jump) { AT_BREAK } else { f64::NEG_INFINITY };
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

/// One step of the forward recursion: the best score of a way that ends in each label, and where it came from.
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

/// The likeliest labels of all places, and by how much the probability of each exceeds that of the next best label
/// there.
pub(crate) fn likeliest(places: &[Place]) -> Vec<(Label, f64)> {
    let margins = margins(places);
    let mut steps = Vec::with_capacity(places.len());
    let mut best = [0.0; 5];
    for (index, place) in places.iter().enumerate() {
        if index == 0 {
            best = place.scores;
            steps.push([0, 1, 2, 3, 4]);
        } else {
            let (next, from) = forward(&best, place);
            (best, _) = (next, steps.push(from));
        }
    }
    let mut label = greatest(&best);
    let mut labels = Vec::with_capacity(places.len());
    for (step, probabilities) in steps.iter().zip(&margins).rev() {
        let other = (0..5).filter(|&k| k != label).map(|k| probabilities[k]).fold(0.0, f64::max);
        labels.push((Label::ALL[label], probabilities[label] - other));
        label = usize::from(step[label]);
    }
    labels.reverse();
    labels
}

pub(crate) fn greatest(scores: &[f64; 5]) -> usize {
    (1..5).fold(0, |best, k| if scores[k] > scores[best] { k } else { best })
}

/// Probability of each label at each place, by the forward-backward algorithm.
fn margins(places: &[Place]) -> Vec<[f64; 5]> {
    let carry = |scores: &[f64; 5], between: Option<Break>, back: bool| -> [f64; 5] {
        std::array::from_fn(|to| {
            sum(std::array::from_fn(|from| {
                let (u, v) = if back { (to, from) } else { (from, to) };
                scores[from] + passage(Label::ALL[u], Label::ALL[v], between)
            }))
        })
    };
    let mut ahead = vec![[0.0; 5]; places.len()];
    for k in (1..places.len()).rev() {
        let joined = std::array::from_fn(|i| ahead[k][i] + places[k].scores[i]);
        ahead[k - 1] = carry(&joined, places[k].between, true);
    }
    let mut behind = [0.0; 5];
    let mut all = Vec::with_capacity(places.len());
    for (k, place) in places.iter().enumerate() {
        if k > 0 {
            behind = carry(&behind, place.between, false);
        }
        behind = std::array::from_fn(|i| behind[i] + place.scores[i]);
        let both: [f64; 5] = std::array::from_fn(|i| behind[i] + ahead[k][i]);
        let total = sum(both);
        all.push(both.map(|score| (score - total).exp()));
    }
    all
}

/// Log of a sum of exponentials.
fn sum(scores: [f64; 5]) -> f64 {
    let most = scores.into_iter().fold(f64::NEG_INFINITY, f64::max);
    most + scores.into_iter().map(|score| (score - most).exp()).sum::<f64>().ln()
}
